"""The area that a body covers as it is seen: against the union of its facets, one by one."""

from pathlib import Path

import numpy as np
import pytest
import shapely
import shapes

from feederscrew.geometry import shaded
from feederscrew.part import load

PARTS = Path(__file__).resolve().parents[2] / "parts"


def facets(corners, faces):
    """The union of the facets whose outer side is seen."""
    a, b, c = corners[faces].transpose(1, 0, 2)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    return shapely.union_all(shapely.polygons(corners[faces][twice > shaded.LEAST]))


def alike(one, other):
    return one.symmetric_difference(other).area < 1e-9 * other.area


@pytest.mark.parametrize("name", ["lbracket_30x20x15", "cap_14x10", "washer_m6"])
@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_area_is_that_of_all_facets_together(name, seed):
    part = load(PARTS / f"{name}.stl")
    points = part.vertices
    if seed is not None:
        points = points @ np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))[0]
    flipped = np.linalg.det(np.linalg.lstsq(part.vertices, points, rcond=None)[0]) < 0.0
    faces = part.faces[:, ::-1] if flipped else part.faces
    for axes in ([0, 1], [2, 0]):
        seen = shaded.area(points[:, axes], faces)
        assert alike(seen, facets(points[:, axes], faces))
        assert alike(
            seen, facets(points[:, axes], faces[:, ::-1])
        )  # the other side of a closed body covers as much


def test_pieces_that_overlap_or_lie_apart_count_once_each():
    """Two boxes, one over a part of the other, and one far off; a facet twice changes nothing."""
    corners, faces, count = [], [], 0
    for off in ((0.0, 0.0, 0.0), (0.007, 0.003, 0.02), (0.05, 0.0, 0.0)):
        box = shapes.box(10, 8, 5)
        corners.append(0.001 * np.asarray(box.vertices) + off)
        faces.append(np.asarray(box.faces) + count)
        count += len(box.vertices)
    corners, faces = np.vstack(corners)[:, :2], np.vstack(faces)
    assert shaded.area(corners, faces).area == pytest.approx((2 * 80.0 - 3.0 * 5.0 + 80.0) * 1e-6, rel=1e-12)
    assert len(shapely.get_parts(shaded.area(corners, faces))) == 2
    assert alike(shaded.area(corners, np.vstack([faces, faces[:6]])), shaded.area(corners, faces))
    assert shaded.area(corners, faces[:0]).is_empty
