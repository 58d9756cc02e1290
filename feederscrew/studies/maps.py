"""Grids over two quantities, and the sliding map: values, regime codes, NaN where there is no answer."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check, units
from feederscrew.mechanics import limits

STEPS = (1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)  # round numbers within a decade
PLAIN_TOP = 3.0  # G that every sliding map reaches
MARGIN = 1.25  # how far past the hop, and past the bowl's own G, it reaches
FINE_STEP, MOST_STEPS = 0.05, 200  # of G, in a map that is printed
NOISE = 12  # decimals of a limit; cos(90 deg) leaves 6e-17


@dataclass(frozen=True, eq=False)
class Axis:
    """One quantity of a grid and the values it takes."""

    column: str  # in tables, with its unit: 'beta_deg'
    values: np.ndarray  # (N,) in SI
    unit: float = 1.0  # SI units in one unit of the column

    @property
    def shown(self):
        """The values in the column's unit."""
        return self.values / self.unit


@dataclass(frozen=True, eq=False)
class Grid:
    """Values at every pair of two axes, the first along axis 0."""

    first: Axis
    second: Axis
    values: dict[str, np.ndarray]  # (N1, N2) by column name
    codes: np.ndarray  # (N1, N2) places in ``names``
    names: tuple[str, ...]  # of the regimes

    def columns(self):
        """The cells as columns of a table, the second axis running fastest."""
        first, second = np.meshgrid(self.first.shown, self.second.shown, indexing="ij")
        return {
            self.first.column: first.ravel(),
            self.second.column: second.ravel(),
            **{name: array.ravel() for name, array in self.values.items()},
            "regime": np.asarray(self.names)[self.codes.ravel()],
        }

    def shares(self):
        """Fraction of the cells in each regime, by name."""
        counts = np.bincount(self.codes.ravel(), minlength=len(self.names))
        return {name: float(count / self.codes.size) for name, count in zip(self.names, counts)}

    def unanswered(self, column):
        """Number of cells without a value."""
        return int(np.isnan(self.values[column]).sum())


@dataclass(frozen=True, eq=False)
class SlideMap:
    """What slips over (alpha - theta, G) at one vibration angle."""

    beta: float  # [rad]
    grid: Grid
    ratio: float  # [1] G of the bowl itself
    alpha_minus_theta: float  # [rad] of a part that faces along the bowl's track
    friction: float  # [1] static
    at_bowl: dict[str, float]  # mu_limit, mu_forward, mu_backward, throw_number at the bowl's own point
    regime: str  # there
    onsets: dict[str, float]  # [1] G of forward slip, backward slip and hop at the bowl's heading
    level_hop: float  # [1] G of the hop on a level floor, the pole of mu_limit


def axis(span):
    """The Axis of a ``bowl.vary.Range``."""
    key = span.key
    return Axis(key.column, check.frozen(np.array(span.values)), units.factor(key.unit, key.dimension))


def evaluate(first, second, function, names=()):
    """A grid of a function of two quantities.

    Parameters
    ----------
    first, second : Axis
    function : callable
        Takes (N1, 1) and (1, N2) arrays in SI; returns arrays that broadcast to (N1, N2) by
        column name, and under 'regime' the places in ``names``.
    names : tuple of str
        Of the regimes; without any, every code is 0.

    Returns
    -------
    Grid
    """
    shape = (len(first.values), len(second.values))
    found = function(first.values[:, None], second.values[None, :])
    full = {name: check.frozen(np.broadcast_to(array, shape)) for name, array in found.items()}
    codes = full.pop("regime", np.zeros(shape, dtype=int))
    return Grid(first, second, full, codes, tuple(names) or ("",))


def slide(bowl, beta, *, as_published=False, shape=None):
    """The sliding map of a bowl at one vibration angle.

    Parameters
    ----------
    bowl : Bowl
        Its friction and track decide the regimes; its drive marks the operating point.
    beta : float [rad]
        Vibration angle, in place of the bowl's own.
    as_published : bool
        Keep [4.27] where it is negative: past the hop, and where the drive is reversed.
    shape : (int, int), optional
        Values of either axis, for pictures; by default steps of 3 deg and of a round G.

    Returns
    -------
    SlideMap
        Columns mu_limit [4.27] on a level floor, mu_forward and mu_backward on the bowl's track,
        whose wall is smooth and takes what is across the track.

    Raises
    ------
    ConfigError
        If the drive is not ``limits.plain``.
    """
    direction = limits.plain(bowl).drive.direction
    ratio = float(limits.acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity))

    def cells(alpha_minus_theta, ratio):
        return _cells(bowl, beta, alpha_minus_theta, ratio, as_published)

    first, second = _headings(direction), _ratios(beta, ratio)
    if shape is not None:
        first, second = _resampled(first, shape[0]), _resampled(second, shape[1])
    grid = evaluate(first, second, cells, limits.REGIMES)
    point = {name: float(value) for name, value in cells(direction, ratio).items()}
    regime = limits.REGIMES[int(point.pop("regime"))]
    point["throw_number"] = float(limits.throw_number(ratio, beta, bowl.track.climb, bowl.track.bank))
    hop = float(limits.hop_ratio(beta))
    return SlideMap(
        beta, grid, ratio, direction, bowl.friction.static, point, regime, _onsets(bowl, beta), hop
    )


def level_line(beta, friction, alpha_minus_theta):
    """G at which [4.27] equals a friction.

    Parameters
    ----------
    beta : float [rad]
    friction : float [1]
    alpha_minus_theta : array_like [rad]
        Less than a quarter turn.

    Returns
    -------
    array [1]
    """
    slope = np.cos(beta) * np.cos(alpha_minus_theta) + friction * np.sin(beta)
    return friction / slope  # eq. [4.27], solved for G


def sheet(beta, highest, top):
    """The surface of [4.27] from zero up to a friction, on a grid that follows that edge.

    Parameters
    ----------
    beta : float [rad]
    highest : float [1]
        Friction at which the surface is cut.
    top : float [1]
        G at which it ends in any case.

    Returns
    -------
    alpha_minus_theta, ratio, friction : (S, S) float [rad, 1, 1]
    """
    widest = np.radians(89.9)  # at 90 deg [4.27] is 0/0 on the hop line
    angles = widest * np.sin(np.linspace(-np.pi / 2.0, np.pi / 2.0, 61))[:, None]  # dense where it is steep
    edge = np.minimum(level_line(beta, highest, angles), top)
    ratio = edge * np.linspace(0.0, 1.0, 61)
    friction = np.minimum(limits.published_limit(ratio, beta, angles), highest)  # rounding at the pole
    return np.broadcast_to(angles, ratio.shape), ratio, friction


def _cells(bowl, beta, alpha_minus_theta, ratio, as_published):
    track = (bowl.track.climb, bowl.track.bank)
    published = limits.published_limit(ratio, beta, alpha_minus_theta)
    pole = np.abs(ratio * np.sin(beta) - 1.0) <= limits.ROUNDING
    reversed_ = np.cos(alpha_minus_theta) < -limits.ROUNDING
    hidden = pole if as_published else limits.hops(ratio, beta) | reversed_
    found = {
        "mu_limit": np.where(hidden, np.nan, published),
        "mu_forward": limits.forward_limit(ratio, beta, alpha_minus_theta, *track),
        "mu_backward": limits.backward_limit(ratio, beta, alpha_minus_theta, *track),
    }
    regimes = limits.regimes(ratio, beta, bowl.friction.static, alpha_minus_theta, *track)
    return {name: np.round(array, NOISE) + 0.0 for name, array in found.items()} | {"regime": regimes}


def _onsets(bowl, beta):
    track = (bowl.track.climb, bowl.track.bank)
    slip = (bowl.friction.static, beta, bowl.drive.direction, *track)
    return {
        "forward": float(limits.forward_ratio(*slip)),
        "backward": float(limits.backward_ratio(*slip)),
        "hop": float(limits.hop_ratio(beta, *track)),
    }


def _headings(direction):
    """alpha - theta over half a turn, or over the whole one where the drive points backward."""
    widest = 90 if abs(direction) <= np.pi / 2.0 else 180
    return Axis(
        "alpha_minus_theta_deg", check.frozen(np.radians(np.arange(-widest, widest + 1, 3))), np.pi / 180.0
    )


def _ratios(beta, ratio):
    """G from 0 past the hop and past the bowl's own, in round steps that grow with the range."""
    hop = float(limits.hop_ratio(beta)) if beta > 0.0 else 0.0
    top = _rounded_up(max(PLAIN_TOP, MARGIN * hop, MARGIN * ratio))
    step = max(FINE_STEP, _rounded_up(top / MOST_STEPS))
    return Axis("acceleration_ratio", check.frozen(np.round(np.arange(round(top / step) + 1) * step, NOISE)))


def _resampled(axis, count):
    values = np.linspace(axis.values[0], axis.values[-1], count)
    return Axis(axis.column, check.frozen(values), axis.unit)


def _rounded_up(number):
    """The next round number: 3.65 gives 4, 0.125 gives 0.2."""
    decade = 10.0 ** np.floor(np.log10(number))
    return float(next(step for step in STEPS if step * decade >= number * (1.0 - 1e-12)) * decade)
