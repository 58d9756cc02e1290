"""Points, edges and faces of OpenCASCADE, from arrays [mm]."""

import numpy as np
from scipy.interpolate import make_interp_spline

from feederscrew.units import MM

SEWN = 1e-5  # [mm] edges nearer than this are one
CURVE_STEP_RAD = 0.05  # [rad] of a curve between two places that it is led through
EPS = 1e-6  # of a volume


def axis():
    """Return the Z axis."""
    from OCP.gp import gp_Ax1, gp_Dir

    return gp_Ax1(point([0, 0, 0]), gp_Dir(0, 0, 1))


def towards(angle):
    """Return the level unit vector (3,) at an angle [rad]."""
    return float(np.cos(angle)), float(np.sin(angle)), 0.0


def point(place):
    """Return a place (3,) [mm]."""
    from OCP.gp import gp_Pnt

    return gp_Pnt(*(float(x) for x in place))


def cast(kind, shape):
    """Return a shape as what it is: 'Face', 'Wire', 'Shell'."""
    from OCP.TopoDS import TopoDS

    return (getattr(TopoDS, f"{kind}_s", None) or getattr(TopoDS, kind))(shape)


def parts(body, kind):
    """Return the parts of a kind that a body has, a list."""
    from OCP.TopExp import TopExp_Explorer

    found, walk = [], TopExp_Explorer(body, kind)
    while walk.More():
        found.append(walk.Current())
        walk.Next()
    return found


def polygon(corners):
    """Return the closed outline through corners (K, 3) [mm]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakePolygon

    wire = BRepBuilderAPI_MakePolygon()
    for one in corners:
        wire.Add(point(one))
    wire.Close()
    return wire.Wire()


def flat_face(corners):
    """Return the flat face within corners (K, 3) [mm]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    return BRepBuilderAPI_MakeFace(polygon(corners), True).Face()


def drawn(wires, along):
    """Return the body that a flat outline, holes after it, leaves along a vector (3,) [mm]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.gp import gp_Vec

    face = BRepBuilderAPI_MakeFace(wires[0], True)
    for hole in wires[1:]:
        face.Add(hole)
    return outwards(BRepPrimAPI_MakePrism(face.Face(), gp_Vec(*(float(x) for x in along))).Shape())


def outwards(body):
    """Return a body, turned inside out where its volume is negative."""
    return body if volume(body) > 0.0 else body.Reversed()


def broken(one, other, end):
    """Return both ends of a side of a ring, and the place between them where the way becomes straight."""
    low, high = sorted((one[0], other[0]))
    if not low < end < high:
        return [one, other]
    return [one, one + (other - one) * (end - one[0]) / (other[0] - one[0]), other]


def side(way, one, other, z):
    """Return a side of a ring as an edge: a straight line, an arc of a circle, or else a spline."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.GC import GC_MakeArcOfCircle

    straight = min(one[0], other[0]) >= way.end - 1e-12 or abs(one[0] - other[0]) < 1e-9
    if straight:
        ends = way.plan(*np.array([one, other]).T) / MM
        return BRepBuilderAPI_MakeEdge(*(point([*place, z]) for place in ends)).Edge()
    count = max(int(abs(other[0] - one[0]) / way.radius / CURVE_STEP_RAD), 3) + 1
    ends = np.cos(way.bank_at(np.linspace(one[0], other[0], count)))
    arc = abs(one[1] - other[1]) < 1e-9 and way.flare == 0.0 and np.ptp(ends) * abs(one[1]) < 1e-12
    s, y = np.linspace(one, other, 3 if arc else count).T
    places = [[*place, z] for place in way.plan(s, y) / MM]
    if arc:
        return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(*map(point, places)).Value()).Edge()
    return edge(np.array(places))


def edge(places):
    """Return a spline through places (M, 3) [mm] as an edge."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge

    return BRepBuilderAPI_MakeEdge(curve(*spline(places))).Edge()


def spline(places):
    """Return poles (N, 3), knots, multiplicities and degree of a spline through places (M, 3)."""
    degree = min(3, len(places) - 1)
    found = make_interp_spline(np.linspace(0.0, 1.0, len(places)), places, k=degree)
    knots, often = np.unique(found.t, return_counts=True)
    return found.c, knots, often, degree


def curve(poles, knots, often, degree):
    """Return the curve of a spline."""
    from OCP.Geom import Geom_BSplineCurve

    return Geom_BSplineCurve(row("gp_Pnt", map(point, poles)), row("double", knots.tolist()),
                             row("int", often.tolist()), degree)  # fmt: skip


def ruled(one, other):
    """Return the face between two splines of the same knots."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.Geom import Geom_BSplineSurface
    from OCP.OCP.collections import Array2_gp_Pnt

    (poles, knots, often, degree), others = one, other[0]
    grid = Array2_gp_Pnt(1, len(poles), 1, 2)
    for k, pair in enumerate(zip(poles, others), start=1):
        for column, place in enumerate(pair, start=1):
            grid.SetValue(k, column, point(place))
    ends = row("double", [0.0, 1.0]), row("int", [2, 2])
    surface = Geom_BSplineSurface(grid, row("double", knots.tolist()), ends[0],
                                  row("int", often.tolist()), ends[1], degree, 1)  # fmt: skip
    return BRepBuilderAPI_MakeFace(surface, SEWN).Face()


def row(kind, values):
    """Return values as the kernel's array of 'double', 'int' or 'gp_Pnt'."""
    from OCP.OCP import collections

    values = list(values)
    found = getattr(collections, f"Array1_{kind}")(1, len(values))
    for k, one in enumerate(values, start=1):
        found.SetValue(k, one)
    return found


def closed(faces):
    """Return the solid within faces."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
    from OCP.TopAbs import TopAbs_SHELL

    sewing = BRepBuilderAPI_Sewing(SEWN)
    for one in faces:
        sewing.Add(one)
    sewing.Perform()
    shell = parts(sewing.SewedShape(), TopAbs_SHELL)[0]
    return outwards(BRepBuilderAPI_MakeSolid(cast("Shell", shell)).Solid())


def volume(body):
    """Return the volume [mm3] of a body."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    found = GProp_GProps()
    (getattr(BRepGProp, "VolumeProperties_s", None) or BRepGProp.VolumeProperties)(
        body, found, EPS, False, False
    )
    return float(found.Mass())


def kinds(body):
    """Return how many faces of a body are planes, cylinders, cones and ruled splines, a dict."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.TopAbs import TopAbs_FACE

    names = {"Plane": "planes", "Cylinder": "cylinders", "Cone": "cones", "BSplineSurface": "ruled"}
    found = dict.fromkeys(names.values(), 0)
    for one in parts(body, TopAbs_FACE):
        kind = str(BRepAdaptor_Surface(cast("Face", one)).GetType()).rpartition("GeomAbs_")[2]
        name = names.get(kind, "others")
        found[name] = found.get(name, 0) + 1
    return found


def valid(body):
    """Say whether OpenCASCADE finds nothing wrong with a body."""
    from OCP.BRepCheck import BRepCheck_Analyzer

    return bool(BRepCheck_Analyzer(body).IsValid())


def below(body, place):
    """Return the height [mm] of the first surface straight below a place (3,) [mm]; None without one."""
    from OCP.gp import gp_Dir, gp_Lin
    from OCP.IntCurvesFace import IntCurvesFace_ShapeIntersector

    found = IntCurvesFace_ShapeIntersector()
    found.Load(body, 1e-6)
    found.Perform(gp_Lin(point(place), gp_Dir(0, 0, -1)), 0.0, 1e5)
    heights = [found.Pnt(k + 1).Z() for k in range(found.NbPnt())]
    return max(heights, default=None)
