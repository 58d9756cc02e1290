"""The bowl with parts on its track: as a picture, for the viewer of a page, and as lines for a drawing."""

from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base.arrays import Array, Floats, Ints, Points, Triangles
from feederscrew.base.units import MM
from feederscrew.cad import riding
from feederscrew.cad.closed_body import BowlSolid
from feederscrew.output import marking, shading, style
from feederscrew.output.page.blocks import Block, Notes, Views
from feederscrew.output.shading import Camera, Mesh, Rays, join_meshes
from feederscrew.part.record import Part

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BOWL_PICTURE_COLUMNS, BOWL_PICTURE_ROWS = 1500, 1050  # [px]
BOWL_AZIMUTH_DEG, BOWL_ELEVATION_DEG = -118.0, 40.0  # [deg] from where it is seen, from the outlet's begin
RIDER_COLOUR = np.array([0.93, 0.55, 0.20])
DRAWN_EDGE_COSINE = np.cos(np.radians(20.0))  # of the normals on both sides of an edge that is drawn
SURFACE_OFFSET_SIZES = 2e-3  # of the solid's size: a place is moved off the surface by it, then looked at


def figure(whole_bowl: BowlSolid, part: Part) -> "Figure":
    """Return the figure of a bowl with parts on its track.

    Parameters
    ----------
    whole_bowl : BowlSolid
    part : Part

    Returns
    -------
    matplotlib.figure.Figure
    """
    solid = whole_bowl.with_lugs
    view = camera(np.degrees(solid.plan.turned) + BOWL_AZIMUTH_DEG, BOWL_ELEVATION_DEG)
    points, faces = parts(solid, part)
    centre = 0.5 * (solid.vertices.min(axis=0) + solid.vertices.max(axis=0))
    whole = Rays(*join_meshes([(solid.vertices, solid.faces), (points, faces)]), centre)
    columns, rows = BOWL_PICTURE_COLUMNS, BOWL_PICTURE_ROWS
    projected = view.project(whole.points)
    low, high = projected.min(axis=0), projected.max(axis=0)
    pixel = 1.03 * max((high - low)[0] / columns, (high - low)[1] / rows)
    left, bottom = 0.5 * (low + high) - 0.5 * pixel * np.array((columns, rows))
    frame = shading.Shot(left, bottom, pixel, columns, rows)

    def paint(normals: Array, facets: Ints) -> Array:
        """The first facets are the bowl's, the others those of parts."""
        is_bowl = (facets < len(solid.faces))[:, None]
        return shading.lit(normals, view, np.where(is_bowl, shading.STEEL_COLOUR, RIDER_COLOUR))

    image = np.empty((rows, columns, 3), dtype=np.uint8)  # numbers of eight bytes: 100 MB more
    draw = shading.one_solid(whole, view, paint)
    for place, drawn in shading.bands(draw, view, frame, shading.RAYS_PER_PIXEL):
        image[place] = np.rint(255.0 * drawn)
    return style.pixels(image)


def parts(solid: BowlSolid, part: Part) -> Mesh:
    """Return the parts along the track of a bowl as one mesh.

    Parameters
    ----------
    solid : BowlSolid
    part : Part

    Returns
    -------
    vertices : (V, 3) float [m]
    faces : (F, 3) int
    """
    own = part.corners
    placed = [riding.place_rider(solid.plan, rider, own, s) for rider, s in solid.riders]
    riders = [(points, np.asarray(part.faces)) for points in placed]
    return join_meshes([(np.zeros((0, 3)), np.zeros((0, 3), int)), *riders])


def blocks(solid: BowlSolid | None, part: Part, why: str = "", mark: str = "") -> list[Block]:
    """Return the blocks of a page on a bowl as a solid: the solid to be turned, or why there is none.

    Parameters
    ----------
    solid : BowlSolid or None
    part : Part
    why : str, optional
        Why there is none.
    mark : str, optional

    Returns
    -------
    list of Block
    """
    if solid is None:
        return [Notes((f"the bowl as a solid: {why}",))] if why else []
    text = f"{2.0 * solid.plan.path.radius / MM:.4g} mm, {solid.mass:.3g} kg as {solid.plan.material.name}"
    captions = ((marking.marked_title("bowl", mark), text, ()),)
    hint = (
        "The bowl as one closed body, parts on its track. Drag it to turn it, or use the arrow keys; "
        "double-click sets it back."
    )
    middle = 0.5 * (solid.vertices.min(axis=0) + solid.vertices.max(axis=0))
    points, faces = parts(solid, part)
    points, faces = shading.reduced_mesh((points - middle) / MM, faces, 60_000)
    bowl = solid.vertices - middle
    upright = {"name": "bowl", "quaternion": (0.0, 0.0, 0.0, 1.0), "height": 0.0, "contact": [], "track": 0}
    scene = {
        **shading.track(points * MM, faces),
        "radius": shading.short(np.sqrt((bowl**2).sum(axis=1).max()) / MM),
        "facets": len(faces),
        "all": len(faces),
        "azimuth": shading.short(np.degrees(solid.plan.turned) + BOWL_AZIMUTH_DEG),
        "elevation": shading.short(BOWL_ELEVATION_DEG),
        "unmarked": True,
        "colour": "parts",
        "reach": 0.9,  # from every side the whole bowl is seen
        "tracks": [shading.track(bowl, solid.faces)],
        "poses": [upright],
    }
    return [Views(scene, captions, "solid-bowl", "The", hint=hint, printed=True, mark=mark)]


def camera(azimuth: float, elevation: float) -> Camera:
    """Return the camera that looks from a direction.

    Parameters
    ----------
    azimuth, elevation : float [deg]

    Returns
    -------
    Camera
    """
    a, e = np.radians(azimuth), np.radians(elevation)
    to_viewer = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return Camera(right, np.cross(to_viewer, right), to_viewer)


def lines(vertices: Points, faces: Triangles, view: Camera) -> Floats:
    """Return the visible edges of a surface, across and up the view.

    Drawn are sharp edges, those of the outline, and those at which not exactly two facets meet, as where a
    file leaves a crack.

    Parameters
    ----------
    vertices : (V, 3) float [m]
    faces : (F, 3) int
    view : Camera

    Returns
    -------
    (N, 2, 2) float [m]
    """
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    rays = Rays(vertices, faces, centre)
    corners = rays.points[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.sqrt((normal**2).sum(axis=1, keepdims=True)), 1e-30)
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    order, owner = np.lexsort(sides.T), np.tile(np.arange(len(faces)), 3)
    is_first = np.append(True, (sides[order][1:] != sides[order][:-1]).any(axis=1))
    starts = np.flatnonzero(is_first)
    counts = np.diff(np.append(starts, len(order)))
    left, right = owner[order[starts]], owner[order[starts + (counts == 2)]]  # of a lone one the same
    facing = (normal * view.towards_viewer).sum(axis=1)
    drawn = (normal[left] * normal[right]).sum(axis=1) < DRAWN_EDGE_COSINE
    drawn |= (facing[left] > 1e-6) != (facing[right] > 1e-6)
    drawn |= counts != 2
    drawn &= (facing[left] > -1e-6) | (facing[right] > -1e-6)
    pair = sides[order[starts]][drawn]
    a, b, push = rays.points[pair[:, 0]], rays.points[pair[:, 1]], (normal[left] + normal[right])[drawn]
    # pieces of them that are seen
    count = np.maximum(1, np.ceil(np.sqrt(((b - a) ** 2).sum(axis=1)) / 0.006)).astype(int)
    owner = np.repeat(np.arange(len(a)), count)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    ends = [a[owner] + (b - a)[owner] * ((place + k) / count[owner])[:, None] for k in (0, 1)]
    off = SURFACE_OFFSET_SIZES * push[owner]
    middle = 0.5 * (ends[0] + ends[1]) + off + SURFACE_OFFSET_SIZES * view.towards_viewer
    visible = view.sees(rays, middle, slack=SURFACE_OFFSET_SIZES)
    same = owner[1:] == owner[:-1]  # pieces of one edge that are seen one after the other are one
    first = visible & ~np.append(False, same & visible[:-1])
    last = visible & ~np.append(same & visible[1:], False)
    pieces = np.stack([view.project(ends[0][first]), view.project(ends[1][last])], axis=1)
    return pieces * rays.size + view.project(centre[None])[0]
