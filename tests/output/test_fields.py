"""The partners of a heading, in its table."""

import numpy as np
import pytest
import shapes

from feederscrew import bowl
from feederscrew.sorting.headings import headings


def test_partners_of_a_heading_are_half_a_turn_on_or_its_mirror_image():
    bracket = shapes.part(shapes.prism(shapes.l_profile(), 15.0))
    rows = headings(bracket, bowl.default()).table().rows()
    turned = [row["half_turn_of_deg"] - row["heading_deg"] for row in rows]
    turned = [turn % 360.0 for turn in turned if np.isfinite(turn)]
    assert turned and turned == pytest.approx([180.0] * len(turned))
    lengths = {(row["aspect"], row["heading_deg"]): row["length_mm"] for row in rows}
    mirrored = [row for row in rows if np.isfinite(row["mirror_of_deg"])]
    assert mirrored
    for row in mirrored:
        assert lengths[row["aspect"], row["mirror_of_deg"]] == pytest.approx(row["length_mm"])
        assert (row["mirror_of_deg"] - row["heading_deg"]) % 360.0 != pytest.approx(180.0)
