"""What a part is, in SI units."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.part.aspect_names import AspectNames
from feederscrew.part.hull import Hull
from feederscrew.records import ReadableRecord


@dataclass(frozen=True, eq=False)
class CardAspect:
    """One resting aspect as a part card gives it; None where the source is silent."""

    name: str
    height: float  # [m] of the centre of mass over the aspect
    faces: int = 1
    polar_inertia: float | None = None  # [kg m2] about the aspect's normal through the centre of mass
    contact_area: float | None = None  # [m2]
    solid_angle: float | None = None  # [sr], or relative when the source states no unit
    solid_angle_in_sr: bool = True
    csa_height: float | None = None  # [m] the height the source divides the solid angle by; None: height
    stability_height: float | None = None  # [m] the height the source divides the area by; None: height


@dataclass(frozen=True, eq=False)
class Part(ReadableRecord):
    """A solid to be fed: its surface (none for a part card) and its mass properties."""

    name: str  # file stem; with the body's number behind it where one of several is taken
    source: str  # the path as given, '-' for standard input
    sha256: str  # of the file's bytes; where one of several bodies is taken, of these and its number
    units: str  # of the file: mm, cm, m, um or in
    material: str  # what the density is, for people: 'steel (default)', '7.85 g/cm3'
    density: float | None  # [kg/m3]; None for a part card without one
    volume: float | None  # [m3]; None for a part card
    mass: float  # [kg]
    centre_of_mass: np.ndarray  # (3,) [m] in the file's axes
    inertia: np.ndarray  # (3, 3) [kg m2] about the centre of mass, along the file's axes
    vertices: np.ndarray | None = None  # (V, 3) [m]
    faces: np.ndarray | None = None  # (F, 3) indices, counter-clockwise seen from outside
    aspects: tuple[CardAspect, ...] = ()  # of a part card
    printed: dict | None = None  # further data of a part card, as read: 'floor', 'track'
    hull: Hull | None = None  # about the centre of mass; None for a part card
    names: AspectNames | None = None  # that the user gives its aspects
    open_surface: bool = False  # computed with ``allow_open``: every output must say so
    warnings: tuple[str, ...] = ()
    file_sha256: str | None = None  # of the file's bytes; None: as ``sha256``

    @property
    def inputs(self) -> Any:
        """The sha256 of each file it was read from, by its path."""
        named = {} if self.names is None else {self.names.source: self.names.sha256}
        return {self.source: self.file_sha256 or self.sha256} | named
