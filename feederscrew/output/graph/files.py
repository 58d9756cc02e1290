"""The files of the tipping graph."""

from feederscrew.output import offers as offer
from feederscrew.output.graph import tables


def offers(study):
    """Offer the table and the drawing of what tips into what.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    list of Offer
    """
    alt = "Tipping graph: which aspect tips into which, and the lift it takes"
    return [
        offer.table("graph.csv", tables.transitions, study),
        offer.picture("graph.png", alt, _graph, study),
    ]


def _graph(study):
    from feederscrew.output.graph import figures

    shares = study.aspects.probabilities["quasistatic"]
    return figures.of_part(study, study.transitions, shares)
