"""Short trials of a chain: what of each orientation leaves, how, and what names its device."""

import functools
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from feederscrew.arrivals.pool import gather
from feederscrew.arrivals.toss_runs import scattered
from feederscrew.base import check
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.running import RunSettings
from feederscrew.base.signatures import Keywords
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.orientation_names import place_of
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import PURE
from feederscrew.designing import calm_drive
from feederscrew.designing.findings import End, Fault, FaultKind
from feederscrew.designing.proof import RobustRun
from feederscrew.feeding import stream
from feederscrew.motion.conveying import RESTITUTION_DOUBT
from feederscrew.part.hull import convex_hull
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, find
from feederscrew.sorting.fates import at_entry
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.sorting.orientations import orientations as on_the_track
from feederscrew.trials import course, runs
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import FillLevel
from feederscrew.trials.looks import AspectsBelow
from feederscrew.trials.wanted import find_poses, leaves_hanging, wanted_rows, wanted_states

SELDOM_SHARE = 5e-3  # [1] orientations that come less often are left out
STUCK_FATES = (Fate.HANGING, Fate.STOPPED)  # what is stuck on the bare track is pushed on by a queue
COUNTED = ("parts", "right", "wrong", "held")  # of each orientation tried
FEW_OTHERS = 8  # so many other orientations are tried more than once
GAP = 1.0 + FillLevel.LOW.gaps  # pitch of parts that come in a row at low fill, over their length


@dataclass(frozen=True, eq=False)
class ShortTrial:
    """Outcome of single parts in one bowl; M orientations."""

    orientations: stream.Orientations
    shares: Floats  # (M,) [1] in which they come; sums to 1
    rows: Ints  # (R,) int, the orientations tried
    parts: Ints  # (R,) int, of each
    right: Ints  # (R,) int, left in the wanted state
    wrong: Ints  # (R,) int, left in another
    held: Ints  # (R,) int, stay at a device or hang
    ends: tuple[dict[End, int], ...]  # (R,) of those that did not leave: how, where and how many
    velocity: float  # [m/s] mean of those that travel
    states: tuple[int, ...]  # the wanted one, then all that count as it
    spacing: float = 0.0  # [m] free way between parts that the devices need
    courses: tuple = ()  # of Course: what was followed
    turns: tuple[dict[End, int], ...] = ()  # (R,) where parts turned that left so, and how many
    shown: tuple[int, ...] | None = None  # rows that shall leave, where another trial has shown which do

    @property
    def wanted(self) -> list[int]:
        """Orientations that shall leave as wanted, tried or not.

        Those that another trial has shown to leave, where one has. Of parts that hang, those of which this
        one shows that most do; else those that do by the static rule.
        """
        if self.shown is not None:
            return list(self.shown)
        if leaves_hanging(self.orientations, self.states):
            return [int(k) for n, k in enumerate(self.rows) if 2 * self.right[n] > self.parts[n]]
        return wanted_rows(self.orientations, self.states)

    @property
    def wanted_places(self) -> list[int]:
        """Places among those tried of the ones that are wanted."""
        wanted = self.wanted
        return [n for n, k in enumerate(self.rows) if k in wanted]

    @property
    def loses_wanted(self) -> bool:
        """Tell whether some part of what is wanted did not leave as wanted."""
        return any(self.right[n] < self.parts[n] for n in self.wanted_places)

    @property
    def left(self) -> tuple[str, ...]:
        """Names of the orientations, as they came, of which a part left, in whatever state."""
        lying = self.orientations.lying
        return tuple(lying[k].name for k, n in zip(self.rows.tolist(), self.right + self.wrong) if n)

    @property
    def weights(self) -> Floats:
        """(R,) [1] shares of those tried, over their number of parts."""
        own = self.shares[self.rows]
        return own / max(own.sum(), 1e-300) / np.maximum(self.parts, 1)

    @property
    def efficiency(self) -> float:
        """Share of the parts offered that leaves as wanted [1]."""
        return float((self.weights * self.right).sum())

    @property
    def wrong_share(self) -> float:
        """Share of the parts offered that leaves otherwise [1]."""
        return float((self.weights * self.wrong).sum())

    @property
    def stopped(self) -> float:
        """Share of the parts offered that stays [1]."""
        return float((self.weights * self.held).sum())

    @property
    def purity(self) -> float:
        """Share of the wanted in what leaves [1]; NaN where nothing does."""
        total = self.efficiency + self.wrong_share
        return self.efficiency / total if total > 0.0 else np.nan

    def join(self, other: "ShortTrial") -> "ShortTrial":
        """Return what both trials of one bowl show, of other orientations or of more parts of the same.

        Parameters
        ----------
        other : ShortTrial

        Returns
        -------
        ShortTrial
        """
        rows = list(dict.fromkeys([*self.rows.tolist(), *other.rows.tolist()]))
        place = {row: n for n, row in enumerate(rows)}
        counts: Keywords = {name: np.zeros(len(rows), int) for name in COUNTED}
        ends: list[Counter[End]] = [Counter() for _ in rows]
        turns: list[Counter[End]] = [Counter() for _ in rows]
        for trial in (self, other):
            own = [place[row] for row in trial.rows.tolist()]
            for name in COUNTED:
                np.add.at(counts[name], own, getattr(trial, name))
            for n, k in enumerate(own):
                ends[k].update(trial.ends[n])
                turns[k].update(trial.turns[n] if trial.turns else {})
        speeds = [trial.velocity for trial in (self, other) if trial.velocity > 0.0]
        return replace(
            self,
            **counts,
            rows=np.array(rows, int),
            ends=tuple(dict(counts_of_row) for counts_of_row in ends),
            turns=tuple(dict(counts_of_row) for counts_of_row in turns),
            velocity=float(np.mean(speeds)) if speeds else 0.0,
            courses=(*self.courses, *other.courses),
        )

    @property
    def rate(self) -> float:
        """Wanted parts [1/s] that such a bowl delivers, from a row with the gaps that its devices need."""
        pitch = GAP * float((self.shares * self.orientations.lengths).sum()) + self.spacing
        longest = GAP * float(np.mean([self.orientations.states[k].length for k in self.states]))
        velocity = max(self.velocity, 0.0)
        return float(min(velocity / pitch * self.efficiency, velocity / longest))


def gain(orientations: stream.Orientations, shares: Floats, states: Sequence[int]) -> float:
    """Return the share of what comes that leaves in one of some states, as the static rule says.

    Parameters
    ----------
    orientations : Orientations
        M of them.
    shares : (M,) float [1]
        In which they come.
    states : sequence of int

    Returns
    -------
    float [1]
    """
    return float((shares[:, None] * orientations.leaving[:, list(states)]).sum())


def frequent_rows(shares: Floats, rows: Sequence[int] = ()) -> list[int]:
    """Return the rows that come often enough to matter, the most frequent first.

    Parameters
    ----------
    shares : (M,) float [1]
        ``SELDOM_SHARE`` or more is often.
    rows : sequence of int, optional
        Those that are there in any case.

    Returns
    -------
    list of int
    """
    order = np.argsort(-shares, kind="stable")
    return [int(k) for k in order if shares[k] >= SELDOM_SHARE or k in rows]


def possible_rows(shares: Floats, highs: Floats) -> list[int]:
    """Return the rows (R,) that may come often enough to matter, the most frequent first.

    Parameters
    ----------
    shares : (M,) array [1]
        In which the orientations come, as far as is known.
    highs : (M,) array [1]
        Upper ends of the intervals of these shares: none of 400 parts may still be 0.75 %.

    Returns
    -------
    list of int
        Those of which share or upper end is ``SELDOM_SHARE`` or more.
    """
    return frequent_rows(np.maximum(shares, highs))


def break_even(wanted: float, wrong: float, passing: float) -> float:
    """Return the share of an orientation from which on too little of what leaves is wanted.

    Of the parts that come in other orientations g leave as wanted and w otherwise; of its own p leave. At its
    share b the purity is (1 - b) g / ((1 - b) (g + w) + b p). That is ``PURE`` where, with
    d = g - PURE (g + w), b = d / (d + PURE p).

    Parameters
    ----------
    wanted, wrong : float [1]
        Shares g and w of the parts that come otherwise.
    passing : float [1]
        Share p of its own parts that leave, above 0.

    Returns
    -------
    float [1]
        0 where the others alone are too many.
    """
    spare = max(wanted - PURE * (wanted + wrong), 0.0)
    return spare / (spare + PURE * passing)


def try_parts(
    part: Part,
    bowl: Bowl,
    orientations: stream.Orientations,
    shares: Floats,
    targets: int | Sequence[int] | Ints,
    *,
    rows: Sequence[int] | Ints,
    count: int | Sequence[int] | Ints,
    run: RunSettings,
    aspects: Aspects | None = None,
    any_heading: Sequence[str] = (),
    shown: tuple[int, ...] | None = None,
) -> ShortTrial:
    """Try parts one at a time, some of each orientation.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    orientations : Orientations
        M of them, that come along its track through these.
    shares : (M,) float [1]
        In which they come.
    targets : int or sequence of int
        The wanted orientation and others that count as it.
    rows : (R,) int
        Orientations that are tried.
    count : int or (R,) int
        Parts of each.
    run : RunSettings
    aspects : Aspects, optional
        Needed with ``any_heading``.
    any_heading : sequence of str, optional
        Aspects on which a part counts as wanted, whatever its heading.
    shown : tuple of int, optional
        Rows that another trial has shown to leave as wanted.

    Returns
    -------
    ShortTrial

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all parts are through.
    """
    rows, states = np.asarray(rows, int), wanted_states(orientations, np.atleast_1d(targets))
    sent = np.tile(rows, count) if isinstance(count, int) else np.repeat(rows, count)
    followed = course.course(
        part,
        bowl,
        orientations.lying,
        course.SentParts(sent.tolist(), len(sent)),
        bowl.devices,
        poses=find_poses(orientations, states, any_heading),
        may_leave=course.leaves_by_rule(orientations.leaving),
        run=run,
    )
    if followed.partial:  # fewer parts than were to be tried decide nothing
        raise KeyboardInterrupt
    left = np.isin(followed.fates, (Fate.PASSED, Fate.TURNED))
    as_wanted = np.isin(followed.orientations[-1], states)
    free = any_heading if not isinstance(orientations.states[states[0]], Hanging) else ()
    # none came to the last station where there are fewer rides
    if aspects is not None and free and len(followed.rides) == len(followed.stations):
        # whether a part left lying on one of these aspects, or would come to, at any heading
        ride, rows_free = followed.rides[-1], [aspects.names.index(name) for name in free]
        passed = ride.outcomes == runs.PASSED
        lies_on = np.isin(AspectsBelow(part, aspects).find_aspects(ride.states[passed]), rows_free)
        as_wanted[followed.riders[-1][passed]] |= lies_on
    stuck = np.isin(followed.fates, STUCK_FATES)

    def end_at(fate: Fate, station: int) -> End:
        device = followed.stations[station].device
        bare = device.kind in ("", Device.kind)
        return End(fate, 0) if bare else End(fate, station, device.kind)

    def turned_at(part_number: int) -> int:
        # the last station at which it came into the orientation in which it left
        changed = np.flatnonzero(
            followed.orientations[:, part_number] != followed.orientations[-1, part_number]
        )
        return int(changed[-1]) if len(changed) else 0

    counts, ends, turns = [], [], []
    for row in rows:
        own = followed.entry_rows == row
        otherwise = own & left & ~as_wanted
        counts.append([int(group.sum()) for group in (own, own & left & as_wanted, otherwise, own & stuck)])
        lost = np.flatnonzero(own & ~left)
        ended = (end_at(Fate(int(followed.fates[n])), int(followed.end_stations[n])) for n in lost)
        ends.append(dict(Counter(ended)))
        turned = (end_at(Fate.TURNED, turned_at(int(n))) for n in np.flatnonzero(otherwise))
        turns.append(dict(Counter(turned)))
    parts, right, wrong, held = np.array(counts).T
    moving = followed.velocities[np.isfinite(followed.velocities) & (followed.velocities > 0.0)]
    return ShortTrial(
        orientations,
        shares,
        rows,
        parts,
        right,
        wrong,
        held,
        ends=tuple(ends),
        turns=tuple(turns),
        velocity=float(moving.mean()) if len(moving) else 0.0,
        states=states,
        courses=(followed,),
        spacing=stream.needed_spacing(bowl.devices, orientations.lying, bowl),
        shown=shown,
    )


def find_returnable_rows(trial: ShortTrial) -> tuple[int, ...]:
    """Return the wanted rows of which a chain returns parts while it lets others of them leave.

    They mean fewer parts a minute, no fault.

    Parameters
    ----------
    trial : ShortTrial

    Returns
    -------
    tuple of int
        Empty where no wanted orientation leaves whole; without those of which a part stays or leaves
        otherwise.
    """
    own = trial.wanted_places
    if not any(trial.right[n] == trial.parts[n] for n in own):
        return ()
    some = [n for n in own if trial.right[n] < trial.parts[n] and not trial.wrong[n] and not trial.held[n]]
    returned = [n for n in some if all(end.came_back for end in trial.ends[n])]
    return tuple(int(trial.rows[n]) for n in returned)


def lost_by_motion(trial: ShortTrial) -> int:
    """Return how many parts of what is wanted were turned, or ended, on the track before any device.

    Parameters
    ----------
    trial : ShortTrial

    Returns
    -------
    int
        What a device returns, stops or turns is not among them.
    """
    counts = [ends[n] for ends in (trial.ends, trial.turns) if ends for n in trial.wanted_places]
    return sum(number for count in counts for end, number in count.items() if end.on_bare_track)


FRICTION = (0.6, 1.4)  # [1]
DRIVE = (0.9, 1.1)  # [1]
CUT = 1e-4  # [m] to either side
CLEAN = 0.985  # [1] purity from which it is let be that another orientation is carried through
EQUAL_MOMENTS = 1e-4  # of the greatest: principal moments that a part of revolution has in common
RETRIED_PARTS = 3  # of each wanted orientation, where one came back: a bowl brings more of them
LEAST_SHARE_LEAVING = 0.5  # [1] of what is wanted that has to leave in a draw, where some of it comes back
OTHERS_DRAWN = 3  # parts tried in each draw beside the wanted one, as they come


def draw_bowl(bowl: Bowl, orientations: Sequence[Orientation], rng: np.random.Generator) -> Bowl:
    """Return a bowl with other friction, restitution, drive and cuts.

    Parameters
    ----------
    bowl : Bowl
    orientations : sequence of Orientation
        Of the part as drawn, which a profile may name: its opening is that of the nominal part.
    rng : numpy.random.Generator

    Returns
    -------
    Bowl
    """
    rubbed, driven = calm_drive.scale_friction(bowl, rng.uniform(*FRICTION)), rng.uniform(*DRIVE)
    devices = tuple(_draw_device(device, orientations, rng) for device in bowl.devices)
    (own,) = rng.spawn(1)
    bounce = scattered((bowl.restitution, bowl.restitution), RESTITUTION_DOUBT, own.standard_normal(1))
    drive = replace(bowl.drive, amplitude=bowl.drive.amplitude * driven)
    return replace(rubbed, drive=drive, devices=devices, restitution=min(float(bounce[0]), 1.0))


def _draw_device(device: Any, orientations: Sequence[Orientation], rng: np.random.Generator) -> Any:
    """A device whose every length is off by up to CUT."""
    more: Keywords = {}
    if device.like and device.action is not Action.SENSE:  # an opening: a gate by an orientation and its play
        grown = _named_orientation(device, device.like[:2], orientations).view_ahead.buffer(device.like[2])
        device = replace(device, corners=_corners(grown), like=())
    elif device.like:  # a sensor: by how much a part may differ that it takes for the wanted one
        aspect, heading, play = device.like
        more["like"] = aspect, heading, max(play + rng.uniform(-CUT, CUT), 0.5 * play)
    if math.isfinite(device.limit):
        more["limit"] = max(device.limit + rng.uniform(-CUT, CUT), CUT)
    if device.span:
        ends = sorted(end + rng.uniform(-CUT, CUT) if end > 0.0 else end for end in device.span)
        more["span"] = (max(ends[0], 0.0), ends[1])
    if device.corners:
        polygon = shapely.Polygon(device.corners)
        more["corners"] = _corners(polygon.buffer(rng.uniform(-CUT, CUT), join_style="mitre"))
    return replace(device, **more)


def _corners(polygon: shapely.Polygon) -> tuple[tuple[float, float], ...]:
    """The corners [m] of a polygon of shapely."""
    return tuple(map(tuple, shapely.get_coordinates(polygon.exterior)[:-1].tolist()))


def _named_orientation(
    device: Any, name: tuple[str, float], orientations: Sequence[Orientation]
) -> Orientation:
    """The orientation of an aspect and heading [rad] that a device names."""
    aspect, heading = name
    return orientations[place_of(orientations, aspect, heading, device.where, f"{device.kind} names")]


def principal_sizes(part: Part) -> list[float]:
    """Return how long a part is along each principal axis, of the least moment first.

    Parameters
    ----------
    part : Part
        From a mesh.

    Returns
    -------
    list of float [m]
    """
    points, axes = np.asarray(part.vertices).T, vectors.eigen(part.inertia)[1].T
    return [float(np.ptp(vectors.dot_columns(points, axis))) for axis in axes]


def draw_part(part: Part, tolerance: float, rng: np.random.Generator) -> Part:
    """Return a part whose size along each principal axis is off by a random length.

    Axes about which it is round stay so.

    Parameters
    ----------
    part : Part
        From a mesh.
    tolerance : float [m]
        By up to which it is off, evenly drawn.
    rng : numpy.random.Generator

    Returns
    -------
    Part

    Raises
    ------
    ValueError
        If the part has no surface.
    """
    if part.vertices is None or part.volume is None:
        raise ValueError("a part without a surface has no size that could be off")
    moments, axes = vectors.eigen(part.inertia)
    axes = axes.T
    scales = 1.0 + rng.uniform(-tolerance, tolerance, 3) / principal_sizes(part)
    for a, b in ((0, 1), (1, 2)):
        if abs(moments[b] - moments[a]) < EQUAL_MOMENTS * moments.max():
            scales[b] = scales[a]
    # stretched along three axes about its centre of mass
    stretch = sum(s * np.outer(axis, axis) for s, axis in zip(scales, axes))
    offset = part.corners
    moved = [vectors.dot_columns(offset.T, row) for row in stretch]
    vertices = part.centre_of_mass + np.stack(moved, axis=1)
    grown = float(np.prod(scales))
    own = [float(vectors.dot(vectors.dot_columns(part.inertia.T, axis), axis)) for axis in axes]
    second = [0.5 * sum(own) - moment for moment in own]  # integral of the square along each axis
    second = [s * s * moment * grown for s, moment in zip(scales, second)]
    inertia = sum((sum(second) - moment) * np.outer(axis, axis) for moment, axis in zip(second, axes))
    return replace(
        part,
        vertices=check.frozen(vertices),
        hull=convex_hull(vertices, part.centre_of_mass, part.source),
        inertia=check.frozen(np.asarray(inertia)),
        mass=part.mass * grown,
        volume=part.volume * grown,
        names=None,
    )


def _match(orientation: Orientation, orientations: Sequence[Orientation]) -> int:
    """The row of the orientation of a part that is nearest to one of a part a little different."""
    size = max(orientation.length, orientation.height)

    def away(other: Orientation) -> float:
        names = ("length", "width", "height", "distance")
        differences = [abs(getattr(orientation, name) - getattr(other, name)) for name in names]
        turned = sum(vectors.dot(a, b) for a, b in zip(orientation.axes, other.axes))  # 3 of the same
        return sum(differences) / size + 0.02 * (3.0 - float(turned))

    return min(range(len(orientations)), key=lambda k: away(orientations[k]))


def robust_run(
    part: Part,
    bowl: Bowl,
    orientations: stream.Orientations,
    shares: Floats,
    targets: int | Sequence[int],
    *,
    draws: int,
    tolerance: float,
    run: RunSettings,
    any_heading: Sequence[str] = (),
    returnable: Sequence[int] = (),
    shown: tuple[int, ...] | None = None,
    enough: float = LEAST_SHARE_LEAVING,
    max_failures: int | None = None,
) -> RobustRun:
    """Try draws of friction, drive, cuts and part.

    A draw holds where what is wanted leaves as wanted, and nothing of the others leaves or stays. Each draw
    tries the wanted orientation and some others, drawn by their shares. Where a wanted part comes back,
    RETRIED_PARTS more of each wanted orientation are tried: it is offered again, and costs rate. The draw
    then holds where at least a share of what is wanted leaves.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    orientations : Orientations
        The M of the nominal part in it.
    shares : (M,) float [1]
        In which they come.
    targets : int or sequence of int
        The wanted one and others that count as it.
    draws : int
    tolerance : float [m]
        By up to which sizes of the part are off.
    run : RunSettings
        It is told how many draws are done, of how many.
    any_heading : sequence of str, optional
        Aspects that count as wanted, whatever the heading.
    returnable : sequence of int, optional
        Orientations that count as wanted and may be returned.
    shown : tuple of int, optional
        Rows that a trial has shown to leave as wanted; those of the static rule without it.
    enough : float [1], optional
        The share that is to leave where parts come back, LEAST_SHARE_LEAVING or more.
    max_failures : int, optional
        Once more draws fail the run ends, for the rest decides nothing; all draws are made without it.

    Returns
    -------
    RobustRun
    """
    most = draws if max_failures is None else max_failures

    def draw_one(draw: int) -> tuple[list[Fault], float]:
        return _draw(
            part,
            bowl,
            orientations,
            shares,
            np.atleast_1d(targets),
            tolerance,
            (run.seed, draw),
            any_heading,
            returnable,
            enough,
            shown,
        )

    def work(begin: Callable[..., Future]) -> None:
        tasks: list[Future] = []
        failures = 0
        for done in range(draws):
            while len(tasks) < min(done + run.jobs, draws):
                tasks.append(begin(draw_one, len(tasks)))
            failures += bool(tasks[done].result()[0])
            run.tell(done + 1, draws)
            if failures > most:
                return

    try:
        outcomes, stopped = gather(work, run.jobs)  # after an interrupt what was done is counted, and marked
    except KeyboardInterrupt:
        outcomes, stopped = [], True
    failed = np.cumsum([bool(wrongs) for wrongs, _ in outcomes])
    outcomes = outcomes[: int((failed <= most).sum()) + 1]  # alike for any number of jobs
    held, done = sum(not wrongs for wrongs, _ in outcomes), len(outcomes)
    wrong = Counter(fault for wrongs, _ in outcomes for fault in dict.fromkeys(wrongs)).most_common(1)
    worst = wrong[0][0].counted_in_draws(wrong[0][1], done) if wrong else None
    slowest = float(min((speed for _, speed in outcomes), default=0.0))
    return RobustRun(done, held, worst, slowest, partial=stopped)


def _draw(
    part: Part,
    bowl: Bowl,
    orientations: stream.Orientations,
    shares: Floats,
    targets: Ints,
    tolerance: float,
    seed: tuple[int, int],
    any_heading: Sequence[str],
    returnable: Sequence[int],
    enough: float,
    shown: tuple[int, ...] | None,
) -> tuple[list[Fault], float]:
    """Return the faults of one draw, and the velocity there.

    Faults name the orientations of the part as it is drawn, not those of the part of other size.
    """
    rng = np.random.default_rng(seed)
    other = draw_part(part, tolerance, rng)
    driven = draw_bowl(bowl, orientations.lying, rng)
    own = list(shown or ()) or _leaving_as_wanted(orientations, targets)
    chosen = draw_rows(orientations, shares, targets, rng, returnable, own)
    try:
        aspects = find(other)
        on_track = on_the_track(other, aspects, bowl.track)
        # devices name orientations as the drawn part has them: its aspects may change places
        devices: list[Any] = list(driven.devices)
        for n, device in enumerate(devices):
            if device.like:
                names = (device.like[:2], *device.also)
                named = [_named_orientation(device, name, orientations.lying) for name in names]
                first, *further = (on_track[_match(orientation, on_track)] for orientation in named)
                like = (first.aspect, first.heading, *device.like[2:])
                also = tuple((match.aspect, match.heading) for match in further)
                devices[n] = replace(device, like=like, also=also)
        driven = replace(driven, devices=tuple(devices))
        lying = at_entry(on_track, driven.devices)

        def there(rows: Iterable[int]) -> list[int]:
            return [_match(orientations.lying[k], lying) for k in rows]

        rows, equivalent = there(chosen), there(targets) if len(targets) > 1 else []
        at_any = [k for k, orientation in enumerate(orientations.lying) if orientation.aspect in any_heading]
        free = tuple(sorted({lying[k].aspect for k in there(at_any)}))
        oriented = stream.along(on_track, aspects, driven.devices, bowl=driven, rows={*rows, *equivalent})
        even = np.full(len(oriented.lying), 1.0 / len(oriented.lying))
        try_drawn = functools.partial(
            try_parts,
            other,
            driven,
            oriented,
            even,
            [rows[0], *equivalent],
            aspects=aspects,
            any_heading=free,
            shown=tuple(there(shown)) if shown else None,
        )
        trial = try_drawn(rows=list(dict.fromkeys(rows)), count=1, run=RunSettings(sum(seed)))
        counting = trial.wanted if shown else wanted_rows(oriented, trial.states[:1])
        if any(came_back(trial, row) for row in trial.rows if row in counting):
            # a wanted part comes along once more: do enough of more of them leave, and the others come back?
            own = [k for k in own if k not in returnable and shares[k] >= SELDOM_SHARE] or [targets[0]]
            retried = list(dict.fromkeys(there(own)))
            more = try_drawn(rows=retried, count=RETRIED_PARTS, run=RunSettings(sum(seed) + 1))
            weights = dict(zip(there(own), (float(shares[k]) for k in own)))
            returnable = (*returnable, *own) if comes_through(more, weights, enough) else returnable
    except FeederError as error:  # the drawn bowl does not convey, or the part does not fit
        return [Fault(FaultKind.NOT_RUN, reason=error.what)], 0.0
    faults = []
    for fault in find_faults(trial, there(returnable)):
        row = chosen[rows.index(fault.row)]
        faults.append(replace(fault, row=row, orientation=orientations.lying[row].name))
    return faults, trial.velocity


def _leaving_as_wanted(orientations: stream.Orientations, rows: Sequence[int] | Ints) -> list[int]:
    """The rows that leave as the wanted one does by the static rule, or that one alone."""
    return wanted_rows(orientations, wanted_states(orientations, rows)[:1]) or [rows[0]]


def draw_rows(
    orientations: stream.Orientations,
    shares: Floats,
    rows: Sequence[int] | Ints,
    rng: np.random.Generator,
    returnable: Sequence[int] = (),
    wanted: Sequence[int] = (),
) -> list[int]:
    """Return the orientations that one draw tries: a wanted one, then OTHERS_DRAWN parts as they come.

    Parameters
    ----------
    orientations : Orientations
        M of them.
    shares : (M,) float [1]
        In which they come.
    rows : sequence of int
        The wanted one and others that count as it.
    rng : numpy.random.Generator
    returnable : sequence of int, optional
        Those that may be returned: none of them is drawn first while another is left.
    wanted : sequence of int, optional
        Rows that leave as wanted: those of the static rule without them.

    Returns
    -------
    list of int
        Each once.
    """
    wanted = list(wanted) or _leaving_as_wanted(orientations, rows)
    wanted = [k for k in wanted if k not in returnable] or wanted
    likely = np.where([k in wanted for k in range(len(shares))], shares + 1e-12, 0.0)
    first = int(rng.choice(len(shares), p=likely / likely.sum()))
    more = rng.choice(len(shares), OTHERS_DRAWN, p=shares / shares.sum())
    return list(dict.fromkeys([first, *(int(k) for k in more)]))


def came_back(trial: ShortTrial, row: int) -> bool:
    """Tell whether the part of a wanted orientation was returned: it comes along once more.

    Parameters
    ----------
    trial : ShortTrial
    row : int
        Of the orientation.

    Returns
    -------
    bool
    """
    place = list(trial.rows).index(row)
    ends = trial.ends[place]
    return not trial.right[place] and bool(ends) and all(end.came_back for end in ends)


def comes_through(trial: ShortTrial, weights: dict[int, float], enough: float = LEAST_SHARE_LEAVING) -> bool:
    """Tell whether enough parts of what is wanted leave, and the others come back.

    Parameters
    ----------
    trial : ShortTrial
    weights : dict of int to float [1]
        Shares in which orientations come, by their rows.
    enough : float [1], optional

    Returns
    -------
    bool
    """
    own = np.array([weights[k] for k in trial.rows])
    leaving = float((own * trial.right / trial.parts).sum())
    sure = not trial.wrong.any() and not trial.held.any()
    return bool(sure and leaving >= enough * own.sum() * (1.0 - 1e-9))


def find_faults(trial: ShortTrial, returnable: Iterable[int] = ()) -> list[Fault]:
    """Return what goes wrong in a short trial: what is lost, stays or is carried through, and where.

    Parameters
    ----------
    trial : ShortTrial
    returnable : iterable of int
        Rows of wanted orientations of which parts may come back: they come along once more, which costs
        parts a minute and is no fault.

    Returns
    -------
    list of Fault
        In the order in which the orientations were tried.
    """
    wanted = trial.wanted
    if not leaves_hanging(trial.orientations, trial.states):
        wanted = wanted_rows(trial.orientations, trial.states[:1])
    found, right = [], set(wanted) - set(returnable)
    for place, row in enumerate(trial.rows.tolist()):
        name, ends = trial.orientations.lying[row].name, tuple(trial.ends[place])
        if row in right:
            if trial.right[place] < trial.parts[place]:
                turns = tuple(trial.turns[place]) if trial.turns else ()
                found.append(Fault(FaultKind.LOST, name, row, (*ends, *turns)))
        elif trial.wrong[place]:
            found.append(Fault(FaultKind.CARRIED, name, row))
        if trial.held[place] and row not in right:
            found.append(Fault(FaultKind.STAYS, name, row, ends))
    return found


def find_denials(trial: ShortTrial) -> Iterator[Fault]:
    """Yield the faults for which a short trial denies a chain.

    Those are all but three kinds. What comes so seldom that it was not seen is named as a risk. Little that
    is carried through is let be while the purity is CLEAN. A wanted orientation of which most parts leave,
    and none stays, is a loss of parts a minute.

    Parameters
    ----------
    trial : ShortTrial

    Yields
    ------
    Fault
    """
    if not trial.efficiency > 0.0:
        yield Fault(FaultKind.NOTHING_LEAVES)
    wanted, rows = trial.wanted, trial.rows.tolist()
    for fault in find_faults(trial, find_returnable_rows(trial)):
        if fault.kind is FaultKind.CARRIED and trial.purity >= CLEAN:
            continue
        if fault.row not in wanted and trial.shares[fault.row] < SELDOM_SHARE:
            continue
        place = rows.index(fault.row)
        mostly = fault.row in wanted and 2 * trial.right[place] > trial.parts[place]
        if not (mostly and not trial.held[place]):
            yield fault
