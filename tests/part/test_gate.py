"""The gate: every kind of damaged surface is mended with a warning, or refused in one line."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import shapely
import shapes
import trimesh
from readings import BOX, loaded, mm3, refused

from feederscrew.base.errors import FeederError
from feederscrew.part import gate, load, mass, topology

BROKEN = Path(__file__).parents[1] / "data" / "broken"
VOLUME = 6000.0  # [mm3] of the box
CLOSED = "export it as a closed solid"
POINT = f"is a line or a point: no facet has an area - {CLOSED}"
TAKE = (
    " - take one with `body` (its number, its name, or largest), save each body as a file of its own, or"
    " unite them in CAD if they are one part; or pass `allow_open` to take them as one part"
)
FILLED = "the surface is open: {} filled in for these numbers (`allow_open`)"
BRACKET_MM3 = 1379.2795
TAKEN = {  # file: volume [mm3], its relative tolerance, words of its warning
    "count_zero_hexbolt": (1675.738, 1e-6, "the header says 0 facets, the file has 476"),
    "faroff_lbracket": (BRACKET_MM3, 3e-3, "lies 1e+05 mm from the origin, where single precision"),
    "hollow_box": (784.0, 1e-6, None),
    "inch_lbracket": (BRACKET_MM3 / 25.4**3, 1e-5, "the largest dimension, 1.18 mm, is small for a fed part"),
    "inverted_lbracket": (BRACKET_MM3, 1e-6, "all facets pointed inwards; reversed"),
    "mixed_winding_lbracket": (BRACKET_MM3, 1e-6, "76 of 532 facets pointed the other way than the rest"),
    "solid_header_binary": (1675.738, 1e-6, None),
}
REFUSED = {
    "flat_sheet": f"is flat: all its corners lie in one plane - {CLOSED}",
    "nan_lbracket": "facet 1 of 532 has a corner that is not a finite number",
    "not_an_stl": "is an HTML page, not a part",
    "open_lbracket": "the surface is open: 32 edges without a neighbour round 10 holes, the widest",
    "truncated_hexbolt": "is cut short: 476 facets announced, 316 are there",
    "two_nuts": "holds 2 bodies: 1 (302.5 mm3, 11.55 x 10 x 5.2 mm), 2 (302.5 mm3, 11.55 x 10 x 5.2 mm)",
    "zero_bytes": "is empty",
}
STRAY = b"v nan nan nan\nv 1e9 0 0\n"  # corners that no facet uses
HOUSING = files.box((10, 10, 10))
CAVITY = files.inside_out(files.box((2, 2, 2), (1, 1, 1)))
SHAKEN = BOX + np.random.default_rng(20260101).uniform(-5e-6, 5e-6, BOX.shape)
BESIDE = files.inside_out(HOUSING * [-1, 1, 1] + [20, 0, 0])  # its wall has the first one's diagonal
AREA = "without area removed: two corners in one place"
LEFT = "pointed the other way than the rest; reversed"
LINE = np.array([[[0, 0, 0], [1, 0, 0], [0, 0, 0]]])
BENT = BOX[[0, 6, 2, 8]]  # two sides at a right angle
GAP = np.where(np.arange(36).reshape(12, 3, 1) == 0, 0.05, 0.0)  # [mm] of one corner
THOUSAND, SMALL = "1000 mm3, 10 x 10 x 10 mm", "8 mm3, 2 x 2 x 2 mm"
INSIDE = (
    f"a body of 8 mm3 lies inside another, both facing outwards: 1 ({THOUSAND}), 2 ({SMALL}) - take one with "
    "`body` (its number, its name, or largest), reverse the inner surface if it is a cavity, else save each "
    "body as a file of its own"
)
LOST = "where single precision keeps 8 mm: its shape is lost - export it near the origin"
CROSSES = "a cavity of 8 mm3 crosses another surface - move the cavity inside the material in CAD"
MANY_CUTS = "the surface passes through itself: 284 pairs of facets cut each other, the deepest by 0.013 mm "
DOUBLE = (
    "its volume, 3.154e+04 mm3, is more than its convex hull's, 1.716e+04: facets overlap - unite the "
    "overlapping bodies in CAD"
)
LOOSE = files.box((1, 1, 1), (3.1, 3.2, 3.3))
CROSSING = r"the surface passes through itself: \d+ pairs? of facets cut each other, the deepest by .* mm at"
SIZE = 10.0  # [mm] of the parts here


def several(*bodies):
    listed = ", ".join(f"{k} ({text})" for k, text in enumerate(bodies, 1))
    return f"holds {len(bodies)} bodies: {listed}{TAKE}"


@pytest.mark.parametrize("name", sorted(path.stem for path in BROKEN.glob("*.stl")))
def test_broken_file_is_used_or_refused(name):
    if name in REFUSED:
        assert files.refused(BROKEN / f"{name}.stl").startswith(REFUSED[name])
        return
    volume, tolerance, words = TAKEN[name]
    part = load(BROKEN / f"{name}.stl")
    assert mm3(part) == pytest.approx(volume, rel=tolerance)
    assert not part.open_surface and len(part.warnings) == (words is not None)
    assert words is None or part.warnings[0].startswith(words)


def stl(*triangles):
    return files.binary_stl(np.concatenate(triangles))


def turned(*flipped):
    triangles = BOX.copy()
    triangles[list(flipped)] = triangles[list(flipped)][:, ::-1]
    return triangles


def needles(count):
    triangles = BOX[:count].copy()
    triangles[:, 1] = triangles[:, 0]
    return triangles


def split():
    """The box, one facet of it cut in two at the middle of a side."""
    a, b, c = BOX[0]
    middle = 0.5 * (a + b)
    return stl([[a, middle, c], [middle, b, c]], BOX[1:])


@pytest.mark.parametrize(
    ("data", "volume", "warnings"),
    [
        (files.obj(BOX + 1e6 + 0.1), VOLUME, ()),  # numbers of double precision may be far off
        (files.obj(BOX, before=STRAY), VOLUME, ()),
        (stl(files.box((100.0, 50.0, 0.01))), 50.0, ()),  # a thin foil is no sheet
        *((stl(turned(*some)), VOLUME, (f"{len(some)} of 12 facets {LEFT}",))
          for some in ([0], [3, 5], [0, 2, 4, 7, 9])),
        (stl(BOX, BOX[:3]), VOLUME, ("3 duplicate facets removed",)),
        (stl(HOUSING, BESIDE), 2000.0, ("2 pairs of facets back to back (inner walls) removed",)),
        (stl(BOX, needles(1)), VOLUME, (f"1 facet {AREA}",)),
        (stl(BOX, needles(2)), VOLUME, (f"2 facets {AREA}",)),
        (files.obj(SHAKEN), VOLUME, ("joined 28 corners that nearly met others",)),
        (split(), VOLUME, ("1 edge meets neighbours half way (T-junctions): joined",)),
        (stl(HOUSING, CAVITY, CAVITY + 4.0), 1000.0 - 16.0, ()),
    ],
    ids=["far", "stray", "foil", "1 turned", "2 turned", "5 turned", "twice", "glued", "needle", "needles",
         "shaken", "split", "cavities"],
)  # fmt: skip
def test_surfaces_that_are_mended(data, volume, warnings):
    part = loaded(data)
    assert mm3(part) == pytest.approx(volume, rel=1e-5)
    assert part.warnings == warnings
    if data != split() and volume == VOLUME:
        assert (len(part.vertices), len(part.faces)) == (8, 12)


LOOSE_LINE = several("936 mm3, 10 x 10 x 10 mm", "1 mm3, 1 x 1 x 1 mm")


def moebius():
    t = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    a, b = (
        np.column_stack([(10 + s * np.cos(t / 2)) * f for f in (np.cos(t), np.sin(t))] + [s * np.sin(t / 2)])
        for s in (3.0, -3.0)
    )
    c, d = np.vstack([a[1:], b[:1]]), np.vstack([b[1:], a[:1]])
    return np.concatenate([np.stack([a, c, b], axis=1), np.stack([c, d, b], axis=1)])


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (stl(BOX + 1e8), f"lies 1e+08 mm from the origin, {LOST}"),
        (files.obj(np.zeros((1, 3, 3)), before=STRAY), POINT), (stl(LINE), POINT),
        (stl(BENT, files.inside_out(BENT)), f"encloses no volume - {CLOSED}"),
        (files.obj(moebius()), f"has one side only, like a Moebius strip - {CLOSED}"),
        (stl(BOX + GAP), "the surface is open: "),  # a visible gap is a hole
        *((stl(HOUSING, files.box((10, 10, 10), touch)), several(THOUSAND, THOUSAND))
          for touch in ((10, 10, 0), (10, 10, 10))),
        (stl(HOUSING, files.inside_out(CAVITY)), INSIDE), (stl(HOUSING, CAVITY + [8, 0, 0]), CROSSES),
        (stl(HOUSING, CAVITY + [20, 0, 0]), several(THOUSAND, SMALL)),
        (stl(HOUSING, CAVITY * 2, files.inside_out(LOOSE)), LOOSE_LINE),
        (stl(HOUSING, CAVITY * 2, LOOSE), LOOSE_LINE), (stl(files.torus_twice(2)), MANY_CUTS),
    ],
    ids=["far", "stray", "line", "sheets", "moebius", "gap", "edge in common", "corner in common", "outwards",
         "crossing", "outside", "cavity in a cavity", "loose body in a cavity", "a sheet on another"],
)  # fmt: skip
def test_surfaces_that_are_refused(data, line):
    text = refused(data)
    assert text.startswith(line) and (line.endswith(" ") or text == line)


def test_more_than_the_hull_is_refused_of_an_open_surface_too():
    assert refused(stl(files.torus_twice(2)), allow_open=True) == DOUBLE


@pytest.mark.parametrize("facet", range(12))
def test_one_facet_missing(facet):
    data = stl(np.delete(BOX, facet, axis=0))
    line = "the surface is open: 3 edges without a neighbour round 1 hole, the widest "
    assert refused(data).startswith(line)
    part = loaded(data, allow_open=True)
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-6)  # a flat hole is closed exactly
    assert (part.open_surface, part.warnings) == (True, (FILLED.format("1 hole"),))


def test_what_is_filled_in_and_what_is_no_solid(rng, monkeypatch):
    mesh = shapes.cylinder(5.0, 20.0, 100)  # a large hole is filled by a fan
    without_ends = mesh.triangles[np.abs(mesh.face_normals[:, 2]) < 0.5]
    part = loaded(stl(without_ends), allow_open=True)
    assert mm3(part) == pytest.approx(mesh.volume, rel=1e-6)
    assert part.warnings == (FILLED.format("2 holes"),)
    monkeypatch.setattr(gate, "MAX_OPEN_EDGES", 2_000)  # loose facets, and a tiny share of the hull
    line = f"the surface is open: 3000 edges without a neighbour - {CLOSED}"
    assert refused(stl(rng.random((1_000, 3, 3)) * 10.0), allow_open=True) == line
    wires = [files.box((100.0, 1e-2, 1e-2)), files.box((1e-2, 100.0, 1e-2)), files.box((1e-2, 1e-2, 100.0))]
    assert "convex hull" in refused(files.obj(np.concatenate(wires)), allow_open=True)


def twisted(turn):
    """A box of 10 mm whose upper face is turned, its corners in (8, 3)."""
    across = 5.0 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    c, s = np.cos(turn), np.sin(turn)
    upper = np.einsum("kx,yx->ky", across, np.array([[c, -s], [s, c]]))
    return np.column_stack([np.concatenate([across, upper]), np.repeat([0.0, 10.0], 4)])


def prism(corners):
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    quads = [(3, 2, 1, 0), (4, 5, 6, 7), *sides]
    return corners[np.array([(a, b, c) for a, b, c, _ in quads] + [(a, c, d) for a, _, c, d in quads])]


def spiked():
    """A box of 10 mm, the middle of its upper face drawn through the lower one."""
    tip, upper = np.array([5.0, 5.0, -4.0]), (HOUSING[:, :, 2] == 10.0).all(axis=1)
    ring = np.array([[0, 0, 10], [10, 0, 10], [10, 10, 10], [0, 10, 10.0]])
    return np.concatenate([HOUSING[~upper], np.stack([ring, np.roll(ring, -1, axis=0), [tip] * 4], axis=1)])


SWAPPED = twisted(0.0)[[0, 1, 2, 3, 5, 4, 6, 7]]  # two corners of the upper face in each other's place


def test_surfaces_that_pass_through_themselves(rng):
    for triangles in (prism(twisted(2.5)), prism(SWAPPED), spiked()):
        assert re.match(f"{CROSSING}|encloses no volume", refused(stl(triangles)))
    assert loaded(stl(prism(twisted(0.6)))).warnings == ()
    corners = spiked().reshape(-1, 3)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    for vertices in (corners, np.einsum("nx,yx->ny", corners, turn) + rng.normal(size=3)):
        joined = topology.weld_corners(np.round(vertices, 9), np.arange(len(corners)).reshape(-1, 3))
        cuts = gate.find_crossings(*joined, 1e-6)
        assert cuts.depths == pytest.approx([10.0 * 4.0 / 14.0] * 4, abs=1e-6)
        # each point of a cut lies on both facets: with their sides it makes triangles of their areas
        facets, places = joined[0][joined[1][cuts.pairs]].reshape(-1, 3, 3), np.repeat(cuts.points, 2, axis=0)
        to = facets - places[:, None]
        parts = np.linalg.norm(np.cross(to, np.roll(to, -1, axis=1)), axis=2).sum(axis=1)
        whole = np.linalg.norm(np.cross(*np.diff(facets, axis=1).swapaxes(0, 1)), axis=1)
        assert parts == pytest.approx(whole, rel=1e-6)


def double_cone(turns, corners=7):
    """Two cones over one ring that goes round several times; its corners and facets."""
    angle = 2.0 * np.pi * turns * np.arange(corners) / corners
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(corners)])
    k, after = np.arange(corners), np.roll(np.arange(corners), -1)
    upper = np.column_stack([k, after, np.full(corners, corners)])
    lower = np.column_stack([after, k, np.full(corners, corners + 1)])
    return np.concatenate([ring, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]]), np.concatenate([upper, lower])


@pytest.mark.parametrize("turns", [1, 2])
def test_what_is_seen_whole_from_its_axis_is_not_searched(turns):
    """Facets that all face away from their feet cut each other only if the surface goes round them twice."""
    vertices, faces = double_cone(turns)
    unseen = gate.unseen_facets(vertices, faces, mass.integrate_solid(vertices[faces]))
    assert (len(unseen) > 0) == (turns > 1)
    assert (len(gate.find_crossings(vertices, faces, 1e-9).pairs) > 0) == (turns > 1)


def extruded(outline, height):
    return np.array(trimesh.creation.extrude_polygon(shapely.Polygon(outline), height).triangles)


L_SHAPE = extruded([[0, 0], [10, 0], [10, 2], [2, 2], [2, 6], [0, 6]], 4.0)  # 112 mm3


def cracked(triangles, most, rng, by_plane=False):
    """An OBJ of the triangles with corners off by up to ``most``, each facet or each plane by itself."""
    if not by_plane:
        return files.obj(triangles + rng.uniform(-most, most, triangles.shape))
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    planes = np.unique(normals.round(6), axis=0, return_inverse=True)[1].ravel()
    return files.obj(triangles + rng.uniform(-most, most, (planes.max() + 1, 3))[planes][:, None])


def width(text):
    return float(re.findall(r"up to ([\d.e+-]+) mm wide", text)[0])


@pytest.mark.parametrize("by_plane", [False, True], ids=["facets", "faces"])
@pytest.mark.parametrize("most", [1e-5, 5e-5, 2e-4])
def test_cracks_are_joined_with_their_width(rng, most, by_plane):
    part = loaded(cracked(L_SHAPE, most, rng, by_plane))
    assert mm3(part) == pytest.approx(112.0, abs=120.0 * most)
    assert not part.open_surface
    text = next(text for text in part.warnings if "crack" in text)
    assert "joined" in text
    assert 0.2 * most < width(text) < 4.0 * most  # two corners are at most 2 sqrt(3) apart


def test_wide_cracks_are_refused_with_their_width_and_joined_if_asked(rng):
    data = cracked(L_SHAPE, 5e-3, rng)
    line = refused(data)
    assert 2e-3 < width(line) < 2e-2  # not the 13 mm across a facet's outline
    assert "allow_open" in line
    part = loaded(data, allow_open=True)
    assert mm3(part) == pytest.approx(112.0, rel=1e-2)
    assert part.open_surface
    assert any("crack" in text for text in part.warnings)
    # Holes beside cracks are filled after these are joined.
    data = cracked(BOX[1:], 1e-4, rng)
    assert "open" in refused(data)
    assert mm3(loaded(data, allow_open=True)) == pytest.approx(6000.0, rel=1e-3)  # it gave 1e-4 mm3


def test_no_thin_wall_slot_or_plate_is_joined_away(rng):
    outcomes = {"taken": 0, "refused": 0}
    for k in range(36):
        thin, most = SIZE * 10.0 ** rng.uniform(-4.7, -3.0), SIZE * 10.0 ** rng.uniform(-6.5, -3.7)
        fin = [[0, 0], [10, 0], [10, 2], [5 + thin, 2], [5 + thin, 4], [5, 4], [5, 2], [0, 2]]
        slot = [[0, 0], [10, 0], [10, 2], [5 + thin, 2], [5 + thin, 1], [5, 1], [5, 2], [0, 2]]
        plate = [[0, 0], [10, 0], [10, thin], [0, thin]]
        outline = (fin, slot, plate)[k % 3]
        data = cracked(extruded(outline, 6.0), most, rng)
        for allow_open in (False, True):
            try:
                part = loaded(data, allow_open=allow_open)
            except FeederError:
                outcomes["refused"] += 1
                continue
            outcomes["taken"] += 1
            assert len(part.vertices) >= 2 * len(outline)  # none of the corners on either side is lost
            slack = 0.25 if allow_open else 0.06
            assert mm3(part) == pytest.approx(6.0 * shapely.Polygon(outline).area, rel=slack), (k, thin, most)
    assert min(outcomes.values()) > 12


@pytest.mark.parametrize("count", [1, 3])
def test_stray_facets_on_a_line_are_left_out(count):
    stray = [[[0, 0, 0], [5, 0, 0], [10, 0, 0]], [[0, 0, 0], [0, 4, 0], [0, 20, 0]]]
    loose = [[[40.0, 0, 0], [41, 1, 0], [42, 2, 0]]]
    part = loaded(files.obj(np.concatenate([BOX, (stray + loose)[:count]])))
    assert (mm3(part), len(part.faces)) == (pytest.approx(6000.0), 12)
    assert np.ptp(part.vertices, axis=0) * 1e3 == pytest.approx([10.0, 20.0, 30.0])
    assert [text for text in part.warnings if "left out" in text]


# Sides [mm] and decimals of the file (None: single precision). The hull leaves out corners that rounding
# lifts, 1e-5 of the volume at most; the gate compared the volume with that hull to 1e-6.
THIN = [((60, 20, 0.5), None), ((60, 20, 0.5), 5), ((40, 10, 1), None), ((20, 20, 20), 4)]


@pytest.mark.parametrize(("sides", "decimals"), THIN)
def test_plates_with_parted_faces_are_not_more_than_their_hull(rng, sides, decimals):
    plate = trimesh.creation.box(sides).subdivide().subdivide()
    for _ in range(12):
        turned = trimesh.transformations.random_rotation_matrix(rng.random(3))
        triangles = plate.copy().apply_transform(turned).triangles + rng.uniform(0, 100, 3)
        data = files.binary_stl(triangles) if decimals is None else files.ascii_stl(triangles.round(decimals))
        assert mm3(loaded(data)) == pytest.approx(np.prod(sides), rel=1e-4 if decimals != 4 else 1e-3)


def test_a_corner_amid_a_face_that_rounding_lifts_is_no_overlap():
    cube = trimesh.creation.box((10, 10, 10)).subdivide()
    middle = int(np.argmin(np.abs(cube.vertices - (0, 0, 5)).sum(axis=1)))
    cube.vertices[middle, 2] += 5e-5  # a pyramid of 50 nm
    assert mm3(loaded(files.ascii_stl(cube.triangles))) == pytest.approx(1000 + 1e-3, rel=1e-6)


def wall(x, y=(0.0, 20.0), z=30.0):
    """Two facets across the box at x, corner to corner of its section where y and z are the box's."""
    a, b, c, d = [[x, y[0], 0.0], [x, y[1], 0.0], [x, y[1], z], [x, y[0], z]]
    return np.array([[a, b, c], [a, c, d]])


def chambers(*places):
    """The box, its skin parted at some x, with one wall at each."""
    ends = (0.0, *places, 10.0)
    pieces = [files.box((b - a, 20, 30), (a, 0, 0)) for a, b in pairwise(ends)]
    facets = np.concatenate(pieces)
    at_wall = [(facets[:, :, 0] == x).all(axis=1) for x in places]
    return stl(facets[~np.any(at_wall, axis=0)], *(wall(x) for x in places))


@pytest.mark.parametrize(
    ("data", "facets"),
    [
        (stl(BOX, wall(5.0)), 2), (stl(BOX, wall(3.0), wall(7.0)), 4), (stl(BOX, wall(5.0, (3.0, 9.0))), 2),
        (chambers(5.0), 2), (chambers(3.0, 8.0), 4),
    ],
    ids=["across", "two", "free", "one skin", "chambers"],
)  # fmt: skip
def test_sheets_within_a_body_are_no_holes(data, facets):
    part = loaded(data)
    assert mm3(part) == pytest.approx(VOLUME)
    (said,) = part.warnings
    assert said.startswith(f"{facets} facets of a sheet") and said.endswith("inside the body: left out")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (stl(BOX, wall(5.0, (0.0, 40.0))), "2 facets of a sheet|outside"),  # it may be a rib
        (stl(BOX, wall(50.0)), "2 facets of a sheet|outside"),
        (stl(HOUSING, CAVITY[1:]), "11 facets of an open surface|inside"),  # a cavity
        (stl(BOX, LOOSE[1:] + 50.0), "the surface is open|1 hole"),
    ],
    ids=["rib", "beside", "cavity", "body"],
)
def test_what_may_be_more_than_a_sheet_is_refused(data, words):
    text = refused(data)
    assert all(word in text for word in words.split("|"))
