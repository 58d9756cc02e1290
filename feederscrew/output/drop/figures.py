"""Charts of drop tests."""

import numpy as np

from feederscrew.output import style
from feederscrew.output.aspects.bars import MARKS

STEP = 0.09  # of a group: from the whisker to the mark of a rule, and from there to the next


def counts(title, aspects, tally, rules):
    """Draw the chart of a drop test with its intervals, beside what the rules say.

    Parameters
    ----------
    title : str
    aspects : Aspects
    tally : Tally
    rules : dict of str to (A,) float [1]
        Drawn as marks over each bar.

    Returns
    -------
    Figure
    """
    places = np.arange(len(aspects.names))
    figure = style.figure(float(np.clip(0.9 * len(places) + 2.0, 5.2, 12.0)), 3.4)
    axes = style.tidy(figure.add_subplot(), title=title, x="aspect", y="probability [%]", grid="y")
    bars(axes, places, tally)
    for place, (name, values) in enumerate(rules.items()):
        label, colour = style.method(name, place)
        beside = places + STEP * (place + 1)  # of the whisker, which stands in the middle
        look = {"marker": MARKS[place % len(MARKS)], "ms": 5, "mec": "white", "mew": 0.6, "color": colour}
        axes.plot(beside, 100.0 * values, ls="none", label=label, **look)
    style.named_ticks(axes, places, aspects.names)
    figure.legend(loc="outside lower center", ncols=min(len(rules) + 2, 6), frameon=False, fontsize=8)
    return figure


def bars(axes, places, tally):
    """Draw bars of the drops with 95 % intervals, and the band from gentle to violent launches behind."""
    low = 100.0 * np.minimum(tally.gentle, tally.violent)
    high = 100.0 * np.maximum(tally.gentle, tally.violent)
    axes.bar(places, high - low, 0.8, bottom=low, color=style.FAINT, label="gentle to violent launches")
    error = 100.0 * np.stack([tally.p - tally.low, tally.high - tally.p])
    axes.bar(places, 100.0 * tally.p, 0.4, color=style.ANSWER, label="drops")
    axes.errorbar(places, 100.0 * tally.p, error, fmt="none", ecolor=style.INK, capsize=4, linewidth=1.0)
