"""Compiled balance of energy: what a part has beyond what gravity and the drive gave it."""

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import W, X, Y, Z
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.motion import forces


@compiled
def unpaid(surface, solid, floor, work, time, taken):
    """Change of the kinetic energy over a step, less the work of gravity and of the drive; at mass 1.

    Both in the bowl's frame, in which the drive is a force. ``work.saved`` holds the start of the step and
    ``work.turn`` the part's attitude there, ``work.state`` the end.
    """
    start, end = work.saved, work.state
    u, v, w, spin = forces(surface, floor, time, taken, start)
    done = (u * (end[X] - start[X]) + v * (end[Y] - start[Y]) + w * (end[Z] - start[Z])) / taken
    for k in range(3):
        done -= spin * work.turn[6 + k] * solid.inertia[k] * 0.5 * (start[W + k] + end[W + k])
    return body.moving_energy(end, solid.inertia) - body.moving_energy(start, solid.inertia) - done
