"""The T shape of chapter 3 as a solid.

Its drawing, Figure 3-3, is lost; its dimensions follow from Table 3-8.
"""

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors

WIDTH = 25.0e-3  # [m] over the head
HEIGHT = 25.0e-3  # [m]
HEAD = 13.0e-3  # [m] height of the head
STEM = 11.0e-3  # [m] width of the stem
DENSITY = 1000.0  # [kg/m3] 1.000e-3 g/mm3: gives Table 3-8
DENSITY_IN_TEXT = 999.0  # [kg/m3] "9.99 E-4 grams per cubic meter", read as g/mm3: does not give it
RATIOS = ("0.4", "0.6", "0.8", "1.0", "1.2", "1.4")  # thickness / width, as printed

_LEAN = np.array([HEIGHT - HEAD, -0.5 * (WIDTH - STEM), 0.0])
ASPECTS = {  # outward normal of the side it lies on; of two equal sides, one
    "A": (0.0, -1.0, 0.0),  # on the end of the stem
    "B": (1.0, 0.0, 0.0),  # on a side of the head
    "C": (0.0, 1.0, 0.0),  # upside down, on the head
    "D": tuple(vectors.unit(_LEAN)),  # leaning on head and stem: no face of the part
    "E": (0.0, 0.0, 1.0),  # flat, on the T
}


def solid(ratio):
    """Return the surface of the T shape.

    Parameters
    ----------
    ratio : float [1]
        Thickness over width.

    Returns
    -------
    vertices : (16, 3) float [m]
        x across the head, y from stem to head, z through the thickness; the middle of the stem's end
        is the origin.
    faces : (28, 3) int
        Counter-clockwise seen from outside.
    """
    half = 0.5 * WIDTH * check.positive("ratio", ratio)
    s, w, shoulder = 0.5 * STEM, 0.5 * WIDTH, HEIGHT - HEAD
    outline = [
        (-s, 0),
        (s, 0),
        (s, shoulder),
        (w, shoulder),
        (w, HEIGHT),
        (-w, HEIGHT),
        (-w, shoulder),
        (-s, shoulder),
    ]
    top = [(0, 1, 2), (0, 2, 7), (2, 3, 4), (2, 4, 5), (2, 5, 7), (5, 6, 7)]
    bottom = [(a + 8, c + 8, b + 8) for a, b, c in top]
    around = [(k, (k + 1) % 8) for k in range(8)]
    sides = [face for a, b in around for face in ((a, a + 8, b), (b, a + 8, b + 8))]
    vertices = np.array([(x, y, z) for z in (half, -half) for x, y in outline])
    return vertices, np.array(top + bottom + sides)
