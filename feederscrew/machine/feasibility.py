"""Whether the machine that is drawn makes the drive that was tried: its springs make one direction."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.direction import vibration_angle
from feederscrew.bowl.record import Bowl, Drive
from feederscrew.conveying import answer
from feederscrew.machine.building import needed_angle
from feederscrew.units import factor

SAME_ANGLE = np.radians(0.5)  # angles at the track that are nearer than this count as one
SAME_PHASE = np.radians(0.05)
LEAF_SPRING, TWO_AXIS = "leaf-spring drive", "two-axis drive"
TWO_MAGNETS = "needs two magnets and a two-channel controller: one set of leaf springs cannot make it"
MM_S = factor("mm/s", "velocity")


@dataclass(frozen=True)
class DriveFigures:
    """A drive in the numbers that decide how parts travel."""

    spring_angle: float  # [rad] of the motion at the springs' circle, from the horizontal
    track_angle: float  # [rad] from the track to the motion there
    phase: float  # [rad] by which the motion along the normal leads the one along the track
    throw_number: float  # [1]
    velocity: float  # [m/s] of a part; NaN where there is no steady one

    @property
    def text(self) -> str:
        """The same in words."""
        travels = "no steady speed" if np.isnan(self.velocity) else f"{self.velocity / MM_S:.3g} mm/s"
        phase = f", phase {np.degrees(self.phase):.4g} deg" if abs(self.phase) > SAME_PHASE else ""
        return (
            f"{np.degrees(self.spring_angle):.3g} deg at the springs, {np.degrees(self.track_angle):.3g} deg "
            f"to the track{phase}, throw number {self.throw_number:.3g}, {travels}"
        )


@dataclass(frozen=True)
class DriveMismatch:
    """A drive that was asked for, and the one that the machine makes at the same stroke."""

    wanted: DriveFigures
    machine: DriveFigures
    two_axis: bool  # the drive asked for is out of phase
    other_angle: bool  # the springs do not make its angle
    second_harmonic: bool = False  # it has one, and springs are tuned to one frequency

    @property
    def text(self) -> str:
        """What is wrong, and both drives, in one sentence."""
        reasons = []
        if self.two_axis:
            reasons.append(f"out of phase by {np.degrees(self.wanted.phase):.4g} deg, {TWO_MAGNETS}")
        if self.other_angle:
            asked, made = np.degrees(self.wanted.track_angle), np.degrees(self.machine.track_angle)
            what = f"{asked:.4g} deg as given, and the springs make it {made:.4g} deg at the track"
            reasons.append(f"is {what}" if not reasons else f"its angle is {what}")
        if self.second_harmonic:
            reasons.append("springs that are tuned to one frequency do not make its second harmonic")
        return f"{'; '.join(reasons)}: asked for {self.wanted.text}; the springs make {self.machine.text}"


def is_two_axis(drive: Drive) -> bool:
    """Return whether a drive is out of phase, which one set of leaf springs cannot make."""
    return bool(abs(drive.phase) > SAME_PHASE)


def can_make(bowl: Bowl) -> DriveMismatch | None:
    """Return what keeps the machine of a bowl from making the drive of that bowl; None where it makes it.

    Source: a rigid bowl on inclined leaves moves in one direction, that of its springs; docs/bowl.md,
    "How it is computed".

    Parameters
    ----------
    bowl : Bowl
        With its machine.

    Returns
    -------
    DriveMismatch or None
        The machine's drive has the amplitude of the bowl's, as a sticker on the rim shows it.
    """
    drive, track, machine = bowl.drive, bowl.track, bowl.machine
    by_springs = float(vibration_angle(machine, track.radius, track.climb))
    two_axis = is_two_axis(drive)
    other_angle = abs(by_springs - drive.vibration_angle) > SAME_ANGLE
    second = bool(drive.second_harmonic)
    if not (two_axis or other_angle or second):
        return None
    plain = replace(drive, vibration_angle=by_springs, phase=0.0, second_harmonic=0.0)
    makes = replace(bowl, drive=plain)
    needed = needed_angle(machine, track.radius, drive.vibration_angle + track.climb)
    return DriveMismatch(
        _figures(bowl, needed), _figures(makes, machine.spring_angle), two_axis, bool(other_angle), second
    )


def _figures(bowl: Bowl, spring_angle: float) -> DriveFigures:
    how = answer.answer(bowl)
    drive = bowl.drive
    return DriveFigures(spring_angle, drive.vibration_angle, drive.phase, how.throw_number, how.velocity)
