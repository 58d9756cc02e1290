"""Many parts, one at a time, through a chain of devices: what becomes of each, and where.

They are laid on the track, or fall onto it while it moves and go through the devices as they come to lie.
"""

import enum
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.arrivals.launch_conditions import named
from feederscrew.arrivals.plate_test import EXACT_PACE
from feederscrew.arrivals.pool import gather
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.columns import Column
from feederscrew.base.geometry import vectors
from feederscrew.base.running import USUAL_RUN, RunSettings
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.record import Bowl
from feederscrew.motion import conveying as answer
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.sorting.tooled_track import along_wall, lay_out
from feederscrew.trials import part_poses, runs, staging
from feederscrew.trials.looks import OTHER, AspectsBelow, Looks
from feederscrew.trials.part_poses import State, States
from feederscrew.trials.shape import round_circles, solid_of
from feederscrew.trials.staging import Stage


class Fate(enum.IntEnum):
    """Fate of a part; the numbers are columns of the tables of counts."""

    PASSED = 0  # left as it should
    TURNED = 1  # left otherwise
    RETURNED = 2
    HANGING = 3  # hangs, and does not travel
    STOPPED = 4  # stands at a device
    ROLLED_BACK = 5
    STUCK = 6  # stands on the track

    @property
    def word(self) -> str:
        """Return the name that tables and files have: 'rolled_back'."""
        return self.name.lower()


PASSED, TURNED, RETURNED, HANGING, STOPPED, ROLLED_BACK, STUCK = Fate
FATES = tuple(fate.word for fate in Fate)
RUN_UP = 1.0  # of the part's size: how far it travels before the first device
LOOKS_PER_STATION = 300  # places noted of a part at a station
PATH_ROOM = 3.0  # times what it should take: so long its places are noted
LEAST_SPEED_M_S = 1e-3  # [m/s] a slower bowl is given up after the time this takes
LEAST_PROGRESS_SHARE = 0.03  # of the way it should come: a slower part does not get on
HANGING_DEPTH_M = 1e-4  # [m] under the track: a part that reaches so deep hangs
AT_DEVICE_M = 5e-4  # [m] from a device: a part that near is at it
MAX_THROW_SHARE = 0.2  # of the bowl's circumference, to either side: further along no part is thrown


@dataclass(frozen=True, eq=False)
class SentParts:
    """N parts that are sent: laid down in some of M orientations, or on the track already."""

    rows: Sequence[int] = ()  # orientations in which they are laid down, in turn
    parts: int = 0  # N of them
    # (states, times, rows) of parts that are on the track already, as ``runs.ride`` takes them, and how
    # each counts among the M; none is laid down then
    on_track: tuple[States, Floats, Ints] | None = None


@dataclass(frozen=True, eq=False)
class Course:
    """Fates of N parts on their way past S stations, the bare track first; M orientations."""

    entry_rows: Ints  # (N,) orientation each was laid down in
    orientations: Ints  # (S + 1, N) before each station and at the end; OTHER; -2 of one gone
    fates: Ints  # (N,) of FATES
    end_stations: Ints  # (N,) station at which it ended; S of one that passed or was turned
    velocities: Floats  # (N,) [m/s] on the bare track; NaN of one that did not travel
    seconds: Floats  # (N,) [s] in all
    depths: Floats  # (N,) [m] the deepest that anything was in anything
    gains: Floats  # (N,) [m] largest rise of the energy over what gravity and the drive gave, as a height
    end_places: Floats  # (N,) [m] along the wall from the device's start, where it ended
    rides: tuple[runs.Runs, ...]  # of each station, of the parts that came so far
    riders: tuple[Ints, ...]  # (P,) which parts those are
    stations: tuple[Stage, ...]
    length: float  # [m] the unit of length of the states
    principal: Floats  # (3, 3) [1]
    partial: bool


def course(
    part: Part,
    bowl: Bowl,
    orientations: Sequence[Orientation],
    sent: SentParts,
    devices: Sequence[Device],
    *,
    poses: Sequence[Orientation] | None = None,
    may_leave: Bools | None = None,
    run: RunSettings = USUAL_RUN,
) -> Course:
    """Send parts through a chain of devices, one at a time, in the order parts meet them.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        Its own devices are not looked at.
    orientations : sequence of Orientation
        The M in which parts are sent.
    sent : SentParts
        Which parts are sent.
    devices : sequence of Device
        Along the track; one that is a measured yield is left out.
    poses : sequence of Orientation, optional
        The S orientations in which a part may be found, the M first; without it those M.
    may_leave : (M, S) bool, optional
        In which of them an orientation may leave and still be said to pass; without it as it came. What hangs
        between rails may always leave so.
    run : RunSettings, optional
        Its seed is of play, heading and phase of the drive: each part draws its own. It is told how many
        parts are through, of how many.

    Returns
    -------
    Course
        Of the parts that were through when the user stopped it, if he did.

    Raises
    ------
    FeederError
        If the part has no shape or too many facets, or the bowl conveys nothing at all.
    """
    solid, length, principal = solid_of(part)
    solid = round_circles(solid, roll_axes(orientations, principal))
    part_in_bowl = runs.setting(solid, length, bowl)
    # the bare track, then each device that is no measured yield
    size = max(orientation.length for orientation in orientations)
    slopes = staging.slopes_before(staging.entry_slopes(devices, bowl.track, orientations))
    slot: tuple[float, ...] = ()
    chain = [staging.stage_bare_track(bowl.track, orientations, RUN_UP * size, slopes)]
    tooled = lay_out(bowl.track, devices, orientations, whole=True)
    for number, placed in enumerate(tooled.devices):
        chain.append(staging.stage_placed(tooled, number, bowl.track, orientations, slopes, slot))
        slopes = (*slopes, *staging.slopes_before(placed.features.slopes))
        slot = placed.features.slot or slot
    run.begin()
    if sent.on_track is not None:
        states, times, entries = sent.on_track
    else:
        entries = np.resize(np.asarray(sent.rows, int), sent.parts)
        states, times = part_poses.lay_down(bowl, orientations, entries, solid, principal, length, run.seed)
    known = orientations if poses is None else poses
    looks = Looks(known, solid, length, principal, bowl.track.radius)
    on_side = chain[-1].on_side
    looks_on_side = Looks(known, solid, length, principal, bowl.track.radius, on_side) if on_side else looks
    may_leave = np.eye(len(orientations), len(looks.reaches), dtype=bool) if may_leave is None else may_leave
    # whatever hangs between rails has come there as it should, also where the static rule did not say so
    hanging = [isinstance(pose, Hanging) for pose in known]
    may_leave = may_leave | np.resize(np.array(hanging, bool), may_leave.shape)
    limits = [limits_at(bowl, station, orientations) for station in chain]
    follows = [runs.make_follower(part_in_bowl, *pair) for pair in zip(chain, limits)]
    follows[0](states[:0], times[:0])  # compiled here, if need be

    def through(n: int) -> list[runs.Runs]:
        """Send one part through the chain; what it did at each station that it came to."""
        state, time, rides = states[[n]], times[[n]], []
        for place, station in enumerate(chain):
            rides.append(follows[place](state, time))
            if rides[-1].outcomes[0] != runs.PASSED or place + 1 == len(chain):
                break
            state = lead_on(rides[-1].states, station, chain[place + 1].begin, part_in_bowl)
            time = time + rides[-1].seconds
        return rides

    def work(begin: Callable[..., Future]) -> None:
        for done, task in enumerate([begin(through, n) for n in range(len(entries))]):
            task.result()
            run.tell(done + 1, len(entries))

    part_rides, stopped = gather(work, run.jobs)
    # What became of them, station by station.
    count, entries = len(part_rides), entries[: len(part_rides)]
    oriented = np.full((len(chain) + 1, count), -2)
    oriented[0] = entries
    fates, end_stations = np.full(count, STUCK), np.full(count, -1)
    speeds, ends = np.full(count, np.nan), np.full(count, np.nan)
    seconds, depths, gains = np.zeros((3, count))
    rides, riders = [], []
    for place, station in enumerate(chain):
        rows = np.flatnonzero([len(rode) > place for rode in part_rides])
        if not len(rows):
            continue
        ride = runs.join_runs([part_rides[n][place] for n in rows])
        rides.append(ride)
        riders.append(rows)
        seconds[rows] += ride.seconds
        depths[rows], gains[rows] = np.maximum(depths[rows], ride.depths), np.maximum(gains[rows], ride.gains)
        if place == 0:
            speeds[rows] = velocities(ride, bowl.track.radius, station.middle)
        passed = ride.outcomes == runs.PASSED
        end_stations[rows] = np.where(passed, place + 1, place)
        unit = bowl.track.radius / looks.radius
        ends[rows] = part_poses.ways_along_wall(ride.states, looks.radius, station.middle / unit) * unit
        lost = [fate_at(station, *row, looks, unit) for row in zip(ride.outcomes, ride.states)]
        fates[rows] = np.where(passed, PASSED, lost)
        own_looks = looks_on_side if station.on_side else looks
        oriented[place + 1][rows[passed]] = own_looks.find_orientations(ride.states[passed])
    # What leaves as it should has passed, what else leaves was turned.
    right = (oriented[-1] >= 0) & may_leave[entries, np.maximum(oriented[-1], 0)]
    fates[(fates == PASSED) & ~right] = TURNED
    arrays = {
        "entry_rows": entries,
        "orientations": oriented,
        "fates": fates,
        "end_stations": end_stations,
        "velocities": speeds,
        "seconds": seconds,
        "depths": depths,
        "gains": gains,
        "end_places": ends,
        "principal": principal,
    }
    return Course(
        **{name: check.frozen(array) for name, array in arrays.items()},
        rides=tuple(rides),
        riders=tuple(check.frozen(rows) for rows in riders),
        stations=tuple(chain),
        length=length,
        partial=stopped,
    )


def lead_on(states: States, station: Stage, begin: float, part_in_bowl: runs.BowlOfPart) -> States:
    """Return the states of parts behind a station, on the track at the begin of the next one.

    What went down to a lower track goes on at its level, as far from the wall.

    Parameters
    ----------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        In which parts have passed the station.
    station : Stage
    begin : float [m]
        Place of the next station along the wall.
    part_in_bowl : BowlOfPart

    Returns
    -------
    (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    """
    radius, length = part_in_bowl.radius, part_in_bowl.length
    states = part_poses.move_along_wall(
        states, begin / length - part_poses.ways_along_wall(states, radius), radius
    )
    if station.drop > 0.0:
        states[:, 2] += station.drop / length
        if station.aside != 0.0:
            out = states[:, :2] - [0.0, radius]
            out *= 1.0 - station.aside / length / vectors.length(out)[:, None]
            states[:, :2] = out + [0.0, radius]
    return states


def roll_axes(orientations: Sequence[Orientation], principal: Floats) -> list[Floats]:
    """Return the axes about which a part rolls, each once.

    An axis counts where the posture has no circle of its own on which it rolls (``rolling_circle``): the
    trial then looks for circles of the part about it.

    Parameters
    ----------
    orientations : sequence of Orientation
    principal : (3, 3) float [1]
        Principal axes as columns, in the file's axes.

    Returns
    -------
    list of (3,) float [1]
        Unit vectors, along the principal axes.
    """
    roll_axes = {}
    postures: list[Any] = [lying.posture for lying in orientations if lying.kind == "rolling"]
    for posture in postures:
        if posture.axis is not None and not np.isfinite(posture.rolling_circle):
            axis = vectors.product(posture.axis, vectors.product(posture.axes[:2], principal))
            up = axis if axis[np.argmax(np.abs(axis))] > 0.0 else -axis
            roll_axes[tuple(np.round(up, 4))] = axis
    return [vectors.unit(axis) for axis in roll_axes.values()]


def leaves_by_rule(leaving: Floats) -> Bools:
    """Return the states in which an orientation leaves as the static rule says, its own if in none.

    Parameters
    ----------
    leaving : (M, S) float [1]
        The share of each of M orientations that leaves in each of S states, the M first.

    Returns
    -------
    (M, S) bool
    """
    right = leaving > 0.0
    return right | (np.eye(len(right), right.shape[1], dtype=bool) & (right.sum(axis=1) == 0)[:, None])


def limits_at(bowl: Bowl, station: Stage, orientations: Sequence[Orientation]) -> runs.RideLimits:
    """Return how long a part has at a station and how often it is noted, by the velocity of a point mass.

    Parameters
    ----------
    bowl : Bowl
    station : Stage
    orientations : sequence of Orientation
        The longest sets how far a part may go back.

    Returns
    -------
    RideLimits
    """
    velocity = answer.answer(bowl).velocity
    speed = max(velocity if np.isfinite(velocity) else 0.0, LEAST_SPEED_M_S)
    distance, period = station.exit - station.begin, 1.0 / bowl.drive.frequency
    size = max(orientation.length for orientation in orientations)
    patience = max(0.5 * size / speed, 0.5)
    seconds = distance / (LEAST_PROGRESS_SHARE * speed) + 1.0  # what creeps is followed to the end
    interval = max(np.ceil(distance / speed / LOOKS_PER_STATION / period), 1.0) * period
    progress, places = LEAST_PROGRESS_SHARE * patience * speed, int(LOOKS_PER_STATION * PATH_ROOM) + 60
    return runs.RideLimits(seconds, patience, progress, 0.5 * size, interval, places)


def fate_at(station: Stage, outcome: int, state: State, looks: Looks, length: float) -> int:
    """Return the fate of a part that has not passed a station.

    Parameters
    ----------
    station : Stage
    outcome : int
        Of the ride: RETURNED, ROLLED, STANDS or RUNNING of ``runs``.
    state : (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
        In which it ended.
    looks : Looks
    length : float [m]
        The unit of length L.

    Returns
    -------
    int
        One of ``Fate``: STOPPED within ``AT_DEVICE_M`` of the device, else STUCK.
    """
    if outcome in (runs.RETURNED, runs.ROLLED):
        return RETURNED if outcome == runs.RETURNED else ROLLED_BACK
    wall = looks.radius, station.middle / length
    rear, front, low = part_poses.reaches(state[None], looks.corners, *wall)[0] * length
    if outcome == runs.RUNNING and station.leaves_hanging and low < -HANGING_DEPTH_M - station.drop:
        return HANGING
    first, last = station.cut
    return STOPPED if front > first - AT_DEVICE_M and rear < last + AT_DEVICE_M else STUCK


def velocities(ride: runs.Runs, radius: float, middle: float = 0.0) -> Floats:
    """Return mean velocities along the wall, over the second half of each path.

    Parameters
    ----------
    ride : Runs
        Of N parts.
    radius : float [m]
        Of the wall.
    middle : float [m], optional
        Of the track, as of ``Stage``.

    Returns
    -------
    (N,) float [m/s]
        NaN of a path of fewer than four places, and of a part that was returned.
    """
    means = np.full(len(ride.paths), np.nan)
    for n, path in enumerate(ride.paths):
        count = int(np.isfinite(path[:, 0]).sum())
        if count < 4 or ride.outcomes[n] == runs.RETURNED:
            continue
        along = along_wall(path[:count, 1:3], radius, middle)
        first = count // 2
        means[n] = (along[-1] - along[first]) / (path[count - 1, 0] - path[first, 0])
    return means


@dataclass(frozen=True, eq=False)
class Landing:
    """Fates of N parts that fell onto the track; A aspects, S orientations in which parts leave."""

    launch: str
    parts: int  # N
    lost: int  # of them off the track before they had come to lie
    # (A, 7) by the aspect on which they came to lie, at any heading; columns as FATES: passed on the
    # same aspect, turned onto another
    fates: Ints
    leaving_counts: Ints  # (S + 1,) orientation in which they left; the last is none of the known
    velocity: float  # [m/s] mean on the bare track; NaN where none travelled
    depth: float  # [m] the deepest that anything was in anything, after the landing
    partial: bool  # stopped by the user: of the parts until then

    @property
    def landed_counts(self) -> Ints:
        """Return (A,) int, how many came to lie on each aspect."""
        return self.fates.sum(axis=1)

    @property
    def leavers(self) -> int:
        """Return how many left behind the last device."""
        return int(self.leaving_counts.sum())

    @property
    def efficiency(self) -> float:
        """Return the share of the parts let fall that leaves in the orientation in which most do [1]."""
        return float(self.leaving_counts[:-1].max(initial=0) / self.parts)

    @property
    def purity(self) -> float:
        """Return the share of that orientation in what leaves [1]; NaN where nothing does."""
        return float(self.leaving_counts[:-1].max(initial=0) / self.leavers) if self.leavers else np.nan


LANDING_COLUMNS: tuple[Column[Landing], ...] = (
    Column("launch", lambda landing: landing.launch),
    Column("parts", lambda landing: landing.parts),
    Column("lost", lambda landing: landing.lost),
    Column("left", lambda landing: landing.leavers),
    Column("efficiency", lambda landing: landing.efficiency, "share"),
    Column("purity", lambda landing: landing.purity, "share"),
    Column("velocity_mm_s", lambda landing: landing.velocity, "mm/s"),
    Column("largest_penetration_mm", lambda landing: landing.depth, "mm"),
)


def landing(
    part: Part,
    bowl: Bowl,
    aspects: Aspects,
    orientations: Sequence[Orientation],
    poses: Sequence[Orientation],
    *,
    launch: str,
    parts: int,
    run: RunSettings = USUAL_RUN,
) -> Landing:
    """Let parts fall onto the bare, moving track and send those that lie on it through the devices.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    aspects : Aspects
        The A of the part.
    orientations : sequence of Orientation
        Of the part on that track.
    poses : sequence of Orientation
        The S in which a part may leave.
    launch : str
        A key of ``arrivals.launch_conditions.PRESETS``, which gives height, spin and speed.
    parts : int
        To let fall.
    run : RunSettings, optional
        It is told how many parts are done, of how many, first with the landing.

    Returns
    -------
    Landing

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all have come to lie and the first of them are through.
    FeederError
        If the part has no shape or too many facets, or the bowl conveys nothing at all.
    """
    below, thrown = AspectsBelow(part, aspects), named(launch)
    run.begin()
    # From their launch to where they lie.
    solid, length, principal = solid_of(part)
    solid = round_circles(solid, roll_axes(orientations, principal))
    part_in_bowl = runs.setting(solid, length, bowl)
    states, times = part_poses.draw_falling(bowl, thrown, below.shape, parts, length, run.seed)
    flight, fastest = np.sqrt(2.0 * thrown.fall[1]), thrown.speed[1]
    room = fastest * flight + fastest**2 / (2.0 * max(bowl.friction.kinetic, 0.05)) + solid.radius
    room = min(length * room, MAX_THROW_SHARE * 2.0 * np.pi * bowl.track.radius)
    slopes = staging.slopes_before(staging.entry_slopes(bowl.devices, bowl.track, orientations))
    stage = replace(staging.stage_bare_track(bowl.track, orientations, 2.0 * room, slopes), exit=np.inf)
    seconds = part_in_bowl.unit * (flight + EXACT_PACE.settling)
    limits = runs.RideLimits(seconds, 2.0 * seconds, 0.0, np.inf, interval=seconds, places=1)
    follow = runs.make_plain_follower(part_in_bowl, stage, limits)
    begun = part_poses.move_along_wall(states, room / length, part_in_bowl.radius)
    ride = runs.ride(follow, begun, times, jobs=run.jobs, progress=lambda done: run.tell(done, parts))
    if ride.partial:
        raise KeyboardInterrupt
    entry_rows = below.find_aspects(ride.states)
    on = (ride.outcomes == runs.RUNNING) & (entry_rows != OTHER)
    # Those that lie on the track go through the devices.
    fates = np.zeros((len(aspects.names), len(FATES)), int)
    leaving, velocity, depth, partial = np.zeros(len(poses) + 1, int), np.nan, 0.0, False
    if on.any():
        radius = bowl.track.radius / length
        back = -part_poses.ways_along_wall(ride.states[on], radius)
        lying = part_poses.move_along_wall(ride.states[on], back, radius)
        sent = SentParts(on_track=(lying, (times + ride.seconds)[on], entry_rows[on]))
        may_leave = np.ones((len(aspects.names), len(poses)), bool)
        own: Any = {"poses": poses, "may_leave": may_leave, "run": replace(run, before=None)}
        rode = course(part, bowl, orientations, sent, bowl.devices, **own)
        left, out = np.isin(rode.fates, (PASSED, TURNED)), np.full(len(rode.fates), OTHER)
        if rode.stations[-1].on_side:
            below = AspectsBelow(part, aspects, part_in_bowl.radius)
        out[rode.riders[-1]] = below.find_aspects(rode.rides[-1].states)
        becomes = np.where(left, np.where(out == rode.entry_rows, PASSED, TURNED), rode.fates)
        np.add.at(fates, (rode.entry_rows, becomes), 1)
        np.add.at(leaving, rode.orientations[-1][left], 1)
        travels = np.isfinite(rode.velocities)
        velocity = float(rode.velocities[travels].mean()) if travels.any() else np.nan
        depth, partial = float(rode.depths.max()), rode.partial
    lost = parts - int(on.sum())
    counts = check.frozen(fates), check.frozen(leaving)
    return Landing(launch, lost + int(fates.sum()), lost, *counts, velocity, depth, partial)
