"""The library's public names: quick to import, and what the commands print."""

import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import feederscrew as fs
from feederscrew.output import tables

ROOT = Path(__file__).parent.parent
BRACKET = ROOT / "parts/lbracket_30x20x15.stl"


@pytest.fixture(scope="module")
def bracket():
    return fs.load(BRACKET)


def test_importing_the_library_imports_nothing_heavy():
    code = "import sys, feederscrew; dir(feederscrew); print(*{'numpy', 'pandas'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert (done.stdout.strip(), done.stderr) == ("", "")


def test_every_public_name_is_there_and_no_other():
    for name in fs.__all__:
        assert getattr(fs, name).__name__ == name
        assert name in dir(fs)
    with pytest.raises(AttributeError, match="no attribute 'lod'"):
        fs.lod


def test_a_shell_completes_the_names_of_the_library_only():
    """It listed `sys`, `functools`, `importlib` and every folder that was imported."""
    code = "import feederscrew.batch, feederscrew as fs; fs.rate; print(*[n for n in dir(fs) if n[0] != '_'])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert done.stdout.split() == sorted(fs.__all__) and done.stderr == ""
    assert all(inspect.isfunction(one) or inspect.isclass(one) for one in map(fs.__getattr__, fs.__all__))


def test_a_public_name_is_never_the_room_of_that_name():
    """Importing a room would put it in the place of the function."""
    code = "import feederscrew.tooling.isolating.chain, feederscrew.trial.course, feederscrew as fs; "
    code += "from feederscrew import tooling; print(tooling is fs.tooling, callable(fs.trial))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert (done.stdout.strip(), done.stderr) == ("True True", "")


def test_every_command_that_computes_has_a_function_and_takes_the_same_name():
    from feederscrew_cli.main import feeder

    other = {"batch", "completion", "config", "doctor", "serve"}  # of files and of this program
    named = {"bowl": "size_bowl", "drop --plate": "shake"}
    wanted = {named.get(name, name) for name in set(feeder.list_commands(None)) - other} | {"shake"}
    assert wanted <= set(fs.__all__)
    assert all(callable(getattr(fs, name)) for name in wanted)


def test_aspects_are_what_the_command_prints(run, bracket):
    printed = run("aspects", BRACKET, "--format", "csv", "-q").stdout
    assert tables.text(tables.frame(dict(fs.aspects(bracket).to_frame())), "csv") == printed


def test_a_rate_is_what_the_command_says(run, bracket):
    import json

    said = json.loads(run("rate", BRACKET, "--aspect", "A", "--format", "json", "-q").stdout)
    found = fs.rate(bracket, fs.read_bowl(), "A")
    assert found.parts.value * 60.0 == pytest.approx(said["parts_per_minute"], rel=1e-12)
    assert fs.convey(fs.read_bowl()).answer.velocity * 1e3 == pytest.approx(said["velocity_mm_s"], rel=1e-12)


def test_a_drop_test_and_a_plate_are_what_the_command_says(run, bracket):
    import json

    call = ("drop", BRACKET, "--drops", 60, "--seed", 3, "--format", "json", "-q")
    said = json.loads(run(*call, "--friction", "0.3").stdout)
    tally = fs.drop(bracket, drops=60, seed=3, friction="0.3").tally
    assert [row["count"] for row in said["aspects"]] == tally.counts.tolist()
    plate = json.loads(run(*call, "--plate", "--seconds", 0.5).stdout)["plates"][0]
    (shaken,) = fs.shake(bracket, fs.read_bowl(), drops=60, seed=3, seconds=0.5).plates
    assert plate["velocity_mm_s"] == pytest.approx(1e3 * shaken.occupancy.velocity[0])


def test_types_are_there_for_a_checker():
    assert (ROOT / "feederscrew/py.typed").exists()
    for name in fs.__all__:
        function = getattr(fs, name)
        if (
            callable(function)
            and not isinstance(function, type)
            and function.__module__.startswith("feederscrew.studies")
        ):
            assert "return" in function.__annotations__, name


@pytest.mark.parametrize(
    ("conditions", "line"),
    [
        ({"fall": "x mm"}, "fall: 'x mm' is not a number - write digits with a decimal point, as in 0.4"),
        ({"friction": "9"}, "friction: '9' is out of range - give 0 to 5"),
    ],
)
def test_a_fault_names_the_argument_not_an_option(bracket, conditions, line):
    with pytest.raises(fs.ConfigError) as caught:
        fs.drop(bracket, **conditions)
    assert str(caught.value) == line


WRONG = {
    "aspects(p, surface='icy')": "surface: is 'icy' - give soft, medium and hard or an exponent",
    "tooling(p, b, play='2 kg')": "play: '2 kg' is a mass, not a length - give it in mm",
    "tooling(p, b, purity=2)": "purity: is 2 - give a number from 0 to 1",
    "tooling(p, b, 5)": "aspect: is 5 - give the name of an aspect, 'A'",
    "tooling(p, b, aspect_shares=4)": "aspect_shares: is 4 - give what shares returned",
    "trial(p, b, 7)": "aspect: is 7 - give the name of an aspect, 'A'",
    "trial(p, b, seconds='2 mm')": "seconds: '2 mm' is a length, not a time - give it in s",
    "trial(p, b, landing=-2)": "landing: is -2 - give a number from 1",
    "trial(p, b, seed=-1)": "seed: is -1 - give a number from 0",
    "design(p, '60/min', aspect_shares=3)": "aspect_shares: is 3 - give what shares returned",
    "design(p, '60/min', aspect=4)": "aspect: is 4 - give the name of an aspect, 'A'",
    "design(p, '60/min', outcome='round')": "outcome: is 'round' - give any, lying and hanging",
    "design(p, '60/min', diameter=(2, 1))": "diameter: is from 2 to 1 - give the smaller and the larger",
    "design([], '60/min')": "part: is [] - give a Part, as load returns it",
    "report(p, fill=3)": "fill: is 3 - give a number from 1e-06 to 1",
    "report(p, bowl='bowl.yaml')": "bowl: is 'bowl.yaml' - give a dict of path and overrides",
    "report(p, bowl={'file': 1})": "bowl: has a key 'file' - give a dict of path and overrides",
}


@pytest.mark.parametrize("call", WRONG)
def test_a_wrong_call_is_a_line_that_names_the_argument(bracket, call):
    """They were a KeyError, a TypeError of an addition, an AttributeError of a number, or no fault."""
    with pytest.raises(fs.ConfigError) as caught:
        eval(f"fs.{call}", {"fs": fs, "p": bracket, "b": fs.read_bowl()})
    assert str(caught.value) == WRONG[call]


def test_an_unknown_keyword_is_answered_with_those_that_are_known(bracket):
    bowl = fs.read_bowl()
    for search in (fs.tooling, fs.trial):
        with pytest.raises(TypeError, match=r"'colour' - known are part, .*\bseed\b"):
            search(bracket, bowl, colour=1)
    for call in (fs.rate, fs.shares, fs.tune, fs.trial, fs.shake):
        with pytest.raises(TypeError, match="did you mean 'seed'"):
            call(bracket, bowl, sed=2)
    with pytest.raises(TypeError, match="did you mean 'amplitude'"):
        fs.convey(bowl, amplitud="0.3 mm")
    with pytest.raises(TypeError, match=r"machine\.leaves.*sizing\.leaves"):
        fs.convey(bowl, leaves=4)


def test_a_pair_of_quantities_is_one_or_the_smaller_and_the_larger():
    from feederscrew.studies import arguments

    assert arguments.pair("diameter", "300 mm", "length") == pytest.approx((0.3, 0.3))
    assert arguments.pair("diameter", (0.2, "1 m"), "length") == pytest.approx((0.2, 1.0))
