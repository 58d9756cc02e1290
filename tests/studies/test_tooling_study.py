"""What the study of tooling hands on to the design."""

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing.loop import design
from feederscrew.designing.proposals import promising
from feederscrew.designing.record import DesignRequest
from feederscrew.errors import ArgumentError, FeederError
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.kinds import KINDS

BOWL = bowls.read(None, ("track.radius=100 m", "track.width=200 mm", "track.bank=0 deg"))
PART = shapes.part(shapes.box(20, 12, 10))


def test_devices_that_turn_parts_are_used_where_they_may_be_and_bring_more():
    plain, turned = (
        tooling(PART, BOWL, "B", rule="csa", turn=turn, vary=False, without="cut_out").design
        for turn in (False, True)
    )
    assert not any(KINDS[cut.device.kind].turns for cut in plain.cuts)
    assert any(KINDS[cut.device.kind].turns for cut in turned.cuts)
    assert turned.efficiency > 2.0 * plain.efficiency


def test_a_heading_is_that_of_an_aspect_which_the_part_has():
    with pytest.raises(ArgumentError, match="heading: is given without an aspect"):
        tooling(PART, BOWL, heading=1.0)
    with pytest.raises(ArgumentError, match="heading: is given without an aspect"):
        DesignRequest(0.5, heading=1.0)
    ways = stream.follow_orientations(PART, find(PART), BOWL.track)
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    near, off = (DesignRequest(0.5, "A", heading=np.radians(angle)) for angle in (88.0, 45.0))
    (row,) = promising(ways, shares, near)
    assert ways.lying[row].name == "A@90"
    assert promising(ways, shares, off)[0] in (0, row)  # on another track the nearest is the same
    with pytest.raises(FeederError, match="aspect A has no stable heading 45 deg"):
        design(PART, BOWL, (), off)
