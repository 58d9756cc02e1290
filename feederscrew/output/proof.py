"""What the trial of a design has shown, beside what other commands compute of it."""

from typing import Any

from feederscrew import __version__
from feederscrew.units import PER_MINUTE


def warnings(verified, part, bowl, wanted=None) -> list[Any]:
    """Say what the trial of a bowl file has shown, or why that holds no more: a list of str.

    Parameters
    ----------
    verified : Verified, VoidTrial or None
        Of the bowl file; None where it has none.
    part : Part or None
    bowl : Bowl
    wanted : str, optional
        The aspect, 'A', or the orientation, 'A@2', that is counted.
    """
    if verified is None:
        return []
    void = list(verified.void(part, bowl, __version__, wanted))
    if void:
        return [f"the trial of this bowl file is void: {'; '.join(void)} - run feeder design again"]
    return [verified.sentence]


def holds(verified, part, bowl, wanted=None):
    """Return whether a bowl file has a trial that is still of this part, this bowl and what is wanted."""
    return verified is not None and not any(verified.void(part, bowl, __version__, wanted))


def leads(document):
    """Return whether a document's rate is that of its trial, and not that of the rule."""
    tried = document.get("verified")
    return bool(tried) and document["parts_per_minute"] == tried["parts_per_minute"]


def with_trial(document, verified, part, bowl, wanted=None):
    """Return a document with the trial's figures beside its own; the lower rate leads.

    A trial that counted several aspects as one leads in any case: the rule counts one orientation.

    Parameters
    ----------
    document : dict
        With ``parts_per_minute`` and its ends, or without a rate.
    verified : Verified, VoidTrial or None
    part : Part
    bowl : Bowl
    wanted : str, optional
        As for ``warnings``.

    Returns
    -------
    dict
        As given where there is no trial that holds.
    """
    if not holds(verified, part, bowl, wanted):
        return document if verified is None else document | {"verified": None}
    tried = _rates(verified)
    document = document | {"verified": block(verified)}
    own = {name: document[name] for name in tried if name in document}
    if not own:
        return document
    lead = tried if verified.up or tried["parts_per_minute"] <= own["parts_per_minute"] else own
    led = {name: lead[name] for name in own}
    return document | led | {"parts_per_minute_static": own["parts_per_minute"]}


def _rates(verified) -> dict[Any, Any]:
    """The rate of a trial with its ends [1/min]."""
    names = ("parts_per_minute", "parts_per_minute_low", "parts_per_minute_high")
    return dict(zip(names, (end / PER_MINUTE for end in (verified.delivered, verified.low, verified.high))))


def block(verified) -> dict[Any, Any]:
    """Return what a trial has shown as a dict."""
    return {
        "status": verified.status,
        "wanted": verified.wanted,
        "up": verified.up,
        **_rates(verified),
        "purity": verified.purity,
        "jams": verified.jams,
        "queue_seconds": verified.queue_seconds,
        "draws": verified.draws,
        "draws_held": verified.held,
    }
