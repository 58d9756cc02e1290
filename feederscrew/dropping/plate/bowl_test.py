"""A virtual dynamic bowl test of one part on one or several drives."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.dropping import conditions
from feederscrew.dropping.ensemble import Aim
from feederscrew.dropping.launches import sample
from feederscrew.dropping.plate import drive
from feederscrew.dropping.plate.occupancy import Occupancy, lasting, occupancy
from feederscrew.dropping.plate.rides import Rides, joined, ride
from feederscrew.dropping.rigid_body import Shape, shape_of_part
from feederscrew.errors import ArgumentError
from feederscrew.records import ReadableRecord
from feederscrew.resting.tumbling.by_class import ground
from feederscrew.running import USUAL_RUN, RunSettings

USUAL = 400  # parts, where the user names no number
ROUND = 400  # parts between two looks at the intervals
MOST_STEPS = 20_000_000  # for one part: a minute of computing; 10 mm for ten minutes take 4,000,000
LEAST, MOST = 8, 600  # looks at a part, one a period or one in so many


@dataclass(frozen=True)
class Pace:
    """How finely and how long a part is followed before it counts, and how many are."""

    seconds: float = 5.0  # [s] each part is followed once it counts
    coarse: float = 1.0  # [1] by how much steps are longer than those that velocities need
    settling: float = 30.0  # [sqrt(L / g)] before the count begins: the launch has died away
    kick: float = np.inf  # [1] times the floor's own energy: a part that this does not tip stays
    width: float | None = None  # [1] of the widest 95 % interval to either side: then enough parts are known
    keep: bool = False  # the rides themselves, for a run of more parts
    done: Rides | None = None  # those of the first parts, where they were kept
    scatters: bool = False  # one value of restitution as that of single impacts, where parts are thrown up


EXACT = Pace(scatters=True)


@dataclass(frozen=True, eq=False)
class Shaken(ReadableRecord):
    """What parts did on one plate."""

    bowl: Bowl
    launch: dict  # name and ranges sampled, in the units of the shop
    throw_number: float  # [1]
    parts: int
    seconds: float  # [s] counted for each part
    occupancy: Occupancy
    lost: int  # parts left out: their motion took far more steps than it should
    partial: bool  # stopped by the user before all parts were done
    rides: Rides | None = None  # of each part, where they are kept

    @property
    def transitions(self):
        """Return how many were seen between classes."""
        counts = self.occupancy.counts
        return int(counts.sum() - np.trace(counts))

    @property
    def unsettled(self):
        """Return how many parts have not lain on any face yet."""
        return round(self.parts * (1.0 - float(self.occupancy.course[-1].sum())))


def test(part, aspects, bowls, preset, own, *, drops=None, pace=EXACT, run=USUAL_RUN):
    """Put parts on a vibrating plate, one at a time, and follow what they lie on.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    bowls : sequence of Bowl
        One plate each: the drive, its restitution, and the kinetic friction.
    preset : str
        A key of ``launch.PRESETS``: how the parts come onto the plate.
    own : dict of str to (str or None)
        Ranges that replace the preset's, and the bowl's restitution and friction.
    drops : int, optional
        Parts on each plate; the same launches on all.
    pace : Pace
        How long each is followed, and how finely.
    run : RunSettings
        Its progress is told after every batch of the parts done, on all plates together, and how many there
        will be.

    Returns
    -------
    list of Shaken
        One a bowl; fewer, the last of them partial, after an interrupt from the keyboard.

    Raises
    ------
    FeederError
        If the part has no shape, or an option is no such quantity or out of range.
    KeyboardInterrupt
        If nothing was finished.
    """
    found = ground(part, aspects)
    shape, length = shape_of_part(part, found)
    count, results = USUAL if drops is None else drops, []
    way = _Way(found.rows, len(aspects.names), shape, length, pace, run)
    came = (conditions.launch_of(preset, length, own, bowl.gravity) for bowl in bowls)
    launches = [_surfaced(launch, bowl, own, pace) for launch, bowl in zip(came, bowls)]
    run.begin()
    for k, bowl in enumerate(bowls):
        try:
            tell = _after(k * count, len(bowls) * count, run.progress)
            results.append(_plate(way, bowl, launches[k], count, tell))
        except KeyboardInterrupt:
            if not results:
                raise
            results[-1] = replace(results[-1], partial=True)
        if results[-1].partial:
            break
    return results


def shaken_of(part, aspects, bowl, preset, pace, counted, seen):
    """Return what parts did on one plate, from what was seen of them in an earlier run that was not stopped.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    bowl : Bowl
    preset : str
        A key of ``launch.PRESETS``.
    pace : Pace
        Of that run.
    counted : (int, int, float [s])
        Parts, those that were lost, and the time counted for each.
    seen : Occupancy

    Returns
    -------
    Shaken
    """
    _, length = shape_of_part(part, ground(part, aspects))
    launch = _surfaced(conditions.launch_of(preset, length, {}, bowl.gravity), bowl, {}, pace)
    parts, lost, seconds = counted
    return Shaken(
        bowl=bowl,
        launch=conditions.described(launch, length, bowl.gravity),
        throw_number=drive.throw_number(bowl),
        parts=parts,
        seconds=seconds,
        occupancy=seen,
        lost=lost,
        partial=False,
    )


def _after(before, total, progress):
    """``progress`` for parts that come after others; None without one."""
    return progress and (lambda done: progress(before + done, total))


def _surfaced(launch, bowl, own, pace):
    """The launch with the bowl's restitution and friction, where the user gave none."""
    surface = {"restitution": bowl.restitution, "friction": bowl.friction.kinetic}
    launch = replace(
        launch, **{key: (value, value) for key, value in surface.items() if own.get(key) is None}
    )
    given = own.get("restitution")
    single = given is None or conditions.single(given) is not None
    thrown = drive.throw_number(bowl) > 1.0
    return launch.scattering() if pace.scatters and single and thrown else launch


@dataclass(frozen=True, eq=False)
class _Way:
    """A part, and the way in which it is followed on every plate."""

    rows: np.ndarray  # (F,) int, class of each of its faces
    classes: int
    shape: Shape
    length: float  # [m] the unit of length
    pace: Pace
    run: RunSettings


def _plate(way, bowl, launch, count, progress):
    """The test on one plate."""
    shape, length, pace = way.shape, way.length, way.pace
    floor, unit = drive.floor_of(bowl, length, pace.coarse), np.sqrt(length / bowl.gravity)
    period = looks_apart(bowl.drive.frequency, pace.seconds)
    number = max(round(pace.seconds / period), LEAST)
    looks = (np.ceil(pace.settling * unit / period) + np.arange(number + 1)) * period / unit
    starts = sample(launch, shape, count, np.random.default_rng(way.run.seed))
    steps, kick = drive.steps_of(floor, pace.coarse), drive.kick_of(floor, pace.kick)
    _must_end(looks[-1] / min(steps.contact, floor.step))
    follow = partial(ride, shape, floor, looks=looks, steps=steps, kick=kick, jobs=way.run.jobs)
    rides = _enough(follow, starts, pace, way.rows, way.classes, progress)
    rng = np.random.default_rng((way.run.seed, len(rides.faces)))
    seen = occupancy(rides.faces, length * rides.places[:, :, 0], way.rows, way.classes, period, rng)
    return Shaken(
        bowl=bowl,
        launch=conditions.described(launch, length, bowl.gravity),
        throw_number=drive.throw_number(bowl),
        parts=len(rides.faces),
        seconds=number * period,
        occupancy=seen,
        lost=rides.lost,
        partial=rides.partial,
        rides=rides if pace.keep else None,
    )


def _must_end(steps):
    """Refuse to follow a part for more steps than anybody waits for."""
    if steps > MOST_STEPS:
        what = f"a part so small takes {steps:.2g} steps at this drive for so long"
        raise ArgumentError("seconds", what, "follow it for less, or check the part's unit")


def _enough(follow, starts, pace, rows, classes, progress):
    """Rides of all parts or, with a width, of as many as make no share's interval wider."""
    count, done = len(starts.energies), [] if pace.done is None else [pace.done]
    size = count if pace.width is None else ROUND
    first = sum(len(rides.faces) + rides.lost for rides in done)
    aim = pace.width and Aim(pace.width, rows, classes)
    while first < count and not (aim and done and aim.widest(_last(done)) <= pace.width):
        tell = progress and (lambda parts, before=first: progress(before + parts))
        try:
            done.append(follow(starts.some(slice(first, first + size)), progress=tell))
        except KeyboardInterrupt:
            if not done:
                raise
            return replace(joined(done), partial=True)
        if done[-1].partial:
            break
        first += size
    return joined(done)


def _last(done):
    """(N,) face that each part lies on at its last look."""
    return np.concatenate([lasting(rides.faces)[:, -1] for rides in done])


def looks_apart(frequency, seconds):
    """Return the time between looks [s]: whole periods of the drive, so that the plate stands alike.

    Source: docs/resting.md, "On the vibrating plate".
    """
    return max(int(np.ceil(seconds * frequency / MOST)), 1) / frequency
