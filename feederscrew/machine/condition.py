"""Measurements at a machine beside what it should do, and what makes the difference."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from feederscrew.base import units
from feederscrew.base.columns import Column, values
from feederscrew.base.errors import ArgumentError
from feederscrew.bowl.record import Bowl
from feederscrew.machine.springs import FULL_TURN_RAD, gain
from feederscrew.motion import conveying as answer

# word: dimension
MEASURED_DIMENSIONS = {
    "acceleration": "acceleration",
    "stroke": "length",
    "frequency": "frequency",
    "fill": "number",
}
MEASUREMENT_TOLERANCE = 0.05  # of a value: as far as a sticker and a usual accelerometer tell
STROKE_TOLERANCE = 0.1  # of the stroke: from here on it is another one
MAX_RESONANCE_RATIO = 3.0  # natural frequencies over that of the drive are looked for up to here


@dataclass(frozen=True)
class MeasuredMachine:
    """A machine as it was found; what was not measured is None."""

    fill: float  # [1] of the full bowl
    acceleration: float | None  # [m/s2] peak, along the motion
    stroke: float | None  # [m] peak to peak
    frequency: float | None  # [Hz] measured, or what acceleration and stroke say together
    should: dict[str, float]  # the same of the machine as it is drawn, at that fill
    natural_frequency: float  # [Hz] of the machine as it is drawn, at that fill
    velocity: float  # [m/s] of a part now; NaN where it is not known
    velocity_should: float  # [m/s]
    causes: tuple[str, ...]  # what is likely, a sentence each


MEASURED_COLUMNS: tuple[Column[MeasuredMachine], ...] = (  # what was measured
    Column("stroke_mm", lambda condition: condition.stroke, "mm"),
    Column("acceleration_m_s2", lambda condition: condition.acceleration, "m/s2"),
    Column("frequency_hz", lambda condition: condition.frequency, "Hz"),
    Column("velocity_mm_s", lambda condition: condition.velocity, "mm/s"),
)
SHOULD_COLUMNS: tuple[Column[MeasuredMachine], ...] = (  # the same of the machine as it is drawn
    Column("stroke_mm", lambda condition: condition.should["stroke"], "mm"),
    Column("acceleration_m_s2", lambda condition: condition.should["acceleration"], "m/s2"),
    Column("frequency_hz", lambda condition: condition.should["frequency"], "Hz"),
    Column("velocity_mm_s", lambda condition: condition.velocity_should, "mm/s"),
)

if TYPE_CHECKING:
    from feederscrew.machine.sheet import MachineSheet
CONDITION_COLUMNS: tuple[Column[MeasuredMachine], ...] = (  # of the document
    Column("fill_percent", lambda condition: condition.fill, "%"),
    Column("measured", lambda condition: values(MEASURED_COLUMNS, condition)),
    Column("should", lambda condition: values(SHOULD_COLUMNS, condition)),
    Column("natural_frequency_hz", lambda condition: condition.natural_frequency, "Hz"),
    Column("causes", lambda condition: list(condition.causes)),
)


def read(text: str) -> dict[str, float]:
    """Return what a user says was measured.

    Parameters
    ----------
    text : str
        'acceleration=64 m/s2, stroke=0.3 mm, fill=50 %', any of them.

    Returns
    -------
    dict of str to float [SI]
        By word.

    Raises
    ------
    ArgumentError
        If a word is unknown, or a value cannot be read.
    """
    values = {}
    for piece in text.split(","):
        word, _, value = (word_part.strip() for word_part in piece.partition("="))
        if word not in MEASURED_DIMENSIONS:
            mend = f"give some of {', '.join(MEASURED_DIMENSIONS)}: 'stroke=0.3 mm'"
            raise ArgumentError("measured", f"{word!r} is unknown", mend)
        if word in values:
            raise ArgumentError(f"measured {word}", "is given twice", "keep one of them")
        try:
            values[word] = units.quantity(value, MEASURED_DIMENSIONS[word])
        except units.QuantityError as fault:
            mended = None if fault.value is None else text.replace(piece, f"{word}={fault.value}")
            raise ArgumentError(f"measured {word}", fault.what, fault.mend, value=mended) from fault
        most = 1.0 if word == "fill" else math.inf
        if not (0.0 < values[word] <= most or (word == "fill" and values[word] == 0.0)):
            mend = "give 0 % to 100 %" if word == "fill" else "give a value above 0"
            raise ArgumentError(f"measured {word}", f"{value} is out of range", mend)
    if not set(values) - {"fill"}:
        raise ArgumentError("measured", "says nothing but the fill", "add stroke=0.3 mm, or an acceleration")
    return values


def diagnose(sheet: "MachineSheet", values: dict[str, float]) -> MeasuredMachine:
    """Return a machine as it was found beside what it should do, and the likely causes of a difference.

    The target is that of the machine as drawn, its stroke at the fill that was found. A missing frequency
    follows from the harmonic motion, f = sqrt(2 a / s) / (2 pi), with the peak acceleration a and the stroke
    s peak to peak. Causes are looked for in the frequency first: a stroke at another frequency says nothing
    about springs.

    Parameters
    ----------
    sheet : MachineSheet
        Of the machine as it is drawn.
    values : dict of str to float [SI]
        From ``read``: 'acceleration', 'stroke', 'frequency', 'fill', any of them.

    Returns
    -------
    MeasuredMachine
        Velocities NaN where no stroke is known.

    References
    ----------
    Harmonic motion, a = w^2 s / 2; docs/bowl.md.
    """
    bowl, emptied, level = sheet.bowl, sheet.emptying, values.get("fill", 0.0)
    share = float(np.interp(level, emptied.levels[::-1], emptied.strokes[::-1]))
    should = {
        "stroke": sheet.stroke.peak_to_peak * share,
        "acceleration": sheet.stroke.acceleration * share,
        "frequency": sheet.stroke.frequency,
    }
    acceleration, stroke = values.get("acceleration"), values.get("stroke")
    frequency = values.get("frequency")
    if frequency is None and acceleration and stroke:
        frequency = math.sqrt(2.0 * acceleration / stroke) / FULL_TURN_RAD
    # how it moves now, where the stroke is known
    turning, amplitude = frequency or bowl.drive.frequency, None
    if stroke is not None:
        amplitude = 0.5 * stroke
    elif acceleration is not None:
        amplitude = acceleration / (FULL_TURN_RAD * turning) ** 2
    natural = float(np.interp(level, emptied.levels[::-1], emptied.natural_frequencies[::-1]))
    ratio = 1.0 if frequency is None else frequency / should["frequency"]
    causes: list[str] = []
    if abs(ratio - 1.0) > MEASUREMENT_TOLERANCE:
        # acceleration and stroke do not belong together at the frequency of the drive
        angle = sheet.stroke.angle
        stands = (("horizontally", math.cos(angle)), ("upright", math.sin(angle)))
        for part, along in stands if acceleration and stroke else ():
            agrees = abs(ratio**2 / along - 1.0) <= 2.0 * MEASUREMENT_TOLERANCE
            if agrees and abs(along - 1.0) > 2.0 * MEASUREMENT_TOLERANCE:
                causes.append(
                    f"the accelerometer stands {part}, not along the motion: there it shows {along:.2f} of "
                    "the acceleration"
                )
        waves = (
            (2.0, "both half-waves pull: the controller is set to full wave"),
            (0.5, "only one half-wave pulls: the controller is set to half wave"),
        )
        for times, cause in waves:
            if abs(ratio / times - 1.0) <= 2.0 * MEASUREMENT_TOLERANCE:
                causes.append(cause)
        causes.append(f"the drive runs at {frequency:.3g} Hz, not at {should['frequency']:.3g} Hz")
    elif amplitude is not None:
        damping = bowl.machine.damping
        causes = _of_stroke(should["frequency"], natural, damping, 2.0 * amplitude / should["stroke"])
    return MeasuredMachine(
        fill=level,
        acceleration=acceleration,
        stroke=stroke,
        frequency=frequency,
        should=should,
        natural_frequency=natural,
        velocity=math.nan if amplitude is None else _velocity(bowl, amplitude, turning),
        velocity_should=_velocity(bowl, 0.5 * should["stroke"], should["frequency"]),
        causes=tuple(causes)
        or (f"the machine does what it should, within {100.0 * STROKE_TOLERANCE:.0f} %",),
    )


def _velocity(bowl: Bowl, amplitude: float, frequency: float) -> float:
    moving = replace(bowl, drive=replace(bowl.drive, amplitude=amplitude, frequency=frequency))
    return float(answer.cells(moving)["velocity"])


def _of_stroke(drive: float, natural: float, damping: float, ratio: float) -> list[str]:
    """Causes where the stroke is another one; each after the first is another way to explain it."""
    if abs(ratio - 1.0) <= STROKE_TOLERANCE:
        return []
    wanted = float(gain(drive, natural, damping)) * ratio

    def miss(share: float) -> float:
        return float(gain(drive, share * drive, damping)) - wanted

    # natural frequency [Hz] on either side of the drive's at which that gain is reached; the machine's first
    sides = [(1.0, MAX_RESONANCE_RATIO), (1.0 / MAX_RESONANCE_RATIO, 1.0)]
    own, other = (
        None if miss(low) * miss(high) > 0.0 else drive * float(brentq(miss, low, high))
        for low, high in sides[:: 1 if natural >= drive else -1]
    )
    causes = []
    if own:
        nearer = abs(own - drive) < abs(natural - drive)
        where = f"natural frequency at {own:.4g} Hz where {natural:.4g} Hz is right"
        causes.append(f"{where}{', nearer to the drive' * nearer}: {_why(own, natural, nearer)}")
    if ratio > 1.0:
        causes.append(f"the controller is set {100.0 * (ratio - 1.0):.0f} % too high - turn it down")
    else:
        if other:
            beyond = "below" if other < drive else "above"
            causes.append(f"at {other:.4g} Hz, {beyond} the drive: {_why(other, natural, nearer=False)}")
        weak = f"the controller gives {100.0 * ratio:.0f} % of its setting, or a part touches the frame"
        causes.append(weak)
    return [f"or {cause}" if k else cause for k, cause in enumerate(causes)]


def _why(now: float, expected: float, nearer: bool) -> str:
    soon = " before the stroke grows by itself" if nearer else ""
    if now > expected:
        return f"too many leaves, or a lighter bowl - take a leaf off{soon}"
    if nearer:
        return f"a leaf is missing, or the bowl is heavier - add a leaf{soon}"
    return "a leaf is broken or loose, or the bowl is heavier - tighten the clamps, look for a cracked leaf"
