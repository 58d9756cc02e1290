"""The bowl and the track for a part, and drives that do not make it hop."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.record import Bowl, Track
from feederscrew.conveying import answer
from feederscrew.dropping.plate.drive import throw_number
from feederscrew.errors import ConfigError
from feederscrew.machine import sizing, throughput

CALM = 0.9  # throw number below which no part hops, with a reserve for the drive's own scatter
HOPPING = (1.2, 1.5, 1.8)  # throw numbers where no tooling has to be met lying
ANGLES = tuple(np.radians((25.0, 20.0, 16.0, 13.0, 10.0)))  # of the drive, the usual first
MAINS = 50.0  # [Hz]
BANK = np.radians(3.0)  # brings back to the wall what leaves it, and holds there what rolls


@dataclass(frozen=True)
class PlainBowl:
    """A bowl without devices, and which of its keys the user gave."""

    bowl: Bowl
    given: frozenset[str]
    size: sizing.Size


def section(part, aspects, plain, given, *, diameter=None, bank=BANK):
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


def _tenths(value, step):
    return float(np.ceil(value / step - 1e-9) * step)


def driven(made, velocity, *, hops=False):
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
        With the steepest drive that is fast enough, else the fastest.
    """
    if "drive.amplitude" in made.given or "drive.peak_to_peak" in made.given:
        return made.bowl
    tried = []
    for bowl in _drives(made, hops):
        fastest = speed(bowl)
        if fastest >= velocity:
            return _slowed(bowl, velocity)
        tried.append((fastest, len(tried), bowl))
    return max(tried)[2]


def _drives(made, hops):
    """Bowls whose drive is as strong as it may be, from the steepest to the flattest."""
    plain, given = made.bowl, made.given
    angles = (plain.drive.vibration_angle,) if "drive.vibration_angle" in given else ANGLES
    frequency = plain.drive.frequency if "drive.frequency" in given else MAINS
    for throw in (CALM, *(HOPPING if hops else ())):
        for angle in angles if throw == CALM else angles[:1]:
            drive = replace(plain.drive, vibration_angle=float(angle), frequency=frequency)
            bowl = replace(plain, drive=drive)
            amplitude = drive.amplitude * throw / throw_number(bowl)
            yield with_amplitude(bowl, amplitude)


def with_amplitude(bowl, amplitude):
    """Return a bowl at another amplitude [m], rounded to a micrometre."""
    return replace(bowl, drive=replace(bowl.drive, amplitude=float(np.round(amplitude, 6))))


def _slowed(bowl, velocity):
    """The bowl at the least amplitude that is as fast as that, and no stronger than it was."""
    found, _ = throughput.amplitude_for(bowl, velocity)
    return bowl if found is None else with_amplitude(bowl, min(found[0], bowl.drive.amplitude))


def speed(bowl):
    """Return the velocity of the point mass [m/s]; 0 where the bowl does not convey."""
    try:
        found = answer.answer(bowl).velocity
    except ConfigError:
        return 0.0
    return max(float(found), 0.0) if np.isfinite(found) else 0.0
