"""The bowl as a solid: its document, and the files of ``feeder bowl --solid``."""

import functools
from typing import Any

from feederscrew.output import marking
from feederscrew.output import offers as offer
from feederscrew.solidbowl import segments
from feederscrew.solidbowl.segments import overhangs
from feederscrew.units import DEG, MM

NOT_EXACT = (
    "what runs along the track is ruled between cubic splines through its helices every 0.1 rad",
    "the fillet below the track is six ruled strips",
    "slanted edges of cuts are splines",
)
RULED_WALL_NOTE = (
    "the wall is no surface of revolution: it is ruled between splines through 16 places a quarter turn"
)


def offers(study, tried=None, mark=None, fields=None) -> tuple[Any, ...]:
    """Return the files of the solid of a bowl.

    Parameters
    ----------
    study : MachineSheet
        With its solid.
    tried : Verified, optional
        What a trial of the bowl has shown: it is in the title block, and across what falls short.
    mark : str, optional
        On every drawing and solid; that of the trial without it.
    fields : marking.SheetFields, optional
        Date and revision of the drawing.

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output import bowl_sheet, solid_files, solidbowl_views

    name, cut, mark = study.order.part.name, study.solid.segments, marking.of_trial(tried, mark)
    title = marking.marked_title(f"bowl for {name}", mark)
    sheet_title = marking.marked_title(f"{name}: bowl", mark)
    sheets = functools.cache(lambda: bowl_sheet.draw_sheets(study, tried, mark, fields))
    pieces = (
        ()
        if cut is None
        else (
            *(
                _file(
                    f"bowl_{piece.name}.stl", mark, solid_files.binary_stl, piece.vertices, piece.faces, mark
                )
                for piece in cut.pieces
            ),
            _file(
                "bowl_segments.3mf", mark, solid_files.segments_3mf, cut.pieces, f"{title}, in segments", mark
            ),
        )
    )
    exact = () if study.solid.step is None else (_file("bowl.step", mark, _marked_step, study.solid, mark),)
    picture = offer.picture("bowl_solid.png", "The bowl, parts on its track", solidbowl_views.figure, study)
    return (
        *pieces,
        *exact,
        _file("bowl.stl", mark, solid_files.bowl_stl, study.solid, mark),
        _file("bowl.3mf", mark, solid_files.bowl_3mf, study.solid, title, mark),
        offer.text("bowl.pdf", lambda: sheets().pdf(sheet_title)),
        offer.text("bowl.dxf", lambda: sheets().dxf()),
        *marking.pictures([picture], mark),
    )


def _file(name, mark, make, *arguments):
    """A file of the solid, of which nobody sees a mark but in its name."""
    return offer.text(marking.file_name(name, mark), make, *arguments)


def _marked_step(solid, mark):
    return marking.mark_step(solid.step.data, mark)


def document(solid) -> dict[Any, Any]:
    """Return what a bowl as a solid measures and weighs.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    dict
    """
    plan, extent = solid.plan, solid.vertices.max(axis=0) - solid.vertices.min(axis=0)
    return {
        "diameter_mm": 2.0 * plan.path.radius / MM,
        "solid_volume_mm3": solid.volume / MM**3,
        "solid_mass_kg": solid.mass,
        "solid_inertia_kg_m2": solid.inertia,
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
        "wall_mm": plan.material.wall / MM,
        "floor_mm": plan.material.floor / MM,
        "track_plate_mm": plan.material.plate / MM,
        "wall_height_mm": plan.top / MM,
        "dome_rise_mm": plan.dome / MM,
        "solid_turns": plan.turns,
        "outlet_height_mm": plan.outlet_height / MM,
        "outlet_angle_deg": plan.turned / DEG,
        "bolts": plan.bolts,
        "bolt_hole_mm": plan.bolt / MM,
        "bolt_circle_mm": plan.bolt_circle / MM,
        "chord_mm": plan.chord / MM,
        "separate_parts": [name for name, _, _ in solid.gates],
        "overhangs_mm2": {name: area / MM**2 for name, area in overhangs(solid).items()},
        **({} if solid.segments is None else _segments(solid.segments)),
        **({} if solid.step is None else {"step": _step(solid)}),
    }


def _step(solid) -> dict[Any, Any]:
    """What the STEP file was found to be when it was opened again."""
    step, leans = solid.step, solid.plan.stairs is not None
    return {
        "volume_mm3": step.volume / MM**3,
        "faces": step.faces,
        "track_off_mm": step.off / MM,
        "not_exact": [*NOT_EXACT, *([RULED_WALL_NOTE] if leans else [])],
    }


def _segments(cut) -> dict[Any, Any]:
    return {
        "segments": [
            {"name": piece.name, "size_mm": [x / MM for x in piece.size], "volume_mm3": piece.volume / MM**3}
            for piece in cut.pieces
        ],
        "dowels": cut.dowels,
        "dowel_mm": cut.dowel / MM,
        "dowel_length_mm": cut.dowel_length / MM,
        "screws": len(cut.screws),
        "screw": segments.SCREW_NAME if len(cut.screws) else None,
        "seam_ends": cut.ends[1],
        "seam_ends_without_screw": cut.ends[0],
        "seams_deg": cut.turned / DEG,
    }
