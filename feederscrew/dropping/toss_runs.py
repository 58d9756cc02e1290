"""Tosses followed one by one from a given state, over small changes of what is not known of each."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew import check
from feederscrew.conveying.sensitivity import RESTITUTION_DOUBT
from feederscrew.dropping.kernel import body, one_drop
from feederscrew.dropping.launch_file import FACES
from feederscrew.dropping.launches import lowest_points
from feederscrew.dropping.pool import in_batches
from feederscrew.dropping.rigid_body import principal_axes, shape_of_part
from feederscrew.errors import FeederError
from feederscrew.units import GRAVITY

USUAL = 64  # runs of each toss
BATCH = 4  # tosses a core takes at a time
DRAWS = 11  # normal numbers a run takes: 3 velocity, 3 spin, 3 attitude, restitution, friction
SUNK = 0.02  # [1] of the part's length: a launch may begin so far below the plane, by the error of its pose
FRICTION = 0.2  # relative standard deviation of a coefficient of friction (assumption)
MODEL_DOUBT = 2.4  # [1] what the model leaves out, as so many times what a picture of the camera leaves open


@dataclass(frozen=True)
class SurfaceRanges:
    """Restitution and friction of a run: a value that scatters, or the ends of a range."""

    restitution: tuple[float, float]
    friction: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Tosses:
    """Where N tosses lead, each over K runs; the first run of each has the values as given."""

    runs: int
    shares: np.ndarray  # (N, 6) [1] of the settled runs that end with each of FACES up
    faces: np.ndarray  # (N,) index into FACES: what most runs end with; -1 where none settled
    rows: np.ndarray  # (N,) class of the aspect those runs rest on
    places: np.ndarray  # (N, 2) [m] where the centre of mass comes to rest: as given, or the median
    spreads: np.ndarray  # (N,) [m] half of those runs end so near that place
    times: np.ndarray  # (N,) [s] until rest, the median of those runs
    settled: np.ndarray  # (N,) int, runs that came to rest
    released: np.ndarray  # (N,) index into FACES: what points up most at the launch
    partial: bool  # stopped by the user before all were done


def follow(part, found, launches, surface, rng, *, runs=USUAL, jobs=1, progress=None):
    """Follow each launch of a file until the part lies still, again and again with small changes.

    Parameters
    ----------
    part : Part
        From a mesh.
    found : Ground
        Of that part.
    launches : LaunchFile
    surface : SurfaceRanges
    rng : numpy.random.Generator
        A launch gets the same numbers whatever the number of jobs.
    runs : int
        Of each launch.
    jobs : int
    progress : function, optional
        Told how many launches are done, and of how many.

    Returns
    -------
    Tosses

    Raises
    ------
    FeederError
        If a launch begins below the plane.

    Notes
    -----
    What is not known: the restitution and friction of this toss (RESTITUTION_DOUBT, FRICTION), and the state
    one picture of the camera. In that time gravity changes a velocity by g times the time, and spin turns the
    part by the spin times the time: velocities, those of a point at half the part's length from the centre,
    and attitudes scatter as a value does that is anywhere in such an interval, by 1 / sqrt(12) of it. Rigid
    corners and one coefficient are not what happens: MODEL_DOUBT times as much makes the mean ``p`` of every
    other filmed toss the share that comes true (source: docs/validation.md, "Filmed tosses of a cube").
    """
    shape, length = shape_of_part(part, found)
    principal = principal_axes(part.inertia)[1]
    states = _states(launches, length, principal)
    _above_the_plane(shape, length, launches, states)
    draws = rng.standard_normal((len(states), runs, DRAWS))
    draws[:, 0] = 0.0  # as given
    uncertain = _uncertain(launches, length)

    def batch(cut):
        work = one_drop.scratch(shape)
        answers = [
            _toss(shape, work, *_varied(states[n], uncertain[n], surface, draws[n]))
            for n in range(cut.start, cut.stop)
        ]
        return [np.stack(column) for column in zip(*answers)]

    tell = None if progress is None else lambda done: progress(done, len(states))
    (ends, faces, times), partial = in_batches(batch, len(states), BATCH, jobs, tell)
    return _summed(launches, length, principal, found.rows, runs, (ends, faces, times), partial)


def _states(launches, length, principal):
    """(N, 13) states as the kernel has them: along the principal axes, without dimensions."""
    turns = _rotations(launches.attitudes) * Rotation.from_matrix(np.array(principal))
    states = np.zeros((len(launches.names), body.STATE))
    states[:, : body.VX] = launches.positions / length
    states[:, body.VX : body.Q] = launches.velocities / np.sqrt(GRAVITY * length)
    states[:, body.Q : body.W] = np.roll(turns.as_quat(), 1, axis=1)
    states[:, body.W :] = np.einsum("ni,ij->nj", launches.spins, principal) / np.sqrt(GRAVITY / length)
    return states


def _rotations(quaternions):
    """Rotations from the part's axes to the plane's, of (N, 4) quaternions w x y z."""
    return Rotation.from_quat(np.roll(quaternions, -1, axis=-1))


def _above_the_plane(shape, length, launches, states):
    """Raise a fault for the first launch that begins in the plane."""
    lowest = states[:, body.Z] + lowest_points(shape, states[:, body.Q : body.W])
    below = np.flatnonzero(lowest < -SUNK)
    if len(below):
        where = f"{launches.source}:{launches.lines[below[0]]}"
        what = f"the launch begins {-1e3 * length * lowest[below[0]]:.3g} mm below the plane"
        raise FeederError(where, what, "give x0_m, y0_m, z0_m of the centre of mass over the plane z = 0")


def _uncertain(launches, length):
    """(N, 3) standard deviations, without dimensions: of velocities, spins and the attitude [rad]."""
    quick = MODEL_DOUBT * launches.frame / np.sqrt(12.0)
    velocity = GRAVITY * quick / np.sqrt(GRAVITY * length)
    turning = quick * np.sqrt((launches.spins**2).sum(axis=1))
    return np.stack([np.full_like(turning, velocity), np.full_like(turning, 2.0 * velocity), turning], axis=1)


def _varied(state, uncertain, surface, draws):
    """(K, 13) states, (K,) restitutions and (K,) frictions of the runs of one toss."""
    states = np.repeat(state[None], len(draws), axis=0)
    states[:, body.VX : body.Q] += uncertain[0] * draws[:, 0:3]
    states[:, body.W :] += uncertain[1] * draws[:, 3:6]
    turns = _rotations(states[:, body.Q : body.W]) * Rotation.from_rotvec(uncertain[2] * draws[:, 6:9])
    states[:, body.Q : body.W] = np.roll(turns.as_quat(), 1, axis=1)
    bounce = scattered(surface.restitution, RESTITUTION_DOUBT, draws[:, 9])
    return states, np.clip(bounce, 0.0, 1.0), scattered(surface.friction, FRICTION, draws[:, 10])


def scattered(ends, relative, draws):
    """Return values of what is known as one value or as a range.

    Source: docs/validation.md, "Restitution is a spread".

    Parameters
    ----------
    ends : (float, float) [that of the value]
        Equal for one value.
    relative : float [1]
        Standard deviation of one value, over it.
    draws : (K,) float [1]
        Normal numbers; 0 gives the value, or the middle of the range.

    Returns
    -------
    (K,) float [that of the value]
        About one value normal, not below a tenth of it; in a range as good as uniform.
    """
    low, high = ends
    if low == high:
        return low * np.maximum(1.0 + relative * draws, 0.1)
    return low + (high - low) / (1.0 + np.exp(-1.702 * draws))  # the normal distribution to 0.01


def _toss(shape, work, states, restitutions, frictions):
    """(K, 13) ends, (K,) faces and (K,) times of the runs of one toss."""
    steps, count = one_drop.Steps(early=False), len(states)
    ends, faces, times = np.zeros_like(states), np.zeros(count, int), np.zeros(count)
    for k in range(count):
        work.state[:] = states[k]
        faces[k], times[k], _ = one_drop.settle(shape, work, restitutions[k], frictions[k], steps)
        ends[k] = work.state
    return ends, faces, times


def _summed(launches, length, principal, rows, runs, answers, partial):
    """The runs of each toss as one answer."""
    ends, faces, times = answers
    count = len(ends)
    ups = _upward(ends[:, :, body.Q : body.W], principal)
    shares, best = np.zeros((count, len(FACES))), np.full(count, -1)
    sides = [np.full(count, -1), np.full((count, 2), np.nan), np.full(count, np.nan), np.full(count, np.nan)]
    second = np.sqrt(length / GRAVITY)
    for n in range(count):
        calm = faces[n] != one_drop.UNSETTLED
        if not calm.any():
            continue
        counts = np.bincount(ups[n][calm], minlength=len(FACES))
        shares[n] = counts / calm.sum()
        first = ups[n][np.argmax(calm)]
        best[n] = first if counts[first] == counts.max() else np.argmax(counts)
        chosen = calm & (ups[n] == best[n])
        spots = length * ends[n, chosen, :2]
        sides[0][n] = np.bincount(rows[faces[n][chosen]]).argmax()
        sides[1][n] = length * ends[n, 0, :2] if chosen[0] else np.median(spots, axis=0)
        sides[2][n] = np.median(np.hypot(*(spots - sides[1][n]).T))
        sides[3][n] = second * np.median(times[n][chosen])
    released = _upward(launches.attitudes[:count], np.eye(3))
    settled = (faces != one_drop.UNSETTLED).sum(axis=1)
    shares, best, lain, places, spreads, seconds, settled, released = (
        check.frozen(array) for array in (shares, best, *sides, settled, released)
    )
    return Tosses(runs, shares, best, lain, places, spreads, seconds, settled, released, partial)


def _upward(quaternions, principal):
    """Index into FACES of the side that points up most, for (..., 4) attitudes along principal axes."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    up = np.stack([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)], axis=-1)
    along = np.einsum("...j,ij->...i", up, principal)
    axis = np.argmax(np.abs(along), axis=-1)
    return 2 * axis + (np.take_along_axis(along, axis[..., None], axis=-1)[..., 0] > 0.0)
