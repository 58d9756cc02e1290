"""Flats that are meant, on a side that is else of the facets of a tessellated curve."""

import numpy as np

from feederscrew.geometry.graphs import components
from feederscrew.resting.basins.landscape import SMOOTH, angle

ONE_PLANE = np.radians(0.2)  # between triangles of one facet
LARGER = (
    1.5  # times the bend about most facets of a side: a facet between sharper bends was not cut by chance
)


def meant(hull, basins):
    """Return which sinks lie on facets much wider than the others of their smooth side.

    Parameters
    ----------
    hull : Hull
    basins : Landscape

    Returns
    -------
    (B,) bool
        Where even the gentlest bend round the sink's facet is ``LARGER`` than that round most of the side, by
        area: a facet of a tessellated ball or cylinder is not, a flat cut into it is.
    """
    first, second = basins.pairs.T
    bends = angle(hull.normals[first], hull.normals[second])
    facets = components(*basins.pairs[bends < ONE_PLANE].T, len(hull.triangles))[1]
    gentlest = np.full(facets.max() + 1, np.inf)
    border = facets[first] != facets[second]
    for side in (first, second):
        np.minimum.at(gentlest, facets[side[border]], bends[border])
    sides = components(*basins.pairs[bends < SMOOTH].T, len(hull.triangles))[1]
    about = gentlest[facets]
    usual = _medians(about, hull.areas, sides)
    return (about > LARGER * usual[sides])[basins.sinks] & np.isfinite(about[basins.sinks])


def _medians(values, weights, owners):
    """(N,) medians of (T,) values by weight, of each owner."""
    order = np.lexsort((values, owners))
    mass = np.cumsum(weights[order])
    last = np.flatnonzero(np.append(np.diff(owners[order]) != 0, True))
    whole = mass[last]
    begun = np.concatenate([[0.0], whole[:-1]])
    return values[order][np.searchsorted(mass, 0.5 * (begun + whole))]
