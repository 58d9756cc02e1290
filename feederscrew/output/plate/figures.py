"""Charts of dynamic bowl tests."""

import matplotlib
import numpy as np

from feederscrew.output import style
from feederscrew.output.plate.tables import travels
from feederscrew.resting.rules import registry
from feederscrew.units import MM, MM_S, counted

COLOURS = [rule.colour for rule in registry.RULES] + list(style.SPARE)
LABELLED = 0.02  # share of the parts from which an aspect carries its name, or a line in a trend
APART = 0.012  # of the range of throw numbers: from one aspect's points to the next one's
GREY = "#aab4bd"


def one(study):
    """Draw shares over time on one plate, and beside them how parts lay at first, later and in the end.

    Parameters
    ----------
    study : PlateStudy
        Its first plate is drawn.

    Returns
    -------
    Figure
    """
    aspects, result = study.aspects, study.plates[0]
    title = f"{study.part.name}: {counted(result.parts, 'part')}, throw number {result.throw_number:.3g}"
    figure = style.figure(8.2, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    style.tidy(left, title=title, x="time on the plate [s]", y="parts [%]", grid="y")
    style.tidy(
        right, title=travels(result, 3) + ", partial" * result.partial, x="aspect", y="share [%]", grid="y"
    )
    over_time(left, aspects, result)
    shares(right, aspects, result.occupancy)
    right.legend(fontsize=8, frameon=False, loc="upper right", labelcolor=style.INK)
    return figure


def over_time(axes, aspects, result):
    """Draw the stacked share of each aspect at every look; what is white above was not down yet."""
    course = 100.0 * result.occupancy.course
    time = np.linspace(0.0, result.seconds, len(course))
    axes.stackplot(time, course.T, colors=[colour(k) for k in range(course.shape[1])], alpha=0.85, lw=0.0)
    middle = np.cumsum(course, axis=1) - 0.5 * course
    for k, name in enumerate(aspects.names):
        if course[-1, k] > 100.0 * LABELLED:
            axes.annotate(
                name, (time[-1], middle[-1, k]), (4, 0), textcoords="offset points", va="center",
                fontsize=8, color=style.INK, annotation_clip=False,
            )  # fmt: skip
    axes.set_xlim(0.0, time[-1])
    axes.set_ylim(0.0, 100.0)


def shares(axes, aspects, seen):
    """Draw how parts lay at first and in the second half, with its interval, and where the rates lead."""
    places = np.arange(len(aspects.names))
    axes.bar(places - 0.2, 100.0 * seen.start, 0.36, color=GREY, label="at first")
    axes.bar(places + 0.2, 100.0 * seen.plate, 0.36, color=style.INK, alpha=0.8, label="second half")
    error = 100.0 * np.stack([seen.plate - seen.plate_low, seen.plate_high - seen.plate])
    axes.errorbar(places + 0.2, 100.0 * seen.plate, error, fmt="none", ecolor=style.INK, capsize=3, lw=1.0)
    spread = 100.0 * np.stack([seen.limit - seen.limit_low, seen.limit_high - seen.limit])
    axes.errorbar(
        places + 0.3, 100.0 * seen.limit, spread, fmt="_", ms=9, mew=2, color=style.ACCENT, capsize=3, lw=1.0,
        label=None if np.isnan(seen.limit).all() else "where the rates lead",
    )  # fmt: skip
    style.named_ticks(axes, places, aspects.names)
    axes.tick_params(axis="x", length=0)


def trend(study):
    """Draw shares and velocity over the throw number, a line an aspect.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    Figure
    """
    aspects = study.aspects
    title = f"{study.part.name} on {len(study.plates)} plates" + ", partial" * study.plates[-1].partial
    figure = style.figure(8.2, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    style.tidy(left, title=title, x="throw number", y="share in the second half [%]")
    style.tidy(right, title="Transport", x="throw number", y="velocity [mm/s]")
    order = np.argsort([result.throw_number for result in study.plates], kind="stable")
    results, names = [study.plates[k] for k in order], [study.names[k] for k in order]
    x = np.array([result.throw_number for result in results])
    seen = [result.occupancy for result in results]
    shown = [k for k in range(len(aspects.names)) if max(one.plate[k] for one in seen) > LABELLED]
    over_throw(left, x, seen, {k: aspects.names[k] for k in shown})
    velocity = np.array([one.velocity for one in seen]) / MM_S
    ends = np.abs(velocity[:, 1:] - velocity[:, :1]).T
    right.errorbar(x, velocity[:, 0], ends, color=style.INK, marker="o", ms=4, capsize=2)
    named(right, x, results, names)
    figure.legend(
        *left.get_legend_handles_labels(), loc="outside lower center", ncols=12, fontsize=8, frameon=False,
        labelcolor=style.INK, title="dotted: at first" + _left_out(aspects, shown), title_fontsize=8,
    )  # fmt: skip
    return figure


def over_throw(axes, x, seen, names):
    """Draw the share of each named aspect over the (N,) throw numbers ``x``, set a little apart."""
    for place, (k, name) in enumerate(names.items()):
        at = x + APART * np.ptp(x) * (place - 0.5 * (len(names) - 1))
        middle, low, high = (
            100.0 * np.array([getattr(one, end)[k] for one in seen])
            for end in ("plate", "plate_low", "plate_high")
        )
        spread = [middle - low, high - middle]
        axes.errorbar(at, middle, spread, color=colour(k), marker="o", ms=4, capsize=2, label=name)
        axes.plot(at, [100.0 * one.start[k] for one in seen], ls=":", lw=1.0, color=colour(k))


def _left_out(aspects, shown):
    """What the picture does not show, as a clause."""
    count = len(aspects.names) - len(shown)
    return f"; {count} aspects never above {100.0 * LABELLED:g} % left out" if count else ""


def named(axes, x, results, names):
    """Draw the stroke of each plate over its point, and the bowl's name where there are several."""
    several = len(set(names)) > 1
    for at, result, name in zip(x, results, names):
        stroke = f"{result.bowl.drive.amplitude / MM:.3g} mm"
        axes.annotate(
            f"{name} {stroke}" if several else stroke,
            (at, np.nanmax(result.occupancy.velocity) / MM_S), (0, 4), textcoords="offset points",
            ha="center", fontsize=7, color=style.INK,
        )  # fmt: skip
    axes.margins(x=0.2, y=0.15)


def colour(k):
    """Return the colour of the k-th aspect; further ones run through a map."""
    return COLOURS[k] if k < len(COLOURS) else matplotlib.colormaps["viridis"]((0.37 * k) % 1.0)
