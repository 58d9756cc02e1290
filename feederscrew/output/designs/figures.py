"""The loop's history as a picture."""

import numpy as np

from feederscrew.output import style
from feederscrew.units import PER_MINUTE

FEWEST = 8  # trials there is room for: a single one is a bar, not a block
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
    style.tidy(axes, x="trial", y="parts per minute", grid="y")
    bars = axes.bar(
        places, rates, color=colours, edgecolor="white", hatch=["" if good else "//" for good in clean]
    )
    target = study.request.target / PER_MINUTE
    line = axes.axhline(target, color=style.INK, linewidth=1.2, linestyle="--", label="asked for")
    for place, rate, one in zip(places, rates, study.attempts):
        axes.text(place, rate, one.wanted, ha="center", va="bottom", fontsize=7 if len(rates) < 12 else 5.5)
    axes.set_xticks(places)
    axes.set_xlim(0.4, max(len(places), FEWEST) + 0.6)
    axes.set_ylim(0.0, 1.12 * max([target, *rates]))
    named = {True: "only what is wanted leaves, and nothing stays", False: "denied"}
    handles = [bars[clean.index(good)] for good in named if good in clean]
    labels = [named[good] for good in named if good in clean]
    axes.legend(
        [line, *handles], ["asked for", *labels], frameon=False, fontsize=8, labelcolor=style.INK,
        loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3,
    )  # fmt: skip
    return figure
