"""Drawings of holes: read back as written, and damaged ones told of in a line."""

from pathlib import Path

import numpy as np
import pytest

from feederscrew import dxf
from feederscrew.errors import ConfigError

RING = [(0.0, 0.0), (0.01, 0.0), (0.01, 0.004), (0.002, 0.006)]
UNREADABLE = "cannot be read as DXF - save it as ASCII DXF R2000 or later"


@pytest.fixture
def drawing(tmp_path):
    path = tmp_path / "hole.dxf"
    path.write_bytes(dxf.written([dxf.Layer("HOLE", 1, rings=(np.array(RING),))]))
    return path


def test_a_ring_comes_back_as_it_was_written(drawing):
    (ring,) = dxf.closed_polylines(drawing, "HOLE", "bowl.yaml:3")
    np.testing.assert_allclose(ring, RING, rtol=1e-12, atol=1e-15)


def test_a_group_value_of_minus_infinity_is_a_line(drawing):
    """It was an OverflowError in the reader."""
    lines = drawing.read_text().split("\n")
    units = lines.index("$INSUNITS") + 2
    lines[units] = "-inf"
    _refused(drawing, "\n".join(lines).encode())


@pytest.mark.parametrize("cut", [12, 300, 3000])
def test_a_damaged_header_is_a_line(drawing, cut):
    """It was a StopIteration in the reader."""
    _refused(drawing, drawing.read_bytes()[:cut])


def test_what_the_reader_says_of_odd_drawings_stays_out_of_sight(tmp_path, caplog):
    """Its own lines stood on stderr beside the answer: 'Found non-unique entity handle'."""
    few = (Path(__file__).parents[1] / "fuzz/few.dxf").read_text()
    start, end = few.index("0\nLWPOLYLINE"), few.rindex("0\nENDSEC")
    twice = few[:end] + few[start:end] + few[end:]
    (tmp_path / "twice.dxf").write_text(twice)
    assert len(dxf.closed_polylines(tmp_path / "twice.dxf", "CUT", "bowl.yaml:3")) == 2
    assert caplog.records == []


def test_every_damage_is_a_line(drawing, rng):
    data = drawing.read_bytes()
    for _ in range(40):
        start, length = rng.integers(len(data)), rng.integers(1, 200)
        odd = rng.choice([b"", b"-inf", b"nan", b"1e999", b"\x00", b"\n", bytes(rng.bytes(30))])
        drawing.write_bytes(data[:start] + odd + data[start + length :])
        try:
            dxf.closed_polylines(drawing, "HOLE", "bowl.yaml:3")
        except ConfigError as fault:
            assert str(fault).startswith("bowl.yaml:3: ")


@pytest.mark.parametrize("place", ["nan", "inf", "1e12"])
def test_a_corner_at_no_place_of_a_bowl_is_a_line(drawing, place):
    text = drawing.read_text()
    assert "\n10.0\n" in text
    drawing.write_text(text.replace("\n10.0\n", f"\n{place}\n"))
    with pytest.raises(ConfigError, match=r"^bowl\.yaml:3: "):
        dxf.closed_polylines(drawing, "HOLE", "bowl.yaml:3")


def _refused(path, data):
    path.write_bytes(data)
    with pytest.raises(ConfigError) as told:
        dxf.closed_polylines(path, "HOLE", "bowl.yaml:3")
    assert str(told.value) == f"bowl.yaml:3: {path} {UNREADABLE}"
