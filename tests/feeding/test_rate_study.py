"""The studies of the rate and of the settings that reach it, and what tooling hands on to a design."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from command_lines import BRACKET

from feederscrew import bowl as bowls
from feederscrew import load, read_bowl
from feederscrew.arrivals import entry
from feederscrew.arrivals.entry import Shares, shares
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.designing.loop import design
from feederscrew.designing.proposals import promising_rows
from feederscrew.designing.record import DesignRequest
from feederscrew.feeding import drive_settings, stream
from feederscrew.feeding.rate import most_frequent, rate
from feederscrew.feeding.tune import tune
from feederscrew.resting.aspects import find
from feederscrew.sorting.tooling import ToolingSearch, tooling

OWN = ("drive.frequency=50 Hz", "drive.amplitude=0.12 mm", "restitution=0", "friction.static=0.4")
BOWL = bowls.read(None, OWN)
STRAIGHT = bowls.read(None, ("track.radius=100 m", "track.width=200 mm", "track.bank=0 deg"))
TARGET = 0.2
BAR = shapes.part(shapes.box(20, 12, 10))


def test_the_rate_is_of_the_orientation_that_leaves_most_often():
    known = SimpleNamespace(
        aspects=("A", "A", "B"), headings=np.array([0.0, 1.0, 2.0]), leaving=np.diag([0.0, 1.0, 1.0]),
        leaves_as=np.arange(3), rules={"pmi": np.array([0.6, 0.1, 0.3]), "csa": np.full(3, np.nan)},
        rolls_back=np.zeros(3, dtype=bool),
    )  # fmt: skip
    assert most_frequent(known, "pmi") == ("B", 2.0)  # 0.6 never passes
    assert most_frequent(known, "csa") == ("A", 0.0)
    known.rolls_back[2] = True  # down the climb: B does not leave
    assert most_frequent(known, "pmi") == ("A", 1.0)
    known.rules["pmi"] = np.array([0.6, 0.01, 0.39])  # of a hundredth no rate is told, of what rolls back 0
    assert most_frequent(known, "pmi") == ("B", 2.0) == most_frequent(known, "pmi", hung=True)
    # A along the wall takes more of the track than A across it, and leaves more often all the same
    part, bowl = load(BRACKET), read_bowl()
    chosen, across = rate(part, bowl).rate, rate(part, bowl, "A", heading=np.pi / 2.0).rate
    assert chosen.orientations.aspects[chosen.row] == "A"
    assert chosen.efficiency > 1.5 * across.efficiency


@pytest.mark.parametrize(("first", "fed"), [(0.45, [400]), (0.36, [400, None])])
def test_few_parts_show_the_likeliest_aspect_where_its_share_is_clear(monkeypatch, first, fed):
    """Intervals of 400 parts reach 0.05 to either side (Wilson): 0.45 is clear of 0.33, 0.36 is not."""
    part, counts = load(BRACKET), []
    at_rest = find(part)
    p = np.zeros(len(at_rest.names))
    p[:3] = first, 0.33, 0.67 - first
    answer = replace(at_rest, recommended=replace(at_rest.recommended, p=p))

    def counted(part, bowl, *, fed=None, **_):
        counts.append(fed)
        return entry.Shares(answer, fed=True)

    monkeypatch.setattr(entry, "shares", counted)
    monkeypatch.setattr("feederscrew.arrivals.arrival.MAX_ARRIVALS", 4000)  # tests feed fewer
    assert entry.likeliest(part, read_bowl()).likeliest == at_rest.names[0]
    assert counts == fed


def test_rate_says_of_each_setting_what_tune_says_and_each_drive_is_asked_once():
    """Of a block whose shares shift from its first aspect to the others as stroke and frequency grow."""
    block = shapes.part(shapes.box(8, 14, 20))
    known = shares(block, BOWL)
    answer = known.aspects.recommended

    def at(bowl):
        pull = bowl.drive.amplitude * bowl.drive.frequency**2
        p = answer.p * np.where(np.arange(len(answer.p)) == 0, np.exp(-1e-3 * pull), 1.0)
        p = p / p.sum()
        other = replace(answer, p=p, low=np.minimum(answer.low, p), high=np.maximum(answer.high, p))
        return Shares(replace(known.aspects, recommended=other))

    for worst in (False, True):
        asked = []
        own = {"aspect_shares": lambda bowl: asked.append(bowl) or at(bowl), "worst": worst}  # noqa: B023
        settings = tune(block, BOWL, "A", TARGET, **own).settings
        assert len(asked) == len(set(asked)) and BOWL in asked and len(settings) >= 2
        for setting in settings:
            there = drive_settings.turned(BOWL, setting.solution.key, setting.solution.value)
            back = rate(block, there, "A", aspect_shares=at(there)).rate
            assert back.velocity.all == pytest.approx(setting.velocity.all, rel=1e-12)
            speed = back.velocity.low if worst else back.velocity.value
            met = back.parts.value * speed / back.velocity.value
            assert met == pytest.approx(setting.solution.rate, rel=1e-9)
            assert met == pytest.approx(TARGET, rel=drive_settings.ACCEPTED_RATE_ERROR)


def test_devices_that_turn_parts_are_used_where_they_may_be_and_bring_more():
    searches = [ToolingSearch(rule="csa", vary=False, turn=turn) for turn in (False, True)]
    plain, turned = (
        tooling(BAR, STRAIGHT, "B", without="cut-out", search=search).design for search in searches
    )
    assert not any(KINDS[cut.device.kind].action.turns for cut in plain.cuts)
    assert any(KINDS[cut.device.kind].action.turns for cut in turned.cuts)
    assert turned.efficiency > 2.0 * plain.efficiency


def test_a_heading_is_that_of_an_aspect_which_the_part_has():
    for call in (lambda: tooling(BAR, STRAIGHT, heading=1.0), lambda: DesignRequest(0.5, heading=1.0)):
        with pytest.raises(ArgumentError, match="heading: is given without an aspect"):
            call()
    states = stream.follow_orientations(BAR, find(BAR), STRAIGHT.track)
    even = np.full(len(states.lying), 1.0 / len(states.lying))
    near, off = (DesignRequest(0.5, "A", heading=np.radians(angle)) for angle in (88.0, 45.0))
    (row,) = promising_rows(states, even, near)
    assert states.lying[row].name == "A@90"
    assert promising_rows(states, even, off)[0] in (0, row)  # on another track the nearest is the same
    with pytest.raises(FeederError, match="aspect A has no stable heading 45 deg"):
        design(BAR, STRAIGHT, (), off)
