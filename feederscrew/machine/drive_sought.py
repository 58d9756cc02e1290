"""The drive and the leaves of a bowl that bring a rate from the full bowl to the empty one."""

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from feederscrew.bowl.direction import vibration_angle
from feederscrew.bowl.record import Bowl, Machine
from feederscrew.bowl.schema import BY_NAME
from feederscrew.bowl.settings import Setting, default
from feederscrew.machine import building, feasibility, filling, sizing, throughput, tuning
from feederscrew.machine.springs import gain, leaf_stress, springs, upright_pull
from feederscrew.machine.stroke import stroke

FULL_WAVE = 2.0
MPA = 1e6  # [Pa]
# amplitude of the pull of all magnets: B^2 / (4 mu_0) at 1 T on six poles of 40 x 40 mm (assumption)
GREATEST_PULL_N = 1900.0
FLOW_TOLERANCE = 1e-9  # [1] flows closer than this are equal
MAX_DRIVE_ITERATIONS = 4  # of strokes and leaves that follow from each other
ALONE, CONTROLLED = "strokes", "controlled"  # fields of an Emptying
STROKE_CONTROL_LABELS = {ALONE: "amplitude left alone", CONTROLLED: "amplitude controlled"}


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
        enough = own.parts >= now.parts * (1.0 - FLOW_TOLERANCE)
        if enough and (own.parts <= now.parts * (1.0 + FLOW_TOLERANCE) or now.parts in tried):
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
            held = (_held(empty, sought, sought.target / flow.parts, way) for way in STROKE_CONTROL_LABELS)
            return next((one for one in held if one is not None), empty)
        fastest.append(best)
    raise throughput.unreachable(sought.target, flow.parts, max(fastest))


def _held(empty: Bowl, sought: Sought, velocity: float, way: str) -> Bowl | None:
    """The bowl with the smallest stroke whose lowest velocity, from full to empty, is enough, or None."""
    made, strokes = empty, np.ones(1)  # of the empty bowl
    for _ in range(MAX_DRIVE_ITERATIONS):
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

    Source: ``tuning.sets``; docs/bowl.md, "1. The part, and the rate".

    Parameters
    ----------
    bowl : Bowl
        With its drive.
    given : collection of str
        Fields of the machine that the user gave, which stay.

    Returns
    -------
    Machine
        With the leaves that last and that a maker would take first: at most ``tuning.USUAL_A_BANK`` in a
        bank, tuned to the upper half of the range, because parts in the bowl lower the natural frequency.
        Of these, the ones of the width in use, of about the length in use, and of a usual number. Where none
        lasts, with those of least stress; as it is where no set tunes it.
    """
    machine, rules = bowl.machine, bowl.sizing
    rows: list[tuple[Machine, tuning.LeafSet]] = []
    for width in (
        (machine.leaf_width,) if "leaf_width" in given else (machine.leaf_width, *tuning.LEAF_WIDTHS_M)
    ):
        rows += _leaf_sets(bowl, width, given)
        lasting = [row for row in rows if row[1].stress <= rules.fatigue_stress]
        best = min(lasting, key=partial(_unusual, bowl), default=None)
        if best is not None and not any(_unusual(bowl, best)[:2]):
            break
    if not rows:
        return machine
    long, leaves = best or min(rows, key=_stress)
    return replace(long, leaves=float(leaves.leaves), leaf_thickness=leaves.thickness)


def _leaf_sets(bowl: Bowl, width: float, given: Collection[str]) -> Iterator[tuple[Machine, tuning.LeafSet]]:
    """Every set of leaves of a width [m] that tunes a bowl, each with the machine that has its length."""
    machine, at_springs = replace(bowl.machine, leaf_width=width), stroke(bowl).springs
    for length in (
        (machine.leaf_length,) if "leaf_length" in given else (machine.leaf_length, *tuning.LEAF_LENGTHS_M)
    ):
        long = replace(machine, leaf_length=length)
        for one in tuning.sets(long, bowl.drive.frequency, at_springs, bowl.sizing):
            if _fits(one, machine, given):
                yield long, one


def _fits(leaves: tuning.LeafSet, machine: Machine, given: Collection[str]) -> bool:
    """Whether a set has the thickness that the user gave, where it was given."""
    return "leaf_thickness" not in given or leaves.thickness == machine.leaf_thickness


def _stress(row: tuple[Machine, tuning.LeafSet]) -> float:
    return row[1].stress


def _unusual(bowl: Bowl, row: tuple[Machine, tuning.LeafSet]) -> tuple[bool, bool, bool, float, float]:
    """How unusual leaves are: many in a bank, tuned low, of another width, length, number."""
    rules, (long, leaves) = bowl.sizing, row
    middle = 0.5 * (rules.least_detuning + rules.greatest_detuning)
    return (
        leaves.leaves > tuning.USUAL_A_BANK * rules.banks,
        leaves.detuning < middle,
        long.leaf_width != bowl.machine.leaf_width,
        round(abs(float(np.log(long.leaf_length / bowl.machine.leaf_length))), 6),
        abs(leaves.leaves - rules.leaves),
    )


@lru_cache(maxsize=4096)
def lacks(bowl: Bowl, given: frozenset[str]) -> str:
    """Return why the machine under a bowl does not make its drive; '' where it does.

    Parameters
    ----------
    bowl : Bowl
        With its drive, a leaf-spring drive.
    given : frozenset of str
        Names of the keys that the user gave, 'machine.leaves': these stay.

    Returns
    -------
    str
        Of a machine that is sized from the track alone: the angle of the springs, the tuning of the leaves,
        their stress, or the pull of the magnets.
    """
    under = building.machine_on(bowl, given, exact=True)
    made = replace(bowl, machine=under)
    other = feasibility.can_make(made)
    if other is not None:
        return other.text
    if "machine.leaves" not in given:
        words = {name.partition(".")[2] for name in given if name.startswith("machine.")}
        under = on_leaves(made, words)
    return leaves_lack(replace(made, machine=under))


def leaves_lack(bowl: Bowl) -> str:
    """Return what keeps the leaves and the magnets of a machine from making its drive; '' for nothing.

    Parameters
    ----------
    bowl : Bowl
        With its machine.
    """
    rules, machine, moved = bowl.sizing, bowl.machine, stroke(bowl)
    natural = springs(machine).natural_frequency
    detuning = natural / moved.frequency - 1.0
    if not rules.least_detuning <= detuning <= rules.greatest_detuning:
        return f"its leaves tune it to {natural:.4g} Hz, {100.0 * detuning:.2g} % above the drive"
    stress = leaf_stress(machine, moved.springs)
    if stress > rules.fatigue_stress:
        return f"its leaves bend to {stress / MPA:.4g} MPa"
    kept = gain(moved.frequency, natural, machine.damping)
    pull = upright_pull(springs(machine).stiffness * moved.springs / kept, machine)
    if pull > GREATEST_PULL_N:
        return f"its magnets have to pull with {pull:.4g} N"
    return ""


def _frequencies(bowl: Bowl, settings: Iterable[Setting]) -> tuple[float, ...]:
    """The drive's frequency as given; else that of the size, then the other wave of the mains."""
    if "frequency" in given(settings, "drive") or "supply" in given(settings, "machine"):
        return (bowl.drive.frequency,)
    mains = bowl.sizing.mains_frequency
    large = 2.0 * bowl.track.radius > bowl.sizing.half_wave_diameter
    return (mains, FULL_WAVE * mains) if large else (FULL_WAVE * mains, mains)
