"""Reciprocal screws: what a body can still do against its contacts, and how it tips off each of them."""

import numpy as np

from feederscrew.screw.angle_between import dual_angle
from feederscrew.screw.point import Point, length
from feederscrew.screw.screws import Twist

ROUNDING = 1e-12  # of the largest singular value: below it a contact adds nothing to the others


def reciprocity(first, second):
    """Return (h1 + h2) cos a - d sin a, zero where two screws are reciprocal.

    Parameters
    ----------
    first, second : Screw of shape (...,)
        Of finite pitch.

    Returns
    -------
    (...,) float [m]
        The reciprocal product of the two unit screws (twice Ball's virtual coefficient), from their lines
        and pitches alone; NaN where a screw has no axis.

    References
    ----------
    R. S. Ball, "A Treatise on the Theory of Screws", Cambridge University Press, 1900, section 10.
    """
    between = dual_angle(first, second)
    pitches = np.where(np.isfinite(between.dual), first.pitch + second.pitch, np.nan)
    return pitches * np.cos(between.real) - between.dual * np.sin(between.real)


def reciprocal_twists(wrenches):
    """Return every twist that a set of wrenches does no work on: the freedom which k contacts leave.

    Parameters
    ----------
    wrenches : Wrench of shape (..., k)
        One set a row; k of any number.

    Returns
    -------
    Twist of shape (..., 6 - r)
        Unit twists, a basis of the twists reciprocal to all k wrenches, at the first wrench's reference
        point; r is how many of the wrenches are independent. Their order and sense carry no meaning.

    Raises
    ------
    ValueError
        If the sets of a batch leave different numbers of freedoms: ask for them one at a time.

    References
    ----------
    K. H. Hunt, "Kinematic Geometry of Mechanisms", Oxford University Press, 1978.
    """
    rows, arm, point = _rows(wrenches)
    _, values, basis = np.linalg.svd(rows, full_matrices=True)
    ranks = np.unique(_rank(values))
    if len(ranks) > 1:
        raise ValueError(f"the sets of wrenches are of ranks {', '.join(map(str, ranks))}, not of one")
    return _twists(basis[..., ranks.max(initial=0) :, :], arm, point)


def tipping_twists(wrenches):
    """Return for each of six contacts the unit twist reciprocal to the other five.

    A body about to leave contact i, all others kept, moves with twist i: ``axis`` is the line it tips about.
    The sense is the one that opens the contact: the reciprocal product with its own wrench is positive.

    Parameters
    ----------
    wrenches : Wrench of shape (..., 6)
        Of the six contacts, pushing on the body.

    Returns
    -------
    Twist of shape (..., 6)
        Column i of the inverse of the six wrenches; at the first wrench's reference point.

    Raises
    ------
    ValueError
        If there are not six wrenches, or they are not independent.
    """
    rows, arm, point = _rows(wrenches)
    _check_independent(rows)
    return _twists(np.swapaxes(np.linalg.inv(rows), -1, -2), arm, point)


def reactions(wrenches, external):
    """Return how hard each of six contacts pushes: the solution of sum_i lambda_i w_i = -external.

    Each equals -(external o t_i) / (w_i o t_i) with t_i of ``tipping_twists``.

    Source: reciprocal screws, Ball 1900; docs/method/screws.md, "Contacts: reciprocal screws".

    Parameters
    ----------
    wrenches : Wrench of shape (..., 6)
        Of the six contacts, each for a reaction of 1.
    external : Wrench of shape (...,)
        All else that acts: weight, inertia, drive.

    Returns
    -------
    (..., 6) float [1]
        In units of each contact's wrench; negative where the contact would have to pull.

    Raises
    ------
    ValueError
        If there are not six wrenches, or they are not independent.
    """
    twists = tipping_twists(wrenches)
    return -_widened(external).reciprocal(twists) / wrenches.reciprocal(twists)


def _rows(wrenches):
    """Wrenches as rows (f, m / arm) of length 1, (..., k, 6), the arm (...,) [m] and their common point.

    The arm, a typical lever, makes force and moment comparable, so that no answer depends on the unit of
    length.
    """
    if len(wrenches.shape) < 1:
        raise ValueError("wrenches need an axis that counts them: (..., k)")
    reference = wrenches.reference
    if reference.coordinates.ndim > 1:
        reference = Point(reference.name, reference.coordinates[..., :1, :])
    wrenches = wrenches.at(reference)
    force, moment = (length(part).max(axis=-1, initial=0.0) for part in (wrenches.resultant, wrenches.moment))
    arm = np.divide(moment, force, out=np.ones_like(force), where=(force > 0.0) & (moment > 0.0))
    rows = np.concatenate([wrenches.resultant, wrenches.moment / arm[..., None, None]], axis=-1)
    size = np.linalg.norm(rows, axis=-1, keepdims=True)
    return rows / np.where(size > 0.0, size, 1.0), arm, reference


def _twists(columns, arm, reference):
    """Unit twists of the columns (v, arm times omega); a turn lost in rounding is none."""
    speed, spin = columns[..., :3], columns[..., 3:]
    lost = length(spin) <= ROUNDING * length(speed)
    spin = np.where(lost[..., None], 0.0, spin)
    return Twist(spin / arm[..., None, None], speed, reference).unit()


def _rank(values):
    return (values > ROUNDING * values[..., :1]).sum(axis=-1)


def _check_independent(rows):
    if rows.shape[-2] != 6:
        raise ValueError(f"there are {rows.shape[-2]} wrenches, not six")
    dependent = _rank(np.linalg.svd(rows, compute_uv=False)) < 6
    if dependent.any():
        raise ValueError(f"{dependent.sum()} of {dependent.size} sets of six wrenches are not independent")


def _widened(screw):
    """The same screws with a further axis of length 1 behind the leading ones."""
    place = screw.reference.coordinates
    point = screw.reference if place.ndim == 1 else Point(screw.reference.name, place[..., None, :])
    return type(screw)(screw.resultant[..., None, :], screw.moment[..., None, :], point)
