"""A drive unit for a bowl of a given size, where the user has none: masses from sheet, springs by rule."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.bowl import unbalance
from feederscrew.bowl.direction import shares
from feederscrew.bowl.record import BALANCED, Bowl, Machine, Sizing, Unbalance
from feederscrew.machine.sizing import Size

RADIUS_STEP_M = 1e-4  # of a springs' circle that is chosen


def machine_for(bowl: Bowl, size: Size, given: Any, *, exact: bool = False) -> Machine:
    """Return the machine under a bowl, what the user gave of it kept.

    Parameters
    ----------
    bowl : Bowl
        Its machine, its rules, and the vibration angle wanted at the track.
    size : Size
    given : set of str
        Fields of the machine that the user gave.
    exact : bool
        The vibration angle is given, and the machine shall make it: the springs move outwards, and then stand
        steeper, as far as ``sizing`` allows. Without it the springs keep their circle and the angle of the
        track follows from them.

    Returns
    -------
    Machine
    """
    rules, radius = bowl.sizing, 0.5 * size.diameter
    mass, inertia = _bowl(radius, size, rules)
    guess = {
        "bowl_mass": mass,
        "bowl_inertia": inertia,
        "base_mass": rules.base_mass * mass,
        "base_inertia": rules.base_mass * inertia,
        "spring_radius": rules.spring_radius * radius,
    }
    made = replace(bowl.machine, **{name: value for name, value in guess.items() if name not in given})
    if not set(unbalance.UNBALANCE_NAMES) & set(given):
        made = replace(made, unbalance=_unbalance(size, made))
    upright = bowl.drive.vibration_angle + size.climb
    if exact:
        return _exact(made, upright, radius, rules, given)
    if "spring_angle" in given:
        return made
    return replace(made, spring_angle=_spring_angle(upright, radius, made, rules))


def machine_on(bowl: Bowl, given: Collection[str], *, exact: bool = False) -> Machine:
    """Return the machine under a bowl of which only the track is known.

    Parameters
    ----------
    bowl : Bowl
        Its depth is that of ``sizing``, over the bowl's diameter.
    given : collection of str
        Names of the keys that the user gave, 'machine.bowl_mass'.
    exact : bool
        As for ``machine_for``.

    Returns
    -------
    Machine
    """
    track, depth = bowl.track, 2.0 * bowl.sizing.depth * bowl.track.radius
    pitch = 2.0 * np.pi * track.radius * np.tan(track.climb)
    size = Size(
        diameter=2.0 * track.radius,
        least={},
        track_width=track.width,
        clearance=0.0,
        bend=0.0,
        climb=track.climb,
        depth=depth,
        turns=depth / pitch if pitch > 0.0 else np.nan,
        pitch=pitch,
    )
    words = {name.partition(".")[2] for name in given if name.startswith("machine.")}
    return machine_for(bowl, size, words, exact=exact)


def _bowl(radius: float, size: Size, rules: Sizing) -> Any:
    """Mass and inertia [kg], [kg m2]: of the solid, or of floor, wall and track of sheet with tooling."""
    if size.mass is not None:
        return size.mass, size.inertia
    weight = rules.sheet * rules.sheet_density  # [kg/m2]
    floor = weight * np.pi * radius**2
    wall = weight * 2.0 * np.pi * radius * size.depth
    inside = max(radius - size.track_width, 0.0)
    track = weight * np.pi * (radius**2 - inside**2) * (size.turns if np.isfinite(size.turns) else 1.0)
    inertia = 0.5 * floor * radius**2 + wall * radius**2 + 0.5 * track * (radius**2 + inside**2)
    extra = 1.0 + rules.tooling_mass
    return float(extra * (floor + wall + track)), float(extra * inertia)


def _unbalance(size: Size, made: Machine) -> Unbalance:
    """How the mass of the solid lies, in the measure of a mass and an inertia that the user gave."""
    if size.mass is None or size.inertia is None:
        return BALANCED
    heavy, own = made.bowl_mass / size.mass, size.unbalance
    x, y, z = own.moment
    inert = made.bowl_inertia / size.inertia
    xx, yy = own.upright
    yz, xz, xy = own.products
    return replace(
        own,
        moment=(heavy * x, heavy * y, heavy * z),
        upright=(inert * xx, inert * yy),
        products=(inert * yz, inert * xz, inert * xy),
    )


def _spring_angle(wanted: float, radius: float, machine: Machine, rules: Sizing) -> float:
    """Angle of the springs, in whole degrees, that moves the bowl at its track in a wanted direction."""
    angle = needed_angle(machine, radius, wanted)
    whole = np.radians(np.round(np.degrees(angle)))
    return float(np.clip(whole, rules.least_spring_angle, rules.greatest_spring_angle))


def needed_angle(machine: Machine, radius: float, wanted: float) -> float:
    """Return the angle [rad] of springs on their circle that moves the bowl in a wanted direction.

    Source: ``bowl.direction.direction``, solved for the springs; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine
        Its spring angle is not used.
    radius : float [m]
        Where the bowl shall move so.
    wanted : float [rad]
        From the horizontal.
    """
    rise, turn = shares(machine)
    return float(np.arctan(np.tan(wanted) * radius / machine.spring_radius * turn / rise))


def _exact(machine: Machine, wanted: float, radius: float, rules: Sizing, given: Any) -> Machine:
    """The machine whose springs move the bowl at its track in a wanted direction, as nearly as they can."""
    usual = machine.spring_radius
    farthest = max(min(rules.greatest_spring_radius * radius, radius - 0.5 * machine.leaf_width), usual)
    if "spring_angle" in given:
        if "spring_radius" in given:
            return machine
        return replace(machine, spring_radius=_circle(machine, wanted, radius, (usual, farthest)))
    if "spring_radius" in given:
        tenth = np.radians(np.round(np.degrees(needed_angle(machine, radius, wanted)), 1))
        angle = float(np.clip(tenth, rules.least_spring_angle, rules.steepest_spring_angle))
        return replace(machine, spring_angle=angle)
    angle = _spring_angle(wanted, radius, machine, rules)
    there = _circle(replace(machine, spring_angle=angle), wanted, radius, (machine.leaf_width, radius))
    if there > farthest:
        outside = replace(machine, spring_radius=farthest)
        whole = np.radians(np.ceil(np.degrees(needed_angle(outside, radius, wanted))))
        angle = float(np.clip(whole, rules.least_spring_angle, rules.steepest_spring_angle))
        there = _circle(replace(machine, spring_angle=angle), wanted, radius, (usual, farthest))
    return replace(machine, spring_angle=angle, spring_radius=there)


def _circle(machine: Machine, wanted: float, radius: float, ends: tuple[float, float]) -> float:
    """Radius of springs of their angle that move the bowl in a wanted direction, within two ends [m]."""
    rise, turn = shares(machine)
    there = radius * np.tan(wanted) / np.tan(machine.spring_angle) * turn / rise
    return float(np.clip(np.round(there / RADIUS_STEP_M) * RADIUS_STEP_M, *ends))
