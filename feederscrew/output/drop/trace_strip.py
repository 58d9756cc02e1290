"""One drop as a strip of stills: the part in its successive attitudes on the plane, and its energy below."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_dilation

from feederscrew.dropping.key_moments import chosen
from feederscrew.dropping.traces import DropTrace
from feederscrew.output import style
from feederscrew.output.drop import trace_curve
from feederscrew.output.solid import marks, render, shading
from feederscrew.output.solid.shading import Shot
from feederscrew.output.solid.stance import TURN, outermost, placed
from feederscrew.units import MM

ACROSS, DOWN = 6, 2  # stills
WIDTH, TALLEST, GAP = 262, 430, 12  # [px] of a still; its greatest height; to the next
EDGE, HEAD, CAPTION, CURVE = 30, 92, 44, 350  # [px]
ROOM = 1.12  # of a still over the part in it
FARTHEST = 1.7  # a part that flies high is drawn so much smaller, at most; higher still, its floor is cut off
UP = 0.1  # of the lowest height of the centre of mass: a gap that is worth telling
CELLS = 4.0  # of the floor's grid across a still, at least
DEEP = 1.25  # [size] how far behind and before the part the grid is drawn
PIECES = 160  # points of a line, to see which are hidden
BEHIND = 40.0  # [size] how far behind the solid a point may lie
GRID = {"color": style.FAINT, "linewidth": 0.8, "zorder": 2}
PAST = {"color": style.ACCENT, "linewidth": 1.1, "zorder": 4}
AHEAD = {"color": style.ACCENT, "linewidth": 0.9, "linestyle": (0, (1, 2.2)), "zorder": 4}
FOOT = {"color": style.INK, "linewidth": 0.7, "linestyle": (0, (3, 2)), "zorder": 4}


@dataclass(frozen=True, eq=False)
class Strip:
    """What all stills share; lengths in sizes of the solid."""

    solid: render.Rays
    trace: DropTrace
    places: np.ndarray  # (N, 3) centre of mass, by row of the trace
    heading: np.ndarray  # (3,) where the part goes, along the picture
    pixel: float  # edge of one pixel
    heights: tuple[int, ...]  # [px] of the stills, row by row
    bottoms: np.ndarray  # (S,) of each still, from the image of the centre of mass

    @property
    def page(self):
        """Width and height of the whole picture."""
        return 2 * EDGE + ACROSS * (WIDTH + GAP) - GAP, HEAD + sum(self.heights) + DOWN * CAPTION + CURVE

    @property
    def step(self):
        """[m] of the grid on the plane."""
        return grid_step(self.pixel * WIDTH / CELLS * self.solid.size)

    def place(self, panel):
        """Return the left, bottom, width and height of a still on the page."""
        row, column = divmod(panel, ACROSS)
        above = HEAD + sum(self.heights[: row + 1]) + row * CAPTION
        return EDGE + column * (WIDTH + GAP), self.page[1] - above, WIDTH, self.heights[row]


def strip(part, aspects, trace, title):
    """Draw one drop.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    trace : DropTrace
    title : str

    Returns
    -------
    Figure
    """
    solid = render.Rays(part.vertices, part.faces, part.centre_of_mass)
    rows = chosen(trace, ACROSS * DOWN)
    laid, stances = _layout(solid, trace, rows)
    figure = style.page(*laid.page)
    page = _page(figure, laid, title)
    for panel, (row, standing) in enumerate(zip(rows, stances)):
        place = laid.place(panel)
        axes = figure.add_axes(_share(laid, *place), xticks=[], yticks=[])
        axes.spines[:].set_color(style.FAINT)
        _still(axes, laid, standing, panel, row)
        _caption(page, place, panel + 1, said(trace, row, aspects.names, _gap(solid, standing)))
    axes = figure.add_axes(_share(laid, EDGE + 60, 66, laid.page[0] - 2 * EDGE - 240, CURVE - 116))
    trace_curve.curve(axes, trace, aspects, rows)
    return figure


def said(trace, row, names, gap):
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


def _layout(solid, trace, rows):
    """The layout in which every still fits, all in one scale, and how the part stands in each."""
    places, points = trace.positions / solid.size, outermost(solid.points)
    way = places[rows[-1], :2] - places[rows[0], :2]
    angle = np.arctan2(way[1], way[0])
    along = np.array([np.cos(angle - TURN), np.sin(angle - TURN), 0.0])
    stances = [
        placed(points, turn.inv().apply([0.0, 0.0, -1.0]), place[2], turn.inv().apply(along))
        for turn, place in zip(trace.turns[rows], places[rows])
    ]
    lifts = np.array([standing.height * standing.camera.up @ -standing.down for standing in stances])
    ends = np.array([[standing.framed[0, 1], standing.bounds[1, 1]] for standing in stances])
    ends += lifts[:, None]  # from the foot of the centre of mass
    widest = 2.0 * max(np.abs(standing.framed[:, 0]).max() for standing in stances)
    close = ROOM * widest / WIDTH
    pixel = float(np.clip(ROOM * np.ptp(ends) / TALLEST, close, FARTHEST * close))
    ends += 0.5 * (ROOM - 1.0) * widest * np.array([-1.0, 1.0])
    by_row = ends.reshape(DOWN, ACROSS, 2)
    low, high = by_row[..., 0].min(axis=1), by_row[..., 1].max(axis=1)
    heights = np.minimum(np.ceil((high - low) / pixel), TALLEST).astype(int)
    bottoms = np.maximum(low[:, None], by_row[..., 1] - pixel * heights[:, None]).ravel() - lifts
    heading = np.array([np.cos(angle), np.sin(angle), 0.0])
    return Strip(solid, trace, places, heading, pixel, tuple(heights.tolist()), bottoms), stances


def _still(axes, laid, standing, panel, row):
    """The part on its way, on a floor with a grid that stays where it is."""
    _, _, width, height = laid.place(panel)
    frame = Shot(-0.5 * width * laid.pixel, laid.bottoms[panel], laid.pixel, width, height)
    axes.imshow(_clear(laid.solid, standing, frame), extent=frame.extent, interpolation="nearest", zorder=3)
    place, to_file = laid.places[row], laid.trace.turns[row].inv()
    foot = np.linspace(place * [1.0, 1.0, 0.0], place, PIECES)
    for look, lines in (
        (GRID, _grid(laid, place)),
        (PAST, [laid.places[: row + 1]]),
        (AHEAD, [laid.places[row:]]),
        (FOOT, [foot]),
    ):
        for line in lines:
            _draw(axes, laid.solid, standing.camera, to_file.apply(line - place), look)
    axes.set(xlim=frame.extent[:2], ylim=frame.extent[2:])


def _clear(solid, standing, frame):
    """The picture (rows, columns, 4) as on glass: opaque where the part is, tinted by its shadow."""
    image = shading.picture(solid, standing, frame)
    depths, _ = standing.camera.cast(solid, *frame.positions())
    part = binary_dilation(np.isfinite(depths), iterations=2)
    shade = 1.0 - image.mean(axis=2)
    return np.dstack([image * part[..., None], np.where(part, 1.0, shade)])


def _draw(axes, solid, camera, line, look):
    """Where a line (N, 3) about the centre of mass is not hidden by the solid."""
    image, seen = camera.project(line), camera.sees(solid, line, away=BEHIND)
    axes.plot(*np.where(seen[:, None], image, np.nan).T, **look)


def _grid(laid, place):
    """Lines on the plane about a still, along and across the way, a round number of millimetres apart."""
    step = laid.step / laid.solid.size
    ways = np.array([laid.heading, np.cross([0.0, 0.0, 1.0], laid.heading)])  # along, across
    reaches, centre = (0.5 * WIDTH * laid.pixel, DEEP), ways @ place
    for one, other in ((0, 1), (1, 0)):
        run = centre[other] + np.linspace(-reaches[other], reaches[other], PIECES)
        first, last = (centre[one] + sign * reaches[one] for sign in (-1.0, 1.0))
        for value in step * np.arange(np.ceil(first / step), last / step):
            yield value * ways[one] + run[:, None] * ways[other]


def grid_step(longest):
    """Return the largest of 1, 2, 5, 10, 20, ... mm that is at most ``longest`` [m]; in m."""
    decade = 10.0 ** np.floor(np.log10(longest / MM))
    return MM * decade * max(step for step in (1.0, 2.0, 5.0) if step * decade * MM <= longest * (1.0 + 1e-9))


def _share(laid, left, bottom, width, height):
    page = laid.page
    return left / page[0], bottom / page[1], width / page[0], height / page[1]


def _page(figure, laid, title):
    """Title and scale; the Axes over the whole page, in pixels."""
    width, height = laid.page
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(0, width), ylim=(0, height))
    axes.text(EDGE, height - 34, title, fontsize=13, fontweight="bold", color=style.INK, va="center")
    text = f"grid on the plane: {laid.step / MM:g} mm; line: path of the centre of mass"
    axes.text(EDGE, height - 66, text, fontsize=8, color=style.INK, va="center")
    marks.scale_bar(axes, width - EDGE, height - 66, laid.pixel * laid.solid.size)
    return axes


def _caption(page, place, number, words):
    """Number and text under a still."""
    left, bottom, _, _ = place
    trace_curve.badge(page, left + 16, bottom - 18, number)
    page.text(left + 34, bottom - 18, words, fontsize=8, color=style.INK, va="center")
