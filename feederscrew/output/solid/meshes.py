"""Meshes as the viewer of a page takes them: not too many facets, in single precision, in base64."""

import base64

import numpy as np

from feederscrew.units import MM

MOST_FACETS = 200_000  # that a browser is shown
FINEST = 2.0**10  # cells across the part of the first grid tried on a larger mesh


def reduced(vertices, faces, most=MOST_FACETS):
    """Return a mesh of at most so many facets: corners of one grid cell become one, facets that vanish go.

    Parameters
    ----------
    vertices : (V, 3) float
    faces : (F, 3) int
    most : int

    Returns
    -------
    vertices : (W, 3) float
    faces : (G, 3) int
    """
    cells, lowest = FINEST, vertices.min(axis=0)
    extent = np.ptp(vertices, axis=0).max()
    kept, corners = faces, vertices
    while len(kept) > most:
        grid = np.floor((vertices - lowest) * (cells / extent)).astype(np.int64)
        _, place = np.unique(grid, axis=0, return_inverse=True)
        place = place.ravel()
        count = np.bincount(place)
        corners = np.column_stack([np.bincount(place, vertices[:, k]) / count for k in range(3)])
        kept = place[faces]
        kept = kept[(kept != np.roll(kept, 1, axis=1)).all(axis=1)]
        cells /= np.sqrt(2.0)
    return corners, kept


def encoded(array, kind):
    """Return an array's bytes, of a numpy ``kind``, as text in base64."""
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def short(value):
    """Return a number with the seven digits that single precision has."""
    return float(f"{value:.7g}")


def viewed(part, back):
    """Return what a scene of the viewer tells of a part and of the viewer's place.

    Parameters
    ----------
    part : Part
        With a mesh.
    back : (3,) float
        Towards the viewer.

    Returns
    -------
    dict
        For JSON: ``positions`` (float32) and ``index`` (uint32), both little-endian in base64, in mm about
        the centre of mass; ``radius``; ``facets`` shown, of ``all``; ``azimuth`` and ``elevation`` [deg].
    """
    points = (part.vertices - part.centre_of_mass) / MM
    vertices, faces = reduced(points, part.faces)
    return {
        "positions": encoded(vertices, "<f4"),
        "index": encoded(faces, "<u4"),
        "radius": short(np.sqrt((points**2).sum(axis=1).max())),
        "facets": len(faces),
        "all": len(part.faces),
        "azimuth": short(np.degrees(np.arctan2(back[1], back[0]))),
        "elevation": short(np.degrees(np.arctan2(back[2], np.hypot(*back[:2])))),
    }


def track(vertices, faces):
    """Return a section of track (V, 3) [m] for a scene of the viewer."""
    return {"positions": encoded(vertices / MM, "<f4"), "index": encoded(faces, "<u4")}
