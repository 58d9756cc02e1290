"""A ride along bare track before the tooling: which orientations last, which turn, roll back or fall off."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.arrivals.ensemble import wilson
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.running import USUAL_RUN, RunSettings
from feederscrew.bowl.record import Bowl
from feederscrew.motion import conveying as answer
from feederscrew.part.record import Part
from feederscrew.sorting.orientations import Orientation
from feederscrew.trials import course, part_poses, runs, staging
from feederscrew.trials.looks import OTHER, Looks
from feederscrew.trials.shape import round_circles, solid_of

RIDE_M = 0.6  # a turn of a small bowl: what has not turned by then seldom does
RIDE_S = 24.0  # [s] after which a slow part is looked at wherever it is
SEGMENT_M = 0.1  # ridden at a time: a way along the wall is known within half a turn only
STANDING_S = 1.0  # a part that has not come on in that time stands, until others push it
OFF_WALL_M = 1e-3  # from the wall, at most, where a part begins
OFF_HEADING = np.radians(3.0)  # [rad] of its heading, at most to either side
OFF_LEVEL = np.radians(1.0)  # [rad] standard deviation of its tilt
LEFT = -2  # of a part that has left the track or rolled back


@dataclass(frozen=True, eq=False)
class RideOfTrack:
    """Arrivals of N parts that rode on bare track; M orientations."""

    names: tuple[str, ...]  # (M,) of the orientations
    entry_rows: Ints  # (N,) the orientation in which each began
    end_rows: Ints  # (N,) in which it arrives at the tooling; LEFT of one that does not
    is_askew: Bools  # (N,) whether it lies so only nearly, away from the wall for instance
    distances: Floats  # (N,) [m] along the wall
    seconds: Floats  # (N,) [s]

    @property
    def rows(self) -> list[int]:
        """Return the orientations that were ridden, in the order in which they were begun."""
        return list(dict.fromkeys(self.entry_rows.tolist()))

    @property
    def counts(self) -> Ints:
        """Return parts (M, M + 1) by the orientation in which they began and ended; the last column: left."""
        counts = np.zeros((len(self.names), len(self.names) + 1), int)
        columns = np.where(self.end_rows == LEFT, len(self.names), self.end_rows)
        np.add.at(counts, (self.entry_rows, columns), 1)
        return counts

    @property
    def is_turned(self) -> Bools:
        """Return (M,) bool, whether any part that began so has ended otherwise, or has left."""
        counts = self.counts
        return counts.sum(axis=1) > np.diag(counts)

    def arriving_shares(self, shares: Floats) -> Floats:
        """Return the shares that arrive at the tooling of those that enter the track.

        An orientation that was not ridden stays what it is. What has left comes back with all others.

        Parameters
        ----------
        shares : (M,) float [1]
            Of the orientations at the entry.

        Returns
        -------
        (M,) float [1]
            Their sum is 1; as given where nothing arrives.
        """
        counts = self.counts.astype(float)
        ridden = counts.sum(axis=1)
        matrix = np.where(ridden[:, None] > 0.0, counts[:, :-1] / np.maximum(ridden, 1.0)[:, None], 0.0)
        matrix[ridden == 0.0, ridden == 0.0] = 1.0
        out = (np.asarray(shares)[:, None] * matrix).sum(axis=0)
        total = out.sum()
        return out / total if total > 0.0 else np.asarray(shares, float)


def ride_of_track(
    part: Part,
    bowl: Bowl,
    orientations: Sequence[Orientation],
    rows: Sequence[int],
    *,
    repeats: int,
    distance: float | None = None,
    run: RunSettings = USUAL_RUN,
) -> RideOfTrack:
    """Let parts ride along the bare track of a bowl, begun a little off, and look how they arrive.

    They begin up to OFF_WALL_M from the wall, OFF_HEADING askew and OFF_LEVEL out of level, at any phase. A
    part that stands goes on when others push it: it stays as it is.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        Of its devices those that lean the track at its entry count.
    orientations : sequence of Orientation
        M of them.
    rows : sequence of int
        Those that ride.
    repeats : int
        Parts of every one of them.
    distance : float [m], optional
        Over which they ride; a turn of the bowl and RIDE_M at the most without it. They ride for RIDE_S at
        the most.
    run : RunSettings, optional
        From its seed each part draws its start.

    Returns
    -------
    RideOfTrack

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all have arrived.
    FeederError
        If the part has no shape or the bowl conveys nothing.
    """
    distance = min(2.0 * np.pi * bowl.track.radius, RIDE_M) if distance is None else distance
    solid, length, principal = solid_of(part)
    solid = round_circles(solid, course.roll_axes(orientations, principal))
    part_in_bowl = runs.setting(solid, length, bowl)
    looks = Looks(orientations, solid, length, principal, bowl.track.radius)
    run.begin()
    entry_rows = np.repeat(np.asarray(rows, int), repeats)
    states, times = part_poses.lay_down(
        bowl,
        orientations,
        entry_rows,
        solid,
        principal,
        length,
        run.seed,
        play=OFF_WALL_M,
        turn=OFF_HEADING,
        tilt=OFF_LEVEL,
    )
    count = max(round(distance / SEGMENT_M), 1)
    # what follows parts along a segment of bare track
    slopes = staging.slopes_before(staging.entry_slopes(bowl.devices, bowl.track, orientations))
    station = staging.stage_bare_track(bowl.track, orientations, distance / count, slopes)
    velocity = answer.answer(bowl).velocity
    speed = max(velocity if np.isfinite(velocity) else 0.0, course.LEAST_SPEED_M_S)
    size = max(orientation.length for orientation in orientations)
    progress = course.LEAST_PROGRESS_SHARE * STANDING_S * speed
    limits = runs.RideLimits(RIDE_S, STANDING_S, progress, 0.5 * size, interval=RIDE_S, places=1)
    follow = runs.make_plain_follower(part_in_bowl, station, limits)
    distances, seconds = np.zeros((2, len(entry_rows)))
    lost, going = np.zeros(len(entry_rows), bool), np.ones(len(entry_rows), bool)
    for done in range(count):
        on = np.flatnonzero(going)
        if not len(on):
            break
        rode = runs.ride(follow, states[on], times[on] + seconds[on], jobs=run.jobs)
        if rode.partial:
            raise KeyboardInterrupt
        passed = rode.outcomes == runs.PASSED
        lost[on] = np.isin(rode.outcomes, (runs.RETURNED, runs.ROLLED))
        distances[on] += rode.distances
        seconds[on] += rode.seconds
        states[on] = part_poses.move_along_wall(rode.states, -rode.distances / length, part_in_bowl.radius)
        going[on] = passed & (seconds[on] < RIDE_S)
        run.tell(done + 1, count)
    end_rows = looks.find_orientations(states)
    is_askew = (end_rows == OTHER) & ~lost
    end_rows[is_askew] = looks.find_nearest(states[is_askew])
    end_rows[lost] = LEFT
    return RideOfTrack(
        tuple(orientation.name for orientation in orientations),
        *map(check.frozen, (entry_rows, end_rows, is_askew, distances, seconds)),
    )


def join_rides(first: RideOfTrack, second: RideOfTrack) -> RideOfTrack:
    """Return two rides of the same orientations as one.

    Parameters
    ----------
    first, second : RideOfTrack

    Returns
    -------
    RideOfTrack
        The parts of the first, then those of the second.
    """
    names = ("entry_rows", "end_rows", "is_askew", "distances", "seconds")
    both = (np.concatenate([getattr(ride, name) for ride in (first, second)]) for name in names)
    return RideOfTrack(first.names, *map(check.frozen, both))


RIDING_SHARE = 0.05  # [1] share from which an orientation rides
RIDING_PARTS = 6  # parts of each; as many again where any of them turned or left
DEPENDS = 0.05  # [1] of what arrives as wanted: a design that owes or loses more to turning says so


@dataclass(frozen=True, eq=False)
class LongRide:
    """A ride of the orientations that come often, and what it makes of the mix; M orientations."""

    ride: RideOfTrack
    entering: Floats  # (M,) [1] shares at the track's entry
    arriving: Floats  # (M,) [1] shares at the tooling
    wanted: tuple[int, ...]  # orientations that leave as wanted

    @property
    def _share_wanted(self) -> Floats:
        """(M,) [1] of what begins so that arrives as wanted; of what was not ridden all or nothing."""
        counts = self.ride.counts
        parts, as_wanted = counts.sum(axis=1), counts[:, list(self.wanted)].sum(axis=1)
        return np.where(parts > 0, as_wanted / np.maximum(parts, 1), self._is_wanted)

    @property
    def _is_wanted(self) -> Bools:
        return np.isin(np.arange(len(self.entering)), self.wanted)

    @property
    def gains(self) -> Floats:
        """Return (M,) [1] of all that enters, the share that arrives as wanted though it did not begin so."""
        return np.where(self._is_wanted, 0.0, self.entering * self._share_wanted)

    @property
    def losses(self) -> Floats:
        """Return (M,) [1] of all that enters, the share that begins as wanted and does not arrive so."""
        return np.where(self._is_wanted, self.entering * (1.0 - self._share_wanted), 0.0)

    @property
    def warning(self) -> str:
        """Return a sentence where the design depends on an orientation that turns on the way; else ''."""
        entering = float(self.entering[list(self.wanted)].sum())
        moved = self.gains + self.losses
        if not moved.sum() > DEPENDS * max(entering + self.gains.sum() - self.losses.sum(), 1e-12):
            return ""
        row = int(np.argmax(moved))
        counts = self.ride.counts[row]
        parts, name = int(counts.sum()), self.ride.names[row]
        turned = parts - int(counts[row])
        arrives = float(self.arriving[list(self.wanted)].sum())
        return (
            f"{turned} of {parts} parts of {name} turned or left on {1e3 * self.distance:.3g} mm of bare "
            f"track, so what is wanted changes from {100.0 * entering:.3g} to {100.0 * arrives:.3g} % on the "
            "way to the tooling; nobody has measured this, so count parts before the tooling of the bowl"
        )

    @property
    def distance(self) -> float:
        """Return how far the parts rode that arrived [m], the median."""
        arrived = self.ride.end_rows >= 0
        return float(np.median(self.ride.distances[arrived])) if arrived.any() else 0.0

    def rows(self) -> list[dict[str, Any]]:
        """Return a dict of each orientation that rode: parts, how many stay, become another, or left.

        Returns
        -------
        list of dict of str to object
            Shares and their Wilson interval are [1].
        """
        lines, counts, names = [], self.ride.counts, self.ride.names
        for row in self.ride.rows:
            parts, stays = int(counts[row].sum()), int(counts[row, row])
            low, high = (float(end[0]) for end in wilson([stays], parts))
            further = [k for k in range(len(names)) if k != row and counts[row, k]]
            lines.append(
                {
                    "orientation": names[row],
                    "parts": parts,
                    "stays": stays,
                    "stays_low": low,
                    "stays_high": high,
                    "becomes": {names[k]: int(counts[row, k]) for k in further},
                    "left": int(counts[row, -1]),
                    "share_entering": float(self.entering[row]),
                    "share_arriving": float(self.arriving[row]),
                }
            )
        return lines


def long_ride(
    part: Part,
    bowl: Bowl,
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted: Sequence[int],
    run: RunSettings,
) -> LongRide:
    """Let parts ride from the track's entry to the tooling, and return the mix that arrives there.

    The orientations that come often ride, and those that leave as wanted whether they come often or not.
    Those of which a part turned or left ride with as many parts again.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they enter the track; often is RIDING_SHARE or more.
    wanted : sequence of int
        Orientations that leave as wanted.
    run : RunSettings
        Its seed and its cores; no progress is told.

    Returns
    -------
    LongRide

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all have arrived.
    """
    often = [int(k) for k in np.argsort(-shares, kind="stable") if shares[k] >= RIDING_SHARE]
    rows = list(dict.fromkeys([*often, *(k for k in wanted if shares[k] > 0.0)]))
    ride = ride_of_track(
        part, bowl, orientations, rows, repeats=RIDING_PARTS, run=RunSettings(run.seed, run.jobs)
    )
    if turned := np.flatnonzero(ride.is_turned).tolist():
        more = RunSettings(run.seed + 1, run.jobs)
        ride = join_rides(
            ride, ride_of_track(part, bowl, orientations, turned, repeats=RIDING_PARTS, run=more)
        )
    return LongRide(ride, shares, ride.arriving_shares(shares), tuple(int(k) for k in wanted))
