"""What was measured at a machine beside what it should do, and what makes the difference."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from feederscrew import units
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.errors import ArgumentError
from feederscrew.machine.springs import FULL_TURN_RAD, gain

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


def read(text: str) -> dict[str, float]:
    """Return what a user says was measured, {word: SI}.

    Parameters
    ----------
    text : str
        'acceleration=64 m/s2, stroke=0.3 mm, fill=50 %', any of them.

    Raises
    ------
    ArgumentError
        If a word is unknown, or a value is not one.
    """
    values = {}
    for piece in text.split(","):
        word, _, value = (word_part.strip() for word_part in piece.partition("="))
        if word not in MEASURED_DIMENSIONS:
            mend = f"give some of {', '.join(MEASURED_DIMENSIONS)}: 'stroke=0.3 mm'"
            raise ArgumentError("measured", f"{word!r} is unknown", mend)
        try:
            values[word] = units.quantity(value, MEASURED_DIMENSIONS[word])
        except units.QuantityError as fault:
            raise ArgumentError(f"measured {word}", fault.what, fault.mend) from fault
        most = 1.0 if word == "fill" else math.inf
        if not (0.0 < values[word] <= most or (word == "fill" and values[word] == 0.0)):
            raise ArgumentError(f"measured {word}", f"{value} is out of range", "give a value above 0")
    if not set(values) - {"fill"}:
        raise ArgumentError("measured", "says nothing but the fill", "add stroke=0.3 mm, or an acceleration")
    return values


def diagnose(sheet: Any, values: dict[str, float]) -> MeasuredMachine:
    """Return a machine as it was found beside what it should do.

    Source: docs/bowl.md, "How it is computed" and "Why it feeds 220 for half a minute and then 165".

    Parameters
    ----------
    sheet : MachineSheet
        Of the machine as it is drawn.
    values : dict of str to float [Hz, m, kg, as its key says]
        From ``read``.

    Returns
    -------
    MeasuredMachine
    """
    bowl, emptied, level = sheet.bowl, sheet.emptying, values.get("fill", 0.0)
    share = float(np.interp(level, emptied.levels[::-1], emptied.strokes[::-1]))
    natural = float(np.interp(level, emptied.levels[::-1], emptied.natural_frequencies[::-1]))
    should = {
        "stroke": sheet.stroke.peak_to_peak * share,
        "acceleration": sheet.stroke.acceleration * share,
        "frequency": sheet.stroke.frequency,
    }
    acceleration, stroke = values.get("acceleration"), values.get("stroke")
    frequency = values.get("frequency")
    if frequency is None and acceleration and stroke:
        frequency = math.sqrt(2.0 * acceleration / stroke) / FULL_TURN_RAD
    now = _bowl_now(bowl, acceleration, stroke, frequency)
    machine = MeasuredMachine(
        fill=level,
        acceleration=acceleration,
        stroke=stroke,
        frequency=frequency,
        should=should,
        natural_frequency=natural,
        velocity=math.nan if now is None else _velocity(now),
        velocity_should=_velocity(_moving(bowl, 0.5 * should["stroke"], should["frequency"])),
        causes=(),
    )
    return replace(machine, causes=tuple(_causes(machine, sheet, now)))


def _bowl_now(
    bowl: Bowl, acceleration: float | None, stroke: float | None, frequency: float | None
) -> Bowl | None:
    """The bowl as it moves; None where the stroke is not known."""
    turning = frequency or bowl.drive.frequency
    if stroke is not None:
        return _moving(bowl, 0.5 * stroke, turning)
    return (
        None
        if acceleration is None
        else _moving(bowl, acceleration / (FULL_TURN_RAD * turning) ** 2, turning)
    )


def _moving(bowl: Bowl, amplitude: float, frequency: float) -> Bowl:
    return replace(bowl, drive=replace(bowl.drive, amplitude=amplitude, frequency=frequency))


def _velocity(bowl: Bowl) -> float:
    return float(answer.cells(bowl)["velocity"])


def _causes(machine: MeasuredMachine, sheet: Any, now: Bowl | None) -> Iterator[Any]:
    """What is likely, the first that would explain the most first."""
    listed = list(_of_frequency(machine, sheet))
    if now is not None and not listed:
        listed = list(_of_stroke(machine, sheet, 2.0 * now.drive.amplitude / machine.should["stroke"]))
    if not listed:
        listed = [f"the machine does what it should, within {100.0 * STROKE_TOLERANCE:.0f} %"]
    yield from listed


def _of_frequency(machine: MeasuredMachine, sheet: Any) -> Iterator[Any]:
    """Causes where acceleration and stroke do not belong together at the frequency of the drive."""
    if machine.frequency is None:
        return
    ratio = machine.frequency / machine.should["frequency"]
    if abs(ratio - 1.0) <= MEASUREMENT_TOLERANCE:
        return
    if machine.acceleration and machine.stroke:
        angle, shown_ratio = sheet.stroke.angle, ratio**2
        for part, share in (("horizontally", math.cos(angle)), ("upright", math.sin(angle))):
            if (
                abs(shown_ratio / share - 1.0) <= 2.0 * MEASUREMENT_TOLERANCE
                and abs(share - 1.0) > 2.0 * MEASUREMENT_TOLERANCE
            ):
                yield (
                    f"the accelerometer stands {part}, not along the motion: there it shows {share:.2f} of "
                    "the acceleration"
                )
    for times, cause in ((2.0, "both half-waves pull: the controller is set to full wave"),
                        (0.5, "only one half-wave pulls: the controller is set to half wave")):  # fmt: skip
        if abs(ratio / times - 1.0) <= 2.0 * MEASUREMENT_TOLERANCE:
            yield cause
    yield f"the drive runs at {machine.frequency:.3g} Hz, not at {machine.should['frequency']:.3g} Hz"


def _of_stroke(machine: MeasuredMachine, sheet: Any, ratio: float) -> list[str]:
    """Causes where the stroke is another one; each after the first is another way to explain it."""
    if abs(ratio - 1.0) <= STROKE_TOLERANCE:
        return []
    drive, damping, natural = (
        machine.should["frequency"],
        sheet.bowl.machine.damping,
        machine.natural_frequency,
    )
    wanted = float(gain(drive, natural, damping)) * ratio
    sides = [
        (1.0, MAX_RESONANCE_RATIO),
        (1.0 / MAX_RESONANCE_RATIO, 1.0),
    ]  # of the drive's frequency, that of the machine first
    own, other = (_tuned(wanted, drive, damping, ends) for ends in sides[:: 1 if natural >= drive else -1])
    likely = [_retuned(own, natural, drive)] if own else []
    if ratio > 1.0:
        return _either(
            [*likely, f"the controller is set {100.0 * (ratio - 1.0):.0f} % too high - turn it down"]
        )
    if other:
        beyond = "below" if other < drive else "above"
        likely.append(f"at {other:.4g} Hz, {beyond} the drive: {_why(other, natural, nearer=False)}")
    weak = f"the controller gives {100.0 * ratio:.0f} % of its setting, or a part touches the frame"
    return _either([*likely, weak])


def _either(causes: list[str]) -> list[str]:
    return [f"or {cause}" if k else cause for k, cause in enumerate(causes)]


def _retuned(now: float, expected: float, drive: float) -> str:
    """What may have moved the natural frequency [Hz] on its side of the drive's."""
    nearer = abs(now - drive) < abs(expected - drive)
    where = f"natural frequency at {now:.4g} Hz where {expected:.4g} Hz is right"
    return f"{where}{', nearer to the drive' * nearer}: {_why(now, expected, nearer)}"


def _why(now: float, expected: float, nearer: bool) -> str:
    soon = " before the stroke grows by itself" if nearer else ""
    if now > expected:
        return f"too many leaves, or a lighter bowl - take a leaf off{soon}"
    if nearer:
        return f"a leaf is missing, or the bowl is heavier - add a leaf{soon}"
    return "a leaf is broken or loose, or the bowl is heavier - tighten the clamps, look for a cracked leaf"


def _tuned(wanted: float, drive: float, damping: float, ends: tuple[float, float]) -> float | None:
    """Natural frequency [Hz] between two shares of the drive's at which a gain is reached; None for none."""

    def miss(share: float) -> float:
        return float(gain(drive, share * drive, damping)) - wanted

    low, high = ends
    if miss(low) * miss(high) > 0.0:
        return None
    return drive * float(brentq(miss, low, high))
