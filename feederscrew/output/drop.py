"""Files of ``feeder drop``: counts of the test, traced drops, and the tosses of ``--launches``."""

from collections.abc import Iterator, Sequence

import numpy as np

from feederscrew.arrivals import toss_runs
from feederscrew.arrivals.drop import (
    AGREEMENT_COLUMNS,
    DROP_TEST_COLUMNS,
    DROP_TRACE_COLUMNS,
    TOSS_FILE_COLUMNS,
    DropStudy,
    TossStudy,
)
from feederscrew.arrivals.drop_test import DropTrace, chosen
from feederscrew.arrivals.toss_runs import FACE_NAMES
from feederscrew.base.arrays import Floats, Ints, Points
from feederscrew.base.columns import Document, values
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.motion.conveying import RESTITUTION_DOUBT
from feederscrew.output import offers as offer
from feederscrew.output import part_facts, style
from feederscrew.output.aspects import MARKS, PROBABILITIES
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import shares_text
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects

mpl_ticker = heavy("matplotlib.ticker")
ndimage = heavy("scipy.ndimage")
shading = heavy("feederscrew.output.shading")


def document(study: DropStudy) -> Document:
    """Return a drop test as one JSON document.

    Parameters
    ----------
    study : DropStudy

    Returns
    -------
    dict
        ``traces`` has when and on what each drop that was followed was counted.
    """
    followed = [values(DROP_TRACE_COLUMNS, (study, trace)) for trace in study.result.traces]
    return values(DROP_TEST_COLUMNS, study) | {"traces": followed, "aspects": study.table()}


def remarks(study: DropStudy) -> list[str]:
    """Return what a user must know of a drop test, a line each.

    Parameters
    ----------
    study : DropStudy

    Returns
    -------
    list of str
    """
    lines, drops, result = [], study.drops, study.result
    tally, aim = result.tally, result.aim
    if result.drops.partial:
        lines.append(f"partial: stopped after {drops} drops")
    elif aim is not None and tally.widest > aim:
        lines.append(
            f"after {drops} drops the widest interval is {100.0 * tally.widest:.3g} % to either side, not "
            f"{100.0 * aim:.3g} % - give more `drops`, or a wider `until`"
        )
    if result.single is not None:
        # how far the intervals reach for the scatter of restitution alone
        low, high = result.launch["restitution"]
        ends = np.stack([tally.p - tally.low, tally.high - tally.p])
        wider = ends - np.sqrt(np.maximum(ends**2 - tally.restitution**2, 0.0))
        lines.append(
            f"restitution {result.single:g} scatters from {low:.3g} to {high:.3g}, as impacts do: "
            f"an interval reaches {100.0 * wider.max():.2g} % further for it"
        )
    if tally.unsettled:
        lines.append(f"{tally.unsettled} of {drops} drops came to rest on no aspect")
    return lines


def offers(study: DropStudy) -> list[offer.Offer]:
    """Offer the counts of a drop test and, where drops were followed, their motion.

    Parameters
    ----------
    study : DropStudy

    Returns
    -------
    list of Offer
    """
    offered = [
        offer.table("drop.csv", study.table),
        offer.document("drop.json", document, study),
        offer.picture("drop.png", "How often the part was found on each aspect", counts_figure, study),
    ]
    if study.result.traces:
        trace = study.telling
        title = f"{study.part.name}: drop {trace.number}, {study.result.launch['name']}"
        what = "One drop in stills, and its energy below"
        offered += [
            offer.table("drop_traces.csv", study.traces_table),
            offer.picture("drop_trace.png", what, strip, study.part, study.aspects, trace, title),
        ]
    return offered


def counts_figure(study: DropStudy, ax: "style.Axes | None" = None) -> "style.Figure":
    """Draw the chart of a drop test with its intervals; the shares by every rule are marks.

    Parameters
    ----------
    study : DropStudy
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    result, names = study.result, study.aspects.names
    tally = result.tally
    title = f"{study.part.name}: {study.drops} drops, {result.launch['name']}"
    title += f", {tally.unsettled} unsettled" if tally.unsettled else ""
    title += ", partial" * result.drops.partial
    places, width = np.arange(len(names)), float(np.clip(0.9 * len(names) + 2.0, 5.2, 12.0))
    figure, axes = style.chart(width, 3.4, ax=ax, title=title, **PROBABILITIES)
    # bars with 95 % intervals, the band from gentle to violent launches behind
    low = 100.0 * np.minimum(tally.gentle, tally.violent)
    high = 100.0 * np.maximum(tally.gentle, tally.violent)
    axes.bar(places, high - low, 0.8, bottom=low, color=style.FAINT, label="gentle to violent launches")
    error = 100.0 * np.stack([tally.p - tally.low, tally.high - tally.p])
    axes.bar(places, 100.0 * tally.p, 0.4, color=style.ANSWER, label="drops")
    axes.errorbar(places, 100.0 * tally.p, error, fmt="none", ecolor=style.INK, capsize=4, linewidth=1.0)
    for place, (name, chances) in enumerate(study.rules.items()):
        label, colour = style.method(name, place)
        mark_places = places + 0.09 * (place + 1)  # beside the whisker, which stands in the middle
        look = {"marker": MARKS[place % len(MARKS)], "ms": 5, "mec": "white", "mew": 0.6, "color": colour}
        axes.plot(mark_places, 100.0 * chances, ls="none", label=label, **look)
    style.named_ticks(axes, places, names, length=3.0)
    style.legend(figure, ax=ax, ncols=min(len(study.rules) + 2, 6))
    return figure


def curve(axes: "style.Axes", trace: DropTrace, aspects: Aspects, rows: Ints) -> None:
    """Draw energy and height of the centre of mass over time.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    trace : DropTrace
    aspects : Aspects
        Whose heights are drawn to compare with.
    rows : (S,) array of int
        Samples of the trace at which the numbers of the stills stand.
    """
    times, energies, heights = 1e3 * trace.times, trace.energies / MM, trace.positions[:, 2] / MM
    style.tidy(axes, x="time [ms]", y="energy as height [mm]", grid="none")
    axes.plot(times, energies, color=style.ACCENT, linewidth=1.6, label="energy", zorder=3)
    axes.plot(times, heights, color="#0072b2", linewidth=1.0, label="of which height", zorder=2)
    # heights to compare with: of the aspect it ends on, of the way out of that, of the others
    plain = {"color": style.FAINT, "linewidth": 0.9, "zorder": 0}
    strong = {"color": style.INK, "linewidth": 0.9, "zorder": 1}
    lines: list[tuple[float, str, style.Look]] = []
    if trace.row >= 0:
        height, name = aspects.heights[trace.row], aspects.names[trace.row]
        lines.append((height / MM, f"rests on {name}", strong))
        if aspects.barriers is not None and np.isfinite(barrier := aspects.barriers[trace.row]):
            dashed = strong | {"linestyle": (0, (5, 3))}
            lines.append(((height + barrier) / MM, f"tips from {name}", dashed))
    left = (row for row in np.flatnonzero(aspects.stable) if row != trace.row)
    lines += [(aspects.heights[row] / MM, f"rests on {aspects.names[row]}", plain) for row in left]
    lowest = 0.88 * min(heights.min(), *(height for height, _, _ in lines))
    highest = max(height for height, _, _ in lines)
    axes.set_yscale("log")
    axes.set_ylim(lowest, max(highest * (highest / lowest) ** 0.4, 1.25 * energies.max()))
    axes.set_xlim(0.0, 1.015 * times[-1])
    axes.yaxis.set_major_locator(mpl_ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(mpl_ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(mpl_ticker.LogLocator(subs=()))
    # their names at the right, from the first on; one without room below the legend's lines is left out
    (low, high), taken = np.log(axes.get_ylim()), [0.96, 0.87]
    letters: style.Look = {"fontsize": 7, "color": style.INK}
    for height, text, look in lines:
        axes.axhline(height, **look)
        place = (np.log(height) - low) / (high - low)
        if all(abs(place - other) >= 0.075 for other in taken):
            taken.append(place)
            words = f"{text} {height:.3g}"
            axes.text(1.01, place, words, transform=axes.transAxes, va="center", **letters)
    for number, row in enumerate(rows, start=1):
        _badge(axes, times[row], energies[row], number)
    if trace.row >= 0:
        certain, words = 1e3 * trace.decided, f"from here {aspects.names[trace.row]} is certain"
        axes.axvline(certain, color=style.INK, linewidth=0.8, linestyle=(0, (1, 2)))
        above: style.Look = {"va": "bottom", "ha": "center", "transform": axes.get_xaxis_transform()}
        axes.text(certain, 1.01, words, **above, **letters)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.03), fontsize=7, frameon=False, borderpad=0.0)


def _badge(axes: "style.Axes", x: float, y: float, number: int) -> None:
    disc = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": style.INK, "linewidth": 0.7}
    look: style.Look = {"ha": "center", "va": "center", "color": style.INK, "bbox": disc, "zorder": 6}
    axes.text(x, y, str(number), fontsize=6, clip_on=False, **look)


ACROSS, DOWN = 6, 2  # stills
WIDTH = 262  # [px] of a still
TALLEST = 430  # its greatest height
GAP = 12  # to the next
# [px]
EDGE = 30
HEAD = 92
CAPTION = 44
CURVE = 350
STILL_MARGIN = 1.12  # of a still over the part in it
MAX_ZOOM_OUT = 1.7  # a part that flies high is drawn so much smaller; higher still, its floor is cut off
GRID_REACH = 1.25  # [size] how far behind and before the part the grid is drawn
PIECES = 160  # points of a line, to see which are hidden
GRID: style.Look = {"color": style.FAINT, "linewidth": 0.8, "zorder": 2}
PAST: style.Look = {"color": style.ACCENT, "linewidth": 1.1, "zorder": 4}
AHEAD: style.Look = {"color": style.ACCENT, "linewidth": 0.9, "linestyle": (0, (1, 2.2)), "zorder": 4}
FOOT: style.Look = {"color": style.INK, "linewidth": 0.7, "linestyle": (0, (3, 2)), "zorder": 4}


def strip(part: Part, aspects: Aspects, trace: DropTrace, title: str) -> "style.Figure":
    """Draw one drop of a part in stills, all in one scale, and its energy below.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
    trace : DropTrace
    title : str

    Returns
    -------
    matplotlib.figure.Figure
    """
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    rows = chosen(trace, ACROSS * DOWN)
    # lengths in sizes of the solid: the centre of mass over time, and how the part stands in each still
    places, points = trace.positions / solid.size, shading.outer_points(solid.points)
    displacement = places[rows[-1], :2] - places[rows[0], :2]
    angle = np.arctan2(displacement[1], displacement[0])
    along = np.array([np.cos(angle - shading.STANCE_TURN_RAD), np.sin(angle - shading.STANCE_TURN_RAD), 0.0])
    stances = [
        shading.stance_along(points, turn.inv().apply([0.0, 0.0, -1.0]), place[2], turn.inv().apply(along))
        for turn, place in zip(trace.turns[rows], places[rows])
    ]
    # the largest scale in which every still fits
    lifts = np.array([standing.height * standing.camera.up @ -standing.down for standing in stances])
    ends = np.array([[standing.shadow_box[0, 1], standing.bounds[1, 1]] for standing in stances])
    ends += lifts[:, None]  # from the foot of the centre of mass
    widest = 2.0 * max(np.abs(standing.shadow_box[:, 0]).max() for standing in stances)
    close = STILL_MARGIN * widest / WIDTH
    pixel = float(np.clip(STILL_MARGIN * np.ptp(ends) / TALLEST, close, MAX_ZOOM_OUT * close))
    ends += 0.5 * (STILL_MARGIN - 1.0) * widest * np.array([-1.0, 1.0])
    by_row = ends.reshape(DOWN, ACROSS, 2)
    low, high = by_row[..., 0].min(axis=1), by_row[..., 1].max(axis=1)
    heights = np.minimum(np.ceil((high - low) / pixel), TALLEST).astype(int)
    bottoms = np.maximum(low[:, None], by_row[..., 1] - pixel * heights[:, None]).ravel() - lifts
    panels = style.Panels(ACROSS, WIDTH, heights.tolist(), CAPTION, HEAD, CURVE, EDGE, GAP)
    # [m] of the grid on the plane: the largest of 1, 2, 5, 10, ... mm that has room
    step = MM * style.round_length(pixel * WIDTH / 4.0 * solid.size / MM)
    # the page
    page_width, page_height = panels.page
    figure, page = style.sheet(page_width, page_height)
    look = {"color": style.INK, "va": "center"}
    page.text(EDGE, page_height - 34, title, fontsize=13, fontweight="bold", **look)
    text = f"grid on the plane: {step / MM:g} mm; line: path of the centre of mass"
    page.text(EDGE, page_height - 66, text, fontsize=8, **look)
    shading.scale_bar(page, page_width - EDGE, page_height - 66, pixel * solid.size)
    heading = np.array([np.cos(angle), np.sin(angle), 0.0])
    for panel, (row, standing) in enumerate(zip(rows, stances)):
        left, bottom, width, height = panels.place(panel)
        axes = style.inset(figure, page, (left, bottom, width, height), xticks=[], yticks=[])
        axes.spines[:].set_color(style.FAINT)
        frame = shading.Shot(-0.5 * width * pixel, bottoms[panel], pixel, width, height)
        # the part as on glass: opaque where it is, tinted by its shadow
        image = shading.picture(solid, standing, frame)
        depths, _, _ = standing.camera.meet(solid, *frame.positions())
        mask = ndimage.binary_dilation(np.isfinite(depths), iterations=2)
        clear = np.dstack([image * mask[..., None], np.where(mask, 1.0, 1.0 - image.mean(axis=2))])
        axes.imshow(clear, extent=frame.extent, interpolation="nearest", zorder=3)
        # its way, on a floor with a grid that stays where it is; of a line what the solid does not hide
        place, to_file = places[row], trace.turns[row].inv()
        drawn = [(GRID, line) for line in _grid(place, heading, step / solid.size, 0.5 * WIDTH * pixel)]
        drawn += [(PAST, places[: row + 1]), (AHEAD, places[row:])]
        drawn.append((FOOT, np.linspace(place * [1.0, 1.0, 0.0], place, PIECES)))
        for line_look, line in drawn:
            in_axes = to_file.apply(line - place)
            is_visible = standing.camera.sees(solid, in_axes, away=40.0)
            axes.plot(*np.where(is_visible[:, None], standing.camera.project(in_axes), np.nan).T, **line_look)
        axes.set(xlim=frame.extent[:2], ylim=frame.extent[2:])
        # under the lowest corner [m]
        gap = (standing.height - (solid.points @ standing.down).max()) * solid.size
        _badge(page, left + 16, bottom - 18, panel + 1)
        page.text(left + 34, bottom - 18, still_caption(trace, row, aspects.names, gap), fontsize=8, **look)
    axes = style.inset(figure, page, (EDGE + 60, 66, page_width - 2 * EDGE - 240, CURVE - 116))
    curve(axes, trace, aspects, rows)
    return figure


def _grid(place: Floats, heading: Floats, step: float, reach: float) -> Iterator[Floats]:
    """Lines on the plane about a place, along and across the way, a round number of millimetres apart."""
    axes = np.array([heading, np.cross([0.0, 0.0, 1.0], heading)])  # along, across
    reaches, centre = (reach, GRID_REACH), axes @ place
    for across, other in ((0, 1), (1, 0)):
        run = centre[other] + np.linspace(-reaches[other], reaches[other], PIECES)
        first, last = (centre[across] + sign * reaches[across] for sign in (-1.0, 1.0))
        for value in step * np.arange(np.ceil(first / step), last / step):
            yield value * axes[across] + run[:, None] * axes[other]


def still_caption(trace: DropTrace, row: int, names: Sequence[str], gap: float) -> str:
    """Return the time of a still, and what is happening.

    Parameters
    ----------
    trace : DropTrace
    row : int
        Sample of the trace.
    names : sequence of str
        Of the aspects.
    gap : float [m]
        Under the lowest corner.

    Returns
    -------
    str
    """
    time = f"{1e3 * trace.times[row]:.0f} ms"
    if row == len(trace.times) - 1 and trace.row >= 0:
        return f"{time}, {'rests on' if trace.still else 'bound for'} {names[trace.row]}"
    if trace.impacts[row]:
        return f"{time}, hits"
    up = f"{gap / MM:.{int(gap < 10.0 * MM)}f}"
    return f"{time}, {up} mm up" if gap > 0.1 * trace.positions[:, 2].min() else time


# --- Tosses: each launch of a file, followed from its own state ---


def toss_document(study: TossStudy) -> Document:
    """Return the tosses as one JSON document.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    dict
    """
    agreement, measured = study.agreement, None
    if agreement is not None:
        measured = values(AGREEMENT_COLUMNS, agreement)
    return {
        **part_facts.part(study.part),
        **values(TOSS_FILE_COLUMNS, study),
        "restitution": list(study.surface.restitution),
        "friction": list(study.surface.friction),
        "restitution_scatter": RESTITUTION_DOUBT,
        "friction_scatter": toss_runs.FRICTION_SPREAD,
        "partial": study.result.partial,
        "measured": measured,
        "tosses": study.table(),
    }


def toss_remarks(study: TossStudy) -> list[str]:
    """Return what a user must know of the tosses, a line each.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    list of str
    """
    count, lost = len(study.result.faces), int((study.result.faces < 0).sum())
    lines = [f"partial: stopped after {count} tosses"] * study.result.partial
    if lost:
        lines.append(f"{lost} of {count} tosses came to rest in no run")
    if study.launches.frame == 0.0:
        lines.append(
            "the file does not say how many pictures a second the camera took: each state is taken as exact "
            "- name a column frames_148Hz"
        )
    return lines


def toss_summary(study: TossStudy) -> list[str]:
    """Return how the answers agree with what was measured, a line each.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    list of str
        Empty where nothing was measured.
    """
    agreement = study.agreement
    if agreement is None:
        return []
    lines = [
        f"{100.0 * agreement.right_share:.1f} % of the upper sides are as measured "
        f"(95 % interval {100.0 * agreement.low:.1f} to {100.0 * agreement.high:.1f} %); the side nearest to "
        f"the top at the launch tells {100.0 * agreement.at_release:.1f} %"
    ]
    if agreement.median_off is not None:
        lines.append(f"half of the places are within {agreement.median_off / MM:.1f} mm of the measured ones")
    if agreement.sure_right_share is not None:
        lines.append(
            f"of the {agreement.sure} answers with p of at least 0.95, "
            f"{100.0 * agreement.sure_right_share:.1f} % are as measured: p considers the surface "
            "and the launch, not the errors of the model"
        )
    return lines


def toss_offers(study: TossStudy) -> list[offer.Offer]:
    """Offer where each toss leads.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    list of Offer
    """
    offered = [offer.table("tosses.csv", study.table), offer.document("tosses.json", toss_document, study)]
    if (ends := study.launches.ends) is not None:
        alt = "Places computed and measured"
        offered.append(offer.picture("tosses.png", alt, _toss_plan, study, ends, study.off))
    return offered


def _toss_plan(
    study: TossStudy, ends: Points, distances: Floats, ax: "style.Axes | None" = None
) -> "style.Figure":
    faces, computed, measured_faces = study.result.faces, study.result.places / MM, study.launches.faces
    measured = ends[: len(computed)] / MM
    median = np.nanmedian(distances) / MM
    title = f"{study.part.name}: {len(computed)} tosses, median distance {median:.3g} mm"
    figure, axes = style.chart(6.4, 5.6, ax=ax, title=title, x="x [mm]", y="y [mm]")
    axes.set_aspect("equal")
    axes.plot(*np.stack([measured, computed]).transpose(2, 0, 1), color=style.FAINT, linewidth=0.8, zorder=1)
    kinds = np.full(len(faces), 2)
    if measured_faces is not None:
        sides = [FACE_NAMES.index(face) for face in measured_faces[: len(faces)]]
        kinds = np.where(faces == sides, 0, 1)
    looks = (
        ("upper side as measured", "o", "#0072b2"),
        ("another upper side", "X", style.ACCENT),
        ("upper side not measured", "o", style.INK),
    )
    for kind, (label, marker, colour) in enumerate(looks):
        if (kinds == kind).any():
            look = {"marker": marker, "color": colour, "s": 18, "linewidths": 0.0}
            axes.scatter(*computed[kinds == kind].T, label=f"computed, {label}", **look)
    axes.scatter(*measured.T, marker=".", s=6, color=style.INK, label="measured")
    style.legend(figure, ax=ax, ncols=3)
    return figure


DROP_VIEW = RecordView(
    lambda study: (
        f"{study.part.name}: {study.drops} drops, {shares_text(study.aspects.names, study.tally.p)}"
    ),
    offers,
    "drop",
)
