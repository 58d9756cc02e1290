"""The machine and the bowl for a part as tables, documents and files: ``feeder bowl``."""

import math
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.conveying.hop import hop
from feederscrew.machine import drive_sizing
from feederscrew.machine.springs import mean_pull
from feederscrew.output import machine_sheet as sheets
from feederscrew.output import marking, proof, solidbowl, tables
from feederscrew.output.offers import document as json_file
from feederscrew.output.offers import picture, table
from feederscrew.units import DEG, MM, MM_S, PER_MINUTE

N_MM, MPA = units.factor("N/mm", "stiffness"), units.factor("MPa", "stress")
LITRE = units.factor("l", "volume")


def offers(study, tried=None, mark=None, fields=None) -> tuple[Any, ...]:
    """Return the files of a machine.

    Parameters
    ----------
    study : MachineSheet
    tried : Verified, optional
        What a trial of exactly this bowl at this stroke has shown: it leads, and what falls short is marked.
    mark : str, optional
        Across every drawing; that of the trial without it.
    fields : marking.SheetFields, optional
        Date and revision of the drawing.

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output import machine_figures as figures
    from feederscrew.output import solidbowl

    alt = "The bowl from above and in section, with its sizes, and what it does from full to empty"
    solid = () if study.solid is None else solidbowl.offers(study, tried, mark, fields)
    drawn = picture("bowl.png", alt, figures.bowl, study, tried)
    return (
        *solid,
        json_file("bowl.json", _document, study, tried),
        table("bowl.csv", summary, study, tried),
        table("bowl_angles.csv", angles, study),
        table("bowl_leaves.csv", leaf_sets, study.sets),
        table("bowl_leaf_changes.csv", leaf_sets, study.changes),
        table("bowl_emptying.csv", emptying, study),
        *marking.pictures([drawn], marking.of_trial(tried, mark)),
    )


def _document(study, tried) -> dict[Any, Any]:
    return document(study) | ({} if tried is None else {"verified": proof.block(tried)})


def document(study) -> dict[Any, Any]:
    """Return everything of a machine as the JSON document.

    Parameters
    ----------
    study : MachineSheet

    Returns
    -------
    dict
    """
    return {
        **_drive(study),
        **({} if study.order is None else order(study)),
        "turns": study.turns if np.isfinite(study.turns) else None,
        "bowl_depth_mm": study.depth / MM,
        **_springs(study),
        **_stroke(study),
        "angle_by_radius": angles(study),
        "leaf_changes": leaf_sets(study.changes),
        "leaf_sets": leaf_sets(study.sets),
        "full_bowl": {
            "filled_with": study.filled_with,
            "volume_l": study.fill.volume / LITRE,
            "mass_kg": study.fill.mass,
            "inertia_kg_m2": study.fill.inertia,
            "mass_carried_kg": study.fill.mass * study.bowl.sizing.carried,
        },
        "emptying": emptying(study),
        "remarks": list(study.remarks),
        "warnings": list(study.remarks),
        **({} if study.solid is None else solidbowl.document(study.solid)),
        **({} if study.rocking is None else _rocking(study)),
    }


def _drive(study) -> dict[Any, Any]:
    """What kind of drive it is; where the springs do not make it, both."""
    drive, other = study.bowl.drive, study.mismatch
    kind = drive_sizing.TWO_AXIS if drive_sizing.is_two_axis(drive) else drive_sizing.LEAF_SPRING
    return {
        "drive_kind": kind,
        "phase_deg": drive.phase / DEG,
        "drive_needs": sheets.two_axis(drive) or None,
        "springs_make_this_drive": other is None,
        "drive_asked_for": None if other is None else _figures(other.wanted),
        "drive_of_the_springs": None if other is None else _figures(other.machine),
    }


def _figures(motion) -> dict[Any, Any]:
    return {
        "vibration_angle_at_the_springs_deg": motion.spring_angle / DEG,
        "vibration_angle_at_the_track_deg": motion.track_angle / DEG,
        "phase_deg": motion.phase / DEG,
        "throw_number": motion.throw_number,
        "velocity_mm_s": motion.velocity / MM_S if np.isfinite(motion.velocity) else None,
    }


def _rocking(study) -> dict[Any, Any]:
    """The stroke round the bowl over its mean, as the solid is and with the weight that balances it."""
    as_is, balanced = study.rocking
    return {
        "stroke_round_least": as_is.least,
        "stroke_round_greatest": as_is.greatest,
        "stroke_round_greatest_at_deg": as_is.angle / DEG,
        "balanced_stroke_round_least": balanced.least,
        "balanced_stroke_round_greatest": balanced.greatest,
        "effective_mass_balanced_kg": balanced.effective_mass,
        "effective_mass_centred_kg": study.springs.effective_mass_centred,
    }


def order(study) -> dict[Any, Any]:
    """Return what an order asked for and what was sized for it, as a dict."""
    wish, size, room = study.order, study.order.size, study.order.lying
    wanted = (None, None) if wish.wanted is None else (wish.wanted[0], wish.wanted[1] / DEG)
    rates, held = (study.rates(v) / PER_MINUTE for v in (study.velocities, study.controlled))
    return {
        "target_per_minute": wish.target / PER_MINUTE,
        "parts_per_minute": study.lowest.rate / PER_MINUTE,
        "lowest_at_fill_percent": 100.0 * study.lowest.level,
        "lowest_with": study.lowest.control,
        "rate_at_this_stroke": float(study.rates(study.answer.velocity)) / PER_MINUTE,
        "rate_lowest_left_alone": rates.min(),
        "rate_lowest_controlled": held.min(),
        "rate_full_bowl": rates[0],
        "rate_empty_bowl": rates[-1],
        "rate_full_bowl_controlled": held[0],
        "rate_empty_bowl_controlled": held[-1],
        "handbook_per_minute": wish.handbook / PER_MINUTE,
        **dict(zip(("aspect", "heading_deg"), wanted)),
        "rule": wish.rule,
        "answer": wish.answer,
        "share_counted": wish.flow.share,
        "mean_length_mm": wish.flow.length / MM,
        "longest_mm": room.longest / MM,
        "tallest_mm": room.tallest / MM,
        "part_width_mm": room.width / MM,
        "bowl_diameter_mm": size.diameter / MM,
        "least_diameters_mm": {rule: least / MM for rule, least in size.least.items()},
        "track_width_mm": size.track_width / MM,
        "clearance_mm": size.clearance / MM,
        "bend_mm": size.bend / MM,
        "climb_deg": size.climb / DEG,
        "steepest_climb_deg": wish.steepest / DEG,
        "turn_rise_mm": size.pitch / MM,
        "hopper_l": wish.hopper / LITRE,
        "sheet": sheets.quotation(study),
    }


def _springs(study) -> dict[Any, Any]:
    springs, machine = study.springs, study.bowl.machine
    return {
        "leaf_stiffness_n_per_mm": springs.leaf_stiffness / N_MM,
        "leaves": int(machine.leaves),
        "leaf_width_mm": machine.leaf_width / MM,
        "leaf_thickness_mm": machine.leaf_thickness / MM,
        "leaf_length_mm": machine.leaf_length / MM,
        "stiffness_n_per_mm": springs.stiffness / N_MM,
        "stiffness_with_over_without_twist": springs.twist,
        "bowl_mass_kg": machine.bowl_mass,
        "bowl_inertia_kg_m2": machine.bowl_inertia,
        "base_mass_kg": machine.base_mass,
        "base_inertia_kg_m2": machine.base_inertia,
        "spring_radius_mm": machine.spring_radius / MM,
        "spring_angle_deg": machine.spring_angle / DEG,
        "effective_mass_kg": springs.effective_mass,
        "effective_mass_base_held_kg": springs.effective_mass_held,
        "natural_frequency_hz": springs.natural_frequency,
        "natural_frequency_without_twist_hz": springs.natural_frequency_without_twist,
        "natural_frequency_base_held_hz": springs.natural_frequency_held,
        "natural_frequency_rigid_clamps_hz": springs.natural_frequency_rigid,
        "natural_frequency_rigid_clamps_end_hz": springs.natural_frequency_rigid_end,
        "drive_frequency_hz": study.stroke.frequency,
        "above_drive_percent": 100.0 * study.detuning,
        "gain": study.gain,
        "leaf_amplitude_mm": study.stroke.springs / MM,
        "leaf_stress_mpa": study.stress / MPA,
        "fatigue_stress_mpa": study.bowl.sizing.fatigue_stress / MPA,
        "drive_force_n": study.force,
        "magnet_force_n": study.magnet,
        "magnet_force_mean_n": mean_pull(study.magnet, study.stroke.frequency),
        "magnet_angle_deg": 90.0,
    }


def _stroke(study) -> dict[Any, Any]:
    moved, answer, bowl = study.stroke, study.answer, study.bowl
    return {
        "controller_percent": 100.0 * bowl.sizing.controller,
        "peak_to_peak_mm": moved.peak_to_peak / MM,
        "peak_to_peak_full_controller_mm": moved.peak_to_peak / bowl.sizing.controller / MM,
        "sticker_mm": moved.peak_to_peak / MM,
        "accelerometer_m_s2": {
            "peak": moved.acceleration,
            "rms": moved.rms,
            "peak_horizontal": moved.horizontal,
            "peak_vertical": moved.vertical,
        },
        "acceleration_ratio": moved.acceleration / bowl.gravity,
        "throw_number": answer.throw_number,
        "hop_height_mm": hop(bowl).height / MM,
        "hop_flight_mm": hop(bowl).flight / MM,
        "vibration_angle_deg": bowl.drive.vibration_angle / DEG,
        "vibration_angle_at_the_track_deg": bowl.drive.vibration_angle / DEG,
        "vibration_angle_at_the_springs_deg": bowl.machine.spring_angle / DEG,
        "velocity_mm_s": answer.velocity / MM_S,
        "regime": answer.regime,
        "hardest_impact_mm_s": answer.hardest_impact / MM_S,
    }


def angles(study):
    """Return the vibration angle over the radius as a frame: to the horizontal, and to the track."""
    return tables.frame(
        {
            "radius_mm": study.radii / MM,
            "vibration_angle_deg": study.angles / DEG,
            "to_the_track_deg": (study.angles - study.bowl.track.climb) / DEG,
        }
    )


def leaf_sets(sets):
    """Return sets of leaves as a frame.

    Parameters
    ----------
    sets : sequence of LeafSet
    """
    named = (
        {"change": [leaf_set.name for leaf_set in sets]} if any(leaf_set.name for leaf_set in sets) else {}
    )
    return tables.frame(
        named
        | {
            "leaf_thickness_mm": [leaf_set.thickness / MM for leaf_set in sets],
            "leaves": [leaf_set.leaves for leaf_set in sets],
            "natural_frequency_hz": [leaf_set.natural_frequency for leaf_set in sets],
            "by_t_squared_hz": [leaf_set.by_square for leaf_set in sets],
            "above_drive_percent": [100.0 * leaf_set.detuning for leaf_set in sets],
            "gain": [leaf_set.gain for leaf_set in sets],
            "leaf_stress_mpa": [leaf_set.stress / MPA for leaf_set in sets],
        }
    )


def emptying(study):
    """Return the bowl from full to empty as a frame, with rates where parts are counted."""
    emptied = study.emptying
    columns = {
        "fill_percent": 100.0 * emptied.levels,
        "parts_kg": emptied.masses,
        "natural_frequency_hz": emptied.natural_frequencies,
        "gain": emptied.gains,
        "stroke_over_that_of_the_empty_bowl": emptied.strokes,
        "vibration_angle_at_the_track_deg": emptied.angles / DEG,
        "spring_stroke_over_that_of_the_empty_bowl": emptied.springs,
        "velocity_mm_s": study.velocities / MM_S,
        "velocity_controlled_mm_s": study.controlled / MM_S,
    }
    if study.order is not None:
        columns["rate_per_minute"] = study.rates(study.velocities) / PER_MINUTE
        columns["rate_controlled_per_minute"] = study.rates(study.controlled) / PER_MINUTE
    return tables.frame({name: np.asarray(values) for name, values in columns.items()})


def summary(study, tried=None):
    """Return the record as a frame for people: the quotation sheet, with what was tried, or the machine."""
    rows = sheets.quotation(study, tried) if study.order is not None else sheets.machine(study, tried)
    return tables.frame({name: [row[name] for row in rows] for name in ("quantity", "value")})


def measured_summary(condition):
    """Return what was measured beside what should be, and the likely cause, as a table."""
    rows = [("parts in the bowl [%]", f"{100.0 * condition.fill:.3g}", "")]
    pairs = (
        (
            "stroke, peak to peak [mm]",
            condition.should["stroke"] / MM,
            condition.stroke and condition.stroke / MM,
        ),
        ("acceleration, peak [m/s2]", condition.should["acceleration"], condition.acceleration),
        ("frequency [Hz]", condition.should["frequency"], condition.frequency),
        ("velocity of a part [mm/s]", condition.velocity_should / MM_S, condition.velocity / MM_S),
    )
    rows += [(name, f"{should:.4g}", _measured_text(now)) for name, should, now in pairs]
    rows.append(("natural frequency, as drawn [Hz]", f"{condition.natural_frequency:.4g}", ""))
    rows += [("likely cause" if k == 0 else "", cause, "") for k, cause in enumerate(condition.causes)]
    return tables.frame(dict(zip(("quantity", "should be", "measured"), zip(*rows))))


def _measured_text(value) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.4g}"


def measured_document(condition) -> dict[Any, Any]:
    """Return a MeasuredMachine as the JSON document."""
    now = {
        "stroke_mm": condition.stroke and condition.stroke / MM,
        "acceleration_m_s2": condition.acceleration,
    }
    return {
        "fill_percent": 100.0 * condition.fill,
        "measured": now
        | {"frequency_hz": condition.frequency, "velocity_mm_s": _finite_velocity(condition.velocity)},
        "should": {
            "stroke_mm": condition.should["stroke"] / MM,
            "acceleration_m_s2": condition.should["acceleration"],
            "frequency_hz": condition.should["frequency"],
            "velocity_mm_s": _finite_velocity(condition.velocity_should),
        },
        "natural_frequency_hz": condition.natural_frequency,
        "causes": list(condition.causes),
    }


def _finite_velocity(velocity):
    return velocity / MM_S if math.isfinite(velocity) else None
