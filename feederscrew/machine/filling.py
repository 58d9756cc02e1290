"""Parts in the bowl: how many, how heavy, and what their mass does to the stroke as the bowl empties."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Machine, Sizing
from feederscrew.machine.springs import gain, springs

LEVELS = 21  # of the curve, from full to empty


@dataclass(frozen=True)
class Fill:
    """A full bowl."""

    volume: float  # [m3] that the parts take up, gaps included
    mass: float  # [kg] of the parts
    inertia: float  # [kg m2] of the parts about the bowl's axis, spread evenly over its floor


@dataclass(frozen=True, eq=False)
class Emptying:
    """A bowl from full to empty; N levels."""

    levels: np.ndarray  # (N,) [1] of the full bowl, from 1 to 0
    masses: np.ndarray  # (N,) [kg] in the bowl
    natural_frequencies: np.ndarray  # (N,) [Hz]
    gains: np.ndarray  # (N,) [1]
    strokes: np.ndarray  # (N,) [1] over that of the empty bowl, the controller left alone
    controlled: np.ndarray  # (N,) [1] the same under amplitude control, as far as the controller reaches


def full(radius: float, depth: float, bulk: float, rules: Sizing) -> Fill:
    """Compute the fill of a full bowl.

    Source: the keys of the section ``sizing``, each with its own; docs/bowl.md.

    Parameters
    ----------
    radius, depth : float [m]
        Of the bowl.
    bulk : float [kg/m3]
        Mass of a part over the volume of its hull: neighbours keep out of its hollows.
    rules : Sizing

    Returns
    -------
    Fill
    """
    volume = np.pi * radius**2 * depth * rules.fill_height
    mass = volume * rules.packing * bulk
    return Fill(volume, mass, 0.5 * mass * radius**2)


def loaded(machine: Machine, fill: Fill, share: float) -> Machine:
    """Return the machine with a share [1] of a fill vibrating with its bowl."""
    around, own = share * fill.inertia, machine.unbalance
    upright = own.upright[0] + 0.5 * around, own.upright[1] + 0.5 * around  # spread flat over the floor
    return replace(
        machine,
        bowl_mass=machine.bowl_mass + share * fill.mass,
        bowl_inertia=machine.bowl_inertia + around,
        unbalance=replace(own, upright=upright),
    )


def emptying(machine: Machine, frequency: float, fill: Fill, rules: Sizing) -> Emptying:
    """Compute what becomes of the stroke as a bowl empties.

    Source: docs/bowl.md, "Why it feeds 220 for half a minute and then 165".

    Parameters
    ----------
    machine : Machine
        Empty.
    frequency : float [Hz]
        Of the drive.
    fill : Fill
    rules : Sizing
        Its share of the fill that is carried, and its setting of the controller.

    Returns
    -------
    Emptying

    Notes
    -----
    The force of the magnet and the damping ratio stay as they are; the damping that parts add is left out,
    so that a stroke near resonance is less than the one here.
    """
    levels = np.linspace(1.0, 0.0, LEVELS)
    natural = np.array([springs(loaded(machine, fill, rules.carried * u)).natural_frequency for u in levels])
    gains = gain(frequency, natural, machine.damping)
    strokes = gains / gains[-1]
    reach = np.minimum(1.0, strokes / rules.controller)
    return Emptying(*(check.frozen(a) for a in (levels, levels * fill.mass, natural, gains, strokes, reach)))
