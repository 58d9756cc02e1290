"""Second harmonic and elliptical drive: zeros, a general solver, invariances, the level ratchet."""

import math

import numpy as np
import pytest
from conveying_agreement import agreed
from conveying_reference import Reference, random_settings

import feederscrew as fs
from feederscrew.conveying import answer, steady, waves
from feederscrew.conveying.operating_point import OperatingPoint, plain
from feederscrew.conveying.waves import PERIOD_RAD, above, harmonic, value
from feederscrew.mechanics import limits
from feederscrew.mechanics.limits import effective

DEG = math.pi / 180.0


def travel_of(setting):
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    return out


def random_waves(count):
    rng = np.random.default_rng(4)
    for level, sine, cosine, weight, phase in rng.normal(size=(count, 5)):
        second = math.exp(2.0 * weight)
        yield waves.Wave(level, sine, cosine, second * math.cos(phase), second * math.sin(phase))


def test_zeros_and_bends_are_all_there():
    """A dense sampling sees as many sign changes, at the same places."""
    angles = np.linspace(0.0, PERIOD_RAD, 4001)
    for wave in random_waves(100):
        for one, found in ((waves.slope(wave), waves.find_bends(wave)), (wave, None)):
            if found is None:
                found = waves.crossings(wave, waves.find_bends(wave), 0)
            found = found[np.isfinite(found)]
            sampled = np.array([waves.height(one, x) for x in angles]) > 0.0
            seen = angles[np.flatnonzero(sampled[1:] != sampled[:-1])] + 0.5 * angles[1]
            assert len(found) == len(seen)
            np.testing.assert_allclose(np.sort(found), seen, rtol=0, atol=0.51 * angles[1])
            assert max((abs(waves.height(one, x)) for x in found), default=0.0) < 1e-14 * 1e3


def test_rises_and_falls_alternate():
    crossing = [a for a in map(harmonic, random_waves(60)) if a.rises[0] < math.inf]
    assert len(crossing) > 30
    for a in crossing:
        for angle in np.linspace(0.0, 6.2, 32):
            assert above(a, angle) == (value(a, angle) > 0.0)


def test_a_touched_zero_is_no_crossing():
    wave = waves.Wave(-1.0, 1.0, 0.0, 0.0, 0.0)  # sin - 1
    assert np.isinf(waves.crossings(wave, waves.find_bends(wave), 0)).all()


def test_no_second_harmonic_is_the_plain_drive():
    for row in random_settings(40, np.random.default_rng(6)):
        one = plain(*row, 0.2)
        other = one._replace(second=0.0, second_phase=1.0)
        np.testing.assert_array_equal(travel_of(one), travel_of(other))


def test_a_vanishing_first_harmonic_leaves_a_plain_drive_of_twice_the_frequency():
    share, compared = 1e9, 0
    for row in random_settings(30, np.random.default_rng(7)):
        alone = travel_of(plain(*row))
        both = travel_of(plain(row[0] / (4.0 * share), *row[1:])._replace(second=share, second_phase=0.0))
        if alone[steady.PERIOD] == both[steady.PERIOD] == 1:
            compared += 1
            assert both[steady.VELOCITY] / (2.0 * share) == pytest.approx(alone[steady.VELOCITY], abs=1e-8)
    assert compared > 10


@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_random_settings_with_everything(restitution):
    rng, results, hops = np.random.default_rng(11), [], 0
    for ratio, angle, climb, kinetic in random_settings(20, rng):
        more, bank, wall, lead, bristles, share, phase, turn = rng.uniform(
            (0, 0, 0, -1, 1, 0.05, -3, -0.5), (0.3, 0.3, 0.3, 1, 2, 0.6, 3, 1.5)
        )
        pair, back = (kinetic + more, kinetic), (bristles * kinetic + more, bristles * kinetic)
        ratio = ratio / (1.0 + 4.0 * share)
        level = [float(effective(mu, wall, bank)) for mu in (*pair, *back)]
        setting = OperatingPoint(ratio, angle, climb, *level, restitution, lead, share, phase, turn)
        second = (share, phase, turn)
        reference = Reference(ratio, angle, climb, *pair, restitution, bank, wall, lead, back, second)
        results.append(agreed(setting, reference))
        hops += bool(results[-1]) and travel_of(setting)[steady.HOPS] > 0.0
    assert results.count(True) >= 14
    assert results.count(False) == 0
    assert hops >= 3


def test_compiled_equals_plain():
    rng = np.random.default_rng(12)
    rows = [
        plain(*row, restitution)._replace(lead=lead, second=share, second_phase=phase, second_turn=turn)
        for row in random_settings(6, rng)
        for restitution in (0.0, 0.4)
        for lead, share, phase, turn in rng.uniform((-3, 0, -3, 0), (3, 1, 3, 1), (1, 4))
    ]
    for row, setting in zip(answer.sweep(np.array(rows)), rows, strict=True):
        out = travel_of(setting)
        if out[steady.STATUS] == steady.PERIODIC and out[steady.HIGH] - out[steady.LOW] < 1e-9:
            np.testing.assert_allclose(row, out, rtol=1e-9, atol=1e-11)


def test_a_second_harmonic_carries_a_part_along_a_level_track():
    """Shaken to and fro along a level track, a part stays where it is; an uneven motion ratchets it on."""
    even = plain(1.5, 0.0, 0.0, 0.4)
    assert travel_of(even)[steady.VELOCITY] == pytest.approx(0.0, abs=1e-12)
    uneven = even._replace(second=0.3, second_phase=0.5 * math.pi)
    velocity = travel_of(uneven)[steady.VELOCITY]
    assert abs(velocity) > 0.05
    other = travel_of(uneven._replace(second_phase=-0.5 * math.pi))
    assert other[steady.VELOCITY] == pytest.approx(-velocity, rel=1e-12)


def test_two_modes_that_swing_apart_make_an_asymmetric_feeder():
    """A second mode along the track alone ratchets as far either way; one with a normal part does not."""
    level = plain(1.5, 0.0, 0.0, 0.4)._replace(second=0.3, second_turn=30 * DEG)
    ahead, behind = (
        travel_of(level._replace(second_phase=sign * 0.5 * math.pi))[steady.VELOCITY] for sign in (1, -1)
    )
    assert ahead * behind < 0.0 and abs(ahead + behind) > 0.02


def everything():
    drive = {"lead": 0.6, "second": 0.35, "second_phase": 1.1, "second_turn": 0.4}
    return plain(1.1, 25 * DEG, 3 * DEG, 0.35)._replace(static_back=0.6, kinetic_back=0.5, **drive)


def test_mirror():
    up = everything()
    down = up._replace(
        **{
            "angle": math.pi - up.angle,
            "second_turn": -up.second_turn,
            "climb": -up.climb,
            "static": up.static_back,
            "kinetic": up.kinetic_back,
        },
        **{"static_back": up.static, "kinetic_back": up.kinetic},
    )
    assert travel_of(down)[steady.VELOCITY] == pytest.approx(-travel_of(up)[steady.VELOCITY], rel=1e-12)


def test_limits_of_slip_of_any_drive():
    """Friction at the limit rides, a little less slips; without extras they are the closed forms."""
    setting = everything()._replace(ratio=0.5)
    forward, backward = answer.limits_of_slip(setting)
    for name, limit, phase in (("static", forward, 1), ("static_back", backward, 2)):
        kinetic = name.replace("static", "kinetic")
        held = setting._replace(static=9.0, static_back=9.0, kinetic=0.2, kinetic_back=0.2)
        above_it = held._replace(**{name: limit * (1.0 + 1e-12), kinetic: 0.2})
        below_it = held._replace(**{name: limit * (1.0 - 1e-9), kinetic: 0.2})
        assert travel_of(above_it)[steady.FRACTIONS + phase] == 0.0
        assert travel_of(below_it)[steady.FRACTIONS + phase] > 0.0
    plain_one = setting._replace(lead=0.0, second=0.0)
    barely = plain_one._replace(second=1e-300)
    assert answer.limits_of_slip(barely) == pytest.approx(answer.limits_of_slip(plain_one), rel=1e-12)


def test_regimes_and_throw_numbers_of_a_plain_drive_are_the_closed_forms():
    for row in random_settings(60, np.random.default_rng(3)):
        ratio, angle, climb, friction = row
        found = travel_of(plain(*row))
        assert found[steady.THROW] == pytest.approx(
            float(limits.throw_number(ratio, angle, climb)), rel=1e-14
        )
        assert found[steady.REGIME] == limits.regimes(ratio, angle, friction, climb=climb)


def test_throw_number_is_where_hops_begin():
    setting = everything()._replace(static=5.0, static_back=5.0)
    throw = travel_of(setting)[steady.THROW]
    for share, hops in ((1.0 - 1e-9, False), (1.0 + 1e-6, True)):
        found = travel_of(setting._replace(ratio=setting.ratio * share / throw))
        assert (found[steady.FRACTIONS + 3] > 0.0) == hops


def test_a_second_mode_along_the_first_is_a_second_harmonic_of_the_same_direction():
    """An invariance: the key that names the direction of the first mode changes nothing; another one does."""
    mode = {"vibration_angle": 0.4, "second_harmonic": 0.3, "second_harmonic_phase": 1.0}

    def velocity(**more):
        return fs.convey(fs.read_bowl(), **mode, **more).answer.velocity

    assert velocity(second_harmonic_angle=0.4) == velocity()
    assert velocity(second_harmonic_angle=0.7) != velocity()


@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_random_settings(restitution):
    results = []
    for ratio, angle, climb, friction in random_settings(20, np.random.default_rng(2)):
        setting = plain(ratio, angle, climb, friction, restitution)
        results.append(agreed(setting, Reference(ratio, angle, climb, friction, friction, restitution)))
    assert results.count(True) >= 14
    assert results.count(False) == 0


def test_every_other_parameter():
    rng, results = np.random.default_rng(3), []
    for ratio, angle, climb, kinetic in random_settings(12, rng):
        more, bank, wall, lead, bristles = rng.uniform((0, 0, 0, -1, 1), (0.3, 0.3, 0.3, 1, 2))
        pair, back = (kinetic + more, kinetic), (bristles * kinetic + more, bristles * kinetic)
        level = [float(effective(mu, wall, bank)) for mu in (*pair, *back)]
        setting = OperatingPoint(ratio, angle, climb, *level, 0.0, lead)
        reference = Reference(setting.ratio, angle, climb, *pair, 0.0, bank, wall, lead, back)
        results.append(agreed(setting, reference))
    assert results.count(True) >= 8
    assert results.count(False) == 0
