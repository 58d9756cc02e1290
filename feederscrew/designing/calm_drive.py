"""The bowl and the track for a part, and the calmest drive that is fast enough for it."""

import enum
import functools
import itertools
import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base.errors import ConfigError
from feederscrew.bowl.reading import has_machine
from feederscrew.bowl.record import Bowl, Track, vibration_angle
from feederscrew.machine import drive_sizing, sizing
from feederscrew.machine.drive_sizing import is_two_axis
from feederscrew.machine.springs import analyse_springs, greatest_amplitude
from feederscrew.motion import conveying as answer
from feederscrew.motion.hop import hop
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects

CALM_THROW_NUMBER = 0.9  # throw number below which no part hops, with a reserve for the drive's own scatter
# of leaf-spring drives; above 3.3 flights last longer
THROW_NUMBERS = (CALM_THROW_NUMBER, 1.3, 1.5, 1.8, 2.0, 2.3, 2.6, 3.0)
TRACK_ANGLES = tuple(math.radians(angle) for angle in (15.0, 20.0, 25.0, 30.0))  # at the track, usual ones
# that a frequency controller may be set to
CONTROLLED_HZ = (30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 120.0, 140.0)
WAVES = (1.0, 2.0)  # half wave and full wave of the mains
BANKS = tuple(np.radians((3.0, 0.0)))  # bring back to the wall what leaves it
STEEP_BANKS = tuple(np.radians((8.0, 3.0)))  # hold there what rolls
WORST = (0.6, 1.4)  # [1] of the nominal friction
LEAST_VELOCITY_KEPT = 0.6  # of the velocity asked for that is left at the worst friction
# through tooling: what creeps rolls off the wall, or stands at a slot and falls in late
LEAST_VELOCITY_M_S = 0.05
STROKES = {"drive.amplitude", "drive.peak_to_peak"}  # keys that give it
CALMER = 0.45  # of the velocity, of a calm drive that turns or loses what is wanted
CALMER_HOP = 0.5  # of the hop, of a drive that throws the part: half the energy of a landing
LIVELIER_HOP = 2.5  # times the hop, of a drive that shakes off a blade what stays there at a calmer one
LEAST_LIVELY_M = 1e-4  # hop of such a drive at least
NEXT_LIVELIER_HOP = 1.6  # times the hop, one throw number of the list farther: before another blade is tried
CALMER_STEP = 0.01  # [1] of the throw number: so much above ``CALM_THROW_NUMBER`` counts as that
CALMER_SHARE = 0.9  # of the velocity: what is faster is no calmer drive
# [deg] of the vibration angle, where no springs make the one that holds
FLATTER_STEP = 5.0  # between two that are tried: nearer ones are alike
FLATTEST_ANGLE = 5  # flatter drives carry parts by friction alone, and slowly
HALVINGS = 12  # of the amplitude
STROKE_STEP = 1e-6  # [m] to which an amplitude is rounded
LIVELY = (1.2, 1.5)  # throw numbers of two-axis drives without tooling: nearly twice as fast as below 1
# frequency [Hz], vibration angle and lead of the normal motion [rad] of two-axis drives
ELLIPTIC = tuple(
    (f, math.radians(angle), math.radians(-60.0))
    for f, angle in ((50.0, 16.0), (50.0, 10.0), (40.0, 10.0), (33.0, 10.0), (30.0, 10.0))
)


class DriveKind(enum.StrEnum):
    """Kinds of drive that may be asked for."""

    LEAF_SPRING = "leaf-spring"  # one magnet along one set of springs
    TWO_AXIS = "two-axis"  # two magnets
    ANY = "any"  # leaf springs first


@dataclass(frozen=True)
class PlainBowl:
    """A bowl without devices, and which of its keys the user gave."""

    bowl: Bowl
    kept_keys: frozenset[str]
    drive: DriveKind = DriveKind.LEAF_SPRING  # that is asked for

    def keeps(self, key: str) -> bool:
        """Tell whether the user gave a key of the bowl file.

        Parameters
        ----------
        key : str
            Its name, 'drive.amplitude'.

        Returns
        -------
        bool
        """
        return key in self.kept_keys

    @property
    def has_stroke(self) -> bool:
        """Tell whether the user gave the stroke."""
        return bool(STROKES & self.kept_keys)


def section(
    part: Part,
    aspects: Aspects,
    plain: Bowl,
    kept_keys: Collection[str],
    *,
    diameter: tuple[float, float] | None = None,
    bank: float = BANKS[0],
    drive: DriveKind = DriveKind.LEAF_SPRING,
) -> PlainBowl:
    """Return a bowl that is large enough for every way a part lies.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    plain : Bowl
        As the user gave it, completed by the defaults.
    kept_keys : collection of str
        Names of keys that are kept of it.
    diameter : (float, float) [m], optional
        Between which the bowl's diameter is chosen.
    bank : float [rad], optional
        Of the track where the user gave none.
    drive : DriveKind, optional
        The kind asked for.

    Returns
    -------
    PlainBowl

    Raises
    ------
    FeederError
        If the part fits no bowl.
    """
    rules = plain.sizing
    if diameter is not None:
        rules = replace(rules, least_diameter=diameter[0], greatest_diameter=diameter[1])
    given = PlainBowl(plain, frozenset(kept_keys), drive)
    diameter_given = 2.0 * plain.track.radius if given.keeps("track.radius") else None
    width_given = plain.track.width if given.keeps("track.width") else None
    climb_given = plain.track.climb if given.keeps("track.climb") else None
    size = sizing.size_bowl(
        sizing.find_lying(part, aspects),
        part.source,
        rules,
        sorts=True,
        diameter=diameter_given,
        width=width_given,
        climb=climb_given,
    )

    def tenths(value: float, step: float) -> float:
        return float(np.ceil(value / step - 1e-9) * step)

    track = Track(
        climb=tenths(size.climb, np.radians(0.1)) if climb_given is None else size.climb,
        bank=plain.track.bank if given.keeps("track.bank") else bank,
        radius=0.5 * size.diameter,
        width=tenths(size.track_width, 1e-4) if width_given is None else size.track_width,
    )
    return replace(given, bowl=replace(plain, track=track, devices=()))


@functools.lru_cache(maxsize=256)
def drive_at(plain_bowl: PlainBowl, velocity: float, *, hops: bool = False) -> Bowl:
    """Return a bowl with the calmest drive that carries a point mass at a velocity.

    Of the drives that the machine can make it is the one of the lowest hop, and of these the one of the least
    stroke, that is as fast as asked for, and at the worst friction ``LEAST_VELOCITY_KEPT`` times that; else,
    or where the velocity is infinite, the fastest. It keeps to the usual speeds, ``sizing.slowest`` to
    ``sizing.fastest``. Through tooling it is no slower than ``LEAST_VELOCITY_M_S``. What the user gave of the
    drive is kept.

    The hop is the lower the higher the frequency, by its square (``motion.hop``): twice the mains
    frequency comes first where it is fast enough. Below the throw number of 1 a leaf-spring drive carries
    slowly; from 2.2 to 3 it is three to six times as fast, and friction hardly matters.

    Parameters
    ----------
    plain_bowl : PlainBowl
    velocity : float [m/s]
    hops : bool, optional
        Whether there is no tooling.

    Returns
    -------
    Bowl

    References
    ----------
    A. H. Redford, G. Boothroyd, "Vibratory feeding", Proc. Inst. Mech. Eng. 182, 135-152, 1967;
    docs/design.md.
    """
    velocity = max(velocity, plain_bowl.bowl.sizing.slowest if hops else LEAST_VELOCITY_M_S)
    levels = _levels(plain_bowl, hops)
    chosen = _calmest(plain_bowl, levels, velocity, _can_build)
    if chosen is None:
        order = sorted(itertools.chain(*levels), key=_fast, reverse=True)  # of equal ones the calmest first
        chosen = next((bowl for bowl in order if _can_build(plain_bowl, bowl)), None)
        if chosen is None:  # no machine makes any: as if one did
            chosen = _calmest(plain_bowl, levels, velocity, lambda *_: True) or order[0]
    return chosen


def _calmest(
    plain_bowl: PlainBowl,
    levels: list[list[Bowl]],
    velocity: float,
    can_build: Callable[[PlainBowl, Bowl], bool],
) -> Bowl | None:
    """The calmest bowl of groups of about the same hop that is fast enough; None where none is."""
    for level in levels if math.isfinite(velocity) else ():
        enough = [bowl for bowl in level if _is_fast(bowl, velocity) and can_build(plain_bowl, bowl)]
        if enough:
            least = enough if plain_bowl.has_stroke else [_slow_down(bowl, velocity) for bowl in enough]
            return min(least, key=_calmness)
    return None


def find_calmer(plain_bowl: PlainBowl, bowl: Bowl) -> Bowl | None:
    """Return a bowl with a calmer drive than that of another one, which turned or lost a part.

    Where the part hops: the fastest drive with at most ``CALMER_HOP`` of that hop. Where it does not: a drive
    that is ``CALMER`` times as fast and throws nothing.

    Parameters
    ----------
    plain_bowl : PlainBowl
    bowl : Bowl

    Returns
    -------
    Bowl or None
        Without devices; None where the user gave the stroke, or none is calmer.
    """
    if plain_bowl.has_stroke:
        return None
    height = hop(bowl).height
    if height > 0.0 and not is_two_axis(bowl.drive):
        drives = itertools.chain(*_levels(plain_bowl, True))
        rows = (other for other in drives if hop(other).height <= CALMER_HOP * height)
        order = sorted(rows, key=_fast, reverse=True)
        return next((other for other in order if _fast(other) > 0.0 and _can_build(plain_bowl, other)), None)
    other = drive_at(plain_bowl, CALMER * speed(bowl))
    most = CALM_THROW_NUMBER + CALMER_STEP
    gentler = throw_number(bowl) > most or speed(other) <= CALMER_SHARE * speed(bowl)
    return other if gentler and 0.0 < throw_number(other) <= most else None


def find_livelier(
    plain_bowl: PlainBowl, bowl: Bowl, factor: float = LIVELIER_HOP, least: float = LEAST_LIVELY_M
) -> Bowl | None:
    """Return a bowl with the calmest drive that throws parts so many times as high as another one's.

    Parameters
    ----------
    plain_bowl : PlainBowl
    bowl : Bowl
        With the drive at which parts stay at a blade.
    factor : float [1]
        Hop over that of the other drive, at least.
    least : float [m]
        Hop at least.

    Returns
    -------
    Bowl or None
        Without devices; None where the user gave the stroke, or no drive is that lively.
    """
    height = max(factor * hop(bowl).height, least)
    if plain_bowl.has_stroke:
        return None
    order = sorted(itertools.chain(*_levels(plain_bowl, True)), key=_calmness)
    rows = (other for other in order if hop(other).height >= height and speed(other) > 0.0)
    return next((other for other in rows if _can_build(plain_bowl, other)), None)


def find_flatter(plain_bowl: PlainBowl, bowl: Bowl) -> Iterator[Bowl]:
    """Yield a bowl with drives at flatter vibration angles that leaf springs make, the nearest angle first.

    Each is as fast as the drive of the bowl, at its frequency and at no more than its throw number: the least
    amplitude that is. Angles are whole degrees, ``FLATTER_STEP`` apart at least. What the user gave of the
    machine stays; the angle and the stroke of the drive are free.

    Parameters
    ----------
    plain_bowl : PlainBowl
    bowl : Bowl
        With a leaf-spring drive that its machine does not make.

    Yields
    ------
    Bowl
        With the devices of the bowl.
    """
    if is_two_axis(bowl.drive):
        return
    free = plain_bowl.kept_keys - {"drive.vibration_angle", *STROKES}
    velocity, angle = speed(bowl), bowl.drive.vibration_angle
    steepest = math.ceil(math.degrees(angle) - math.degrees(drive_sizing.SAME_ANGLE)) - 1
    last = math.inf
    for degrees in range(steepest, FLATTEST_ANGLE - 1, -1):
        if last - degrees < FLATTER_STEP:
            continue
        drive = replace(bowl.drive, vibration_angle=math.radians(degrees))
        livelier = _set_throw_number(replace(bowl, drive=drive), float(throw_number(bowl)))
        under = drive_sizing.machine_on(livelier, free, exact=True)
        if drive_sizing.can_make(replace(livelier, machine=under)) is not None:
            continue  # whatever its stroke: the angle is not that of springs
        flatter = slow_to(livelier, velocity)
        shortfall = drive_sizing.drive_shortfall(replace(flatter, devices=()), free)
        if speed(flatter) >= velocity and not shortfall:
            last = degrees
            yield flatter


def _levels(plain_bowl: PlainBowl, hops: bool) -> list[list[Bowl]]:
    """Drives of the kinds that are asked for, of each in groups of about the same hop, the calmest first."""
    drive, levels = plain_bowl.drive, list[list[Bowl]]()
    if plain_bowl.keeps("drive.phase"):
        two_axis = is_two_axis(plain_bowl.bowl.drive)
        drive = DriveKind.TWO_AXIS if two_axis else DriveKind.LEAF_SPRING
    if drive in (DriveKind.LEAF_SPRING, DriveKind.ANY):
        order = sorted(_usual(plain_bowl, set(_leaf_spring_drives(plain_bowl))), key=_calmness)
        levels += [list(group) for _, group in itertools.groupby(order, key=lambda bowl: _calmness(bowl)[0])]
    if drive in (DriveKind.TWO_AXIS, DriveKind.ANY):
        levels += [[bowl] for bowl in _usual(plain_bowl, dict.fromkeys(_two_axis_drives(plain_bowl, hops)))]
    return levels


def _usual(plain_bowl: PlainBowl, bowls: Collection[Bowl]) -> list[Bowl]:
    """Those of some bowls that are no faster than ``sizing.fastest``; the slowest one where all are."""
    if plain_bowl.has_stroke:
        return list(bowls)
    most = plain_bowl.bowl.sizing.fastest
    return [bowl for bowl in bowls if speed(bowl) <= most] or [min(bowls, key=speed)]


def _calmness(bowl: Bowl) -> tuple[float, float]:
    """Height of the hop [m] to two digits, then amplitude [m]: the calmest drive has the least."""
    return float(f"{hop(bowl).height:.2g}"), bowl.drive.amplitude


def _leaf_spring_drives(plain_bowl: PlainBowl) -> Iterator[Bowl]:
    """Every leaf-spring drive that the supply and the springs make."""
    plain, kept_keys = plain_bowl.bowl, plain_bowl.kept_keys
    rules, own_drive = plain.sizing, plain.drive
    # frequencies [Hz] that the supply makes, or the one that the user gave
    frequencies = tuple(wave * rules.mains_frequency for wave in WAVES)
    if plain_bowl.keeps("drive.frequency"):
        frequencies = (own_drive.frequency,)
    elif rules.control == "frequency" and not plain_bowl.keeps("machine.leaves"):
        frequencies = CONTROLLED_HZ
    elif rules.control == "frequency":
        # a controller runs a machine that has its leaves below its natural frequency
        natural = float(analyse_springs(drive_sizing.machine_on(plain, kept_keys)).natural_frequency)
        frequencies = (round(natural / (1.0 + 0.5 * (rules.least_detuning + rules.greatest_detuning)), 1),)
    elif has_machine(kept_keys):
        frequencies = (plain.machine.supply,)
    # vibration angles at the track [rad], or the one that the user's drive or springs make
    angles = TRACK_ANGLES
    if plain_bowl.keeps("drive.vibration_angle"):
        angles = (own_drive.vibration_angle,)
    elif plain_bowl.keeps("machine.spring_angle"):
        machine = drive_sizing.machine_on(plain, kept_keys)
        angles = (float(vibration_angle(machine, plain.track.radius, plain.track.climb)),)
    phase = own_drive.phase if plain_bowl.keeps("drive.phase") else 0.0
    for frequency, angle in itertools.product(frequencies, angles):
        drive = replace(own_drive, frequency=frequency, vibration_angle=angle, phase=phase)
        bowl = replace(plain, drive=drive)
        if plain_bowl.has_stroke:
            yield bowl
        else:
            yield from (_set_throw_number(bowl, throw) for throw in THROW_NUMBERS)


def _two_axis_drives(plain_bowl: PlainBowl, hops: bool) -> Iterator[Bowl]:
    """Every drive with two magnets, the simplest first."""
    plain = plain_bowl.bowl
    throws = (CALM_THROW_NUMBER, *LIVELY) if hops else (CALM_THROW_NUMBER,)
    for throw, row in itertools.product(throws, ELLIPTIC):
        own = dict(zip(("frequency", "vibration_angle", "phase"), row))
        kept = {name: getattr(plain.drive, name) for name in own if f"drive.{name}" in plain_bowl.kept_keys}
        bowl = replace(plain, drive=replace(plain.drive, **own | kept))
        yield bowl if plain_bowl.has_stroke else _set_throw_number(bowl, throw)


def _set_throw_number(bowl: Bowl, throw: float) -> Bowl:
    """The bowl at the amplitude of a throw number, or at the greatest that drives are built for."""
    amplitude = bowl.drive.amplitude * throw / throw_number(bowl)
    return with_amplitude(bowl, min(amplitude, greatest_amplitude(bowl)))


def _can_build(plain_bowl: PlainBowl, bowl: Bowl) -> bool:
    """Tell whether usual springs and magnets make the drive; what the user owns counts as built."""
    if is_two_axis(bowl.drive) or plain_bowl.has_stroke or plain_bowl.keeps("machine.leaves"):
        return True
    return not drive_sizing.drive_shortfall(bowl, frozenset(plain_bowl.kept_keys))


def with_amplitude(bowl: Bowl, amplitude: float) -> Bowl:
    """Return a bowl at another amplitude, rounded down to a step of the stroke.

    Parameters
    ----------
    bowl : Bowl
    amplitude : float [m]

    Returns
    -------
    Bowl
    """
    rounded = float(np.floor(amplitude / STROKE_STEP + 1e-6) * STROKE_STEP)
    return replace(bowl, drive=replace(bowl.drive, amplitude=rounded))


def _slow_down(bowl: Bowl, velocity: float) -> Bowl:
    """The bowl at the least amplitude that is as fast as that, down to the next lower throw number."""
    throw, high = float(throw_number(bowl)), bowl.drive.amplitude
    lower = [number for number in THROW_NUMBERS if number < throw - CALMER_STEP]
    low = high * max(lower) / throw if lower and not is_two_axis(bowl.drive) else 0.0
    for _ in range(HALVINGS if low == 0.0 else HALVINGS // 2):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _is_fast(with_amplitude(bowl, middle), velocity) else (middle, high)
    return with_amplitude(bowl, min(high + STROKE_STEP, bowl.drive.amplitude))


def slow_to(bowl: Bowl, velocity: float, *, kept: float = LEAST_VELOCITY_KEPT) -> Bowl:
    """Return a bowl at the least amplitude that has a velocity.

    Parameters
    ----------
    bowl : Bowl
    velocity : float [m/s]
        That is asked for.
    kept : float [1], optional
        Share of it that is asked for at the worst friction; usually as of every design.

    Returns
    -------
    Bowl
        The same bowl where it is no faster than that.

    References
    ----------
    Own; docs/design.md: halvings of the amplitude, as a part is the faster the larger it is.
    """
    low, high = 0.0, bowl.drive.amplitude
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        slower = with_amplitude(bowl, middle)
        enough = speed(slower) >= velocity and slowest(slower) >= kept * velocity
        low, high = (low, middle) if enough else (middle, high)
    return with_amplitude(bowl, min(high + STROKE_STEP, bowl.drive.amplitude))


def _fast(bowl: Bowl) -> float:
    """The velocity [m/s] that may be asked of a bowl: its own, or less where the worst friction slows it."""
    return min(speed(bowl), slowest(bowl) / LEAST_VELOCITY_KEPT)


def _is_fast(bowl: Bowl, velocity: float) -> bool:
    """Tell whether a velocity [m/s] may be asked of a bowl."""
    return speed(bowl) >= velocity and slowest(bowl) >= LEAST_VELOCITY_KEPT * velocity


def slowest(bowl: Bowl) -> float:
    """Return the velocity of the point mass at the worst friction.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [m/s]
        The least at the shares ``WORST`` of its friction.
    """
    return min(speed(scale_friction(bowl, share)) for share in WORST)


def velocity_kept(bowl: Bowl) -> float:
    """Return the share of its velocity that a bowl keeps at the worst friction.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [1]
        0 where it has none.
    """
    own = speed(bowl)
    return min(slowest(bowl) / own, 1.0) if own > 0.0 else 0.0


def scale_friction(bowl: Bowl, share: float) -> Bowl:
    """Return a bowl with a share of its friction.

    Parameters
    ----------
    bowl : Bowl
    share : float [1]
        Of every coefficient.

    Returns
    -------
    Bowl
    """
    values = {name: getattr(bowl.friction, name) for name in vars(bowl.friction)}
    scaled: dict = {name: None if value is None else value * share for name, value in values.items()}
    return replace(bowl, friction=replace(bowl.friction, **scaled))


def speed(bowl: Bowl) -> float:
    """Return the velocity of the point mass.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [m/s]
        0 where the bowl does not convey.
    """
    return _speed(replace(bowl, devices=()))


@functools.lru_cache(maxsize=4096)
def _speed(bowl: Bowl) -> float:
    try:
        velocity = answer.answer(bowl).velocity
    except ConfigError:
        return 0.0
    return max(float(velocity), 0.0) if np.isfinite(velocity) else 0.0
