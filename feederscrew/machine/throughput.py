"""The stroke that brings a wanted number of parts a minute."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.errors import ArgumentError, FeederError
from feederscrew.machine.stroke import greatest_amplitude
from feederscrew.rates import well_oriented

STROKE_SAMPLES = 120  # strokes that are looked at
CONSTANT_LOAD = (1.0,)  # of a bowl that does not change
STROKE_BISECTIONS = 40
CLIMB_BISECTIONS = 30  # halvings of the search for the steepest climb
MAX_CLIMB_RAD = np.radians(45.0)


@dataclass(frozen=True)
class Flow:
    """What leaves the bowl, for one metre of track."""

    parts: float  # [1/m] counted parts on a length of track
    share: float  # [1] of all parts that climb the track, those that are counted
    length: float  # [m] mean length along the track of a part


def flow(
    found: well_oriented.Orientations,
    rule: str,
    *,
    target: tuple[str, float] | None = None,
    gap: float = 0.0,
    fill: float = 1.0,
) -> Flow:
    """Compute how many parts a length of track delivers.

    Source: docs/bowl.md, "1. The part, and the rate".

    Parameters
    ----------
    found : Orientations
        On the track, through the devices.
    rule : str
        Whose probabilities are taken.
    target : (str, float [rad]), optional
        Aspect and heading that count; without it, every orientation that stays on the track and that the
        devices let pass.
    gap : float [m]
    fill : float [1]

    Returns
    -------
    Flow

    Raises
    ------
    FeederError
        If nothing leaves.
    """
    if target is not None:
        parts = well_oriented.parts_per_metre(found, target, rule, gap=gap, fill=fill)
        row = list(zip(found.aspects, found.headings)).index(target)
        return Flow(
            parts, well_oriented.efficiency(found, row, rule), float(well_oriented.fed(found, row).length)
        )
    chances = np.nan_to_num(found.rules[rule])
    leaving = float((chances * found.leaves).sum())
    if not leaving > 0.0 and float((chances * found.through).sum()) > 0.0:
        raise FeederError(
            "track.climb", f"the part {well_oriented.ROLLS_BACK_REMARK}", well_oriented.HOLD_ADVICE
        )
    if not leaving > 0.0:
        raise FeederError("devices", "let no part pass", "see what each returns in feeder rate")
    share, length = leaving / float((chances * found.stays).sum()), well_oriented.mean_length(found, rule)
    return Flow(fill * share / (length + gap), share, length)


def amplitude_for(
    bowl: Bowl, velocity: float, strokes: Any = CONSTANT_LOAD, angles: Any = None
) -> tuple[tuple[float, float] | None, tuple[float, float]]:
    """Return the smallest stroke from which on a part travels at least so fast.

    Source: docs/bowl.md, "1. The part, and the rate"; the strokes are those of
    "Why it feeds 220 for half a minute and then 165".

    Parameters
    ----------
    bowl : Bowl
        Its amplitude is not used.
    velocity : float [m/s]
    strokes : (N,) float [1]
        Over that stroke, as the bowl empties: at the slowest of them it shall travel so fast.
    angles : (N,) float [rad], optional
        Vibration angle at each of them; that of the bowl without it.

    Returns
    -------
    (float [m], float [m/s]) or None
        Amplitude and velocity there; None where no stroke that drives are built for does.
    (float [m/s], float [m])
        The fastest of all, and its amplitude.

    Notes
    -----
    Where a part hops, velocity does not only grow with the stroke. A stroke is preferred from which on the
    velocity holds over the range that is tuned with the controller; where there is none, the smallest stroke
    that is fast enough is taken.
    """
    amplitudes = greatest_amplitude(bowl) * np.arange(1, STROKE_SAMPLES + 1) / STROKE_SAMPLES
    speeds = _speeds(bowl, amplitudes, strokes, angles)
    best = int(np.argmax(speeds))
    fastest = float(speeds[best]), float(amplitudes[best])
    first = _first(amplitudes, speeds >= velocity, 1.0 + bowl.sizing.retune)
    if first is None:
        return None, fastest
    low, high = (amplitudes[first - 1] if first else 0.0), amplitudes[first]
    for _ in range(STROKE_BISECTIONS):
        middle = 0.5 * (low + high)
        enough = _speeds(bowl, middle, strokes, angles) >= velocity
        low, high = (low, middle) if enough else (middle, high)
    return (float(high), float(_speeds(bowl, high, strokes, angles))), fastest


def _first(amplitudes: np.ndarray, fast: np.ndarray, reach: float) -> Any:
    """The first place from which on all is fast up to ``reach`` times as far; else the first fast one."""
    places = np.flatnonzero(fast)
    for place in places:
        around = (amplitudes >= amplitudes[place]) & (amplitudes <= reach * amplitudes[place])
        if fast[around].all():
            return place
    return places[0] if places.size else None


def steepest(bowl: Bowl) -> float:
    """Return the climb up to which a part travels, the springs left as they are [rad]; NaN for none.

    Source: docs/bowl.md, "How it is computed".
    """
    upright = bowl.drive.vibration_angle + bowl.track.climb

    def travels(climb: float) -> bool:
        drive = replace(bowl.drive, vibration_angle=max(upright - climb, 0.0))
        there = replace(bowl, drive=drive, track=replace(bowl.track, climb=climb))
        return float(answer.cells(there)["velocity"]) > 0.0

    low, high = 0.0, min(MAX_CLIMB_RAD, upright)
    if not travels(low):
        return float("nan")
    for _ in range(CLIMB_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if travels(middle) else (low, middle)
    return low


def unreachable(target: float, parts_per_metre: float, fastest: tuple[float, float]) -> ArgumentError:
    """Return the fault that no stroke brings so many parts, and what the most is."""
    minute = units.factor("/min", "rate")
    speed, amplitude = fastest
    most = f"{max(speed, 0.0) * parts_per_metre / minute:.4g}/min at {2e3 * amplitude:.3g} mm peak to peak"
    what = f"no bowl reaches {target / minute:.6g}/min of this part: the most is {most}"
    return ArgumentError(
        "target", what, "split it over several bowls or tracks, or let more orientations pass"
    )


def _speeds(bowl: Bowl, amplitudes: Any, strokes: Any, angles: Any = None) -> Any:
    """Slowest velocities of strokes as the bowl empties [m/s]; minus infinity where there is none.

    No stroke is beyond what drives are built for: there the magnet strikes.
    """
    each = np.minimum(np.multiply.outer(amplitudes, strokes), greatest_amplitude(bowl))
    drive = replace(bowl.drive, amplitude=each)
    if angles is not None:
        turned: Any = np.broadcast_to(angles, each.shape)
        drive = replace(drive, vibration_angle=turned)
    found = answer.cells(replace(bowl, drive=drive))["velocity"]
    return np.where(np.isfinite(found), found, -np.inf).min(axis=-1)
