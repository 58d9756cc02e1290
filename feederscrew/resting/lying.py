"""Way in which a part lies on an aspect, in one word: by what of it touches the floor."""

import enum
from collections.abc import Sequence

import numpy as np

from feederscrew.base.arrays import Points, Triangles, Vector
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.graphs import component_of
from feederscrew.base.geometry.polygons import outline, sides
from feederscrew.part.hull import Hull
from feederscrew.part.record import Part
from feederscrew.resting.faces import ONE_PLANE, Face
from feederscrew.resting.landscape import Landscape, angle

FACE_SHARE = 0.3  # of the supporting polygon: with less material that touches, edges or points carry the part
SAME_SIZE = 0.02  # share by which two sizes or areas of a part may differ and count as one
TOUCHING_SHARE = 2e-4  # of the part's size: material that is lower than that over the floor touches it
NOISE_DEPTHS = 8.0  # of a file's noise: material so deep off a plane is still of it


class Lies(enum.StrEnum):
    """Way in which a part lies; tables, pictures, reports and documents print the word."""

    LARGEST_FACE = "on its largest face"
    FACE = "on a face"
    END = "on end"
    EDGES = "on edges"
    ROLLS = "on its side, rolls"


def describe_lying(
    part: Part, hull: Hull, basins: Landscape, faces: Sequence[Face], noise: float = 0.0
) -> tuple[Lies, ...]:
    """Return how a part lies on each of some faces of its hull.

    A face of the part carries it where material that touches the floor fills ``FACE_SHARE`` of the contact
    polygon. It lies "on end" if its longest side is upright then, and "on its largest face" if no flat face
    that can touch a floor is larger and some side is smaller. Otherwise edges or points carry it. What rolls
    lies on its side.

    Parameters
    ----------
    part : Part
        From a mesh.
    hull : Hull
        Of the part, about its centre of mass.
    basins : Landscape
        Of the hull: which of its triangles are neighbours.
    faces : sequence of Face
        In any order; one of each class of equal faces.
    noise : float [m]
        Of the file: mean depth of the roughest flat face's corners off its plane. A face of few corners
        shows less than the whole of it.

    Returns
    -------
    tuple of Lies
        One for each face.
    """
    areas = [
        0.0 if face.kind == "rolling" else touching_area(part, face.normal, face.height, noise)
        for face in faces
    ]
    least, largest = _side_areas(part, hull, basins, max(areas, default=0.0))
    has_largest = least < largest * (1.0 - SAME_SIZE)
    answers = []
    for face, area in zip(faces, areas):
        if face.kind == "rolling":
            answers.append(Lies.ROLLS)
        elif area < FACE_SHARE * face.area:
            answers.append(Lies.EDGES)
        elif is_on_end(hull, face.normal):
            answers.append(Lies.END)
        else:
            is_largest = has_largest and area >= largest * (1.0 - SAME_SIZE)
            answers.append(Lies.LARGEST_FACE if is_largest else Lies.FACE)
    return tuple(answers)


def touching_area(part: Part, normal: Vector, height: float, noise: float = 0.0) -> float:
    """Return the area [m2] of a part's material that touches a floor.

    Parameters
    ----------
    part : Part
        From a mesh.
    normal : (3,) [1]
        Out of the part, down to the floor.
    height : float [m]
        Of the centre of mass over the floor.
    noise : float [m]
        Mean depth of a flat side's corners off its plane.

    Returns
    -------
    float [m2]
        Of the facets of which every corner touches, as the floor sees them.
    """
    corners = part.corners
    depth = max(TOUCHING_SHARE * _size(corners), NOISE_DEPTHS * noise)
    return _area_near(corners, np.asarray(part.faces), normal, height - depth)


def _size(corners: Points) -> float:
    """Largest extent [m] of corners along an axis of the file."""
    return float(np.ptp(corners, axis=0).max())


def _area_near(corners: Points, faces: Triangles, normal: Vector, least: float) -> float:
    """Area [m2], as a normal sees it, of the facets of which every corner is beyond a height [m] along it."""
    low = vectors.product(corners, normal) > least
    first, second, third = faces.T
    touching = np.flatnonzero(low[first])  # of most sides of a round part only some facets
    touching = touching[low[second[touching]] & low[third[touching]]]
    a, b, c = (corners[column[touching]] for column in (first, second, third))
    facing = vectors.product(vectors.cross(b - a, c - a), normal)
    return 0.5 * float(np.maximum(facing, 0.0).sum())


def is_on_end(hull: Hull, normal: Vector) -> bool:
    """Tell whether the longest side of a part is upright.

    The sides are those of the smallest upright box around the part; of sides of one length none is the
    longest.

    Parameters
    ----------
    hull : Hull
    normal : (3,) float [1]
        Of the hull, that is down.

    Returns
    -------
    bool
    """
    across = vectors.plane_axes(normal)
    plan = outline(np.column_stack([vectors.product(hull.vertices, axis) for axis in across]))
    along = sides(plan)
    along = along / np.hypot(*along.T)[:, None]
    lengths = np.ptp(vectors.product(along, plan.T), axis=1)
    widths = np.ptp(vectors.product(np.column_stack([-along[:, 1], along[:, 0]]), plan.T), axis=1)
    least = int(np.argmin(lengths * widths))
    upright = float(np.ptp(vectors.product(hull.vertices, normal)))
    return upright > (1.0 + SAME_SIZE) * max(lengths[least], widths[least])


def _side_areas(part: Part, hull: Hull, basins: Landscape, known: float) -> tuple[float, float]:
    """Areas [m2] of the least side of a hull, and of the material of the largest; ``known``: of one."""
    bends = angle(*(hull.normals[basins.pairs[:, k]] for k in (0, 1)))
    plane = component_of(basins.pairs[bends < ONE_PLANE], len(hull.triangles))
    areas = np.bincount(plane, hull.areas)
    sides_left = np.flatnonzero(areas > known * (1.0 + SAME_SIZE))
    # the largest triangle of each side, the first of equal ones
    order = np.lexsort((-hull.areas, plane))
    _, starts = np.unique(plane[order], return_index=True)
    middle = order[starts]
    corners, faces = part.corners, np.array(part.faces, order="F")
    depth = TOUCHING_SHARE * _size(corners)
    largest = known
    for side in middle[sides_left]:
        least = float(hull.heights[side]) - depth
        largest = max(largest, _area_near(corners, faces, hull.normals[side], least))
    return float(areas[areas > 0.0].min()), largest
