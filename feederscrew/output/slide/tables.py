"""The sliding maps of a bowl as tables: every cell, and what holds at the bowl's own point."""

import numpy as np

from feederscrew.output import tables
from feederscrew.output.motion_words import regime_words

LIMITS = {  # what a summary says of each map, in this order
    "mu_limit": "limiting friction, level floor [4.27]",
    "mu_forward": "friction that stops forward slip",
    "mu_backward": "friction that stops backward slip",
    "throw_number": "throw number (hops above 1)",
}
ONSETS = {"forward": "G of forward slip", "backward": "G of backward slip", "hop": "G of the hop"}


def shown(study, format):
    """Return what a format prints of a SlideStudy: every cell as CSV, a summary for people."""
    return cells(study.maps) if format == "csv" else summary(study.maps)


def cells(slides):
    """Return every cell of every SlideMap, as a frame."""
    parts = []
    for one in slides:
        columns = one.grid.columns()
        count = len(columns["regime"])
        parts.append({"beta_deg": np.full(count, np.degrees(one.beta)), **columns})
    return tables.frame({name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def summary(slides):
    """Return what holds at the bowl's own point, a column a map, as a frame for people."""
    first = slides[0]
    names = ["acceleration ratio G = A w2/g", "alpha - theta [deg]", "static friction", *LIMITS.values()]
    names += [
        *ONSETS.values(),
        "regime",
        *(f"share of the map: {regime_words(name)}" for name in first.grid.names),
    ]
    columns = {f"beta = {np.degrees(one.beta):.6g} deg": _column(one) for one in slides}
    return tables.frame({"at the bowl's own point": names, **columns})


def document(study, settings):
    """Return a SlideStudy as the JSON document.

    Parameters
    ----------
    study : SlideStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    dict
    """
    maps = [_map(one) for one in study.maps]
    return {"bowl": settings, "as_published": study.as_published, "maps": maps}


def remarks(study):
    """Return what a reader of a SlideStudy should know, a sentence each."""
    lines = []
    for one in study.maps:
        shares, beta = one.grid.shares(), f"beta = {np.degrees(one.beta):.6g} deg"
        empty, cells = one.grid.unanswered("mu_limit"), one.grid.codes.size
        if shares["hop"] == 0.0:
            lines.append(f"{beta}: the drive does not lift the part, so no cell hops.")
        if shares["stick"] + shares["hop"] == 1.0:
            lines.append(f"{beta}: nothing slips before it hops at static friction {one.friction:g}.")
        if empty:
            lines.append(
                f"{beta}: mu_limit is empty in {empty} of {cells} cells, "
                "where no friction prevents forward slip (part hops)."
            )
    return lines


def settings(found):
    """Return the bowl settings and where each came from, as a frame."""
    columns = {
        "key": [s.key.name for s in found],
        "value": [s.text for s in found],
        "from": [s.origin for s in found],
        "lowest": [s.key.lowest for s in found],
        "highest": [s.key.highest for s in found],
        "meaning": [s.key.meaning for s in found],
    }
    return tables.frame(columns)


def _map(one):
    return {
        "beta_deg": np.degrees(one.beta),
        "operating_point": {
            "acceleration_ratio": one.ratio,
            "alpha_minus_theta_deg": np.degrees(one.alpha_minus_theta),
            "static_friction": one.friction,
            **one.at_bowl,
            "regime": one.regime,
        },
        "onset_ratios": one.onsets,
        "shares": one.grid.shares(),
        "cells": one.grid.columns(),
    }


def _column(one):
    numbers = [one.ratio, np.degrees(one.alpha_minus_theta), one.friction]
    numbers += [one.at_bowl[name] for name in LIMITS] + [one.onsets[name] for name in ONSETS]
    shares = [_percent(share) for share in one.grid.shares().values()]
    return [*(_number(number) for number in numbers), regime_words(one.regime), *shares]


def _number(value):
    if np.isnan(value):
        return "none"
    return "never" if np.isinf(value) else f"{value:.4g}"


def _percent(share):
    return "< 1 %" if 0.0 < share < 0.005 else f"{100 * share:.0f} %"
