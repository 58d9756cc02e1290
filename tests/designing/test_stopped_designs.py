"""A design that is stopped hands over the best so far, wherever that is."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import exploring, families, loop, proposals, queues, short_trials
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.short_trials import robust_run
from feederscrew.errors import FeederError
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.studies.rate import Shares
from feederscrew.trial import long_ride

CUBE = shapes.part(shapes.box(10, 10, 10))
REQUEST = DesignRequest(40.0 / 60.0, draws=2, rule="csa")
SHARES = Shares(find(CUBE))


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(queues, "TOUCHING_PARTS", 3)
    monkeypatch.setattr(queues, "FILL_SECONDS", 1.0)
    monkeypatch.setattr(long_ride, "RIDE_M", 0.05)
    monkeypatch.setattr(exploring, "arriving", lambda *_: SHARES)


def stopping(word):
    """What is told, and a user who stops it as soon as a word comes."""
    said = []

    def told(text):
        said.append(text)
        if word in text:
            raise KeyboardInterrupt

    return said, told


@pytest.mark.parametrize(
    ("word", "why", "bowl"),
    [
        ("trial 1", "0 short trials made", False),
        ("draws:", "no draw was tried; no queue was followed", True),
        ("queue:", "2 of 2 draws sort, 2 are asked for; no queue was followed", True),
        ("at normal fill", "2 of 2 draws sort, 2 are asked for; the queue at low fill was", True),
    ],
)
def test_it_hands_over_what_was_proved_so_far_and_no_verdict(word, why, bowl):
    said, told = stopping(word)
    found = loop.design(CUBE, bowls.default(), frozenset(), REQUEST, tell=told)
    assert found.partial and found.status == "not proved" and why in found.why
    assert (found.bowl is not None) == bowl and len(found.attempts) == bowl
    assert word in said[-1] and said[0] == "trial 1 of at most 16: A@0, no device"


def test_a_family_is_stopped_with_the_parts_that_were_reached(monkeypatch):
    """Or, where each holds for itself, while all are tried with one chain."""
    _, told = stopping("draws:")
    pair = [CUBE, replace(CUBE, name="other")]
    found = families.family(pair, bowls.default(), frozenset(), REQUEST, tell=told)
    assert (found.partial, found.status, len(found.members)) == (True, "not proved", 1)
    holds = {"partial": False, "status": "holds", "devices": (), "bowl": None}
    monkeypatch.setattr(families.loop, "design", lambda part, *_, **__: SimpleNamespace(part=part, **holds))
    monkeypatch.setattr(families, "_of_one_chain", lambda *_: told("draws:"))
    found = families.family(pair, bowls.default(), frozenset(), REQUEST)
    assert (found.partial, found.status, len(found.members)) == (True, "not proved", 2)


def test_parts_that_a_stopped_trial_has_not_tried_are_no_verdict(monkeypatch):
    ways = proposals.known_through(CUBE, find(CUBE), bowls.default())
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    seen = SimpleNamespace(partial=True, orientations=np.zeros((1, 1)), fates=np.zeros(1))
    monkeypatch.setattr(short_trials.course, "course", lambda *_, **__: seen)
    with pytest.raises(KeyboardInterrupt):
        short_trials.single(CUBE, bowls.default(), ways, shares, 0, rows=(0,), each=2, run=RunSettings(1))
    drawn = robust_run(CUBE, bowls.default(), ways, shares, 0, draws=3, tolerance=1e-5, run=RunSettings(1))
    assert drawn.partial and drawn.draws == 0


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"aspect": "Q"}, "there is no aspect 'Q' - choose one of A"),
        ({"aspect": ""}, "there is no aspect '' - choose one of A"),
        ({"up": "A,Q"}, "has no aspect 'Q' - choose one of A"),
        ({"without": "wipr"}, "unknown device 'wipr'"),
        ({"aspect": "a", "heading": 0.7}, "has no stable heading"),
    ],
)
def test_design_refuses_it_before_anything_is_tried(asked, said):
    tried = []
    with pytest.raises(FeederError) as fault:
        loop.design(CUBE, bowls.default(), frozenset(), DesignRequest(0.5, **asked), tell=tried.append)
    assert said in str(fault.value) and not tried


@pytest.mark.parametrize(
    "line",
    ["design --target 30/min", "tooling", "rate", "trial --parts 1", "tune --target 30/min"],
)
def test_every_command_refuses_an_aspect_alike(line, run):
    shapes.box(10, 10, 10).export("cube.stl")
    command, *more = line.split()
    done = run(command, "cube.stl", *more, "--aspect", "Q", "--rule", "csa")
    assert done.exit_code == 2 and done.stdout == ""
    fault = "Error: --aspect of cube.stl: there is no aspect 'Q' - choose one of A"
    assert done.stderr.splitlines()[-1] == fault
