"""Bodies of our own facets, united and cut: the bowl's door to manifold3d."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import affinity

from feederscrew.base.arrays import Points
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.polygons import turned as rotated
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM, counted
from feederscrew.cad.plan import FULL_TURN_RAD, BowlPlan, TrackPath
from feederscrew.sorting.solid import extrude

if TYPE_CHECKING:
    from feederscrew.cad.closed_body import BowlSolid

manifold3d = heavy("manifold3d")

MIN_PIECE_VOLUME_M3 = 1e-9  # [m3] a loose piece smaller than this is left out
HOLE_SIDES = 48  # of a round hole
Body = Any  # [mm] a Manifold; of the kit ``exact_body`` a TopoDS_Shape
HAS_EXACT_CURVES = False  # a curve is a chain of chords
SEAM_M = 1e-5  # [m] of the plate left along the wall where it is cut: no two faces may coincide


def swept(legs: Sequence[tuple[Points, Points]]) -> Body:
    """Return a body whose section is handed on from frame to frame, leg after leg.

    Parameters
    ----------
    legs : sequence of ((M, K, 2) float [m], (M, 2, 2) float [m])
        Sections, the corners of each counter-clockwise: outwards, upwards. Frames, of each the place from
        above where its first coordinate is zero, and the unit vector along which it grows. A leg begins with
        the section that the one before ends with.

    Returns
    -------
    manifold3d.Manifold [mm]
    """
    rows = [in_space(*leg) for leg in legs]
    points = np.concatenate([rows[0], *(row[1:] for row in rows[1:])])
    count, corners = points.shape[:2]
    k, row = np.arange(corners), corners * np.arange(count - 1)[:, None]
    a, b = row + k, row + (k + 1) % corners
    sides = np.stack([a, a + corners, b, b, a + corners, b + corners], axis=-1).reshape(-1, 3)
    ends = []
    for end in (points[0], points[-1]):  # its upright plane as (K, 2): along it and up
        far = end[np.argmax(((end - end[0])[:, :2] ** 2).sum(axis=1))] - end[0]
        along = far[:2] / np.hypot(*far[:2])
        along = along if np.sum(along * end[0, :2]) >= 0.0 else -along
        flat = np.column_stack([end[:, 0] * along[0] + end[:, 1] * along[1], end[:, 2]])
        ends.append(np.asarray(manifold3d.triangulate([flat / MM])))
    first, last = ends
    faces = np.concatenate([sides, first, corners * (count - 1) + last[:, ::-1]])
    body = manifold3d.Manifold(manifold3d.Mesh64(points.reshape(-1, 3) / MM, faces.astype(np.uint64)))
    if body.is_empty():
        fault = f"a swept body is not a closed surface ({body.status()})"
        raise FeederError("the bowl as a solid", fault, "take another `chord`, or another width of track")
    return body


def in_space(sections: Points, frames: Points) -> Points:
    """Return the corners of sections in space.

    Parameters
    ----------
    sections : (M, K, 2) float [m]
        Corners of each: outwards, upwards.
    frames : (M, 2, 2) float
        Of each the place [m] from above where its first coordinate is zero, and the unit vector [1] along
        which that grows.

    Returns
    -------
    (M, K, 3) float [m]
    """
    place, outward = frames[:, None, 0], frames[:, None, 1]
    return np.concatenate([place + sections[..., :1] * outward, sections[..., 1:]], axis=-1)


def turned(profile: ArrayLike, segments: int, start: float = 0.0, angle: float = FULL_TURN_RAD) -> Body:
    """Return a body of revolution about Z.

    Parameters
    ----------
    profile : (K, 2) array_like [m]
        Radius and height, counter-clockwise.
    segments : int
        Facets round the axis.
    start : float [rad]
        Angle at which it begins.
    angle : float [rad]
        Over which it turns.

    Returns
    -------
    Body [mm]
    """
    section = manifold3d.CrossSection([np.asarray(profile) / MM])
    if angle >= FULL_TURN_RAD:
        return section.revolve(segments)
    return section.revolve(segments, float(np.degrees(angle))).rotate((0.0, 0.0, float(np.degrees(start))))


def patch(ring: Points, low: float, high: float) -> Body:
    """Return an upright body within a closed curve.

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
    return extrude(shapely.Polygon(ring), low, high)


def over(path: TrackPath, ring: Points, low: float, high: float, chord: float) -> Body:
    """Return an upright body over a ring that is drawn along a way.

    Parameters
    ----------
    path : TrackPath
    ring : (K, 2) float [m]
        Corners: length along the wall, and distance from it.
    low, high : float [m]
        Heights of its ends.
    chord : float [m]
        By how much an arc may be too flat.

    Returns
    -------
    Body [mm]
    """
    border = shapely.linestrings(np.vstack([ring, ring[:1]]))
    fine = shapely.get_coordinates(shapely.segmentize(border, np.sqrt(4.0 * path.radius * chord)))[:-1]
    return extrude(shapely.make_valid(shapely.Polygon(path.plan(fine[:, 0], fine[:, 1]))), low, high)


def disc(at: ArrayLike, size: float, low: float, high: float) -> Body:
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
    return extrude(shapely.Polygon(np.asarray(at) + _circle(size)), low, high)


def _circle(size: float) -> Points:
    """Corners (K, 2) [m] of a round hole by its diameter."""
    angles = 2.0 * np.pi * (np.arange(HOLE_SIDES) + 0.5) / HOLE_SIDES  # no corner on an edge of what it is in
    return 0.5 * size * np.column_stack([np.cos(angles), np.sin(angles)])


def bore(place: ArrayLike, towards: Points, size: float, deep: float) -> Body:
    """Return a round rod along a direction.

    Parameters
    ----------
    place : (3,) array_like [m]
        Middle of its near end.
    towards : (3,) float [1]
        Unit vector, not upright.
    size : float [m]
        Diameter.
    deep : float [m]
        Length.

    Returns
    -------
    Body [mm]
    """
    across = np.cross([0.0, 0.0, 1.0], towards)
    across = across / np.sqrt((across**2).sum())
    axes = np.column_stack([across, np.cross(towards, across), towards])
    return plank(shapely.Polygon(_circle(size)), deep, axes, place)


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
    return extrude(area, 0.0, thickness).transform(np.column_stack([axes, np.asarray(foot) / MM]))


def hull(places: Points) -> Body:
    """Return the convex hull of some places.

    Parameters
    ----------
    places : (N, 3) float [m]

    Returns
    -------
    manifold3d.Manifold [mm]
    """
    return manifold3d.Manifold.hull_points(np.asarray(places) / MM)


def united(bodies: Iterable[Body]) -> Body:
    """Return the union of some bodies.

    Parameters
    ----------
    bodies : iterable of manifold3d.Manifold

    Returns
    -------
    manifold3d.Manifold
    """
    return manifold3d.Manifold.batch_boolean(list(bodies), manifold3d.OpType.Add)


def without(body: Body, tools: Sequence[Body]) -> Body:
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
    return manifold3d.Manifold.batch_boolean([body, *tools], manifold3d.OpType.Subtract) if tools else body


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
    return body.trim_by_plane((0.0, 0.0, 1.0), height / MM)


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
    body = body.mirror((0.0, 1.0, 0.0)) if mirrored else body
    return body.rotate((0.0, 0.0, float(np.degrees(turned)))) if turned else body


def moved(body: Body, by: tuple[float, float, float]) -> Body:
    """Return a body moved.

    Parameters
    ----------
    body : manifold3d.Manifold
    by : (float, float, float) [mm]

    Returns
    -------
    manifold3d.Manifold
    """
    return body.translate(by)


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
        If more than a crumb hangs loose.
    """
    pieces = sorted(body.decompose(), key=lambda item: -item.volume())
    loose = [piece for piece in pieces[1:] if piece.volume() * MM**3 > MIN_PIECE_VOLUME_M3]
    if loose:
        what = f"the cuts leave {counted(len(loose), 'loose piece')} of the track"
        raise FeederError(where, what, "leave some track on both sides of each cut, or move them apart")
    return pieces[0]


def placed(solid: "BowlSolid") -> Body:
    """Return a bowl as a body as it stands in its files.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    manifold3d.Manifold [mm]
    """
    return manifold3d.Manifold(manifold3d.Mesh64(solid.vertices / MM, solid.faces.astype(np.uint64)))


def unplaced(solid: "BowlSolid") -> Body:
    """Return a bowl with its outlet at the angle 0, right-handed, to cast rays at.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    manifold3d.Manifold [mm]
    """
    whole = placed(solid).rotate((0.0, 0.0, -float(np.degrees(solid.plan.turned))))
    return whole.mirror((0.0, 1.0, 0.0)) if solid.plan.left else whole


def about_axis(places: ArrayLike, turn: float) -> Points:
    """Return places turned about Z.

    Parameters
    ----------
    places : (..., 2) or (..., 3) array_like [m]
    turn : float [rad]

    Returns
    -------
    (..., 2) or (..., 3) float [m]
    """
    places = np.asarray(places)
    return np.concatenate([rotated(places, turn), places[..., 2:]], axis=-1)


def as_planned(plan: BowlPlan, points: ArrayLike) -> Points:
    """Return points of a bowl's files as its plan has them: right-handed, the outlet at the angle 0.

    Parameters
    ----------
    plan : BowlPlan
    points : (N, 2) or (N, 3) array_like [m]
        In the axes of the files.

    Returns
    -------
    (N, 2) or (N, 3) float [m]
    """
    points = about_axis(points, -plan.turned)
    return points * [1.0, -1.0, 1.0][: points.shape[-1]] if plan.left else points


def as_filed(plan: BowlPlan, points: ArrayLike) -> Points:
    """Return points of a bowl's plan as its files have them; the inverse of ``as_planned``.

    Parameters
    ----------
    plan : BowlPlan
    points : (N, 2) or (N, 3) array_like [m]
        Right-handed, the outlet at the angle 0.

    Returns
    -------
    (N, 2) or (N, 3) float [m]
    """
    points = np.asarray(points)
    return about_axis(points * [1.0, -1.0, 1.0][: points.shape[-1]] if plan.left else points, plan.turned)


def below(body: Body, place: ArrayLike, deep: float = 10.0) -> float | None:
    """Return the height of the first surface straight below a place.

    Parameters
    ----------
    body : Body [mm]
    place : (3,) array_like [m]
    deep : float [m]
        How far down it is looked for.

    Returns
    -------
    float [m] or None
        None if there is none.
    """
    start = np.asarray(place) / MM
    hits = body.ray_cast(tuple(start), tuple(start + np.array([0.0, 0.0, -deep]) / MM))
    return float(hits[0].position[2]) * MM if hits else None


def section(body: Body, angle: float) -> list[Points]:
    """Return the outlines that a plane through the axis cuts of a body.

    Parameters
    ----------
    body : Body [mm]
    angle : float [rad]
        Of the plane, from XZ.

    Returns
    -------
    list of (K, 2) float [m]
        Closed outlines, holes among them: place along the plane, and height.
    """
    flat = body.rotate((0.0, 0.0, -float(np.degrees(angle)))).rotate((-90.0, 0.0, 0.0))
    return [np.asarray(ring) * MM for ring in flat.slice(1e-3).to_polygons()]


def first_met(body: Body, start: ArrayLike, towards: ArrayLike) -> list[float]:
    """Return the distances of all surfaces on a straight line from one place to another.

    Parameters
    ----------
    body : Body [mm]
    start, towards : (3,) array_like [m]
        Its ends.

    Returns
    -------
    list of float [m]
        From ``start``, the nearest first.
    """
    start = np.asarray(start, float)
    hits = body.ray_cast(tuple(start / MM), tuple(np.asarray(towards, float) / MM))
    return [float(np.sqrt(np.sum((np.asarray(hit.position) * MM - start) ** 2))) for hit in hits]


def rod(axis: int, middle: ArrayLike, size: float, deep: float) -> Body:
    """Return a round rod along one of the axes.

    Parameters
    ----------
    axis : int
        0, 1 or 2.
    middle : (3,) array_like [m]
    size : float [m]
        Diameter.
    deep : float [m]
        Length to either side of its middle.

    Returns
    -------
    Body [mm]
    """
    solid = manifold3d.Manifold.cylinder(2.0 * deep / MM, 0.5 * size / MM, circular_segments=24, center=True)
    solid = (solid.rotate((0.0, 90.0, 0.0)), solid.rotate((90.0, 0.0, 0.0)), solid)[axis]
    return solid.translate(tuple(np.asarray(middle) / MM))


def cut_by(body: Body, planes: Iterable[tuple[int, float]]) -> list[Body]:
    """Return a body in cells, cut by planes square to the axes.

    Parameters
    ----------
    body : Body [mm]
    planes : iterable of (int, float [m])
        Axis, and the place on it.

    Returns
    -------
    list of Body [mm]
        Those that are not empty.
    """
    cells = [body]
    for axis, at in planes:
        normal = tuple(float(k == axis) for k in range(3))
        cells = [half for cell in cells for half in cell.split_by_plane(normal, at / MM)]
    return [cell for cell in cells if not cell.is_empty()]


def parts_of(body: Body, least: float = MIN_PIECE_VOLUME_M3) -> list[Body]:
    """Return the pieces of a body that hang together.

    Parameters
    ----------
    body : Body [mm]
    least : float [m3]
        Smaller ones are left out.

    Returns
    -------
    list of Body [mm]
    """
    return [item for item in body.decompose() if item.volume() * MM**3 > least]


def cut_face(body: Body, axis: int, at: float) -> shapely.Geometry:
    """Return the face that a plane square to an axis cuts of a body.

    Parameters
    ----------
    body : Body [mm]
    axis : int
        0, 1 or 2.
    at : float [m]
        Place of the plane on that axis.

    Returns
    -------
    shapely geometry [m]
        In the other two axes, in their order; holes are open.
    """
    turn = ((0.0, -90.0, 0.0), (90.0, 0.0, 0.0), (0.0, 0.0, 0.0))[axis]  # x' y' z': -z y x, x -z y, x y z
    rings = [np.asarray(ring) * MM for ring in body.rotate(turn).slice(at / MM).to_polygons()]
    area = shapely.Polygon()
    for ring in rings:
        area = area.symmetric_difference(shapely.Polygon(ring).buffer(0.0))
    rearward = ((0.0, 1.0, -1.0, 0.0), (1.0, 0.0, 0.0, -1.0), (1.0, 0.0, 0.0, 1.0))[axis]
    return affinity.affine_transform(area, (*rearward, 0.0, 0.0))
