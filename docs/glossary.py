"""Draw the pictures of docs/glossary.md: its words on a bowl's track and on a bolt.

Example: python docs/glossary.py
"""

from pathlib import Path

import numpy as np

from feederscrew.output import style

FOLDER = Path(__file__).resolve().parent
STEEL, TRACK, WALL, AIR = "#b9c4cd", "#eef1f4", "#8fa5b5", "#56b4e9"
BOLT = np.array([(-4, -6), (0, -6), (0, -2.5), (14, -2.5), (14, 2.5), (0, 2.5), (0, 6), (-4, 6)], float)
CENTRE = np.array((3.0, 0.0))  # of mass
DEG = np.pi / 180.0


def turned(points, angle, at=(0.0, 0.0)):
    """Return points (N, 2) turned about the bolt's centre of mass by an angle [rad] and moved to a place."""
    c, s = np.cos(angle), np.sin(angle)
    return (np.asarray(points) - CENTRE) @ np.array([[c, s], [-s, c]]) + at


def fill(axes, points, colour=STEEL, **more):
    """Fill an outline (N, 2)."""
    axes.fill(*np.asarray(points).T, facecolor=colour, edgecolor=style.INK, linewidth=1.0, **more)


def note(axes, text, x, y, **more):
    """Write a word at a place."""
    axes.text(x, y, text, **{"fontsize": 8, "color": style.INK, "ha": "center", "va": "center"} | more)


def arrow(axes, begin, end, colour=style.ACCENT, kind="-|>", **more):
    """Draw an arrow from one place to another."""
    looks = {"arrowstyle": kind, "color": colour, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0} | more
    axes.annotate("", end, begin, arrowprops=looks)


def arc(axes, centre, radius, begin, end, text, away=1.35, **more):
    """Draw an angle [deg] as an arc with its name in the middle."""
    turn = np.linspace(begin, end, 40) * DEG
    axes.plot(
        centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn), color=style.ACCENT, lw=1.2
    )
    middle = 0.5 * (begin + end) * DEG
    note(axes, text, centre[0] + away * radius * np.cos(middle), centre[1] + away * radius * np.sin(middle),
         color=style.ACCENT, **more)  # fmt: skip


def bare(axes, title, x, y):
    """An empty panel of equal scales."""
    style.tidy(axes, title=title, grid="none")
    axes.set(xlim=x, ylim=y, aspect="equal", xticks=[], yticks=[])
    axes.spines[["left", "bottom"]].set_visible(False)


def aspects(axes):
    """Three sides on which a bolt rests."""
    bare(axes, "Aspect: the side it rests on", (-14, 62), (-5, 26))
    axes.plot((-12, 60), (0, 0), color=style.INK, lw=2)
    lean = np.arctan2(3.5, 14.0)
    lying = turned(BOLT, -lean)
    fill(axes, lying - (lying[:, 0].min() + 10.0, lying[:, 1].min()))
    fill(axes, turned(BOLT, 90 * DEG, (28.0, 7.0)))
    fill(axes, turned(BOLT, -90 * DEG, (48.0, 11.0)))
    for name, x in (("A: on edges", -1), ("B: on end", 28), ("C: on end", 48)):
        note(axes, name, x, -3)


def headings(axes):
    """Headings of a bolt along the wall, and their zero."""
    bare(axes, "Heading: how it is turned, from above", (-16, 62), (-6, 26))
    axes.fill_between((-15, 61), 0, 22, color=TRACK)
    axes.fill_between((-15, 61), -1.6, 0, color=WALL)
    note(axes, "wall", -11, -3.6)
    note(axes, "free edge, the bowl's axis beyond", 23, 24)
    arrow(axes, (46, -3.6), (60, -3.6), style.INK)
    note(axes, "direction of travel", 34, -3.6)
    for angle, x, y in ((0, -4, 6), (90, 26, 7), (180, 50, 6)):
        fill(axes, turned(BOLT, angle * DEG, (x, y)))
        ahead = turned([(9.0, 0.0)], angle * DEG, (x, y))[0]
        axes.plot(x, y, "o", color=style.INK, ms=4)
        arrow(axes, (x, y), ahead)
    note(axes, "A@0", -4, 15)
    note(axes, "A@90", 36, 16)
    note(axes, "A@180", 50, 15)


def section(axes):
    """The track across, with its bank."""
    bare(axes, "Across the track: wall, bank, free edge", (-4, 34), (-6, 18))
    bank = 12 * DEG
    along = np.array((np.cos(bank), -np.sin(bank)))
    up = np.array((np.sin(bank), np.cos(bank)))
    free, foot = np.array((4.0, 4.0)), np.array((4.0, 4.0)) + 22 * along
    fill(axes, [free, foot, foot - 2 * up, free - 2 * up], TRACK)
    fill(axes, [foot - (0, 3), foot + (2, -3), foot + (2, 18), foot + (0, 18)], WALL)
    near = foot - 1.4 * along
    fill(axes, [near, near - 10 * along, near - 10 * along + 6 * up, near + 6 * up])
    axes.plot((5.0, foot[0]), (foot[1], foot[1]), color=style.INK, lw=0.8, ls="--")
    arc(axes, foot, 12, 168, 180, "bank", 0.78)
    note(axes, "wall", 29.3, 12, ha="left")
    note(axes, "track", 16, -3)
    note(axes, "free edge", 2, 7)
    arrow(axes, (3.4, 2.5), (-1.5, -4), style.INK, connectionstyle="arc3,rad=0.3")
    note(axes, "returned", 2.3, -4.6, ha="left")


def side(axes):
    """The track from the side, with its climb and the drive."""
    bare(axes, "Along the track: climb, drive", (-2, 40), (-4, 20))
    climb, drive = 6 * DEG, 32 * DEG
    begin, end = np.array((2.0, 1.0)), np.array((2.0, 1.0)) + 34 * np.array((np.cos(climb), np.sin(climb)))
    axes.plot(*zip(begin, end), color=style.INK, lw=2.5)
    axes.plot((begin[0], 36), (begin[1], begin[1]), color=style.INK, lw=0.8, ls="--")
    arc(axes, begin, 27, 0, 6, "climb", 1.1)
    fill(axes, turned([(0, 0), (6, 0), (6, 4), (0, 4)], climb, (13.0, 1.95)) + (0.0, 0.0))
    at = np.array((21.0, 3.2))
    arrow(axes, at, at + 14 * np.array((np.cos(drive), np.sin(drive))), kind="<|-|>")
    arc(axes, at, 9, 6, 32, "vibration angle", 1.7)
    note(axes, "drive: to and fro\nby the amplitude", 25, 15.5)
    note(axes, "throw number above 1:\nthe part hops", 8, 11.5)


def drives(axes):
    """The motion of a track with one set of leaf springs, and with two magnets."""
    bare(axes, "Drive: leaf springs, two axes", (-3, 41), (-6, 13))
    beta, phase = 32 * DEG, np.linspace(0.0, 2.0 * np.pi, 100)
    for x, lead, name in (
        (4, 0.0, "leaf springs:\na line, phase 0"),
        (24, 70 * DEG, "two magnets:\nan ellipse"),
    ):
        axes.plot((x - 4, x + 14), (0, 0), color=style.INK, lw=2.5)
        along, up = 5 * np.cos(beta) * np.sin(phase), 5 * np.sin(beta) * np.sin(phase + lead)
        axes.plot(x + 5 + along, 5 + up, color=style.ACCENT, lw=1.4)
        note(axes, name, x + 5, -3.5)
    arrow(axes, (26, 9.5), (33, 9.5), style.INK)
    note(axes, "travel", 29.5, 11)
    arrow(axes, (9, 5), 5 * np.array((np.cos(beta), np.sin(beta))) + (9, 5), style.INK)
    note(axes, "amplitude", 4.5, 8.6)


def queue(axes):
    """A queue from above, with its pitch, and the place where it leaves the track when it backs up."""
    bare(axes, "Queue, from above: pitch, gap, pressure break", (-2, 78), (-7, 27))
    axes.fill([0, 44, 44, 58, 58, 76, 76, 0], [13, 13, 5.6, 5.6, 13, 13, 0, 0], color=TRACK)
    axes.fill_between((0, 76), -1.6, 0, color=WALL)
    for x in (1, 13, 25, 37, 49, 62):
        fill(axes, np.array([(0, 0), (11, 0), (11, 5), (0, 5)]) + (x, 0.1))
    arrow(axes, (49, 9), (62, 9), kind="<|-|>")
    note(axes, "pitch", 55.5, 10.6, color=style.ACCENT)
    arrow(axes, (60, -3.5), (62, -3.5), style.INK, kind="-")
    note(axes, "gap", 61, -5)
    fill(axes, turned(np.array([(0, 0), (11, 0), (11, 5), (0, 5)]), 35 * DEG, (50, 16)))
    arrow(axes, (47, 8), (45, 14.5), style.INK, connectionstyle="arc3,rad=0.2")
    note(axes, "pressure break: what backs up\nleaves over the narrow ledge", 22, 17.5)


def chain(axes):
    """A chain of devices, and what becomes of the parts."""
    bare(axes, "Chain of devices, from above: what becomes of 100 parts that arrive", (0, 120), (-18, 27))
    axes.fill_between((2, 118), 0, 16, color=TRACK)
    axes.fill_between((2, 118), -1.6, 0, color=WALL)
    for x, wide, name in ((14, 20, "spacing section"), (44, 20, "vision reject"), (78, 24, "rails")):
        axes.plot((x, x, x + wide, x + wide), (16, 18, 18, 16), color=style.INK, lw=1.0)
        note(axes, name, x + 0.4 * wide, 21)
    for x, angle in ((5, 0), (19, 180), (32, 0), (53, 90)):
        fill(axes, turned(0.45 * BOLT + 0.55 * CENTRE, angle * DEG, (x, 5.5)))
    axes.fill([51.8, 54.2, 56, 50], [-1.6, -1.6, 3, 3], color=AIR, alpha=0.6)
    note(axes, "air", 53, -4)
    axes.add_patch(disc((53, 13.2), 2.0, "white"))
    note(axes, "camera", 60.5, 13.2)
    axes.fill_between((78, 102), 4.3, 7.0, color="white")
    for x in (84, 92, 112):
        axes.add_patch(disc((x, 5.65), 2.7, STEEL))
    arrow(axes, (60, 16.4), (68, 25), style.INK, connectionstyle="arc3,rad=-0.3")
    note(axes, "returned: 60 go back into the bowl", 69.5, 25, ha="left")
    note(axes, "jam: a part stands here,\nand nothing gets through", 88, -7)
    arrow(axes, (92, -4), (92, 2.6), style.INK)
    note(axes, "in", 1, -4, ha="left")
    note(axes, "out: 40, of which\n38 as wanted", 119, -7, ha="right")
    note(axes, "efficiency = 38 of 100 = 38 %     purity = 38 of 40 = 95 %", 60, -15, fontsize=9)


def disc(place, radius, colour):
    """A round thing: a camera, a bolt that hangs by its head."""
    from matplotlib.patches import Circle

    return Circle(place, radius, facecolor=colour, edgecolor=style.INK, linewidth=1.0)


PICTURES = {  # panels of each, a row of them below the other
    "glossary_part": ((aspects, headings),),
    "glossary_track": ((section, side), (drives, queue)),
    "glossary_chain": ((chain,),),
}
HEIGHTS = {"glossary_part": 2.5, "glossary_track": 5.2, "glossary_chain": 3.4}  # [in]


def picture(name):
    """Return one of the pictures as PNG."""
    figure, rows = style.figure(8.4, HEIGHTS[name]), PICTURES[name]
    for row, panels in enumerate(rows):
        for column, panel in enumerate(panels):
            panel(figure.add_subplot(len(rows), len(panels), row * len(panels) + column + 1))
    return style.png(figure)


if __name__ == "__main__":
    for name in PICTURES:
        (FOLDER / f"{name}.png").write_bytes(picture(name))
