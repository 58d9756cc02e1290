"""Air assist: a steady nozzle in the wall at a blade's foot, which blows along the blade's face.

Axes: x along the wall with the travel, y from the wall to the free edge, z up. The blade's face begins at the
wall, its foot, and makes an angle a with x, above 0 and below 90 deg; parts come from -x. The nozzle is in
the wall there. Its jet widens by 11 deg to either side (``SPREAD``), and is aimed so that its side runs along
the face: no ray meets the blade. It pushes a part that the blade holds up along the face, over the free edge.

Source: the thrust and the jet of `pneumatics`, Coulomb's friction; docs/tooling.md, "Air assist".
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from feederscrew.base import value_forms as forms
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.units import MM
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import UNSURE, length_text, length_words, mapping_text
from feederscrew.bowl.devices.features import Jet
from feederscrew.bowl.devices.pneumatics import (
    BAR_PA,
    JET_REACH_M,
    NOZZLE_KEYS,
    SPREAD,
    SURE_FORCE_RATIO,
    shares_taken,
    thrust,
)

FORM = forms.mapping(
    nozzle=forms.LENGTH_FORM, pressure=forms.quantity("pressure"), height=forms.LENGTH_FORM
)  # of its value in a bowl file
EXAMPLE = "{nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm}"
ASIDE_RAD = math.atan(SPREAD)  # [rad] between the jet's axis and the face
FACE_PLACES = 7  # along the face, at which the force on a part that stands there is taken
PASSING_PLACES = 13  # along the track, at which that on a part that passes below the blade is taken


class FaceForce(NamedTuple):
    """Force of the air on a part [N]."""

    along: float  # along the face, positive towards the free edge
    off: float  # square to the face, positive away from it
    down: float  # positive onto the track


class AirAssist(NamedTuple):
    """Nozzle in the wall at a blade's foot that blows all the time along the face."""

    nozzle: float  # [m]
    pressure: float  # [Pa] above the ambient
    height: float  # [m] of the nozzle over the track

    @property
    def thrust(self) -> float:
        """Thrust [N] of the nozzle."""
        return thrust(self.nozzle, self.pressure)

    @property
    def text(self) -> str:
        """Its value as a bowl file has it."""
        pairs = ("nozzle", length_text(self.nozzle)), ("pressure", f"{self.pressure / BAR_PA:.9g} bar")
        return mapping_text((*pairs, ("height", length_text(self.height))))

    @property
    def words(self) -> str:
        """Its value for people."""
        bore, high = length_words(self.nozzle), length_words(self.height)
        return f"air along the face from a nozzle of {bore} at {self.pressure / BAR_PA:.4g} bar, {high} up"

    @property
    def shop_words(self) -> str:
        """What a shop buys and sets."""
        bore, bar = length_words(self.nozzle), f"{self.pressure / BAR_PA:.4g} bar"
        return f"1 nozzle of {bore} in the wall at the blade, blows along its face: regulator {bar}"

    def document_values(self) -> Document:
        """Return its values for a document: in mm, bar and N."""
        return {
            "nozzle_mm": self.nozzle / MM,
            "pressure_bar": self.pressure / BAR_PA,
            "nozzle_height_mm": self.height / MM,
            "thrust_N": self.thrust,
        }

    def jet(self, foot: float, heading: float) -> Jet:
        """Return its jet at a blade: the jet's side begins at the blade's foot and runs along its face.

        Parameters
        ----------
        foot : float [m]
            Along the wall, where the face begins.
        heading : float [rad]
            Of the face to the direction of travel.

        Returns
        -------
        Jet
        """
        aim, (x, y) = heading + ASIDE_RAD, self._mouth(heading)
        mouth = (foot + x, y, self.height)
        towards = (math.cos(aim), math.sin(aim), 0.0)
        return Jet(mouth, towards, 0.5 * self.nozzle, SPREAD, self.thrust, JET_REACH_M)

    def _mouth(self, heading: float) -> tuple[float, float]:
        """Middle of its mouth from the face's foot, x and y [m]: set back until its rim is flush."""
        aim, radius = heading + ASIDE_RAD, 0.5 * self.nozzle
        setback = radius * abs(math.cos(aim)) / math.sin(aim)  # along its axis
        before = (radius * math.cos(ASIDE_RAD) + setback * math.sin(ASIDE_RAD)) / math.sin(heading)
        return -before - setback * math.cos(aim), -setback * math.sin(aim)

    def forces(self, orientation: LyingPart, heading: float, places: Sequence[tuple[float, float]]) -> Floats:
        """Return the forces on an orientation with its centre of mass at places beside a face.

        Each of the jet's rays gives the first facet that it meets what of its momentum is square to that
        facet: ``pneumatics.shares_taken``.

        Parameters
        ----------
        orientation : LyingPart
        heading : float [rad]
            Of the face to the direction of travel.
        places : sequence of (float, float) [m]
            Of the centre of mass from the face's foot: x and y.

        Returns
        -------
        (N, 3) float [N]
            Rows as ``FaceForce``.
        """
        aim, cos_aside, sin_aside = heading + ASIDE_RAD, math.cos(ASIDE_RAD), math.sin(ASIDE_RAD)
        turn = 0.5 * math.pi - aim  # into axes in which the jet blows along y
        mouth = self._mouth(heading)
        rows = []
        for x, y in places:
            place = turned(np.array([[x - mouth[0], y - mouth[1]]]), turn)[0]
            share = shares_taken(
                orientation.posture,
                orientation.heading + turn,
                (float(place[0]), float(place[1])),
                self.nozzle,
                self.height,
            )
            out, down, right = share
            along, off = out * cos_aside + right * sin_aside, out * sin_aside - right * cos_aside
            rows.append((along, off, down))
        return self.thrust * np.array(rows).reshape(-1, 3)

    def at_face(self, orientation: LyingPart, heading: float, clearance: float) -> list[FaceForce]:
        """Return the forces on an orientation that stands at a blade, from the wall to the free edge.

        It comes along the wall, as it lies, until a corner of it above the blade's edge meets the face.

        Parameters
        ----------
        orientation : LyingPart
        heading : float [rad]
            Of the face to the direction of travel.
        clearance : float [m]
            Of the blade's edge over the track.

        Returns
        -------
        list of FaceForce
            At ``FACE_PLACES`` along the face; empty where no corner of it is above the edge.
        """
        surface, c, s = orientation.posture.surface, math.cos(heading), math.sin(heading)
        high = turned(surface[surface[:, 2] > clearance, :2], orientation.heading)
        if not len(high):
            return []
        distance, least = orientation.distance, float((c * high[:, 1] - s * high[:, 0]).min())
        ahead, way = (c * distance + least) / s, max(orientation.track.width - distance, 0.0) / s
        steps = way * np.linspace(0.0, 1.0, FACE_PLACES)
        places = [(ahead + c * step, distance + s * step) for step in steps.tolist()]
        return [FaceForce(*row) for row in self.forces(orientation, heading, places).tolist()]

    def clears(self, encounter: Encounter, heading: float, friction: float, clearance: float) -> bool:
        """Tell whether an orientation that stands at a blade surely slides along its face with this air.

        The track drags a part that stands by D = mu N along the wall at most. N is its weight and what the
        air presses it down by, 0 where that lifts it off. The face at the angle a pushes back with
        R = D sin a - Fn and holds with mu_f R at most. F and Fn are the air's force along the face and off
        it. So the part slides where

            F > mu_f max(D sin a - Fn, 0) - D cos a.

        Where the air does not press it onto the face, the right side is 0 or less below a = 90 deg -
        atan(mu_f): then no air is needed. Sure is twice the right side, or 0 where that is negative, at each
        of ``FACE_PLACES`` with the air's other forces as they are. It covers sliding only: a part that turns
        or rolls at the face, leans on it or has tipped into a slot needs a trial.

        Parameters
        ----------
        encounter : Encounter
        heading : float [rad]
            a, of the face to the direction of travel.
        friction : float [1]
            mu_f, of the face.
        clearance : float [m]
            Of the blade's edge over the track.

        Returns
        -------
        bool
            False of one that the blade does not meet.

        References
        ----------
        Coulomb's friction; docs/tooling.md, "Air assist".
        """
        orientation, c, s = encounter.orientation, math.cos(heading), math.sin(heading)
        forces = self.at_face(orientation, heading, clearance)
        weight = orientation.posture.mass * orientation.gravity

        def needed(force: FaceForce) -> float:
            drag = encounter.grip * max(weight + force.down, 0.0)
            return friction * max(drag * s - force.off, 0.0) - drag * c

        return bool(forces) and all(
            force.along >= SURE_FORCE_RATIO * max(needed(force), 0.0) for force in forces
        )

    def least_at_face(self, orientation: LyingPart, heading: float, clearance: float) -> FaceForce:
        """Return the force on an orientation that stands at a blade, where it is least along the face.

        Parameters
        ----------
        orientation : LyingPart
        heading : float [rad]
            Of the face to the direction of travel.
        clearance : float [m]
            Of the blade's edge over the track.

        Returns
        -------
        FaceForce
            0 N on one that is not as high.
        """
        forces = self.at_face(orientation, heading, clearance)
        return min(forces, key=lambda force: force.along, default=FaceForce(0.0, 0.0, 0.0))

    def passing_margin(self, encounter: Encounter, heading: float, margin: float) -> float:
        """Return the margin of an orientation that passes below the blade, with the air on it.

        A lying part stays where the greatest force on it towards the free edge is half of what just takes it
        off, or less, and is blown off where the mean one is twice that, as at an ``air jet``. In between
        nothing is sure: 0, or barely below it. A part that hangs in rails stays where the air's force is half
        of the friction that holds it, mu m g, or less; else its margin is 0. What the air does to the time
        that a part takes is left out.

        Parameters
        ----------
        encounter : Encounter
        heading : float [rad]
            Of the face to the direction of travel.
        margin : float [m]
            Without air, 0 or more.

        Returns
        -------
        float [m]
        """
        orientation, width = encounter.orientation, encounter.orientation.track.width
        first, last = orientation.outline[:, 0].min(), orientation.outline[:, 0].max()
        begin, end = self._mouth(heading)[0] - last, width / math.tan(heading) - first
        steps = begin + (np.arange(PASSING_PLACES) + 0.5) / PASSING_PLACES * (end - begin)
        forces = self.forces(orientation, heading, [(step, orientation.distance) for step in steps.tolist()])
        c, s = math.cos(heading), math.sin(heading)
        off_wall = s * forces[:, 0] + c * forces[:, 1] - encounter.grip * np.maximum(forces[:, 2], 0.0)
        if encounter.hanging:
            size = np.hypot(forces[:, 0], forces[:, 1]).max()
            holds = encounter.grip * orientation.posture.mass * orientation.gravity
            return margin if SURE_FORCE_RATIO * size <= holds else min(margin, 0.0)
        force = encounter.force_to_clear(end - begin, self.height)
        mean, most = float(off_wall.mean()) / force, float(off_wall.max()) / force
        distance = width - orientation.distance
        if most <= 1.0 / SURE_FORCE_RATIO:
            return min(margin, distance * (1.0 - most))
        if mean >= SURE_FORCE_RATIO:
            return -distance
        return 0.0 if mean < 1.0 else -UNSURE


def read(entry: Entry) -> AirAssist:
    """Read {nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm}.

    Parameters
    ----------
    entry : Entry
        'air: value'.

    Returns
    -------
    AirAssist

    Raises
    ------
    ConfigError
        If a key is unknown or missing, or a value out of range.
    """
    return AirAssist(**values.nozzle(entry, needed=NOZZLE_KEYS))
