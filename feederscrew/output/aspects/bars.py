"""Bar charts of probability profiles."""

import numpy as np

from feederscrew.output import style

BAR = 0.34  # [in] of paper a bar gets
NARROW, WIDE = 5.2, 12.0  # [in] limits of the figure's width
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
    axes = style.tidy(
        figure.add_subplot(), title=style.words(title), x="aspect", y="probability [%]", grid="y"
    )
    grouped(axes, names, profiles, room=(width - 1.0) / (len(names) * (len(profiles) + 1.0)))
    figure.legend(loc="outside lower center", ncols=min(len(profiles), 6), frameon=False, fontsize=8)
    return figure


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
    axes.set_xticks(places, names)
    axes.tick_params(axis="x", length=0)
    reach = max(0.5 * len(names), 1.0) + 0.5 * width
    axes.set_xlim(places.mean() - reach, places.mean() + reach)
    axes.set_ylim(0.0, highest * 1.14)


def _numbers(axes, x, percent, known, upright):
    for at, value in zip(x[known], percent[known]):
        axes.annotate(
            f"{value:.1f}",
            (at, value),
            (0, 2),
            textcoords="offset points",
            ha="center",
            va="bottom",
            rotation=90 if upright else 0,
            fontsize=6.5,
            color=style.INK,
        )
