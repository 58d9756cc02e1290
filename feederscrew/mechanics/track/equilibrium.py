"""Whether friction can hold a part at rest on the track: any static equilibrium, by a linear programme.

The balance at rest takes the least friction, all along the track and the same share of its limit at every
contact. Where that would need more than there is, friction across the track, up and down the wall, or more
of it at one end of the part than at the other may still hold it.

Source: Coulomb's cones as a linear programme; docs/mechanics.md.
"""

import numpy as np
from numpy.typing import NDArray

from feederscrew.mechanics.track.frame import frame, loads

CONE_SIDES = 64  # of the pyramid within a friction cone: its corners lie on it, its sides 0.12 % within
CONE_MARGIN = 1e-6  # of every coefficient, so that an equilibrium on the very limit is none


def exists(seat, bowl, phase=0.5 * np.pi) -> bool:
    """Return whether forces within the friction cones balance the load on a part at rest.

    Source: Coulomb's cones as a linear programme; docs/mechanics.md, "The track".

    Parameters
    ----------
    seat : Seat
        Of a part with a contact polygon: the floor presses at its corners, the wall at its two contacts.
    bowl : Bowl
        Single values; friction at the wall is ``friction.wall``.
    phase : float [rad]
        w t; a quarter turn is the upper reversal.

    Returns
    -------
    bool
        False also for a part card without a contact polygon, of which it is not known.
    """
    if len(seat.contact) == 0:
        return False
    from scipy.optimize import linprog  # a fifth of a second to load: only where a balance is in doubt

    axes = frame(bowl, seat.walls)
    load = loads(seat, bowl, axes, phase) / (seat.mass * bowl.gravity)
    rays = _rays(seat, bowl, axes)
    right = np.concatenate([-load, np.zeros(3)])
    return linprog(np.zeros(len(rays)), A_eq=rays.T, b_eq=right, method="highs").status == 0


def _rays(seat, bowl, axes) -> NDArray[np.float64]:
    """Edges of the friction pyramids as wrenches about the centre of mass, its height the unit; (R, 6)."""
    angle = 2.0 * np.pi * np.arange(CONE_SIDES) / CONE_SIDES
    around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    static, wall = (mu * (1.0 - CONE_MARGIN) for mu in (bowl.friction.static, bowl.friction.wall))
    floor = np.column_stack([static * around, np.ones(CONE_SIDES)])
    feet = np.column_stack([seat.contact, np.full(len(seat.contact), -seat.height)])
    places, forces = [np.repeat(feet, CONE_SIDES, axis=0)], [np.tile(floor, (len(feet), 1))]
    for place, normal, course in zip(seat.walls, axes.normals, axes.courses):
        upward = np.cross(course, normal)
        tangents = around[:, :1] * course + around[:, 1:] * upward
        places.append(np.tile(place, (CONE_SIDES, 1)))
        forces.append(normal + wall * tangents)
    place, force = np.concatenate(places) / seat.height, np.concatenate(forces)
    return np.concatenate([force, np.cross(place, force)], axis=1)
