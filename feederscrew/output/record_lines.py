"""A record in one line: what ``repr`` and a notebook say of it, without its class.

Each function takes the record of one command, or one of its inputs, and returns its answer: 'bracket: A 42 %,
B 17 %'. The module of a command in ``output`` names the function in its ``RecordView``.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base.arrays import Array, Floats
from feederscrew.base.units import DEGREE, GRAM, MINUTE, MM, counted, listed
from feederscrew.bowl import Bowl
from feederscrew.motion.floor_balance import MOTION_STATES
from feederscrew.output.offers import RecordView
from feederscrew.part.record import Part

if TYPE_CHECKING:
    from feederscrew.arrivals.drop import PlateStudy
    from feederscrew.arrivals.floor import FloorStudy
    from feederscrew.designing.families import FamilyStudy
    from feederscrew.designing.record import DesignStudy
    from feederscrew.feeding.compare import CalibrateStudy
    from feederscrew.feeding.tune import TuneStudy
    from feederscrew.feeding.well_oriented import Rate
    from feederscrew.machine.sheet import MachineSheet
    from feederscrew.motion.conveying import Answer
    from feederscrew.motion.slide import SlideStudy
    from feederscrew.part.inertia import InertiaStudy
    from feederscrew.resting.aspects import Aspects
    from feederscrew.sorting.headings import HeadingsStudy
    from feederscrew.sorting.orientations import Orientation
    from feederscrew.sorting.tooling import ToolingStudy
    from feederscrew.sorting.track import TrackStudy
    from feederscrew.trials.trial import TrialStudy

PERCENT = 0.01  # [SI]
MOST_SHARES = 8  # aspects in a line


def figure(value: float | Array | None, unit_in_si: float = 1.0) -> str:
    """Return a number with three digits.

    Parameters
    ----------
    value : float, array or None [SI]
    unit_in_si : float [SI]
        Size of the unit that is written.

    Returns
    -------
    str
        '-' for a missing value and NaN; '<5 values>' for an array.
    """
    if value is None or np.ndim(value):
        return "-" if value is None else f"<{np.size(value)} values>"
    return "-" if math.isnan(value) else f"{value / unit_in_si:.3g}"


def part_text(part: Part) -> str:
    """Return name, size, mass, material and facets of a part."""
    mass = f"{figure(part.mass, GRAM)} g"
    if part.vertices is None or part.faces is None:
        return f"{part.name}: a part card, {mass}, {counted(len(part.aspects), 'aspect')}"
    size = " x ".join(figure(side, MM) for side in np.ptp(part.vertices, axis=0))
    open_surface = ", open surface" * part.open_surface
    return f"{part.name}: {size} mm, {mass} ({part.material}), {len(part.faces)} facets{open_surface}"


def bowl_text(bowl: Bowl) -> str:
    """Return a bowl, first its origin: 'bowl.yaml, 2 overrides', 'defaults', 'changed' after it was read."""
    origin = "changed after it was read"
    if bowl.settings:
        own = [setting for setting in bowl.settings if setting.is_own]
        files = list(dict.fromkeys(s.where.rsplit(":", 2)[0] for s in own if not s.overrides))
        overrides = sum(setting.overrides for setting in own)
        last = [counted(overrides, "override")] if overrides else []
        origin = ", ".join([*(files or ["defaults"]), *last])
    drive, friction, track = bowl.drive, bowl.friction, bowl.track
    devices = ", ".join(device.kind for device in bowl.devices) or "none"
    return (
        f"{origin}: amplitude {figure(drive.amplitude, MM)} mm at {figure(drive.frequency)} Hz and "
        f"{figure(drive.vibration_angle, DEGREE)} deg, friction {figure(friction.static)}, "
        f"track {figure(track.width, MM)} mm wide, radius {figure(track.radius, MM)} mm, "
        f"climb {figure(track.climb, DEGREE)} deg, bank {figure(track.bank, DEGREE)} deg, "
        f"devices: {devices:.120}"
    )


def shares_text(names: Sequence[str], shares: Floats) -> str:
    """Return names with their shares (N,) [1], the largest first: 'A 42 %, B 17 %'."""
    ranked = sorted(zip(names, np.nan_to_num(shares)), key=lambda pair: -pair[1])
    texts = [f"{name} {figure(share, PERCENT)} %" for name, share in ranked[:MOST_SHARES]]
    texts += [f"{len(ranked) - MOST_SHARES} more"] if len(ranked) > MOST_SHARES else []
    return ", ".join(texts)


def aspects_text(aspects: "Aspects") -> str:
    """Return the most probable aspects with their shares, and the rule that they are from."""
    shares = shares_text(aspects.names, aspects.chances[aspects.ranking])
    return f"rests on {shares} ({aspects.source(aspects.ranking)})"


def convey_text(answer: "Answer") -> str:
    """Return velocity, status, regime and throw number of a point on the track."""
    return (
        f"{figure(answer.velocity, MM)} mm/s up the track, {answer.status}, regime {answer.regime}, "
        f"throw number {figure(answer.throw_number)}"
    )


def rate_text(rate: "Rate") -> str:
    """Return the orientation that is fed, parts a minute with their interval, efficiency and purity."""
    orientation, parts = rate.orientations.lying[rate.row], rate.parts
    low, value, high = (figure(end * MINUTE) for end in (parts.low, parts.value, parts.high))
    return (
        f"{orientation_text(orientation)}: {value} parts/min ({low} to {high}), "
        f"efficiency {figure(rate.efficiency, PERCENT)} %, purity {figure(rate.purity, PERCENT)} %"
    )


def orientation_text(orientation: "Orientation") -> str:
    """Return an orientation by its name: 'A@90', 'hanging'."""
    return orientation.name


def tune_text(study: "TuneStudy") -> str:
    """Return the target of a tuned bowl, and the settings of the drive that reach it."""
    solutions = (tuned.solution for tuned in study.settings)
    settings = (f"{s.key.name} {s.number:.4g} {s.key.unit}".rstrip() for s in solutions)
    return f"{study.part.name}: {figure(study.target * MINUTE)} parts/min with {' or '.join(settings)}"


def slide_text(study: "SlideStudy") -> str:
    """Return regime and limiting friction of the first four vibration angles."""
    return "; ".join(
        f"at {figure(slide_map.beta, DEGREE)} deg regime {slide_map.regime}, "
        f"limiting friction {figure(slide_map.at_bowl['mu_limit'])}"
        for slide_map in study.maps[:4]
    )


def motion_text(study: "FloorStudy | TrackStudy", heading: str) -> str:
    """Return the states of motion over a period of the drive, of a part at a heading."""
    states = listed([MOTION_STATES[code] for code in np.unique(study.cycle.state)])
    return f"{study.part.name} on {study.posture.name} at {heading} deg: {states} over a period of the drive"


def track_text(study: "TrackStudy") -> str:
    """Return the states of motion of a part on the track."""
    lying = study.headings
    return motion_text(
        study, f"heading {figure(None if lying is None else lying.headings[study.row], DEGREE)}"
    )


def headings_text(study: "HeadingsStudy") -> str:
    """Return the first three stable headings of each aspect."""
    lines = [
        f"{stable.aspect} at {', '.join(figure(angle, DEGREE) for angle in stable.headings[:3])} deg"
        for stable in study.headings[:MOST_SHARES]
    ]
    return f"{study.part.name}: {'; '.join(lines)}"


def machine_text(sheet: "MachineSheet") -> str:
    """Return diameter, stroke, frequency and velocity of a bowl; first the order it is sized for."""
    text = (
        f"bowl of {figure(2.0 * sheet.bowl.track.radius, MM)} mm, "
        f"{figure(sheet.stroke.peak_to_peak, MM)} mm peak to peak at {figure(sheet.stroke.frequency)} Hz, "
        f"{figure(sheet.answer.velocity, MM)} mm/s"
    )
    order = sheet.order
    asked = f"{order.part.name} at {figure(order.target * MINUTE)} parts/min: " if order is not None else ""
    return f"{asked}{text}"


def tooling_text(study: "ToolingStudy") -> str:
    """Return designs in words: 'A@90 isolated by wiper (efficiency 80 %, purity 100 %)'."""
    texts = []
    for design in (design for design in study.designs if design is not None):
        text = (
            f"{orientation_text(study.orientations[design.wanted])} {'not ' * (not design.isolated)}isolated"
        )
        cuts = [cut.device.kind for cut in design.cuts]
        if design.isolated or cuts:
            efficiency, purity = figure(design.efficiency, PERCENT), figure(design.purity, PERCENT)
            by = ", ".join(cuts) or "the devices of the bowl"
            text += f" by {by} (efficiency {efficiency} %, purity {purity} %)"
        texts.append(text)
    more = f"; {len(texts) - 4} more" if len(texts) > 4 else ""
    return f"{study.part.name}: {'; '.join(texts[:4])}{more}"


def trial_text(study: "TrialStudy") -> str:
    """Return counts, efficiency and purity of the first four runs of a trial."""
    runs = [
        f"at {figure(run.bowl.drive.amplitude, MM)} mm {int(run.counts[:, 0].sum())} of "
        f"{int(run.counts.sum())} parts pass, efficiency {figure(run.efficiency, PERCENT)} %, "
        f"purity {figure(run.purity, PERCENT)} %"
        for run in study.runs[:4]
    ]
    return f"{study.part.name}: {'; '.join(runs)}"


def design_text(study: "DesignStudy") -> str:
    """Return status, what is fed, parts a minute, devices and reason of a design."""
    if study.bowl is None:
        return f"{study.part.name}: {study.status} - {study.why:.300}"
    value, low, high = (figure(rate * MINUTE) for rate in study.proof.delivered)
    return (
        f"{study.part.name}: {study.status}, {study.wanted} at {value} parts/min ({low} to {high}) through "
        f"{', '.join(device.kind for device in study.devices) or 'no device'}"
        + (f" - {study.why:.240}" if study.why else "")
    )


def family_text(study: "FamilyStudy") -> str:
    """Return the status of a family of parts and of each of its members."""
    members = ", ".join(f"{member.part.name} {member.status}" for member in study.members)
    return f"{study.status}, {'one bowl for all' if study.shared else 'a bowl for each'}: {members}"


def calibrate_text(study: "CalibrateStudy") -> str:
    """Return the fitted exponents with their intervals."""
    fits = [
        f"{fit.name} exponent {figure(fit.calibration.exponent)} "
        f"({figure(fit.calibration.low)} to {figure(fit.calibration.high)})"
        for fit in study.fits[:4]
    ]
    return f"{study.part.name}: {'; '.join(fits)}"


def plate_text(study: "PlateStudy") -> str:
    """Return throw number and shares of the first three plates."""
    plates = [
        f"throw number {figure(p.throw_number)}: {shares_text(study.aspects.names, p.occupancy.plate)}"
        for p in study.plates[:3]
    ]
    return f"{study.part.name}: {'; '.join(plates)}"


def inertia_text(study: "InertiaStudy") -> str:
    """Return mass, centre of mass and principal moments of a part."""
    centre = ", ".join(figure(value, MM) for value in study.part.centre_of_mass)
    moments = ", ".join(figure(value, 1e-9) for value in study.balance.moments)
    mass = figure(study.part.mass, GRAM)
    return f"{study.part.name}: {mass} g, centre of mass {centre} mm, principal moments {moments} g mm2"


PART_VIEW = RecordView(part_text)
BOWL_VIEW = RecordView(bowl_text)
ASPECTS_VIEW = RecordView(aspects_text)
SHARES_VIEW = RecordView(lambda shares: aspects_text(shares.aspects))
ANSWER_VIEW = RecordView(convey_text)
RATE_VIEW = RecordView(rate_text)
