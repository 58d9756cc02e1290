"""The dimensions of a bowl and its track: what sizing finds, and what the solid is made of."""

from dataclasses import dataclass

from feederscrew.bowl.record import UNBALANCE_UNKNOWN, Unbalance

# [m] of upright wall over a part on a track or below its rails, at least, where it steps out
MIN_WALL_ABOVE_PART_M = 5e-3


@dataclass(frozen=True)
class Size:
    """Bowl and track."""

    diameter: float  # [m]
    least: dict[str, float]  # [m] diameter that each rule asks for
    track_width: float  # [m]
    clearance: float  # [m] play of the part across the track
    bend: float  # [m] l^2 / (4 R): its sagitta on both sides
    climb: float  # [rad]
    depth: float  # [m] rise of the track
    turns: float
    pitch: float  # [m] rise of one turn
    mass: float | None = None  # [kg] of the bowl, where it is known from its solid
    inertia: float | None = None  # [kg m2] of the same about its axis
    unbalance: Unbalance = UNBALANCE_UNKNOWN  # of the same
    room: float | None = None  # [m] radius of its inside at the bottom, where its solid steps outwards
