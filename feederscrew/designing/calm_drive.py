"""The bowl and the track for a part, and drives that do not make it hop."""

import functools
import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.record import Bowl, Track
from feederscrew.conveying import answer
from feederscrew.dropping.plate.drive import throw_number
from feederscrew.errors import ConfigError
from feederscrew.machine import sizing
from feederscrew.machine.stroke import greatest_amplitude
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects

CALM = 0.9  # throw number below which no part hops, with a reserve for the drive's own scatter
HOPPING = (1.2, 1.5, 1.8)  # throw numbers where no tooling has to be met lying
LIVELY = (1.2, 1.5)  # of the drives out of phase there: nearly twice as fast as below 1
BANKS = tuple(np.radians((3.0, 0.0)))  # bring back to the wall what leaves it
STEEP_BANKS = tuple(np.radians((8.0, 3.0)))  # hold there what rolls
WORST = (0.6, 1.4)  # [1] of the nominal friction
STEADY = 0.6  # of the velocity asked for that is left at the worst friction
LEAST = 0.05  # [m/s] through tooling: what creeps rolls off the wall, or stands at a slot and falls in late
STROKES = {"drive.amplitude", "drive.peak_to_peak"}  # keys that give it
CALMER = 0.45  # of the velocity of a drive that turns or loses what is wanted: two such steps reach ``LEAST``
CALMER_STEP = 0.01  # [1] of the throw number: so much above ``CALM`` counts as that
CALMER_SHARE = 0.9  # of the velocity: what is faster is no calmer drive
HALVINGS = 12  # of the amplitude
STROKE_STEP = 1e-6  # [m] to which an amplitude is rounded
# frequency [Hz], vibration angle and lead of the normal motion [rad]: the simplest drive first
STRAIGHT = tuple((f, math.radians(25.0), 0.0) for f in (50.0,))
ELLIPTIC = tuple(
    (f, math.radians(angle), math.radians(-60.0))
    for f, angle in ((50.0, 16.0), (50.0, 10.0), (40.0, 10.0), (33.0, 10.0), (30.0, 10.0))
)


@dataclass(frozen=True)
class PlainBowl:
    """A bowl without devices, and which of its keys the user gave."""

    bowl: Bowl
    given: frozenset[str]
    size: sizing.Size | None  # None once the bowl has changed


def section(
    part: Part,
    aspects: Aspects,
    plain: Bowl,
    given: Collection[str],
    *,
    diameter: tuple[float, float] | None = None,
    bank: float = BANKS[0],
) -> PlainBowl:
    """Return a bowl that is large enough for every way a part lies.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    plain : Bowl
        What the user gave, completed by the defaults.
    given : collection of str
        Names of the keys the user gave: those are kept.
    diameter : (float, float) [m], optional
        Least and greatest.
    bank : float [rad]
        Of the track, where the user gave none.

    Returns
    -------
    PlainBowl
    """
    rules = plain.sizing
    if diameter is not None:
        rules = replace(rules, least_diameter=diameter[0], greatest_diameter=diameter[1])
    known = {"diameter": "track.radius", "width": "track.width", "climb": "track.climb"}
    kept = {"diameter": 2.0 * plain.track.radius, "width": plain.track.width, "climb": plain.track.climb}
    own = {name: kept[name] for name, key in known.items() if key in given}
    size = sizing.size(sizing.lying(part, aspects), part.source, rules, sorts=True, **own)
    track = Track(
        climb=_tenths(size.climb, np.radians(0.1)) if "climb" not in own else size.climb,
        bank=plain.track.bank if "track.bank" in given else bank,
        radius=0.5 * size.diameter,
        width=size.track_width if "width" in own else _tenths(size.track_width, 1e-4),
    )
    return PlainBowl(replace(plain, track=track, devices=()), frozenset(given), size)


def _tenths(value: float, step: float) -> float:
    return float(np.ceil(value / step - 1e-9) * step)


def driven(made: PlainBowl, velocity: float, *, hops: bool = False) -> Bowl:
    """Return a bowl whose drive carries a point mass at a velocity, or as near to it as it does calmly.

    Parameters
    ----------
    made : PlainBowl
    velocity : float [m/s]
    hops : bool
        Whether parts may hop: there is no tooling.

    Returns
    -------
    Bowl
        With the simplest drive that is fast enough, also at the worst friction, at the least stroke that
        is; else the fastest. Through tooling no slower than ``LEAST``.

    Notes
    -----
    A straight drive below the throw number of 1 carries slowly, and hardly at all where friction is low. Out
    of phase, the surface rises while it moves forward and falls while it moves back: friction itself carries
    the part, several times as fast, and its coefficient hardly matters.

    References
    ----------
    A. H. Redford, G. Boothroyd, "Vibratory feeding", Proc. Inst. Mech. Eng. 182, 135-152, 1967.
    """
    if STROKES & made.given:
        return made.bowl
    tried: list[tuple[float, int, Bowl]] = []
    velocity = velocity if hops else max(velocity, LEAST)
    for bowl in _drives(made, hops):
        fastest = _fast(bowl)
        if fastest >= velocity:
            return _slowed(bowl, velocity)
        tried.append((fastest, -len(tried), bowl))
    return max(tried)[2]


def calmer(made: PlainBowl, bowl: Bowl) -> Bowl | None:
    """Return a bowl with a calmer drive than another one's, ``CALMER`` times as fast and without hops.

    Parameters
    ----------
    made : PlainBowl
        The bowl without devices, as for ``driven``.
    bowl : Bowl
        With the drive that turned or lost a part.

    Returns
    -------
    Bowl or None
        Without devices. None where the user gave the stroke, or none is calmer.
    """
    if STROKES & made.given:
        return None
    found = driven(made, CALMER * speed(bowl))
    gentler = throw_number(bowl) > CALM + CALMER_STEP or speed(found) <= CALMER_SHARE * speed(bowl)
    return found if gentler and 0.0 < throw_number(found) <= CALM + CALMER_STEP else None


def _drives(made: PlainBowl, hops: bool) -> Iterator[Bowl]:
    """Bowls whose drive is as strong as it may be, the simplest first."""
    plain, given = made.bowl, made.given
    kinds = [(CALM, *row) for row in STRAIGHT]
    kinds += [(throw, *STRAIGHT[0]) for throw in HOPPING] if hops else []
    kinds += [(CALM, *row) for row in ELLIPTIC]
    kinds += [(throw, *row) for throw in LIVELY for row in ELLIPTIC] if hops else []
    seen = set()
    for throw, frequency, angle, phase in kinds:
        own = {"frequency": frequency, "vibration_angle": angle, "phase": phase}
        kept = {name: getattr(plain.drive, name) for name in own if f"drive.{name}" in given}
        drive = replace(plain.drive, **own | kept)
        if (throw, drive) in seen:
            continue
        seen.add((throw, drive))
        bowl = replace(plain, drive=drive)
        amplitude = min(drive.amplitude * throw / throw_number(bowl), greatest_amplitude(bowl))
        yield with_amplitude(bowl, amplitude)


def with_amplitude(bowl: Bowl, amplitude: float) -> Bowl:
    """Return a bowl at another amplitude [m], rounded to a micrometre."""
    rounded = float(np.floor(amplitude / STROKE_STEP + 1e-6) * STROKE_STEP)
    return replace(bowl, drive=replace(bowl.drive, amplitude=rounded))


def _slowed(bowl: Bowl, velocity: float) -> Bowl:
    """The bowl at the least amplitude that is as fast as that, and no stronger than it was."""
    low, high = 0.0, bowl.drive.amplitude
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _fast(with_amplitude(bowl, middle)) >= velocity else (middle, high)
    return with_amplitude(bowl, min(high + STROKE_STEP, bowl.drive.amplitude))


def _fast(bowl: Bowl) -> float:
    """The velocity [m/s] that may be asked of a bowl: its own, or less where the worst friction slows it."""
    return min(speed(bowl), slowest(bowl) / STEADY)


def slowest(bowl: Bowl) -> float:
    """Return the velocity of the point mass [m/s] at the worst friction."""
    return min(speed(rubbed(bowl, share)) for share in WORST)


def kept(bowl: Bowl) -> float:
    """Return the share [1] of its velocity that a bowl keeps at the worst friction; 0 where it has none."""
    own = speed(bowl)
    return min(slowest(bowl) / own, 1.0) if own > 0.0 else 0.0


def rubbed(bowl: Bowl, share: float) -> Bowl:
    """Return a bowl with a share of its friction."""
    values = {name: getattr(bowl.friction, name) for name in vars(bowl.friction)}
    scaled: dict = {name: None if value is None else value * share for name, value in values.items()}
    return replace(bowl, friction=replace(bowl.friction, **scaled))


def speed(bowl: Bowl) -> float:
    """Return the velocity of the point mass [m/s]; 0 where the bowl does not convey."""
    return _speed(replace(bowl, devices=()))


@functools.lru_cache(maxsize=4096)
def _speed(bowl: Bowl) -> float:
    try:
        found = answer.answer(bowl).velocity
    except ConfigError:
        return 0.0
    return max(float(found), 0.0) if np.isfinite(found) else 0.0
