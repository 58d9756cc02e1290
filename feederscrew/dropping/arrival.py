"""What lies at the track's entry: parts fed from a hopper onto the moving floor of a bowl."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.dropping import occupancy, plate_test
from feederscrew.dropping.ensemble import NORMAL_95, half_width
from feederscrew.dropping.occupancy import Occupancy
from feederscrew.running import RunSettings

ARRIVAL_LAUNCH = "feed"
FLOOR_TIMES_S = (0.5, 2.0)  # [s] on the floor: the longer one where the shorter decides nothing
FIRST_PARTS, LONGER_TIME_PARTS = (
    400,
    800,
)  # parts that choose the spell; that show whether the longer one decides
MAX_ARRIVALS = 4000  # parts that are followed, where time or rates decide
ARRIVAL_HALF_WIDTH = 0.02  # [1] half the widest 95 % interval of a share at which enough parts are followed
ARRIVAL_PACE = plate_test.PlatePace(coarse=3.0, settling=40.0, kick=4.0)
"""For shares alone, not velocities. Of 2,400 parts of eight real kinds on the default floor 8 that were
followed no further lay on another side half a second later, at four times the floor's energy."""
THROWN_SETTLING = (
    15.0  # [sqrt(L / g)] of settling on a floor that throws parts up: there nothing comes to lie still
)
MAX_ARRIVAL_STEPS = 300_000  # for one part: of 10 mm it takes 13,000 on the default floor, of 10 um 240,000
ARRIVED_SHARE_GAP = 0.05  # [1] of a share: so near to where the rates lead it has arrived
MOVING_REMARK = (
    "the shares still change after {:g} s on the floor - how long the parts stay in the bowl decides"
)
UNSEEN_REMARK = (
    "{} of {} parts lie on no aspect while the floor moves - the drive may be too strong for this part"
)
MAX_LOST_SHARE = 0.1  # [1] of the parts that may lie on no aspect


@dataclass(frozen=True, eq=False)
class Arrival:
    """Shares in which parts reach the track's entry; A classes."""

    p: np.ndarray  # (A,) [1] sums to 1; NaN where no part came to lie on anything
    low: np.ndarray  # (A,) [1] 95 % interval; where nothing is settled, of all that it may become
    high: np.ndarray  # (A,) [1]
    settled: bool  # whether time or the rates of change decide them
    reason: str  # why they are not settled, for a user; empty where they are
    shaken: plate_test.PlateResult  # what the parts did on the floor

    @property
    def sure(self) -> bool:
        """Whether every share is known to ARRIVAL_HALF_WIDTH."""
        return (
            half_width(self.shaken.occupancy.plate_low, self.shaken.occupancy.plate_high)
            <= ARRIVAL_HALF_WIDTH
        )


def arrival(part, aspects, bowl, *, drops=None, seed=1, jobs=1, progress=None) -> Arrival:
    """Feed parts from a hopper onto the bowl's moving floor until time or rates settle their shares.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    bowl : Bowl
        Its drive, restitution and kinetic friction.
    drops : int, optional
        Parts to follow; without it as many as make every share known to ARRIVAL_HALF_WIDTH, at most
        MAX_ARRIVALS, or LONGER_TIME_PARTS where
        the longer spell decides nothing.
    seed, jobs : int
    progress : function, optional
        As in ``plate_test.test``; it starts again for a longer spell.

    Returns
    -------
    Arrival

    Raises
    ------
    FeederError
        If the part has no shape.
    KeyboardInterrupt
        If the user stops it before anything is known.
    """
    arrived, last, run = None, 0.0, RunSettings(seed, jobs, progress)
    for count, seconds, pace in _runs(bowl, drops):
        if arrived is not None and seconds == last:
            count = count or enough(arrived)
            pace = replace(pace, done=arrived.shaken.rides)
        if arrived is not None and not _wanted(arrived, last, count, seconds):
            continue
        own = {"drops": count, "pace": replace(pace, seconds=seconds), "run": run}
        try:
            shaken = plate_test.test(part, aspects, [bowl], ARRIVAL_LAUNCH, {}, **own)[0]
        except KeyboardInterrupt:
            if arrived is None:
                raise
            return _without_rides(replace(arrived, shaken=replace(arrived.shaken, partial=True)))
        arrived, last = judged(shaken), seconds
        if shaken.partial:
            break
    return _without_rides(arrived)


def _without_rides(arrived) -> Any:
    return replace(arrived, shaken=replace(arrived.shaken, rides=None))


def to_arrays(arrived) -> Any:
    """Return what was seen of the parts on the floor as plain arrays, for ``from_arrays``.

    Source: own.

    Parameters
    ----------
    arrived : Arrival
        Of a run that was not stopped.

    Returns
    -------
    dict of str to array
    """
    shaken = arrived.shaken
    counted = {
        "parts": np.array(shaken.parts),
        "lost": np.array(shaken.lost),
        "seconds": np.array(shaken.seconds),
    }
    return occupancy.to_arrays(shaken.occupancy) | counted


def from_arrays(part, aspects, bowl, drops, arrays) -> Arrival:
    """Return an arrival from plain arrays, once every number in them is one that such parts can have.

    Source: own. What follows from other numbers, such as the intervals, is computed again.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    bowl : Bowl
    drops : int or None
        As for ``arrival``.
    arrays : dict of str to array
        As of ``to_arrays``.

    Returns
    -------
    Arrival

    Raises
    ------
    ValueError
        If a number or a shape cannot be of such parts.
    KeyError
        If an array is missing.
    """
    most = MAX_ARRIVALS if drops is None else drops
    parts, lost = (int(check.ranged(k, arrays[k], (), 0, most, whole=True)) for k in ("parts", "lost"))
    seconds = float(check.ranged("seconds", arrays["seconds"], (), 0.0, 2.0 * max(FLOOR_TIMES_S)))
    if parts < 1 or parts + lost > most or (drops is not None and parts + lost != drops):
        raise ValueError(f"{parts} parts and {lost} that were lost, of {most}")
    looks = occupancy.from_arrays(arrays, len(aspects.names), parts)
    return judged(
        plate_test.shaken_of(part, aspects, bowl, ARRIVAL_LAUNCH, ARRIVAL_PACE, (parts, lost, seconds), looks)
    )


def steps_needed(hull, bowl) -> float:
    """Return how many steps one part takes on the floor of a bowl, were it followed to the end.

    Source: own; docs/resting.md, "What arrives from the bowl's floor".

    Parameters
    ----------
    hull : Hull
        Of the part.
    bowl : Bowl
        With gravity.

    Returns
    -------
    float [1]
        Beyond ``MOST_STEPS`` a part is not fed: it is far smaller, or the drive quicker, than in any bowl.
    """
    length = float(np.cbrt(hull.volume))
    unit = np.sqrt(length / bowl.gravity)
    floor = plate_test.floor_of(bowl, length, ARRIVAL_PACE.coarse)
    longest = min(plate_test.steps_of(floor, ARRIVAL_PACE.coarse).contact, floor.step)
    return (max(FLOOR_TIMES_S) / unit + ARRIVAL_PACE.settling) / longest


def enough(arrived) -> int:
    """Return how many parts make every share known to ARRIVAL_HALF_WIDTH, by how they differed.

    Parameters
    ----------
    arrived : Arrival

    Returns
    -------
    int
        At most MAX_ARRIVALS.
    """
    width, parts = NORMAL_95 * arrived.shaken.occupancy.error.max(), arrived.shaken.parts
    rounds = np.ceil(parts * (width / ARRIVAL_HALF_WIDTH) ** 2 / plate_test.PARTS_A_LOOK)
    return int(min(MAX_ARRIVALS, rounds * plate_test.PARTS_A_LOOK))


def _runs(bowl, drops) -> list[Any]:
    """Parts (None: as many as are enough), seconds and pace of the runs there may be, in their order."""
    pace = (
        ARRIVAL_PACE
        if plate_test.throw_number(bowl) < 1.0
        else replace(ARRIVAL_PACE, settling=THROWN_SETTLING)
    )
    if drops is not None:
        return [(drops, seconds, pace) for seconds in FLOOR_TIMES_S]
    adaptive = replace(pace, width=ARRIVAL_HALF_WIDTH)
    return [
        (FIRST_PARTS, FLOOR_TIMES_S[0], replace(pace, keep=True)),
        (MAX_ARRIVALS, FLOOR_TIMES_S[0], adaptive),
        (LONGER_TIME_PARTS, FLOOR_TIMES_S[1], replace(adaptive, keep=True)),
        (None, FLOOR_TIMES_S[1], pace),
    ]


def _wanted(arrived, last, count, seconds) -> bool:
    """Whether another run is needed after what was found in the last one: of more parts, or for longer."""
    if seconds > last:
        return not arrived.settled
    return arrived.settled and not arrived.sure and count > arrived.shaken.parts


def judged(shaken) -> Arrival:
    """Say whether one run on the floor settles the shares.

    Parameters
    ----------
    shaken : PlateResult

    Returns
    -------
    Arrival
        Settled where no share still changes and, once so many transitions were seen that they tell where
        the shares lead and that more than ARRIVAL_HALF_WIDTH of the parts change in the longer spell, all
        shares have
        come ARRIVED_SHARE_GAP to it.
    """
    looks = shaken.occupancy
    lying = looks.plate.sum()
    p = looks.plate / lying if lying > 0.0 else np.full(len(looks.plate), np.nan)
    reason = _reason(shaken, looks, p, lying)
    low, high = _span(looks, p, settled=not reason)
    return Arrival(check.frozen(p), check.frozen(low), check.frozen(high), not reason, reason, shaken)


def _reason(shaken, looks: Occupancy, p, lying) -> Any:
    """Why the shares are not settled; empty where they are."""
    if not lying >= 1.0 - MAX_LOST_SHARE:
        return UNSEEN_REMARK.format(round((1.0 - lying) * shaken.parts), shaken.parts)
    away = np.abs(np.nan_to_num(looks.limit, nan=0.0) - p) > ARRIVED_SHARE_GAP
    outside = (looks.limit < looks.plate_low) | (looks.limit > looks.plate_high)
    some = shaken.transitions * FLOOR_TIMES_S[1] > ARRIVAL_HALF_WIDTH * shaken.parts * shaken.seconds
    led = some and (away & outside & np.isfinite(looks.limit)).any()
    return MOVING_REMARK.format(shaken.seconds) if led or looks.changing.any() else ""


def _span(looks, p, settled) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(A,) ends of the interval: of the time on the plate, or from the first shares to where they lead."""
    ends = [looks.plate_low, looks.plate_high, p]
    if not settled:
        ends += [looks.start, looks.limit_low, looks.limit_high]
    spread, nothing = np.stack(ends), ~np.isfinite(p)
    low, high = np.nanmin(spread, axis=0), np.nanmax(spread, axis=0)
    return np.where(nothing, 0.0, low), np.where(nothing, 1.0, high)
