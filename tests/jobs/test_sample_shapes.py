"""Parts by their sizes, as standards, closed forms and OpenCASCADE have their dimensions and volumes."""

import io
import struct

import numpy as np
import pytest
from command_lines import PARTS

from feederscrew.base.errors import ArgumentError
from feederscrew.base.units import MM
from feederscrew.jobs.samples import families, solids
from feederscrew.part import load

EXAMPLES = [(family.name, family.size) for family in families.FAMILIES.values()]
CLOSED_MM3 = {  # closed forms; where a bevel takes corners off a hexagon, OpenCASCADE 8.0
    "hexbolt_m8x25": 2019.2529, "shcs_m3x8": 119.6247, "hexnut_m6": 337.8861,
    "plain_washer_m6": np.pi / 4 * (12**2 - 6.4**2) * 1.6,
    "pin_6x20": np.pi * (9 * 17.6 + 2 * 1.2 / 3 * (9 + 3 * 1.8 + 1.8**2)),
    "cap_14x10x1": np.pi * (49 * 10 - 36 * 9),
    "bracket_25x10x12x1": 12 * (25 + 9) - np.pi * 2**2,
    "t_shape_0.4": 10 * (25 * 13 + 11 * 12),
}  # fmt: skip
# greatest height of the head and across flats [mm], as bd_warehouse 0.4.0 has them for ISO 4017
GREATEST_HEADS_MM = {
    "M3": (2.2, 5.5), "M4": (3.0, 7), "M5": (3.74, 8), "M6": (4.24, 10), "M8": (5.54, 13), "M10": (6.69, 16),
    "M12": (7.79, 18), "M16": (10.29, 24), "M20": (12.85, 30),
}  # fmt: skip


def corners(shape):
    return solids.triangles(shape).reshape(-1, 3) / MM


@pytest.mark.parametrize(("name", "size"), EXAMPLES)
def test_a_part_of_a_family_is_a_closed_solid_of_its_volume(name, size):
    shape = families.shape(name, size)
    part = load("-", stdin=io.BytesIO(solids.stl(shape)))
    assert part.warnings == () and not part.open_surface
    assert part.volume / MM**3 == pytest.approx(CLOSED_MM3[shape.name], rel=2.5e-3)  # chords cut off arcs


@pytest.mark.parametrize("thread", families.PITCHES_MM)
def test_a_shank_is_as_thick_as_its_thread(thread):
    """The file that was an example had a shank of the minor diameter: rails fitted it, and no real bolt."""
    for name, sizes in (("hex-bolt", families.HEX_BOLTS_MM), ("socket-screw", families.SOCKET_SCREWS_MM)):
        for length in sizes[thread][-2:]:
            places = corners(families.shape(name, f"{thread}x{length}"))
            shank = places[places[:, 2] < -1e-9]
            assert 2 * np.hypot(*shank[:, :2].T).max() == pytest.approx(float(thread[1:]), abs=1e-5)
            assert places[:, 2].min() == pytest.approx(-length)


@pytest.mark.parametrize("thread", GREATEST_HEADS_MM)
def test_a_head_lies_within_its_standard_and_is_bevelled(thread):
    greatest, flats = GREATEST_HEADS_MM[thread]
    long = families.HEX_BOLTS_MM[thread][-1]
    places = corners(families.shape("hex-bolt", f"{thread}x{long}"))
    top = places[:, 2].max()
    assert greatest - 0.4 < top <= greatest
    assert np.ptp(places[:, 1]) == pytest.approx(flats, abs=1e-5)
    assert np.ptp(places[:, 0]) == pytest.approx(flats * 2 / np.sqrt(3), abs=1e-5)
    assert 2 * np.hypot(*places[places[:, 2] > top - 1e-6][:, :2].T).max() < flats  # no corner left on top


def test_nuts_and_washers_fit_their_bolts():
    for thread, pitch in families.PITCHES_MM.items():
        nut, washer = (corners(families.shape(name, thread)) for name in ("hex-nut", "washer"))
        bore, hole = (2 * np.hypot(*places[:, :2].T).min() for places in (nut, washer))
        major = float(thread[1:])
        assert major - 1.083 * pitch < bore + 1e-3 and bore < major < hole  # ISO 724


def test_the_example_parts_are_those_of_their_families():
    for file, name, size in (
        ("hexbolt_m8x25", "hex-bolt", "M8x25"),
        ("shcs_m3x8_simple", "socket-screw", "M3x8"),
    ):
        ours, kept = solids.triangles(families.shape(name, size)), load(PARTS / f"{file}.stl")
        assert kept.volume == pytest.approx(
            np.einsum("fk,fk->", ours[:, 0], np.cross(ours[:, 1], ours[:, 2])) / 6
        )
        gaps = np.abs(np.unique(ours.reshape(-1, 3), axis=0)[:, None] - kept.vertices).max(axis=2).min(axis=1)
        assert gaps.max() < 1e-8


@pytest.mark.parametrize(
    ("name", "size", "own", "where"),
    [
        ("hex-bolt", "M7x25", {}, "size"), ("hex-bolt", "M8", {}, "size"), ("hex-bolt", "8x25", {}, "size"),
        ("hex-bolt", "M8x26", {}, "size"), ("hex-bolt", "M8x100", {}, "size"),
        ("hex-nut", "M6x2", {}, "size"),
        ("cap", "14", {}, "size"), ("cap", "14x1e9", {}, "size"), ("pin", "6x-2", {}, "size"),
        ("pin", "20x6", {}, "size"),
        ("cap", "14x10", {"wall": 7e-3}, "wall"), ("cap", "14x10", {"wall": 1e-5}, "wall"),
        ("bracket", "6x10x12", {"wall": 1e-3}, "size"), ("bracket", "25x10x12", {"wall": 10e-3}, "wall"),
        ("hex-bolt", "M8x25", {"ratio": 0.4}, "ratio"), ("cap", "", {}, "size"),
        ("t-shape", "25", {}, "size"),
        ("t-shape", "", {"ratio": 0.01}, "ratio"), ("bolt", "M8x25", {}, "name"),
    ],
)  # fmt: skip
def test_what_no_family_has_is_refused(name, size, own, where):
    with pytest.raises(ArgumentError) as error:
        families.shape(name, size, **own)
    assert str(error.value.where) == where


def test_sizes_are_read_as_people_write_them():
    assert (
        families.shape("hex-bolt", "m8 X 25").name
        == families.shape("hex-bolt", "M8×25").name
        == "hexbolt_m8x25"
    )
    assert families.shape("washer", "M2.5").name == "plain_washer_m2.5"


@pytest.mark.parametrize("ratio", [0.4, 1.7])
def test_a_t_has_its_ratio(ratio):
    places = corners(families.shape("t-shape", ratio=ratio))
    assert np.ptp(places, axis=0) == pytest.approx([25, 25, 25 * ratio])


def test_the_facets_of_a_file_are_those_that_its_head_counts():
    data = solids.stl(families.shape("cap", "14x10"))
    assert len(data) == 84 + 50 * struct.unpack("<I", data[80:84])[0] and b"cap_14x10x1" in data[:80]


@pytest.mark.needs("OCP")
@pytest.mark.parametrize(("name", "size"), EXAMPLES)
def test_the_exact_faces_of_a_part_have_its_volume(tmp_path, name, size):
    shape = families.shape(name, size)
    data = solids.step(shape)
    (tmp_path / "part.step").write_bytes(data)
    assert load(tmp_path / "part.step").volume / MM**3 == pytest.approx(CLOSED_MM3[shape.name], rel=1e-3)
    assert solids.step(shape) == data
    stored = PARTS / f"{shape.name}.step"
    assert not stored.exists() or stored.read_bytes() == data
