"""The triangles about a sink that make one plane, for many sinks in one pass."""

import numpy as np

from feederscrew.geometry import groups, vectors
from feederscrew.resting.basins.landscape import GENTLE

FLATNESS = 1e-2  # of the radius: how deep a corner may lie under the plane of its face
TIGHTEST_FIRST = np.array([1e-6, 1e-5, 1e-4, 1e-3, FLATNESS])


def planes(hull, sinks, members, of_curves=False):
    """Return the members in the plane about each sink, and with them what lies in the sink's own.

    Parameters
    ----------
    hull : Hull
    sinks : (F,) int
        Triangles.
    members : sequence of F int arrays
        Triangles about each sink, itself among them.
    of_curves : bool
        They are of curved sides.

    Returns
    -------
    list of F int arrays
        Ascending.

    Notes
    -----
    The tightest plane that holds most of what noise allows, and that a looser one would hardly add to:
    in a clean file the face itself without the shallow bevels beside it, in a noisy one all of it. Of a
    curve one strip is wanted, though the halves of the strips beside it may lie as shallow.
    """
    if not len(sinks):
        return []
    fewest = [1 if of_curves and _fan(hull, each) else 2 for each in members]  # triangles of a strip
    every, owners = groups.joined([np.sort(each) for each in members])
    depth = _depth(hull, sinks, every, owners)
    lean = vectors.dot(hull.normals[every], hull.normals[sinks][owners])
    near = (depth < FLATNESS * hull.radius) & (lean > GENTLE)
    every, owners, tight = every[near], owners[near], depth[near] < TIGHTEST_FIRST[0] * hull.radius
    if not tight.all():
        kept = tight | _in_the_tightest(hull, every, owners, tight, np.array(fewest), of_curves)
        every, owners = every[kept], owners[kept]
    return groups.split(every, owners, len(sinks))


def _in_the_tightest(hull, members, owners, tight, fewest, of_curves):
    """(N,) which members lie in the tightest plane that holds enough, about the largest triangle of each."""
    first, areas = groups.starts(owners, len(fewest)), hull.areas[members]
    own = np.where(tight, areas, -1.0) if of_curves else areas
    largest = members[np.lexsort((-own, owners))[first]]
    inside = _depth(hull, largest, members, owners) <= hull.radius * TIGHTEST_FIRST[:, None]
    held = np.add.reduceat(inside * areas, first, axis=1)
    count = np.add.reduceat(inside, first, axis=1, dtype=int)
    shared = held / np.add.reduceat(areas, first) - 0.1 * (count < 2)  # one triangle is a plane by itself
    enough = shared >= 0.5
    if of_curves:
        enough |= count >= fewest
    good = enough[:-1] & (held[1:] <= 1.02 * held[:-1])
    chosen = np.where(good.any(axis=0), good.argmax(axis=0), len(TIGHTEST_FIRST))
    every = np.ones((1, len(members)), dtype=bool)
    return np.concatenate([inside, every])[chosen[owners], np.arange(len(members))]


def _fan(hull, members):
    """Whether most triangles meet at one corner, as the strips of a cone do at its tip."""
    return np.bincount(hull.triangles[members].ravel()).max() > 0.5 * len(members)


def _depth(hull, planes, members, owners):
    """(N,) [m] how far the corners of each member lie off the plane of its owner's triangle, of (F,)."""
    corners = hull.triangles[members].T
    if len(planes) == 1 and corners.size > len(hull.vertices):  # sooner of every corner of the hull once
        above = vectors.product(hull.vertices, hull.normals[planes[0]])[corners]
    else:
        above = vectors.dot(hull.vertices[corners], hull.normals[planes][owners])
    a, b, c = np.abs(above - hull.heights[planes][owners])
    return np.maximum(np.maximum(a, b), c)
