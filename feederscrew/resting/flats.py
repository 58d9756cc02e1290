"""Flats that are meant, on a side that is else of the facets of a tessellated curve."""

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry.graphs import component_of
from feederscrew.resting.basins.landscape import SMOOTH_ANGLE, angle

ONE_PLANE = np.radians(0.2)  # between triangles of one facet
LARGER = 1.5  # times the bend round most of a side: a facet between sharper bends was not cut by chance
LONE_BEND_FACTOR = 1.2  # times the bend that 95 % of a side do not exceed: such a facet is alone
MAJORITY_SHARE = 0.95  # of a side, by area


def intended_flats(hull, basins) -> NDArray[np.bool_]:
    """Return which sinks lie on facets much wider than the others of their smooth side.

    Parameters
    ----------
    hull : Hull
    basins : Landscape

    Returns
    -------
    (B,) bool
        Where even the gentlest bend round the sink's facet is ``LARGER`` than that round half of the side, by
        area, or ``LONE_BEND_FACTOR`` of that round ``MAJORITY_SHARE`` of it: a facet of a tessellated ball or
        cylinder is not, a flat cut into it is.
    """
    first, second = basins.pairs.T
    bends = angle(hull.normals[first], hull.normals[second])
    facets = component_of(basins.pairs[bends < ONE_PLANE], len(hull.triangles))
    gentlest = np.full(facets.max() + 1, np.inf)
    border = facets[first] != facets[second]
    for side in (first, second):
        np.minimum.at(gentlest, facets[side[border]], bends[border])
    sides = component_of(basins.pairs[bends < SMOOTH_ANGLE], len(hull.triangles))
    about = gentlest[facets]
    half, most = (_quantiles(about, hull.areas, sides, share) for share in (0.5, MAJORITY_SHARE))
    limit = np.minimum(LARGER * half, LONE_BEND_FACTOR * most)
    return (about > limit[sides])[basins.sinks] & np.isfinite(about[basins.sinks])


def _quantiles(values, weights, owners, share) -> NDArray[np.float64]:
    """(N,) quantiles of (T,) values by weight, of each owner."""
    order = np.lexsort((values, owners))
    mass = np.cumsum(weights[order])
    last = np.flatnonzero(np.append(np.diff(owners[order]) != 0, True))
    whole = mass[last]
    begun = np.concatenate([[0.0], whole[:-1]])
    return values[order][np.searchsorted(mass, begun + share * (whole - begun))]
