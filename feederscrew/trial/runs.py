"""Parts one at a time past one station: starts, runs on several cores, and what became of them."""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from feederscrew import check
from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.floor_motion import Floor
from feederscrew.dropping.plate import drive
from feederscrew.dropping.pool import in_batches
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import on_disk
from feederscrew.trial import stations
from feederscrew.trial.kernel import contact, motion, travel

PASSED, RETURNED, RUNNING = travel.PASSED, travel.RETURNED, travel.RUNNING
PERIOD, HOPPING = 80, 160  # steps of a period of the drive, and where parts hop
SWEEPS, CONVERGED = 60, 1e-4  # of the contact solver: at most, and what a sweep may still change
CONTACTS = 96  # of a part at a time
BATCH = 5  # parts a core takes at a time


class WorkingArrays(NamedTuple):
    """Arrays the kernel works in."""

    state: np.ndarray
    saved: np.ndarray
    push: np.ndarray
    turn: np.ndarray  # (9,)
    tangent: np.ndarray  # (2,)
    spots: np.ndarray  # (C, 3)
    shown: np.ndarray  # (C, 3)
    near: np.ndarray  # (B,) int
    low: np.ndarray  # (C,) int
    edges: np.ndarray  # (E,) int
    faces: np.ndarray  # (T,) int
    box: np.ndarray  # (4,)
    vectors: np.ndarray  # (3, 3)
    contacts: np.ndarray  # (CONTACTS, WIDTH)
    memory: np.ndarray  # (2,) how many of them the step before had, and how long it was


@dataclass(frozen=True, eq=False)
class Runs:
    """What became of N parts at one station, in SI units; K places of each."""

    outcomes: np.ndarray  # (N,) int: PASSED, RETURNED or RUNNING
    states: np.ndarray  # (N, 13) at the end, without dimensions
    seconds: np.ndarray  # (N,) [s]
    ways: np.ndarray  # (N,) [m] along the wall
    depths: np.ndarray  # (N,) [m] the deepest that anything was in anything
    gains: np.ndarray  # (N,) [m] largest rise of the energy over what gravity and the drive gave, as a height
    paths: np.ndarray  # (N, K, 8) time [s], position [m], attitude; NaN after the end
    partial: bool  # stopped by the user before all parts were done


@dataclass(frozen=True, eq=False)
class BowlOfPart:
    """A part in a bowl, without dimensions."""

    solid: object  # trial.shape.TrueSolid
    length: float  # [m] the unit of length
    unit: float  # [s] the unit of time
    floor: Floor
    radius: float  # of the wall
    gravity: np.ndarray  # (3,)
    friction: np.ndarray  # (5,)
    restitution: float
    threshold: float


def setting(solid, length, bowl):
    """Return what the kernel needs of a bowl.

    Parameters
    ----------
    solid : TrueSolid
    length : float [m]
        Its unit.
    bowl : Bowl

    Returns
    -------
    BowlOfPart
    """
    floor, track, friction = drive.floor_of(bowl, length), bowl.track, bowl.friction
    if bowl.drive.amplitude == 0.0:
        floor = floor._replace(along=0.0, up=0.0)
    c, s = np.cos(track.climb), np.sin(track.climb)
    steps = HOPPING if drive.throw_number(bowl) > 1.0 else PERIOD
    return BowlOfPart(
        solid=solid,
        length=length,
        unit=float(np.sqrt(length / bowl.gravity)),
        floor=floor._replace(step=2.0 * np.pi / floor.rate / steps),
        radius=track.radius / length,
        gravity=np.array([-s, -c * np.sin(track.bank), -c * np.cos(track.bank)]),
        friction=np.array([friction.static, friction.kinetic, *friction.backward, friction.wall]),
        restitution=bowl.restitution,
        threshold=drive.steps_of(floor).threshold,
    )


def laid(orientation, principal, length, track, *, place, aside=0.0, turn=0.0):
    """Return the state of a part laid on the track in an orientation.

    Parameters
    ----------
    orientation : Orientation
    principal : (3, 3) float [1]
        From ``solid_of``.
    length : float [m]
        The unit of length.
    track : Track
    place : float [m]
        Of its centre of mass along the wall.
    aside : float [m]
        From the wall.
    turn : float [rad]
        Of its heading, counter-clockwise.

    Returns
    -------
    (13,) float
    """
    theta, angle = place / track.radius, place / track.radius + orientation.heading + turn
    axes = vectors.product(_about_z(angle), vectors.product(orientation.posture.axes, principal))
    off = track.radius - orientation.distance - aside
    state = np.zeros(body.STATE)
    state[:3] = off * np.sin(theta), track.radius - off * np.cos(theta), orientation.posture.height
    state[:3] /= length
    state[body.Q : body.Q + 4] = quaternion(axes)
    return state


def _about_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def quaternion(axes):
    """Return the quaternion (4,), w x y z, of a rotation matrix (3, 3)."""
    trace = np.array([axes.trace(), *np.diag(axes)])
    k = int(np.argmax(trace))
    if k == 0:
        spun = [axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]]
        found = np.array([1.0 + trace[0], *spun])
    else:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        found = np.zeros(4)
        found[0] = axes[m, j] - axes[j, m]
        found[1 + i] = 1.0 + axes[i, i] - axes[j, j] - axes[m, m]
        found[1 + j] = axes[j, i] + axes[i, j]
        found[1 + m] = axes[m, i] + axes[i, m]
    return found / vectors.length(found)


def matrix(state):
    """Return the rotation matrix (3, 3) of a state, body to bowl."""
    a, b, c, d = state[body.Q : body.Q + 4]
    return np.array(
        [
            [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
        ]
    )


def ways(states, radius):
    """Return how far along the wall states (N, 13) are (N,), in the unit of length of the radius."""
    return radius * np.arctan2(states[:, 0], radius - states[:, 1])


def moved(states, by, radius):
    """Return states (N, 13) turned about the bowl's axis by ways along the wall, in one unit of length."""
    theta = np.broadcast_to(np.asarray(by) / radius, len(states))
    c, s = np.cos(theta), np.sin(theta)
    out = np.array(states, float)
    for first, middle in ((0, radius), (3, 0.0)):
        x, y = states[:, first], states[:, first + 1] - middle
        out[:, first], out[:, first + 1] = c * x - s * y, s * x + c * y + middle
    a, d = np.cos(0.5 * theta), np.sin(0.5 * theta)
    w, x, y, z = (states[:, body.Q + k] for k in range(4))
    out[:, body.Q : body.Q + 4] = np.column_stack(
        [a * w - d * z, a * x - d * y, a * y + d * x, a * z + d * w]
    )
    return out


def ride(known, station, states, times, *, limits, every, places, jobs=1, progress=None):
    """Follow parts past one station.

    Parameters
    ----------
    known : BowlOfPart
    station : Stage
    states : (N, 13) float
        At the start, without dimensions.
    times : (N,) float [s]
        Of the start, which sets the phase of the drive.
    limits : (float [s], float [s], float [m], float [m])
        After how long a part is given up; the time in which it must get on, and how far; how far it may go
        back from where it began.
    every : float [s]
        Between two places noted; whole steps.
    places : int
        Noted at most.
    jobs : int
        Cores to use; the outcome does not depend on it.
    progress : function, optional
        Told after every batch how many parts are done.

    Returns
    -------
    Runs
        After an interrupt from the keyboard, the batches that were finished, up to the first that was not.

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """
    surface = surface_of(known, station, limits)
    stride = max(round(every / known.unit / known.floor.step), 1)
    batch = partial(_batch, known, surface, stride, places, states, times)
    batch(slice(0, 0))  # compiled here, if need be
    columns, stopped = in_batches(batch, len(states), BATCH, jobs, progress)
    outcomes, ends, notes, paths = columns
    paths *= np.array([known.unit, *[known.length] * 3, 1.0, 1.0, 1.0, 1.0])
    found = {
        "outcomes": outcomes, "states": ends, "seconds": notes[:, travel.TIME] * known.unit,
        "ways": notes[:, travel.MOVED] * known.length, "depths": notes[:, travel.SUNK] * known.length,
        "gains": notes[:, travel.WON] * known.length, "paths": paths,
    }  # fmt: skip
    return Runs(**{name: check.frozen(value) for name, value in found.items()}, partial=stopped)


def surface_of(known, station, limits):
    """Return a station as the kernel takes it, with the limits of ``ride``."""
    plates, borders = stations.with_backs(station.plates), np.array(station.borders)
    plates[:, [0, 1, 2, 12, 13]] /= known.length
    borders[:, :4] /= known.length
    return motion.StageSurface(
        radius=known.radius,
        gravity=known.gravity,
        plates=plates,
        borders=borders,
        friction=known.friction,
        restitution=known.restitution,
        threshold=known.threshold,
        sweeps=SWEEPS,
        converged=CONVERGED,
        exit=station.exit / known.length,
        drop=station.drop / known.length,
        under=-np.inf if station.below else -station.drop / known.length,
        longest=limits[0] / known.unit,
        patience=limits[1] / known.unit,
        progress=limits[2] / known.length,
        back=(station.begin - limits[3]) / known.length,
    )


def scratch(solid, borders):
    """Return the arrays the kernel works in."""
    count = len(solid.corners)
    return WorkingArrays(
        state=np.zeros(body.STATE), saved=np.zeros(body.STATE), push=np.zeros(body.STATE), turn=np.zeros(9),
        tangent=np.zeros(2), spots=np.zeros((count, 3)), shown=np.zeros((count, 3)),
        near=np.zeros(max(borders, 1), np.int64), vectors=np.zeros((3, 3)), low=np.zeros(count, np.int64),
        edges=np.zeros(len(solid.edges), np.int64), faces=np.zeros(len(solid.triangles), np.int64),
        box=np.zeros(4), contacts=np.zeros((CONTACTS, contact.WIDTH)), memory=np.zeros(2),
    )  # fmt: skip


def compiled():
    """Say whether the kernel of the trial is on disk already."""
    return on_disk(travel.travel_all)


def _batch(known, surface, stride, places, states, times, cut):
    """Outcomes, ends, notes and paths of some parts."""
    ends = np.array(states[cut], float)
    count = len(ends)
    outcomes, notes = np.zeros(count, np.int64), np.zeros((count, travel.NOTES))
    paths = np.full((count, places, 8), np.nan)
    travel.travel_all(
        surface, known.solid, known.floor, scratch(known.solid, len(surface.borders)), ends,
        np.asarray(times)[cut] / known.unit, stride, paths, notes, outcomes,
    )  # fmt: skip
    return outcomes, ends, notes, paths
