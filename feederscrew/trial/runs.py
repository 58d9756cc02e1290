"""Parts one at a time past one station: starts, runs on several cores, and what became of them."""

from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.dropping import plate_test
from feederscrew.dropping.kernel.floor_motion import Floor
from feederscrew.dropping.pool import in_batches
from feederscrew.geometry.compiled import on_disk, zero_rows
from feederscrew.trial import air
from feederscrew.trial.arrays import NO_CROWD, workspace_of
from feederscrew.trial.kernel import travel, workspace

RUNNING, PASSED, RETURNED, STANDS, ROLLED = (
    travel.RUNNING, travel.PASSED, travel.RETURNED, travel.STANDS, travel.ROLLED,
)  # fmt: skip
OVER_EDGE_SHARE = (
    0.1  # of its size: a part whose centre of mass is so far over the free edge does not come back
)
PERIOD, HOPPING = 48, 96  # steps of a period of the drive, and where parts hop
SWEEPS, CONVERGED = 60, 1e-4  # of the contact solver: at most, and what a sweep may still change
BORDER_EXTENSION = 5e-3  # of the unit of length: a border goes on so far where its corner is not convex
PARTS_PER_TASK = 5  # parts a core takes at a time


@dataclass(frozen=True, eq=False)
class Runs:
    """What became of N parts at one station, in SI units; K places of each."""

    outcomes: np.ndarray  # (N,) int: PASSED, RETURNED, STANDS, ROLLED or RUNNING
    states: np.ndarray  # (N, 13) at the end, without dimensions
    seconds: np.ndarray  # (N,) [s]
    distances: np.ndarray  # (N,) [m] along the wall
    depths: np.ndarray  # (N,) [m] the deepest that anything was in anything
    gains: np.ndarray  # (N,) [m] largest rise of the energy over what gravity and the drive gave, as a height
    paths: np.ndarray  # (N, K, 8) time [s], position [m], attitude; NaN after the end
    partial: bool  # stopped by the user before all parts were done


RUN_COLUMNS = tuple(field.name for field in fields(Runs) if field.name != "partial")


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


def ride(follow, states, times, *, jobs=1, progress=None) -> Runs:
    """Follow parts past one station.

    Parameters
    ----------
    follow : function
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
    follow(states[:0], times[:0])  # compiled here, if need be

    def batch(cut) -> list[Any]:
        runs = follow(states[cut], times[cut])
        return [getattr(runs, name) for name in RUN_COLUMNS]

    columns, stopped = in_batches(batch, len(states), PARTS_PER_TASK, jobs, progress)
    return Runs(**{name: check.frozen(value) for name, value in zip(RUN_COLUMNS, columns)}, partial=stopped)


def past(part_in_bowl, station, *, limits, interval, places):
    """Return the function that follows parts past one station, one after the other.

    It takes states (N, 13) and times (N,) [s] and gives Runs.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    station : Stage
    limits : (float [s], float [s], float [m], float [m])
        After how long a part is given up; the time in which it must get on, and how far; how far it may go
        back from where it began.
    interval : float [s]
        Between two places noted; whole steps.
    places : int
        Noted at most.
    """
    surface, limits = surface_of(part_in_bowl, station), limits_of(part_in_bowl, station, limits)
    return partial(
        _followed,
        part_in_bowl,
        surface,
        limits,
        (max(round(interval / part_in_bowl.unit / part_in_bowl.floor.step), 1), places),
    )


def joined(rides) -> Runs:
    """Return the Runs of several parts at one station as one."""
    columns = {name: np.concatenate([getattr(ride, name) for ride in rides]) for name in RUN_COLUMNS}
    return Runs(**{name: check.frozen(value) for name, value in columns.items()}, partial=False)


def surface_of(part_in_bowl, station) -> workspace.Surface:
    """Return a station as the kernel takes it."""
    length = part_in_bowl.length
    plates, borders = station.plates.copy(), station.borders.copy()
    box = ("least_x", "most_x", "least_y", "most_y")
    for name in ("origin_x", "origin_y", "origin_z", "depth", "rounding", *box):
        plates[name] /= length
    for name in ("start_x", "start_y", "end_x", "end_y"):
        borders[name] /= length
    _extend_borders(plates, borders)
    return workspace.Surface(
        radius=part_in_bowl.radius,
        slopes=air.leaning(station.air.slopes, part_in_bowl.climb, part_in_bowl.bank, station.size, length),
        plates=plates,
        borders=borders,
        jets=air.blowing(station.air.jets, length, part_in_bowl.unit),
        friction=part_in_bowl.friction,
        restitution=part_in_bowl.restitution,
        threshold=part_in_bowl.threshold,
        sweeps=SWEEPS,
        converged=CONVERGED,
    )


def _extend_borders(plates, borders) -> None:
    """Write how far borders go on within the solid before their starts and behind their ends.

    At a corner that is not convex the solid goes on behind either border: a part's edge that comes
    down into it meets the one or the other.
    """
    starts = np.column_stack([borders.start_x, borders.start_y])
    ends = np.column_stack([borders.end_x, borders.end_y])
    shares = BORDER_EXTENSION / np.hypot(*(ends - starts).T)
    borders["onwards_start"] = np.where(borders.convex, 0.0, shares)
    for plate in plates:
        own = slice(plate.begin, plate.end)
        after = plate.begin + np.array(
            [np.argmin(((starts[own] - end) ** 2).sum(axis=1)) for end in ends[own]]
        )
        borders["onwards_end"][own] = np.where(borders.convex[after], 0.0, shares[own])


def limits_of(part_in_bowl, station, limits):
    """Return when a part is done with a station as the kernel takes it, with the limits of ``past``."""
    return workspace.Limits(
        exit=station.exit / part_in_bowl.length,
        drop=station.drop / part_in_bowl.length,
        under=-np.inf if station.below else -station.drop / part_in_bowl.length,
        longest=limits[0] / part_in_bowl.unit,
        patience=limits[1] / part_in_bowl.unit,
        progress=limits[2] / part_in_bowl.length,
        back_limit=(station.begin - limits[3]) / part_in_bowl.length,
        edge=station.width / part_in_bowl.length,
        free=station.width / part_in_bowl.length + OVER_EDGE_SHARE * part_in_bowl.solid.radius,
    )


def compiled():
    """Say whether the kernel of the trial is on disk already."""
    return on_disk(travel.ride)


def _followed(part_in_bowl, surface, limits, looks, states, times) -> Runs:
    """What became of some parts, looked at each so many steps, so often at most."""
    stride, places = looks
    ends, count = np.array(states, float), len(states)
    outcomes, journals = np.zeros(count, np.int64), zero_rows(count, workspace.JOURNAL)
    paths = np.full((count, places, 8), np.nan)
    sent = workspace.Sent(ends, np.asarray(times) / part_in_bowl.unit, stride, paths, journals, outcomes)
    work = workspace_of(part_in_bowl.solid, surface, 1)
    travel.ride(surface, limits, part_in_bowl.solid, part_in_bowl.floor, work, sent, NO_CROWD)
    paths *= np.array([part_in_bowl.unit, *[part_in_bowl.length] * 3, 1.0, 1.0, 1.0, 1.0])
    return Runs(
        outcomes=outcomes, states=ends, seconds=journals.time * part_in_bowl.unit,
        distances=journals.way * part_in_bowl.length, depths=journals.depth * part_in_bowl.length,
        gains=journals.gain * part_in_bowl.length, paths=paths, partial=False,
    )  # fmt: skip
