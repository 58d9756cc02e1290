"""Findings of checking the thesis: its slips, its silences, and what explains its numbers.

``data/findings.csv`` says each in words. The numbers in these words are computed here, from the printed
tables, the solids and the equations.
"""

import csv
import functools
from dataclasses import dataclass, replace
from importlib import resources
from typing import Any

import numpy as np

from feederscrew import bowl
from feederscrew.base.columns import Column
from feederscrew.motion import limits
from feederscrew.resting.deviation import deviation, total_variation
from feederscrew.thesis import figures, parts
from feederscrew.thesis.motion import floor, track
from feederscrew.thesis.tables import TOTAL, chapter_4, table

MILLI = 1e-3
BANK_SHOWN = np.radians(10.0)  # delta and alpha the omitted terms are shown at
TURN_SHOWN = np.radians(20.0)  # alpha = theta the projections are shown at
SLIPS_ONE_WAY = ("drive.amplitude=0.05 mm", "drive.frequency=60 Hz", "drive.vibration_angle=30 deg")


@dataclass(frozen=True)
class Finding:
    """A slip, a silence, or what explains a number."""

    id: str
    title: str  # in words
    where: str  # in the thesis
    what: str
    numbers: str  # how it shows, a format of the numbers computed below

    @property
    def evidence(self) -> str:
        """Return how it shows; the numbers are computed, never typed."""
        return self.numbers.format_map(_numbers())


FINDING_COLUMNS: tuple[Column[Finding], ...] = (
    Column("id", lambda finding: finding.id),
    Column("title", lambda finding: finding.title),
    Column("where", lambda finding: finding.where),
    Column("what", lambda finding: finding.what),
    Column("shown", lambda finding: finding.evidence),
)


Figures = dict[str, Any]  # numbers and words that the sentences of findings name


@functools.cache
def _numbers() -> Figures:
    return _t_shape() | _resting_cards() | _chapter_4_data() | _motion() | _conclusions()


def _limit(ratio: float, beta: float, turn: float = 0.0) -> float:
    """Limiting friction [1] by eq. [4.27] at G, beta [deg] and alpha - theta [deg]."""
    return float(limits.published_limit(ratio, np.radians(beta), np.radians(turn)))


def _t_shape() -> Figures:
    ours, printed, ngoi = parts.t_aspects(0.6), table("3-8"), table("3-1")
    moments = ours.moments / parts.G_MM2
    # Table 3-9: with the thesis's rounding of its inputs and without
    theirs = np.array([table("3-9").numbers(ratio) for ratio in parts.T_RATIOS])
    plain = 100.0 * np.array([parts.t_aspects(float(ratio)).pmi for ratio in parts.T_RATIOS])
    rounded = 100.0 * np.array([parts.rounded_shares(float(ratio))[2] for ratio in parts.T_RATIOS])
    weights = ours.faces * ours.moments / ours.heights
    # Table 3-1: the ratio whose CSA profile it has
    thin, thick = (", ".join(f"{100 * p:.1f}" for p in parts.t_aspects(ratio).csa) for ratio in (0.4, 0.6))
    csa, ratios = ngoi.numbers("csa") / 100.0, np.arange(30, 71, 2) / 100.0
    # eq. of PMI: which height aspect D takes; totals of cut and of rounded entries
    i, h = printed.numbers("I"), printed.numbers("h")
    right, wrong = i / h, i / h[[0, 1, 2, 4, 4]]
    return {
        "off_height": np.abs(ours.heights / parts.MM - h).max(),
        "off_moment": np.abs(moments - i).max(),
        "off_in_text": np.abs(parts.T_DENSITY_IN_TEXT / parts.T_DENSITY * moments - i).max(),
        "with_rounding": np.abs(rounded - theirs).max(),
        "without_rounding": np.abs(plain - theirs).max(),
        "e_once": ours.pmi[4],
        "e_printed": float(printed.text("E", "probability")),
        "e_over_all": (weights / weights.sum())[4],
        "csa_printed": ", ".join(ngoi.text(row, "csa") for row in ngoi.names),
        "csa_thin": thin,
        "csa_thick": thick,
        "csa_closest": ratios[np.argmin([deviation(parts.t_aspects(ratio).csa, csa) for ratio in ratios])],
        "experiment_sum": ngoi.numbers("experiment").sum(),
        "experiment_total": ngoi.text(TOTAL, "experiment"),
        "d_with_h4": (right / right.sum())[3],
        "d_with_h5": (wrong / wrong.sum())[3],
        "ratios_before": right.sum(),
        "ratios_after": printed.numbers("I_over_h").sum(),
        "t_sum": printed.numbers("probability").sum(),
        "arc_sum": table("3-10").numbers("probability").sum(),
    }


def _resting_cards() -> Figures:
    # Tables 3-2 and 3-5: solid angles and heights; Table 3-11: totals
    arc_q, heights, magnet = table("3-2").numbers("Q"), table("3-2").numbers("h"), table("3-11")
    ratios, implied = heights / table("3-10").numbers("h"), heights * table("3-2").numbers("h_total_over_h")
    magnet_ratios = table("3-5").numbers("h") / magnet.numbers("h")
    # Tables 3-12 and 3-13: deviations
    arc, own, names = parts.profiles("arc_chute"), parts.profiles("magnet"), table("3-4").names
    value, count, mixed = deviation(arc["MDBT_80"], arc["PMI"]), len(arc["PMI"]), parts.mixed_heights()
    return {
        "arc_q": arc_q.sum(),
        "magnet_q": table("3-5").numbers("Q").sum(),
        "sphere": 4.0 * np.pi,
        "arc_q_but_first": arc_q[1:].sum(),
        "arc_q_total": table("3-2").text(TOTAL, "Q"),
        "ratios": (ratios.min(), ratios.max()),
        "row_4": heights[3],
        "row_2": heights[1],
        "h_total": implied.mean(),
        "h_total_spread": np.ptp(implied),
        "cell": next(cell for cell in parts.cells("3-6") if (cell.row, cell.column) == ("1", "A_over_h")),
        "i_over_h_sum": (magnet.numbers("I") / magnet.numbers("h")).sum(),
        "i_over_h_total": magnet.text(TOTAL, "I_over_h"),
        "magnet_sum": magnet.numbers("probability").sum(),
        "deviation": value,
        "deviation_printed": table("3-12").text("MDBT_80 - PMI", "deviation"),
        "deviation_of_sample": value * np.sqrt(count / (count - 1)),
        "mixed": ", ".join(f"{p:.4f}" for p in mixed),
        "csa_mixed": deviation(mixed, own["PMI"]),
        "csa_mixed_printed": table("3-13").text("CSA - PMI", "deviation"),
        "csa_plain": deviation(own["CSA"], own["PMI"]),
        "magnet_ratios": ", ".join(f"{ratio:.2f}" for ratio in magnet_ratios),
        "dominant_measured": names[arc["MDBT_78"].argmax()],
        "dominant_pmi": names[arc["PMI"].argmax()],
    }


def _chapter_4_data() -> Figures:
    arc, magnet, row = chapter_4("arc_chute"), chapter_4("magnet"), table("3-11").rows["3"]
    # the Arc Chute's moments about the origin [g mm2], and the squares of its centre's levers [mm2]
    x, y, z = (arc[axis] for axis in "xyz")
    about_origin = np.array([arc[f"origin_{a}{a}"] for a in "xyz"])
    squares = np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    moment = float(table("3-10").text("5", "I"))
    # the Magnet's principal axes, its product of inertia read as I_xy or as I_xz
    about_z, about_y = (
        np.degrees(0.5 * np.arctan2(2.0 * abs(magnet["I_xy"]), abs(magnet["I_xx"] - magnet[name])))
        for name in ("I_yy", "I_zz")
    )
    return {
        "arc": arc,
        "magnet": magnet,
        "mass_needed": (about_origin[1] - arc["I_yy"]) / squares[1],
        "swapped": about_origin - magnet["mass"] * squares,
        "coefficient": arc["drive_offset"] / arc["I_xx"],
        "coefficient_of_table": arc["drive_offset"] / moment,
        "moment_5": moment,
        "turned_as_printed": about_z,
        "turned_as_xz": about_y,
        "height_3": float(row["h"]),
        "moment_3": float(row["I"]),
    }


def _motion() -> Figures:
    # the Arc Chute on its fifth aspect on a banked track, driven a little across it: it slips one way
    plain, card, arc = bowl.read(None, SLIPS_ONE_WAY), parts.card("arc_chute"), chapter_4("arc_chute")
    drive, at_bank = replace(plain.drive, direction=BANK_SHOWN), replace(plain.track, bank=BANK_SHOWN)
    banked = track(card, replace(plain, drive=drive, track=at_bank), "5")
    both, terms = (banked.printed, banked.now), banked.omitted_terms
    size = {term.name: abs(term.value) / (MILLI if term.unit == "N" else 1.0) for term in terms}
    # what the print has of moments on a floor
    e, h, beta = arc["drive_offset"], arc["centroid_height"], plain.drive.vibration_angle
    # Figures 5-6 and 5-7: where the part hops and sticks; when a larger beta helps
    ratio, drawn = figures.RATIO_OF_5_6, figures.figure_5_7()
    low, high = figures.DRIVE_RATIOS[5], figures.DRIVE_RATIOS[-1]
    # dual numbers: derivatives at 0 of (a + b x)(c + d x) and of (a + b x)/(c + d x)
    a, b, c, d, step = 1.0, 2.0, 3.0, 4.0, 1e-6
    product, quotient = (
        (rule(step) - rule(-step)) / (2.0 * step)
        for rule in (lambda x: (a + b * x) * (c + d * x), lambda x: (a + b * x) / (c + d * x))
    )
    return {
        "hops_from": np.degrees(np.arcsin(1.0 / ratio)),
        "peak": ratio * figures.GRAVITY_OF_CHAPTER_5,
        "hops": 100.0 * np.mean(drawn.hops),
        "sticks": 100.0 * np.mean(drawn.values < 0.0),
        "low": low,
        "at_low": (_limit(low, 10.0), _limit(low, 40.0)),
        "high": high,
        "at_high": (_limit(high, 10.0), _limit(high, 40.0)),
        "turn": np.degrees(TURN_SHOWN),
        "fixed_lever": -np.sin(TURN_SHOWN) * (e * np.sin(beta) + h * np.cos(beta) * np.cos(TURN_SHOWN)),
        "doubled_cosine": np.cos(2.0 * TURN_SHOWN),
        "weight": banked.seat.mass * plain.gravity / MILLI,  # [mN], as every force below
        "radial": size["radial gravity, -m g cos(phi) sin(delta)"],
        "centripetal": size["centripetal force at mid-stroke"],
        "along_x": size["wall friction turned by sigma, along X"],
        "along_y": size["wall friction turned by sigma, along Y"],
        "about_x": size["moment of the drive about X"],
        "about_y": size["moment of wall friction about Y"],
        "walls": [study.walls.sum() / MILLI for study in both],
        "dragged": [study.radial_friction / MILLI for study in both],
        "aside": banked.now.offset[..., 1] / MILLI,
        "ahead": float(floor(card, plain, "5").now.offset[..., 0] / MILLI),
        "forward": _limit(0.5, 20.0),
        "backward": float(limits.backward_limit(0.5, np.radians(20.0))),
        "product": product,
        "quotient": quotient,
        "crossed": a * d - b * c,
        "crossed_over_square": (a * d - b * c) / c**2,
    }


def _conclusions() -> Figures:
    csa, measured = (table("3-1").numbers(name) for name in ("csa", "experiment"))
    csa, measured, pmi = csa / csa.sum(), measured / measured.sum(), parts.t_aspects(0.6).pmi
    at_78, at_80 = (table("3-4").numbers(name) for name in ("MDBT_78", "MDBT_80"))
    return {
        "change": 100.0 * total_variation(at_78, at_80),
        "pmi_from_csa": total_variation(pmi, csa),
        "pmi_from_measured": total_variation(pmi, measured),
        "csa_from_measured": total_variation(csa, measured),
        "aslant": _limit(0.5, 20.0, 60.0),
    }


with (resources.files("feederscrew.thesis") / "data" / "findings.csv").open(encoding="utf-8") as _file:
    FINDINGS = tuple(Finding(**row) for row in csv.DictReader(_file))
FINDING_OF = {finding.id: finding for finding in FINDINGS}
