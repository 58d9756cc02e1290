"""Probability profiles side by side, and the one place for the colour of a profile."""

import numpy as np
from matplotlib.patches import Patch

from feederscrew.output import style
from feederscrew.resting.rules import registry

RAMPS = {  # test series: one hue each, darker with the amplitude
    "MDBT": ("#c3c8ce", "#8d97a2", "#545f6b"),
    "MDFT": ("#e3c4d6", "#cc79a7", "#8f4a71"),
}
FIXED = {
    "CSA_at_0.4": ("CSA at ratio 0.4", "#f3c565"),
    "CSA_Table_3-1": ("CSA, Table 3-1", "#b67c00"),
    "CSA_mixed_heights": ("CSA, mixed heights", "#f3c565"),
    "experiment": ("experiment", "#545f6b"),
    "recommended": ("recommended", style.ANSWER),
}
OWN = ("#545f6b", "#cc79a7", "#a9b3bd", "#8f4a71", "#7d6b5d", "#5b3a8e")  # a user's profiles, in turn
BAR = 0.20  # [in] of paper a bar gets
WIDEST = 13.0  # [in] of all charts side by side
UPRIGHT = 0.3  # [in] of a bar below which its number stands upright
LEAST_ROOM = 0.17  # [in] of a bar below which its number is left out


def look(name, place=0):
    """Return label and colour of a profile, the same in every chart.

    Parameters
    ----------
    name : str
        A rule in any case, 'MDBT_80', or a user's own.
    place : int
        Of a user's own profile among its like.

    Returns
    -------
    label, colour : str
    """
    series, _, amplitude = name.rpartition("_")
    if series in RAMPS and amplitude in ("78", "80", "82"):
        return f"{series} {amplitude} %", RAMPS[series][("78", "80", "82").index(amplitude)]
    if name in FIXED:
        return FIXED[name]
    if name.lower() in registry.RULE_OF:
        return style.method(name.lower())
    return name.replace("_", " "), OWN[place % len(OWN)]


def bars(axes, names, profiles, printed=None, room=BAR):
    """Draw the grouped bars on an Axes, with a tick where print has the number.

    Parameters
    ----------
    axes : Axes
        To draw on.
    names : sequence of str
        The A aspects.
    profiles : dict of str to (A,) float [1]
        By profile name.
    printed : dict of str to (A,) float [1]
        Published numbers of some of them.
    room : float [in]
        Width of paper a bar has.
    """
    places, width = np.arange(len(names)), 1.0 / (len(profiles) + 0.9)
    for place, (name, values) in enumerate(profiles.items()):
        label, colour = look(name, place)
        x = places + (place - 0.5 * (len(profiles) - 1)) * width
        axes.bar(x, 100.0 * values, 0.92 * width, color=colour, label=label)
        if room >= LEAST_ROOM:
            _numbers(axes, x, 100.0 * values, upright=room < UPRIGHT)
        if name in (printed or {}):
            _ticks(axes, x, 100.0 * printed[name], width)
    style.named_ticks(axes, places, names)
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(-0.55, len(names) - 0.45)
    above = (
        132.0 if LEAST_ROOM <= room < UPRIGHT else 114.0
    )  # numbers that stand upright are kept off the title
    axes.set_ylim(0.0, above * max(values.max() for values in profiles.values()))


def comparison(title, names, measured, rules, compared):
    """Draw one chart a rule against everything measured, and how far each profile is from what was measured.

    Parameters
    ----------
    title : str
        The part's name.
    names : sequence of str
        The A aspects.
    measured, rules : dict of str to (A,) float [1]
    compared : dict of (str, str) to float [1]
        Deviation of each pair of profiles.

    Returns
    -------
    Figure
    """
    width = float(np.clip(len(names) * (len(measured) + 1.9) * BAR + 1.0, 4.2, 12.0))
    side, tall = max(3.1, 0.42 * len(measured) + 1.5), 0.42 * (len(measured) + len(rules)) + 1.3
    across = max(1, min(len(rules), int(WIDEST / width)))
    rows = -(-max(len(rules), 1) // across)
    figure = style.figure(across * width + side, max(2.2 * rows, tall))
    grid = figure.add_gridspec(rows, across + 1, width_ratios=(*[width] * across, side))
    charts = {name: {**measured, name: values} for name, values in rules.items()} or {title: measured}
    room = (width - 1.0) / (len(names) * (len(measured) + 1.9))
    for place, (rule, profiles) in enumerate(charts.items()):
        row, column = divmod(place, across)
        axes = figure.add_subplot(grid[row, column])
        heading = (f"{title}: " if place == 0 else "") + look(rule)[0] if rules else title
        lowest, first = place + across >= len(charts), column == 0
        style.tidy(
            axes, title=heading, x="aspect" if lowest else "", y="share [%]" if first else "", grid="y"
        )
        bars(axes, names, profiles, room=room)
    _legend(figure, measured, rules)
    _matrix(figure.add_subplot(grid[:, across]), list(measured), list(rules), compared)
    return figure


def _legend(figure, measured, rules):
    """One entry a profile, whatever chart it stands in."""
    looks = [look(name, place) for place, name in enumerate(measured)]
    looks += [look(name, len(measured)) for name in rules]
    handles = [Patch(color=colour, label=label) for label, colour in looks]
    figure.legend(
        handles=handles, loc="outside lower center", ncols=min(len(handles), 9), frameon=False, fontsize=8
    )


def _matrix(axes, measured, rules, compared):
    """Deviations of every profile from those that were measured, as a table of shades."""
    names, known = [*measured, *rules], {frozenset(pair): value for pair, value in compared.items()}
    values = np.full((len(names), len(measured)), np.nan)
    for j, i in zip(*np.tril_indices(len(names), -1, len(measured))):
        values[j, i] = known.get(frozenset((names[j], names[i])), np.nan)
    rows = slice(1, None)  # the first has nothing before it
    top = max(np.nanmax(values, initial=0.0), 0.1)
    axes.imshow(values[rows], cmap="Blues", vmin=0.0, vmax=1.25 * top, aspect="equal")
    for (j, i), value in np.ndenumerate(values[rows]):
        if np.isfinite(value):
            colour = "white" if value > 0.6 * top else style.INK
            axes.text(i, j, f"{value:.3f}", ha="center", va="center", fontsize=7, color=colour)
    labels = [look(name, place)[0] for place, name in enumerate(names)]
    style.tidy(axes, title="Deviation from\nwhat was measured", grid="none")
    axes.set_xticks(range(len(measured)), labels[: len(measured)], rotation=45, ha="right")
    axes.set_yticks(range(len(names) - 1), labels[1:])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)


def _numbers(axes, x, percent, upright):
    for at, value in zip(x, percent):
        text = f"{value:.1f}"
        axes.annotate(
            text, (at, value), (0, 2), textcoords="offset points", ha="center", va="bottom", fontsize=6.5,
            rotation=90 if upright else 0, color=style.INK,
        )  # fmt: skip


def _ticks(axes, x, percent, width):
    axes.hlines(percent, x - 0.46 * width, x + 0.46 * width, color=style.INK, linewidth=1.1, zorder=3)
