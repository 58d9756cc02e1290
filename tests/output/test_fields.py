"""Fields of a record under names that end in a unit, and the partners of a heading that come from them."""

from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl
from feederscrew.output import tables
from feederscrew.studies.headings import headings

RECORD = SimpleNamespace(
    pitch=0.012, climb=np.radians(3.0), stress=2.5e6, share=0.25, leaves=18, none=None,
    rows=np.array([1e-3, 2e-3]), track=SimpleNamespace(width=0.02),
)  # fmt: skip


@pytest.mark.parametrize(
    ("entry", "name", "value"),
    [
        ("pitch_mm", "pitch_mm", 12.0), ("climb_deg", "climb_deg", 3.0),
        ("leaf_stress_mpa=stress", "leaf_stress_mpa", 2.5), ("share_percent=share", "share_percent", 25.0),
        ("width_mm=track.width", "width_mm", 20.0), ("rows_mm", "rows_mm", [1.0, 2.0]),
        ("leaves", "leaves", 18), ("none_mm=none", "none_mm", None),
    ],
)  # fmt: skip
def test_a_field_is_given_in_the_unit_that_ends_its_name(entry, name, value):
    values = tables.row_of(RECORD, entry)
    assert list(values) == [name] and values[name] == (value if value is None else pytest.approx(value))
    assert name != "leaves" or type(values[name]) is int  # no unit: as it is


def test_each_record_is_a_row():
    frame = tables.table_of([RECORD, RECORD], "pitch_mm leaves", "climb_deg")
    assert frame["pitch_mm"] == pytest.approx([12.0, 12.0])
    assert list(frame) == ["pitch_mm", "leaves", "climb_deg"]
    assert list(tables.table_of([], "pitch_mm leaves")) == ["pitch_mm", "leaves"]


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
