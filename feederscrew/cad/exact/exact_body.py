"""Bodies with exact faces, united and cut: the bowl's door to OpenCASCADE, an extra (``cad``).

Planes, cylinders and cones are exact; what runs along the track is a ruled face between two curves, each a
cubic spline through places every 0.1 rad: within 1e-4 mm of the helix for a bowl of a metre.
"""

import contextlib
import contextvars
import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Ints, Points
from feederscrew.base.errors import FeederError, MissingPackage
from feederscrew.base.geometry.vectors import product
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.cad.facets import Body, in_space
from feederscrew.cad.plan import TrackPath

BRepAdaptor = heavy("OCP.BRepAdaptor")
BRepAlgoAPI = heavy("OCP.BRepAlgoAPI")
BRepBuilderAPI = heavy("OCP.BRepBuilderAPI")
BRepCheck = heavy("OCP.BRepCheck")
BRepGProp = heavy("OCP.BRepGProp")
BRepPrimAPI = heavy("OCP.BRepPrimAPI")
GC = heavy("OCP.GC")
GProp = heavy("OCP.GProp")
Geom = heavy("OCP.Geom")
IntCurvesFace = heavy("OCP.IntCurvesFace")
interpolate = heavy("scipy.interpolate")
arrays = heavy("OCP.OCP.collections")
TopAbs = heavy("OCP.TopAbs")
TopExp = heavy("OCP.TopExp")
TopoDS = heavy("OCP.TopoDS")
gp = heavy("OCP.gp")

Handle = Any  # a point, an axis, a curve or an array of OpenCASCADE
Spline = tuple[Points, Points, Ints, int]  # poles (N, 3), knots, multiplicities, degree
SEWN = 1e-5  # [mm] edges nearer than this are one
CURVE_STEP_RAD = 0.05  # [rad] of a curve between two places that it is led through
HAS_EXACT_CURVES = True  # a curve is a curve
SEAM_M = 1e-10  # [m] a cut begins so far from the wall: not at its face, which it would go through
SEAM_ANGLE_RAD = 0.7  # [rad] where a face of revolution is closed: nothing else of a bowl ends there
MIN_PIECE_VOLUME_MM3 = 1.0  # [mm3] a loose piece smaller than this is left out
FUZZY_TOLERANCES_MM = 1e-5, 1e-4, 1e-6  # [mm] nearer faces and edges meet: the first that does well
_near = contextvars.ContextVar("near", default=FUZZY_TOLERANCES_MM[0])


def check(where: str = "step") -> None:
    """Refuse to go on where OpenCASCADE is not installed; the fault says what to install.

    Parameters
    ----------
    where : str, optional
        The argument that asks for it.

    Raises
    ------
    MissingPackage
    """
    try:
        import OCP.STEPControl  # noqa: F401
    except ImportError:
        what, mend = "needs OpenCASCADE, which is not installed", "pip install 'feederscrew[cad]'"
        raise MissingPackage(where, what, mend) from None


@contextlib.contextmanager
def meeting(near: float) -> Iterator[None]:
    """Unite and cut bodies whose faces and edges meet within a length, within a ``with``.

    Parameters
    ----------
    near : float [mm]

    Yields
    ------
    None
    """
    before = _near.set(near)
    try:
        yield
    finally:
        _near.reset(before)


def axis() -> Handle:
    """Return the Z axis.

    Returns
    -------
    gp_Ax1
    """
    return gp.gp_Ax1(point([0, 0, 0]), gp.gp_Dir(0, 0, 1))


def point(place: Iterable[float]) -> Handle:
    """Return a place.

    Parameters
    ----------
    place : (3,) float [mm]

    Returns
    -------
    gp_Pnt
    """
    return gp.gp_Pnt(*map(float, place))


def cast(kind: str, shape: Body) -> Body:
    """Return a shape as an object of its own class in OpenCASCADE.

    Parameters
    ----------
    kind : str
        'Face', 'Wire' or 'Shell'.
    shape : Body

    Returns
    -------
    Body
        The same shape.
    """
    return (getattr(TopoDS.TopoDS, f"{kind}_s", None) or getattr(TopoDS.TopoDS, kind))(shape)


def parts(body: Body, kind: Handle) -> list[Body]:
    """Return the parts of a kind that a body has.

    Parameters
    ----------
    body : Body [mm]
    kind : Handle
        As TopAbs_FACE.

    Returns
    -------
    list of Body [mm]
    """
    parts, walk = [], TopExp.TopExp_Explorer(body, kind)
    while walk.More():
        parts.append(walk.Current())
        walk.Next()
    return parts


def polygon(corners: Points) -> Body:
    """Return the closed outline through some corners.

    Parameters
    ----------
    corners : (K, 3) float [mm]

    Returns
    -------
    TopoDS_Wire
    """
    wire = BRepBuilderAPI.BRepBuilderAPI_MakePolygon()
    for corner in corners:
        wire.Add(point(corner))
    wire.Close()
    return wire.Wire()


def flat_face(corners: Points) -> Body:
    """Return the flat face within some corners.

    Parameters
    ----------
    corners : (K, 3) float [mm]

    Returns
    -------
    TopoDS_Face
    """
    return BRepBuilderAPI.BRepBuilderAPI_MakeFace(polygon(corners), True).Face()


def drawn(wires: list[Body], along: Iterable[float]) -> Body:
    """Return the body that a flat outline leaves along a straight line.

    Parameters
    ----------
    wires : list of Body [mm]
        The outline; its holes after it.
    along : (3,) iterable of float [mm]

    Returns
    -------
    Body [mm]
    """
    face = BRepBuilderAPI.BRepBuilderAPI_MakeFace(wires[0], True)
    for hole in wires[1:]:
        face.Add(hole)
    return outwards(BRepPrimAPI.BRepPrimAPI_MakePrism(face.Face(), gp.gp_Vec(*map(float, along))).Shape())


def outwards(body: Body) -> Body:
    """Return a body of one shell, made anew with that turned inside out where its volume is negative.

    A solid that is only marked as reversed does not do: within a compound, as a cut leaves it, OpenCASCADE
    takes it for nothing and loses it in a union.

    Parameters
    ----------
    body : TopoDS_Solid

    Returns
    -------
    TopoDS_Solid
    """
    if volume(body) > 0.0:
        return body
    shell = parts(body, TopAbs.TopAbs_SHELL)[0]
    return BRepBuilderAPI.BRepBuilderAPI_MakeSolid(cast("Shell", shell.Reversed())).Solid()


def side(path: TrackPath, start: Points, stop: Points, z: float) -> Body:
    """Return a side of a ring as an edge: a straight line, an arc of a circle, or else a spline.

    An arc is exact where the wall is a cylinder, the bank does not change, and both ends are as far from the
    wall.

    Parameters
    ----------
    path : TrackPath
    start, stop : (2,) float [m]
        Ends: length along the wall, and distance from it.
    z : float [mm]
        Height.

    Returns
    -------
    Body [mm]
        An edge.
    """
    if min(start[0], stop[0]) >= path.end - 1e-12 or abs(start[0] - stop[0]) < 1e-9:
        ends = path.plan(*np.array([start, stop]).T) / MM
        return BRepBuilderAPI.BRepBuilderAPI_MakeEdge(*(point([*place, z]) for place in ends)).Edge()
    count = max(int(abs(stop[0] - start[0]) / path.radius / CURVE_STEP_RAD), 3) + 1
    ends = np.cos(path.bank_at(np.linspace(start[0], stop[0], count)))
    arc = abs(start[1] - stop[1]) < 1e-9 and path.flare == 0.0 and np.ptp(ends) * abs(start[1]) < 1e-12
    s, y = np.linspace(start, stop, 3 if arc else count).T
    places = [[*place, z] for place in path.plan(s, y) / MM]
    curve = GC.GC_MakeArcOfCircle(*map(point, places)).Value() if arc else spline_curve(np.array(places))
    return BRepBuilderAPI.BRepBuilderAPI_MakeEdge(curve).Edge()


def spline_curve(places: Points) -> Handle:
    """Return a spline through some places as a curve.

    Parameters
    ----------
    places : (M, 3) float [mm]

    Returns
    -------
    Geom_BSplineCurve
    """
    poles, knots, often, degree = spline(places)
    along = row("double", knots.tolist()), row("int", often.tolist())
    return Geom.Geom_BSplineCurve(row("gp_Pnt", map(point, poles)), *along, degree)


def spline(places: Points) -> Spline:
    """Return a spline through some places.

    Parameters
    ----------
    places : (M, 3) float [mm]

    Returns
    -------
    poles : (N, 3) float [mm]
    knots : (J,) float [1]
        From 0 to 1.
    multiplicities : (J,) int
    degree : int
        3, or less through fewer than four places.
    """
    degree = min(3, len(places) - 1)
    curve = interpolate.make_interp_spline(np.linspace(0.0, 1.0, len(places)), places, k=degree)
    return curve.c, *np.unique(curve.t, return_counts=True), degree


def ruled(lower: Spline, upper: Spline) -> Body:
    """Return the ruled face between two splines.

    Parameters
    ----------
    lower, upper : Spline [mm]
        Of the same knots, multiplicities and degree.

    Returns
    -------
    Body [mm]
        A face.
    """
    poles, knots, often, degree = lower
    grid = arrays.Array2_gp_Pnt(1, len(poles), 1, 2)
    for k, pair in enumerate(zip(poles, upper[0]), start=1):
        for column, place in enumerate(pair, start=1):
            grid.SetValue(k, column, point(place))
    places = row("double", knots.tolist()), row("double", [0.0, 1.0])
    times = row("int", often.tolist()), row("int", [2, 2])
    surface = Geom.Geom_BSplineSurface(grid, *places, *times, degree, 1)
    return BRepBuilderAPI.BRepBuilderAPI_MakeFace(surface, SEWN).Face()


def row(kind: str, values: Iterable[object]) -> Handle:
    """Return values as an array of OpenCASCADE.

    Parameters
    ----------
    kind : str
        'double', 'int' or 'gp_Pnt'.
    values : iterable

    Returns
    -------
    Handle
    """
    values = list(values)
    row_kind = getattr(arrays, f"Array1_{kind}")(1, len(values))
    for k, value in enumerate(values, start=1):
        row_kind.SetValue(k, value)
    return row_kind


def volume(body: Body) -> float:
    """Return the volume of a body, to a millionth of it.

    Parameters
    ----------
    body : TopoDS_Shape

    Returns
    -------
    float [mm3]
    """
    properties, door = GProp.GProp_GProps(), BRepGProp.BRepGProp
    measure = getattr(door, "VolumeProperties_s", None) or door.VolumeProperties
    measure(body, properties, 1e-6, False, False)  # to 1e-6 of the volume
    return float(properties.Mass())


def kinds(body: Body) -> dict[str, int]:
    """Return how many faces of a body are planes, cylinders, cones and ruled splines.

    Parameters
    ----------
    body : TopoDS_Shape

    Returns
    -------
    dict of str to int
    """
    names = {"Plane": "planes", "Cylinder": "cylinders", "Cone": "cones", "BSplineSurface": "ruled"}
    surface_kinds = dict.fromkeys(names.values(), 0)
    for part in parts(body, TopAbs.TopAbs_FACE):
        kind = str(BRepAdaptor.BRepAdaptor_Surface(cast("Face", part)).GetType()).rpartition("GeomAbs_")[2]
        name = names.get(kind, "others")
        surface_kinds[name] = surface_kinds.get(name, 0) + 1
    return surface_kinds


def valid(body: Body) -> bool:
    """Tell whether OpenCASCADE finds nothing wrong with a body.

    Parameters
    ----------
    body : TopoDS_Shape

    Returns
    -------
    bool
    """
    return bool(BRepCheck.BRepCheck_Analyzer(body).IsValid())


def below(body: Body, place: Points) -> float | None:
    """Return the height of the first surface straight below a place.

    Parameters
    ----------
    body : Body [mm]
    place : (3,) float [mm]

    Returns
    -------
    float [mm] or None
        None if there is none.
    """
    intersector = IntCurvesFace.IntCurvesFace_ShapeIntersector()
    intersector.Load(body, 1e-6)
    intersector.Perform(gp.gp_Lin(point(place), gp.gp_Dir(0, 0, -1)), 0.0, 1e5)
    heights = [intersector.Pnt(k + 1).Z() for k in range(intersector.NbPnt())]
    return max(heights, default=None)


def swept(legs: Sequence[tuple[Points, Points]]) -> Body:
    """Return a body whose section is handed on from frame to frame; as ``facets.swept``.

    Parameters
    ----------
    legs : sequence of ((M, K, 2) float [m], (M, 2, 2) float [m])
        Sections and frames of each leg.

    Returns
    -------
    TopoDS_Shape
    """
    rows = [in_space(*leg) / MM for leg in legs]
    faces = [flat_face(rows[0][0][::-1]), flat_face(rows[-1][-1])]
    for leg in rows:
        borders = [spline(leg[:, k]) for k in range(leg.shape[1])]
        faces += [ruled(border, other) for border, other in zip(borders, [*borders[1:], borders[0]])]
    sewing = BRepBuilderAPI.BRepBuilderAPI_Sewing(SEWN)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    shell = parts(sewing.SewedShape(), TopAbs.TopAbs_SHELL)[0]
    return outwards(BRepBuilderAPI.BRepBuilderAPI_MakeSolid(cast("Shell", shell)).Solid())


def turned(
    profile: ArrayLike, segments: int, start: float = SEAM_ANGLE_RAD, angle: float = 2.0 * np.pi
) -> Body:
    """Return a body of revolution about Z.

    Parameters
    ----------
    profile : (K, 2) array_like [m]
        Radius and height, counter-clockwise.
    segments : int
        Not used: the faces are exact. ``facets.turned`` has the same signature.
    start : float [rad]
        Angle at which it begins.
    angle : float [rad]
        Over which it turns.

    Returns
    -------
    Body [mm]
    """
    r, z = np.asarray(profile, float).T / MM
    face = flat_face(np.column_stack([r * np.cos(start), r * np.sin(start), z]))
    return outwards(BRepPrimAPI.BRepPrimAPI_MakeRevol(face, axis(), float(angle)).Shape())


def disc(at: Sequence[float], size: float, low: float, high: float) -> Body:
    """Return an upright round rod.

    Parameters
    ----------
    at : (2,) array_like [m]
        Its middle, seen from above.
    size : float [m]
        Diameter.
    low, high : float [m]
        Heights of its ends.

    Returns
    -------
    Body [mm]
    """
    seam = gp.gp_Dir(float(np.cos(SEAM_ANGLE_RAD)), float(np.sin(SEAM_ANGLE_RAD)), 0.0)
    foot = gp.gp_Ax2(point([at[0] / MM, at[1] / MM, low / MM]), gp.gp_Dir(0, 0, 1), seam)
    return BRepPrimAPI.BRepPrimAPI_MakeCylinder(foot, 0.5 * size / MM, (high - low) / MM).Shape()


def bore(place: ArrayLike, towards: Iterable[float], size: float, deep: float) -> Body:
    """Return a round rod along a direction.

    Parameters
    ----------
    place : (3,) array_like [m]
        Middle of its near end.
    towards : (3,) float [1]
        Unit vector.
    size : float [m]
        Diameter.
    deep : float [m]
        Length.

    Returns
    -------
    Body [mm]
    """
    foot = gp.gp_Ax2(point(np.asarray(place) / MM), gp.gp_Dir(*map(float, towards)))
    return BRepPrimAPI.BRepPrimAPI_MakeCylinder(foot, 0.5 * size / MM, deep / MM).Shape()


def plank(area: shapely.Geometry, thickness: float, axes: Points, foot: ArrayLike) -> Body:
    """Return a plate over an area, in space.

    Parameters
    ----------
    area : shapely geometry [m]
        In the first two of its axes.
    thickness : float [m]
        Along the third.
    axes : (3, 3) float [1]
        Its axes, a column each.
    foot : (3,) array_like [m]
        Origin of its axes.

    Returns
    -------
    Body [mm]
    """
    solid = []
    for area_part in shapely.get_parts(area):
        if area_part.geom_type == "Polygon":
            area_part = shapely.geometry.polygon.orient(area_part)
            rings = [np.asarray(ring.coords)[:-1] for ring in (area_part.exterior, *area_part.interiors)]
            wires = [polygon((np.asarray(foot) + product(ring, axes[:, :2].T)) / MM) for ring in rings]
            solid.append(drawn(wires, thickness / MM * axes[:, 2]))
    return solid[0] if len(solid) == 1 else united(solid)


def patch(ring: Points, low: float, high: float) -> Body:
    """Return an upright body within a closed curve.

    The curve is two splines, so that neither closes on itself.

    Parameters
    ----------
    ring : (K, 2) float [m]
        Places of the curve, seen from above.
    low, high : float [m]
        Heights of its ends.

    Returns
    -------
    Body [mm]
    """
    half = len(ring) // 2
    wire = BRepBuilderAPI.BRepBuilderAPI_MakeWire()
    for places in (ring[: half + 1], np.vstack([ring[half:], ring[:1]])):
        curve = spline_curve(np.column_stack([places, np.full(len(places), low)]) / MM)
        wire.Add(BRepBuilderAPI.BRepBuilderAPI_MakeEdge(curve).Edge())
    return drawn([wire.Wire()], [0.0, 0.0, (high - low) / MM])


def over(path: TrackPath, ring: Points, low: float, high: float, chord: float) -> Body:
    """Return an upright body over a ring that is drawn along a way.

    A side of the ring is a straight edge, an arc or a spline: ``side``. It is divided where the way becomes
    straight.

    Parameters
    ----------
    path : TrackPath
    ring : (K, 2) float [m]
        Corners: length along the wall, and distance from it.
    low, high : float [m]
        Heights of its ends.
    chord : float [m]
        Not used: the faces are exact. ``facets.over`` has the same signature.

    Returns
    -------
    Body [mm]
    """
    wire = BRepBuilderAPI.BRepBuilderAPI_MakeWire()
    for a, b in zip(ring, np.roll(ring, -1, axis=0)):
        stops = [a, b]
        if min(a[0], b[0]) < path.end < max(a[0], b[0]):  # there the way becomes straight
            stops.insert(1, a + (b - a) * (path.end - a[0]) / (b[0] - a[0]))
        for item, other in itertools.pairwise(stops):
            if np.abs(item - other).max() > 1e-9:
                wire.Add(side(path, item, other, low / MM))
    return drawn([wire.Wire()], [0.0, 0.0, (high - low) / MM])


def united(bodies: list[Body]) -> Body:
    """Return the union of bodies, one after the other.

    Parameters
    ----------
    bodies : list of TopoDS_Shape
        One at least.

    Returns
    -------
    TopoDS_Shape
    """
    whole, *rest = bodies
    for other in rest:
        whole = _combined(BRepAlgoAPI.BRepAlgoAPI_Fuse, whole, [other])
    return whole


def without(body: Body, tools: list[Body]) -> Body:
    """Return a body with others cut out of it.

    Parameters
    ----------
    body : Body [mm]
    tools : sequence of Body [mm]
        None of them leaves the body as it is.

    Returns
    -------
    Body [mm]
    """
    return _combined(BRepAlgoAPI.BRepAlgoAPI_Cut, body, tools) if tools else body


def above(body: Body, height: float) -> Body:
    """Return the share of a body that lies above a height.

    Parameters
    ----------
    body : Body [mm]
    height : float [m]

    Returns
    -------
    Body [mm]
    """
    far = 10.0  # beyond everything
    under = plank(shapely.box(-far, -far, far, far), height + far, np.eye(3), [0.0, 0.0, -far])
    return without(body, [under])


def placed_as(body: Body, *, mirrored: bool, turned: float) -> Body:
    """Return a body mirrored at the XZ plane or not, then turned about Z.

    Parameters
    ----------
    body : Body [mm]
    mirrored : bool
        The track rises the other way round.
    turned : float [rad]

    Returns
    -------
    Body [mm]
    """
    turn, flip = gp.gp_Trsf(), gp.gp_Trsf()
    turn.SetRotation(axis(), float(turned))
    if mirrored:
        flip.SetMirror(gp.gp_Ax2(point([0, 0, 0]), gp.gp_Dir(0, 1, 0)))
    return BRepBuilderAPI.BRepBuilderAPI_Transform(body, turn.Multiplied(flip), True).Shape()


def moved(body: Body, by: Iterable[float]) -> Body:
    """Return a body moved by a vector.

    Parameters
    ----------
    body : Body [mm]
    by : (3,) iterable of float [mm]

    Returns
    -------
    Body [mm]
    """
    shift = gp.gp_Trsf()
    shift.SetTranslation(gp.gp_Vec(*map(float, by)))
    return BRepBuilderAPI.BRepBuilderAPI_Transform(body, shift, True).Shape()


def one_piece(body: Body, where: str) -> Body:
    """Return the one piece of a body, without crumbs.

    Parameters
    ----------
    body : Body [mm]
    where : str
        What a fault names: 'devices'.

    Returns
    -------
    Body [mm]

    Raises
    ------
    FeederError
        If OpenCASCADE finds no body, or more than one.
    """
    pieces = sorted(parts(body, TopAbs.TopAbs_SOLID), key=lambda item: -volume(item))
    if not pieces or any(volume(piece) > MIN_PIECE_VOLUME_MM3 for piece in pieces[1:]):
        raise FeederError(where, f"OpenCASCADE finds {len(pieces)} bodies", "take bowl.stl")
    return pieces[0]


def _combined(kind: Callable[[], Handle], body: Body, tools: list[Body]) -> Body:
    solid, lists = kind(), (arrays.List_TopoDS_Shape(), arrays.List_TopoDS_Shape())
    lists[0].Append(body)
    for tool in tools:
        lists[1].Append(tool)
    solid.SetArguments(lists[0])
    solid.SetTools(lists[1])
    solid.SetUseOBB(True)  # a face along a helix fills little of a box along the axes
    solid.SetFuzzyValue(_near.get())  # where two splines along one helix meet, which else ends nowhere
    solid.Build()
    return solid.Shape()
