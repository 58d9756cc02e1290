"""What ``feeder drop --launches`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.drop import toss_tables


def offers(study):
    """Offer where each toss leads.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    list of Offer
    """
    offered = [
        offer.table("tosses.csv", toss_tables.tosses, study),
        offer.document("tosses.json", toss_tables.document, study),
    ]
    if study.launches.ends is not None:
        offered.append(offer.picture("tosses.png", "Places computed and measured", _plan, study))
    return offered


def _plan(study):
    from feederscrew.output.drop import toss_figures

    return toss_figures.plan(study)
