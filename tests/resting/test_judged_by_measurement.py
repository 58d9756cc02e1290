"""Constants that were chosen on measured sets, judged by those sets."""

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from feederscrew.arrivals.drop import drop
from feederscrew.feeding.compare import compare_sets
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.deviation import total_variation
from feederscrew.resting.rules import recommended

MEASURED = Path(__file__).parents[2] / "docs/measured"


def test_the_share_of_hops_of_drop_is_nearest_to_what_was_measured():
    """Of each set of a part that was dropped: no share a twentieth away is nearer."""
    chosen, judged = recommended.HOP_SHARES["drop"], 0
    for study in compare_sets(sorted(MEASURED.glob("*.csv"))).sets:
        if study.part.vertices is None or study.measured.head.launch != "drop":
            continue
        aspects, judged = find(study.part), judged + 1
        shares = np.zeros(len(aspects.stable))
        shares[aspects.stable] = study.profile.fractions / study.profile.fractions.sum()
        error = {
            share: total_variation(recommended.temper_shares(aspects.chances, share)[1], shares)
            for share in (chosen - 0.05, chosen, chosen + 0.05)
        }
        assert min(error, key=error.get) == chosen
    assert judged >= 2


def simulated():
    """Measured and simulated share of each class that was measured, and the tosses and drops behind them."""
    shares = {path.stem: counts_of(path) for path in MEASURED.glob("*.csv")}
    text = (Path(__file__).parents[1] / "data/launched_shares.csv").read_text()
    rows = list(csv.DictReader(line for line in text.splitlines() if line[0] != "#"))
    return rows, *np.array([shares[row["set"]][row["class"]] for row in rows]).T


def counts_of(path):
    """Share of each class in a file of counts, and how many tosses that is; NaN where it is not given."""
    head, *lines = [line for line in path.read_text().splitlines() if line and line[0] != "#"]
    values = {name: float(first) for name, first, *_ in (line.split(",") for line in lines)}
    total = sum(values.values())
    tosses = total if head.endswith("tosses") else np.nan
    return {name: (value / total, tosses) for name, value in values.items()}


def test_what_a_launchs_name_leaves_open_is_what_the_measured_sets_are_off_by():
    """95 % of a new one, normal about zero, whose standard deviation may be anything: on a grid of it."""
    rows, shares, tosses = simulated()
    p, drops = (np.array([float(row[name]) for row in rows]) for name in ("simulated", "drops"))
    shape = recommended.shape(p)
    noise = (np.nan_to_num(shares * (1.0 - shares) / tosses) + p * (1.0 - p) / drops) / shape**2
    spread = np.linspace(1e-4, 0.5, 4000)[:, None]
    density = stats.norm.pdf((shares - p) / shape, scale=np.sqrt(spread**2 + noise)).prod(axis=1)
    reaches = np.linspace(0.05, 0.2, 1501)
    held = (density * (2.0 * stats.norm.cdf(reaches[:, None] / spread[:, 0]) - 1.0)).sum(axis=1)
    width = reaches[np.argmax(held >= 0.95 * density.sum())]
    assert width == pytest.approx(recommended.LAUNCH_WIDTH, abs=0.006)


@pytest.mark.parametrize("name", ["t_shape", "short_cube"])
def test_the_shares_that_the_launchs_name_was_judged_by_are_those_of_a_drop_test(name):
    part = load(str(MEASURED / f"{name}.stl"))
    shares = dict(zip(find(part).names, drop(part, "drop", drops=1000, seed=5).tally.p))
    for row in (row for row in simulated()[0] if row["set"] == name):
        share = float(row["simulated"])
        assert shares[row["class"]] == pytest.approx(share, abs=4.0 * np.sqrt(share * (1.0 - share) / 1000))
