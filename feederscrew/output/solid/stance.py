"""How a part stands before the viewer: on its aspect, its long side across the picture."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from feederscrew.output.solid.render import Camera

ELEVATION = np.radians(27.0)  # of the viewer above the floor
TURN = np.radians(32.0)  # of the part's long side out of the picture's plane
FEW = 20_000  # points that are quick to handle all of
CELLS = 24  # from the middle of the sphere of directions to its side, for more points than that
SHADOW = 1.18  # of the part's plan: the floor its shadow darkens
BACK_TALL = 0.02  # of the size: below it neither end counts as the taller


@dataclass(frozen=True, eq=False)
class Stance:
    """A solid on one aspect, all along its file's axes and in its size."""

    down: np.ndarray  # (3,) towards the floor
    along: np.ndarray  # (3,) in the floor, along the part's long side
    height: float  # [size] of the centre of mass over the floor
    camera: Camera
    plan: np.ndarray  # (N, 2) [size] the part seen from above, in the floor axes
    bounds: np.ndarray  # (2, 2) [size] lowest and highest corner of the part's image
    framed: np.ndarray  # (2, 2) [size] the same with its shadow

    @property
    def floor_axes(self):
        """(3, 3) rows x, y in the floor and z up."""
        return np.stack([self.along, np.cross(self.along, self.down), -self.down])


def stance(points, down, height):
    """Put a part on the floor and look at it.

    Parameters
    ----------
    points : (V, 3) float [size]
        Corners of its surface, about the centre of mass.
    down : (3,) float
        Outward unit normal of the aspect.
    height : float [size]
        Of the centre of mass over the floor.

    Returns
    -------
    Stance
    """
    along = _long_side(points, down)
    lean = np.cov(points @ np.cross(along, down), -points @ down)[0, 1]  # the tall end goes to the back
    return placed(points, down, height, -along if lean < -(BACK_TALL**2) else along)


def placed(points, down, height, along):
    """Return the stance whose floor axis ``along``, a unit vector, is ``TURN`` out of the picture's plane."""
    across = np.cross(along, down)
    camera = _camera(along, across, -down)
    plan = points @ np.column_stack([along, across])
    middle = 0.5 * (plan.min(axis=0) + plan.max(axis=0))
    floor = (middle + SHADOW * (plan - middle)) @ np.stack([along, across]) + height * down
    bounds = _box(camera.project(points))
    return Stance(down, along, height, camera, plan, bounds, _box(np.vstack([bounds, camera.project(floor)])))


def outermost(points):
    """Return a few thousand points that reach about as far as all of them: the farthest in each direction.

    Parameters
    ----------
    points : (V, 3) float
        Any number, about the centre of mass.

    Returns
    -------
    (N, 3) float
    """
    if len(points) <= FEW:
        return points
    radii = np.linalg.norm(points, axis=1)
    cells = np.rint(CELLS * points / np.maximum(radii, 1e-30)[:, None]).astype(np.int64) + CELLS
    keys = cells @ np.array([(2 * CELLS + 1) ** 2, 2 * CELLS + 1, 1])
    order = np.lexsort((-radii, keys))
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    return points[order[first]]


def _box(image):
    return np.stack([image.min(axis=0), image.max(axis=0)])


def _long_side(points, down):
    """Unit vector in the floor along the longer side of the smallest rectangle round the plan."""
    x = _any_across(down)
    y = np.cross(-down, x)
    plan = points @ np.column_stack([x, y])
    outline = plan[ConvexHull(plan).vertices]
    sides = np.roll(outline, -1, axis=0) - outline
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    along = np.ptp(outline @ sides.T, axis=0)
    across = np.ptp(outline @ (sides @ [[0.0, 1.0], [-1.0, 0.0]]).T, axis=0)
    best = int(np.argmin(np.round(along * across, 9)))
    u, v = sides[best] if along[best] >= across[best] else (-sides[best][1], sides[best][0])
    return u * x + v * y


def _any_across(down):
    """The file axis most across ``down``, made perpendicular to it."""
    axis = np.eye(3)[np.argmin(np.abs(np.round(down, 9)))]
    across = axis - (axis @ down) * down
    return across / np.linalg.norm(across)


def _camera(x, y, z):
    right = np.cos(TURN) * x + np.sin(TURN) * y
    ahead = np.cos(TURN) * y - np.sin(TURN) * x
    back = np.sin(ELEVATION) * z - np.cos(ELEVATION) * ahead
    return Camera(right, np.cross(back, right), back)
