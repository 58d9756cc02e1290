"""What Figures 3-6 to 3-13 and 5-1 to 5-7 draw."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from feederscrew.thesis import chapter_5, parts
from feederscrew.thesis.printed_tables import table
from feederscrew.thesis.recompute import THINNER
from feederscrew.thesis.t_shape import RATIOS


@dataclass(frozen=True, eq=False)
class Bars:
    """Profiles side by side, a group of bars for each aspect."""

    aspects: tuple[str, ...]
    profiles: dict[str, np.ndarray]  # (A,) [1] by name
    printed: dict[str, np.ndarray]  # (A,) [1] the numbers in print, where ours are recomputed


@dataclass(frozen=True, eq=False)
class ByRatio:
    """Probability of each aspect over the aspect ratio."""

    ratios: np.ndarray  # (6,)
    rule: str
    lines: dict[str, np.ndarray]  # (6,) [1] ours, by aspect
    points: dict[str, tuple[np.ndarray, dict[str, np.ndarray]]]  # what is in print: ratios and [1] by aspect


@dataclass(frozen=True)
class Figure:
    """One figure of the thesis."""

    number: str
    caption: str
    data: Callable[[], object]  # Bars, ByRatio, chapter_5.Curves or chapter_5.FigureGrid


def t_shape_profiles():
    """Figure 3-6: the T shape at aspect ratio 0.6."""
    ours, thin, ngoi = parts.t_aspects(0.6), parts.t_aspects(THINNER), table("3-1")
    profiles = {
        "PMI": ours.pmi,
        "CSA": ours.csa,
        f"CSA_at_{THINNER}": thin.csa,
        "CSA_Table_3-1": ngoi.numbers("csa") / 100.0,
        "experiment": ngoi.numbers("experiment") / 100.0,
    }
    return Bars(ngoi.names, profiles, {"PMI": table("3-8").numbers("probability")})


def pmi_by_ratio():
    """Figure 3-7: the PMI rule over the aspect ratio."""
    printed = table("3-9")
    theirs = np.array([printed.numbers(ratio) for ratio in RATIOS]).T / 100.0
    points = {"Table 3-9": (_ratios(), dict(zip(printed.names, theirs, strict=True)))}
    return ByRatio(_ratios(), "PMI", _lines("pmi"), points)


def csa_by_ratio():
    """Figure 3-8: the CSA rule over the aspect ratio, and what survives of the measured curves."""
    printed = table("3-1")
    at = np.array([0.6])
    points = {
        f"{name}, Table 3-1": (
            at,
            {row: np.array([float(printed.text(row, column)) / 100.0]) for row in printed.names},
        )
        for name, column in (("CSA", "csa"), ("experiment", "experiment"))
    }
    return ByRatio(_ratios(), "CSA", _lines("csa"), points)


def against(part, *names, mixed=False):
    """Return a part's PMI profile beside others of its profiles.

    Parameters
    ----------
    part : str
        'arc_chute' or 'magnet'.
    names : str
        Of the other profiles.
    mixed : bool
        Show the CSA profile of mixed heights as well.

    Returns
    -------
    callable
        That gives the Bars.
    """

    def bars():
        every = parts.profiles(part)
        chosen = {name: every[name] for name in ("PMI", *names)}
        chosen |= {"CSA_mixed_heights": parts.mixed_heights()} if mixed else {}
        numbers = parts.TABLES[part]
        rules = [name for name in chosen if name.lower() in numbers]
        printed = {name: table(numbers[name.lower()]).numbers("probability") for name in rules}
        return Bars(table(numbers["pmi"]).names, chosen, printed)

    return bars


def _lines(rule):
    values = np.array([getattr(parts.t_aspects(ratio), rule) for ratio in _ratios()]).T
    return dict(zip(table("3-9").names, values, strict=True))


def _ratios():
    return np.array([float(ratio) for ratio in RATIOS])


MEASURED = table("3-4").columns
FIGURES = (
    Figure("3-6", "Probability comparison for the T shape, aspect ratio 0.6", t_shape_profiles),
    Figure("3-7", "Probability by aspect ratio, PMI method, T shape", pmi_by_ratio),
    Figure("3-8", "Probability by aspect ratio, CSA method and experiment, T shape", csa_by_ratio),
    Figure("3-9", "Arc Chute, PMI and CSA", against("arc_chute", "CSA")),
    Figure("3-10", "Arc Chute, PMI and experiment at three amplitudes", against("arc_chute", *MEASURED)),
    Figure("3-11", "Arc Chute, PMI and stability method", against("arc_chute", "STABILITY")),
    Figure("3-12", "Magnet, PMI and CSA", against("magnet", "CSA", mixed=True)),
    Figure("3-13", "Magnet, PMI and experiment at three amplitudes", against("magnet", *MEASURED)),
    Figure("5-1", "Limiting condition for sliding along Z, α = θ", chapter_5.figure_5_1),
    Figure("5-2", "Limiting friction, β = 10°", lambda: chapter_5.limit_surface("5-2")),
    Figure("5-3", "Limiting friction, β = 20°", lambda: chapter_5.limit_surface("5-3")),
    Figure("5-4", "Limiting friction, β = 40°", lambda: chapter_5.limit_surface("5-4")),
    Figure("5-5", "Contour lines of Figure 5-2, β = 10°", lambda: chapter_5.limit_surface("5-5")),
    Figure("5-6", "Acceleration along Z over β and μ, f = 60 Hz, A = 0.5 mm", chapter_5.figure_5_6),
    Figure("5-7", "Acceleration along Z over f and A, β = 20°, μ = 0.5", chapter_5.figure_5_7),
)
