"""The gate: every kind of damaged surface is mended and said, or refused in one line."""

from pathlib import Path

import numpy as np
import part_files as files
import pytest
import shapes

from feederscrew.part import load

BROKEN = Path(__file__).parents[1] / "data" / "broken"
BOX = files.box()
VOLUME = 6000.0  # [mm3] of that box
CLOSED = "export it as a closed solid"
OPEN = "close it in CAD, or pass `allow_open` to compute from what there is"
SPLIT = (
    "save each body as a file of its own, or unite them in CAD if they are one part;"
    " or pass `allow_open` to take them as one part"
)

TAKE = f" - take one with `body` (its number, its name, or largest), {SPLIT}"


def several(*bodies):
    """The line that lists bodies: volume and size of each."""
    listed = ", ".join(f"{k} ({text})" for k, text in enumerate(bodies, 1))
    return f"holds {len(bodies)} bodies: {listed}{TAKE}"


TAKEN = {  # file: volume [mm3], its relative tolerance, warnings
    "count_zero_hexbolt": (
        1675.738,
        1e-6,
        ("the header says 0 facets, the file has 476: all of them are read",),
    ),
    "faroff_lbracket": (
        1379.2795,
        3e-3,
        ("lies 1e+05 mm from the origin, where single precision keeps 0.0078 mm: export it near the origin",),
    ),
    "hollow_box": (784.0, 1e-6, ()),
    "inch_lbracket": (
        1379.2795 / 25.4**3,
        1e-5,
        (
            "the largest dimension, 1.18 mm, is small for a fed part: "
            "if the file is in inches or centimetres, pass `units` in",
        ),
    ),
    "inverted_lbracket": (1379.2795, 1e-6, ("all facets pointed inwards; reversed",)),
    "mixed_winding_lbracket": (
        1379.2795,
        1e-6,
        ("76 of 532 facets pointed the other way than the rest; reversed",),
    ),
    "solid_header_binary": (1675.738, 1e-6, ()),
}
REFUSED = {
    "flat_sheet": f"is flat: all its corners lie in one plane - {CLOSED}",
    "nan_lbracket": "facet 1 of 532 has a corner that is not a finite number - export the part again",
    "not_an_stl": "is an HTML page, not a part - export the part as STL, OBJ, PLY, OFF, GLB, 3MF or STEP",
    "open_lbracket": (
        "the surface is open: 32 edges without a neighbour round 10 holes, the widest 33.3 mm across at "
        f"(16.58, -1.772, 0) - {OPEN}"
    ),
    "truncated_hexbolt": (
        "is cut short: 476 facets announced, 316 are there - export the part again, or copy the whole file"
    ),
    "two_nuts": "holds 2 bodies: 1 (302.5 mm3, 11.55 x 10 x 5.2 mm), 2 (302.5 mm3, 11.55 x 10 x 5.2 mm)"
    + TAKE,
    "zero_bytes": "is empty - export the part again",
}


def of(folder, triangles, **options):
    """Part of some triangles."""
    return load(files.written(folder, np.asarray(triangles)), **options)


def mm3(part):
    return part.volume * 1e9


def test_every_broken_file_is_listed():
    assert {path.stem for path in BROKEN.glob("*.stl")} == {*TAKEN, *REFUSED}


@pytest.mark.parametrize("name", TAKEN)
def test_broken_file_that_can_be_used(name):
    volume, tolerance, warnings = TAKEN[name]
    part = load(BROKEN / f"{name}.stl")
    assert mm3(part) == pytest.approx(volume, rel=tolerance)
    assert part.warnings == warnings
    assert not part.open_surface


@pytest.mark.parametrize("name", REFUSED)
def test_broken_file_that_is_refused(name):
    assert files.refused(BROKEN / f"{name}.stl") == REFUSED[name]


def test_part_too_far_off_is_refused(tmp_path):
    path = files.written(tmp_path, BOX + 1e8)
    assert files.refused(path) == (
        "lies 1e+08 mm from the origin, where single precision keeps 8 mm: its shape is lost"
        " - export it near the origin"
    )


def test_numbers_of_double_precision_may_be_far_off(tmp_path):
    part = load(files.written(tmp_path, files.obj(BOX + 1e6 + 0.1), "far.obj"))
    assert part.warnings == ()
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-8)


def test_corners_that_no_facet_uses_do_not_count(tmp_path):
    stray = b"v nan nan nan\nv 1e9 0 0\n"
    part = load(files.written(tmp_path, files.obj(BOX, before=stray), "stray.obj"))
    assert mm3(part) == pytest.approx(VOLUME)
    assert part.warnings == ()
    needle = np.zeros((1, 3, 3))
    path = files.written(tmp_path, files.obj(needle, before=stray), "needle.obj")
    assert files.refused(path) == f"is a line or a point: no facet has an area - {CLOSED}"


def test_line_point_and_sheets_have_no_volume(tmp_path):
    line = np.array([[[0, 0, 0], [1, 0, 0], [0, 0, 0]]])
    assert (
        files.refused(files.written(tmp_path, line))
        == f"is a line or a point: no facet has an area - {CLOSED}"
    )
    bent = BOX[[0, 6, 2, 8]]  # two sides at a right angle, each from both sides
    both = np.concatenate([bent, files.inside_out(bent)])
    assert files.refused(files.written(tmp_path, both)) == f"encloses no volume - {CLOSED}"


def test_thin_foil_is_no_sheet(tmp_path):
    assert mm3(of(tmp_path, files.box((100.0, 50.0, 0.01)))) == pytest.approx(50.0, rel=1e-5)


@pytest.mark.parametrize("facet", range(12))
def test_one_facet_missing(tmp_path, facet):
    path = files.written(tmp_path, np.delete(BOX, facet, axis=0))
    line = files.refused(path)
    assert line.startswith("the surface is open: 3 edges without a neighbour round 1 hole, the widest ")
    part = load(path, allow_open=True)
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-6)  # a flat hole is closed exactly
    assert part.open_surface
    assert part.warnings == ("the surface is open: 1 hole filled in for these numbers (`allow_open`)",)


def test_large_hole_is_filled_by_a_fan(tmp_path):
    mesh = shapes.cylinder(5.0, 20.0, 100)
    triangles = mesh.triangles[np.abs(mesh.face_normals[:, 2]) < 0.5]  # without its ends
    part = of(tmp_path, triangles, allow_open=True)
    assert mm3(part) == pytest.approx(mesh.volume, rel=1e-6)
    assert part.warnings == ("the surface is open: 2 holes filled in for these numbers (`allow_open`)",)


def test_loose_facets_are_no_solid(tmp_path, rng):
    path = files.written(tmp_path, rng.random((40_000, 3, 3)) * 10.0)
    line = f"the surface is open: 120000 edges without a neighbour - {CLOSED}"
    assert files.refused(path) == line
    assert files.refused(path, allow_open=True) == line


@pytest.mark.parametrize("flipped", [[0], [3, 5], [0, 2, 4, 7, 9]])
def test_mixed_winding_is_turned(tmp_path, flipped):
    triangles = BOX.copy()
    triangles[flipped] = triangles[flipped][:, ::-1]
    part = of(tmp_path, triangles)
    assert mm3(part) == pytest.approx(VOLUME)
    assert part.warnings == (f"{len(flipped)} of 12 facets pointed the other way than the rest; reversed",)


def test_moebius_strip_is_refused(tmp_path):
    t = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    edge = lambda s: np.column_stack(  # noqa: E731
        [(10 + s * np.cos(t / 2)) * np.cos(t), (10 + s * np.cos(t / 2)) * np.sin(t), s * np.sin(t / 2)]
    )
    a, b = edge(3.0), edge(-3.0)
    c, d = np.vstack([a[1:], b[:1]]), np.vstack([b[1:], a[:1]])
    strip = np.concatenate([np.stack([a, c, b], axis=1), np.stack([c, d, b], axis=1)])
    path = files.written(tmp_path, files.obj(strip), "moebius.obj")
    assert files.refused(path) == f"has one side only, like a Moebius strip - {CLOSED}"


def test_facets_given_twice(tmp_path):
    part = of(tmp_path, np.concatenate([BOX, BOX[:3]]))
    assert mm3(part) == pytest.approx(VOLUME)
    assert len(part.faces) == 12
    assert part.warnings == ("3 duplicate facets removed",)


def test_inner_walls_of_glued_boxes(tmp_path):
    first, second = files.box((10, 10, 10)), files.box((10, 10, 10), (10, 0, 0))
    part = of(tmp_path, np.concatenate([first, mirrored_wall(second)]))
    assert mm3(part) == pytest.approx(2000.0)
    assert part.warnings == ("2 pairs of facets back to back (inner walls) removed",)


def mirrored_wall(triangles):
    """The second box mirrored onto itself, so that its wall has the first one's diagonal."""
    return files.inside_out(triangles * [-1, 1, 1] + [30, 0, 0])


@pytest.mark.parametrize(
    ("count", "said"), [(1, "1 facet without area removed"), (2, "2 facets without area removed")]
)
def test_facets_without_area_are_left_out_and_said_in_one_warning(tmp_path, count, said):
    needle = BOX[:count].copy()
    needle[:, 1] = needle[:, 0]
    part = of(tmp_path, np.concatenate([BOX, needle]))
    assert mm3(part) == pytest.approx(VOLUME)
    assert part.warnings == (f"{said}: two corners in one place",)
    assert len(part.faces) == 12


def test_corners_that_nearly_meet_are_joined(tmp_path, rng):
    gaps = rng.uniform(-5e-6, 5e-6, BOX.shape)
    part = load(files.written(tmp_path, files.obj(BOX + gaps), "gaps.obj"))
    assert mm3(part) == pytest.approx(VOLUME, rel=1e-5)
    assert len(part.vertices) == 8
    assert part.warnings == ("joined 28 corners that nearly met others",)


def test_a_visible_gap_is_a_hole(tmp_path):
    gap = BOX.copy()
    gap[0, 0] += 0.05
    assert files.refused(files.written(tmp_path, gap)).startswith("the surface is open: ")


def test_t_junctions_are_joined(tmp_path):
    halves = BOX[0], BOX[1:]
    a, b, c = halves[0]
    middle = 0.5 * (a + b)
    split = np.concatenate([[[a, middle, c], [middle, b, c]], halves[1]])
    part = of(tmp_path, split)
    assert mm3(part) == pytest.approx(VOLUME)
    assert part.warnings == ("1 edge meets neighbours half way (T-junctions): joined",)


@pytest.mark.parametrize("touch", [(10, 10, 0), (10, 10, 10)], ids=["edge", "corner"])
def test_bodies_that_touch_are_two(tmp_path, touch):
    path = files.written(tmp_path, np.concatenate([files.box((10, 10, 10)), files.box((10, 10, 10), touch)]))
    assert files.refused(path) == several(*["1000 mm3, 10 x 10 x 10 mm"] * 2)


CAVITY = files.inside_out(files.box((2, 2, 2), (1, 1, 1)))
HOUSING = files.box((10, 10, 10))


def test_cavities_are_taken_off(tmp_path):
    part = of(tmp_path, np.concatenate([HOUSING, CAVITY, CAVITY + 4.0]))
    assert mm3(part) == pytest.approx(1000.0 - 16.0)
    assert part.warnings == ()


@pytest.mark.parametrize(
    ("inner", "line"),
    [
        (files.inside_out(CAVITY),
         "a body of 8 mm3 lies inside another, both facing outwards: 1 (1000 mm3, 10 x 10 x 10 mm), 2 (8"
         " mm3, 2 x 2 x 2 mm) - take one with `body` (its number, its name, or largest), reverse the "
         "inner surface if it is a cavity, else save each body as a file of its own"),
        (CAVITY + np.array([8, 0, 0]),
         "a cavity of 8 mm3 crosses another surface - move the cavity inside the material in CAD"),
        (CAVITY + np.array([20, 0, 0]), several("1000 mm3, 10 x 10 x 10 mm", "8 mm3, 2 x 2 x 2 mm")),
        (np.concatenate([CAVITY * 2, files.inside_out(files.box((1, 1, 1), (3.1, 3.2, 3.3)))]),
         several("936 mm3, 10 x 10 x 10 mm", "1 mm3, 1 x 1 x 1 mm")),
        (np.concatenate([CAVITY * 2, files.box((1, 1, 1), (3.1, 3.2, 3.3))]),
         several("936 mm3, 10 x 10 x 10 mm", "1 mm3, 1 x 1 x 1 mm")),
    ],
    ids=["outwards", "crossing", "outside", "cavity in a cavity", "loose body in a cavity"],
)  # fmt: skip
def test_inner_surface_that_is_no_cavity(tmp_path, inner, line):
    assert files.refused(files.written(tmp_path, np.concatenate([HOUSING, inner]))) == line


def test_volume_above_the_hull_is_refused(tmp_path):
    assert of(tmp_path, files.torus_twice(1)).volume > 0.0
    line = files.refused(files.written(tmp_path, files.torus_twice(2)))
    assert line == (
        "its volume, 3.154e+04 mm3, is more than its convex hull's, 1.716e+04: facets overlap"
        " - unite the overlapping bodies in CAD"
    )


def test_given_facets_of_a_part_stay_as_they_are(tmp_path):
    part = of(tmp_path, BOX)
    assert {tuple(sorted(map(tuple, part.vertices[face].round(6)))) for face in part.faces} == {
        tuple(sorted(map(tuple, (triangle * 1e-3).round(6)))) for triangle in BOX
    }
