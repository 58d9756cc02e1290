"""The section of track as a STEP file for quotations: the one door to OpenCASCADE, an extra (``cad``)."""

import re
import tempfile
from pathlib import Path

import numpy as np

from feederscrew.errors import FeederError, MissingPackage
from feederscrew.tooling import solid
from feederscrew.units import MM

WHEN = re.compile(rb"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'")  # in the file's head: the same bytes twice
COUNT = re.compile(rb"track section \d+")  # of the files this process wrote
NAME = "write.step.product.name", "track section"
MISSING = "pip install 'feederscrew[cad]'"


def check():
    """Raise the line that says what to install where OpenCASCADE is not here.

    Raises
    ------
    MissingPackage
    """
    try:
        import OCP.STEPControl  # noqa: F401
    except ImportError:
        raise MissingPackage("step", "needs OpenCASCADE, which is not installed", MISSING) from None


def step(section):
    """Return the section of track with its cuts as the bytes of a STEP file in millimetres.

    Parameters
    ----------
    section : TrackSection

    Returns
    -------
    bytes
        One solid of flat faces, as the STL has it, in the same axes.

    Raises
    ------
    MissingPackage
        If OpenCASCADE is not installed or refuses the body.
    """
    check()
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    _quiet()
    writer = STEPControl_Writer()
    (getattr(Interface_Static, "SetCVal_s", None) or Interface_Static.SetCVal)(*NAME)
    if writer.Transfer(_body(section), STEPControl_AsIs) != IFSelect_RetDone:
        raise FeederError("tooling.step", "the section of track cannot be written", "take tooling.stl")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "tooling.step"
        writer.Write(str(path))
        return COUNT.sub(b"track section", WHEN.sub(b"'1970-01-01T00:00:00'", path.read_bytes()))


def _quiet():
    """Keep what OpenCASCADE tells of each file off the terminal."""
    from OCP.Message import Message

    messenger = (getattr(Message, "DefaultMessenger_s", None) or Message.DefaultMessenger)()
    messenger.ChangePrinters().Clear()


def _body(section):
    """The solid whose triangles in one plane are one face."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
    from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
    from OCP.TopAbs import TopAbs_SHELL
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    vertices, faces = solid.solid(section)
    sewing = BRepBuilderAPI_Sewing(1e-6)
    for corners in vertices[faces] / MM:
        if np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) > 1e-9:
            sewing.Add(_face(corners))
    sewing.Perform()
    shells = TopExp_Explorer(sewing.SewedShape(), TopAbs_SHELL)
    cast = TopoDS.Shell_s if hasattr(TopoDS, "Shell_s") else TopoDS.Shell
    whole = BRepBuilderAPI_MakeSolid(cast(shells.Current())).Solid()
    merged = ShapeUpgrade_UnifySameDomain(whole, True, True, False)
    merged.Build()
    return merged.Shape()


def _face(corners):
    """One triangle [mm]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
    from OCP.gp import gp_Pnt

    wire = BRepBuilderAPI_MakePolygon(*(gp_Pnt(*(float(x) for x in one)) for one in corners), True).Wire()
    return BRepBuilderAPI_MakeFace(wire, True).Face()
