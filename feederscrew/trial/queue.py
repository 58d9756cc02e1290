"""A queue of parts through a chain of devices: in a row or poured, touching and pushing each other."""

import itertools
import math
from dataclasses import dataclass, field

import numpy as np

from feederscrew import check
from feederscrew.dropping.kernel import body
from feederscrew.rates import stream
from feederscrew.tooling.orientations import Hanging
from feederscrew.trial import course, crowd, part_poses, runs, starts
from feederscrew.trial.kernel.steps import BEHIND, BELOW
from feederscrew.trial.looks import OTHER, AspectsBelow, Looks
from feederscrew.trial.rounding import rounded
from feederscrew.trial.shape import solid_of
from feederscrew.trial.staging import Stage

MEAN_GAP_SHARE = 0.2  # of a part's length: mean free way between parts as they come in a row
JAM_SECONDS = (
    1.0  # [s] a part that stands at a device with nothing before it is taken out by hand after so long
)
BACKED_UP_SECONDS = (
    0.5  # [s] a part that stands at a pressure break so long, and is pushed, has left the track
)
STANDING_WAY = 0.05  # of the unit of length: a part that has come no further stands
PART_OF_TURN = 0.5  # of the bowl's circumference, less two lengths: more parts than fit there wait to enter
CARRIED_SHARE = 0.1  # of its weight that other parts carry, and ...
CLIMB_HEIGHT = 0.02  # ... as high over the track: a part has climbed on others
WHOLE_PERIOD_TOLERANCE = (
    1e-6  # of a period: a time that is so little longer than whole periods is that of them
)
BLOCK = 40  # parts that come in exact shares
POURED_SPACING = 1.05  # of the part's radius: apart along the track, and over it, where parts are poured


@dataclass(frozen=True, eq=False)
class QueuedParts:
    """What a queue of N parts did; D devices, S orientations in which parts may leave, A aspects."""

    parts: int  # N
    on_track: int  # of them at a time, at most; the others wait to enter
    poured: bool
    seconds: float  # [s] followed
    counted: float  # [s] of them since the first part came to the outlet; 0 where none did
    delivered: float  # parts that left the last device then, that in the outlet as the share of its length
    # (S + 1, A + 1) int, in which orientation whole ones left, the last is none of the known; on which aspect
    # those lay, whatever their heading, the last hung
    whole: np.ndarray
    left_by_entry: np.ndarray  # (M, S + 1, A + 1) int, the same by the orientation in which they came
    returned_by_entry: np.ndarray  # (M,) int
    returned: int  # fell back into the bowl
    jams: int  # stood at a device and were taken out
    climbs: int  # times that a part came to lie on others
    velocity: float  # [m/s] mean of all parts
    gap: float  # [m] mean free way between neighbours
    touching: float  # [1] share of the parts that are pushed from behind
    pressure: np.ndarray  # (D,) [N] greatest mean force of a period on a part that stands at a device
    depth: float  # [m] the deepest that anything was in anything
    partial: bool  # stopped by the user: of the seconds until then
    relieved: int = 0  # of those returned, backed up at a pressure break and pushed off there
    # (F, N, 7) position [m] and attitude w x y z (principal axes to bowl), evenly over the time; NaN of a
    # part that waits to enter
    poses: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, 7)))
    moments: tuple[tuple[float, int, int], ...] = ()  # time [s], parts left and returned by then, of each
    stage: Stage | None = None  # the track with all its devices, on which they lie
    pulses: tuple[tuple[tuple[float, float], ...], ...] = ()  # [s] begin and end of each, by sensor

    @property
    def rate(self):
        """Return delivered parts [1/s]; 0 where none came to the outlet."""
        return self.delivered / self.counted if self.counted > 0.0 else 0.0

    @property
    def leaving(self):
        """Return (S + 1,) int, in which orientation whole parts left; the last is none of the known."""
        return self.whole.sum(axis=1)

    @property
    def aspects(self):
        """Return (A + 1,) int, on which aspect whole parts left, whatever their heading; the last hung."""
        return self.whole.sum(axis=0)


@dataclass(frozen=True)
class QueuePlan:
    """How many parts are in a queue, how they come, and how long they are followed."""

    parts: int
    seconds: float  # [s] at most
    # [1] mean free way between parts as they come in a row, over their length, beside the room that devices
    # need; 0 where they come touching. None: they fall onto the track in any attitude, not in a row
    gaps: float | None = MEAN_GAP_SHARE
    frames: int = 0  # poses of all parts that are noted for a film
    balanced: bool = False  # orientations in exact shares, in random order; else each is drawn by itself


def queue_of(part, bowl, aspects, orientations, poses, shares, plan, run):
    """Follow a queue of parts that come without end: what leaves is offered again at the end of the row.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
        With its devices.
    aspects : Aspects
        Of the part, A of them.
    orientations : sequence of Orientation
        M of them.
    poses : sequence of Orientation
        S of them in which parts may leave: those, then those that hang.
    shares : (M,) float [1]
        In which they come; sums to 1.
    plan : QueuePlan
    run : RunSettings
        Its progress is told how many periods of the drive are done, of how many. A queue takes one core.

    Returns
    -------
    QueuedParts

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before the first period is done.
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
    part, bowl, aspects, poses, plan
        As of ``queue_of``; the plan's seconds are not looked at.
    offered : (sequence of Orientation, (M,) float [1])
        How parts come, and in which shares.
    seed : int
    """

    def __init__(self, part, bowl, aspects, offered, poses, plan, seed):
        self.part, self.bowl, (orientations, shares), parts = part, bowl, offered, plan.parts
        solid, length, self.principal = solid_of(part)
        solid = rounded(solid, course.axes(orientations, self.principal))
        self.part_in_bowl = part_in_bowl = runs.setting(solid, length, bowl)
        self.every, self.gaps, self.parts, self.chances = orientations, plan.gaps, parts, np.cumsum(shares)
        self.rng, self.tilts = (np.random.default_rng(key) for key in ((seed, parts), (seed, parts, 1)))
        longest = max(orientation.length for orientation in orientations)
        turn = PART_OF_TURN * 2.0 * np.pi * bowl.track.radius - 2.0 * longest  # some rolls back
        room = min(1.5 * longest * parts + 2.0 * longest, max(turn, 2.0 * longest))
        self.track = crowd.crowded(bowl, orientations, bowl.devices, room)
        self.placed = [device for device in bowl.devices if device.placed]
        self.outlet, self.windows = (
            self.track.outlet / part_in_bowl.length,
            self.track.windows / part_in_bowl.length,
        )
        self.apart = stream.needed_spacing(bowl.devices, orientations, bowl) / part_in_bowl.length
        self.crowd = crowd.PartsOnTrack(part_in_bowl, self.track, parts)
        self.looks = Looks(poses, solid, length, self.principal, bowl.track.radius)
        self.mark, self.since, self.on_others = np.zeros(parts), np.zeros(parts), np.zeros(parts, bool)
        self.below, self.hanging = (
            AspectsBelow(part, aspects),
            [isinstance(orientation, Hanging) for orientation in poses],
        )
        self.left = np.zeros((len(orientations), len(poses) + 1, len(aspects.names) + 1), int)
        self.returned_by_entry, self.entered = np.zeros(len(orientations), int), np.zeros(parts, int)
        self.balanced, self.drawn = plan.balanced, []  # orientations of the parts to come
        self.returned = self.jams = self.climbs = self.relieved = 0
        self.way, self.free, self.touch, self.depth = [], [], [], 0.0
        self.pressure, self.whole, self.first, self.most = np.zeros(len(self.windows)), 0, None, 0
        self.periods, self.waiting, self.deep = 0, list(range(parts)), solid.radius * length
        self.frames, self.poses, self.moments = plan.frames, [], []
        self.coming, self.start = None, 0.0  # drawn, without room yet; how much of the first one had left
        self.enter()

    @property
    def time(self):
        """Followed so far [s]."""
        return self.periods / self.bowl.drive.frequency

    def periods_in(self, seconds):
        """Return how many periods of the drive are followed in a time [s]: no less than the time, and one."""
        return max(math.ceil(seconds * self.bowl.drive.frequency - WHOLE_PERIOD_TOLERANCE), 1)

    def follow(self, seconds, tell=None) -> None:
        """Go on until a time [s] since the queue began; what was followed before is not followed again.

        Parameters
        ----------
        seconds : float [s]
        tell : function, optional
            Told after each period how many are done, of how many.

        Raises
        ------
        KeyboardInterrupt
            If the user stops it: ``result`` has the periods until then.
        """
        count = self.periods_in(seconds)
        while self.periods < count:
            self.ride(self.periods)
            if self.periods * self.frames >= (len(self.poses) + 1) * count:
                self.note()
            if tell:
                tell(self.periods, count)

    def enter(self):
        """Let waiting parts in at the end of the row, as long as there is room.

        What has no room yet is the next one to come: were another drawn for it, short ones would come more
        often than they do.
        """
        if not self.waiting:
            return
        reach = self.crowd.reaches(np.flatnonzero(self.crowd.on))
        end = min((rear for rear, _, _ in reach.values()), default=0.0)
        while self.waiting:
            self.coming = self.coming or self.fresh()
            row, state, gap = self.coming
            rear, front, _ = part_poses.extents(
                state, self.part_in_bowl.solid.corners, self.part_in_bowl.radius
            )
            place = min(end, 0.0) - gap - front
            if place + rear < self.track.start / self.part_in_bowl.length:
                break
            self.coming = None
            n = self.waiting.pop(0)
            self.crowd.lay(n, part_poses.moved(state[None], place, self.part_in_bowl.radius)[0])
            self.mark[n], self.since[n], self.on_others[n] = place, self.time, False
            self.entered[n] = row
            end = place + rear
        self.most = max(self.most, int(self.crowd.on.sum()))

    def fresh(self):
        """A part about to enter: its orientation, its state at the place 0, and the free way before it."""
        k = self.next_row()
        orientation = self.every[k]
        track = orientation.track
        if self.gaps is not None:
            play = starts.MAX_START_PLAY_M * self.rng.random()
            state = part_poses.pose_on_track(
                orientation, self.principal, self.part_in_bowl.length, track, place=0.0
            )
            state = starts.tilted(state, self.part_in_bowl.solid.corners, self.tilts)
            state = starts.clear(
                state, self.part_in_bowl.solid, track, self.part_in_bowl.length, play, orientation.wall_leans
            )
            gap = (
                self.apart
                + 2.0 * self.gaps * self.rng.random() * orientation.length / self.part_in_bowl.length
            )
            return k, state, gap
        radius, state = self.part_in_bowl.solid.radius, np.zeros(body.STATE)
        turn = self.rng.standard_normal(4)
        state[:3] = 0.0, radius * POURED_SPACING, radius * POURED_SPACING * (1.0 + self.rng.random())
        state[body.Q : body.Q + 4] = turn / np.sqrt((turn**2).sum())
        return k, state, 0.0

    def next_row(self):
        """The orientation in which the next part comes.

        Balanced, BLOCK parts come in their shares as nearly as whole parts can, in random order: a systematic
        sample (W. G. Cochran, "Sampling techniques", 3rd ed., 1977, ch. 8).
        """
        last = len(self.every) - 1
        if not self.balanced:
            return min(int(np.searchsorted(self.chances, self.rng.random() * self.chances[-1])), last)
        if not self.drawn:
            points = (np.arange(BLOCK) + self.rng.random()) / BLOCK * self.chances[-1]
            rows = np.minimum(np.searchsorted(self.chances, points), last)
            self.drawn = self.rng.permutation(rows).tolist()
        return self.drawn.pop()

    def ride(self, turn) -> None:
        """Move all for one period of the drive, and look what became of them."""
        lying = np.flatnonzero(self.crowd.on)
        before = part_poses.ways_along_wall(self.crowd.arrays.states, self.part_in_bowl.radius)
        self.depth = max(self.depth, self.crowd.ride(turn))
        self.periods += 1
        after = part_poses.ways_along_wall(self.crowd.arrays.states, self.part_in_bowl.radius)
        self.crowd.watch(lying, before, after, turn + 1)
        fallen = self.fallen()
        on = lying[~self.crowd.blown_off()[lying]]
        if len(on):
            self.way.append((after - before)[on].mean())
        reach = self.crowd.reaches(lying)
        order = lying[np.argsort(-after[lying], kind="stable")].tolist()
        self.free += [max(reach[a][0] - reach[b][1], 0.0) for a, b in itertools.pairwise(order)]
        self.touch.append((self.crowd.forces[lying, BEHIND] > 0.0).mean())
        self.carried(lying, reach)
        for n in order:
            self.look(n, after[n], reach, order, fallen[n])
        self.enter()

    def note(self) -> None:
        """Note where all parts are, for a film."""
        states = self.crowd.arrays.states
        poses = np.concatenate(
            [states[:, :3] * self.part_in_bowl.length, states[:, body.Q : body.Q + 4]], axis=1
        )
        poses[~self.crowd.on] = np.nan
        self.poses.append(poses)
        self.moments.append((self.time, self.whole, self.returned))

    def carried(self, lying, reach) -> None:
        """Count parts that have come to lie on others."""
        for n in lying:
            on = self.crowd.forces[n, BELOW] > CARRIED_SHARE and reach[n][2] > CLIMB_HEIGHT
            self.climbs += bool(on and not self.on_others[n])
            self.on_others[n] = on

    def look(self, n, place, reach, order, fell) -> None:
        """What became of one part: left, fell, stands at a device, goes on."""
        rear, front, _ = reach[n]
        if self.first is None and front > self.outlet and not fell:
            self.first = self.time
            self.start = self.outside(rear, front)
        if rear > self.outlet and not fell and not self.crowd.slides_off(n):
            self.leave(n)
            self.send_back(n)
        elif fell or front < self.track.start / self.part_in_bowl.length:
            self.come_back(n)
        elif place - self.mark[n] > STANDING_WAY:
            self.mark[n], self.since[n] = place, self.time
        elif self.time - self.since[n] >= BACKED_UP_SECONDS and self.pushed_off(n, rear, front):
            self.relieved += 1
            self.come_back(n)
        else:
            self.stand(n, front, reach, order)

    def pushed_off(self, n, rear, front):
        """Whether a part that stands is at a pressure break, reaches over its ledge, and is pushed.

        Source: the trade's use of a pressure break: parts that back up leave the track there.
        """
        at = [
            device.limit
            for device, (begin, end) in zip(self.placed, self.windows)
            if device.relieves and rear < end and front > begin
        ]
        if not at or not self.crowd.forces[n, BEHIND] > 0.0:
            return False
        state = self.crowd.arrays.states[n]
        across = part_poses.reach(state, self.part_in_bowl.solid.corners, self.part_in_bowl.radius)
        return bool(across * self.part_in_bowl.length > min(at))

    def leave(self, n) -> None:
        """Count a part that has left: its orientation, and the aspect on which it lies."""
        state = self.at_outlet(n)
        orientation = self.looks.of([state])[0]
        hangs = orientation != OTHER and self.hanging[orientation]
        self.whole += 1
        self.left[self.entered[n], orientation, OTHER if hangs else self.below.of([state])[0]] += 1

    def come_back(self, n) -> None:
        """Count a part that fell back into the bowl."""
        self.returned += 1
        self.returned_by_entry[self.entered[n]] += 1
        self.send_back(n)

    def stand(self, n, front, reach, order) -> None:
        """A part that stands: what pushes it, and whether it is what holds the others up."""
        at = np.flatnonzero((self.windows[:, 0] < front) & (front < self.windows[:, 1] + STANDING_WAY))
        if not len(at):
            return
        force = self.crowd.forces[n, BEHIND]
        self.pressure[at[0]] = max(self.pressure[at[0]], force)
        ahead = [reach[m][0] - front for m in order if m != n and self.crowd.on[m] and reach[m][1] > front]
        if self.time - self.since[n] >= JAM_SECONDS and min(ahead, default=np.inf) > MEAN_GAP_SHARE:
            self.jams += 1
            self.send_back(n)

    def fallen(self):
        """Which parts, (N,) bool, have fallen off the track they are at, or were blown off it."""
        heights = self.crowd.arrays.states[:, body.Z] * self.part_in_bowl.length
        return self.crowd.blown_off() | (heights < self.track.levels.min() - self.deep)

    def at_outlet(self, n):
        """The state of a part as if the track were at the level at which it began."""
        state = np.array(self.crowd.arrays.states[n])
        state[body.Z] -= self.track.levels[-1] / self.part_in_bowl.length
        return state

    def send_back(self, n) -> None:
        """Take a part off the track; it waits to enter again."""
        self.crowd.take(n)
        self.waiting.append(n)

    def outside(self, rear, front) -> float:
        """How much of a part has left [1]."""
        return float(np.clip((front - self.outlet) / (front - rear), 0.0, 1.0))

    def result(self, partial=False) -> QueuedParts:
        """Return what the parts did so far, QueuedParts; ``partial`` where the user stopped it."""
        length, seconds = self.part_in_bowl.length, self.time
        reach = self.crowd.reaches(np.flatnonzero(self.crowd.on))  # none of them has fallen
        part = sum(self.outside(rear, front) for rear, front, _ in reach.values())
        counted = 0.0 if self.first is None else seconds - self.first
        return QueuedParts(
            parts=self.parts,
            on_track=self.most,
            poured=self.gaps is None,
            seconds=seconds,
            counted=counted,
            delivered=self.whole + part - self.start if counted else 0.0,
            whole=check.frozen(self.left.sum(axis=0)),
            left_by_entry=check.frozen(np.array(self.left)),
            returned_by_entry=check.frozen(np.array(self.returned_by_entry)),
            returned=self.returned,
            jams=self.jams,
            climbs=self.climbs,
            velocity=float(np.mean(self.way)) * length * self.bowl.drive.frequency,
            gap=float(np.mean(self.free)) * length if self.free else 0.0,
            touching=float(np.mean(self.touch)),
            pressure=check.frozen(self.pressure * self.part.mass * self.bowl.gravity),
            depth=self.depth * length,
            partial=partial,
            relieved=self.relieved,
            poses=check.frozen(np.reshape(self.poses, (len(self.poses), self.parts, 7))),
            moments=tuple(self.moments),
            stage=self.track.stage,
            pulses=tuple(
                tuple(
                    (begin * self.part_in_bowl.unit, end * self.part_in_bowl.unit)
                    for begin, end in pulses.log
                )
                for pulses in self.crowd.pulses
            ),
        )
