"""What arrives at the tooling: the mix at the track's entry after a ride along bare track."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew.bowl.record import Bowl
from feederscrew.dropping.ensemble import wilson
from feederscrew.part.record import Part
from feederscrew.running import RunSettings
from feederscrew.tooling.orientations import Orientation
from feederscrew.trial.long_ride import RideOfTrack, joined, ride_of_track

RIDING_SHARE = 0.05  # [1] share from which an orientation rides
RIDING_PARTS = 6  # parts of each; as many again where any of them turned or left
DEPENDS = 0.05  # [1] of what arrives as wanted: a design that owes or loses more to turning says so


@dataclass(frozen=True, eq=False)
class LongRide:
    """A ride of the orientations that come often, and what it makes of the mix; M orientations."""

    ride: RideOfTrack
    entering: NDArray[np.float64]  # (M,) [1] shares at the track's entry
    arriving: NDArray[np.float64]  # (M,) [1] shares at the tooling
    wanted: tuple[int, ...]  # orientations that leave as wanted

    @property
    def either(self) -> NDArray[np.float64]:
        """(M,) [1] shares of which half are those that enter and half those that arrive."""
        return 0.5 * (self.entering + self.arriving)

    @property
    def gained(self) -> NDArray[np.float64]:
        """(M,) [1] of all that enters, what began so and arrives as wanted though it was not."""
        return np.where(self._is_wanted, 0.0, self.entering * self._share_wanted)

    @property
    def lost(self) -> NDArray[np.float64]:
        """(M,) [1] of all that enters, what began so, as wanted, and arrives otherwise or not at all."""
        return np.where(self._is_wanted, self.entering * (1.0 - self._share_wanted), 0.0)

    @property
    def _is_wanted(self) -> NDArray[np.bool_]:
        return np.isin(np.arange(len(self.entering)), self.wanted)

    @property
    def _share_wanted(self) -> NDArray[np.float64]:
        """(M,) [1] of what begins so that arrives as wanted; of what was not ridden all or nothing."""
        counts = self.ride.counts
        parts = counts.sum(axis=1)
        as_wanted = counts[:, list(self.wanted)].sum(axis=1)
        return np.where(parts > 0, as_wanted / np.maximum(parts, 1), self._is_wanted)

    @property
    def warning(self) -> str:
        """A sentence where the design depends on an orientation that turns on the way; '' elsewhere."""
        entering = float(self.entering[list(self.wanted)].sum())
        moved = self.gained + self.lost
        if not moved.sum() > DEPENDS * max(entering + self.gained.sum() - self.lost.sum(), 1e-12):
            return ""
        row = int(np.argmax(moved))
        counts = self.ride.counts[row]
        parts, name = int(counts.sum()), self.ride.names[row]
        turned = parts - int(counts[row])
        arrives = float(self.arriving[list(self.wanted)].sum())
        return (
            f"{turned} of {parts} parts of {name} turned or left on {1e3 * self.distance:.3g} mm of bare "
            f"track, so what is wanted changes from {100.0 * entering:.3g} to {100.0 * arrives:.3g} % on the "
            "way to the tooling; simulations differ in this, so count parts before the tooling of the bowl"
        )

    @property
    def distance(self) -> float:
        """How far the parts rode that arrived [m], the median."""
        arrived = self.ride.ended >= 0
        return float(np.median(self.ride.distances[arrived])) if arrived.any() else 0.0

    def rows(self) -> list[dict[str, Any]]:
        """Return a dict of each orientation that rode: parts, how many stay, become another, or left."""
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
    lying: Sequence[Orientation],
    shares: NDArray[np.float64],
    wanted: Sequence[int],
    run: RunSettings,
) -> LongRide:
    """Let the orientations that come often ride to the tooling.

    Those of which a part turned or left ride with as many parts again.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        At the drive that was chosen.
    lying : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they enter the track.
    wanted : sequence of int
        Those that leave as wanted; they ride whether they come often or not.
    run : RunSettings
        Each part draws its own start from the seed.

    Returns
    -------
    LongRide

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before all have arrived.
    """
    shares = np.asarray(shares, float)
    often = [k for k in np.argsort(-shares, kind="stable") if shares[k] >= RIDING_SHARE]
    rows = list(dict.fromkeys([*(int(k) for k in often), *(k for k in wanted if shares[k] > 0.0)]))
    ride = ride_of_track(part, bowl, lying, rows, each=RIDING_PARTS, run=RunSettings(run.seed, run.jobs))
    turned = [int(k) for k in np.flatnonzero(ride.turned)]
    if turned:
        more = RunSettings(run.seed + 1, run.jobs)
        ride = joined(ride, ride_of_track(part, bowl, lying, turned, each=RIDING_PARTS, run=more))
    return LongRide(ride, shares, ride.arriving(shares), tuple(int(k) for k in wanted))
