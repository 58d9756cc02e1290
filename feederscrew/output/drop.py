"""Files of ``feeder drop``: counts of the test, and the traced drops."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.dropping.drop_test import DropTrace, chosen
from feederscrew.heavy import heavy
from feederscrew.output import offers as offer
from feederscrew.output import style, tables
from feederscrew.output.aspects import MARKS
from feederscrew.output.tables import Frame
from feederscrew.part.record import Part
from feederscrew.studies.drop import DropStudy
from feederscrew.units import MM

mpl_ticker = heavy("matplotlib.ticker")
ndimage = heavy("scipy.ndimage")
shading = heavy("feederscrew.output.shading")


def counts(study: DropStudy) -> Frame:
    """Return how many drops rest on each aspect, one row an aspect: the columns of ``drop.csv``.

    A test that the user stopped is labelled in every row.
    """
    aspects, tally = study.aspects, study.result.tally
    partial = {"partial": [True] * len(aspects.names)} if study.result.drops.partial else {}
    return tables.frame(
        {
            "aspect": aspects.names,
            "height_mm": study.result.heights / MM,
            "count": tally.counts,
            "p_drop": tally.p,
            "p_drop_low": tally.low,
            "p_drop_high": tally.high,
            "p_gentle": tally.gentle,
            "p_violent": tally.violent,
            "p_restitution": tally.restitution,
            "unsettled_share": [tally.unsettled_share] * len(aspects.names),
            **partial,
        }
    )


def document(study: DropStudy) -> dict[str, Any]:
    """Return the drop test as one JSON document."""
    result = study.result
    return {
        "part": study.part.name,
        "drops": study.drops,
        "seed": result.seed,
        "launch": result.launch,
        "partial": result.drops.partial,
        "unsettled": result.tally.unsettled,
        "unsettled_share": result.tally.unsettled_share,
        "until": result.aim,
        "widest": result.tally.widest,
        "traces": listed(study),
        "aspects": counts(study),
    }


def remarks(study):
    """Return what a user must know of a drop test, a line each."""
    listed, drops, tally, aim = [], study.drops, study.result.tally, study.result.aim
    if study.result.drops.partial:
        listed.append(f"partial: stopped after {drops} drops")
    elif aim is not None and tally.widest > aim:
        listed.append(
            f"after {drops} drops the widest interval is {100.0 * tally.widest:.3g} % to either side, not "
            f"{100.0 * aim:.3g} % - give more `drops`, or a wider `until`"
        )
    if study.result.single is not None:
        listed.append(_scatter(study))
    if tally.unsettled:
        listed.append(f"{tally.unsettled} of {drops} drops came to rest on no aspect")
    return listed


def _scatter(study) -> str:
    """What becomes of one value of restitution, and of the intervals."""
    tally, (low, high) = study.result.tally, study.result.launch["restitution"]
    ends = np.stack([tally.p - tally.low, tally.high - tally.p])
    wider = ends - np.sqrt(np.maximum(ends**2 - tally.restitution**2, 0.0))
    return (
        f"restitution {study.result.single:g} scatters from {low:.3g} to {high:.3g}, as impacts do: "
        f"an interval reaches {100.0 * wider.max():.2g} % further for it"
    )


def title(study):
    """Return what the chart is of, and what is the matter with it."""
    result = study.result
    unsettled = f", {result.tally.unsettled} unsettled" if result.tally.unsettled else ""
    named = f"{study.part.name}: {study.drops} drops, {result.launch['name']}"
    return named + unsettled + ", partial" * result.drops.partial


NONE = "none"  # the class of a drop that never settles


def traces(study: DropStudy) -> Frame:
    """Return one row a moment of each followed drop: the columns of ``drop_traces.csv``.

    They are the centre of mass over the plane, the quaternion from the file's axes to the plane's, total
    energy over m g, what happens, and the aspect the drop ends on.
    """
    followed = study.result.traces
    positions = np.concatenate([trace.positions for trace in followed]) / MM
    attitudes = np.concatenate([trace.attitudes for trace in followed])
    lengths = [len(trace.times) for trace in followed]
    return tables.frame(
        {
            "drop": np.repeat([trace.number for trace in followed], lengths),
            "time_s": np.concatenate([trace.times for trace in followed]),
            **dict(zip(("x_mm", "y_mm", "z_mm"), positions.T)),
            **dict(zip(("q_w", "q_x", "q_y", "q_z"), attitudes.T)),
            "energy_mm": np.concatenate([trace.energies for trace in followed]) / MM,
            "event": np.concatenate([_events(trace) for trace in followed]),
            "aspect": np.repeat([name(study.aspects, trace) for trace in followed], lengths),
        }
    )


def listed(study) -> list[Any]:
    """Return when each followed drop was counted, on what, and whether it was seen at rest."""
    return [
        {
            "drop": trace.number,
            "aspect": name(study.aspects, trace),
            "counted_s": trace.decided,
            "still": trace.still,
        }
        for trace in study.result.traces
    ]


def name(aspects, trace):
    """Return the aspect a drop is counted on."""
    return aspects.names[trace.row] if trace.row >= 0 else NONE


def _events(trace):
    events = np.where(trace.impacts, "impact", "").astype(object)
    events[0] = "launch"
    if trace.still:
        events[-1] = "still"
    return events


def offers(study: DropStudy) -> list[offer.Offer]:
    """Offer the counts of a drop test and, where drops were followed, their motion."""
    offered = [
        offer.table("drop.csv", counts, study),
        offer.document("drop.json", document, study),
        offer.picture("drop.png", "How often the part was found on each aspect", _counts, study),
    ]
    if study.result.traces:
        offered += [
            offer.table("drop_traces.csv", traces, study),
            offer.picture("drop_trace.png", "One drop in stills, and its energy below", _strip, study),
        ]
    return offered


def _counts(study):
    return counts_figure(title(study), study.aspects, study.result.tally, study.rules)


def _strip(study):
    trace = study.telling
    title = f"{study.part.name}: drop {trace.number}, {study.result.launch['name']}"
    return strip(study.part, study.aspects, trace, title)


MARK_STEP = 0.09  # of a group: from the whisker to the mark of a rule, and from there to the next


def counts_figure(title: str, aspects, tally, rules):
    """Draw the chart of a drop test with its intervals; ``rules``, (A,) [1] by name, are marks."""
    places = np.arange(len(aspects.names))
    figure = style.figure(float(np.clip(0.9 * len(places) + 2.0, 5.2, 12.0)), 3.4)
    axes = style.tidy(figure.add_subplot(), title=title, x="aspect", y="probability [%]", grid="y")
    bars(axes, places, tally)
    for place, (name, values) in enumerate(rules.items()):
        label, colour = style.method(name, place)
        mark_places = places + MARK_STEP * (place + 1)  # of the whisker, which stands in the middle
        look = {"marker": MARKS[place % len(MARKS)], "ms": 5, "mec": "white", "mew": 0.6, "color": colour}
        axes.plot(mark_places, 100.0 * values, ls="none", label=label, **look)
    style.named_ticks(axes, places, aspects.names)
    figure.legend(loc="outside lower center", ncols=min(len(rules) + 2, 6), frameon=False, fontsize=8)
    return figure


def bars(axes, places, tally) -> None:
    """Draw bars of the drops with 95 % intervals, and the band from gentle to violent launches behind."""
    low = 100.0 * np.minimum(tally.gentle, tally.violent)
    high = 100.0 * np.maximum(tally.gentle, tally.violent)
    axes.bar(places, high - low, 0.8, bottom=low, color=style.FAINT, label="gentle to violent launches")
    error = 100.0 * np.stack([tally.p - tally.low, tally.high - tally.p])
    axes.bar(places, 100.0 * tally.p, 0.4, color=style.ANSWER, label="drops")
    axes.errorbar(places, 100.0 * tally.p, error, fmt="none", ecolor=style.INK, capsize=4, linewidth=1.0)


HEIGHT = "#0072b2"  # colour of the height of the centre of mass
LABEL_SPACING = 0.075  # of the axis: labels closer than this would touch
HEADROOM_SHARE = 0.4  # room over the highest reference line, of that below it, on the logarithmic axis
LEGEND = (0.96, 0.87)  # places of its lines, of the axis


def curve(axes, trace, aspects, rows) -> None:
    """Draw the energy and height of the centre of mass over time on an Axes.

    The numbers of the stills stand at the (S,) ``rows`` of the trace.
    """
    times, energies, heights = 1e3 * trace.times, trace.energies / MM, trace.positions[:, 2] / MM
    style.tidy(axes, x="time [ms]", y="energy as height [mm]", grid="none")
    axes.plot(times, energies, color=style.ACCENT, linewidth=1.6, label="energy", zorder=3)
    axes.plot(times, heights, color=HEIGHT, linewidth=1.0, label="of which height", zorder=2)
    lines = references(trace, aspects)
    lowest = 0.88 * min(heights.min(), *(height for height, _, _ in lines))
    highest = max(height for height, _, _ in lines)
    axes.set_yscale("log")
    axes.set_ylim(lowest, max(highest * (highest / lowest) ** HEADROOM_SHARE, 1.25 * energies.max()))
    axes.set_xlim(0.0, 1.015 * times[-1])
    axes.yaxis.set_major_locator(mpl_ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(mpl_ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(mpl_ticker.LogLocator(subs=()))
    _named(axes, lines)
    for number, row in enumerate(rows, start=1):
        badge(axes, times[row], energies[row], number)
    if trace.row >= 0:
        certain = 1e3 * trace.decided
        axes.axvline(certain, color=style.INK, linewidth=0.8, linestyle=(0, (1, 2)))
        axes.text(certain, 1.01, f"from here {aspects.names[trace.row]} is certain", fontsize=7, va="bottom",
                  ha="center", color=style.INK, transform=axes.get_xaxis_transform())  # fmt: skip
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.03), fontsize=7, frameon=False, borderpad=0.0)


def references(trace, aspects):
    """Return heights to compare with: (mm, text, style), of every aspect and of the way out of the last."""
    plain = {"color": style.FAINT, "linewidth": 0.9, "zorder": 0}
    strong = {"color": style.INK, "linewidth": 0.9, "zorder": 1}
    lines = []
    if trace.row >= 0:
        height = aspects.heights[trace.row]
        name, barrier = aspects.names[trace.row], aspects.barriers[trace.row]
        lines.append((height / MM, f"rests on {name}", strong))
        if np.isfinite(barrier):
            saddle = (height + barrier) / MM
            lines.append((saddle, f"tips from {name}", strong | {"linestyle": (0, (5, 3))}))
    for row in np.flatnonzero(aspects.stable):
        if row != trace.row:
            lines.append((aspects.heights[row] / MM, f"rests on {aspects.names[row]}", plain))
    return lines


def badge(axes, x, y, number) -> None:
    """Draw a still's number in a disc."""
    disc = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": style.INK, "linewidth": 0.7}
    axes.text(x, y, str(number), fontsize=6, ha="center", va="center", color=style.INK, bbox=disc, zorder=6,
              clip_on=False)  # fmt: skip


def _named(axes, lines) -> None:
    """Reference lines, their names at the right from the first on; one without room is left out."""
    low, high = np.log(axes.get_ylim())
    taken = list(LEGEND)
    for height, text, look in lines:
        axes.axhline(height, **look)
        place = (np.log(height) - low) / (high - low)
        if all(abs(place - other) >= LABEL_SPACING for other in taken):
            taken.append(place)
            axes.text(1.01, place, f"{text} {height:.3g}", transform=axes.transAxes, fontsize=7, va="center",
                      color=style.INK)  # fmt: skip


ACROSS, DOWN = 6, 2  # stills
WIDTH, TALLEST, GAP = 262, 430, 12  # [px] of a still; its greatest height; to the next
EDGE, HEAD, CAPTION, CURVE = 30, 92, 44, 350  # [px]
STILL_MARGIN = 1.12  # of a still over the part in it
MAX_ZOOM_OUT = (
    1.7  # a part that flies high is drawn so much smaller, at most; higher still, its floor is cut off
)
UP = 0.1  # of the lowest height of the centre of mass: a gap that is worth telling
CELLS_ACROSS = 4.0  # of the floor's grid across a still, at least
GRID_REACH = 1.25  # [size] how far behind and before the part the grid is drawn
PIECES = 160  # points of a line, to see which are hidden
HIDDEN_DISTANCE = 40.0  # [size] how far behind the solid a point may lie
GRID = {"color": style.FAINT, "linewidth": 0.8, "zorder": 2}
PAST = {"color": style.ACCENT, "linewidth": 1.1, "zorder": 4}
AHEAD = {"color": style.ACCENT, "linewidth": 0.9, "linestyle": (0, (1, 2.2)), "zorder": 4}
FOOT = {"color": style.INK, "linewidth": 0.7, "linestyle": (0, (3, 2)), "zorder": 4}


@dataclass(frozen=True, eq=False)
class Strip:
    """What all stills share; lengths in sizes of the solid."""

    solid: Any  # shading.Rays
    trace: DropTrace
    places: np.ndarray  # (N, 3) centre of mass, by row of the trace
    heading: np.ndarray  # (3,) where the part goes, along the picture
    pixel: float  # edge of one pixel
    heights: tuple[int, ...]  # [px] of the stills, row by row
    bottoms: np.ndarray  # (S,) of each still, from the image of the centre of mass

    @property
    def page(self) -> tuple[Any, ...]:
        """Width and height of the whole picture."""
        return 2 * EDGE + ACROSS * (WIDTH + GAP) - GAP, HEAD + sum(self.heights) + DOWN * CAPTION + CURVE

    @property
    def step(self):
        """[m] of the grid on the plane."""
        return grid_step(self.pixel * WIDTH / CELLS_ACROSS * self.solid.size)

    def place(self, panel) -> tuple[Any, ...]:
        """Return the left, bottom, width and height of a still on the page."""
        row, column = divmod(panel, ACROSS)
        above = HEAD + sum(self.heights[: row + 1]) + row * CAPTION
        return EDGE + column * (WIDTH + GAP), self.page[1] - above, WIDTH, self.heights[row]


def strip(part: Part, aspects, trace, title: str):
    """Draw one drop of a part with a mesh in stills, and its energy below."""
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    rows = chosen(trace, ACROSS * DOWN)
    layout, stances = _layout(solid, trace, rows)
    figure = style.page(*layout.page)
    page = _page(figure, layout, title)
    for panel, (row, standing) in enumerate(zip(rows, stances)):
        place = layout.place(panel)
        axes = figure.add_axes(_share(layout, *place), xticks=[], yticks=[])
        axes.spines[:].set_color(style.FAINT)
        _still(axes, layout, standing, panel, row)
        _caption(page, place, panel + 1, still_caption(trace, row, aspects.names, _gap(solid, standing)))
    axes = figure.add_axes(_share(layout, EDGE + 60, 66, layout.page[0] - 2 * EDGE - 240, CURVE - 116))
    curve(axes, trace, aspects, rows)
    return figure


def still_caption(trace, row, names, gap):
    """Return the time of a still, and what is happening; ``gap`` [m] is under the lowest corner."""
    time = f"{1e3 * trace.times[row]:.0f} ms"
    if row == len(trace.times) - 1 and trace.row >= 0:
        return f"{time}, {'rests on' if trace.still else 'bound for'} {names[trace.row]}"
    if trace.impacts[row]:
        return f"{time}, hits"
    up = f"{gap / MM:.{int(gap < 10.0 * MM)}f}"
    return f"{time}, {up} mm up" if gap > UP * trace.positions[:, 2].min() else time


def _gap(solid, standing):
    """[m] under the lowest corner."""
    return (standing.height - (solid.points @ standing.down).max()) * solid.size


def _layout(solid, trace, rows) -> tuple[Any, ...]:
    """The layout in which every still fits, all in one scale, and how the part stands in each."""
    places, points = trace.positions / solid.size, shading.outermost(solid.points)
    displacement = places[rows[-1], :2] - places[rows[0], :2]
    angle = np.arctan2(displacement[1], displacement[0])
    along = np.array([np.cos(angle - shading.STANCE_TURN_RAD), np.sin(angle - shading.STANCE_TURN_RAD), 0.0])
    stances = [
        shading.placed(points, turn.inv().apply([0.0, 0.0, -1.0]), place[2], turn.inv().apply(along))
        for turn, place in zip(trace.turns[rows], places[rows])
    ]
    lifts = np.array([standing.height * standing.camera.up @ -standing.down for standing in stances])
    ends = np.array([[standing.framed[0, 1], standing.bounds[1, 1]] for standing in stances])
    ends += lifts[:, None]  # from the foot of the centre of mass
    widest = 2.0 * max(np.abs(standing.framed[:, 0]).max() for standing in stances)
    close = STILL_MARGIN * widest / WIDTH
    pixel = float(np.clip(STILL_MARGIN * np.ptp(ends) / TALLEST, close, MAX_ZOOM_OUT * close))
    ends += 0.5 * (STILL_MARGIN - 1.0) * widest * np.array([-1.0, 1.0])
    by_row = ends.reshape(DOWN, ACROSS, 2)
    low, high = by_row[..., 0].min(axis=1), by_row[..., 1].max(axis=1)
    heights = np.minimum(np.ceil((high - low) / pixel), TALLEST).astype(int)
    bottoms = np.maximum(low[:, None], by_row[..., 1] - pixel * heights[:, None]).ravel() - lifts
    heading = np.array([np.cos(angle), np.sin(angle), 0.0])
    return Strip(solid, trace, places, heading, pixel, tuple(heights.tolist()), bottoms), stances


def _still(axes, layout, standing, panel, row) -> None:
    """The part on its way, on a floor with a grid that stays where it is."""
    _, _, width, height = layout.place(panel)
    frame = shading.Shot(-0.5 * width * layout.pixel, layout.bottoms[panel], layout.pixel, width, height)
    axes.imshow(_clear(layout.solid, standing, frame), extent=frame.extent, interpolation="nearest", zorder=3)
    place, to_file = layout.places[row], layout.trace.turns[row].inv()
    foot = np.linspace(place * [1.0, 1.0, 0.0], place, PIECES)
    for look, lines in (
        (GRID, _grid(layout, place)),
        (PAST, [layout.places[: row + 1]]),
        (AHEAD, [layout.places[row:]]),
        (FOOT, [foot]),
    ):
        for line in lines:
            _draw(axes, layout.solid, standing.camera, to_file.apply(line - place), look)
    axes.set(xlim=frame.extent[:2], ylim=frame.extent[2:])


def _clear(solid, standing, frame):
    """The picture (rows, columns, 4) as on glass: opaque where the part is, tinted by its shadow."""
    image = shading.picture(solid, standing, frame)
    depths, _ = standing.camera.cast(solid, *frame.positions())
    part = ndimage.binary_dilation(np.isfinite(depths), iterations=2)
    shade = 1.0 - image.mean(axis=2)
    return np.dstack([image * part[..., None], np.where(part, 1.0, shade)])


def _draw(axes, solid, camera, line, look) -> None:
    """Where a line (N, 3) about the centre of mass is not hidden by the solid."""
    image, visible = camera.project(line), camera.sees(solid, line, away=HIDDEN_DISTANCE)
    axes.plot(*np.where(visible[:, None], image, np.nan).T, **look)


def _grid(layout, place) -> Iterator[Any]:
    """Lines on the plane about a still, along and across the way, a round number of millimetres apart."""
    step = layout.step / layout.solid.size
    axes = np.array([layout.heading, np.cross([0.0, 0.0, 1.0], layout.heading)])  # along, across
    reaches, centre = (0.5 * WIDTH * layout.pixel, GRID_REACH), axes @ place
    for across, other in ((0, 1), (1, 0)):
        run = centre[other] + np.linspace(-reaches[other], reaches[other], PIECES)
        first, last = (centre[across] + sign * reaches[across] for sign in (-1.0, 1.0))
        for value in step * np.arange(np.ceil(first / step), last / step):
            yield value * axes[across] + run[:, None] * axes[other]


def grid_step(longest):
    """Return the largest of 1, 2, 5, 10, 20, ... mm that is at most ``longest`` [m]; in m."""
    decade = 10.0 ** np.floor(np.log10(longest / MM))
    return MM * decade * max(step for step in (1.0, 2.0, 5.0) if step * decade * MM <= longest * (1.0 + 1e-9))


def _share(layout, left, bottom, width, height) -> tuple[Any, ...]:
    page = layout.page
    return left / page[0], bottom / page[1], width / page[0], height / page[1]


def _page(figure, layout, title):
    """Title and scale; the Axes over the whole page, in pixels."""
    width, height = layout.page
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(0, width), ylim=(0, height))
    axes.text(EDGE, height - 34, title, fontsize=13, fontweight="bold", color=style.INK, va="center")
    text = f"grid on the plane: {layout.step / MM:g} mm; line: path of the centre of mass"
    axes.text(EDGE, height - 66, text, fontsize=8, color=style.INK, va="center")
    shading.scale_bar(axes, width - EDGE, height - 66, layout.pixel * layout.solid.size)
    return axes


def _caption(page, place, number, words) -> None:
    """Number and text under a still."""
    left, bottom, _, _ = place
    badge(page, left + 16, bottom - 18, number)
    page.text(left + 34, bottom - 18, words, fontsize=8, color=style.INK, va="center")
