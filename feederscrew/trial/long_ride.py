"""A ride along bare track before the tooling: which orientations last, which turn, roll back or fall off."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.arrays import Bools, Floats, Ints
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.part.record import Part
from feederscrew.running import USUAL_RUN, RunSettings
from feederscrew.tooling.orientations import Orientation
from feederscrew.trial import course, part_poses, runs, staging
from feederscrew.trial.looks import OTHER, Looks
from feederscrew.trial.shape import round_circles, solid_of

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
    """What became of N parts on bare track; M orientations."""

    names: tuple[str, ...]  # (M,) of the orientations
    entry_rows: Ints  # (N,) the orientation in which each began
    end_rows: Ints  # (N,) in which it arrives at the tooling; LEFT of one that does not
    is_askew: Bools  # (N,) whether it lies so only nearly, away from the wall for instance
    distances: Floats  # (N,) [m] along the wall
    seconds: Floats  # (N,) [s]

    @property
    def rows(self) -> list[int]:
        """The orientations that were ridden, in the order in which they were begun."""
        return list(dict.fromkeys(self.entry_rows.tolist()))

    @property
    def counts(self) -> Ints:
        """(M, M + 1) parts by the orientation in which they began and ended; the last column has left."""
        counts = np.zeros((len(self.names), len(self.names) + 1), int)
        columns = np.where(self.end_rows == LEFT, len(self.names), self.end_rows)
        np.add.at(counts, (self.entry_rows, columns), 1)
        return counts

    @property
    def is_turned(self) -> Bools:
        """(M,) whether any part that began so has ended otherwise, or has left."""
        counts = self.counts
        return counts.sum(axis=1) > np.diag(counts)

    def arriving_shares(self, shares: Floats) -> Floats:
        """Return the shares (M,) [1] that arrive at the tooling of those (M,) that enter the track.

        An orientation that was not ridden stays what it is. What has left comes back with all others.
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

    Of the bowl's devices those that lean the track at its entry count. ``repeats`` parts of every one of the
    ``rows`` ride over a ``distance`` [m], by default a turn of the bowl and RIDE_M at the most, for
    RIDE_S at the most; each draws its start from the seed of ``run``. Raises KeyboardInterrupt if the user
    stops it before all have arrived, FeederError if the part has no shape or the bowl conveys nothing.
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
    slopes = staging.entry_slopes(bowl.devices, bowl.track, orientations)
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
    """Return two rides of the same orientations as one."""
    names = ("entry_rows", "end_rows", "is_askew", "distances", "seconds")
    both = (np.concatenate([getattr(ride, name) for ride in (first, second)]) for name in names)
    return RideOfTrack(first.names, *map(check.frozen, both))
