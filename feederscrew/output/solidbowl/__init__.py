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
        On every drawing and solid; that of the trial without it.

    Returns
    -------
    tuple of Offer
    """
    from feederscrew.output.solidbowl import bowl_picture, drawing_sheet, printing

    name, cut, mark = study.order.part.name, study.solid.segments, marking.of_trial(tried, mark)
    title = marking.marked_title(f"bowl for {name}", mark)
    pieces = (
        ()
        if cut is None
        else (
            *(
                _file(f"bowl_{one.name}.stl", mark, printing.binary, one.vertices, one.faces, mark)
                for one in cut.pieces
            ),
            _file(
                "bowl_segments.3mf", mark, printing.side_by_side, cut.pieces, f"{title}, in segments", mark
            ),
        )
    )
    exact = () if study.solid.step is None else (_file("bowl.step", mark, _step, study.solid, mark),)
    picture = offer.picture("bowl_solid.png", "The bowl, parts on its track", bowl_picture.figure, study)
    return (
        *pieces,
        *exact,
        _file("bowl.stl", mark, printing.stl, study.solid, mark),
        _file("bowl.3mf", mark, printing.threemf, study.solid, title, mark),
        offer.text("bowl.pdf", drawing_sheet.pdf, study, tried, mark),
        *marking.pictures([picture], mark),
    )


def _file(name, mark, make, *arguments):
    """A file of the solid, of which nobody sees a mark but in its name."""
    return offer.text(marking.file_name(name, mark), make, *arguments)


def _step(solid, mark):
    return marking.mark_step(solid.step.data, mark)
