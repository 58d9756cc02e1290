"""The surface of a body in single precision: closed, and no facet without an area."""

import numpy as np

from feederscrew import check
from feederscrew.units import factor

MM = factor("mm", "length")
FINEST = 2e-6  # [m] corners nearer than this become one


def mesh(body):
    """Return the surface of a Manifold, the same however it was made.

    Parameters
    ----------
    body : Manifold [mm]

    Returns
    -------
    vertices : (V, 3) float [m]
        Numbers that single precision holds in millimetres.
    faces : (F, 3) int
        Counter-clockwise seen from outside.
    """
    found = body.simplify(FINEST / MM).to_mesh64()
    points = np.asarray(found.vert_properties)[:, :3].astype(np.float32).astype(float)
    points, places = np.unique(points, axis=0, return_inverse=True)
    faces = places.ravel()[np.asarray(found.tri_verts).astype(int)]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    faces = _in_order(_with_area(points, faces))
    return check.frozen(points * MM), check.frozen(faces)


def _with_area(points, faces):
    """The facets without those that rounding left no area: their long side is split in the neighbour."""
    faces = [tuple(one) for one in faces.tolist()]
    for _ in range(100):
        a, b, c = points[np.array(faces)].transpose(1, 0, 2)
        flat = np.flatnonzero(~np.cross(b - a, c - a).any(axis=1))
        if not len(flat):
            break
        faces = _split(points, faces, int(flat[0]))
    return np.array(faces)


def _split(points, faces, at):
    """The facets without one whose corners lie on a line."""
    one = faces[at]
    sides = [np.sum((points[one[k]] - points[one[k - 1]]) ** 2) for k in range(3)]
    k = int(np.argmax(sides))
    a, b, c = one[k - 1], one[k], one[k - 2]  # c lies between a and b
    kept = [face for place, face in enumerate(faces) if place != at]
    for place, face in enumerate(kept):
        for turn in range(3):
            if (face[turn], face[turn - 2]) == (b, a):
                d = face[turn - 1]
                return [*kept[:place], (b, c, d), (c, a, d), *kept[place + 1 :]]
    return kept


def _in_order(faces):
    first = np.argmin(faces, axis=1)[:, None]
    turned_round = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return turned_round[np.lexsort(turned_round.T[::-1])]
