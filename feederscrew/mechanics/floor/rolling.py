"""A part that rolls on the floor: friction follows from the rolling, up to where it slips as well."""

from dataclasses import dataclass

import numpy as np

from feederscrew.geometry import vectors

HALVINGS = 90  # of the interval of slip accelerations: down to rounding


@dataclass(frozen=True, eq=False)
class Rolling:
    """Forces on a rolling part; vectors in body axes, (..., 2)."""

    friction: np.ndarray  # (..., 2) [N] of the floor on the part
    acceleration: np.ndarray  # (..., 2) [m/s2] of the axis relative to the bowl
    rolling_acceleration: np.ndarray  # (...) [rad/s2] about the axis, or the y axis; right-handed
    slips: np.ndarray  # (...) bool, as well as rolling
    limiting_friction: np.ndarray  # (...) [1] least static friction with which it only rolls


def rolling(posture, coefficients, push, normal):
    """Return a part on a rolling aspect, from rest.

    Parameters
    ----------
    posture : Posture
        With a rolling axis through the centre of mass, ``height`` above the floor; a ball has none and
        rolls every way.
    coefficients : Friction
        Static decides whether it slips, kinetic how.
    push : (..., 2) float [N]
        Drive along the floor.
    normal : (...) float [N]
        Normal force.

    Returns
    -------
    Rolling

    Notes
    -----
    Rolling, the contact line stays at rest: across the axis friction is T I / (I + m h^2), a third of the
    drive for a solid cylinder, and along the axis the whole drive; for a ball it is two sevenths of the
    drive either way. Where their sum
    exceeds static friction, kinetic friction acts against the slip of the contact line, whose direction
    follows from itself.

    References
    ----------
    The thesis, chapter 1, on Diaz (2004): friction of a rolling cylinder is found, not assumed to be mu N.
    """
    axis = np.array([0.0, 1.0]) if posture.axis is None else posture.axis
    frame = np.array([[-axis[1], axis[0]], axis])  # rows: across, along
    inertia, other = (_about(line, posture.inertia[:2, :2]) for line in frame[::-1])
    turning = np.array([1.0 / inertia, 1.0 / other if posture.axis is None else 0.0])  # for a moment of 1
    ease = 1.0 / posture.mass + posture.height**2 * turning  # of the contact
    drive = vectors.product(push, frame.T) / posture.mass
    need = drive / ease
    limiting = np.divide(
        np.hypot(need[..., 0], need[..., 1]),
        normal,
        out=np.full(np.shape(normal), np.nan),
        where=normal > 0.0,
    )
    slips = ~(limiting <= coefficients.static)
    resisted = np.where(slips[..., None], _slipping(drive, ease, coefficients.kinetic * normal), need)
    friction = -vectors.product(resisted, frame)
    return Rolling(
        friction=friction,
        acceleration=(push + friction) / posture.mass,
        rolling_acceleration=resisted[..., 0] * posture.height / inertia * -1.0,
        slips=slips,
        limiting_friction=limiting,
    )


def _about(axis, inertia):
    """Moment of inertia about a line in the floor."""
    return float(vectors.dot(vectors.product(axis, inertia), axis))


def _slipping(drive, ease, strength):
    """Resistance of a given strength along the slip that remains under it, (..., 2) across and along."""
    drive = np.broadcast_to(drive, (*np.broadcast_shapes(drive.shape[:-1], np.shape(strength)), 2))
    low, high = np.zeros(drive.shape[:-1]), np.hypot(drive[..., 0], drive[..., 1])
    for _ in range(HALVINGS):
        slip = 0.5 * (low + high)
        direction = _direction(drive, ease, strength, slip)
        too_slow = np.hypot(direction[..., 0], direction[..., 1]) > 1.0
        low, high = np.where(too_slow, slip, low), np.where(too_slow, high, slip)
    return np.asarray(strength)[..., None] * _direction(drive, ease, strength, high)


def _direction(drive, ease, strength, slip):
    """Direction of a slip of given acceleration; of length 1 for the one that happens."""
    stiffness = slip[..., None] + np.asarray(strength)[..., None] * ease
    return np.divide(drive, stiffness, out=np.zeros(drive.shape), where=stiffness > 0.0)
