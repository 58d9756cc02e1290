"""Parts one at a time past one station: starts, runs on several cores, and what became of them."""

from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.dropping import plate_test
from feederscrew.dropping.kernel.floor_motion import Floor
from feederscrew.dropping.pool import in_batches
from feederscrew.geometry.compiled import on_disk
from feederscrew.trial import air
from feederscrew.trial.arrays import ALONE, crowd_of
from feederscrew.trial.kernel import crowd_records, travel

RUNNING, PASSED, RETURNED, STANDS, ROLLED = (
    travel.RUNNING, travel.PASSED, travel.RETURNED, travel.STANDS, travel.ROLLED,
)  # fmt: skip
OVER = 0.1  # of its size: a part whose centre of mass is so far over the free edge does not come back
PERIOD, HOPPING = 48, 96  # steps of a period of the drive, and where parts hop
SWEEPS, CONVERGED = 60, 1e-4  # of the contact solver: at most, and what a sweep may still change
ONWARDS = 5e-3  # of the unit of length: a border goes on so far where its corner is not convex
BATCH = 5  # parts a core takes at a time


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


COLUMNS = tuple(one.name for one in fields(Runs) if one.name != "partial")


@dataclass(frozen=True, eq=False)
class BowlOfPart:
    """A part in a bowl, without dimensions."""

    solid: Any  # trial.shape.TrueSolid
    length: float  # [m] the unit of length
    unit: float  # [s] the unit of time
    floor: Floor
    radius: float  # of the wall
    climb: float  # [rad]
    bank: float  # [rad]
    friction: np.ndarray  # (5,)
    restitution: float
    threshold: float


def setting(solid, length, bowl) -> BowlOfPart:
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
    floor, track, friction = plate_test.floor_of(bowl, length), bowl.track, bowl.friction
    if bowl.drive.amplitude == 0.0:
        floor = floor._replace(along=0.0, up=0.0)
    steps = HOPPING if plate_test.throw_number(bowl) > 1.0 else PERIOD
    return BowlOfPart(
        solid=solid,
        length=length,
        unit=float(np.sqrt(length / bowl.gravity)),
        floor=floor._replace(step=2.0 * np.pi / floor.rate / steps),
        radius=track.radius / length,
        climb=track.climb,
        bank=track.bank,
        friction=np.array([friction.static, friction.kinetic, *friction.backward, friction.wall]),
        restitution=bowl.restitution,
        threshold=plate_test.steps_of(floor).threshold,
    )


def ride(one, states, times, *, jobs=1, progress=None) -> Runs:
    """Follow parts past one station.

    Parameters
    ----------
    one : function
        Of ``past``: follows some of them, one after the other.
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        At the start.
    times : (N,) float [s]
        Of the start, which sets the phase of the drive.
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
    one(states[:0], times[:0])  # compiled here, if need be

    def batch(cut) -> list[Any]:
        made = one(states[cut], times[cut])
        return [getattr(made, name) for name in COLUMNS]

    columns, stopped = in_batches(batch, len(states), BATCH, jobs, progress)
    return Runs(**{name: check.frozen(value) for name, value in zip(COLUMNS, columns)}, partial=stopped)


def past(known, station, *, limits, every, places):
    """Return the function that follows parts past one station, one after the other.

    It takes states (N, 13) and times (N,) [s] and gives Runs.

    Parameters
    ----------
    known : BowlOfPart
    station : Stage
    limits : (float [s], float [s], float [m], float [m])
        After how long a part is given up; the time in which it must get on, and how far; how far it may go
        back from where it began.
    every : float [s]
        Between two places noted; whole steps.
    places : int
        Noted at most.
    """
    surface, limits = surface_of(known, station), limits_of(known, station, limits)
    return partial(
        _followed, known, surface, limits, (max(round(every / known.unit / known.floor.step), 1), places)
    )


def joined(rides) -> Runs:
    """Return the Runs of several parts at one station as one."""
    columns = {name: np.concatenate([getattr(ride, name) for ride in rides]) for name in COLUMNS}
    return Runs(**{name: check.frozen(value) for name, value in columns.items()}, partial=False)


def surface_of(known, station):
    """Return a station as the kernel takes it."""
    plates, borders = np.array(station.plates), np.array(station.borders)
    plates[:, [0, 1, 2, 12, 13]] /= known.length
    borders[:, :4] /= known.length
    spans = [slice(int(row[crowd_records.FIRST]), int(row[crowd_records.LAST])) for row in plates]
    boxes = [[f(borders[own, k:4:2]) for k in (0, 1) for f in (np.min, np.max)] for own in spans]
    return crowd_records.Surface(
        radius=known.radius,
        slopes=air.leaning(station.air.slopes, known.climb, known.bank, station.size, known.length),
        plates=np.hstack([plates, boxes]),
        borders=np.hstack([borders, onwards(borders, spans)]),
        jets=air.blowing(station.air.jets, known.length, known.unit),
        friction=known.friction,
        restitution=known.restitution,
        threshold=known.threshold,
        sweeps=SWEEPS,
        converged=CONVERGED,
    )


def onwards(borders, spans):
    """Return how far (B, 2) [1] borders go on within the solid before their starts and behind their ends.

    At a corner that is not convex the solid goes on behind either border: a part's edge that comes
    down into it meets the one or the other.
    """
    found = np.zeros((len(borders), 2))
    length = np.hypot(*(borders[:, 2:4] - borders[:, :2]).T)
    found[:, 0] = np.where(borders[:, crowd_records.BEND] > 0.5, 0.0, ONWARDS / length)
    for own in spans:
        starts, ends = borders[own, :2], borders[own, 2:4]
        after = own.start + np.array([np.argmin(((starts - end) ** 2).sum(axis=1)) for end in ends])
        found[own, 1] = np.where(borders[after, crowd_records.BEND] > 0.5, 0.0, ONWARDS / length[own])
    return found


def limits_of(known, station, limits):
    """Return when a part is done with a station as the kernel takes it, with the limits of ``past``."""
    return crowd_records.Limits(
        exit=station.exit / known.length,
        drop=station.drop / known.length,
        under=-np.inf if station.below else -station.drop / known.length,
        longest=limits[0] / known.unit,
        patience=limits[1] / known.unit,
        progress=limits[2] / known.length,
        back=(station.begin - limits[3]) / known.length,
        edge=station.width / known.length,
        free=station.width / known.length + OVER * known.solid.radius,
    )


def compiled():
    """Say whether the kernel of the trial is on disk already."""
    return on_disk(travel.ride)


def _followed(known, surface, limits, looks, states, times) -> Runs:
    """What became of some parts, looked at each so many steps, so often at most."""
    stride, places = looks
    ends, count = np.array(states, float), len(states)
    outcomes, notes = np.zeros(count, np.int64), np.zeros((count, travel.NOTES + 2))
    paths = np.full((count, places, 8), np.nan)
    sent = crowd_records.Sent(ends, np.asarray(times) / known.unit, stride, paths, notes, outcomes)
    crowd = crowd_of(known.solid, surface, 1)
    travel.ride(surface, limits, known.solid, known.floor, crowd, sent, ALONE)
    paths *= np.array([known.unit, *[known.length] * 3, 1.0, 1.0, 1.0, 1.0])
    return Runs(
        outcomes=outcomes, states=ends, seconds=notes[:, travel.TIME] * known.unit,
        ways=notes[:, travel.MOVED] * known.length, depths=notes[:, travel.SUNK] * known.length,
        gains=notes[:, travel.WON] * known.length, paths=paths, partial=False,
    )  # fmt: skip
