"""What a bowl is, in SI units."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Drive:
    """Harmonic vibration of the bowl."""

    amplitude: float  # [m] half the peak-to-peak stroke, along the vibration direction
    frequency: float  # [Hz]
    vibration_angle: float  # [rad] beta, from the floor or track surface to the vibration direction
    direction: float  # [rad] alpha, of the vibration in the floor, from the Z axis


@dataclass(frozen=True)
class Friction:
    """Coulomb coefficients between part and bowl."""

    static: float  # [1]
    kinetic: float  # [1] never above static
    wall: float  # [1] kinetic, against the bowl wall


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
