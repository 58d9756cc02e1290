"""What stands along the track at one device: holes, blades, plates, sections and jets, of no kind by name.

Coordinates of a device: x along the wall from where the device begins, y from the wall inwards, z over the
track. A device hands over one `Standing`; `trial.staging` makes of
it what the kernel takes.
"""

from dataclasses import dataclass

import numpy as np

BLADE = 1.5e-3  # [m] thickness of a blade


@dataclass(frozen=True, eq=False)
class Hole:
    """A hole through the track."""

    outline: np.ndarray  # (K, 2) [m] x, y; open into the wall where y <= 0, at the free edge where y >= width


@dataclass(frozen=True, eq=False)
class Blade:
    """An upright plate on or over the track, at any angle to it."""

    solid: object  # shapely: of its face [m], along the face from its foot, height over the track
    foot: tuple[float, float] = (0.0, 0.0)  # [m] x, y where the face begins
    heading: float = 0.5 * np.pi  # [rad] from the track's direction; less than a right angle is swept back
    thickness: float = BLADE  # [m] behind the face
    friction: float | None = None  # [1] static and kinetic, both ways; None is the track's


@dataclass(frozen=True, eq=False)
class Plate:
    """A further level plate, below the track."""

    level: float  # [m] z of its surface
    begin: float  # [m] x
    end: float = np.inf  # [m]
    aside: float = 0.0  # [m] y, where it begins


@dataclass(frozen=True, eq=False)
class Section:
    """A stretch of the track with another cross-section."""

    begin: float  # [m] x
    end: float  # [m]
    faces: np.ndarray  # (K, 2) [m] y, z from the wall outwards: two points are one slope, three a groove


@dataclass(frozen=True, eq=False)
class Jet:
    """A round jet that pushes what of a part is in it."""

    at: tuple[float, float, float]  # [m] x, y, z of its mouth
    towards: tuple[float, float, float]  # [1] along the wall, inwards, up
    radius: float  # [m]
    pressure: float  # [Pa] on the area of the part across the jet
    reach: float = np.inf  # [m] from the mouth
    frequency: float = 0.0  # [Hz] of its pulses; 0 is steady
    duty: float = 1.0  # [1] share of a pulse in which it blows
    phase: float = 0.0  # [rad] of a pulse at the time 0


@dataclass(frozen=True, eq=False)
class Standing:
    """All that stands along the track at one device."""

    length: float = 0.0  # [m] of the device along the wall
    holes: tuple[Hole, ...] = ()
    blades: tuple[Blade, ...] = ()
    plates: tuple[Plate, ...] = ()
    sections: tuple[Section, ...] = ()
    jets: tuple[Jet, ...] = ()
    drop: float = 0.0  # [m] by which the track that goes on lies lower
    aside: float = 0.0  # [m] from the wall, where that begins
    hangs: bool = False  # whether parts leave hanging, their centres of mass below the track
    settles: float = 0.0  # of the part's size: how far behind the device parts go on until they are looked at
