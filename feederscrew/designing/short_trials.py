"""Short trials of a chain: what of each orientation leaves, how, and what names its device."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.conveying.answer import RESTITUTION_DOUBT
from feederscrew.designing.record import RobustRun
from feederscrew.dropping.pool import gather
from feederscrew.dropping.toss_runs import scattered
from feederscrew.errors import FeederError
from feederscrew.geometry import vectors
from feederscrew.mechanics.headings import rests
from feederscrew.part.hull import convex_hull
from feederscrew.part.record import Part
from feederscrew.rates import stream
from feederscrew.resting.aspects import Aspects, find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.orientation_names import place_of
from feederscrew.tooling.fates import at_entry
from feederscrew.tooling.orientations import Hanging, Orientation
from feederscrew.tooling.orientations import orientations as on_the_track
from feederscrew.trial import course, runs
from feederscrew.trial.looks import AspectsBelow

SELDOM_SHARE = 5e-3  # [1] orientations that come less often are left out
STUCK_FATES = (course.HANGING, course.STOPPED)  # what is stuck on the bare track is pushed on by a queue
COUNTED = ("parts", "right", "wrong", "held")  # of each orientation tried
FEW_OTHERS = 8  # so many other orientations are tried more than once
LOW = 0.5  # mean free way between parts at low fill, over their length: a third of the row is empty
GAP = 1.0 + LOW  # pitch of parts that come in a row at low fill, over their length


@dataclass(frozen=True, eq=False)
class Tried:
    """What single parts did in one bowl; M orientations."""

    orientations: stream.Orientations
    shares: np.ndarray  # (M,) [1] in which they come; sums to 1
    rows: np.ndarray  # (R,) int, the orientations tried
    parts: np.ndarray  # (R,) int, of each
    right: np.ndarray  # (R,) int, left in the wanted state
    wrong: np.ndarray  # (R,) int, left in another
    held: np.ndarray  # (R,) int, stay at a device or hang
    places: tuple[dict[str, int], ...]  # (R,) of those that did not leave: 'returned at gap' and how many
    velocity: float  # [m/s] mean of those that travel
    state: int  # the wanted one
    states: tuple[int, ...]  # all that count as it
    deepest: float  # [m]
    spacing: float = 0.0  # [m] free way between parts that the devices need
    courses: tuple = ()  # of Course: what was followed
    turns: tuple[dict[str, int], ...] = ()  # (R,) where parts turned that left so: 'turned on the track'

    @property
    def weights(self) -> np.ndarray:
        """(R,) [1] shares of those tried, over their number of parts."""
        own = self.shares[self.rows]
        return own / max(own.sum(), 1e-300) / np.maximum(self.parts, 1)

    @property
    def efficiency(self) -> float:
        """Share of the parts offered that leaves as wanted [1]."""
        return float((self.weights * self.right).sum())

    @property
    def carried(self) -> float:
        """Share of the parts offered that leaves otherwise [1]."""
        return float((self.weights * self.wrong).sum())

    @property
    def stopped(self) -> float:
        """Share of the parts offered that stays [1]."""
        return float((self.weights * self.held).sum())

    @property
    def purity(self) -> float:
        """Share of the wanted in what leaves [1]; NaN where nothing does."""
        total = self.efficiency + self.carried
        return self.efficiency / total if total > 0.0 else np.nan

    def joined(self, other: "Tried") -> "Tried":
        """Return what both trials of one bowl show, of other orientations or of more parts of the same."""
        rows = list(dict.fromkeys([*self.rows.tolist(), *other.rows.tolist()]))
        place = {row: n for n, row in enumerate(rows)}
        counts: dict[str, Any] = {name: np.zeros(len(rows), int) for name in COUNTED}
        places: list[Counter[str]] = [Counter() for _ in rows]
        turns: list[Counter[str]] = [Counter() for _ in rows]
        for trial in (self, other):
            own = [place[row] for row in trial.rows.tolist()]
            for name in COUNTED:
                np.add.at(counts[name], own, getattr(trial, name))
            for n, k in enumerate(own):
                places[k].update(trial.places[n])
                turns[k].update(trial.turns[n] if trial.turns else {})
        speeds = [trial.velocity for trial in (self, other) if trial.velocity > 0.0]
        return replace(
            self,
            **counts,
            rows=np.array(rows, int),
            places=tuple(dict(counts_of_row) for counts_of_row in places),
            turns=tuple(dict(counts_of_row) for counts_of_row in turns),
            velocity=float(np.mean(speeds)) if speeds else 0.0,
            deepest=max(self.deepest, other.deepest),
            courses=(*self.courses, *other.courses),
        )

    @property
    def rate(self) -> float:
        """Wanted parts [1/s] that such a bowl delivers, from a row with the gaps that its devices need."""
        pitch = GAP * float((self.shares * self.orientations.lengths).sum()) + self.spacing
        longest = GAP * float(np.mean([self.orientations.states[k].length for k in self.states]))
        return float(
            min(max(self.velocity, 0.0) / pitch * self.efficiency, max(self.velocity, 0.0) / longest)
        )


def wanted_states(orientations: stream.Orientations, rows: Sequence[int] | np.ndarray) -> tuple[int, ...]:
    """Return the states in which some rows leave, the first one first.

    The wanted row comes first; of others that count as it, those that are returned add no state.
    """
    further = [k for k in rows[1:] if orientations.leaving[k].max() > 0.5]
    return tuple(dict.fromkeys(int(orientations.leaves_as[k]) for k in (rows[0], *further)))


def wanted_rows(orientations: stream.Orientations, states: Sequence[int]) -> list[int]:
    """Return the rows that leave in one of some states as the static rule says."""
    return [k for k in range(len(orientations.lying)) if orientations.leaving[k, list(states)].sum() > 0.5]


def aspects_at_any_heading(
    lying: Sequence[Orientation], row: int, up: Sequence[str], *, heading_given: bool = False
) -> tuple[str, ...]:
    """Return the aspects on which a part counts as a wanted row however it is turned.

    Those of ``up``, the option `--up`, and the wanted row's own where it is round in plan and takes any
    heading, unless one heading was asked for.
    """
    names, wanted = {name.strip().casefold() for name in up}, lying[row]
    aspects = [other.aspect for other in lying if other.aspect.casefold() in names]
    if not heading_given and rests(wanted.posture.outline, wanted.track.radius).rounded:
        aspects.append(wanted.aspect)
    return tuple(dict.fromkeys(aspects))


def counted(
    orientations: stream.Orientations, states: Sequence[int], any_heading: Sequence[str] = ()
) -> tuple[Orientation, ...]:
    """Return the poses, one a state, in which parts may be found.

    At any heading of an aspect that counts beside another: those of the further ``states``, and those named.
    """
    own = [orientations.states[k] for k in states[1:]]
    names = {pose.aspect for pose in own if not isinstance(pose, Hanging)} | set(any_heading)
    return tuple(replace(pose, any_heading=pose.aspect in names) for pose in orientations.states)


def gain(orientations: stream.Orientations, shares: np.ndarray, states: Sequence[int]) -> float:
    """Return the share [1] of what comes that leaves in one of some states, as the static rule says."""
    return float((shares[:, None] * orientations.leaving[:, list(states)]).sum())


def often(shares: np.ndarray, rows: Sequence[int] = ()) -> list[int]:
    """Return the rows (R,) that come often enough to matter, the most frequent first; some in any case."""
    order = np.argsort(-shares, kind="stable")
    return [int(k) for k in order if shares[k] >= SELDOM_SHARE or k in rows]


def single(
    part: Part,
    bowl: Bowl,
    orientations: stream.Orientations,
    shares: np.ndarray,
    wanted: int | Sequence[int] | np.ndarray,
    *,
    rows: Any,
    each: int | Sequence[int] | np.ndarray,
    run: RunSettings,
    aspects: Aspects | None = None,
    any_heading: Sequence[str] = (),
) -> Tried:
    """Try parts one at a time.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    orientations : Orientations
        On its track, through its devices; M of them.
    shares : (M,) float [1]
    wanted : int or sequence of int
        The wanted orientation, and others that count as it.
    rows : sequence of int
        Those to be tried.
    each : int or (R,) int
        Parts of each.
    run : RunSettings
    aspects : Aspects, optional
        Of the part: needed where some aspect counts at any heading.
    any_heading : sequence of str
        Aspects on which a part counts as wanted, whatever its heading.

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all parts are through.
    """
    rows, states = np.asarray(rows, int), wanted_states(orientations, np.atleast_1d(wanted))
    sent = np.tile(rows, each) if isinstance(each, int) else np.repeat(rows, each)
    followed = course.course(
        part, bowl, orientations.lying, course.Sending(sent.tolist(), len(sent)), bowl.devices,
        poses=counted(orientations, states, any_heading), leaves=course.rightly(orientations.leaving),
        run=run,
    )  # fmt: skip
    if followed.partial:  # fewer parts than were to be tried decide nothing
        raise KeyboardInterrupt
    left = np.isin(followed.fates, (course.PASSED, course.TURNED))
    as_wanted = np.isin(followed.orientations[-1], states)
    if aspects is not None and any_heading and not isinstance(orientations.states[states[0]], Hanging):
        as_wanted |= _lies_on(part, aspects, followed, any_heading)
    stuck = np.isin(followed.fates, STUCK_FATES)

    def at(n: int) -> str:
        return at_station(followed.stations[n].device)

    def turned_at(part_number: int) -> int:
        # the last station at which it came into the orientation in which it left
        changed = np.flatnonzero(
            followed.orientations[:, part_number] != followed.orientations[-1, part_number]
        )
        return int(changed[-1]) if len(changed) else 0

    counts: list[list[int]] = []
    places, turns = [], []
    for row in rows:
        own = followed.entered == row
        groups = own, own & left & as_wanted, own & left & ~as_wanted, own & stuck
        counts.append([int(group.sum()) for group in groups])
        places.append(_counts(
            f"{course.FATES[followed.fates[n]].replace('_', ' ')} {at(followed.ended[n])}"
            for n in np.flatnonzero(own & ~left)
        ))  # fmt: skip
        turns.append(
            _counts(f"turned {at(turned_at(int(n)))}" for n in np.flatnonzero(own & left & ~as_wanted))
        )
    parts, right, wrong, held = np.array(counts).T
    moving = followed.velocities[np.isfinite(followed.velocities) & (followed.velocities > 0.0)]
    return Tried(
        orientations, shares, rows, parts, right, wrong, held, places=tuple(places), turns=tuple(turns),
        velocity=float(moving.mean()) if len(moving) else 0.0,
        state=states[0], states=states, deepest=float(followed.depths.max(initial=0.0)),
        spacing=stream.needed_spacing(bowl.devices, orientations.lying, bowl), courses=(followed,),
    )  # fmt: skip


def _counts(texts: Iterable[str]) -> dict[str, int]:
    return dict(Counter(texts))


def _lies_on(part: Part, aspects: Aspects, followed: course.Course, names: Sequence[str]) -> np.ndarray:
    """(N,) bool, whether a part left lying on one of some aspects, or would come to, at any heading."""
    lies_on, ride, riders = np.zeros(len(followed.fates), bool), followed.rides[-1], followed.riders[-1]
    if len(followed.rides) < len(followed.stations):  # none came to the last station
        return lies_on
    passed = ride.outcomes == runs.PASSED
    rows = [aspects.names.index(name) for name in names]
    lies_on[riders[passed]] = np.isin(AspectsBelow(part, aspects).of(ride.states[passed]), rows)
    return lies_on


def at_station(device: Device) -> str:
    """Return where a station is, in words: 'at gap', or 'on the track' of one without a device."""
    return "on the track" if device.kind in ("", Device.kind) else f"at {device.name}"


def spared_rows(tried: Tried) -> tuple[int, ...]:
    """Return the wanted rows of which a chain returns parts while it lets others of them leave.

    Fewer parts a minute, no fault. None where no wanted orientation leaves whole, nor any of which a part
    stays or leaves otherwise.
    """
    right = wanted_rows(tried.orientations, tried.states)
    own = [n for n, k in enumerate(tried.rows) if k in right]
    if not any(tried.right[n] == tried.parts[n] for n in own):
        return ()
    some = [n for n in own if tried.right[n] < tried.parts[n] and not tried.wrong[n] and not tried.held[n]]
    returned = [n for n in some if all(end.startswith("returned") for end in tried.places[n])]
    return tuple(int(tried.rows[n]) for n in returned)


def lost_by_motion(tried: Tried) -> int:
    """Return how many parts of what is wanted were turned, or ended on the track before any device.

    What a device returns, stops or turns is not among them.
    """
    right = wanted_rows(tried.orientations, tried.states)
    own = [n for n, k in enumerate(tried.rows) if k in right]
    counts = [ends[n] for ends in (tried.places, tried.turns) if ends for n in own]
    return sum(number for count in counts for name, number in count.items() if name.endswith("on the track"))


FRICTION, DRIVE, CUT = (0.6, 1.4), (0.9, 1.1), 1e-4  # [1], [1], [m] to either side
CARRIED, CLEAN = " is carried through", 0.985  # and the purity from which that is let be
EQUAL_MOMENTS = 1e-4  # of the greatest: principal moments that a part of revolution has in common
RETRIED_PARTS = 3  # of each wanted orientation, where one came back: a bowl brings more of them
LEAST_SHARE_LEAVING = 0.5  # [1] of what is wanted that has to leave in a draw, where some of it comes back
OTHERS_DRAWN = 3  # parts tried in each draw beside the wanted one, as they come


def drawn_bowl(bowl: Bowl, lying: Sequence[Orientation], rng: np.random.Generator) -> Bowl:
    """Return a bowl with other friction, restitution, drive and cuts.

    ``lying`` are orientations of the part as drawn, which a profile may name: its opening is that of the
    nominal part.
    """
    rubbed, driven = rng.uniform(*FRICTION), rng.uniform(*DRIVE)
    values = {name: getattr(bowl.friction, name) for name in vars(bowl.friction)}
    friction: dict[str, Any] = {
        name: None if value is None else value * rubbed for name, value in values.items()
    }
    devices = tuple(_drawn_device(device, lying, rng) for device in bowl.devices)
    (own,) = rng.spawn(1)
    bounce = scattered((bowl.restitution, bowl.restitution), RESTITUTION_DOUBT, own.standard_normal(1))
    return replace(
        bowl,
        friction=replace(bowl.friction, **friction),
        drive=replace(bowl.drive, amplitude=bowl.drive.amplitude * driven),
        devices=devices,
        restitution=min(float(bounce[0]), 1.0),
    )


def _drawn_device(device: Any, lying: Sequence[Orientation], rng: np.random.Generator) -> Any:
    """A device whose every length is off by up to CUT."""
    more: dict[str, Any] = {}
    if device.like and not device.senses:  # an opening: a gate by an orientation and its play
        grown = _named_orientation(device, device.like[:2], lying).view_ahead.buffer(device.like[2])
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


def _corners(polygon: Any) -> tuple[tuple[float, float], ...]:
    """The corners [m] of a polygon of shapely."""
    return tuple(map(tuple, shapely.get_coordinates(polygon.exterior)[:-1].tolist()))


def _named(
    devices: Sequence[Any], lying: Sequence[Orientation], drawn: Sequence[Orientation]
) -> tuple[Any, ...]:
    """Devices with the orientation that they name as the drawn part has it: its aspects may change places."""
    named_devices = []
    for device in devices:
        if device.like:
            orientations = [
                _named_orientation(device, named, lying) for named in (device.like[:2], *device.also)
            ]
            matches = [drawn[_matched(orientation, drawn)] for orientation in orientations]
            first, *further = ((match.aspect, match.heading) for match in matches)
            device = replace(device, like=(*first, *device.like[2:]), also=tuple(further))
        named_devices.append(device)
    return tuple(named_devices)


def _named_orientation(device: Any, named: tuple[str, float], lying: Sequence[Orientation]) -> Orientation:
    """The orientation of an aspect and heading [rad] that a device names."""
    aspect, heading = named
    return lying[place_of(lying, aspect, heading, device.where, f"{device.kind} names")]


def principal_sizes(part: Part) -> list[float]:
    """Return how long a part from a mesh is along each principal axis [m], of the least moment first."""
    return [
        float(np.ptp(_along(np.asarray(part.vertices), axis))) for axis in vectors.eigen(part.inertia)[1].T
    ]


def drawn_part(part: Part, tolerance: float, rng: np.random.Generator) -> Part:
    """Return a part, from a mesh, whose size along each principal axis is off by up to a tolerance [m].

    Axes about which it is round stay so.
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
    offset = part.vertices - part.centre_of_mass
    vertices = part.centre_of_mass + np.stack([_along(offset, row) for row in stretch], axis=1)
    grown = float(np.prod(scales))
    own = [float(vectors.dot(_along(part.inertia, axis), axis)) for axis in axes]
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


def _along(points: np.ndarray, axis: np.ndarray) -> np.ndarray:
    return points[:, 0] * axis[0] + points[:, 1] * axis[1] + points[:, 2] * axis[2]


def _matched(orientation: Orientation, lying: Sequence[Orientation]) -> int:
    """The row of the orientation of a part that is nearest to one of a part a little different."""
    size = max(orientation.length, orientation.height)

    def away(other: Orientation) -> float:
        names = ("length", "width", "height", "distance")
        differences = [abs(getattr(orientation, name) - getattr(other, name)) for name in names]
        turned = sum(vectors.dot(a, b) for a, b in zip(orientation.axes, other.axes))  # 3 of the same
        return sum(differences) / size + 0.02 * (3.0 - float(turned))

    return min(range(len(lying)), key=lambda k: away(lying[k]))


def robust_run(
    part: Part,
    bowl: Bowl,
    orientations: stream.Orientations,
    shares: np.ndarray,
    wanted: int | Sequence[int],
    *,
    draws: int,
    tolerance: float,
    run: RunSettings,
    any_heading: Sequence[str] = (),
    spared: Sequence[int] = (),
    enough: float = LEAST_SHARE_LEAVING,
    allowed: int | None = None,
) -> RobustRun:
    """Try draws of part, friction, drive and cuts.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    orientations : Orientations
        Of the nominal part in that bowl; M of them.
    shares : (M,) float [1]
    wanted : int or sequence of int
        The wanted orientation, and others that count as it.
    draws : int
    tolerance : float [m]
        Of the part.
    run : RunSettings
        Its progress is told how many draws are done, of how many.
    any_heading : sequence of str
        Aspects that count as the wanted one, whatever the heading.
    spared : sequence of int
        Orientations that count as the wanted one and may be returned.
    enough : float [1]
        Share of what is wanted that has to leave, where a part of it comes back: LEAST_SHARE_LEAVING or more.
    allowed : int, optional
        Draws that may fail: with one more the run ends, for the rest decides nothing. All draws without it.

    Returns
    -------
    RobustRun
        A draw holds where what is wanted leaves as wanted, and nothing of the others leaves or stays. Each
        draw tries the wanted orientation and some others, drawn by their shares. Where a wanted part comes
        back, RETRIED_PARTS more of each wanted orientation are tried: it is offered again, and costs rate.
    """
    most = draws if allowed is None else allowed

    def draw_one(draw: int) -> tuple[list[str], float]:
        return _draw(
            part, bowl, orientations, shares, np.atleast_1d(wanted), tolerance, (run.seed, draw),
            any_heading, spared, enough,
        )  # fmt: skip

    def work(begin: Any) -> None:
        tasks: list[Any] = []
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
    wrong = Counter(fault for wrongs, _ in outcomes for fault in set(wrongs)).most_common(1)
    worst = f"{wrong[0][0]} in {wrong[0][1]} of {done}" if wrong else ""
    slowest = float(min((speed for _, speed in outcomes), default=0.0))
    return RobustRun(done, held, worst, slowest, partial=stopped)


def _draw(
    part: Part, bowl: Bowl, orientations: stream.Orientations, shares: np.ndarray, wanted: np.ndarray,
    tolerance: float, seed: tuple[int, int], any_heading: Sequence[str], spared: Sequence[int], enough: float,
) -> tuple[list[str], float]:  # fmt: skip
    """What goes wrong in one draw, and the velocity there."""
    rng = np.random.default_rng(seed)
    other = drawn_part(part, tolerance, rng)
    driven = drawn_bowl(bowl, orientations.lying, rng)
    chosen = drawn_rows(orientations, shares, wanted, rng, spared)
    try:
        aspects = find(other)
        on_track = on_the_track(other, aspects, bowl.track)
        driven = replace(driven, devices=_named(driven.devices, orientations.lying, on_track))
        lying = at_entry(on_track, driven.devices)

        def there(rows: Iterable[int]) -> list[int]:
            return [_matched(orientations.lying[k], lying) for k in rows]

        rows, equivalent = there(chosen), there(wanted) if len(wanted) > 1 else []
        named = [k for k, one in enumerate(orientations.lying) if one.aspect in any_heading]
        free = tuple(sorted({lying[k].aspect for k in there(named)}))
        oriented = stream.along(on_track, aspects, driven.devices, bowl=driven, rows={*rows, *equivalent})
        even = np.full(len(oriented.lying), 1.0 / len(oriented.lying))

        def tried_parts(own: Sequence[int], each: int, number: int) -> Tried:
            return single(
                other, driven, oriented, even, [rows[0], *equivalent], rows=list(dict.fromkeys(own)),
                each=each, run=RunSettings(number), aspects=aspects, any_heading=free,
            )  # fmt: skip

        tried = tried_parts(rows, 1, sum(seed))
        counting = wanted_rows(oriented, tried.states[:1])
        if any(came_back(tried, row) for row in tried.rows if row in counting):
            # a wanted part comes along once more: do enough of more of them leave, and the others come back?
            own = _leaving_as_wanted(orientations, wanted)
            own = [k for k in own if k not in spared and shares[k] >= SELDOM_SHARE] or [wanted[0]]
            more = tried_parts(there(own), RETRIED_PARTS, sum(seed) + 1)
            weights = dict(zip(there(own), (float(shares[k]) for k in own)))
            spared = (*spared, *own) if comes_through(more, weights, enough) else spared
    except FeederError as fault:  # the drawn bowl does not convey, or the part does not fit
        return [fault.what], 0.0
    return faults(tried, there(spared)), tried.velocity


def _leaving_as_wanted(orientations: stream.Orientations, rows: Sequence[int] | np.ndarray) -> list[int]:
    """The rows that leave as the wanted one does by the static rule, or that one alone."""
    return wanted_rows(orientations, wanted_states(orientations, rows)[:1]) or [rows[0]]


def drawn_rows(
    orientations: stream.Orientations,
    shares: np.ndarray,
    rows: Sequence[int] | np.ndarray,
    rng: np.random.Generator,
    spared: Sequence[int] = (),
) -> list[int]:
    """Return the orientations that one draw tries: a wanted one, then OTHERS_DRAWN parts as they come.

    ``shares`` (M,) [1] are those of the orientations, ``rows`` the wanted one and others that count as it. Of
    those that are ``spared``, and may be returned, none is drawn first while another is left.
    """
    wanted = _leaving_as_wanted(orientations, rows)
    wanted = [k for k in wanted if k not in spared] or wanted
    likely = np.where([k in wanted for k in range(len(shares))], shares + 1e-12, 0.0)
    first = int(rng.choice(len(shares), p=likely / likely.sum()))
    more = rng.choice(len(shares), OTHERS_DRAWN, p=shares / shares.sum())
    return list(dict.fromkeys([first, *(int(k) for k in more)]))


def came_back(tried: Tried, row: int) -> bool:
    """Return whether the part of a wanted orientation was returned: it comes along once more."""
    place = list(tried.rows).index(row)
    ends = tried.places[place]
    return not tried.right[place] and bool(ends) and all(end.startswith("returned") for end in ends)


def comes_through(tried: Tried, weights: dict[int, float], enough: float = LEAST_SHARE_LEAVING) -> bool:
    """Return whether enough [1] of more parts of what is wanted leave, and the others come back.

    Weights are the shares [1] in which their orientations come.
    """
    own = np.array([weights[k] for k in tried.rows])
    leaving = float((own * tried.right / tried.parts).sum())
    sure = not tried.wrong.any() and not tried.held.any()
    return bool(sure and leaving >= enough * own.sum() * (1.0 - 1e-9))


def faults(tried: Tried, spared: Iterable[int] = ()) -> list[str]:
    """Return what goes wrong in a short trial, a sentence each: (what is lost, stopped or carried, where).

    What counts as the wanted one and comes back is a loss of parts a minute only; so is that of orientations
    that are ``spared``, rows.
    """
    sentences, right = [], set(wanted_rows(tried.orientations, tried.states[:1])) - set(spared)
    for place, k in enumerate(tried.rows):
        name = tried.orientations.lying[k].name
        if k in right:
            if tried.right[place] < tried.parts[place]:
                turns = tried.turns[place] if tried.turns else {}
                where = ", ".join((*tried.places[place], *turns)) or "turned"
                sentences.append(f"{name} is lost ({where})")
        elif tried.wrong[place]:
            sentences.append(f"{name}{CARRIED}")
        if tried.held[place] and k not in right:
            sentences.append(f"{name} stays ({', '.join(tried.places[place])})")
    return sentences


def denied(tried: Tried) -> Iterator[str]:
    """Say what a short trial denies: what leaves or stays though rejected, and what is lost in the main."""
    if not tried.efficiency > 0.0:
        yield "nothing leaves as wanted"
    right = wanted_rows(tried.orientations, tried.states)
    names = [tried.orientations.lying[k].name for k in tried.rows]
    for fault in faults(tried, spared_rows(tried)):
        place = names.index(fault.split(" ", 1)[0])
        if fault.endswith(CARRIED) and tried.purity >= CLEAN:
            continue
        mostly = tried.rows[place] in right and 2 * tried.right[place] > tried.parts[place]
        if not (mostly and not tried.held[place]):
            yield fault
