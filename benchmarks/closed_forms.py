"""Closed forms tried against the recommended one, for ``accuracy.py``; each weighs the faces of a body."""

import numpy as np

from feederscrew.resting.basins import barriers
from feederscrew.resting.tumbling.exact import tumble

DIRECTIONS = 3000  # of the quadrature over the sphere
STEPS = (0.02,) * 150 + (0.004,) * 30  # [rad] of a walk down the height


def depth(body):
    """How far each face lies under the highest way to stand, over that height."""
    return 1.0 - np.nan_to_num(body.tips.heights) / body.radius


def free_moment(body):
    """Moment about each face's normal with the other two rotations left free, over the height."""
    normals = np.array([face.normal for face in body.ground.faces])
    heights = np.array([face.height for face in body.ground.faces])
    inverse = np.linalg.inv(body.part.inertia)
    return 1.0 / np.einsum("fi,ij,fj->f", normals, inverse, normals) / heights


def finite_barriers(body):
    """Lowest lift off each face; the radius where nothing tips it."""
    lifts = barriers.barriers(body.tips)
    return np.where(np.isfinite(lifts), lifts, body.radius)


def with_critical_angle(body):
    """Geometric mean of the critical solid angle and the surface-weighted rule."""
    faces = body.ground.faces
    heights, angles = np.array([f.height for f in faces]), np.array([f.solid_angle for f in faces])
    critical = barriers.critical_solid_angles([f.polygon for f in faces], heights) * angles / heights
    return np.sqrt(critical * body.tips.shares * depth(body) ** 2)


def splits(body):
    """From the top down, each saddle splits the probability by basin x depth under it on both sides."""
    tips, shares = body.tips, np.nan_to_num(body.tips.shares)
    weights, groups, events = (shares > 0.0).astype(float), {k: [k] for k in range(len(shares))}, []
    home = np.arange(len(shares))
    for k in np.argsort(tips.tops, kind="stable"):
        one, other = home[tips.pairs[k]]
        if one != other:
            events.append((tips.tops[k], groups[one], groups[other]))
            groups[one] = groups[one] + groups.pop(other)
            home[groups[one]] = one
    for top, *sides in reversed(events):
        rooms = [(shares[s] * np.maximum(top - np.nan_to_num(tips.heights[s]), 0.0)).sum() for s in sides]
        for side, room in zip(sides, rooms):
            weights[side] *= room / max(sum(rooms), np.finfo(float).tiny)
    return weights


def phase_space(body):
    """Integral over each basin of (R - H)^(5/2): the motions of a part that touches the floor (five
    freedoms) with the energy of its highest way to stand, by attitude."""
    rooms, ends = _walked(body)
    return np.bincount(ends, rooms**2.5, minlength=len(body.tips.shares))


def _walked(body):
    """Depth under R of many directions, and the face each rolls to in small steps."""
    hull = body.ground.hull
    k = np.arange(DIRECTIONS) + 0.5
    turn, z = np.pi * (1.0 + np.sqrt(5.0)) * k, 1.0 - 2.0 * k / DIRECTIONS
    down = np.column_stack([np.sqrt(1.0 - z * z) * np.cos(turn), np.sqrt(1.0 - z * z) * np.sin(turn), z])
    corners = hull.vertices / hull.radius
    rooms = 1.0 - (down @ corners.T).max(axis=1)
    for step in STEPS:
        slope = corners[np.argmax(down @ corners.T, axis=1)]
        slope = slope - np.einsum("ni,ni->n", slope, down)[:, None] * down
        down = down - step * slope / np.maximum(np.linalg.norm(slope, axis=1), step)[:, None]
        down /= np.linalg.norm(down, axis=1)[:, None]
    found = tumble(hull)
    faces = barriers.named(found, body.ground.labels[found.sinks])
    return np.maximum(rooms, 0.0), faces[np.argmax(down @ found.normals.T, axis=1)]


TRIED = {
    "pmi, other rotations free": free_moment,
    "basin x lowest barrier": lambda body: body.tips.shares * finite_barriers(body),
    "basin x exp(-5 h / R)": lambda body: body.tips.shares * np.exp(5.0 * (depth(body) - 1.0)),
    "basin x (R - h) / h": lambda body: (
        body.tips.shares * depth(body) / (1.0 - np.minimum(depth(body), 0.99))
    ),
    "surface x critical angle": with_critical_angle,
    "splits at the saddles": splits,
    "integral of (R - H)^(5/2)": phase_space,
}
