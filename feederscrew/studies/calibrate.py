"""The study of ``feeder calibrate``: the surface exponent that counts of one part ask for."""

from dataclasses import dataclass
from os import PathLike

from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.counts import profiles
from feederscrew.resting.counts.calibration_file import Fit, fits


@dataclass(frozen=True, eq=False)
class CalibrateStudy:
    """An exponent for every column of counts of one part."""

    part: Part
    aspects: Aspects
    measured: profiles.Measured
    fits: tuple[Fit, ...]


def calibrate(part: Part, counts: str | PathLike[str]) -> CalibrateStudy:
    """Study which exponent of the surface-weighted rule explains counts by aspect.

    Parameters
    ----------
    part : Part
        From a mesh.
    counts : str or Path
        CSV file as for ``compare``.

    Returns
    -------
    CalibrateStudy

    Raises
    ------
    FeederError
        Every fault of the file, each with its line; if the part has no shape, no column holds counts, or
        they do not tell an exponent.
    """
    found = find(part)
    measured = profiles.read(counts, found.names)
    return CalibrateStudy(part, found, measured, tuple(fits(part, found, measured)))
