"""Bodies with exact faces, united and cut: the bowl's door to OpenCASCADE, an extra (``cad``).

Planes, cylinders and cones are exact; what runs along the track is a ruled face between two curves, each a
cubic spline through places every 0.1 rad: within 1e-4 mm of the helix for a bowl of a metre.
"""

import contextlib
import contextvars
import itertools

import numpy as np
import shapely

from feederscrew.errors import FeederError, MissingPackage
from feederscrew.geometry.vectors import product
from feederscrew.solidbowl.exact import exact_faces
from feederscrew.solidbowl.facets import in_space
from feederscrew.units import MM

HAS_EXACT_CURVES = True  # a curve is a curve
SEAM_ANGLE_RAD = 0.7  # [rad] where a face of revolution is closed: nothing else of a bowl ends there
MIN_PIECE_VOLUME_MM3 = 1.0  # [mm3] a loose piece smaller than this is left out
FUZZY_TOLERANCES_MM = (
    1e-5,
    1e-4,
    1e-6,
)  # [mm] faces and edges nearer than this meet: the first with which all goes well
BEYOND_BOWL_MM = 1e4  # [mm] beyond everything
_near = contextvars.ContextVar("near", default=FUZZY_TOLERANCES_MM[0])
MISSING = "pip install 'feederscrew[cad]'"


def check(where="step"):
    """Raise the line that says what to install where OpenCASCADE is not here.

    Raises
    ------
    MissingPackage
    """
    try:
        import OCP.STEPControl  # noqa: F401
    except ImportError:
        raise MissingPackage(where, "needs OpenCASCADE, which is not installed", MISSING) from None


@contextlib.contextmanager
def meeting(near):
    """Unite and cut bodies whose faces and edges meet within a length [mm], within a ``with``."""
    before = _near.set(near)
    try:
        yield
    finally:
        _near.reset(before)


def swept(legs):
    """Return a body whose section is handed on from frame to frame; as ``facets.swept``."""
    legs = [in_space(*leg) / MM for leg in legs]
    faces = [exact_faces.flat_face(legs[0][0][::-1]), exact_faces.flat_face(legs[-1][-1])]
    for leg in legs:
        borders = [exact_faces.spline(leg[:, k]) for k in range(leg.shape[1])]
        faces += [exact_faces.ruled(one, other) for one, other in zip(borders, [*borders[1:], borders[0]])]
    return exact_faces.closed(faces)


def turned(profile, segments):
    """Return a body of revolution about Z, of a profile (K, 2) [m]: radius and height."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol

    r, z = np.asarray(profile, float).T / MM
    face = exact_faces.flat_face(np.column_stack([r * np.cos(SEAM_ANGLE_RAD), r * np.sin(SEAM_ANGLE_RAD), z]))
    return BRepPrimAPI_MakeRevol(face, exact_faces.axis()).Shape()


def drum(radius, low, high, segments):
    """Return a cylinder about the axis."""
    return turned([(0.0, low), (radius, low), (radius, high), (0.0, high)], segments)


def disc(at, size, low, high):
    """Return a round rod upright: its middle (2,), its diameter and its two heights [m]."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir

    foot = gp_Ax2(
        exact_faces.point([at[0] / MM, at[1] / MM, low / MM]),
        gp_Dir(0, 0, 1),
        gp_Dir(*exact_faces.towards(SEAM_ANGLE_RAD)),
    )
    return BRepPrimAPI_MakeCylinder(foot, 0.5 * size / MM, (high - low) / MM).Shape()


def bore(place, towards, size, deep):
    """Return a round rod along a unit vector (3,): its near end (3,), diameter and length [m]."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir

    foot = gp_Ax2(exact_faces.point(np.asarray(place) / MM), gp_Dir(*(float(x) for x in towards)))
    return BRepPrimAPI_MakeCylinder(foot, 0.5 * size / MM, deep / MM).Shape()


def prism(area, low, high):
    """Return a body over an area [m] seen from above, between two heights [m]."""
    axes = np.eye(3)
    return plank(area, high - low, axes, [0.0, 0.0, low])


def plank(area, thickness, axes, foot):
    """Return a plate over an area [m], ``thickness`` [m] deep; columns of ``axes`` (3, 3): its axes."""
    made = []
    for one in shapely.get_parts(area):
        if one.geom_type == "Polygon":
            one = shapely.geometry.polygon.orient(one)
            rings = [np.asarray(ring.coords)[:-1] for ring in (one.exterior, *one.interiors)]
            rings = [(np.asarray(foot) + product(ring, np.asarray(axes)[:, :2].T)) / MM for ring in rings]
            wires = [exact_faces.polygon(ring) for ring in rings]
            made.append(exact_faces.drawn(wires, thickness / MM * np.asarray(axes)[:, 2]))
    return made[0] if len(made) == 1 else united(made)


def patch(ring, low, high):
    """Return a body within a closed curve through places (K, 2) [m], between two heights [m]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire

    half = len(ring) // 2
    wire = BRepBuilderAPI_MakeWire()
    for places in (ring[: half + 1], np.vstack([ring[half:], ring[:1]])):
        level = np.column_stack([places, np.full(len(places), low)])
        wire.Add(exact_faces.edge(level / MM))
    return exact_faces.drawn([wire.Wire()], [0.0, 0.0, (high - low) / MM])


def over(way, ring, low, high, chord):
    """Return a body over a ring (K, 2) [m] of lengths and distances along a way, between two heights [m]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire

    wire = BRepBuilderAPI_MakeWire()
    for a, b in zip(ring, np.roll(ring, -1, axis=0)):
        for one, other in itertools.pairwise(exact_faces.broken(a, b, way.end)):
            if np.abs(one - other).max() > 1e-9:
                wire.Add(exact_faces.side(way, one, other, low / MM))
    return exact_faces.drawn([wire.Wire()], [0.0, 0.0, (high - low) / MM])


def united(bodies):
    """Return the union of bodies, one after the other."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse

    whole, *others = bodies
    for other in others:
        whole = _combined(BRepAlgoAPI_Fuse, whole, [other])
    return whole


def without(body, tools):
    """Return a body with others cut out of it."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut

    return _combined(BRepAlgoAPI_Cut, body, tools) if tools else body


def above(body, height):
    """Return what of a body lies above a height [m]."""
    below = shapely.box(*(BEYOND_BOWL_MM * MM * np.array([-1.0, -1.0, 1.0, 1.0])))
    return without(body, [prism(below, -BEYOND_BOWL_MM * MM, height)])


def placed_as(body, *, mirrored, turned):
    """Return a body mirrored at the XZ plane or not, then turned about Z by an angle [rad]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Ax2, gp_Dir, gp_Trsf

    turn, flip = gp_Trsf(), gp_Trsf()
    turn.SetRotation(exact_faces.axis(), float(turned))
    if mirrored:
        flip.SetMirror(gp_Ax2(exact_faces.point([0, 0, 0]), gp_Dir(0, 1, 0)))
    return BRepBuilderAPI_Transform(body, turn.Multiplied(flip), True).Shape()


def one_piece(body, where):
    """Return the one piece of a body; as ``facets.one_piece``."""
    from OCP.TopAbs import TopAbs_SOLID

    pieces = sorted(exact_faces.parts(body, TopAbs_SOLID), key=lambda one: -exact_faces.volume(one))
    if not pieces or any(exact_faces.volume(one) > MIN_PIECE_VOLUME_MM3 for one in pieces[1:]):
        raise FeederError(where, f"OpenCASCADE finds {len(pieces)} bodies", "take bowl.stl")
    return pieces[0]


def _combined(kind, body, tools):
    from OCP.OCP.collections import List_TopoDS_Shape

    made, lists = kind(), (List_TopoDS_Shape(), List_TopoDS_Shape())
    lists[0].Append(body)
    for one in tools:
        lists[1].Append(one)
    made.SetArguments(lists[0])
    made.SetTools(lists[1])
    made.SetUseOBB(True)  # a face along a helix fills little of a box along the axes
    made.SetFuzzyValue(_near.get())  # where two splines along one helix meet, which else ends nowhere
    made.Build()
    return made.Shape()
