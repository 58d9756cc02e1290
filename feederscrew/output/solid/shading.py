"""From what the rays met to colours: light, drawn edges, the part's shadow on the floor."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_dilation, gaussian_filter, map_coordinates

from feederscrew.output.solid.render import AWAY, SINGLE, Camera

SAMPLES = 3  # rays a pixel, each way
BAND = 16  # rows of pixels drawn at a time: all their rays in the caches of a processor
RIM = 2  # rows of samples beyond a band that have a say in its edges
PAPER = np.array([1.0, 1.0, 1.0])
STEEL = np.array([0.72, 0.79, 0.86])
PALE = np.array([0.86, 0.86, 0.86])  # of an aspect the part does not stay on
EDGE = np.array([0.13, 0.17, 0.22])
LIGHTS = (  # towards the light, across and up the image and to the viewer; and how strong it is
    (np.array([-0.45, 0.60, 0.66]), 0.52),
    (np.array([0.75, 0.05, 0.66]), 0.22),
)
AMBIENT = 0.42
SHARP = np.cos(np.radians(24.0))  # a turn of the surface that is drawn as an edge
STEP = 0.02  # [size] a jump in depth that is drawn as an outline
FLOOR_GRID = 160  # cells each way of the shadow map
SHADE = 0.42  # darkness of the floor where the part touches it


@dataclass(frozen=True, eq=False)
class Shot:
    """Where a picture lies in the image plane, in sizes of the solid."""

    left: float
    bottom: float
    pixel: float  # edge of one pixel
    columns: int
    rows: int

    @property
    def extent(self):
        """(left, right, bottom, top), as an image on axes wants it."""
        return (
            self.left,
            self.left + self.columns * self.pixel,
            self.bottom,
            self.bottom + self.rows * self.pixel,
        )

    def positions(self, each=1):
        """Return the image positions, ``each`` a pixel: across from the left, up from the top row down."""
        step = self.pixel / each
        across = self.left + (np.arange(self.columns * each) + 0.5) * step
        up = self.bottom + (np.arange(self.rows * each)[::-1] + 0.5) * step
        return across, up


def picture(solid, stance, frame, colour=STEEL):
    """Render the solid on the floor as an image.

    Parameters
    ----------
    solid : Rays
        What is seen.
    stance : Stance
        How it stands and from where it is seen.
    frame : Shot
        What part of the image plane is drawn.
    colour : (3,) float
        Of the solid, 0 to 1.

    Returns
    -------
    (rows, columns, 3) float
        Red, green and blue from 0 to 1, the top row first.
    """
    across, up = frame.positions(SAMPLES)
    floor = _floor(solid, stance, *frame.positions()).astype(SINGLE)
    covered, columns = _covered(stance.bounds, across, up)
    image = np.empty_like(floor)
    for first in range(0, frame.rows, BAND):
        samples = floor[first : first + BAND].repeat(SAMPLES, axis=0).repeat(SAMPLES, axis=1)
        start = SAMPLES * first
        rows = _within(covered, start, start + len(samples))
        if rows.start < rows.stop:
            cast = _within(covered, rows.start - RIM, rows.stop + RIM)
            kept = slice(rows.start - cast.start, rows.stop - cast.start)
            part = samples[rows.start - start : rows.stop - start, columns]
            _draw(part, kept, solid, stance.camera, across[columns], up[cast], colour, up[0] - up[1])
        image[first : first + BAND] = averaged(samples, SAMPLES)
    return image


def averaged(samples, each):
    """Average the samples of each pixel, ``each`` a side; (rows, columns, 3) from 0 to 1."""
    rows, columns = (length // each for length in samples.shape[:2])
    return samples.reshape(rows, each, columns, each, 3).mean(axis=(1, 3)).clip(0.0, 1.0)


def _draw(image, kept, solid, camera, across, up, colour, step):
    """Draw on an image what the rays of its rows meet; they are the rows ``kept`` of those that are cast."""
    depths, normals = camera.cast(solid, across, up)
    met = np.isfinite(depths[kept])
    image[met] = lit(normals[kept][met], camera, colour)
    image[edges(depths, normals, camera, step)[kept]] = EDGE


def _within(rows, start, stop):
    """Return those of a slice of rows that lie from one row to before another."""
    return slice(max(rows.start, start), min(rows.stop, stop))


def _covered(bounds, across, up):
    """Rows and columns of samples round the part, with a rim for its outline."""
    rim = 4.0 * (up[0] - up[1])
    columns = np.flatnonzero((across > bounds[0, 0] - rim) & (across < bounds[1, 0] + rim))
    rows = np.flatnonzero((up > bounds[0, 1] - rim) & (up < bounds[1, 1] + rim))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


def lit(normals, camera: Camera, colour):
    """Return the colour of matt surfaces (N, 3) under the lights; from behind it is that from the front."""
    seen = normals @ np.column_stack([camera.right, camera.up, camera.back]).astype(SINGLE)
    seen *= np.where(seen[:, 2:] < 0.0, SINGLE(-1.0), SINGLE(1.0))
    light = np.full(len(seen), AMBIENT, dtype=SINGLE)
    for towards, strength in LIGHTS:
        light += strength * np.maximum(seen @ (towards / np.linalg.norm(towards)).astype(SINGLE), 0.0)
    return light[:, None] * colour.astype(SINGLE)


def edges(depths, normals, camera, step):
    """Return which samples lie on an outline (two wide) or on a sharp edge (one wide)."""
    met = np.isfinite(depths)
    depths = np.where(met, depths, 2.0 * AWAY)
    facing = np.maximum(np.abs(normals @ camera.back.astype(SINGLE)), 0.05)
    slope = step * np.sqrt(1.0 - np.minimum(facing, 1.0) ** 2) / facing  # depth a flat surface gains a sample
    outline, crease = np.zeros_like(met), np.zeros_like(met)
    for axis in (0, 1):
        near, far = (np.s_[:-1, :], np.s_[1:, :]) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
        jump = np.abs(depths[near] - depths[far]) > STEP + 2.0 * np.maximum(slope[near], slope[far])
        bend = np.einsum("rci,rci->rc", normals[near], normals[far]) < SHARP
        both = met[near] & met[far]
        outline[near] |= jump
        outline[far] |= jump
        crease[near] |= bend & both
        crease[far] |= bend & both
    return binary_dilation(outline) | crease


def _floor(solid, stance, across, up):
    """White paper with the soft shadow of the part."""
    camera, axes = stance.camera, stance.floor_axes
    start = camera.origins(across, up) @ axes.T  # in floor axes
    towards = -camera.back @ axes.T
    reach = (-stance.height - start[..., 2]) / towards[2]
    spot = start[..., :2] + reach[..., None] * towards[:2]
    shadow, lowest, cell = _shadow(solid, stance)
    place = (spot - lowest) / cell
    dark = map_coordinates(shadow, [place[..., 0], place[..., 1]], order=1, mode="constant")
    return PAPER * (1.0 - dark[..., None])


def _shadow(solid, stance):
    """How dark each cell of the floor is: darkest where the part touches it, soft where it is high.

    Returns the map, the position of its first cell and the size of a cell.
    """
    axes = stance.floor_axes
    plan = stance.plan
    lowest, highest = plan.min(axis=0), plan.max(axis=0)
    cell = 1.6 * (highest - lowest).max() / FLOOR_GRID
    lowest = 0.5 * (lowest + highest) - 0.5 * cell * (FLOOR_GRID - 1)
    x, y = np.meshgrid(*(low + cell * np.arange(FLOOR_GRID) for low in lowest), indexing="ij")
    spots = np.stack([x, y, np.full_like(x, -stance.height - 0.01)], axis=-1).reshape(-1, 3)
    distances = solid.hits(spots @ axes, axes[2])[0]
    cover = np.exp(-np.clip(distances - 0.01, 0.0, None) / 0.35).reshape(x.shape)
    soft = 0.55 * gaussian_filter(cover, 2.0) + 0.45 * gaussian_filter(cover, 7.0)
    return SHADE * soft, lowest, cell
