"""Faces that a rotation symmetry of the part carries into each other, joined into classes."""

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.geometry.graphs import component_of
from feederscrew.resting.basins.landscape import angle

SAME_WAY = np.radians(3.0)  # a turned face lies on another when their normals agree this well
SAME_SIZE = 0.007  # ... and their heights
CANDIDATES = 400  # rotations tried at most: more equal faces than that are a curve


def classes(faces, part, moments):
    """Return labels of equal faces.

    Only rotations count: a feeder cannot reflect a part, so mirror images stay apart. The rotation must be
    a symmetry of the solid, not just of its hull.

    Source: own; docs/resting.md, "Exact tumbling".

    Parameters
    ----------
    faces : list of Face
    part : Part
        With a mesh.
    moments : Moments
        Of the part.

    Returns
    -------
    (N,) int [1]
        Class of each face, numbered in order of first appearance.
    """
    middles, alike = np.array([face.middle for face in faces]), _alike(faces)
    axes = np.array([face.axis for face in faces])
    if alike.sum() == len(faces):
        return np.arange(len(faces))
    carried = np.zeros_like(alike)
    for rotation in symmetries(faces, part, moments):
        there = _along(vectors.product(axes, rotation.T), axes)
        carried |= there & _laid_on(vectors.product(middles, rotation.T), middles)
    return component_of(np.argwhere(carried & alike), len(faces))


def _laid_on(turned, middles):
    """(N, N) bool: whether the mean normals of turned faces are those of others.

    Of a round side the lowest strip says nothing: it lies wherever the tessellation begins.
    """
    apart = turned[:, None] - middles
    return vectors.norm(apart) < 2.0 * np.sin(0.5 * SAME_WAY)


def _along(turned, axes):
    """(N, N) bool: whether turned axes are parallel to others; true where one has none."""
    return ~(np.abs(vectors.product(turned, axes.T)) < np.cos(SAME_WAY))


def symmetries(faces, part, moments):
    """Return rotations that leave the solid as it is, the identity left out.

    Source: own; docs/resting.md, "Exact tumbling".

    Parameters
    ----------
    faces : list of Face
        Landmarks: a symmetry must carry them onto each other.
    part : Part
    moments : Moments
        Of the part.

    Returns
    -------
    (N, 3, 3) float [1]
        Enough of them to carry every face onto all its equals.
    """
    tolerance = moments.error + 2.0 * max(face.roughness for face in faces) / moments.size
    found = _by_landmarks(faces)
    if found is None:
        flats = [face for face in faces if face.kind == "flat"]
        found = _half_turns((flats or faces)[0].normal, moments)
    found = np.concatenate([found, _principal(part)])
    return found[moments.mismatch(found) < tolerance]


def body_frame(part, moments):
    """Return axes fixed in the part: principal axes of inertia, pointed by the solid's third moments.

    Source: the eigenvectors of the inertia matrix; own: their signs.

    Parameters
    ----------
    part : Part
        With a mesh.
    moments : Moments
        Of the part.

    Returns
    -------
    (3, 3) float [1]
        Axes as columns. Where the part is symmetric its own axes are not told apart, and the file's decide.
    """
    _, axes = vectors.eigen(part.inertia)
    skew = moments.directional(axes.T)[:, 2]
    clear = np.abs(skew) > moments.error
    largest = axes[np.argmax(np.abs(axes), axis=0), np.arange(3)]
    axes = axes * np.where(clear, np.sign(skew), np.sign(largest))
    if clear.sum() == 2:  # the third follows: a mirror plane leaves no skew across it, but a hand
        axes[:, ~clear] *= vectors.determinant(axes)
    return axes


def _alike(faces):
    """(N, N) bool: of one kind and of one height, as far as the file's noise lets us tell."""
    heights = np.array([face.height for face in faces])
    kinds = np.array([face.kind for face in faces])
    noise = 2.0 * max(face.roughness for face in faces)
    apart = np.abs(heights[:, None] - heights)
    return (apart < SAME_SIZE * np.minimum(heights[:, None], heights) + noise) & (kinds[:, None] == kinds)


def _by_landmarks(faces):
    """Rotations that carry one pair of unlike directions onto another; None where all are parallel."""
    normals = np.array([face.normal for face in faces])
    heights = np.array([face.height for face in faces])
    like = _alike(faces)
    flat = np.array([face.kind == "flat" for face in faces])
    rarest = np.lexsort((-heights, like.sum(axis=1), ~flat))
    rarest = rarest[flat[rarest]]
    for a, b in ((a, b) for a in rarest[:1] for b in rarest[1:]):
        if vectors.length(vectors.cross(normals[a], normals[b])) > np.sin(SAME_WAY):
            return _carrying(normals, a, b, np.flatnonzero(like[a] & flat), np.flatnonzero(like[b] & flat))
    return None


def _carrying(normals, a, b, a_images, b_images):
    """(N, 3, 3) rotations taking normals a, b to every pair of images that keeps their angle."""
    c, d = (images.ravel() for images in np.meshgrid(a_images, b_images, indexing="ij"))
    between = angle(normals[a], normals[b])
    kept = np.abs(angle(normals[c], normals[d]) - between) < SAME_WAY
    kept = np.flatnonzero(kept & ((c != a) | (d != b)))[:CANDIDATES]
    ends = _frames(normals[c[kept]], normals[d[kept]])
    return vectors.product(ends, _frames(normals[a], normals[b]).T)


def _half_turns(axis, moments):
    """Half turns about axes across ``axis``: the likeliest, where the solid changes least."""
    u = vectors.unit(vectors.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    v = vectors.cross(axis, u)

    def turns(phases):
        across = np.cos(phases)[:, None] * u + np.sin(phases)[:, None] * v
        return 2.0 * across[:, :, None] * across[:, None, :] - np.eye(3)

    best, width = 0.0, np.pi / 2
    for _ in range(4):  # the mismatch is a Fourier sum of the phase up to order six: a coarse grid finds it
        phases = best + width * np.linspace(-1.0, 1.0, 61)
        best, width = phases[np.argmin(moments.mismatch(turns(phases)))], width / 20
    across = turns(np.array([best]))
    along = 2.0 * np.outer(axis, axis) - np.eye(3)
    return np.concatenate([across, along[None], vectors.product(across, along)])


def _principal(part):
    """Half turns about the principal axes: all there are where the principal moments differ."""
    axes = vectors.eigen(part.inertia)[1].T
    return 2.0 * axes[:, :, None] * axes[:, None, :] - np.eye(3)


def _frames(first, second):
    """(..., 3, 3) right-handed axes as columns: along first (..., 3), and in the plane of both."""
    z = first
    y = vectors.unit(vectors.cross(first, second))
    return np.stack([vectors.cross(y, z), y, z], axis=-1)
