"""STEP files with exact faces: a bowl, written, opened again and measured; and a section of its track."""

import contextlib
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from feederscrew.base.errors import FeederError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.cad.closed_body import BowlSolid, pieces
from feederscrew.cad.exact import exact_body
from feederscrew.cad.facets import Body
from feederscrew.cad.section import section_body, solid
from feederscrew.sorting.tooled_track import TooledTrack

IFSelect = heavy("OCP.IFSelect")
Interface = heavy("OCP.Interface")
Message = heavy("OCP.Message")
STEPControl = heavy("OCP.STEPControl")
TopAbs = heavy("OCP.TopAbs")

STEP_TIMESTAMP = re.compile(rb"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'")  # in the file's head: the same bytes twice
STEP_NAME_SETTING = "write.step.product.name"
STEP_HEIGHT_SAMPLES = 24  # along the track at which the height of the opened file is measured
STEP_VOLUME_TOLERANCE = 3e-3  # of the volume of the facets, which lie within the chord of the arcs
SECTION_VOLUME_TOLERANCE = 2e-3  # [1] of the volume of the facets, whose chords lie within the arcs


@dataclass(frozen=True, eq=False)
class StepFile:
    """A bowl as STEP, and what it was found to be when it was opened again."""

    data: bytes
    volume: float  # [m3]
    faces: dict[str, int]  # how many are planes, cylinders, cones, ruled, others
    off: float  # [m] the most by which the track's height differs from the formula


def step_file(bowl: BowlSolid) -> StepFile:
    """Return a bowl as a STEP file with exact faces.

    Parameters
    ----------
    bowl : BowlSolid

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
            return _tried(bowl)
    with exact_body.meeting(last):
        return _tried(bowl)


def _tried(bowl: BowlSolid) -> StepFile:
    """A bowl as a STEP file, opened again and measured, or the fault of what came out of it."""
    plan = bowl.plan
    whole, gates = pieces(plan, exact_body)
    bodies = [whole, *(gate for _, gate in gates)]
    placed = [exact_body.placed_as(body, mirrored=plan.left, turned=plan.turned) for body in bodies]
    data = step_bytes(placed, "bowl")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bowl.step"
        path.write_bytes(data)
        reader = STEPControl.STEPControl_Reader()
        reader.ReadFile(str(path))
        reader.TransferRoots()
        opened = exact_body.parts(reader.OneShape(), TopAbs.TopAbs_SOLID)
    sizes = [exact_body.volume(item) * MM**3 for item in opened]
    if len(opened) != len(bodies) or not all(exact_body.valid(item) for item in opened):
        raise _refused(f"finds {len(opened)} bodies, or one that is not closed")
    if abs(sizes[0] / bowl.volume - 1.0) > STEP_VOLUME_TOLERANCE:
        raise _refused(f"makes a bowl of {sizes[0] / MM**3:.6g} mm3, not {bowl.volume / MM**3:.6g}")
    # the track's height where no device is, with the outlet at the angle 0 again
    body = exact_body.placed_as(opened[0], mirrored=False, turned=-plan.turned)
    body = exact_body.placed_as(body, mirrored=plan.left, turned=0.0)
    last = plan.first if plan.stretch is not None else plan.path.end
    off = []
    for k in range(STEP_HEIGHT_SAMPLES):
        s, y = last * (k + 1.0) / (STEP_HEIGHT_SAMPLES + 2.0), plan.width * (0.1 + 0.8 * (k * 0.618 % 1.0))
        place = plan.path.places(s, y)
        below = exact_body.below(body, (place + [0.0, 0.0, 0.5 * plan.headroom]) / MM)
        off.append(np.inf if below is None else abs(below * MM - place[2]))
    return StepFile(data, sizes[0], exact_body.kinds(opened[0]), float(max(off)))


def _refused(what: str) -> FeederError:
    return FeederError("bowl.step", f"OpenCASCADE {what}", "take bowl.stl or bowl.3mf")


def step_bytes(bodies: list[Body], name: str) -> bytes:
    """Return bodies of OpenCASCADE as the bytes of a STEP file, the same in every run.

    The file has no date, and its products have no running number.

    Parameters
    ----------
    bodies : list of Body [mm]
    name : str
        Of the products.

    Returns
    -------
    bytes

    Raises
    ------
    FeederError
        If OpenCASCADE does not take one of them.
    """
    messenger = (getattr(Message.Message, "DefaultMessenger_s", None) or Message.Message.DefaultMessenger)()
    messenger.ChangePrinters().Clear()  # what it tells of each file stays off the terminal
    writer, static = STEPControl.STEPControl_Writer(), Interface.Interface_Static
    (getattr(static, "SetCVal_s", None) or static.SetCVal)(STEP_NAME_SETTING, name)
    as_is, done = STEPControl.STEPControl_AsIs, IFSelect.IFSelect_RetDone
    if any(writer.Transfer(body, as_is) != done for body in bodies):
        raise _refused("cannot write it")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "body.step"
        writer.Write(str(path))
        text = STEP_TIMESTAMP.sub(b"'1970-01-01T00:00:00'", path.read_bytes())
    return re.sub(rf"'{name} \d+'".encode(), f"'{name}'".encode(), text)  # it counts the files it wrote


def section_file(section: TooledTrack) -> bytes:
    """Return the section of track with its cuts as a STEP file in millimetres.

    It is one solid: the wall is tangent to X at the origin.

    Parameters
    ----------
    section : TooledTrack

    Returns
    -------
    bytes

    Raises
    ------
    MissingPackage
        If OpenCASCADE is not installed.
    FeederError
        If what it makes is not the section of the facets.
    """
    return step_bytes([exact_section(section)], "track section")


def exact_section(section: TooledTrack) -> Body:
    """Return the section of track with its cuts as one exact body, of the volume of its facets.

    OpenCASCADE loses pieces of some unions: faces that nearly meet are taken as one within the first of
    ``FUZZY_TOLERANCES_MM`` that loses none.

    Parameters
    ----------
    section : TooledTrack

    Returns
    -------
    Body [mm]

    Raises
    ------
    MissingPackage
        If OpenCASCADE is not installed.
    FeederError
        If what it makes is not the section of the facets.
    """
    exact_body.check()
    vertices, faces = solid(section)
    a, b, c = np.moveaxis(vertices[faces] / MM, 1, 0)
    facets = float(np.einsum("fk,fk->f", a, np.cross(b, c)).sum()) / 6.0
    refused = FeederError("tooling.step", "OpenCASCADE makes no section", "take tooling.stl")
    for near in exact_body.FUZZY_TOLERANCES_MM:
        try:
            with exact_body.meeting(near):
                body = exact_body.one_piece(section_body(section, exact_body), "tooling.step")
        except FeederError as fault:
            refused = FeederError("tooling.step", fault.what, "take tooling.stl")
            continue
        size = exact_body.volume(body)
        if exact_body.valid(body) and abs(size / facets - 1.0) <= SECTION_VOLUME_TOLERANCE:
            return body
        what = f"OpenCASCADE makes a section of {size:.6g} mm3, not {facets:.6g}"
        refused = FeederError("tooling.step", what, "take tooling.stl")
    raise refused
