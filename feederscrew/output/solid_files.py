"""Solids as files: binary STL and 3MF."""

import io
import zipfile
from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from feederscrew.base.arrays import Floats, Points, Triangles
from feederscrew.base.units import MM
from feederscrew.cad.closed_body import BowlSolid
from feederscrew.cad.section import triangles
from feederscrew.cad.segments import Segment
from feederscrew.output import marking
from feederscrew.sorting.tooled_track import TooledTrack

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


def bowl_stl(solid: BowlSolid | Segment, mark: str = "") -> bytes:
    """Return a bowl as a solid, or a segment of one, as binary STL in mm.

    Parameters
    ----------
    solid : BowlSolid or Segment
    mark : str, optional
        In the file's head.

    Returns
    -------
    bytes
    """
    return binary_stl(solid.vertices[solid.faces], "feeder bowl: the bowl as a solid, in mm", mark)


def section_stl(strip: TooledTrack, mark: str = "") -> bytes:
    """Return a track section, bent, as binary STL in mm: wall tangent to X at the origin, track in Z = 0.

    Parameters
    ----------
    strip : TooledTrack
    mark : str, optional
        In the file's head.

    Returns
    -------
    bytes
    """
    return binary_stl(triangles(strip), "feeder tooling: track section in mm", mark)


def binary_stl(facets: Floats, header: str, mark: str = "") -> bytes:
    """Return facets as a binary STL in mm.

    Parameters
    ----------
    facets : (F, 3, 3) float [m]
        Corners by facet, counter-clockwise seen from outside.
    header : str
        Of ASCII.
    mark : str, optional
        In the file's head, behind the header.

    Returns
    -------
    bytes
    """
    corners = (facets / MM).astype("<f4")
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).astype(float)
    size = np.sqrt((normal**2).sum(axis=1, keepdims=True))
    normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
    record = np.zeros(len(corners), dtype=[("numbers", "<f4", (4, 3)), ("nothing", "<u2")])
    record["numbers"][:, 0], record["numbers"][:, 1:] = normal, corners
    head = marking.marked_title(header, mark).encode("ascii").ljust(80)[:80]
    return head + np.uint32(len(corners)).tobytes() + record.tobytes()


def bowl_3mf(solid: BowlSolid, title: str, mark: str = "") -> bytes:
    """Return a bowl as a solid and each gate of its own as a 3MF file in mm.

    Parameters
    ----------
    solid : BowlSolid
    title : str
    mark : str, optional
        In each name.

    Returns
    -------
    bytes
    """
    objects = [("bowl", solid.vertices, solid.faces), *solid.gates]
    return _pack_3mf(objects, title, mark)


def segments_3mf(pieces: Sequence[Segment], title: str, mark: str = "") -> bytes:
    """Return segments of a bowl as a 3MF file in mm, one object each, beside each other.

    Parameters
    ----------
    pieces : sequence of Segment
    title : str
    mark : str, optional
        In each name.

    Returns
    -------
    bytes
    """
    across = np.cumsum([0.0, *(piece.size[0] + 10e-3 for piece in pieces)])
    moved = [(p.name, p.vertices + [x, 0.0, 0.0], p.faces) for x, p in zip(across, pieces)]
    return _pack_3mf(moved, title, mark)


def _pack_3mf(objects: Sequence[tuple[str, Points, Triangles]], title: str, mark: str = "") -> bytes:
    """Return objects (name, vertices (V, 3) [m], faces (F, 3)) as the bytes of a 3MF file."""
    model = MODEL + f'<metadata name="Title">{quoteattr(title)[1:-1]}</metadata>\n<resources>\n'
    for number, (name, vertices, faces) in enumerate(objects, start=1):
        points = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in vertices / MM)
        facets = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
        model += (
            f'<object id="{number}" type="model" name={quoteattr(marking.marked_title(name, mark))}><mesh>\n'
            f"<vertices>{points}</vertices>\n<triangles>{facets}</triangles>\n</mesh></object>\n"
        )
    items = "".join(f'<item objectid="{k + 1}"/>' for k in range(len(objects)))
    model += f"</resources>\n<build>{items}</build>\n</model>\n"
    contents = {"[Content_Types].xml": TYPES, "_rels/.rels": RELATIONS, "3D/3dmodel.model": model}
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        for name, text in contents.items():
            dated = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))  # the same bytes twice
            file.writestr(dated, text.encode(), zipfile.ZIP_DEFLATED)
    return archive.getvalue()
