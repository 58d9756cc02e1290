"""Views of a solid as lines: its sharp edges and outlines, as far as it does not hide them itself."""

import numpy as np

from feederscrew.output.shading import Camera, Rays

SHARP = np.cos(np.radians(20.0))  # of the normals on both sides of an edge that is drawn
STEP = 0.006  # of the solid's size: places along an edge at which it is looked at
OFF = 2e-3  # of the solid's size: by which a place is moved off the surface before it is looked at


def camera(azimuth, elevation):
    """Return the camera that looks from an azimuth and an elevation [deg]."""
    a, e = np.radians(azimuth), np.radians(elevation)
    back = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return Camera(right, np.cross(back, right), back)


def lines(vertices, faces, looked):
    """Return the visible edges of a closed surface.

    Parameters
    ----------
    vertices : (V, 3) float
    faces : (F, 3) int
    looked : Camera

    Returns
    -------
    (N, 2, 2) float
        Ends of each piece, across and up the view, in the vertices' unit, from their origin.
    """
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    rays = Rays(vertices, faces, centre)
    a, b, push = _edges(rays.points, faces, looked.back)
    count = np.maximum(1, np.ceil(np.sqrt(((b - a) ** 2).sum(axis=1)) / STEP)).astype(int)
    owner = np.repeat(np.arange(len(a)), count)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    ends = [a[owner] + (b - a)[owner] * ((place + k) / count[owner])[:, None] for k in (0, 1)]
    middle = 0.5 * (ends[0] + ends[1]) + OFF * push[owner] + OFF * looked.back
    seen = looked.sees(rays, middle, slack=OFF)
    pieces = np.stack([looked.project(end[seen]) for end in ends], axis=1)
    return pieces * rays.size + looked.project(centre[None])[0]


def _edges(points, faces, back):
    """Ends of the edges that are drawn, and the direction off the surface there."""
    corners = points[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.sqrt((normal**2).sum(axis=1, keepdims=True)), 1e-30)
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    owner = np.tile(np.arange(len(faces)), 3)
    order = np.lexsort(np.sort(sides, axis=1).T)
    one, other = owner[order[0::2]], owner[order[1::2]]
    pair = sides[order[0::2]]
    cosine = (normal[one] * normal[other]).sum(axis=1)
    facing = (normal * back).sum(axis=1)
    drawn = (cosine < SHARP) | ((facing[one] > 1e-6) != (facing[other] > 1e-6))
    drawn &= (facing[one] > -1e-6) | (facing[other] > -1e-6)
    push = (normal[one] + normal[other])[drawn]
    return points[pair[drawn, 0]], points[pair[drawn, 1]], push
