"""Round bodies as CAD systems export them: turned, shifted, subdivided, in single precision."""

from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

KINDS = ("cylinder", "washer", "capsule", "frustum", "cone", "ball", "stepped", "dumbbell")
MOST = 30_000  # triangles before a further split


def revolved(profile, sections):
    """(F, 3, 3) triangles of a closed (K, 2) profile of places along an axis and radii, turned about it."""
    x, r = np.array(profile, float).T
    turn = 2.0 * np.pi * np.arange(sections + 1) / sections
    turn[-1] = 0.0
    along = np.broadcast_to(x[:, None], (len(x), sections + 1))
    rings = np.stack([along, np.outer(r, np.cos(turn)), np.outer(r, np.sin(turn))], axis=-1)
    a, b, c, d = rings[:-1, :-1], rings[:-1, 1:], rings[1:, 1:], rings[1:, :-1]
    triangles = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)])
    pointed = np.stack([r[:-1] == 0.0, r[1:] == 0.0])  # the triangle that shrinks to a line on the axis
    return triangles[np.repeat(~pointed[:, :, None], sections, axis=2)]


def split(triangles):
    """Every triangle in four, by the middles of its edges."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
    parts = ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def profile(kind, rng):
    """(K, 2) [mm] profile of a random body of some kind."""
    r, h = rng.uniform(2.0, 8.0), rng.uniform(1.0, 30.0)
    if kind == "cylinder":
        return [(0, 0), (0, r), (h, r), (h, 0)]
    if kind == "washer":
        return [(0, r / 3), (0, r), (h, r), (h, r / 3), (0, r / 3)]
    if kind == "frustum":
        return [(0, 0), (0, r), (h, r * rng.uniform(0.3, 0.99)), (h, 0)]
    if kind == "cone":
        return [(0, 0), (0, r), (h, 0)]
    if kind == "dumbbell":
        other = r * rng.uniform(0.4, 1.0)
        return [
            (0, 0), (0, r), (2, r), (2, r / 3), (2 + h, r / 3), (2 + h, other), (4 + h, other), (4 + h, 0),
        ]  # fmt: skip
    if kind == "stepped":
        places, radii = np.cumsum([0.0, *rng.uniform(1.0, 8.0, rng.integers(2, 6))]), []
        for start, end in pairwise(places):
            radius = rng.uniform(1.0, 8.0)
            radii += [(start, radius), (end, radius)]
        return [(0.0, 0.0), *radii, (places[-1], 0.0)]
    quarter = np.linspace(0.0, np.pi / 2, rng.integers(3, 9))[1:-1]
    start = [(-r * np.cos(u), r * np.sin(u)) for u in quarter]
    length = 0.0 if kind == "ball" else h
    end = [(length - x, y) for x, y in reversed(start)]
    waist = [(0.0, r)] if kind == "ball" else [(0.0, r), (h, r)]
    return [(-r, 0.0), *start, *waist, *end, (length + r, 0.0)]


def body(seed):
    """(F, 3, 3) [mm] triangles of a random round body, every number one of single precision."""
    rng = np.random.default_rng(seed)
    kind = KINDS[rng.integers(len(KINDS))]
    triangles = revolved(profile(kind, rng), rng.integers(6, 100))
    if rng.random() < 0.7:
        triangles = triangles @ Rotation.random(random_state=rng).as_matrix().T
    triangles = triangles + rng.normal(size=3) * rng.choice([0.0, 30.0])
    for _ in range(rng.integers(0, 3)):
        triangles = split(triangles) if len(triangles) < MOST else triangles
    return triangles.astype(np.float32).astype(float)


def frustum(seed=None):
    """(F, 3, 3) [mm] frustum of 48 sides, radii 10 and 7, height 14, turned and every triangle in four."""
    triangles = split(revolved([(0, 0), (0, 10), (14, 7), (14, 0)], 48))
    if seed is not None:
        triangles = triangles @ Rotation.random(random_state=seed).as_matrix().T
    return triangles.astype(np.float32).astype(float)
