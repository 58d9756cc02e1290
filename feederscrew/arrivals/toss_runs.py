"""Tosses read from a file of launches, each followed over small changes of what is not known of it."""

import hashlib
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.arrivals.kernel import body, falling, one_drop
from feederscrew.arrivals.launch_conditions import lowest_points
from feederscrew.arrivals.pool import in_batches
from feederscrew.arrivals.rounded_hull import principal_axes, shape_of_part
from feederscrew.base import check, documents
from feederscrew.base.arrays import Array, Floats, Ints
from feederscrew.base.errors import FeederError
from feederscrew.base.units import GRAVITY, QuantityError, decimal, quantity_text
from feederscrew.motion.conveying import RESTITUTION_DOUBT
from feederscrew.part.record import Part
from feederscrew.resting.exact_tumbling import Ground
from feederscrew.resting.profiles import FaultList, split_cells

POSITION_COLUMNS = ("x0_m", "y0_m", "z0_m")
ATTITUDE_COLUMNS = ("qw0", "qx0", "qy0", "qz0")
VELOCITY_COLUMNS = ("vx0", "vy0", "vz0")
SPIN_COLUMNS = ("wx0", "wy0", "wz0")
STATE_COLUMNS = (*POSITION_COLUMNS, *ATTITUDE_COLUMNS, *VELOCITY_COLUMNS, *SPIN_COLUMNS)
END_COLUMNS = ("xe_m", "ye_m")
FACE_COLUMN = "face_up_end"
FACE_NAMES = ("-x", "+x", "-y", "+y", "-z", "+z")  # sides of a part by the axes of its file
CAMERA_PATTERN = re.compile(r"frames_(\d+(?:\.\d+)?)Hz")
QUATERNION_TOLERANCE = 0.02  # [1] that the length of a quaternion may differ from 1 by
# beyond, the unit is not SI
MAX_SPEED_M_S = 1e3
MAX_SPIN_RAD_S = 1e4
MAX_DISTANCE_M = 1e3
MAX_LAUNCHES_BYTES = 5_000_000
MAX_TOSSES = 5_000
STATE_EXAMPLE = f"give the columns toss,{','.join(STATE_COLUMNS)} in SI units"
DEFAULT_RUNS = 64  # runs of each toss
TOSSES_A_BATCH = 4  # tosses a core takes at a time
DRAWS_A_RUN = 11  # normal numbers a run takes: 3 velocity, 3 spin, 3 attitude, restitution, friction
MAX_SUNK_SHARE = 0.02  # [1] of the part's length: a launch may begin so far below, by the error of its pose
FRICTION_SPREAD = 0.2  # relative standard deviation of a coefficient of friction (assumption)
MODEL_DOUBT = 2.4  # [1] what the model leaves out, as so many times what a picture of the camera leaves open


@dataclass(frozen=True, eq=False)
class LaunchFile:
    """N launches of one part, each a state over the plane z = 0, and their measured ends."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    names: tuple[str, ...]  # of the tosses, as they stand in the file
    lines: tuple[int, ...]  # of the file
    positions: Floats  # (N, 3) [m] of the centre of mass
    attitudes: Floats  # (N, 4) unit quaternions w x y z, from the file's axes to the plane's
    velocities: Floats  # (N, 3) [m/s] of the centre of mass
    spins: Floats  # (N, 3) [rad/s] in the axes of the part file
    frame: float  # [s] from one picture of the camera to the next; 0 where the file does not say
    ends: Floats | None  # (N, 2) [m] where the centre of mass came to rest, as measured
    faces: tuple[str, ...] | None  # (N,) of FACE_NAMES: what points up at rest, as measured


def read_launches(path: str | Path) -> LaunchFile:
    """Return a file of launches, CSV in SI units.

    It has a column ``toss`` and those of ``STATE_COLUMNS``; ``xe_m``, ``ye_m`` and ``face_up_end`` where the
    end was measured; a column ``frames_148Hz`` says how many pictures a second the camera took. Lines that
    begin with '#' and other columns are left out.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    LaunchFile

    Raises
    ------
    Faults
        With every fault of the file, one a line.
    FeederError
        If it cannot be read, is empty, too large or lacks a column.
    """
    where = str(path)
    data = documents.content(path, MAX_LAUNCHES_BYTES, "a CSV file of launches", FeederError)
    if len(data) > MAX_LAUNCHES_BYTES:
        raise FeederError(path, f"has more than {MAX_LAUNCHES_BYTES // 1_000_000} MB", "split the file")
    # Header, and rows with the numbers of their lines.
    numbered = enumerate(documents.decoded(data, where).splitlines(), 1)
    lines = [(k, line) for k, line in numbered if line.strip(", \t") and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise FeederError(where, "has no launch", STATE_EXAMPLE)
    if len(lines) > MAX_TOSSES + 1:
        raise FeederError(where, f"has more than {MAX_TOSSES} launches", "split the file")
    first, header = lines[0][0], split_cells(where, *lines[0], STATE_EXAMPLE)
    lacking = [name for name in ("toss", *STATE_COLUMNS) if name not in header]
    if lacking:
        raise FeederError(f"{where}:{first}", f"there is no column {lacking[0]}", STATE_EXAMPLE)
    twice = [name for name in header if name and header.count(name) > 1]
    if twice:
        raise FeederError(f"{where}:{first}", f"column {twice[0]} is given twice", "keep one of them")
    cells = [split_cells(where, number, line, STATE_EXAMPLE) for number, line in lines[1:]]
    rows, numbers = [dict(zip(header, row)) for row in cells], [number for number, _ in lines[1:]]
    wanted = (*STATE_COLUMNS, *(END_COLUMNS if set(END_COLUMNS) <= set(header) else ()))
    limits = dict.fromkeys(POSITION_COLUMNS, (MAX_DISTANCE_M, "m"))
    limits |= dict.fromkeys(VELOCITY_COLUMNS, (MAX_SPEED_M_S, "m/s"))
    limits |= dict.fromkeys(SPIN_COLUMNS, (MAX_SPIN_RAD_S, "rad/s"))
    few = FaultList(where)
    for number, row in zip(numbers, rows):
        place = f"{path}:{number}"
        bad = False
        for name in wanted:
            try:
                decimal(row.get(name, ""))
            except QuantityError:
                bad, what = True, f"{name}: {quantity_text(row.get(name, ''))} is not a number"
                few.add(place, what, "give a number in SI units")
        if not row["toss"]:
            few.add(place, "the toss has no name", "give each launch a name or number of its own")
        if FACE_COLUMN in header and row.get(FACE_COLUMN, "") not in FACE_NAMES:
            what = f"{FACE_COLUMN}: {quantity_text(row.get(FACE_COLUMN, ''))} is not a side of the part"
            few.add(place, what, f"give one of {', '.join(FACE_NAMES)}")
        if bad:
            continue
        size = math.hypot(*(float(row[name]) for name in ATTITUDE_COLUMNS))
        if abs(size - 1.0) > QUATERNION_TOLERANCE:
            few.add(place, f"the quaternion has the length {size:.3g}", "give one of length 1, as w x y z")
        for name, (most, unit) in limits.items():
            if abs(float(row[name])) > most:
                few.add(place, f"{name} is {row[name]}", f"give {unit}, from {-most:g} to {most:g}")
    few.raise_any()

    def columns(names: Sequence[str]) -> Floats:
        return check.frozen(np.array([[float(row[name]) for name in names] for row in rows]))

    attitudes = columns(ATTITUDE_COLUMNS)
    rate = next((float(match[1]) for match in map(CAMERA_PATTERN.fullmatch, header) if match), 0.0)
    return LaunchFile(
        source=where,
        sha256=hashlib.sha256(data).hexdigest(),
        names=tuple(row["toss"] for row in rows),
        lines=tuple(numbers),
        positions=columns(POSITION_COLUMNS),
        attitudes=check.frozen(attitudes / np.sqrt((attitudes**2).sum(axis=1))[:, None]),
        velocities=columns(VELOCITY_COLUMNS),
        spins=columns(SPIN_COLUMNS),
        frame=1.0 / rate if rate > 0.0 else 0.0,
        ends=columns(END_COLUMNS) if set(END_COLUMNS) <= set(header) else None,
        faces=tuple(row[FACE_COLUMN] for row in rows) if FACE_COLUMN in header else None,
    )


@dataclass(frozen=True)
class SurfaceRanges:
    """Restitution and friction of a run: a value that scatters, or the ends of a range."""

    restitution: tuple[float, float]
    friction: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Tosses:
    """Outcomes of N tosses, each over K runs; the first run of each has the values as given."""

    runs: int
    shares: Floats  # (N, 6) [1] of the settled runs that end with each of FACE_NAMES up
    faces: Ints  # (N,) index into FACE_NAMES: what most runs end with; -1 where none settled
    rows: Ints  # (N,) class of the aspect those runs rest on
    places: Floats  # (N, 2) [m] where the centre of mass comes to rest: as given, or the median
    spreads: Floats  # (N,) [m] half of those runs end so near that place
    times: Floats  # (N,) [s] until rest, the median of those runs
    settled: Ints  # (N,) int, runs that came to rest
    released: Ints  # (N,) index into FACE_NAMES: what points up most at the launch
    partial: bool  # stopped by the user before all were done


def follow(
    part: Part,
    resting_faces: Ground,
    launches: LaunchFile,
    surface: SurfaceRanges,
    rng: np.random.Generator,
    *,
    runs: int = DEFAULT_RUNS,
    jobs: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Tosses:
    """Follow each launch of a file until the part lies still, again and again with small changes.

    Two things are not known: the restitution and friction of this toss (``RESTITUTION_DOUBT``,
    ``FRICTION_SPREAD``), and the state within one picture of the camera. In that time T gravity changes a
    velocity by g T, and the spin w turns the part by w T. Velocities, those of a point at half the part's
    length from the centre, and attitudes scatter as a value does that is anywhere in such an interval, by 1 /
    sqrt(12) of it. Rigid corners and one coefficient are not what happens: ``MODEL_DOUBT`` times as much
    makes the mean ``p`` of every other filmed toss the share that comes true.

    Parameters
    ----------
    part : Part
    resting_faces : Ground
    launches : LaunchFile
    surface : SurfaceRanges
    rng : Generator
        A launch gets the same numbers whatever the number of ``jobs``.
    runs : int
        Of each launch.
    jobs : int
        Threads.
    progress : callable, optional
        Called with how many launches are done, and of how many.

    Returns
    -------
    Tosses

    Raises
    ------
    FeederError
        If a launch begins below the plane.

    References
    ----------
    docs/validation.md, "Filmed tosses of a cube".
    """
    shape, length = shape_of_part(part, resting_faces)
    principal = principal_axes(part.inertia)[1]
    # States as the kernel has them: along the principal axes, without dimensions.
    turns = _rotations(launches.attitudes) * Rotation.from_matrix(np.array(principal))
    states = np.zeros((len(launches.names), body.STATE))
    states[:, : body.VX] = launches.positions / length
    states[:, body.VX : body.Q] = launches.velocities / np.sqrt(GRAVITY * length)
    states[:, body.Q : body.W] = np.roll(turns.as_quat(), 1, axis=1)
    states[:, body.W :] = np.einsum("ni,ij->nj", launches.spins, principal) / np.sqrt(GRAVITY / length)
    # Raise a fault for the first launch that begins in the plane.
    lowest = states[:, body.Z] + lowest_points(shape, states[:, body.Q : body.W])
    below = np.flatnonzero(lowest < -MAX_SUNK_SHARE)
    if len(below):
        where = f"{launches.source}:{launches.lines[below[0]]}"
        what = f"the launch begins {-1e3 * length * lowest[below[0]]:.3g} mm below the plane"
        raise FeederError(where, what, "give x0_m, y0_m, z0_m of the centre of mass over the plane z = 0")
    draws = rng.standard_normal((len(states), runs, DRAWS_A_RUN))
    draws[:, 0] = 0.0  # as given
    # (N, 3) standard deviations, without dimensions: of velocities, spins and the attitude [rad].
    quick = MODEL_DOUBT * launches.frame / np.sqrt(12.0)
    velocity = GRAVITY * quick / np.sqrt(GRAVITY * length)
    turning = quick * np.sqrt((launches.spins**2).sum(axis=1))
    uncertain = np.stack(
        [np.full_like(turning, velocity), np.full_like(turning, 2.0 * velocity), turning], axis=1
    )

    steps = falling.Steps(early=False)

    def batch(cut: slice) -> list[Array]:
        """(T, K, 13) ends, (T, K) faces and (T, K) times of the runs of some tosses."""
        work, count = falling.scratch(shape), cut.stop - cut.start
        ends = np.zeros((count, runs, body.STATE))
        faces, times = np.zeros((count, runs), int), np.zeros((count, runs))
        for n in range(count):
            begun = _varied(states[cut.start + n], uncertain[cut.start + n], surface, draws[cut.start + n])
            for k, (state, restitution, friction) in enumerate(zip(*begun)):
                work.state[:] = state
                faces[n, k], times[n, k], _ = one_drop.settle(shape, work, restitution, friction, steps)
                ends[n, k] = work.state
        return [ends, faces, times]

    tell = None if progress is None else lambda done: progress(done, len(states))
    (ends, faces, times), partial = in_batches(batch, len(states), TOSSES_A_BATCH, jobs, tell)
    # The runs of each toss as one answer.
    count = len(ends)
    ups, settled = _upward(ends[:, :, body.Q : body.W], principal), faces != one_drop.UNSETTLED
    shares, best, lain = np.zeros((count, len(FACE_NAMES))), np.full(count, -1), np.full(count, -1)
    places, spreads, seconds = np.full((count, 2), np.nan), np.full(count, np.nan), np.full(count, np.nan)
    for n in range(count):
        calm = settled[n]
        if not calm.any():
            continue
        counts = np.bincount(ups[n][calm], minlength=len(FACE_NAMES))
        shares[n] = counts / calm.sum()
        first = ups[n][np.argmax(calm)]
        best[n] = first if counts[first] == counts.max() else np.argmax(counts)
        chosen = calm & (ups[n] == best[n])
        spots = length * ends[n, chosen, :2]
        lain[n] = np.bincount(resting_faces.rows[faces[n][chosen]]).argmax()
        places[n] = length * ends[n, 0, :2] if chosen[0] else np.median(spots, axis=0)
        spreads[n] = np.median(np.hypot(*(spots - places[n]).T))
        seconds[n] = np.sqrt(length / GRAVITY) * np.median(times[n][chosen])
    released = _upward(launches.attitudes[:count], np.eye(3))
    arrays = {
        "shares": shares,
        "faces": best,
        "rows": lain,
        "places": places,
        "spreads": spreads,
        "times": seconds,
        "settled": settled.sum(axis=1),
        "released": released,
    }
    return Tosses(runs, **{name: check.frozen(array) for name, array in arrays.items()}, partial=partial)


def _rotations(quaternions: Floats) -> Rotation:
    """Return the rotations from the part's axes to the plane's, of (N, 4) quaternions w x y z."""
    return Rotation.from_quat(np.roll(quaternions, -1, axis=-1))


def _varied(
    state: Floats,
    uncertain: Floats,
    surface: SurfaceRanges,
    draws: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Return (K, 13) states, (K,) restitutions and (K,) frictions of the runs of one toss."""
    states = np.repeat(state[None], len(draws), axis=0)
    states[:, body.VX : body.Q] += uncertain[0] * draws[:, 0:3]
    states[:, body.W :] += uncertain[1] * draws[:, 3:6]
    turns = _rotations(states[:, body.Q : body.W]) * Rotation.from_rotvec(uncertain[2] * draws[:, 6:9])
    states[:, body.Q : body.W] = np.roll(turns.as_quat(), 1, axis=1)
    bounce = scattered(surface.restitution, RESTITUTION_DOUBT, draws[:, 9])
    return states, np.clip(bounce, 0.0, 1.0), scattered(surface.friction, FRICTION_SPREAD, draws[:, 10])


def scattered(ends: tuple[float, float], relative: float, draws: Floats) -> Floats:
    """Return values of what is known as one value or as a range.

    About one value, of equal ends, they are normal with the standard deviation ``relative`` of it, and not
    below a tenth of it. In a range they are as good as uniform: the logistic function 1 / (1 + exp(-1.702 x))
    is the normal distribution to 0.01.

    Parameters
    ----------
    ends : (float, float) [its unit]
    relative : float [1]
    draws : (K,) float [1]
        Normal numbers: 0 gives the value, or the middle of the range.

    Returns
    -------
    (K,) float [its unit]

    References
    ----------
    docs/validation.md, "Restitution is a spread".
    """
    low, high = ends
    if low == high:
        return low * np.maximum(1.0 + relative * draws, 0.1)
    return low + (high - low) / (1.0 + np.exp(-1.702 * draws))  # the normal distribution to 0.01


def _upward(quaternions: Floats, principal: Floats) -> Any:
    """Return the side that points up most, for (..., 4) attitudes along principal axes.

    The entries index ``FACE_NAMES``.
    """
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    up = np.stack([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)], axis=-1)
    along = np.einsum("...j,ij->...i", up, principal)
    axis = np.argmax(np.abs(along), axis=-1)
    return 2 * axis + (np.take_along_axis(along, axis[..., None], axis=-1)[..., 0] > 0.0)
