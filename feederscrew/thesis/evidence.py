"""The numbers behind each finding, computed from the printed tables and the solids."""

import numpy as np

from feederscrew.resting.counts.deviation import deviation
from feederscrew.thesis import parts, t_shape
from feederscrew.thesis.printed_tables import TOTAL, table
from feederscrew.thesis.recompute import cells, rounded_shares
from feederscrew.thesis.t_shape import RATIOS


def printed(part):
    """Chapter 4's numbers of one part by their name there, as floats."""
    return {row: float(cells[part]) for row, cells in table("chapter 4").rows.items() if cells[part]}


def t_geometry():
    """Return the largest gap between Table 3-8's I and h and the solid's."""
    ours, theirs = parts.t_aspects(0.6), table("3-8")
    moments = np.abs(ours.moments / parts.G_MM2 - theirs.numbers("I"))
    return {"moments": moments.max(), "heights": np.abs(ours.heights / parts.MM - theirs.numbers("h")).max()}


def t_density():
    """Return the largest gap from Table 3-8's moments with the density used and with the text's [g mm2]."""
    ours, theirs = parts.t_aspects(0.6).moments / parts.G_MM2, table("3-8").numbers("I")
    return {
        "right": np.abs(ours - theirs).max(),
        "wrong": np.abs(t_shape.DENSITY_IN_TEXT / t_shape.DENSITY * ours - theirs).max(),
    }


def t_rounding():
    """Return the largest gap from Table 3-9 in percentage points, without and with the thesis's roundings."""
    theirs = np.array([table("3-9").numbers(ratio) for ratio in RATIOS])
    plain = 100.0 * np.array([parts.t_aspects(float(ratio)).pmi for ratio in RATIOS])
    rounded = 100.0 * np.array([rounded_shares(float(ratio))[2] for ratio in RATIOS])
    return {"plain": np.abs(plain - theirs).max(), "rounded": np.abs(rounded - theirs).max()}


def t_classes():
    """Return PMI of aspect E with each class counted once, and with all its faces."""
    ours = parts.t_aspects(0.6)
    every = ours.faces * ours.moments / ours.heights
    return {
        "once": ours.pmi[4],
        "every": (every / every.sum())[4],
        "printed": float(table("3-8").text("E", "probability")),
    }


def t_csa():
    """CSA of the T shape in percent at the printed ratio and at 0.4, and the ratio closest to print."""
    at = {ratio: ", ".join(f"{100 * p:.1f}" for p in parts.t_aspects(ratio).csa) for ratio in (0.4, 0.6)}
    theirs, tried = table("3-1").numbers("csa") / 100.0, np.arange(30, 71, 2) / 100.0
    gaps = [deviation(parts.t_aspects(ratio).csa, theirs) for ratio in tried]
    words = ", ".join(table("3-1").text(row, "csa") for row in table("3-1").names)
    return {"thin": at[0.4], "thick": at[0.6], "printed": words, "closest": tried[np.argmin(gaps)]}


def t_experiment():
    """Return the sum of Table 3-1's experiment column in percent."""
    return {
        "sum": table("3-1").numbers("experiment").sum(),
        "printed": table("3-1").text(TOTAL, "experiment"),
    }


def t_equation():
    """Return the probability of aspect D with h4 under I4, and with h5 as the equation prints."""
    moments, heights = table("3-8").numbers("I"), table("3-8").numbers("h")
    right, wrong = moments / heights, moments / heights[[0, 1, 2, 4, 4]]
    return {"right": (right / right.sum())[3], "wrong": (wrong / wrong.sum())[3]}


def q_unit():
    """Return sums of Q beside the whole sphere, 4 pi."""
    return {
        "arc_chute": table("3-2").numbers("Q").sum(),
        "magnet": table("3-5").numbers("Q").sum(),
        "sphere": 4.0 * np.pi,
    }


def q_total():
    """Return the sum of Q with and without aspect 1."""
    values = table("3-2").numbers("Q")
    return {"all": values.sum(), "rest": values[1:].sum(), "printed": table("3-2").text(TOTAL, "Q")}


def arc_chute_heights():
    """Return ratios of Table 3-2's heights to Table 3-10's, and how often one height is printed."""
    theirs, ours = table("3-2").numbers("h"), table("3-10").numbers("h")
    return {
        "lowest": (theirs / ours).min(),
        "highest": (theirs / ours).max(),
        "row_4": theirs[3],
        "row_2": theirs[1],
    }


def h_total():
    """Return the height that the ratio column of Table 3-2 implies, row by row [mm]."""
    implied = table("3-2").numbers("h") * table("3-2").numbers("h_total_over_h")
    return {"mean": implied.mean(), "spread": np.ptp(implied)}


def rounded_inputs():
    """Return A/h of the Magnet's aspect 1, and how far the rounding of A and h can move it [mm]."""
    cell = next(cell for cell in cells("3-6") if (cell.row, cell.column) == ("1", "A_over_h"))
    return {"value": cell.recomputed, "spread": cell.within, "printed": cell.published}


def cut_ratios():
    """Table 3-8's total: added before, and after, the digits are dropped."""
    moments, heights = table("3-8").numbers("I"), table("3-8").numbers("h")
    return {"before": (moments / heights).sum(), "after": table("3-8").numbers("I_over_h").sum()}


def rounded_totals():
    """Return sums of the printed probabilities of the three PMI tables."""
    sums = {number: table(number).numbers("probability").sum() for number in ("3-8", "3-10", "3-11")}
    return {"t_shape": sums["3-8"], "arc_chute": sums["3-10"], "magnet": sums["3-11"]}


def magnet_total():
    """Return the sum of the Magnet's I/h."""
    values = table("3-11").numbers("I") / table("3-11").numbers("h")
    return {"sum": values.sum(), "printed": table("3-11").text(TOTAL, "I_over_h")}


def deviations():
    """Return the Arc Chute's MDBT_80 against PMI: divided by the number of aspects, and by one less."""
    profiles = parts.profiles("arc_chute")
    value = deviation(profiles["MDBT_80"], profiles["PMI"])
    count = len(profiles["PMI"])
    text = table("3-12").text("MDBT_80 - PMI", "deviation")
    return {"population": value, "sample": value * np.sqrt(count / (count - 1)), "printed": text}


def mixed_heights():
    """Return the Magnet's CSA profile with mixed heights, and its deviation from PMI with either."""
    mixed, profiles = parts.mixed_heights(), parts.profiles("magnet")
    return {
        "profile": ", ".join(f"{p:.4f}" for p in mixed),
        "mixed": deviation(mixed, profiles["PMI"]),
        "plain": deviation(profiles["CSA"], profiles["PMI"]),
        "printed": table("3-13").text("CSA - PMI", "deviation"),
    }


def magnet_heights():
    """Return ratios of Table 3-5's heights to Table 3-11's, as a text."""
    ratios = table("3-5").numbers("h") / table("3-11").numbers("h")
    return {"ratios": ", ".join(f"{ratio:.2f}" for ratio in ratios)}


def parallel_axes():
    """Mass and moments about the centre that the Arc Chute's moments about the origin lead to [g, g mm2]."""
    value = printed("arc_chute")
    x, y, z = (value[axis] for axis in "xyz")
    arms = np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    about_origin = np.array([value[f"origin_{a}{a}"] for a in "xyz"])
    mass = (about_origin[1] - value["I_yy"]) / arms[1]
    return {"mass": mass, "other": printed("magnet")["mass"], "own": value["mass"]} | dict(
        zip(("I_xx", "I_yy", "I_zz"), about_origin - printed("magnet")["mass"] * arms, strict=True)
    )


def magnet_matrix():
    """Return the off-diagonal pair of the Magnet's matrix, as printed [g mm2]."""
    value = printed("magnet")
    return {"upper": value["I_xy"], "lower": value["I_yx"]}


def alignment():
    """Return the coefficient of [4.17] with the printed I_xx, and with Table 3-10's moment [1/(g mm)]."""
    value, moment = printed("arc_chute"), float(table("3-10").text("5", "I"))
    return {
        "printed": value["drive_offset"] / value["I_xx"],
        "table": value["drive_offset"] / moment,
        "I_xx": value["I_xx"],
        "I_5": moment,
    }


def magnet_pose():
    """Return the Magnet's lowest aspect in Table 3-11 beside chapter 4's pose [mm, g mm2]."""
    value, row = printed("magnet"), table("3-11").rows["3"]
    return {"x": value["x"], "h": float(row["h"]), "I_xx": value["I_xx"], "I": float(row["I"])}


def bank_angle():
    """Return the remark's angle beside the equation's, in degrees."""
    value = printed("arc_chute")
    return {"remark": value["bank_without_radial_friction"], "equation": value["wall_lever_angle"]}


def wall_lever():
    """Return the two values of one lever [mm]."""
    value = printed("arc_chute")
    return {"first": value["wall_y"], "second": value["wall_friction_y"]}


def principal_axes():
    """Turn of the Magnet's principal axes [deg]: about z as printed, about y with I_xy read as I_xz."""
    value = printed("magnet")
    return {
        "about_z": _turn(value["I_xx"], value["I_yy"], value["I_xy"]),
        "about_y": _turn(value["I_xx"], value["I_zz"], value["I_xy"]),
        "text": value["principal_axis_off_z"],
    }


def dominant():
    """Return the Arc Chute's most frequent aspect at 78 percent, and the PMI rule's."""
    profiles, names = parts.profiles("arc_chute"), table("3-4").names
    return {"measured": names[profiles["MDBT_78"].argmax()], "pmi": names[profiles["PMI"].argmax()]}


def _turn(first, second, product):
    """Angle from the axes to the principal ones in their plane, in degrees."""
    return float(np.degrees(0.5 * np.arctan2(2.0 * abs(product), abs(first - second))))
