"""The acceleration of a part that slides along the track, at any phase and speed, and where it breaks loose.

While one set of wall contacts is closed, everything is linear in the load. So a sense of sliding and a set of
contacts are a few rows of three numbers, found once.
"""

import math

import numpy as np

from feederscrew.mechanics import cycle
from feederscrew.mechanics.floor.balance import HOP
from feederscrew.mechanics.track import system

NEAR = 1e-13  # [rad] width of the bracket in which a part breaks loose
STEPS = 60
BEYOND = 1e9  # [1] friction in place of one that is not finite


def acceleration(seat, bowl, axes, least):
    """Return the acceleration of a sliding part as a function of phase, speed and sense.

    Source: ``system.sliding``, which is linear in the load.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
        Single values.
    axes : TrackAxes
    least : float [m/s2]
        A reaction per unit of mass more negative than this would be a pull.

    Returns
    -------
    callable
        From phase [rad], speed [m/s] along the track and sense, +1 or -1, to an acceleration [m/s2]; of a
        part that has lost contact, what the load gives it.
    """
    rows = {sense: _rows(seat, bowl, axes, sense) for sense in (1.0, -1.0)}
    omega = 2.0 * np.pi * bowl.drive.frequency
    stroke, radius = float(bowl.drive.amplitude * omega), float(bowl.track.radius)
    drive, up, radial = (vector.tolist() for vector in (axes.drive, axes.up, axes.radial))
    weight = [bowl.gravity * component for component in up]

    def at(phase, speed, sense):
        push = stroke * omega * math.sin(phase)
        outward = (drive[0] * stroke * math.cos(phase) + speed) ** 2 / radius
        x = push * drive[0] - weight[0] - outward * radial[0]
        y = push * drive[1] - weight[1] - outward * radial[1]
        z = push * drive[2] - weight[2] - outward * radial[2]
        chosen = rows[sense][0]
        for row in rows[sense]:
            (a, b, c), (d, e, f) = row[2], row[3]
            if a * x + b * y + c * z >= least and d * x + e * y + f * z >= least:
                chosen = row
                break
        (a, b, c), (d, e, f) = chosen[:2]
        return a * x + b * y + c * z if d * x + e * y + f * z > 0.0 else x

    return at


def windows(rest, needed, static, samples=cycle.SAMPLES):
    """Return the phases at which a part at rest breaks loose.

    Source: Coulomb's law on the reactions of ``system.held``; docs/mechanics.md, "The track".

    Parameters
    ----------
    rest : callable
        From phases, (N,) float [rad], to the TrackMotion of a part at rest.
    needed : callable
        From the same to the friction that holds it, (N,) float [1]; NaN or infinite where none does.
    static : float [1]
    samples : int
        At which it is looked for; a multiple of four, so that both reversals are among them.

    Returns
    -------
    list of (float [rad], float [rad], float [1])
        As ``cycle.settle`` takes them.
    """
    phase = cycle.phases(samples)
    sense = _sense(rest(phase), static)
    change = np.flatnonzero(sense != np.roll(sense, 1))
    if len(change) == 0:
        return [(0.0, cycle.TURN, float(sense[0]))] if sense[0] else []
    before, step = sense[change - 1], cycle.TURN / samples
    low, high = phase[change] - step, phase[change].copy()
    edges = _edges(lambda at: needed(at) - static, low, high, (before != 0.0) & (sense[change] == 0.0))
    return _cut(edges, sense[change])


def _edges(beyond, low, high, falls):
    """Phases at which a margin passes zero, each within a bracket; where it is not finite, it is positive.

    Brackets whose ends are both loose, one way and the other, close in on their lower end.
    """
    sign = np.where(falls, -1.0, 1.0)
    left, right = (sign * np.nan_to_num(beyond(at), nan=BEYOND, posinf=BEYOND) for at in (low, high))
    for count in range(STEPS):
        if (high - low).max() <= NEAR:
            break
        share = np.where((left < 0.0) & (right > 0.0) & (count % 3 < 2), left / (left - right), 0.5)
        middle = low + (high - low) * share
        now = sign * np.nan_to_num(beyond(middle), nan=BEYOND, posinf=BEYOND)
        below, met = now <= 0.0, np.abs(now) <= NEAR
        low, left = np.where(below, middle, low), np.where(below, now, left)
        high, right = np.where(below, high, middle), np.where(below, right, now)
        low, high = np.where(met, middle, low), np.where(met, middle, high)
    return high


def _cut(starts, senses):
    """Windows within one period from where each begins; a state lasts to the next one's begin."""
    found = []
    for start, end, sense in zip(starts, np.append(starts[1:], starts[0] + cycle.TURN), senses):
        if sense and end > cycle.TURN:
            found += [(0.0, float(end - cycle.TURN), float(sense)), (float(start), cycle.TURN, float(sense))]
        elif sense:
            found.append((float(start), float(end), float(sense)))
    return sorted(found)


def _sense(rest, static):
    """Way in which a part at rest breaks loose: +1, -1, or 0 where it is held."""
    loose = (rest.state == HOP) | ~(rest.needed[:, 0] <= static)
    return np.where(loose, np.where(rest.acceleration[:, 0] > 0.0, 1.0, -1.0), 0.0)


def _rows(seat, bowl, axes, sense):
    """For each set of closed contacts the rows of acceleration, normal force and two margins.

    Each row is a list of three numbers: the value for a unit of load per mass along X, Y and Z.
    """
    unit = seat.mass * np.eye(3)
    course = np.tile(sense * system.AHEAD, (3, 1))
    wall, found = sense * bowl.friction.wall, []
    for closed in system.SETS:
        use = np.full(3, wall if any(closed) else 0.0)
        one = system.sliding(seat, axes, unit, closed, np.full(3, bowl.friction.kinetic), use, course)
        conditions = [one.walls[:, k] if shut else one.parting[:, k] for k, shut in enumerate(closed)]
        rows = (one.acceleration[:, 0], one.normal, *conditions)
        along, normal, *conditions = (row.tolist() for row in rows)
        found.append((along, normal, *conditions))
    return found
