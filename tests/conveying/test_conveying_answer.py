"""From a bowl to an answer in SI units: published demonstration, radius, sensitivity, traces."""

from dataclasses import replace

import numpy as np
import pytest
from conveying_reference import random_settings
from mechanics_samples import box_posture

from feederscrew import bowl as bowls
from feederscrew.conveying import answer, steady
from feederscrew.conveying.operating_point import FLIGHT, PHASES, OperatingPoint, plain
from feederscrew.conveying.steady import trace
from feederscrew.errors import ConfigError
from feederscrew.mechanics import track_balance
from feederscrew.mechanics.floor_balance import HOP
from feederscrew.mechanics.track_balance import seat
from feederscrew.studies.slide import slide

DEG = np.pi / 180.0


def bowl(*overrides):
    return bowls.read(None, ("restitution=0", "track.climb=3 deg", "gravity=9.81 m/s2", *overrides))


def driven(frequency, stroke, angle, friction):
    return bowl(
        f"drive.frequency={frequency} Hz",
        f"drive.peak_to_peak={stroke} mm",
        f"drive.vibration_angle={angle} deg",
        f"friction.static={friction}",
    )


@pytest.mark.parametrize(
    ("setting", "velocity", "half_digit"),
    [
        ((50, 1.0, 15, 0.2), -30, 0.5),
        ((50, 1.0, 15, 0.4), 12.1, 0.05),
        ((50, 1.0, 25, 0.4), 103.7, 0.05),
        ((50, 2.0, 15, 0.2), 282, 0.5),
        ((60, 1.5, 25, 0.2), -46, 0.5),
        ((120, 0.3, 25, 0.4), 85, 0.5),
    ],
)
def test_demonstration_velocities(setting, velocity, half_digit):
    assert answer.answer(driven(*setting)).velocity * 1e3 == pytest.approx(velocity, abs=half_digit)


def test_velocity_scales_with_stroke_frequency_and_gravity():
    """v w / g depends on the ratio A w^2 / g alone."""
    here = driven(50, 1.0, 25, 0.4)
    drive = replace(here.drive, frequency=100.0, amplitude=here.drive.amplitude / 4.0)
    assert answer.answer(replace(here, drive=drive)).velocity == pytest.approx(
        answer.answer(here).velocity / 2.0
    )
    moon = replace(
        here, gravity=here.gravity / 6.0, drive=replace(here.drive, amplitude=here.drive.amplitude / 6.0)
    )
    assert answer.answer(moon).velocity == pytest.approx(answer.answer(here).velocity / 6.0)


def banked(*more):
    """The setting whose velocity independent code has by three-dimensional vectors: 15.28 mm/s."""
    drive = ("drive.amplitude=0.15 mm", "drive.frequency=50 Hz", "drive.vibration_angle=25 deg")
    surface = ("friction.static=0.4", "friction.kinetic=0.4", "friction.wall=0.8")
    return bowl(*drive, *surface, "track.climb=2 deg", "track.bank=12 deg", *more)


def test_a_banked_track_with_a_wall_is_a_level_one_of_another_friction():
    found = answer.answer(banked())
    assert found.setting.static == pytest.approx(0.57898, abs=5e-6)
    assert found.velocity == pytest.approx(15.275e-3, abs=0.5e-6)
    level = answer.answer(banked("track.bank=0 deg", f"friction.static={found.setting.static!r}",
                                 f"friction.kinetic={found.setting.kinetic!r}"))  # fmt: skip
    assert found.velocity == level.velocity
    assert (found.regime, found.throw_number) == (level.regime, level.throw_number)


def test_limits_of_slip_are_told_of_the_floor_beside_its_wall():
    """At its limit the floor's own friction just holds; a wall may hold by itself."""
    here = banked("drive.amplitude=0.05 mm")
    limit = answer.answer(here).mu_forward
    assert limit == pytest.approx(
        (0.5030379 * np.cos(here.drive.vibration_angle) - np.sin(here.track.climb))
        / (np.cos(here.track.climb) - 0.5030379 * np.sin(here.drive.vibration_angle))
        * np.cos(here.track.bank)
        - 0.8 * np.sin(here.track.bank),
        rel=1e-6,
    )
    for friction, slips in ((limit * 1.001, False), (limit * 0.999, True)):
        surface = (f"friction.static={friction}", "friction.kinetic=0.01")
        found = answer.answer(banked("drive.amplitude=0.05 mm", *surface))
        assert (found.fractions["forward"] > 0.0) == slips
        assert (found.margins["forward"] < 0.0) == slips


def test_slide_and_track_take_the_bank_as_convey_does():
    """One wall for all: the same limits, regime and throw number, and contact lost at the same drive."""
    for stroke in (0.05, 0.1, 0.3):
        here = banked(f"drive.amplitude={stroke} mm")
        found, (one,) = answer.answer(here), slide(here).maps
        assert one.at_bowl["throw_number"] == pytest.approx(found.throw_number, rel=1e-12)
        assert one.regime == found.regime
        if found.regime != "hop":
            limits = (one.at_bowl["mu_forward"], one.at_bowl["mu_backward"])
            assert limits == pytest.approx((found.mu_forward, found.mu_backward), rel=1e-9)
    place = seat(box_posture(height=0.0005), 0.0, np.array([[-0.015, -0.005], [0.015, -0.005]]), 1.0)
    for share, hops in ((0.999, False), (1.001, True)):
        there = banked(f"drive.amplitude={0.15 * share / 0.6381678} mm")
        state = track_balance.motion(place, there, np.array([0.5 * np.pi])).state
        assert bool((state == HOP).any()) == hops


@pytest.mark.parametrize(
    ("overrides", "line"),
    [
        (("drive.amplitude=0 mm",), "drive.amplitude: is 0 mm, so nothing moves - give more than 0 mm"),
        (
            ("drive.direction=5 deg",),
            "drive.direction: is not 0 deg, but a track can only convey along itself"
            " - leave it out: it is for the floor (feeder floor)",
        ),
    ],
)
def test_bowls_that_convey_nothing(overrides, line):
    with pytest.raises(ConfigError) as caught:
        answer.answer(bowl(*overrides))
    assert str(caught.value) == line


def test_kinetic_above_static_within_a_map():
    settings = bowls.settings(None, ("friction.kinetic=0.5",))
    varied = bowls.swept(settings, {"friction.static": np.array([0.6, 0.4])})
    with pytest.raises(ConfigError, match=r"friction\.kinetic: is above friction\.static"):
        answer.cells(varied)


def test_one_screw_moves_the_whole_bowl():
    here = driven(50, 1.0, 25, 0.4)
    inner = answer.at_radius(here, here.track.radius * np.array([0.5, 1.0]))
    steepness = np.tan(inner.drive.vibration_angle + here.track.climb)
    assert steepness[0] == pytest.approx(2.0 * steepness[1])
    rise = inner.drive.amplitude * np.sin(inner.drive.vibration_angle + here.track.climb)
    assert rise[0] == pytest.approx(rise[1])
    assert inner.drive.amplitude[1] == pytest.approx(here.drive.amplitude)
    assert inner.drive.vibration_angle[1] == pytest.approx(here.drive.vibration_angle)


def test_sensitivity_is_a_difference_of_answers():
    here = driven(50, 1.0, 25, 0.4)
    nearby = answer.sensitivity(here)
    more = driven(50, 1.1, 25, 0.4)
    assert nearby["amplitude"].more == pytest.approx(answer.answer(more).velocity)
    assert nearby["friction"].less == pytest.approx(answer.answer(driven(50, 1.0, 25, 0.36)).velocity)
    assert nearby["angle"].more == pytest.approx(answer.answer(driven(50, 1.0, 27.5, 0.4)).velocity)
    assert answer.friction_doubt(here).more == pytest.approx(
        answer.answer(driven(50, 1.0, 25, 0.48)).velocity
    )
    assert answer.Neighbours(0.9, 1.1).elasticity(1.0) == pytest.approx(1.0)
    assert np.isnan(answer.Neighbours(0.0, 0.1).elasticity(0.0))


@pytest.mark.parametrize(
    "setting", [plain(0.6, 0.5, 0.05, 0.3), plain(4.0, 0.6, 0.0, 0.3), plain(7.0, 0.6, 0.0, 0.3)]
)
def test_trace_is_one_cycle(setting):
    drawn = trace(setting)
    assert (np.diff(drawn.time) >= 0.0).all()
    assert drawn.time[0] == 0.0
    assert drawn.time[-1] == pytest.approx(round(drawn.time[-1]))
    gap = drawn.part_normal - drawn.plate_normal
    assert (gap > -1e-12).all()
    assert (gap[drawn.phase != FLIGHT] == 0.0).all()
    assert gap[-1] == pytest.approx(gap[0], abs=1e-9)
    slip = drawn.part_along - drawn.plate_along
    assert np.abs(np.diff(slip)[drawn.phase[1:] == PHASES.index("stick")]).max(initial=0.0) < 1e-12
    # the slip over the cycle is the velocity
    from feederscrew.conveying import steady

    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    made = slip[-1] / (2.0 * np.pi * drawn.time[-1])
    assert made == pytest.approx(out[steady.VELOCITY], rel=1e-9)


@pytest.mark.parametrize(("stroke", "period"), [("0.25", 1), ("0.51", 2), ("0.69", 3)])
def test_the_slowest_and_the_fastest_period_are_those_of_the_trace(stroke, period):
    found = answer.answer(bowls.read(None, (f"drive.amplitude={stroke} mm", "restitution=0.3")))
    drawn = trace(found.setting)
    slip = drawn.part_along - drawn.plate_along
    single = np.diff(np.interp(np.arange(round(drawn.time[-1]) + 1), drawn.time, slip)) / (2.0 * np.pi)
    ends = np.array([found.slowest, found.fastest]) / found.speed
    assert found.period == period and ends == pytest.approx([single.min(), single.max()], rel=1e-6)
    assert found.slowest <= found.velocity <= found.fastest
    assert (found.slowest == found.fastest) == (period == 1)


def test_keys_of_the_drive_and_of_bristles_reach_the_kernel():
    keys = ("drive.phase=20 deg", "drive.second_harmonic=0.3", "drive.second_harmonic_phase=40 deg")
    setting = answer.answer(
        bowl(*keys, "friction.static_backward=0.9", "friction.kinetic_backward=0.8")
    ).setting
    assert (setting.lead, setting.second, setting.second_phase) == pytest.approx((-20 * DEG, 0.3, 40 * DEG))
    assert (setting.static, setting.static_back, setting.kinetic_back) == (0.6, 0.9, 0.8)


@pytest.mark.parametrize("phase", [0, 20, 75])
def test_half_a_turn_of_the_phase_sends_a_part_the_other_way_on_a_level_track(phase):
    there, back = (
        answer.answer(bowl("track.climb=0 deg", "drive.amplitude=0.1 mm", f"drive.phase={x} deg")).velocity
        for x in (phase, phase - 180)
    )
    assert back == pytest.approx(-there, rel=1e-10)
    assert abs(there) > 1e-4


def test_a_cell_at_rest_has_no_throw_number():
    strokes = np.array([[0.0, 0.05e-3]])
    angles = np.radians([[20.0], [40.0]])
    varied = {"drive.amplitude": strokes, "drive.vibration_angle": angles}
    found = answer.cells(bowls.swept(bowls.settings(), varied))["throw_number"]
    assert (found[:, 0] == 0.0).all()
    assert (found[:, 1] > 0.1).all()


def test_cells_and_answers_agree_on_an_uneven_drive():
    keys = (
        "drive.second_harmonic=0.3",
        "drive.phase=30 deg",
        "friction.static_backward=0.9",
        "restitution=0",
    )
    settings = bowls.settings(None, keys)
    strokes = np.array([0.03e-3, 0.05e-3, 0.2e-3])
    found = answer.cells(bowls.swept(settings, {"drive.amplitude": strokes}))
    for k, stroke in enumerate(strokes):
        alone = answer.answer(bowls.read(None, (*keys, f"drive.amplitude={stroke * 1e3} mm")))
        assert found["velocity"][k] == pytest.approx(alone.velocity, rel=1e-9)
        assert answer.SWEEP_REGIMES[found["regime"][k]] == alone.regime
        margins = alone.margins
        if alone.regime != "hop":
            assert (margins["forward"] < 0.0) == (alone.regime in ("forward", "both"))
            assert (margins["backward"] < 0.0) == (alone.regime in ("backward", "both"))
        assert found["throw_number"][k] == pytest.approx(alone.throw_number)


def test_an_elliptical_drive_is_not_followed_inwards():
    with pytest.raises(ConfigError, match="not a screw motion"):
        answer.inwards(bowl("drive.phase=20 deg"))


@pytest.fixture(scope="module")
def settings():
    box = random_settings(40, np.random.default_rng(8))
    return np.array([plain(*row, restitution) for row in box for restitution in (0.0, 0.4)])


def test_threads_change_nothing(settings):
    many = np.tile(settings, (8, 1))
    np.testing.assert_array_equal(answer.sweep(many, workers=3), answer.sweep(many, workers=1))


def test_every_status():
    rows = [plain(0.5, 0.5, 0.0, 0.3), plain(4.5, 0.5236, 0.0, 0.3, 0.6), plain(2.0, 0.5, 0.35, 0.3)]
    found = answer.sweep(np.array(rows))[:, steady.STATUS]
    assert [steady.STATUSES[int(code)] for code in found] == list(steady.STATUSES)


def test_a_compiled_kernel_is_kept(settings):
    answer.sweep(settings[:1])
    assert answer.sweep_compiled()


def test_faults_of_a_row(settings):
    wrong = settings.copy()
    wrong[3, OperatingPoint._fields.index("kinetic")] = 2.0
    with pytest.raises(ValueError, match="kinetic friction is above static"):
        answer.sweep(wrong)
    with pytest.raises(ValueError, match="shape"):
        answer.sweep(settings[:, :5])
