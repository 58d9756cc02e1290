"""What checking the thesis showed: its slips, its silences, and what explains its numbers.

The numbers of the evidence are computed from the printed tables, the solids and the equations.
"""

import csv
import functools
from dataclasses import dataclass, replace
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from feederscrew import bowl
from feederscrew.mechanics import limits
from feederscrew.resting.deviation import deviation
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

    def evidence(self) -> str:
        """Return how it shows; the numbers are computed, never typed."""
        return _evidence()[self.id]


@functools.cache
def _evidence() -> dict[str, str]:
    return _t_shape() | _resting_cards() | _chapter_4_data() | _motion() | _conclusions()


def _limit(ratio: float, beta: float, turn: float = 0.0) -> float:
    """Limiting friction [1] by eq. [4.27] at G, beta [deg] and alpha - theta [deg]."""
    return float(limits.published_limit(ratio, np.radians(beta), np.radians(turn)))


def _t_shape() -> dict[str, str]:
    ours, printed, ngoi = parts.t_aspects(0.6), table("3-8"), table("3-1")
    # Table 3-8: lengths and density
    moments, heights = ours.moments / parts.G_MM2, ours.heights / parts.MM
    off_h, off_i = (np.abs(a - printed.numbers(name)).max() for a, name in ((heights, "h"), (moments, "I")))
    in_text = np.abs(parts.T_DENSITY_IN_TEXT / parts.T_DENSITY * moments - printed.numbers("I")).max()
    # Table 3-9: with the thesis's rounding of its inputs and without
    theirs = np.array([table("3-9").numbers(ratio) for ratio in parts.T_RATIOS])
    plain = 100.0 * np.array([parts.t_aspects(float(ratio)).pmi for ratio in parts.T_RATIOS])
    rounded = 100.0 * np.array([parts.rounded_shares(float(ratio))[2] for ratio in parts.T_RATIOS])
    with_rounding, without = (np.abs(shares - theirs).max() for shares in (rounded, plain))
    weights = ours.faces * ours.moments / ours.heights
    # Table 3-1: the ratio whose CSA profile it has
    thin, thick = (", ".join(f"{100 * p:.1f}" for p in parts.t_aspects(ratio).csa) for ratio in (0.4, 0.6))
    csa, ratios = ngoi.numbers("csa") / 100.0, np.arange(30, 71, 2) / 100.0
    closest = ratios[np.argmin([deviation(parts.t_aspects(ratio).csa, csa) for ratio in ratios])]
    in_print = ", ".join(ngoi.text(row, "csa") for row in ngoi.names)
    # eq. of PMI: which height aspect D takes; totals of cut and of rounded entries
    i, h = printed.numbers("I"), printed.numbers("h")
    right, wrong = i / h, i / h[[0, 1, 2, 4, 4]]
    t_sum, arc_sum = (table(number).numbers("probability").sum() for number in ("3-8", "3-10"))
    lengths = f"Table 3-8's heights and moments follow within {off_h:.4f} mm and {off_i:.4f} g mm2."
    return {
        "t-shape-drawing": lengths,
        "conclusion-4": lengths,
        "t-shape-density": f"With 1.000e-3 g/mm3 the largest gap is {off_i:.4f} g mm2, with 9.99e-4 g/mm3"
        f" {in_text:.2f} g mm2.",
        "t-shape-rounded": f"Largest gap {with_rounding:.1e} percentage points with the rounding,"
        f" {without:.4f} without.",
        "pmi-class-once": f"Aspect E at ratio 0.6: {ours.pmi[4]:.4f} counted once, as printed"
        f" ({float(printed.text('E', 'probability'))}); {(weights / weights.sum())[4]:.4f} over all faces.",
        "csa-ratio": f"Printed {in_print} percent; ours {thin} at 0.4 and {thick} at 0.6; closest of all from"
        f" 0.30 to 0.70 is {closest:.2f}.",
        "experiment-total": f"They sum to {ngoi.numbers('experiment').sum():.2f};"
        f" printed {ngoi.text(TOTAL, 'experiment')}.",
        "pmi-equation": f"Aspect D of Table 3-8: {(right / right.sum())[3]:.4f} with h4, as printed;"
        f" {(wrong / wrong.sum())[3]:.4f} with h5.",
        "cut-ratios": f"Table 3-8: {right.sum():.2f} before, {printed.numbers('I_over_h').sum():.2f} after,"
        " as printed.",
        "sum-of-rounded": f"Printed entries sum to {t_sum:.4f} (T shape) and {arc_sum:.4f} (Arc Chute).",
    }


def _resting_cards() -> dict[str, str]:
    # Tables 3-2 and 3-5: solid angles and heights
    arc_q, magnet_q = (table(number).numbers("Q") for number in ("3-2", "3-5"))
    heights = table("3-2").numbers("h")
    ratios, implied = heights / table("3-10").numbers("h"), heights * table("3-2").numbers("h_total_over_h")
    magnet_ratios = table("3-5").numbers("h") / table("3-11").numbers("h")
    cell = next(cell for cell in parts.cells("3-6") if (cell.row, cell.column) == ("1", "A_over_h"))
    # Table 3-11: totals
    magnet = table("3-11")
    total = (magnet.numbers("I") / magnet.numbers("h")).sum()
    # Tables 3-12 and 3-13: deviations
    arc, own, names = parts.profiles("arc_chute"), parts.profiles("magnet"), table("3-4").names
    value, count = deviation(arc["MDBT_80"], arc["PMI"]), len(arc["PMI"])
    sample = value * np.sqrt(count / (count - 1))
    mixed = parts.mixed_heights()
    with_mixed, plain = (deviation(csa, own["PMI"]) for csa in (mixed, own["CSA"]))
    measured, pmi = (names[arc[name].argmax()] for name in ("MDBT_78", "PMI"))
    return {
        "q-unit": f"Q sums to {arc_q.sum():.2f} and {magnet_q.sum():.2f};"
        f" a whole sphere is {4.0 * np.pi:.2f} sr.",
        "q-total": f"All five sum to {arc_q.sum():.4f}; the last four to {arc_q[1:].sum():.4f};"
        f" printed {table('3-2').text(TOTAL, 'Q')}.",
        "arc-chute-heights": f"Ratio {ratios.min():.2f} to {ratios.max():.2f}; row 4 prints {heights[3]} as"
        f" row 2 does ({heights[1]}).",
        "h-total": f"H_total = {implied.mean():.4f} mm, the same in every row within"
        f" {np.ptp(implied):.0e} mm.",
        "rounded-inputs": f"A/h of the Magnet's aspect 1 is {cell.recomputed:.5f} from the printed terms,"
        f" uncertain by {cell.within:.5f}; printed {cell.published}.",
        "magnet-total": f"{total:.4f}; printed {magnet.text(TOTAL, 'I_over_h')}.",
        "magnet-probability-total": "The printed entries sum to"
        f" {magnet.numbers('probability').sum():.4f}.",
        "cut-deviations": f"MDBT_80 - PMI: {value:.4f}, printed"
        f" {table('3-12').text('MDBT_80 - PMI', 'deviation')}; divided by one aspect less it would be"
        f" {sample:.3f}.",
        "magnet-csa-mixed": f"Mixed profile {', '.join(f'{p:.4f}' for p in mixed)}; CSA - PMI is"
        f" {with_mixed:.4f} with it (printed {table('3-13').text('CSA - PMI', 'deviation')}), {plain:.3f}"
        " with Table 3-5 as printed.",
        "magnet-heights": f"Ratios {', '.join(f'{ratio:.2f}' for ratio in magnet_ratios)}.",
        "dominant-aspect": f"Most parts were found on aspect {measured}; PMI puts most on {pmi}.",
        "figure-references": "By their captions: 3-5 shows the Magnet's aspects, 3-7 the PMI rule alone.",
        "drawings-lost": "Such cells are marked 'given'.",
    }  # fmt: skip


def _chapter_4_data() -> dict[str, str]:
    arc, magnet, row = chapter_4("arc_chute"), chapter_4("magnet"), table("3-11").rows["3"]
    # the Arc Chute's moments about the origin [g mm2], and the squares of its centre's levers [mm2]
    x, y, z = (arc[axis] for axis in "xyz")
    about_origin = np.array([arc[f"origin_{a}{a}"] for a in "xyz"])
    squares = np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    needed = (about_origin[1] - arc["I_yy"]) / squares[1]
    swapped_x, _, swapped_z = about_origin - magnet["mass"] * squares
    lever, matrix, moment = arc["drive_offset"], arc["I_xx"], float(table("3-10").text("5", "I"))
    # the Magnet's principal axes, its product of inertia read as I_xy or as I_xz
    xx, product = magnet["I_xx"], magnet["I_xy"]
    about_z, about_y = (
        np.degrees(0.5 * np.arctan2(2.0 * abs(product), abs(xx - magnet[name]))) for name in ("I_yy", "I_zz")
    )
    return {
        "masses-swapped": f"The parallel-axis term of I_yy needs {needed:.3f} g; printed {arc['mass']} g for"
        f" the Arc Chute, {magnet['mass']} g for the Magnet.",
        "axes-swapped": f"From the moments about the origin I_xx = {swapped_x:.2f} and I_zz = {swapped_z:.2f}"
        " g mm2; printed the other way round.",
        "aspect-5-moment": f"Coefficient {lever / matrix:.4f} with I_xx = {matrix} g mm2,"
        f" {lever / moment:.4f} with Table 3-10's {moment} g mm2.",
        "magnet-matrix": f"I_xy = {product:+}, I_yx = {magnet['I_yx']:+} g mm2.",
        "magnet-axes": f"As printed z is principal and the others are turned {about_z:.1f} deg; read as I_xz"
        f" it is {about_y:.2f} deg.",
        "magnet-height": f"h {float(row['h'])} and {magnet['x']} mm; I {float(row['I'])} and {xx} g mm2.",
        "bank-angle": f"Remark {arc['bank_without_radial_friction']} deg, equation"
        f" {arc['wall_lever_angle']} deg.",
        "wall-lever": f"{arc['wall_y']} and {arc['wall_friction_y']} mm.",
        "momentum-cross": f"At 1 rad/s and 1 mm/s across the force is m w v = {arc['mass']:.3f} uN; the print"
        f" has the moment I w^2 there, {arc['I_zz']:.2f} nN m.",
        "equation-4-24": "docs/equations.md has each printed equation with its function.",
    }


def _motion() -> dict[str, str]:
    # the Arc Chute on its fifth aspect on a banked track, driven a little across it: it slips one way
    plain, card, arc = bowl.read(None, SLIPS_ONE_WAY), parts.card("arc_chute"), chapter_4("arc_chute")
    drive, at_bank = replace(plain.drive, direction=BANK_SHOWN), replace(plain.track, bank=BANK_SHOWN)
    banked = track(card, replace(plain, drive=drive, track=at_bank), "5")
    size = {term.name: abs(term.value) / (MILLI if term.unit == "N" else 1.0) for term in banked.omitted}
    weight = banked.seat.mass * plain.gravity / MILLI  # [mN]
    radial = size["radial gravity, -m g cos(phi) sin(delta)"]
    along_x, along_y = (size[f"wall friction turned by sigma, along {axis}"] for axis in "XY")
    about_x, about_y = size["moment of the drive about X"], size["moment of wall friction about Y"]
    walls, complete_walls = (study.walls.sum() / MILLI for study in (banked.printed, banked.now))
    dragged, complete_dragged = (study.radial_friction / MILLI for study in (banked.printed, banked.now))
    # what the print has of moments on a floor
    e, h, beta = arc["drive_offset"], arc["centroid_height"], plain.drive.vibration_angle
    lever = -np.sin(TURN_SHOWN) * (e * np.sin(beta) + h * np.cos(beta) * np.cos(TURN_SHOWN))
    ahead = floor(card, plain, "5").now.offset[..., 0] / MILLI
    # Figures 5-6 and 5-7: where the part hops and sticks; when a larger beta helps
    ratio, drawn = figures.ratio_of_5_6(), figures.figure_5_7()
    hops_from, hops = np.degrees(np.arcsin(1.0 / ratio)), 100.0 * np.mean(drawn.hops)
    low, high = figures.DRIVE_RATIOS[5], figures.DRIVE_RATIOS[-1]
    forward, backward = _limit(0.5, 20.0), float(limits.backward_limit(0.5, np.radians(20.0)))
    # dual numbers: derivatives at 0 of (a + b x)(c + d x) and of (a + b x)/(c + d x)
    a, b, c, d, step = 1.0, 2.0, 3.0, 4.0, 1e-6
    product, quotient = (
        (rule(step) - rule(-step)) / (2.0 * step)
        for rule in (lambda x: (a + b * x) * (c + d * x), lambda x: (a + b * x) / (c + d * x))
    )
    turn = np.degrees(TURN_SHOWN)
    return {
        "hop": f"Figure 5-6 hops from beta = {hops_from:.1f} deg, where A w^2 ="
        f" {ratio * figures.GRAVITY_OF_CHAPTER_5:.0f} m/s2; Figure 5-7 over {hops:.0f} percent of its area,"
        f" and sticks over {100.0 * np.mean(drawn.values < 0.0):.0f} percent.",
        "beta-sliding": f"At G = {low:.1f} the limiting friction falls from {_limit(low, 10.0):.3f} (beta 10"
        f" deg) to {_limit(low, 40.0):.3f} (40 deg); at G = {high:.1f} it grows from {_limit(high, 10.0):.3f}"
        f" to {_limit(high, 40.0):.3f}.",
        "fixed-axes": f"Aligned at alpha = theta = {turn:.0f} deg no moment about Z' is left; the print has a"
        f" lever of {lever:.2f} mm.",
        "alpha-plus-theta": f"Aligned at {turn:.0f} deg the factor is 1; the print gives"
        f" {np.cos(2.0 * TURN_SHOWN):.3f}.",
        "sign-of-r-y": "A friction of -R_y at the foot, h below the centre of mass, has the moment +h R_y"
        " about Z'.",
        "radial-gravity": f"{radial:.2f} mN of a weight of {weight:.1f} mN at 10 deg of bank.",
        "centripetal": f"At most {size['centripetal force at mid-stroke']:.4f} mN of a weight of"
        f" {weight:.1f} mN in the default bowl.",
        "wall-tangent": f"{along_x:.2g} mN along X and {along_y:.2g} mN along Y.",
        "track-moments": f"{about_x:.2g} and {about_y:.2g} N mm, where the weight has {weight:.1f} mN.",
        "wall-pulls": f"At the upper reversal R1 + R2 is {walls:.2f} mN as printed; the complete equations"
        f" give {complete_walls:.2f} mN, and open a contact rather than let it pull.",
        "normal-force-line": f"At the upper reversal N acts {float(ahead):.2f} mm ahead of the Arc Chute's"
        " centre of mass.",
        "seven-unknowns": f"While the Arc Chute slides at 10 deg of bank the print has R3 = {dragged:.2f} mN"
        f" and no d_y; Coulomb's friction acts against the sliding, so R3 = {complete_dragged:.2f} mN and"
        f" d_y = {banked.now.offset[..., 1] / MILLI:.3f} mm.",
        "one-instant": f"At G = 0.5 and beta 20 deg a part slips forward below {forward:.3f} and back below"
        f" {backward:.3f}: between the two it slips one way only.",
        "dual-numbers": f"For a, b, c, d = 1, 2, 3, 4 the dual parts are {product:.4f} and {quotient:.4f};"
        f" with ad - bc the print gives {a * d - b * c:.4f} and {(a * d - b * c) / c**2:.4f}.",
        "conclusion-5": f"At 10 deg of bank {radial:.2f} mN of a weight of {weight:.1f} mN are left out;"
        f" Figure 5-7 is drawn over {hops:.0f} percent where the part has left the floor.",
    }  # fmt: skip


def _conclusions() -> dict[str, str]:
    def variation(profile: NDArray[np.float64], other: NDArray[np.float64]) -> float:
        """Total variation of two profiles [1]."""
        return 0.5 * float(np.abs(profile - other).sum())

    change = variation(*(table("3-4").numbers(name) for name in ("MDBT_78", "MDBT_80")))
    csa, measured = (table("3-1").numbers(name) for name in ("csa", "experiment"))
    csa, measured, pmi = csa / csa.sum(), measured / measured.sum(), parts.t_aspects(0.6).pmi
    return {
        "conclusion-1": "Between 78 and 80 percent of the drive the measured shares change by"
        f" {100.0 * change:.1f} percent of the parts.",
        "conclusion-2": f"Total variation of PMI from CSA {variation(pmi, csa):.3f} and from the experiment"
        f" {variation(pmi, measured):.3f}, of CSA from the experiment {variation(csa, measured):.3f}.",
        "conclusion-8": f"At G = 0.5, beta 20 deg and alpha - theta 60 deg it says"
        f" {_limit(0.5, 20.0, 60.0):.3f}; the open floor needs {_limit(0.5, 20.0):.3f}.",
    }


with (resources.files("feederscrew.thesis") / "data" / "findings.csv").open(encoding="utf-8") as _file:
    FINDINGS = tuple(Finding(**row) for row in csv.DictReader(_file))
FINDING_OF = {finding.id: finding for finding in FINDINGS}
