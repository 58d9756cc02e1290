"""How parts arrive on the plane: presets, each an ensemble from which every drop draws its own conditions."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.dropping.kernel import body
from feederscrew.geometry import vectors

DRAWS = 11  # uniform numbers a drop takes: 3 attitude, 3 spin, 2 drift, fall, restitution, friction


@dataclass(frozen=True)
class Launch:
    """Ranges a drop draws from, uniformly, without dimensions; attitudes and directions are all alike.

    The unit of length is L, the cube root of the hull's volume; of speed sqrt(g L), of rate sqrt(g / L).
    """

    name: str
    fall: tuple[float, float]  # from the lowest corner to the plane
    spin: tuple[float, float]  # rate
    speed: tuple[float, float]  # along the plane
    restitution: tuple[float, float]  # of a corner hit
    friction: tuple[float, float]
    forward: bool = False  # spins the way it would roll, about the axis across its speed; else about any axis

    def but(self, **ranges):
        """The same launch with some ranges replaced; named 'own' once one is."""
        given = {name: given for name, given in ranges.items() if given is not None}
        return replace(self, name="own", **given) if given else self


PRESETS = {
    "place": Launch("place", (0.0, 0.05), (0.0, 0.0), (0.0, 0.0), (0.0, 0.2), (0.3, 0.8)),
    "drop": Launch("drop", (1.0, 6.0), (0.0, 0.0), (0.0, 0.0), (0.1, 0.6), (0.3, 0.8)),
    "tumble": Launch("tumble", (1.0, 6.0), (2.0, 6.0), (3.0, 8.0), (0.2, 0.6), (0.3, 0.6), forward=True),
}
"""place: set down by hand. drop: let fall without spin. tumble: thrown in, or off a bowl's floor: a part
that comes sliding and catches an edge goes on turning forward, at some times sqrt(g / L). Ranges chosen by
this argument and on the measured square cuboids and the T shape."""


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
    down = _in_body(attitude, np.array([[0.0, 0.0, 1.0]]))
    states[:, body.Z] = fall - vectors.product(down, shape.vertices.T).min(axis=1)
    ahead = np.stack([np.cos(2.0 * np.pi * u[:, 7]), np.sin(2.0 * np.pi * u[:, 7])], axis=1)
    states[:, body.VX : body.VX + 2] = drift[:, None] * ahead
    across = np.column_stack([-ahead[:, 1], ahead[:, 0], np.zeros(count)])
    axes = _in_body(attitude, across) if launch.forward else _directions(u[:, 4], u[:, 5])
    states[:, body.W : body.W + 3] = spin[:, None] * axes
    turning = 0.5 * (vectors.product(states[:, body.W : body.W + 3] ** 2, shape.inertia))
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


def _in_body(q, vectors):
    """(N, 3) vectors of the floor's axes in body axes, for (N, 4) quaternions."""
    turned = 2.0 * np.cross(q[:, 1:], vectors)
    return vectors - q[:, :1] * turned + np.cross(q[:, 1:], turned)


def _directions(u, v):
    """(N, 3) unit vectors, uniform over the sphere."""
    z, turn = 2.0 * u - 1.0, 2.0 * np.pi * v
    flat = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)
