"""Charts of dynamic bowl tests."""

import matplotlib
import numpy as np

from feederscrew.output import plots
from feederscrew.output.columns import MM
from feederscrew.output.plate_tables import MM_S

COLOURS = [colour for _, colour in plots.METHODS.values()] + list(plots.SPARE)
LABELLED = 0.02  # share of the parts from which an area over time carries its name
GREY = "#aab4bd"


def one(title, aspects, result):
    """Shares over time on one plate, and beside them how parts fell, lay and would lie in the end.

    Parameters
    ----------
    title : str
    aspects : Aspects
    result : feederscrew.motion.plate.report.Shaken

    Returns
    -------
    Figure
    """
    figure = plots.figure(8.2, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    plots.tidy(left, title=plots.words(title), x="time on the plate [s]", y="parts [%]", grid="y")
    plots.tidy(right, title=_speed(result), x="aspect", y="share [%]", grid="y")
    over_time(left, aspects, result)
    shares(right, aspects, result.occupancy)
    right.legend(fontsize=8, frameon=False, loc="upper right", labelcolor=plots.INK)
    return figure


def over_time(axes, aspects, result):
    """Stacked share of each aspect at every look; what is white above was not down yet."""
    course = 100.0 * result.occupancy.course
    time = np.linspace(0.0, result.seconds, len(course))
    axes.stackplot(time, course.T, colors=[colour(k) for k in range(course.shape[1])], alpha=0.85, lw=0.0)
    middle = np.cumsum(course, axis=1) - 0.5 * course
    for k, name in enumerate(aspects.names):
        if course[-1, k] > 100.0 * LABELLED:
            axes.annotate(
                name, (time[-1], middle[-1, k]), (4, 0), textcoords="offset points", va="center",
                fontsize=8, color=plots.INK, annotation_clip=False,
            )  # fmt: skip
    axes.set_xlim(0.0, time[-1])
    axes.set_ylim(0.0, 100.0)


def shares(axes, aspects, seen):
    """How parts fell, how they lay in the second half with its interval, and where the rates lead."""
    places = np.arange(len(aspects.names))
    axes.bar(places - 0.2, 100.0 * seen.start, 0.36, color=GREY, label="as they fell")
    axes.bar(places + 0.2, 100.0 * seen.plate, 0.36, color=plots.INK, alpha=0.8, label="second half")
    error = 100.0 * np.stack([seen.plate - seen.plate_low, seen.plate_high - seen.plate])
    axes.errorbar(places + 0.2, 100.0 * seen.plate, error, fmt="none", ecolor=plots.INK, capsize=3, lw=1.0)
    spread = 100.0 * np.stack([seen.limit - seen.limit_low, seen.limit_high - seen.limit])
    axes.errorbar(
        places + 0.3, 100.0 * seen.limit, spread, fmt="_", ms=9, mew=2, color=plots.ACCENT, capsize=3, lw=1.0,
        label="where the rates lead",
    )  # fmt: skip
    axes.set_xticks(places, aspects.names)
    axes.tick_params(axis="x", length=0)


def trend(title, aspects, results, names):
    """Shares and velocity over the throw number, a line an aspect.

    Parameters
    ----------
    title : str
    aspects : Aspects
    results : sequence of feederscrew.motion.plate.report.Shaken
    names : sequence of str
        Of the bowl of each result.

    Returns
    -------
    Figure
    """
    figure = plots.figure(8.2, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    x = np.array([result.throw_number for result in results])
    order = np.argsort(x, kind="stable")
    plots.tidy(left, title=plots.words(title), x="throw number", y="share in the second half [%]")
    plots.tidy(right, title="Transport", x="throw number", y="velocity [mm/s]")
    seen = [results[k].occupancy for k in order]
    for k, name in enumerate(aspects.names):
        middle, low, high = (
            100.0 * np.array([getattr(one, end)[k] for one in seen])
            for end in ("plate", "plate_low", "plate_high")
        )
        left.errorbar(
            x[order],
            middle,
            [middle - low, high - middle],
            color=colour(k),
            marker="o",
            ms=4,
            capsize=2,
            label=name,
        )
        left.plot(x[order], [100.0 * one.start[k] for one in seen], ls=":", lw=1.0, color=colour(k))
    velocity = np.array([one.velocity for one in seen]) / MM_S
    right.errorbar(
        x[order],
        velocity[:, 0],
        np.abs(velocity[:, 1:] - velocity[:, :1]).T,
        color=plots.INK,
        marker="o",
        ms=4,
        capsize=2,
    )
    named(right, x, results, names)
    left.legend(
        fontsize=8,
        frameon=False,
        ncols=2,
        labelcolor=plots.INK,
        title="dotted: as they fell",
        title_fontsize=8,
    )
    return figure


def named(axes, x, results, names):
    """The stroke of each plate over its point, and the bowl's name where there are several."""
    several = len(set(names)) > 1
    for at, result, name in zip(x, results, names):
        stroke = f"{result.bowl.drive.amplitude / MM:.3g} mm"
        axes.annotate(
            plots.words(f"{name} {stroke}" if several else stroke),
            (at, result.occupancy.velocity[0] / MM_S), (0, 7), textcoords="offset points", ha="center",
            fontsize=7, color=plots.INK,
        )  # fmt: skip
    axes.margins(x=0.12, y=0.15)


def colour(k):
    """Colour of the k-th aspect; further ones run through a map."""
    return COLOURS[k] if k < len(COLOURS) else matplotlib.colormaps["viridis"]((0.37 * k) % 1.0)


def _speed(result):
    speed, low, high = result.occupancy.velocity / MM_S
    return f"travels at {speed:.3g} mm/s ({low:.3g} to {high:.3g})"
