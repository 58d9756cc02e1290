"""Figures 3-6 to 3-13 and 5-1 to 5-7: what they draw, what print states of them, and the figures drawn again.

The printed curves are lost.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import matplotlib
import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.columns import Frame
from feederscrew.motion import limits
from feederscrew.output import compare, slide, style
from feederscrew.resting.deviation import deviation
from feederscrew.thesis import parts
from feederscrew.thesis.motion import Quantity
from feederscrew.thesis.tables import DIFFERS, EXACT_TO_PRINT, EXPLAINED, table

GRAVITY_OF_CHAPTER_5 = 9.8  # [m/s2]
AMPLITUDE_OF_5_6_M = 0.5e-3
FREQUENCY_OF_5_6_HZ = 60.0
RATIO_OF_5_6 = limits.acceleration_ratio(AMPLITUDE_OF_5_6_M, FREQUENCY_OF_5_6_HZ, GRAVITY_OF_CHAPTER_5)
BETA_OF_5_7 = np.radians(20.0)  # [rad]
FRICTION_OF_5_7 = 0.5  # [1]
BETAS_OF_5_1 = (10.0, 20.0, 30.0, 40.0)  # [deg]
BETA_OF = {"5-2": 10.0, "5-3": 20.0, "5-4": 40.0, "5-5": 10.0}  # [deg]
DRIVE_RATIOS = np.linspace(0.0, 1.0, 51)  # G; the printed axis is lost, and nothing hops up to here
HEADING_TURNS = np.radians(np.linspace(-90.0, 90.0, 61))  # alpha - theta
MEASURED = table("3-4").columns
COMPARED: dict[str, tuple[str, str, tuple[str, ...]]] = {  # caption, part, and what stands beside its PMI
    "3-9": ("Arc Chute, PMI and CSA", "arc_chute", ("CSA",)),
    "3-10": ("Arc Chute, PMI and experiment at three amplitudes", "arc_chute", MEASURED),
    "3-11": ("Arc Chute, PMI and stability method", "arc_chute", ("STABILITY",)),
    "3-12": ("Magnet, PMI and CSA", "magnet", ("CSA",)),
    "3-13": ("Magnet, PMI and experiment at three amplitudes", "magnet", MEASURED),
}
ASPECT_LINES = (  # of the T shape, A to E: colour and dashes
    ("#0072b2", "-"),
    ("#e69f00", "-"),
    ("#009e73", "-"),
    ("#cc79a7", "--"),
    ("#545f6b", "-"),
)
LABEL_BOX = {"facecolor": "white", "edgecolor": "none", "boxstyle": "round,pad=0.25"}
ACCELERATION_AXIS = "acceleration V'z [m/s²]"


@dataclass(frozen=True, eq=False)
class Bars:
    """Profiles side by side, a group of bars for each aspect."""

    aspects: tuple[str, ...]
    profiles: dict[str, Floats]  # (A,) [1] by name
    printed_shares: dict[str, Floats]  # (A,) [1] the numbers in print, where ours are recomputed


@dataclass(frozen=True, eq=False)
class ByRatio:
    """Probability of each aspect over the aspect ratio."""

    ratios: Floats  # (6,)
    rule: str
    lines: dict[str, Floats]  # (6,) [1] ours, by aspect
    points: dict[str, tuple[Floats, dict[str, Floats]]]  # what is in print: ratios and [1] by aspect


@dataclass(frozen=True, eq=False)
class Curves:
    """Figure 5-1."""

    ratios: Floats  # (N,) G
    limits: dict[float, Floats]  # (N,) limiting friction by beta [deg]


@dataclass(frozen=True, eq=False)
class FigureGrid:
    """A value over two parameters."""

    x: Floats  # (N,)
    y: Floats  # (M,)
    values: Floats  # (M, N)
    throw: Floats  # (M, N) [1] throw number: contact is lost from 1 on
    columns: tuple[str, str, str]  # of x, y and values in a table
    axes: tuple[str, str]  # labels of x and y
    ticks: tuple[Floats, Floats]  # x and y in the units of table and axes

    @property
    def hops(self) -> Bools:
        """(M, N) bool, contact is lost."""
        return self.throw >= 1.0 - limits.HOP_ROUNDING


Data = Bars | ByRatio | Curves | FigureGrid


@dataclass(frozen=True)
class Claim:
    """One statement in print on a figure, and the number that decides it."""

    statement: str  # in our words
    published: str  # what the number should be: '40 to 60'
    recomputed: float
    holds: bool
    finding: str = ""
    is_explained: bool = False  # the finding says where it holds, and there it does

    @property
    def verdict(self) -> str:
        """As of a cell."""
        if self.holds:
            return EXACT_TO_PRINT
        return EXPLAINED if self.finding and self.is_explained else DIFFERS


@dataclass(frozen=True)
class Figure:
    """One figure of the thesis."""

    number: str
    caption: str
    draw_data: Callable[..., "style.Figure"]  # of its title and its data
    data: Callable[[], Data]

    @property
    def claims(self) -> tuple[Claim, ...]:
        """The statements in print on it."""
        return tuple((_chapter_3_claims if self.number[0] == "3" else _chapter_5_claims)(self.number))


def _t_shape_profiles() -> Bars:
    """Figure 3-6: the T shape at aspect ratio 0.6."""
    ours, ngoi = parts.t_aspects(0.6), table("3-1")
    profiles = {
        "PMI": ours.pmi,
        "CSA": ours.csa,
        f"CSA_at_{parts.THINNER_RATIO}": parts.t_aspects(parts.THINNER_RATIO).csa,
        "CSA_Table_3-1": ngoi.numbers("csa") / 100.0,
        "experiment": ngoi.numbers("experiment") / 100.0,
    }
    return Bars(ngoi.names, profiles, {"PMI": table("3-8").numbers("probability")})


def by_ratio(rule: str) -> ByRatio:
    """Return Figure 3-7, rule 'pmi', or Figure 3-8, 'csa' with what survives of the measured curves."""
    ratios = np.array([float(ratio) for ratio in parts.T_RATIOS])
    values = np.array([getattr(parts.t_aspects(ratio), rule) for ratio in ratios]).T
    lines = dict(zip(table("3-9").names, values, strict=True))
    if rule == "pmi":
        rows = np.array([table("3-9").numbers(ratio) for ratio in parts.T_RATIOS]).T / 100.0
        return ByRatio(ratios, "PMI", lines, {"Table 3-9": (ratios, dict(zip(table("3-9").names, rows)))})
    points = {
        f"{name}, Table 3-1": (
            np.array([0.6]),
            dict(zip(table("3-1").names, table("3-1").numbers(column)[:, None] / 100.0)),
        )
        for name, column in (("CSA", "csa"), ("experiment", "experiment"))
    }
    return ByRatio(ratios, "CSA", lines, points)


def _profiles(number: str) -> Bars:
    """The PMI profile of a part beside others; the Magnet's CSA with mixed heights too."""
    _, part, names = COMPARED[number]
    profiles, numbers = parts.profiles(part), parts.TABLES_OF[part]
    chosen = {name: profiles[name] for name in ("PMI", *names)}
    if number == "3-12":
        chosen["CSA_mixed_heights"] = parts.mixed_heights()
    rules = [name for name in chosen if name.lower() in numbers]
    printed = {name: table(numbers[name.lower()]).numbers("probability") for name in rules}
    return Bars(table(numbers["pmi"]).names, chosen, printed)


def figure_5_1() -> Curves:
    """Return limiting friction over G for alpha = theta, eq. [4.28].

    Returns
    -------
    Curves
    """
    betas = {beta: limits.published_limit(DRIVE_RATIOS, np.radians(beta)) for beta in BETAS_OF_5_1}
    return Curves(DRIVE_RATIOS, betas)


def limit_surface(number: str) -> FigureGrid:
    """Return limiting friction over alpha - theta [rad] and G, eq. [4.27].

    Parameters
    ----------
    number : str
        Of the figure: '5-2' to '5-5'.

    Returns
    -------
    FigureGrid
    """
    beta, ratios = np.radians(BETA_OF[number]), DRIVE_RATIOS[:, None]
    values, throw = limits.published_limit(ratios, beta, HEADING_TURNS), limits.throw_number(ratios, beta)
    columns, axes = ("alpha_minus_theta_deg", "acceleration_ratio", "mu_limit"), (slide.ANGLE, slide.RATIO)
    ticks = np.degrees(HEADING_TURNS), DRIVE_RATIOS
    return _grid(HEADING_TURNS, DRIVE_RATIOS, values, throw, columns, axes, ticks)


def sliding_acceleration(acceleration: Quantity, beta: Quantity, friction: Quantity) -> Floats:
    """Return the acceleration V'_z of a sliding part at the upper reversal, as the thesis draws it.

    a cos(beta) - mu (g - a sin(beta)), with a = A w^2. It holds up to the hop, a sin(beta) = g; past that it
    is the formula's value, not a part's.

    Parameters
    ----------
    acceleration : float or array [m/s2]
        A w^2 of the drive.
    beta : float or array [rad]
        Vibration angle.
    friction : float or array [1]
        mu; all three broadcast.

    Returns
    -------
    (...) float [m/s2]

    References
    ----------
    The thesis, eqs. [4.14], [4.16] with R_z = mu N and alpha = theta.
    """
    return acceleration * np.cos(beta) - friction * (GRAVITY_OF_CHAPTER_5 - acceleration * np.sin(beta))


def figure_5_6() -> FigureGrid:
    """Return V'_z over (beta, mu): x is beta [rad], y is mu."""
    betas, frictions = np.radians(np.linspace(0.0, 90.0, 91)), np.linspace(0.0, 1.0, 51)
    values = sliding_acceleration(RATIO_OF_5_6 * GRAVITY_OF_CHAPTER_5, betas, frictions[:, None])
    throw, ticks = limits.throw_number(RATIO_OF_5_6, betas), (np.degrees(betas), frictions)
    columns = ("beta_deg", "friction", "acceleration_z_m_s2")
    axes = ("vibration angle β [deg]", "friction μ [1]")
    return _grid(betas, frictions, values, throw, columns, axes, ticks)


def figure_5_7() -> FigureGrid:
    """Return V'_z over (f, A): x is the frequency [Hz], y is the amplitude [m]."""
    frequencies, amplitudes = np.linspace(0.0, 100.0, 101), np.linspace(0.0, 1e-3, 51)
    ratio = limits.acceleration_ratio(amplitudes[:, None], frequencies, GRAVITY_OF_CHAPTER_5)
    values = sliding_acceleration(ratio * GRAVITY_OF_CHAPTER_5, BETA_OF_5_7, FRICTION_OF_5_7)
    throw, ticks = limits.throw_number(ratio, BETA_OF_5_7), (frequencies, 1e3 * amplitudes)
    columns = ("frequency_Hz", "amplitude_mm", "acceleration_z_m_s2")
    axes = ("frequency f [Hz]", "amplitude A [mm]")
    return _grid(frequencies, amplitudes, values, throw, columns, axes, ticks)


def _grid(x: Floats, y: Floats, values: Floats, throw: Floats, *names: Any) -> FigureGrid:
    return FigureGrid(x, y, check.frozen(values), check.frozen(np.broadcast_to(throw, values.shape)), *names)


def _claim(
    statement: str,
    value: float,
    bound: float,
    finding: str = "",
    is_explained: bool = False,
    *,
    is_above: bool = False,
) -> Claim:
    """The claim that a value is below a bound, or above it."""
    published, holds = (f"> {bound:.3f}", value > bound) if is_above else (f"< {bound:.3f}", value < bound)
    return Claim(statement, published, value, holds, finding, is_explained)


def _chapter_3_claims(number: str) -> Iterator[Claim]:
    if number == "3-6":
        ngoi, pmi = table("3-1"), parts.t_aspects(0.6).pmi
        csa, measured = ngoi.numbers("csa") / 100.0, ngoi.numbers("experiment") / 100.0
        near, far = deviation(csa, measured), deviation(pmi, measured)
        order = np.argsort(pmi[:4]) == np.argsort(csa[:4])
        yield _claim("deviation of CSA from the experiment, below that of PMI", near, far, "csa-ratio")
        text = "aspects A to D in the same order by PMI and CSA"
        yield Claim(text, "4", float(order.sum()), bool(order.all()))
    if number in ("3-7", "3-8"):  # E leads at the smallest ratio, falls at every step, leads no more at last
        lines = np.array(list(by_ratio("pmi" if number == "3-7" else "csa").lines.values()))
        first, last = (lines[:, k].argmax() == len(lines) - 1 for k in (0, -1))
        holds = bool(first and not last and (np.diff(lines[-1]) < 0.0).all())
        change = float(lines[-1, -1] - lines[-1, 0])
        yield Claim("aspect E from ratio 0.4, where it leads, to 1.4", "< 0", change, holds)
    if number == "3-7":
        ours, theirs = (float(np.ptp(by_ratio(name).lines["E"])) for name in ("pmi", "csa"))
        yield _claim("range of aspect E, smaller by PMI than by CSA", ours, theirs)
    if number not in COMPARED:
        return
    profiles = parts.profiles(COMPARED[number][1])
    gaps = {name: deviation(profiles["PMI"], profile) for name, profile in profiles.items() if name != "PMI"}
    dominant = [bool(profiles[name].argmax() == profiles["PMI"].argmax()) for name in MEASURED]
    text = "tests whose dominant aspect PMI predicts"
    if number == "3-9":
        rest = min(gap for name, gap in gaps.items() if name != "CSA")
        yield _claim("deviation of PMI from CSA, the least of all", gaps["CSA"], rest)
    elif number == "3-10":
        first, second = (deviation(profiles["MDBT_80"], profiles[name]) for name in ("MDBT_78", "MDBT_82"))
        yield _claim("deviation between amplitudes 78 and 80, above 80 and 82", first, second, is_above=True)
        at_78 = ["78" in name and "MDBT" in name for name in MEASURED]
        is_explained = all(agrees or low for agrees, low in zip(dominant, at_78, strict=True))
        yield Claim(text, "6", float(sum(dominant)), all(dominant), "dominant-aspect", is_explained)
    elif number == "3-11":
        sentence = "deviation of PMI from stability, above that from CSA"
        yield _claim(sentence, gaps["STABILITY"], gaps["CSA"], is_above=True)
    elif number == "3-12":
        mixed, bound = deviation(profiles["PMI"], parts.mixed_heights()), gaps["STABILITY"]
        sentence, finding = "deviation of PMI from CSA, below that from stability", "magnet-csa-mixed"
        yield _claim(sentence, gaps["CSA"], bound, finding=finding, is_explained=mixed < bound)
    else:
        worst = max(deviation(profiles["STABILITY"], profiles[name]) for name in MEASURED)
        value = min(gaps[name] for name in MEASURED)
        yield _claim("deviation of PMI from any test, above stability's", value, worst, is_above=True)
        yield Claim(text, f"{len(dominant)}", float(sum(dominant)), all(dominant))


def _chapter_5_claims(number: str) -> Iterator[Claim]:
    if number == "5-1":  # of the steps from one drawn beta to the next, at every G
        curves, ratios = figure_5_1().limits, DRIVE_RATIOS[1:]  # at G = 0 every curve is 0
        betas = np.radians(list(curves))
        grows = (np.diff(np.array(list(curves.values())), axis=0) > 0.0)[:, 1:]
        beyond, below = ratios > np.sin(betas[1:, None]), ratios < np.sin(betas[:-1, None])
        is_explained = bool(grows[beyond].all() and not grows[below].any())
        text = "share of the drawn steps in beta that enlarge the sliding region"
        yield Claim(text, "1", float(grows.mean()), bool(grows.all()), "beta-sliding", is_explained)
    elif number in BETA_OF:  # below the surface the part slides: it is the complete limit of a level floor
        data, beta = limit_surface(number), np.radians(BETA_OF[number])
        gap = float(np.abs(data.values - limits.forward_limit(data.y[:, None], beta, data.x)).max())
        yield Claim("gap between [4.27] and the least friction that holds", "0", gap, gap < 1e-9)
        if number == "5-5":
            gap = float(np.abs(data.values - limit_surface("5-2").values).max())
            yield Claim("gap between the contour lines' values and Figure 5-2", "0", gap, gap == 0.0)
    elif number == "5-6":
        data = figure_5_6()
        row, column = np.unravel_index(data.values.argmax(), data.values.shape)
        best = float(np.degrees(data.x[column]))
        yield Claim("beta of the largest acceleration [deg]", "40 to 60", best, 40.0 <= best <= 60.0, "hop")
        text = "mu of the largest acceleration, the highest drawn"
        yield Claim(text, f"{data.y[-1]:g}", data.y[row], bool(row == len(data.y) - 1))
    elif number == "5-7":
        rises = np.diff(figure_5_7().values[:, 1:], axis=0) > 0.0
        text = "share of the steps in amplitude that raise the acceleration"
        yield Claim(text, "1", float(rises.mean()), bool(rises.all()), "hop")


def numbers(figure: Figure) -> Frame:
    """Return the numbers a figure draws, as a table; of a surface its cells, row by row."""
    data = figure.data()
    if isinstance(data, Bars):
        printed = {f"{name}_printed": values for name, values in data.printed_shares.items()}
        return Frame.of({"aspect": data.aspects, **data.profiles, **printed})
    if isinstance(data, ByRatio):
        return Frame.of({"aspect_ratio": data.ratios, **data.lines})
    if isinstance(data, Curves):
        limit = {f"mu_limit_beta_{beta:g}": values for beta, values in data.limits.items()}
        return Frame.of({"acceleration_ratio": data.ratios, **limit})
    arrays = (*np.meshgrid(*data.ticks), data.values, data.hops)
    return Frame.of({name: np.ravel(a) for name, a in zip((*data.columns, "hops"), arrays)})


def draw(figure: Figure, ax: "style.Axes | None" = None) -> "style.Figure":
    """Return a figure of the thesis as a matplotlib figure.

    Parameters
    ----------
    figure : Figure
        Of the thesis.
    ax : matplotlib Axes, optional
        It is drawn there, where it has one picture.

    Returns
    -------
    matplotlib Figure
    """
    own = {} if ax is None else {"ax": ax}
    return figure.draw_data(f"Figure {figure.number}. {figure.caption}", figure.data(), **own)


def _draw_bars(title: str, data: Bars, ax: "style.Axes | None" = None) -> "style.Figure":
    bars = len(data.aspects) * (len(data.profiles) + 0.9)
    width = float(np.clip(bars * (0.42 if len(data.profiles) < 4 else 0.30) + 1.0, 4.6, 9.5))
    figure, axes = style.chart(width, 3.6, ax=ax, title=title, x="aspect", y="probability [%]", grid="y")
    compare.bars(axes, data.aspects, data.profiles, data.printed_shares, (width - 0.9) / bars)
    handles = list(axes.containers)
    if data.printed_shares:
        handles += axes.plot([], [], color=style.INK, linewidth=1.1, label="in print")
    style.legend(figure, ax=ax, handles=handles, ncols=min(len(handles), 4 if width < 9.0 else 8))
    return figure


def _draw_lines(title: str, data: ByRatio, ax: "style.Axes | None" = None) -> "style.Figure":
    x, y = "aspect ratio, thickness / width [1]", f"probability by {data.rule} [%]"
    figure, axes = style.chart(6.6, 4.4, ax=ax, title=title, x=x, y=y)
    handles = []
    for (name, values), (colour, dashes) in zip(data.lines.items(), ASPECT_LINES):
        label = f"aspect {name}"
        handles += axes.plot(data.ratios, 100.0 * values, dashes, color=colour, linewidth=1.8, label=label)
    # what is in print: a marker each in its aspect's colour, and one in ink for the legend
    for (label, (ratios, rows)), (marker, is_filled) in zip(data.points.items(), (("o", False), ("D", True))):
        look: style.Look = {"markersize": 5.5, "linestyle": "none", "marker": marker}
        for column, (colour, _) in zip(rows.values(), ASPECT_LINES):
            face = colour if is_filled else "white"
            axes.plot(ratios, 100.0 * column, color=colour, markerfacecolor=face, clip_on=False, **look)
        face = style.INK if is_filled else "white"
        handles += axes.plot([], [], color=style.INK, markerfacecolor=face, label=label, **look)
    axes.set_ylim(bottom=0.0)
    style.legend(figure, ax=ax, handles=handles, ncols=4)
    return figure


def _draw_curves(title: str, data: Curves) -> "style.Figure":
    """As published, and over G: there the curves part, and cross where G = sin(beta)."""
    figure = style.figure(9.4, 4.2)
    left, right = figure.subplots(1, 2)
    style.tidy(left, title=title, x=slide.RATIO, y=slide.FRICTION)
    style.tidy(right, title="The same, divided by G", x=slide.RATIO, y="limiting friction / G [1]")
    shades = matplotlib.colormaps[slide.LEVEL_COLOURS](np.linspace(0.05, 0.8, len(data.limits)))
    for (beta, values), shade in zip(data.limits.items(), shades):
        left.plot(data.ratios, values, color=shade, linewidth=1.8, label=f"β = {beta:g}°")
        right.plot(data.ratios[1:], values[1:] / data.ratios[1:], color=shade, linewidth=1.8)
        b = np.radians(beta)
        right.plot(np.sin(b), 1.0 / np.cos(b), "o", color=shade, markersize=5)
    right.plot([], [], "o", color=style.INK, markersize=5, label="G = sin β: beyond, μ grows with β")
    for axes in (left, right):
        axes.set(xlim=(0.0, data.ratios[-1]))
        axes.legend(fontsize=8, frameon=False, loc="upper left", labelcolor=style.INK)
    left.set_ylim(bottom=0.0)
    return figure


def _draw_limits(title: str, data: FigureGrid) -> "style.Figure":
    figure = style.figure(6.4, 5.0)
    shades: style.Look = {"vmin": 0.0, "vmax": slide.HIGHEST, "rcount": 34, "ccount": 46}
    labels = (slide.ANGLE, slide.RATIO, slide.FRICTION)
    axes = _add_surface(figure, (1, 1, 1), title, labels, data, **shades)
    axes.set(xlim=(-90, 90), ylim=(0.0, DRIVE_RATIOS[-1]))
    axes.set_zlim(bottom=0.0)
    axes.set_xticks(np.arange(-90, 91, 30))
    return figure


def _draw_contours(title: str, data: FigureGrid, ax: "style.Axes | None" = None) -> "style.Figure":
    figure, axes = style.chart(6.6, 4.2, ax=ax, title=title, x=slide.ANGLE, y=slide.RATIO, grid="none")
    levels = [level for level in slide.LEVELS if level <= data.values.max()]
    shades = matplotlib.colormaps[slide.LEVEL_COLOURS](np.linspace(0.05, 0.75, len(levels)))
    angles = np.linspace(-89.9, 89.9, 361)
    look: style.Look = {"fontsize": 7.5, "ha": "center", "va": "center", "bbox": LABEL_BOX}
    for level, shade in zip(levels, shades):
        ratios = limits.published_ratio(level, np.radians(BETA_OF["5-5"]), np.radians(angles))
        axes.plot(angles, ratios, color=shade, linewidth=1.4)
        axes.text(0.0, ratios[180], f"μ = {level:g}", color=shade, **look)
    axes.set(xlim=(-90, 90), ylim=(0.0, data.y[-1]))
    axes.set_xticks(np.arange(-90, 91, 30))
    return figure


def _draw_acceleration(title: str, data: FigureGrid) -> "style.Figure":
    """As published, and from above with the part that no part follows."""
    figure = style.figure(10.4, 4.6)
    left, right = figure.add_gridspec(1, 2, width_ratios=(1.0, 1.15))
    (x, y), (x_label, y_label) = data.ticks, data.axes
    labels = (*data.axes, ACCELERATION_AXIS)
    _add_surface(figure, (left,), "As published", labels, data, rcount=46, ccount=46)
    above = figure.add_subplot(right)
    flat = style.tidy(above, title="Where the part slides", x=x_label, y=y_label, grid="none")
    filled = flat.contourf(x, y, data.values, 14, cmap=slide.LEVEL_COLOURS)
    # white hatching where contact is lost; dashes where friction holds the part, the formula is negative
    with matplotlib.rc_context({"hatch.color": "white", "hatch.linewidth": 0.4}):
        flat.contourf(x, y, data.throw, [1.0, np.inf], colors="none", hatches=["///"])
    flat.contour(x, y, data.throw, [1.0], colors="white", linewidths=1.8)
    row, column = (int(np.mean(places)) for places in np.nonzero(data.hops))
    look: style.Look = {"fontsize": 8.5, "ha": "center", "va": "center"}
    text = "hops: the formula's value,\nnot a part's"
    flat.text(x[column], y[row], text, color=style.INK, bbox=LABEL_BOX, **look)
    sticks = data.values < 0.0
    if sticks.any():
        flat.contour(x, y, data.values, [0.0], colors="white", linewidths=1.4, linestyles="--")
        row = len(y) // 2
        flat.text(x[sticks[row].sum() // 2], y[row], "sticks", color="white", **look)
    bar = figure.colorbar(filled, ax=flat, pad=0.02)
    bar.set_label(ACCELERATION_AXIS, fontsize=9, color=style.INK)
    bar.ax.tick_params(labelsize=8, colors=style.INK)
    bar.outline.set_visible(False)
    figure.suptitle(title, x=0.01, ha="left", fontsize=10, color=style.INK, fontweight="bold")
    return figure


def _add_surface(
    figure: "style.Figure",
    place: Sequence[Any],
    title: str,
    labels: Iterable[str],
    data: FigureGrid,
    **look: Any,
) -> Any:
    axes: Any = figure.add_subplot(*place, projection="3d", computed_zorder=False)
    axes.plot_surface(
        *np.meshgrid(*data.ticks),
        data.values,
        cmap=slide.LEVEL_COLOURS,
        edgecolor="white",
        linewidth=0.2,
        **look,
    )
    axes.set_title(title, loc="left", fontsize=10, color=style.INK, fontweight="bold")
    for set_label, text in zip((axes.set_xlabel, axes.set_ylabel, axes.set_zlabel), labels):
        set_label(text, fontsize=9, color=style.INK)
    axes.tick_params(labelsize=8, colors=style.INK)
    axes.set_box_aspect(None, zoom=0.92)
    axes.view_init(elev=28, azim=-118)
    return axes


THESIS_FIGURES = (
    Figure("3-6", "Probability comparison for the T shape, aspect ratio 0.6", _draw_bars, _t_shape_profiles),
    Figure("3-7", "Probability by aspect ratio, PMI method, T shape", _draw_lines, partial(by_ratio, "pmi")),
    Figure(
        "3-8",
        "Probability by aspect ratio, CSA method and experiment, T shape",
        _draw_lines,
        partial(by_ratio, "csa"),
    ),
    *(Figure(number, COMPARED[number][0], _draw_bars, partial(_profiles, number)) for number in COMPARED),
    Figure("5-1", "Limiting condition for sliding along Z, α = θ", _draw_curves, figure_5_1),
    *(
        Figure(number, f"Limiting friction, β = {beta:g}°", _draw_limits, partial(limit_surface, number))
        for number, beta in BETA_OF.items()
        if number != "5-5"
    ),
    Figure("5-5", "Contour lines of Figure 5-2, β = 10°", _draw_contours, partial(limit_surface, "5-5")),
    Figure("5-6", "Acceleration along Z over β and μ, f = 60 Hz, A = 0.5 mm", _draw_acceleration, figure_5_6),
    Figure("5-7", "Acceleration along Z over f and A, β = 20°, μ = 0.5", _draw_acceleration, figure_5_7),
)
FIGURE_OF = {figure.number: figure for figure in THESIS_FIGURES}
