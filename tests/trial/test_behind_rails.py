"""What hangs between rails goes on hanging past the devices behind them: rule, single parts and a queue."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
import trimesh

from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import Hanging
from feederscrew.tooling.verdicts import DeviceEncounter
from feederscrew.trial import course, queue

HEADED = shapes.part(
    trimesh.creation.revolve([(0, 0), (2, 0), (2, 10), (4, 10), (4, 13), (0, 13)], sections=32)
)
T_NUT = shapes.part(shapes.t_nut())


def tried(part, bowl, devices, which, parts=4):
    """The orientations of a part through devices, and what became of parts of some of them."""
    aspects = find(part)
    known = stream.follow_orientations(part, aspects, bowl.track, devices, bowl=bowl)
    rows = [k for k, one in enumerate(known.lying) if which(one)]
    seen = course.course(
        part, bowl, known.lying, course.Sending(rows, parts), devices,
        poses=known.states, leaves=course.rightly(known.leaving), run=RunSettings(2),
    )  # fmt: skip
    return aspects, known, rows, seen


@pytest.mark.parametrize(("clearance", "passes"), [(5e-3, True), (2e-3, False)])
def test_a_hold_down_over_the_heads_does_as_its_rule_says(clearance, passes):
    bowl = awkward.bowl("track.radius=0.15 m", "track.bank=6 deg")
    rails = make_device("rails", "r", span=(2.25e-3, 6.65e-3), lead=(1e-3, 6.95e-3, 20e-3, 10e-3))
    devices = (rails, make_device("hold_down", "h", limit=clearance))
    aspects, known, rows, seen = tried(
        HEADED, bowl, devices, lambda one: one.height < 9e-3 and one.length > 0.012
    )
    hangs = [isinstance(one, Hanging) for one in known.states]
    assert known.leaving[rows].sum() == pytest.approx(len(rows) if passes else 0.0)
    if not passes:
        assert set(seen.fates) == {course.STOPPED} and set(seen.ended) == {2}
        return
    assert set(seen.fates) == {course.PASSED} and np.array(hangs)[seen.orientations[-1]].all()
    assert seen.depths.max() < 1e-4
    shares = np.zeros(len(known.lying))
    shares[rows] = 1.0 / len(rows)
    plan, here = queue.QueuePlan(2, 16.0), replace(bowl, devices=devices)
    found = queue.queue_of(HEADED, here, aspects, known.lying, known.states, shares, plan, RunSettings(2))
    assert found.jams == found.returned == 0 and found.leaving[:-1][hangs].sum() == found.leaving.sum() > 0


def test_rails_hold_what_a_swept_wiper_would_clear():
    """The head stands 3 mm over the rails: a wiper at 2 mm stops it, and cannot sweep it off them."""
    bowl = awkward.bowl("track.radius=0.15 m", "track.bank=6 deg")
    rails = make_device("rails", "r", span=(2.25e-3, 6.65e-3), lead=(1e-3, 6.95e-3, 20e-3, 10e-3))
    devices = (rails, make_device("wiper", "w", limit=2e-3, sweep=0.5))
    _, known, rows, seen = tried(
        HEADED, bowl, devices, lambda one: one.height < 9e-3 and one.length > 0.012, 2
    )
    assert {known.fates[row] for row in rows} == {"stopped"} and set(seen.fates) == {course.STOPPED}


def test_a_t_nut_hangs_by_its_shoulders_in_rails_and_stops_in_a_slot():
    """Stem 5 mm wide and 6 mm deep, head 10 mm: between rails of 6.4 mm it goes down until the head rests."""
    bowl = awkward.bowl("track.radius=0.15 m")

    def stem_down(one):
        up = one.posture.axes[2]
        return abs(up[1] - 1.0) < 1e-6 and one.length > 0.015 and one.width < 0.011

    rails = (make_device("rails", "r", span=(2.2e-3, 8.6e-3)),)
    _, known, rows, seen = tried(T_NUT, bowl, rails, stem_down, 2)
    assert len(rows) == 1 and seen.fates.tolist() == [course.PASSED] * 2
    (down,) = [one for one in known.states if isinstance(one, Hanging)]
    assert known.leaving[rows[0], known.states.index(down)] == 1.0
    assert down.height == pytest.approx(3e-3, abs=1e-9) and down.neck.shank == pytest.approx(5e-3, abs=1e-9)
    slot = make_device("slot", "s", span=(2.2e-3, 8.6e-3))
    meeting = DeviceEncounter(known.lying[rows[0]], known.lying)
    assert slot.judged(meeting).passes == 0.0 and slot.fate(meeting) == "stopped"
    _, _, _, seen = tried(T_NUT, bowl, (slot,), stem_down, 2)
    assert set(seen.fates) == {course.STOPPED}
