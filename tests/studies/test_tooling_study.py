"""What the study of tooling hands on to the design."""

import shapes

from feederscrew import bowl as bowls
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
