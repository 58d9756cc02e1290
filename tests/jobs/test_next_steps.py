"""The next steps go by the status as it is, and by no part of its words."""

import pytest

from feederscrew.bowl.verified import HELD
from feederscrew.jobs.serving.next_steps import next_steps
from feederscrew.jobs.serving.orders import PageOrder


@pytest.mark.parametrize("status", [*HELD, "holds nothing", "falls short", None])
def test_only_what_holds_has_no_next_step(status):
    order = PageOrder.__new__(PageOrder)
    steps = next_steps(order, {"status": status, "partial": True})
    assert bool(steps) == (status == "holds nothing" or status == "falls short")
