"""Signs and constants of rocking that a level, symmetric pin would not show."""

import awkward
import numpy as np
import pytest
import shapes

from feederscrew.rates import rocking, steadiness, stream, tipping
from feederscrew.rates.rocking import INSTANTS, Rocker, goes_over
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import made

GRAVITY = 9.81


@pytest.mark.parametrize("share", [0.98, 1.02])
@pytest.mark.parametrize(("near", "far"), [(4e-3, 1.5e-3), (5e-3, 2e-3)])
def test_an_impact_keeps_the_angular_momentum_about_the_side_it_lands_on(share, near, far, monkeypatch):
    """Of its rate about one side a part keeps what its momentum about the other side gives there (Housner).

    Points of a flat body: before the impact each moves with the rate about the near side, and the moment of
    that momentum about the far side is summed over them. The rate that is left turns it over the far side
    from s / (h T) on, T^2 = (k^2 + s^2 + h^2) / (g h).
    """
    height, half = 5e-3, np.array([np.sqrt(1.1e-5), np.sqrt(0.4e-5)])  # k^2 of four points: their mean square
    points = half * [[1, 1], [1, -1], [-1, 1], [-1, -1]] + [0.0, height]
    about_near, about_far = points - [near, 0.0], points - [-far, 0.0]
    velocity = np.column_stack([-about_near[:, 1], about_near[:, 0]])  # at a unit rate
    moment = (about_far[:, 0] * velocity[:, 1] - about_far[:, 1] * velocity[:, 0]).sum()
    kept = moment / (about_far**2).sum()
    spread = float((half**2).sum())
    time = np.sqrt((spread + far**2 + height**2) / (GRAVITY * height))
    rate = share * far / (height * time) / kept
    count, step = 16000, 5e-5
    monkeypatch.setattr(rocking, "INSTANTS", count)
    monkeypatch.setattr(rocking, "FOLLOWED", 1)
    offset = np.zeros(count)
    offset[0] = rate / step * (spread + near**2 + height**2) / GRAVITY + near
    pushed = Rocker(near, far, height, spread, force=np.full(count, GRAVITY), offset=offset)
    assert goes_over(pushed, count * step) == (share > 1.0)


def moment_across(one):
    """Square of the radius of gyration about the level axis across the track, from the mesh itself."""
    mesh = one.posture.solid
    centres, volumes = tetrahedra(mesh.vertices[mesh.faces])
    middle = np.einsum("f,fi->i", volumes, centres.mean(axis=1)) / volumes.sum()
    ahead, up = one.axes[0], one.axes[2]
    corners = centres - middle
    return sum(second_moment(corners @ axis, volumes) for axis in (ahead, up)) / volumes.sum()


def tetrahedra(triangles):
    """Corners (F, 4, 3) and signed volumes (F,) of the tetrahedra from the origin to each triangle."""
    apex = np.zeros((len(triangles), 1, 3))
    return np.concatenate([apex, triangles], axis=1), np.linalg.det(triangles) / 6.0


def second_moment(values, volumes):
    """Integral of the square of a linear function with these corner values (F, 4) over tetrahedra."""
    return (volumes * (values.sum(axis=1) ** 2 + (values**2).sum(axis=1)) / 20.0).sum()


@pytest.fixture(scope="module")
def flat():
    """An orientation of the awkward body that lies on the track, of three different inertias."""
    return next(one for one in awkward.lying() if one.kind == "flat" and not one.falls_off)


def followed(monkeypatch, one, bowl, limit):
    """What is asked of rocking for a part over a gap, answered by never: (Rocker, start) in their order."""
    asked = []
    monkeypatch.setattr(steadiness, "goes_over", lambda *args: asked.append(args) or False)
    steadiness.steady([made("gap", "test", limit=limit)], [one], bowl, 2.5e-4)
    return asked


def test_over_a_gap_it_rocks_about_the_edge_across_the_track(monkeypatch, flat):
    asked = followed(monkeypatch, flat, awkward.plain_bowl(), flat.gap - 1e-4)
    spreads = {rocker.spread for rocker, *_ in asked}
    assert len(spreads) == 1 and spreads.pop() == pytest.approx(moment_across(flat), rel=1e-6)
    reach = flat.foot.corners[:, 0]
    leaving, coming = asked[0][0], asked[-1][0]
    assert (leaving.far, coming.far) == pytest.approx((-reach.min(), reach.max()), rel=1e-9)
    assert leaving.far != pytest.approx(coming.far, rel=1e-3)
    np.testing.assert_array_equal(coming.offset, -leaving.offset)
    assert coming.growth > 0.0 == leaving.growth


def test_it_may_land_at_any_time_of_the_period(monkeypatch, flat):
    """The instants at which it is tried to land are spread evenly over the whole period, at least eight."""
    asked = followed(monkeypatch, flat, awkward.plain_bowl(), flat.gap - 1e-4)
    starts = [start for _, _, *given in asked for start in given]
    around = np.diff([*sorted(starts), sorted(starts)[0] + INSTANTS])
    assert len(starts) >= 8 and around.max() == around.min()


def test_what_is_late_for_the_next_stroke_is_followed(monkeypatch):
    """Tilt, rate and pull of the weight make a parabola: late is what has not come down a stroke later."""
    monkeypatch.setattr(tipping, "goes_over", lambda *args: True)
    ratios = []
    for slender in np.linspace(1.3, 2.7, 15):
        part = shapes.part(shapes.box(3.0, 3.9, 3.0 * slender))
        bowl = awkward.plain_bowl("friction.static=0.9", "friction.kinetic=0.85", "track.climb=1 deg")
        for one, tips, tilt, lean, over in told(part, bowl):
            if not tips:
                continue
            stroke, height = 0.5 / bowl.drive.frequency, one.posture.height
            rate, beside = 2.0 * tilt / stroke, height * np.tan(lean)
            back = bowl.gravity * beside / (beside**2 + height**2)
            down = np.roots([-0.5 * back, rate, tilt]).real.max()
            late = down > stroke
            assert over == (late or tilt >= lean)
            if tilt < lean:
                ratios.append(down / stroke)
    near = np.abs(np.log(ratios))
    assert near.min() < 0.1 and min(ratios) < 1.0 < max(ratios)


def told(part, bowl):
    """Each orientation and what tipping says of it."""
    found = find(part)
    known = stream.orientations(part, found, bowl.track)
    rows = tipping.tipping(known.lying, bowl)
    return zip(known.lying, rows.tips, rows.tilt, rows.balance, rows.over)
