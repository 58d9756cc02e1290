"""Names that a user gives the aspects of a part: they stay with its sides, whatever the ranks are."""

from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew import load, write_names
from feederscrew.base.errors import FeederError
from feederscrew.jobs import batch
from feederscrew.jobs.batch import task, work
from feederscrew.part.card import read_aspect_names
from feederscrew.resting import aspects
from feederscrew.resting.aspects import find
from feederscrew_cli.main import feeder

PARTS = Path(__file__).resolve().parents[2] / "parts"
BRACKET = PARTS / "lbracket_30x20x15.stl"
OTHER = "4,-6,8"  # [mm] a centre of mass, as of a bracket with an insert
EXAMPLE = "write a line an aspect such as 'head_up: [0, 0, -1]' below 'aspects:'"
THREE = "write three numbers, as [0, 0, -1]"
NO_NAME = "cannot be the name of an aspect"
LETTERS = "give 1 to 12 letters, digits, '-', '_' and '.', the first a letter or a digit"


def sides(resting):
    return dict(zip(resting.names, resting.normals.round(6).tolist()))


@pytest.fixture
def box(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shapes.box(10.0, 20.0, 30.0).export(tmp_path / "box.stl")
    return "box.stl"


def written(text):
    Path("n.yaml").write_text(text)
    return "n.yaml"


def named(part, text, **options):
    resting = find(load(part, names=written(text), **options))
    return resting.names, resting.warnings


def test_a_name_stays_where_the_centre_of_mass_changes_the_order(tmp_path):
    part = load(BRACKET)
    before, moved = find(part), find(load(BRACKET, centre_of_mass=OTHER))
    same = [name for name in before.names if sides(before)[name] == sides(moved).get(name)]
    assert len(same) < len(before.names)  # letters mean other sides now
    write_names(part, before, tmp_path / "n.yaml")
    kept = find(load(BRACKET, centre_of_mass=OTHER, names=tmp_path / "n.yaml"))
    common = set(kept.names) & set(before.names)
    assert common and all(sides(kept)[name] == sides(before)[name] for name in common)
    assert np.array_equal(kept.normals, moved.normals)  # rows are by rank all the same
    again = find(load(BRACKET, names=tmp_path / "n.yaml"))
    assert again.names == before.names and not again.warnings


def test_names_of_a_box(box):
    lines = ["  on_end: [0, 0, 1]", "  edgeways: [0, 2, 0]", "  flat: [-0.5, 0, 0.01]"]
    for order in (lines, lines[::-1]):  # whatever the order of the file
        assert named(box, "\n".join(["aspects:", *order])) == (("flat", "edgeways", "on_end"), ())
    names, warnings = named(box, "aspects:\n  A: [0, 0, 1]\n  b: [0, 1, 1]\n  lid: [0, 0, -1]\n")
    assert names == ("C", "D", "A")  # neither A nor B is given a second time
    assert warnings == (
        "n.yaml: the part rests on no aspect 'b' (0, 0.707, 0.707 down)",
        "n.yaml: 'lid' is one aspect with 'A' and goes by that name",
        "n.yaml has no name for the aspect with 1, 0, 0 down: it is called C",
        "n.yaml has no name for the aspect with 0, 1, 0 down: it is called D",
    )
    # Faces that are equal no more are two aspects.
    names, warnings = named(box, "aspects:\n  wide: [1, 0, 0]\n", centre_of_mass="-3,0,0")
    assert names.count("wide") == 1 and len(names) > 3 and len(warnings) == len(names) - 1


def test_a_rolling_class_is_found_again_with_other_facets(box):
    coarse, fine = (shapes.cylinder(5.0, 20.0, count) for count in (40, 64))
    directions = sides(find(shapes.part(fine)))
    assert directions.keys() == sides(find(shapes.part(coarse))).keys()
    assert directions != sides(find(shapes.part(coarse)))
    coarse.export("pin.stl")
    lines = [f"  {name}_of_old: {down}" for name, down in directions.items()]
    names = tuple(f"{name}_of_old" for name in find(load("pin.stl")).names)
    assert named("pin.stl", "\n".join(["aspects:", *lines])) == (names, ())


def test_a_direction_between_two_aspects_is_refused(box, monkeypatch):
    monkeypatch.setitem(aspects.NAMING_REACH, "flat", np.radians(15.0))  # within the usual one they are one
    shapes.prism([(0, 0), (30, 0), (30, 20), (14, 23), (0, 20)], 8.0).export("roof.stl")
    with pytest.raises(FeederError) as caught:
        named("roof.stl", "aspects:\n  top: [0, 1, 0]\n")
    assert str(caught.value).endswith(
        "n.yaml: the direction of 'top' is 11 and 12 deg off two aspects of the part - "
        "write the direction of the one that is meant"
    )


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("- a\n", f"1:1: is not a block of names - {EXAMPLE}"),
        ("aspects:\n", f"1:1: names no aspect - {EXAMPLE}"),
        ("aspect:\n  a: [0, 0, 1]\n", "1:1: unknown key 'aspect' - did you mean aspects?"),
        *((f"aspects:\n  {name}: [0, 0, 1]\n", f"2:3: '{name}' {NO_NAME} - {LETTERS}")
          for name in ("=1+1", "a b", "a@90", "a" * 13)),
        ('aspects:\n  "a\\eb": [0, 0, 1]\n', f"2:3: 'a b' {NO_NAME} - {LETTERS}"),
        ("aspects:\n  None: [0, 0, 1]\n", f"2:3: 'None' {NO_NAME} - choose another"),
        ("aspects: {a: [0, 0, 1], A: [0, 1, 0]}\n",
         "1:25: 'A' and 'a' differ in case only - give each its own name"),
        ("aspects: {a: [0, 0, 1], b: [0, 0, 3]}\n", "1:25: 'b' has the direction of 'a' - keep one of them"),
        ("aspects:\n  a: [0, 0]\n", f"2:6: the direction of 'a' is not a list of three - {THREE}"),
        ("aspects:\n  a: [0, 0, 0]\n", f"2:6: the direction of 'a' is zero - {THREE}"),
        ("aspects:\n  a: [0, x, 0]\n", f"2:6: the direction of 'a': 'x' is not a number - {THREE}"),
    ],
)  # fmt: skip
def test_every_fault_of_a_file_of_names_has_its_line(box, text, line):
    with pytest.raises(FeederError) as caught:
        read_aspect_names(written(text))
    assert f"n.yaml:{line}" in caught.value.lines


def test_every_command_that_reads_a_part_takes_names(box, run):
    takers = {name for name, command in feeder.commands.items() for p in command.params if p.name == "names"}
    assert takers == {
        "advise", "aspects", "inertia", "drop", "calibrate", "compare", "design", "floor", "track",
        "headings", "rate", "tune", "tooling", "trial", "bowl", "report",
    }  # fmt: skip
    written("aspects:\n  on_end: [0, 0, 1]\n")
    answer = run("headings", box, "--names", "n.yaml", "--aspect", "On_End", "--format", "csv")
    assert answer.exit_code == 0 and answer.stdout.splitlines()[1].startswith("on_end,")
    refused = run("aspects", PARTS / "arc_chute.yaml", "--names", "n.yaml")
    assert refused.stderr == "Error: --names: a part card has its own - leave it out\n"


def test_a_batch_and_a_file_of_counts_go_by_names(box, run):
    written("aspects:\n  flat: [1, 0, 0]\n  edge: [0, 1, 0]\n  end: [0, 0, 1]\n")
    Path("list.csv").write_text("part,names,aspect\nbox.stl,n.yaml,edge\nbox.stl,,B\n")
    by_name, by_letter = batch.gather(["list.csv"])
    assert by_name.names.names == ("flat", "edge", "end") and by_letter.names is None
    Path("gone.csv").write_text("part,names\nbox.stl,no.yaml\n")
    with pytest.raises(FeederError) as caught:
        batch.gather(["gone.csv"])
    assert caught.value.lines == ("gone.csv:2: no.yaml: no such file - check the path",)
    choices, data = batch.Choices(pictures=False), Path(box).read_bytes()
    tasks = [task.Task.of(request, choices, data) for request in (by_name, by_letter)]
    assert tasks[0].key != tasks[1].key
    assert [work.work(job).row["aspect"] for job in tasks] == ["edge", "B"]
    head = "# part: box.stl\n# names: n.yaml\naspect,tosses\n"
    Path("counts.csv").write_text(f"{head}end,5\nflat,60\nedge,20\n")
    answer = run("compare", "counts.csv", "--format", "json")
    assert answer.exit_code == 0 and '"flat"' in answer.stdout
