"""The machine and the bowl for a part as tables, documents and files: ``feeder bowl``."""

import math
from collections.abc import Sequence

from feederscrew.base.columns import Document, Frame, of_records, values
from feederscrew.base.heavy import heavy
from feederscrew.base.units import DEG, MM, MM_S
from feederscrew.bowl.verified import Verified
from feederscrew.machine.condition import CONDITION_COLUMNS, MeasuredMachine
from feederscrew.machine.sheet import (
    DRIVE_COLUMNS,
    FULL_BOWL_COLUMNS,
    MACHINE_COLUMNS,
    MISMATCH_COLUMNS,
    ORDER_COLUMNS,
    MachineSheet,
    Order,
)
from feederscrew.machine.springs import LEAF_SET_COLUMNS, ROCKING_COLUMNS, LeafSet, Rocking
from feederscrew.output import beside_bowl, marking, proof, solidbowl
from feederscrew.output import machine_sheet as sheets
from feederscrew.output import offers as offer
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import machine_text

figures = heavy("feederscrew.output.machine_figures")


def offers(
    study: MachineSheet,
    trial: Verified | None = None,
    mark: str | None = None,
    fields: marking.SheetFields | None = None,
) -> tuple[offer.Offer, ...]:
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

    def document_with_trial() -> Document:
        return document(study, trial) | ({} if trial is None else {"verified": proof.block(trial)})

    alt = "The bowl from above and in section, with its sizes, and what it does from full to empty"
    drawn = offer.picture("bowl.png", alt, lambda: figures.bowl(study, trial))
    return (
        *(() if study.solid is None else solidbowl.offers(study, trial, mark, fields)),
        offer.document("bowl.json", document_with_trial),
        offer.table("bowl.csv", summary, study, trial),
        offer.table("bowl_angles.csv", study.angles_table),
        offer.table("bowl_leaves.csv", leaf_sets, study.sets),
        offer.table("bowl_leaf_changes.csv", leaf_sets, study.changes),
        offer.table("bowl_emptying.csv", study.emptying_table),
        *marking.pictures([drawn], marking.of_trial(trial, mark)),
    )


def document(study: MachineSheet, trial: Verified | None = None) -> Document:
    """Return everything of a MachineSheet as the JSON document; where springs do not make the drive, both.

    With an order it has what stands beside the bowl, for the pose that the trial counted.
    """
    return {
        **values(DRIVE_COLUMNS, study),
        "drive_needs": sheets.two_axis(study.bowl.drive) or None,
        **values(MISMATCH_COLUMNS, study),
        **({} if study.order is None else _order_entries(study, study.order)),
        **values(MACHINE_COLUMNS, study),
        "angle_by_radius": study.angles_table(),
        "leaf_changes": leaf_sets(study.changes),
        "leaf_sets": leaf_sets(study.sets),
        "full_bowl": values(FULL_BOWL_COLUMNS, study),
        "emptying": study.emptying_table(),
        "remarks": list(study.remarks),
        "warnings": list(study.remarks),
        **beside_bowl.document(beside_bowl.find_beside(study, trial)),
        **({} if study.solid is None else solidbowl.document(study.solid)),
        **({} if (rocking := study.rocking) is None else _rocking_entries(study, *rocking)),
    }


def _rocking_entries(study: MachineSheet, as_is: Rocking, balanced: Rocking) -> Document:
    return {
        **values(ROCKING_COLUMNS, as_is),
        "stroke_round_greatest_at_deg": as_is.angle / DEG,
        **{f"balanced_{name}": value for name, value in values(ROCKING_COLUMNS, balanced).items()},
        "effective_mass_balanced_kg": balanced.effective_mass,
        "effective_mass_centred_kg": study.springs.effective_mass_centred,
    }


def _order_entries(study: MachineSheet, wish: Order) -> Document:
    return {**values(ORDER_COLUMNS, (study, wish)), "sheet": sheets.quotation(study)}


def leaf_sets(sets: Sequence[LeafSet]) -> Frame:
    """Return sets of leaves, each a LeafSet, as a frame."""
    table = of_records(LEAF_SET_COLUMNS, sets)
    return table if any(table["change"]) else table.without(("change",))


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


def measured_document(condition: MeasuredMachine) -> Document:
    """Return a MeasuredMachine as the JSON document."""
    return values(CONDITION_COLUMNS, condition)


MACHINE_VIEW = RecordView(machine_text, offers, "bowl")
