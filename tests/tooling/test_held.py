"""A design holds what rolls on the level: by a bank, or by a groove where that would be steep."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.isolating import design
from feederscrew.tooling.isolating.chain import DesignConstraints
from feederscrew.tooling.orientations import orientations, travelling

DOWEL = load(Path(__file__).resolve().parents[2] / "parts" / "dowel_6x20.stl")
OWN = ("track.width=30 mm", "track.climb=3 deg", "friction.wall=0.5")
BOWL = bowls.read(None, OWN)
EVERY = travelling(orientations(DOWEL, find(DOWEL), BOWL.track), BOWL)
ALONG, ACROSS, UPRIGHT = (next(one for one in EVERY if one.name == name) for name in ("A@0", "A@90", "B@86"))


def angles(one, friction, before=(), constraints=None):
    return [
        (device.kind, pytest.approx(math.degrees(device.angle)))
        for device in design.holding_stretches(one, friction, before, constraints or DesignConstraints())
    ]


def test_the_bank_holds_by_the_friction_of_the_wall_with_a_degree_to_spare():
    assert angles(ALONG, 0.5) == [("bank", 7.0)]  # atan(tan 3 deg / 0.5) = 5.98 deg
    assert angles(ALONG, 0.9) == [("bank", 6.0)]
    assert angles(ACROSS, 0.3) == [("bank", 11.0)]  # 9.9 deg
    bank = design.holding_stretches(ACROSS, 0.3, (), DesignConstraints())[0]
    assert ACROSS.may_roll_back and not bank.onward(replace(ACROSS, wall_grip=0.3)).may_roll_back


def test_a_groove_stands_in_where_the_bank_would_be_steep_for_what_lies_along():
    assert angles(ALONG, 0.1) == [("groove", 30.0), ("bank", 6.0)]
    assert angles(ALONG, 0.0) == [("groove", 30.0), ("bank", 6.0)]
    assert angles(ACROSS, 0.1) == []
    assert angles(ALONG, 0.1, constraints=DesignConstraints(without=("groove",))) == []


def test_nothing_is_added_where_the_track_leans_or_nothing_rolls():
    assert angles(UPRIGHT, 0.5) == []
    assert angles(replace(ALONG, track=replace(ALONG.track, bank=0.01)), 0.5) == []
    assert angles(ALONG, 0.5, before=(make_device("bank", "b", angle=0.1),)) == []
    assert angles(ALONG, 0.5, constraints=DesignConstraints(without=("bank",))) == []


def test_the_design_of_a_dowel_begins_with_its_bank():
    study = tooling(DOWEL, BOWL, "A", heading=0.0, rule="csa", vary=False)
    first, *others = study.design.cuts
    assert study.design.isolated and first.device.kind == "bank" and first.device.text == "7 deg"
    assert np.isnan(first.margin_pass) and first.returns == ()
    assert study.design.devices == (first.device, *(cut.device for cut in others))
    level = tooling(DOWEL, BOWL, "A", heading=0.0, rule="csa", without="bank").design
    assert all(cut.device.kind != "bank" for cut in level.cuts)
    across = tooling(DOWEL, BOWL, "A", heading=math.pi / 2, rule="csa", without="bank").design
    assert not across.isolated and "can roll back" in across.reasons[0]
