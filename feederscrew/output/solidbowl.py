"""The bowl as a solid: its document, and the files of ``feeder bowl --solid``."""

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from feederscrew.base.columns import values
from feederscrew.base.units import MM
from feederscrew.cad import segments
from feederscrew.cad.closed_body import SOLID_COLUMNS
from feederscrew.cad.segments import SEGMENTS_COLUMNS
from feederscrew.output import marking
from feederscrew.output import offers as offer

if TYPE_CHECKING:
    from feederscrew.bowl.verified import Verified
    from feederscrew.cad.closed_body import BowlSolid
    from feederscrew.machine.sheet import MachineSheet


def offers(
    study: "MachineSheet",
    trial: "Verified | None" = None,
    mark: str | None = None,
    fields: marking.SheetFields | None = None,
) -> tuple[offer.Offer, ...]:
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
    from feederscrew.output import beside_bowl, bowl_sheet, solid_files, solidbowl_views, tooling_drawing

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
        strip = solid.plan.stretch
        shop = "" if strip is None else tooling_drawing.shop_names(strip)
        pieces.append(file("bowl.step", marking.mark_step, solid.step.data, shop))
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
    overhangs = {name: area / MM**2 for name, area in segments.overhangs(solid).items()}
    measures = values(SOLID_COLUMNS, solid) | {"overhangs_mm2": overhangs}
    if solid.segments is not None:
        measures |= values(SEGMENTS_COLUMNS, solid.segments)
    if solid.step is not None:
        not_exact = [
            "what runs along the track is ruled between cubic splines through its helices every 0.1 rad",
            "the fillet below the track is six ruled strips",
            "slanted edges of cuts are splines",
        ]
        if solid.plan.stairs is not None:
            ruled = "it is ruled between splines through 16 places a quarter turn"
            not_exact.append(f"the wall is no surface of revolution: {ruled}")
        measures["step"] = {
            "volume_mm3": solid.step.volume / MM**3,
            "faces": solid.step.faces,
            "track_off_mm": solid.step.off / MM,
            "not_exact": not_exact,
        }
    return measures
