"""The studies of the floor and the track, with the printed equations' solution beside the complete one."""

from dataclasses import dataclass

import numpy as np

from feederscrew.studies import floor as on_floor
from feederscrew.studies import track as on_track
from feederscrew.thesis.motion import printed_floor, printed_track
from feederscrew.thesis.motion.comparison import FLOOR_TERMS, TRACK_TERMS, Term, omitted_terms


@dataclass(frozen=True, eq=False, kw_only=True)
class FloorAsPublished(on_floor.FloorStudy):
    """A FloorStudy whose upper reversal, and each cell of its maps, is solved by print as well."""

    printed: printed_floor.PrintedFloor  # type: ignore[misc]
    terms = FLOOR_TERMS

    def cells(self, bowl, heading):
        """Return what ``FloorStudy.cells`` does, and what print says of it as ``published_*``."""
        printed = printed_floor.motion(self.posture, bowl, heading)
        return super().cells(bowl, heading) | {
            "published_z_m_s2": printed.acceleration[..., 0],  # goes on where the part has lost contact
            "published_alignment_rad_s2": printed.turning,
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class TrackAsPublished(on_track.TrackStudy):
    """A TrackStudy whose upper reversal is solved by print as well."""

    printed: printed_track.PrintedTrack  # type: ignore[misc]
    omitted: tuple[Term, ...]  # what these leave out
    terms = TRACK_TERMS


def floor(part, bowl, aspect=None, heading=0.0):
    """Study a part on the bowl floor, by print as well.

    Parameters
    ----------
    part, bowl, aspect, heading
        As for ``studies.floor.floor``, which names the errors.

    Returns
    -------
    FloorAsPublished
    """
    found = on_floor.floor(part, bowl, aspect, heading)
    return FloorAsPublished(**vars(found), printed=printed_floor.motion(found.posture, bowl, heading))


def track(part, bowl, aspect=None, heading=None):
    """Study a part on the track against the wall, by print as well.

    Parameters
    ----------
    part, bowl, aspect, heading
        As for ``studies.track.track``, which names the errors.

    Returns
    -------
    TrackAsPublished
    """
    found = on_track.track(part, bowl, aspect, heading)
    levers = _levers(found)
    return TrackAsPublished(
        **vars(found),
        printed=printed_track.motion(levers, bowl, found.seat.heading),
        omitted=omitted_terms(found.seat, bowl, found.now, levers.offset),
    )


def _levers(found):
    """Levers of the printed equations: the card's own, or the mesh's."""
    posture, seat = found.posture, found.seat
    printed = {} if posture.corners is not None else posture.printed["track"]
    ahead = posture.offset * np.cos(seat.heading)
    levers = printed_track.levers(seat, float(ahead), printed.get("axes", "tilted"))
    return printed_track.printed_levers(levers, printed) if printed else levers
