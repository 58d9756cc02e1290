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
FASTEST = 20  # settings that are asked what they bring at most
REACHED = 1e-6  # of the velocity


@dataclass(frozen=True, eq=False)
class Solution:
    """One setting that reaches the wanted velocity; everything else stays as it is."""

    key: Key  # what was turned
    value: float  # [SI]
    answer: answer.Answer
    parts_per_metre: float = np.nan  # [1/m] well-oriented parts on a length of track at that drive

    @property
    def rate(self):
        """Well-oriented parts [1/s]."""
        return self.answer.velocity * self.parts_per_metre

    @property
    def order(self):
        """Sorts the gentle ones first: regime, one velocity before several, softest impact."""
        found = self.answer
        several = found.high - found.low > answer.COEXIST * found.speed
        return GENTLE.index(found.regime), several, found.hardest_impact


def solutions(bowl, target, density):
    """Every setting of amplitude, angle or frequency alone that reaches at least a rate.

    Parameters
    ----------
    bowl : Bowl
    target : float [1/s]
        Well-oriented parts, from rest; above 0.
    density : callable
        From a bowl to the well-oriented parts on a length of its track [1/m], without those that its drive
        turns over; of None, as if it turned over none.

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
    looks = [_look(bowl, BY_NAME[name]) for name in KNOBS]
    asked, found = [density(None)], []
    for parts in asked:  # grows by what is left where a setting turns some over
        for one in _reaching(bowl, looks, target / parts):
            one = replace(one, parts_per_metre=density(turned(bowl, one.key, one.value)))
            if one.parts_per_metre >= (1.0 - REACHED) * parts:
                found.append(one)
            elif one.parts_per_metre > 0.0 and not np.isclose(one.parts_per_metre, asked, atol=0.0).any():
                asked.append(one.parts_per_metre)
    if not found:
        raise _unreachable(bowl, looks, target, density)
    return sorted(found, key=lambda one: (one.rate > (1.0 + REACHED) * target, *one.order))


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


def _look(bowl, key):
    """A key, its values and the velocity at each [m/s]."""
    values = _values(bowl, key)
    return key, values, _speeds(bowl, key, values)


def _reaching(bowl, looks, velocity):
    """Every setting that travels at least so fast."""
    fast = [one for look in looks for one in _crossings(bowl, *look, velocity)]
    return [one for one in fast if one.answer.velocity >= (1.0 - REACHED) * velocity]


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


def _unreachable(bowl, looks, target, density):
    """The fault that no setting brings so many parts, and what is the most."""
    peaks = [(speed, key, value) for key, values, speeds in looks for speed, value in zip(speeds, values)]
    peaks = sorted((peak for peak in peaks if np.isfinite(peak[0])), key=lambda peak: -peak[0])
    if not peaks:
        return FeederError("track.climb", "is steeper than friction holds", "lower the climb")
    per_minute = units.factor("/min", "rate")
    what = f"no setting reaches {target / per_minute:.6g}/min"
    mend = "lower the target, or change two keys of the drive together"
    if peaks[0][0] <= 0.0:
        return ArgumentError("target", f"{what}: the part never travels up the track", mend)
    for speed, key, value in peaks[:FASTEST]:
        parts = density(turned(bowl, key, value))
        if parts > 0.0:
            at = f"{key.name} {value / units.factor(key.unit, key.dimension):.4g} {key.unit}"
            most = f"the most is {speed * parts / per_minute:.4g}/min, at {at}"
            return ArgumentError("target", f"{what}: {most}", mend)
    return ArgumentError("target", f"{what}: at those drives the part can tip over on the track", mend)
