"""The best phase of an elliptical drive: what it gains, and how little it then depends on friction."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.conveying.answer import cells, scaled
from feederscrew.errors import ConfigError

STEP = np.radians(2.0)  # between the phases tried
FINE = 20  # phases to each side of the best one, within a step
NEARLY = 0.9  # of the best velocity
FRICTIONS = (0.5, 0.8, 1.0, 1.2, 1.5)  # of the bowl's coefficients


@dataclass(frozen=True, eq=False)
class BestPhase:
    """Velocities of one bowl over the phase of its drive."""

    phases: np.ndarray  # (P,) [rad] tried, from -180 deg
    cells: dict[str, np.ndarray]  # (P,) what the part does there, as ``answer.cells`` names it
    phase: float  # [rad] by which the motion along the normal leads, where the part is fastest up the track
    velocity: float  # [m/s] there
    straight: float  # [m/s] of a straight drive, phase 0
    lowest: float  # [rad] of the phases round the best that give nearly its velocity
    highest: float  # [rad] which may lie beyond half a turn
    frictions: np.ndarray  # (K,) [1] friction tried, over the bowl's
    best_over_friction: np.ndarray  # (K,) [m/s] at the best phase
    straight_over_friction: np.ndarray  # (K,) [m/s]


def best_phase(bowl):
    """Find the phase of the drive at which a part travels fastest up the track.

    Parameters
    ----------
    bowl : Bowl
        Single values; its own phase does not matter.

    Returns
    -------
    BestPhase

    Raises
    ------
    ConfigError
        If nothing moves, the drive does not point along the track, or no phase has a steady velocity.
    """
    phases = -np.pi + STEP * np.arange(round(2.0 * np.pi / STEP))
    around = cells(with_phase(bowl, phases))
    velocities = around["velocity"]
    if np.isnan(velocities).all():
        what = "has no steady velocity at any value: the part slides down the track without stopping"
        raise ConfigError("drive.phase", what, "lower track.climb, or raise the friction")
    near = phases[np.nanargmax(velocities)] + STEP * np.linspace(-1.0, 1.0, 2 * FINE + 1)
    found = cells(with_phase(bowl, near))["velocity"]
    best = int(np.nanargmax(found))
    phase, velocity = float(near[best]), float(found[best])
    low, high = _range(phases, velocities, velocity)
    frictions = np.array(FRICTIONS)
    return BestPhase(
        phases=check.frozen(phases),
        cells=around,
        phase=phase,
        velocity=velocity,
        straight=_velocity(bowl, 0.0),
        lowest=low,
        highest=high,
        frictions=check.frozen(frictions),
        best_over_friction=check.frozen(_over_friction(bowl, phase, frictions)),
        straight_over_friction=check.frozen(_over_friction(bowl, 0.0, frictions)),
    )


def with_phase(bowl, phase):
    """Return the bowl with another phase of its drive [rad], one or many."""
    return replace(bowl, drive=replace(bowl.drive, phase=phase))


def _range(phases, velocities, best):
    """First and last phase of those on both sides of the best that give nearly its velocity."""
    count, peak = len(phases), int(np.nanargmax(velocities))
    good = velocities >= NEARLY * best if best > 0.0 else velocities == velocities[peak]
    back = next((k for k in range(count) if not good[(peak - k - 1) % count]), count - 1)
    on = next((k for k in range(count) if not good[(peak + k + 1) % count]), count - 1)
    return float(phases[peak] - STEP * back), float(phases[peak] + STEP * on)


def _velocity(bowl, phase):
    return float(cells(with_phase(bowl, np.array([phase])))["velocity"][0])


def _over_friction(bowl, phase, shares):
    return np.array([_velocity(scaled(bowl, friction=share), phase) for share in shares])
