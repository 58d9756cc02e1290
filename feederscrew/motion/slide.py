"""The study of ``feeder slide``: when a part slips, which way, and when it hops."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Reals
from feederscrew.base.geometry.grids import Grid, GridAxis, evaluate
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.record import Bowl
from feederscrew.motion import limits
from feederscrew.motion.limits import Regime

ROUND_STEPS = (1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)  # round numbers within a decade
PLAIN_TOP = 3.0  # G that every sliding map reaches
MAX_RATIO = 1e6  # G of a hop that no bowl within the limits of its keys reaches: it is left off the map
RATIO_MARGIN = 1.25  # how far past the hop, and past the bowl's own G, it reaches
MIN_MAP_ROWS = 32  # of a map, computed at a time: some dozen arrays are made of each
# of a map that is printed
FINE_STEP = 0.05  # of G
MOST_STEPS = 200
MAX_ANGLE = np.radians(89.9)  # of a surface: at 90 deg [4.27] is 0/0 on the hop line
MAP_COLUMNS = 61  # points of a surface in either direction
RATIO_DECIMALS = 12  # decimals of a limit; cos(90 deg) leaves 6e-17


@dataclass(frozen=True, eq=False)
class SlideMap(ReadableRecord):
    """Slip over (alpha - theta, G) at one vibration angle."""

    beta: float  # [rad]
    grid: Grid
    ratio: float  # [1] G of the bowl itself
    alpha_minus_theta: float  # [rad] of a part that faces along the bowl's track
    friction: float  # [1] static
    at_bowl: dict[str, float]  # mu_limit, mu_forward, mu_backward, throw_number at the bowl's own point
    regime: Regime  # there
    onsets: dict[str, float]  # [1] G of forward slip, backward slip and hop at the bowl's heading
    level_hop: float  # [1] G of the hop on a level floor, the pole of mu_limit

    def sheet(self, highest: float) -> tuple[Floats, Floats, Floats]:
        """Compute the surface of [4.27] from zero up to a friction [1], on a grid that follows that edge.

        alpha - theta [rad], ratio [1] and friction [1], each (S, S); it ends at the map's highest G in
        any case.
        """
        first, last = -np.pi / 2.0, np.pi / 2.0
        angles = MAX_ANGLE * np.sin(np.linspace(first, last, MAP_COLUMNS))[:, None]  # dense where it is steep
        edge = np.minimum(self.level_line(highest, angles), self.grid.second.values[-1])
        ratio = edge * np.linspace(0.0, 1.0, MAP_COLUMNS)
        friction = limits.published_limit(ratio, self.beta, angles)
        friction = np.minimum(friction, highest)  # rounding at the pole
        return np.broadcast_to(angles, ratio.shape), ratio, friction

    def level_line(self, friction: float, alpha_minus_theta: Floats) -> Floats:
        """Return the G [1] at which [4.27] equals a friction [1], over alpha - theta [rad]."""
        return limits.published_ratio(friction, self.beta, alpha_minus_theta)


@dataclass(frozen=True, eq=False)
class SlideStudy(ReadableRecord, view="slide.SLIDE_VIEW"):
    """The sliding maps of one bowl, one for each vibration angle."""

    bowl: Bowl
    as_published: bool  # whether mu_limit keeps its negative branch
    maps: tuple[SlideMap, ...]

    def fine(self, shape: tuple[int, int]) -> tuple[SlideMap, ...]:
        """Compute maps of ``shape`` values for pictures, without what [4.27] has below 0."""
        return tuple(sliding_map(self.bowl, slide_map.beta, shape=shape) for slide_map in self.maps)


@former_keywords()
def slide(
    bowl: Bowl,
    angles: Iterable[Quantity] = (),
    *,
    as_published: bool = False,
) -> SlideStudy:
    """Compute when a part slips, which way, and when it hops, as ``feeder slide``.

    Parameters
    ----------
    bowl : Bowl
    angles : iterable of str or float [rad]
        Vibration angles, a map each; the bowl's without them.
    as_published : bool
        Keep the limiting friction of [4.27] where it is negative, past the hop; else it is NaN there.

    Returns
    -------
    SlideStudy

    Raises
    ------
    ConfigError
        If the drive is elliptical or has a second harmonic, or friction is another one backwards.

    References
    ----------
    Thesis, eq. [4.27] (docs/equations.md); on a climbing and banked track docs/conveying.md.
    """
    bowl = arguments.a_bowl(bowl)
    betas = [arguments.amount("angles", angle, "angle") for angle in angles]
    maps = tuple(
        sliding_map(bowl, beta, as_published=as_published)
        for beta in dict.fromkeys(betas or [bowl.drive.vibration_angle])
    )
    return SlideStudy(bowl, as_published, maps)


def sliding_map(
    bowl: Bowl, beta: float, *, as_published: bool = False, shape: tuple[int, int] | None = None
) -> SlideMap:
    """Compute the sliding map of a bowl at a vibration angle, in place of the bowl's own.

    Columns: mu_limit [4.27] on a level floor, mu_forward and mu_backward of the bowl's track beside its
    upright wall. The part of a drive across the track that presses against the wall is without friction.

    Parameters
    ----------
    bowl : Bowl
    beta : float [rad]
        Vibration angle.
    as_published : bool
        Keep [4.27] where it is negative: past the hop, and where the drive is reversed.
    shape : (int, int), optional
        Values of either axis, for pictures; by default steps of 3 deg and of a round acceleration ratio.

    Returns
    -------
    SlideMap

    Raises
    ------
    ConfigError
        If the drive is not ``limits.plain``.

    References
    ----------
    The thesis, eq. [4.27]; ``motion.limits``.
    """
    direction = limits.plain(bowl).drive.direction
    ratio = float(limits.acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity))
    climb, wall = bowl.track.climb, (bowl.friction.wall, bowl.track.bank)

    def cells(alpha_minus_theta: Reals, ratio: Reals) -> dict[str, Array]:
        pole = np.abs(ratio * np.sin(beta) - 1.0) <= limits.HOP_ROUNDING
        reversed_ = np.cos(alpha_minus_theta) < -limits.HOP_ROUNDING
        hidden = pole if as_published else limits.hops(ratio, beta) | reversed_
        forward = limits.forward_limit(ratio, beta, alpha_minus_theta, climb)
        backward = limits.backward_limit(ratio, beta, alpha_minus_theta, climb)
        columns = {
            "mu_limit": np.where(hidden, np.nan, limits.published_limit(ratio, beta, alpha_minus_theta)),
            "mu_forward": limits.of_floor(forward, *wall),
            "mu_backward": limits.of_floor(backward, *wall),
        }
        columns = {name: np.round(array, RATIO_DECIMALS) + 0.0 for name, array in columns.items()}
        friction = limits.effective(bowl.friction.static, *wall)
        return columns | {"regime": limits.regimes(ratio, beta, friction, alpha_minus_theta, climb)}

    # alpha - theta over half a turn, or over the whole one where the drive points backward
    widest = 90 if abs(direction) <= np.pi / 2.0 else 180
    headings = np.radians(np.arange(-widest, widest + 1, 3))
    first = GridAxis("alpha_minus_theta_deg", check.frozen(headings), np.pi / 180.0, "deg")
    # G from 0 past the hop and past the bowl's own, in round steps that grow with the range
    hop = float(limits.hop_ratio(beta))
    reached = hop if beta > 0.0 and hop < MAX_RATIO else 0.0
    top = _rounded_up(max(PLAIN_TOP, RATIO_MARGIN * reached, RATIO_MARGIN * ratio))
    step = max(FINE_STEP, _rounded_up(top / MOST_STEPS))
    ratios = np.round(np.arange(round(top / step) + 1) * step, RATIO_DECIMALS)
    second = GridAxis("acceleration_ratio", check.frozen(ratios))
    if shape is not None:
        first, second = (
            replace(axis, values=check.frozen(np.linspace(axis.values[0], axis.values[-1], count)))
            for axis, count in zip((first, second), shape)
        )
    grid = evaluate(first, second, cells, limits.POINT_REGIMES, rows=MIN_MAP_ROWS)
    point = {name: float(value) for name, value in cells(direction, ratio).items()}
    regime = limits.POINT_REGIMES[int(point.pop("regime"))]
    point["throw_number"] = float(limits.throw_number(ratio, beta, bowl.track.climb))
    here = limits.level(bowl)
    slip = (here.friction.static, beta, here.drive.direction, here.track.climb)
    forward, backward = float(limits.forward_ratio(*slip)), float(limits.backward_ratio(*slip))
    onsets = {
        "forward": forward,
        "backward": backward,
        "hop": float(limits.hop_ratio(beta, here.track.climb)),
    }
    return SlideMap(beta, grid, ratio, direction, bowl.friction.static, point, regime, onsets, hop)


def _rounded_up(number: float) -> float:
    """Return the next round number: 3.65 gives 4, 0.125 gives 0.2."""
    decade = 10.0 ** np.floor(np.log10(number))
    return float(next(step for step in ROUND_STEPS if step * decade >= number * (1.0 - 1e-12)) * decade)
