"""Findings of a design's trial, beside what other commands compute of it."""

from typing import TypeGuard

from feederscrew import __version__
from feederscrew.base.columns import Document, values
from feederscrew.bowl import Bowl
from feederscrew.bowl.verified import (
    VERIFIED_COLUMNS,
    VERIFIED_FIGURE_COLUMNS,
    VERIFIED_RATE_COLUMNS,
    Verified,
    VoidTrial,
)
from feederscrew.part.record import Part

FileTrial = Verified | VoidTrial | None  # that a bowl file tells of


def warnings(trial: FileTrial, part: Part | None, bowl: Bowl, wanted_name: str | None = None) -> list[str]:
    """Return what the trial of a bowl file has shown, or why it is void, a sentence each.

    Parameters
    ----------
    trial : Verified, VoidTrial or None
        Of the bowl file.
    part : Part or None
    bowl : Bowl
    wanted_name : str, optional
        'A' or 'A@2', that is counted now.

    Returns
    -------
    list of str
    """
    if holds(trial, part, bowl, wanted_name):
        return [trial.sentence]
    if trial is None:
        return []
    void = "; ".join(trial.void(part, bowl, __version__, wanted_name))
    return [f"the trial of this bowl file is void: {void} - run feeder design again"]


def holds(
    trial: FileTrial, part: Part | None, bowl: Bowl, wanted_name: str | None = None
) -> TypeGuard[Verified]:
    """Tell whether a bowl file has a trial that is still of this part, this bowl and what is wanted.

    Parameters
    ----------
    trial : Verified, VoidTrial or None
        Of the bowl file.
    part : Part or None
    bowl : Bowl
    wanted_name : str, optional
        'A' or 'A@2', that is counted now.

    Returns
    -------
    bool
    """
    return trial is not None and not any(trial.void(part, bowl, __version__, wanted_name))


def with_trial(
    document: Document, trial: FileTrial, part: Part | None, bowl: Bowl, wanted_name: str | None = None
) -> Document:
    """Return a document with the trial's figures beside its own ``parts_per_minute``; the lower rate leads.

    A trial leads in any case where it counted several aspects as one, since the rule counts one orientation,
    and where by the rule nothing leaves.

    Parameters
    ----------
    document : dict of str to object
    trial : Verified, VoidTrial or None
        Of the bowl file.
    part : Part or None
    bowl : Bowl
    wanted_name : str, optional
        'A' or 'A@2', that is counted now.

    Returns
    -------
    dict of str to object
        As given without a trial that holds.
    """
    if not holds(trial, part, bowl, wanted_name):
        return document if trial is None else document | {"verified": None}
    tried = _rates(trial)
    document = document | {"verified": block(trial)}
    own = {name: document[name] for name in tried if name in document}
    if not own:
        return document
    own_rate = own["parts_per_minute"]
    lead = tried if trial.up or own_rate == 0.0 or tried["parts_per_minute"] <= own_rate else own
    led = {name: lead[name] for name in own}
    return document | led | {"parts_per_minute_static": own["parts_per_minute"]}


def _rates(trial: Verified) -> dict[str, float]:
    return values(VERIFIED_RATE_COLUMNS, trial)


def block(trial: Verified) -> Document:
    """Return what a trial has shown as a dict."""
    figures = values(VERIFIED_FIGURE_COLUMNS, trial)
    condition = {"condition": trial.condition} if trial.condition else {}
    return values(VERIFIED_COLUMNS, trial) | condition | _rates(trial) | figures
