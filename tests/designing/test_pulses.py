"""The pulse of a sensor is as short as takes off what it returns, and longer where a trial denies that."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import proposals, short_trials
from feederscrew.designing.proposals import (
    PULSE_RESERVE,
    PULSE_STEP_S,
    SHORTEST_PULSE_STEPS,
    longer,
    quickened,
)
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.devices.pneumatics import PULSE
from feederscrew.tooling.isolating.chain import judge_cut
from feederscrew.tooling.verdicts import DeviceEncounter


def tried(ways, right, wrong):
    """A short trial of all orientations, one of each, on their way to the first state."""
    count = len(ways.lying)
    own = [np.array([int(k in some) for k in range(count)]) for some in (right, wrong, ())]
    return short_trials.Tried(
        ways, np.full(count, 1.0 / count), np.arange(count), np.ones(count, int), *own,
        places=({},) * count, velocity=0.05, state=0, states=(0,), deepest=0.0,
    )  # fmt: skip


@pytest.fixture(scope="module")
def wedge():
    """A wedge of 24 x 13 mm on a banked track, a sorter of its first orientation, and what that returns."""
    corners = np.array([[0, 0], [0.024, 0], [0.024, 0.004], [0.004, 0.013]])
    part = shapes.part(shapes.prism(1e3 * corners, 7.0))
    bowl = bowls.read(None, ["track.bank=5 deg", "track.width=30 mm"])
    ways = proposals.known_through(part, find(part), bowl)
    one = ways.lying[0]
    like = {"like": (one.aspect, one.heading, 1e-3), "text": "{of: A@0, play: 1 mm, sees: outline}"}
    device = make_device("sorter", "test", **like)
    must = np.arange(len(ways.lying)) > 0
    return ways, judge_cut(ways.lying, 0, device, must, device, device)


def reserve(cut, every, time):
    """The least way [m] beyond the edge over which a share of a pulse carries what the cut returns."""
    gone = [DeviceEncounter(one, every) for one in every if one.name in cut.returns]
    return min(met.blown(*cut.device.jet.push(met.orientation, every), time / PULSE_RESERVE) for met in gone)


def weighing(every, times):
    """Orientations of a part so many times as heavy."""
    return [replace(one, posture=replace(one.posture, mass=times * one.posture.mass)) for one in every]


def test_a_pulse_is_the_shortest_with_its_reserve_and_the_file_says_so(wedge):
    ways, cut = wedge
    found = []
    for times in (0.2, 0.9, 1.2, 50.0):
        every = weighing(ways.lying, times)
        device = quickened(cut, every).device
        found.append(device.time)
        if device.time < PULSE:
            assert reserve(cut, every, device.time) > 0.0
            assert (
                device.text
                == f"{cut.device.rewritten().text[:-1]}, jet: {{time: {1e3 * device.time:.0f} ms}}}}"
            )
            assert device.gap(every[0], 0.2) == pytest.approx(
                cut.device.gap(every[0], 0.2) - 0.2 * (PULSE - device.time)
            )
        if device.time > PULSE_STEP_S * SHORTEST_PULSE_STEPS:
            assert reserve(cut, every, device.time - PULSE_STEP_S) <= 0.0
    assert found[0] == PULSE_STEP_S * SHORTEST_PULSE_STEPS < found[1] < found[2] <= found[3] == PULSE


def test_what_is_carried_through_makes_the_pulse_longer_up_to_that_of_before(wedge):
    ways, cut = wedge
    proposal = proposals.Proposal(0, (quickened(cut, weighing(ways.lying, 0.2)),), (), "test")
    slipped = next(k for k, one in enumerate(ways.lying) if one.name in cut.returns)
    seen, times = tried(ways, {0}, {slipped}), []
    assert longer(proposal, tried(ways, {0}, ()), ways.lying) is None
    for _ in range(3):
        other = longer(proposal, seen, ways.lying)
        if other is None:
            break
        assert proposals.better(proposal, seen, ways.lying).chain == other.chain
        (device,) = other.devices
        times.append(device.time)
        assert other.step == f"pulse of {1e3 * device.time:.0f} ms" and ("jet" in device.text) == (
            device.time < PULSE
        )
        proposal = other
    assert other is None and times == pytest.approx([0.04]) and times[-1] == PULSE
