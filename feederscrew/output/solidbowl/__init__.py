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

    name = study.order.part.name
    return (
        offer.text("bowl.stl", printing.stl, study.solid),
        offer.text("bowl.3mf", printing.threemf, study.solid, f"bowl for {name}"),
        offer.text("bowl.pdf", drawing_sheet.pdf, study),
        offer.picture("bowl_solid.png", "The bowl, parts on its track", bowl_picture.figure, study),
    )
