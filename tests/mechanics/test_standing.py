"""Which aspect ``feeder floor`` and ``feeder track`` take where none is asked for."""

import json
import re
from pathlib import Path

import pytest

PARTS = Path(__file__).parents[2] / "parts"
CARD, BRACKET = PARTS / "arc_chute.yaml", PARTS / "lbracket_30x20x15.stl"
LISTED = """
mass: 2 g
centre_of_mass: [0 mm, 0 mm, 0 mm]
inertia: [[100 g mm2, 0 g mm2, 0 g mm2], [0 g mm2, 100 g mm2, 0 g mm2], [0 g mm2, 0 g mm2, 100 g mm2]]
aspects:
  - {aspect: x, height: 3 mm, polar_inertia: 100 g mm2}
  - {aspect: y, height: 2 mm, polar_inertia: 100 g mm2}
"""


@pytest.mark.parametrize("command", ["floor", "track"])
@pytest.mark.parametrize(
    ("part", "aspect", "why"),
    [
        (CARD, "5", "the one of the card's {} block"),
        (BRACKET, "A", r"the likeliest \(fed onto the moving floor, \d+ parts, seed 1\)"),
    ],
    ids=["card", "mesh"],
)
def test_an_aspect_is_chosen_and_told(run, command, part, aspect, why):
    chosen, asked = (run(command, part, *given, "--format", "json") for given in ([], ["--aspect", aspect]))
    assert json.loads(chosen.stdout) == json.loads(asked.stdout)
    first, rest = chosen.stderr.split("\n", maxsplit=1)
    assert re.fullmatch(f"Aspect {aspect}, {why.format(command) if part == CARD else why}", first)
    assert rest == asked.stderr


def test_of_a_card_that_analyses_none_the_first_is_taken(run, tmp_path):
    (tmp_path / "card.yaml").write_text(LISTED)
    assert run("floor", "card.yaml").stderr.splitlines()[0] == "Aspect x, the first of the card"
