"""Remarks that a designer of a machine must not overlook: each says where, what and what to change."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base import units
from feederscrew.base.errors import FeederError
from feederscrew.base.units import MM, MPA
from feederscrew.bowl.devices.trade import Action
from feederscrew.machine.springs import fewest_leaves, greatest_amplitude
from feederscrew.motion import hop
from feederscrew.motion.conveying import speed_remark

if TYPE_CHECKING:
    from feederscrew.machine.sheet import MachineSheet, Order

VISIBLE_STROKE_SPREAD = 0.05  # of the stroke round a bowl, that parts show


def remarks(sheet: "MachineSheet") -> tuple[str, ...]:
    """Return the remarks on a machine.

    Parameters
    ----------
    sheet : MachineSheet

    Returns
    -------
    tuple of str
        A line each: springs, limits, emptying, rocking, size, tipping of the part, speed.
    """
    order = sheet.order
    faults = [*_springs(sheet), *_limits(sheet), *_emptying(sheet), *_rocking(sheet)]
    faults += [] if order is None else _size(sheet, order)
    tipping = () if order is None or sheet.as_tried else order.tipping  # else the trial has the last word
    return (*map(str, faults), *tipping, *speed_remark(sheet.answer.velocity, sheet.bowl.sizing))


def solid_remarks(sheet: "MachineSheet") -> tuple[str, ...]:
    """Return the remarks on a machine that its bowl as a solid alone gives.

    Parameters
    ----------
    sheet : MachineSheet
        With a solid.

    Returns
    -------
    tuple of str
    """
    return (*map(str, _rocking(sheet)), *(() if sheet.solid is None else sheet.solid.remarks))


def find_drive_faults(sheet: "MachineSheet") -> Iterator[FeederError]:
    """Yield what keeps the springs of a machine from making its drive.

    Parameters
    ----------
    sheet : MachineSheet

    Yields
    ------
    FeederError
        One, or none.
    """
    other = sheet.mismatch
    if other is not None and other.two_axis:
        yield FeederError("drive.phase", other.text, "set drive.phase to 0 deg for a leaf-spring drive")
    elif other is not None and not other.other_angle:
        yield FeederError("drive.second_harmonic", other.text, "set drive.second_harmonic to 0")
    elif other is not None:
        yield FeederError("drive.vibration_angle", other.text, "leave it out, to go by the springs")


def _springs(sheet: "MachineSheet") -> Iterator[FeederError]:
    """The drive that the springs do not make, and how they are tuned to it."""
    yield from find_drive_faults(sheet)
    rules, drive, detuning = sheet.bowl.sizing, sheet.stroke.frequency, sheet.detuning
    natural = f"the natural frequency {sheet.springs.natural_frequency:.4g} Hz"
    better = f": {' or '.join(fewest_leaves(sheet.sets)[:3])}" if sheet.sets else ""
    window = f"{100 * rules.least_detuning:.3g} to {100 * rules.greatest_detuning:.3g} %"
    if detuning <= 0.0:
        what, mend = f"is below the drive's {drive:.4g} Hz", "add leaves or take thicker ones"
    elif detuning < rules.least_detuning:
        what = f"is {100 * detuning:.2g} % above the drive: the stroke changes with every gram"
        mend = f"add leaves, to come {window} above it"
    elif detuning > rules.greatest_detuning:
        what = f"is {100 * detuning:.3g} % above the drive: much of the magnet's force is wasted"
        mend = f"take leaves away, to come {window} above it"
    else:
        return
    yield FeederError("machine.leaves", f"{natural} {what}", f"{mend}{better}")


def _limits(sheet: "MachineSheet") -> Iterator[FeederError]:
    """Leaves that do not share into banks or bend too far, a stroke that no drive makes, parts that hop."""
    bowl, rules = sheet.bowl, sheet.bowl.sizing
    leaves, banks = int(bowl.machine.leaves), int(rules.banks)
    if sheet.has_machine and leaves % banks:
        near = leaves - leaves % banks
        some = f"{near} or {near + banks}" if near else f"{banks}"
        what = f"{leaves} leaves do not share into {banks} banks"
        yield FeederError("machine.leaves", what, f"take {some}, or give sizing.banks")
    if sheet.stress > rules.fatigue_stress:
        beyond = f"beyond their fatigue stress {rules.fatigue_stress / MPA:.4g} MPa"
        what = f"the leaves bend to {sheet.stress / MPA:.4g} MPa, {beyond}"
        yield FeederError("machine.leaf_thickness", what, "take more and thinner leaves, or longer ones")
    most = greatest_amplitude(bowl)
    if bowl.drive.amplitude > most * (1.0 + 1e-9):
        there = f"{2.0 * bowl.drive.amplitude / MM:.4g} mm peak to peak at {sheet.stroke.frequency:.4g} Hz"
        what = f"{there} is more than drives are built for"
        yield FeederError("drive.amplitude", what, f"give at most {most / MM:.3g} mm, or a lower frequency")
    # devices that a part meets on the track, where it hops higher than their margin and no trial was run
    over = [
        device.kind
        for device in bowl.devices
        if device.action.has_place and device.action is not Action.OVERHEAD and not sheet.as_tried
    ]
    for remark in hop.remark(bowl) if over else ():
        names = units.listed(list(dict.fromkeys(over)))
        what = f"at the throw number {sheet.answer.throw_number:.3g} {remark}"
        mend = f"try the {names} with feeder trial, or take twice the frequency"
        yield FeederError("drive.amplitude", what, mend)


def _emptying(sheet: "MachineSheet") -> Iterator[FeederError]:
    """Return what a bowl left alone does from full to empty."""
    bowl, rules, emptied, drive = sheet.bowl, sheet.bowl.sizing, sheet.emptying, sheet.stroke.frequency
    most = greatest_amplitude(bowl)
    full_frequency = emptied.natural_frequencies[0]
    if sheet.detuning > 0.0 and full_frequency <= drive:
        holds = emptied.levels[emptied.natural_frequencies > drive].max(initial=0.0)
        what = f"a full bowl's natural frequency {full_frequency:.4g} Hz is below the drive's {drive:.4g} Hz"
        mend = f"fill it to {100 * holds:.2g} % at most from a hopper, or control the amplitude"
        yield FeederError("sizing.fill_height", what, mend)
    speeds_left = np.maximum(sheet.velocities, 0.0)
    full, empty = speeds_left[0], speeds_left[-1]
    mend = "control the amplitude, or hold the level with a hopper"
    if abs(full - empty) > rules.retune * empty:
        what = f"left alone, {full / MM:.3g} mm/s of a full bowl become {empty / MM:.3g} mm/s as it empties"
        yield FeederError("sizing.carried", what, mend)
    beyond = emptied.levels[emptied.strokes * bowl.drive.amplitude > most]
    if beyond.size and bowl.drive.amplitude <= most:
        stroke = f"the stroke passes {2.0 * most / MM:.3g} mm above {100 * beyond.min():.3g} % of fill"
        yield FeederError("drive.amplitude", f"left alone, {stroke}: the magnet strikes", mend)


def _rocking(sheet: "MachineSheet") -> Iterator[FeederError]:
    if sheet.rocking is None or sheet.solid is None:
        return
    as_is, balanced = sheet.rocking
    if as_is.greatest - as_is.least > VISIBLE_STROKE_SPREAD:
        weight, angle = sheet.solid.balance
        low, high, rest = (
            100.0 * (share - 1.0) for share in (as_is.least, as_is.greatest, balanced.greatest)
        )
        what = f"its stroke differs by {low:+.2g} to {high:+.2g} % round the bowl, whose mass lies to a side"
        there = f"{1e3 * weight:.3g} g on the wall at {np.degrees(angle):.0f} deg"
        yield FeederError("the bowl as a solid", what, f"put {there}: at most {rest:.2g} % are left")


def _size(sheet: "MachineSheet", order: "Order") -> Iterator[FeederError]:
    """Return what of a bowl that was sized for a part and a rate is out of its rules."""
    low, size = sheet.lowest, order.size
    if low.rate < order.target * (1.0 - 1e-6):
        there = f"{60.0 * low.rate:.3g}/min at {100.0 * low.level:.3g} % of the fill, {low.control}"
        what = f"{60.0 * order.target:.3g}/min are not kept as the bowl empties: {there}"
        yield FeederError("target", what, "hold the level with a hopper, or lower the target")
    rule, least = max(size.least.items(), key=lambda rule_size: rule_size[1])
    if size.diameter < least * (1.0 - 1e-9):
        what = f"{500 * size.diameter:.4g} mm is less than {500 * least:.4g} mm ({rule})"
        yield FeederError("track.radius", what, "give a larger bowl")
    if not size.climb < order.steepest:
        climb, most = np.degrees(size.climb), np.degrees(order.steepest)
        what = f"{climb:.3g} deg is steeper than friction carries at this stroke ({most:.3g} deg)"
        yield FeederError("track.climb", what, "lower it or raise the friction")
    if size.pitch < order.lying.tallest + sheet.bowl.sizing.sheet:
        what = f"a turn rises {size.pitch / MM:.4g} mm, less than the part stands high"
        yield FeederError("track.climb", what, "climb more steeply, or step the bowl outwards at each turn")
    if sheet.bowl.sizing.hand == "left":
        what = (
            "orientations and devices are judged for a right-handed track, of which this is the mirror image"
        )
        yield FeederError("track.hand", what, "mirror the part's file too, unless it is its own mirror image")
