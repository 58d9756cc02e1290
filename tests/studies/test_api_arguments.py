"""Arguments of the library that cannot be used: one line that names the argument, never an answer."""

import inspect
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import pytest
import shapes

import feederscrew as fs


@pytest.fixture(scope="module")
def part():
    return shapes.part(shapes.box(8.0, 12.0, 20.0))


BOWL = fs.read_bowl(None, ("track.width=40 mm",))
LAUNCHES = "give one of place, drop, flip, roll, feed"


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda part: fs.rate(part, BOWL, "C", gap=-1), "gap: is -1 - give a number from 0"),
        (lambda part: fs.rate(part, BOWL, "C", fill=5), "fill: is 5 - give a number from 1e-06 to 1"),
        (lambda part: fs.rate(part, BOWL, "C", fill="x"), "fill: is 'x', not a number - give a number"),
        (lambda part: fs.rate(part, BOWL, "C", heading=math.nan), "heading: is nan - give a number"),
        (lambda part: fs.rate(part, BOWL, "C", launch="throw"), f"launch: is 'throw' - {LAUNCHES}"),
        (lambda part: fs.drop(part, drops=-5), "drops: is -5 - give a number from 1"),
        (lambda part: fs.drop(part, launch="throw"), f"launch: is 'throw' - {LAUNCHES}"),
        (lambda part: fs.drop(part, seed=-1), "seed: is -1 - give a number from 0"),
        (lambda part: fs.drop(part, jobs=0), "jobs: is 0 - give a number from 1"),
        (lambda part: fs.size_bowl(part, 0), "target: is 0 - give a number from 1e-06"),
        (lambda part: fs.size_bowl(part, BOWL), "target: is a Bowl, not a number - give a number"),
        (lambda part: fs.rate(part, BOWL, "C", seed=-1), "seed: is -1 - give a number from 0"),
        (lambda part: fs.rate(part, BOWL, "C", fed=0), "fed: is 0 - give a number from 1"),
        (lambda part: fs.design(part, 0), "target: is 0 - give a number from 1e-06"),
        (lambda part: fs.tune(part, BOWL, "C", -3), "target: is -3 - give a number from 1e-06"),
        (lambda part: fs.tune(part, BOWL, None, 1), "aspect: is None - give the name of an aspect, 'A'"),
        (lambda part: fs.headings(part, BOWL, 5), "aspect: is 5 - give the name of an aspect, 'A'"),
        (lambda part: fs.load(part), "source: is a Part - give the path of a file"),
        (lambda part: fs.convey(None), "bowl: is None - give a Bowl, as read_bowl returns it"),
        (lambda part: fs.rate(BOWL, part), "part: is a Bowl - give a Part, as load returns it"),
        (
            lambda part: fs.rate(part, BOWL, "C", aspect_shares=3),
            "aspect_shares: is 3 - give what shares returned",
        ),
        (lambda part: fs.shake(part, [BOWL], drops=-5), "drops: is -5 - give a number from 1"),
        (lambda part: fs.shake(part, [BOWL], seconds=-1), "seconds: is -1 - give a number from 1e-06"),
        (
            lambda _: fs.convey(replace(BOWL, gravity=-1.0)),
            "gravity: is not above 0 - give m/s2, 9.81 on earth",
        ),
        (
            lambda part: fs.rate(part, replace(BOWL, gravity=-1.0), "C"),
            "gravity: is not above 0 - give m/s2, 9.81 on earth",
        ),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(part, call, line):
    with pytest.raises(fs.FeederError) as caught:
        call(part)
    assert str(caught.value) == line


def test_the_seed_of_the_parts_on_the_floor_is_that_of_the_command(part, run):
    """It was called fed_seed here, and --seed there."""
    part_file = "block.stl"
    shapes.box(8.0, 12.0, 20.0).export(part_file)
    found = [fs.rate(part, BOWL, "A", fed=60, seed=seed) for seed in (1, 2)]
    assert found[0].parts.value != found[1].parts.value
    call = (
        "rate",
        part_file,
        "--aspect",
        "A",
        "--set",
        "track.width=40 mm",
        "--fed",
        "60",
        "--format",
        "json",
    )
    for seed, one in enumerate(found, start=1):
        said = json.loads(run(*call, "--seed", seed).stdout)
        assert said["answer"] == one.answer == f"fed onto the moving floor, 60 parts, seed {seed}"
        assert said["parts_per_minute"] == pytest.approx(60.0 * one.parts.value, rel=1e-9)


def test_a_bowl_keeps_what_its_file_lists(part, tmp_path):
    (tmp_path / "b.yaml").write_text("track: {width: 40 mm}\ndevices:\n  - wiper: 10 mm\n")
    bowl = fs.read_bowl(tmp_path / "b.yaml")
    found = fs.rate(part, bowl, "A")
    assert found.rate.orientations.stations == ("track", "wiper")
    assert fs.rate(part, bowl, "A", devices=()).rate.orientations.stations == ("track",)


@pytest.mark.parametrize(("room", "module"), [("tooling", "orientations"), ("trial", "staging")])
def test_a_function_that_shares_its_name_with_a_room_hides_no_module(room, module):
    """``import feederscrew.tooling.x as y`` failed once the function was asked for."""
    function = getattr(fs, room)
    assert callable(function)
    assert inspect.isfunction(function)
    known = {}
    exec(f"import feederscrew.{room}.{module} as found", known)  # the statement itself is what is looked at
    assert known["found"].__name__ == f"feederscrew.{room}.{module}"
    assert getattr(fs, room) is function


@pytest.mark.parametrize("void", [(), ("another part",)])
def test_a_bowl_is_sized_at_the_stroke_of_a_trial_that_is_still_of_it(monkeypatch, void):
    """`feeder bowl` keeps that stroke: the library denied it, and took the one of the static rule."""
    asked = {}
    tried = SimpleNamespace(void=lambda *_: iter(void))
    monkeypatch.setattr("feederscrew.bowl.verified", lambda path: tried)
    monkeypatch.setattr("feederscrew.studies.bowl.bowl", lambda *_, **options: asked.update(options))
    fs.size_bowl(shapes.part(shapes.box(4.0, 5.0, 6.0)), "30/min", "A")
    assert asked["as_tried"] is not bool(void)
