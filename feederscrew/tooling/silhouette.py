"""What a gate across the track sees of a part that goes through it."""

import numpy as np
import shapely

from feederscrew.geometry.polygons import turned
from feederscrew.tooling.contact import SLIVER, rings

FINEST = 3e-5  # [m] to which the silhouette is exact on a curved track
PLAIN = 1e-4  # of the part's size: corners that stand out by less are left out
GRID = 1e-8  # [m]


def silhouette(posture, heading, distance, radius):
    """Return the outline of a part seen along the track.

    Parameters
    ----------
    posture : Posture
        Of a part with a mesh.
    heading : float [rad]
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.

    Returns
    -------
    tuple of (K, 2) float [m]
        Rings of distance from the wall and height over the track, swept past a radial gate.
    """
    points, faces = posture.surface, posture.solid.faces
    plan = turned(points[:, :2], heading)
    corners = np.column_stack([plan[:, 0], radius - distance - plan[:, 1], points[:, 2]])[faces]
    corners = _short(corners, np.sqrt(8.0 * radius * FINEST))
    seen = np.stack([radius - np.hypot(corners[..., 0], corners[..., 1]), corners[..., 2]], axis=-1)
    a, b, c = seen[:, 0], seen[:, 1], seen[:, 2]
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    whole = shapely.union_all(shapely.polygons(seen[twice > 1e-14]), grid_size=GRID)
    size = np.ptp(points, axis=0).max()
    return rings(whole.simplify(PLAIN * size), SLIVER * size**2)


def _short(corners, longest):
    """Triangles halved along the track until none is longer than the curve allows."""
    done = []
    while len(corners):
        along = corners[..., 0]
        side = np.abs(np.roll(along, -1, axis=1) - along)
        k = side.argmax(axis=1)
        small = side.max(axis=1) <= longest
        done.append(corners[small])
        corners, k = corners[~small], k[~small]
        rows = np.arange(len(corners))
        a, b, c = corners[rows, k], corners[rows, (k + 1) % 3], corners[rows, (k + 2) % 3]
        middle = 0.5 * (a + b)
        corners = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
    return np.concatenate(done)
