"""Shaded views of a part: rays, light, contact polygons, and pairs of parts."""

import base64
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from feederscrew.base.arrays import Array, Bools, Floats, Points, Triangles, Vector
from feederscrew.base.columns import Document
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.output import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from feederscrew.part.record import Part
    from feederscrew.resting.aspects import Aspects

ndimage = heavy("scipy.ndimage")
mpl_patches = heavy("matplotlib.patches")

Mesh = tuple[Array, Array]  # corners (V, 3) [m] and faces (F, 3)
BOX_FACES = np.array(
    [
        (0, 1, 3),
        (0, 3, 2),
        (4, 6, 7),
        (4, 7, 5),
        (0, 4, 5),
        (0, 5, 1),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
        (1, 5, 7),
        (1, 7, 3),
    ]
)  # corners in the order of ``itertools.product``
AWAY = 4.0  # sizes from the centre of mass to where rays start
MISSED = -1
SINGLE_PRECISION = np.float32  # what the caster keeps, and more than a picture shows
SMOOTH_COSINE = np.cos(np.radians(20.0))  # facets that meet under less are one curved side
MOST_FACETS = 200_000  # beyond it a facet is smaller than a pixel
ELEVATION = np.radians(27.0)  # of the viewer above the floor
STANCE_TURN_RAD = np.radians(32.0)  # of the part's long side out of the picture's plane
MAX_QUICK_POINTS = 20_000  # points that are quick to handle all of
DIRECTION_CELLS = 24  # from the middle of the sphere of directions to its side, for more points than that
RAYS_PER_PIXEL = 3  # rays a pixel, each way, where a picture changes within it
BAND = 48  # rows of pixels drawn at a time: all their rays in the caches of a processor
CHANGE_COSINE = np.cos(np.radians(12.0))  # a turn of the surface from pixel to pixel: several rays there
STEEL_COLOUR = np.array([0.72, 0.79, 0.86])
PALE_COLOUR = np.array([0.86, 0.86, 0.86])  # of an aspect the part does not stay on
EDGE_COLOUR = np.array([0.13, 0.17, 0.22])
LIGHTS = (  # towards the light, across and up the image and to the viewer; and how strong it is
    (np.array([-0.45, 0.60, 0.66]), 0.52),
    (np.array([0.75, 0.05, 0.66]), 0.22),
)
AMBIENT = 0.42
CREASE_COSINE = np.cos(np.radians(24.0))  # a turn of the surface that is drawn as an edge
FLOOR_GRID = 160  # cells each way of the shadow map
Surfaces = list[tuple[Array, Array]]  # depths (N,) and normals (N, 3) of each
Pairs = Sequence[tuple[Any, Any]]  # for each of two axes: indices of samples, and of those next to them
Neighbours = tuple[float, Pairs]  # how far apart samples are, and which are beside each other
Draw = Callable[[Array, Array, Array, Neighbours | None], Surfaces]  # as ``bands`` call it
GRID_PAIRS = (  # what is beside each other in an array of two axes: down, then across
    (np.s_[:-1, :], np.s_[1:, :]),
    (np.s_[:, :-1], np.s_[:, 1:]),
)
CONTACT_LINE: style.Look = {"color": style.ACCENT, "linewidth": 1.3, "solid_capstyle": "round"}
HIDDEN_CONTACT_LINE = CONTACT_LINE | {"linewidth": 0.8, "linestyle": (0, (3, 2)), "alpha": 0.8}
BEYOND = 0.08  # [size] how far a rolling axis sticks out at both ends
ROLLING_AXIS_LINE: style.Look = {"color": "#0072b2", "linewidth": 0.9, "linestyle": (0, (9, 2.5, 2, 2.5))}
METAL = np.array([0.90, 0.91, 0.92])  # the track
PAIR_SAMPLES = 2  # rays a pixel, each way


class Rays:
    """A surface (V, 3), (F, 3) [m] about its centre of mass, of unit size for the caster."""

    def __init__(self, vertices: Points, faces: Triangles, centre: Vector) -> None:
        points = np.asarray(vertices, dtype=float) - centre
        self.size = float(np.linalg.norm(points, axis=1).max())
        self.points = points / self.size
        self.faces = np.asarray(faces)
        smooth = corner_normals(self.points, self.faces)
        self.corner_normals = None if smooth is None else smooth.astype(SINGLE_PRECISION)
        self._single = self.points.astype(SINGLE_PRECISION)
        self._scene = EmbreeScene()
        TriangleMesh(self._scene, self._single, self.faces.astype(np.int32))

    def hits(self, origins: Array, direction: Vector) -> tuple[Array, Array, Array]:
        """Return what parallel rays meet first.

        Parameters
        ----------
        origins : (N, 3) float [size]
            About the centre of mass.
        direction : (3,) float [1]

        Returns
        -------
        distances : (N,) float [size]
            Infinite where nothing is met.
        normals : (N, 3) float [1]
            Outward, smooth over curved sides; zero where nothing is met.
        facets : (N,) int
            MISSED where nothing is met.
        """
        origins = np.ascontiguousarray(origins, dtype=SINGLE_PRECISION)
        directions = np.broadcast_to(np.asarray(direction, dtype=SINGLE_PRECISION), origins.shape)
        hits = self._scene.run(origins, np.ascontiguousarray(directions), output=True)
        is_hit = hits["primID"] != MISSED
        triangle, u, v = (hits[name][is_hit] for name in ("primID", "u", "v"))
        if self.corner_normals is None:
            a, b, c = np.moveaxis(self._single[self.faces[triangle]], 1, 0)
            across = np.cross(b - a, c - a)
        else:
            weights = np.column_stack([1.0 - u - v, u, v])
            across = np.einsum("nk,nki->ni", weights, self.corner_normals[triangle])
        normals = np.zeros(origins.shape, dtype=SINGLE_PRECISION)
        normals[is_hit] = _units(across)
        return np.where(is_hit, hits["tfar"], SINGLE_PRECISION(np.inf)), normals, hits["primID"]


@dataclass(frozen=True, eq=False)
class Camera:
    """Parallel projection; its axes are given along the solid's axes."""

    right: Vector  # (3,)
    up: Vector  # (3,)
    towards_viewer: Vector  # (3,) towards the viewer

    def project(self, points: Points) -> Array:
        """Return where points are on the image: across and up.

        Parameters
        ----------
        points : (N, 3) float [any length]

        Returns
        -------
        (N, 2) float [any length]
        """
        return np.asarray(points) @ np.column_stack([self.right, self.up])

    def origins(self, across: Array, up: Array) -> Array:
        """Return the ray starts of image positions.

        Parameters
        ----------
        across, up : (...) float [size]

        Returns
        -------
        (..., 3) float [size]
        """
        u, v = (np.asarray(places, SINGLE_PRECISION)[..., None] for places in (across, up))
        axes = self.right, self.up, self.towards_viewer
        right, above, to_viewer = (axis.astype(SINGLE_PRECISION) for axis in axes)
        return u * right + v * above + SINGLE_PRECISION(AWAY) * to_viewer

    def meet(self, solid: Rays, across: Array, up: Array) -> tuple[Array, Array, Array]:
        """Return what rays meet over a grid of the image.

        Parameters
        ----------
        solid : Rays
        across : (C,) array
            Image positions, in sizes of the solid.
        up : (R,) array
            The same.

        Returns
        -------
        depths, normals, facets : (R, C), (R, C, 3) and (R, C) int arrays
            Depths lie behind the starts of the rays; facets are ``MISSED`` where nothing is met.
        """
        grid = len(up), len(across)
        distances, normals, facets = self.meet_at(solid, *np.meshgrid(across, up))
        return distances.reshape(grid), normals.reshape(*grid, 3), facets.reshape(grid)

    def meet_at(self, solid: Rays, across: Array, up: Array) -> tuple[Array, Array, Array]:
        """Return what rays meet at image positions.

        Parameters
        ----------
        solid : Rays
        across, up : (...) array
            In sizes of the solid.

        Returns
        -------
        depths, normals, facets : (N,), (N, 3) and (N,) int arrays
            Flat, as ``Rays.hits`` returns them.
        """
        return solid.hits(self.origins(across, up).reshape(-1, 3), -self.towards_viewer)

    def sees(self, solid: Rays, points: Array, slack: float = 0.01, away: float = AWAY) -> Bools:
        """Return which points the solid does not hide.

        Parameters
        ----------
        solid : Rays
        points : (N, 3) float [size]
        slack : float [size], optional
            By which a point may lie behind the surface.
        away : float [size], optional
            How far towards the viewer is looked for what hides a point.

        Returns
        -------
        (N,) bool
        """
        starts = points + away * self.towards_viewer
        distances = solid.hits(starts, -self.towards_viewer)[0]
        return distances > away - slack


def corner_normals(points: Points, faces: Triangles) -> Array | None:
    """Return the unit normal at each corner of each facet, averaged over its curved side.

    Parameters
    ----------
    points : (V, 3) float [any length]
    faces : (F, 3) int

    Returns
    -------
    (F, 3, 3) float [1] or None
        None of very many facets.
    """
    if len(faces) > MOST_FACETS:
        return None
    a, b, c = np.moveaxis(points[faces], 1, 0)
    areas = np.cross(b - a, c - a)  # (F, 3) normals times twice the area
    own = _units(areas)
    # the side that each facet belongs to: joined across every edge bent less than 20 deg
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    facet, size = np.tile(np.arange(len(faces)), 3), len(faces)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    first, second = facet[order[:-1][same]], facet[order[1:][same]]
    joined = np.einsum("ei,ei->e", own[first], own[second]) > SMOOTH_COSINE
    graph = coo_matrix((np.ones(joined.sum()), (first[joined], second[joined])), shape=(size, size))
    labels = connected_components(graph, directed=False)[1]
    keys = faces.astype(np.int64) * (labels.max(initial=0) + 1) + labels[:, None]
    place = np.unique(keys, return_inverse=True)[1].ravel()
    sums = np.column_stack([np.bincount(place, np.repeat(areas[:, k], 3)) for k in range(3)])
    mean = _units(sums)[place].reshape(-1, 3, 3)
    bent = np.einsum("fki,fi->fk", mean, own) < SMOOTH_COSINE
    return np.where(bent[..., None], own[:, None, :], mean)


def _units(vectors: Array) -> Array:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-30)


@dataclass(frozen=True, eq=False)
class Stance:
    """A solid on one aspect, all along its file's axes and in its size."""

    down: Vector  # (3,) towards the floor
    along: Vector  # (3,) in the floor, along the part's long side
    height: float  # [size] of the centre of mass over the floor
    camera: Camera
    plan: Floats  # (N, 2) [size] the part seen from above, in the floor axes
    bounds: Floats  # (2, 2) [size] lowest and highest corner of the part's image
    shadow_box: Floats  # (2, 2) [size] the same with its shadow

    @property
    def floor_axes(self) -> Floats:
        """(3, 3) rows x, y in the floor and z up."""
        return np.stack([self.along, np.cross(self.along, self.down), -self.down])


def stance(points: Points, down: Vector, height: float) -> Stance:
    """Return the stance of a solid on the floor, on the aspect of a normal.

    Parameters
    ----------
    points : (V, 3) float [size]
        About the centre of mass.
    down : (3,) float [1]
    height : float [size]
        Of the centre of mass over the floor.

    Returns
    -------
    Stance
    """
    # floor axes x, from the file axis that is most across ``down``, and y
    axis = np.eye(3)[np.argmin(np.abs(np.round(down, 9)))]
    x = axis - (axis @ down) * down
    x /= np.linalg.norm(x)
    y = np.cross(-down, x)
    # along the longer side of the smallest rectangle round the plan
    plan = points @ np.column_stack([x, y])
    outline = plan[ConvexHull(plan).vertices]
    sides = np.roll(outline, -1, axis=0) - outline
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    lengths = np.ptp(outline @ sides.T, axis=0)
    widths = np.ptp(outline @ (sides @ [[0.0, 1.0], [-1.0, 0.0]]).T, axis=0)
    best = int(np.argmin(np.round(lengths * widths, 9)))
    u, v = sides[best] if lengths[best] >= widths[best] else (-sides[best][1], sides[best][0])
    along = u * x + v * y
    # the taller end, by a fiftieth of the size, goes to the back
    lean = np.cov(points @ np.cross(along, down), -points @ down)[0, 1]
    return stance_along(points, down, height, -along if lean < -(0.02**2) else along)


def stance_along(points: Points, down: Vector, height: float, along: Vector) -> Stance:
    """Return the stance whose floor axis is turned out of the picture's plane.

    Parameters
    ----------
    points : (V, 3) float [size]
    down : (3,) float [1]
    height : float [size]
    along : (3,) float [1]
        The floor axis, a unit vector.

    Returns
    -------
    Stance
    """
    across, up = np.cross(along, down), -down
    c, s = np.cos(STANCE_TURN_RAD), np.sin(STANCE_TURN_RAD)
    right, ahead = c * along + s * across, c * across - s * along
    to_viewer = np.sin(ELEVATION) * up - np.cos(ELEVATION) * ahead
    camera = Camera(right, np.cross(to_viewer, right), to_viewer)
    plan = points @ np.column_stack([along, across])
    middle = 0.5 * (plan.min(axis=0) + plan.max(axis=0))
    shadow = middle + 1.18 * (plan - middle)  # the floor that it darkens
    floor = shadow @ np.stack([along, across]) + height * down
    bounds = _box(camera.project(points))
    return Stance(down, along, height, camera, plan, bounds, _box(np.vstack([bounds, camera.project(floor)])))


def outer_points(points: Array) -> Array:
    """Return a few thousand points that reach about as far as all: the farthest in each direction.

    Parameters
    ----------
    points : (V, 3) array

    Returns
    -------
    (K, 3) array
        All of them where they are few.
    """
    if len(points) <= MAX_QUICK_POINTS:
        return points
    radii = np.linalg.norm(points, axis=1)
    cells = np.rint(DIRECTION_CELLS * points / np.maximum(radii, 1e-30)[:, None]).astype(np.int64)
    cells += DIRECTION_CELLS
    keys = cells @ np.array([(2 * DIRECTION_CELLS + 1) ** 2, 2 * DIRECTION_CELLS + 1, 1])
    order = np.lexsort((-radii, keys))
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    return points[order[first]]


def _box(image: Array) -> Array:
    return np.stack([image.min(axis=0), image.max(axis=0)])


@dataclass(frozen=True, eq=False)
class Shot:
    """Window of a picture in the image plane, in sizes of the solid."""

    left: float
    bottom: float
    pixel: float  # edge of one pixel
    columns: int
    rows: int

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """(left, right, bottom, top), as an image on axes wants it."""
        right, top = self.left + self.columns * self.pixel, self.bottom + self.rows * self.pixel
        return self.left, right, self.bottom, top

    def positions(self, each: int = 1) -> tuple[Array, Array]:
        """Return the image positions of pixels.

        Parameters
        ----------
        each : int, optional
            A pixel, both ways.

        Returns
        -------
        (C,) array, (R,) array
            Across from the left, and up from the top row down.
        """
        step = self.pixel / each
        across = self.left + (np.arange(self.columns * each) + 0.5) * step
        up = self.bottom + (np.arange(self.rows * each)[::-1] + 0.5) * step
        return across, up


def picture(solid: Rays, stance: Stance, frame: Shot, colour: Array = STEEL_COLOUR) -> Array:
    """Render the solid on white paper with its shadow.

    Parameters
    ----------
    solid : Rays
    stance : Stance
    frame : Shot
        What of the image plane is seen.
    colour : (3,) float [1], optional

    Returns
    -------
    (rows, columns, 3) float [1]
        The top row first.
    """
    # darkness of the cells of the floor, darkest at the contact
    axes, lowest, highest = stance.floor_axes, stance.plan.min(axis=0), stance.plan.max(axis=0)
    cell = 1.6 * (highest - lowest).max() / FLOOR_GRID
    lowest = 0.5 * (lowest + highest) - 0.5 * cell * (FLOOR_GRID - 1)
    x, y = np.meshgrid(*(low + cell * np.arange(FLOOR_GRID) for low in lowest), indexing="ij")
    spots = np.stack([x, y, np.full_like(x, -stance.height - 0.01)], axis=-1).reshape(-1, 3)
    distances = solid.hits(spots @ axes, axes[2])[0]
    cover = np.exp(-np.clip(distances - 0.01, 0.0, None) / 0.35).reshape(x.shape)
    shadow = 0.42 * (0.55 * ndimage.gaussian_filter(cover, 2.0) + 0.45 * ndimage.gaussian_filter(cover, 7.0))
    # the cell that each ray meets
    start = stance.camera.origins(*np.meshgrid(*frame.positions())) @ axes.T
    towards = -stance.camera.towards_viewer @ axes.T
    reach = (-stance.height - start[..., 2]) / towards[2]
    place = (start[..., :2] + reach[..., None] * towards[:2] - lowest) / cell
    dark = ndimage.map_coordinates(shadow, [place[..., 0], place[..., 1]], order=1, mode="constant")
    floor = (np.ones(3) * (1.0 - dark[..., None])).astype(SINGLE_PRECISION)
    image = np.empty_like(floor)
    draw = one_solid(solid, stance.camera, lambda normals, _: lit(normals, stance.camera, colour))
    for rows, drawn in bands(draw, stance.camera, frame, RAYS_PER_PIXEL, floor):
        image[rows] = drawn
    return image


def one_solid(solid: Rays, camera: Camera, paint: Callable[[Array, Array], Array]) -> Draw:
    """Return what ``bands`` draw of a solid.

    Parameters
    ----------
    solid : Rays
    camera : Camera
    paint : callable
        From normals (N, 3) and facets (N,) to colours (N, 3).

    Returns
    -------
    callable
    """

    def draw(across: Array, up: Array, colours: Array, neighbours: Neighbours | None) -> Surfaces:
        depths, normals, facets = camera.meet_at(solid, across, up)
        is_met = facets != MISSED
        colours[is_met] = paint(normals[is_met], facets[is_met])
        if neighbours is not None:
            colours[edges(depths, normals, camera, *neighbours)] = EDGE_COLOUR
        return [(depths, normals)]

    return draw


def bands(
    draw: Draw, camera: Camera, frame: Shot, each: int, ground: Array | None = None
) -> Iterator[tuple[slice, Array]]:
    """Yield some rows of a picture at a time.

    A pixel has the colour at its centre. Where normal, depth or colour change from a pixel to the next it has
    the mean of ``each`` rays both ways, edges among them.

    Parameters
    ----------
    draw : callable
        Is handed image positions across and up (N,), the colours (N, 3) behind it to paint over, and what
        ``edges`` need, the step and the pairs of samples, None for no edges; it returns depths (N,) and
        normals (N, 3) of each surface that it draws.
    camera : Camera
    frame : Shot
    each : int
    ground : (R, C, 3) array, optional
        Behind what is drawn; paper without one.

    Yields
    ------
    slice, (R, C, 3) array
        The rows, and their colours from 0 to 1.
    """
    across, up = frame.positions()
    offsets = frame.pixel * ((np.arange(each) + 0.5) / each - 0.5)
    for first in range(0, frame.rows, BAND):
        last = min(first + BAND, frame.rows)
        # the row beside a band has a say in its edges: it is cast, and not drawn
        start, stop = max(first - 1, 0), min(last + 1, frame.rows)
        image = np.ones((stop - start, frame.columns, 3), dtype=SINGLE_PRECISION)
        if ground is not None:
            image[:] = ground[start:stop]
        colours = image.reshape(-1, 3).copy()
        u, v = np.meshgrid(across, up[start:stop])
        surfaces = draw(u.ravel(), v.ravel(), colours, None)
        colours = colours.reshape(image.shape)
        pixels = _changing(surfaces, colours, camera, frame.pixel)
        # several rays in each pixel that changes, (pixels, rays down, rays across)
        rays = np.broadcast_arrays(
            u[pixels][:, None, None] + offsets, v[pixels][:, None, None] - offsets[:, None]
        )
        samples = image[pixels].repeat(each**2, axis=0)
        neighbours = frame.pixel / each, _neighbours(pixels, each)
        draw(rays[0].ravel(), rays[1].ravel(), samples, neighbours)
        colours[pixels] = samples.reshape(-1, each**2, 3).mean(axis=1)
        yield slice(first, last), colours[first - start : last - start].clip(0.0, 1.0)


def _changing(surfaces: Surfaces, image: Array, camera: Camera, step: float) -> Array:
    """Which pixels (rows, columns) of an image differ from one beside them, and the pixels next to these."""
    grid = image.shape[:2]
    changing = np.zeros(grid, dtype=bool)
    for depths, normals in surfaces:
        is_met, slope = np.isfinite(depths), _slopes(normals, camera, step)
        depths = np.where(is_met, depths, 2.0 * AWAY).reshape(grid)
        is_met, slope, normals = is_met.reshape(grid), slope.reshape(grid), normals.reshape(*grid, 3)
        for near, far in GRID_PAIRS:
            beyond = np.abs(depths[near] - depths[far]) - 2.0 * np.maximum(slope[near], slope[far])
            differs = beyond > 0.002  # [size]
            differs |= np.einsum("rci,rci->rc", normals[near], normals[far]) < CHANGE_COSINE
            differs |= np.abs(image[near] - image[far]).max(axis=2) > 0.04
            differs &= is_met[near] | is_met[far]
            changing[near] |= differs
            changing[far] |= differs
    return _widen(changing, GRID_PAIRS)


def _neighbours(pixels: Bools, each: int) -> tuple[tuple[Array, Array], ...]:
    """Indices of the samples beside each other, first across and then down, of a mask of pixels.

    The samples are the rows of (pixels, each, each), from the top left.
    """
    count = np.count_nonzero(pixels)
    own = np.arange(count * each**2).reshape(count, each, each)
    place = np.full(pixels.shape, MISSED)
    place[pixels] = np.arange(count)
    pairs = []
    for (near, far), turned in zip(GRID_PAIRS[::-1], (own, own.swapaxes(1, 2))):
        both = (place[near] != MISSED) & (place[far] != MISSED)
        first, second = turned[place[near][both], :, -1], turned[place[far][both], :, 0]
        within = turned[:, :, :-1].ravel(), turned[:, :, 1:].ravel()
        pairs.append((np.append(within[0], first), np.append(within[1], second)))
    return tuple(pairs)


def average_samples(samples: Array, each: int) -> Array:
    """Average the samples of each pixel.

    Parameters
    ----------
    samples : (rows, columns, 3) float [1]
    each : int
        Samples a side of a pixel.

    Returns
    -------
    (rows / each, columns / each, 3) float [1]
    """
    rows, columns = (length // each for length in samples.shape[:2])
    return samples.reshape(rows, each, columns, each, 3).mean(axis=(1, 3)).clip(0.0, 1.0)


def lit(normals: Array, camera: Camera, colour: Array) -> Array:
    """Return the colour of matt surfaces under the lights; from behind it is that from the front.

    Parameters
    ----------
    normals : (N, 3) float [1]
    camera : Camera
    colour : (3,) float [1]

    Returns
    -------
    (N, 3) float [1]
    """
    axes = np.column_stack([camera.right, camera.up, camera.towards_viewer]).astype(SINGLE_PRECISION)
    by_camera = normals @ axes
    by_camera *= np.where(by_camera[:, 2:] < 0.0, SINGLE_PRECISION(-1.0), SINGLE_PRECISION(1.0))
    light = np.full(len(by_camera), AMBIENT, dtype=SINGLE_PRECISION)
    for towards, strength in LIGHTS:
        unit = (towards / np.linalg.norm(towards)).astype(SINGLE_PRECISION)
        light += strength * np.maximum(by_camera @ unit, 0.0)
    return light[:, None] * colour.astype(SINGLE_PRECISION)


def edges(depths: Array, normals: Array, camera: Camera, step: float, pairs: Pairs = GRID_PAIRS) -> Bools:
    """Return which samples lie on an outline (two wide) or on a sharp edge (one wide).

    Parameters
    ----------
    depths : (...) array
    normals : (..., 3) array
    camera : Camera
    step : float
        From a sample to the next.
    pairs : sequence
        For each of two axes the indices of samples and of those that come next to them.

    Returns
    -------
    (...) array of bool
    """
    is_hit, slope = np.isfinite(depths), _slopes(normals, camera, step)
    depths = np.where(is_hit, depths, 2.0 * AWAY)
    outline, crease = np.zeros_like(is_hit), np.zeros_like(is_hit)
    for near, far in pairs:
        jump = np.abs(depths[near] - depths[far]) > 0.02 + 2.0 * np.maximum(slope[near], slope[far])
        bend = np.einsum("...i,...i->...", normals[near], normals[far]) < CREASE_COSINE
        bend &= is_hit[near] & is_hit[far]
        outline[near] |= jump
        outline[far] |= jump
        crease[near] |= bend
        crease[far] |= bend
    return _widen(outline, pairs) | crease


def _slopes(normals: Array, camera: Camera, step: float) -> Array:
    """Depth that a flat surface of these normals gains over a step."""
    facing = np.maximum(np.abs(normals @ camera.towards_viewer.astype(SINGLE_PRECISION)), 0.05)
    return step * np.sqrt(1.0 - np.minimum(facing, 1.0) ** 2) / facing


def _widen(flags: Bools, pairs: Pairs) -> Array:
    wide = flags.copy()
    for near, far in pairs:
        wide[near] |= flags[far]
        wide[far] |= flags[near]
    return wide


def reduced_mesh(vertices: Points, faces: Triangles, most: int = 200_000) -> tuple[Points, Triangles]:
    """Return a mesh of fewer facets: corners of one grid cell become one.

    Parameters
    ----------
    vertices : (V, 3) float [any length]
    faces : (F, 3) int
    most : int, optional
        Facets that there may be.

    Returns
    -------
    vertices : (V', 3) float [any length]
    faces : (F', 3) int
    """
    cells, lowest = 2.0**10, vertices.min(axis=0)  # across the part, at first
    extent = np.ptp(vertices, axis=0).max()
    reduced, corners = faces, vertices
    while len(reduced) > most:
        grid = np.floor((vertices - lowest) * (cells / extent)).astype(np.int64)
        place = np.unique(grid, axis=0, return_inverse=True)[1].ravel()
        count = np.bincount(place)
        corners = np.column_stack([np.bincount(place, vertices[:, k]) / count for k in range(3)])
        reduced = place[faces]
        reduced = reduced[(reduced != np.roll(reduced, 1, axis=1)).all(axis=1)]
        cells /= np.sqrt(2.0)
    return corners, reduced


def encode_base64(array: Array, kind: str) -> str:
    """Return an array's bytes as text in base64.

    Parameters
    ----------
    array : array
    kind : str
        Of numpy, '<f4'.

    Returns
    -------
    str
    """
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def short(value: float) -> float:
    """Return a number with the seven digits that single precision has.

    Parameters
    ----------
    value : float

    Returns
    -------
    float
    """
    return float(f"{value:.7g}")


def scene_of_part(part: "Part", to_viewer: Vector) -> Document:
    """Return what a scene of the viewer tells of a part, and of the viewer's place.

    Parameters
    ----------
    part : Part
        From a mesh.
    to_viewer : (3,) float [1]

    Returns
    -------
    dict of str to object
        As JSON has it: ``positions`` (float32) and ``index`` (uint32), both little-endian in base64, in mm
        about the centre of mass; ``radius``; ``facets`` shown, of ``all``; ``azimuth`` and ``elevation``
        [deg].
    """
    points = part.corners / MM
    vertices, faces = reduced_mesh(points, np.asarray(part.faces))
    return {
        "positions": encode_base64(vertices, "<f4"),
        "index": encode_base64(faces, "<u4"),
        "radius": short(np.sqrt((points**2).sum(axis=1).max())),
        "facets": len(faces),
        "all": len(np.asarray(part.faces)),
        "azimuth": short(np.degrees(np.arctan2(to_viewer[1], to_viewer[0]))),
        "elevation": short(np.degrees(np.arctan2(to_viewer[2], np.hypot(*to_viewer[:2])))),
    }


def track(vertices: Points, faces: Triangles) -> Document:
    """Return a section of track for a scene of the viewer.

    Parameters
    ----------
    vertices : (V, 3) float [m]
    faces : (F, 3) int

    Returns
    -------
    dict of str to object
        As JSON has it.
    """
    return {"positions": encode_base64(vertices / MM, "<f4"), "index": encode_base64(faces, "<u4")}


def centre_of_mass(axes: "Axes", radius: float, place: tuple[float, float] = (0.0, 0.0)) -> None:
    """Draw the quartered circle through whatever is in front of it.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    radius : float [data unit]
    place : (float, float) [data unit], optional
    """
    look = {"facecolor": "white", "edgecolor": "black", "linewidth": 0.8, "zorder": 5}
    axes.add_patch(mpl_patches.Circle(place, radius, **look))
    look = {"color": "black", "linewidth": 0, "zorder": 6}
    for start in (0.0, 180.0):
        axes.add_patch(mpl_patches.Wedge(place, radius, start, start + 90.0, **look))


def contact(axes: "Axes", solid: Rays, standing: Stance, polygon: Array) -> None:
    """Draw the contact polygon: whole where it is seen, dashed where the part hides it.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    solid : Rays
    standing : Stance
    polygon : (K, 3) float [size]
    """
    camera = standing.camera
    face = {"facecolor": style.ACCENT, "alpha": 0.16, "zorder": 2}
    axes.add_patch(mpl_patches.Polygon(camera.project(polygon), closed=True, **face))
    # every edge in 60 pieces, to see which are hidden
    share = np.linspace(0.0, 1.0, 61)[:, None]
    chains = [(1.0 - share) * a + share * b for a, b in zip(polygon, np.roll(polygon, -1, axis=0))]
    pieces = np.concatenate([np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains])
    ends = camera.project(pieces.reshape(-1, 3)).reshape(-1, 2, 2)
    is_seen = camera.sees(solid, pieces.mean(axis=1))
    for flags, look in ((is_seen, CONTACT_LINE), (~is_seen, HIDDEN_CONTACT_LINE)):
        indices = np.flatnonzero(flags)
        for run in np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1):
            if len(run):
                chain = np.vstack([ends[run, 0], ends[run[-1], 1]])
                axes.plot(chain[:, 0], chain[:, 1], zorder=3, **look)


def rolling_axis(axes: "Axes", solid: Rays, standing: Stance, direction: Vector) -> None:
    """Draw the axis a part rolls about, through its centre of mass.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    solid : Rays
    standing : Stance
    direction : (3,) float [1]
        A unit vector; nothing is drawn where it is NaN.
    """
    if not np.isfinite(direction).all():
        return
    along = solid.points @ direction
    ends = standing.camera.project(np.outer([along.min() - BEYOND, along.max() + BEYOND], direction))
    axes.plot(*ends.T, zorder=4, scalex=False, scaley=False, **ROLLING_AXIS_LINE)


def scale_bar(axes: "Axes", right: float, y: float, pixel: float) -> None:
    """Draw a bar of a round number of millimetres.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    right, y : float [data unit]
        Where it ends.
    pixel : float [m]
        One data unit.
    """
    length = style.round_length(110.0 * pixel * 1e3)
    left = right - length * 1e-3 / pixel
    axes.plot([left, right], [y, y], color=style.INK, linewidth=1.6, solid_capstyle="butt")
    for end in (left, right):
        axes.plot([end, end], [y - 5, y + 5], color=style.INK, linewidth=1.0)
    look: style.Look = {"fontsize": 7.5, "color": style.INK, "ha": "center", "va": "bottom"}
    axes.text(0.5 * (left + right), y + 9, f"{length:g} mm", **look)


def marks_legend(axes: "Axes", left: float, y: float, *, rolling: bool) -> None:
    """Draw what the marks mean, in one line of text.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    left, y : float [data unit]
        Where it begins.
    rolling : bool
        Whether an axis is drawn.
    """
    centre_of_mass(axes, 9.0, (left + 9.0, y))
    axes.text(left + 26, y, "centre of mass", fontsize=7, color=style.INK, va="center")
    axes.plot([left + 170, left + 198], [y, y], **CONTACT_LINE)
    axes.text(left + 208, y, "contact, dashed where hidden", fontsize=7, color=style.INK, va="center")
    if rolling:
        axes.plot([left + 460, left + 500], [y, y], **ROLLING_AXIS_LINE)
        axes.text(left + 510, y, "axis it rolls about", fontsize=7, color=style.INK, va="center")


def pair_picture(
    track: Mesh, part: Mesh, centre: Vector, camera: Camera, half: float, columns: int, rows: int
) -> tuple[Array, Shot, float]:
    """Render a part on a track.

    Parameters
    ----------
    track, part : ((V, 3) float [m], (F, 3) int)
    centre : (3,) float [m]
        Of the picture.
    camera : Camera
    half : float [m]
        Seen to either side of the centre.
    columns, rows : int

    Returns
    -------
    image : (rows, columns, 3) float [1]
        The top row first.
    shot : Shot
        Where it lies in the image plane, in units of ``size``.
    size : float [m]
    """
    alone, whole = Rays(*part, centre), Rays(*join_meshes([track, part]), centre)
    half = half / whole.size
    frame = Shot(-half, -half * rows / columns, 2.0 * half / columns, columns, rows)

    def draw(across: Array, up: Array, colours: Array, neighbours: Neighbours | None) -> Surfaces:
        depths, normals, _ = camera.meet_at(whole, across, up)
        near, own = _part_alone(alone, camera, whole.size, across, up)
        is_hit, there = np.isfinite(depths), np.isfinite(near)
        is_part = there & (near <= np.where(is_hit, depths, np.inf) + 1e-3)
        for mask, colour in ((is_hit & ~is_part, METAL), (is_hit & is_part, STEEL_COLOUR)):
            colours[mask] = lit(normals[mask], camera, colour)
        hidden = there & ~is_part
        shape = lit(own[hidden], camera, STEEL_COLOUR)
        if neighbours is not None:
            colours[edges(depths, normals, camera, *neighbours)] = EDGE_COLOUR
            shape[edges(near, own, camera, *neighbours)[hidden]] = EDGE_COLOUR
        colours[hidden] += 0.45 * (shape - colours[hidden])  # it is seen through what is in front of it
        return [(depths, normals), (near, own)]

    image = np.concatenate([drawn for _, drawn in bands(draw, camera, frame, PAIR_SAMPLES)])
    return image, frame, whole.size


def shown_share(track: Mesh, part: Mesh, centre: Vector, camera: Camera, half: float) -> float:
    """Return the share of what is to be seen of a part that the track does not hide, as in a picture.

    Parameters
    ----------
    track, part : ((V, 3) float [m], (F, 3) int)
    centre : (3,) float [m]
    camera : Camera
    half : float [m]
        Seen to either side of the centre.

    Returns
    -------
    float [1]
    """
    alone, whole = Rays(*part, centre), Rays(*join_meshes([track, part]), centre)
    side = np.linspace(-half, half, 40) / whole.size
    across, up = (places.ravel() for places in np.meshgrid(side, side))
    depths = camera.meet_at(whole, across, up)[0]
    near, _ = _part_alone(alone, camera, whole.size, across, up)
    there = np.isfinite(near)
    is_seen = there & (near <= np.where(np.isfinite(depths), depths, np.inf) + 1e-3)
    return float(is_seen.sum() / max(there.sum(), 1))


def box_mesh(low: Sequence[float] | Vector, high: Sequence[float] | Vector) -> Mesh:
    """Return a box along the axes as a closed mesh.

    Parameters
    ----------
    low, high : (3,) float [m]
        Two opposite corners.

    Returns
    -------
    corners : (8, 3) float [m]
    faces : (12, 3) int
        Counter-clockwise seen from outside.
    """
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    return np.asarray(low) + corners * np.subtract(high, low), BOX_FACES


def join_meshes(meshes: Sequence[Mesh]) -> Mesh:
    """Return several meshes as one.

    Parameters
    ----------
    meshes : sequence of Mesh

    Returns
    -------
    Mesh
    """
    first = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    corners = np.concatenate([vertices for vertices, _ in meshes])
    return corners, np.concatenate([faces + n for (_, faces), n in zip(meshes, first)])


def _part_alone(alone: Rays, camera: Camera, size: float, across: Array, up: Array) -> tuple[Array, Array]:
    """Depths (N,) in a size, and normals (N, 3), of a part without the track."""
    scale = size / alone.size
    near, normals, _ = camera.meet_at(alone, across * scale, up * scale)
    return (near - AWAY) / scale + AWAY, normals


def thumbnail(solid: Rays, aspects: "Aspects", row: int, size: tuple[int, int]) -> Array:
    """Return the picture of a solid on an aspect.

    Parameters
    ----------
    solid : Rays
    aspects : Aspects
    row : int
        Of the aspect.
    size : (int, int)
        Width and height in pixels.

    Returns
    -------
    (height, width, 3) float [1]
    """
    standing = stance(outer_points(solid.points), aspects.normals[row], aspects.heights[row] / solid.size)
    return _draw_solid(solid, standing, size)


def on_its_lowest(solid: Rays, size: tuple[int, int]) -> Array:
    """Return the picture of a solid on the lowest side of its file.

    Parameters
    ----------
    solid : Rays
    size : (int, int)
        Width and height in pixels.

    Returns
    -------
    (height, width, 3) float [1]
    """
    down, height = np.array([0.0, 0.0, -1.0]), -float(solid.points[:, 2].min())
    return _draw_solid(solid, stance(outer_points(solid.points), down, height), size)


def _draw_solid(solid: Rays, standing: Stance, size: tuple[int, int]) -> Array:
    lowest, highest = standing.shadow_box
    pixel = 1.08 * max((highest - lowest) / size)
    left, bottom = 0.5 * (lowest + highest) - 0.5 * pixel * np.array(size)
    return np.clip(picture(solid, standing, Shot(left, bottom, pixel, *size)), 0.0, 1.0)
