"""The machine and the bowl for a part as tables, documents and files: ``feeder bowl``."""

import math
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from feederscrew.bowl.verified import Verified
from feederscrew.columns import Frame
from feederscrew.conveying.hop import hop
from feederscrew.heavy import heavy
from feederscrew.machine import drive_sizing
from feederscrew.machine.condition import MeasuredMachine
from feederscrew.machine.springs import LeafSet, Rocking, mean_pull
from feederscrew.output import beside_bowl, marking, proof, solidbowl, tables
from feederscrew.output import machine_sheet as sheets
from feederscrew.output import offers as offer
from feederscrew.output.tables import row_of
from feederscrew.studies.bowl import MachineSheet, Order
from feederscrew.units import DEG, LITRE, MM, MM_S, PER_MINUTE

figures = heavy("feederscrew.output.machine_figures")


def offers(
    study: MachineSheet, trial: Verified | None = None, mark: str | None = None,
    fields: marking.SheetFields | None = None,
) -> tuple[offer.Offer, ...]:  # fmt: skip
    """Return the files of a machine.

    Parameters
    ----------
    study : MachineSheet
    trial : Verified, optional
        What a trial of exactly this bowl at this stroke has shown: it leads, and what falls short is marked.
    mark : str, optional
        Stands across every drawing in place of the trial's.
    fields : SheetFields, optional
        Date and revision of the drawings.

    Returns
    -------
    tuple of Offer
    """

    def document_with_trial() -> dict[str, Any]:
        return document(study, trial) | ({} if trial is None else {"verified": proof.block(trial)})

    alt = "The bowl from above and in section, with its sizes, and what it does from full to empty"
    drawn = offer.picture("bowl.png", alt, lambda: figures.bowl(study, trial))
    return (
        *(() if study.solid is None else solidbowl.offers(study, trial, mark, fields)),
        offer.document("bowl.json", document_with_trial),
        offer.table("bowl.csv", summary, study, trial),
        offer.table("bowl_angles.csv", _angles, study),
        offer.table("bowl_leaves.csv", leaf_sets, study.sets),
        offer.table("bowl_leaf_changes.csv", leaf_sets, study.changes),
        offer.table("bowl_emptying.csv", emptying, study),
        *marking.pictures([drawn], marking.of_trial(trial, mark)),
    )


def document(study: MachineSheet, trial: Verified | None = None) -> dict[str, Any]:
    """Return everything of a MachineSheet as the JSON document; where springs do not make the drive, both.

    With an order it has what stands beside the bowl, for the pose that the trial counted.
    """
    drive, other = study.bowl.drive, study.mismatch
    machine, sizing, leap = study.bowl.machine, study.bowl.sizing, hop(study.bowl)
    ends = "vibration_angle_at_the_springs_deg=spring_angle vibration_angle_at_the_track_deg=track_angle"
    motion = ends, "phase_deg throw_number velocity_mm_s"
    kind = drive_sizing.TWO_AXIS if drive_sizing.is_two_axis(drive) else drive_sizing.LEAF_SPRING
    return {
        "drive_kind": kind,
        **row_of(drive, "phase_deg"),
        "drive_needs": sheets.two_axis(drive) or None,
        "springs_make_this_drive": other is None,
        "drive_asked_for": None if other is None else row_of(other.wanted, *motion),
        "drive_of_the_springs": None if other is None else row_of(other.machine, *motion),
        **({} if study.order is None else _order_entries(study, study.order)),
        **row_of(study, "turns bowl_depth_mm=depth leaf_stiffness_n_per_mm=springs.leaf_stiffness"),
        "leaves": int(machine.leaves),
        **row_of(machine, "leaf_width_mm leaf_thickness_mm leaf_length_mm"),
        **row_of(study.springs, "stiffness_n_per_mm stiffness_with_over_without_twist=twist"),
        **row_of(machine, "bowl_mass_kg bowl_inertia_kg_m2 base_mass_kg base_inertia_kg_m2"),
        **row_of(machine, "spring_radius_mm spring_angle_deg"),
        **row_of(
            study.springs,
            "effective_mass_kg effective_mass_base_held_kg=effective_mass_held natural_frequency_hz",
            "natural_frequency_without_twist_hz natural_frequency_base_held_hz=natural_frequency_held",
            "natural_frequency_rigid_clamps_hz=natural_frequency_rigid",
            "natural_frequency_rigid_clamps_end_hz=natural_frequency_rigid_end",
        ),
        **row_of(
            study,
            "drive_frequency_hz=stroke.frequency above_drive_percent=detuning gain",
            "leaf_amplitude_mm=stroke.springs leaf_stress_mpa=stress",
            "fatigue_stress_mpa=bowl.sizing.fatigue_stress drive_force_n=force magnet_force_n=magnet",
        ),
        "magnet_force_mean_n": mean_pull(study.magnet, study.stroke.frequency),
        "magnet_angle_deg": 90.0,
        **row_of(study, "controller_percent=bowl.sizing.controller peak_to_peak_mm=stroke.peak_to_peak"),
        "peak_to_peak_full_controller_mm": study.stroke.peak_to_peak / sizing.controller / MM,
        **row_of(study, "sticker_mm=stroke.peak_to_peak"),
        "accelerometer_m_s2": row_of(
            study.stroke, "peak=acceleration rms peak_horizontal=horizontal peak_vertical=vertical"
        ),
        "acceleration_ratio": study.stroke.acceleration / study.bowl.gravity,
        **row_of(study.answer, "throw_number"),
        **row_of(leap, "hop_height_mm=height hop_flight_mm=flight"),
        **row_of(drive, "vibration_angle_deg vibration_angle_at_the_track_deg=vibration_angle"),
        **row_of(machine, "vibration_angle_at_the_springs_deg=spring_angle"),
        **row_of(study.answer, "velocity_mm_s regime hardest_impact_mm_s"),
        "angle_by_radius": _angles(study),
        "leaf_changes": leaf_sets(study.changes),
        "leaf_sets": leaf_sets(study.sets),
        "full_bowl": {
            "filled_with": study.filled_with,
            "volume_l": study.fill.volume / LITRE,
            **row_of(study.fill, "mass_kg inertia_kg_m2"),
            "mass_carried_kg": study.fill.mass * sizing.carried,
        },
        "emptying": emptying(study),
        "remarks": list(study.remarks),
        "warnings": list(study.remarks),
        **beside_bowl.document(beside_bowl.find_beside(study, trial)),
        **({} if study.solid is None else solidbowl.document(study.solid)),
        **({} if (rocking := study.rocking) is None else _rocking_entries(study, *rocking)),
    }


def _rocking_entries(study: MachineSheet, as_is: Rocking, balanced: Rocking) -> dict[str, Any]:
    ends = "stroke_round_least=least stroke_round_greatest=greatest"
    return {
        **row_of(as_is, ends, "stroke_round_greatest_at_deg=angle"),
        **{f"balanced_{name}": value for name, value in row_of(balanced, ends).items()},
        **row_of(balanced, "effective_mass_balanced_kg=effective_mass"),
        **row_of(study.springs, "effective_mass_centred_kg"),
    }


def _order_entries(study: MachineSheet, wish: Order) -> dict[str, Any]:
    size = wish.size
    wanted = (None, None) if wish.wanted is None else (wish.wanted[0], wish.wanted[1] / DEG)
    rates, held = (study.rates(v) / PER_MINUTE for v in (study.velocities, study.controlled))
    return {
        "target_per_minute": wish.target / PER_MINUTE,
        **row_of(study.lowest, "parts_per_minute=rate lowest_at_fill_percent=level lowest_with=control"),
        "rate_at_this_stroke": float(study.rates(study.answer.velocity)) / PER_MINUTE,
        "rate_lowest_left_alone": rates.min(),
        "rate_lowest_controlled": held.min(),
        "rate_full_bowl": rates[0],
        "rate_empty_bowl": rates[-1],
        "rate_full_bowl_controlled": held[0],
        "rate_empty_bowl_controlled": held[-1],
        **row_of(wish, "handbook_per_minute=handbook"),
        **dict(zip(("aspect", "heading_deg"), wanted)),
        **row_of(wish, "rule answer share_counted=flow.share mean_length_mm=flow.length"),
        **row_of(wish.lying, "longest_mm tallest_mm part_width_mm=width"),
        "bowl_diameter_mm": size.diameter / MM,
        "least_diameters_mm": {rule: least / MM for rule, least in size.least.items()},
        **row_of(size, "track_width_mm clearance_mm bend_mm climb_deg"),
        **row_of(wish, "steepest_climb_deg=steepest turn_rise_mm=size.pitch"),
        "hopper_l": wish.hopper / LITRE,
        "sheet": sheets.quotation(study),
    }


def _angles(study: MachineSheet) -> Frame:
    columns = row_of(study, "radius_mm=radii vibration_angle_deg=angles")
    return Frame.of(columns | {"to_the_track_deg": (study.angles - study.bowl.track.climb) / DEG})


def leaf_sets(sets: Sequence[LeafSet]) -> Frame:
    """Return sets of leaves, each a LeafSet, as a frame."""
    table = tables.table_of(
        sets,
        "change=name leaf_thickness_mm=thickness leaves natural_frequency_hz by_t_squared_hz=by_square",
        "above_drive_percent=detuning gain leaf_stress_mpa=stress",
    )
    return table if any(table["change"]) else table.without(("change",))


def emptying(study: MachineSheet) -> Frame:
    """Return the bowl from full to empty as a frame, with rates where parts are counted."""
    columns = row_of(
        study.emptying,
        "fill_percent=levels parts_kg=masses natural_frequency_hz=natural_frequencies gain=gains",
        "stroke_over_that_of_the_empty_bowl=strokes vibration_angle_at_the_track_deg=angles",
        "spring_stroke_over_that_of_the_empty_bowl=springs",
    )
    columns |= row_of(study, "velocity_mm_s=velocities velocity_controlled_mm_s=controlled")
    if study.order is not None:
        columns["rate_per_minute"] = study.rates(study.velocities) / PER_MINUTE
        columns["rate_controlled_per_minute"] = study.rates(study.controlled) / PER_MINUTE
    return Frame.of({name: np.asarray(values) for name, values in columns.items()})


def summary(study: MachineSheet, trial: Verified | None = None) -> Frame:
    """Return the machine as a frame for people: the quotation sheet, with what was tried, or the machine.

    Parameters
    ----------
    study : MachineSheet
    trial : Verified, optional
        That a bowl file records of exactly this bowl.

    Returns
    -------
    Frame
    """
    return Frame.of_rows(sheets.quotation(study, trial), ("quantity", "value"))


def measured_summary(condition: MeasuredMachine) -> Frame:
    """Return what was measured beside what should be, and the likely cause, as a table.

    Parameters
    ----------
    condition : MeasuredMachine

    Returns
    -------
    Frame
    """
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
    return Frame.of_cells(("quantity", "should be", "measured"), rows)


def measured_document(condition: MeasuredMachine) -> dict[str, Any]:
    """Return a MeasuredMachine as the JSON document."""
    names = "stroke_mm acceleration_m_s2 frequency_hz velocity_mm_s"
    should = SimpleNamespace(**condition.should, velocity=condition.velocity_should)
    return {
        **row_of(condition, "fill_percent=fill"),
        "measured": row_of(condition, names),
        "should": row_of(should, names),
        **row_of(condition, "natural_frequency_hz"),
        "causes": list(condition.causes),
    }
