"""Signs and constants of rocking that a level, symmetric pin would not show."""

from dataclasses import replace
from types import SimpleNamespace

import awkward
import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.feeding import stream
from feederscrew.motion import track_balance
from feederscrew.motion.cycle import phases
from feederscrew.motion.track_balance import seat
from feederscrew.resting.aspects import find
from feederscrew.sorting import tipping
from feederscrew.sorting.orientations import gyration, orientations
from feederscrew.sorting.tipping import ROCKING_STEPS, Rocker, goes_over, seat_in_groove

GRAVITY = 9.81
PERIOD = 1.0 / 60.0
STEADY = Rocker(
    near=2e-3, far=3e-3, height=10e-3, spread=4e-5,
    force=np.full(ROCKING_STEPS, 9.81), offset=np.zeros(ROCKING_STEPS),
)  # fmt: skip


def sliding(ahead, back, push, instants):
    """Motions of a part at rest, sliding ahead, and sliding back, pushed off at some instants only."""
    slides, rest = np.zeros(ROCKING_STEPS, bool), np.zeros((ROCKING_STEPS, 2))
    slides[list(instants)], rest[list(instants), 0] = True, push
    braked = [np.outer(np.ones(ROCKING_STEPS), (one, 0.0)) for one in (-ahead, back)]
    return [SimpleNamespace(acceleration=one, slides=slides) for one in (rest, *braked)]


def test_seen_at_any_instant_a_settled_part_slides_as_the_point_mass_does():
    """Its senses are ahead where the velocity over the track is ahead: followed finely from rest."""
    bowl = awkward.plain_bowl("track.radius=100 m", "track.bank=0 deg", "drive.amplitude=0.3 mm")
    one = next(one for one in awkward.lying("track.radius=100 m", "track.bank=0 deg") if one.kind == "flat")
    place = seat(one.posture, one.heading, one.touching, 0.0)
    phase, same = phases(ROCKING_STEPS), np.ones(ROCKING_STEPS)
    motions = [track_balance.motion(place, bowl, phase, sense * same) for sense in tipping.SENSES]
    found = tipping._senses(motions, 1.0 / bowl.drive.frequency / ROCKING_STEPS)
    assert {0, 1, 2} >= set(found) and (found == 1).any()
    drive, climb = bowl.drive, bowl.track.climb
    fine, speed, settled = 400, 0.0, {}
    step = 1.0 / drive.frequency / (fine * ROCKING_STEPS)
    top = drive.amplitude * (2.0 * np.pi * drive.frequency) ** 2
    for k in range(6 * fine * ROCKING_STEPS):
        drop = -top * np.sin(phase[0] + 2.0 * np.pi * k / (fine * ROCKING_STEPS))
        along = -drop * np.cos(drive.vibration_angle) - bowl.gravity * np.sin(climb)
        press = bowl.gravity * np.cos(climb) + drop * np.sin(drive.vibration_angle)
        if speed == 0.0:
            speed = step * along if abs(along) > bowl.friction.static * press else 0.0
        else:
            after = speed + step * (along - np.sign(speed) * bowl.friction.kinetic * press)
            speed = after if after * speed > 0.0 else 0.0
        if k % fine == 0:
            settled[k // fine % ROCKING_STEPS] = np.sign(speed)
    senses = np.array([settled[k] for k in range(ROCKING_STEPS)])
    told = np.array([0.0, 1.0, -1.0])[found]
    assert (senses == told).mean() > 0.9  # the first and the last instant of a slide are a close call


@pytest.mark.parametrize("share", [0.98, 1.02])
@pytest.mark.parametrize(("near", "far"), [(4e-3, 1.5e-3), (5e-3, 2e-3)])
def test_an_impact_keeps_the_angular_momentum_about_the_side_it_lands_on(share, near, far, monkeypatch):
    """Points of a flat body move with the rate about the near side; summed is their moment about the far one.

    The rate that is left (Housner) turns it over from s / (h T) on, T^2 = (k^2 + s^2 + h^2) / (g h).
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
    monkeypatch.setattr(tipping, "ROCKING_STEPS", count)
    monkeypatch.setattr(tipping, "FOLLOWED", 1)
    offset = np.zeros(count)
    offset[0] = rate / step * (spread + near**2 + height**2) / GRAVITY + near
    pushed = Rocker(near, far, height, spread, force=np.full(count, GRAVITY), offset=offset)
    assert goes_over(pushed, count * step) == (share > 1.0)


@pytest.fixture(scope="module")
def flat():
    """An orientation of the awkward body that lies on the track, of three different inertias."""
    return next(one for one in awkward.lying() if one.kind == "flat" and not one.falls_off)


def followed(monkeypatch, one, bowl, limit):
    """What is asked of rocking for a part over a gap, answered by never: (Rocker, start) in their order."""
    asked = []
    monkeypatch.setattr(tipping, "goes_over", lambda *args: asked.append(args) or False)
    tipping.steady([make_device("gap", "test", limit=limit)], [one], bowl, 2.5e-4)
    return asked


def test_over_a_gap_it_rocks_about_the_edge_across_the_track(monkeypatch, flat):
    """The instants at which it is tried to land are spread evenly over the whole period, at least eight."""
    asked = followed(monkeypatch, flat, awkward.plain_bowl(), flat.gap - 1e-4)
    spreads = {rocker.spread for rocker, *_ in asked}
    assert len(spreads) == 1 and spreads.pop() == pytest.approx(awkward.square_of_gyration(flat), rel=1e-6)
    reach = flat.foot.corners[:, 0]
    assert {period for _, period, *_ in asked} == {1.0 / awkward.plain_bowl().drive.frequency}
    leaving, coming = asked[0][0], asked[-1][0]
    assert (leaving.far, coming.far) == pytest.approx((-reach.min(), reach.max()), rel=1e-9)
    assert leaving.far != pytest.approx(coming.far, rel=1e-3)
    np.testing.assert_array_equal(coming.offset, -leaving.offset)
    assert coming.growth > 0.0 == leaving.growth
    starts = [start for _, _, *given in asked for start in given]
    around = np.diff([*sorted(starts), min(starts) + ROCKING_STEPS])
    assert len(starts) >= 8 and around.max() == around.min()


def test_a_part_rocks_over_the_side_about_which_the_moment_is_greatest(monkeypatch):
    """Not the one that the strongest force lies beyond: 20 at half a millimetre, 5 at three of them."""
    contact = 1e-3 * np.array([[-3.0, -2.0], [5.0, -2.0], [5.0, 4.0], [-3.0, 4.0]])
    force, offset = np.full(ROCKING_STEPS, 9.81), np.zeros((ROCKING_STEPS, 2))
    force[:2], offset[0], offset[1] = [20.0, 5.0], [5.5e-3, 0.0], [0.0, -5e-3]
    monkeypatch.setattr(tipping, "over_period", lambda *_: (force, offset))
    found = tipping.rocker(SimpleNamespace(contact=contact, height=6e-3), lambda angle: angle, None)
    assert (found.near, found.far) == pytest.approx((2e-3, 4e-3), rel=1e-9)
    assert np.sin(found.spread) == pytest.approx(0.0, abs=1e-9)  # about the direction along the track
    np.testing.assert_allclose(found.offset[:2], [0.0, 5e-3], atol=1e-12)


def test_what_is_late_for_the_next_stroke_is_followed(monkeypatch):
    """Tilt, rate and pull of the weight make a parabola: late is what has not come down a stroke later."""
    monkeypatch.setattr(tipping, "goes_over", lambda *args: True)
    bowl, ratios = awkward.plain_bowl("friction.static=0.9", "friction.kinetic=0.85", "track.climb=1 deg"), []
    stroke = 0.5 / bowl.drive.frequency
    for slender in np.linspace(1.3, 2.7, 15):
        part = shapes.part(shapes.box(3.0, 3.9, 3.0 * slender))
        lying = stream.follow_orientations(part, find(part), bowl.track).lying
        rows = tipping.tipping(lying, bowl)
        for one, tips, tilt, lean, over in zip(lying, rows.tips, rows.tilt, rows.balance, rows.over):
            if not tips:
                continue
            height = one.posture.height
            rate, beside = 2.0 * tilt / stroke, height * np.tan(lean)
            back = bowl.gravity * beside / (beside**2 + height**2)
            down = np.roots([-0.5 * back, rate, tilt]).real.max()
            assert over == (down > stroke or tilt >= lean)
            if tilt < lean:
                ratios.append(down / stroke)
    assert np.abs(np.log(ratios)).min() < 0.1 and min(ratios) < 1.0 < max(ratios)


@pytest.mark.parametrize("offset, over", [(1.99e-3, 0), (2.01e-3, 1), (-2.99e-3, 0), (-3.01e-3, 1)])
def test_a_steady_force_turns_a_part_over_from_its_sides_on(offset, over):
    assert goes_over(replace(STEADY, offset=np.full(ROCKING_STEPS, offset)), PERIOD) == over


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_one_push_turns_it_over_from_the_rate_that_lifts_the_centre_of_mass(share, monkeypatch):
    """From the rate W the tilt is W T sinh(t / T) - r / h (cosh(t / T) - 1): it turns if W < r / (h T)."""
    count, step = 4000, 1e-4
    monkeypatch.setattr(tipping, "ROCKING_STEPS", count)
    monkeypatch.setattr(tipping, "FOLLOWED", 1)
    moment = STEADY.spread + STEADY.near**2 + STEADY.height**2
    time = np.sqrt(moment / (9.81 * STEADY.height))
    rate = share * STEADY.near / (STEADY.height * time)
    offset = np.zeros(count)
    offset[0] = rate / step * moment / 9.81 + STEADY.near
    pushed = replace(STEADY, force=np.full(count, 9.81), offset=offset)
    assert goes_over(pushed, count * step) == (share > 1.0)


def test_a_pin_on_the_track_rocks_with_its_own_inertia():
    """The gyration about a side is that of the box; near and far sides are half its width away."""
    part, bowl = shapes.part(shapes.box(10, 10, 40)), bowls.read(None, [])
    upright = next(one for one in orientations(part, find(part), bowl.track) if one.height > 0.03)
    found = tipping.rocker(seat_in_groove(upright, 0.0), lambda angle: gyration(upright, angle), bowl)
    assert (found.near, found.far) == pytest.approx((5e-3, 5e-3), rel=1e-9)
    assert found.spread == pytest.approx((0.01**2 + 0.04**2) / 12.0, rel=1e-9)
    assert np.all(found.force >= 0.0) and found.force.mean() == pytest.approx(9.81, rel=0.02)


def test_a_part_that_gains_support_in_time_comes_back():
    """A force 0.1 mm beyond the near side turns it over, but not where that side moves on past the force."""
    pushed = replace(STEADY, offset=np.full(ROCKING_STEPS, 2.1e-3))
    assert goes_over(pushed, PERIOD) and not goes_over(replace(pushed, growth=0.1), PERIOD)
    assert goes_over(replace(pushed, growth=1e-5), PERIOD, start=ROCKING_STEPS // 2)
    grown = [replace(pushed, growth=growth) for growth in np.geomspace(1e-4, 0.1, 60)]
    over = [goes_over(one, PERIOD) for one in grown]
    assert 10 < sum(over) < 50
    assert all([goes_over(one, PERIOD, start=k) for one in grown] == over for k in (7, ROCKING_STEPS // 2))
