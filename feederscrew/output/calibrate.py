"""Files of ``feeder calibrate``."""

from typing import Any

from feederscrew.output import offers as offer
from feederscrew.output import tables
from feederscrew.output.tables import Frame
from feederscrew.studies.compare import CalibrateStudy

UNLIKELY = 0.01  # p-value below which no exponent explains the counts


def exponents(study: CalibrateStudy) -> Frame:
    """Return the exponents, one row a column of counts: the columns of ``calibrate.csv``."""
    fits = study.fits
    calibrations = [fit.calibration for fit in fits]
    return tables.frame(
        {
            "counts": [fit.name for fit in fits],
            "parts": [fit.parts for fit in fits],
            "exponent": [each.exponent for each in calibrations],
            "exponent_low": [each.low for each in calibrations],
            "exponent_high": [each.high for each in calibrations],
            "chi_square": [each.chi_square.statistic for each in calibrations],
            "degrees_of_freedom": [each.chi_square.degrees_of_freedom or None for each in calibrations],
            "p_value": [each.chi_square.p_value for each in calibrations],
        }
    )


def document(study: CalibrateStudy) -> dict[str, Any]:
    """Return the calibration as one JSON document."""
    fitted = {fit.name: dict(zip(study.aspects.names, fit.calibration.shares)) for fit in study.fits}
    return {"part": study.part.name, "calibrations": exponents(study), "p_surface": fitted}


def remarks(study):
    """Return what a user must know of a calibration, a line each."""
    listed = []
    for fit in study.fits:
        if fit.calibration.bounded:
            listed.append(f"{fit.name}: the counts limit the exponent on one side only")
        if (p_value := fit.calibration.chi_square.p_value) < UNLIKELY:
            listed.append(f"{fit.name}: no exponent explains these counts (p {p_value:.2g})")
    return listed


def offers(study: CalibrateStudy) -> list[offer.Offer]:
    """Offer the table and the document of a calibration."""
    return [
        offer.table("calibrate.csv", exponents, study),
        offer.document("calibrate.json", document, study),
    ]
