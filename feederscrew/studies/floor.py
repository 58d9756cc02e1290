"""Everything ``feeder floor`` finds of one part, in the order of the pipeline."""

from dataclasses import dataclass

from feederscrew.bowl.record import Bowl
from feederscrew.mechanics import limits
from feederscrew.mechanics.cycle import Cycle
from feederscrew.mechanics.floor import balance
from feederscrew.mechanics.published import floor as published_floor
from feederscrew.mechanics.standing import standing
from feederscrew.part.record import Part
from feederscrew.resting.posture import Posture


@dataclass(frozen=True, eq=False)
class FloorAnalysis:
    """One part on one aspect in one heading on the floor of one bowl."""

    part: Part
    posture: Posture
    bowl: Bowl
    heading: float  # [rad] theta
    now: balance.FloorMotion  # at the upper reversal, from rest
    printed: published_floor.PrintedFloor  # the same by the printed equations
    cycle: balance.FloorMotion  # over one settled period
    course: Cycle
    why: str | None = None  # this aspect; None where it was asked for


def analyse(part, bowl, aspect=None, heading=0.0):
    """A part on the bowl floor.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        Single values.
    aspect : str, optional
        Its name; without one, as ``standing`` chooses.
    heading : float [rad]
        theta.

    Returns
    -------
    FloorAnalysis

    Raises
    ------
    FeederError
        If the part has no such aspect, or the drive is not ``limits.plain``.
    """
    limits.plain(bowl)
    stand, why = standing(part, aspect, "floor")
    cycle, course = balance.over_cycle(stand, bowl, heading)
    return FloorAnalysis(
        part=part,
        posture=stand,
        bowl=bowl,
        heading=heading,
        now=balance.motion(stand, bowl, heading),
        printed=published_floor.motion(stand, bowl, heading),
        cycle=cycle,
        course=course,
        why=why,
    )
