"""Orientations: what is one, who is whose mirror image, what touches the track."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapely
import shapes
import trimesh
from on_track import LEVEL, block, lying, named, pick

from feederscrew.base.geometry.polygons import turned
from feederscrew.sorting.orientations import name_mirror_images

CURVED = replace(LEVEL, radius=0.15)
FOLDED = [  # a hull, [mm]; on one of its aspects the two facets below make an angle of 0.01 rad
    (-12.97, -3.79, -0.58), (2.94, 10.7, 8.03), (-6.56, 8.38, 0.14), (-9.87, -1.53, -11.51),
    (10.5, -3.46, -1.7), (6.1, 1.0, 3.34), (-7.76, -9.51, 5.38), (-10.86, -10.14, 4.04),
    (7.23, 4.3, -5.26), (4.62, 5.73, -3.15),
]  # fmt: skip
LEGS = [(-10, 0), (-7, 0), (-7, 6), (7, 6), (7, 0), (10, 0), (10, 10), (-10, 10)]
STEM = [(-2, 0), (2, 0), (2, 3), (10, 3), (10, 8), (-10, 8), (-10, 3), (-2, 3)]
BRACKET = shapes.prism(shapes.l_profile(), 15)


def test_orientations_of_simple_bodies_have_closed_form_limits():
    every = lying(block())
    assert len(every) == 6 and sum(one.chances["csa"] for one in every) == pytest.approx(1.0, abs=1e-9)
    along = pick(every, 20, 5)
    limits = along.gap, along.balcony, along.canyon, along.margin
    assert limits == pytest.approx((0.010, 0.006, 0.006, 0.006), rel=1e-3)
    # Turns by a third are one.
    side = 18.0
    every = lying(shapes.prism([(-side / 2, 0), (side / 2, 0), (0, side * np.sqrt(3) / 2)], 4))
    (flat,) = [one for one in every if one.height == pytest.approx(0.004)]
    assert flat.balcony == pytest.approx(1e-3 * side * np.sqrt(3) / 6, rel=1e-3)
    assert flat.heading_share == pytest.approx(1.0)
    # A bridge touches with its legs and not its hull.
    every = lying(shapes.prism(LEGS, 8))
    upright = [one for one in every if one.height == pytest.approx(0.010) and one.length > 0.015]
    one = next(one for one in upright if len(one.foot.rings) == 2)
    areas = [np.ptp(ring, axis=0).prod() for ring in one.foot.rings]
    assert areas == pytest.approx([24e-6, 24e-6], rel=1e-3)
    assert one.gap == pytest.approx(0.003, rel=1e-3)
    # A dowel rolls on a strip as long as itself.
    along = pick(lying(shapes.cylinder(3.0, 18.4, 64), CURVED), 18.4, 5.993)
    assert along.kind == "rolling"
    assert along.distance == pytest.approx(0.003 + 0.0184**2 / (8.0 * 0.15), rel=3e-3)
    length, width = np.ptp(along.foot.rings[0], axis=0)
    assert length == pytest.approx(0.0184, rel=1e-3)
    assert width == pytest.approx(2.0 * np.sqrt(2.0 * 0.03) * 0.003, rel=0.05)


def test_a_long_block_on_a_bent_track_passes_a_gap_of_half_its_length():
    """Its middle is a^2 / 8 R = 1.33 mm nearer to the bowl's axis than its ends: the gap reaches it there."""
    along = pick(lying(block(40, 12, 8), CURVED), height=8)
    assert along.length > 0.039 and along.gap == pytest.approx(0.020, rel=1e-3)


@pytest.mark.parametrize(("width", "carried"), [(7, False), (9, False), (11, True)])
def test_a_foot_beyond_the_track_supports_nothing(width, carried):
    """A T on its stem of 4 mm, across the track: its foot begins 8 mm from the wall, its weight is at 10."""
    every = lying(shapes.prism(STEM, 8), replace(LEVEL, width=1e-3 * width))
    across = [one for one in every if one.height == pytest.approx(0.008) and one.length < 0.009]
    across = [one for one in across if len(one.posture.feet) == 4 and one.posture.height > 0.0045]
    assert across and all((one.margin > 0.0, not one.falls_off) == (carried, carried) for one in across)
    if not carried:
        assert all((one.balcony, one.canyon, one.gap) == (np.inf, 0.0, 0.0) for one in across)


def test_what_stands_on_facets_not_in_one_plane_has_the_foot_that_headings_gives_it():
    every = [one for one in lying(trimesh.convex.convex_hull(FOLDED)) if not one.posture.on_floor.any()]
    assert every and not any(one.falls_off for one in every)
    for one in every:
        assert one.foot.corners == pytest.approx(turned(one.posture.feet[:, 0], one.heading), abs=1e-12)
        assert one.margin > 0.003


def test_mirror_images_stay_apart_and_name_each_other():
    every = name_mirror_images(lying(BRACKET, CURVED))
    pairs = [(one, named(every, one.mirror)) for one in every if one.mirror]
    assert pairs
    for one, other in pairs:
        assert other.mirror == one.name
        assert one.chances["csa"] == pytest.approx(other.chances["csa"], rel=1e-6)
        assert one.distance == pytest.approx(other.distance, rel=1e-6)
    # Limits do not hang on the tessellation.
    whole, finer = every, lying(shapes.subdivided(BRACKET, 2), CURVED)
    assert [one.name for one in whole] == [one.name for one in finer]
    for one, other in zip(whole, finer):
        limits, others = ((k.balcony, k.canyon, k.gap, k.margin) for k in (one, other))
        assert others == pytest.approx(limits, abs=2e-6)


def test_a_skew_body_touches_a_round_wall_and_covers_the_track_as_its_corners_say():
    """Seen from the bowl's axis its farthest corner is at the wall, and its nearest place its width away."""
    for one in awkward.lying():
        radius = one.track.radius
        ahead, inwards = one.axes[:2]
        seen = one.posture.solid.vertices - one.posture.solid.centre_of_mass
        places = np.column_stack([seen @ ahead, radius - one.distance - seen @ inwards])
        assert np.hypot(*places.T).max() == pytest.approx(radius, rel=1e-9)
        near = shapely.MultiPoint(places).convex_hull.distance(shapely.Point(0.0, 0.0))
        assert one.width == pytest.approx(radius - near, rel=1e-6)
        assert one.length == pytest.approx(np.ptp(places[:, 0]), rel=1e-9)
        assert one.posture.height == pytest.approx(-(seen @ one.axes[2]).min(), rel=1e-9)
    # It tips as a pendulum, T2 = (k2 + h2) / (g h), by 2 T of its way: over an edge across, or the worst one.
    gravity, turns, uneven = awkward.bowl().gravity, np.linspace(0.0, np.pi, 2001), []
    axes = np.column_stack([np.cos(turns), np.sin(turns), 0.0 * turns])
    for one in awkward.lying():
        spread, height = awkward.second_moments(one), one.posture.height
        about = np.trace(spread) - np.einsum("ni,ij,nj->n", axes, spread, axes)
        ways = 2.0 * one.speed * np.sqrt((about + height**2) / (gravity * height))
        assert one.carry_ahead == pytest.approx(ways[1000], rel=1e-6)  # about the axis across
        assert one.carry == pytest.approx(ways.max(), rel=1e-5)
        uneven.append(one.carry / one.carry_ahead)
    assert max(uneven) > 1.1 and min(uneven) >= 1.0
