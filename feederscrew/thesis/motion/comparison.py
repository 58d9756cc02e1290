"""Printed against complete equations: each quantity side by side, with the terms the print leaves out."""

from dataclasses import dataclass

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.mechanics.track.frame import frame

FLOOR_TERMS = {  # quantity: what parts the printed from the complete value
    "normal_force_N": "none",
    "alignment_acceleration_rad_s2": "static friction, which holds a part at rest against turning",
    "limiting_friction": "the factor cos(alpha - theta): it needs a wall to take the force across",
    "acceleration_z_m_s2": "friction as a vector against the sliding: R_z = mu N cos(alpha - theta)",
    "acceleration_y_m_s2": "friction as a vector against the sliding: R_y",
    "normal_line_offset_mm": "inertia acts at the centre of mass, not in the contact plane at e [4.18]",
}
TRACK_TERMS = {
    "normal_force_N": "none of its own: it follows R1 + R2",
    "wall_1_N": "radial gravity [4.33]; moment of the drive about X [4.35]; centripetal m V^2/r",
    "wall_2_N": "radial gravity [4.33]; moment of the drive about X [4.35]; centripetal m V^2/r",
    "radial_friction_N": "d_y, offset of the normal force across the track, takes the moment about X",
    "traction_N": "friction as a vector where the part leaves the wall; else follows N",
    "normal_line_offset_mm": "inertia at the centre of mass; moment of wall friction about Y [4.36]",
    "acceleration_x_m_s2": "wall friction along the wall's tangent, turned by sigma",
}


@dataclass(frozen=True)
class Term:
    """A term that the printed track equations leave out."""

    name: str
    equation: str  # of the thesis
    value: float
    unit: str  # 'N' or 'N mm'


def omitted_terms(seat, bowl, found, offset):
    """Return the size of every omitted term on the track, at the upper reversal.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
        Single values.
    found : TrackMotion
        The complete solution at the upper reversal.
    offset : float [m]
        e, the lever at which the print applies the drive.

    Returns
    -------
    tuple of Term
        The centripetal force is that of the bowl's own greatest speed, at mid-stroke.
    """
    axes = frame(bowl, seat.walls)
    track, drive = bowl.track, bowl.drive
    speed = drive.amplitude * 2.0 * np.pi * drive.frequency * float(axes.drive[0])
    push = seat.mass * drive.amplitude * (2.0 * np.pi * drive.frequency) ** 2 * axes.drive
    sine = -seat.walls[:, 0] / track.radius
    dragged = found.wall_friction
    height = float(vectors.dot(axes.up, seat.walls.mean(axis=0)))
    weight = seat.mass * bowl.gravity
    less = 1.0 - np.sqrt(1.0 - sine**2)  # of a force turned by sigma
    drive_lever = seat.height * push[0] + offset * push[2]
    radial = -weight * np.cos(track.climb) * np.sin(track.bank)
    return (
        Term("radial gravity, -m g cos(phi) sin(delta)", "4.33", float(radial), "N"),
        Term("centripetal force at mid-stroke", "4.33, 4.58", seat.mass * speed**2 / track.radius, "N"),
        Term("wall friction turned by sigma, along X", "4.32, 4.57", float(vectors.dot(dragged, less)), "N"),
        Term("wall friction turned by sigma, along Y", "4.33, 4.58", float(vectors.dot(dragged, sine)), "N"),
        Term("moment of wall friction about Y", "4.36, 4.61", 1e3 * height * float(dragged.sum()), "N mm"),
        Term("moment of the drive about X", "4.35, 4.60", _about_x(seat, axes, push), "N mm"),
        Term("drive at the contact plane, about Y", "4.36, 4.61", 1e3 * float(drive_lever), "N mm"),
    )


def _about_x(seat, axes, push):
    return -1e3 * seat.height * float(vectors.dot(push, axes.radial))
