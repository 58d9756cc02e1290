"""Parts that fall onto the moving track, come to lie as they do, and go through the devices so."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.dropping.launch_conditions import named
from feederscrew.dropping.plate_test import EXACT_PACE
from feederscrew.running import USUAL_RUN
from feederscrew.trial import course, part_poses, runs, staging, starts
from feederscrew.trial.looks import OTHER, AspectsBelow
from feederscrew.trial.rounding import rounded
from feederscrew.trial.shape import solid_of

MAX_THROW_SHARE = (
    0.2  # of the bowl's circumference, to either side: further no part is thrown along the track
)


@dataclass(frozen=True, eq=False)
class Landing:
    """What became of N parts that fell onto the track; A aspects, S orientations in which parts leave."""

    launch: str
    parts: int  # N
    lost: int  # of them off the track before they had come to lie
    fates: np.ndarray  # (A, 7) int, by the aspect on which they came to lie, at any heading; columns as
    # ``course.FATES``: passed on the same aspect, turned onto another
    leaving: np.ndarray  # (S + 1,) int, orientation in which they left; the last is none of the known
    velocity: float  # [m/s] mean on the bare track; NaN where none travelled
    depth: float  # [m] the deepest that anything was in anything, after the landing
    partial: bool  # stopped by the user: of the parts until then

    @property
    def landed(self):
        """Return (A,) int, how many came to lie on each aspect."""
        return self.fates.sum(axis=1)

    @property
    def left(self) -> int:
        """Return how many left behind the last device."""
        return int(self.leaving.sum())

    @property
    def efficiency(self) -> float:
        """Return the share of the parts let fall that leaves in the orientation in which most do [1]."""
        return float(self.leaving[:-1].max(initial=0) / self.parts)

    @property
    def purity(self):
        """Return the share of that orientation in what leaves [1]; NaN where nothing does."""
        return float(self.leaving[:-1].max(initial=0) / self.left) if self.left else np.nan


def landing(part, bowl, aspects, orientations, poses, *, launch, parts, run=USUAL_RUN) -> Landing:
    """Let parts fall onto the bare, moving track and send those that lie on it through the devices.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
        With its devices.
    aspects : Aspects
        Of the part.
    orientations, poses : sequence of Orientation
        Of the part, and those in which it may leave.
    launch : str
        A key of ``dropping.launch_conditions.PRESETS``: height, spin and speed.
    parts : int
    run : RunSettings
        Its progress is told how many parts are done, of how many, first with the landing.

    Returns
    -------
    Landing

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all have come to lie and the first of them are through.
    """
    below = AspectsBelow(part, aspects)
    run.begin()
    ride, times = _fallen(part, bowl, orientations, below.shape, named(launch), parts, run)
    if ride.partial:
        raise KeyboardInterrupt
    entered = below.of(ride.states)
    on = (ride.outcomes == runs.RUNNING) & (entered != OTHER)
    if not on.any():
        return _landing_record(launch, parts, aspects, poses, None, below)
    radius = bowl.track.radius / solid_of(part)[1]
    states = part_poses.moved(ride.states[on], -part_poses.ways_along_wall(ride.states[on], radius), radius)
    leaves = np.ones((len(aspects.names), len(poses)), bool)
    sent = course.Sending(begun=(states, (times + ride.seconds)[on], entered[on]))
    own = {"poses": poses, "leaves": leaves, "run": replace(run, before=None)}
    rode = course.course(part, bowl, orientations, sent, bowl.devices, **own)
    return _landing_record(launch, parts - int(on.sum()), aspects, poses, rode, below)


def _fallen(part, bowl, orientations, shape, launch, parts, run) -> tuple[Any, ...]:
    """Runs of parts from their launch to where they lie, and the times [s] at which they began."""
    solid, length, principal = solid_of(part)
    solid = rounded(solid, course.axes(orientations, principal))
    part_in_bowl = runs.setting(solid, length, bowl)
    states, times = starts.falling(bowl, launch, shape, parts, length, run.seed)
    flight, fastest = np.sqrt(2.0 * launch.fall[1]), launch.speed[1]
    room = fastest * flight + fastest**2 / (2.0 * max(bowl.friction.kinetic, 0.05)) + solid.radius
    room = min(length * room, MAX_THROW_SHARE * 2.0 * np.pi * bowl.track.radius)
    first = staging.at_entry(bowl.devices, bowl.track, orientations)
    stage = replace(staging.plain(bowl.track, orientations, 2.0 * room, first), exit=np.inf)
    seconds = part_in_bowl.unit * (flight + EXACT_PACE.settling)
    limits = (seconds, 2.0 * seconds, 0.0, np.inf)
    follow = runs.past(part_in_bowl, stage, limits=limits, interval=seconds, places=1)
    begun = part_poses.moved(states, room / length, part_in_bowl.radius)
    ride = runs.ride(follow, begun, times, jobs=run.jobs, progress=lambda done: run.tell(done, parts))
    return ride, times


def _landing_record(launch, lost, aspects, poses, rode, below) -> Landing:
    """The record of what became of those that lay; ``rode`` is None where none did."""
    fates = np.zeros((len(aspects.names), len(course.FATES)), int)
    leaving, velocity = np.zeros(len(poses) + 1, int), np.nan
    if rode is not None:
        left = np.isin(rode.fates, (course.PASSED, course.TURNED))
        out = np.full(len(left), OTHER)
        out[rode.riders[-1]] = below.of(rode.rides[-1].states)
        becomes = np.where(left & (out != rode.entered), course.TURNED, rode.fates)
        np.add.at(fates, (rode.entered, np.where(left & (out == rode.entered), course.PASSED, becomes)), 1)
        np.add.at(leaving, rode.orientations[-1][left], 1)
        travels = np.isfinite(rode.velocities)
        velocity = float(rode.velocities[travels].mean()) if travels.any() else np.nan
    return Landing(
        launch=launch,
        parts=lost + int(fates.sum()),
        lost=lost,
        fates=check.frozen(fates),
        leaving=check.frozen(leaving),
        velocity=velocity,
        depth=0.0 if rode is None else float(rode.depths.max()),
        partial=rode is not None and rode.partial,
    )
