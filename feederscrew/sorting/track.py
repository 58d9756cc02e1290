"""The study of ``feeder track``: a part on one aspect against the wall of one bowl."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import likeliest
from feederscrew.base.arrays import Array, Floats
from feederscrew.base.columns import Column
from feederscrew.base.geometry import grids
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.reading import KeyRange, Setting
from feederscrew.bowl.record import Bowl
from feederscrew.motion import limits, motion_maps, track_balance, track_contacts
from feederscrew.motion.cycle import Cycle
from feederscrew.motion.floor_balance import HOP, SLIDE, STICK, TIP
from feederscrew.motion.headings import Headings
from feederscrew.motion.track_balance import Seat, bank_without_radial_friction
from feederscrew.motion.track_contacts import Opening, first_to_open
from feederscrew.part.record import Part
from feederscrew.resting.posture import Posture, choose_posture
from feederscrew.sorting import orientations, tipping

USUAL = ("track.bank=0deg:30deg:41", "track.climb=0deg:8deg:41")  # of a map


@dataclass(frozen=True, eq=False)
class TrackStudy(ReadableRecord, view="track.TRACK_VIEW"):
    """Reactions on the part at the upper reversal and over a cycle; maps on request."""

    part: Part
    posture: Posture
    bowl: Bowl
    seat: Seat
    headings: Headings | None  # None of a part card
    row: int  # of the headings, the one taken
    now: track_balance.TrackMotion  # at the upper reversal, from rest
    cycle: track_balance.TrackMotion  # over one settled period
    course: Cycle
    opening: Opening
    bank_without_radial_friction: float  # [rad]
    held_across: bool  # at rest, by friction that the reactions of ``now`` do not show
    laid_heading: float | None  # [rad] as laid down; None for the most frequent that stays on the track
    why: str | None = None  # this aspect; None where it was asked for
    stands: tipping.Stands | None = None  # what the rate reckons with; None of a part card
    printed: ClassVar[Any] = None  # the upper reversal by print, in `thesis.motion`

    def over(self, settings: Sequence[Setting], ranges: Sequence[KeyRange] = ()) -> grids.Grid:
        """Compute the upper reversal at every pair of two values of the bowl, else as it is.

        The ranges are two, or none for bank and climb. The columns of the Grid are those of
        ``motion.motion_maps``, in SI; NaN where the part does not fit.
        """
        first, second = ranges or bowls.key_ranges(USUAL)

        def function(x: Floats, y: Floats) -> dict[str, Array]:
            bowl = limits.plain(bowls.swept(settings, {first.key.name: x, second.key.name: y}))
            return motion_maps.track_cells(self.posture, bowl, self.laid_heading)

        return grids.evaluate(first.axis, second.axis, function, motion_maps.TRACK_REGIMES)


TRACK_COLUMNS: tuple[Column[TrackStudy], ...] = (  # of the document
    Column("part", lambda study: study.part.name),
    Column("aspect", lambda study: study.posture.name),
    Column("heading_deg", lambda study: study.seat.heading, "deg"),
    Column("height_mm", lambda study: study.seat.height, "mm"),
)


@former_keywords()
def track(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
) -> TrackStudy:
    """Compute the reactions on a part on the track against the wall, as ``feeder track``.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name, 'A', or with its heading, 'A@354'; the likeliest without it.
    heading : str or float [rad], optional
        As laid down: pushed to the wall, the part turns to the stable heading of that range. The most
        frequent that stays on the track without it.

    Returns
    -------
    TrackStudy

    Raises
    ------
    FeederError
        If there is no such aspect, the bowl is smaller than the part, the part falls off the track, the drive
        is elliptical or has a second harmonic, or friction is another one backwards.

    References
    ----------
    docs/mechanics.md; the thesis's equations of a part on the track are in docs/equations.md.
    """
    part, bowl = arguments.a_part(part), arguments.a_bowl(bowl)
    aspect, angle = arguments.an_orientation(aspect, heading)
    limits.plain(bowl)
    posture, why = choose_posture(part, aspect, "track", partial(likeliest, bowl=bowl))
    seat, headings, row = motion_maps.seated(posture, bowl, angle)
    now = track_balance.motion(seat, bowl)  # from rest, which friction may hold though the least would not do
    held_across = bool(now.state in (SLIDE, TIP) and track_contacts.has_equilibrium(seat, bowl))
    if held_across:
        now = replace(track_balance.motion(seat, bowl, held=True), state=np.array(STICK))
    cycle, course = track_balance.over_cycle(seat, bowl)
    stands = None
    if headings is not None:
        orientation = orientations.orientation_at(posture, headings, row, {}, bowl.track)
        stands = tipping.stands(orientation, bowl, bool((cycle.state == HOP).any()))
    opening, bank = first_to_open(seat, bowl), bank_without_radial_friction(seat)
    motion = now, cycle, course, opening, bank, held_across
    return TrackStudy(part, posture, bowl, seat, headings, row, *motion, angle, why, stands)
