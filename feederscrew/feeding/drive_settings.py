"""Settings of the drive that give a wanted rate, the gentle ones first."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import overload

import numpy as np

from feederscrew.base import units
from feederscrew.base.arrays import Floats, Reals
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.bowl.record import Bowl, BowlGrid
from feederscrew.bowl.schema import BY_NAME, Key
from feederscrew.motion import conveying as answer
from feederscrew.motion.limits import Regime

KNOBS = ("drive.amplitude", "drive.vibration_angle", "drive.frequency")  # turned one at a time
# regimes, the most wanted first
REGIMES_BY_GENTLENESS = (
    Regime.FORWARD,
    Regime.STICK,
    Regime.BOTH,
    Regime.BACKWARD,
    Regime.HOP,
    Regime.NO_STEADY_STATE,
)
KNOB_SAMPLES = 241  # values of a knob that are looked at
HIGHEST_THROW = 3.5  # beyond the best throw number, about 3, velocity falls and rests on chance
KNOB_BISECTIONS = 24  # of a step of KNOB_SAMPLES, to 3e-10 of a knob's range
MAX_RATED_SETTINGS = 20  # settings that are asked what they bring at most
RATE_TOLERANCE = 0.01  # of the rate: no further step is made
DECIDED = 0.03  # of the rate: as near as the parts that decide are asked for, which are known to 5 %
# of the rate: a setting gives it; what arrives is sampled, so that it jumps by a few per cent
ACCEPTED_RATE_ERROR = 0.04
LED = 0.1  # of the rate: a setting led no nearer to it by the bowl's own shares waits for all others
LEADS = 3  # steps that the shares of the bowl's own drive lead
# settings whose arriving parts are simulated, at 2 to 6 s each: in all, and where none gives the rate so far
MAX_SIMULATED = 8
MAX_SIMULATED_IN_VAIN = 16
ROUNDS = 8  # steps towards a setting
REMEMBERED = 3  # those whose parts lead on
SETTING_TOLERANCE = 0.01  # of a value: two settings are one
SETTING_DIGITS = 5  # of a value as it is printed
Density = Callable[[Bowl | None], float]  # [1/m] as ``solutions`` takes it


@dataclass(frozen=True, eq=False)
class Solution:
    """One setting that reaches the wanted velocity; everything else stays as it is."""

    key: Key  # what was turned
    value: float  # [SI]
    answer: answer.Answer
    speed: float  # [m/s] that the target is met with: from rest, or the slowest of every start and surface
    parts_per_metre: float  # [1/m] well-oriented parts on a length of track, with what arrives at that drive

    @property
    def number(self) -> float:
        """Return the value in the key's unit, as it is given back."""
        return float(f"{self.value / units.factor(self.key.unit, self.key.dimension):.12g}")

    @property
    def rate(self) -> float:
        """Return the well-oriented parts [1/s] at that speed."""
        return self.speed * self.parts_per_metre

    @property
    def order(self) -> tuple[int, bool, float]:
        """Return a sort key, the gentle ones first: regime, one velocity before several, softest impact."""
        here = self.answer
        several = here.high - here.low > answer.COEXISTING_VELOCITY_GAP * here.speed
        return REGIMES_BY_GENTLENESS.index(here.regime), several, here.hardest_impact


@dataclass(frozen=True, eq=False)
class FoundSettings:
    """Settings of the drive that give a rate, and how many more may do so."""

    solutions: tuple[Solution, ...]  # the gentle ones first
    skipped: int = 0  # settings of about that velocity whose arriving parts were not simulated


def solutions(
    bowl: Bowl,
    target: float,
    density: Density,
    *,
    rough: Density | None = None,
    sampled: bool = False,
    worst: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> FoundSettings:
    """Return settings of amplitude, angle or frequency alone that give a rate, with what each lets arrive.

    A rate is velocity times well-oriented parts on a length of track. Both depend on the drive, so each
    setting is sought in steps: the velocity that the last density asks for, then the density at that
    velocity. Each solution gives the rate to ``ACCEPTED_RATE_ERROR``; where none does, because the velocity
    jumps over the wanted one, each gives more. One-way and gentle regimes come first. Values are round
    numbers in their unit.

    Parameters
    ----------
    bowl : Bowl
    target : float [1/s]
        Well-oriented parts, above 0: from rest, or with ``worst`` at the slowest of every start and surface,
        as ``well_oriented.velocity``.
    density : callable
        Of a bowl: the well-oriented parts on a length of its track [1/m], with what arrives at its drive and
        without what that turns over. For None: at the bowl's own drive as if it turned over none.
    rough : callable, optional
        The same with what arrives at the bowl's own drive, sooner: it leads to a setting that ``density``
        then decides on.
    sampled : bool
        The parts of ``density`` are simulated. A setting is then known no better than to ``DECIDED``. At most
        ``MAX_SIMULATED`` settings are tried, those of each key in turn; at most ``MAX_SIMULATED_IN_VAIN``
        where none of them gives the rate.
    worst : bool
        Take the slowest velocity of every start and surface, not the one from rest.
    progress : callable, optional
        Called with how many settings are found, and of how many, at first with none.

    Returns
    -------
    FoundSettings

    Raises
    ------
    FeederError
        If no setting gives the rate; the line says what the bowl reaches at most.

    References
    ----------
    docs/conveying.md, "Commands".
    """
    curves = [_Curve.of(bowl, BY_NAME[name], worst) for name in KNOBS]
    if not any(np.isfinite(curve.speeds).any() for curve in curves):
        raise FeederError("track.climb", "is steeper than friction holds", "lower the climb")
    starts = [(curve, value) for curve in curves for value in curve.starts(target / density(None))]
    likely: list[tuple[_Curve, float]] = []
    unlikely: list[tuple[_Curve, float]] = []
    # the bowl's own shares lead from each start, none beside another; those LED to the rate come first
    for curve, value in starts:
        rate = 0.0
        for _ in range(LEADS):
            at = curve.readable(value)
            parts = (rough or density)(turned(bowl, curve.key, at))
            rate = curve.speed(at) * parts
            there = curve.nearest_crossing(value, target / parts) if parts > 0.0 else None
            if abs(rate - target) <= RATE_TOLERANCE * target or there is None:
                break
            value = there
        if not any(
            other.key == curve.key and abs(value - near) <= SETTING_TOLERANCE * near
            for other, near in likely + unlikely
        ):
            (likely if abs(rate - target) <= LED * target else unlikely).append((curve, value))
    likely, unlikely = _keys_in_turn(likely), _keys_in_turn(unlikely)
    close, total = DECIDED if sampled else RATE_TOLERANCE, len(likely + unlikely)
    tried: list[Solution] = []
    near: list[Solution] = []
    simulated = skipped = 0
    if progress:
        progress(0, total)
    for count, (curve, value) in enumerate(likely + unlikely):
        if near and count >= len(likely):
            break
        rounds = ROUNDS
        if sampled:
            rounds = min(ROUNDS, (MAX_SIMULATED if near else MAX_SIMULATED_IN_VAIN) - simulated)
        if rounds <= 0:
            skipped = (len(likely) if near else total) - count
            break
        steps = _steps(curve, value, target, density, close, rounds)
        simulated += len(steps)
        tried.append(_nearest_step(steps, target))
        separate = _separate_solutions(tried, target)
        near = [one for one in separate if abs(one.rate - target) <= ACCEPTED_RATE_ERROR * target]
        if progress:
            progress(count + 1, total)
    accepted = near or [one for one in _separate_solutions(tried, target) if one.rate > target]
    if accepted:
        return FoundSettings(tuple(sorted(accepted, key=lambda solution: solution.order)), skipped)
    # no setting brings so many parts: what is the most
    peaks = [(speed, c.key, value) for c in curves for speed, value in zip(c.speeds, c.values)]
    peaks = sorted((peak for peak in peaks if np.isfinite(peak[0])), key=lambda peak: -peak[0])
    what = f"no setting reaches {target / units.PER_MINUTE:.6g}/min: "
    if skipped:
        what = f"none of {len(tried)} settings that were tried gives {target / units.PER_MINUTE:.6g}/min: "
    most = "at those drives the part can tip over on the track"
    if peaks[0][0] <= 0.0:
        most = "the part never travels up the track"
    for speed, key, value in peaks[:MAX_RATED_SETTINGS] if peaks[0][0] > 0.0 else ():
        parts = density(turned(bowl, key, value))
        if parts > 0.0:
            at_value = f"{key.name} {value / units.factor(key.unit, key.dimension):.4g} {key.unit}"
            most = f"the most is {speed * parts / units.PER_MINUTE:.4g}/min, at {at_value}"
            break
    mend = "lower the target, or change two keys of the drive together"
    raise ArgumentError("target", what + most, mend)


@overload
def turned(bowl: Bowl, key: Key, value: float) -> Bowl: ...
@overload
def turned(bowl: BowlGrid, key: Key, value: Reals) -> BowlGrid: ...
def turned(bowl: BowlGrid, key: Key, value: Reals) -> BowlGrid:
    """Return the bowl with one key of its drive at another value, or at an array of values.

    Parameters
    ----------
    bowl : BowlGrid
    key : Key
        Of the section ``drive``.
    value : float or (V,) float [SI]

    Returns
    -------
    BowlGrid
        Its field of that key is an array where ``value`` is one.
    """
    drive = replace(bowl.drive, **{key.word: value})
    return replace(bowl, drive=drive)


@dataclass(frozen=True, eq=False)
class _Curve:
    """A key, values of it and the velocity at each."""

    bowl: Bowl
    key: Key
    worst: bool
    values: Floats  # (V,) [SI]
    speeds: Floats  # (V,) [m/s]

    @classmethod
    def of(cls, bowl: Bowl, key: Key, worst: bool) -> "_Curve":
        """Return the curve of a knob within its limits and below the highest throw number.

        The throw number grows with amplitude, with the square of the frequency, and with the sine of the
        vibration angle: ``share`` is how far it may grow from here.
        """
        low, high = (units.quantity(limit, key.dimension) for limit in (key.lowest, key.highest))
        drive = bowl.drive
        upright = answer.throw_number(turned(bowl, BY_NAME["drive.vibration_angle"], np.pi / 2))
        share = HIGHEST_THROW / (upright * np.sin(max(drive.vibration_angle, 1e-3)))
        if key.word == "amplitude":
            high = min(high, drive.amplitude * share)
        if key.word == "frequency":
            high = min(high, drive.frequency * np.sqrt(share))
        values = np.linspace(low, high, KNOB_SAMPLES)[1:-1]
        if key.word == "vibration_angle":
            values = values[upright * np.sin(values) <= HIGHEST_THROW]
        return cls(bowl, key, worst, values, _speeds(bowl, key, values, worst))

    def starts(self, velocity: float) -> Floats:
        """Return the values to seek a setting from: where a velocity is passed, else where it is greatest."""
        there = self.crossings(velocity)
        if there.size or not np.isfinite(self.speeds).any() or np.nanmax(self.speeds) <= 0.0:
            return there
        return self.values[[np.nanargmax(self.speeds)]]

    def crossings(self, velocity: float) -> Floats:
        """Return where a velocity is passed (N,): the faster side of it; where it jumps, beyond the jump."""
        above, finite = self.speeds >= velocity, np.isfinite(self.speeds)
        k = np.flatnonzero((above[1:] != above[:-1]) & finite[1:] & finite[:-1])
        low, high, rises = self.values[k], self.values[k + 1], above[k + 1]
        for _ in range(KNOB_BISECTIONS):
            middle = 0.5 * (low + high)
            beyond = (_speeds(self.bowl, self.key, middle, self.worst) >= velocity) == rises
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return np.where(rises, high, low)

    def nearest_crossing(self, value: float, velocity: float) -> float | None:
        """Return the crossing of a velocity that is nearest to a value; None where it is never passed."""
        there = self.crossings(velocity)
        return float(there[np.argmin(np.abs(there - value))]) if there.size else None

    def readable(self, value: float) -> float:
        """Return the value as printed in the key's unit, so that it is the same when it is given back."""
        number = value / units.factor(self.key.unit, self.key.dimension)
        return units.quantity(f"{number:.{SETTING_DIGITS}g} {self.key.unit}", self.key.dimension)

    def speed(self, value: float) -> float:
        """Return the velocity [m/s] at a value."""
        return float(_speeds(self.bowl, self.key, np.array([value]), self.worst)[0])


def _keys_in_turn(starts: list[tuple[_Curve, float]]) -> list[tuple[_Curve, float]]:
    """Return the starts in another order: the first of each key, then the second of each."""
    earlier = [[other.key for other, _ in starts[:k]].count(curve.key) for k, (curve, _) in enumerate(starts)]
    return [starts[k] for k in sorted(range(len(starts)), key=earlier.__getitem__)]


def _steps(
    curve: _Curve, value: float, target: float, density: Density, close: float, most: int
) -> list[Solution]:
    """Return the settings on the way from a start to one that gives the target with what arrives there.

    Each step takes the parts that arrived at the step before it, since another drive brings others. They are
    sampled, so after ``REMEMBERED`` steps the mean of the last ones leads on.
    """
    steps: list[Solution] = []
    last = None
    for _ in range(most):
        jumps = value == last
        own = value if jumps else curve.readable(value)
        driven = turned(curve.bowl, curve.key, own)
        steps.append(Solution(curve.key, own, answer.answer(driven), curve.speed(own), density(driven)))
        if abs(steps[-1].rate - target) <= close * target or jumps or not steps[-1].parts_per_metre > 0.0:
            break
        led = steps[-REMEMBERED:] if len(steps) > REMEMBERED else steps[-1:]
        mean = float(np.mean([step.parts_per_metre for step in led]))
        there = curve.nearest_crossing(value, target / mean)
        if there is None:
            break
        last, value = value, there
    return steps


def _nearest_step(steps: list[Solution], target: float) -> Solution:
    """Return the setting that gives the target, else the nearest that gives more, else the nearest."""
    away = [(abs(step.rate - target), step) for step in steps]
    enough = [pair for pair in away if pair[0] <= ACCEPTED_RATE_ERROR * target or pair[1].rate > target]
    return min(enough or away, key=lambda pair: pair[0])[1]


def _separate_solutions(solutions: list[Solution], target: float) -> list[Solution]:
    """Return the solutions without neighbours of the same key: of those, the nearest to the target."""
    separate: list[Solution] = []
    for solution in sorted(solutions, key=lambda solution: abs(solution.rate - target)):
        values = [other.value for other in separate if other.key == solution.key]
        if all(abs(solution.value - other) > SETTING_TOLERANCE * other for other in values):
            separate.append(solution)
    return separate


def _speeds(bowl: Bowl, key: Key, values: Floats, worst: bool) -> Floats:
    """Return the velocity at each value [m/s]: from rest, or the slowest of every start and surface."""
    there = turned(bowl, key, values)
    here = answer.cells(there)
    if not worst:
        return here["velocity"]
    surfaces = answer.surfaces(there, bool((here["throw_number"] > 1.0).any()))[1:]
    around = [here, *map(answer.cells, surfaces)]
    return np.min([cells["low"] for cells in around], axis=0)  # NaN where one friction has no steady state
