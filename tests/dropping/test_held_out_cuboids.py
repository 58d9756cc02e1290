"""Cuboids rolled by hand on which nothing was chosen: each within the interval that is printed."""

import csv
from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew.dropping import drop_test, launch_conditions
from feederscrew.resting.aspects import find
from feederscrew.resting.rules import recommended

NOTHING = dict.fromkeys(launch_conditions.CONDITION_KEYS)
FILE = Path(__file__).parents[2] / "docs/measured/held_out/cuboids.csv"
ROWS = csv.DictReader(line for line in FILE.read_text().splitlines() if line[0] != "#")
MEASURED = {float(row["x_over_y"]): (float(row["p_square"]), int(row["n"])) for row in ROWS}


@pytest.fixture(scope="module")
def found():
    """Of each cuboid the share of its square faces in a drop test, with its interval."""
    answers = {}
    for x in MEASURED:
        part = shapes.part(shapes.box(10.0 * x, 10.0, 10.0))
        aspects = find(part)
        tally = drop_test.test(part, aspects, "roll", NOTHING, drops=2000).tally
        told = recommended.dropped(tally, "roll")
        square = int(np.abs(aspects.heights - 0.005 * x).argmin())
        answers[x] = told.p[square], told.low[square], told.high[square]
    return answers


def test_each_share_is_in_its_interval(found):
    assert len(found) == 7
    assert [x for x, (p, _) in MEASURED.items() if not found[x][1] <= p <= found[x][2]] == []


def test_they_are_off_by_little_more_than_the_tosses_own_sampling(found):
    away = [found[x][0] - p for x, (p, _) in MEASURED.items()]
    sampling = [p * (1.0 - p) / count for p, count in MEASURED.values()]
    assert np.sqrt(np.mean(np.square(away))) < 2.0 * np.sqrt(np.mean(sampling))
