"""Parts in the bowl: how many, how heavy, and what their mass does to the stroke as the bowl empties."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.bowl.direction import RIGHT_ANGLE_RAD, shares
from feederscrew.bowl.record import Bowl, Machine, Sizing
from feederscrew.machine.springs import gain, springs

FILL_LEVEL_COUNT = 21  # of the curve, from full to empty


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
    springs: np.ndarray  # (N,) [1] stroke between bowl and base over that of the empty bowl
    strokes: np.ndarray  # (N,) [1] stroke of the bowl at its track over that of the empty bowl, left alone
    angles: np.ndarray  # (N,) [rad] from the track to the bowl's motion there
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


def emptying(bowl: Bowl, fill: Fill) -> Emptying:
    """Compute what becomes of the stroke as a bowl empties.

    Source: two free bodies on springs; docs/bowl.md, "Why it feeds 220 for half a minute and then 165".

    Parameters
    ----------
    bowl : Bowl
        Empty. Its drive is that of the empty bowl; its ``sizing`` has the share of the fill that is carried,
        and the setting of the controller.
    fill : Fill

    Returns
    -------
    Emptying

    Notes
    -----
    The force of the magnet and the damping ratio stay as they are; the damping that parts add is left out,
    so that a stroke near resonance is less than the one here. The springs move by force times gain over
    stiffness. Of that the bowl rises by the share m2 / (m1 + m2) and turns by I2 / (I1 + I2): parts in it
    make both shares smaller, and each by another amount, so that the angle at the track changes as well.
    """
    machine, rules, drive = bowl.machine, bowl.sizing, bowl.drive
    levels = np.linspace(1.0, 0.0, FILL_LEVEL_COUNT)
    laden = [loaded(machine, fill, rules.carried * u) for u in levels]
    natural = np.array([springs(one).natural_frequency for one in laden])
    gains = gain(drive.frequency, natural, machine.damping)
    relative = gains / gains[-1]
    rises, turns = np.array([shares(one) for one in laden]).T
    upright = drive.vibration_angle + bowl.track.climb
    along = relative * turns / turns[-1] * np.cos(upright)
    up = relative * rises / rises[-1] * np.sin(upright)
    strokes = np.hypot(along, up)
    angles = np.clip(np.arctan2(up, along) - bowl.track.climb, 0.0, RIGHT_ANGLE_RAD)
    angles[-1], strokes[-1] = drive.vibration_angle, 1.0  # without rounding
    reach = np.minimum(1.0, strokes / rules.controller)
    columns = (levels, levels * fill.mass, natural, gains, relative, strokes, angles, reach)
    return Emptying(*(check.frozen(a) for a in columns))
