"""The bowl as a solid: what ``feeder bowl --solid`` writes beside the sheet."""

from feederscrew.output import offers as offer


def offers(study):
    """Return the files of the solid of a bowl.

    Parameters
    ----------
    study : MachineSheet
        With its solid.

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output.solidbowl import bowl_picture, drawing_sheet, printing

    name, cut = study.order.part.name, study.solid.segments
    pieces = (
        ()
        if cut is None
        else (
            *(
                offer.text(f"bowl_{one.name}.stl", printing.binary, one.vertices, one.faces)
                for one in cut.pieces
            ),
            offer.text(
                "bowl_segments.3mf", printing.side_by_side, cut.pieces, f"bowl for {name}, in segments"
            ),
        )
    )
    exact = () if study.solid.step is None else (offer.text("bowl.step", _step, study.solid),)
    return (
        *pieces,
        *exact,
        offer.text("bowl.stl", printing.stl, study.solid),
        offer.text("bowl.3mf", printing.threemf, study.solid, f"bowl for {name}"),
        offer.text("bowl.pdf", drawing_sheet.pdf, study),
        offer.picture("bowl_solid.png", "The bowl, parts on its track", bowl_picture.figure, study),
    )


def _step(solid):
    return solid.step.data
