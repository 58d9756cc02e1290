"""The drive and the leaves of a bowl that bring a rate from the full bowl to the empty one."""

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.direction import vibration_angle
from feederscrew.bowl.record import Bowl, Machine
from feederscrew.bowl.schema import BY_NAME
from feederscrew.bowl.settings import Setting, default
from feederscrew.machine import building, filling, sizing, throughput, tuning
from feederscrew.machine.stroke import stroke

FULL_WAVE = 2.0
EVEN = 1e-9  # [1] flows closer than this are equal
ROUNDS = 4  # of strokes and leaves that follow from each other
ALONE, CONTROLLED = "strokes", "controlled"  # fields of an Emptying
WAYS = {ALONE: "amplitude left alone", CONTROLLED: "amplitude controlled"}


@dataclass(frozen=True, eq=False)
class Sought:
    """A bowl whose drive is sought."""

    bowl: Bowl  # with its track
    size: sizing.Size  # of it
    settings: tuple[Setting, ...]  # that say what the user gave
    target: float  # [1/s] counted parts
    bulk: float  # [kg/m3] of the parts' hulls

    @property
    def fill(self) -> filling.Fill:
        """A full bowl."""
        return filling.full(
            self.size.room or self.bowl.track.radius, self.size.depth, self.bulk, self.bowl.sizing
        )


def given(settings: Iterable[Setting], section: str = "") -> set[str]:
    """Return the words of the keys of a section that the user gave, a set."""
    return {s.key.word for s in settings if s.given and s.key.section == section}


def brought(sought: Sought, flow: Callable[[Bowl | None], throughput.Flow]) -> tuple[Bowl, throughput.Flow]:
    """Find the bowl whose drive brings the target, without the parts that this drive turns over.

    Parameters
    ----------
    sought : Sought
    flow : callable
        From a bowl, or from None for no drive at all, to the Flow along its track.

    Returns
    -------
    Bowl, Flow

    Raises
    ------
    ArgumentError
        If no stroke that drives are built for brings so many.
    """
    now, tried = flow(None), set()
    while True:
        driven = _driven(sought, now)
        own = flow(driven)
        enough = own.parts >= now.parts * (1.0 - EVEN)
        if enough and (own.parts <= now.parts * (1.0 + EVEN) or now.parts in tried):
            return driven, own
        tried.add(now.parts)
        now = own  # there are only so many orientations to turn over


def as_given(sought: Sought) -> Bowl:
    """Return the bowl with the drive of its file as it stands, and the machine that is sized for it.

    Parameters
    ----------
    sought : Sought

    Returns
    -------
    Bowl
        What the user gave of the machine is kept, as for ``brought``.
    """
    plain, settings = sought.bowl, sought.settings
    under = building.machine_for(plain, sought.size, given(settings, "machine"), exact=True)
    made = replace(plain, machine=replace(under, supply=plain.drive.frequency))
    return _with(made, plain.drive.amplitude, settings)


def _driven(sought: Sought, flow: throughput.Flow) -> Bowl:
    """The bowl with machine, frequency and the smallest stroke that reaches the target."""
    plain, settings = sought.bowl, sought.settings
    angle_given = "vibration_angle" in given(settings, "drive")
    angle = plain.drive.vibration_angle if angle_given else default(BY_NAME["drive.vibration_angle"]).value
    wanted = replace(plain, drive=replace(plain.drive, vibration_angle=angle))
    under = building.machine_for(wanted, sought.size, given(settings, "machine"), exact=angle_given)
    if not angle_given:
        angle = float(vibration_angle(under, plain.track.radius, plain.track.climb))
    fastest = []
    for frequency in _frequencies(plain, settings):
        drive = replace(plain.drive, vibration_angle=angle, frequency=frequency)
        made = replace(plain, drive=drive, machine=replace(under, supply=frequency))
        found, best = throughput.amplitude_for(made, sought.target / flow.parts)
        if found is not None:
            empty = _with(made, found[0], settings)
            held = (_held(empty, sought, sought.target / flow.parts, way) for way in WAYS)
            return next((one for one in held if one is not None), empty)
        fastest.append(best)
    raise throughput.unreachable(sought.target, flow.parts, max(fastest))


def _held(empty: Bowl, sought: Sought, velocity: float, way: str) -> Bowl | None:
    """The bowl with the smallest stroke whose lowest velocity, from full to empty, is enough, or None."""
    made, strokes = empty, np.ones(1)  # of the empty bowl
    for _ in range(ROUNDS):
        emptied = filling.emptying(made, sought.fill)
        if np.array_equal(getattr(emptied, way), strokes):
            return made
        strokes = getattr(emptied, way)
        found, _ = throughput.amplitude_for(made, velocity, strokes, emptied.angles)
        if found is None:
            return None
        made = _with(made, found[0], sought.settings)
    return made


def _with(bowl: Bowl, amplitude: float, settings: Iterable[Setting]) -> Bowl:
    """The bowl at a stroke, on the leaves that tune it then, unless the user gave their number."""
    bowl = replace(bowl, drive=replace(bowl.drive, amplitude=amplitude))
    if "leaves" in given(settings, "machine"):
        return bowl
    return replace(bowl, machine=on_leaves(bowl, given(settings, "machine")))


def on_leaves(bowl: Bowl, given: Collection[str]) -> Machine:
    """Return the machine of a bowl with the leaves that tune it to its drive at its stroke.

    Source: ``tuning.sets`` and ``tuning.chosen``; docs/bowl.md, "1. The part, and the rate".

    Parameters
    ----------
    bowl : Bowl
        With its drive.
    given : collection of str
        Fields of the machine that the user gave, which stay.

    Returns
    -------
    Machine
        With leaves of its own length, or else of the nearest length of which some set lasts. Where none
        lasts, with those of least stress; as it is where no set tunes it.
    """
    rules, machine, least = bowl.sizing, bowl.machine, None
    at_springs = stroke(bowl).springs
    near = sorted(tuning.LENGTHS, key=lambda one: abs(np.log(one / machine.leaf_length)))
    for length in (machine.leaf_length,) if "leaf_length" in given else (machine.leaf_length, *near):
        long = replace(machine, leaf_length=length)
        sets = tuning.sets(long, bowl.drive.frequency, at_springs, rules)
        if "leaf_thickness" in given:
            sets = tuple(one for one in sets if one.thickness == machine.leaf_thickness)
        lasting = tuning.chosen(sets, rules)
        if lasting is not None:
            return replace(long, leaves=float(lasting.leaves), leaf_thickness=lasting.thickness)
        for one in sets:
            if least is None or one.stress < least[1].stress:
                least = long, one
    if least is None:
        return machine
    return replace(least[0], leaves=float(least[1].leaves), leaf_thickness=least[1].thickness)


def _frequencies(bowl: Bowl, settings: Iterable[Setting]) -> tuple[float, ...]:
    """The drive's frequency as given; else that of the size, then the other wave of the mains."""
    if "frequency" in given(settings, "drive") or "supply" in given(settings, "machine"):
        return (bowl.drive.frequency,)
    mains = bowl.machine.supply / FULL_WAVE
    large = 2.0 * bowl.track.radius > bowl.sizing.half_wave_diameter
    return (mains, FULL_WAVE * mains) if large else (FULL_WAVE * mains, mains)
