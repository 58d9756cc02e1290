"""Whose probabilities a rate takes: the recommended answer from counts, or from the bowl's own floor."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.dropping.ensemble import wilson
from feederscrew.errors import FeederError
from feederscrew.rates.stream import Orientations
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.profiles import AspectProfile, Measured
from feederscrew.resting.rules.recommended import LAUNCH, Recommended, launched
from feederscrew.tooling.devices.orientation_names import place

if TYPE_CHECKING:
    from feederscrew.dropping.arrival import Arrival

UNDECIDED_REMARK = "the shares at the track's entry are undecided: {}"
STOPPED_REMARK = "the parts on the floor were stopped after {}"
TOO_LONG = (
    "the part is too small, or the drive too quick, to be followed on the moving floor: the closed form"
    " is taken"
)
NO_ARRIVALS_MESSAGE = "no part came to lie on the moving floor: the closed form is taken"


def arrived(aspects: Aspects, arrival: "Arrival", seed: int) -> Aspects:
    """Return the aspects with what arrives at the track's entry as their recommended answer.

    Parameters
    ----------
    aspects : Aspects
    arrival : Arrival
    seed : int
        Of its launches.

    Returns
    -------
    Aspects
        With a warning where the shares are undecided.
    """
    parts = arrival.shaken.parts
    if not np.isfinite(arrival.p).all():
        return replace(aspects, warnings=(*aspects.warnings, NO_ARRIVALS_MESSAGE))
    remarks: tuple[str, ...] = () if arrival.settled else (UNDECIDED_REMARK.format(arrival.reason),)
    remarks += (STOPPED_REMARK.format(parts),) if arrival.shaken.partial else ()
    rule = f"fed onto the moving floor, {parts} parts, seed {seed}"
    low, high = launched(arrival.p, arrival.low, arrival.high, aspects.stable)
    answer = Recommended(rule, LAUNCH, arrival.p, check.frozen(low), check.frozen(high))
    return replace(aspects, recommended=answer, warnings=(*aspects.warnings, *remarks))


def too_long(aspects: Aspects, bowl: Bowl) -> bool:
    """Whether a part would take more steps on the floor of a bowl than one is followed for."""
    from feederscrew.dropping.arrival import MAX_ARRIVAL_STEPS, steps_needed

    return aspects.ground is not None and steps_needed(aspects.ground.hull, bowl) > MAX_ARRIVAL_STEPS


def not_fed(aspects: Aspects) -> Aspects:
    """Return the aspects of a part that is not fed, with a warning that says so."""
    return replace(aspects, warnings=(*aspects.warnings, TOO_LONG))


def counted(aspects: Aspects, measured: Measured) -> Aspects:
    """Return the aspects with measured counts as their recommended answer.

    Parameters
    ----------
    aspects : Aspects
        Without facets it rolls off.
    measured : Measured
        Of that part, with one column.

    Returns
    -------
    Aspects
        The interval is Wilson's, of 95 %; shares without counts have none.

    Raises
    ------
    FeederError
        If there are several columns.
    """
    column = _only(measured)
    p = column.fractions / column.fractions.sum()
    low, high = wilson(column.values, column.values.sum()) if column.counted else (p, p)
    total = f", {column.values.sum():.0f} parts" if column.counted else ""
    launch = measured.head.launch or LAUNCH
    answer = Recommended(
        rule=f"{measured.source}{total}",
        launch=launch,
        p=check.frozen(p),
        low=check.frozen(np.minimum(low, p)),
        high=check.frozen(np.maximum(high, p)),
    )
    return replace(aspects, recommended=answer)


def _only(measured: Measured) -> AspectProfile:
    if len(measured.profiles) != 1:
        names = ", ".join(profile.name for profile in measured.profiles[:5])
        what = f"has {len(measured.profiles)} columns of shares ({names})"
        raise FeederError(measured.source, what, "leave one of them in the file")
    return measured.profiles[0]


def oriented(queue: Orientations, measured: Measured | None) -> Orientations:
    """Return the orientations with the shares that were counted for each of them.

    Parameters
    ----------
    queue : Orientations
    measured : Measured or None
        As it stands where it counts aspects, and where there is none.

    Returns
    -------
    Orientations

    Raises
    ------
    FeederError
        If a part was counted in an orientation that the part cannot have on this track.
    """
    if measured is None or measured.by_orientation is None:
        return queue
    values = np.zeros(len(queue.lying))
    for (aspect, heading), count in zip(measured.lying, measured.by_orientation[:, 0]):
        if count > 0.0:
            row = place(queue.aspects, queue.headings, aspect, heading, measured.source, "counts")
            values[row] += count
    shares = values / values.sum()
    low, high = wilson(values, values.sum()) if _only(measured).counted else (shares, shares)
    ends = np.column_stack([np.minimum(low, shares), np.maximum(high, shares)])
    rules = queue.rules | {"recommended": check.frozen(shares)}
    return replace(queue, rules=rules, interval=check.frozen(ends))
