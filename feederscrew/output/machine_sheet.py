"""The sheet of a machine and the sheet that a quotation asks for: one line a quantity, in plain text."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np

from feederscrew.base import units
from feederscrew.base.arrays import Points
from feederscrew.base.units import DEG, GRAM, LITRE, MM, MM_S, MPA, PER_MINUTE
from feederscrew.bowl.record import Bowl, Drive, Machine
from feederscrew.bowl.verified import Verified
from feederscrew.machine import drive_sizing
from feederscrew.machine.sheet import MachineSheet, Order
from feederscrew.machine.springs import MAINS, fewest_leaves, mean_pull
from feederscrew.motion.hop import hop
from feederscrew.output.tables import regime_words
from feederscrew.part.density import DEFAULT_MATERIAL
from feederscrew.part.record import Part

Pairs = Iterator[tuple[str, str]]
N_MM, GRAM_CM3 = units.factor("N/mm", "stiffness"), units.factor("g/cm3", "density")


def quotation(study: MachineSheet, trial: Verified | None = None) -> list[dict[str, str]]:
    """Return what a maker asks for; without an order the machine.

    The condition under which the bowl holds comes first, then what one set of leaf springs cannot make, and
    both drives.

    Parameters
    ----------
    study : MachineSheet
    trial : Verified, optional
        What a trial of the bowl has shown.

    Returns
    -------
    list of dict of str to str
        'quantity' and 'value'.
    """
    rows = [(trial.status, trial.condition)] if trial is not None and trial.condition else []
    rows += [("drive", words)] if (words := two_axis(study.bowl.drive)) else []
    if study.mismatch is not None:
        wanted, made = study.mismatch.wanted.text, study.mismatch.machine.text
        rows += [("drive asked for", wanted), ("these springs make", made)]
    if study.order is not None:
        rows += [*_order_rows(study, study.order, trial), *_spring_rows(study)]
    else:
        if trial is not None:
            rows.append(("orientation that leaves", trial.wanted))
            rows.append(("rate asked for [1/min]", f"{trial.target / PER_MINUTE:.6g}"))
        rows += [
            *_trial_rows(trial),
            *_spring_rows(study),
            *_reading_rows(study),
            *_travel_rows(study),
            *_fill_rows(study),
        ]
    return [{"quantity": quantity, "value": value} for quantity, value in rows]


def two_axis(drive: Drive) -> str:
    """Return what a drive out of phase is and needs, as text.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    str
        '' of a leaf-spring drive.
    """
    if not drive_sizing.is_two_axis(drive):
        return ""
    return f"{drive_sizing.TWO_AXIS}, phase {drive.phase / DEG:.4g} deg: {drive_sizing.TWO_MAGNETS}"


def angles(study: MachineSheet, *, phase: bool = True) -> str:
    """Return the angle of the motion at the springs and at the track, as text for titles and drawings.

    Parameters
    ----------
    study : MachineSheet
    phase : bool, optional
        Whether the phase of a two-axis drive is said too.

    Returns
    -------
    str
    """
    degrees = study.bowl.machine.spring_angle / DEG, study.bowl.drive.vibration_angle / DEG
    words = f"{degrees[0]:.3g}° at the springs, {degrees[1]:.3g}° to the track"
    led = phase and drive_sizing.is_two_axis(study.bowl.drive)
    return f"{words}, phase {study.bowl.drive.phase / DEG:.4g}°" if led else words


def _order_rows(study: MachineSheet, order: Order, trial: Verified | None) -> Pairs:
    size, rules, part, room = order.size, study.bowl.sizing, order.part, order.lying
    points, volume = cast(Points, part.vertices), cast(float, part.volume)  # an order is of a mesh
    extents = " x ".join(f"{side / MM:.4g}" for side in sorted(np.ptp(points, axis=0), reverse=True))
    yield "part, drawing", f"{part.name}, {part.source}"
    yield "material, density [g/cm3]", f"{material(part)}, {part.mass / volume / GRAM_CM3:.4g}"
    yield "mass [g], volume [mm3]", f"{part.mass / GRAM:.4g}, {volume / MM**3:.5g}"
    at_most = f"at most {room.longest / MM:.4g} along the wall, {room.tallest / MM:.4g} high"
    yield "size [mm]", f"{extents}; {at_most}"
    yield from _trial_rows(trial)
    rates, low = study.rates(study.velocities) / PER_MINUTE, study.lowest
    yield "rate asked for [1/min]", f"{order.target / PER_MINUTE:.6g}"
    at = f"at {100 * low.level:.3g} % of the fill, {low.control}"
    yield "lowest rate, full to empty [1/min]", f"{low.rate / PER_MINUTE:.4g} {at}"
    at_this = study.rates(study.answer.velocity) / PER_MINUTE
    yield "rate at this stroke [1/min]", f"{at_this:.4g}; {rates[0]:.4g} of a full bowl left alone"
    yield "handbook, 1500 E / l [1/min]", f"{order.handbook / PER_MINUTE:.4g}"
    counted = "every one that passes track and devices"
    if order.wanted is not None:
        counted = f"aspect {order.wanted[0]} at {order.wanted[1] / DEG:.3g} deg"
    yield "orientation that counts", f"{counted}, {100 * order.flow.share:.3g} % of the parts"
    yield "whose probabilities", order.answer
    rule = max(size.least, key=size.least.__getitem__)
    least = f"{size.least[rule] / MM:.4g} by: {rule}"
    play = f"play {size.clearance / MM:.3g}, bend {size.bend / MM:.3g}"
    yield "bowl diameter [mm]", f"{size.diameter / MM:.4g} (least {least})"
    yield "bowl depth [mm]", f"{size.depth / MM:.4g}"
    yield "track width [mm]", f"{size.track_width / MM:.4g} (part {room.width / MM:.4g}, {play})"
    yield "climb [deg]", f"{size.climb / DEG:.3g} (friction carries {order.steepest / DEG:.3g})"
    yield "turns", f"{study.turns:.3g}, each rises {size.pitch / MM:.3g} mm"
    yield from _fill_rows(study)
    hours = rules.hopper_interval / units.factor("min", "time")
    yield "hopper [l]", f"{order.hopper / LITRE:.3g}, filled every {hours:.4g} min"
    yield "supply, drive [Hz]", supply(study.stroke.frequency)
    yield from _reading_rows(study)
    yield from _travel_rows(study)
    least_setting, greatest_setting = (rules.controller + sign * rules.retune for sign in (-1.0, 1.0))
    window = f"{100 * least_setting:.3g} to {100 * greatest_setting:.3g}"
    yield "tune again outside [%]", f"{window} of the controller, at that rate"


def _trial_rows(trial: Verified | None) -> Pairs:
    if trial is not None:
        ends = ", ".join(f"{end / PER_MINUTE:.4g}" for end in (trial.low, trial.high))
        shown = f"{trial.delivered / PER_MINUTE:.4g} ({ends}): {trial.status}"
        yield "rate as its trial showed [1/min]", shown


def rate_of_trial(trial: Verified) -> str:
    """Return what a trial has delivered as text for titles and drawings.

    Parameters
    ----------
    trial : Verified

    Returns
    -------
    str
    """
    value, low = (f"{end / PER_MINUTE:.4g}" for end in (trial.delivered, trial.low))
    return f"{value}/min, at least {low}: {trial.status}"


def material(part: Part) -> str:
    """Return what a part is made of, as text: 'steel assumed' where neither file nor user says it.

    Parameters
    ----------
    part : Part

    Returns
    -------
    str
    """
    return "steel assumed" if part.material == DEFAULT_MATERIAL else part.material


def _fill_rows(study: MachineSheet) -> Pairs:
    rules, fill, under = study.bowl.sizing, study.fill, study.bowl.machine
    third = abs(rules.fill_height - 1.0 / 3.0) < 1e-3
    share = "a third" if third else f"{100 * rules.fill_height:.3g} %"
    whence = "" if study.order is not None else f", {study.filled_with}"
    yield "full bowl [kg]", f"{fill.mass:.3g} in {fill.volume / LITRE:.3g} l, {share} of the depth{whence}"
    mass = under.bowl_mass + rules.carried * fill.mass
    inertia = under.bowl_inertia + rules.carried * fill.inertia
    yield "on the springs, empty", f"{under.bowl_mass:.3g} kg, {under.bowl_inertia:.3g} kg m2"
    yield "on the springs, full", f"{mass:.3g} kg, {inertia:.3g} kg m2"


def supply(frequency: float) -> str:
    """Return the mains and waves that give a frequency, as text.

    Parameters
    ----------
    frequency : float [Hz]

    Returns
    -------
    str
        A frequency converter where none does.
    """
    for mains in MAINS:
        for wave, times in (("half wave", 1.0), ("full wave", 2.0)):
            if abs(frequency - times * mains) < 1e-6:
                return f"{mains:.0f} Hz {wave}, {frequency:.4g}"
    return f"frequency converter, {frequency:.4g}"


def _reading_rows(study: MachineSheet) -> Pairs:
    moved, rules = study.stroke, study.bowl.sizing
    full = moved.peak_to_peak / rules.controller / MM
    at = f"at {100 * rules.controller:.3g} % of the controller, {full:.3g} at 100 %"
    yield "stroke, peak to peak [mm]", f"{moved.peak_to_peak / MM:.3g} {at}"
    parts = f"rms {moved.rms:.3g}, horizontal {moved.horizontal:.3g}, vertical {moved.vertical:.3g}"
    yield "accelerometer [m/s2]", f"{moved.acceleration:.3g} peak; {parts}"
    ratio = moved.acceleration / study.bowl.gravity
    yield "G, throw number", f"{ratio:.3g}, {study.answer.throw_number:.3g}"
    if study.answer.throw_number > 1.0:
        yield "a part hops", hop(study.bowl).text


def _travel_rows(study: MachineSheet) -> Pairs:
    answer, bowl = study.answer, study.bowl

    def words(value: float) -> str:
        """A velocity to three digits; 'none' where there is none, as without a steady state."""
        return f"{value / MM_S:.3g}" if math.isfinite(value) else "none"

    upright = (bowl.drive.vibration_angle + bowl.track.climb) / DEG
    angle = f"{bowl.drive.vibration_angle / DEG:.3g} to the track, {upright:.3g} to the horizontal"
    yield "vibration angle [deg]", angle
    yield "velocity at this stroke [mm/s]", f"{words(answer.velocity)}, {regime_words(answer.regime)}"
    yield "hardest impact [mm/s]", words(answer.hardest_impact)
    if study.order is None:
        full, empty = (words(study.velocities[k]) for k in (0, -1))
        yield "velocity from full to empty [mm/s]", f"{full} to {empty}, amplitude left alone"


def _spring_rows(study: MachineSheet) -> Pairs:
    springs, under, rules = study.springs, study.bowl.machine, study.bowl.sizing
    each = f"{springs.leaf_stiffness / N_MM:.5g} N/mm each"
    counts = spring_banks(study.bowl).counts
    banks = f"{len(counts)} banks of {' or '.join(map(str, sorted(set(counts))))}"
    yield "leaves", f"{under.leaves:.0f} of {leaf_words(under)} mm, {banks}, {each}"
    place = f"radius {under.spring_radius / MM:.4g} mm, motion there {under.spring_angle / DEG:.3g} deg"
    yield "springs", f"{place}, {springs.stiffness / N_MM:.5g} N/mm with twist"
    held = f"base held {springs.effective_mass_held:.4g}"
    yield "effective mass [kg]", f"{springs.effective_mass:.4g} ({held})"
    rigid = f"{springs.natural_frequency_rigid:.4g} to {springs.natural_frequency_rigid_end:.4g}"
    plain = f"without twist {springs.natural_frequency_without_twist:.4g}; rigid clamps {rigid}"
    yield "natural frequency [Hz]", f"{springs.natural_frequency:.4g} ({plain})"
    yield "above the drive [%], gain", f"{100 * study.detuning:.3g}, {study.gain:.3g}"
    if study.solid is not None and (modes := study.rocking) is not None:
        # where the centre of mass of a solid is, and what that does to the stroke round it
        x, y, z = study.solid.centre / MM
        yield "centre of mass [mm]", f"{np.hypot(x, y):.3g} from the axis, {z:.3g} over the floor's edge"
        as_is, balanced = (
            f"{100 * (rocking.least - 1.0):+.2g} to {100 * (rocking.greatest - 1.0):+.2g}"
            for rocking in modes
        )
        weight, angle = study.solid.balance
        words = f"with {weight / GRAM:.3g} g on the wall at {angle / DEG:.0f} deg {balanced}"
        yield "stroke round the bowl [%]", f"{as_is}; {words}"
    # what other sets of leaves do; makers who reckon with t^2 beside beam theory's t^3
    for leaf_set in study.changes[1:]:
        words = f"{leaf_set.natural_frequency:.4g} Hz, gain {leaf_set.gain:.3g}"
        if leaf_set.thickness != under.leaf_thickness:
            words += f" by t^3; {leaf_set.by_square:.4g} Hz by RNA's t^2"
        yield leaf_set.name, words
    window = f"{100 * rules.least_detuning:.3g} to {100 * rules.greatest_detuning:.3g} %"
    sets = ", ".join(fewest_leaves(study.sets)[:5]) or "none of this width and length"
    yield f"leaves that tune it {window}", sets
    yield "leaf stress [MPa]", f"{study.stress / MPA:.3g} (bears {rules.fatigue_stress / MPA:.4g})"
    mean = mean_pull(study.magnet, study.stroke.frequency)
    pull = f"{study.magnet:.3g} upright about a mean of {mean:.3g}"
    yield "force of the magnet [N]", f"{pull}; {study.force:.3g} along the motion"


@dataclass(frozen=True)
class SpringBanks:
    """Leaf springs as a maker builds them: lengths [m], angles [rad]."""

    counts: tuple[int, ...]  # leaves of each bank
    angles: tuple[float, ...]  # of each bank about the axis, as the sheet shows the bowl from above
    thickness: float  # of a leaf, and of the spacers between two leaves at both ends

    @property
    def spacers(self) -> int:
        """Spacers of all banks: between two leaves, at both ends."""
        return sum(2 * (count - 1) for count in self.counts)

    @property
    def stack(self) -> float:
        """Thickness [m] of the thickest bank with its spacers."""
        return (2 * max(self.counts) - 1) * self.thickness


def spring_banks(bowl: Bowl) -> SpringBanks:
    """Return the banks of the leaf springs of a bowl.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    SpringBanks
        Spread evenly about the bowl; the first ones have a leaf more where they are not equal.
    """
    leaves, banks = int(bowl.machine.leaves), int(bowl.sizing.banks)
    counts = tuple(leaves // banks + (k < leaves % banks) for k in range(banks))
    angles = tuple(float(0.5 * np.pi + 2.0 * np.pi * k / banks) for k in range(banks))
    return SpringBanks(counts, angles, float(bowl.machine.leaf_thickness))


def leaf_words(machine: Machine) -> str:
    """Return width, thickness and length [mm] of a leaf, as text.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    str
    """
    return " x ".join(
        f"{getattr(machine, f'leaf_{side}') / MM:.3g}" for side in ("width", "thickness", "length")
    )
