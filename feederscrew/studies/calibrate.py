"""The study of ``feeder calibrate``: the surface exponent that counts of one part ask for."""

from dataclasses import dataclass
from os import PathLike

from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting import profiles
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.calibration import Fit, fit_counts, fit_passes
from feederscrew.studies import arguments, passages


@dataclass(frozen=True, eq=False)
class CalibrateStudy(ReadableRecord):
    """An exponent for every column of counts of one part, or for its feeding test."""

    part: Part
    aspects: Aspects
    measured: profiles.Measured | profiles.DeviceCounts
    fits: tuple[Fit, ...]


def calibrate(part: Part, counts: str | PathLike[str]) -> CalibrateStudy:
    """Fit the exponent of a surface to counts by aspect or by device, as ``feeder calibrate``.

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
    part, counts = arguments.a_part(part), arguments.a_file("counts", counts)
    text, sha256 = profiles.read_count_text(counts)
    table, aspects = profiles.parse_count_sheet(text, str(counts)), find(part)
    if not profiles.counts_by_device(table):
        measured = profiles.measured(table, str(counts), sha256, aspects.names)
        return CalibrateStudy(part, aspects, measured, tuple(fit_counts(part, aspects, measured)))
    tested = profiles.device_counts(table, str(counts), sha256)
    flow, _ = passages.counted_flow(part, aspects, passages.bowl_of(tested)[1], tested)
    return CalibrateStudy(part, aspects, tested, (fit_passes(part, aspects, tested, flow),))
