"""A bowl as a STEP file: written, opened again and measured."""

import contextlib
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.heavy import heavy
from feederscrew.solidbowl.closed_body import pieces
from feederscrew.solidbowl.exact import exact_body
from feederscrew.units import MM

IFSelect = heavy("OCP.IFSelect")
Interface = heavy("OCP.Interface")
Message = heavy("OCP.Message")
STEPControl = heavy("OCP.STEPControl")
TopAbs = heavy("OCP.TopAbs")

STEP_TIMESTAMP = re.compile(rb"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'")  # in the file's head: the same bytes twice
STEP_NAME_SETTING = "write.step.product.name"
STEP_HEIGHT_SAMPLES = 24  # along the track at which the height of the opened file is measured
STEP_VOLUME_TOLERANCE = 3e-3  # of the volume of the facets, which lie within the chord of the arcs


@dataclass(frozen=True, eq=False)
class StepFile:
    """A bowl as STEP, and what it was found to be when it was opened again."""

    data: bytes
    volume: float  # [m3]
    faces: dict[str, int]  # how many are planes, cylinders, cones, ruled, others
    off: float  # [m] the most by which the track's height differs from the formula


def step_file(solid) -> StepFile:
    """Return a bowl as a STEP file with exact faces.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    StepFile

    Raises
    ------
    FeederError
        If OpenCASCADE is not installed, or what it makes is not the bowl of the facets.
    """
    exact_body.check()
    *rest, last = exact_body.FUZZY_TOLERANCES_MM
    for near in rest:
        with contextlib.suppress(FeederError), exact_body.meeting(near):
            return _tried(solid)
    with exact_body.meeting(last):
        return _tried(solid)


def _tried(solid) -> StepFile:
    """A bowl as a STEP file, or the fault of what came out of it."""
    plan = solid.plan
    whole, gates = pieces(plan, exact_body)
    bodies = [whole, *(gate for _, gate in gates)]
    placed = [exact_body.placed_as(body, mirrored=plan.left, turned=plan.turned) for body in bodies]
    data = step_bytes(placed, "bowl")
    opened = _opened(data)
    sizes = [exact_body.volume(item) * MM**3 for item in opened]
    if len(opened) != len(bodies) or not all(exact_body.valid(item) for item in opened):
        raise _refused(f"finds {len(opened)} bodies, or one that is not closed")
    if abs(sizes[0] / solid.volume - 1.0) > STEP_VOLUME_TOLERANCE:
        raise _refused(f"makes a bowl of {sizes[0] / MM**3:.6g} mm3, not {solid.volume / MM**3:.6g}")
    return StepFile(data, sizes[0], exact_body.kinds(opened[0]), _off(plan, opened[0]))


def _refused(what) -> FeederError:
    return FeederError("bowl.step", f"OpenCASCADE {what}", "take bowl.stl or bowl.3mf")


def step_bytes(bodies, name) -> bytes:
    """Return bodies of OpenCASCADE [mm] as the bytes of a STEP file without a date, of products of a name.

    Raises
    ------
    FeederError
        If OpenCASCADE does not take one of them.
    """

    messenger = (getattr(Message.Message, "DefaultMessenger_s", None) or Message.Message.DefaultMessenger)()
    messenger.ChangePrinters().Clear()  # what it tells of each file stays off the terminal
    writer = STEPControl.STEPControl_Writer()
    (getattr(Interface.Interface_Static, "SetCVal_s", None) or Interface.Interface_Static.SetCVal)(
        STEP_NAME_SETTING, name
    )
    if any(
        writer.Transfer(body, STEPControl.STEPControl_AsIs) != IFSelect.IFSelect_RetDone for body in bodies
    ):
        raise _refused("cannot write it")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "body.step"
        writer.Write(str(path))
        text = STEP_TIMESTAMP.sub(b"'1970-01-01T00:00:00'", path.read_bytes())
    return re.sub(rf"'{name} \d+'".encode(), f"'{name}'".encode(), text)  # it counts the files it wrote


def _opened(data):

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bowl.step"
        path.write_bytes(data)
        reader = STEPControl.STEPControl_Reader()
        reader.ReadFile(str(path))
        reader.TransferRoots()
        return exact_body.parts(reader.OneShape(), TopAbs.TopAbs_SOLID)


def _off(plan, body) -> float:
    """How far [m] the track's height lies off the formula, where no device is."""
    body = exact_body.placed_as(body, mirrored=False, turned=-plan.turned)
    body = exact_body.placed_as(body, mirrored=plan.left, turned=0.0)
    last = plan.first if plan.stretch is not None else plan.path.end
    off = []
    for k in range(STEP_HEIGHT_SAMPLES):
        s, y = last * (k + 1.0) / (STEP_HEIGHT_SAMPLES + 2.0), plan.width * (0.1 + 0.8 * (k * 0.618 % 1.0))
        place = plan.path.places(s, y)
        below = exact_body.below(body, (place + [0.0, 0.0, 0.5 * plan.headroom]) / MM)
        off.append(np.inf if below is None else abs(below * MM - place[2]))
    return float(max(off))
