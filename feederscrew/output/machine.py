"""The machine and the bowl for a part as tables, documents and files: ``feeder bowl``."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.conveying.hop import hop
from feederscrew.heavy import heavy
from feederscrew.machine import drive_sizing
from feederscrew.machine.springs import mean_pull
from feederscrew.output import machine_sheet as sheets
from feederscrew.output import marking, proof, solidbowl, tables
from feederscrew.output import offers as offer
from feederscrew.output.tables import Frame
from feederscrew.units import DEG, MM, MM_S, PER_MINUTE

figures = heavy("feederscrew.output.machine_figures")

N_MM, MPA = units.factor("N/mm", "stiffness"), units.factor("MPa", "stress")
LITRE = units.factor("l", "volume")


def offers(
    study: Any, tried: Any = None, mark: str | None = None, fields: Any = None
) -> tuple[offer.Offer, ...]:
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
    """

    def whole() -> dict[str, Any]:
        return document(study) | ({} if tried is None else {"verified": proof.block(tried)})

    alt = "The bowl from above and in section, with its sizes, and what it does from full to empty"
    drawn = offer.picture("bowl.png", alt, lambda: figures.bowl(study, tried))
    return (
        *(() if study.solid is None else solidbowl.offers(study, tried, mark, fields)),
        offer.document("bowl.json", whole),
        offer.table("bowl.csv", summary, study, tried),
        offer.table("bowl_angles.csv", _angles, study),
        offer.table("bowl_leaves.csv", leaf_sets, study.sets),
        offer.table("bowl_leaf_changes.csv", leaf_sets, study.changes),
        offer.table("bowl_emptying.csv", emptying, study),
        *marking.pictures([drawn], marking.of_trial(tried, mark)),
    )


def document(study: Any) -> dict[str, Any]:
    """Return everything of a MachineSheet as the JSON document; where springs do not make the drive, both."""
    drive, other, moved, answer = study.bowl.drive, study.mismatch, study.stroke, study.answer
    springs, machine, sizing, fill = study.springs, study.bowl.machine, study.bowl.sizing, study.fill

    leap = hop(study.bowl)

    def motion(figures: Any) -> dict[str, Any]:
        return {
            "vibration_angle_at_the_springs_deg": figures.spring_angle / DEG,
            "vibration_angle_at_the_track_deg": figures.track_angle / DEG,
            "phase_deg": figures.phase / DEG,
            "throw_number": figures.throw_number,
            "velocity_mm_s": _mm_s(figures.velocity),
        }

    kind = drive_sizing.TWO_AXIS if drive_sizing.is_two_axis(drive) else drive_sizing.LEAF_SPRING
    return {
        "drive_kind": kind,
        "phase_deg": drive.phase / DEG,
        "drive_needs": sheets.two_axis(drive) or None,
        "springs_make_this_drive": other is None,
        "drive_asked_for": None if other is None else motion(other.wanted),
        "drive_of_the_springs": None if other is None else motion(other.machine),
        **({} if study.order is None else _order(study)),
        "turns": study.turns if np.isfinite(study.turns) else None,
        "bowl_depth_mm": study.depth / MM,
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
        "drive_frequency_hz": moved.frequency,
        "above_drive_percent": 100.0 * study.detuning,
        "gain": study.gain,
        "leaf_amplitude_mm": moved.springs / MM,
        "leaf_stress_mpa": study.stress / MPA,
        "fatigue_stress_mpa": sizing.fatigue_stress / MPA,
        "drive_force_n": study.force,
        "magnet_force_n": study.magnet,
        "magnet_force_mean_n": mean_pull(study.magnet, moved.frequency),
        "magnet_angle_deg": 90.0,
        "controller_percent": 100.0 * sizing.controller,
        "peak_to_peak_mm": moved.peak_to_peak / MM,
        "peak_to_peak_full_controller_mm": moved.peak_to_peak / sizing.controller / MM,
        "sticker_mm": moved.peak_to_peak / MM,
        "accelerometer_m_s2": {
            "peak": moved.acceleration,
            "rms": moved.rms,
            "peak_horizontal": moved.horizontal,
            "peak_vertical": moved.vertical,
        },
        "acceleration_ratio": moved.acceleration / study.bowl.gravity,
        "throw_number": answer.throw_number,
        "hop_height_mm": leap.height / MM,
        "hop_flight_mm": leap.flight / MM,
        "vibration_angle_deg": drive.vibration_angle / DEG,
        "vibration_angle_at_the_track_deg": drive.vibration_angle / DEG,
        "vibration_angle_at_the_springs_deg": machine.spring_angle / DEG,
        "velocity_mm_s": answer.velocity / MM_S,
        "regime": answer.regime,
        "hardest_impact_mm_s": answer.hardest_impact / MM_S,
        "angle_by_radius": _angles(study),
        "leaf_changes": leaf_sets(study.changes),
        "leaf_sets": leaf_sets(study.sets),
        "full_bowl": {
            "filled_with": study.filled_with,
            "volume_l": fill.volume / LITRE,
            "mass_kg": fill.mass,
            "inertia_kg_m2": fill.inertia,
            "mass_carried_kg": fill.mass * sizing.carried,
        },
        "emptying": emptying(study),
        "remarks": list(study.remarks),
        "warnings": list(study.remarks),
        **({} if study.solid is None else solidbowl.document(study.solid)),
        **({} if study.rocking is None else _rocking(study)),
    }


def _rocking(study: Any) -> dict[str, Any]:
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


def _order(study: Any) -> dict[str, Any]:
    """What an order asked for and what was sized for it."""
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


def _angles(study: Any) -> Frame:
    """The vibration angle over the radius: to the horizontal, and to the track."""
    return tables.frame(
        {
            "radius_mm": study.radii / MM,
            "vibration_angle_deg": study.angles / DEG,
            "to_the_track_deg": (study.angles - study.bowl.track.climb) / DEG,
        }
    )


def leaf_sets(sets: Sequence[Any]) -> Frame:
    """Return sets of leaves, each a LeafSet, as a frame."""
    names = [leaf_set.name for leaf_set in sets]
    columns: dict[str, Any] = {"change": names} if any(names) else {}
    columns |= {
        "leaf_thickness_mm": [leaf_set.thickness / MM for leaf_set in sets],
        "leaves": [leaf_set.leaves for leaf_set in sets],
        "natural_frequency_hz": [leaf_set.natural_frequency for leaf_set in sets],
        "by_t_squared_hz": [leaf_set.by_square for leaf_set in sets],
        "above_drive_percent": [100.0 * leaf_set.detuning for leaf_set in sets],
        "gain": [leaf_set.gain for leaf_set in sets],
        "leaf_stress_mpa": [leaf_set.stress / MPA for leaf_set in sets],
    }
    return tables.frame(columns)


def emptying(study: Any) -> Frame:
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


def summary(study: Any, tried: Any = None) -> Frame:
    """Return the record as a frame for people: the quotation sheet, with what was tried, or the machine."""
    rows = sheets.quotation(study, tried) if study.order is not None else sheets.machine(study, tried)
    return tables.of_rows(rows, ("quantity", "value"))


def measured_summary(condition: Any) -> Frame:
    """Return what was measured beside what should be, and the likely cause, as a table."""
    should, stroke = condition.should, condition.stroke
    pairs = (
        ("stroke, peak to peak [mm]", should["stroke"] / MM, stroke and stroke / MM),
        ("acceleration, peak [m/s2]", should["acceleration"], condition.acceleration),
        ("frequency [Hz]", should["frequency"], condition.frequency),
        ("velocity of a part [mm/s]", condition.velocity_should / MM_S, condition.velocity / MM_S),
    )
    rows = [("parts in the bowl [%]", f"{100.0 * condition.fill:.3g}", "")]
    for name, wanted, now in pairs:
        rows.append((name, f"{wanted:.4g}", "-" if now is None or math.isnan(now) else f"{now:.4g}"))
    rows.append(("natural frequency, as drawn [Hz]", f"{condition.natural_frequency:.4g}", ""))
    rows += [("likely cause" if k == 0 else "", cause, "") for k, cause in enumerate(condition.causes)]
    return tables.of_cells(("quantity", "should be", "measured"), rows)


def measured_document(condition: Any) -> dict[str, Any]:
    """Return a MeasuredMachine as the JSON document."""

    def values(stroke: Any, acceleration: Any, frequency: Any, velocity: float) -> dict[str, Any]:
        mm = stroke and stroke / MM
        motion = {"stroke_mm": mm, "acceleration_m_s2": acceleration, "frequency_hz": frequency}
        return motion | {"velocity_mm_s": _mm_s(velocity)}

    now = condition.stroke, condition.acceleration, condition.frequency, condition.velocity
    should = condition.should
    return {
        "fill_percent": 100.0 * condition.fill,
        "measured": values(*now),
        "should": values(
            should["stroke"], should["acceleration"], should["frequency"], condition.velocity_should
        ),
        "natural_frequency_hz": condition.natural_frequency,
        "causes": list(condition.causes),
    }


def _mm_s(velocity: float) -> float | None:
    return velocity / MM_S if math.isfinite(velocity) else None
