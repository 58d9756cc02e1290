"""The study of the rate: which orientation it is of, where none is asked for."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np

from feederscrew import load, read_bowl
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
