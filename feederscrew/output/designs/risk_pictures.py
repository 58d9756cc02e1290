"""Two parts that shingle, hook or nest, and a part that wedges between two walls, as pictures."""

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.output import style
from feederscrew.output.solid import pair as rendered
from feederscrew.output.solid.render import Camera

WIDTH, HEIGHT, CAPTION, EDGE = 460, 300, 34, 12  # pixels
ROOM = 1.15  # times what is drawn reaches
THIN, OVER = 0.05, 0.3  # of a part's size: how thick walls are drawn; how far they go on
VIEWS = {"shingles": (-0.25, -1.0, 0.25), "wedges": (-0.45, -0.35, 1.0)}  # from where, along, across and up
VIEW = -0.6, -0.7, 0.5
BOX = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
     (0, 6, 4), (1, 5, 7), (1, 7, 3)]
)  # fmt: skip


def drawn(part, risk):
    """Draw the pair of a risk.

    Parameters
    ----------
    part : Part
        From a mesh.
    risk : Risk
        With a pair.

    Returns
    -------
    Figure
    """
    first, second = bodies(part, risk.pair)
    everything = np.vstack([first[0], second[0]])
    centre = 0.5 * (everything.min(axis=0) + everything.max(axis=0))
    camera = camera_from(np.array(VIEWS.get(risk.kind, VIEW)))
    reach = np.abs(camera.project(everything - centre)).max(axis=0)
    half = ROOM * max(reach[0], reach[1] * WIDTH / HEIGHT)
    image, _, _ = rendered.picture(second, first, centre, camera, half, WIDTH, HEIGHT)
    figure = style.page(WIDTH + 2 * EDGE, HEIGHT + CAPTION + 2 * EDGE)
    high, wide = HEIGHT + CAPTION + 2.0 * EDGE, WIDTH + 2.0 * EDGE
    axes = figure.add_axes((EDGE / wide, EDGE / high, WIDTH / wide, HEIGHT / high), xticks=[], yticks=[])
    axes.spines[:].set_color(style.FAINT)
    axes.imshow(image, interpolation="nearest")
    place = EDGE / wide, 1.0 - (EDGE + 16.0) / high
    figure.text(*place, f"{risk.kind}: {part.name}", fontsize=9, fontweight="bold", color=style.INK)
    return figure


def bodies(part, pair):
    """Return the part and what it may be caught by, each as ((V, 3) float [m], (F, 3) int), in its axes."""
    points = part.vertices - part.centre_of_mass
    first = vectors.product(points, pair.axes.T)
    if pair.turn is not None:
        moved = vectors.product(points, pair.turn.T) + pair.place
        return (first, part.faces), (vectors.product(moved, pair.axes.T), part.faces)
    least, most = first.min(axis=0), first.max(axis=0)
    size = (most - least).max()
    middle, low = 0.5 * (least + most), least - OVER * size
    long = np.array([most[0] - least[0] + 2.0 * OVER * size, THIN * size, 0.6 * (most[2] - least[2])])
    walls = []
    for y in (middle[1] - 0.5 * pair.walls - THIN * size, middle[1] + 0.5 * pair.walls):
        walls.append(BOX * long + np.array([low[0], y, least[2]]))
    return (first, part.faces), (np.vstack(walls), np.vstack([SIDES, SIDES + len(BOX)]))


def camera_from(place):
    """Return the view from a place (3,) [1] of which the third number is up."""
    back = vectors.unit(place)
    right = vectors.unit(np.cross((0.0, 0.0, 1.0), back))
    return Camera(right=right, up=np.cross(back, right), back=back)
