"""A part counts as wanted by what was asked for, never as wrong because its heading has no name."""

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import proposals, queues, robust, trying
from feederscrew.designing.record import DesignRequest
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.trial.queue import QueuedParts


@pytest.fixture(scope="module")
def block():
    part = shapes.part(shapes.box(20, 12, 5))
    ways = proposals.known_through(part, find(part), bowls.default())
    return part, find(part), ways, {one.name: k for k, one in enumerate(ways.lying)}


def seen(leaving, aspects):
    """A queue of which so many parts left in each orientation, the last in none, and on each aspect."""
    return QueuedParts(
        parts=12, on_track=9, poured=False, seconds=60.0, counted=50.0, delivered=float(sum(leaving)),
        leaving=np.array(leaving), aspects=np.array(aspects), returned=3, jams=0, climbs=0, velocity=0.05,
        gap=0.01, touching=0.2, pressure=np.zeros(0), depth=0.0, partial=False,
    )  # fmt: skip


def test_a_queue_counts_an_aspect_that_is_asked_for_however_its_parts_are_turned(block):
    """Of 16 parts that left 15 lie on A, 5 of them at a heading that is none of the known."""
    part, aspects, ways, names = block
    leaving = np.zeros(len(ways.states) + 1, int)
    leaving[[names["A@0"], names["A@90"], -1]] = 4, 6, 6
    on = [15 if name == "A" else 0 for name in aspects.names]
    queue = seen(leaving, [*on, 1])

    def right(any_heading):
        row = queues.FollowedRow(part, None, aspects, ways, None, (names["A@0"],), 1, any_heading=any_heading)
        found = row.count("low", 0.5, queue)
        assert found.left == 16
        return found.right

    assert right(()) == 4  # A@0 alone was asked for
    assert right(("A",)) == 15


def test_a_wanted_orientation_counts_beside_an_aspect_that_may_be_up(block):
    part, aspects, ways, names = block
    leaving = np.zeros(len(ways.states) + 1, int)
    other = next(k for k, one in enumerate(ways.states) if one.aspect == "B")
    leaving[[names["A@0"], other, -1]] = 3, 5, 4
    on = {"A": 6, "B": 5}
    queue = seen(leaving, [*(on.get(name, 0) for name in aspects.names), 1])
    row = queues.FollowedRow(part, None, aspects, ways, None, (other,), 1, any_heading=("A",))
    assert row.wanted_parts(queue) == 5 + 6


def test_single_parts_and_draws_count_the_aspect_alike(block):
    part, aspects, ways, names = block
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    bowl, rows = bowls.default(), (names["A@0"], names["A@90"])
    own = {"rows": rows, "each": 1, "run": RunSettings(1), "aspects": aspects}
    alone = trying.single(part, bowl, ways, shares, rows[0], **own)
    free = trying.single(part, bowl, ways, shares, rows[0], any_heading=("A",), **own)
    assert (list(alone.wrong), list(free.wrong)) == ([0, 1], [0, 0])
    assert free.purity == 1.0
    only = np.zeros(len(shares))
    only[rows[1]] = 1.0
    drawn = {"draws": 1, "tolerance": 1e-5, "run": RunSettings(1)}
    assert robust.robust_run(part, bowl, ways, only, rows[0], **drawn).held == 0
    assert robust.robust_run(part, bowl, ways, only, rows[0], any_heading=("A",), **drawn).held == 1


def test_what_is_round_in_plan_counts_at_any_heading_unless_one_is_asked_for():
    disc = shapes.part(shapes.cylinder(10, 4, 48))
    ways = proposals.known_through(disc, find(disc), bowls.default())
    lying = [k for k, one in enumerate(ways.lying) if one.kind == "flat"]
    assert lying
    for k in lying:
        assert trying.aspects_at_any_heading(ways.lying, k, ()) == (ways.lying[k].aspect,)
        assert trying.aspects_at_any_heading(ways.lying, k, (), heading_given=True) == ()
    request = DesignRequest(1.0, up=(ways.lying[lying[0]].aspect.lower(),), heading=None)
    assert proposals.free_headings(ways.lying, lying[0], request) == (ways.lying[lying[0]].aspect,)
