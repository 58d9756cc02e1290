"""A design that is stopped hands over the best so far, wherever that is."""

from dataclasses import replace

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import families, loop, queues
from feederscrew.designing.record import DesignRequest

CUBE = shapes.part(shapes.box(10, 10, 10))
REQUEST = DesignRequest(40.0 / 60.0, draws=2)


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(queues, "PARTS", 3)
    monkeypatch.setattr(queues, "SECONDS", 1.0)


def stopping(word):
    """What is told, and a user who stops it as soon as a word comes."""
    said = []

    def told(text):
        said.append(text)
        if word in text:
            raise KeyboardInterrupt

    return said, told


@pytest.mark.parametrize(
    ("word", "status", "why", "bowl"),
    [
        ("trial 1", "none", "stopped before a design was proved", False),
        ("draws:", "falls short", "stopped before a queue was followed: no draw was tried", True),
        ("at normal fill", "falls short", "stopped before a queue was followed: no draw was tried", True),
    ],
)
def test_it_hands_over_the_best_so_far_marked_partial(word, status, why, bowl):
    said, told = stopping(word)
    found = loop.design(CUBE, bowls.default(), frozenset(), REQUEST, told=told)
    assert found.partial and found.status == status and found.why.startswith(why)
    assert (found.bowl is not None) == bowl and len(found.attempts) == bowl
    assert word in said[-1] and said[0] == "trial 1: A@0, no device"


def test_a_family_is_stopped_with_the_parts_that_were_reached():
    _, told = stopping("draws:")
    other = replace(CUBE, name="other")
    found = families.family([CUBE, other], bowls.default(), frozenset(), REQUEST, told=told)
    assert found.partial and len(found.members) == 1
