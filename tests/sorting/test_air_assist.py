"""Air along the face of a blade: its jet, what it takes off, what it leaves, its value and its faults."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
import shapes
from on_track import device, lying, read

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices import pneumatics
from feederscrew.bowl.devices.air_assist import ASIDE_RAD, AirAssist, FaceForce
from feederscrew.bowl.devices.base import UNSURE
from feederscrew.bowl.devices.kinds import CostClass
from feederscrew.sorting import falling
from feederscrew.sorting.fates import course
from feederscrew.sorting.orientations import Hanging
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

GRAVITY, GRIP = 9.80665, 0.6
AIR = AirAssist(2e-3, 3e4, 8e-3)
# a block 20 x 12 mm and 16 mm high along the wall of a straight track: its side takes all of a jet
BOWL = bowls.read(None, ["track.radius=100 m", "track.bank=0 deg", "track.width=16 mm"])
BLOCK = shapes.part(shapes.box(20, 12, 16))


def block_along(bowl=BOWL):
    """The block on its broad face, along the wall, with the friction of the track."""
    every = lying(BLOCK, bowl.track)
    (one,) = [one for one in every if one.length > 19e-3 and 15e-3 < one.height < 17e-3]
    return replace(one, grip=GRIP)


def wiper(degrees, air=None, limit=8e-3):
    return device("wiper", limit=limit, sweep=math.radians(degrees), air=air)


def air_of(thrust, height=10e-3, nozzle=2e-3):
    return AirAssist(nozzle, pneumatics.pressure_for(nozzle, thrust), height)


@pytest.mark.parametrize("degrees", [15.0, 30.0, 60.0, 85.0])
@pytest.mark.parametrize("nozzle", [1e-3, 3e-3])
def test_the_side_of_the_jet_lies_on_the_face(degrees, nozzle):
    """The line from the mouth's edge at half the jet's angle to its axis goes through the face's foot."""
    heading = math.radians(degrees)
    jet = AirAssist(nozzle, 3e4, 8e-3).jet(0.05, heading)
    aim = math.atan2(jet.towards[1], jet.towards[0])
    assert jet.angle == pytest.approx(heading + math.radians(11.0))
    for way in (0.0, 0.03, 0.1):  # along the cone's side
        axis = np.array(jet.at[:2]) + way * np.array([math.cos(aim), math.sin(aim)])
        side = axis + (jet.radius + jet.spread * way) * np.array([math.sin(aim), -math.cos(aim)])
        off = (side - [0.05, 0.0])[1] * math.cos(heading) - (side - [0.05, 0.0])[0] * math.sin(heading)
        assert off == pytest.approx(0.0, abs=1e-9)
    # all of the mouth is within the wall, and its axis comes out before the blade
    assert jet.at[1] + jet.radius * abs(math.cos(aim)) == pytest.approx(0.0, abs=1e-12)
    assert jet.place < 0.05 and jet.at[2] == 8e-3
    assert jet.thrust == pneumatics.thrust(nozzle, 3e4) and math.isinf(jet.seconds)


@pytest.mark.parametrize("degrees", [30.0, 50.0, 70.0])
def test_the_jet_pushes_square_to_the_side_that_it_meets(degrees):
    """A side along the wall takes T sin(aim) inwards, of which the face turns sin a along itself."""
    one, heading = block_along(), math.radians(degrees)
    aim = heading + ASIDE_RAD
    inwards = AIR.thrust * math.sin(aim)
    first = AIR.at_face(one, heading, 5e-3)[0]
    assert first.along == pytest.approx(inwards * math.sin(heading), rel=0.02)
    assert first.off == pytest.approx(inwards * math.cos(heading), rel=0.02)
    assert first.down == pytest.approx(0.0, abs=1e-6 * AIR.thrust)


@pytest.mark.parametrize("degrees", [62.0, 70.0, 80.0])
def test_air_takes_off_what_friction_holds_at_a_steeper_face(monkeypatch, degrees):
    """T sin(aim) (sin a + 2 mu cos a) = 2 mu W (mu sin a - cos a) is twice what it takes, by hand."""
    one, a = block_along(), math.radians(degrees)
    weight, needed = one.posture.mass * GRAVITY, GRIP * math.sin(a) - math.cos(a)
    turned = math.sin(a + ASIDE_RAD) * (math.sin(a) + 2.0 * GRIP * math.cos(a))
    enough = 2.0 * GRIP * weight * needed / turned
    meets = DeviceEncounter(one)
    assert wiper(degrees).fate(meets) == "stopped"
    assert wiper(degrees, air_of(0.97 * enough)).fate(meets) == "stopped"
    assert wiper(degrees, air_of(1.03 * enough)).fate(meets) == "returned"
    # air that pushes it back takes off nothing, though it presses it off the face
    monkeypatch.setattr(AirAssist, "at_face", lambda *_: [FaceForce(-0.1 * weight, 2.0 * weight, 0.0)])
    assert wiper(degrees, air_of(1.03 * enough)).fate(meets) == "stopped"
    monkeypatch.undo()
    # above the part it blows at nothing
    assert wiper(degrees, air_of(10.0 * enough, height=25e-3)).fate(meets) == "stopped"


def test_what_passes_below_the_blade_is_left_or_blown_off_within_a_factor_of_two():
    """Half of the force that just takes it off leaves it, twice as much takes it off: as at an air jet."""
    one, high = block_along(), 20e-3
    still = replace(one, swing=0.0, speed=0.05)
    force = one.posture.mass * GRAVITY * GRIP  # a still track: friction alone holds it
    share = math.sin(math.radians(60.0) + ASIDE_RAD)  # while all of the jet meets the side
    weak, some, strong = (
        verdict(wiper(60.0, air_of(ratio * force / share, nozzle=4e-3), high), still)
        for ratio in (0.4, 1.0, 9.0)
    )
    assert weak.sure and weak.passes == 1.0 and 0.0 < weak.margin <= 4e-3
    assert not some.sure
    assert strong.sure and strong.passes == 0.0 and strong.margin < -UNSURE
    # over it the jet meets nothing: it passes as without air
    over = verdict(wiper(60.0, air_of(force, height=24e-3), high), still)
    assert over.margin == pytest.approx(4e-3) and over.passes == 1.0


def test_what_hangs_passes_below_a_jet_over_its_head_and_not_surely_in_one():
    head, shank = shapes.cylinder(5.0, 3.0, 64), shapes.cylinder(2.0, 15.0, 64)
    head.apply_translation([0, 0, 9.0])
    bolt = lying(head.union(shank), replace(BOWL.track, width=20e-3))
    along = next(one for one in bolt if one.height < 11e-3 and one.length > 15e-3)
    rails = device("rails", span=(along.distance - 2.2e-3, along.distance + 2.2e-3))
    (hanging,) = [one for one in course([rails], bolt).states if isinstance(one, Hanging)]
    low, over = (wiper(30.0, AirAssist(2e-3, 1e5, height), 4e-3) for height in (1e-3, 12e-3))
    assert not verdict(low, hanging).sure
    assert verdict(over, hanging).margin == verdict(wiper(30.0, limit=4e-3), hanging).margin > 0.0


def test_air_shortens_the_time_in_which_a_part_clears():
    one = block_along()
    times = [
        falling.clearing_time(wiper(degrees, air), one, BOWL)
        for degrees in (30.0, 70.0)
        for air in (None, *(AirAssist(2e-3, pressure, 10e-3) for pressure in (1e4, 2e4, 1e5)))
    ]
    assert math.isinf(times[4]) and np.isfinite(times[5])
    for own in (times[:4], times[4:]):
        assert all(later < earlier for earlier, later in itertools.pairwise(own))
    # not sooner than by all of that force, from rest, without friction
    air = AirAssist(2e-3, 1e5, 10e-3)
    along, off = (force / one.posture.mass for force in wiper(70.0, air).force_along_face(one))
    inwards = along * math.sin(math.radians(70.0)) + off * math.cos(math.radians(70.0))
    assert times[7] >= math.sqrt(2.0 * (one.track.width - one.distance) / inwards) * (1.0 - 1e-12)


def test_of_a_curved_deflector_the_jet_runs_along_the_straight_way_to_its_end():
    blade = device("curved deflector", limit=8e-3, air=AIR)
    features = blade.features(BOWL.track, lying(BLOCK, BOWL.track))
    (jet,) = features.jets
    first, last = features.blades[0], features.blades[-1]
    end = np.array(last.foot) + last.axes[0] * last.solid.bounds[2]
    way = end - first.foot
    assert jet.angle - ASIDE_RAD == pytest.approx(math.atan2(way[1], way[0]), abs=3e-4)
    assert first.heading < jet.angle - ASIDE_RAD < last.heading
    steep = device("curved deflector", limit=8e-3, begin=math.radians(30.0), end=math.radians(80.0))
    meets = DeviceEncounter(block_along())
    assert (
        steep.fate(meets) == "stopped"
        and steep.with_air(AirAssist(2e-3, 1e5, 10e-3)).fate(meets) == "returned"
    )


@pytest.mark.parametrize("line", [
    "wiper: {clearance: 6 mm, sweep: 30 deg, air: {nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm}}",
    "curved deflector: {clearance: 6 mm, from: 12 deg, to: 50 deg, "
    "air: {nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm}}",
])  # fmt: skip
def test_it_is_read_and_written_and_makes_the_blade_a_device_of_steady_air(tmp_path, line):
    blade = read(tmp_path, line).devices[0]
    assert blade.air == AIR and blade.value_text() == blade.text == line.partition(": ")[2]
    assert blade.takes_air and CostClass.of([blade]) is CostClass.AIR
    steel = blade.with_air(None)
    assert not steel.takes_air and CostClass.of([steel]) is CostClass.STEEL and "air" not in steel.text
    assert steel.compared_values != blade.compared_values
    assert "0.3 bar" in blade.shop_words[0] and not steel.shop_words
    assert blade.document_values()["pressure_bar"] == pytest.approx(0.3)
    assert len(blade.features(BOWL.track, [block_along()]).jets) == 1


@pytest.mark.parametrize(("value", "says"), [
    ("{clearance: 6 mm, air: {nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm}}", "no face"),
    ("{clearance: 6 mm, sweep: 90 deg, air: {nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm}}", "no face"),
    ("{clearance: 6 mm, sweep: 30 deg, air: {nozzle: 2 mm, pressure: 0.3 bar}}", "air has no height"),
    ("{clearance: 6 mm, sweep: 30 deg, air: 0.3 bar}", "air has no nozzle"),
    ("{clearance: 6 mm, sweep: 30 deg, air: {nozzle: 2 mm, pressure: 30 bar, height: 8 mm}}", "pressure is"),
    ("{clearance: 6 mm, sweep: 30 deg, air: {nozle: 2 mm, pressure: 3 bar, height: 8 mm}}", "unknown key"),
])  # fmt: skip
def test_its_faults(tmp_path, value, says):
    with pytest.raises(FeederError, match=says):
        read(tmp_path, f"wiper: {value}")
