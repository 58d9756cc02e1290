"""Edges along the track: step and tip turn parts over; narrowed track, canyon, slot; rails to hang on."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np

from feederscrew.base import value_forms as forms
from feederscrew.base.arrays import Points
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, HangingPart, LyingPart
from feederscrew.bowl.devices.base import (
    MM,
    UNSURE,
    Device,
    Verdict,
    carried,
    length_text,
    mapping_text,
    room_of,
    size_of,
    span_words,
)
from feederscrew.bowl.devices.features import Drop, Features, TrackOpening, box_ring
from feederscrew.bowl.devices.trade import Action, Bound, ProposedBy, Trade, ValueSearch

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

LOWER = 0.5  # of the part's greatest length: how far below a ledge the second track lies
LEDGE_RAMP_RAD = math.radians(15.0)  # [rad] least slope on which a ledge comes down to the track beside it
LONGEST_RAMP_SHARE = 0.7  # of the radius at the ledge's edge: so far ahead a ramp reaches at most
LOWER_TRACK_LENGTHS = 10.0  # of the part's size: how far the lower track goes on
SETTLES = 2.0  # of the part's size: how far behind a turning device parts end
SHOP_STEP_M = 5e-5  # [m] of which a value that is proposed is a whole multiple
DISTANCE = "distance from the wall to the centre of mass"
MAX_LEAD_IN_M = 1.0  # [m] of a lead-in
RAIL_SPAN_FORMS = {"from_": forms.LENGTH_FORM, "to": forms.LENGTH_FORM}
LEAD_IN_FORMS = {"length": forms.LENGTH_FORM, "taper": forms.LENGTH_FORM}


def _reach(orientations: Sequence[LyingPart]) -> float:
    """How far [m] a lower track goes on for a verdict."""
    return LOWER_TRACK_LENGTHS * max(size_of(one) for one in orientations)


class Step(Device):
    """A drop of the track."""

    kind = "step"
    trade = Trade(
        "5 mm",
        "drop of the track by that height: orientations of a lower barrier pitch over their leading edge; "
        "quasi-static, until a trial confirms it",
    )
    action = Action.PITCH

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        return Features(drop=Drop(self.limit, reach=_reach(orientations)), settles=SETTLES)

    def judged(self, encounter: Encounter) -> Verdict:
        return encounter.turning(*encounter.pitched_over(self.limit))

    @classmethod
    def changes(cls, often: Sequence[Encounter]) -> list[float]:
        """Return the values at which it changes what it does with some orientation.

        Parameters
        ----------
        often : sequence of Encounter

        Returns
        -------
        list of float [m]
            Ascending, each once.
        """
        turns = [encounter.pitched(False) for encounter in often]
        return sorted({x for turn in turns for x in (turn.lift, turn.sure, turn.holds) if np.isfinite(x)})


class _Ledge(Device):
    def ledge_margin(self, encounter: Encounter) -> float:
        needed = encounter.orientation.balcony
        return self.limit - needed if math.isfinite(needed) else -encounter.orientation.axial_foot.reach


class TippingLedge(_Ledge):
    """A ledge above a second track."""

    kind = "tipping ledge"
    trade = Trade(
        "6 mm",
        "ledge of that width above a second track, half the part's greatest length lower: orientations whose "
        "weight lies beyond it turn over it if that drop takes them past their barrier; quasi-static, until "
        "a trial confirms it",
        old_name="tip",
    )
    action = Action.ROLL

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        length, lower = room_of(orientations), below_ledge(orientations)
        # steeper where it would go too far round a small bowl: its foot is square to where it begins
        least = math.atan2(lower, LONGEST_RAMP_SHARE * (track.radius - self.limit))
        drop = Drop(lower, self.limit, _reach(orientations), length, max(LEDGE_RAMP_RAD, least))
        return Features(length + drop.ramp_length(track.radius), drop=drop, settles=SETTLES)

    def judged(self, encounter: Encounter) -> Verdict:
        margin = self.ledge_margin(encounter)
        beyond = 1.0 - encounter.share(margin)
        turned: tuple[tuple[int, float], ...] = ()
        if beyond > 0.0:
            turned, certain = encounter.rolled_over(self.limit)
            turned = tuple((place, beyond * part) for place, part in turned)
            margin = margin if margin >= 0.0 else min(-margin, certain)
        return encounter.turning(turned, margin)

    @classmethod
    def changes(cls, often: Sequence[Encounter]) -> list[float]:
        """Return the values at which it changes what it does with some orientation.

        Parameters
        ----------
        often : sequence of Encounter

        Returns
        -------
        list of float [m]
            Ascending, each once.
        """
        return sorted({x for x in (one.orientation.balcony for one in often) if np.isfinite(x)})


def _along(span: tuple[float, float], orientations: Sequence[LyingPart]) -> Features:
    """An opening between two distances [m] from the wall, all along the device."""
    room = room_of(orientations)
    return Features(room, openings=(TrackOpening(box_ring(0.0, room, *span), span),))


def below_ledge(orientations: Sequence[LyingPart]) -> float:
    """Return how far below a ledge the second track lies: half the part's greatest length.

    Parameters
    ----------
    orientations : sequence of LyingPart

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "4. Turning parts over".
    """
    return LOWER * max(max(orientation.length, orientation.height) for orientation in orientations)


class _Balcony(_Ledge):
    search: ClassVar[ValueSearch] = ValueSearch(bound=Bound.UPPER, limited_by="balcony")

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        if self.limit >= track.extent:
            return Features(room_of(orientations))
        return _along((self.limit, track.extent), orientations)

    def judged(self, encounter: Encounter) -> Verdict:
        return encounter.verdict(self.ledge_margin(encounter))


class NarrowedTrack(_Balcony):
    """A track of a lesser width."""

    kind = "narrowed track"
    trade = Trade(
        "9 mm",
        "track of a lesser width; returns orientations whose foot of the centre of mass is not supported",
        old_name="narrowed_track",
        measures=DISTANCE,
    )
    action = Action.NARROW
    search = ValueSearch(ProposedBy.VALUE, Bound.UPPER, "balcony", rank=3)

    def acts(self, track: "Track") -> bool:
        return self.limit < track.width


class PressureBreak(_Balcony):
    """A ledge before the tooling, from which parts that back up leave the track."""

    kind = "pressure break"
    trade = Trade(
        "10 mm",
        "ledge of that width before the tooling: returns what it does not carry; where parts back up, those "
        "that stand on it and reach over it are pushed off, so that a queue behind it is no longer pushed",
        old_name="pressure_break",
        measures=DISTANCE,
        serves="takes off parts that back up",
    )
    action = Action.RELIEVE

    @classmethod
    def relieving(cls, wanted: Sequence[LyingPart], margin: float, where: str) -> Device | None:
        """Return the break that carries some orientations by a margin, beside what their hop takes of it.

        Parameters
        ----------
        wanted : sequence of LyingPart
        margin : float [m]
        where : str
            What asks for it.

        Returns
        -------
        Device or None
            None where one of them would not reach over the ledge, and so not leave it where they back up.
        """
        least = max(orientation.balcony + margin + cls(where).hop_blur(orientation) for orientation in wanted)
        limit = math.ceil(least / SHOP_STEP_M - 1e-6) * SHOP_STEP_M
        reach = min(orientation.width for orientation in wanted)
        return cls(where).valued(limit) if limit + margin <= reach else None


class Canyon(Device):
    """A strip removed along the wall."""

    kind = "canyon"
    trade = Trade(
        "8 mm",
        "strip of that width removed along the wall; returns orientations whose foot lies over it",
        measures=DISTANCE,
    )
    action = Action.CUT
    search = ValueSearch(ProposedBy.VALUE, Bound.LOWER, "canyon", rank=1)

    def misfits(self, width: float) -> list[ConfigError]:
        return self.hole_faults(width, 0.0, self.limit)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        return _along((0.0, self.limit), orientations)

    def more(self, encounter: Encounter) -> float:
        return encounter.leans(self.limit)

    def judged(self, encounter: Encounter) -> Verdict:
        margin = encounter.orientation.canyon - self.limit
        return encounter.verdict(carried(margin, -margin, self.more(encounter) if margin < 0.0 else 0.0))


class Slot(Device):
    """A long hole along the track."""

    kind = "slot"
    trade = Trade(
        "{from: 2 mm, to: 5 mm}",
        "long hole along the track between two distances from the wall",
        forms.mapping(**RAIL_SPAN_FORMS),
    )
    action = Action.CUT

    @classmethod
    def read(cls, entry: Entry) -> dict[str, Any]:
        return values.span(entry)[0]

    def value_text(self) -> str:
        return mapping_text(zip(("from", "to"), map(length_text, self.span)))

    def misfits(self, width: float) -> list[ConfigError]:
        return self.hole_faults(width, *self.span)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        near, far = self.span
        return _along((near, far), orientations)

    def judged(self, encounter: Encounter) -> Verdict:
        return encounter.verdict(encounter.over_slot(self.span))


@dataclass(frozen=True)
class Rails(Device):
    """A slot between two rails in which headed parts hang, with a wider stretch before it."""

    # [m] of the lead-in: from and to by their distances from the wall, its length, and that of its taper
    lead: tuple[float, ...] = ()

    kind = "rails"
    trade = Trade(
        "{from: 4.5 mm, to: 8.5 mm}",
        "slot between two rails, by their distances from the wall: headed parts whose centre of mass lies "
        "over it hang in it by the head from there on; what falls through is returned; with `lead_in: {from: "
        "3 mm, to: 9 mm, length: 30 mm, taper: 20 mm}` it begins so wide, for parts that lie askew",
        forms.mapping(
            ("lead_in",), **RAIL_SPAN_FORMS, lead_in=forms.mapping(**RAIL_SPAN_FORMS, **LEAD_IN_FORMS)
        ),
    )
    action = Action.HANG

    @classmethod
    def read(cls, entry: Entry) -> dict[str, Any]:
        span, arguments = values.span(entry, ("lead_in",))
        if "lead_in" not in arguments:
            return span
        lead = arguments["lead_in"]
        wide, more = values.span(lead, needed=("length", "taper"))
        ends = (values.within(more, name, "length", 0.0, MAX_LEAD_IN_M) for name in ("length", "taper"))
        own, slot = wide["span"], span["span"]
        if own[0] > slot[0] + 1e-9 or own[1] < slot[1] - 1e-9:
            what = "lead_in is narrower than the slot"
            raise ConfigError(lead.value.where, what, "let it reach as far to both sides, or leave it out")
        return span | {"lead": (*own, *ends)}

    def misfits(self, width: float) -> list[ConfigError]:
        entry = self.hole_faults(width, *self.entry.span) if self.lead else []
        return self.hole_faults(width, *self.span) + entry

    @property
    def entry(self) -> "Rails":
        """The rails as parts meet them first: as wide as the lead-in, without one."""
        return replace(self, span=self.lead[:2], lead=()) if self.lead else self

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        size = max(size_of(orientation) for orientation in orientations)
        length = room_of(orientations) + sum(self.lead[2:])
        near, far = self.span
        slot = TrackOpening(self._outline(length + 2.0 * size), (near, far), hangs=True)
        return Features(length, openings=(slot,))

    def _outline(self, length: float) -> Points:
        """Its slot (K, 2) [m] with the lead-in, over a length [m] at least."""
        if not self.lead:
            return box_ring(0.0, length, *self.span)
        (low, high), (near, far, straight, taper) = self.span, self.lead
        end = max(length, straight + taper + 0.5 * length)
        ring = [
            (0.0, near), (straight, near), (straight + taper, low), (end, low),
            (end, high), (straight + taper, high), (straight, far), (0.0, far),
        ]  # fmt: skip
        if near == low:
            del ring[1:3]
        if far == high:
            del ring[-3:-1]
        return np.array(ring)

    def with_span(self, span: Sequence[float], lead: tuple[float, ...] | None = None) -> Device:
        """Return the rails with another slot and, where given, another lead-in, written anew.

        Parameters
        ----------
        span : sequence of float [m]
            From and to, off the wall.
        lead : tuple of float [m], optional
            From, to, length and taper of the lead-in, which reaches as far as the slot at least.

        Returns
        -------
        Rails
        """
        lead = self.lead if lead is None else lead
        if lead:
            lead = (min(lead[0], span[0]), max(lead[1], span[1]), *lead[2:])
        return replace(self, span=tuple(span), lead=tuple(lead)).rewritten()

    def hop_blur(self, orientation: LyingPart) -> float:
        """Return 0: its margins are widths of head, shank and slot, which a hop does not change.

        Parameters
        ----------
        orientation : LyingPart

        Returns
        -------
        float [m]
        """
        return 0.0

    def judged(self, encounter: Encounter) -> Verdict:
        if encounter.hanging:
            return encounter.verdict(cast(HangingPart, encounter.orientation).over(self.span))
        first = self.entry.span
        over = encounter.over_slot(first)
        stem = encounter.held_by_shoulders(self.span) if over < -UNSURE else -np.inf
        if stem >= 0.0:
            return encounter.verdict(stem, hangs=True)
        width, widest = (last - near for near, last in (self.span, first))
        held = encounter.held_by_head(width, widest) if over < 0.0 else -np.inf
        if held > 0.0 and encounter.may_catch(first, self.span):
            return encounter.verdict(0.0, hangs=True)
        margin = min(held, -over) if held > 0.0 else over
        return encounter.verdict(margin, hangs=margin >= 0.0 and over < 0.0)

    def value_text(self) -> str:
        lengths = ", ".join(
            f"{name}: {size / MM:.9g} mm" for name, size in zip(("from", "to", "length", "taper"), self.lead)
        )
        return f"{self._slot_text()[:-1]}{f', lead_in: {{{lengths}}}' if self.lead else ''}}}"

    def _slot_text(self) -> str:
        return f"{{from: {self.span[0] / MM:.9g} mm, to: {self.span[1] / MM:.9g} mm}}"

    @property
    def short(self) -> str:
        if not self.lead:
            return self.text
        near, far = (end / MM for end in self.lead[:2])
        return f"{self._slot_text()}, lead-in {near:.6g} to {far:.6g} mm"

    @property
    def value_words(self) -> str:
        lead = f", lead-in {span_words(self.lead[:2])}" if self.lead else ""
        return f"slot {span_words(self.span)}{lead}"

    def document_values(self) -> dict[str, Any]:
        names = ("from_mm", "to_mm", "length_mm", "taper_mm")
        lead = {name: size / MM for name, size in zip(names, self.lead)}
        return super().document_values() | ({"lead_in": lead} if self.lead else {})
