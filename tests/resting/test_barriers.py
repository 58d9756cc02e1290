"""Barriers, tipping angles and the two rules built on them, against closed forms."""

import numpy as np
import pytest

from feederscrew.part.hull import convex_hull
from feederscrew.resting.barriers import (
    UNNAMED,
    balance,
    barriers,
    critical_solid_angles,
    rises,
    tip_angles,
    tipping,
)
from feederscrew.resting.exact_tumbling import tumble

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2.0


def box_tipping(size, centre=(0.0, 0.0, 0.0)):
    """Tipping of a box; face 2 k is the one at -x_k, 2 k + 1 that at +x_k."""
    hull = convex_hull(CUBE * size, np.array(centre, float))
    return tipping(tumble(hull), sides_of(hull))


def sides_of(hull):
    axis = np.argmax(np.abs(hull.normals), axis=1)
    return 2 * axis + (hull.normals[np.arange(len(axis)), axis] > 0)


def rectangle(a, b, h):
    return np.array([(-a, -b, -2 * h), (-a, b, -2 * h), (a, b, -2 * h), (a, -b, -2 * h)]) / 2.0


def rectangle_angle(a, b, h):
    return 4.0 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)))


def test_a_box_tips_over_the_middles_of_its_edges():
    a, b, c = size = (10.0, 20.0, 30.0)
    tips = box_tipping(size)
    assert len(tips.pairs) == 12
    tops = {tuple(pair): top for pair, top in zip(tips.pairs.tolist(), tips.tops)}
    assert tops[0, 2] == pytest.approx(np.hypot(a, b) / 2)
    assert tops[0, 4] == pytest.approx(np.hypot(a, c) / 2)
    assert tops[3, 5] == pytest.approx(np.hypot(b, c) / 2)
    lowest = barriers(tips)
    assert lowest[:2] == pytest.approx([np.hypot(a, b) / 2 - a / 2] * 2)
    assert lowest[4:] == pytest.approx([np.hypot(a, c) / 2 - c / 2] * 2)


def test_the_floor_tilts_by_half_the_width_over_the_height():
    assert tip_angles([rectangle(6.0, 4.0, 5.0)], [5.0])[0] == pytest.approx(np.arctan(2.0 / 5.0))
    assert tip_angles([rectangle(6.0, 4.0, 5.0) + np.array([0, 1.5, 0])], [5.0])[0] == pytest.approx(
        np.arctan(0.5 / 5.0)
    )
    assert tip_angles([rectangle(6.0, 4.0, 5.0) + np.array([0, 2.5, 0])], [5.0])[0] < 0.0


def test_the_critical_solid_angle_of_a_box():
    a, b, h = 3.0, 2.0, 1.2
    want = np.mean([rectangle_angle(a, b, np.hypot(h, side / 2)) for side in (a, a, b, b)])
    q = rectangle_angle(a, b, h)
    assert critical_solid_angles([rectangle(a, b, h)], [h])[0] == pytest.approx((q - want) / q)


def test_a_face_through_the_centre_of_mass_has_no_share_of_its_solid_angle():
    """Of a sheet 4 um thick, read in single precision; it was a division by zero."""
    face = 1e-3 * np.array([[10.0, 0.0, 2.0], [-10.0, 0.0, 2.0], [-10.0, 0.0, -2.0], [10.0, 0.0, -2.0]])
    assert (critical_solid_angles([face, face[::-1]], [2e-6, 2e-6]) == 0.0).all()


def test_in_balance_as_much_tips_into_each_face_as_out_of_it():
    tips = box_tipping((3.0, 4.0, 5.0), (0.4, -0.3, 0.2))
    shares, net = balance(tips), np.zeros(6)
    for (i, j), (from_i, from_j) in zip(tips.pairs, rises(tips)):
        over = shares[i] / from_i - shares[j] / from_j
        net[i], net[j] = net[i] - over, net[j] + over
    assert net == pytest.approx(np.zeros(6), abs=1e-9)
    assert shares.sum() == pytest.approx(1.0) and shares.argmax() == np.nanargmin(tips.heights)


def test_an_unnamed_sink_joins_the_face_behind_its_lowest_saddle():
    hull = convex_hull(CUBE * (1.0, 2.0, 3.0), np.array((0.01, 0.0, 0.0)))
    labels = sides_of(hull)
    full = tipping(tumble(hull), labels)
    part = tipping(tumble(hull), np.where(labels == 5, UNNAMED, labels))
    gain = part.shares[:5] - full.shares[:5]
    assert gain == pytest.approx([0, full.shares[5], 0, 0, 0], abs=1e-12)
    with pytest.raises(ValueError, match="no sink"):
        tipping(tumble(hull), np.full(len(labels), UNNAMED))


def test_faces_that_share_a_sink_tip_over_its_saddles_alike():
    hull = convex_hull(CUBE * (1.0, 2.0, 3.0), np.zeros(3))
    labels = sides_of(hull)
    tips = tipping(tumble(hull), np.where(labels == 5, UNNAMED, labels))
    tops = {tuple(pair): top for pair, top in zip(tips.pairs.tolist(), tips.tops)}
    assert tops[0, 1] == pytest.approx(np.hypot(1, 3) / 2)  # over the end that both share
    assert tops[0, 2] == tops[1, 2] == pytest.approx(np.hypot(1, 2) / 2)
    assert rises(tips).shape == (len(tops), 2) and barriers(tips)[0] == pytest.approx(barriers(tips)[1])


def test_a_part_with_one_face_cannot_tip():
    hull = convex_hull(CUBE, np.zeros(3))
    tips = tipping(tumble(hull), np.zeros(len(hull.triangles), int))
    assert len(tips.pairs) == 0 and np.isinf(barriers(tips)).all()
    assert balance(tips) == pytest.approx([1.0]) and tips.shares == pytest.approx([1.0])
