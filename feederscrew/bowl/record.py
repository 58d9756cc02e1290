"""What a bowl is, in SI units."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Drive:
    """Vibration of the bowl: harmonic, and straight, unless its last three fields say otherwise."""

    amplitude: float  # [m] half the peak-to-peak stroke, along the vibration direction
    frequency: float  # [Hz]
    vibration_angle: float  # [rad] beta, from the floor or track surface to the vibration direction
    direction: float  # [rad] alpha, of the vibration in the floor, from the Z axis
    phase: float = 0.0  # [rad] by which the motion along the normal leads the one along the track
    second_harmonic: float = 0.0  # [1] amplitude at twice the frequency, of ``amplitude``
    second_harmonic_phase: float = 0.0  # [rad] psi of sin(w t) + r sin(2 w t + psi)


@dataclass(frozen=True)
class Friction:
    """Coulomb coefficients between part and bowl."""

    static: float  # [1] against sliding up the track, and on the floor
    kinetic: float  # [1] never above static
    wall: float  # [1] kinetic, against the bowl wall
    static_backward: float | None = None  # [1] against sliding down the track; None: as static
    kinetic_backward: float | None = None  # [1] never above static_backward; None: as kinetic

    @property
    def backward(self):
        """Static and kinetic coefficient against sliding down the track."""
        pairs = (self.static_backward, self.static), (self.kinetic_backward, self.kinetic)
        return tuple(same if own is None else own for own, same in pairs)


@dataclass(frozen=True)
class Track:
    """The helical track along the bowl wall."""

    climb: float  # [rad] phi, rise along the track
    bank: float  # [rad] delta, tilt about the track's direction
    radius: float  # [m] of the bowl wall
    width: float  # [m]


@dataclass(frozen=True)
class Bowl:
    """Drive, surface and track of one bowl."""

    drive: Drive
    friction: Friction
    track: Track
    restitution: float  # [1] of an impact on the track
    gravity: float  # [m/s2]
