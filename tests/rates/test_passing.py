"""Shares that pass the devices of a bowl, from the shares of the aspects."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.errors import FeederError
from feederscrew.rates import stream
from feederscrew.resting import profiles

KNOWN = SimpleNamespace(
    names=("track", "wiper_1", "gap_2", "gap_3"),
    stations=("track", "wiper", "gap", "gap"),
    aspects=("A", "A", "B"),
    heading_shares=np.array([0.25, 0.75, 1.0]),
    passes=np.array([[1.0, 0.5, 1.0, 0.0], [1.0, 1.0, 0.0, 1.0], [0.0, 1.0, 0.4, 1.0]]),
)


def counted(*rows):
    text = "\n".join(["device,passed,rejected", *rows])
    return profiles.device_counts(profiles.parse_count_sheet(text, "c.csv"), "c.csv", "")


def test_parts_are_followed_from_device_to_device():
    flow = stream.station_shares(KNOWN, ("A", "B", "C"))
    np.testing.assert_allclose(flow[0], [[1, 1, 0], [1, 0, 0], [0.875, 0, 0], [0.125, 0, 0]])
    share = stream.passing_shares(flow, np.array([0.5, 0.2, 0.3]))
    np.testing.assert_allclose(share, [0.5 / 0.7, 0.875, 0.125 / 0.875, 0.0])
    assert np.isnan(stream.passing_shares(flow, np.array([0.0, 1.0, 0.0]))[1])


shares = st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3).map(np.array)


@settings(max_examples=60, deadline=None)
@given(shares, shares, shares, shares)
def test_the_ends_are_those_of_the_corners(came, through, one, other):
    flow = np.stack([came, came * through])[:, None]
    low, high = np.minimum(one, other), np.maximum(one, other)
    corners = np.array(list(product(*zip(low, high))))
    total = corners @ came
    every = (corners @ (came * through))[total > 0.0] / total[total > 0.0]
    found = np.array(stream.passing_ends(flow, low, high))[:, 0]
    if not len(every):
        assert np.isnan(found).all()
    else:
        np.testing.assert_allclose(found, [every.min(), every.max()], rtol=1e-9, atol=1e-12)


def test_devices_are_known_by_their_names():
    assert stream.counted_stations(KNOWN, counted("gap_3,1,2", "wiper,3,4", "track,1,0")).tolist() == [
        3,
        1,
        0,
    ]
    with pytest.raises(FeederError, match=r"c.csv:2: the bowl has no device 'gap' - did you mean gap_"):
        stream.counted_stations(KNOWN, counted("gap,1,2"))
    with pytest.raises(FeederError, match=r"c.csv:3: device 'wiper' is that of line 2 - keep one of them"):
        stream.counted_stations(KNOWN, counted("wiper_1,1,2", "wiper,1,2"))


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        (["wiper,1"], "c.csv:2: has 1 value after the device - give the parts that passed and those"),
        (["gap,1,x"], "c.csv:2: rejected: 'x' is not a number of parts - give a whole number up to 1e"),
        (["gap,0,0"], "c.csv:2: no part came to device 'gap' - remove the row"),
        (["gap,1,2", "gap,1,3"], "c.csv:3: device 'gap' is already in line 2 - keep one of them"),
        ([], "c.csv: has no device - give a header 'device,passed,rejected' and one row a device"),
    ],
)
def test_faults_of_a_feeding_test(rows, line):
    with pytest.raises(FeederError) as caught:
        counted(*rows)
    assert str(caught.value).startswith(line)
