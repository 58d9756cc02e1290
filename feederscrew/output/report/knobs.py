"""The drive of a bowl as knobs: what the script of the page needs to compute velocity, regime and rate."""

from feederscrew.bowl.record import Bowl
from feederscrew.output.convey import CONVEY_COLOURS
from feederscrew.output.page.blocks import Knob, Knobs, Text
from feederscrew.output.words import regime_words
from feederscrew.rates.well_oriented import Rate, fed
from feederscrew.studies.report import STROKE_RANGE, ReportStudy
from feederscrew.units import DEG, MM

LEAST_TOP_MM = 1.0  # to which the slider of the amplitude goes at least
LEAD = (
    "Turn the drive and see at once what a part does. Friction turns all coefficients by the same factor. "
    "The rate keeps the mix of orientations and the verdicts that the devices have at the bowl file's own "
    "drive, so it is a guide; feeder rate and feeder trial compute it."
)
TWO_WAVES = "The drive has a second harmonic, which the knobs do not know: feeder convey computes it."


def knobs(case: ReportStudy, rate: Rate | None) -> list[Text | Knobs]:
    """Return a lead and the knobs of the bowl of a report.

    Parameters
    ----------
    case : ReportStudy
    rate : Rate or None
        Without one the rate is left out.

    Returns
    -------
    list of Text and Knobs
        One sentence alone where the drive has a second harmonic.
    """
    if case.bowl.drive.second_harmonic:
        return [Text(TWO_WAVES, quiet=True)]
    drive, friction, climb = case.bowl.drive, case.bowl.friction.static, case.bowl.track.climb
    top = max(STROKE_RANGE * drive.amplitude / MM, LEAST_TOP_MM)
    sliders = (
        Knob("amplitude", "amplitude", "mm", 0.01, top, drive.amplitude / MM),
        _knob("frequency", "frequency", "Hz", 20.0, 150.0, drive.frequency),
        _knob("angle", "vibration angle", "deg", 2.0, 60.0, drive.vibration_angle / DEG),
        _knob("phase", "phase", "deg", -180.0, 180.0, drive.phase / DEG),
        _knob("friction", "static friction", "", 0.05, 1.2, friction),
        _knob("climb", "climb", "deg", 0.0, 12.0, climb / DEG),
    )
    values = {
        "bowl": bowl_values(case.bowl),
        "rate": None if rate is None else rate_values(rate),
        "regimes": [[name, colour, regime_words(name)] for name, colour in CONVEY_COLOURS.items()],
        "top": top,
    }
    return [Text(LEAD, quiet=True, printed=False), Knobs(sliders, values)]


def _knob(name: str, label: str, unit: str, low: float, high: float, own: float) -> Knob:
    """A slider whose ends include the bowl's own value."""
    return Knob(name, label, unit, min(low, own), max(high, own), own)


def bowl_values(bowl: Bowl) -> dict[str, float]:
    """Return a bowl as the script computes with it, in SI units: one setting, no arrays."""
    friction = bowl.friction
    static_back, kinetic_back = friction.backward
    values = {
        "amplitude": bowl.drive.amplitude, "frequency": bowl.drive.frequency,
        "angle": bowl.drive.vibration_angle, "phase": bowl.drive.phase, "climb": bowl.track.climb,
        "bank": bowl.track.bank, "static": friction.static, "kinetic": friction.kinetic,
        "staticBack": static_back, "kineticBack": kinetic_back, "wall": friction.wall,
        "restitution": bowl.restitution, "gravity": bowl.gravity,
    }  # fmt: skip
    return {name: float(value) for name, value in values.items()}


def rate_values(rate: Rate) -> dict[str, float]:
    """Return the factors of a rate that do not depend on the velocity.

    Returns
    -------
    dict of str to float
        ``density`` [1/m] of the queue before the devices, ``blocked`` [s] for which a part blocks the track
        in the mean, ``efficiency`` [1], ``length`` [m] that a part takes behind the devices.
    """
    density = rate.fill / rate.pitch
    freely = rate.velocity.value * density
    moves = freely > 0.0 and rate.offered.value > 0.0
    return {
        "density": float(density),
        "blocked": max(0.0, float(1.0 / rate.offered.value - 1.0 / freely)) if moves else 0.0,
        "efficiency": float(rate.efficiency),
        "length": float(fed(rate.orientations, rate.row).length),
    }
