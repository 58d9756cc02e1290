"""The study of the rate: which orientation it is of, where none is asked for."""

from types import SimpleNamespace

import numpy as np

from feederscrew.studies.rate import most_frequent


def test_the_rate_is_of_the_orientation_that_leaves_most_often():
    known = SimpleNamespace(
        aspects=("A", "A", "B"),
        headings=np.array([0.0, 1.0, 2.0]),
        states=tuple(SimpleNamespace(length=length) for length in (1.0, 4.0, 1.0)),
        leaving=np.diag([0.0, 1.0, 1.0]),
        leaves_as=np.arange(3),
        rules={"pmi": np.array([0.6, 0.3, 0.1]), "csa": np.array([np.nan, np.nan, np.nan])},
    )
    assert most_frequent(known, "pmi") == ("B", 2.0)  # 0.1 / 1 beats 0.3 / 4; 0.6 never passes
    assert most_frequent(known, "csa") == ("A", 0.0)
