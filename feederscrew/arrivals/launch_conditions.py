"""Launches of parts onto the plane: presets, from which a drop draws, and conditions of a user."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel.falling import Launched
from feederscrew.arrivals.rounded_hull import Shape, lowest_on
from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document
from feederscrew.base.errors import ArgumentError
from feederscrew.base.geometry import vectors
from feederscrew.base.signatures import Keywords
from feederscrew.base.units import GRAVITY, QuantityError, factor, quantity, quantity_text
from feederscrew.motion.conveying import even_range
from feederscrew.resting.rules.recommended import launch_of_name

DRAWS_A_DROP = 11  # uniform numbers a drop takes: 3 attitude, 3 spin, 2 drift, fall, restitution, friction
# axes a launch spins about
ANY_AXIS = "any"
LEVEL_AXIS = "horizontal"
FLIP_AXIS = "in the greatest face"
FLIP_LEAN_RAD = np.radians(40.0)  # of FLIP_AXIS's axis from the level, at most: see docs/resting.md


@dataclass(frozen=True)
class Launch:
    """Ranges a drop draws from, uniformly, without dimensions; attitudes and directions are all alike.

    The unit of length is L, the cube root of the hull's volume; of speed sqrt(g L), of rate sqrt(g / L).
    """

    name: str
    fall: tuple[float, float]  # from the lowest point to the plane
    spin: tuple[float, float]  # rate
    speed: tuple[float, float]  # along the plane
    restitution: tuple[float, float]  # of a corner hit
    friction: tuple[float, float]
    axis: str = ANY_AXIS  # it spins about: ANY, LEVEL, or FLIP_AXIS

    def but(self, **ranges: Any) -> "Launch":
        """Return the launch with some ranges replaced; named 'own' once one is."""
        changes = {name: ends for name, ends in ranges.items() if ends is not None}
        return replace(self, name="own", **changes) if changes else self

    def scattering(self) -> "Launch":
        """Return the launch with one value of restitution as ``answer.even_range`` round it."""
        low, high = self.restitution
        return replace(self, restitution=even_range(low) if low == high else (low, high))


SURFACE: Keywords = {"restitution": (0.2, 0.6), "friction": (0.2, 0.5)}  # hard on hard, every launch
PRESETS = {
    launch.name: launch
    for launch in (
        Launch("place", (0.0, 0.05), (0.0, 0.0), (0.0, 0.0), **SURFACE),
        Launch("drop", (1.0, 6.0), (0.0, 0.0), (0.0, 0.0), **SURFACE),
        Launch("flip", (15.0, 40.0), (6.0, 14.0), (0.0, 2.0), **SURFACE, axis=FLIP_AXIS),
        Launch("roll", (1.0, 4.0), (1.0, 5.0), (2.0, 6.0), **SURFACE, axis=LEVEL_AXIS),
        Launch("feed", (2.0, 6.0), (0.0, 2.0), (0.0, 2.0), **SURFACE),
    )
}
"""What was done to the part. place: set down by hand. drop: let fall without spin. flip: spun up by hand, as
a coin, about an axis in the plane of its greatest face, level to FLIP_LEAN_RAD. roll: cast or poured
over a table, spinning about a horizontal axis. feed: out of a hopper into a bowl. docs/resting.md says where
each range comes from."""


def named(name: str) -> Launch:
    """Return the preset of a name, or of a former one."""
    return PRESETS[launch_of_name(name)]


@dataclass(frozen=True, eq=False)
class Starts:
    """Starting conditions of N drops."""

    states: Floats  # (N, 13)
    restitutions: Floats  # (N,)
    frictions: Floats  # (N,)
    energies: Floats  # (N,) fall and kinetic energy, in units of m g L: how violent the launch is

    def some(self, part: slice) -> "Starts":
        """Return those of a slice."""
        return Starts(self.states[part], self.restitutions[part], self.frictions[part], self.energies[part])

    def launched(self, part: slice = slice(None)) -> Launched:
        """Return those of a slice as the kernels take them: a Launched."""
        return Launched(self.states[part], self.restitutions[part], self.frictions[part])


def sample(launch: Launch, shape: Shape, count: int, rng: np.random.Generator) -> Starts:
    """Return the starting conditions of some drops, drawn uniformly from the ranges of a launch.

    Attitudes are uniform over all rotations; those of ``FLIP_AXIS`` have that axis within ``FLIP_LEAN_RAD``
    of the level. Each drop takes ``DRAWS_A_DROP`` numbers of ``rng``, so that drops come out the same however
    they are batched.

    Parameters
    ----------
    launch : Launch
    shape : Shape
    count : int
        Drops, N.
    rng : Generator

    Returns
    -------
    Starts
        States (N, 13) [L, sqrt(g L), 1, sqrt(g / L)].

    References
    ----------
    docs/resting.md, "The drop test"; K. Shoemake, "Uniform random rotations", Graphics Gems III, 124-132,
    1992.
    """
    u = rng.random((count, DRAWS_A_DROP))
    states = np.zeros((count, body.STATE))
    # Unit quaternions, uniform over all attitudes: K. Shoemake, "Uniform random rotations", Graphics Gems
    # III, 124-132, 1992.
    near, far = np.sqrt(1.0 - u[:, 0]), np.sqrt(u[:, 0])
    a, b, turn = (2.0 * np.pi * u[:, column] for column in (1, 2, 4))
    attitude = np.stack([near * np.sin(a), near * np.cos(a), far * np.sin(b), far * np.cos(b)], axis=1)
    if launch.axis == ANY_AXIS:  # uniform over the sphere
        z = 2.0 * u[:, 4] - 1.0
        around, flat = 2.0 * np.pi * u[:, 5], np.sqrt(np.maximum(1.0 - z * z, 0.0))
        axes = np.stack([flat * np.cos(around), flat * np.sin(around), z], axis=1)
    elif launch.axis == FLIP_AXIS:
        along, across = vectors.plane_axes(shape.flat)
        axes = np.cos(turn)[:, None] * along + np.sin(turn)[:, None] * across
        # Attitudes that turn these to at most FLIP_LEAN_RAD from the level. An axis and its opposite are as
        # likely: the one that is nearer to where it is turned to is taken.
        rise, ahead, half = FLIP_LEAN_RAD * (2.0 * u[:, 0] - 1.0), 2.0 * np.pi * u[:, 1], np.pi * u[:, 2]
        level = np.cos(rise)
        there = np.stack([level * np.cos(ahead), level * np.sin(ahead), np.sin(rise)], axis=1)
        axes = np.where((axes * there).sum(axis=1)[:, None] < 0.0, -axes, axes)
        p = np.column_stack([1.0 + (axes * there).sum(axis=1), np.cross(axes, there)])
        p /= np.sqrt((p**2).sum(axis=1))[:, None]
        q = np.column_stack([np.cos(half), np.sin(half)[:, None] * axes])
        # The quaternion of the turn q about the axis, then p.
        whole = p[:, 0] * q[:, 0] - (p[:, 1:] * q[:, 1:]).sum(axis=1)
        turned = p[:, :1] * q[:, 1:] + q[:, :1] * p[:, 1:] + np.cross(p[:, 1:], q[:, 1:])
        attitude = np.column_stack([whole, turned])
    else:
        axes = _in_body(attitude, np.stack([np.cos(turn), np.sin(turn), np.zeros(count)], axis=1))

    def between(ends: tuple[float, float], column: int) -> Floats:
        return ends[0] + (ends[1] - ends[0]) * u[:, column]

    fall, spin, drift = between(launch.fall, 8), between(launch.spin, 3), between(launch.speed, 6)
    states[:, body.Q : body.Q + 4] = attitude
    states[:, body.Z] = fall - lowest_points(shape, attitude)
    heading = 2.0 * np.pi * u[:, 7]
    states[:, body.VX : body.VX + 2] = drift[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    states[:, body.W : body.W + 3] = spin[:, None] * axes
    turning = 0.5 * (states[:, body.W : body.W + 3] ** 2 * shape.solid.inertia).sum(axis=1)
    return Starts(
        states=check.frozen(states),
        restitutions=check.frozen(between(launch.restitution, 9)),
        frictions=check.frozen(between(launch.friction, 10)),
        energies=check.frozen(fall + 0.5 * drift**2 + turning),
    )


def lowest_points(shape: Shape, attitudes: Floats) -> Floats:
    """Return the height of the lowest point over the centre of mass.

    Parameters
    ----------
    shape : Shape
    attitudes : (N, 4) float [1]
        Unit quaternions of the body.

    Returns
    -------
    (N,) float [L]
        Negative.

    References
    ----------
    The support function of a body in the direction down.
    """
    up = _in_body(attitudes, np.array([[0.0, 0.0, 1.0]]))
    lowest = np.einsum("ni,vi->nv", up, shape.solid.vertices).min(axis=1)
    rims = np.einsum("ni,nri->nr", up, lowest_on(shape, up))
    return np.minimum(lowest, rims.min(axis=1, initial=np.inf))


def _in_body(q: Floats, directions: Floats) -> Floats:
    """Return (N, 3) directions along the floor's axes in body axes, for (N, 4) quaternions."""
    turned = 2.0 * np.cross(q[:, 1:], directions)
    return directions - q[:, :1] * turned + np.cross(q[:, 1:], turned)


CONDITION_KEYS = {  # argument: dimension; lowest, highest without dimensions
    "fall": ("length", 0.0, 1000.0),
    "spin": ("angular velocity", 0.0, 100.0),
    "speed": ("velocity", 0.0, 100.0),
    "restitution": ("number", 0.0, 1.0),
    "friction": ("number", 0.0, 5.0),
}
# half-widths of an interval that drops may go on for
MIN_HALF_WIDTH = 1e-4  # [1]
MAX_HALF_WIDTH = 0.5  # [1]
LIMIT_UNITS = {"length": "mm", "velocity": "mm/s", "angular velocity": "rad/s", "number": ""}


def launch_of(
    preset: str, length: float, texts: Mapping[str, str | None], gravity: float = GRAVITY
) -> Launch:
    """Return a preset, by its name or a former one, with the user's own ranges in it.

    Parameters
    ----------
    preset : str
    length : float [m]
        Of the part: cube root of its hull's volume.
    texts : mapping of str to str or None
        By key of ``CONDITION_KEYS``: a quantity, or two with a colon between; None keeps the preset's.
    gravity : float [m/s2]

    Returns
    -------
    Launch
        Ranges in units of the part's length L, sqrt(g L) and sqrt(g / L).

    Raises
    ------
    ArgumentError
        If a text is no such quantity, or out of range.

    References
    ----------
    docs/resting.md, "The drop test".
    """
    units = _units(length, gravity)
    ranges = {key: None if text is None else _range(key, text, units[key]) for key, text in texts.items()}
    return named(preset).but(**ranges)


def _units(length: float, gravity: float) -> dict[str, float]:
    """Return the SI units in one of each range, for a part of a length [m]."""
    rate, speed = float(np.sqrt(gravity / length)), float(np.sqrt(gravity * length))
    return {"fall": length, "spin": rate, "speed": speed, "restitution": 1.0, "friction": 1.0}


def single(text: str | None) -> float | None:
    """Return a number [1] as typed, if it is one value and no range such as '0.3:0.3'; else None."""
    return None if text is None or ":" in text else _read("restitution", text, "number")


def described(launch: Launch, length: float, gravity: float = GRAVITY) -> Document:
    """Return the name and ranges of a launch in the units of the shop.

    Parameters
    ----------
    launch : Launch
    length : float [m]
        Of the part.
    gravity : float [m/s2]

    Returns
    -------
    dict
        Ranges [mm, rad/s, mm/s, 1], the name and the axis.
    """
    units = _units(length, gravity)
    return {
        "name": launch.name,
        "height_mm": [1e3 * length * end for end in launch.fall],
        "spin_rad_s": [units["spin"] * end for end in launch.spin],
        "speed_mm_s": [1e3 * units["speed"] * end for end in launch.speed],
        "restitution": list(launch.restitution),
        "friction": list(launch.friction),
        "axis": launch.axis,
    }


def share(text: str, where: str) -> float:
    """Return a share above 0 and below 1 as typed, '1%' or '0.01'.

    Parameters
    ----------
    text : str
    where : str
        Option that it was given to, for the fault.

    Returns
    -------
    float [1]

    Raises
    ------
    ArgumentError
        If it is not a share from ``MIN_HALF_WIDTH`` to ``MAX_HALF_WIDTH``.
    """
    value = _read(where, text, "number")
    if not MIN_HALF_WIDTH <= value <= MAX_HALF_WIDTH:
        limits = f"give {MIN_HALF_WIDTH:.2%} to {MAX_HALF_WIDTH:.0%}"
        raise ArgumentError(where, f"{quantity_text(text)} is out of range", limits)
    return value


def _range(key: str, text: str, size: float) -> tuple[float, float]:
    """Return (lowest, highest) without dimensions from 'a' or 'a:b', in a unit of a size."""
    dimension, lowest, highest = CONDITION_KEYS[key]
    ends = [_read(key, end, dimension) / size for end in text.split(":")]
    if len(ends) > 2 or ends[0] > ends[-1]:
        what = f"{quantity_text(text)} is not a range"
        raise ArgumentError(key, what, "give one value, or the smaller and the larger as a:b")
    if not lowest <= ends[0] <= ends[-1] <= highest:
        limits = []  # as a user would type them, rounded down to three digits
        for end in (lowest, highest):
            number = end * size / factor(LIMIT_UNITS[dimension], dimension)
            step = 10.0 ** (np.floor(np.log10(number)) - 2.0) if number > 0.0 else 1.0
            digits = np.floor(number / step + 1e-9) * step
            limits.append(f"{digits:.6g} {LIMIT_UNITS[dimension]}".strip())
        of_part = "" if dimension == "number" else " for this part"
        mend = f"give {' to '.join(limits)}{of_part}"
        raise ArgumentError(key, f"{quantity_text(text)} is out of range", mend)
    return ends[0], ends[-1]


def _read(where: str, text: str, dimension: str) -> float:
    try:
        return quantity(text, dimension)
    except QuantityError as fault:
        raise ArgumentError(where, fault.what, fault.mend) from fault
