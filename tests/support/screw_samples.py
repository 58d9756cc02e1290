"""What the screw tests draw from, and how they compare."""

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from feederscrew.motion.screws import Point, Screw

RELATIVE = 1e-12
few = settings(max_examples=60, deadline=None)

grid = st.integers(-12, 12).map(lambda k: k / 4.0)  # noughts, equal and parallel vectors come up often
vectors = st.tuples(grid, grid, grid).map(np.array)
directions = vectors.filter(lambda v: np.abs(v).max() > 0.0)
sizes = st.integers(-9, 9).map(lambda k: 10.0**k)
points = st.builds(Point, st.just("P"), st.builds(lambda v: v / 3.0, vectors))
displacements = st.tuples(vectors.map(lambda v: Rotation.from_rotvec(v / 2.7)), vectors)


def screws(kind=Screw):
    """Any screw of a kind, the zero screw and pure couples among them, from 1e-9 to 1e9."""
    return st.builds(lambda k, s, s0, p: k * kind(s, s0 / 3.0, p), sizes, vectors, vectors, points)


def lines(kind=Screw):
    """A screw that has an axis."""
    return st.builds(lambda k, s, s0, p: k * kind(s, s0 / 3.0, p), sizes, directions, vectors, points)


def moved(screw, displacement):
    """The screw turned and shifted, its reference point with it."""
    turn, shift = displacement[0].as_matrix().T, displacement[1]
    point = Point("P'", screw.reference.coordinates @ turn + shift)
    return type(screw)(screw.resultant @ turn, screw.moment @ turn, point)


def random_screws(rng, kind, *shape):
    """A batch of ordinary screws at one point."""
    point = Point("P", rng.normal(size=3))
    return kind(rng.normal(size=(*shape, 3)), rng.normal(size=(*shape, 3)), point)


def near(got, wanted, scale=None):
    """Equal to 1e-12 of ``scale``, or of the largest number wanted."""
    got, wanted = np.asarray(got), np.asarray(wanted)
    scale = np.abs(wanted).max(initial=0.0) if scale is None else scale
    np.testing.assert_allclose(got, wanted, rtol=0.0, atol=RELATIVE * np.max(scale))


def same(got, wanted, reach=10.0):
    """The same screw; ``reach`` bounds the levers its moment went through."""
    got = got.at(wanted.reference)
    force = np.abs(wanted.resultant).max(initial=0.0)
    near(got.resultant, wanted.resultant)
    near(got.moment, wanted.moment, max(np.abs(wanted.moment).max(initial=0.0), reach * force))
