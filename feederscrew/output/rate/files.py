"""What ``feeder rate`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.rate import tables


def offers(study):
    """Offer the files of a RateStudy, as a list of Offer."""
    return [
        offer.document("rate.json", tables.document, study),
        offer.table("orientations.csv", tables.orientations, study.rate.orientations, study.rule),
    ]
