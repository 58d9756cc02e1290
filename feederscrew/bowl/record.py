"""Bowl in SI units, and the direction in which leaf springs move it over its radius.

Source: a rigid bowl on inclined leaf springs; docs/method/bowl.md.
"""

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Unpack, cast

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Reals
from feederscrew.base.columns import Column
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl.devices.base import Device

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    from feederscrew.bowl.values import BowlValues, Overrides

    # a number, or an array of them where many bowls are computed at once
    Number = TypeVar("Number", bound=Reals, default=float, covariant=True)
else:
    from typing import TypeVar

    Number = TypeVar("Number")

VALUES_MODULE = "feederscrew.bowl.values"
WRITING_MODULE = "feederscrew.bowl.writing"
MAX_TRACK_WIDTH_SHARE = 0.95  # of the wall's radius: about the axis there is no track


@dataclass(frozen=True)
class Drive(Generic[Number]):
    """Vibration of the bowl: harmonic, and straight, unless its last four fields say otherwise."""

    amplitude: Number  # [m] half the peak-to-peak stroke, along the vibration direction
    frequency: Number  # [Hz]
    vibration_angle: Number  # [rad] beta, from the floor or track surface to the vibration direction
    direction: Number  # [rad] alpha, of the vibration in the floor, from the Z axis
    # the defaults are numbers, as those of a Bowl are
    phase: Number = 0.0  # type: ignore[assignment]  # [rad] by which the motion along the normal leads
    second_harmonic: Number = 0.0  # type: ignore[assignment]  # [1] of ``amplitude``, at twice the frequency
    second_harmonic_phase: Number = 0.0  # type: ignore[assignment]  # [rad] psi: sin(w t) + r sin(2 w t + psi)
    second_harmonic_angle: Number | None = None  # [rad] of a second mode; None: as vibration_angle

    @property
    def second_harmonic_turn(self) -> "Number | float":
        """Angle from the direction of the first harmonic up to that of the second [rad]."""
        angle: Any = self.second_harmonic_angle
        return 0.0 if angle is None else cast("Number", angle - self.vibration_angle)


DRIVE_PHASE_COLUMNS: tuple[Column[Drive], ...] = (  # of documents
    Column("phase_deg", lambda drive: drive.phase, "deg"),
    Column("frequency_hz", lambda drive: drive.frequency, "Hz"),
)


@dataclass(frozen=True)
class Friction(Generic[Number]):
    """Coulomb coefficients between part and bowl."""

    static: Number  # [1] against sliding up the track, and on the floor
    kinetic: Number  # [1] never above static
    wall: Number  # [1] kinetic, against the bowl wall
    static_backward: Number | None = None  # [1] against sliding down the track; None: as static
    kinetic_backward: Number | None = None  # [1] never above static_backward; None: as kinetic

    @property
    def backward(self) -> tuple[Number, Number]:
        """Static and kinetic coefficient against sliding down the track."""
        static, kinetic = self.static_backward, self.kinetic_backward
        return self.static if static is None else static, self.kinetic if kinetic is None else kinetic


@dataclass(frozen=True)
class Track(Generic[Number]):
    """The helical track along the bowl wall."""

    climb: Number  # [rad] phi, rise along the track
    bank: Number  # [rad] delta, tilt about the track's direction
    radius: Number  # [m] of the bowl wall
    width: Number  # [m]

    @property
    def extent(self: "Track[float]") -> float:
        """Return how far from the wall there is track [m]: its width, or nearly to the bowl's axis."""
        return min(self.width, MAX_TRACK_WIDTH_SHARE * self.radius)


TRACK_SIZE_COLUMNS: tuple[Column[Track], ...] = (  # of documents
    Column("track_width_mm", lambda track: track.width, "mm"),
    Column("bank_deg", lambda track: track.bank, "deg"),
    Column("climb_deg", lambda track: track.climb, "deg"),
)


@dataclass(frozen=True)
class Unbalance:
    """Mass of a bowl that does not lie evenly about its axis; Z from the upper ends of the leaves."""

    moment: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [kg m] mass times the place of its centre
    upright: tuple[float, float] = (0.0, 0.0)  # [kg m2] inertia about X and Y there
    products: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [kg m2] mass times yz, xz and xy
    turns: float = 1.0  # [1] 1 where it turns counter-clockwise as it rises, -1 of a left hand


UNBALANCE_UNKNOWN = Unbalance()  # nothing of it is known


@dataclass(frozen=True)
class Machine:
    """Machine under the bowl: two masses on inclined leaf springs."""

    bowl_mass: float  # [kg] of everything above the springs, tooling included, parts not
    bowl_inertia: float  # [kg m2] of the same, about the bowl's axis
    base_mass: float  # [kg] of everything below the springs
    base_inertia: float  # [kg m2]
    spring_radius: float  # [m] of the springs' circle
    spring_angle: float  # [rad] of the motion at the springs, from the horizontal
    leaf_width: float  # [m]
    leaf_thickness: float  # [m]
    leaf_length: float  # [m] free, between the clamps
    leaf_modulus: float  # [Pa]
    leaves: float  # of all banks together
    damping: float  # [1] of the critical one
    supply: float  # [Hz] at which the supply drives the bowl
    unbalance: Unbalance = UNBALANCE_UNKNOWN  # known of a bowl that is a solid


@dataclass(frozen=True)
class Sizing:
    """Rules of thumb of the trade, each with its source in the schema."""

    least_diameter: float  # [m]
    diameter_per_length: float  # [1]
    diameter_per_width: float  # [1]
    greatest_diameter: float  # [m]
    diameter_step: float  # [m]
    least_climb: float  # [rad]
    clearance: float  # [1] of the part's width
    least_clearance: float  # [m]
    greatest_clearance: float  # [m]
    headroom: float  # [1] of the part's height
    depth: float  # [1] of the diameter
    fill_height: float  # [1] of the depth
    packing: float  # [1]
    carried: float  # [1] of the fill's mass
    hopper_interval: float  # [s]
    controller: float  # [1]
    retune: float  # [1]
    least_detuning: float  # [1]
    greatest_detuning: float  # [1]
    greatest_acceleration: float  # [1] of gravity
    greatest_stroke: float  # [m] peak to peak
    leaves: float  # of a usual set
    banks: float  # that share them
    fatigue_stress: float  # [Pa]
    half_wave_diameter: float  # [m]
    spring_radius: float  # [1] of the bowl's radius
    least_spring_angle: float  # [rad]
    greatest_spring_angle: float  # [rad]
    greatest_spring_radius: float  # [1] of the bowl's radius
    steepest_spring_angle: float  # [rad] where the drive's angle is given
    base_mass: float  # [1] of the bowl's mass
    sheet: float  # [m]
    sheet_density: float  # [kg/m3]
    tooling_mass: float  # [1] of the bare bowl's mass
    slowest: float  # [m/s]
    fastest: float  # [m/s]
    handbook_speed: float  # [m/s]
    fill_density: float = 0.0  # [kg/m3] mass of a part over the volume of its hull; 0: unknown
    shape: str = "cylinder"  # of the wall
    hand: str = "right"  # of the helix; 'left' is the mirror image
    bolts: float = 6.0  # of the bowl on its drive, beside the one in the middle
    bolt_hole: float = 9e-3  # [m] diameter
    bolt_circle: float = 0.12  # [m] diameter
    bolt_share: float = 0.4  # [1] circle of the bolts over the bowl's diameter, where none is given
    outlet_height: float = 0.0  # [m] over the floor's edge; 0: where the turns end
    outlet_angle: float = 0.0  # [rad] where the outlet leaves the wall
    drains: float = 0.0  # holes in the floor
    drain_hole: float = 4e-3  # [m] diameter
    mains: str = "50 Hz"  # where the bowl is to run
    lining: str = "unsaid"  # of the track, for the table of friction
    part_material: str = "steel"  # what parts are made of, for that table
    control: str = "mains"  # or 'frequency': the controller makes any

    @property
    def mains_frequency(self) -> float:
        """Frequency of the mains [Hz]."""
        return float(self.mains.partition(" ")[0])


@dataclass(frozen=True)
class Bowl(ReadableRecord, Generic[Number], view="record_lines.BOWL_VIEW"):
    """Drive, surface, track and devices of one bowl."""

    drive: Drive[Number]
    friction: Friction[Number]
    track: Track[Number]
    restitution: Number  # [1] of an impact on the track
    gravity: Number  # [m/s2]
    machine: Machine = None  # type: ignore[assignment]  # None only of a record made by hand
    sizing: Sizing = None  # type: ignore[assignment]
    devices: tuple[Device, ...] = ()  # along the track, in the order parts meet them
    settings: ClassVar[tuple[Any, ...]] = ()  # it was read from; of one that was changed afterwards none
    source: ClassVar[str | None] = None  # path of its file; None of defaults

    def with_values(self, overrides: "Overrides" = (), **values: "Unpack[BowlValues]") -> "Bowl":
        """Return the same bowl with other values, ``bowl.with_values(amplitude="0.3 mm")``.

        A key that takes its value from another one follows it, as in a file: with ``static`` alone, kinetic
        friction is the same. What is given counts as the user's own: a design keeps it.

        Parameters
        ----------
        overrides : dict, str or sequence of str
            By the full names of keys: {'machine.leaves': 4} or 'machine.leaves=4'.
        **values : str or float [SI] or quantity of pint
            Keys of a bowl file by their last word. They go over the overrides. None leaves the bowl's own.

        Returns
        -------
        Bowl

        Raises
        ------
        FeederError
            If a value is of another dimension or out of range, or two of them exclude each other.
        TypeError
            If there is no such key.
        """
        return cast(Bowl, import_module(VALUES_MODULE).adjusted(self, overrides, values))

    def to_yaml(self) -> str:
        """Return the bowl as the text of a bowl file, which ``read_bowl`` reads back as the same bowl.

        Keys that somebody gave are lines, and defaults are comments.

        Returns
        -------
        str

        Raises
        ------
        FeederError
            If no file can say what the bowl is: a value of it is out of range, or an array.
        """
        return cast(str, import_module(WRITING_MODULE).yaml_text(self))


# Many bowls at once: fields of drive, friction and track, restitution and gravity may be arrays, which
# broadcast together. A ``Bowl`` is one of these as well.
BowlGrid = Bowl[Reals]
RIGHT_ANGLE_RAD = 0.5 * np.pi  # [rad] upright


def direction(machine: Machine, radius: ArrayLike) -> Any:
    """Return the angle of the bowl's motion to the horizontal at a distance from its axis.

    tan psi(r) = tan psi_s (r_s / r) [m2 / (m1 + m2)] / [I2 / (I1 + I2)]: the springs fix the direction of the
    bowl against its base. Momentum fixes how much of it the bowl takes: m2 / (m1 + m2) of the rise and I2 /
    (I1 + I2) of the turn.

    Parameters
    ----------
    machine : Machine
        A rigid bowl on inclined leaf springs, its centre of mass on the axis.
    radius : array_like [m]

    Returns
    -------
    float or array [rad]
        pi / 2 on the axis.

    References
    ----------
    docs/bowl.md, "How it is computed".
    """
    rise, turn = shares(machine)
    along = machine.spring_radius * rise * np.sin(machine.spring_angle)
    return np.arctan2(along, np.asarray(radius) * turn * np.cos(machine.spring_angle))


def shares(machine: Machine) -> tuple[float, float]:
    """Return the bowl's shares of the rise and of the turn between bowl and base.

    m2 / (m1 + m2) and I2 / (I1 + I2): 1 is the bowl, 2 is the base.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [1]
        Of the rise.
    float [1]
        Of the turn.

    References
    ----------
    The bowl and its base keep their momentum; docs/bowl.md, "How it is computed".
    """
    rise = machine.base_mass / (machine.bowl_mass + machine.base_mass)
    return rise, machine.base_inertia / (machine.bowl_inertia + machine.base_inertia)


def vibration_angle(machine: Machine, radius: ArrayLike, climb: ArrayLike) -> Any:
    """Return the angle from the track to the bowl's motion, within 0 to 90 deg.

    Parameters
    ----------
    machine : Machine
    radius : array_like [m]
        Of the track.
    climb : array_like [rad]
        Of the track.

    Returns
    -------
    float or array [rad]
        ``direction`` less the climb.

    References
    ----------
    docs/bowl.md, "How it is computed".
    """
    return np.clip(direction(machine, radius) - climb, 0.0, RIGHT_ANGLE_RAD)
