"""A sample's shape as a file: STL of its mesh, STEP of its exact faces."""

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.base.errors import FeederError
from feederscrew.base.units import MM
from feederscrew.cad import facets
from feederscrew.cad.exact import exact_body, exact_file
from feederscrew.jobs.samples.families import SampleShape
from feederscrew.output.solid_files import binary_stl

WELD_MM = 1e-6  # corners nearer than this are one: a bevel meets the edges of a hexagon in its own corners
STEP_TOLERANCE = 1e-2  # [1] of the volume of the mesh, whose chords lie within the circles


def triangles(shape: SampleShape) -> Floats:
    """Return the facets of a sample's mesh.

    Parameters
    ----------
    shape : SampleShape

    Returns
    -------
    (F, 3, 3) float [m]
        Corners by facet, counter-clockwise seen from outside, rounded to multiples of ``WELD_MM``.
    """
    mesh = shape.build(facets).to_mesh64()
    corners = np.asarray(mesh.vert_properties)[:, :3]
    places, joined = np.unique(np.round(corners / WELD_MM).astype(np.int64), axis=0, return_inverse=True)
    faces = joined.reshape(-1)[np.asarray(mesh.tri_verts).astype(int)]
    a, b, c = faces.T
    return MM * WELD_MM * places[faces[(a != b) & (b != c) & (c != a)]]


def stl(shape: SampleShape) -> bytes:
    """Return a sample as binary STL.

    Parameters
    ----------
    shape : SampleShape

    Returns
    -------
    bytes
        With lengths in mm.
    """
    return binary_stl(triangles(shape), f"feeder sample: {shape.name}, in mm")


def step(shape: SampleShape) -> bytes:
    """Return a sample as STEP, with planes, cylinders and cones.

    Parameters
    ----------
    shape : SampleShape

    Returns
    -------
    bytes
        With lengths in mm.

    Raises
    ------
    MissingPackage
        If OpenCASCADE is not installed.
    FeederError
        If the part that OpenCASCADE makes has another volume than the mesh, by more than ``STEP_TOLERANCE``.
    """
    exact_body.check()
    corners = triangles(shape) / MM
    expected = float(np.einsum("fk,fk->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum()) / 6.0
    body = exact_body.one_piece(shape.build(exact_body), shape.name)
    volume = exact_body.volume(body)
    if not exact_body.valid(body) or abs(volume / expected - 1.0) > STEP_TOLERANCE:
        what = f"OpenCASCADE makes a part of {volume:.6g} mm3, not {expected:.6g}"
        raise FeederError(f"{shape.name}.step", what, "take the STL")
    return exact_file.step_bytes([body], shape.name)
