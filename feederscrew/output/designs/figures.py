"""The loop's history as a picture."""

import numpy as np

from feederscrew.output import style
from feederscrew.output.designs.tables import PER_MINUTE

CLEAN, DENIED = "#009e73", style.ACCENT


def history(study):
    """Return the figure of every short trial: the rate it would deliver, and what it lost.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    Figure
    """
    figure = style.figure(7.0, 3.0)
    axes = figure.add_subplot()
    places = np.arange(1, len(study.attempts) + 1)
    rates = [one.rate / PER_MINUTE for one in study.attempts]
    clean = [one.clean for one in study.attempts]
    colours = [CLEAN if good else DENIED for good in clean]
    axes.bar(places, rates, color=colours)
    axes.axhline(study.request.target / PER_MINUTE, color="black", linewidth=0.8, label="asked for")
    for place, rate, one in zip(places, rates, study.attempts):
        axes.text(place, rate, one.wanted, ha="center", va="bottom", fontsize=7)
    axes.set_xlabel("trial; green: only what is wanted leaves, and nothing stays")
    axes.set_ylabel("parts per minute")
    axes.set_xticks(places)
    axes.legend(frameon=False, fontsize=8)
    return figure
