"""What ``feeder compare`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.compare import tables


def offers(study):
    """Offer the table of comparisons and their picture.

    Parameters
    ----------
    study : CompareStudy

    Returns
    -------
    list of Offer
    """
    alt = "What was measured beside each rule, and how far every two profiles are apart"
    return [
        offer.table("compare.csv", tables.comparisons, study),
        offer.picture("compare.png", alt, _comparison, study),
    ]


def _comparison(study):
    from feederscrew.output.compare import figures

    measured, rules = ({p.name: p.fractions for p in some} for some in (study.measured.profiles, study.rules))
    pairs = {(each.first.name, each.second.name): each.deviation for each in study.comparisons}
    return figures.comparison(study.part.name, study.aspects.names, measured, rules, pairs)
