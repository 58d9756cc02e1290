"""Calibrations as tables and documents."""

from feederscrew.output import tables


def exponents(fits):
    """One row a column of counts.

    Parameters
    ----------
    fits : sequence of Fit

    Returns
    -------
    DataFrame
        The columns of ``calibrate.csv``.
    """
    found = [fit.calibration for fit in fits]
    return tables.frame(
        {
            "counts": [fit.name for fit in fits],
            "parts": [float(fit.counts.sum()) for fit in fits],
            "exponent": [each.exponent for each in found],
            "exponent_low": [each.low for each in found],
            "exponent_high": [each.high for each in found],
            "chi_square": [each.chi_square for each in found],
            "degrees_of_freedom": [each.freedom if each.freedom > 0 else None for each in found],
            "p_value": [each.p_value for each in found],
        }
    )


def document(part, aspects, fits):
    """The calibration as one JSON document.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    fits : sequence of Fit

    Returns
    -------
    dict
    """
    fitted = {fit.name: dict(zip(aspects.names, fit.calibration.shares)) for fit in fits}
    return {"part": part.name, "calibrations": exponents(fits), "p_surface": fitted}


def remarks(fits):
    """What a user must know of a calibration, a line each."""
    told = []
    for fit in fits:
        if fit.calibration.bounded:
            told.append(f"{fit.name}: the counts leave the exponent open to one side")
        if fit.calibration.p_value < 0.01:
            told.append(f"{fit.name}: no exponent explains these counts (p {fit.calibration.p_value:.2g})")
    return told


def write(folder, document):
    """The files of ``feeder calibrate``.

    Parameters
    ----------
    folder : ResultFolder
    document : dict
        From `document`.
    """
    folder.write("calibrate.csv", tables.text(document["calibrations"], "csv"))
    folder.write("calibrate.json", tables.json_text(document))
