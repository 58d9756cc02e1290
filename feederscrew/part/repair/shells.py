"""Closed surfaces in one file: a body, its inner cavities, or bodies too many."""

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.geometry.graphs import components

PROBES = 64  # corners of a shell that are tried
BUDGET, MOST_TURNS = 4_000_000, 400_000_000  # solid angles for one shell and for all: half a second, a minute
LISTED = 3  # bodies named with their volume
SPLIT = (
    "save each body as a file of its own, or unite them in CAD if they are one part;"
    " or pass `allow_open` to take them as one part"
)
INNER = "reverse the inner surface if it is a cavity, else save each body as a file of its own"
CROSSING = "move the cavity inside the material in CAD"


def shells(edges, faces):
    """Which shell each facet belongs to.

    Parameters
    ----------
    edges : MeshEdges
    faces : (F, 3) int

    Returns
    -------
    number : int
        Of shells: facets joined across edges. Where more than two facets meet, shells touch; they are one
        only if they do not close without each other.
    shell : (F,) int
    """
    one, other = edges.mates(edges.count == 2).T
    number, shell = components(one, other, len(faces))
    crowded = edges.count > 2
    if not crowded.any():
        return number, shell
    facets, edge = edges.order // 3, np.repeat(np.arange(len(crowded)), edges.count)
    at = crowded[edge]
    runs = np.where(faces < np.roll(faces, -1, axis=1), 1, -1).ravel()[edges.order[at]]
    pairs, which = np.unique(edge[at] * number + shell[facets[at]], return_inverse=True)
    unclosed = pairs[np.bincount(which, runs) != 0]
    at_edge, of_shell = np.divmod(unclosed, number)
    same = at_edge[1:] == at_edge[:-1]
    count, group = components(of_shell[:-1][same], of_shell[1:][same], number)
    return count, group[shell]


def fault(vertices, faces, shell, volume, unit):
    """What keeps several shells from being one outer surface and cavities in its material.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    shell : (F,) int
    volume : (S,) float [cubed unit of the file]
        Of each shell; the largest is positive.
    unit : str
        Of the file.

    Returns
    -------
    (what, mend) : tuple of str, or None
        None where it is one part.
    """
    by_size = np.argsort(-np.abs(volume), kind="stable")
    bodies = by_size[volume[by_size] > 0.0]
    if len(bodies) > 1:
        turns = _turns_around(vertices, faces, shell, bodies[1])
        what = f"a body of {volume[bodies[1]]:.4g} {unit}3 lies inside another, both facing outwards"
        return (what, INNER) if (turns > 0.5).all() else _several(volume[bodies], unit)
    if len(volume) * len(faces) > MOST_TURNS:
        return f"holds {len(volume)} closed surfaces", SPLIT
    for cavity in by_size[1:]:
        turns = _turns_around(vertices, faces, shell, cavity)
        if (turns < 0.5).all():
            return _several(np.abs(volume[[*bodies, cavity]]), unit)
        if (np.abs(turns - 1.0) > 0.1).any():
            return f"a cavity of {-volume[cavity]:.4g} {unit}3 crosses another surface", CROSSING
    return None


def _several(volume, unit):
    listed = ", ".join(f"{v:.4g}" for v in volume[:LISTED]) + (", ..." if len(volume) > LISTED else "")
    return f"holds {len(volume)} bodies, of {listed} {unit}3", SPLIT


def turns_around(vertices, faces, shell, inner, outer):
    """Return how often one shell goes round corners of another.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    shell : (F,) int
    inner, outer : int

    Returns
    -------
    (N,) float [1]
        1 inside the outer shell, 0 outside; negative where it faces inwards.
    """
    corners = np.unique(faces[shell == inner])
    around = vertices[faces[shell == outer]]
    step = -(-len(corners) // max(1, min(PROBES, BUDGET // len(around))))
    return np.array([winding(point, around) for point in vertices[corners[::step]]])


def _turns_around(vertices, faces, shell, one):
    """(N,) float [1] how often the other shells go round corners of one: 1 in their material, 0 outside."""
    own = shell == one
    corners = np.unique(faces[own])
    step = -(-len(corners) // max(1, min(PROBES, BUDGET // len(faces))))
    others = vertices[faces[~own]]
    return np.array([winding(point, others) for point in vertices[corners[::step]]])


def winding(point, corners):
    """Return how often closed triangles go round a point [1].

    Parameters
    ----------
    point : (3,) float [unit of the file]
    corners : (F, 3, 3) float [unit of the file]

    References
    ----------
    van Oosterom, Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30 (1983).
    """
    a, b, c = np.moveaxis(corners - point, 1, 0)
    la, lb, lc = (vectors.norm(corner) for corner in (a, b, c))
    triple = np.einsum("fi,fi->f", a, vectors.cross(b, c))
    ab, bc, ca = (np.einsum("fi,fi->f", u, v) for u, v in ((a, b), (b, c), (c, a)))
    return np.arctan2(triple, la * lb * lc + ab * lc + bc * la + ca * lb).sum() / (2.0 * np.pi)
