"""A pressure break: parts that back up at it in the queue leave the track; the break that is proposed."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import KINDS, make_device
from feederscrew.tooling.verdicts import verdict
from feederscrew.trial import queue

BLOCK = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.read(None, ["track.bank=3 deg"])
STOP = make_device("height_bar", "", limit=4e-3)  # everything stands before it


def queued(*devices):
    """Eight blocks that touch, lying along the wall: the row backs up."""
    known = stream.follow_orientations(BLOCK, find(BLOCK), BOWL.track, devices, bowl=BOWL)
    flat = np.array([one.height < 6e-3 and one.length > 0.019 for one in known.lying])
    return queue.queue_of(
        BLOCK, replace(BOWL, devices=devices), find(BLOCK), known.lying, known.states, flat / flat.sum(),
        queue.QueuePlan(8, 5.0, 0.0), RunSettings(2),
    )  # fmt: skip


@pytest.mark.parametrize(("ledge", "leaves"), [(6.5, True), (14.0, False)])
def test_parts_that_back_up_and_reach_over_the_ledge_leave_there(ledge, leaves):
    """12 mm wide: over a ledge of 6.5 mm they reach, over one of 14 mm they do not."""
    found = queued(make_device("pressure_break", "", limit=1e-3 * ledge), STOP)
    assert (found.relieved > 0) == leaves and found.returned == found.relieved
    assert found.jams > 0


def test_nothing_leaves_at_a_break_behind_which_parts_go_on():
    found = queued(make_device("pressure_break", "", limit=6.5e-3))
    assert found.leaving.sum() > 0 and found.relieved == found.returned == found.jams == 0


def test_the_break_that_is_proposed_carries_what_is_wanted_and_no_more_than_it_has_to():
    lying = stream.follow_orientations(BLOCK, find(BLOCK), BOWL.track, bowl=BOWL).lying
    one = next(k for k in lying if k.height < 6e-3 and k.length > 0.019)
    (kind,) = [kind for kind in KINDS.values() if kind.relieves]
    device = kind.relieving([one], 2.5e-4, "design")
    assert device.kind == "pressure_break"
    assert device.text == "6.15 mm"  # half the width less 2.5 tan(3 deg), plus 0.25 mm, in steps of 0.05 mm
    assert verdict(device, one, lying).margin == pytest.approx(device.limit - one.balcony)
    assert 2.5e-4 <= device.limit - one.balcony < 3e-4 and device.limit < one.width
    assert kind.relieving([one, replace(one, width=6.3e-3)], 2.5e-4, "design") is None
    assert kind.relieving([replace(one, hop=1e-3)], 2.5e-4, "design").limit == pytest.approx(
        device.limit + 1e-3
    )
