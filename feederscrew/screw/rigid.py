"""Rigid displacements: a rotation followed by a translation."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.screw.point import Point, vectors
from feederscrew.screw.screws import Screw

ORTHOGONAL_WITHIN = 1e-9  # of a rotation matrix: far above rounding, far below a typing slip


@dataclass(frozen=True, eq=False)
class Displacement:
    """x goes to R x + t. ``@`` applies it: to a point, to a screw, or after another displacement.

    A screw is carried along with its reference point (O becomes O'); use ``.at(ORIGIN)`` to express the
    moved screw where the old one was.

    Parameters
    ----------
    rotation : (..., 3, 3) float [1]
        R, a proper rotation matrix.
    translation : (..., 3) float [m]
        t, where the origin goes.

    Raises
    ------
    ValueError
        If R is not a proper rotation, a shape is wrong or an entry is not finite.
    """

    rotation: np.ndarray
    translation: np.ndarray

    def __post_init__(self):
        rotation = vectors("rotation", self.rotation)
        if rotation.shape[-2:] != (3, 3):
            raise ValueError(f"rotation has shape {rotation.shape}, not (..., 3, 3)")
        skew = np.abs(rotation @ np.swapaxes(rotation, -1, -2) - np.eye(3)).max(initial=0.0)
        if skew > ORTHOGONAL_WITHIN or (np.linalg.det(rotation) < 0.0).any():
            raise ValueError("rotation is not a proper rotation matrix")
        shape = np.broadcast_shapes(rotation.shape[:-1], np.shape(self.translation))
        translation = vectors("translation", np.broadcast_to(self.translation, shape))
        object.__setattr__(self, "rotation", check.frozen(np.broadcast_to(rotation, (*shape, 3)).copy()))
        object.__setattr__(self, "translation", translation)

    def __matmul__(self, other):
        """The moved point or screw, or the displacement that does ``other`` first and then this one."""
        if isinstance(other, Displacement):
            return Displacement(self.rotation @ other.rotation, self._moved(other.translation))
        if isinstance(other, Point):
            return Point(f"{other.name}'", self._moved(other.coordinates))
        if isinstance(other, Screw):
            resultant, moment = (_turned(self.rotation, part) for part in (other.resultant, other.moment))
            return type(other)(resultant, moment, self @ other.reference)
        raise ValueError(f"a displacement moves points, screws and displacements, not {type(other).__name__}")

    def inverse(self):
        """Return the displacement back: x goes to R^T (x - t)."""
        back = np.swapaxes(self.rotation, -1, -2)
        return Displacement(back, -_turned(back, self.translation))

    @property
    def matrix(self):
        """Homogeneous matrix [R t; 0 1], (..., 4, 4)."""
        matrix = np.zeros((*self.translation.shape[:-1], 4, 4))
        matrix[..., :3, :3], matrix[..., :3, 3], matrix[..., 3, 3] = self.rotation, self.translation, 1.0
        return matrix

    def _moved(self, positions):
        return _turned(self.rotation, positions) + self.translation


def _turned(rotation, u):
    return np.einsum("...ij,...j->...i", rotation, u)
