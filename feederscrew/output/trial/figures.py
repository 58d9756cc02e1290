"""Charts of trials: orientations in and out, and the paths over a device from above."""

import textwrap

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from feederscrew.base.arrays import Floats, Points
from feederscrew.base.units import MM
from feederscrew.output import style
from feederscrew.sorting.tooled_track import along_wall
from feederscrew.trials import course, runs
from feederscrew.trials.course import Fate
from feederscrew.trials.result import TrialRun
from feederscrew.trials.staging import Stage

BLOWN_OFF = None  # in place of the fate of a returned part, where a sensor saw it
# of each fate: colour, told apart by colour-blind eyes, line, and mark where the path ends
LOOKS: dict[Fate | None, tuple[str, str, str]] = {
    Fate.PASSED: ("#0072b2", "-", ""),
    Fate.TURNED: ("#009e73", "--", "D"),
    Fate.RETURNED: ("#d55e00", "-", "x"),
    BLOWN_OFF: ("#882255", "-", "^"),
    Fate.HANGING: ("#cc79a7", "-", "v"),
    Fate.STOPPED: ("#e69f00", "-", "s"),
    Fate.ROLLED_BACK: ("#7a5c3e", ":", "<"),
    Fate.STUCK: ("#000000", "-", "*"),
}
TRACK, AIR_COLOUR = "#e3e8ec", "#009e73"
PATHS_WIDTH_IN = 7.2  # [in] of a panel of paths
SIDE_MARGIN_MM, WALL_MARGIN_MM = 2.0, 2.0  # of a panel, before and behind, and outside the wall
MOST = 24  # orientations have a row: those of which parts leave, then those that come most often
STAYS: dict[int, str] = {course.HANGING: "stays\nhanging"}  # of the matrix, beside what leaves hanging


def matrix(run: TrialRun, ax: "style.Axes | None" = None) -> Figure:
    """Draw in which orientation parts came, and in which they left or what became of them.

    Parameters
    ----------
    run : TrialRun
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    order = [int(k) for k in np.argsort(-run.shares, kind="stable") if run.tried_counts[k]]
    leaving = run.matrix.sum(axis=1)  # of what is wanted parts leave: it has a row however seldom it comes
    shown = set(sorted(order, key=lambda k: leaving[k] == 0)[:MOST])
    rows = [k for k in order if k in shown]
    out = [m for m in range(run.matrix.shape[1]) if run.matrix[rows, m].any()]
    names = [item.name for item in run.orientations.states] + ["other"]
    lost = [fate for fate in range(course.RETURNED, len(course.FATES)) if run.counts[rows, fate].any()]
    counts = np.column_stack([run.matrix[rows][:, out], run.counts[rows][:, lost]])
    shares = counts / run.tried_counts[rows][:, None]
    titles = [names[m] for m in out]
    titles += [STAYS.get(fate, course.FATES[fate].replace("_", "\n")) for fate in lost]
    figure, axes = style.chart(max(4.2, 1.8 + 0.62 * len(titles)), 1.5 + 0.3 * len(rows), ax=ax, grid="none")
    axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.25, aspect="auto")
    axes.hlines(np.arange(1, len(rows)) - 0.5, -0.5, len(titles) - 0.5, color="white", linewidth=1.5)
    axes.vlines(np.arange(1, len(titles)) - 0.5, -0.5, len(rows) - 0.5, color="white", linewidth=1.5)
    for r, c in zip(*np.nonzero(counts)):
        colour = "white" if shares[r, c] > 0.7 else style.INK
        axes.text(c, r, counts[r, c], ha="center", va="center", fontsize=8, color=colour)
    style.tidy(axes, title="Orientations in and out, parts", x="leaves as", y="comes as", grid="none")
    style.named_ticks(axes, range(len(titles)), titles, length=3.0)
    odd = [" *" if run.is_odd[k] else "" for k in rows]
    axes.set_yticks(range(len(rows)), [names[k] + mark for k, mark in zip(rows, odd)])
    if any(odd):
        axes.set_xlabel("leaves as   (* not what the static rule says)", fontsize=9, color=style.INK)
    return figure


def paths(run: TrialRun) -> Figure:
    """Draw where the centres of mass of parts went over each device, unrolled, from above.

    Parameters
    ----------
    run : TrialRun

    Returns
    -------
    matplotlib.figure.Figure
    """
    sent, radius = run.course, run.bowl.track.radius
    flat_paths = [
        [unroll_path(path, radius, station.middle) for path in ride.paths]
        for station, ride in zip(sent.stations, sent.rides)
    ]
    widest = 1e3 * max(off.max(initial=0.0) for rides in flat_paths for _, off in rides)
    longest = 1e3 * max(station.exit - station.begin for station in sent.stations[: len(sent.rides)])
    span, high = longest + 2.0 * SIDE_MARGIN_MM, 1.1 * widest + 2.0 * WALL_MARGIN_MM
    panel = PATHS_WIDTH_IN * high / span
    figure = style.figure(PATHS_WIDTH_IN + 0.9, 0.7 + (panel + 0.75) * len(sent.rides))
    panels = figure.subplots(len(sent.rides), 1, squeeze=False)[:, 0]
    drawn_fates: set[Fate | None] = set()  # fates in the picture
    stations = zip(panels, sent.stations, sent.rides, sent.riders, flat_paths)
    for axes, station, ride, riders, flat in stations:
        axes.set_facecolor("white")
        for place, ring in enumerate(solids(station)):
            off = radius - np.hypot(ring[:, 0], radius - ring[:, 1])
            outline = np.column_stack([along_wall(ring, radius, station.middle), off]) / MM
            after = np.roll(ring, -1, axis=0)
            hole = place > 0 and (ring[:, 0] * after[:, 1] - ring[:, 1] * after[:, 0]).sum() < 0.0
            face = "white" if hole else TRACK
            axes.add_patch(Polygon(outline, facecolor=face, edgecolor=style.INK, linewidth=0.6, zorder=0.5))
        for plate in station.plates[1:]:
            begin = along_wall(np.array([plate.origin_x, plate.origin_y]), radius, station.middle)
            axes.axvline(begin / MM, color=style.INK, linewidth=2.0)
        for watch in station.air.watches:  # where a sensor looks and where its nozzles are, in the wall
            axes.axvline(watch.place / MM, color=AIR_COLOUR, linewidth=0.9, linestyle="--")
            axes.plot(watch.nozzles / MM, 0.0, "^", color=AIR_COLOUR, markersize=7, zorder=5)
            for where, word, side in (watch.place, "sensor ", "right"), (watch.nozzles, " air", "left"):
                look = {"xycoords": ("data", "axes fraction"), "ha": side, "fontsize": 7, "color": AIR_COLOUR}
                style.note(axes, word, (where / MM, 1.0), (0, -8), **look)
        for rider, (along, off), outcome in zip(riders, flat, ride.outcomes):
            fate: Fate | None = Fate(int(sent.fates[rider]))
            if outcome == runs.PASSED and fate is not Fate.TURNED:  # turned: leaves so
                fate = Fate.PASSED
            looks = [watch.place for watch in station.air.watches]
            if fate is Fate.RETURNED and any(along.max(initial=-1.0) >= place for place in looks):
                fate = BLOWN_OFF
            colour, line, mark = LOOKS[fate]
            axes.plot(along / MM, off / MM, line, color=colour, linewidth=0.7, alpha=0.7)
            if len(along):
                axes.plot(along[-1] / MM, off[-1] / MM, mark, color=colour, markersize=4)
            drawn_fates.add(fate)
        title = f"{station.device.kind}: {station.device.value_words}".removesuffix(": ")
        title = "\n".join(textwrap.wrap(title, 88))
        style.tidy(axes, title=title, x="along the wall [mm]", y="from the wall [mm]", grid="none")
        axes.axhline(0.0, color=style.INK, linewidth=3.0)  # the wall
        left = station.begin / MM - SIDE_MARGIN_MM
        axes.set(xlim=(left, left + span), ylim=(-WALL_MARGIN_MM, high - WALL_MARGIN_MM), aspect="equal")
    for fate in (fate for fate in LOOKS if fate in drawn_fates):
        colour, line, mark = LOOKS[fate]
        panels[0].plot([], [], line, color=colour, marker=mark, markersize=4, label=label_of(fate))
    style.legend(figure, ncols=len(LOOKS), fontsize=7)
    return figure


def label_of(fate: Fate | None) -> str:
    """Return the fate of a part as a legend has it: 'rolled back', 'blown off'.

    Parameters
    ----------
    fate : Fate or None

    Returns
    -------
    str
    """
    return "blown off" if fate is BLOWN_OFF else fate.word.replace("_", " ")


def unroll_path(path: Floats, radius: float, middle: float = 0.0) -> tuple[Floats, Floats]:
    """Return a path unrolled, as far as it goes.

    Parameters
    ----------
    path : (K, 8) float [s and m]
        As of ``Runs.paths``.
    radius : float [m]
        Of the wall.
    middle : float [m], optional
        Of the track, as of ``Stage``.

    Returns
    -------
    along, off : (K',) float [m]
        Lengths along the wall, and distances from it.
    """
    followed = path[np.isfinite(path[:, 0])]
    off = radius - np.hypot(followed[:, 1], radius - followed[:, 2])
    return along_wall(followed[:, 1:3], radius, middle), off


def solids(station: Stage, plate: int = 0) -> list[Points]:
    """Return the rings of what is solid of a plate, in its frame: for the track the bowl's.

    Parameters
    ----------
    station : Stage
    plate : int, optional

    Returns
    -------
    list of (K, 2) float [m]
    """
    row = station.plates[plate]
    borders = station.borders[row.begin : row.end]
    starts, ends = (np.column_stack([borders[f"{end}_x"], borders[f"{end}_y"]]) for end in ("start", "end"))
    breaks = np.flatnonzero(np.hypot(*(starts[1:] - ends[:-1]).T) > 1e-12) + 1
    return np.split(starts, breaks) if len(starts) else []
