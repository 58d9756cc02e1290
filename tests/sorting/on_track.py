"""Parts as they lie on a track and devices as a bowl file has them, for the tests of tooling."""

import functools
from pathlib import Path

import numpy as np
import shapes

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.record import Track
from feederscrew.part.record import Part
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import add_travel, orientations

PARTS = Path(__file__).resolve().parents[2] / "parts"
LEVEL = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)  # as good as straight
WIDE = bowls.read(None, ["track.width=30 mm"])


@functools.cache
def load(name):
    """A part of parts/ by the name of its file."""
    return parts.load(PARTS / f"{name}.stl")


@functools.cache
def block(length=20, width=12, height=5):
    """A block of steel of three sides [mm]."""
    return shapes.part(shapes.box(length, width, height))


def lying(body, track=LEVEL):
    """Orientations of a part, or of a mesh [mm] in steel, at rest on a track."""
    part = body if isinstance(body, Part) else shapes.part(body)
    return orientations(part, find(part), track)


def coming(body, bowl=WIDE):
    """Orientations of a part or mesh as they travel on the track of a bowl."""
    return add_travel(lying(body, bowl.track), bowl)


def pick(every, length=None, height=None):
    """The first orientation of a length and a height [mm]."""
    sizes = {"length": length, "height": height}
    wanted = {name: 1e-3 * size for name, size in sizes.items() if size is not None}
    return next(k for k in every if all(np.isclose(getattr(k, n), v, rtol=1e-3) for n, v in wanted.items()))


def named(every, *names):
    """The orientations of these names; of one name, that one."""
    by_name = {one.name: one for one in every}
    return by_name[names[0]] if len(names) == 1 else [by_name[name] for name in names]


def read(folder, *lines, track="", settings=()):
    """The bowl of a file with these lines under its devices, and a line of its track."""
    path = folder / "bowl.yaml"
    head = f"track: {track}\n" if track else ""
    path.write_text(f"{head}devices:\n" + "".join(f"  - {one}\n" for one in lines))
    return bowls.read(path, settings)


def device(kind, **values):
    """A device of a kind that no file names."""
    return make_device(kind, "test", **values)


def slanted(kind, degrees, text=""):
    """A bank, groove or spacing section at an angle, with the text of its value in a file."""
    return make_device(kind, "test", angle=np.radians(degrees), **({"text": text} if text else {}))
