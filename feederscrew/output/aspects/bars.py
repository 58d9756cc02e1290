"""Bar charts of probability profiles."""

import numpy as np

from feederscrew.output import style

BAR = 0.34  # [in] of paper a bar gets
NARROW, WIDE = 5.2, 12.0  # [in] limits of the figure's width
GROUP = 1.0  # [in] of paper an aspect gets beside the recommended answer
THICK, ASIDE = 0.3, 0.22  # [1] of a group: width of the recommended answer's bar, its way to the left
FIRST, LAST = 0.0, 0.36  # [1] of a group: where the marks of the rules begin and end
MARKS = "osD^vPX*<>hp"  # of the rules: who does not see their colours tells them apart by shape
ANSWERED = "recommended, with interval"
BROAD, FEW, MANY = 6.0, 3, 5  # [in] width from which a legend has many columns, and how many
UPRIGHT = 0.31  # [in] below this width of a bar its number stands on end


def probabilities(names, profiles, title=""):
    """Draw the chart of several profiles side by side, grouped by aspect.

    Parameters
    ----------
    names : sequence of str
        The A aspects.
    profiles : dict of str to (A,) float [1]
        Probability by aspect, by rule or by the name of an experiment; NaN draws no bar.
    title : str
        Over the chart.

    Returns
    -------
    Figure
    """
    width = float(np.clip(len(names) * (len(profiles) + 1.0) * BAR + 1.0, NARROW, WIDE))
    figure = style.figure(width, 3.4)
    axes = style.tidy(figure.add_subplot(), title=title, x="aspect", y="probability [%]", grid="y")
    grouped(axes, names, profiles, room=(width - 1.0) / (len(names) * (len(profiles) + 1.0)))
    figure.legend(loc="outside lower center", ncols=min(len(profiles), 6), frameon=False, fontsize=8)
    return figure


def answered(names, answer, profiles, title=""):
    """Draw the recommended answer with its interval as a bar, and every rule as a small mark beside it.

    Parameters
    ----------
    names : sequence of str
        The A aspects.
    answer : (3, A) array_like [1]
        Probability, and the lower and upper end of its interval.
    profiles : dict of str to (A,) float [1]
        Probability by rule.
    title : str
        Over the chart.

    Returns
    -------
    Figure
    """
    width = float(np.clip(len(names) * GROUP + 1.0, NARROW, WIDE))
    figure = style.figure(width, 3.4)
    axes = style.tidy(figure.add_subplot(), title=title, x="aspect", y="probability [%]", grid="y")
    places = np.arange(len(names))
    share, low, high = 100.0 * np.asarray(answer, dtype=float)
    axes.bar(places - ASIDE, share, THICK, color=style.ANSWER, label=ANSWERED)
    reach = np.maximum([share - low, high - share], 0.0)
    axes.errorbar(places - ASIDE, share, reach, fmt="none", ecolor=style.INK, elinewidth=1.4, capsize=3)
    _numbers(axes, places - ASIDE, np.maximum(share, high), np.isfinite(share), upright=False, texts=share)
    steps = np.linspace(FIRST, LAST, len(profiles))
    for place, (step, (name, values)) in enumerate(zip(steps, profiles.items())):
        label, colour = style.method(name, place)
        look = {"marker": MARKS[place % len(MARKS)], "markersize": 4.2, "linestyle": "none", "color": colour}
        axes.plot(places + step, 100.0 * np.asarray(values), label=label, **look)
    style.named_ticks(axes, places, names)
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(-0.55, len(names) - 0.45)
    every = [high, *(100.0 * np.asarray(values) for values in profiles.values())]
    axes.set_ylim(0.0, 1.12 * np.nanmax(every))
    _first_in_legend(figure, axes, MANY if width >= BROAD else FEW)
    return figure


def _first_in_legend(figure, axes, columns):
    """Draw the legend with the bar before the marks: matplotlib lists lines first."""
    handles, labels = axes.get_legend_handles_labels()
    first = labels.index(ANSWERED)
    order = [first, *(place for place in range(len(labels)) if place != first)]
    listed = [handles[place] for place in order], [labels[place] for place in order]
    figure.legend(*listed, loc="outside lower center", ncols=columns, frameon=False, fontsize=7.5)


def grouped(axes, names, profiles, room=UPRIGHT):
    """Draw the bars of several profiles on an Axes, each with its value over it.

    Parameters
    ----------
    axes : Axes
        To draw on.
    names, profiles
        As in `probabilities`.
    room : float [in]
        Width of paper a bar has; decides whether its number is written across or on end.
    """
    places = np.arange(len(names))
    width = 1.0 / (len(profiles) + 1.0)
    highest = 0.0
    for place, (name, values) in enumerate(profiles.items()):
        label, colour = style.method(name, place)
        percent = 100.0 * np.nan_to_num(np.asarray(values, dtype=float))
        highest = max(highest, percent.max())
        x = places + (place - 0.5 * (len(profiles) - 1)) * width
        axes.bar(x, percent, 0.9 * width, color=colour, label=label)
        _numbers(axes, x, percent, np.isfinite(values), upright=room < UPRIGHT)
    style.named_ticks(axes, places, names)
    axes.tick_params(axis="x", length=0)
    reach = max(0.5 * len(names), 1.0) + 0.5 * width
    axes.set_xlim(places.mean() - reach, places.mean() + reach)
    axes.set_ylim(0.0, highest * 1.14)


def _numbers(axes, x, percent, known, upright, texts=None):
    """Write the percentages, or ``texts`` in their place, over the ends of bars."""
    look = {} if texts is None else {"fontweight": "bold"}
    texts = percent if texts is None else texts
    for at, value, text in zip(x[known], percent[known], texts[known]):
        axes.annotate(
            f"{text:.1f}",
            (at, value),
            (0, 2),
            textcoords="offset points",
            ha="center",
            va="bottom",
            rotation=90 if upright else 0,
            fontsize=6.5,
            color=style.INK,
            **look,
        )
