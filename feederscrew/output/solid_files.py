"""Solids as files: binary STL, 3MF, and the section of track as STEP (OpenCASCADE, the extra ``cad``)."""

import io
import re
import tempfile
import zipfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from feederscrew.errors import FeederError, MissingPackage
from feederscrew.output import marking
from feederscrew.tooling import solid
from feederscrew.tooling.solid import triangles
from feederscrew.units import MM

BOWL_HEADER = "feeder bowl: the bowl as a solid, in mm"
HEADER_BYTES = 80  # of a binary STL
BETWEEN = 10e-3  # [m] from segment to segment
ZIP_DATE = (1980, 1, 1, 0, 0, 0)  # of each file in the archive: the same bytes twice
TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
    "</Types>\n"
)
RELATIONS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>\n'
)
MODEL = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<model unit="millimeter" xml:lang="en-US" '
    'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">\n'
)
SECTION_HEADER = "feeder tooling: track section in mm"
STEP_DATE = re.compile(rb"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'")  # in the file's head: the same bytes twice
COUNT = re.compile(rb"track section \d+")  # of the files this process wrote
NAME = "write.step.product.name", "track section"
MISSING = "pip install 'feederscrew[cad]'"


def bowl_stl(solid, mark=""):
    """Return the bowl as a binary STL in millimetres.

    Parameters
    ----------
    solid : BowlSolid
    mark : str
        In the file's head.

    Returns
    -------
    bytes
    """
    return binary_stl(solid.vertices, solid.faces, mark)


def binary_stl(vertices, faces, mark=""):
    """Return a surface (V, 3) [m], (F, 3) as the bytes of a binary STL in millimetres, a mark in its head."""
    return _binary_stl(vertices[faces], BOWL_HEADER, mark)


def _binary_stl(triangles_m, header, mark):
    """Triangles (F, 3, 3) [m] as the bytes of a binary STL [mm]."""
    corners = (triangles_m / MM).astype("<f4")
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).astype(float)
    size = np.sqrt((normal**2).sum(axis=1, keepdims=True))
    normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
    record = np.zeros(len(corners), dtype=[("numbers", "<f4", (4, 3)), ("nothing", "<u2")])
    record["numbers"][:, 0], record["numbers"][:, 1:] = normal, corners
    head = marking.marked_title(header, mark).encode("ascii").ljust(HEADER_BYTES)[:HEADER_BYTES]
    return head + np.uint32(len(corners)).tobytes() + record.tobytes()


def bowl_3mf(solid, title, mark=""):
    """Return the bowl and each gate of its own as the bytes of a 3MF file, one object each.

    Parameters
    ----------
    solid : BowlSolid
    title : str
    mark : str
        In the name of each object, which a slicer shows.

    Returns
    -------
    bytes
        In millimetres.
    """
    objects = [("bowl", solid.vertices, solid.faces), *solid.gates]
    return pack_3mf(objects, title, mark)


def segments_3mf(pieces, title, mark=""):
    """Return segments of a bowl as the bytes of a 3MF file, one object each, beside each other."""
    across = np.cumsum([0.0, *(segment.size[0] + BETWEEN for segment in pieces)])
    moved = zip(across, pieces)
    return pack_3mf(
        [(segment.name, segment.vertices + [x, 0.0, 0.0], segment.faces) for x, segment in moved], title, mark
    )


def pack_3mf(objects, title, mark=""):
    """Return objects (name, vertices (V, 3) [m], faces (F, 3)) as the bytes of a 3MF file."""
    objects = [(marking.marked_title(name, mark), *surface) for name, *surface in objects]
    model = MODEL + f'<metadata name="Title">{quoteattr(title)[1:-1]}</metadata>\n<resources>\n'
    model += "".join(_object(k + 1, *member) for k, member in enumerate(objects))
    items = "".join(f'<item objectid="{k + 1}"/>' for k in range(len(objects)))
    model += f"</resources>\n<build>{items}</build>\n</model>\n"
    contents = {"[Content_Types].xml": TYPES, "_rels/.rels": RELATIONS, "3D/3dmodel.model": model}
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        for name, text in contents.items():
            file.writestr(zipfile.ZipInfo(name, ZIP_DATE), text.encode(), zipfile.ZIP_DEFLATED)
    return archive.getvalue()


def _object(number, name, vertices, faces) -> str:
    points = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in vertices / MM)
    facets = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return (
        f'<object id="{number}" type="model" name={quoteattr(name)}><mesh>\n'
        f"<vertices>{points}</vertices>\n<triangles>{facets}</triangles>\n</mesh></object>\n"
    )


def section_stl(strip, mark=""):
    """Return the track section with its cuts, bent, as a binary STL in millimetres.

    Parameters
    ----------
    strip : TrackSection
    mark : str
        In the file's head.

    Returns
    -------
    bytes
        Closed; the wall is tangent to X at the origin, the track's surface lies in the plane Z = 0.
    """
    return _binary_stl(triangles(strip), SECTION_HEADER, mark)


def check_opencascade() -> None:
    """Raise the line that says what to install where OpenCASCADE is not here.

    Raises
    ------
    MissingPackage
    """
    try:
        import OCP.STEPControl  # noqa: F401
    except ImportError:
        raise MissingPackage("step", "needs OpenCASCADE, which is not installed", MISSING) from None


def section_step(section):
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
    check_opencascade()
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
        return COUNT.sub(b"track section", STEP_DATE.sub(b"'1970-01-01T00:00:00'", path.read_bytes()))


def _quiet() -> None:
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

    wire = BRepBuilderAPI_MakePolygon(
        *(gp_Pnt(*(float(x) for x in corner)) for corner in corners), True
    ).Wire()
    return BRepBuilderAPI_MakeFace(wire, True).Face()
