"""The bowl as a solid: its document, and the files of ``feeder bowl --solid``."""

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from feederscrew.output import marking
from feederscrew.output import offers as offer
from feederscrew.output.tables import row_of
from feederscrew.solidbowl import segments
from feederscrew.units import DEG, MM

if TYPE_CHECKING:
    from feederscrew.bowl.verified import Verified
    from feederscrew.solidbowl.closed_body import BowlSolid
    from feederscrew.studies.bowl import MachineSheet


def offers(
    study: "MachineSheet", trial: "Verified | None" = None, mark: str | None = None,
    fields: marking.SheetFields | None = None,
) -> tuple[offer.Offer, ...]:  # fmt: skip
    """Return the files of the solid of a bowl.

    Parameters
    ----------
    study : MachineSheet
    trial : Verified, optional
        What a trial of the bowl has shown: it is in the title block, and across what falls short.
    mark : str, optional
        Stands on every drawing and solid in its place.
    fields : SheetFields, optional
        Date and revision of the drawing.

    Returns
    -------
    tuple of Offer
        Empty without a solid.
    """
    from feederscrew.output import beside_bowl, bowl_sheet, solid_files, solidbowl_views

    solid, order, mark = study.solid, study.order, marking.of_trial(trial, mark)
    if solid is None or order is None:
        return ()
    name = order.part.name
    title = marking.marked_title(f"bowl for {name}", mark)
    sheet_title = marking.marked_title(f"{name}: bowl", mark)
    sheets = functools.cache(lambda: bowl_sheet.draw_sheets(study, trial, mark, fields))

    def file(name: str, make: Callable[..., str | bytes], *arguments: Any) -> offer.Offer:
        """A file of which nobody sees a mark but in its name."""
        return offer.text(marking.file_name(name, mark), make, *arguments, mark)

    pieces = []
    if solid.segments is not None:
        of_pieces = solid.segments.pieces
        pieces += [file(f"bowl_{piece.name}.stl", solid_files.bowl_stl, piece) for piece in of_pieces]
        pieces.append(file("bowl_segments.3mf", solid_files.segments_3mf, of_pieces, f"{title}, in segments"))
    if solid.step is not None:
        pieces.append(file("bowl.step", marking.mark_step, solid.step.data))
    alt = "The bowl, parts on its track"
    beside = beside_bowl.find_beside(study, trial)
    stations = () if beside is None else (offer.table("bowl_stations.csv", beside_bowl.table, beside),)
    picture = offer.picture("bowl_solid.png", alt, solidbowl_views.figure, solid, order.part)
    return (
        *pieces,
        file("bowl.stl", solid_files.bowl_stl, solid),
        file("bowl.3mf", solid_files.bowl_3mf, solid, title),
        offer.text("bowl.pdf", lambda: sheets().pdf(sheet_title)),
        offer.text("bowl.dxf", lambda: sheets().dxf()),
        *stations,
        *marking.pictures([replace(picture, is_apart=True)], mark),
    )


def document(solid: "BowlSolid") -> dict[str, Any]:
    """Return what a BowlSolid measures and weighs, and of its STEP file what it was when opened again."""
    plan, extent = solid.plan, solid.vertices.max(axis=0) - solid.vertices.min(axis=0)
    measures = {
        "diameter_mm": 2.0 * plan.path.radius / MM,
        "solid_volume_mm3": solid.volume / MM**3,
        **row_of(solid, "solid_mass_kg=mass solid_inertia_kg_m2=inertia"),
        "solid_centre_of_mass_mm": list(solid.centre / MM),
        "balance_weight_kg": solid.balance[0],
        "balance_angle_deg": solid.balance[1] / DEG,
        "balance_radius_mm": solid.balanced_at / MM,
        "solid_extent_mm": list(extent / MM),
        "solid_facets": len(solid.faces),
        "material": plan.material.name,
        "shape": "cylinder" if plan.stairs is None else plan.stairs.shape,
        "falls_to": solid.falls,
        "hand": "left" if plan.left else "right",
        **row_of(plan.material, "wall_mm floor_mm track_plate_mm=plate"),
        **row_of(
            plan,
            "wall_height_mm=top dome_rise_mm=dome solid_turns=turns outlet_height_mm outlet_angle_deg=turned",
            "bolts bolt_hole_mm=bolt bolt_circle_mm chord_mm",
        ),
        "separate_parts": [name for name, _, _ in solid.gates],
        "overhangs_mm2": {name: area / MM**2 for name, area in segments.overhangs(solid).items()},
    }
    if (cut := solid.segments) is not None:
        measures |= {
            "segments": [
                {"name": p.name, "size_mm": [x / MM for x in p.size], "volume_mm3": p.volume / MM**3}
                for p in cut.pieces
            ],
            **row_of(cut, "dowels dowel_mm dowel_length_mm"),
            "screws": len(cut.screws),
            "screw": segments.SCREW_NAME if len(cut.screws) else None,
            "seam_ends": cut.ends[1],
            "seam_ends_without_screw": cut.ends[0],
            "seams_deg": cut.turned / DEG,
        }
    if solid.step is not None:
        not_exact = [
            "what runs along the track is ruled between cubic splines through its helices every 0.1 rad",
            "the fillet below the track is six ruled strips",
            "slanted edges of cuts are splines",
        ]
        if plan.stairs is not None:
            ruled = "it is ruled between splines through 16 places a quarter turn"
            not_exact.append(f"the wall is no surface of revolution: {ruled}")
        measures["step"] = {
            "volume_mm3": solid.step.volume / MM**3,
            "faces": solid.step.faces,
            "track_off_mm": solid.step.off / MM,
            "not_exact": not_exact,
        }
    return measures
