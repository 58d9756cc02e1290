"""The part on the track as tables and as a document, in the units of the shop."""

import numpy as np

from feederscrew.mechanics.floor.balance import HOP, MOTION_STATES, regime
from feederscrew.output import tables
from feederscrew.output.floor.tables import (
    EVERY,
    OUTSIDE,
    STATE_WORDS,
    chosen,
    difference,
    label,
    mean_velocity,
    noiseless,
    shown_value,
    tips,
)
from feederscrew.units import MM

CONTACTS = ("floor", "wall_1", "wall_2")
HELD_ACROSS = (
    "at rest at the upper reversal, friction across the track or up the wall can hold the part; by the least "
    "friction along the track, which the reactions show and the cycle follows, it would slide"
)
ALONG = (
    "velocity along the wall, with its friction and the bank [mm/s]"  # not that of a point mass, of convey
)
UNKNOWN = "not known: it hops"
IN_FLIGHT = "in flight"  # no contact of all
TURNED_OFF = (
    "friction turns the part about the wall contact that is left; the velocity is that of a part that keeps "
    "its heading, and too high - feeder trial follows the turning"
)
TURNS = 1.0  # [rad/s2] in 10 ms that is less than a hundredth of a degree
TURNED = 1.0  # [deg] of heading: less is not worth a word
LABELS = {
    "normal_force_N": "normal force N",
    "wall_1_N": "wall reaction R1, trailing contact",
    "wall_2_N": "wall reaction R2, leading contact",
    "radial_friction_N": "radial friction R3, away from the wall",
    "traction_N": "traction R4, against motion ahead",
    "normal_line_offset_mm": "line of action of N, d ahead",
    "normal_line_offset_y_mm": "line of action of N, away from the wall",
    "acceleration_x_m_s2": "acceleration along the track, V'_X",
    "acceleration_y_m_s2": "acceleration away from the wall",
    "turning_rad_s2": "turning off the wall",
    "tips": OUTSIDE,
}


def instant(found):
    """One instant under the names of the JSON contract; ``found`` is a TrackMotion of one instant."""
    load = found.normal_force + abs(found.traction)
    return {
        "normal_force_N": float(found.normal_force),
        "wall_1_N": noiseless(found.walls[0], load),
        "wall_2_N": noiseless(found.walls[1], load),
        "radial_friction_N": noiseless(found.radial_friction, load),
        "traction_N": noiseless(found.traction, load),
        "normal_line_offset_mm": noiseless(found.offset[0] / MM, 1.0),
        "normal_line_offset_y_mm": noiseless(found.offset[1] / MM, 1.0),
        "acceleration_x_m_s2": float(found.acceleration[0]),
        "acceleration_y_m_s2": noiseless(found.acceleration[1], found.acceleration[0]),
        "turning_rad_s2": noiseless(found.turning, found.acceleration[0] / MM),
        "wall_1_friction_N": float(found.wall_friction[0]),
        "wall_2_friction_N": float(found.wall_friction[1]),
        "floor_couple_N_mm": float(found.couple) / MM,
        "opened": [] if found.state == HOP else opened(found.closed),
        "tips": tips(found.inside),
        "state": MOTION_STATES[int(found.state)],
    }


def printed(found):
    """Return the same of the printed equations; ``found`` is a PrintedTrack of one instant."""
    return {
        "normal_force_N": float(found.normal_force),
        "wall_1_N": float(found.walls[0]),
        "wall_2_N": float(found.walls[1]),
        "radial_friction_N": float(found.radial_friction),
        "traction_N": float(found.traction),
        "normal_line_offset_mm": float(found.offset) / MM,
        "acceleration_x_m_s2": float(found.acceleration),
        "tips": None,
        "state": "hop" if found.normal_force <= 0.0 else "slide" if found.slides else "stick",
    }


def over_cycle(found, course):
    """One period as columns; ``found`` is a TrackMotion of shape (N,)."""
    shown = slice(None, None, EVERY)
    pairs = {"": found.walls, "_friction": found.wall_friction}
    return {
        "phase_deg": np.linspace(0.0, 360.0, len(course.velocity), endpoint=False)[shown],
        "state": [MOTION_STATES[code] for code in found.state[shown]],
        "normal_force_N": found.normal_force[shown],
        **{f"wall_{k + 1}{name}_N": pair[shown, k] for name, pair in pairs.items() for k in (0, 1)},
        "radial_friction_N": found.radial_friction[shown] + 0.0,
        "traction_N": found.traction[shown],
        "normal_line_offset_mm": found.offset[shown, 0] / MM,
        "normal_line_offset_y_mm": found.offset[shown, 1] / MM,
        "acceleration_x_m_s2": found.acceleration[shown, 0],
        "acceleration_y_m_s2": found.acceleration[shown, 1],
        "turning_rad_s2": found.turning[shown],
        "floor_couple_N_mm": found.couple[shown] / MM,
        "velocity_m_s": course.velocity[shown],
        "friction_needed": found.needed[shown, 0],
        "opened": [
            IN_FLIGHT if state == HOP else " ".join(opened(pair))
            for state, pair in zip(found.state[shown], found.closed[shown])
        ],
        "tips": [tips(inside) for inside in found.inside[shown]],
    }


def document(found, settings):
    """Return all of one TrackStudy, for JSON; of one as published, the upper reversal by print.

    Parameters
    ----------
    found : TrackStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    dict
    """
    values = {}
    if found.printed is not None:
        values = {"instant": printed(found.printed), "difference": differences(found)}
        values["omitted_terms"] = omitted_terms(found)
    return {
        "part": found.part.name,
        "aspect": found.posture.name,
        "heading_deg": float(np.degrees(found.seat.heading)),
        "height_mm": found.seat.height / MM,
        "wall_contacts": _contacts(found),
        "as_published": found.printed is not None,
        "regime": regime(found.cycle.state),
        "instant": instant(found.now),
        **values,
        "on_the_track": None if found.stands is None else found.stands.verdict,
        "on_the_track_said": None if found.stands is None else found.stands.sentence,
        "first_to_open": found.opening.contact,
        "opens_at_drive_factor": found.opening.drive_factor,
        "opens_at_reversal": found.opening.reversal,
        "tipping_axis": _axis(found.opening),
        "friction_needed": friction_needed(found.cycle),
        "held_across": found.held_across,
        "stays_on_wall": stays_on_wall(found.cycle),
        "bank_without_radial_friction_deg": float(np.degrees(found.bank_without_radial_friction)),
        "mean_velocity_m_s": mean_velocity(found),
        "settled": found.course.settled,
        "cycle": over_cycle(found.cycle, found.course),
        "bowl": settings,
    }


def differences(found):
    """Return the printed against the complete upper reversal of a TrackAsPublished, as a frame."""
    return difference(printed(found.printed), instant(found.now), found.terms)


def omitted_terms(found):
    """Return the terms that the printed equations of a TrackAsPublished leave out, as a frame."""
    names = ("name", "equation", "value", "unit")
    return tables.frame({name: [getattr(term, name) for term in found.omitted] for name in names})


def friction_needed(cycle):
    """Greatest friction over normal force that holds the part at rest through the cycle, by contact."""
    if not np.isfinite(cycle.needed).all():
        return dict.fromkeys(CONTACTS, np.nan)
    return dict(zip(CONTACTS, cycle.needed.max(axis=0).tolist()))


def stays_on_wall(cycle):
    """Whether a wall contact is closed at every instant; None where it hops: the flight is not followed."""
    return None if HOP in cycle.state else bool(cycle.closed.any(axis=-1).all())


def shown(document, format):
    """What goes to stdout: the cycle as CSV; for people the upper reversal, or what print leaves out."""
    if format == "csv":
        return tables.frame(document["cycle"])
    return document.get("difference", summary(document))


def summary(document):
    """Return what people want to know first, a row a quantity."""
    now, needed = document["instant"], document["friction_needed"]
    rows = {label(name, text): now[name] for name, text in LABELS.items() if name in now}
    rows |= {
        "state at the upper reversal": STATE_WORDS.get(now["state"], now["state"]),
        "regime over the cycle": STATE_WORDS.get(document["regime"], document["regime"]),
        "on the track, over the strokes": document["on_the_track_said"],
        ALONG: None if document["mean_velocity_m_s"] is None else document["mean_velocity_m_s"] / MM,
        "heading [deg]": document["heading_deg"],
        **_opening(document),
        "stays against the wall": UNKNOWN if document["stays_on_wall"] is None else document["stays_on_wall"],
        **{f"friction needed to hold it, {name.replace('_', ' ')}": needed[name] for name in CONTACTS},
        "bank without radial friction [deg]": document["bank_without_radial_friction_deg"],
    }
    return tables.frame({"quantity": list(rows), "value": [shown_value(value) for value in rows.values()]})


def _opening(document):
    """Which contact a growing drive opens first, and when; or which carries nothing even at rest."""
    contact, factor = document["first_to_open"], document["opens_at_drive_factor"]
    if factor == 0.0:
        return {"carries nothing even at rest": contact.replace("_", " ")}
    return {"first contact to open": contact, "opens at this many times the drive": factor}


def remarks(found):
    """Return what a reader of a TrackStudy should know, a sentence each."""
    lines, cycle = chosen(found), found.cycle
    if len(found.seat.contact) == 0:
        lines.append("a part card has no contact polygon: whether it tips is not known")
    if found.held_across:
        lines.append(HELD_ACROSS)
    if HOP in cycle.state:
        lines.append(
            "the part loses contact within the cycle: its flight is not followed here, but by feeder convey; "
            "whether it stays against the wall is not known"
        )
    elif not cycle.closed.all():
        share = 100.0 * np.mean(~cycle.closed.all(axis=-1))
        lines.append(f"a wall contact is open for {share:.0f} % of the cycle: {_which(cycle.closed)}")
        if found.posture.kind != "rolling" and np.abs(cycle.turning).max() > TURNS:
            lines.append(TURNED_OFF)
    if found.posture.kind == "rolling":
        lines.append("rolling aspect: held by the wall, its rolling about the axis is not followed")
    turn = np.degrees(found.seat.twist(found.bowl.track.bank))
    if abs(turn) > TURNED:
        lines.append(
            f"the wall contacts lie at different heights: banked, the part turns by about {turn:.2g} deg more"
        )
    if found.headings is not None and found.headings.overhangs[found.row] > 0.0:
        lines.append(
            f"the part overhangs the track's edge by {found.headings.overhangs[found.row] / MM:.3g} mm"
        )
    return lines


def opened(closed):
    """Return names of the wall contacts that have opened."""
    return [name for name, shut in zip(CONTACTS[1:], closed) if not shut]


def _which(closed):
    names = [name.replace("_", " ") for name, shut in zip(CONTACTS[1:], closed.T) if not shut.all()]
    return " and ".join(names)


def _contacts(found):
    """Place of each wall contact from the foot of the centre of mass, and sigma."""
    places = found.seat.walls + np.array([0.0, 0.0, found.seat.height])
    sigma = np.degrees(np.arcsin(-found.seat.walls[:, 0] / found.bowl.track.radius))
    return [
        {"name": name, "place_mm": place / MM, "sigma_deg": float(angle)}
        for name, place, angle in zip(CONTACTS[1:], places, sigma)
    ]


def _axis(opening):
    return {
        "point_mm": opening.point / MM,
        "direction": opening.direction,
        "pitch_mm": opening.pitch / MM,
    }
