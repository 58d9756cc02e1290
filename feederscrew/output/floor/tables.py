"""The part on the floor as tables and as a document, in the units of the shop."""

import numpy as np

from feederscrew.mechanics.floor.balance import HOP, MOTION_STATES, ON_THE_LINE, regime, rolls, stable_heading
from feederscrew.output import tables
from feederscrew.studies.floor import FloorStudy
from feederscrew.units import MM, factor

COARSE = 46  # values of each quantity of a map in a table
MAPS = {  # by the end of their file's name
    "beta_friction": FloorStudy.over_angle_and_friction,
    "frequency_amplitude": FloorStudy.over_frequency_and_amplitude,
}
OUTSIDE = "line of action of N outside the contact"  # at that instant; over the strokes it may only rock
STATE_WORDS = {"tip": "line of action outside the contact", "stick": "held by friction"}  # else as it is
EVERY = 5  # of the samples of a cycle, in tables and documents
LABELS = {  # what people read
    "normal_force_N": "normal force N",
    "alignment_acceleration_rad_s2": "alignment acceleration theta''",
    "stable_heading_deg": "stable heading",
    "limiting_friction": "limiting friction",
    "acceleration_y_m_s2": "acceleration across the heading, V'_y",
    "acceleration_z_m_s2": "acceleration along the heading, V'_z",
    "friction_N": "friction",
    "greatest_friction_N": "greatest static friction, mu N",
    "normal_line_offset_mm": "line of action of N, d along the heading",
    "normal_line_offset_y_mm": "line of action of N, across the heading",
    "tips": OUTSIDE,
}


def instant(found, posture, bowl):
    """Return the upper reversal under the names of the JSON contract.

    Parameters
    ----------
    found : FloorMotion or PrintedFloor
        At one instant.
    posture : Posture
    bowl : Bowl

    Returns
    -------
    dict
    """
    size = np.hypot(*found.acceleration)
    return {
        "normal_force_N": float(found.normal_force),
        "alignment_acceleration_rad_s2": float(found.turning) + 0.0,
        "stable_heading_deg": float(np.degrees(stable_heading(posture, bowl))),
        "limiting_friction": float(found.limiting_friction),
        "acceleration_y_m_s2": noiseless(found.acceleration[1], size),
        "acceleration_z_m_s2": noiseless(found.acceleration[0], size),
        **_offsets(found),
        **_friction(found, bowl),
        "tips": tips(getattr(found, "inside", np.nan)),
        "state": MOTION_STATES[int(found.state)],
    }


def over_cycle(found, course):
    """One period as columns.

    Parameters
    ----------
    found : FloorMotion of shape (N,)
    course : Cycle

    Returns
    -------
    dict of str to sequence
    """
    shown = slice(None, None, EVERY)
    return {
        "phase_deg": np.linspace(0.0, 360.0, len(course.velocity), endpoint=False)[shown],
        "state": [MOTION_STATES[code] for code in found.state[shown]],
        "normal_force_N": found.normal_force[shown],
        "friction_z_N": found.friction[shown, 0],
        "friction_y_N": found.friction[shown, 1],
        "limiting_friction": found.limiting_friction[shown],
        "acceleration_z_m_s2": found.acceleration[shown, 0],
        "acceleration_y_m_s2": found.acceleration[shown, 1],
        "alignment_acceleration_rad_s2": found.turning[shown] + 0.0,
        "velocity_m_s": course.velocity[shown],
        "normal_line_offset_mm": found.offset[shown, 0] / MM,
        "normal_line_offset_y_mm": found.offset[shown, 1] / MM,
        "tips": [tips(inside) for inside in found.inside[shown]],
    }


def document(found, settings):
    """Return all of one FloorStudy, for JSON; of one as published, the upper reversal by print.

    Parameters
    ----------
    found : FloorStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    dict
    """
    posture, bowl = found.posture, found.bowl
    now, values = instant(found.now, posture, bowl), {}
    if found.printed is not None:
        values = {"instant": instant(found.printed, posture, bowl)}
        values["difference"] = difference(values["instant"], now, found.terms)
    return {
        "part": found.part.name,
        "aspect": posture.name,
        "kind": posture.kind,
        "form": posture.form,
        "heading_deg": float(np.degrees(found.heading)),
        "height_mm": posture.height / MM,
        "drive_offset_mm": posture.offset / MM,
        "rolling_circle_mm": posture.rolling_circle / MM if np.isfinite(posture.rolling_circle) else None,
        "turning_inertia_g_mm2": posture.turning_inertia / factor("g mm2", "inertia"),
        "as_published": found.printed is not None,
        "regime": regime(found.cycle.state),
        "instant": now,
        **values,
        "mean_velocity_m_s": mean_velocity(found),
        "settled": found.course.settled,
        "cycle": over_cycle(found.cycle, found.course),
        "bowl": settings,
    }


def shown(document, format):
    """What goes to stdout: the cycle as CSV; for people the upper reversal, or what print leaves out."""
    if format == "csv":
        return tables.frame(document["cycle"])
    return document.get("difference", summary(document))


def summary(document):
    """Return the upper reversal, a row a quantity, for people."""
    now = document["instant"]
    rows = {label(name, text): now[name] for name, text in LABELS.items() if name in now}
    for name, state in (
        ("state at the upper reversal", now["state"]),
        ("regime over the cycle", document["regime"]),
    ):
        rows[name] = STATE_WORDS.get(state, state)
    return tables.frame({"quantity": list(rows), "value": [shown_value(value) for value in rows.values()]})


def difference(printed, complete, terms):
    """Return printed against complete values, with the omitted term named.

    Parameters
    ----------
    printed, complete : dict of str to float
        Under the names of ``terms``.
    terms : dict of str to str
        Omitted term by quantity.

    Returns
    -------
    Frame
    """
    rows = [(name, printed[name], complete[name], term) for name, term in terms.items()]
    names, first, second, omitted = zip(*rows)
    gap = np.array(first, dtype=float) - np.array(second, dtype=float)
    alike = np.abs(gap) <= 1e-9 * np.maximum(np.abs(first), np.abs(second))
    listed = ["-" if same else term for same, term in zip(alike, omitted)]
    return tables.frame(
        {
            "quantity": names,
            "as_published": first,
            "complete": second,
            "difference": gap,
            "omitted_term": listed,
        }
    )


def remarks(found):
    """Return what a reader of a FloorStudy should know, a sentence each."""
    posture, lines = found.posture, chosen(found)
    if len(posture.contact) == 0:
        lines.append("a part card has no contact polygon: whether it tips is not known")
    if rolls(posture):
        limit = float(found.now.limiting_friction)
        lines.append(
            f"rolling aspect, {posture.form}: it rolls, and slips as well where static friction is below"
            f" {limit:.3g}"
        )
    if np.isfinite(posture.rolling_circle):
        lines.append(
            f"it rolls in a circle: its centre of mass stays {posture.rolling_circle / MM:.4g} mm from the"
            " point where its axis meets the floor; the straight line of these numbers is not its path"
        )
    if HOP in found.cycle.state:
        lines.append(
            "the part loses contact within the cycle: its flight is not followed here, but by feeder convey"
        )
    if not np.isfinite(posture.offset):
        lines.append(f"the card gives no drive offset for aspect {posture.name}: theta'' is not known")
    return lines


def map_cells(study, kind):
    """Return a map of ``MAPS`` as columns."""
    return MAPS[kind](study, COARSE).columns()


def map_remarks(study):
    """Return what a reader of the maps should know, a sentence each."""
    return [line for kind, make in MAPS.items() for line in map_notes(kind, make(study, COARSE))]


def map_notes(kind, grid):
    """Return a sentence where nothing slides on a map."""
    if MOTION_STATES.index("slide") in grid.codes:
        return []
    return [f"{kind.replace('_', ' and ')}: {none_slides(grid)}."]


def none_slides(grid):
    """Say what a map shows on which nothing slides: of which instant it is, and what happens there."""
    shares = {name: share for name, share in grid.shares().items() if share > 0.0}
    words = {"stick": "is held", "tip": "has its line of action outside the contact", "hop": "is in the air"}
    said = ", ".join(
        f"{words[name]} in {100 * share:.3g} %" for name, share in shares.items() if name in words
    )
    return (
        f"at the upper reversal the part slides in no cell of the map, it {said} of them; the map is of that"
        " instant, the velocity of the whole cycle"
    )


def alignment(study):
    """Return theta'' over every heading as columns."""
    headings, cells = study.alignment()
    names = ("alignment_acceleration_rad_s2", "published_alignment_rad_s2")
    return {"heading_deg": np.degrees(headings), **{name: cells[name] for name in names if name in cells}}


def mean_velocity(found):
    """Of the cycle [m/s]; None where the part hops, or gets faster with every period."""
    return None if HOP in found.cycle.state or not found.course.settled else found.course.mean


def chosen(found):
    """Return which aspect was taken, in one line, where none was asked for."""
    return [f"Aspect {found.posture.name}, {found.why}"] if found.why else []


def label(name, text):
    """Return a quantity for people, its unit behind it."""
    return text + next((f" [{unit}]" for end, unit in tables.UNITS.items() if name.endswith(end)), "")


def shown_value(value):
    """Return a number, text or verdict for people."""
    if value is None or value != value:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else "never" if np.isinf(value) else f"{value:.5g}"


def noiseless(value, scale):
    """Return the rounding of an exact zero as zero; ``scale`` is what it came out of."""
    return 0.0 if abs(value) <= 1e-9 * max(abs(scale), 1e-12) else float(value)


def tips(inside):
    """True, false, or None where the contact polygon or the contact is missing."""
    return None if np.isnan(inside) else bool(inside < -ON_THE_LINE)


def _friction(found, bowl):
    """Friction of the complete equations and the most that the floor gives; the print has no such vector."""
    if not hasattr(found, "friction"):
        return {}
    limit = float(bowl.friction.static * found.normal_force)
    return {"friction_N": float(np.hypot(*found.friction)), "greatest_friction_N": limit}


def _offsets(found):
    pair = np.broadcast_to(found.offset, (2,)) if np.ndim(found.offset) else (found.offset, np.nan)
    return {
        "normal_line_offset_mm": float(pair[0]) / MM,
        "normal_line_offset_y_mm": float(pair[1]) / MM + 0.0,
    }
