"""The study of the rate: which orientation it is of, where none is asked for."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew import load, read_bowl
from feederscrew.resting.aspects import find
from feederscrew.studies import rate as rates
from feederscrew.studies.rate import most_frequent, rate

PARTS = Path(__file__).parents[2] / "parts"


def test_the_rate_is_of_the_orientation_that_leaves_most_often():
    known = SimpleNamespace(
        aspects=("A", "A", "B"),
        headings=np.array([0.0, 1.0, 2.0]),
        leaving=np.diag([0.0, 1.0, 1.0]),
        leaves_as=np.arange(3),
        rules={"pmi": np.array([0.6, 0.1, 0.3]), "csa": np.array([np.nan, np.nan, np.nan])},
    )
    assert most_frequent(known, "pmi") == ("B", 2.0)  # 0.6 never passes
    assert most_frequent(known, "csa") == ("A", 0.0)


def test_no_other_orientation_has_a_higher_rate():
    """A along the wall takes more of the track than A across it, and leaves more often all the same."""
    part, bowl = load(PARTS / "lbracket_30x20x15.stl"), read_bowl()
    chosen = rate(part, bowl).rate
    across = rate(part, bowl, "A", heading=np.pi / 2.0).rate
    assert chosen.orientations.aspects[chosen.row] == "A"
    assert chosen.efficiency > 1.5 * across.efficiency


@pytest.mark.parametrize(("first", "fed"), [(0.45, [400]), (0.36, [400, None])])
def test_few_parts_show_the_likeliest_aspect_where_its_share_is_clear(monkeypatch, first, fed):
    """Intervals of 400 parts reach 0.05 to either side (Wilson): 0.45 is clear of 0.33, 0.36 is not."""
    part, counts = load(PARTS / "lbracket_30x20x15.stl"), []
    at_rest = find(part)
    p = np.zeros(len(at_rest.names))
    p[:3] = first, 0.33, 0.67 - first
    answer = replace(at_rest, recommended=replace(at_rest.recommended, p=p))

    def shares(part, bowl, *, fed=None, **_):
        counts.append(fed)
        return rates.Shares(answer, fed=True)

    monkeypatch.setattr(rates, "shares", shares)
    monkeypatch.setattr("feederscrew.dropping.arrival.MAX_ARRIVALS", 4000)  # tests feed fewer
    assert rates.likeliest(part, read_bowl()).likeliest == at_rest.names[0]
    assert counts == fed
