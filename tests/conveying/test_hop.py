"""How high and how far a part hops."""

import math
from dataclasses import replace

import pytest
from scipy.optimize import brentq

from feederscrew.bowl.reading import record, settings
from feederscrew.conveying.answer import answer
from feederscrew.conveying.hop import HOP_MARGIN_M, Hop, hop, remark

BOWL = record(settings(overrides=["track.climb=3 deg", "friction.static=0.6", "restitution=0.3"]))


def bowl_at(throw, frequency=50.0, degrees=20.0):
    """The bowl with a drive of a throw number."""
    angle = math.radians(degrees)
    omega = 2.0 * math.pi * frequency
    amplitude = throw * BOWL.gravity * math.cos(BOWL.track.climb) / (omega**2 * math.sin(angle))
    drive = replace(BOWL.drive, amplitude=amplitude, frequency=frequency, vibration_angle=angle)
    return replace(BOWL, drive=drive)


def closed_form(throw):
    """Greatest gap [g cos(climb) / w^2] and duration [periods] of a flight between two plastic impacts."""
    start = math.asin(1.0 / throw)

    def rising(x):
        return throw * (math.cos(start) - math.cos(x)) - (x - start)

    def gap(x):
        return (
            throw * (math.cos(start) * (x - start) - math.sin(x) + math.sin(start)) - 0.5 * (x - start) ** 2
        )

    top = brentq(rising, start + 1e-3, start + 2.0 * math.pi)
    return gap(top), (brentq(gap, top, start + 2.0 * math.pi) - start) / (2.0 * math.pi)


@pytest.mark.parametrize("frequency", [50.0, 120.0])
@pytest.mark.parametrize("throw", [1.05, 1.3, 1.5, 1.8, 2.0, 2.3, 2.6, 3.0])
def test_a_hop_agrees_with_its_closed_form(throw, frequency):
    height, duration = closed_form(throw)
    unit = BOWL.gravity * math.cos(BOWL.track.climb) / (2.0 * math.pi * frequency) ** 2
    own = hop(bowl_at(throw, frequency))
    assert own.height == pytest.approx(height * unit, rel=1e-7)
    assert own.duration == pytest.approx(duration, rel=1e-7)


def test_a_part_stays_on_the_track_below_the_throw_number_of_one():
    assert hop(bowl_at(0.9)) == hop(bowl_at(1.0 - 1e-9)) == Hop(0.0, 0.0, 0.0)
    still = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0))
    assert hop(still) == Hop(0.0, 0.0, 0.0)


def test_the_way_of_a_flight_is_about_that_of_a_period():
    """At 2.6 and above a part hardly touches the track: what it makes in a period it flies."""
    # v / f of 213 mm/s at 50 Hz, 20 deg, throw number 2.6 and without rebound
    assert hop(bowl_at(2.6)).flight == pytest.approx(4.27e-3, rel=0.01)
    flat, steep = (hop(bowl_at(2.6, degrees=degrees)) for degrees in (15.0, 30.0))
    assert flat.flight > 1.5 * steep.flight and flat.height == pytest.approx(steep.height)


def test_rebound_and_a_lead_do_not_change_the_height():
    """The motion along the normal is that of the plastic point mass, whatever goes on along the track."""
    own = bowl_at(1.8)
    lively = replace(own, restitution=0.6)
    led = replace(own, drive=replace(own.drive, phase=math.radians(-60.0)))
    assert hop(own) == hop(lively)
    assert hop(led).height == pytest.approx(hop(own).height)


def test_a_flight_over_several_periods_is_one_flight():
    """At 6 a plastic part stays in the air for nearly two periods."""
    own = hop(bowl_at(6.0))
    assert 1.0 < own.duration < 2.0
    assert own.height > 3.0 * hop(bowl_at(3.0)).height
    velocity = answer(replace(bowl_at(6.0), restitution=0.0)).velocity
    assert own.flight == pytest.approx(velocity * own.duration / 50.0, rel=0.1)


def test_a_hop_is_told_where_it_is_higher_than_a_margin():
    """0.38 mm at 50 Hz and throw number 2.3, a quarter of that at 100 Hz."""
    (said,) = remark(bowl_at(2.3))
    assert hop(bowl_at(2.3)).height > HOP_MARGIN_M and "0.38 mm high and 3.5 mm far" in said
    assert remark(bowl_at(2.3, 100.0)) == remark(bowl_at(0.9)) == ()
