"""The plain functions of this folder, compiled: many settings at a time, on every core."""

import functools
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.conveying import operating_point, point_motion, steady, waves
from feederscrew.conveying.operating_point import OperatingPoint, checked
from feederscrew.conveying.steady import COLUMNS, survey
from feederscrew.geometry.compiled import compiled as inlined
from feederscrew.geometry.compiled import entry, on_disk, outlined

IN_A_PERIOD = (  # what follows a part through a period of the drive: compiled into one piece
    *(waves.value, waves.after, waves.above, waves.onward, waves.reached),
    *(waves.gain, waves._beyond_sine, waves._beyond_cosine),
    *(
        operating_point.contact,
        point_motion.later,
        point_motion.slip_end,
        point_motion._stop,
        point_motion.landing,
    ),
    *(point_motion._descent, point_motion._beyond_bounce, point_motion._dip),
    *(point_motion.step, point_motion._ride, point_motion._slide, point_motion._fly, point_motion.land),
)
KERNEL = (
    *(waves.height, waves.slope, waves._knots, waves.find_bends, waves.crest),
    *(waves.crossings, waves._insert, waves._zero, waves.harmonic, waves.peak, waves.travel),
    *(
        operating_point.law,
        operating_point.lift_wave,
        operating_point.pull_wave,
        operating_point._pull,
        operating_point.throw_number,
        point_motion.at_rest,
        point_motion.turn,
    ),
    *(steady.settle, steady.follow, steady.noted, steady.evenly, steady._joins, steady._leap),
    *(steady._slid_forward, steady._repeats, steady._normal_apart, steady._grows),
    *(steady._period_of_normal, steady._hasten, steady._closed_in, steady._at_speed),
    *(steady._on, steady._runs),
    *(steady.steady, steady._steady, steady._cycle, steady._long_run, steady._noted_turn, steady._slid),
    *(steady.escape, steady._state_distance, steady._averages, steady.survey, steady.regime, steady._nothing),
    *(steady._widen, steady.thrown, steady.plate_speed),
)
SETTINGS_A_LOT = 256  # settings handed to a core at a time: their costs differ a hundredfold


def sweep(settings, workers=None) -> NDArray[np.float64]:
    """Compute the steady motion of many settings, as ``steady.survey`` does for one.

    Source: docs/conveying.md, "How it is computed".

    Parameters
    ----------
    settings : (N, 12) float [1 and rad, as OperatingPoint]
        One ``OperatingPoint`` a row.
    workers : int, optional
        Threads; by default one a core.

    Returns
    -------
    (N, 17) float [as of ``steady.survey``]
        Rows as ``steady.survey`` fills them.

    Raises
    ------
    ValueError
        If a shape is wrong, an entry is not finite, or a row is not a track.

    Notes
    -----
    The first call on a machine compiles for some seconds and keeps the result on disk; ``compiled`` tells
    whether that has been done.
    """
    settings = check.shaped("settings", settings, (-1, len(OperatingPoint._fields)))
    for row in settings[np.unique(_suspects(settings))]:
        checked(OperatingPoint(*row))
    out = np.empty((len(settings), COLUMNS))
    starts = range(0, len(settings), SETTINGS_A_LOT)
    run = _compiled()
    run(settings[:0], out[:0])
    if len(settings) <= SETTINGS_A_LOT:
        run(settings, out)
        return out
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        list(
            pool.map(
                lambda at: run(settings[at : at + SETTINGS_A_LOT], out[at : at + SETTINGS_A_LOT]), starts
            )
        )
    return out


def compiled() -> bool:
    """Tell whether the compiled functions are already on disk, or numba is set not to compile."""
    return on_disk(_compiled())


def _suspects(settings) -> NDArray[np.int64]:
    """Rows that could fail ``setting.checked``, found at once."""
    s = OperatingPoint(*settings.T)
    bad = (s.ratio <= 0.0) | (s.angle < 0.0) | (s.angle > np.pi / 2)
    bad |= (s.kinetic > s.static) | (s.kinetic_back > s.static_back)
    bad |= np.minimum(s.kinetic, s.kinetic_back) < 0.0
    bad |= (s.restitution < 0.0) | (s.restitution >= 1.0)
    return np.flatnonzero(bad)


@functools.cache
def _compiled():
    """The loop over settings, compiled with every function it reaches."""
    for functions, mark in ((IN_A_PERIOD, inlined), (KERNEL, outlined)):
        for function in functions:
            mark(function, arrays=True)
    return entry(_loop, arrays=True)


def _loop(settings, out) -> None:
    for row in range(len(settings)):
        s = settings[row]
        drive = s[8], s[9], s[10], s[11]
        survey(OperatingPoint(s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], *drive), out[row])
