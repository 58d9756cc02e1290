"""The study of ``feeder floor``: a part on one aspect in one heading on the floor of one bowl."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from feederscrew.arrivals.entry import likeliest
from feederscrew.base.arrays import Array, Floats
from feederscrew.base.columns import Column
from feederscrew.base.geometry.grids import Grid, evaluate, span
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.record import Bowl, BowlGrid
from feederscrew.motion import floor_balance, limits, motion_maps
from feederscrew.motion.cycle import Cycle
from feederscrew.part.record import Part
from feederscrew.resting.posture import Posture, choose_posture

# as Figure 5-6
TOP_ANGLE = np.pi / 2.0  # [rad]
TOP_FRICTION = 1.0  # [1]
# as Figure 5-7, or more
LEAST_FREQUENCY = 10.0  # [Hz]
TOP_FREQUENCY = 120.0  # [Hz]
TOP_AMPLITUDE = 0.5e-3  # [m]
MAP_MARGIN = 1.25  # a map reaches at least so far beyond the bowl's own point


@dataclass(frozen=True, eq=False)
class FloorStudy(ReadableRecord, view="floor.FLOOR_VIEW"):
    """Motion of the part at the upper reversal and over a cycle; maps on request."""

    part: Part
    posture: Posture
    bowl: Bowl
    heading: float  # [rad] theta
    now: floor_balance.FloorMotion  # at the upper reversal, from rest
    cycle: floor_balance.FloorMotion  # over one settled period
    course: Cycle
    why: str | None = None  # this aspect; None where it was asked for
    printed: ClassVar[Any] = None  # the upper reversal by print, in `thesis.motion`

    @property
    def stable_heading(self) -> float:
        """Return the heading [rad] that the part turns to while it slides; NaN for none."""
        return floor_balance.stable_heading(self.posture, self.bowl)

    def cells(self, bowl: BowlGrid, heading: float | Floats) -> dict[str, Array]:
        """Compute the upper reversal for arrays of bowl settings and headings theta [rad].

        Arrays by name, as ``motion.motion_maps.floor_cells`` has them.
        """
        return motion_maps.floor_cells(self.posture, bowl, heading)

    def over_angle_and_friction(self, count: int) -> Grid:
        """Compute the upper reversal over ``count`` values of either quantity, as Figure 5-6."""

        many: BowlGrid = self.bowl

        def function(beta: Floats, mu: Floats) -> dict[str, Array]:
            varied = replace(many, drive=replace(many.drive, vibration_angle=beta))
            return self.cells(floor_balance.with_friction(varied, mu), self.heading)

        angle = span("beta_deg", 0.0, TOP_ANGLE, count, np.pi / 180.0, "deg")
        friction = span("friction", 0.0, TOP_FRICTION, count)
        return evaluate(angle, friction, function, motion_maps.FLOOR_REGIMES)

    def over_frequency_and_amplitude(self, count: int) -> Grid:
        """Compute it over ``count`` values of frequency [Hz] and of amplitude [mm], as Figure 5-7."""

        many: BowlGrid = self.bowl

        def function(f: Floats, a: Floats) -> dict[str, Array]:
            drive = replace(many.drive, frequency=f, amplitude=a)
            return self.cells(replace(many, drive=drive), self.heading)

        highest = max(TOP_FREQUENCY, MAP_MARGIN * self.bowl.drive.frequency)
        widest = max(TOP_AMPLITUDE, MAP_MARGIN * self.bowl.drive.amplitude)
        frequency = span("frequency_Hz", LEAST_FREQUENCY, highest, count, label="Hz")
        amplitude = span("amplitude_mm", 0.0, widest, count, 1e-3, "mm")
        return evaluate(frequency, amplitude, function, motion_maps.FLOOR_REGIMES)

    def alignment(self) -> tuple[Floats, dict[str, Array]]:
        """Compute theta'' over every heading, (361,) [rad], a degree apart.

        Arrays by name, as ``motion.motion_maps.floor_cells`` has them.
        """
        headings = np.radians(np.arange(-180.0, 181.0, 1.0))
        return headings, self.cells(self.bowl, headings)


FLOOR_COLUMNS: tuple[Column[FloorStudy], ...] = (  # of the document
    Column("part", lambda study: study.part.name),
    Column("aspect", lambda study: study.posture.name),
    Column("lies", lambda study: study.posture.lies),
    Column("rolls", lambda study: study.posture.rolls),
    Column("heading_deg", lambda study: study.heading, "deg"),
    Column("height_mm", lambda study: study.posture.height, "mm"),
    Column("drive_offset_mm", lambda study: study.posture.offset, "mm"),
    Column("rolling_circle_mm", lambda study: _rolling_circle(study.posture), "mm"),
    Column("turning_inertia_g_mm2", lambda study: study.posture.turning_inertia, "g mm2"),
    Column("as_published", lambda study: study.printed is not None),
    Column("regime", lambda study: floor_balance.regime(study.cycle.state)),
)


def _rolling_circle(posture: Posture) -> float | None:
    return posture.rolling_circle if np.isfinite(posture.rolling_circle) else None


@former_keywords()
def floor(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity = 0.0,
) -> FloorStudy:
    """Compute the forces on a part on the bowl's floor and what it does, as ``feeder floor``.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name, 'A', or with its heading, 'A@354'; the likeliest without it.
    heading : str or float [rad]
        By which the part is turned from the direction of the drive, '90 deg'.

    Returns
    -------
    FloorStudy

    Raises
    ------
    FeederError
        If the part has no such aspect, the drive is elliptical or has a second harmonic, or friction is
        another one backwards.

    References
    ----------
    docs/mechanics.md; the thesis's equations of a part on the floor are in docs/equations.md.
    """
    part, bowl = arguments.a_part(part), arguments.a_bowl(bowl)
    aspect, named = arguments.an_orientation(aspect, None)
    angle = arguments.amount("heading", heading, "angle") if named is None else named
    limits.plain(bowl)
    stand, why = choose_posture(part, aspect, "floor", partial(likeliest, bowl=bowl))
    now = floor_balance.motion(stand, bowl, angle)
    cycle, course = floor_balance.over_cycle(stand, bowl, angle)
    return FloorStudy(part, stand, bowl, angle, now, cycle, course, why)
