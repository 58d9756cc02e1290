"""The best design of each cost class, side by side: what steel does, what air, and what a sensor."""

from collections.abc import Collection, Iterator, Sequence
from typing import Any

import numpy as np

from feederscrew.designing.proposals import COST_CLASSES
from feederscrew.designing.record import HOLDS, NONE, NOT_TRIED, Alternative, Attempt, DesignStudy
from feederscrew.tooling.devices.kinds import cost_class


def merit(study: DesignStudy) -> tuple[bool, bool, float, float]:
    """Return what of two designs is the better one: holds, then clean, then the most parts."""
    return study.status == HOLDS, study.jams == 0, study.robust.share, study.delivered[1]


def alternatives(
    studies: Sequence[DesignStudy], attempts: Sequence[Attempt], searched: Collection[int]
) -> tuple[Alternative, ...]:
    """Return the best of each cost class, the cheapest class first.

    Parameters
    ----------
    studies : sequence of DesignStudy
        That were proved, as far as they were.
    attempts : sequence of Attempt
        Every short trial.
    searched : collection of int
        Cost classes of which chains were looked for.
    """
    return tuple(_alternatives(studies, attempts, searched))


def _alternatives(
    studies: Sequence[DesignStudy], attempts: Sequence[Attempt], searched: Collection[int]
) -> Iterator[Alternative]:
    holds = any(study.status == HOLDS for study in studies)
    for number in COST_CLASSES:
        own = [one for one in studies if one.bowl is not None and cost_class(one.devices) == number]
        tried = [one for one in attempts if one.cost_class == number]
        if own:
            yield of_study(max(own, key=merit))
        elif tried:
            best = max(tried, key=lambda one: (one.clean, one.efficiency, one.rate))
            faults = ", ".join(best.faults[:2]) or "too slow in its short trial"
            yield Alternative(number, NONE, chain=best.chain, why=f"{best.wanted}: {faults}")
        elif number in searched:
            yield Alternative(number, NONE, why="no chain of this class tells what is wanted from the rest")
        else:
            why = "a cheaper one holds: --alternatives proves this class too" if holds else "it was stopped"
            yield Alternative(number, NOT_TRIED, why=why)


def of_study(study: DesignStudy) -> Alternative:
    """Return a design as the alternative of its cost class."""
    purity, share = study.purity[0], study.efficiency
    shown = bool(study.queues) and not study.partial  # what was stopped is no evidence
    sensors: list[Any] = [one for one in study.devices if one.senses]
    return Alternative(
        cost_class=cost_class(study.devices),
        status=study.status,
        delivered=study.delivered if shown else None,
        purity=None if np.isnan(purity) or not shown else purity,
        efficiency=None if np.isnan(share) or not shown else share,
        chain=tuple(f"{one.kind}: {one.text}" for one in study.devices),
        chain_words=tuple(f"{one.full_name}: {one.value_words}" for one in study.devices),
        sees=tuple(one.sees for one in sensors),
        why="; ".join(study.shortfalls) if study.status != HOLDS else "",
    )
