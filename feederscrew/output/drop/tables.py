"""Drop tests as a table and as a document."""

import numpy as np

from feederscrew.output import tables
from feederscrew.output.drop import trace_tables
from feederscrew.units import MM


def counts(study):
    """Return how many drops rest on each aspect, one row an aspect.

    Parameters
    ----------
    study : DropStudy
        One that the user stopped is labelled in every row.

    Returns
    -------
    Frame
        The columns of ``drop.csv``.
    """
    aspects, tally = study.aspects, study.result.tally
    partial = {"partial": [True] * len(aspects.names)} if study.result.drops.partial else {}
    return tables.frame(
        {
            "aspect": aspects.names,
            "height_mm": study.result.heights / MM,
            "count": tally.counts,
            "p_drop": tally.p,
            "p_drop_low": tally.low,
            "p_drop_high": tally.high,
            "p_gentle": tally.gentle,
            "p_violent": tally.violent,
            "p_restitution": tally.restitution,
            "unsettled_share": [tally.unsettled_share] * len(aspects.names),
            **partial,
        }
    )


def document(study):
    """Return the drop test as one JSON document.

    Parameters
    ----------
    study : DropStudy

    Returns
    -------
    dict
    """
    result = study.result
    return {
        "part": study.part.name,
        "drops": study.drops,
        "seed": result.seed,
        "launch": result.launch,
        "partial": result.drops.partial,
        "unsettled": result.tally.unsettled,
        "unsettled_share": result.tally.unsettled_share,
        "until": result.aim,
        "widest": result.tally.widest,
        "traces": trace_tables.listed(study),
        "aspects": counts(study),
    }


def remarks(study):
    """Return what a user must know of a drop test, a line each."""
    listed, drops, tally, aim = [], study.drops, study.result.tally, study.result.aim
    if study.result.drops.partial:
        listed.append(f"partial: stopped after {drops} drops")
    elif aim is not None and tally.widest > aim:
        listed.append(
            f"after {drops} drops the widest interval is {100.0 * tally.widest:.3g} % to either side, not "
            f"{100.0 * aim:.3g} % - give more `drops`, or a wider `until`"
        )
    if study.result.single is not None:
        listed.append(_scatter(study))
    if tally.unsettled:
        listed.append(f"{tally.unsettled} of {drops} drops came to rest on no aspect")
    return listed


def _scatter(study):
    """What becomes of one value of restitution, and of the intervals."""
    tally, (low, high) = study.result.tally, study.result.launch["restitution"]
    ends = np.stack([tally.p - tally.low, tally.high - tally.p])
    wider = ends - np.sqrt(np.maximum(ends**2 - tally.restitution**2, 0.0))
    return (
        f"restitution {study.result.single:g} scatters from {low:.3g} to {high:.3g}, as impacts do: "
        f"an interval reaches {100.0 * wider.max():.2g} % further for it"
    )


def title(study):
    """Return what the chart is of, and what is the matter with it."""
    result = study.result
    unsettled = f", {result.tally.unsettled} unsettled" if result.tally.unsettled else ""
    named = f"{study.part.name}: {study.drops} drops, {result.launch['name']}"
    return named + unsettled + ", partial" * result.drops.partial
