"""Many parts, one at a time, through a chain of devices: what becomes of each, and where."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.conveying import answer
from feederscrew.dropping.pool import gather
from feederscrew.geometry import vectors
from feederscrew.running import USUAL_RUN
from feederscrew.trial import part_poses, runs, sensed_rides, staging, starts
from feederscrew.trial.looks import Looks
from feederscrew.trial.rounding import rounded
from feederscrew.trial.shape import solid_of

PASSED, TURNED, RETURNED, HANGING, STOPPED, ROLLED_BACK, STUCK = range(7)
FATES = ("passed", "turned", "returned", "hanging", "stopped", "rolled_back", "stuck")
RUN_UP = 1.0  # of the part's size: how far it travels before the first device
LOOKS_PER_STATION = 300  # places noted of a part at a station
PATH_ROOM = 3.0  # times what it should take: so long its places are noted
LEAST_SPEED_M_S = 1e-3  # [m/s] a slower bowl is given up after the time this takes
LEAST_PROGRESS_SHARE = 0.03  # of the way it should come: a slower part does not get on
HANGING_DEPTH_M = 1e-4  # [m] under the track: a part that reaches so deep hangs
AT_DEVICE_M = 5e-4  # [m] from a device: a part that near is at it


@dataclass(frozen=True, eq=False)
class Sending:
    """Which N parts are sent: laid down in some of M orientations, or on the track already."""

    tried: Sequence[int] = ()  # orientations in which they are laid down, in turn
    parts: int = 0  # N of them
    begun: tuple | None = None  # (states, times, entered) of parts that are on the track already, as
    # `runs.ride` takes them, and how each counts among the M; none is laid down then

    def on_track(self, lay):
        """Return states (N, 13), times (N,) [s] and orientations (N,): begun, or as ``lay`` lays them."""
        if self.begun is not None:
            return self.begun
        entered = np.resize(np.asarray(self.tried, int), self.parts)
        return *lay(entered), entered


@dataclass(frozen=True, eq=False)
class Course:
    """What became of N parts on their way past S stations, the bare track first; M orientations."""

    entered: np.ndarray  # (N,) int, orientation each was laid down in
    orientations: np.ndarray  # (S + 1, N) int, before each station and at the end; OTHER; -2 of one gone
    fates: np.ndarray  # (N,) int, of FATES
    ended: np.ndarray  # (N,) int, station at which it ended; S of one that passed or was turned
    velocities: np.ndarray  # (N,) [m/s] on the bare track; NaN of one that did not travel
    seconds: np.ndarray  # (N,) [s] in all
    depths: np.ndarray  # (N,) [m] the deepest that anything was in anything
    gains: np.ndarray  # (N,) [m] largest rise of the energy over what gravity and the drive gave, as a height
    fell: np.ndarray  # (N,) [m] along the wall from the device's start, where it ended
    rides: tuple  # runs.Runs of each station, of the parts that came so far
    riders: tuple  # (P,) int, which parts those are
    stations: tuple  # staging.Stage
    length: float  # [m] the unit of length of the states
    principal: np.ndarray  # (3, 3) [1]
    partial: bool


def course(part, bowl, orientations, sent, devices, *, poses=None, leaves=None, run=USUAL_RUN):
    """Send parts through a chain of devices.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    orientations : sequence of Orientation
        Of the part, M of them.
    sent : Sending
    devices : sequence of Device
        In the order parts meet them.
    poses : sequence of Orientation, optional
        S of them, the M first, in which parts may be found; the M without it.
    leaves : (M, S) bool, optional
        In which of them an orientation may leave and still be said to pass; as it came without it.
    run : RunSettings
        Its seed is of play, heading and phase of the drive: each part draws its own. Its progress is told how
        many parts are through, of how many.

    Returns
    -------
    Course

    Raises
    ------
    FeederError
        If the part has no shape or the bowl conveys nothing at all.
    """
    solid, length, principal = solid_of(part)
    solid = rounded(solid, axes(orientations, principal))
    part_in_bowl, chain = runs.setting(solid, length, bowl), _chain(bowl, orientations, devices)
    run.begin()
    states, times, entered = sent.on_track(
        lambda rows: starts.laid_down(bowl, orientations, rows, solid, principal, length, run.seed)
    )
    looks = Looks(orientations if poses is None else poses, solid, length, principal, bowl.track.radius)
    leaves = np.eye(len(orientations), len(looks.reaches), dtype=bool) if leaves is None else leaves
    rides = [
        sensed_rides.past(part_in_bowl, station, **_limits(bowl, station, orientations)) for station in chain
    ]
    rides[0](states[:0], times[:0])  # compiled here, if need be

    def through(n):
        return _through(part_in_bowl, chain, rides, states[[n]], times[[n]])

    def work(begin) -> None:
        for done, task in enumerate([begin(through, n) for n in range(len(entered))]):
            task.result()
            run.tell(done + 1, len(entered))

    part_rides, stopped = gather(work, run.jobs)
    collected = _CourseCollector(chain, entered[: len(part_rides)], looks)
    for place in range(len(chain)):
        riders = np.flatnonzero([len(rode) > place for rode in part_rides])
        if len(riders):
            collected.add(place, runs.joined([part_rides[n][place] for n in riders]), riders, bowl)
    return collected.course(length, principal, leaves, stopped)


def _through(part_in_bowl, chain, rides, state, time):
    """Send one part through the chain; what it did at each station that it came to."""
    rides_done = []
    for place, station in enumerate(chain):
        ride = rides[place](state, time)
        rides_done.append(ride)
        if ride.outcomes[0] != runs.PASSED or place + 1 == len(chain):
            break
        state = _led_on(ride.states, station, chain[place + 1].begin, part_in_bowl)
        time = time + ride.seconds
    return rides_done


def _led_on(states, station, begin, part_in_bowl):
    """States (N, 13) behind a station, on the track at the begin [m] of the next one.

    What went down to a lower track goes on at its level; one that begins beside a ledge leads to the wall.
    """
    states = part_poses.moved(
        states,
        begin / part_in_bowl.length - part_poses.ways_along_wall(states, part_in_bowl.radius),
        part_in_bowl.radius,
    )
    if station.drop > 0.0:
        down = states[:, 2] < 0.0 if station.aside > 0.0 else np.ones(len(states), dtype=bool)
        states[down, 2] += station.drop / part_in_bowl.length
        out = states[:, :2] - [0.0, part_in_bowl.radius]
        out *= 1.0 + down[:, None] * station.aside / part_in_bowl.length / vectors.length(out)[:, None]
        states[:, :2] = out + [0.0, part_in_bowl.radius]
    return states


def axes(orientations, principal) -> list[Any]:
    """Return the axes (N, 3) about which a part rolls, along its principal axes."""
    roll_axes = [
        vectors.product(orientation.posture.axis, vectors.product(orientation.posture.axes[:2], principal))
        for orientation in orientations
        if orientation.kind == "rolling"
        and orientation.posture.axis is not None
        and not np.isfinite(orientation.posture.rolling_circle)
    ]
    values = {
        tuple(np.round(axis if axis[np.argmax(np.abs(axis))] > 0.0 else -axis, 4)): axis for axis in roll_axes
    }
    return [vectors.unit(axis) for axis in values.values()]


def rightly(leaving):
    """Return the states (M, S) an orientation leaves in as the static rule says, or as it came if in none.

    Parameters
    ----------
    leaving : (M, S) float [1]
        Share of each orientation that leaves in each state, the M orientations first.
    """
    right = leaving > 0.0
    return right | (np.eye(len(right), right.shape[1], dtype=bool) & ~right.any(axis=1)[:, None])


def _chain(bowl, orientations, devices) -> list[Any]:
    """The bare track, then each device that is no measured yield."""
    size = max(orientation.length for orientation in orientations)
    placed, slopes, slot = [], staging.at_entry(devices, bowl.track, orientations), ()
    first = slopes
    for device in devices:
        if device.placed:
            standing = device.standing(bowl.track, orientations)
            placed.append(staging.stage(device, bowl.track, orientations, slopes=slopes, slot=slot))
            slopes, slot = (*slopes, *standing.slopes), standing.slot or slot
    return [staging.plain(bowl.track, orientations, RUN_UP * size, first), *placed]


def _limits(bowl, station, orientations) -> dict[Any, Any]:
    """How long a part has, and how often it is looked at, by the velocity of the point mass."""
    velocity = answer.answer(bowl).velocity
    speed = max(velocity if np.isfinite(velocity) else 0.0, LEAST_SPEED_M_S)
    distance = station.exit - station.begin
    size = max(orientation.length for orientation in orientations)
    patience = max(0.5 * size / speed, 0.5)
    seconds = distance / (LEAST_PROGRESS_SHARE * speed) + 1.0  # what creeps is followed to the end
    period = 1.0 / bowl.drive.frequency
    every_s = max(np.ceil(distance / speed / LOOKS_PER_STATION / period), 1.0) * period
    return {
        "limits": (seconds, patience, LEAST_PROGRESS_SHARE * patience * speed, 0.5 * size),
        "interval": every_s, "places": int(LOOKS_PER_STATION * PATH_ROOM) + 60,
    }  # fmt: skip


class _CourseCollector:
    """Collects what became of the parts, station by station."""

    def __init__(self, chain, entered, looks):
        self.looks, self.chain, count, parts = looks, chain, len(chain), len(entered)
        self.entered, self.orientations = entered, np.full((count + 1, parts), -2)
        self.orientations[0] = entered
        self.fates, self.ended = np.full(parts, STUCK), np.full(parts, -1)
        self.velocities, self.fell = np.full(parts, np.nan), np.full(parts, np.nan)
        self.seconds, self.depths, self.gains = np.zeros(parts), np.zeros(parts), np.zeros(parts)
        self.rides, self.riders = [], []

    def add(self, place, ride, riders, bowl) -> None:
        """Note what one station did."""
        self.rides.append(ride)
        self.riders.append(riders)
        self.seconds[riders] += ride.seconds
        self.depths[riders] = np.maximum(self.depths[riders], ride.depths)
        self.gains[riders] = np.maximum(self.gains[riders], ride.gains)
        if place == 0:
            self.velocities[riders] = velocities(ride, bowl.track.radius)
        passed = ride.outcomes == runs.PASSED
        self.ended[riders] = np.where(passed, place + 1, place)
        self.fell[riders] = (
            part_poses.ways_along_wall(ride.states, self.looks.radius) * bowl.track.radius / self.looks.radius
        )
        fates = [
            self._fate(self.chain[place], outcome, state, bowl.track.radius / self.looks.radius)
            for outcome, state in zip(ride.outcomes, ride.states)
        ]
        self.fates[riders] = np.where(passed, PASSED, fates)
        self.orientations[place + 1][riders[passed]] = self.looks.of(ride.states[passed])

    def _fate(self, station, outcome, state, length):
        """What became of a part that has not passed a station."""
        if outcome in (runs.RETURNED, runs.ROLLED):
            return RETURNED if outcome == runs.RETURNED else ROLLED_BACK
        rear, front, low = np.array(part_poses.extents(state, self.looks.corners, self.looks.radius)) * length
        if outcome == runs.RUNNING and station.below and low < -HANGING_DEPTH_M - station.drop:
            return HANGING
        first, last = station.cut
        return STOPPED if front > first - AT_DEVICE_M and rear < last + AT_DEVICE_M else STUCK

    def course(self, length, principal, leaves, partial) -> Course:
        """All of it as a record; what leaves as it should has passed, what else leaves was turned."""
        out = self.orientations[-1]
        whole = self.fates == PASSED
        right = (out >= 0) & leaves[self.entered, np.maximum(out, 0)]
        self.fates[whole & ~right] = TURNED
        arrays = {
            "entered": self.entered, "fates": self.fates, "ended": self.ended, "fell": self.fell,
            "velocities": self.velocities, "seconds": self.seconds, "depths": self.depths,
            "gains": self.gains, "orientations": self.orientations, "principal": principal,
        }  # fmt: skip
        return Course(
            **{name: check.frozen(array) for name, array in arrays.items()},
            rides=tuple(self.rides), riders=tuple(check.frozen(riders) for riders in self.riders),
            stations=tuple(self.chain), length=length, partial=partial,
        )  # fmt: skip


def velocities(ride, radius):
    """Return mean velocities (N,) [m/s], over the second half of each path; NaN of a short one."""
    means = np.full(len(ride.paths), np.nan)
    for n, path in enumerate(ride.paths):
        count = int(np.isfinite(path[:, 0]).sum())
        if count < 4 or ride.outcomes[n] == runs.RETURNED:
            continue
        along = radius * np.arctan2(path[:count, 1], radius - path[:count, 2])
        first = count // 2
        means[n] = (along[-1] - along[first]) / (path[count - 1, 0] - path[first, 0])
    return means
