"""An orientation has one name: what tables and drawings print, 'A@178', each ``--aspect`` takes."""

from pathlib import Path

import click
import pytest

from feederscrew.bowl.devices.orientation_names import NAMED
from feederscrew_cli import options

BRACKET = Path(__file__).parents[2] / "parts/lbracket_30x20x15.stl"


def test_the_name_of_an_orientation_is_its_aspect_and_its_heading(run_json):
    once = run_json("track", BRACKET, "--aspect", "A@178")
    assert once == run_json("track", BRACKET, "--aspect", "A", "--heading", "178deg")
    assert once != run_json("track", BRACKET, "--aspect", "A")
    assert run_json("headings", BRACKET, "--aspect", "a@178") == run_json(
        "headings", BRACKET, "--aspect", "A"
    )


def test_a_trial_sends_the_orientation_that_is_named(run_json):
    document = run_json("trial", BRACKET, "--aspect", "A@178", "--parts", "2", "--rule", "csa")
    assert [row["share"] for row in document["orientations"] if row["tried"]] == [1.0]


def test_a_heading_is_given_once(run):
    result = run("track", BRACKET, "--aspect", "A@178", "--heading", "10deg")
    assert result.exit_code == 2 and "names a heading" in result.output


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("C@174 hanging", ("C", 174.0, "hanging")),
        ("A@354", ("A", 354.0, "any")),
        ("head_up@0 hanging 2", ("head_up", 0.0, "hanging")),
        ("A", ("A", None, "any")),
    ],
)
def test_what_hangs_names_its_outcome(name, said):
    @click.command()
    @options.choice("--outcome", ["any", "lying", "hanging"], "How.", default="any")
    @options.heading("DEG", "Heading.")
    @options.aspect("Aspect.")
    def command(aspect, heading, outcome):
        told.append((aspect, heading, outcome))

    told = []
    command.main(["--aspect", name], standalone_mode=False)
    ((aspect, heading, outcome),) = told
    assert (aspect, outcome) == said[::2] and heading == (
        said[1] and pytest.approx(said[1] * 0.017453292519943295)
    )
    assert options.ORIENTATION.pattern == NAMED.pattern
