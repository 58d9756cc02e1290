"""What ``feeder drop --plate`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.plate import tables


def offers(study):
    """Offer the tables of a dynamic bowl test, its document and its chart.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    list of Offer
    """
    return [
        offer.table("plate.csv", tables.plates, study),
        offer.table("plate_rates.csv", tables.rates, study),
        offer.table("plate_time.csv", tables.course, study),
        offer.table("plate_drives.csv", tables.drives, study),
        offer.document("plate.json", tables.document, study),
        offer.picture("plate.png", "Shares of the aspects on the plate", _plate, study),
    ]


def _plate(study):
    """Over time on one plate, over the throw number on several."""
    from feederscrew.output.plate import figures

    return figures.one(study) if len(study.plates) == 1 else figures.trend(study)
