"""What Figures 3-6 to 3-13 and 5-1 to 5-7 draw, and what print states of them; their curves are lost."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.mechanics import limits
from feederscrew.resting.deviation import deviation
from feederscrew.thesis import parts
from feederscrew.thesis.recompute import THINNER_RATIO
from feederscrew.thesis.tables import DIFFERS, EXACT_TO_PRINT, EXPLAINED, table

GRAVITY_OF_CHAPTER_5 = 9.8  # [m/s2]
FREQUENCY_OF_5_6_HZ = 60.0
AMPLITUDE_OF_5_6_M = 0.5e-3
BETA_OF_5_7 = np.radians(20.0)
FRICTION_OF_5_7 = 0.5
BETAS_OF_5_1 = (10.0, 20.0, 30.0, 40.0)  # [deg]
BETA_OF = {"5-2": 10.0, "5-3": 20.0, "5-4": 40.0, "5-5": 10.0}  # [deg]
DRIVE_RATIOS = np.linspace(0.0, 1.0, 51)  # G; the printed axis is lost, and nothing hops up to here
HEADING_TURNS = np.radians(np.linspace(-90.0, 90.0, 61))  # alpha - theta
MEASURED = table("3-4").columns
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Bars:
    """Profiles side by side, a group of bars for each aspect."""

    aspects: tuple[str, ...]
    profiles: dict[str, Array]  # (A,) [1] by name
    printed: dict[str, Array]  # (A,) [1] the numbers in print, where ours are recomputed


@dataclass(frozen=True, eq=False)
class ByRatio:
    """Probability of each aspect over the aspect ratio."""

    ratios: Array  # (6,)
    rule: str
    lines: dict[str, Array]  # (6,) [1] ours, by aspect
    points: dict[str, tuple[Array, dict[str, Array]]]  # what is in print: ratios and [1] by aspect


@dataclass(frozen=True, eq=False)
class Curves:
    """Figure 5-1."""

    ratios: Array  # (N,) G
    limits: dict[float, Array]  # (N,) limiting friction by beta [deg]


@dataclass(frozen=True, eq=False)
class FigureGrid:
    """A value over two parameters."""

    x: Array  # (N,)
    y: Array  # (M,)
    values: Array  # (M, N)
    throw: Array  # (M, N) [1] throw number: contact is lost from 1 on

    @property
    def hops(self) -> NDArray[np.bool_]:
        """(M, N) bool, contact is lost."""
        return self.throw >= 1.0 - limits.HOP_ROUNDING


Data = Bars | ByRatio | Curves | FigureGrid


@dataclass(frozen=True)
class Claim:
    """One statement in print on a figure, and the number that decides it."""

    statement: str  # in our words
    published: str  # what the number should be: '40 to 60'
    recomputed: float
    holds: bool
    finding: str = ""
    explained: bool = False  # the finding says where it holds, and there it does

    @property
    def verdict(self) -> str:
        """As of a cell."""
        if self.holds:
            return EXACT_TO_PRINT
        return EXPLAINED if self.finding and self.explained else DIFFERS


@dataclass(frozen=True)
class Figure:
    """One figure of the thesis."""

    number: str
    caption: str
    data: Callable[[], Data]
    statements: Callable[[], Iterator[Claim]]

    @property
    def claims(self) -> tuple[Claim, ...]:
        """The statements in print on it."""
        return tuple(self.statements())


def t_shape_profiles() -> Bars:
    """Figure 3-6: the T shape at aspect ratio 0.6."""
    ours, thin, ngoi = parts.t_aspects(0.6), parts.t_aspects(THINNER_RATIO), table("3-1")
    profiles = {
        "PMI": ours.pmi,
        "CSA": ours.csa,
        f"CSA_at_{THINNER_RATIO}": thin.csa,
        "CSA_Table_3-1": ngoi.numbers("csa") / 100.0,
        "experiment": ngoi.numbers("experiment") / 100.0,
    }
    return Bars(ngoi.names, profiles, {"PMI": table("3-8").numbers("probability")})


def by_ratio(rule: str) -> ByRatio:
    """Figure 3-7, rule 'pmi', and Figure 3-8, 'csa' with what survives of the measured curves."""
    printed = table("3-9" if rule == "pmi" else "3-1")
    ratios = np.array([float(ratio) for ratio in parts.T_RATIOS])
    values = np.array([getattr(parts.t_aspects(ratio), rule) for ratio in ratios]).T
    lines = dict(zip(table("3-9").names, values, strict=True))
    if rule == "pmi":
        rows = np.array([printed.numbers(ratio) for ratio in parts.T_RATIOS]).T / 100.0
        return ByRatio(ratios, "PMI", lines, {"Table 3-9": (ratios, dict(zip(printed.names, rows)))})
    points = {
        f"{name}, Table 3-1": (
            np.array([0.6]),
            {row: np.array([share]) for row, share in zip(printed.names, printed.numbers(column) / 100.0)},
        )
        for name, column in (("CSA", "csa"), ("experiment", "experiment"))
    }
    return ByRatio(ratios, "CSA", lines, points)


def compared_with_pmi(part: str, *names: str) -> Bars:
    """Return the PMI profile of 'arc_chute' or 'magnet' beside others of its profiles, by their names.

    The Magnet's CSA is shown with mixed heights as well.
    """
    profiles = parts.profiles(part)
    chosen = {name: profiles[name] for name in ("PMI", *names)}
    if part == "magnet" and "CSA" in names:
        chosen["CSA_mixed_heights"] = parts.mixed_heights()
    numbers = parts.TABLES_OF[part]
    rules = [name for name in chosen if name.lower() in numbers]
    printed = {name: table(numbers[name.lower()]).numbers("probability") for name in rules}
    return Bars(table(numbers["pmi"]).names, chosen, printed)


def figure_5_1() -> Curves:
    """Return limiting friction over G for alpha = theta, eq. [4.28]."""
    betas = {beta: limits.published_limit(DRIVE_RATIOS, np.radians(beta)) for beta in BETAS_OF_5_1}
    return Curves(DRIVE_RATIOS, betas)


def limit_surface(number: str) -> FigureGrid:
    """Return limiting friction over (alpha - theta, G), eq. [4.27].

    Parameters
    ----------
    number : str
        '5-2' to '5-5'.

    Returns
    -------
    FigureGrid
        x is alpha - theta [rad], y is G.
    """
    beta = np.radians(BETA_OF[number])
    values = limits.published_limit(DRIVE_RATIOS[:, None], beta, HEADING_TURNS)
    throw = limits.throw_number(DRIVE_RATIOS[:, None], beta)
    return _grid(HEADING_TURNS, DRIVE_RATIOS, values, throw)


def sliding_acceleration(
    acceleration: Any, beta: Any, friction: Any, gravity: float = GRAVITY_OF_CHAPTER_5
) -> Array:
    """Return V'_z of a sliding part at the upper reversal, as the thesis draws it.

    Parameters
    ----------
    acceleration : array_like [m/s2]
        A w^2 of the drive.
    beta : array_like [rad]
        Vibration angle.
    friction : array_like [1]
    gravity : float [m/s2]

    Returns
    -------
    array [m/s2]
        Past the hop it is the formula's value, not a part's.

    References
    ----------
    The thesis, eqs. [4.14], [4.16] with R_z = mu N and alpha = theta.
    """
    return acceleration * np.cos(beta) - friction * (gravity - acceleration * np.sin(beta))


def ratio_of_5_6() -> float:
    """Return G of Figure 5-6."""
    return limits.acceleration_ratio(AMPLITUDE_OF_5_6_M, FREQUENCY_OF_5_6_HZ, GRAVITY_OF_CHAPTER_5)


def figure_5_6() -> FigureGrid:
    """Return V'_z over (beta, mu): x is beta [rad], y is mu."""
    betas, frictions = np.radians(np.linspace(0.0, 90.0, 91)), np.linspace(0.0, 1.0, 51)
    ratio = ratio_of_5_6()
    values = sliding_acceleration(ratio * GRAVITY_OF_CHAPTER_5, betas, frictions[:, None])
    return _grid(betas, frictions, values, limits.throw_number(ratio, betas))


def figure_5_7() -> FigureGrid:
    """Return V'_z over (f, A): x is the frequency [Hz], y is the amplitude [m]."""
    frequencies, amplitudes = np.linspace(0.0, 100.0, 101), np.linspace(0.0, 1e-3, 51)
    ratio = limits.acceleration_ratio(amplitudes[:, None], frequencies, GRAVITY_OF_CHAPTER_5)
    values = sliding_acceleration(ratio * GRAVITY_OF_CHAPTER_5, BETA_OF_5_7, FRICTION_OF_5_7)
    return _grid(frequencies, amplitudes, values, limits.throw_number(ratio, BETA_OF_5_7))


def _grid(x: Array, y: Array, values: Array, throw: Array) -> FigureGrid:
    return FigureGrid(x, y, check.frozen(values), check.frozen(np.broadcast_to(throw, values.shape)))


def _below(statement: str, value: float, bound: float, *, above: bool = False, **finding: object) -> Claim:
    """The claim that a value is below a bound, or above it."""
    holds, sign = (value > bound, ">") if above else (value < bound, "<")
    return Claim(statement, f"{sign} {bound:.3f}", value, holds, **finding)  # type: ignore[arg-type]


def _t_shape_claims() -> Iterator[Claim]:
    ngoi, pmi = table("3-1"), parts.t_aspects(0.6).pmi
    csa, measured = ngoi.numbers("csa") / 100.0, ngoi.numbers("experiment") / 100.0
    near, far = deviation(csa, measured), deviation(pmi, measured)
    order = np.argsort(pmi[:4]) == np.argsort(csa[:4])
    yield _below("deviation of CSA from the experiment, below that of PMI", near, far, finding="csa-ratio")
    yield Claim("aspects A to D in the same order by PMI and CSA", "4", float(order.sum()), bool(order.all()))


def _ratio_claims(rule: str) -> Iterator[Claim]:
    """Aspect E leads at the smallest ratio, falls at every step and leads no more at the largest."""
    lines = np.array(list(by_ratio(rule).lines.values()))
    first, last = (lines[:, k].argmax() == len(lines) - 1 for k in (0, -1))
    holds = bool(first and not last and (np.diff(lines[-1]) < 0.0).all())
    change = float(lines[-1, -1] - lines[-1, 0])
    yield Claim("aspect E from ratio 0.4, where it leads, to 1.4", "< 0", change, holds)
    if rule == "pmi":
        ours, theirs = (float(np.ptp(by_ratio(name).lines["E"])) for name in ("pmi", "csa"))
        yield _below("range of aspect E, smaller by PMI than by CSA", ours, theirs)


def _arc_chute_claims(compared: str) -> Iterator[Claim]:
    profiles = parts.profiles("arc_chute")
    gaps = {name: deviation(profiles["PMI"], profile) for name, profile in profiles.items() if name != "PMI"}
    if compared == "CSA":
        rest = min(gap for name, gap in gaps.items() if name != "CSA")
        yield _below("deviation of PMI from CSA, the least of all", gaps["CSA"], rest)
    elif compared == "STABILITY":
        text = "deviation of PMI from stability, above that from CSA"
        yield _below(text, gaps["STABILITY"], gaps["CSA"], above=True)
    else:
        first, second = (deviation(profiles["MDBT_80"], profiles[name]) for name in ("MDBT_78", "MDBT_82"))
        yield _below("deviation between amplitudes 78 and 80, above 80 and 82", first, second, above=True)
        leads = _predicted("arc_chute")
        low = ["78" in name and "MDBT" in name for name in MEASURED]
        explained = all(agrees or at_78 for agrees, at_78 in zip(leads, low, strict=True))
        text = "tests whose dominant aspect PMI predicts"
        yield Claim(text, "6", float(sum(leads)), all(leads), "dominant-aspect", explained)


def _magnet_claims(compared: str) -> Iterator[Claim]:
    profiles = parts.profiles("magnet")
    if compared == "CSA":
        bound = deviation(profiles["PMI"], profiles["STABILITY"])
        value, mixed = (deviation(profiles["PMI"], csa) for csa in (profiles["CSA"], parts.mixed_heights()))
        text = "deviation of PMI from CSA, below that from stability"
        yield _below(text, value, bound, finding="magnet-csa-mixed", explained=mixed < bound)
    else:
        worst = max(deviation(profiles["STABILITY"], profiles[name]) for name in MEASURED)
        value = min(deviation(profiles["PMI"], profiles[name]) for name in MEASURED)
        yield _below("deviation of PMI from any test, above stability's", value, worst, above=True)
        leads = _predicted("magnet")
        text = "tests whose dominant aspect PMI predicts"
        yield Claim(text, f"{len(leads)}", float(sum(leads)), all(leads))


def _predicted(part: str) -> list[bool]:
    """Whether PMI predicts the dominant aspect of each test."""
    profiles = parts.profiles(part)
    return [bool(profiles[name].argmax() == profiles["PMI"].argmax()) for name in MEASURED]


def _aligned_claims() -> Iterator[Claim]:
    """The sliding region grows with beta: of the steps from one drawn beta to the next, at every G."""
    data = figure_5_1()
    betas, curves = np.radians(list(data.limits)), np.array(list(data.limits.values()))
    grows = (np.diff(curves, axis=0) > 0.0)[:, 1:]  # at G = 0 every curve is 0
    beyond = data.ratios[1:] > np.sin(betas[1:, None])
    share = float(grows.mean())
    below = data.ratios[1:] < np.sin(betas[:-1, None])
    explained = bool(grows[beyond].all() and not grows[below].any())
    text = "share of the drawn steps in beta that enlarge the sliding region"
    yield Claim(text, "1", share, bool(grows.all()), "beta-sliding", explained)


def _surface_claims(number: str) -> Iterator[Claim]:
    """Below the surface the part slides: it is the complete limit of a level floor."""
    data, beta = limit_surface(number), np.radians(BETA_OF[number])
    gap = float(np.abs(data.values - limits.forward_limit(data.y[:, None], beta, data.x)).max())
    yield Claim("gap between [4.27] and the least friction that holds", "0", gap, gap < 1e-9)
    if number == "5-5":
        gap = float(np.abs(data.values - limit_surface("5-2").values).max())
        yield Claim("gap between the contour lines' values and Figure 5-2", "0", gap, gap == 0.0)


def _beta_claims() -> Iterator[Claim]:
    data = figure_5_6()
    row, column = np.unravel_index(data.values.argmax(), data.values.shape)
    beta = float(np.degrees(data.x[column]))
    yield Claim("beta of the largest acceleration [deg]", "40 to 60", beta, 40.0 <= beta <= 60.0, "hop")
    text = "mu of the largest acceleration, the highest drawn"
    yield Claim(text, f"{data.y[-1]:g}", data.y[row], bool(row == len(data.y) - 1))


def _amplitude_claims() -> Iterator[Claim]:
    rises = np.diff(figure_5_7().values[:, 1:], axis=0) > 0.0
    text = "share of the steps in amplitude that raise the acceleration"
    yield Claim(text, "1", float(rises.mean()), bool(rises.all()), "hop")


def _surface(number: str, caption: str) -> Figure:
    return Figure(number, caption, lambda: limit_surface(number), lambda: _surface_claims(number))


def _by_ratio(number: str, rule: str, caption: str) -> Figure:
    return Figure(number, caption, lambda: by_ratio(rule), lambda: _ratio_claims(rule))


def _compared(number: str, part: str, names: tuple[str, ...], caption: str) -> Figure:
    claims = _arc_chute_claims if part == "arc_chute" else _magnet_claims
    return Figure(number, caption, lambda: compared_with_pmi(part, *names), lambda: claims(names[0]))


THESIS_FIGURES = (
    Figure(
        "3-6", "Probability comparison for the T shape, aspect ratio 0.6", t_shape_profiles, _t_shape_claims
    ),
    _by_ratio("3-7", "pmi", "Probability by aspect ratio, PMI method, T shape"),
    _by_ratio("3-8", "csa", "Probability by aspect ratio, CSA method and experiment, T shape"),
    _compared("3-9", "arc_chute", ("CSA",), "Arc Chute, PMI and CSA"),
    _compared("3-10", "arc_chute", MEASURED, "Arc Chute, PMI and experiment at three amplitudes"),
    _compared("3-11", "arc_chute", ("STABILITY",), "Arc Chute, PMI and stability method"),
    _compared("3-12", "magnet", ("CSA",), "Magnet, PMI and CSA"),
    _compared("3-13", "magnet", MEASURED, "Magnet, PMI and experiment at three amplitudes"),
    Figure("5-1", "Limiting condition for sliding along Z, α = θ", figure_5_1, _aligned_claims),
    _surface("5-2", "Limiting friction, β = 10°"),
    _surface("5-3", "Limiting friction, β = 20°"),
    _surface("5-4", "Limiting friction, β = 40°"),
    _surface("5-5", "Contour lines of Figure 5-2, β = 10°"),
    Figure("5-6", "Acceleration along Z over β and μ, f = 60 Hz, A = 0.5 mm", figure_5_6, _beta_claims),
    Figure("5-7", "Acceleration along Z over f and A, β = 20°, μ = 0.5", figure_5_7, _amplitude_claims),
)
FIGURE_OF = {figure.number: figure for figure in THESIS_FIGURES}
