"""How a part lies, by what of it touches: shapes of which anybody sees the word."""

from pathlib import Path

import numpy as np
import pytest
import round_bodies
import shapes
import trimesh

from feederscrew.arrivals.aspects_study import aspects as study_of
from feederscrew.output import aspects as aspects_output
from feederscrew.part import load
from feederscrew.resting import lying
from feederscrew.resting.aspects import find
from feederscrew.resting.lying import Lies
from feederscrew.resting.posture import posture

ROOT = Path(__file__).parents[2]
LARGEST, FACE, END, EDGES, ROLLS = Lies
TETRAHEDRON = trimesh.convex.convex_hull(np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) * 9.0)
CHANNEL = [(0, 0), (20, 0), (20, 9), (18, 9), (18, 2), (2, 2), (2, 9), (0, 9)]  # sheet of 2 mm
CUP = trimesh.Trimesh(
    **trimesh.triangles.to_kwargs(
        round_bodies.revolved([(0, 0), (0, 7), (10, 7), (10, 6), (2, 6), (2, 0)], 48)  # of 1 mm, open above
    )
)

# mesh; words from the lowest centre of mass to the highest
SHAPES = {
    "box": (shapes.box(30, 20, 5), [LARGEST, FACE, END]),
    "cube": (shapes.box(10, 10, 10), [FACE]),
    "square plate": (shapes.box(20, 20, 3), [LARGEST, FACE]),  # no side of it is the longest
    "square bar": (shapes.box(30, 8, 8), [LARGEST, END]),
    "disc": (shapes.cylinder(8.0, 3.0, 48), [LARGEST, ROLLS]),
    "pin": (shapes.cylinder(3.0, 20.0, 48), [ROLLS, END]),
    "ball": (shapes.ball(5.0, 3), [ROLLS]),
    "nut": (shapes.cylinder(7.5, 6.5, 6), [LARGEST, FACE]),
    "tetrahedron": (TETRAHEDRON, [FACE]),
    # on the broad leg, on the edges of both profiles, on the ends of both legs, on the short leg
    "bracket": (shapes.prism(shapes.l_profile(), 15.0), [LARGEST, EDGES, EDGES, EDGES, END]),
    # flanges up; flanges down; on a flange's outside; on end
    "channel": (shapes.prism(CHANNEL, 40.0), [LARGEST, EDGES, FACE, END]),
    "cup": (CUP, [LARGEST, EDGES, ROLLS]),
}


def words(part):
    aspects = find(part)
    order = np.argsort(np.round(aspects.heights, 7), kind="stable")
    return [aspects.lies[row] for row in order]


@pytest.mark.parametrize("name", SHAPES)
def test_twelve_shapes_lie_as_anybody_would_say(name, rng):
    mesh, expected = SHAPES[name]
    assert words(shapes.part(mesh)) == words(shapes.part(shapes.turned(mesh, rng))) == expected


def test_noise_of_a_file_takes_no_face_from_a_box(rng):
    mesh = shapes.noisy(shapes.subdivided(shapes.box(30, 20, 5), 3), 0.02, rng)
    aspects = find(shapes.part(mesh))
    likely = aspects.heights < 1.1 * aspects.heights.min()
    assert {lies for lies, low in zip(aspects.lies, likely) if low} <= {LARGEST, FACE}


def test_material_that_touches_is_what_the_floor_sees():
    """The bracket on both profile edges: 96 of 348 mm2 by hand, less than 30 %."""
    part = shapes.part(shapes.prism(shapes.l_profile(), 15.0))
    aspects = find(part)
    areas = [lying.touching_area(part, n, h) * 1e6 for n, h in zip(aspects.normals, aspects.heights)]
    assert sorted(np.round(areas, 6)) == [0.0, 96.0, 96.0, 300.0, 450.0]


def test_table_document_picture_and_record_say_the_same():
    part = load(ROOT / "parts/lbracket_30x20x15.stl")
    study = study_of(part, drops=0)
    table, document = study.table(), aspects_output.document(study)
    assert not {"kind", "form"} & set(table)
    assert list(table["lies"]) == list(study.aspects.lies) == [one.lies for one in study.aspects]
    assert [row["lies"] for row in document["aspects"].rows()] == list(table["lies"])
    assert not any(table["rolls"]) and {one.rolls for one in study.aspects} == {False}
    for name, lies in zip(study.aspects.names, study.aspects.lies):
        assert posture(part, study.aspects, name).lies == lies
    drawn = aspects_output.aspect_views(part, study.aspects, range(len(study.aspects.names)))
    said = " ".join(text.get_text() for axes in drawn.axes for text in axes.texts)
    assert "on its largest face ×1" in said and "on edges" in said


def test_a_card_has_no_shape_and_does_not_say_how_it_lies():
    aspects = find(load(ROOT / "parts/arc_chute.yaml"))
    assert set(aspects.lies) == {""}
