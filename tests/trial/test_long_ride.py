"""A ride along bare track: what stays, turns or leaves, and the mix that arrives by hand."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
from block_rides import ALONG, ASPECTS, PART
from block_rides import BOWL as BLOCK_BOWL

from feederscrew.conveying import answer
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import long_ride
from feederscrew.trial.long_ride import LEFT, RideOfTrack

BOWL = replace(BLOCK_BOWL, track=replace(BLOCK_BOWL.track, radius=0.15, width=0.04, bank=np.radians(5.0)))


EVERY = orientations(PART, ASPECTS, BOWL.track)


def ride_of(entered, ended):
    """A ride of so many parts among four orientations."""
    ones, askew = np.ones(len(entered)), np.zeros(len(entered), bool)
    return RideOfTrack(tuple("PQRS"), np.array(entered), np.array(ended), askew, ones, ones)


def test_the_mix_that_arrives_is_that_of_the_parts_by_hand():
    """P stays in 3 of 4, one becomes R; of Q one becomes R, one leaves; R does not ride; S leaves."""
    ride, entering = (
        ride_of([0, 0, 0, 0, 1, 1, 3, 3], [0, 0, 0, 2, 2, LEFT, LEFT, LEFT]),
        [0.3, 0.4, 0.2, 0.1],
    )
    assert ride.counts.tolist() == [[3, 0, 1, 0, 0], [0, 0, 1, 0, 1], [0, 0, 0, 0, 0], [0, 0, 0, 0, 2]]
    assert ride.turned.tolist() == [True, True, False, True] and ride.rows == [0, 1, 3]
    arrive = np.array([0.3 * 0.75, 0.0, 0.3 * 0.25 + 0.4 * 0.5 + 0.2, 0.0])
    assert ride.arriving(np.array(entering)) == pytest.approx(arrive / arrive.sum())
    assert ride_of([0, 1], [0, 1]).arriving(np.array(entering)) == pytest.approx(entering)


def test_a_flat_block_rides_on_as_the_point_mass_and_stays_as_it_is(monkeypatch):
    """More than half a turn, where places along the wall begin again; the velocity is the closed form's."""
    monkeypatch.setattr(long_ride, "RIDE_S", 60.0)
    ride = long_ride.ride_of_track(PART, BOWL, EVERY, [ALONG], each=2, distance=0.55, run=RunSettings(3))
    assert ride.ended.tolist() == [ALONG, ALONG] and not ride.askew.any()
    assert ride.distances == pytest.approx(0.55, abs=0.01)
    assert ride.distances.min() / BOWL.track.radius > np.pi
    along_the_wall = answer.answer(BOWL).velocity * 150.0 / (150.0 - 6.0)  # its middle is 6 mm off the wall
    assert ride.distances / ride.seconds == pytest.approx(along_the_wall, rel=0.05)


def test_what_rolls_back_or_over_the_free_edge_has_left():
    """A roller across a track that climbs 5 deg rolls back; one along a track leaning outwards leaves it."""
    roller = shapes.part(shapes.cylinder(4, 12, 48))
    steep = replace(BOWL, track=replace(BOWL.track, climb=np.radians(5.0), bank=np.radians(0.0)))
    lying = orientations(roller, find(roller), steep.track)
    across = [k for k, one in enumerate(lying) if one.kind == "rolling" and one.length < 9e-3]
    ride = long_ride.ride_of_track(roller, steep, lying, across[:1], each=3, distance=0.2)
    assert ride.ended.tolist() == [LEFT] * 3 and (ride.distances < 0.0).all()


def test_a_ride_that_the_user_stops_decides_nothing():
    def stop(done, total):
        assert (done, total) == (1, 2)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        long_ride.ride_of_track(
            PART, BOWL, EVERY, [ALONG], each=1, distance=0.2, run=RunSettings(1, progress=stop)
        )
