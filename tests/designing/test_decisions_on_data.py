"""The search decides on records: with every sentence and label scrambled it makes the same moves.

Trials, draws and queues are drawn by chance here: every kind of fault comes up, and nothing is simulated.
"""

import functools
import hashlib
import inspect
import zlib
from types import SimpleNamespace

import numpy as np
import pytest
from design_counts import design_study, short_trial

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import Shares
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing import exploring, loop, nearest, proposals, queues, short_trials, texts
from feederscrew.designing.findings import End, Fault, FaultKind
from feederscrew.designing.proof import RobustRun
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.search import Search
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import FilledQueue, LeavingPose, PoseKind
from feederscrew.trials.long_ride import LongRide, RideOfTrack
from feederscrew.trials.wanted import wanted_rows

SEEDS = range(3)


def scrambled(text):
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def scramble_all(monkeypatch):
    """Make every sentence of a design, and every word that a trial has for a fate or a device, unreadable."""
    proposals.follow_orientations.cache_clear()
    for name, function in inspect.getmembers(texts, inspect.isfunction):
        if function.__module__ == texts.__name__ and inspect.signature(function).return_annotation is str:
            monkeypatch.setattr(texts, name, lambda *a, _own=function, **k: scrambled(_own(*a, **k)))
    monkeypatch.setattr(Fate, "word", property(lambda self: scrambled(self.name)))
    for name in ("full_name", "short", "value_words"):
        monkeypatch.setattr(Device, name, property(lambda self, _name=name: scrambled(_name + self.kind)))


def chance(*of):
    """A generator for what it is of, the same in every run."""
    return np.random.default_rng(zlib.crc32(repr(of).encode()))


def draw_end(rng, devices, fates):
    """An end at one of some devices, or on the bare track."""
    fate, placed = Fate(int(rng.choice(fates))), [device for device in devices if device.action.has_place]
    station = int(rng.integers(len(placed) + 1))
    return End(fate, station, placed[station - 1].kind) if station else End(fate)


@pytest.fixture
def by_chance(monkeypatch, block):
    """Trials, draws and queues whose outcomes are drawn by a seed, the chain and its drive."""
    lost_fates = (Fate.RETURNED, Fate.HANGING, Fate.STOPPED, Fate.ROLLED_BACK)
    seed = {}

    def short(search, bowl, ways, weights, proposal):
        rng = chance(seed["of"], proposal.chain, bowl.drive.amplitude)
        rows, states = np.arange(len(ways.lying)), proposal.states(ways)
        wanted = wanted_rows(ways, states)
        fails = rng.random() < 0.6
        counts, ends, turns = np.zeros((3, len(rows)), int), [], []
        for row in rows:
            goes_wrong = fails and rng.random() < 0.3
            if row in wanted:
                right = int(rng.integers(2)) if goes_wrong else 2
                ends.append({draw_end(rng, bowl.devices, lost_fates): 2 - right} if right < 2 else {})
                turns.append({})
                stays = sum(n for end, n in ends[-1].items() if end.fate in short_trials.STUCK_FATES)
                counts[:, row] = right, 0, stays
            elif goes_wrong and rng.random() < 0.5:
                counts[:, row] = 0, 2, 0
                ends.append({})
                turns.append({draw_end(rng, bowl.devices, [Fate.TURNED]): 2})
            else:
                fate = Fate.STOPPED if goes_wrong else Fate.RETURNED
                ends.append({draw_end(rng, bowl.devices, [fate]): 2})
                turns.append({})
                counts[:, row] = 0, 0, 2 * goes_wrong
        return short_trials.ShortTrial(
            ways, weights, rows, np.full(len(rows), 2), *counts, ends=tuple(ends), turns=tuple(turns),
            velocity=0.08, states=states,
        )  # fmt: skip

    def robust_run(part, bowl, ways, shares, targets, *, draws, **_):
        rng = chance(seed["of"], draws, bowl.drive.amplitude, [device.text for device in bowl.devices])
        if rng.random() < 0.4:
            return RobustRun(draws, draws)
        kind, row = FaultKind(int(rng.integers(2, 5))), int(rng.integers(len(ways.lying)))
        ends = (draw_end(rng, bowl.devices, lost_fates),) if kind is not FaultKind.CARRIED else ()
        failures = int(rng.integers(1, draws + 1))
        worst = Fault(kind, ways.lying[row].name, row, ends).counted_in_draws(failures, draws)
        return RobustRun(draws, draws - failures, worst)

    def follow_fills(line, **_):
        rng = chance(seed["of"], line.bowl.drive.amplitude, [device.text for device in line.bowl.devices])
        found = []
        for name in queues.FILLS:
            wrong, jams = int(rng.choice([0, 0, 30])), int(rng.choice([0, 0, 0, 1]))
            other = line.orientations.lying[int(rng.integers(len(line.orientations.lying)))]
            poses = (
                LeavingPose(PoseKind.HEADING_OFF, "A"),
                LeavingPose(PoseKind.ORIENTATION, other.aspect, other.name),
            )
            instead = ((poses[int(rng.integers(2))], wrong),) if wrong else ()
            right = int(rng.integers(20, 300))
            found.append(
                FilledQueue(
                    name,
                    name.gaps,
                    12,
                    300.0,
                    300.0,
                    float(right),
                    right,
                    right + wrong,
                    10,
                    jams,
                    0,
                    left_instead=instead,
                )
            )
        return tuple(found)

    def long_ride(part, bowl, lying, shares, wanted, run):
        none = np.zeros(0, int)
        ride = RideOfTrack(
            tuple(one.name for one in lying), none, none, none.astype(bool), none * 1.0, none * 1.0
        )
        return LongRide(ride, shares, shares, tuple(wanted))

    known = {}

    def propose_chain(part, bowl, aspects, row, ways, request, recipe):
        key = bowl, row, recipe  # the static rule takes most of the time, and says the same each time
        if key not in known:
            known[key] = by_rule(part, bowl, aspects, row, ways, request, recipe)
        return known[key]

    shares, by_rule = Shares(block.aspects), proposals.propose_chain
    followed = functools.cache(proposals.follow_orientations.__wrapped__)  # a search remembers 16
    monkeypatch.setattr(proposals, "follow_orientations", followed)
    monkeypatch.setattr(proposals, "propose_chain", propose_chain)
    monkeypatch.setattr(exploring, "_short", short)
    monkeypatch.setattr(exploring, "robust_run", robust_run)
    monkeypatch.setattr(loop, "robust_run", robust_run)
    monkeypatch.setattr(loop, "long_ride", long_ride)
    monkeypatch.setattr(loop.hazards, "risks", lambda *_, **__: ())
    monkeypatch.setattr(queues, "follow_fills", follow_fills)
    monkeypatch.setattr(exploring, "entry_shares", lambda *_: shares)

    def decisions(number):
        seed["of"] = number
        request = DesignRequest(0.5, rule="csa", budget=8)
        study = loop.design(block.part, bowls.default(), frozenset(), request)
        tried = [
            (one.chain, one.move.kind, one.move.value, one.peak_to_peak, one.cause, len(one.faults))
            for one in study.attempts
        ]
        near = study.nearest and (study.nearest.rate, study.nearest.chain, study.nearest.peak_to_peak)
        return (
            study.status,
            study.cause,
            study.turn,
            study.devices,
            tried,
            near,
            [a.status for a in study.alternatives],
        )

    return decisions


def test_scrambled_sentences_change_no_decision(by_chance, monkeypatch):
    plain = [by_chance(number) for number in SEEDS]
    scramble_all(monkeypatch)
    assert [by_chance(number) for number in SEEDS] == plain
    # the search did something: moves of several kinds, designs that hold and others that do not
    kinds = {move for _, _, _, _, tried, _, _ in plain for _, move, *_ in tried}
    assert len(kinds) >= 5 and len({status for status, *_ in plain}) >= 2


NAMES = (
    "A",
    "lost_side",
    "A at b (c)",
    "is lost (stopped at gap",
    "nothing leaves",
)  # of an aspect, by its user


@pytest.fixture
def answer_to(monkeypatch, block):
    """What a search does about a fault that most draws show: its moves are noted, and none is tried."""
    moves = []

    def note(name):
        return lambda *_, **__: moves.append(name)

    for module, name in (
        (exploring, "try_livelier"), (exploring, "try_calmer"), (proposals, "_widen_slot"),
        (proposals, "_cut_more"), (proposals, "relax_device"), (loop, "_faster"),
    ):  # fmt: skip
        monkeypatch.setattr(module, name, note(name))
    wiper = SimpleNamespace(device=SimpleNamespace(action=Action.OVERHEAD, kind="wiper"))
    trial = short_trial(block.ways, (0,))

    def call(fault):
        moves.clear()
        search = Search.begin(block.part, DesignRequest(0.5), bowls.default())
        robust = RobustRun(20, 12, fault.counted_in_draws(8, 20))
        study = design_study(block.part, robust=robust)
        candidate = SimpleNamespace(
            proposal=SimpleNamespace(cuts=(wiper,), row=0), orientations=block.ways, bowl=study.bowl,
            trial=trial, worst=robust.main_fault, attempt=SimpleNamespace(clean=False),
        )  # fmt: skip
        list(exploring._find_calmer(search, candidate))
        loop._change_by_proof(search, study, candidate)
        return (*moves, nearest._by_motion(study), study.cause, study.status)

    return call


def test_neither_a_sentence_nor_the_name_of_an_aspect_changes_what_a_fault_leads_to(answer_to, monkeypatch):
    """Every kind of fault, at every place and end of its parts, by five names; then with texts scrambled."""
    places = [(station, kind) for station, kind in enumerate(("", "wiper", "gap"))]
    ends = [(), *((End(fate, *place),) for fate in Fate for place in places)]
    kinds = FaultKind.LOST, FaultKind.CARRIED, FaultKind.STAYS, FaultKind.NOTHING_LEAVES

    def answers(name):
        return [answer_to(Fault(kind, name, 0, some)) for kind in kinds for some in ends]

    plain = answers("A")
    assert len(set(plain)) >= 8 and {move for moves in plain for move in moves[:-3]} == {
        "try_livelier", "try_calmer", "_widen_slot", "_cut_more", "relax_device", "_faster",
    }  # fmt: skip
    assert all(answers(name) == plain for name in NAMES[1:])
    scramble_all(monkeypatch)
    assert all(answers(name) == plain for name in NAMES[2:4])
