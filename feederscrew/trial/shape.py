"""A part's true surface without dimensions, as the trial's kernel needs it."""

from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from feederscrew import check
from feederscrew.dropping.rounded_hull import principal_axes
from feederscrew.errors import FeederError
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import frozen_rows
from feederscrew.part.hull import convex_hull
from feederscrew.part.record import refuse_many_facets
from feederscrew.trial.kernel import workspace
from feederscrew.trial.kernel.plate_views import BLOCK

FLAT_ANGLE = 2e-3  # [rad] facets that meet at a smaller angle are one face
EDGE_EXTENSION = 3e-3  # of the unit of length: an edge goes on so far where a hollow edge meets its end


class TrueSolid(NamedTuple):
    """A rigid body about its centre of mass, along its principal axes; V corners, E edges, T triangles."""

    vertices: np.ndarray  # (V, 3) every corner
    corners: np.ndarray  # (C, 3) the first of them, in which convex edges end: no other can touch
    edges: np.ndarray  # (E, 2) int, convex edges, both ends
    sides: np.ndarray  # (E, 6) in both faces of an edge, unit vectors away from it
    onwards: np.ndarray  # (E, 2) [1] how far an edge goes on within the body before its start, behind its end
    firsts: np.ndarray  # (C + 1,) int, where the neighbours of each corner begin in ``neighbours``
    neighbours: np.ndarray  # (N,) int, corners joined to a corner by an edge of the surface
    triangles: np.ndarray  # (T, 3) int, counter-clockwise from outside
    normals: np.ndarray  # (T, 3)
    outer: np.ndarray  # (C,) bool, corners of the hull: of a plane no other can touch
    grouped: np.ndarray  # (C,) int, corners in an order in which each so many, BLOCK, lie together
    corner_blocks: np.ndarray  # (ceil(C / BLOCK), 6) least and greatest place of so many corners
    edge_blocks: np.ndarray  # (ceil(E / BLOCK), 6) the same of edges
    face_blocks: np.ndarray  # (ceil(T / BLOCK), 6) and of triangles
    circles: np.recarray  # (K,) CIRCLE of its hull that touch as circles
    on_circle: np.ndarray  # (C,) bool, corners on them
    singles: np.ndarray  # (S,) int, corners of the hull that are on no circle, grouped
    single_blocks: np.ndarray  # (ceil(S / BLOCK), 6) least and greatest place of so many
    inertia: np.ndarray  # (3,) principal moments at mass 1
    radius: float  # largest distance of a corner


def solid_of(part) -> tuple[Any, ...]:
    """Return a part's surface without dimensions.

    Parameters
    ----------
    part : Part
        From a mesh.

    Returns
    -------
    solid : TrueSolid
    length : float [m]
        Cube root of the hull's volume, the unit of length.
    principal : (3, 3) float [1]
        Its principal axes as columns, in the file's axes.

    Raises
    ------
    FeederError
        If the part has no surface, or one of very many facets.
    """
    if part.vertices is None:
        raise FeederError(part.source, "has no surface, as a part card", "give the part as a mesh")
    refuse_many_facets(part)
    hull = convex_hull(part.vertices, part.centre_of_mass, part.source)
    length = float(np.cbrt(hull.volume))
    moments, principal = principal_axes(part.inertia)
    corners = vectors.product(part.vertices - part.centre_of_mass, principal) / length
    normals = _normals(corners, part.faces)
    ends, sides, hollow = convex_edges(corners, part.faces, normals)
    order = together(corners[ends].mean(axis=1))
    ends, sides = ends[order], sides[order]
    touches = np.zeros(len(corners), bool)
    touches[ends] = True
    order = np.argsort(~touches, kind="stable")
    place = np.argsort(order, kind="stable")
    corners = check.frozen(corners[order])
    order = together(corners[place[part.faces]].mean(axis=1))
    triangles, normals = place[part.faces][order], normals[order]
    firsts, neighbours = join_neighbours(triangles, int(touches.sum()))
    return (
        TrueSolid(
            vertices=corners,
            corners=corners[: touches.sum()],
            edges=check.frozen(place[ends]),
            sides=check.frozen(sides),
            onwards=check.frozen(onwards(corners, place, ends, hollow)),
            firsts=check.frozen(firsts),
            neighbours=check.frozen(neighbours),
            triangles=check.frozen(triangles),
            normals=check.frozen(normals),
            **_found_by(corners[: touches.sum()]),
            edge_blocks=check.frozen(boxes(corners[place[ends]])),
            face_blocks=check.frozen(boxes(corners[triangles])),
            inertia=check.frozen(moments / (part.mass * length**2)),
            radius=float(vectors.length(corners).max()),
        ),
        length,
        principal,
    )


def onwards(corners, place, ends, hollow):
    """Return how far (E, 2) [1] edges go on within the body: a little where a hollow edge meets their end.

    Parameters
    ----------
    corners : (V, 3) float [L]
    place : (V,) int
        Where each corner of the file is among them.
    ends : (E, 2) int
        As in the file.
    hollow : (H,) int
        The same.
    """
    length = vectors.length(corners[place[ends[:, 1]]] - corners[place[ends[:, 0]]])
    return np.where(np.isin(ends, hollow), EDGE_EXTENSION / length[:, None], 0.0)


def _found_by(corners) -> dict[Any, Any]:
    """How corners (C, 3) [L] are found near something; none is on a circle yet."""
    none, grouped = np.zeros(len(corners), bool), together(corners)
    return {
        "outer": check.frozen(on_hull(corners)), "grouped": check.frozen(grouped),
        "corner_blocks": check.frozen(boxes(corners[grouped][:, None])),
        "circles": frozen_rows([], workspace.CIRCLE), "on_circle": check.frozen(none),
        **singles_of(corners, none),
    }  # fmt: skip


def singles_of(corners, on_circle) -> dict[Any, Any]:
    """Return ``singles``, ``single_blocks`` of corners (C, 3) [L] of which some are on circles, (C,) bool."""
    own = np.flatnonzero(on_hull(corners) & ~on_circle)
    own = own[together(corners[own])] if len(own) else own
    return {"singles": check.frozen(own), "single_blocks": check.frozen(boxes(corners[own][:, None]))}


def on_hull(corners):
    """Return which corners (C, 3) are corners of their hull, (C,) bool."""
    outer = np.zeros(len(corners), bool)
    outer[ConvexHull(corners).vertices] = True
    return outer


def together(points) -> np.ndarray:
    """Return an order (N,) of points (N, 3) [L] in which those of each block lie together.

    They are halved across where they lie furthest apart, by whole blocks, over and over.
    """
    groups, waiting = [], [np.arange(len(points))]
    while waiting:
        own = waiting.pop()
        if len(own) <= BLOCK:
            groups.append(own)
            continue
        axis = int(np.argmax(np.ptp(points[own], axis=0)))
        own = own[np.argsort(points[own, axis], kind="stable")]
        half = BLOCK * ((len(own) // BLOCK + 1) // 2)
        waiting += [own[half:], own[:half]]
    return np.concatenate(groups)


def boxes(features):
    """Return the box (B, 6) [L], least places and greatest, around each block of features (N, K, 3) [L]."""
    blocks = [features[k : k + BLOCK] for k in range(0, len(features), BLOCK)]
    return np.array([[*block.min(axis=(0, 1)), *block.max(axis=(0, 1))] for block in blocks]).reshape(-1, 6)


def _normals(corners, faces):
    """(T, 3) unit normals; zero of a facet without area."""
    a, b, c = (corners[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    size = vectors.length(normal)
    return normal / np.where(size > 0.0, size, 1.0)[:, None]


def join_neighbours(triangles, count) -> tuple[Any, ...]:
    """Return which of the first corners of a surface are joined by an edge of a triangle.

    Parameters
    ----------
    triangles : (T, 3) int [1]
    count : int
        Only corners before this one count.

    Returns
    -------
    firsts : (count + 1,) int
        Where the neighbours of each corner begin.
    neighbours : (N,) int
        All of them, one corner after the other.
    """
    ends = np.concatenate([triangles[:, [k, m]] for k in range(3) for m in range(3) if k != m])
    ends = np.unique(ends[(ends < count).all(axis=1)], axis=0)
    return np.searchsorted(ends[:, 0], np.arange(count + 1)), np.ascontiguousarray(ends[:, 1])


def convex_edges(corners, faces, normals) -> tuple[Any, ...]:
    """Return the edges at which a surface turns outwards, and the corners of those at which it turns inwards.

    Parameters
    ----------
    corners : (V, 3) float [L]
    faces : (T, 3) int
        Of a closed surface, counter-clockwise from outside.
    normals : (T, 3) float [1]

    Returns
    -------
    ends : (E, 2) int
    sides : (E, 6) float [1]
        In both faces, unit vectors square to the edge and away from it.
    hollow : (H,) int
    """
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    owners = np.tile(np.arange(len(faces)), 3)
    key = np.sort(pairs, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    key, owners, pairs = key[order], owners[order], pairs[order]
    two = np.flatnonzero((key[1:] == key[:-1]).all(axis=1))
    ends, first, second = pairs[two], owners[two], owners[two + 1]
    along = corners[ends[:, 1]] - corners[ends[:, 0]]
    into_first = np.cross(normals[first], along)  # into the first face: it runs the edge as given
    into_second = -np.cross(normals[second], along)
    size = vectors.length(along)[:, None]
    into_first, into_second = into_first / size, into_second / size
    bend = np.arctan2(-vectors.dot(into_second, normals[first]), vectors.dot(normals[first], normals[second]))
    keep = bend > FLAT_ANGLE
    return ends[keep], np.hstack([into_first, into_second])[keep], np.unique(ends[bend < -FLAT_ANGLE])
