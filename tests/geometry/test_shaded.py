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
    return shapely.union_all(shapely.polygons(corners[faces][twice > shaded.LEAST_AREA_M2]))


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


def test_below_sides_counts_what_is_highest_and_leaves_what_is_not_there():
    """A roof over 0 to 4 mm over a floor, a side of 1 um between its halves, and a slope apart."""
    sides = 1e-3 * np.array(
        [
            [[0.0, 1.0], [1.999, 3.0]], [[1.999, 3.0], [2.0, 3.0]], [[4.0, 1.0], [2.0, 3.0]],
            [[4.0, 0.5], [0.0, 0.5]], [[7.0, 0.0], [9.0, 4.0]], [[9.0, 4.0], [9.0, 0.0]],
        ]
    )  # fmt: skip
    sides[:, :, 0] -= 9e-3
    for some in (sides, sides[::-1, ::-1], sides[[3, 0, 4, 1, 5, 2]]):
        seen = shaded.below(some, 1e-6)
        assert [one.area for one in shapely.get_parts(seen)] == pytest.approx([8e-6, 4e-6], rel=1e-3)
        assert [round(1e3 * end, 6) for end in seen.bounds] == [-9.0, 0.0, 0.0, 4.0]
        assert len(shapely.get_coordinates(seen)) == 10  # no corner where sides only go on
    union = shapely.union_all(
        [shapely.Polygon([*side, (side[1, 0], 0.0), (side[0, 0], 0.0)]) for side in sides[:4]]
    )
    assert shapely.get_parts(shaded.below(sides, 1e-6))[0].symmetric_difference(union).area < 2e-9


def test_below_what_crosses_is_told_to_half_a_strip():
    rng = np.random.default_rng(3)
    for _ in range(20):
        sides = 0.02 * np.column_stack([rng.random((30, 2)), rng.random((30, 2))]).reshape(
            30, 2, 2
        ).transpose(0, 2, 1)
        seen = shaded.below(sides, 1e-6)
        all_of = shapely.union_all(
            [shapely.Polygon([*side, (side[1, 0], 0.0), (side[0, 0], 0.0)]).buffer(0.0) for side in sides]
        )
        assert seen.symmetric_difference(all_of).area < 0.02 * all_of.area
