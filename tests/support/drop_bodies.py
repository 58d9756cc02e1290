"""Bodies for drop tests, with their faces labelled by direction."""

import csv
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.rounded_hull import shape_of
from feederscrew.part.hull import convex_hull

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2.0


def box(size, turn=None):
    """Shape of a homogeneous box, face 2 k at -x_k and 2 k + 1 at +x_k, and its length."""
    size = np.array(size, float)
    turn = np.eye(3) if turn is None else turn
    hull = convex_hull(CUBE * size @ turn.T, np.zeros(3))
    normals = hull.normals @ turn
    axis = np.argmax(np.abs(normals), axis=1)
    labels = 2 * axis + (normals[np.arange(len(axis)), axis] > 0)
    inertia = np.diag((size**2).sum() - size**2) / 12.0
    return shape_of(hull, labels, 1.0, turn @ inertia @ turn.T)


def cuboids():
    """Measured tosses of square cuboids: x over y, share on the two square faces, tosses."""
    text = (Path(__file__).parents[1] / "data/square_cuboids.csv").read_text()
    rows = csv.DictReader(line for line in text.splitlines() if line[0] != "#")
    return [(float(r["x_over_y"]), float(r["p_square"]), int(r["n"])) for r in rows]


def lying_flat(shape, turn=0.0):
    """A state at rest on the largest face, relative to the floor."""
    across = np.argmin(shape.solid.vertices.max(axis=0))  # principal axes come in the order of their moments
    upright = Rotation.align_vectors([[0.0, 0.0, 1.0]], [np.eye(3)[across]])[0]
    state = np.zeros(body.STATE)
    state[body.Q : body.Q + 4] = (Rotation.from_rotvec([0, 0, turn]) * upright).as_quat()[[3, 0, 1, 2]]
    state[body.Z] = shape.solid.vertices[:, across].max()
    return state
