"""Errata of the equations of chapter 4, by their size for the Arc Chute."""

import functools
from dataclasses import replace

import numpy as np

from feederscrew import bowl
from feederscrew.thesis import parts
from feederscrew.thesis.finding import Finding
from feederscrew.thesis.motion.as_published import track
from feederscrew.units import factor

BANK, TURN = np.radians(10.0), np.radians(20.0)  # [rad] delta (and alpha), theta the sizes are shown at
MILLI = 1e-3


PLAIN = ("drive.amplitude=0.05 mm", "drive.frequency=60 Hz", "drive.vibration_angle=30 deg")  # slips one way


def plain_bowl():
    """Return the bowl on which omitted terms are weighed: the part slips forward and never back."""
    return bowl.read(None, PLAIN)


@functools.cache
def on_track():
    """Return the Arc Chute on its fifth aspect on a banked track, driven a little across it."""
    default = plain_bowl()
    drive, at_bank = replace(default.drive, direction=BANK), replace(default.track, bank=BANK)
    banked = replace(default, drive=drive, track=at_bank)
    return track(parts.card("arc_chute"), banked, "5")


def _sizes(*names):
    """Sizes of omitted terms [mN, N mm], as {0}, {1} ... of a template's names a, b ..."""
    terms = {term.name: term for term in on_track().omitted}
    chosen = [terms[name] for name in names]
    return {
        letter: abs(term.value) / (MILLI if term.unit == "N" else 1.0)
        for letter, term in zip("abc", chosen, strict=False)
    } | {"weight": on_track().seat.mass * plain_bowl().gravity / MILLI}


def gravity():
    """Return the radial component of the weight."""
    return _sizes("radial gravity, -m g cos(phi) sin(delta)")


def centripetal():
    """Return the force of the curved track."""
    return _sizes("centripetal force at mid-stroke")


def wall_friction():
    """Return the friction of the wall along its own tangent."""
    return _sizes("wall friction turned by sigma, along X", "wall friction turned by sigma, along Y")


def moments():
    """Return moments the track equations leave out."""
    return _sizes("moment of the drive about X", "moment of wall friction about Y")


def pulling():
    """Return the wall's reactions by the printed equations, and by the complete ones."""
    found = on_track()
    return {"printed": found.printed.walls.sum() / MILLI, "complete": found.now.walls.sum() / MILLI}


def projection():
    """Lever of the drive's moment about Z' of [4.13] at alpha = theta: printed, and in body axes."""
    printed = parts.card("arc_chute").printed["floor"]
    e, h = (printed[key] / factor("mm", "length") for key in ("drive_offset", "centroid_height"))
    beta = plain_bowl().drive.vibration_angle
    level, lift = np.cos(beta), np.sin(beta)
    return {"printed": -np.sin(TURN) * (e * lift + h * level * np.cos(TURN)), "turn": np.degrees(TURN)}


def angles():
    """Return cos(alpha - theta) and what is printed for it at alpha = theta."""
    return {"printed": np.cos(2.0 * TURN), "turn": np.degrees(TURN)}


FINDINGS = (
    Finding(
        "fixed-axes",
        "Equations [4.13] and [4.43]",
        "The drive's moment is projected on fixed axes by cos(theta) and sin(theta), where the equations are"
        " in body axes: there alpha - theta belongs in its place.",
        "Aligned at alpha = theta = {turn:.0f} deg no moment about Z' is left; the print has a lever of"
        " {printed:.2f} mm.",
        projection,
    ),
    Finding(
        "alpha-plus-theta",
        "Equations [4.43] and [4.46]",
        "The drive along Z' is printed as cos(alpha) cos(theta) - sin(alpha) sin(theta), which is"
        " cos(alpha + theta); the body axis needs cos(alpha - theta), as in [4.13] and [4.52].",
        "Aligned at {turn:.0f} deg the factor is 1; the print gives {printed:.3f}.",
        angles,
    ),
    Finding(
        "sign-of-r-y",
        "Equation [4.13]",
        "The moment of R_y has the other sign than in [4.19]; the sum of wrenches has the latter.",
        "A friction of -R_y at the foot, h below the centre of mass, has the moment +h R_y about Z'.",
    ),
    Finding(
        "radial-gravity",
        "Equation [4.33]",
        "The Arc Chute's track equations are in axes tilted by the bank, where gravity has a radial"
        " component, -m g cos(phi) sin(delta); it is left out; the Magnet's, in level axes, need none.",
        "{a:.2f} mN of a weight of {weight:.1f} mN at 10 deg of bank.",
        gravity,
    ),
    Finding(
        "centripetal",
        "Equations [4.33] and [4.58]",
        "The force that keeps the part on its circle, m V^2/r, is left out.",
        "At most {a:.4f} mN of a weight of {weight:.1f} mN in the default bowl.",
        centripetal,
    ),
    Finding(
        "wall-tangent",
        "Equations [4.32] and [4.57]",
        "Wall friction is taken along X, though each wall contact's tangent is turned by sigma and its"
        " friction has a radial part.",
        "{a:.2g} mN along X and {b:.2g} mN along Y.",
        wall_friction,
    ),
    Finding(
        "track-moments",
        "Equations [4.35] to [4.37] and [4.60] to [4.62]",
        "The drive's moment about X and the moment of wall friction about Y are left out, and [4.36]"
        " repeats [4.29] with sin(delta) for cos(delta) and without its last term.",
        "{a:.2g} and {b:.2g} N mm, where the weight has {weight:.1f} mN.",
        moments,
    ),
    Finding(
        "wall-pulls",
        "Equations [4.32] to [4.37]",
        "The equations assume that the part touches the wall; where it would leave it their reactions pull.",
        "At the upper reversal R1 + R2 is {printed:.2f} mN as printed; the complete equations give"
        " {complete:.2f} mN, and open a contact rather than let it pull.",
        pulling,
    ),
)
