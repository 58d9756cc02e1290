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
from feederscrew.geometry.compiled import on_disk
from feederscrew.trial import staging
from feederscrew.trial.kernel import contact, motion, travel

RUNNING, PASSED, RETURNED, STANDS, ROLLED = (
    travel.RUNNING, travel.PASSED, travel.RETURNED, travel.STANDS, travel.ROLLED,
)  # fmt: skip
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

    outcomes: np.ndarray  # (N,) int: PASSED, RETURNED, STANDS, ROLLED or RUNNING
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
    upright: np.ndarray  # (2,) inwards and up, in the track's frame
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
        upright=np.array([np.sin(track.bank), np.cos(track.bank)]),
        friction=np.array([friction.static, friction.kinetic, *friction.backward, friction.wall]),
        restitution=bowl.restitution,
        threshold=drive.steps_of(floor).threshold,
    )


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
    plates, borders = staging.with_backs(station.plates), np.array(station.borders)
    plates[:, [0, 1, 2, 12, 13]] /= known.length
    borders[:, :4] /= known.length
    return motion.StageSurface(
        radius=known.radius,
        gravity=known.gravity,
        upright=known.upright,
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
