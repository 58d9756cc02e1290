"""What the thesis states about its figures, checked: the printed curves themselves are lost."""

from dataclasses import dataclass

import numpy as np

from feederscrew.mechanics import limits
from feederscrew.resting.counts.deviation import deviation
from feederscrew.thesis import chapter_5, figure_data, parts
from feederscrew.thesis.printed_cells import DIFFERS, EXACT, EXPLAINED
from feederscrew.thesis.printed_tables import table


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
    def verdict(self):
        """As of a cell."""
        if self.holds:
            return EXACT
        return EXPLAINED if self.finding and self.explained else DIFFERS


def claims(number):
    """Return the statements on one figure.

    Parameters
    ----------
    number : str
        '3-6' to '3-13', '5-1' to '5-7'.

    Returns
    -------
    tuple of Claim
    """
    return tuple(STATEMENTS[number]())


def _t_shape():
    ngoi, pmi = table("3-1"), parts.t_aspects(0.6).pmi
    csa, measured = ngoi.numbers("csa") / 100.0, ngoi.numbers("experiment") / 100.0
    near, far = deviation(csa, measured), deviation(pmi, measured)
    order = np.argsort(pmi[:4]) == np.argsort(csa[:4])
    yield Claim(
        "deviation of CSA from the experiment, below that of PMI",
        f"< {far:.3f}",
        near,
        near < far,
        "csa-ratio",
    )
    yield Claim("aspects A to D in the same order by PMI and CSA", "4", float(order.sum()), bool(order.all()))


def _falling(data):
    """Aspect E leads at the smallest ratio, falls at every step and leads no more at the largest."""
    lines = np.array(list(data.lines.values()))
    first, last = (lines[:, k].argmax() == len(lines) - 1 for k in (0, -1))
    holds = bool(first and not last and (np.diff(lines[-1]) < 0.0).all())
    yield Claim(
        "aspect E from ratio 0.4, where it leads, to 1.4", "< 0", float(lines[-1, -1] - lines[-1, 0]), holds
    )


def _pmi_by_ratio():
    data = figure_data.pmi_by_ratio()
    yield from _falling(data)
    ours, theirs = (np.ptp(lines["E"]) for lines in (data.lines, figure_data.csa_by_ratio().lines))
    yield Claim(
        "range of aspect E, smaller by PMI than by CSA", f"< {theirs:.3f}", float(ours), bool(ours < theirs)
    )


def _csa_by_ratio():
    yield from _falling(figure_data.csa_by_ratio())


def _arc_chute_csa():
    profiles = parts.profiles("arc_chute")
    value = deviation(profiles["PMI"], profiles["CSA"])
    rest = min(deviation(profiles["PMI"], p) for name, p in profiles.items() if name not in ("PMI", "CSA"))
    yield Claim("deviation of PMI from CSA, the least of all", f"< {rest:.3f}", value, value < rest)


def _arc_chute_measured():
    profiles = parts.profiles("arc_chute")
    first, second = (deviation(profiles["MDBT_80"], profiles[other]) for other in ("MDBT_78", "MDBT_82"))
    yield Claim(
        "deviation between amplitudes 78 and 80, above 80 and 82", f"> {second:.3f}", first, first > second
    )
    led = [profiles[name].argmax() == profiles["PMI"].argmax() for name in figure_data.MEASURED]
    low = ["78" in name and "MDBT" in name for name in figure_data.MEASURED]
    explained = all(agrees or odd for agrees, odd in zip(led, low, strict=True))
    yield Claim(
        "tests whose dominant aspect PMI predicts",
        "6",
        float(sum(led)),
        all(led),
        "dominant-aspect",
        explained,
    )


def _arc_chute_stability():
    profiles = parts.profiles("arc_chute")
    ours, csa = (deviation(profiles["PMI"], profiles[name]) for name in ("STABILITY", "CSA"))
    yield Claim("deviation of PMI from stability, above that from CSA", f"> {csa:.3f}", ours, ours > csa)


def _magnet_csa():
    profiles, mixed = parts.profiles("magnet"), parts.mixed_heights()
    bound = deviation(profiles["PMI"], profiles["STABILITY"])
    value, other = (deviation(profiles["PMI"], csa) for csa in (profiles["CSA"], mixed))
    yield Claim(
        "deviation of PMI from CSA, below that from stability",
        f"< {bound:.3f}",
        value,
        value < bound,
        "magnet-csa-mixed",
        explained=other < bound,
    )


def _magnet_measured():
    profiles = parts.profiles("magnet")
    worst = max(deviation(profiles["STABILITY"], profiles[name]) for name in figure_data.MEASURED)
    value = min(deviation(profiles["PMI"], profiles[name]) for name in figure_data.MEASURED)
    yield Claim("deviation of PMI from any test, above stability's", f"> {worst:.3f}", value, value > worst)
    led = [profiles[name].argmax() == profiles["PMI"].argmax() for name in figure_data.MEASURED]
    yield Claim("tests whose dominant aspect PMI predicts", f"{len(led)}", float(sum(led)), all(led))


def _aligned():
    """The sliding region grows with beta: of the steps from one drawn beta to the next, at every G."""
    data = chapter_5.figure_5_1()
    betas, curves = np.radians(list(data.limits)), np.array(list(data.limits.values()))
    grows = (np.diff(curves, axis=0) > 0.0)[:, 1:]  # at G = 0 every curve is 0
    beyond = data.ratios[1:] > np.sin(betas[1:, None])
    share = float(grows.mean())
    yield Claim(
        "share of the drawn steps in beta that enlarge the sliding region",
        "1",
        share,
        bool(grows.all()),
        "beta-sliding",
        explained=bool(grows[beyond].all() and not grows[data.ratios[1:] < np.sin(betas[:-1, None])].any()),
    )


def _surface(number):
    """Below the surface the part slides: it is the complete limit of a level floor."""

    def statements():
        data, beta = chapter_5.limit_surface(number), np.radians(chapter_5.BETA_OF[number])
        complete = limits.forward_limit(data.y[:, None], beta, data.x)
        gap = float(np.abs(data.values - complete).max())
        yield Claim("gap between [4.27] and the least friction that holds", "0", gap, gap < 1e-9)

    return statements


def _contours():
    yield from _surface("5-5")()
    gap = np.abs(chapter_5.limit_surface("5-5").values - chapter_5.limit_surface("5-2").values).max()
    yield Claim("gap between the contour lines' values and Figure 5-2", "0", float(gap), bool(gap == 0.0))


def _over_beta():
    data = chapter_5.figure_5_6()
    row, column = np.unravel_index(data.values.argmax(), data.values.shape)
    beta = float(np.degrees(data.x[column]))
    yield Claim("beta of the largest acceleration [deg]", "40 to 60", beta, 40.0 <= beta <= 60.0, "hop")
    yield Claim(
        "mu of the largest acceleration, the highest drawn",
        f"{data.y[-1]:g}",
        data.y[row],
        row == len(data.y) - 1,
    )


def _over_amplitude():
    data = chapter_5.figure_5_7()
    rises = np.diff(data.values[:, 1:], axis=0) > 0.0
    share = float(rises.mean())
    yield Claim(
        "share of the steps in amplitude that raise the acceleration", "1", share, bool(rises.all()), "hop"
    )


STATEMENTS = {
    "3-6": _t_shape,
    "3-7": _pmi_by_ratio,
    "3-8": _csa_by_ratio,
    "3-9": _arc_chute_csa,
    "3-10": _arc_chute_measured,
    "3-11": _arc_chute_stability,
    "3-12": _magnet_csa,
    "3-13": _magnet_measured,
    "5-1": _aligned,
    "5-2": _surface("5-2"),
    "5-3": _surface("5-3"),
    "5-4": _surface("5-4"),
    "5-5": _contours,
    "5-6": _over_beta,
    "5-7": _over_amplitude,
}
