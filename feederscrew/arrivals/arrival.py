"""Mix of aspects that enters the track: parts fed from a hopper onto the moving floor of a bowl.

Source: own; docs/resting.md, "What arrives from the bowl's floor".
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.arrivals import plate_test
from feederscrew.arrivals.ensemble import NORMAL_95
from feederscrew.arrivals.plate_test import PlatePace
from feederscrew.arrivals.rounded_hull import shape_of_part
from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats
from feederscrew.base.running import RunSettings
from feederscrew.bowl.record import Bowl
from feederscrew.part.hull import Hull
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, require_ground

ARRIVAL_LAUNCH = "feed"
FLOOR_TIMES_S = (0.5, 2.0)  # [s] on the floor: the longer one where the shorter decides nothing
FIRST_PARTS = 400  # that choose the time on the floor
LONGER_TIME_PARTS = 800  # that show whether the longer one decides
MAX_ARRIVALS = 4000  # parts that are followed, where time or rates decide
ARRIVAL_HALF_WIDTH = 0.025  # [1] half the widest 95 % interval of a share at which enough parts are followed
ARRIVAL_PACE = PlatePace(coarse=3.0, flight=12.0, settling=40.0, kick=4.0)
"""For shares alone, not velocities. Of 2,400 parts of eight real kinds on the default floor 8 that were
followed no further lay on another side half a second later, at four times the floor's energy. Steps in the
air last a sixteenth of a period at most: a whole one passes over landings where the floor rises meanwhile."""
THROWN_SETTLING = 15.0  # [sqrt(L / g)] on a floor that throws parts up: there nothing comes to lie still
MAX_ARRIVAL_STEPS = 300_000  # for one part: of 10 mm it takes 13,000 on the default floor, of 10 um 240,000
ARRIVED_SHARE_GAP = 0.05  # [1] of a share: so near to where the rates lead it has arrived
MAX_LOST_SHARE = 0.1  # [1] of the parts that may lie on no aspect
MOVING_REMARK = (
    "the shares still change after {:g} s on the floor - how long the parts stay in the bowl decides"
)
UNSEEN_REMARK = (
    "{} of {} parts lie on no aspect while the floor moves - the drive may be too strong for this part"
)


@dataclass(frozen=True, eq=False)
class Arrival:
    """Shares in which parts reach the track's entry; A classes."""

    p: Floats  # (A,) [1] sums to 1; NaN where no part came to lie on anything
    low: Floats  # (A,) [1] 95 % interval; where nothing is settled, of all that it may become
    high: Floats  # (A,) [1]
    settled: bool  # whether time or the rates of change decide them
    reason: str  # why they are not settled, for a user; empty where they are
    shaken: plate_test.PlateResult  # what the parts did on the floor


def arrival(
    part: Part,
    aspects: Aspects,
    bowl: Bowl,
    *,
    drops: int | None = None,
    seed: int = 1,
    jobs: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Arrival:
    """Feed parts from a hopper onto the bowl's moving floor until time or rates settle their shares.

    First ``FIRST_PARTS`` are followed for the shorter of ``FLOOR_TIMES_S``; where that settles nothing,
    others for the longer one. Then more parts follow until every share is known.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    bowl : Bowl
    drops : int, optional
        Parts to follow. Without it as many as make every share known to ``ARRIVAL_HALF_WIDTH``, at most
        ``MAX_ARRIVALS``, or ``LONGER_TIME_PARTS`` where the longer time decides nothing.
    seed : int
        Of the launches.
    jobs : int
        Threads.
    progress : callable, optional
        As in ``plate_test.test``; it starts again for a longer time.

    Returns
    -------
    Arrival

    Raises
    ------
    FeederError
        If the part has no shape.
    KeyboardInterrupt
        If the user stops it before anything is known; later, the result is partial.
    """
    thrown = plate_test.throw_number(bowl) >= 1.0
    pace = replace(ARRIVAL_PACE, settling=THROWN_SETTLING) if thrown else ARRIVAL_PACE
    short, long = FLOOR_TIMES_S
    if drops is None:
        adaptive = replace(pace, width=ARRIVAL_HALF_WIDTH)
        runs = [
            (FIRST_PARTS, short, replace(pace, keep=True)),
            (MAX_ARRIVALS, short, adaptive),
            (LONGER_TIME_PARTS, long, replace(adaptive, keep=True)),
            (None, long, pace),
        ]
    else:
        runs = [(drops, seconds, pace) for seconds in FLOOR_TIMES_S]
    arrived: Any = None
    last, run = 0.0, RunSettings(seed, jobs, progress)
    for count, seconds, pace in runs:
        if arrived is not None:
            # Another run: for longer where nothing is settled, else of more parts where they are not sure.
            if arrived.settled != (seconds == last):
                continue
            if arrived.settled:
                occupancy, parts = arrived.shaken.occupancy, arrived.shaken.parts
                if count is None:  # as many as make every share known, by how the parts differed
                    width = NORMAL_95 * occupancy.error.max() / ARRIVAL_HALF_WIDTH
                    rounds = np.ceil(parts * width**2 / plate_test.PARTS_A_LOOK)
                    count = int(min(MAX_ARRIVALS, rounds * plate_test.PARTS_A_LOOK))
                pace = replace(pace, done=arrived.shaken.rides)
                widest = 0.5 * (occupancy.plate_high - occupancy.plate_low).max()
                if widest <= ARRIVAL_HALF_WIDTH or count <= parts:
                    continue
        pace = replace(pace, seconds=seconds)
        try:
            shaken = plate_test.test(
                part, aspects, [bowl], ARRIVAL_LAUNCH, {}, drops=count, pace=pace, run=run
            )[0]
        except KeyboardInterrupt:
            if arrived is None:
                raise
            arrived = replace(arrived, shaken=replace(arrived.shaken, partial=True))
            break
        arrived, last = judge(shaken), seconds
        if shaken.partial:
            break
    return replace(arrived, shaken=replace(arrived.shaken, rides=None))


def judge(shaken: plate_test.PlateResult) -> Arrival:
    """Return the arrival that one run on the floor shows: shares, their ends, and whether they are settled.

    Shares are settled where none still changes. They also have to come within ``ARRIVED_SHARE_GAP`` of where
    the rates lead, once two things are known: so many transitions were seen that they tell where that is, and
    more than ``ARRIVAL_HALF_WIDTH`` of the parts change in the longer time.

    Parameters
    ----------
    shaken : PlateResult

    Returns
    -------
    Arrival
    """
    occupancy = shaken.occupancy
    lying = occupancy.plate.sum()
    p = occupancy.plate / lying if lying > 0.0 else np.full(len(occupancy.plate), np.nan)
    away = np.abs(np.nan_to_num(occupancy.limit, nan=0.0) - p) > ARRIVED_SHARE_GAP
    outside = (occupancy.limit < occupancy.plate_low) | (occupancy.limit > occupancy.plate_high)
    some = shaken.transitions * FLOOR_TIMES_S[1] > ARRIVAL_HALF_WIDTH * shaken.parts * shaken.seconds
    led = some and (away & outside & np.isfinite(occupancy.limit)).any()
    reason = MOVING_REMARK.format(shaken.seconds) if led or occupancy.changing.any() else ""
    if not lying >= 1.0 - MAX_LOST_SHARE:
        reason = UNSEEN_REMARK.format(round((1.0 - lying) * shaken.parts), shaken.parts)
    # Ends of the interval: of the time on the plate, or from the first shares to where they lead.
    ends = [occupancy.plate_low, occupancy.plate_high, p]
    if reason:
        ends += [occupancy.start, occupancy.limit_low, occupancy.limit_high]
    nothing = ~np.isfinite(p)
    low = np.where(nothing, 0.0, np.nanmin(np.stack(ends), axis=0))
    high = np.where(nothing, 1.0, np.nanmax(np.stack(ends), axis=0))
    return Arrival(check.frozen(p), check.frozen(low), check.frozen(high), not reason, reason, shaken)


def to_arrays(arrived: Arrival) -> dict[str, Array]:
    """Return what was seen of the parts on the floor as plain arrays, for ``from_arrays``."""
    counted = {name: np.array(getattr(arrived.shaken, name)) for name in ("parts", "lost", "seconds")}
    fields = vars(arrived.shaken.occupancy).items()
    return counted | {name: array for name, array in fields if name not in plate_test.DERIVED_FIELDS}


def from_arrays(
    part: Part, aspects: Aspects, bowl: Bowl, drops: int | None, arrays: Mapping[str, Array]
) -> Arrival:
    """Return an arrival from the arrays of ``to_arrays``, if each number is one that such parts can have.

    What follows from other numbers, such as the intervals, is computed again.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    bowl : Bowl
    drops : int or None
        Parts that were asked for.
    arrays : mapping of str to array

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
    occupancy = plate_test.occupancy_from(arrays, len(aspects.names), parts)
    _, length = shape_of_part(part, require_ground(part, aspects))
    launch = plate_test.launch_on(bowl, ARRIVAL_LAUNCH, length, {}, ARRIVAL_PACE)
    return judge(plate_test.result_of(bowl, launch, length, occupancy, parts, lost, seconds))


def steps_needed(hull: Hull, bowl: Bowl) -> float:
    """Return how many steps one part takes on the floor of a bowl if it is followed to the end.

    Beyond ``MAX_ARRIVAL_STEPS`` a part is not fed: it is far smaller, or the drive quicker, than in any bowl.

    Parameters
    ----------
    hull : Hull
    bowl : Bowl

    Returns
    -------
    float [1]

    References
    ----------
    Own; docs/resting.md, "What arrives from the bowl's floor".
    """
    length = float(np.cbrt(hull.volume))
    unit = np.sqrt(length / bowl.gravity)
    floor = plate_test.floor_of(bowl, length, ARRIVAL_PACE.flight)
    longest = min(plate_test.steps_of(floor, ARRIVAL_PACE.coarse).contact, floor.step)
    return (max(FLOOR_TIMES_S) / unit + ARRIVAL_PACE.settling) / longest
