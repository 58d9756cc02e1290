"""A wall that steps outwards with the track: each turn lies beside the one before, and not above it.

What falls through a cut meets a slope that leads it to the turn before, or to the floor: so there may be more
than one turn of track. Seen in a section the wall of a turn stands upright, leads outwards as a slope, and
stands upright again below the next turn.
"""

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from feederscrew.errors import FeederError
from feederscrew.machine.sizing import MIN_WALL_ABOVE_PART_M

CYLINDER, STEPPED, CONICAL = SHAPES = ("cylinder", "stepped", "conical")
STAIRS_TURN = 2.0 * np.pi
TURN_CLEARANCE_M = 1e-3  # [m] by which the next turn stands further out than the track is wide
SLOPE, SURE = np.radians(40.0), np.radians(5.0)  # least slope, and how much steeper than parts hold still on
UNSUPPORTED_SLOPE_RAD = np.radians(45.5)  # a slope that needs no support
MIN_FLOOR_RADIUS_SHARE = 0.5  # of the bowl's radius: no floor is smaller
WALL_LIFT_M = 3e-4  # [m] by which the wall ends higher than the floor below it
QUARTER_TURN_POINTS = 16  # places in a quarter turn that a curve is led through


@dataclass(frozen=True)
class Stairs:
    """Section of the wall between the last turn of the track and the one before; lengths [m]."""

    shape: str
    step: float  # outwards
    flare: float  # [1] by which the wall's radius grows over the length of the track
    slope: float  # [rad] of what leads back inwards
    upright: float  # of the wall over the turn before
    below: float  # of upright wall below the last turn, at least
    most: float  # length of track that the bowl has room for

    @property
    def needed(self):
        """Least rise of a turn [m]: upright wall over the turn before, slope, upright wall below."""
        return self.upright + self.step * float(np.tan(self.slope)) + self.below

    def sections(self, path, theta, low) -> np.ndarray:
        """Return the corners (M, K, 2) [m] of the wall's inner side: radius and height, from below upwards.

        Parameters
        ----------
        path : TrackPath
        theta : (M,) float [rad]
            From a turn before the outlet to the outlet.
        low : float [m]
            Height below which no wall is needed.
        """
        last = path.at(-STAIRS_TURN * np.arange(1, 100))
        turns = int(np.argmax(path.risen(last) < low)) + 1
        rows: list[np.ndarray] = []
        for k in range(turns, -1, -1):
            s = path.at(np.asarray(theta) - STAIRS_TURN * k)
            lower = np.column_stack([path.wall_radius(s), path.risen(s)])
            rows.append(lower)
        corners = []
        for foot, above in itertools.pairwise(rows):
            step, pitch = (above - foot).T
            slide = step * np.tan(self.slope)
            high = np.clip(pitch - slide - self.below, 0.0, self.upright)
            slide = np.minimum(slide, pitch - high)
            corners += [foot, foot + np.column_stack([0.0 * high, high]),
                        np.column_stack([above[:, 0], foot[:, 1] + high + slide])]  # fmt: skip
        return np.stack([*corners, rows[-1]], axis=1)


def stairs(track, made_of, tooled, options, extents) -> Stairs | None:
    """Return the steps of a wall; None of a cylinder.

    Parameters
    ----------
    track : Track
    made_of : Material
    tooled : Stretch or None
    options : SolidOptions
    extents : (3,) float [m]
        Of the part along its axes.

    Returns
    -------
    Stairs or None

    Raises
    ------
    FeederError
        If the track does not rise enough for them, or devices are to stand on a wall that leans.
    """
    if options.shape == CYLINDER:
        return None
    if options.shape == CONICAL and tooled is not None:
        what = "conical leans outwards, and devices are computed by an upright wall"
        raise FeederError("sizing.shape", what, "take stepped")
    least = min([track.bank, *(bank for _, _, bank in tooled.leans)]) if tooled else track.bank
    step = track.width * np.cos(least) + TURN_CLEARANCE_M
    flare = -np.log1p(-step / track.radius) / STAIRS_TURN
    tallest = float(max(extents)) if tooled is None else tooled.tallest
    hangs = tooled is not None and any(cut.hangs for cut in tooled.cuts)
    slope = max(
        SLOPE if made_of.supported else UNSUPPORTED_SLOPE_RAD, float(np.arctan(options.friction)) + SURE
    )
    pitch = np.tan(track.climb) * step / flare
    below = 3.0 * made_of.plate + (float(max(extents)) + MIN_WALL_ABOVE_PART_M if hangs else 0.0)
    if options.shape == CONICAL:
        slope, below, upright = float(np.arctan2(pitch, step)), 0.0, 0.0
    else:
        upright = tallest + MIN_WALL_ABOVE_PART_M
        _check(pitch, upright + step * np.tan(slope) + below, step / flare)
    return Stairs(
        options.shape,
        float(step),
        float(flare),
        slope,
        upright,
        below,
        float((1.0 - MIN_FLOOR_RADIUS_SHARE) * track.radius / flare),
    )


def _check(pitch, needed, length) -> None:
    if pitch < needed:
        least = np.ceil(10.0 * np.degrees(np.arctan(needed / length))) / 10.0
        what = f"a turn rises {1e3 * pitch:.4g} mm, and a stepped wall needs {1e3 * needed:.4g} mm"
        raise FeederError("track.climb", what, f"give {least:.4g} deg, or sizing.shape: cylinder")


def shell(plan, kit) -> list[Any]:
    """Return the wall of a stepped or conical bowl, with what closes it below its outlet.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``.

    Returns
    -------
    list of bodies [mm]
    """
    quarters = -STAIRS_TURN, -0.75 * STAIRS_TURN, -0.5 * STAIRS_TURN, -0.25 * STAIRS_TURN, 0.0
    legs = [_leg(plan, kit, start, end) for start, end in itertools.pairwise(quarters)]
    halves = [kit.swept(legs[:2]), kit.swept(legs[2:])]
    return [kit.above(item, plan.underside + WALL_LIFT_M) for item in (kit.united(halves), _end(plan, kit))]


def _leg(plan, kit, start, end) -> tuple[Any, ...]:
    """Sections and frames of a quarter of the wall."""
    theta = np.linspace(start, end, (QUARTER_TURN_POINTS if kit.HAS_EXACT_CURVES else plan.segments // 4) + 1)
    inner = plan.stairs.sections(plan.path, theta, plan.underside - 2e-3)
    inner = np.concatenate([inner, inner[:, -1:]], axis=1)
    inner[:, -1, 1] = plan.top
    outer = inner + [plan.material.wall, 0.0]
    outer[:, 1:-2, 1] -= plan.material.wall
    outer[:, 0::3, 1] = np.where(np.arange(outer.shape[1])[0::3] > 0, outer[:, 0::3, 1], inner[:, 0::3, 1])
    corners = _corners(plan.stairs, inner.shape[1])
    sections = np.concatenate([outer[:, corners], inner[:, corners[::-1]]], axis=1)
    sine = np.where(theta == -STAIRS_TURN, 0.0, np.sin(theta))  # the two ends meet there
    towards = np.stack([np.cos(theta), sine], axis=-1)
    return sections, np.stack([np.zeros_like(towards), towards], axis=1)


def _corners(steps, count) -> list[Any]:
    """Which corners of a section are none of the track's own: an edge on its surface cuts badly."""
    last = count - 1
    if steps.shape == CONICAL:
        return [0, last - 1, last]  # the feet of all turns lie on one line
    return [k for k in range(count) if k % 3 or k in (0, last)]


def _end(plan, kit):
    """The plate that closes the wall where its last turn ends, below the outlet."""
    inner = plan.stairs.sections(plan.path, np.zeros(1), plan.underside - 2e-3)[0]
    low, rest = inner[-4], inner[-4:]
    under = plan.outlet_height - 0.5 * plan.material.plate
    half = 0.5 * plan.material.wall
    ring = [
        *(rest[1:3] + [half, -half]),
        [rest[3][0] + half, under],
        [low[0] + half, under],
    ]
    axes = np.column_stack([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    return kit.plank(shapely.Polygon(ring), plan.material.wall, axes, [0.0, 0.0, 0.0])


def floor_edge(plan, kit) -> np.ndarray:
    """Return the edge (K, 2) [m] of the floor, within the wall, seen from above."""
    theta = np.linspace(-STAIRS_TURN, 0.0, (64 if kit.HAS_EXACT_CURVES else plan.segments) + 1)[:-1]
    inner = plan.stairs.sections(plan.path, theta, plan.underside - 2e-3)
    r = np.array([np.interp(0.0, item[:, 1], item[:, 0]) for item in inner]) + 0.3 * plan.material.wall
    return np.column_stack([r * np.cos(theta), r * np.sin(theta)])
