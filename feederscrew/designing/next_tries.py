"""Requests to try where a design does not do what was asked, the likeliest first."""

import enum
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

from feederscrew.base.units import MINUTE, MM, rounded_down
from feederscrew.bowl.verified import HELD, Status
from feederscrew.designing.calm_drive import (
    CALMER_SHARE,
    LEAST_VELOCITY_KEPT,
    STROKES,
    DriveKind,
    slow_to,
    speed,
    velocity_kept,
)
from feederscrew.designing.findings import Cause
from feederscrew.designing.record import Attempt, DesignRequest, DesignStudy
from feederscrew.machine.drive_sizing import is_two_axis
from feederscrew.sorting.isolating.chain import OutcomeKind

MOST_TRIES = 3
SHARE_OF_TRIAL_RATE = 0.5  # [1] of what a clean short trial promises: queues bring less
OFTEN_SHARE = 0.05  # [1] of the parts, from which an aspect is worth a design of its own
FAR_MORE = 1.5  # [1] times the rate that was asked for, from which a calmer drive is named
SPARE = 1.25  # [1] times the rate that was asked for, that it aims at: the middle of 1 to 1.5
STILL_CONVEYS = 0.1  # [1] of that rate, that it brings at the worst friction at least
MORE_TRIALS = 2  # times the budget, where nothing else is left


class TryKind(enum.StrEnum):
    """Kinds of change to what was asked; files print the word."""

    PROOF = "proof"  # the same, to the end
    LOWER_RATE = "lower rate"
    ANOTHER_SIDE = "another side"
    ANY_HEADING = "any heading"
    MORE_DEVICES = "more kinds of devices"
    ANY_OUTCOME = "lying or hanging"
    ANY_DIAMETER = "any diameter"
    ANOTHER_DRIVE = "another drive"
    MORE_TRIALS = "more trials"
    CALMER_DRIVE = "calmer drive"
    FLATTER_DRIVE = "drive at a flatter angle"


class Evidence(enum.StrEnum):
    """Kinds of evidence for a request to try; files print the word."""

    HOLDS = "holds"  # its draws and its queues were run
    CLEAN = "clean in a short trial"
    UNTRIED = "not tried"


@dataclass(frozen=True)
class NextTry:
    """A request that differs from the one of a design, and why it is worth a try."""

    kind: TryKind
    request: DesignRequest
    evidence: Evidence = Evidence.UNTRIED
    aspect: str = ""  # that counts then; '' where it is as before
    share: float | None = None  # [1] of the parts that come on that aspect; None where it is not known
    trials: int = 0  # short trials in which that aspect was wanted
    rate: float | None = None  # [1/s] that its trials brought
    worst_rate: float | None = None  # [1/s] at the worst friction, by the speed there
    settings: tuple[tuple[str, str], ...] = ()  # keys of the bowl and their values


def next_tries(study: DesignStudy) -> tuple[NextTry, ...]:
    """Return at most ``MOST_TRIES`` requests to try after a design, the likeliest to hold first.

    After one that holds and brings far more than was asked: the same with a calmer drive. Else: what was
    proved to hold comes first, then what was clean in a short trial, what the request itself ruled out, the
    aspects that were not tried or did best, another drive, and more trials.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    tuple of NextTry
        Empty of a design that holds and brings about what was asked.
    """
    if study.status in HELD:
        return tuple(_calmer_drive(study))
    if study.status is Status.NOT_PROVED:
        return (NextTry(TryKind.PROOF, replace(study.request, quick=False)),)
    tries: dict[DesignRequest, NextTry] = {}
    for one in _ways(study):
        if one.request != study.request or one.settings:
            tries.setdefault(one.request, one)
    return tuple(tries.values())[:MOST_TRIES]


def _calmer_drive(study: DesignStudy) -> Iterator[NextTry]:
    """The same with a smaller amplitude, where the bowl brings far more than was asked."""
    rate, target, bowl = study.proof.delivered[0], study.request.target, study.bowl
    keeps_stroke = any(key in word for word in study.call for key in STROKES)
    if bowl is None or keeps_stroke or is_two_axis(bowl.drive) or rate < FAR_MORE * target:
        return
    velocity = speed(bowl) * SPARE * target / rate
    best = rate
    # one that keeps its speed where friction is at its worst; else as well one that is nearer to what was
    # asked for, and at the worst friction does not stand still
    for kept in (LEAST_VELOCITY_KEPT, STILL_CONVEYS):
        calmer = slow_to(bowl, velocity, kept=kept)
        less = rate * speed(calmer) / speed(bowl)
        if less < CALMER_SHARE * best and best >= FAR_MORE * target:
            yield NextTry(
                TryKind.CALMER_DRIVE,
                study.request,
                rate=less,
                worst_rate=less * velocity_kept(calmer),
                settings=(("drive.amplitude", f"{calmer.drive.amplitude / MM:.4g} mm"),),
            )
            best = less


def _ways(study: DesignStudy) -> Iterator[NextTry]:
    """Every request that may hold, the likeliest first."""
    request, near = study.request, study.nearest
    if near is not None and near.rate and near.request is not None:
        yield _of_nearest(study)
    yield from _clean_ways(study)
    if request.without:
        yield NextTry(TryKind.MORE_DEVICES, replace(request, without=()))
    own = study.wanted_aspect
    if own and (request.heading is not None or own in study.proof.aspects_heading_off):
        yield NextTry(TryKind.ANY_HEADING, _with_aspect(request, own), aspect=own)
    if request.outcome is not OutcomeKind.ANY:
        yield NextTry(TryKind.ANY_OUTCOME, replace(request, outcome=OutcomeKind.ANY))
    if request.diameter is not None:
        yield NextTry(TryKind.ANY_DIAMETER, replace(request, diameter=None))
    if request.aspect is not None or request.up:
        yield NextTry(TryKind.ANOTHER_SIDE, replace(request, aspect=None, heading=None, up=()))
    sides = _sides(study)
    yield from sides[:1]
    if study.cause is Cause.ARRIVAL or study.cause is Cause.DRIVE:  # half the rate takes a calmer drive
        lower = rounded_down(MINUTE * SHARE_OF_TRIAL_RATE * request.target) / MINUTE
        yield NextTry(TryKind.LOWER_RATE, replace(request, target=lower))
    if request.drive is DriveKind.LEAF_SPRING:
        yield NextTry(TryKind.ANOTHER_DRIVE, replace(request, drive=DriveKind.TWO_AXIS))
    yield from sides[1:]
    yield NextTry(TryKind.MORE_TRIALS, replace(request, budget=MORE_TRIALS * request.budget))


def _with_aspect(request: DesignRequest, aspect: str) -> DesignRequest:
    """The request for an aspect at any heading."""
    return replace(request, aspect=None, heading=None, up=(aspect,))


def _of_nearest(study: DesignStudy) -> NextTry:
    """The request for the nearest that holds, as it was proved."""
    near, request = study.nearest, study.request
    if near is None or near.rate is None or near.request is None:
        raise ValueError("nothing near it holds")
    other = replace(near.request, target=near.rate, budget=request.budget)
    if near.settings:
        return NextTry(TryKind.FLATTER_DRIVE, other, Evidence.HOLDS, rate=near.rate, settings=near.settings)
    aspect = (near.wanted or "").partition("@")[0]
    if other.up != request.up and other.up:
        return NextTry(TryKind.ANY_HEADING, other, Evidence.HOLDS, aspect=other.up[-1], rate=near.rate)
    if (other.aspect, other.up) == (request.aspect, request.up) and other.outcome is request.outcome:
        return NextTry(TryKind.LOWER_RATE, other, Evidence.HOLDS, rate=near.rate)
    # another way up than was asked for: it is named, as the same search would find it
    hangs = not aspect or aspect.startswith("hanging")
    named = replace(other, outcome=OutcomeKind.HANGING) if hangs else replace(other, aspect=aspect)
    return NextTry(
        TryKind.ANOTHER_SIDE, named, Evidence.HOLDS, aspect="" if hangs else aspect, rate=near.rate
    )


def _clean_ways(study: DesignStudy) -> Iterator[NextTry]:
    """Yield what got through a short trial too slowly, of each aspect at the rate of its fastest trial."""
    request, fastest = study.request, dict[str, Attempt]()
    for attempt in study.attempts:
        if attempt.clean and attempt.rate > fastest.get(attempt.aspect, attempt).rate:
            fastest[attempt.aspect] = attempt
        elif attempt.clean:
            fastest.setdefault(attempt.aspect, attempt)
    for aspect, attempt in sorted(fastest.items(), key=lambda item: -item[1].rate):
        lower = rounded_down(MINUTE * SHARE_OF_TRIAL_RATE * attempt.rate) / MINUTE
        if not 0.0 < lower < request.target:
            continue
        own = _with_aspect(request, aspect) if aspect else replace(request, outcome=OutcomeKind.HANGING)
        same = aspect in (request.aspect, *request.up) or not aspect
        kind = TryKind.LOWER_RATE if same else TryKind.ANOTHER_SIDE
        yield NextTry(
            kind, replace(request if same else own, target=lower), Evidence.CLEAN, aspect=aspect,
            share=dict(study.arrivals).get(aspect), trials=_trials(study)[aspect], rate=attempt.rate,
        )  # fmt: skip


def _trials(study: DesignStudy) -> Counter[str]:
    """Count how often each aspect was wanted in a short trial."""
    return Counter(attempt.aspect for attempt in study.attempts)


def _sides(study: DesignStudy) -> list[NextTry]:
    """Aspects that come often, each at any heading.

    Those that were not tried come first, then those of which most parts left as wanted in the best of their
    trials.
    """
    request, trials = study.request, _trials(study)
    named = {name.casefold() for name in (request.aspect or "", *request.up)}
    often = [(name, share) for name, share in study.arrivals if share >= OFTEN_SHARE]

    def failure(one: tuple[str, float]) -> tuple[bool, float, int, float]:
        name, share = one
        best = max((each.efficiency for each in study.attempts if each.aspect == name), default=0.0)
        return trials[name] > 0, -best / share, trials[name], -share

    order = sorted(often, key=failure)
    return [
        NextTry(
            TryKind.ANOTHER_SIDE, _with_aspect(request, name), aspect=name, share=share, trials=trials[name]
        )
        for name, share in order
        if name.casefold() not in named
    ]
