"""Compiled lists of which circles of a part are near the surface of a plate."""

import math

from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel import circles_met
from feederscrew.trial.kernel.crowd_records import DEPTH, FIRST, LAST, RIMS
from feederscrew.trial.kernel.near_borders import comes
from feederscrew.trial.kernel.plate_views import DEEP, inside, placed


@compiled
def _borders_come(surface, crowd, rim, middle, every, margin):
    """Whether any of so many near borders comes near a circle with its middle there."""
    box, frame, found = crowd.box, crowd.frame, False
    for e in range(2):
        along = frame[3 * e] * rim[3] + frame[3 * e + 1] * rim[4] + frame[3 * e + 2] * rim[5]
        half = rim[6] * math.sqrt(max(1.0 - along * along, 0.0))
        box[2 * e], box[2 * e + 1] = middle[e] - half, middle[e] + half
    for m in range(every):
        found = found or comes(surface.borders[crowd.near[m]], box, margin + DEEP)
    return found


@compiled
def near_rims(surface, solid, crowd, n, k, every, margin):
    """Add the circles near a plate's surface, of so many near borders, within a margin [L].

    A circle to which no border comes near counts as it lies over what is solid; of any other each point is
    asked for.
    """
    plate, plain = surface.plates[k], every == 0
    whole = 0.5 * plate[DEPTH] >= DEEP
    for m in range(len(solid.rims)):
        low, _ = circles_met.lowest(crowd.frame, solid.rims[m])
        if not -DEEP - margin < low < margin:
            continue
        a, b, _ = placed(crowd.frame, solid.rims[m])
        alone = plain or (whole and not _borders_come(surface, crowd, solid.rims[m], (a, b), every, margin))
        if alone and not inside(surface.borders, int(plate[FIRST]), int(plate[LAST]), a, b):
            continue
        count = crowd.low[RIMS]
        crowd.rims[n, count, 0], crowd.rims[n, count, 1] = m, alone
        crowd.low[RIMS] = count + 1
