"""Short trials of a chain: what of each orientation leaves, how, and what names its device."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.mechanics.headings import rests
from feederscrew.part.record import Part
from feederscrew.rates import stream
from feederscrew.resting.aspects import Aspects
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import Hanging, Orientation
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

    Parameters
    ----------
    orientations : Orientations
    rows : sequence of int
        The wanted one first; others that count as it, of which those that are returned add no state.
    """
    further = [k for k in rows[1:] if orientations.leaving[k].max() > 0.5]
    return tuple(dict.fromkeys(int(orientations.leaves_as[k]) for k in (rows[0], *further)))


def wanted_rows(orientations: stream.Orientations, states: Sequence[int]) -> list[int]:
    """Return the rows that leave in one of some states as the static rule says."""
    return [k for k in range(len(orientations.lying)) if orientations.leaving[k, list(states)].sum() > 0.5]


def aspects_at_any_heading(
    lying: Sequence[Orientation], row: int, up: Sequence[str], *, heading_given: bool = False
) -> tuple[str, ...]:
    """Return the aspects on which a part counts as wanted however it is turned.

    Parameters
    ----------
    lying : sequence of Orientation
    row : int
        The wanted one.
    up : sequence of str
        Aspects that may be up: those of `--up`.
    heading_given : bool
        Whether one heading of the wanted aspect was asked for.

    Returns
    -------
    tuple of str
        Those of ``up``, and the wanted row's own where it is round in plan and takes any heading.
    """
    names, wanted = {name.strip().casefold() for name in up}, lying[row]
    aspects = [other.aspect for other in lying if other.aspect.casefold() in names]
    if not heading_given and rests(wanted.posture.outline, wanted.track.radius).rounded:
        aspects.append(wanted.aspect)
    return tuple(dict.fromkeys(aspects))


def counted(
    orientations: stream.Orientations, states: Sequence[int], any_heading: Sequence[str] = ()
) -> tuple[Orientation, ...]:
    """Return the poses in which parts may be found; of an aspect that counts beside another at any heading.

    Parameters
    ----------
    orientations : Orientations
        S states.
    states : sequence of int
        The wanted one, and others that count as it.
    any_heading : sequence of str
        Further aspects that count at any heading.

    Returns
    -------
    tuple of Orientation
        S of them.
    """
    names = {
        orientations.states[k].aspect for k in states[1:] if not isinstance(orientations.states[k], Hanging)
    }
    names |= set(any_heading)
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

    Returns
    -------
    Tried

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
    whole, as_wanted = (
        np.isin(followed.fates, (course.PASSED, course.TURNED)),
        np.isin(followed.orientations[-1], states),
    )
    if aspects is not None and any_heading and not isinstance(orientations.states[states[0]], Hanging):
        as_wanted |= _lies_on(part, aspects, followed, any_heading)
    own = [followed.entered == k for k in rows]
    count = [[int((own_parts & some).sum()) for own_parts in own] for some in (
        np.ones(len(whole), bool), whole & as_wanted, whole & ~as_wanted,
        np.isin(followed.fates, STUCK_FATES),
    )]  # fmt: skip
    moving = followed.velocities[np.isfinite(followed.velocities) & (followed.velocities > 0.0)]
    parts, right, wrong, held = (np.array(counts_of_rows) for counts_of_rows in count)
    return Tried(
        orientations, shares, rows, parts, right, wrong, held,
        places=tuple(_places(followed, own_parts) for own_parts in own),
        turns=tuple(_turns(followed, own_parts & ~as_wanted) for own_parts in own),
        velocity=float(moving.mean()) if len(moving) else 0.0,
        state=states[0], states=states, deepest=float(followed.depths.max(initial=0.0)),
        spacing=stream.needed_spacing(bowl.devices, orientations.lying, bowl), courses=(followed,),
    )  # fmt: skip


def _lies_on(part: Part, aspects: Aspects, followed: course.Course, names: Sequence[str]) -> np.ndarray:
    """(N,) bool, whether a part left lying on one of some aspects, or would come to, at any heading."""
    lies_on, ride, riders = np.zeros(len(followed.fates), bool), followed.rides[-1], followed.riders[-1]
    if len(followed.rides) < len(followed.stations):  # none came to the last station
        return lies_on
    passed = ride.outcomes == runs.PASSED
    rows = [aspects.names.index(name) for name in names]
    lies_on[riders[passed]] = np.isin(AspectsBelow(part, aspects).of(ride.states[passed]), rows)
    return lies_on


def _places(followed: course.Course, own: np.ndarray) -> dict[str, int]:
    """Where parts ended that did not leave, and how: {'returned at gap': 2}."""
    counts: dict[str, int] = {}
    for n in np.flatnonzero(own & ~np.isin(followed.fates, (course.PASSED, course.TURNED))):
        where = at_station(followed.stations[followed.ended[n]].device)
        name = f"{course.FATES[followed.fates[n]].replace('_', ' ')} {where}"
        counts[name] = counts.get(name, 0) + 1
    return counts


def _turns(followed: course.Course, own: np.ndarray) -> dict[str, int]:
    """Where parts came into the orientation in which they left, and how many: {'turned on the track': 2}."""
    counts: dict[str, int] = {}
    for n in np.flatnonzero(own & np.isin(followed.fates, (course.PASSED, course.TURNED))):
        changed = np.flatnonzero(followed.orientations[:, n] != followed.orientations[-1, n])
        station = int(changed[-1]) if len(changed) else 0
        name = f"turned {at_station(followed.stations[station].device)}"
        counts[name] = counts.get(name, 0) + 1
    return counts


def at_station(device: Device) -> str:
    """Return where a station is, in words: 'at gap', or 'on the track' of one without a device."""
    return "on the track" if device.kind in ("", Device.kind) else f"at {device.name}"


def spared_rows(tried: Tried) -> tuple[int, ...]:
    """Return the wanted orientations of which a chain returns parts while it lets others of them leave.

    Parameters
    ----------
    tried : Tried

    Returns
    -------
    tuple of int
        Their rows: fewer parts a minute, no fault. None where no wanted orientation leaves whole, nor any of
        which a part stays or leaves otherwise.
    """
    right = set(wanted_rows(tried.orientations, tried.states))
    own = [n for n, k in enumerate(tried.rows) if k in right]
    if not any(tried.right[n] == tried.parts[n] for n in own):
        return ()
    some = [n for n in own if tried.right[n] < tried.parts[n] and not tried.wrong[n] and not tried.held[n]]
    returned = [n for n in some if all(end.startswith("returned") for end in tried.places[n])]
    return tuple(int(tried.rows[n]) for n in returned)


def lost_by_motion(tried: Tried) -> int:
    """Return how many parts of what is wanted were turned, or ended on the track before any device.

    Parameters
    ----------
    tried : Tried

    Returns
    -------
    int
        What a device returns, stops or turns is not among them.
    """
    right = set(wanted_rows(tried.orientations, tried.states))
    own = [n for n, k in enumerate(tried.rows) if k in right]
    counts = [counted_ends[n] for counted_ends in (tried.places, tried.turns) if counted_ends for n in own]
    return sum(number for count in counts for name, number in count.items() if name.endswith("on the track"))
