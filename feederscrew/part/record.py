"""Part, in SI units; sizes that need a word: many facets, dimensions as small as tolerances."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.base.arrays import Floats, Points, Triangles
from feederscrew.base.columns import Column
from feederscrew.base.errors import FeederError, MeshError
from feederscrew.base.heavy import heavy
from feederscrew.base.records import ReadableRecord
from feederscrew.base.units import MM
from feederscrew.base.views import views
from feederscrew.part.hull import Hull

trimesh = heavy("trimesh")

CardBlock = dict[str, Any]  # values of a block of a part card by their keys, in SI units
MAX_FACETS = 20_000  # beyond, verdicts of devices take gigabytes and hours (100,000: 2.3 GB, no end)
PART_MEND = "give a Part, as load returns it"
SMALL_PART_M = 1e-3  # [m] largest dimension: below it shops measure in other tolerances
SMALL_SHARE, LARGE_SHARE = 0.05, 0.25  # [1] of the largest dimension: said of such a part, and of any


@dataclass(frozen=True)
class AspectNames:
    """The names of one file, each with a direction in the axes of the part file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    directions: tuple[tuple[str, tuple[float, float, float]], ...]  # unit vectors; down on that aspect

    @property
    def names(self) -> tuple[str, ...]:
        """The names in the order of the file."""
        return tuple(name for name, _ in self.directions)


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
class Part(ReadableRecord, view="record_lines.PART_VIEW"):
    """A solid to be fed: its surface (none for a part card) and its mass properties."""

    name: str  # file stem; with the body's number behind it where one of several is taken
    source: str  # the path as given, '-' for standard input
    sha256: str  # of the file's bytes; where one of several bodies is taken, of these and its number
    units: str  # of the file: mm, cm, m, um or in
    material: str  # what the density is, for people: 'steel (default)', '7.85 g/cm3'
    density: float | None  # [kg/m3]; None for a part card without one
    volume: float | None  # [m3]; None for a part card
    mass: float  # [kg]
    centre_of_mass: Floats  # (3,) [m] in the file's axes
    inertia: Floats  # (3, 3) [kg m2] about the centre of mass, along the file's axes
    vertices: Points | None = None  # (V, 3) [m]
    faces: Triangles | None = None  # (F, 3) indices, counter-clockwise seen from outside
    aspects: tuple[CardAspect, ...] = ()  # of a part card
    printed: dict[str, CardBlock] | None = None  # further data of a part card, as read: 'floor', 'track'
    hull: Hull | None = None  # about the centre of mass; None for a part card
    names: AspectNames | None = None  # that the user gives its aspects
    open_surface: bool = False  # computed with ``allow_open``: every output must say so
    warnings: tuple[str, ...] = ()
    file_sha256: str | None = None  # of the file's bytes; None: as ``sha256``

    @property
    def corners(self) -> Points:
        """(V, 3) [m] corners of the surface, from the centre of mass; none of a part card."""
        return np.empty((0, 3)) if self.vertices is None else self.vertices - self.centre_of_mass

    @property
    def mesh(self) -> Any:
        """The surface as a ``trimesh.Trimesh`` [m], in the axes of the file.

        Raises
        ------
        MeshError
            If the part is a part card, which has no shape.
        """
        if self.vertices is None:
            raise MeshError(self.source, "is a part card, it has no shape", "give a mesh")
        return trimesh.Trimesh(np.array(self.vertices), np.array(self.faces), process=False)

    def show(self) -> Any:
        """Show the part on each aspect, to be turned: in a notebook, or else in a browser.

        Returns
        -------
        ShownPart
            Its ``path`` is the page, one HTML file that needs no other and no network.

        Raises
        ------
        MeshError
            If the part is a part card, which has no shape.
        """
        if self.vertices is None:
            raise MeshError(self.source, "is a part card, it has no shape", "give a mesh")
        return views().shown(self)

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of each file it was read from, by its path."""
        named = {} if self.names is None else {self.names.source: self.names.sha256}
        return {self.source: self.file_sha256 or self.sha256} | named


PART_COLUMNS: tuple[Column[Part], ...] = (  # of every document
    Column("part", lambda part: part.name),
    Column("units", lambda part: part.units),
    Column("material", lambda part: part.material),
    Column("density_g_cm3", lambda part: part.density, "g/cm3"),
    Column("mass_g", lambda part: part.mass, "g"),
    Column("volume_mm3", lambda part: part.volume, "mm3"),
    Column("centre_of_mass_mm", lambda part: part.centre_of_mass, "mm"),
    Column("inertia_g_mm2", lambda part: part.inertia, "g mm2"),
    Column("open_surface", lambda part: part.open_surface),
)
# what was assumed of a part
CONDITION_COLUMNS = tuple(
    column
    for column in PART_COLUMNS
    if column.name in ("units", "material", "density_g_cm3", "centre_of_mass_mm", "open_surface")
)


def refuse_many_facets(part: Part) -> None:
    """Refuse a part whose surface has more facets than can be followed past devices.

    Parameters
    ----------
    part : Part
        A part card has no facets.

    Raises
    ------
    FeederError
        With more than ``MAX_FACETS`` facets.
    """
    if part.faces is not None and len(part.faces) > MAX_FACETS:
        what = f"has {len(part.faces)} facets, too many to follow on the track"
        raise FeederError(part.source, what, f"export it more coarsely, with {MAX_FACETS} facets at most")


def small_part_remarks(part: Part, allowances: Mapping[str, float], width: float | None) -> tuple[str, ...]:
    """Say where allowances are of the size of a part, or a track is no wider than one.

    A part is compared with its box along the file's axes. It lies on the track with its middle dimension
    across it where it lies as low and as narrow as it can without standing on edge.

    Parameters
    ----------
    part : Part
        Nothing is said of one without a surface.
    allowances : mapping of str to float [m]
        'margin', 'play', 'tolerance': they are added up.
    width : float [m] or None
        Of the track.

    Returns
    -------
    tuple of str
        A sentence each, with the numbers.
    """
    if part.vertices is None:
        return ()
    least, middle, largest = np.sort(np.ptp(part.vertices, axis=0))
    size = " x ".join(f"{length / MM:.3g}" for length in (largest, middle, least))
    remarks = []
    total = sum(allowances.values())
    if total >= (SMALL_SHARE if largest < SMALL_PART_M else LARGE_SHARE) * largest:
        listed = ", ".join(f"{name} {length / MM:.6g} mm" for name, length in allowances.items())
        together = f", together {total / MM:.6g} mm," if len(allowances) > 1 else ""
        exceeds = total > least
        relation = "more than its least dimension" if exceeds else f"{100 * total / least:.0f} % of its least"
        remarks.append(
            f"the part is {size} mm: {listed}{together} are {100 * total / largest:.0f} % of its largest "
            f"dimension and {relation}: give values for such a part"
        )
    if width is not None and width <= middle:
        remarks.append(f"the track, {width / MM:.3g} mm wide, is no wider than one part of {size} mm")
    return tuple(remarks)
