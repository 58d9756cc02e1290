"""A part counts as wanted by what was asked for, never as wrong because its heading has no name."""

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import proposals, queues, short_trials
from feederscrew.designing.record import DesignRequest
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.trial.queue import QueuedParts


@pytest.fixture(scope="module")
def block():
    part = shapes.part(shapes.box(20, 12, 5))
    ways = proposals.known_through(part, find(part), bowls.default())
    return part, find(part), ways, {one.name: k for k, one in enumerate(ways.lying)}


def seen(leaving, lying):
    """A queue of which so many parts left in each orientation, the last in none; ``lying`` on each aspect."""
    whole = np.zeros((len(leaving), len(next(iter(lying.values())))), int)
    for k, row in lying.items():
        whole[k] = row
    assert whole.sum(axis=1).tolist() == list(leaving)
    return QueuedParts(
        parts=12, on_track=9, poured=False, seconds=60.0, counted=50.0, delivered=float(sum(leaving)),
        whole=whole, left_by_entry=whole[None], returned_by_entry=np.array([3]), returned=3,
        jams=0, climbs=0, velocity=0.05,
        gap=0.01, touching=0.2, pressure=np.zeros(0), depth=0.0, partial=False,
    )  # fmt: skip


def test_a_queue_counts_an_aspect_that_is_asked_for_however_its_parts_are_turned(block):
    """Of 16 parts that left 15 lie on A, 5 of them at a heading that is none of the known."""
    part, aspects, ways, names = block
    leaving = np.zeros(len(ways.states) + 1, int)
    leaving[[names["A@0"], names["A@90"], -1]] = 4, 6, 6
    on, nowhere = np.eye(len(aspects.names) + 1, dtype=int)[[list(aspects.names).index("A"), -1]]
    queue = seen(leaving, {names["A@0"]: 4 * on, names["A@90"]: 6 * on, -1: 5 * on + nowhere})

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
    a, b, nowhere = (np.eye(len(aspects.names) + 1, dtype=int)[list(aspects.names).index(n)] for n in "ABC")
    queue = seen(leaving, {names["A@0"]: 3 * a, other: 5 * b, -1: 3 * a + nowhere})
    row = queues.FollowedRow(part, None, aspects, ways, None, (other,), 1, any_heading=("A",))
    assert row.wanted_parts(queue) == 5 + 6


def test_a_part_counts_once_whose_orientation_and_whose_face_are_both_wanted(block):
    """Askew, a part is nearest in attitude to B and has A below it: one part, of eight that left."""
    part, aspects, ways, _ = block
    leaving = np.zeros(len(ways.states) + 1, int)
    other = next(k for k, one in enumerate(ways.states) if one.aspect == "B")
    leaving[[other, -1]] = 5, 3
    a, b, c = (np.eye(len(aspects.names) + 1, dtype=int)[list(aspects.names).index(n)] for n in "ABC")
    queue = seen(leaving, {other: 2 * a + 3 * b, -1: c + 2 * a})
    row = queues.FollowedRow(part, None, aspects, ways, None, (other,), 1, any_heading=("A",))
    assert row.wanted_parts(queue) == 5 + 2
    assert row.count("low", 0.5, queue).left == 8


def test_single_parts_and_draws_count_the_aspect_alike(block):
    part, aspects, ways, names = block
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    bowl, rows = bowls.default(), (names["A@0"], names["A@90"])
    own = {"rows": rows, "each": 1, "run": RunSettings(1), "aspects": aspects}
    alone = short_trials.single(part, bowl, ways, shares, rows[0], **own)
    free = short_trials.single(part, bowl, ways, shares, rows[0], any_heading=("A",), **own)
    assert (list(alone.wrong), list(free.wrong)) == ([0, 1], [0, 0])
    assert free.purity == 1.0
    only = np.zeros(len(shares))
    only[rows[1]] = 1.0
    drawn = {"draws": 1, "tolerance": 1e-5, "run": RunSettings(1)}
    assert short_trials.robust_run(part, bowl, ways, only, rows[0], **drawn).held == 0
    assert short_trials.robust_run(part, bowl, ways, only, rows[0], any_heading=("A",), **drawn).held == 1


def test_what_is_round_in_plan_counts_at_any_heading_unless_one_is_asked_for():
    disc = shapes.part(shapes.cylinder(10, 4, 48))
    ways = proposals.known_through(disc, find(disc), bowls.default())
    lying = [k for k, one in enumerate(ways.lying) if one.kind == "flat"]
    assert lying
    for k in lying:
        assert short_trials.aspects_at_any_heading(ways.lying, k, ()) == (ways.lying[k].aspect,)
        assert short_trials.aspects_at_any_heading(ways.lying, k, (), heading_given=True) == ()
    request = DesignRequest(1.0, up=(ways.lying[lying[0]].aspect.lower(),), heading=None)
    assert proposals.free_headings(ways.lying, lying[0], request) == (ways.lying[lying[0]].aspect,)
