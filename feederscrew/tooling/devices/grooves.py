"""A groove: a stretch of the track that is a V, in which what is round lies along it and rolls no more."""

import math
from dataclasses import dataclass, replace

from feederscrew import value_forms as forms
from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import angle_text, degrees_words, mapping_text, room_of
from feederscrew.tooling.devices.leans import LEAST, Bank, Lean
from feederscrew.tooling.devices.pieces import Slope, Standing

FLATTEST, STEEPEST_FACE_RAD = math.radians(10.0), math.radians(60.0)  # [rad]
HOLDS = 30.0  # [deg] of a groove's faces
# [deg] that a design tries beside that: the steepest first, in which what turns has farther to fall
ANGLES = (55.0, 45.0, 30.0, 15.0)
GROOVE_ROOMS = 3.0  # rooms of a part in which what comes across turns along it


@dataclass(frozen=True)
class Groove(Lean):
    """A V from here on, until a bank: the track leans towards its wall, and the wall back by as much."""

    kind = "groove"
    trade = "V groove"
    serves = "lets lie along it what is round"
    form = forms.mapping(angle=forms.ANGLE_FORM)
    example = "{angle: 30 deg}"
    meaning = (
        "the track is a V from here on, until a bank: it and its wall rise by so much to either side; round "
        "parts lie along it and roll no more, on a friction that acts as mu / cos(angle)"
    )
    hanging = False
    leans = True
    grooved = True
    layer = "SLOPE"

    @classmethod
    def read(cls, entry):
        given = values.mapping(entry, ("angle",), "write {angle: 30 deg}")
        return {"angle": values.within(given, "angle", "angle", FLATTEST, STEEPEST_FACE_RAD)}

    def value_text(self):
        return mapping_text((("angle", angle_text(self.angle)),))

    @property
    def value_words(self):
        return f"both faces rise at {degrees_words(self.angle)}"

    @classmethod
    def of(cls, degrees, where):
        """Return a groove of so many degrees, and the low bank that ends it."""
        groove = cls(where, angle=math.radians(degrees))
        return groove.rewritten(), Bank.of(LEAST, where)

    @classmethod
    def holding(cls, one, wall_friction, where):
        return cls.of(HOLDS, where) if one.rolls_along else ()

    @classmethod
    def leanings(cls, one, where):
        return [cls.of(angle, where) for angle in ANGLES] if one.kind == "rolling" and one.rolls_along else []

    def onward(self, one):
        """Return an orientation as it goes on: both faces hold what lies along them."""
        track, rolls = replace(one.track, bank=self.angle), one.may_roll_back and not one.rolls_along
        return replace(one, track=track, groove=self.angle, may_roll_back=rolls)

    def judged(self, met):
        """Return what it does: it passes what lies in it as it came, and turns the rest."""
        return met.laid_in_groove(self.angle)

    def standing(self, track, every):
        slope = Slope(0.0, bank=self.angle, wall=0.5 * math.pi - self.angle)
        return Standing(GROOVE_ROOMS * room_of(every), slopes=(slope,))
