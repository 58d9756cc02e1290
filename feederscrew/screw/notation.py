"""One screw in the four notations: vectors, dual vector, Pluecker coordinates, Lie algebra."""

import numpy as np

from feederscrew.screw.point import ORIGIN, skew
from feederscrew.screw.screws import Momentum, Screw, Twist, Wrench

LETTERS = {Twist: ("omega", "v"), Wrench: ("f", "m"), Momentum: ("q", "H"), Screw: ("s", "s")}
PRINTED_FROM = 1e-12  # of the largest number in a line: what is smaller is rounding and prints as 0


def pluecker(screw):
    """Return Pluecker coordinates: of a twist (v; omega), of every other screw ray coordinates (s; s0).

    Source: docs/method/screws.md, "Four notations".

    Parameters
    ----------
    screw : Screw of shape (...,)
        Its moment part is taken about its own reference point.

    Returns
    -------
    (..., 6) float [m/s, rad/s] of a twist, [N, N m] of a wrench
        Ordered so that the plain product of a twist's and a wrench's six numbers is their power.
    """
    parts = (screw.resultant, screw.moment)
    return np.concatenate(parts[::-1] if isinstance(screw, Twist) else parts, axis=-1)


def from_pluecker(kind, coordinates, reference=ORIGIN):
    """Return the ``Twist``, ``Wrench``, ``Momentum`` or ``Screw`` of six coordinates (..., 6)."""
    coordinates = np.asarray(coordinates, dtype=float)
    if coordinates.ndim == 0 or coordinates.shape[-1] != 6:
        raise ValueError(f"coordinates has shape {coordinates.shape}, not (..., 6)")
    parts = coordinates[..., :3], coordinates[..., 3:]
    return kind(*(parts[::-1] if issubclass(kind, Twist) else parts), reference)


def lie_matrix(screw):
    """Return the screw as an element of se(3), [s~ s0; 0 0] with s~ u = s x u, (..., 4, 4).

    Of a twist it turns the homogeneous coordinates of a body point, measured from the reference point, into
    that point's velocity.
    """
    matrix = np.zeros((*screw.shape, 4, 4))
    matrix[..., :3, :3], matrix[..., :3, 3] = skew(screw.resultant), screw.moment
    return matrix


def from_lie_matrix(kind, matrix, reference=ORIGIN):
    """Return the screw of a kind from its matrix (..., 4, 4); only the part that is skew is read."""
    matrix = np.asarray(matrix, dtype=float)
    if matrix.shape[-2:] != (4, 4):
        raise ValueError(f"matrix has shape {matrix.shape}, not (..., 4, 4)")
    upper, lower = [2, 0, 1], [1, 2, 0]
    resultant = 0.5 * (matrix[..., upper, lower] - matrix[..., lower, upper])
    return kind(resultant, matrix[..., :3, 3], reference)


def text(screw):
    """Return four lines for people, one a notation, in SI units about the screw's own reference point.

    Parameters
    ----------
    screw : Screw of shape ()
        One screw.

    Returns
    -------
    str
        Six significant digits. The second line splits the screw into magnitude and pitch, and line; of a
        screw of infinite pitch the line has a direction and no place.

    Raises
    ------
    ValueError
        If it is a batch.
    """
    if screw.shape:
        raise ValueError(f"there are {screw.shape} screws to print, not one")
    s, s0 = LETTERS[type(screw)]
    s0 = f"{s0}_{screw.reference.name}"
    return "\n".join(
        (
            f"vectors   ({s}, {s0}) = ({_row(screw.resultant)}, {_row(screw.moment)})",
            f"dual      {s} + eps {s0} = {_dual_form(screw)}",
            f"Pluecker  {_pluecker_form(screw, s, s0)}",
            f"Lie       {_matrix_form(lie_matrix(screw))}, {_row(pluecker(screw))}",
        )
    )


def _dual_form(screw):
    axis = screw.axis
    line = np.cross(axis.foot - screw.reference.coordinates, axis.direction)
    size, along = _numbers((screw.norm.real, screw.norm.dual))
    direction, line = (_row(np.nan_to_num(part)) for part in (axis.direction, line))
    return f"({size} + eps {along}) ({direction} + eps {line})"


def _pluecker_form(screw, s, s0):
    halves = np.split(pluecker(screw.unit()), 2)
    names = (s0, s) if isinstance(screw, Twist) else (s, s0)
    return f"[{'; '.join(names)}] = {screw.magnitude:.6g} [{'; '.join(map(_row, halves))}]"


def _matrix_form(matrix):
    return f"[{'; '.join(' '.join(_numbers(row)) for row in matrix)}]"


def _row(values):
    return f"({', '.join(_numbers(values))})"


def _numbers(values):
    least = PRINTED_FROM * np.abs(values).max()
    return [f"{value if abs(value) > least else 0.0:.6g}" for value in values]
