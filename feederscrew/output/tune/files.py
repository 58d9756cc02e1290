"""What ``feeder tune`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.tune import tables


def offers(study):
    """Offer the files of a TuneStudy, as a list of Offer."""
    return [
        offer.document("tune.json", tables.document, study),
        offer.table("tune.csv", tables.settings, study),
    ]
