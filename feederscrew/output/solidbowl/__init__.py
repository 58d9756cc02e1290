"""The bowl as a solid: what ``feeder bowl --solid`` writes beside the sheet."""

from feederscrew.output import marking
from feederscrew.output import offers as offer


def offers(study, tried=None, mark=None):
    """Return the files of the solid of a bowl.

    Parameters
    ----------
    study : MachineSheet
        With its solid.
    tried : Verified, optional
        What a trial of the bowl has shown: it is in the title block, and across what falls short.
    mark : str, optional
        Across every drawing; that of the trial without it.

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output.solidbowl import bowl_picture, drawing_sheet, printing

    name, cut, mark = study.order.part.name, study.solid.segments, marking.of_trial(tried, mark)
    title = " - ".join(filter(None, (f"bowl for {name}", mark)))
    pieces = (
        ()
        if cut is None
        else (
            *(
                offer.text(f"bowl_{one.name}.stl", printing.binary, one.vertices, one.faces)
                for one in cut.pieces
            ),
            offer.text("bowl_segments.3mf", printing.side_by_side, cut.pieces, f"{title}, in segments"),
        )
    )
    exact = () if study.solid.step is None else (offer.text("bowl.step", _step, study.solid),)
    picture = offer.picture("bowl_solid.png", "The bowl, parts on its track", bowl_picture.figure, study)
    return (
        *pieces,
        *exact,
        offer.text("bowl.stl", printing.stl, study.solid),
        offer.text("bowl.3mf", printing.threemf, study.solid, title),
        offer.text("bowl.pdf", drawing_sheet.pdf, study, tried, mark),
        *marking.pictures([picture], mark),
    )


def _step(solid):
    return solid.step.data
