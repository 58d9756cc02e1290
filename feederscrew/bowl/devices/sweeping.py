"""Blades that bend along the track: the curved deflector."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base import value_forms as forms
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError
from feederscrew.base.heavy import heavy
from feederscrew.bowl.devices import air_assist, values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import (
    RETURNED,
    Verdict,
    angle_text,
    degrees_words,
    length_text,
    mapping_text,
    room_of,
    tall_of,
)
from feederscrew.bowl.devices.blades import SQUARE_FACE_RAD, SweptBlade
from feederscrew.bowl.devices.features import BLADE, Blade, Features
from feederscrew.bowl.devices.trade import IS_ANGLE, Trade
from feederscrew.bowl.devices.values import DeviceFields

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

optimize = heavy("scipy.optimize")
shapely = heavy("shapely")

DEFLECTOR_BEGIN_RAD = math.radians(12.0)  # [rad] at the wall, as tried
DEFLECTOR_END_RAD = math.radians(50.0)  # [rad] at the free edge, as tried
TRIED_SIZES = 400  # of a piece, up to where the first alone would reach the free edge of a straight track
DEFLECTOR_BEND_RAD = math.radians(7.0)  # [rad] between two flat pieces at most


@dataclass(frozen=True)
class CurvedDeflector(SweptBlade):
    """A blade over the track that bends from along the track at the wall to across it at the free edge."""

    begin: float = field(default=DEFLECTOR_BEGIN_RAD, metadata=IS_ANGLE)  # [rad] of its face at the wall ...
    end: float = field(default=DEFLECTOR_END_RAD, metadata=IS_ANGLE)  # [rad] ... and at the free edge

    kind = "curved deflector"
    trade = Trade(
        "{clearance: 11.5 mm, from: 12 deg, to: 50 deg}",
        "blade at a clearance over the track, bent from one angle to the direction of travel at the wall to "
        "a larger one at the free edge: sweeps higher orientations off, also those that roll and stop at a "
        "straight wiper; air: {nozzle: 2 mm, pressure: 0.3 bar, height: 14 mm} may follow, as of a wiper",
        forms.mapping(
            ("air",),
            **{"clearance": forms.LENGTH_FORM, "from_": forms.ANGLE_FORM, "to": forms.ANGLE_FORM},
            air=air_assist.FORM,
        ),
        measures="height",
    )

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
        mend = "write {clearance: 11.5 mm, from: 12 deg, to: 50 deg}"
        own = values.mapping(entry, ("clearance", "from", "to", "air"), mend, ("air",))
        low, high = math.radians(1.0), math.radians(89.0)
        begin, end = (values.within(own, name, "angle", low, high) for name in ("from", "to"))
        if end <= begin:
            what = "the face of curved deflector bends back towards the track"
            raise ConfigError(entry.value.where, what, "give an angle to that is larger than from")
        clearance = values.within(own, "clearance", "length", 1e-9, values.MAX_LENGTH_M)
        air = {"air": air_assist.read(own["air"])} if "air" in own else {}
        return {"limit": clearance, "begin": begin, "end": end} | air

    def value_text(self) -> str:
        ends = ("from", angle_text(self.begin)), ("to", angle_text(self.end))
        air = "" if self.air is None else self.air.text
        return mapping_text((("clearance", length_text(self.limit)), *ends, ("air", air)))

    @property
    def value_words(self) -> str:
        bend = f"bent from {degrees_words(self.begin)} to {degrees_words(self.end)}"
        return f"{super().value_words}, {bend}{self._air_words}"

    def document_values(self) -> Document:
        ends = {"from_deg": math.degrees(self.begin), "to_deg": math.degrees(self.end)}
        return super().document_values() | ends

    @property
    def headings(self) -> list[float]:
        """Angles [rad] of its flat pieces to the direction of travel, from the wall on."""
        pieces = max(math.ceil((self.end - self.begin) / DEFLECTOR_BEND_RAD - 1e-9), 1)
        step = (self.end - self.begin) / pieces
        return [self.begin + (k + 0.5) * step for k in range(pieces)]

    @property
    def face(self) -> tuple[float, float | None] | None:
        """The sweep [rad] of its last piece, at which parts are slowest, and no friction of its own."""
        return self.headings[-1], None

    def fate(self, encounter: Encounter) -> str:
        """Return what becomes of what it holds up: RETURNED where its last piece still sweeps it on.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        DeviceFate
        """
        if encounter.hanging:
            return super().fate(encounter)
        last, friction = self.headings[-1], encounter.grip
        clears = last < SQUARE_FACE_RAD - math.atan(friction)
        if not clears and self.air is not None:
            clears = self.air.clears(encounter, last, friction, self.limit)
        return RETURNED if clears else super().fate(encounter)

    def judged(self, encounter: Encounter, sweep: float = 0.0) -> Verdict:
        """Return the verdict of its height; not sure where one of its pieces may lay the part over.

        Parameters
        ----------
        encounter : Encounter
        sweep : float, optional
            Not used: it has many.

        Returns
        -------
        Verdict
        """
        verdicts = [super(CurvedDeflector, self).judged(encounter, sweep) for sweep in self.headings]
        return max(verdicts, key=lambda outcome: outcome.margin)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        room, tall = room_of(orientations), tall_of(orientations, self.limit)
        size = self._size(track)
        *feet, end = self._feet(size, track.radius)
        blades: list[Blade] = []
        for (along, off), heading in zip(feet, self.headings):
            # each goes on behind the face of the one before it, so that they are one plate
            face = shapely.box(-BLADE if blades else 0.0, self.limit, size, tall)
            blades.append(Blade(face, (0.5 * room + along, off), heading))
        return Features(0.5 * room + end[0], blades=tuple(blades), jets=self._jets(0.5 * room, track))

    def chord(self, track: "Track") -> float:
        along, off = self._feet(self._size(track), track.radius)[-1]
        turn, left = along / track.radius, track.radius - off
        return math.atan2(track.radius - left * math.cos(turn), left * math.sin(turn))

    def _size(self, track: "Track") -> float:
        """The length [m] of each of its flat pieces.

        Pieces of an arc are alike: so long that the last one ends at the free edge.
        """
        sizes = np.linspace(0.0, track.extent / math.sin(self.begin), TRIED_SIZES)[1:].tolist()
        far = next((size for size in sizes if self._beyond(size, track) >= 0.0), None)
        if far is None:
            what = f"its face from {degrees_words(self.begin)} on meets the wall before the free edge"
            raise ConfigError(self.where, what, "give a larger angle from, or a larger bowl")
        return float(optimize.brentq(self._beyond, 0.0, far, (track,)))

    def _beyond(self, size: float, track: "Track") -> float:
        """How far [m] beyond the free edge its last piece ends, of pieces of a size [m]."""
        return self._feet(size, track.radius)[-1][1] - track.extent

    def _feet(self, size: float, radius: float) -> list[tuple[float, float]]:
        """Where its flat pieces of a size [m] begin and the last one ends: along the wall [m], and off it."""
        feet = [(0.0, 0.0)]
        for heading in self.headings:
            along, off = feet[-1]
            x, y = size * math.cos(heading), off + size * math.sin(heading)
            # each is flat, its heading that to the wall where it begins
            feet.append((along + radius * math.atan2(x, radius - y), radius - math.hypot(x, radius - y)))
        return feet
