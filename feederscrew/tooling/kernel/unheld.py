"""The longest way over which a foot is not supported while a hole passes below it."""

from feederscrew.geometry.compiled import compiled, entry
from feederscrew.tooling.kernel import passage
from feederscrew.tooling.kernel.carried_corners import carried
from feederscrew.tooling.kernel.hull_depth import inset_beside

UNHELD_SAMPLES = 8  # parts of a piece between two events


@entry
def longest(foot, hole, scratch, enough):
    """Return the longest turn of the hole [rad] through which the margin stays below zero.

    Between samples the margin is taken to change evenly.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    foot : Foot
    hole : HoleEdges
    scratch : VerdictArrays
    enough : float [rad]
        A longer turn is returned as soon as it is so long; infinite for the longest.
    """
    best = turn = 0.0
    for i in range(passage._events(foot, hole, scratch) - 1):
        step = (scratch.events[i + 1] - scratch.events[i]) / UNHELD_SAMPLES
        if step * UNHELD_SAMPLES <= passage.INSTANT:
            continue
        if carried(foot, hole, scratch, i, 0.0):
            turn = 0.0
            continue
        active = passage.status(foot, hole, scratch, i)
        before = _unheld_margin(foot, hole, scratch, scratch.events[i], active)
        for k in range(1, UNHELD_SAMPLES + 1):
            after = _unheld_margin(foot, hole, scratch, scratch.events[i] + k * step, active)
            if before < 0.0 and after < 0.0:
                turn += step
            elif before < 0.0:
                best, turn = max(best, turn + step * before / (before - after)), 0.0
            else:
                turn = step * after / (after - before) if after < 0.0 else 0.0
            before = after
        best = max(best, turn)
        if best >= enough:
            break
    return best


@compiled
def _unheld_margin(foot, hole, scratch, phi, active):
    count = passage._gather(foot, hole, scratch, phi, active, True, scratch.points)
    return inset_beside(scratch.points, count, foot, scratch.keep)
