"""Facets on which a body stands but that are no aspect here: what they make of the published rules."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry import vectors
from feederscrew.geometry.graphs import component_of
from feederscrew.part.hull import Hull
from feederscrew.resting.basins.landscape import SMOOTH, Landscape, angle
from feederscrew.resting.faces import Face
from feederscrew.resting.flats import ONE_PLANE
from feederscrew.resting.rules import published
from feederscrew.units import MM

MIN_INSIDE_SHARE = (
    1e-2  # [1] of the part's radius: a foot nearer to a facet's border is one of the file's noise
)
MAX_SHALLOW = 500  # of such facets, the furthest from a border first: with more it is a curve
MIN_CHANGE = 5e-4  # [1] of a probability: less does not show in a table
ALIKE_DIGITS = 4  # of height and area, in which equal facets agree
RULES = ("pmi", "csa", "stability")


@dataclass(frozen=True, eq=False)
class ShallowFacets:
    """K facets with the foot of the centre of mass within them that were merged with a deeper neighbour."""

    normals: NDArray[np.float64]  # (K, 3) outward
    heights: NDArray[np.float64]  # (K,) [m] of the centre of mass
    areas: NDArray[np.float64]  # (K,) [m2]
    solid_angles: NDArray[np.float64]  # (K,) [sr]
    inside: NDArray[np.float64]  # (K,) [m] of the foot from the nearest border


def shallow_facets(hull: Hull, basins: Landscape, faces: list[Face]) -> ShallowFacets:
    """Find the facets on which a body stands and that are no stable face.

    Parameters
    ----------
    hull : Hull
    basins : Landscape
    faces : list of Face
        The stable faces of that hull.

    Returns
    -------
    ShallowFacets
        None of a curved side that rolls: its facets are those of the tessellation.
    """
    bends = angle(*(hull.normals[basins.pairs[:, k]] for k in (0, 1)))
    side = component_of(basins.pairs[bends < SMOOTH], len(hull.triangles))
    free = np.ones(len(hull.triangles), dtype=bool)
    for face in faces:
        free[face.triangles] = False
        if face.kind == "rolling":
            free[np.isin(side, side[face.triangles])] = False
            free[np.isin(basins.basins, basins.basins[face.triangles])] = False
    plane = component_of(basins.pairs[bends < ONE_PLANE], len(free))
    taken = np.unique(plane[~free])
    candidates = np.unique(plane[basins.lows])
    candidates = candidates[~np.isin(candidates, taken)]
    order = np.argsort(plane, kind="stable")
    bounds = np.searchsorted(plane[order], [candidates, candidates + 1])
    facets = [order[start:end] for start, end in bounds.T]
    rows = [_described(hull, facet) for facet in facets]
    kept = [row for row in rows if row[4] > MIN_INSIDE_SHARE * hull.radius]
    kept = sorted(kept, key=lambda row: -row[4])[:MAX_SHALLOW]
    normals, *columns = zip(*kept) if kept else (np.empty((0, 3)), *[np.empty(0)] * 4)
    return ShallowFacets(np.array(normals), *(np.array(column) for column in columns))


def published_changes(
    shallow: ShallowFacets,
    weights: dict[str, NDArray[np.float64]],
    stable: NDArray[np.bool_],
    inertia: NDArray[np.float64],
    as_published: bool,
) -> dict[str, NDArray[np.float64]]:
    """Return the probabilities by the published rules with every facet on which the body stands.

    Parameters
    ----------
    shallow : ShallowFacets
    weights : dict of str to (A,) float [any one unit]
        By rule, of the aspects.
    stable : (A,) bool
    inertia : (3, 3) float [kg m2]
        About the centre of mass.
    as_published : bool
        Equal facets count once in the PMI rule.

    Returns
    -------
    dict of str to (A,) float [1]
        Of the aspects; what is missing to 1 is that of the facets.
    """
    ones = np.ones(len(shallow.heights), dtype=int)
    moments = vectors.dot(vectors.product(shallow.normals, inertia), shallow.normals)
    once = ones
    if as_published and len(ones):
        columns = np.column_stack(
            [shallow.heights / shallow.heights.max(), shallow.areas / shallow.areas.max()]
        )
        _, first = np.unique(columns.round(ALIKE_DIGITS), axis=0, return_index=True)
        once = np.zeros_like(ones)
        once[first] = 1
    more = {
        "pmi": published.pmi(once, moments, shallow.heights),
        "csa": published.csa(ones, shallow.solid_angles, shallow.heights),
        "stability": published.stability(ones, shallow.areas, shallow.heights),
    }
    changed = {}
    for rule in RULES:
        own = np.where(stable, weights[rule], 0.0)
        changed[rule] = own / (own.sum() + more[rule].sum())
    return changed


def remark(
    shallow: ShallowFacets,
    names: tuple[str, ...],
    chances: dict[str, NDArray[np.float64]],
    complete: dict[str, NDArray[np.float64]],
) -> tuple[str, ...]:
    """Say what the published rules give with every facet, where it differs.

    Parameters
    ----------
    shallow : ShallowFacets
    names : tuple of str
        Of the A aspects.
    chances, complete : dict of str to (A,) float [1]
        By rule, of the aspects alone and with every facet.

    Returns
    -------
    tuple of str
        One sentence, or none.
    """
    changes = {rule: chances[rule] - complete[rule] for rule in RULES}
    if not len(shallow.inside) or max(np.abs(change).max() for change in changes.values()) < MIN_CHANGE:
        return ()
    pieces = []
    for rule in RULES:
        row = int(np.argmax(np.abs(changes[rule])))
        pieces.append(f"p_{rule} of {names[row]} {complete[rule][row]:.3f} for {chances[rule][row]:.3f}")
    count = len(shallow.inside)
    facets = "1 facet is no aspect" if count == 1 else f"{count} facets are no aspects"
    return (
        f"{facets} here, although the part stands on {'it' if count == 1 else 'them'} (foot of the centre of "
        f"mass up to {shallow.inside.max() / MM:.2g} mm inside), because next to nothing tips it to a "
        f"neighbour; the rules as published count {'it' if count == 1 else 'them'}: {', '.join(pieces)}",
    )


def _described(hull, facet):
    """Normal, height, area, solid angle of the triangles of one plane; how far the foot is inside it."""
    areas, corners = hull.areas[facet], hull.triangles[facet]
    normal = vectors.unit(np.einsum("t,tx->x", areas, hull.normals[facet]))
    height = float(np.einsum("t,t->", areas, hull.heights[facet]) / areas.sum())
    starts, ends = corners.ravel(), corners[:, [1, 2, 0]].ravel()
    border = ~np.isin(starts * len(hull.vertices) + ends, ends * len(hull.vertices) + starts)
    p, q = hull.vertices[starts[border]], hull.vertices[ends[border]]
    inwards = vectors.unit(vectors.cross(normal, q - p))
    inside = float(np.einsum("ex,ex->e", height * normal - p, inwards).min())
    return normal, height, float(areas.sum()), float(hull.solid_angles[facet].sum()), inside
