"""Ray-cast images of a solid: what is in front hides what is behind, whatever the mesh."""

from dataclasses import dataclass

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from feederscrew.output.solid import smoothing

AWAY = 4.0  # sizes from the centre of mass to where rays start
MISSED = -1
SINGLE = np.float32  # what the caster keeps, and more than a picture shows


class Rays:
    """A surface about its centre of mass, scaled to unit size for the single precision of the caster.

    Parameters
    ----------
    vertices : (V, 3) float [m]
        Corners of the surface.
    faces : (F, 3) int
        Corner indices, counter-clockwise seen from outside.
    centre : (3,) float [m]
        Centre of mass, in the same axes.
    """

    def __init__(self, vertices, faces, centre):
        points = np.asarray(vertices, dtype=float) - centre
        self.size = float(np.linalg.norm(points, axis=1).max())
        self.points = points / self.size
        self.faces = np.asarray(faces)
        smooth = smoothing.corner_normals(self.points, self.faces)
        self.corner_normals = None if smooth is None else smooth.astype(SINGLE)
        self._single = self.points.astype(SINGLE)
        self._scene = EmbreeScene()
        TriangleMesh(self._scene, self._single, self.faces.astype(np.int32))

    def hits(self, origins, direction):
        """Return what parallel rays meet first.

        Parameters
        ----------
        origins : (N, 3) float [size]
            Where the rays start, about the centre of mass.
        direction : (3,) float
            Unit vector they all follow.

        Returns
        -------
        distances : (N,) float [size]
            Infinite where nothing is met.
        normals : (N, 3) float
            Outward unit normals of the surface there, smooth over curved sides; zero where nothing is met.
        facets : (N,) int
            Which are met; ``MISSED`` where none is.
        """
        origins = np.ascontiguousarray(origins, dtype=SINGLE)
        directions = np.broadcast_to(np.asarray(direction, dtype=SINGLE), origins.shape)
        found = self._scene.run(origins, np.ascontiguousarray(directions), output=True)
        met = found["primID"] != MISSED
        normals = np.zeros(origins.shape, dtype=SINGLE)
        normals[met] = self._normals(found["primID"][met], found["u"][met], found["v"][met])
        return np.where(met, found["tfar"], SINGLE(np.inf)), normals, found["primID"]

    def _normals(self, triangle, u, v):
        if self.corner_normals is None:
            a, b, c = np.moveaxis(self._single[self.faces[triangle]], 1, 0)
            normals = np.cross(b - a, c - a)
        else:
            weights = np.column_stack([1.0 - u - v, u, v])
            normals = np.einsum("nk,nki->ni", weights, self.corner_normals[triangle])
        return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


@dataclass(frozen=True, eq=False)
class Camera:
    """Parallel projection; its axes are given along the solid's axes."""

    right: np.ndarray  # (3,)
    up: np.ndarray  # (3,)
    back: np.ndarray  # (3,) towards the viewer

    def project(self, points):
        """Project (N, 3) points to (N, 2), across and up the image, in the points' unit."""
        return np.asarray(points) @ np.column_stack([self.right, self.up])

    def origins(self, across, up):
        """Return the ray starts (rows, columns, 3) for a grid of image positions, in sizes of the solid."""
        u, v = np.meshgrid(np.asarray(across, SINGLE), np.asarray(up, SINGLE))
        right, above, back = (axis.astype(SINGLE) for axis in (self.right, self.up, self.back))
        return u[..., None] * right + v[..., None] * above + SINGLE(AWAY) * back

    def cast(self, solid, across, up):
        """Return depths behind the ray starts (rows, columns) and normals (rows, columns, 3) over a grid."""
        return self.meet(solid, across, up)[:2]

    def meet(self, solid, across, up):
        """Return depths, normals and facets (rows, columns), ``MISSED`` without one, over a grid."""
        origins = self.origins(across, up)
        distances, normals, facets = solid.hits(origins.reshape(-1, 3), -self.back)
        grid = origins.shape[:2]
        return distances.reshape(grid), normals.reshape(origins.shape), facets.reshape(grid)

    def sees(self, solid, points, slack=0.01, away=AWAY):
        """Return which of (N, 3) points, less than ``away`` behind the solid, it does not hide; (N,) bool."""
        starts = points + away * self.back
        distances = solid.hits(starts, -self.back)[0]
        return distances > away - slack
