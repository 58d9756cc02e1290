"""The stretch of track to print, as a binary STL in millimetres."""

import numpy as np

from feederscrew.output import marking
from feederscrew.tooling.solid import triangles
from feederscrew.units import MM

HEADER = "feeder tooling: track section in mm"
HEADER_BYTES = 80  # of a binary STL


def stl(strip, mark=""):
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
    return _binary(triangles(strip), mark)


def _binary(corners, mark):
    """The bytes of an STL file [mm]."""
    corners = (corners / MM).astype("<f4")
    sides = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(*sides).astype(float)
    size = np.sqrt((normal**2).sum(axis=1, keepdims=True))
    normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
    record = np.zeros(len(corners), dtype=[("numbers", "<f4", (4, 3)), ("nothing", "<u2")])
    record["numbers"][:, 0], record["numbers"][:, 1:] = normal, corners
    head = marking.marked_title(HEADER, mark).encode("ascii").ljust(HEADER_BYTES)[:HEADER_BYTES]
    return head + np.uint32(len(corners)).tobytes() + record.tobytes()
