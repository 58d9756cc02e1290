"""How parts arrive on the plane: presets, each an ensemble from which every drop draws its own conditions."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.resting.drop import body

DRAWS = 11  # uniform numbers a drop takes: 3 attitude, 3 spin, 2 drift, fall, restitution, friction


@dataclass(frozen=True)
class Launch:
    """Ranges a drop draws from, uniformly, without dimensions; attitudes and directions are all alike.

    The unit of length is L, the cube root of the hull's volume; of speed sqrt(g L), of rate sqrt(g / L).
    """

    name: str
    fall: tuple[float, float]  # from the lowest corner to the plane
    spin: tuple[float, float]  # rate about any axis
    speed: tuple[float, float]  # along the plane
    restitution: tuple[float, float]  # of a corner hit
    friction: tuple[float, float]

    def but(self, **ranges):
        """The same launch with some ranges replaced; named 'own' once one is."""
        given = {name: given for name, given in ranges.items() if given is not None}
        return replace(self, name="own", **given) if given else self


PRESETS = {
    "place": Launch("place", (0.0, 0.05), (0.0, 0.0), (0.0, 0.0), (0.0, 0.2), (0.3, 0.8)),
    "drop": Launch("drop", (1.0, 6.0), (0.0, 0.0), (0.0, 0.0), (0.1, 0.6), (0.3, 0.8)),
    "tumble": Launch("tumble", (1.0, 6.0), (1.0, 4.0), (2.0, 5.0), (0.1, 0.6), (0.4, 0.9)),
}
"""place: set down by hand. drop: let fall without spin. tumble: thrown in, or off a bowl's floor: a part
that slides at sqrt(g L) and catches an edge leaves it turning at about sqrt(g / L), and a few such trips
against a hard floor give some times that, with drift to match. Ranges chosen by this argument and on the
measured square cuboids and the T shape."""


@dataclass(frozen=True, eq=False)
class Starts:
    """Starting conditions of N drops."""

    states: np.ndarray  # (N, 13)
    restitutions: np.ndarray  # (N,)
    frictions: np.ndarray  # (N,)
    energies: np.ndarray  # (N,) fall and kinetic energy, in units of m g L: how violent the launch is


def sample(launch, shape, count, rng):
    """Draw the starting conditions of some drops.

    Parameters
    ----------
    launch : Launch
    shape : Shape
    count : int
    rng : numpy.random.Generator
        Each drop takes DRAWS numbers, so that drops come out the same however they are batched.

    Returns
    -------
    Starts
    """
    u = rng.random((count, DRAWS))
    states = np.zeros((count, body.STATE))
    attitude, fall = _attitudes(u[:, :3]), _between(launch.fall, u[:, 8])
    spin, drift = _between(launch.spin, u[:, 3]), _between(launch.speed, u[:, 6])
    states[:, body.Q : body.Q + 4] = attitude
    states[:, body.Z] = fall - (_down(attitude) @ shape.vertices.T).min(axis=1)
    states[:, body.W : body.W + 3] = spin[:, None] * _directions(u[:, 4], u[:, 5])
    states[:, body.VX] = drift * np.cos(2.0 * np.pi * u[:, 7])
    states[:, body.VY] = drift * np.sin(2.0 * np.pi * u[:, 7])
    turning = 0.5 * (states[:, body.W : body.W + 3] ** 2 @ shape.inertia)
    return Starts(
        states=check.frozen(states),
        restitutions=check.frozen(_between(launch.restitution, u[:, 9])),
        frictions=check.frozen(_between(launch.friction, u[:, 10])),
        energies=check.frozen(fall + 0.5 * drift**2 + turning),
    )


def _between(ends, share):
    return ends[0] + (ends[1] - ends[0]) * share


def _attitudes(u):
    """(N, 4) unit quaternions, uniform over all attitudes.

    K. Shoemake, "Uniform random rotations", Graphics Gems III, 124-132, 1992.
    """
    low, high = np.sqrt(1.0 - u[:, 0]), np.sqrt(u[:, 0])
    a, b = 2.0 * np.pi * u[:, 1], 2.0 * np.pi * u[:, 2]
    return np.stack([low * np.sin(a), low * np.cos(a), high * np.sin(b), high * np.cos(b)], axis=1)


def _down(q):
    """(N, 3) floor's z axis in body axes: the last row of each rotation matrix."""
    a, b, c, d = q.T
    return np.stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)], axis=1)


def _directions(u, v):
    """(N, 3) unit vectors, uniform over the sphere."""
    z, turn = 2.0 * u - 1.0, 2.0 * np.pi * v
    flat = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)
