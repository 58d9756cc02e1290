"""From a bowl to an answer in SI units: published demonstration, radius, sensitivity, traces, phase, hops."""

import doctest
import importlib.util
import math
from dataclasses import replace
from pathlib import Path

import awkward
import numpy as np
import pytest
from conveying_reference import Reference, random_settings
from mechanics_samples import box_posture
from scipy.optimize import brentq

from feederscrew import bowl as bowls
from feederscrew.base.errors import ConfigError
from feederscrew.bowl.record import Friction
from feederscrew.motion import conveying as answer
from feederscrew.motion import steady, track_balance
from feederscrew.motion.floor_balance import HOP
from feederscrew.motion.hop import HOP_MARGIN_M, Hop, hop, remark
from feederscrew.motion.operating_point import FLIGHT, PHASES, Numbers, OperatingPoint, plain, with_numbers
from feederscrew.motion.slide import slide
from feederscrew.motion.steady import trace
from feederscrew.motion.track_balance import seat

DEG = np.pi / 180.0
DOCS = Path(__file__).parents[2] / "docs"
NO_STEADY_STATE = (
    "drive.phase: has no steady velocity at any value: the part slides down the track without stopping"
    " - lower track.climb, or raise the friction"
)
HOPPING = bowls.read(None, ("track.climb=3 deg", "friction.static=0.6", "restitution=0.3"))


def bowl(*overrides):
    return bowls.read(None, ("restitution=0", "track.climb=3 deg", "gravity=9.81 m/s2", *overrides))


def driven(frequency, stroke, angle, friction):
    return bowl(f"drive.frequency={frequency} Hz", f"drive.peak_to_peak={stroke} mm",
                f"drive.vibration_angle={angle} deg", f"friction.static={friction}")  # fmt: skip


def velocity(own):
    return answer.answer(own).velocity


@pytest.mark.parametrize(
    ("setting", "wanted", "half_digit"),
    [
        ((50, 1.0, 15, 0.2), -30, 0.5), ((50, 1.0, 15, 0.4), 12.1, 0.05), ((50, 1.0, 25, 0.4), 103.7, 0.05),
        ((50, 2.0, 15, 0.2), 282, 0.5), ((60, 1.5, 25, 0.2), -46, 0.5), ((120, 0.3, 25, 0.4), 85, 0.5),
    ],
)  # fmt: skip
def test_demonstration_velocities(setting, wanted, half_digit):
    assert velocity(driven(*setting)) * 1e3 == pytest.approx(wanted, abs=half_digit)


def banked(*more):
    """The setting whose velocity independent code has by three-dimensional vectors: 15.28 mm/s."""
    drive = ("drive.amplitude=0.15 mm", "drive.frequency=50 Hz", "drive.vibration_angle=25 deg")
    surface = ("friction.static=0.4", "friction.kinetic=0.4", "friction.wall=0.8")
    return bowl(*drive, *surface, "track.climb=2 deg", "track.bank=12 deg", *more)


def test_a_banked_track_with_a_wall_is_a_level_one_of_another_friction_up_to_its_limit():
    own = answer.answer(banked())
    assert own.setting.static == pytest.approx(0.57898, abs=5e-6)
    assert own.velocity == pytest.approx(15.275e-3, abs=0.5e-6)
    level = answer.answer(banked("track.bank=0 deg", f"friction.static={own.setting.static!r}",
                                 f"friction.kinetic={own.setting.kinetic!r}"))  # fmt: skip
    assert own.velocity == level.velocity
    assert (own.regime, own.throw_number) == (level.regime, level.throw_number)
    here = banked("drive.amplitude=0.05 mm")
    angle, climb, bank = here.drive.vibration_angle, here.track.climb, here.track.bank
    level = (0.5030379 * np.cos(angle) - np.sin(climb)) / (np.cos(climb) - 0.5030379 * np.sin(angle))
    limit = answer.answer(here).mu_forward
    assert limit == pytest.approx(level * np.cos(bank) - 0.8 * np.sin(bank), rel=1e-6)
    for friction, slips in ((limit * 1.001, False), (limit * 0.999, True)):
        surface = (f"friction.static={friction}", "friction.kinetic=0.01")
        own = answer.answer(banked("drive.amplitude=0.05 mm", *surface))
        assert (own.fractions["forward"] > 0.0) == (own.margins["forward"] < 0.0) == slips


def test_slide_and_track_take_the_bank_as_convey_does():
    """One wall for all: the same limits, regime and throw number, and contact lost at the same drive."""
    for stroke in (0.05, 0.1, 0.3):
        here = banked(f"drive.amplitude={stroke} mm")
        own, (chart,) = answer.answer(here), slide(here).maps
        assert chart.at_bowl["throw_number"] == pytest.approx(own.throw_number, rel=1e-12)
        assert chart.regime == own.regime
        if own.regime != "hop":
            limits = (chart.at_bowl["mu_forward"], chart.at_bowl["mu_backward"])
            assert limits == pytest.approx((own.mu_forward, own.mu_backward), rel=1e-9)
    place = seat(box_posture(height=0.0005), 0.0, np.array([[-0.015, -0.005], [0.015, -0.005]]), 1.0)
    for share, hops in ((0.999, False), (1.001, True)):
        there = banked(f"drive.amplitude={0.15 * share / 0.6381678} mm")
        state = track_balance.motion(place, there, np.array([0.5 * np.pi])).state
        assert bool((state == HOP).any()) == hops


@pytest.mark.parametrize(
    ("call", "overrides", "line"),
    [
        (answer.answer, ["drive.amplitude=0 mm"],
         "drive.amplitude: is 0 mm, so nothing moves - give more than 0 mm"),
        (answer.answer, ["drive.direction=5 deg"],
         "drive.direction: is not 0 deg, but a track can only convey along itself"
         " - leave it out: it is for the floor (feeder floor)"),
        (answer.inwards, ["drive.phase=20 deg"], "SCREW"),
        (answer.best_phase, ["track.climb=30 deg", "friction.static=0.3"], NO_STEADY_STATE),
    ],
)  # fmt: skip
def test_bowls_that_convey_nothing(call, overrides, line):
    with pytest.raises(ConfigError) as caught:
        call(bowl(*overrides))
    text = str(caught.value)
    assert text == line if line != "SCREW" else "not a screw motion" in text


def test_what_is_made_of_a_bowl():
    here = driven(50, 1.0, 25, 0.4)
    inner = answer.at_radius(here, here.track.radius * np.array([0.5, 1.0]))
    angle = inner.drive.vibration_angle + here.track.climb
    assert np.tan(angle[0]) == pytest.approx(2.0 * np.tan(angle[1]))
    assert np.ptp(inner.drive.amplitude * np.sin(angle)) < 1e-9 * here.drive.amplitude
    assert inner.drive.amplitude[1] == pytest.approx(here.drive.amplitude)
    assert inner.drive.vibration_angle[1] == pytest.approx(here.drive.vibration_angle)
    drive = ("drive.phase=20 deg", "drive.second_harmonic=0.3", "drive.second_harmonic_phase=40 deg")
    surface = ("friction.static_backward=0.9", "friction.kinetic_backward=0.8")
    setting = answer.answer(bowl(*drive, *surface)).setting
    assert (setting.lead, setting.second, setting.second_phase) == pytest.approx((-20 * DEG, 0.3, 40 * DEG))
    assert (setting.static, setting.static_back, setting.kinetic_back) == (0.6, 0.9, 0.8)
    here = driven(50, 1.0, 25, 0.4)
    nearby = answer.sensitivity(here)
    assert nearby["amplitude"].more == pytest.approx(velocity(driven(50, 1.1, 25, 0.4)))
    assert nearby["friction"].less == pytest.approx(velocity(driven(50, 1.0, 25, 0.36)))
    assert nearby["angle"].more == pytest.approx(velocity(driven(50, 1.0, 27.5, 0.4)))
    assert answer.friction_doubt(here).more == pytest.approx(velocity(driven(50, 1.0, 25, 0.48)))
    assert answer.Neighbours(0.9, 1.1).elasticity(1.0) == pytest.approx(1.0)
    assert np.isnan(answer.Neighbours(0.0, 0.1).elasticity(0.0))


@pytest.mark.parametrize(
    "setting", [plain(0.6, 0.5, 0.05, 0.3), plain(4.0, 0.6, 0.0, 0.3), plain(7.0, 0.6, 0.0, 0.3)]
)
def test_trace_is_one_cycle(setting):
    curve, out = trace(setting), np.empty(steady.COLUMNS)
    assert (np.diff(curve.time) >= 0.0).all()
    assert curve.time[0] == 0.0
    assert curve.time[-1] == pytest.approx(round(curve.time[-1]))
    gap = curve.part_normal - curve.plate_normal
    assert (gap > -1e-12).all()
    assert (gap[curve.phase != FLIGHT] == 0.0).all()
    assert gap[-1] == pytest.approx(gap[0], abs=1e-9)
    slip = curve.part_along - curve.plate_along
    assert np.abs(np.diff(slip)[curve.phase[1:] == PHASES.index("stick")]).max(initial=0.0) < 1e-12
    steady.survey(setting, out, steady.memory())  # the slip over the cycle is the velocity
    assert slip[-1] / (2.0 * np.pi * curve.time[-1]) == pytest.approx(out[steady.VELOCITY], rel=1e-9)


@pytest.mark.parametrize(("stroke", "period"), [("0.25", 1), ("0.51", 2), ("0.69", 3)])
def test_the_slowest_and_the_fastest_period_are_those_of_the_trace(stroke, period):
    own = answer.answer(bowls.read(None, (f"drive.amplitude={stroke} mm", "restitution=0.3")))
    curve = trace(own.setting)
    slip = curve.part_along - curve.plate_along
    single = np.diff(np.interp(np.arange(round(curve.time[-1]) + 1), curve.time, slip)) / (2.0 * np.pi)
    ends = np.array([own.slowest, own.fastest]) / own.speed
    assert own.period == period and ends == pytest.approx([single.min(), single.max()], rel=1e-6)
    assert own.slowest <= own.velocity <= own.fastest
    assert (own.slowest == own.fastest) == (period == 1)


def test_cells_of_a_map():
    strokes, angles = np.array([[0.0, 0.05e-3]]), np.radians([[20.0], [40.0]])
    varied = {"drive.amplitude": strokes, "drive.vibration_angle": angles}
    throw = answer.cells(bowls.swept(bowls.settings(), varied))["throw_number"]
    assert (throw[:, 0] == 0.0).all() and (throw[:, 1] > 0.1).all()  # none at rest
    slippery = bowls.settings(None, ("friction.kinetic=0.5",))
    varied = bowls.swept(slippery, {"friction.static": np.array([0.6, 0.4])})
    with pytest.raises(ConfigError, match=r"friction\.kinetic: is above friction\.static"):
        answer.cells(varied)
    # Cells and answers agree on an uneven drive.
    drive = ("drive.second_harmonic=0.3", "drive.phase=30 deg")
    keys = (*drive, "friction.static_backward=0.9", "restitution=0")
    strokes = np.array([0.03e-3, 0.05e-3, 0.2e-3])
    cells = answer.cells(bowls.swept(bowls.settings(None, keys), {"drive.amplitude": strokes}))
    for k, stroke in enumerate(strokes):
        alone = answer.answer(bowls.read(None, (*keys, f"drive.amplitude={stroke * 1e3} mm")))
        assert cells["velocity"][k] == pytest.approx(alone.velocity, rel=1e-9)
        assert answer.SWEEP_REGIMES[cells["regime"][k]] == alone.regime
        assert cells["throw_number"][k] == pytest.approx(alone.throw_number)
        if alone.regime != "hop":
            for way in ("forward", "backward"):
                assert (alone.margins[way] < 0.0) == (alone.regime in (way, "both"))


def test_sweeps_of_the_kernel():
    """Threads change nothing, each status occurs, the kernel is kept, faults of a row are refused."""
    box = random_settings(40, np.random.default_rng(8))
    settings = np.array([plain(*row, restitution) for row in box for restitution in (0.0, 0.4)])
    many = np.tile(settings, (8, 1))
    np.testing.assert_array_equal(answer.sweep(many, workers=3), answer.sweep(many, workers=1))
    assert answer.sweep_compiled()
    rows = [plain(0.5, 0.5, 0.0, 0.3), plain(4.5, 0.5236, 0.0, 0.3, 0.6), plain(2.0, 0.5, 0.35, 0.3)]
    codes = answer.sweep(np.array(rows))[:, steady.STATUS]
    assert [steady.STATUSES[int(code)] for code in codes] == list(steady.STATUSES)
    settings[3, OperatingPoint._fields.index("kinetic")] = 2.0
    with pytest.raises(ValueError, match="kinetic friction is above static"):
        answer.sweep(settings)
    with pytest.raises(ValueError, match="shape"):
        answer.sweep(settings[:, :5])


def test_the_pages_are_as_computed(monkeypatch):
    """Each example of docs/method/conveying.md prints what the page says; samples of what is drawn hold."""
    examples = doctest.testfile(str(DOCS / "method/conveying.md"), module_relative=False)
    assert examples.attempted > 8 and examples.failed == 0
    monkeypatch.syspath_prepend(DOCS)
    script = importlib.import_module("conveying_map")
    for row in script._row(0.0, 30, 0.4), script._row(0.2, 40, 0.8):
        assert row in script.METHOD.read_text()
    assert script.phases() in (DOCS / "conveying.md").read_text()
    chart, out = np.loadtxt(DOCS / "conveying_map.csv", delimiter=",", skiprows=1), np.empty(steady.COLUMNS)
    assert chart.shape == (3500, 5)
    for coupling, steepness, throw, restitution, wanted in chart[chart[:, 3] == 0.0][::97]:
        setting = with_numbers(Numbers(coupling, steepness, throw, restitution), 0.5)
        steady.survey(setting, out, steady.memory())
        assert abs(out[steady.VELOCITY] / np.cos(setting.angle) - wanted) < 5e-3  # four digits of coupling


def level(own, share=1.0):
    """The bowl without bank on the floor that holds as much: mu / cos(bank) + mu_wall tan(bank)."""
    mu, bank = own.friction, own.track.bank
    static, kinetic, *back = (
        float(share * (coefficient / np.cos(bank) + mu.wall * np.tan(bank)))
        for coefficient in (mu.static, mu.kinetic, mu.static_backward, mu.kinetic_backward)
    )
    surfaces = Friction(static, kinetic, mu.wall, *back)
    return replace(own, friction=surfaces, track=replace(own.track, bank=0.0))


@pytest.mark.parametrize("stroke", [0.17, 0.21])
def test_floor_and_wall_told_apart_by_a_general_solver_carry_a_part_as_fast(stroke):
    here = awkward.bowl(f"drive.amplitude={stroke} mm", "track.bank=14 deg")
    mu, drive, track = here.friction, here.drive, here.track
    rate = 2.0 * np.pi * drive.frequency
    other = Reference(
        drive.amplitude * rate**2 / here.gravity, drive.vibration_angle, track.climb, mu.static, mu.kinetic,
        bank=track.bank, wall=mu.wall, back=(mu.static_backward, mu.kinetic_backward),
    )  # fmt: skip
    own = answer.answer(here)
    assert own.period == 1 and own.throw_number < 1.0 and own.fractions["backward"] > 0.02
    assert own.velocity == pytest.approx(other.velocity(9, 1) * drive.amplitude * rate, rel=1e-5)


def test_friction_is_scaled_in_all_its_places():
    here = awkward.bowl("track.bank=14 deg")
    own, nearby = velocity(here), answer.sensitivity(here)["friction"]
    for share, there in ((1.0, own), (0.9, nearby.less), (1.1, nearby.more)):
        assert there == pytest.approx(velocity(level(here, share)), rel=1e-9)
    assert abs(nearby.less / own - 1.0) > 0.02  # or the shares would not matter
    here = awkward.bowl()
    other = answer.scaled(here, friction=0.5)
    mu = (other.friction.static, other.friction.kinetic, *other.friction.backward, other.friction.wall)
    assert mu == pytest.approx((0.25, 0.21, 0.31, 0.275, 0.135), rel=1e-12)
    assert replace(other, friction=here.friction) == here


def at_the_hop(friction, angle, *overrides):
    rise = 9.81 / (2.0 * np.pi * 50.0) ** 2 * (1 - 1e-9)
    drive = f"drive.amplitude={float(rise / np.sin(angle * DEG)) * 1e3!r} mm", "drive.frequency=50 Hz"
    track = "track.climb=0 deg", f"friction.static={friction}"
    return bowl(*drive, f"drive.vibration_angle={float(angle)!r} deg", *track, *overrides)


def share(own, speed):
    """Of the plate's greatest speed along the track."""
    return speed / (answer.greatest_speed(own) * np.cos(own.drive.vibration_angle))


def test_at_its_best_phase_the_velocity_hardly_depends_on_friction_and_angle():
    bowls_at = [at_the_hop(friction, angle) for friction in (0.2, 0.8) for angle in (10, 30)]
    best = [(own, answer.best_phase(own)) for own in bowls_at]
    quickest, straight = ([share(own, getattr(b, k)) for own, b in best] for k in ("velocity", "straight"))
    assert (min(quickest), max(quickest)) == pytest.approx((0.577, 0.673), abs=2e-3)
    assert (min(straight), max(straight)) == pytest.approx((0.08, 0.58), abs=6e-3)
    # It is the greatest of all answers.
    own = at_the_hop(0.3, 20, "track.climb=3 deg", "drive.phase=40 deg")  # its own phase does not matter
    best = answer.best_phase(own)
    phases = (best.phase, 0.0, best.phase + 2 * DEG, best.lowest, best.highest)
    at, straight, after, *edges = (velocity(answer.with_phase(own, x)) for x in phases)
    assert (best.velocity, best.straight) == pytest.approx((at, straight), rel=1e-9)
    assert best.velocity >= max(after, best.cells["velocity"].max())
    assert min(edges) >= 0.9 * best.velocity
    assert list(best.frictions) == list(answer.FRICTION_FACTORS)
    assert best.best_over_friction[2] == pytest.approx(best.velocity)
    lower = velocity(answer.scaled(answer.with_phase(own, best.phase), friction=0.5))
    assert best.best_over_friction[0] == pytest.approx(lower, rel=1e-9)


def bowl_at(throw, frequency=50.0, degrees=20.0):
    angle, omega = math.radians(degrees), 2.0 * math.pi * frequency
    amplitude = throw * HOPPING.gravity * math.cos(HOPPING.track.climb) / (omega**2 * math.sin(angle))
    drive = replace(HOPPING.drive, amplitude=amplitude, frequency=frequency, vibration_angle=angle)
    return replace(HOPPING, drive=drive)


@pytest.mark.parametrize("frequency", [50.0, 120.0])
@pytest.mark.parametrize("throw", [1.05, 1.3, 1.5, 1.8, 2.0, 2.3, 2.6, 3.0])
def test_a_hop_agrees_with_its_closed_form(throw, frequency):
    """Greatest gap [g cos(climb) / w^2] and duration [periods] of a flight between two plastic impacts."""
    start = math.asin(1.0 / throw)

    def gap(x):
        rise = throw * (math.cos(start) * (x - start) - math.sin(x) + math.sin(start))
        return rise - 0.5 * (x - start) ** 2

    last = start + 2.0 * math.pi
    top = brentq(lambda x: throw * (math.cos(start) - math.cos(x)) - (x - start), start + 1e-3, last)
    unit = HOPPING.gravity * math.cos(HOPPING.track.climb) / (2.0 * math.pi * frequency) ** 2
    own = hop(bowl_at(throw, frequency))
    assert own.height == pytest.approx(gap(top) * unit, rel=1e-7)
    assert own.duration == pytest.approx((brentq(gap, top, last) - start) / (2.0 * math.pi), rel=1e-7)


def test_hops_below_above_and_at_length():
    still = replace(HOPPING, drive=replace(HOPPING.drive, amplitude=0.0))
    assert hop(still) == hop(bowl_at(0.9)) == hop(bowl_at(1.0 - 1e-9)) == Hop(0.0, 0.0, 0.0)
    # At 2.6 and above a part hardly touches the track: what it makes in a period it flies.
    # v / f of 213 mm/s at 50 Hz, 20 deg, throw number 2.6 and without rebound
    assert hop(bowl_at(2.6)).flight == pytest.approx(4.27e-3, rel=0.01)
    flat, steep = (hop(bowl_at(2.6, degrees=degrees)) for degrees in (15.0, 30.0))
    assert flat.flight > 1.5 * steep.flight and flat.height == pytest.approx(steep.height)
    # At 6 a plastic part stays in the air for nearly two periods, in one flight.
    own = hop(bowl_at(6.0))
    assert 1.0 < own.duration < 2.0 and own.height > 3.0 * hop(bowl_at(3.0)).height
    plastic = velocity(replace(bowl_at(6.0), restitution=0.0))
    assert own.flight == pytest.approx(plastic * own.duration / 50.0, rel=0.1)
    # 0.38 mm at 50 Hz and throw number 2.3, a quarter of that at 100 Hz.
    (text,) = remark(bowl_at(2.3))
    assert hop(bowl_at(2.3)).height > HOP_MARGIN_M and "0.38 mm high and 3.5 mm far" in text
    assert remark(bowl_at(2.3, 100.0)) == remark(bowl_at(0.9)) == ()
