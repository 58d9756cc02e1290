"""What lies at the track's entry: parts fed from a hopper onto the moving floor of a bowl."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.dropping.ensemble import NORMAL, half_width
from feederscrew.dropping.plate import bowl_test, drive, occupancy
from feederscrew.dropping.plate.occupancy import Occupancy
from feederscrew.running import RunSettings

LAUNCH = "feed"
SPELLS = (0.5, 2.0)  # [s] on the floor: the longer one where the shorter decides nothing
FIRST, LONGEST = 400, 800  # parts that choose the spell; that show whether the longer one decides
MOST = 4000  # parts that are followed, where time or rates decide
WIDTH = 0.02  # [1] half the widest 95 % interval of a share at which enough parts are followed
PACE = bowl_test.Pace(coarse=3.0, settling=40.0, kick=4.0)
"""For shares alone, not velocities. Of 2,400 parts of eight real kinds on the default floor 8 that were
followed no further lay on another side half a second later, at four times the floor's energy."""
THROWN = 15.0  # [sqrt(L / g)] of settling on a floor that throws parts up: there nothing comes to lie still
MOST_STEPS = 300_000  # for one part: of 10 mm it takes 13,000 on the default floor, of 10 um 240,000
NEAR = 0.05  # [1] of a share: so near to where the rates lead it has arrived
MOVING = "the shares still change after {:g} s on the floor - how long the parts stay in the bowl decides"
UNSEEN = "{} of {} parts lie on no aspect while the floor moves - the drive may be too strong for this part"
LOST = 0.1  # [1] of the parts that may lie on no aspect


@dataclass(frozen=True, eq=False)
class Arrival:
    """Shares in which parts reach the track's entry; A classes."""

    p: np.ndarray  # (A,) [1] sums to 1; NaN where no part came to lie on anything
    low: np.ndarray  # (A,) [1] 95 % interval; where nothing is settled, of all that it may become
    high: np.ndarray  # (A,) [1]
    settled: bool  # whether time or the rates of change decide them
    reason: str  # why they are not settled, for a user; empty where they are
    shaken: bowl_test.Shaken  # what the parts did on the floor

    @property
    def sure(self):
        """Whether every share is known to WIDTH."""
        return half_width(self.shaken.occupancy.plate_low, self.shaken.occupancy.plate_high) <= WIDTH


def arrival(part, aspects, bowl, *, drops=None, seed=1, jobs=1, progress=None):
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
        Parts to follow; without it as many as make every share known to WIDTH, at most MOST, or LONGEST where
        the longer spell decides nothing.
    seed, jobs : int
    progress : function, optional
        As in ``bowl_test.test``; it starts again for a longer spell.

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
    found, last, run = None, 0.0, RunSettings(seed, jobs, progress)
    for count, seconds, pace in _runs(bowl, drops):
        if found is not None and seconds == last:
            count = count or enough(found)
            pace = replace(pace, done=found.shaken.rides)
        if found is not None and not _wanted(found, last, count, seconds):
            continue
        own = {"drops": count, "pace": replace(pace, seconds=seconds), "run": run}
        try:
            shaken = bowl_test.test(part, aspects, [bowl], LAUNCH, {}, **own)[0]
        except KeyboardInterrupt:
            if found is None:
                raise
            return _without_rides(replace(found, shaken=replace(found.shaken, partial=True)))
        found, last = judged(shaken), seconds
        if shaken.partial:
            break
    return _without_rides(found)


def _without_rides(found):
    return replace(found, shaken=replace(found.shaken, rides=None))


def to_arrays(found):
    """Return what was seen of the parts on the floor as plain arrays, for ``from_arrays``.

    Source: own.

    Parameters
    ----------
    found : Arrival
        Of a run that was not stopped.

    Returns
    -------
    dict of str to array
    """
    shaken = found.shaken
    counted = {
        "parts": np.array(shaken.parts),
        "lost": np.array(shaken.lost),
        "seconds": np.array(shaken.seconds),
    }
    return occupancy.to_arrays(shaken.occupancy) | counted


def from_arrays(part, aspects, bowl, drops, arrays):
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
    most = MOST if drops is None else drops
    parts, lost = (int(check.ranged(k, arrays[k], (), 0, most, whole=True)) for k in ("parts", "lost"))
    seconds = float(check.ranged("seconds", arrays["seconds"], (), 0.0, 2.0 * max(SPELLS)))
    if parts < 1 or parts + lost > most or (drops is not None and parts + lost != drops):
        raise ValueError(f"{parts} parts and {lost} that were lost, of {most}")
    seen = occupancy.from_arrays(arrays, len(aspects.names), parts)
    return judged(bowl_test.shaken_of(part, aspects, bowl, LAUNCH, PACE, (parts, lost, seconds), seen))


def steps_needed(hull, bowl):
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
    floor = drive.floor_of(bowl, length, PACE.coarse)
    longest = min(drive.steps_of(floor, PACE.coarse).contact, floor.step)
    return (max(SPELLS) / unit + PACE.settling) / longest


def enough(found):
    """Return how many parts make every share known to WIDTH, by how they differed from part to part.

    Parameters
    ----------
    found : Arrival

    Returns
    -------
    int
        At most MOST.
    """
    width, parts = NORMAL * found.shaken.occupancy.error.max(), found.shaken.parts
    rounds = np.ceil(parts * (width / WIDTH) ** 2 / bowl_test.ROUND)
    return int(min(MOST, rounds * bowl_test.ROUND))


def _runs(bowl, drops):
    """Parts (None: as many as are enough), seconds and pace of the runs there may be, in their order."""
    pace = PACE if drive.throw_number(bowl) < 1.0 else replace(PACE, settling=THROWN)
    if drops is not None:
        return [(drops, seconds, pace) for seconds in SPELLS]
    adaptive = replace(pace, width=WIDTH)
    return [
        (FIRST, SPELLS[0], replace(pace, keep=True)),
        (MOST, SPELLS[0], adaptive),
        (LONGEST, SPELLS[1], replace(adaptive, keep=True)),
        (None, SPELLS[1], pace),
    ]


def _wanted(found, last, count, seconds):
    """Whether another run is needed after what was found in the last one: of more parts, or for longer."""
    if seconds > last:
        return not found.settled
    return found.settled and not found.sure and count > found.shaken.parts


def judged(shaken):
    """Say whether one run on the floor settles the shares.

    Parameters
    ----------
    shaken : Shaken

    Returns
    -------
    Arrival
        Settled where no share still changes and, once so many transitions were seen that they tell where
        the shares lead and that more than WIDTH of the parts change in the longer spell, all shares have
        come NEAR to it.
    """
    seen = shaken.occupancy
    lying = seen.plate.sum()
    p = seen.plate / lying if lying > 0.0 else np.full(len(seen.plate), np.nan)
    reason = _reason(shaken, seen, p, lying)
    low, high = _span(seen, p, settled=not reason)
    return Arrival(check.frozen(p), check.frozen(low), check.frozen(high), not reason, reason, shaken)


def _reason(shaken, seen: Occupancy, p, lying):
    """Why the shares are not settled; empty where they are."""
    if not lying >= 1.0 - LOST:
        return UNSEEN.format(round((1.0 - lying) * shaken.parts), shaken.parts)
    away = np.abs(np.nan_to_num(seen.limit, nan=0.0) - p) > NEAR
    outside = (seen.limit < seen.plate_low) | (seen.limit > seen.plate_high)
    some = shaken.transitions * SPELLS[1] > WIDTH * shaken.parts * shaken.seconds
    led = some and (away & outside & np.isfinite(seen.limit)).any()
    return MOVING.format(shaken.seconds) if led or seen.changing.any() else ""


def _span(seen, p, settled):
    """(A,) ends of the interval: of the time on the plate, or from the first shares to where they lead."""
    ends = [seen.plate_low, seen.plate_high, p]
    if not settled:
        ends += [seen.start, seen.limit_low, seen.limit_high]
    every, nothing = np.stack(ends), ~np.isfinite(p)
    low, high = np.nanmin(every, axis=0), np.nanmax(every, axis=0)
    return np.where(nothing, 0.0, low), np.where(nothing, 1.0, high)
