"""Settings of the drive that reach a wanted velocity, the gentle ones first."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import units
from feederscrew.bowl.schema import BY_NAME, Key
from feederscrew.conveying import answer
from feederscrew.errors import ArgumentError, FeederError

KNOBS = ("drive.amplitude", "drive.vibration_angle", "drive.frequency")  # turned one at a time
GENTLE = ("forward", "stick", "both", "backward", "hop", "no steady state")  # regimes, the most wanted first
STEPS = 241  # values of a knob that are looked at
HIGHEST_THROW = 3.5  # beyond the best throw number, about 3, velocity falls and rests on chance
HALVINGS = 45
REACHED = 1e-6  # of the velocity


@dataclass(frozen=True, eq=False)
class Solution:
    """One setting that reaches the wanted velocity; everything else stays as it is."""

    key: Key  # what was turned
    value: float  # [SI]
    answer: answer.Answer

    @property
    def order(self):
        """Sorts the gentle ones first: regime, one velocity before several, softest impact."""
        found = self.answer
        several = found.high - found.low > answer.COEXIST * found.speed
        return GENTLE.index(found.regime), several, found.hardest_impact


def solutions(bowl, target, parts_per_metre):
    """Every setting of amplitude, angle or frequency alone that reaches at least a rate.

    Parameters
    ----------
    bowl : Bowl
    target : float [1/s]
        Well-oriented parts, from rest; above 0.
    parts_per_metre : float [1/m]
        From ``rate.parts_per_metre``.

    Returns
    -------
    list of Solution
        Each reaches at least the rate: more of it where the velocity jumps over the wanted one; those come
        last. One-way and gentle regimes first.

    Raises
    ------
    FeederError
        If none does; the line says what the bowl reaches at most.
    """
    velocity, found, peaks = target / parts_per_metre, [], []
    for name in KNOBS:
        key, values = BY_NAME[name], _values(bowl, BY_NAME[name])
        speeds = _speeds(bowl, key, values)
        fast = _crossings(bowl, key, values, speeds, velocity)
        found += [one for one in fast if one.answer.velocity >= (1.0 - REACHED) * velocity]
        peaks += [(speed, key, value) for speed, value in zip(speeds, values) if np.isfinite(speed)]
    if not found:
        raise _unreachable(target, parts_per_metre, max(peaks, key=lambda peak: peak[0], default=None))
    return sorted(found, key=lambda one: (one.answer.velocity > (1.0 + REACHED) * velocity, *one.order))


def turned(bowl, key, value):
    """The bowl with one key of its drive at another value, or at an array of them."""
    return replace(bowl, drive=replace(bowl.drive, **{key.word: value}))


def _values(bowl, key):
    """Values of a knob worth looking at: within its limits and below the highest throw number."""
    low, high = (units.quantity(limit, key.dimension) for limit in (key.lowest, key.highest))
    drive = bowl.drive
    upright = answer.throw_number(turned(bowl, BY_NAME["drive.vibration_angle"], np.pi / 2))
    share = HIGHEST_THROW / (upright * np.sin(max(drive.vibration_angle, 1e-3)))
    if key.word == "amplitude":
        high = min(high, drive.amplitude * share)
    if key.word == "frequency":
        high = min(high, drive.frequency * np.sqrt(share))
    values = np.linspace(low, high, STEPS)[1:-1]
    throw = upright * np.sin(values)
    return values[throw <= HIGHEST_THROW] if key.word == "vibration_angle" else values


def _speeds(bowl, key, values):
    return answer.cells(turned(bowl, key, values))["velocity"]


def _crossings(bowl, key, values, speeds, velocity):
    """Where a velocity is passed: the faster side of it, beyond a jump where it jumps over the wanted one."""
    above, known = speeds >= velocity, np.isfinite(speeds)
    k = np.flatnonzero((above[1:] != above[:-1]) & known[1:] & known[:-1])
    low, high, rises = values[k], values[k + 1], above[k + 1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        beyond = (_speeds(bowl, key, middle) >= velocity) == rises
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    fast = np.where(rises, high, low)
    return [Solution(key, float(value), answer.answer(turned(bowl, key, value))) for value in fast]


def _unreachable(target, parts_per_metre, peak):
    """The fault that no setting is fast enough, and what is the most."""
    if peak is None:
        return FeederError("track.climb", "is steeper than friction holds", "lower the climb")
    speed, key, value = peak
    per_minute = units.factor("/min", "rate")
    most = f"{speed * parts_per_metre / per_minute:.4g}/min"
    at = f"{key.name} {value / units.factor(key.unit, key.dimension):.4g} {key.unit}"
    what = f"no setting reaches {target / per_minute:.6g}/min: the most is {most}, at {at}"
    if speed <= 0.0:
        what = f"no setting reaches {target / per_minute:.6g}/min: the part never travels up the track"
    return ArgumentError("target", what, "lower the target, or change two keys of the drive together")
