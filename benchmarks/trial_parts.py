"""Parts by which the rules of trials were not found: plain shapes, made here."""

import sys
from pathlib import Path

import numpy as np
import trimesh

sys.path.insert(0, str(Path(__file__).parent.parent / "tests/support"))
import shapes

L_SHAPE = [(0, 0), (18, 0), (18, 5), (5, 5), (5, 14), (0, 14)]
U_SHAPE = [(0, 0), (20, 0), (20, 12), (15, 12), (15, 4), (5, 4), (5, 12), (0, 12)]
T_SHAPE = [(-2.5, 0), (2.5, 0), (2.5, 10), (10, 10), (10, 15), (-10, 15), (-10, 10), (-2.5, 10)]
WEDGE = [(0, 0), (16, 0), (10, 8), (0, 8)]
Z_SHAPE = [(0, 0), (11, 0), (11, 6), (18, 6), (18, 10), (7, 10), (7, 4), (0, 4)]
HEADED = [(0, -6), (2.5, -6), (2.5, 6), (5, 6), (5, 9), (0, 9)]  # radius, height
STEPPED = [(0, -5), (5, -5), (5, 1), (3, 1), (3, 9), (0, 9)]
SECTIONS = 64  # of what is turned on a lathe

OUTLINES = {  # [mm]
    "l_18x14x10": (L_SHAPE, 10.0),
    "u_20x12x9": (U_SHAPE, 9.0),
    "t_20x15x7": (T_SHAPE, 7.0),
    "wedge_16x8x11": (WEDGE, 11.0),
    "z_18x10x6": (Z_SHAPE, 6.0),
}
BOXES = {"block_22x13x6": (22, 13, 6), "block_16x9x4": (16, 9, 4)}
TURNED = {"headed_10x15": HEADED, "stepped_10x14": STEPPED}
NAMES = (*BOXES, *OUTLINES, *TURNED, "disc_14x5")


def drawn(seed):
    """Return a part drawn by a seed: a plate with a step or a notch, a stepped prism or a turned pin."""
    rng = np.random.default_rng((24, seed))
    length, width, height = np.sort(rng.uniform([10.0, 6.0, 2.0], [24.0, 14.0, 9.0]))[::-1]
    cut, deep = rng.uniform(0.25, 0.75, 2)
    notched = [
        (0, 0), (length, 0), (length, width * deep),
        (length * cut, width * deep), (length * cut, width), (0, width),
    ]  # fmt: skip
    raised = [(0, 0), (length, 0), (length, height * deep), (length * cut, height), (0, height)]
    thick, thin = 0.5 * width, 0.5 * width * cut
    pin = [(0, 0), (thick, 0), (thick, length * deep), (thin, length * deep), (thin, length), (0, length)]
    kind = seed % 4
    if kind == 0:
        mesh = shapes.prism(notched, height)
    elif kind == 1:
        mesh = shapes.prism(raised, width)
    elif kind == 2:
        mesh = trimesh.creation.revolve(pin, sections=SECTIONS)
    else:
        mesh = shapes.box(length, width, height)
    return shapes.part(mesh, f"drawn_{seed}")


def made(name):
    """Return one of these parts, of steel."""
    if name in BOXES:
        mesh = shapes.box(*BOXES[name])
    elif name in OUTLINES:
        mesh = shapes.prism(*OUTLINES[name])
    elif name in TURNED:
        mesh = trimesh.creation.revolve(TURNED[name], sections=SECTIONS)
    else:
        mesh = shapes.cylinder(7, 5, SECTIONS)
    return shapes.part(mesh, name)
