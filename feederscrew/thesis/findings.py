"""What checking the thesis showed: its slips, its silences, and what explains its numbers."""

from feederscrew.thesis import chapter_4, evidence, motion_evidence
from feederscrew.thesis.finding import Finding

FINDINGS = (
    Finding(
        "t-shape-drawing",
        "Figure 3-3",
        "The drawing of the T shape is lost; its dimensions follow from Table 3-8: 25 mm wide and"
        " high, head 13 mm high over the full width, stem 11 mm wide, centred, thickness = aspect"
        " ratio x 25 mm.",
        "Table 3-8's heights and moments follow within {heights:.4f} mm and {moments:.4f} g mm2.",
        evidence.t_geometry,
    ),
    Finding(
        "t-shape-density",
        "Section 3.1",
        "The text's density, 9.99E-4 grams per cubic meter, does not give Table 3-8; 1.000e-3 g/mm3 does.",
        "With 1.000e-3 g/mm3 the largest gap is {right:.4f} g mm2, with 9.99e-4 g/mm3 {wrong:.2f} g mm2.",
        evidence.t_density,
    ),
    Finding(
        "t-shape-rounded",
        "Table 3-9",
        "The table was computed from moments and heights rounded to two decimals; with the same "
        "rounding all 30 cells follow to the last digit.",
        "Largest gap {rounded:.1e} percentage points with the rounding, {plain:.4f} without.",
        evidence.t_rounding,
    ),
    Finding(
        "pmi-class-once",
        "Tables 3-8 and 3-9",
        "The PMI rule counts each class of equal aspects once: B, D and E have two faces each.",
        "Aspect E at ratio 0.6: {once:.4f} counted once, as printed ({printed}); {every:.4f} over all faces.",
        evidence.t_classes,
    ),
    Finding(
        "csa-ratio",
        "Table 3-1",
        "The columns labelled aspect ratio 0.6 belong to a thinner prism: our CSA agrees at 0.4, not at 0.6.",
        "Printed {printed} percent; ours {thin} at 0.4 and {thick} at 0.6; closest of all from "
        "0.30 to 0.70 is {closest:.2f}.",
        evidence.t_csa,
    ),
    Finding(
        "experiment-total",
        "Table 3-1",
        "The experiment's five percentages do not add up to the total printed under them.",
        "They sum to {sum:.2f}; printed {printed}.",
        evidence.t_experiment,
    ),
    Finding(
        "pmi-equation",
        "Section 3.1, the general equation",
        "The denominator prints I4/h5; Table 3-8 uses I4/h4.",
        "Aspect D of Table 3-8: {right:.4f} with h4, as printed; {wrong:.4f} with h5.",
        evidence.t_equation,
    ),
    Finding(
        "q-unit",
        "Tables 3-2 and 3-5",
        "The unit of Q is not stated and is not the steradian: the aspects of one part would "
        "cover more than a sphere.",
        "Q sums to {arc_chute:.2f} and {magnet:.2f}; a whole sphere is {sphere:.2f} sr.",
        evidence.q_unit,
    ),
    Finding(
        "q-total",
        "Table 3-2",
        "The total of Q leaves out aspect 1.",
        "All five sum to {all:.4f}; the last four to {rest:.4f}; printed {printed}.",
        evidence.q_total,
    ),
    Finding(
        "arc-chute-heights",
        "Tables 3-2, 3-3 and 3-10",
        "The Arc Chute's heights in Tables 3-2 and 3-3 are not those of Table 3-10, and row 4 "
        "repeats rows 2 and 3.",
        "Ratio {lowest:.2f} to {highest:.2f}; row 4 prints {row_4} as row 2 does ({row_2}).",
        evidence.arc_chute_heights,
    ),
    Finding(
        "h-total",
        "Table 3-2",
        "The column H_total/h implies one H_total, which is printed nowhere.",
        "H_total = {mean:.4f} mm, the same in every row within {spread:.0e} mm.",
        evidence.h_total,
    ),
    Finding(
        "rounded-inputs",
        "Tables 3-3 and 3-6",
        "Printed areas and heights are themselves rounded; a last digit of what follows from them"
        " can be off by one.",
        "A/h of the Magnet's aspect 1 is {value:.5f} from the printed terms, uncertain by "
        "{spread:.5f}; printed {printed}.",
        evidence.rounded_inputs,
    ),
    Finding(
        "cut-ratios",
        "Tables 3-8 and 3-10",
        "I/h is cut off after two decimals, not rounded, and the total adds the cut numbers.",
        "Table 3-8: {before:.2f} before, {after:.2f} after, as printed.",
        evidence.cut_ratios,
    ),
    Finding(
        "sum-of-rounded",
        "Tables 3-8 and 3-10",
        "The probabilities' total of 0.9999 adds the rounded entries; unrounded they sum to 1.",
        "Printed entries sum to {t_shape:.4f} (T shape) and {arc_chute:.4f} (Arc Chute).",
        evidence.rounded_totals,
    ),
    Finding(
        "magnet-total",
        "Table 3-11",
        "The total of I/h is misprinted: a point stands where a 0 belongs.",
        "{sum:.4f}; printed {printed}.",
        evidence.magnet_total,
    ),
    Finding(
        "magnet-probability-total",
        "Table 3-11",
        "The total of the probabilities is misprinted 0.9999, as in Tables 3-8 and 3-10 where it is right.",
        "The printed entries sum to {magnet:.4f}.",
        evidence.rounded_totals,
    ),
    Finding(
        "cut-deviations",
        "Tables 3-12 and 3-13",
        "The 'standard deviation' is the root mean square difference over the aspects, cut off at"
        " the printed digits; 78, 80 and 82 are the MDBT columns.",
        "MDBT_80 - PMI: {population:.4f}, printed {printed}; divided by one aspect less it would be "
        "{sample:.3f}.",
        evidence.deviations,
    ),
    Finding(
        "magnet-csa-mixed",
        "Table 3-13 and section 3.1's conclusion on the Magnet",
        "The four rows with CSA do not follow from Table 3-5; they follow from its Q over Table "
        "3-11's heights. The good agreement of PMI and CSA for the Magnet rests on these mixed "
        "heights.",
        "Mixed profile {profile}; CSA - PMI is {mixed:.4f} with it (printed {printed}), "
        "{plain:.3f} with Table 3-5 as printed.",
        evidence.mixed_heights,
    ),
    Finding(
        "magnet-heights",
        "Tables 3-5, 3-6 and 3-11",
        "The Magnet's heights in Tables 3-5 and 3-6 are not those of Table 3-11.",
        "Ratios {ratios}.",
        evidence.magnet_heights,
    ),
    Finding(
        "dominant-aspect",
        "Section 3.1 and Figure 3-10",
        "The PMI rule does not find the Arc Chute's dominant aspect at 78 percent of full drive.",
        "Most parts were found on aspect {measured}; PMI puts most on {pmi}.",
        evidence.dominant,
    ),
    Finding(
        "masses-swapped",
        "Equations [4.3] and [4.38]",
        "The Arc Chute's moments about the origin fit the mass printed for the Magnet, not its "
        "own: the two masses are swapped.",
        "The parallel-axis term of I_yy needs {mass:.3f} g; printed {own} g for the Arc Chute, "
        "{other} g for the Magnet.",
        evidence.parallel_axes,
    ),
    Finding(
        "axes-swapped",
        "Equation [4.1]",
        "x and z are exchanged in the Arc Chute's printed inertia matrix.",
        "From the moments about the origin I_xx = {I_xx:.2f} and I_zz = {I_zz:.2f} g mm2; printed"
        " the other way round.",
        evidence.parallel_axes,
    ),
    Finding(
        "aspect-5-moment",
        "Equations [4.17] and [4.23]",
        "The Arc Chute's alignment divides by the matrix's exchanged I_xx; Table 3-10 gives the "
        "aspect it stands on another.",
        "Coefficient {printed:.4f} with I_xx = {I_xx} g mm2, {table:.4f} with Table 3-10's {I_5} g mm2.",
        evidence.alignment,
    ),
    Finding(
        "magnet-matrix",
        "Equation [4.38]",
        "The Magnet's printed inertia matrix is not symmetric.",
        "I_xy = {upper:+}, I_yx = {lower:+} g mm2.",
        evidence.magnet_matrix,
    ),
    Finding(
        "magnet-axes",
        "Section 4.3",
        "The text calls the Magnet's principal axis four degrees off the figure's z; neither "
        "reading of the printed product of inertia gives that.",
        "As printed z is principal and the others are turned {about_z:.1f} deg; read as I_xz it "
        "is {about_y:.2f} deg.",
        evidence.principal_axes,
    ),
    Finding(
        "magnet-height",
        "Table 3-11 and equation [4.39]",
        "The Magnet's lowest aspect has another height and another moment in Table 3-11 than in chapter 4.",
        "h {h} and {x} mm; I {I} and {I_xx} g mm2.",
        evidence.magnet_pose,
    ),
    Finding(
        "bank-angle",
        "Section 4.2, the remark on R3",
        "The bank without radial friction is misprinted in the remark; the equations have another angle.",
        "Remark {remark} deg, equation {equation} deg.",
        evidence.bank_angle,
    ),
    Finding(
        "wall-lever",
        "Equations [4.31] to [4.36]",
        "One lever of the Arc Chute's wall contacts is printed with two values.",
        "{first} and {second} mm.",
        evidence.wall_lever,
    ),
    Finding(
        "hop",
        "Figures 5-6 and 5-7",
        "The formula is drawn where the part has left the floor; its maximum is the formula's, at"
        " tan(beta) = mu, not a part's. Where it is negative the part sticks.",
        "Figure 5-6 hops from beta = {beta_deg:.1f} deg, where A w^2 = {acceleration:.0f} m/s2; "
        "Figure 5-7 over {share:.0f} percent of its area, and sticks over {held:.0f} percent.",
        motion_evidence.hop,
    ),
    Finding(
        "beta-sliding",
        "Figure 5-1 and conclusion 6",
        "A larger beta enlarges the sliding region only where G > sin(beta); below, it shrinks it.",
        "At G = {low} the limiting friction falls from {low_10:.3f} (beta 10 deg) to {low_40:.3f}"
        " (40 deg); at G = {high} it grows from {high_10:.3f} to {high_40:.3f}.",
        motion_evidence.sliding,
    ),
    Finding(
        "figure-references",
        "Section 3.1",
        "The text on Figure 3-6 once says 3-5, and the paragraph on Ngoi's measured curves says 3-7 for 3-8.",
        "By their captions: 3-5 shows the Magnet's aspects, 3-7 the PMI rule alone.",
    ),
    Finding(
        "drawings-lost",
        "Figures 1-1, 1-2 and 3-8",
        "The dimensions of Arc Chute and Magnet are lost, so their moments, areas and solid "
        "angles are data here; of Figure 3-8's measured curves only the points of Table 3-1 "
        "survive.",
        "Such cells are marked 'given'.",
    ),
    *chapter_4.FINDINGS,
)
BY_ID = {finding.id: finding for finding in FINDINGS}
