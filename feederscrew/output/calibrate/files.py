"""What ``feeder calibrate`` leaves in its folder."""

from feederscrew.output import offers as offer
from feederscrew.output.calibrate import tables


def offers(study):
    """Offer the table and the document of a calibration.

    Parameters
    ----------
    study : CalibrateStudy

    Returns
    -------
    list of Offer
    """
    return [
        offer.table("calibrate.csv", tables.exponents, study),
        offer.document("calibrate.json", tables.document, study),
    ]
