"""Stretches of the track that lean otherwise: bank, spacing on a steeper way, V of a groove, and twist."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar, Self

from feederscrew.base import value_forms as forms
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, Lying, LyingPart
from feederscrew.bowl.devices.base import (
    MM,
    Device,
    Verdict,
    angle_text,
    degrees_words,
    length_text,
    length_words,
    mapping_text,
    room_of,
)
from feederscrew.bowl.devices.features import Features, Slope
from feederscrew.bowl.devices.trade import IS_ANGLE, Action, Trade
from feederscrew.bowl.devices.values import DeviceFields

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

MAX_BANK_RAD = math.radians(45.0)
# [deg] of a bank that holds what rolls: the least, the greatest, and beyond the angle that just holds
LEAST = 6.0
MOST = 15.0
MORE = 1.0
PROPOSED_BANKS_DEG = (6.0, 10.0, 15.0)  # [deg] that a design tries
PARTING = -6.0  # [deg] climb of a stretch that separates parts
HOLDS = 30.0  # [deg] of a groove's faces
# [deg] that a design tries beside that: the steepest first, in which what turns has farther to fall
ANGLES = (55.0, 45.0, 30.0, 15.0)
GROOVE_ROOMS = 3.0  # rooms of a part in which what comes across turns along it
TWIST_SETTLES = 1.0  # of the part's size: how far behind a twist parts go on until they are looked at
MIN_TWIST_M, MAX_TWIST_M = 0.02, 1.0  # [m] of a twist along the wall


@dataclass(frozen=True)
class Lean(Device):
    """A stretch of the track that leans otherwise by an angle."""

    angle: float = field(default=0.0, metadata=IS_ANGLE)  # [rad]

    key: ClassVar[str] = ""  # of the angle in a mapping; '': it is written alone
    limits: ClassVar[tuple[float, float]] = (0.0, MAX_BANK_RAD)  # [rad] of the angle

    @classmethod
    def read(cls, entry: Entry) -> DeviceFields:
        name, arguments = entry.key, {entry.key: entry}
        if cls.key:
            name, arguments = cls.key, values.mapping(entry, (cls.key,), f"write {cls.trade.example}")
        return {"angle": values.within(arguments, name, "angle", *cls.limits)}

    def value_text(self) -> str:
        return mapping_text(((self.key, angle_text(self.angle)),)) if self.key else angle_text(self.angle)

    @classmethod
    def of(cls, degrees: float, where: str) -> Self:
        """Return the stretch at an angle.

        Parameters
        ----------
        degrees : float [deg]
        where : str
            What asks for it.

        Returns
        -------
        Lean
            Of this kind.
        """
        return cls(where, angle=math.radians(degrees)).rewritten()

    @classmethod
    def holding(cls, orientation: LyingPart, wall_friction: float, where: str) -> "tuple[Lean, ...]":
        """Return the devices, in order, that hold what rolls on the level.

        Parameters
        ----------
        orientation : LyingPart
        wall_friction : float [1]
        where : str
            What asks for them.

        Returns
        -------
        tuple of Lean
            Empty where they cannot.
        """
        return ()

    @classmethod
    def leanings(cls, orientation: LyingPart, where: str) -> "list[tuple[Lean, ...]]":
        """Return other ways to lean the track for an orientation.

        Parameters
        ----------
        orientation : LyingPart
        where : str
            What asks for them.

        Returns
        -------
        list of tuple of Lean
            Devices in order each.
        """
        return []

    @classmethod
    def parting(cls, where: str) -> "Lean | None":
        """Return the stretch of track on which parts come apart.

        Parameters
        ----------
        where : str
            What asks for it.

        Returns
        -------
        Lean or None
            None of a kind that is not for that.
        """
        return None

    @property
    def label(self) -> str:
        return f"{self.kind} {self.text}"

    def document_values(self) -> Document:
        return {"angle_deg": math.degrees(self.angle)}


@dataclass(frozen=True)
class VGroove(Lean):
    """A V from here on, until a bank: the track leans towards its wall, and the wall back by as much."""

    kind = "V groove"
    trade = Trade(
        "{angle: 30 deg}",
        "the track is a V from here on, until a bank: it and its wall rise by so much to either side; round "
        "parts lie along it and roll no more, on a friction that acts as mu / cos(angle)",
        forms.mapping(angle=forms.ANGLE_FORM),
        old_name="groove",
        serves="lets lie along it what is round",
    )
    action = Action.GROOVE
    key, limits = "angle", (math.radians(10.0), math.radians(60.0))

    @property
    def value_words(self) -> str:
        return f"both faces rise at {degrees_words(self.angle)}"

    @classmethod
    def holding(cls, orientation: LyingPart, wall_friction: float, where: str) -> "tuple[Lean, ...]":
        return (cls.of(HOLDS, where), BankedTrack.of(LEAST, where)) if orientation.rolls_along else ()

    @classmethod
    def leanings(cls, orientation: LyingPart, where: str) -> "list[tuple[Lean, ...]]":
        along = orientation.kind == "rolling" and orientation.rolls_along
        return [(cls.of(angle, where), BankedTrack.of(LEAST, where)) for angle in ANGLES] if along else []

    def onward(self, orientation: Lying) -> Lying:
        track = replace(orientation.track, bank=self.angle)
        rolls = orientation.may_roll_back and not orientation.rolls_along
        return orientation.on_track(track, groove=self.angle, may_roll_back=rolls)

    def judged(self, encounter: Encounter) -> Verdict:
        return encounter.laid_in_groove(self.angle)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        slope = Slope(0.0, bank=self.angle, wall=0.5 * math.pi - self.angle)
        length = GROOVE_ROOMS * room_of(orientations)
        return Features(length, slopes=(slope,))


@dataclass(frozen=True)
class TwistedTrack(Lean):
    """A twist at the end of the track: its floor stands up as a wall, and its wall lies down as the floor."""

    length: float = 0.0  # [m] along the wall

    kind = "twisted track"
    trade = Trade(
        "{angle: 80 deg, length: 120 mm}",
        "the track twists by so much over that length, with its wall, and stays so to the outlet: the floor "
        "stands up as a wall at the inner side, the wall lies down as the floor, and parts go on on the side "
        "that was at the wall; listed last",
        forms.mapping(angle=forms.ANGLE_FORM, length=forms.LENGTH_FORM),
        serves="stands parts on the side that was at the wall",
    )
    action = Action.TWIST
    key, limits = "angle", (math.radians(65.0), math.radians(80.0))

    @classmethod
    def read(cls, entry: Entry) -> DeviceFields:
        arguments = values.mapping(entry, ("angle", "length"), f"write {cls.trade.example}")
        return {
            "angle": values.within(arguments, "angle", "angle", *cls.limits),
            "length": values.within(arguments, "length", "length", MIN_TWIST_M, MAX_TWIST_M),
        }

    def value_text(self) -> str:
        return mapping_text((("angle", angle_text(self.angle)), ("length", length_text(self.length))))

    def document_values(self) -> Document:
        return super().document_values() | {"length_mm": self.length / MM}

    @property
    def value_words(self) -> str:
        return f"by {degrees_words(self.angle)} over {length_words(self.length)}"

    @property
    def on_side(self) -> float:
        return self.angle

    def onward(self, orientation: Lying) -> Lying:
        # the wall that the floor has become holds it: what would tip on the level does not
        held = orientation.on_track(orientation.track, falls_off=False, turns_over=False, may_tip=False)
        return held.against_inner_wall()

    def judged(self, encounter: Encounter) -> Verdict:
        return encounter.stood_on_side(self.angle)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        slope = Slope(0.0, bank=self.angle, wall=self.angle, length=self.length)
        return Features(self.length, slopes=(slope,), settles=TWIST_SETTLES)


@dataclass(frozen=True)
class BankedTrack(Lean):
    """Another bank from here on."""

    kind = "banked track"
    trade = Trade(
        "6 deg",
        "the track is banked towards the wall by so much from here on; listed first, from the track's entry: "
        "parts on their round side are then held at the wall where friction.wall tan(bank) > tan(climb)",
        forms.ANGLE_FORM,
        old_name="bank",
        serves="holds what rolls at the wall",
    )
    action = Action.BANK

    @property
    def value_words(self) -> str:
        return f"{degrees_words(self.angle)} towards the wall"

    @classmethod
    def holding(cls, orientation: LyingPart, wall_friction: float, where: str) -> "tuple[Lean, ...]":
        steep = math.degrees(math.atan2(math.tan(max(orientation.track.climb, 0.0)), max(wall_friction, 0.0)))
        bank = max(LEAST, math.ceil(steep + MORE))
        return (cls.of(bank, where),) if wall_friction > 0.0 and bank <= MOST else ()

    @classmethod
    def leanings(cls, orientation: LyingPart, where: str) -> "list[tuple[Lean, ...]]":
        return [(cls.of(bank, where),) for bank in PROPOSED_BANKS_DEG]

    def onward(self, orientation: Lying) -> Lying:
        track = replace(orientation.track, bank=self.angle)
        held = math.tan(track.climb) <= orientation.wall_grip * math.tan(self.angle)
        rolls = orientation.may_roll_back and not held
        return orientation.on_track(track, groove=0.0, may_roll_back=rolls)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        return Features(0.5 * room_of(orientations), slopes=(Slope(0.0, bank=self.angle, wall=0.0),))


@dataclass(frozen=True)
class SpacingSection(Lean):
    """A steeper way down from here on, on which parts travel faster and so come apart."""

    kind = "spacing section"
    trade = Trade(
        "{climb: -4 deg}",
        "the track climbs by so much from here on, below 0 it goes down: parts travel faster and come apart, "
        "as a vision reject needs",
        forms.mapping(climb=forms.ANGLE_FORM),
        old_name="separation",
    )
    action = Action.CLIMB
    key, limits = "climb", (-MAX_BANK_RAD, MAX_BANK_RAD)

    @classmethod
    def parting(cls, where: str) -> Lean:
        return cls.of(PARTING, where)

    @property
    def value_words(self) -> str:
        return f"{'goes down' if self.angle < 0.0 else 'climbs'} at {degrees_words(abs(self.angle))}"

    @property
    def serves(self) -> str:
        """Return what it is for: on the way down parts come apart, on the way up rails begin."""
        return "makes the gaps a vision reject needs" if self.angle < 0.0 else "climbs again, as rails need"

    def onward(self, orientation: Lying) -> Lying:
        return orientation.on_track(replace(orientation.track, climb=self.angle))

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        return Features(room_of(orientations), slopes=(Slope(0.0, climb=self.angle),))
