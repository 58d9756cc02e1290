"""The climb at which a bowl with a spacing section can be drawn: that of ``feeder bowl --solid``."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import shares
from feederscrew.base import units
from feederscrew.cad import solid as solidbowl
from feederscrew.cad.plan import ARC_CHORD_M, STEEL_NAME, TrackTooLow
from feederscrew.designing import calm_drive, exploring, proposals
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.search import Search
from feederscrew.machine import sheet as machines
from feederscrew.resting.aspects import find
from feederscrew.sorting.isolating.chain import Cut
from feederscrew.sorting.tooled_track import lay_out

PART = shapes.part(shapes.box(40, 12, 5))
ASPECTS = find(PART)
DEVICES = "devices:\n  - separation: {climb: -6 deg}\n  - sorter: {of: A@0, play: 0.5 mm, sees: outline}\n"


@pytest.fixture
def spaced(tmp_path):
    """The bowl that a design begins with, and the devices of a chain with a spacing section."""
    (tmp_path / "bowl.yaml").write_text(DEVICES)
    bowl = bowls.read(tmp_path / "bowl.yaml")
    return calm_drive.section(PART, ASPECTS, replace(bowl, devices=()), ()), bowl.devices


def on_track(made, devices):
    bowl = replace(made.bowl, devices=devices)
    return bowl, proposals.follow_orientations(PART, ASPECTS, bowl)


def drawn(tmp_path, track, climb):
    """The sheet of ``feeder bowl --solid`` for a file with that track."""
    lines = [f"track.radius={1e3 * track.radius} mm", f"track.width={1e3 * track.width} mm"]
    lines += [] if climb is None else [f"track.climb={np.degrees(climb)} deg"]
    settings = bowls.settings(tmp_path / "bowl.yaml", lines)
    wanted = solidbowl.solid_options(settings, solid=True, material=STEEL_NAME, chord=ARC_CHORD_M)
    return machines.size_machine(settings, PART, 0.05, aspects=ASPECTS, solid=wanted, rule="csa")


def climb_by_hand(bowl, stream, devices):
    """Of a cylinder: from where it leads down over L to the outlet it must clear the turn below by the part.

    That turn is 2 pi R - L behind: (2 pi R - L) tan(climb) = h + 5 mm + L tan(6 deg), in whole quarters of a
    degree. The outlet begins 10 mm behind the devices.
    """
    tooled = lay_out(bowl.track, devices, stream.lying)
    ((begin, angle),) = tooled.climbs
    down = tooled.length - begin + 10e-3
    assert angle == np.radians(-6.0)
    rise = (40e-3 + 5e-3 + down * np.tan(np.radians(6.0))) / (2.0 * np.pi * bowl.track.radius - down)
    return np.ceil(np.degrees(np.arctan(rise)) / 0.25) * 0.25


def test_it_is_the_one_that_the_bowl_takes_by_itself_and_a_step_less_is_refused(tmp_path, spaced):
    made, devices = spaced
    bowl, stream = on_track(made, devices)
    climb = solidbowl.drawable_climb(bowl, PART, stream)
    by_hand = climb_by_hand(bowl, stream, devices)
    assert np.degrees([bowl.track.climb, climb]) == pytest.approx([3.5, by_hand])
    assert drawn(tmp_path, bowl.track, None).bowl.track.climb == pytest.approx(climb, abs=1e-12)
    with pytest.raises(TrackTooLow, match=rf"give a track\.climb of at least {by_hand:g} deg"):
        drawn(tmp_path, bowl.track, climb - solidbowl.CLIMB_STEP_RAD)
    for chain in ((), devices[1:]):  # a bowl that can be drawn keeps its climb
        bowl, stream = on_track(made, chain)
        assert solidbowl.drawable_climb(bowl, PART, stream) == bowl.track.climb


class Stop(Exception):
    """Raised where a trial would begin."""


@pytest.mark.parametrize("fixed", [(), ("track.climb",)])
def test_a_design_tries_its_chain_on_the_track_that_can_be_drawn(spaced, monkeypatch, fixed):
    """Unless the user gave the climb: the trial of 3.5 deg was of a bowl that nobody can draw."""
    made, devices = spaced
    bowls_tried = []

    def single(part, bowl, *_, **__):
        bowls_tried.append(bowl)
        raise Stop

    monkeypatch.setattr(exploring.short_trials, "try_parts", single)
    search = Search.begin(PART, DesignRequest(10.0 / units.MINUTE), made.bowl, fixed)
    search.state.shares = shares(PART, made.bowl, rule="csa")
    count = len(on_track(made, devices)[1].lying)
    cuts = tuple(Cut(one, np.nan, np.nan, one, one, ()) for one in devices)
    proposal = proposals.Proposal(0, cuts, (), Move(MoveKind.NO_DEVICE))
    with pytest.raises(Stop):
        exploring.try_proposal(search, made, proposal, np.full(count, 1.0 / count))
    (bowl,) = bowls_tried
    degrees = 3.5 if fixed else climb_by_hand(*on_track(made, devices), devices)
    assert np.degrees(bowl.track.climb) == pytest.approx(degrees)
    assert bowl.devices == devices and bowl.drive.amplitude > 0.0
