"""Several parts on one track with all its devices, in a row or poured: they push, carry, climb each other."""

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import zero_rows
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.feeding import stream
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.sorting.tooled_track import TooledTrack, lay_out, size_of_part
from feederscrew.trials import course, part_poses, runs, staging
from feederscrew.trials.kernel import travel, workspace
from feederscrew.trials.kernel.steps import BEHIND, BELOW, IN_PART, IN_TRACK
from feederscrew.trials.looks import OTHER, AspectsBelow, Looks
from feederscrew.trials.part_poses import State
from feederscrew.trials.queue_counts import MAX_QUEUE_DEPTH_M, QueueCounts, QueuedParts
from feederscrew.trials.shape import round_circles, solid_of
from feederscrew.trials.staging import Stage
from feederscrew.trials.supply import PartSupply, QueuePlan

JAM_CLEARANCE = 0.2  # [L] of free way ahead: a part that stands behind so much is held by a device alone
JAM_SECONDS = 1.0  # a part that stands at a device so long, nothing before it, is taken out by hand
BACKED_UP_SECONDS = 0.5  # a part that stands at a pressure break so long, and is pushed, has left the track
STANDING_WAY = 0.05  # [L] of the part's length: a part that has come no further since its last mark stands
PART_OF_TURN = 0.5  # of the bowl's circumference, less two lengths: more parts than fit there wait to enter
CARRIED_SHARE = 0.1  # [1] of its weight: a part of which others carry more, and which lies higher than
CLIMB_HEIGHT = 0.02  # [L] over the track at its place, has climbed on others
WHOLE_PERIOD_TOLERANCE = 1e-6  # of a period: a time so little longer than whole periods is that of them
PITCHES_BEFORE = 2.0  # greatest pitches of parts that come with room for a sensor: track before its devices
SEEN_AGAIN_WAY = 0.5  # [L] back from a sensor: a part that comes again from there is seen again
SPEED_PERIODS = 8  # over which a sensor takes the speed of a part: within one it may hop or be pushed
TAIL = 1.2  # of the part's size: track behind the outlet, on which a whole part still lies as it leaves
APART = 1.2  # of the part's size: from the end of what is drawn on to its begin, round the bowl, at least


@dataclass(frozen=True, eq=False)
class CrowdedTrack:
    """The bare track for a row, then the devices one behind the other; D devices."""

    stage: Stage
    start: float  # [m] along the wall, where the drawn track begins
    windows: Floats  # (D, 2) [m] where each device's stretch begins and ends
    levels: Floats  # (D + 1,) [m] of the track before the first device and behind each
    changes: Floats  # (D,) [m] along the wall, where it is at the level behind each device
    outlet: float  # [m] behind the last of them

    def level_at(self, place: float) -> float:
        """Return the level of the track at a place along the wall: of a ledge its own, up to its end.

        Parameters
        ----------
        place : float [m]

        Returns
        -------
        float [m]
        """
        return float(self.levels[int(np.searchsorted(self.changes, place, side="right"))])


def lay_out_track(
    bowl: Bowl,
    orientations: Sequence[Orientation],
    devices: Sequence[Device],
    room: float,
    least: float | None = None,
) -> CrowdedTrack:
    """Return the track for a row of parts: bare up to the place 0, then the devices one behind the other.

    All of it lies within one turn of the bowl: in its plane a second turn would lie on the first.

    Parameters
    ----------
    bowl : Bowl
        Its track.
    orientations : sequence of Orientation
        Of the part.
    devices : sequence of Device
        In the order parts meet them; one that is a measured yield is left out.
    room : float [m]
        Length of the bare track; it is shorter where the devices leave less of a turn.
    least : float [m], optional
        Length of it that a row needs; ``room`` without it.

    Returns
    -------
    CrowdedTrack

    Raises
    ------
    FeederError
        If devices and row need more than a turn of the bowl.
    """
    track, size = bowl.track, size_of_part(orientations)
    tooled = lay_out(track, devices, orientations, whole=True)
    end, room = tooled.length + TAIL * size, room_within_turn(tooled, size, room, least)
    ends = -room - size, end
    placed = staging.place_all(tooled, end, size)
    levels, changes = [0.0], []
    for item in placed:
        drop = item.features.drop
        levels.append(levels[-1] - item.lower[0])
        changes.append(item.begin + (0.0 if drop is None or drop.aside <= 0.0 else item.features.length))
    # The bare track has the bowl's climb: a spacing section leads down from its own place on.
    first = [replace(slope, climb=None) for slope in staging.entry_slopes(devices, track, orientations)]
    blown = staging.place_air(placed, track, orientations)
    stage = Stage(
        staging.BARE_TRACK,
        *staging.build_track(placed, track, size, ends),
        begin=-room,
        exit=np.inf,
        air=replace(blown, slopes=(*staging.slopes_before(first), *blown.slopes)),
        size=size,
        width=track.extent,
        on_side=staging.on_side(devices),
        middle=0.5 * sum(ends),
    )
    windows = [(item.start, item.end) for item in tooled.devices]
    spans = check.frozen(np.reshape(windows, (-1, 2)).astype(float))
    heights = check.frozen(np.array(levels)), check.frozen(np.array(changes, float))
    return CrowdedTrack(stage, -room, spans, *heights, tooled.length)


def room_within_turn(tooled: TooledTrack, size: float, room: float, least: float | None = None) -> float:
    """Return how long the bare track before devices is, of which a turn of the bowl has room.

    Parameters
    ----------
    tooled : TooledTrack
    size : float [m]
        Of the part, as ``size_of_part`` returns it.
    room : float [m]
        As long as it is at the most.
    least : float [m], optional
        As long as a row needs it; ``room`` without it.

    Returns
    -------
    float [m]

    Raises
    ------
    FeederError
        If devices and row need more than a turn of the bowl.
    """
    turn, least = 2.0 * np.pi * tooled.track.radius, room if least is None else least
    left = turn - tooled.length - (1.0 + TAIL + APART) * size
    if least > left:
        takes, needs = f"take {1e3 * tooled.length:.4g} mm of track", f"{1e3 * least:.4g} mm before them"
        what = f"{takes}, and a row of parts needs {needs}: a turn of the bowl has {1e3 * turn:.4g} mm"
        raise FeederError("devices", what, "take fewer, or a larger track.radius")
    return min(room, left)


def bare_track(bowl: Bowl, orientations: Sequence[Orientation], plan: QueuePlan) -> tuple[float, float]:
    """Return how long the bare track before the devices of a bowl is for a row of parts.

    Parameters
    ----------
    bowl : Bowl
        With its devices.
    orientations : sequence of Orientation
        In which parts come.
    plan : QueuePlan
        Of the row.

    Returns
    -------
    room, least : float [m]
        As long as it is where a turn of the bowl leaves so much, and as short as it may be.
    """
    longest = max(orientation.length for orientation in orientations)
    spacing = stream.needed_spacing(bowl.devices, orientations, bowl)
    turn = PART_OF_TURN * 2.0 * np.pi * bowl.track.radius - 2.0 * longest  # some rolls back
    room = min(1.5 * longest * plan.parts + 2.0 * longest, max(turn, 2.0 * longest))
    pitch = spacing + (1.0 + 2.0 * (plan.gaps or 0.0)) * longest  # the greatest
    if plan.is_ridden and spacing > 0.0:  # parts that come with room do not push each other
        room = min(room, PITCHES_BEFORE * pitch)
    room = max(room, pitch)  # or no part ever enters
    return room, min(room, max(pitch, 2.0 * longest))


Reaches = dict[int, list[float]]  # [L] by part: rear and front along the wall, and its lowest point


class QueueOutcome(Enum):
    """What has become of a part of a queue in a period of the drive."""

    LEFT = auto()  # beyond the outlet, on the track
    FELL = auto()  # beyond the free edge, below the track, or back from where the track begins
    GOES_ON = auto()
    STANDS = auto()  # held, by a device or by the part before it
    BACKED_UP = auto()  # stood at a pressure break, and was pushed off there
    JAMS = auto()  # stands at a device so long that somebody takes it out
    OVERLAPS = auto()  # the same, but too deep in another part or in the track: a fault of the trial


class PartsOnTrack:
    """N parts at most on a track, moved period by period; lengths in units of the part's, along the wall.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    track : CrowdedTrack
    count : int
        N.
    """

    def __init__(self, part_in_bowl: runs.BowlOfPart, track: CrowdedTrack, count: int) -> None:
        self.part_in_bowl, self.solid, self.stage = part_in_bowl, part_in_bowl.solid, track.stage
        self.hull = part_in_bowl.solid.corners[part_in_bowl.solid.outer]
        self.track, self.middle = track, track.stage.middle / part_in_bowl.length
        self.surface = runs.surface_of(part_in_bowl, track.stage)
        self.arrays = runs.workspace_of(part_in_bowl.solid, self.surface, count)
        self.is_on = np.zeros(count, bool)
        self.period = 2.0 * np.pi / part_in_bowl.floor.rate
        self.last_ways = np.full((SPEED_PERIODS, count), np.nan)  # ways of each, of the last periods
        self.pulses = [staging.Pulses() for _ in track.stage.air.watches]
        self.was_seen = np.zeros((len(self.pulses), count), bool)  # by each sensor, since it came to it

    def lay(self, n: int, state: State) -> None:
        """Put a part onto the track.

        Parameters
        ----------
        n : int
            Its number, from 0.
        state : (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
        """
        self.arrays.states[n] = state
        runs.forget(self.arrays, n)
        self.last_ways[:, n] = np.nan
        self.was_seen[:, n] = False
        self.is_on[n] = True

    def take(self, n: int) -> None:
        """Take a part off the track.

        Parameters
        ----------
        n : int
            Its number, from 0.
        """
        self.is_on[n] = False

    def ride(self, turn: int) -> float:
        """Move all parts through one period of the drive.

        Parameters
        ----------
        turn : int
            Which period, from 0: it sets the time.

        Returns
        -------
        float [L]
            The deepest that anything was in anything.
        """
        journals = zero_rows(1, workspace.JOURNAL)
        steps = round(self.period / self.part_in_bowl.floor.step)
        crowd = workspace.QueueSteps(self.is_on, turn * self.period, steps, journals)
        runs.move_crowd(self.part_in_bowl, self.surface, self.arrays, crowd)
        return float(journals.depth[0])

    def slides_off(self, n: int) -> bool:
        """Tell whether a part is beyond the free edge, or too fast towards it to stay on the track.

        Parameters
        ----------
        n : int
            Its number, from 0.

        Returns
        -------
        bool
        """
        out = travel.slides_to(self.surface, self.arrays.states[n])
        return bool(out > self.stage.width / self.part_in_bowl.length)

    def watch(self, rows: Ints, before: Floats, after: Floats, turn: int) -> None:
        """Let sensors look at the parts whose centres of mass have come past them in a period.

        What is nearer to a part than the sensor can tell is one with it. Jets that a part sets off blow as
        it comes to them at its mean speed of the last periods; at that of this one where it has come no
        further in those. A part that rocks is seen once, until it has gone back by ``SEEN_AGAIN_WAY``.

        Parameters
        ----------
        rows : (K,) int
            The parts on the track.
        before, after : (N,) float [L]
            Places of all parts along the wall, before the period and behind it.
        turn : int
            The next period, from which on jets blow.
        """
        if not self.pulses:
            return
        self.last_ways[1:] = self.last_ways[:-1]
        self.last_ways[0] = before
        now, length = turn * self.period, self.part_in_bowl.length
        for watch, pulses, was_seen in zip(self.stage.air.watches, self.pulses, self.was_seen):
            place = watch.place / length
            was_seen &= after >= place - SEEN_AGAIN_WAY
            for n in [n for n in rows if before[n] < place <= after[n] and not was_seen[n]]:
                was_seen[n] = True
                states = self.arrays.states[[n, *self.parts_near(n, rows, watch.sensor.resolution)]]
                level = self.track.level_at(watch.place)
                if runs.blows_off(watch.sensor, self.part_in_bowl, states, level):
                    noted = self.last_ways[np.isfinite(self.last_ways[:, n]), n]
                    speed = (after[n] - noted[-1]) / (len(noted) * self.period)
                    speed = speed if speed > 0.0 else (after[n] - before[n]) / self.period
                    left = max(watch.nozzles / length - after[n], 0.0)
                    pulses.set_off(now + left / speed, watch.seconds / self.part_in_bowl.unit)
            self.surface.jets.begin[watch.jets], self.surface.jets.end[watch.jets] = pulses.next(now)

    def parts_near(self, n: int, rows: Iterable[int], resolution: float) -> list[int]:
        """Return the parts that are one with a part for a sensor, directly or by others between them.

        Parameters
        ----------
        n : int
            The part.
        rows : iterable of int
            The parts on the track, n among them.
        resolution : float [m]
            The least gap along the wall that the sensor tells.

        Returns
        -------
        list of int
            Without n.
        """
        reach = self.reaches(rows)
        touching, rear, front = [], reach[n][0], reach[n][1]
        wide = resolution / self.part_in_bowl.length
        for m in sorted(rows, key=lambda m: abs(reach[m][0] - reach[n][0])):
            if m != n and reach[m][0] < front + wide and reach[m][1] > rear - wide:
                touching.append(m)
                rear, front = min(rear, reach[m][0]), max(front, reach[m][1])
        return touching

    @property
    def forces(self) -> Floats:
        """Return (N, 2) mean forces of others in the last period, from behind and below, over the weight."""
        return self.arrays.strains / self.period

    def ways(self) -> Floats:
        """Return (N,) how far along the wall the centre of mass of each part is [L]."""
        return part_poses.ways_along_wall(self.arrays.states, self.part_in_bowl.radius, self.middle)

    @property
    def depths(self) -> Floats:
        """Return (N, 2) [L] the deepest of each in the last period: in the track, and in another part."""
        return self.arrays.depths

    def reaches(self, rows: Iterable[int]) -> Reaches:
        """Return, by part, how far it reaches along the wall and down.

        Parameters
        ----------
        rows : iterable of int
            Parts on the track.

        Returns
        -------
        dict of int to list of float [L]
            Rear and front along the wall, and the height of the lowest point.
        """
        states = self.arrays.states[list(rows)]
        wall = self.part_in_bowl.radius, self.middle
        return dict(zip(rows, part_poses.reaches(states, self.hull, *wall).tolist()))


def queue_of(
    part: Part,
    bowl: Bowl,
    aspects: Aspects,
    orientations: Sequence[Orientation],
    poses: Sequence[Orientation],
    shares: Floats,
    plan: QueuePlan,
    run: RunSettings,
) -> QueuedParts:
    """Follow a queue of parts that come without end: what leaves is offered again at the end of the row.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    aspects : Aspects
        Of the part.
    orientations : sequence of Orientation
        The M in which parts come.
    poses : sequence of Orientation
        The S in which they may leave: those M, then those that hang.
    shares : (M,) float [1]
        In which they come; the sum is 1.
    plan : QueuePlan
    run : RunSettings
        It is told how many periods of the drive are done, of how many. A queue takes one core.

    Returns
    -------
    QueuedParts
        Of the periods until the user stopped it, if he did.

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before the first period is done.
    FeederError
        If the part has no shape or too many facets, or devices and row need more than a turn of the bowl.
    """
    run.begin()
    queue = PartsQueue(part, bowl, aspects, (orientations, shares), poses, plan, run.seed)
    try:
        queue.follow(plan.seconds, run.tell)
    except KeyboardInterrupt:
        if not queue.periods:
            raise
    return queue.result(partial=queue.periods < queue.periods_in(plan.seconds))


class PartsQueue:
    """A queue that is followed bit by bit; lengths in units of the part's, times in seconds.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspects : Aspects
    supply : (sequence of Orientation, (M,) float [1])
        The M orientations in which parts come, and their shares.
    poses : sequence of Orientation
        As of ``queue_of``.
    plan : QueuePlan
        ``follow`` says how long the queue goes on; the frames for a film are spread over the plan's seconds.
    seed : int
        Of play, gaps, tilt and the order of the orientations.
    """

    def __init__(
        self,
        part: Part,
        bowl: Bowl,
        aspects: Aspects,
        supply: tuple[Sequence[Orientation], Floats],
        poses: Sequence[Orientation],
        plan: QueuePlan,
        seed: int,
    ) -> None:
        self.part, self.bowl, self.plan, (self.orientations, shares) = part, bowl, plan, supply
        solid, length, principal = solid_of(part)
        solid = round_circles(solid, course.roll_axes(self.orientations, principal))
        self.part_in_bowl = runs.setting(solid, length, bowl)
        count, spacing = plan.parts, stream.needed_spacing(bowl.devices, self.orientations, bowl)
        rooms = bare_track(bowl, self.orientations, plan)
        self.track = lay_out_track(bowl, self.orientations, bowl.devices, *rooms)
        self.devices = [device for device in bowl.devices if device.action.has_place]
        self.outlet, self.windows = self.track.outlet / length, self.track.windows / length
        self.stretches = self.windows.tolist()
        self.crowd = PartsOnTrack(self.part_in_bowl, self.track, count)
        on_side = self.track.stage.on_side
        self.looks = Looks(poses, solid, length, principal, bowl.track.radius, on_side)
        self.below = AspectsBelow(part, aspects, self.part_in_bowl.radius if on_side else 0.0)
        self.hanging = [isinstance(pose, Hanging) for pose in poses]
        self.supply = PartSupply(
            self.part_in_bowl, self.orientations, shares, principal, plan, spacing / length, seed
        )
        # Of each part: where it was last on its way, since when, whether it lies on others, how it came.
        self.mark, self.since = np.zeros((2, count))
        self.on_others, self.entry_rows = np.zeros(count, bool), np.zeros(count, int)
        self.waiting_parts, self.periods = list(range(count)), 0
        self.counts = QueueCounts(len(self.orientations), len(poses), len(aspects.names), len(self.windows))
        self.poses: list[Floats] = []
        self.moments: list[tuple[float, int, int]] = []
        self.enter()

    @property
    def time(self) -> float:
        """Return the time followed so far [s]."""
        return self.periods / self.bowl.drive.frequency

    def periods_in(self, seconds: float) -> int:
        """Return how many periods of the drive are followed in a time.

        Parameters
        ----------
        seconds : float [s]

        Returns
        -------
        int
            No less than the time, and one at least.
        """
        return max(math.ceil(seconds * self.bowl.drive.frequency - WHOLE_PERIOD_TOLERANCE), 1)

    def follow(self, seconds: float, tell: Callable[[int, int], None] | None = None) -> None:
        """Go on until a time since the queue began; what was followed before is not followed again.

        Parameters
        ----------
        seconds : float [s]
            Since the queue began.
        tell : callable, optional
            Told after each period how many are done, of how many.

        Raises
        ------
        KeyboardInterrupt
            If the user stops it: ``result`` has the periods until then.
        """
        count, planned = self.periods_in(seconds), self.periods_in(self.plan.seconds)
        while self.periods < count:
            self.ride(self.periods)
            if self.periods * self.plan.frames >= (len(self.poses) + 1) * planned:
                # Where all parts are, for a film.
                states = self.crowd.arrays.states
                places, attitudes = states[:, :3] * self.part_in_bowl.length, states[:, body.Q : body.Q + 4]
                poses = np.concatenate([places, attitudes], axis=1)
                poses[~self.crowd.is_on] = np.nan
                self.poses.append(poses)
                self.moments.append((self.time, self.counts.whole, self.counts.returned))
            if tell:
                tell(self.periods, count)

    def enter(self, reach: Reaches | None = None) -> None:
        """Let waiting parts in at the end of the row, as long as there is room.

        What has no room yet is the next one to come.

        Parameters
        ----------
        reach : dict of int to list of float [L], optional
            Of all parts, as ``PartsOnTrack.reaches`` returns it; some may have been taken off since. Found
            here without it.
        """
        if not self.waiting_parts:
            return
        if reach is None:
            reach = self.crowd.reaches(np.flatnonzero(self.crowd.is_on))
        rears = [rear for n, (rear, _, _) in reach.items() if self.crowd.is_on[n]]
        end = min(rears, default=0.0)
        while self.waiting_parts:
            part = self.supply.see_next()
            place = min(end, 0.0) - part.gap - part.front
            if place + part.rear < self.track.start / self.part_in_bowl.length:
                break
            self.supply.take_next()
            n = self.waiting_parts.pop(0)
            state = part_poses.move_along_wall(part.state[None], place, self.part_in_bowl.radius)[0]
            self.crowd.lay(n, state)
            self.mark[n], self.since[n], self.on_others[n] = place, self.time, False
            self.entry_rows[n] = part.row
            end = place + part.rear
        self.counts.max_on_track = max(self.counts.max_on_track, int(self.crowd.is_on.sum()))

    def ride(self, turn: int) -> None:
        """Move all parts for one period of the drive, and look what became of them.

        Parameters
        ----------
        turn : int
            Which period, from 0.
        """
        lying, radius = np.flatnonzero(self.crowd.is_on), self.part_in_bowl.radius
        counts = self.counts
        before = self.crowd.ways()
        self.crowd.ride(turn)
        counts.depths = np.maximum(counts.depths, self.crowd.depths[lying].max(axis=0, initial=0.0))
        self.periods += 1
        after = self.crowd.ways()
        self.crowd.watch(lying, before, after, turn + 1)
        # Blown off: so far beyond the free edge that the track holds them no more. Fallen: those, and what is
        # below the track's lowest level.
        length, size = self.part_in_bowl.length, self.part_in_bowl.solid.radius
        x, y, z = self.crowd.arrays.states[:, body.X : body.Z + 1].T
        out = radius - np.sqrt(x * x + (radius - y) * (radius - y))
        blown = out > self.track.stage.width / length + runs.OVER_EDGE_SHARE * size
        fallen = blown | (z * length < self.track.levels.min() - size * length)
        on = lying[~blown[lying]]
        if len(on):
            counts.ways.append((after - before)[on].mean())
        reach = self.crowd.reaches(lying)
        order = lying[np.argsort(-after[lying], kind="stable")].tolist()
        counts.free_ways += [max(reach[a][0] - reach[b][1], 0.0) for a, b in itertools.pairwise(order)]
        forces = self.crowd.forces
        counts.touch_shares.append((forces[lying, BEHIND] > 0.0).mean())
        # parts that have come to lie on others; what is asked of each part in each period is asked of lists
        levels = self.track.levels[np.searchsorted(self.track.changes, after * length, side="right")]
        below, heights, places = forces[:, BELOW].tolist(), (levels / length).tolist(), after.tolist()
        for n in lying.tolist():
            over = reach[n][2] - heights[n]
            climbed = below[n] > CARRIED_SHARE and over > CLIMB_HEIGHT
            counts.climbs += climbed and not self.on_others[n]
            self.on_others[n] = climbed
        for n in order:
            self._count(n, self.outcome_of(n, places[n], reach, fallen[n]), places[n], reach)
        self.enter(reach)

    def outcome_of(self, n: int, place: float, reach: Reaches, has_fallen: bool) -> QueueOutcome:
        """Return what has become of a part in a period.

        Parameters
        ----------
        n : int
            The part.
        place : float [L]
            Of its centre of mass along the wall.
        reach : dict of int to list of float [L]
            Of all parts, as ``PartsOnTrack.reaches`` returns it.
        has_fallen : bool
            Whether it is beyond the free edge, or below the track.

        Returns
        -------
        QueueOutcome
        """
        rear, front, _ = reach[n]
        stood = self.time - self.since[n]
        if rear > self.outlet and not has_fallen and not self.crowd.slides_off(n):
            return QueueOutcome.LEFT
        if has_fallen or front < self.track.start / self.part_in_bowl.length:
            return QueueOutcome.FELL
        if place - self.mark[n] > STANDING_WAY:
            return QueueOutcome.GOES_ON
        if stood >= BACKED_UP_SECONDS and self._is_pushed_off(n, rear, front):
            return QueueOutcome.BACKED_UP
        if not self._devices_at(front):
            return QueueOutcome.STANDS
        # Whether it is what holds the others up: nothing stands close before it.
        ahead = [reach[m][0] - front for m in reach if m != n and self.crowd.is_on[m] and reach[m][1] > front]
        is_first = min(ahead, default=np.inf) > JAM_CLEARANCE
        if stood < JAM_SECONDS or not is_first:
            return QueueOutcome.STANDS
        deep = self.crowd.depths[n].max() * self.part_in_bowl.length
        return QueueOutcome.OVERLAPS if deep > MAX_QUEUE_DEPTH_M else QueueOutcome.JAMS

    def _count(self, n: int, outcome: QueueOutcome, place: float, reach: Reaches) -> None:
        """Count what has become of a part, and take it off the track where it is no longer on it."""
        rear, front, _ = reach[n]
        if front > self.outlet and outcome is not QueueOutcome.FELL:
            self.counts.note_first(self.time, self._outside(rear, front))
        match outcome:
            case QueueOutcome.LEFT:
                self.counts.note_left(self.entry_rows[n], *self._way_up(n))
                self._take_off(n)
            case QueueOutcome.FELL | QueueOutcome.BACKED_UP:
                self.counts.relieved += outcome is QueueOutcome.BACKED_UP
                self.counts.note_returned(self.entry_rows[n], int(np.searchsorted(self.windows[:, 0], front)))
                self._take_off(n)
            case QueueOutcome.GOES_ON:
                self.mark[n], self.since[n] = place, self.time
            case QueueOutcome.STANDS | QueueOutcome.JAMS | QueueOutcome.OVERLAPS:
                devices = self._devices_at(front)[:1]
                for device in devices:
                    self.counts.note_pressure(device, self.crowd.forces[n, BEHIND])
                if outcome is not QueueOutcome.STANDS:
                    if outcome is QueueOutcome.JAMS:
                        self.counts.note_jam(self.entry_rows[n], devices[0] + 1)
                    else:
                        self.counts.overlaps += 1
                    self._take_off(n)
                    for other, (_, end, _) in reach.items():  # what it held up has not stood by itself
                        if end <= front:
                            self.since[other] = self.time

    def _devices_at(self, front: float) -> list[int]:
        """The devices at whose stretch a part stands, by the place of its front [L]."""
        stretches = enumerate(self.stretches)
        return [k for k, (begin, end) in stretches if begin < front < end + STANDING_WAY]

    def _way_up(self, n: int) -> tuple[int, int]:
        """The pose and the aspect in which a part leaves, as if the track were at its first level."""
        state = np.array(self.crowd.arrays.states[n])
        state[body.Z] -= self.track.levels[-1] / self.part_in_bowl.length
        pose = self.looks.find_orientations([state])[0]
        hangs = pose != OTHER and self.hanging[pose]
        return pose, OTHER if hangs else self.below.find_aspects([state])[0]

    def _is_pushed_off(self, n: int, rear: float, front: float) -> bool:
        """Tell whether a part that stands is at a pressure break, reaches over its ledge, and is pushed.

        Source: the trade's use of a pressure break: parts that back up leave the track there.
        """
        limits = [
            device.limit
            for device, (begin, end) in zip(self.devices, self.windows)
            if device.action is Action.RELIEVE and rear < end and front > begin
        ]
        if not limits or not self.crowd.forces[n, BEHIND] > 0.0:
            return False
        state, solid, radius = self.crowd.arrays.states[n], self.part_in_bowl.solid, self.part_in_bowl.radius
        x, y, _ = (state[:3] + vectors.product(solid.corners, part_poses.matrix(state).T)).T
        across = float(radius - np.hypot(x, radius - y).min())
        return across * self.part_in_bowl.length > min(limits)

    def _take_off(self, n: int) -> None:
        """Take a part off the track; it waits to enter again."""
        self.crowd.take(n)
        self.waiting_parts.append(n)

    def _outside(self, rear: float, front: float) -> float:
        """Return the share of a part's length that has left [1]."""
        return float(np.clip((front - self.outlet) / (front - rear), 0.0, 1.0))

    def result(self, partial: bool = False) -> QueuedParts:
        """Return the counts of the queue so far, in SI units.

        Parameters
        ----------
        partial : bool, optional
            Whether the user stopped it.

        Returns
        -------
        QueuedParts
            Valid once one period has been followed.
        """
        length, unit, seconds = self.part_in_bowl.length, self.part_in_bowl.unit, self.time
        reach = self.crowd.reaches(np.flatnonzero(self.crowd.is_on))  # none of them has fallen
        part = sum(self._outside(rear, front) for rear, front, _ in reach.values())
        counts, counted_seconds = self.counts, self.counts.counted_seconds(seconds)
        logs = [pulses.log for pulses in self.crowd.pulses]
        return QueuedParts(
            parts=self.plan.parts,
            on_track=counts.max_on_track,
            is_poured=self.plan.gaps is None,
            seconds=seconds,
            counted_seconds=counted_seconds,
            # below 0 where the first part fell back from the outlet
            delivered=max(counts.whole + part - counts.first_share, 0.0) if counted_seconds else 0.0,
            whole=check.frozen(counts.left.sum(axis=0)),
            left_by_entry=check.frozen(np.array(counts.left)),
            returned_by_entry=check.frozen(counts.returned_at.sum(axis=1)),
            returned_at=check.frozen(np.array(counts.returned_at)),
            jammed_at=check.frozen(np.array(counts.jammed_at)),
            returned=counts.returned,
            jams=counts.jams,
            climbs=counts.climbs,
            velocity=float(np.mean(counts.ways)) * length * self.bowl.drive.frequency,
            gap=float(np.mean(counts.free_ways)) * length if counts.free_ways else 0.0,
            touching=float(np.mean(counts.touch_shares)),
            pressure=check.frozen(counts.pressure * self.part.mass * self.bowl.gravity),
            depth_in_track=float(counts.depths[IN_TRACK]) * length,
            depth_in_part=float(counts.depths[IN_PART]) * length,
            overlaps=counts.overlaps,
            partial=partial,
            relieved=counts.relieved,
            poses=check.frozen(np.reshape(self.poses, (len(self.poses), self.plan.parts, 7))),
            moments=tuple(self.moments),
            stage=self.track.stage,
            pulses=tuple(tuple((begin * unit, end * unit) for begin, end in log) for log in logs),
        )
