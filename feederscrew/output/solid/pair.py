"""A part on a track, rendered together: what of the part a blade or the track hides shines through."""

import numpy as np

from feederscrew.output.solid.render import AWAY, Rays
from feederscrew.output.solid.shading import EDGE, STEEL, Shot, averaged, edges, lit

METAL = np.array([0.90, 0.91, 0.92])  # the track
SAMPLES = 2  # rays a pixel, each way
COARSE = 40  # rays each way to find out what is hidden
THROUGH = 0.45  # of its colour: the part where something is in front of it


def picture(track, part, centre, camera, half, columns, rows):
    """Render a part on a track as an image.

    Parameters
    ----------
    track, part : ((V, 3) float [m], (F, 3) int)
        Corners and faces of each, in the same axes.
    centre : (3,) float [m]
        In the middle of the image.
    camera : Camera
    half : float [m]
        What is seen to either side of it.
    columns, rows : int
        Pixels.

    Returns
    -------
    image : (rows, columns, 3) float
        0 to 1, the top row first.
    frame : Shot
        Where it lies in the image plane, in units of ``size``.
    size : float [m]
    """
    (ground, sides), (corners, faces) = track, part
    whole = Rays(np.vstack([ground, corners]), np.vstack([sides, faces + len(ground)]), centre)
    half = half / whole.size
    frame = Shot(-half, -half * rows / columns, 2.0 * half / columns, columns, rows)
    across, up = frame.positions(SAMPLES)
    depths, normals = camera.cast(whole, across, up)
    near, own = _part_alone(part, centre, camera, whole.size, across, up)
    met, there = np.isfinite(depths), np.isfinite(near)
    is_part = there & (near <= np.where(met, depths, np.inf) + 1e-3)
    image = np.ones((*depths.shape, 3))
    for mask, colour in ((met & ~is_part, METAL), (met & is_part, STEEL)):
        image[mask] = lit(normals[mask], camera, colour)
    step = up[0] - up[1]
    image[edges(depths, normals, camera, step)] = EDGE
    hidden = there & ~is_part
    shape = lit(own[hidden], camera, STEEL)
    shape[edges(near, own, camera, step)[hidden]] = EDGE
    image[hidden] += THROUGH * (shape - image[hidden])
    return averaged(image, SAMPLES), frame, whole.size


def shown_share(track, part, centre, camera, half):
    """Return the share [1] of what is to be seen of a part that the track does not hide.

    Parameters
    ----------
    track, part, centre, camera, half
        As for ``picture``.
    """
    (ground, sides), (corners, faces) = track, part
    whole = Rays(np.vstack([ground, corners]), np.vstack([sides, faces + len(ground)]), centre)
    across = up = np.linspace(-half, half, COARSE) / whole.size
    depths, _ = camera.cast(whole, across, up)
    near, _ = _part_alone(part, centre, camera, whole.size, across, up)
    there = np.isfinite(near)
    seen = there & (near <= np.where(np.isfinite(depths), depths, np.inf) + 1e-3)
    return float(seen.sum() / max(there.sum(), 1))


def _part_alone(part, centre, camera, size, across, up):
    """Depths (rows, columns) in a size, and normals, of the part without the track."""
    corners, faces = part
    alone = Rays(corners, faces, centre)
    scale = size / alone.size
    near = np.full((len(up), len(across)), np.inf)
    normals = np.zeros((*near.shape, 3))
    low, high = (end(camera.project(corners - centre), axis=0) / size for end in (np.min, np.max))
    columns = np.flatnonzero((across > low[0]) & (across < high[0]))
    rows = np.flatnonzero((up > low[1]) & (up < high[1]))
    if len(columns) and len(rows):
        box = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        near[box], normals[box] = camera.cast(alone, across[columns] * scale, up[rows] * scale)
    return (near - AWAY) / scale + AWAY, normals
