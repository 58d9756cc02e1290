"""A bowl whose centre of mass is off its axis: its effective mass, and how it rocks on the springs.

Two rigid bodies that nothing holds; the leaves leave them a screw about the bowl's axis against each other.
Source: momentum of both together is zero; docs/bowl.md, "How it is computed".
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.bowl.record import Bowl, Machine
from feederscrew.errors import FeederError
from feederscrew.geometry.vectors import cross, determinant, dot

BASE_DENSITY = 7850.0  # [kg/m3] of the base, taken as a round plate of it
RIM_SAMPLES = 360  # round the bowl at which its stroke is computed


@dataclass(frozen=True)
class Rocking:
    """The stroke round a bowl, over that of one which is balanced."""

    least: float  # [1]
    greatest: float  # [1]
    angle: float  # [rad] about Z where it is greatest
    effective_mass: float  # [kg]


@dataclass(frozen=True, eq=False)
class _Body:
    """A rigid body about a point of the bowl's axis at the upper ends of the leaves."""

    mass: float  # [kg]
    moment: np.ndarray  # (3,) [kg m]
    inertia: np.ndarray  # (3, 3) [kg m2]

    def with_weight(self, mass: float, place: np.ndarray) -> "_Body":
        """Return the body with a point of mass [kg] at a place (3,) [m]."""
        own = mass * (dot(place, place) * np.eye(3) - np.outer(place, place))
        return _Body(self.mass + mass, self.moment + mass * place, self.inertia + own)

    def momentum(self, speed: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Momentum (3,) [kg m/s] and moment of it (3,) [kg m2/s] of a motion."""
        along = self.mass * speed + cross(spin, self.moment)
        return along, cross(self.moment, speed) + dot(self.inertia, spin)

    def motion(self, along: np.ndarray, around: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Motion that has a momentum: speed (3,) of the point, spin (3,)."""
        centre = self.moment / self.mass
        own = self.inertia - self.mass * (dot(centre, centre) * np.eye(3) - np.outer(centre, centre))
        spin = _solved(own, around - cross(centre, along))
        return along / self.mass - cross(spin, centre), spin


def is_even(machine: Machine) -> bool:
    """Return whether nothing is known of a bowl that would rock it."""
    known = machine.unbalance
    return not any((*known.moment[:2], *known.products))


def effective_mass(machine: Machine) -> float:
    """Return the mass [kg] that moves against the springs, of a bowl whose centre may be off its axis.

    Source: own; two bodies that move in a screw; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [kg]
        Twice the energy of both bodies over the square of the speed between them along the springs.
    """
    rise, turn = _screw(machine)
    along, around = _bowl(machine).momentum(*_bowl_motion(machine, _bowl(machine)))
    return float(dot(rise, along) + dot(turn, around))


def rocking(machine: Machine, radius: float, height: float, weight: Any = None) -> Rocking:
    """Compute how the stroke of a bowl differs round its axis.

    Source: own; two bodies that move in a screw; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine
    radius, height : float [m]
        Where the stroke is taken: over the upper ends of the leaves.
    weight : (float [kg], (3,) float [m]), optional
        Put on the bowl to balance it, over the same ends.

    Returns
    -------
    Rocking
    """
    bowl = _bowl(machine) if weight is None else _bowl(machine).with_weight(weight[0], np.array(weight[1]))
    speed, spin = _bowl_motion(machine, bowl)
    theta = 2.0 * np.pi * np.arange(RIM_SAMPLES) / RIM_SAMPLES
    places = np.column_stack([radius * np.cos(theta), radius * np.sin(theta), np.full(RIM_SAMPLES, height)])
    moved = speed + cross(spin, places)
    strokes = np.sqrt(dot(moved, moved))
    mean = np.sqrt(dot(strokes, strokes) / RIM_SAMPLES)
    rise, turn = _screw(machine)
    along, around = bowl.momentum(speed, spin)
    return Rocking(
        least=float(strokes.min() / mean),
        greatest=float(strokes.max() / mean),
        angle=float(theta[int(np.argmax(strokes))]),
        effective_mass=float(dot(rise, along) + dot(turn, around)),
    )


def both(bowl: Bowl, solid: Any) -> tuple[Rocking, Rocking] | None:
    """Return the stroke round a bowl where its track ends, as it is and with the weight that balances it.

    Parameters
    ----------
    bowl : Bowl
    solid : BowlSolid
        Of that bowl.

    Returns
    -------
    two Rocking, or None
        None where the machine was not computed with the solid.
    """
    plan, under = solid.plan, bowl.machine
    if is_even(under):
        return None
    at = bowl.track.radius, plan.outlet_height - plan.underside
    return rocking(under, *at), rocking(under, *at, solid.weight)


def _screw(machine: Machine) -> tuple[np.ndarray, np.ndarray]:
    """Speed and spin between bowl and base, of the unit of speed along the springs."""
    turn = machine.unbalance.turns * np.cos(machine.spring_angle) / machine.spring_radius
    return np.array([0.0, 0.0, np.sin(machine.spring_angle)]), np.array([0.0, 0.0, turn])


def _bowl(machine: Machine) -> _Body:
    known = machine.unbalance
    yz, xz, xy = known.products
    inertia = np.array(
        [[known.upright[0], -xy, -xz], [-xy, known.upright[1], -yz], [-xz, -yz, machine.bowl_inertia]]
    )
    moment = np.array(known.moment)
    if (moment[:2] ** 2).sum() >= machine.bowl_mass * machine.bowl_inertia:
        what = f"{machine.bowl_inertia:.4g} kg m2 is less than the mass of the bowl has off its axis"
        raise FeederError("machine.bowl_inertia", what, "give that of the bowl as it is, or leave it out")
    return _Body(machine.bowl_mass, moment, inertia)


def _base(machine: Machine) -> _Body:
    """A round plate of steel below the lower ends of the leaves."""
    mass, inertia = machine.base_mass, machine.base_inertia
    thick = mass**2 / (2.0 * np.pi * BASE_DENSITY * inertia)
    low = -machine.leaf_length * np.cos(machine.spring_angle) - 0.5 * thick
    across = 0.5 * inertia + mass * (thick**2 / 12.0 + low**2)
    return _Body(mass, np.array([0.0, 0.0, mass * low]), np.diag([across, across, inertia]))


def _bowl_motion(machine: Machine, bowl: _Body) -> tuple[np.ndarray, np.ndarray]:
    """Motion of the bowl where it and its base together have no momentum: (M1 + M2) V1 = M2 screw."""
    base = _base(machine)
    both = _Body(bowl.mass + base.mass, bowl.moment + base.moment, bowl.inertia + base.inertia)
    return both.motion(*base.momentum(*_screw(machine)))


def _solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The solution (3,) of three equations, by Cramer's rule."""
    columns = matrix.T
    whole = determinant(columns)
    return (
        np.array([determinant([right if k == j else columns[k] for k in range(3)]) for j in range(3)]) / whole
    )
