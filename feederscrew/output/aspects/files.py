"""What ``feeder aspects`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.aspects import tables
from feederscrew.output.graph import files as graph


def offers(study, *, tipping=False):
    """Offer the table of aspects and its pictures.

    Parameters
    ----------
    study : AspectsStudy
    tipping : bool
        Offer the tipping graph as well.

    Returns
    -------
    list of Offer
        ``names.yaml`` and ``aspects.png`` only of a part that has a shape.
    """
    offered = [
        offer.table("aspects.csv", tables.aspects, study),
        offer.document("aspects.json", tables.document, study),
        offer.picture("probabilities.png", "Probability of each aspect by every rule", _probabilities, study),
    ]
    if study.part.vertices is not None:
        offered.append(offer.text("names.yaml", tables.names, study))
        offered.append(offer.picture("aspects.png", "The part as it rests on each aspect", _sheet, study))
    return offered + (graph.offers(study) if tipping else [])


def _probabilities(study):
    from feederscrew.output.aspects import figures

    return figures.probabilities(study)


def _sheet(study):
    from feederscrew.output.aspects import figures

    return figures.sheet(study)
