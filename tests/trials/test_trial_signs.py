"""Each sign and each coefficient of the trial's mechanics, where a straight, level, even fixture hides it."""

from dataclasses import replace

import block_rides
import numpy as np
import pytest
import shapes
from block_rides import laid, ridden

from feederscrew import bowl as bowls
from feederscrew.arrivals.kernel import body
from feederscrew.trials import part_poses, runs, shape, staging
from feederscrew.trials.kernel import steps, track_contacts
from feederscrew.trials.runs import workspace_of

OWN = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "friction.static_backward=0.25", "friction.kinetic_backward=0.2",
    "friction.wall=0.7", "track.radius=150 mm", "track.width=40 mm", "track.climb=2 deg", "track.bank=3 deg",
]  # fmt: skip
PART = shapes.part(shapes.prism([(0, 0), (17, 0), (17, 6), (6, 9), (0, 9)], 4))  # without a symmetry
BOWL = bowls.read(None, OWN)
SOLID, LENGTH, _ = shape.solid_of(PART)
BOTH_WAYS = pytest.mark.parametrize(("ahead", "friction"), [(1.0, 0.4), (-1.0, 0.2)])


def still(**track):
    return block_rides.still(BOWL, **track)


def lying(bowl, aside=None, ahead=0.0):
    """The part flat on the track at the wall, or that far off it, going ahead."""
    one = min(block_rides.lying(PART, bowl), key=lambda one: one.height)
    state = laid(PART, one, bowl, place=0.1, aside=aside or 0.0)
    state = state if aside else part_poses.set_play(state, SOLID, bowl.track, LENGTH, 0.0)
    state[body.VX] = ahead
    return state


@BOTH_WAYS
def test_a_part_slides_as_far_as_the_friction_of_its_direction_lets_it(ahead, friction):
    bowl = still(climb=0.0, bank=0.0, radius=50.0)
    known, ride = ridden(PART, bowl, lying(bowl, 5e-3, ahead), 0.3)
    assert ride.distances[0] == pytest.approx(ahead * known.length * 0.5 / friction, rel=0.01)


@pytest.mark.parametrize("wall", [0.0, 0.7])
def test_floor_and_upright_wall_brake_on_a_bank(wall):
    """The friction of a level track of mu / cos(bank) + mu_w tan(bank)."""
    bank = np.radians(12.0)
    bowl = still(climb=0.0, bank=bank, radius=50.0)
    bowl = replace(bowl, friction=replace(bowl.friction, wall=wall))
    known, ride = ridden(PART, bowl, lying(bowl, ahead=0.8), 0.3)
    friction = 0.4 / np.cos(bank) + wall * np.tan(bank)
    assert ride.distances[0] == pytest.approx(known.length * 0.5 * 0.64 / friction, rel=0.03)


@pytest.mark.parametrize("bank", [-10.0, 0.0, 10.0])
def test_the_wall_stands_upright(bank):
    """A part touches it with its upper edge where the track falls towards it, else with its lower."""
    state = lying(still(bank=np.radians(bank)))
    spots = state[:3] + SOLID.corners @ part_poses.matrix(state).T
    off = BOWL.track.radius - LENGTH * np.hypot(spots[:, 0], BOWL.track.radius / LENGTH - spots[:, 1])
    height = LENGTH * spots[:, 2]
    gap = off - height * np.tan(np.radians(bank))
    assert gap.min() == pytest.approx(0.0, abs=3e-6)
    assert (height[np.argmin(gap)] > 2e-3) == (bank > 0.0) or bank == 0.0


def test_a_part_in_the_air_keeps_its_attitude_while_the_bowl_turns():
    """In the bowl's frame it turns back: by the change of the bowl's own rate, about the bowl's axis."""
    state, drive, track = lying(BOWL, aside=5e-3), BOWL.drive, BOWL.track
    state[body.Z] += 5.0
    known, ride = ridden(PART, BOWL, state, 0.25 / drive.frequency)
    end = ride.states[0]
    rates = part_poses.matrix(end) @ end[body.W : body.W + 3] / known.unit
    speed = drive.amplitude * 2.0 * np.pi * drive.frequency * np.cos(drive.vibration_angle)
    theta = np.arctan2(state[0], track.radius / LENGTH - state[1])
    inwards = np.array([-np.sin(theta), np.cos(theta), 0.0])
    axis = np.sin(track.bank) * inwards + np.array([0.0, 0.0, np.cos(track.bank)])
    np.testing.assert_allclose(rates, speed / track.radius * axis, rtol=0.01, atol=2e-3)


@BOTH_WAYS
@pytest.mark.parametrize("share", [0.3, 0.7])
def test_a_part_comes_to_a_stand_as_soon_as_friction_has_taken_its_speed(ahead, friction, share):
    bowl = still(climb=0.0, bank=0.0, radius=50.0)
    known = runs.setting(SOLID, LENGTH, bowl)
    every = block_rides.lying(PART, bowl)
    surface, step = runs.surface_of(known, staging.stage_bare_track(bowl.track, every, 0.5)), known.floor.step
    work = workspace_of(SOLID, surface, 1)
    # what it takes in that share of a step
    work.states[0] = lying(bowl, 5e-3, ahead * share * friction * step)
    steps.begin_step(surface, work, (0, 1))
    reach = steps.reach_ahead(SOLID, work.states[0], step)
    track_contacts.find_contacts(surface, SOLID, work, 0, reach)
    _, _, stands = steps.push_island(surface, SOLID, known.floor, work, (0, 1), 0.0, step)
    assert stands == pytest.approx(share, rel=0.02)
