"""Which corners of a foot keep track below while a hole passes, and what these alone carry."""

import math

from feederscrew.geometry.compiled import compiled, outlined
from feederscrew.tooling.kernel.hull_depth import inset_beside

MARGIN_ROUNDING_M = 1e-12  # [m] of a margin: what is sure by more cannot come out lower


@outlined
def carried(foot, hole, scratch, i, margin):
    """Return whether the corners that have track below in a piece carry a foot by a margin [m] for certain.

    More track can only carry it better, so the few corners of its hull are asked first; with all of them it
    is carried as on the whole track, to the last digit. Fills ``keep`` where that is not certain.
    """
    keep_corners(foot, hole, scratch, i, foot.hull)
    whole = len(foot.hull) > 0
    for k in foot.hull:
        whole = whole and scratch.keep[k] == 1
    inset = kept_inset(foot, scratch, foot.hull)
    if inset > margin + MARGIN_ROUNDING_M or (whole and inset >= max(margin, 0.0)):
        return True
    keep_corners(foot, hole, scratch, i, foot.all_corners)
    return kept_inset(foot, scratch, foot.all_corners) > margin + MARGIN_ROUNDING_M


@outlined
def kept_inset(foot, scratch, corners):
    """Return the margin [m] on no more than those of some corners of a foot that have track below."""
    count = 0
    for k in corners:
        if scratch.keep[k]:
            scratch.points[count, 0] = foot.corners[k, 0]
            scratch.points[count, 1] = foot.centre - foot.corners[k, 1]
            count += 1
    return inset_beside(scratch.points, count, foot, scratch.keep)


@compiled
def keep_corners(foot, hole, scratch, i, corners):
    """Fill which of some corners of the foot have track below in a piece between two events."""
    phi = 0.5 * (scratch.events[i] + scratch.events[i + 1])
    for k in corners:
        scratch.keep[k] = 0 if _over(hole.edges, foot.polar[k, 0] - phi, foot.polar[k, 1]) else 1


@compiled
def _over(edges, theta, radius):
    """Whether a point is over the hole."""
    inside = False
    for j in range(len(edges)):
        edge = edges[j]
        if edge.arc or not edge.low <= radius < edge.high:
            continue
        bend = 0.0 if edge.gamma == 0.0 else math.asin(min(edge.gamma / radius, 1.0))
        if edge.alpha + edge.kappa * radius + bend > theta:
            inside = not inside
    return inside
