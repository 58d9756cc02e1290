"""Cuboids rolled by hand on which nothing was chosen: each within the interval that is printed."""

import csv
from pathlib import Path

import numpy as np
import shapes

from feederscrew.arrivals import drop_test, launch_conditions
from feederscrew.resting.aspects import find

NOTHING = dict.fromkeys(launch_conditions.CONDITION_KEYS)
FILE = Path(__file__).parents[2] / "docs/measured/held_out/cuboids.csv"


def test_each_share_is_in_its_interval_and_off_by_little_more_than_the_tosses_own_sampling():
    rows = list(csv.DictReader(line for line in FILE.read_text().splitlines() if line[0] != "#"))
    assert len(rows) == 7
    errors, sampling = [], []
    for row in rows:
        x, measured = float(row["x_over_y"]), float(row["p_square"])
        part = shapes.part(shapes.box(10.0 * x, 10.0, 10.0))
        aspects = find(part)
        answer = drop_test.test(part, aspects, "roll", NOTHING, drops=2000).tally.answer("roll")
        square = int(np.abs(aspects.heights - 0.005 * x).argmin())
        assert answer.low[square] <= measured <= answer.high[square], x
        errors.append(answer.p[square] - measured)
        sampling.append(measured * (1.0 - measured) / int(row["n"]))
    assert np.sqrt(np.mean(np.square(errors))) < 2.0 * np.sqrt(np.mean(sampling))
