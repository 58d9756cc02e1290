"""A part that stands across between two walls like a strut: how far apart such walls are."""

import math

import numpy as np

from feederscrew.tooling.orientations import Orientation

TURNS = 1.02  # times its breadth along the wall: what is no wider, turned as you like, is no strut


def walls_between(one: Orientation, friction: float) -> tuple[float, float] | None:
    """Return between which distances of two parallel walls a part may wedge; None where it cannot.

    A part between upright walls, turned until it touches both, is a strut: two forces along the line through
    the points where it touches. They hold it, however hard it is pushed along, where that line is within the
    angle of friction of square to the walls. It turns no further where that line is its own longest.

    Source: own; docs/design.md, "7. Risks between parts".

    Parameters
    ----------
    one : Orientation
        Lying as it travels along the first wall.
    friction : float [1]
        Of the part on the walls.

    Returns
    -------
    (float, float) [m] or None
        Least and greatest. Walls that are nearer than the part is broad let none in; walls that are further
        apart never touch it at once.
    """
    corners = one.outline
    breadth = float(np.ptp(corners[:, 1]))
    longest = _longest(corners)
    if longest <= TURNS * breadth:
        return None
    return max(longest * math.cos(math.atan(friction)), breadth), longest


def _longest(corners: np.ndarray) -> float:
    """The greatest distance of two corners (J, 2)."""
    apart = corners[:, None] - corners[None]
    return float(np.sqrt((apart**2).sum(axis=-1)).max())


def strut(one: Orientation, width: float) -> float:
    """Return the heading [rad] by which a part is turned further where it touches walls so far apart.

    Parameters
    ----------
    one : Orientation
    width : float [m]
        Of the two walls.
    """
    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, 721)
    wide = [
        float(np.ptp(math.sin(turn) * one.outline[:, 0] + math.cos(turn) * one.outline[:, 1]))
        for turn in angles
    ]
    return float(angles[int(np.argmin(np.abs(np.array(wide) - width)))])
