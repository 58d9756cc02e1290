"""A virtual dynamic bowl test of one part: many, one at a time, on plates that vibrate, on several cores.

Source: docs/resting.md, "On the vibrating plate"; the bowl tests of the thesis (MDBT).
"""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.dropping import launch_conditions
from feederscrew.dropping.ensemble import Aim
from feederscrew.dropping.kernel import falling
from feederscrew.dropping.kernel import ride as shaken
from feederscrew.dropping.kernel.falling import Steps
from feederscrew.dropping.kernel.floor_motion import Floor
from feederscrew.dropping.launch_conditions import sample
from feederscrew.dropping.occupancy import Occupancy, lasting, occupancy
from feederscrew.dropping.pool import in_batches
from feederscrew.dropping.rounded_hull import Shape, shape_of_part
from feederscrew.errors import ArgumentError
from feederscrew.geometry.compiled import on_disk
from feederscrew.records import ReadableRecord
from feederscrew.resting.exact_tumbling import require_ground
from feederscrew.running import USUAL_RUN, RunSettings

STEPS_A_PERIOD = (
    200  # steps of a period, at least: eight times as many change a flat part's velocity by 2 % at most
)
PLATE_STEP_REFINEMENT = 2.0  # than the steps of a drop
SLOW_CONTACT_SHARE = 0.1  # of the plate's greatest speed upwards: slower contacts do not rebound


def floor_of(bowl, length, coarse=1.0) -> Floor:
    """Return the plate that moves as the bowl's floor does; level, its x axis along the drive.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    bowl : Bowl
    length : float [m]
        Of the part, cube root of its hull's volume.
    coarse : float [1]
        By how much steps are longer than those that velocities need.

    Returns
    -------
    Floor
    """
    drive, time = bowl.drive, math.sqrt(length / bowl.gravity)
    rate = 2.0 * math.pi * drive.frequency * time
    second_angle = drive.vibration_angle + drive.second_harmonic_turn
    second = drive.amplitude * drive.second_harmonic / length
    return Floor(
        rate=rate,
        along=drive.amplitude * math.cos(drive.vibration_angle) / length,
        up=drive.amplitude * math.sin(drive.vibration_angle) / length,
        lead=-drive.phase,
        second_along=second * math.cos(second_angle),
        second_up=second * math.sin(second_angle),
        second_phase=drive.second_harmonic_phase,
        step=coarse * 2.0 * math.pi / rate / STEPS_A_PERIOD,
    )


def steps_of(floor, coarse=1.0) -> Any:
    """Return steps for a plate: finer than a drop's unless ``coarse``, and rebounds as slow as its own."""
    usual, once = Steps(), min(coarse, PLATE_STEP_REFINEMENT)
    return usual._replace(
        flight=coarse * usual.flight / PLATE_STEP_REFINEMENT,
        contact=coarse * usual.contact / PLATE_STEP_REFINEMENT**2,
        swing=once * usual.swing / PLATE_STEP_REFINEMENT,
        tolerance=once * usual.tolerance / PLATE_STEP_REFINEMENT,
        threshold=min(
            usual.threshold, max(SLOW_CONTACT_SHARE * (floor.up + 2.0 * floor.second_up) * floor.rate, 1e-4)
        ),
    )


def throw_number(bowl) -> float:
    """Return the level floor's greatest downward acceleration over gravity [1], as of a track.

    Source: the normal force of eq. [4.14] at the upper reversal; docs/conveying.md, "The model".
    """
    if bowl.drive.amplitude == 0.0:
        return 0.0
    return float(answer.throw_number(replace(bowl, track=replace(bowl.track, climb=0.0, bank=0.0))))


def kick_of(floor, times) -> float:
    """Return the energy [m g L] of a point at so many ``times`` that of the floor's quickest motion.

    Source: docs/resting.md, "On the vibrating plate".
    """
    first, second = math.hypot(floor.along, floor.up), math.hypot(floor.second_along, floor.second_up)
    quickest = floor.rate * (first + 2.0 * second)
    return times * 0.5 * quickest**2


PARTS_A_BATCH = 10  # parts a core takes at a time


@dataclass(frozen=True, eq=False)
class Rides:
    """Where each of N parts lay at each of K looks."""

    faces: np.ndarray  # (N, K) face it lies on, UNSETTLED while it may be tipping over
    places: np.ndarray  # (N, K, 2) of its centre of mass, in units of L
    lost: int  # further parts, left out: their motion took far more steps than it should
    partial: bool  # stopped by the user before all were done


def ride(shape, floor, starts, looks, steps, *, kick=math.inf, jobs=1, progress=None) -> Rides:
    """Follow parts on a plate.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    shape : Shape
    floor : Floor
    starts : feederscrew.dropping.launch_conditions.Starts
        Of the N parts, relative to the plate.
    looks : (K,) float [sqrt(L/g)]
        Times, ascending.
    steps : Steps
    kick : float [m g L]
        Energy that the floor gives a part at most: one whose face it does not tip it off is followed no
        further. Infinite, all parts are followed to the end.
    jobs : int
        Cores to use; the outcome does not depend on it.
    progress : function, optional
        Told after every batch how many parts are done.

    Returns
    -------
    Rides
        After an interrupt from the keyboard, the batches that were finished, up to the first that was not:
        a run of so many parts gives the same.

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """
    batch = partial(_batch, shape, floor, starts, looks, steps, kick)
    batch(slice(0, 0))  # compiled here, if need be
    columns, stopped = in_batches(batch, len(starts.energies), PARTS_A_BATCH, jobs, progress)
    faces, places, whole = columns
    return Rides(check.frozen(faces[whole]), check.frozen(places[whole]), int((~whole).sum()), stopped)


def joined(rides) -> Rides:
    """Return several rides, one after the other, as one."""
    return Rides(
        faces=check.frozen(np.concatenate([own.faces for own in rides])),
        places=check.frozen(np.concatenate([own.places for own in rides])),
        lost=sum(own.lost for own in rides),
        partial=any(own.partial for own in rides),
    )


def compiled():
    """Tell whether the kernel of the plate is on disk already."""
    return on_disk(shaken.ride_all)


def _batch(
    shape, floor, starts, looks, steps, kick, part
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.bool_]]:
    """Faces and places of some parts, and whether every look was taken."""
    launched = starts.launched(part)
    record = shaken.empty_looks(len(launched.states), looks)
    shaken.ride_all(shape, falling.scratch(shape), floor, launched, steps, record, kick)
    return record.faces, record.places, record.taken == len(looks)


DEFAULT_PLATE_PARTS = 400  # parts, where the user names no number
PARTS_A_LOOK = 400  # parts between two looks at the intervals
MAX_PLATE_STEPS = 20_000_000  # for one part: a minute of computing; 10 mm for ten minutes take 4,000,000
MIN_LOOKS, MAX_LOOKS = 8, 600  # looks at a part, one a period or one in so many


@dataclass(frozen=True)
class PlatePace:
    """How finely and how long a part is followed before it counts, and how many are."""

    seconds: float = 5.0  # [s] each part is followed once it counts
    coarse: float = 1.0  # [1] by how much steps are longer than those that velocities need
    settling: float = 30.0  # [sqrt(L / g)] before the count begins: the launch has died away
    kick: float = np.inf  # [1] times the floor's own energy: a part that this does not tip stays
    width: float | None = None  # [1] of the widest 95 % interval to either side: then enough parts are known
    keep: bool = False  # the rides themselves, for a run of more parts
    done: Rides | None = None  # those of the first parts, where they were kept
    scatters: bool = False  # one value of restitution as that of single impacts, where parts are thrown up


EXACT_PACE = PlatePace(scatters=True)


@dataclass(frozen=True, eq=False)
class PlateResult(ReadableRecord):
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
    def transitions(self) -> int:
        """Return how many were seen between classes."""
        counts = self.occupancy.counts
        return int(counts.sum() - np.trace(counts))

    @property
    def unsettled(self):
        """Return how many parts have not lain on any face yet."""
        return round(self.parts * (1.0 - float(self.occupancy.course[-1].sum())))


def test(part, aspects, bowls, preset, own, *, drops=None, pace=EXACT_PACE, run=USUAL_RUN):
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
    pace : PlatePace
        How long each is followed, and how finely.
    run : RunSettings
        Its progress is told after every batch of the parts done, on all plates together, and how many there
        will be.

    Returns
    -------
    list of PlateResult
        One a bowl; fewer, the last of them partial, after an interrupt from the keyboard.

    Raises
    ------
    FeederError
        If the part has no shape, or an option is no such quantity or out of range.
    KeyboardInterrupt
        If nothing was finished.
    """
    faces = require_ground(part, aspects)
    shape, length = shape_of_part(part, faces)
    count, results = DEFAULT_PLATE_PARTS if drops is None else drops, []
    setup = _PlateSetup(faces.rows, len(aspects.names), shape, length, pace, run)
    came = (launch_conditions.launch_of(preset, length, own, bowl.gravity) for bowl in bowls)
    launches = [_surfaced(launch, bowl, own, pace) for launch, bowl in zip(came, bowls)]
    run.begin()
    for k, bowl in enumerate(bowls):
        try:
            tell = _after(k * count, len(bowls) * count, run.progress)
            results.append(_plate(setup, bowl, launches[k], count, tell))
        except KeyboardInterrupt:
            if not results:
                raise
            results[-1] = replace(results[-1], partial=True)
        if results[-1].partial:
            break
    return results


def shaken_of(part, aspects, bowl, preset, pace, counted, looks) -> PlateResult:
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
    pace : PlatePace
        Of that run.
    counted : (int, int, float [s])
        Parts, those that were lost, and the time counted for each.
    looks : Occupancy

    Returns
    -------
    PlateResult
    """
    _, length = shape_of_part(part, require_ground(part, aspects))
    launch = _surfaced(launch_conditions.launch_of(preset, length, {}, bowl.gravity), bowl, {}, pace)
    parts, lost, seconds = counted
    return PlateResult(
        bowl=bowl,
        launch=launch_conditions.described(launch, length, bowl.gravity),
        throw_number=throw_number(bowl),
        parts=parts,
        seconds=seconds,
        occupancy=looks,
        lost=lost,
        partial=False,
    )


def _after(before, total, progress) -> Any:
    """``progress`` for parts that come after others; None without one."""
    return progress and (lambda done: progress(before + done, total))


def _surfaced(launch, bowl, own, pace):
    """The launch with the bowl's restitution and friction, where the user gave none."""
    surface = {"restitution": bowl.restitution, "friction": bowl.friction.kinetic}
    launch = replace(
        launch, **{key: (value, value) for key, value in surface.items() if own.get(key) is None}
    )
    restitution = own.get("restitution")
    single = restitution is None or launch_conditions.single(restitution) is not None
    thrown = throw_number(bowl) > 1.0
    return launch.scattering() if pace.scatters and single and thrown else launch


@dataclass(frozen=True, eq=False)
class _PlateSetup:
    """A part, and the way in which it is followed on every plate."""

    rows: np.ndarray  # (F,) int, class of each of its faces
    classes: int
    shape: Shape
    length: float  # [m] the unit of length
    pace: PlatePace
    run: RunSettings


def _plate(setup, bowl, launch, count, progress) -> PlateResult:
    """The test on one plate."""
    shape, length, pace = setup.shape, setup.length, setup.pace
    floor, unit = floor_of(bowl, length, pace.coarse), np.sqrt(length / bowl.gravity)
    period = looks_apart(bowl.drive.frequency, pace.seconds)
    number = max(round(pace.seconds / period), MIN_LOOKS)
    looks = (np.ceil(pace.settling * unit / period) + np.arange(number + 1)) * period / unit
    starts = sample(launch, shape, count, np.random.default_rng(setup.run.seed))
    steps, kick = steps_of(floor, pace.coarse), kick_of(floor, pace.kick)
    _must_end(looks[-1] / min(steps.contact, floor.step))
    follow = partial(ride, shape, floor, looks=looks, steps=steps, kick=kick, jobs=setup.run.jobs)
    rides = _enough(follow, starts, pace, setup.rows, setup.classes, progress)
    rng = np.random.default_rng((setup.run.seed, len(rides.faces)))
    record = occupancy(rides.faces, length * rides.places[:, :, 0], setup.rows, setup.classes, period, rng)
    return PlateResult(
        bowl=bowl,
        launch=launch_conditions.described(launch, length, bowl.gravity),
        throw_number=throw_number(bowl),
        parts=len(rides.faces),
        seconds=number * period,
        occupancy=record,
        lost=rides.lost,
        partial=rides.partial,
        rides=rides if pace.keep else None,
    )


def _must_end(steps) -> None:
    """Refuse to follow a part for more steps than anybody waits for."""
    if steps > MAX_PLATE_STEPS:
        what = f"a part so small takes {steps:.2g} steps at this drive for so long"
        raise ArgumentError("seconds", what, "follow it for less, or check the part's unit")


def _enough(follow, starts, pace, rows, classes, progress) -> Rides:
    """Rides of all parts or, with a width, of as many as make no share's interval wider."""
    count, done = len(starts.energies), [] if pace.done is None else [pace.done]
    size = count if pace.width is None else PARTS_A_LOOK
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


def _last(done) -> NDArray[np.int64]:
    """(N,) face that each part lies on at its last look."""
    return np.concatenate([lasting(rides.faces)[:, -1] for rides in done])


def looks_apart(frequency, seconds) -> float:
    """Return the time between looks [s]: whole periods of the drive, so that the plate stands alike.

    Source: docs/resting.md, "On the vibrating plate".
    """
    return max(int(np.ceil(seconds * frequency / MAX_LOOKS)), 1) / frequency
