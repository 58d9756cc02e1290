"""What checking the thesis showed: its slips, its silences, and what explains its numbers.

Each finding computes the numbers of its evidence from the printed tables, the solids and the equations.
"""

import csv
import functools
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from feederscrew import bowl
from feederscrew.mechanics import limits
from feederscrew.resting.deviation import deviation
from feederscrew.thesis import figures, parts
from feederscrew.thesis.motion import TrackAsPublished, floor, track
from feederscrew.thesis.recompute import cells, rounded_shares
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
    evidence: Callable[[], str]  # how it shows, its numbers computed, never typed


_evidence_of: dict[str, Callable[[], str]] = {}


def _evidence(finding: str) -> Callable[[Callable[[], str]], Callable[[], str]]:
    """Make the function that follows the evidence of a finding of ``data/findings.csv``."""

    def registered(evidence: Callable[[], str]) -> Callable[[], str]:
        _evidence_of[finding] = evidence
        return evidence

    return registered


@_evidence("t-shape-drawing")
def _t_shape_drawing() -> str:
    ours, theirs = parts.t_aspects(0.6), table("3-8")
    heights = np.abs(ours.heights / parts.MM - theirs.numbers("h")).max()
    moments = np.abs(ours.moments / parts.G_MM2 - theirs.numbers("I")).max()
    return f"Table 3-8's heights and moments follow within {heights:.4f} mm and {moments:.4f} g mm2."


@_evidence("t-shape-density")
def _t_shape_density() -> str:
    ours, theirs = parts.t_aspects(0.6).moments / parts.G_MM2, table("3-8").numbers("I")
    right = np.abs(ours - theirs).max()
    wrong = np.abs(parts.T_DENSITY_IN_TEXT / parts.T_DENSITY * ours - theirs).max()
    return f"With 1.000e-3 g/mm3 the largest gap is {right:.4f} g mm2, with 9.99e-4 g/mm3 {wrong:.2f} g mm2."


@_evidence("t-shape-rounded")
def _t_shape_rounded() -> str:
    theirs = np.array([table("3-9").numbers(ratio) for ratio in parts.T_RATIOS])
    plain = 100.0 * np.array([parts.t_aspects(float(ratio)).pmi for ratio in parts.T_RATIOS])
    rounded = 100.0 * np.array([rounded_shares(float(ratio))[2] for ratio in parts.T_RATIOS])
    with_rounding, without = (np.abs(ours - theirs).max() for ours in (rounded, plain))
    return f"Largest gap {with_rounding:.1e} percentage points with the rounding, {without:.4f} without."


@_evidence("pmi-class-once")
def _pmi_class_once() -> str:
    ours, printed = parts.t_aspects(0.6), float(table("3-8").text("E", "probability"))
    weights = ours.faces * ours.moments / ours.heights
    of_faces = (weights / weights.sum())[4]
    return (
        f"Aspect E at ratio 0.6: {ours.pmi[4]:.4f} counted once, as printed ({printed});"
        f" {of_faces:.4f} over all faces."
    )


@_evidence("csa-ratio")
def _csa_ratio() -> str:
    thin, thick = (", ".join(f"{100 * p:.1f}" for p in parts.t_aspects(ratio).csa) for ratio in (0.4, 0.6))
    theirs, ratios = table("3-1").numbers("csa") / 100.0, np.arange(30, 71, 2) / 100.0
    closest = ratios[np.argmin([deviation(parts.t_aspects(ratio).csa, theirs) for ratio in ratios])]
    printed = ", ".join(table("3-1").text(row, "csa") for row in table("3-1").names)
    return (
        f"Printed {printed} percent; ours {thin} at 0.4 and {thick} at 0.6; closest of all from 0.30 to 0.70"
        f" is {closest:.2f}."
    )


@_evidence("experiment-total")
def _experiment_total() -> str:
    total, printed = table("3-1").numbers("experiment").sum(), table("3-1").text(TOTAL, "experiment")
    return f"They sum to {total:.2f}; printed {printed}."


@_evidence("pmi-equation")
def _pmi_equation() -> str:
    moments, heights = table("3-8").numbers("I"), table("3-8").numbers("h")
    right, wrong = moments / heights, moments / heights[[0, 1, 2, 4, 4]]
    right, wrong = (right / right.sum())[3], (wrong / wrong.sum())[3]
    return f"Aspect D of Table 3-8: {right:.4f} with h4, as printed; {wrong:.4f} with h5."


@_evidence("q-unit")
def _q_unit() -> str:
    arc_chute, magnet = (table(number).numbers("Q").sum() for number in ("3-2", "3-5"))
    return f"Q sums to {arc_chute:.2f} and {magnet:.2f}; a whole sphere is {4.0 * np.pi:.2f} sr."


@_evidence("q-total")
def _q_total() -> str:
    values, printed = table("3-2").numbers("Q"), table("3-2").text(TOTAL, "Q")
    return f"All five sum to {values.sum():.4f}; the last four to {values[1:].sum():.4f}; printed {printed}."


@_evidence("arc-chute-heights")
def _arc_chute_heights() -> str:
    heights = table("3-2").numbers("h")
    ratios = heights / table("3-10").numbers("h")
    return (
        f"Ratio {ratios.min():.2f} to {ratios.max():.2f}; row 4 prints {heights[3]} as row 2 does"
        f" ({heights[1]})."
    )


@_evidence("h-total")
def _h_total() -> str:
    implied = table("3-2").numbers("h") * table("3-2").numbers("h_total_over_h")
    return f"H_total = {implied.mean():.4f} mm, the same in every row within {np.ptp(implied):.0e} mm."


@_evidence("rounded-inputs")
def _rounded_inputs() -> str:
    cell = next(cell for cell in cells("3-6") if (cell.row, cell.column) == ("1", "A_over_h"))
    return (
        f"A/h of the Magnet's aspect 1 is {cell.recomputed:.5f} from the printed terms, uncertain by"
        f" {cell.within:.5f}; printed {cell.published}."
    )


@_evidence("cut-ratios")
def _cut_ratios() -> str:
    printed = table("3-8")
    before, after = (printed.numbers("I") / printed.numbers("h")).sum(), printed.numbers("I_over_h").sum()
    return f"Table 3-8: {before:.2f} before, {after:.2f} after, as printed."


@_evidence("sum-of-rounded")
def _sum_of_rounded() -> str:
    t_shape, arc_chute = (table(number).numbers("probability").sum() for number in ("3-8", "3-10"))
    return f"Printed entries sum to {t_shape:.4f} (T shape) and {arc_chute:.4f} (Arc Chute)."


@_evidence("magnet-total")
def _magnet_total() -> str:
    total = (table("3-11").numbers("I") / table("3-11").numbers("h")).sum()
    return f"{total:.4f}; printed {table('3-11').text(TOTAL, 'I_over_h')}."


@_evidence("magnet-probability-total")
def _magnet_probability_total() -> str:
    return f"The printed entries sum to {table('3-11').numbers('probability').sum():.4f}."


@_evidence("cut-deviations")
def _cut_deviations() -> str:
    profiles, printed = parts.profiles("arc_chute"), table("3-12").text("MDBT_80 - PMI", "deviation")
    value, count = deviation(profiles["MDBT_80"], profiles["PMI"]), len(profiles["PMI"])
    sample = value * np.sqrt(count / (count - 1))
    return (
        f"MDBT_80 - PMI: {value:.4f}, printed {printed}; divided by one aspect less it would be {sample:.3f}."
    )


@_evidence("magnet-csa-mixed")
def _magnet_csa_mixed() -> str:
    mixed, profiles = parts.mixed_heights(), parts.profiles("magnet")
    profile = ", ".join(f"{p:.4f}" for p in mixed)
    with_mixed, plain = (deviation(csa, profiles["PMI"]) for csa in (mixed, profiles["CSA"]))
    return (
        f"Mixed profile {profile}; CSA - PMI is {with_mixed:.4f} with it (printed"
        f" {table('3-13').text('CSA - PMI', 'deviation')}), {plain:.3f} with Table 3-5 as printed."
    )


@_evidence("magnet-heights")
def _magnet_heights() -> str:
    ratios = table("3-5").numbers("h") / table("3-11").numbers("h")
    return f"Ratios {', '.join(f'{ratio:.2f}' for ratio in ratios)}."


@_evidence("dominant-aspect")
def _dominant_aspect() -> str:
    profiles, names = parts.profiles("arc_chute"), table("3-4").names
    measured, pmi = (names[profiles[name].argmax()] for name in ("MDBT_78", "PMI"))
    return f"Most parts were found on aspect {measured}; PMI puts most on {pmi}."


@_evidence("masses-swapped")
def _masses_swapped() -> str:
    about_origin, squares = _about_origin()
    mass = (about_origin[1] - chapter_4("arc_chute")["I_yy"]) / squares[1]
    own, other = (chapter_4(name)["mass"] for name in ("arc_chute", "magnet"))
    return (
        f"The parallel-axis term of I_yy needs {mass:.3f} g; printed {own} g for the Arc Chute,"
        f" {other} g for the Magnet."
    )


@_evidence("axes-swapped")
def _axes_swapped() -> str:
    about_origin, squares = _about_origin()
    x, _, z = about_origin - chapter_4("magnet")["mass"] * squares
    return (
        f"From the moments about the origin I_xx = {x:.2f} and I_zz = {z:.2f} g mm2; printed the other way"
        " round."
    )


def _about_origin() -> tuple[np.ndarray, np.ndarray]:
    """The Arc Chute's moments about the origin [g mm2], and the squares of its centre's levers [mm2]."""
    value = chapter_4("arc_chute")
    x, y, z = (value[axis] for axis in "xyz")
    moments = np.array([value[f"origin_{a}{a}"] for a in "xyz"])
    return moments, np.array([y * y + z * z, x * x + z * z, x * x + y * y])


@_evidence("aspect-5-moment")
def _aspect_5_moment() -> str:
    value, moment = chapter_4("arc_chute"), float(table("3-10").text("5", "I"))
    lever, matrix = value["drive_offset"], value["I_xx"]
    return (
        f"Coefficient {lever / matrix:.4f} with I_xx = {matrix} g mm2, {lever / moment:.4f} with Table 3-10's"
        f" {moment} g mm2."
    )


@_evidence("magnet-matrix")
def _magnet_matrix() -> str:
    value = chapter_4("magnet")
    return f"I_xy = {value['I_xy']:+}, I_yx = {value['I_yx']:+} g mm2."


@_evidence("magnet-axes")
def _magnet_axes() -> str:
    value = chapter_4("magnet")
    xx, yy, zz, product = (value[name] for name in ("I_xx", "I_yy", "I_zz", "I_xy"))
    about_z, about_y = (
        np.degrees(0.5 * np.arctan2(2.0 * abs(product), abs(xx - other))) for other in (yy, zz)
    )
    return (
        f"As printed z is principal and the others are turned {about_z:.1f} deg; read as I_xz it is"
        f" {about_y:.2f} deg."
    )


@_evidence("magnet-height")
def _magnet_height() -> str:
    value, row = chapter_4("magnet"), table("3-11").rows["3"]
    return f"h {float(row['h'])} and {value['x']} mm; I {float(row['I'])} and {value['I_xx']} g mm2."


@_evidence("bank-angle")
def _bank_angle() -> str:
    value = chapter_4("arc_chute")
    return f"Remark {value['bank_without_radial_friction']} deg, equation {value['wall_lever_angle']} deg."


@_evidence("wall-lever")
def _wall_lever() -> str:
    value = chapter_4("arc_chute")
    return f"{value['wall_y']} and {value['wall_friction_y']} mm."


@_evidence("hop")
def _hop() -> str:
    ratio, drawn = figures.ratio_of_5_6(), figures.figure_5_7()
    beta, share = np.degrees(np.arcsin(1.0 / ratio)), 100.0 * np.mean(drawn.hops)
    return (
        f"Figure 5-6 hops from beta = {beta:.1f} deg, where A w^2 ="
        f" {ratio * figures.GRAVITY_OF_CHAPTER_5:.0f} m/s2; Figure 5-7 over {share:.0f} percent of its area,"
        f" and sticks over {100.0 * np.mean(drawn.values < 0.0):.0f} percent."
    )


@_evidence("beta-sliding")
def _beta_sliding() -> str:
    low, high = figures.DRIVE_RATIOS[5], figures.DRIVE_RATIOS[-1]
    low_10, low_40, high_10, high_40 = (
        float(limits.published_limit(ratio, np.radians(beta))) for ratio in (low, high) for beta in (10, 40)
    )
    return (
        f"At G = {low:.1f} the limiting friction falls from {low_10:.3f} (beta 10 deg) to {low_40:.3f}"
        f" (40 deg); at G = {high:.1f} it grows from {high_10:.3f} to {high_40:.3f}."
    )


@_evidence("figure-references")
def _figure_references() -> str:
    return "By their captions: 3-5 shows the Magnet's aspects, 3-7 the PMI rule alone."


@_evidence("drawings-lost")
def _drawings_lost() -> str:
    return "Such cells are marked 'given'."


@functools.cache
def banked_arc_chute() -> TrackAsPublished:
    """Return the Arc Chute on its fifth aspect on a banked track, driven a little across it.

    It slips forward and never back: the omitted terms are weighed here.
    """
    plain = bowl.read(None, SLIPS_ONE_WAY)
    drive, at_bank = replace(plain.drive, direction=BANK_SHOWN), replace(plain.track, bank=BANK_SHOWN)
    return track(parts.card("arc_chute"), replace(plain, drive=drive, track=at_bank), "5")


def _omitted(name: str) -> float:
    """Size of an omitted term [mN or N mm]."""
    term = next(term for term in banked_arc_chute().omitted if term.name == name)
    return abs(term.value) / (MILLI if term.unit == "N" else 1.0)


def _weight() -> float:
    """Of the Arc Chute [mN]."""
    return banked_arc_chute().seat.mass * bowl.read(None, SLIPS_ONE_WAY).gravity / MILLI


@_evidence("fixed-axes")
def _fixed_axes() -> str:
    value = chapter_4("arc_chute")
    e, h = value["drive_offset"], value["centroid_height"]
    beta = bowl.read(None, SLIPS_ONE_WAY).drive.vibration_angle
    lever = -np.sin(TURN_SHOWN) * (e * np.sin(beta) + h * np.cos(beta) * np.cos(TURN_SHOWN))
    return (
        f"Aligned at alpha = theta = {np.degrees(TURN_SHOWN):.0f} deg no moment about Z' is left; the print"
        f" has a lever of {lever:.2f} mm."
    )


@_evidence("alpha-plus-theta")
def _alpha_plus_theta() -> str:
    printed = np.cos(2.0 * TURN_SHOWN)
    return f"Aligned at {np.degrees(TURN_SHOWN):.0f} deg the factor is 1; the print gives {printed:.3f}."


@_evidence("sign-of-r-y")
def _sign_of_r_y() -> str:
    return "A friction of -R_y at the foot, h below the centre of mass, has the moment +h R_y about Z'."


@_evidence("radial-gravity")
def _radial_gravity() -> str:
    size = _omitted("radial gravity, -m g cos(phi) sin(delta)")
    return f"{size:.2f} mN of a weight of {_weight():.1f} mN at 10 deg of bank."


@_evidence("centripetal")
def _centripetal() -> str:
    size = _omitted("centripetal force at mid-stroke")
    return f"At most {size:.4f} mN of a weight of {_weight():.1f} mN in the default bowl."


@_evidence("wall-tangent")
def _wall_tangent() -> str:
    along_x, along_y = (_omitted(f"wall friction turned by sigma, along {axis}") for axis in "XY")
    return f"{along_x:.2g} mN along X and {along_y:.2g} mN along Y."


@_evidence("track-moments")
def _track_moments() -> str:
    drive, wall = _omitted("moment of the drive about X"), _omitted("moment of wall friction about Y")
    return f"{drive:.2g} and {wall:.2g} N mm, where the weight has {_weight():.1f} mN."


@_evidence("wall-pulls")
def _wall_pulls() -> str:
    printed, complete = banked_arc_chute().printed, banked_arc_chute().now
    return (
        f"At the upper reversal R1 + R2 is {printed.walls.sum() / MILLI:.2f} mN as printed; the complete"
        f" equations give {complete.walls.sum() / MILLI:.2f} mN, and open a contact rather than let it pull."
    )


@_evidence("normal-force-line")
def _normal_force_line() -> str:
    card, plain = parts.card("arc_chute"), bowl.read(None, SLIPS_ONE_WAY)
    ahead = floor(card, plain, "5").now.offset[..., 0] / MILLI
    return f"At the upper reversal N acts {float(ahead):.2f} mm ahead of the Arc Chute's centre of mass."


@_evidence("seven-unknowns")
def _seven_unknowns() -> str:
    printed, complete = banked_arc_chute().printed, banked_arc_chute().now
    radial, coulomb = (study.radial_friction / MILLI for study in (printed, complete))
    return (
        f"While the Arc Chute slides at 10 deg of bank the print has R3 = {radial:.2f} mN and no d_y;"
        f" Coulomb's friction acts against the sliding, so R3 = {coulomb:.2f} mN and"
        f" d_y = {complete.offset[..., 1] / MILLI:.3f} mm."
    )


@_evidence("one-instant")
def _one_instant() -> str:
    ratio, beta = 0.5, np.radians(20.0)
    forward, backward = float(limits.published_limit(ratio, beta)), float(limits.backward_limit(ratio, beta))
    return (
        f"At G = {ratio:.1f} and beta 20 deg a part slips forward below {forward:.3f} and back below"
        f" {backward:.3f}: between the two it slips one way only."
    )


@_evidence("dual-numbers")
def _dual_numbers() -> str:
    a, b, c, d = 1.0, 2.0, 3.0, 4.0
    step = 1e-6  # both are derivatives at 0: of (a + b x)(c + d x), and of (a + b x)/(c + d x)
    product, quotient = (
        (rule(step) - rule(-step)) / (2.0 * step)
        for rule in (lambda x: (a + b * x) * (c + d * x), lambda x: (a + b * x) / (c + d * x))
    )
    return (
        f"For a, b, c, d = 1, 2, 3, 4 the dual parts are {product:.4f} and {quotient:.4f}; with ad - bc the"
        f" print gives {a * d - b * c:.4f} and {(a * d - b * c) / c**2:.4f}."
    )


@_evidence("momentum-cross")
def _momentum_cross() -> str:
    value = chapter_4("arc_chute")
    return (
        f"At 1 rad/s and 1 mm/s across the force is m w v = {value['mass']:.3f} uN; the print has the moment"
        f" I w^2 there, {value['I_zz']:.2f} nN m."
    )


@_evidence("equation-4-24")
def _equation_4_24() -> str:
    return "docs/equations.md has each printed equation with its function."


def _gap(profile: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Total variation of two profiles [1]."""
    return 0.5 * float(np.abs(profile - other).sum())


@_evidence("conclusion-1")
def _conclusion_1() -> str:
    low, high = (table("3-4").numbers(name) for name in ("MDBT_78", "MDBT_80"))
    return (
        f"Between 78 and 80 percent of the drive the measured shares change by {100.0 * _gap(low, high):.1f}"
        " percent of the parts."
    )


@_evidence("conclusion-2")
def _conclusion_2() -> str:
    names = ("csa", "experiment")
    csa, measured = (table("3-1").numbers(name) / table("3-1").numbers(name).sum() for name in names)
    pmi = parts.t_aspects(0.6).pmi
    return (
        f"Total variation of PMI from CSA {_gap(pmi, csa):.3f} and from the experiment"
        f" {_gap(pmi, measured):.3f}, of CSA from the experiment {_gap(csa, measured):.3f}."
    )


@_evidence("conclusion-4")
def _conclusion_4() -> str:
    return _t_shape_drawing()


@_evidence("conclusion-5")
def _conclusion_5() -> str:
    size = _omitted("radial gravity, -m g cos(phi) sin(delta)")
    hops = 100.0 * np.mean(figures.figure_5_7().hops)
    return (
        f"At 10 deg of bank {size:.2f} mN of a weight of {_weight():.1f} mN are left out; Figure 5-7 is drawn"
        f" over {hops:.0f} percent where the part has left the floor."
    )


@_evidence("conclusion-8")
def _conclusion_8() -> str:
    ratio, beta, turn = 0.5, np.radians(20.0), np.radians(60.0)
    at_wall, free = (float(limits.published_limit(ratio, beta, angle)) for angle in (turn, 0.0))
    return (
        f"At G = {ratio:.1f}, beta 20 deg and alpha - theta 60 deg it says {at_wall:.3f}; the open floor"
        f" needs {free:.3f}."
    )


with (resources.files("feederscrew.thesis") / "data" / "findings.csv").open(encoding="utf-8") as _file:
    FINDINGS = tuple(Finding(**row, evidence=_evidence_of[row["id"]]) for row in csv.DictReader(_file))
FINDING_OF = {finding.id: finding for finding in FINDINGS}
