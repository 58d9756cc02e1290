"""What ``feeder headings`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.headings import tables


def offers(study, settings):
    """Offer the files of a HeadingsStudy.

    Parameters
    ----------
    study : HeadingsStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    list of Offer
    """
    return [
        offer.document("headings.json", tables.document, study, settings),
        offer.table("headings.csv", tables.frame, study),
        *(
            offer.picture(
                f"headings_{one.name}.png", f"Stable headings of aspect {one.name} from above",
                _draw, study, place,
            )
            for place, one in enumerate(study.postures)
        ),
    ]  # fmt: skip


def _draw(study, place):
    from feederscrew.output.headings import figures

    posture = study.postures[place]
    title = f"{study.part.name}, aspect {posture.name}: heading, share"
    return figures.headings(posture, study.headings[place], study.track, title)
