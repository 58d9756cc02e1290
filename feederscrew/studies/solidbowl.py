"""``feeder bowl --solid``: the bowl of a sheet as one closed body."""

from dataclasses import replace

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.solidbowl import cuts
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.materials import material
from feederscrew.solidbowl.plan import Asked, plan
from feederscrew.solidbowl.ways_down import check_ways_down


def asked(settings, *, solid, material, chord):
    """Return what is asked of the solid, None where none is.

    Parameters
    ----------
    settings : tuple of Setting
    solid : bool
    material : str
        Of ``materials.NAMES``.
    chord : float [m]

    Returns
    -------
    Asked or None
    """
    if not solid:
        return None
    rules = bowls.record(settings).sizing
    given = {s.key.name for s in settings if s.given}
    return Asked(
        chord=chord,
        material=material,
        outlet_height=rules.outlet_height,
        outlet_angle=rules.outlet_angle,
        left=rules.hand == "left",
        bolts=int(rules.bolts),
        bolt=rules.bolt_hole,
        bolt_circle=rules.bolt_circle if "machine.bolt_circle" in given else 0.0,
        bolt_share=rules.bolt_share,
        drains=int(rules.drains),
        drain=rules.drain_hole,
    )


def in_material(bowl, asked):
    """Return the bowl with the thickness and density of what its solid is made of.

    Parameters
    ----------
    bowl : Bowl
    asked : Asked or None
        Without one the bowl stays as it is.

    Returns
    -------
    Bowl
    """
    if asked is None:
        return bowl
    made_of = material(asked.material, bowl.sizing)
    rules = replace(bowl.sizing, sheet=made_of.plate, sheet_density=made_of.density)
    return replace(bowl, sizing=rules)


def solid(bowl, size, part, every, asked):
    """Return the size of a bowl and its solid.

    Parameters
    ----------
    bowl : Bowl
        Its track and devices.
    size : Size
    part : Part
    every : sequence of Orientation
        Of the part on that track.
    asked : Asked or None

    Returns
    -------
    Size
        With rise, turns, mass and inertia of the solid in place of the estimate.
    BowlSolid or None
        None where none is asked for.

    Raises
    ------
    FeederError
        If the track does not fit the bowl, or what falls through a cut does not reach the floor.
    """
    if asked is None:
        return size, None
    made_of = material(asked.material, bowl.sizing)
    tooled = cuts.stretch(bowl.track, bowl.devices, every) if _tooled(bowl.devices) else None
    made = body(plan(size, bowl.track, made_of, tooled, asked, extents=np.ptp(part.vertices, axis=0)))
    check_ways_down(made)
    own = {"depth": made.plan.outlet_height, "turns": made.plan.turns}
    return replace(size, **own, mass=made.mass, inertia=made.inertia), made


def _tooled(devices):
    return any(device.kind != "yield" for device in devices)
