"""Groups of unlike lengths in one array."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from feederscrew.geometry import graphs

GROUPS = st.lists(st.lists(st.integers(0, 99), min_size=1).map(np.array), min_size=1)


@given(GROUPS)
def test_sums_are_of_each_group(given_groups):
    members, owners = graphs.join_groups(given_groups)
    both = np.stack([members, 2 * members])
    expected = np.array([group.sum() for group in given_groups])
    np.testing.assert_array_equal(graphs.group_sums(members, owners, len(expected)), expected)
    np.testing.assert_array_equal(graphs.group_sums(both, owners, len(expected)), np.outer(expected, [1, 2]))
