"""The library's public names: quick to import, and what the commands print."""

import inspect
import math
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace

import pytest
import shapes
from command_lines import BRACKET, ROOT

import feederscrew as fs
from feederscrew.base.columns import Frame
from feederscrew.bowl import arguments
from feederscrew.output import tables
from feederscrew_cli.main import feeder

FUNCTIONS = {name: getattr(fs, name) for name in fs.__all__ if inspect.isfunction(getattr(fs, name))}
BOWL = fs.read_bowl(None, ("track.width=40 mm",))


@pytest.fixture(scope="module")
def bracket():
    return fs.load(BRACKET)


@pytest.fixture(scope="module")
def part():
    return shapes.part(shapes.box(8.0, 12.0, 20.0))


@pytest.mark.parametrize(
    ("code", "printed"),
    [
        ("import sys, feederscrew; dir(feederscrew); print(*{'numpy', 'pandas'} & set(sys.modules))", ""),
        # it listed `sys`, `functools`, `importlib` and every folder that was imported
        ("import feederscrew.jobs.batch, feederscrew as fs; fs.rate;"
         " print(*[n for n in dir(fs) if n[0] != '_'])", " ".join(sorted(fs.__all__))),
        # importing a room would put it in the place of the function
        ("import feederscrew.sorting.isolating.chain, feederscrew.trials.course, feederscrew as fs;"
         " from feederscrew import tooling; print(tooling is fs.tooling, callable(fs.trial))", "True True"),
    ],
    ids=["nothing heavy", "names alone", "no rooms"],
)  # fmt: skip
def test_an_import_of_the_library_brings_its_names_and_nothing_else(code, printed):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert (done.stdout.strip(), done.stderr) == (printed, "")


def test_every_public_name_is_there_and_every_command_that_computes_has_its_function():
    for name in fs.__all__:
        value = getattr(fs, name)
        assert value.__name__ == name and name in dir(fs)
        assert inspect.isfunction(value) or inspect.isclass(value)
    with pytest.raises(AttributeError, match="lod"):
        fs.lod
    other = {
        "batch",
        "cache",
        "completion",
        "config",
        "doctor",
        "sample",
        "serve",
    }  # of files and of this program
    commands = (set(feeder.list_commands(None)) - other - {"bowl"}) | {"size_bowl", "shake"}
    assert commands <= set(FUNCTIONS)
    # Signatures list each keyword with its type.
    assert len(FUNCTIONS) > 20 and (ROOT / "feederscrew/py.typed").exists()
    for name, function in FUNCTIONS.items():
        parameters = inspect.signature(function).parameters
        assert "return" in function.__annotations__, name
        assert len(parameters) <= 16, name
        for parameter in parameters.values():
            assert parameter.kind is not parameter.VAR_KEYWORD or name in ("read_bowl", "sweep"), name
            assert parameter.annotation is not parameter.empty, name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_help_of_a_function_fits_a_screen(name, capsys):
    """That of rate had 98 parameters and a line of 3,406 letters."""
    help(FUNCTIONS[name])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 60 and max(map(len, lines)) <= 120
    assert f"{name}(" in "".join(lines) and "feederscrew." not in lines[3]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_help_tells_each_parameter_with_its_type(name):
    """The API page gives names of one entry one default: seven parameters of report had that of the first."""
    parameters = inspect.signature(FUNCTIONS[name]).parameters
    section = inspect.getdoc(FUNCTIONS[name]).partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    told = []
    for line in section.splitlines():
        names, _, kind = line.partition(" : ")
        if line[:1].strip():
            entry = [parameters[word.strip().lstrip("*")] for word in names.split(",")]
            assert kind or entry[0].kind is inspect.Parameter.VAR_POSITIONAL, line
            assert len({parameter.default for parameter in entry}) == 1, line
            told += [parameter.name for parameter in entry]
    assert sorted(told) == sorted(parameters)


def test_a_signature_that_is_shown_is_the_one_that_is_called():
    assert {"aspect", "gap", "fed"} <= set(inspect.signature(fs.rate).parameters)
    assert str(inspect.signature(fs.find_aspects)).startswith("(part: Part, *, unstable: bool = False")
    assert inspect.signature(fs.tooling).parameters["purity"].default == 1.0


def test_answers_are_what_the_commands_say(run, run_json, bracket):
    printed = run("aspects", BRACKET, "--format", "csv", "-q").stdout
    assert tables.text(Frame.of(dict(fs.aspects(bracket).to_frame())), "csv") == printed
    said, bowl = run_json("rate", BRACKET, "--aspect", "A", "-q"), fs.read_bowl()
    rate = fs.rate(bracket, bowl, "A").parts.value
    assert rate * 60.0 == pytest.approx(said["parts_per_minute"], rel=1e-12)
    assert fs.convey(bowl).answer.velocity * 1e3 == pytest.approx(said["velocity_mm_s"], rel=1e-12)
    call = ("drop", BRACKET, "--drops", 60, "--seed", 3, "-q")
    tally = fs.drop(bracket, drops=60, seed=3, friction="0.3").tally
    counts = [row["count"] for row in run_json(*call, "--friction", "0.3")["aspects"]]
    assert counts == tally.counts.tolist()
    (plate,) = run_json(*call, "--plate", "--seconds", 0.5)["plates"]
    (shaken,) = fs.shake(bracket, bowl, drops=60, seed=3, seconds=0.5).plates
    assert plate["velocity_mm_s"] == pytest.approx(1e3 * shaken.occupancy.velocity[0])


WRONG = {
    "rate(p, b, 'A', gap=-1)": "gap: is -1 - give a number from 0",
    "rate(p, b, 'A', gap='2 s')": "gap: '2 s' is a time, not a length - give it in mm",
    "rate(p, b, 'A', fill='x')": "fill: is 'x', not a number - give a number",
    "rate(p, b, 'A', heading=math.nan)": "heading: is nan - give a number",
    "rate(p, b, 'A', fed=0)": "fed: is 0 - give a number from 1",
    "rate(b, p)": "part: is a Bowl - give a Part, as load returns it",
    "rate(p, replace(b, gravity=-1.0), 'A')": "gravity: is not above 0 - give m/s2, 9.81 on earth",
    "drop(p, drops=2.5)": "drops: is 2.5 - give a whole number",
    "drop(p, launch='throw')": "launch: is 'throw' - give one of place, drop, flip, roll, feed",
    "size_bowl(p, '60/min', bowl=3)": "bowl: is 3 - give a Bowl, as read_bowl returns it",
    "read_bowl(3)": "path: is 3 - give the path of a file",
    "tune(p, b, 'A', '60')": "target: '60' has no unit - write 60/min",
    "tune(p, b, None, 1)": "aspect: is None - give the name of an aspect, 'A'",
    "load('x.stl', density=7)": "density: is 7 kg/m3 - give kg/m3, 7850 for steel, or a text, '7.85 g/cm3'",
    "load(p)": "source: is a Part - give the path of a file, a mesh, (vertices, faces), or a solid of "
    "build123d or cadquery",
    "convey(None)": "bowl: is None - give a Bowl, as read_bowl returns it",
    "shake(p, None)": "bowls: is None - give a Bowl, as read_bowl returns it, or several in a list",
    "shake(p, [])": "bowls: is empty - give a Bowl, as read_bowl returns it",
    "posture(p, 3, 'A')": "aspects: is 3 - give Aspects, as find_aspects returns them",
    "aspects(p, surface='icy')": "surface: is 'icy' - give soft, medium and hard or an exponent",
    "tooling(p, b, purity=2)": "purity: is 2 - give a number from 0 to 1",
    "tooling(p, b, aspect_shares=4)": "aspect_shares: is 4 - give what shares returned",
    "design(p, '60/min', outcome='round')": "outcome: is 'round' - give any or lying or hanging",
    "design(p, '60/min', diameter=(2, 1))": "diameter: is from 2 to 1 - give the smaller and the larger",
    "design([], '60/min')": "part: is [] - give a Part, as load returns it",
    "report(p, fill=3)": "fill: is 3 - give a number from 1e-06 to 1",
    "report(p, bowl='bowl.yaml')": "bowl: is 'bowl.yaml' - give a Bowl, as read_bowl returns it",
    "tooling(p, b, search=3)": "search: is 3 - give a ToolingSearch",
}


@pytest.mark.parametrize("call", WRONG)
def test_a_wrong_call_is_a_line_that_names_the_argument(bracket, call):
    """They were a KeyError, a TypeError of an addition, an AttributeError of a number, or no fault."""
    with pytest.raises(fs.FeederError) as caught:
        eval(f"fs.{call}", {"fs": fs, "p": bracket, "b": fs.read_bowl(), "math": math, "replace": replace})
    assert str(caught.value) == WRONG[call]


def test_an_unknown_keyword_is_answered_with_those_that_are_known(bracket):
    bowl = fs.read_bowl()
    for search in (fs.tooling, fs.trial):
        with pytest.raises(TypeError, match=r"'colour' - known are part, .*\bprogress\b"):
            search(bracket, bowl, colour=1)
    for call in (fs.rate, fs.shares, fs.tune, fs.trial, fs.shake):
        with pytest.raises(TypeError, match="did you mean 'seed'"):
            call(bracket, bowl, sed=2)
    with pytest.raises(TypeError, match="did you mean 'amplitude'"):
        fs.convey(bowl, amplitud="0.3 mm")
    with pytest.raises(TypeError, match=r"machine\.leaves.*sizing\.leaves"):
        fs.convey(bowl, leaves=4)


def test_a_pair_of_quantities_is_one_or_the_smaller_and_the_larger():
    assert arguments.pair("diameter", "300 mm", "length") == pytest.approx((0.3, 0.3))
    assert arguments.pair("diameter", (0.2, "1 m"), "length") == pytest.approx((0.2, 1.0))


def test_the_seed_of_the_parts_on_the_floor_is_that_of_the_command(part, run_json):
    """It was called fed_seed here, and --seed there."""
    shapes.box(8.0, 12.0, 20.0).export("block.stl")
    first, second = studies = [fs.rate(part, BOWL, "A", fed=60, seed=seed) for seed in (1, 2)]
    assert first.parts.value != second.parts.value
    call = ("rate", "block.stl", "--aspect", "A", "--set", "track.width=40 mm", "--fed", "60", "--seed")
    for seed, study in enumerate(studies, start=1):
        said = run_json(*call, seed)
        assert said["answer"] == study.answer == f"fed onto the moving floor, 60 parts, seed {seed}"
        assert said["parts_per_minute"] == pytest.approx(60.0 * study.parts.value, rel=1e-9)


@pytest.mark.parametrize("void", [(), ("another part",)])
def test_a_bowl_is_sized_at_the_stroke_of_a_trial_that_is_still_of_it(monkeypatch, part, void):
    """`feeder bowl` keeps that stroke: the library denied it, and took the one of the static rule."""
    taken = {}
    tried = SimpleNamespace(void=lambda *_: iter(void))
    monkeypatch.setattr("feederscrew.bowl.verified", lambda path: tried)
    monkeypatch.setattr("feederscrew.machine.sheet.size_machine", lambda *_, **options: taken.update(options))
    fs.size_bowl(part, "30/min", "A")
    assert taken["as_tried"] is not bool(void)
