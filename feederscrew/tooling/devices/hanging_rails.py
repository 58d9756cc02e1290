"""Rails: headed parts hang between them."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import value_forms as forms
from feederscrew.errors import ConfigError
from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import MM, UNSURE, Device, room_of, span_words
from feederscrew.tooling.devices.ledges import between
from feederscrew.tooling.devices.pieces import Hole, Standing

MAX_LEAD_IN_M = 1.0  # [m] of a lead-in
RAIL_SPAN_FORMS = {"from_": forms.LENGTH_FORM, "to": forms.LENGTH_FORM}
LEAD_IN_FORMS = {"length": forms.LENGTH_FORM, "taper": forms.LENGTH_FORM}


@dataclass(frozen=True)
class Rails(Device):
    """A slot between two rails in which headed parts hang, with a wider stretch before it."""

    # [m] of the lead-in: from and to by their distances from the wall, its length, and that of its taper
    lead: tuple[float, ...] = ()

    kind = "rails"
    form = forms.mapping(
        ("lead_in",), **RAIL_SPAN_FORMS, lead_in=forms.mapping(**RAIL_SPAN_FORMS, **LEAD_IN_FORMS)
    )
    example = "{from: 4.5 mm, to: 8.5 mm}"
    meaning = (
        "slot between two rails, by their distances from the wall: headed parts whose centre of mass lies "
        "over it hang in it by the head from there on; what falls through is returned; with `lead_in: {from: "
        "3 mm, to: 9 mm, length: 30 mm, taper: 20 mm}` it begins so wide, for parts that lie askew"
    )
    hangs = True
    picture = "above"

    @classmethod
    def read(cls, entry):
        found, given = values.span_and(entry, ("lead_in",))
        if "lead_in" not in given:
            return found
        lead = given["lead_in"]
        wide, more = values.span_and(lead, needed=("length", "taper"))
        ends = (values.within(more, name, "length", 0.0, MAX_LEAD_IN_M) for name in ("length", "taper"))
        own, slot = wide["span"], found["span"]
        if own[0] > slot[0] + 1e-9 or own[1] < slot[1] - 1e-9:
            what = "lead_in is narrower than the slot"
            raise ConfigError(lead.value.where, what, "let it reach as far to both sides, or leave it out")
        return found | {"lead": (*own, *ends)}

    def misfits(self, width):
        return between(self, width) + (between(self.entry, width) if self.lead else [])

    def span_on(self, track):
        return self.span

    @property
    def entry(self):
        """The rails as parts meet them first: as wide as the lead-in, without one."""
        return replace(self, span=self.lead[:2], lead=()) if self.lead else self

    def goes_on(self, width):
        return sum(self.lead[2:])

    def outline_on(self, track, length):
        """Return the slot, unrolled from where its lead-in begins, (K, 2) [m]."""
        if not self.lead:
            return super().outline_on(track, length)
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

    def with_span(self, span, lead=None):
        """Return the rails with another slot [m] and, where given, another lead-in, written anew."""
        lead = self.lead if lead is None else lead
        if lead:
            lead = (min(lead[0], span[0]), max(lead[1], span[1]), *lead[2:])
        return replace(self, span=tuple(span), lead=tuple(lead)).rewritten()

    def value_text(self):
        return written(self.span, self.lead)

    def hop_blur(self, one):
        """Return nothing: its margins are widths of head, shank and slot, which a hop does not change."""
        return 0.0

    def standing(self, track, every):
        """Return its slot, which goes on behind it: those that hang do not come back onto the track."""
        room, size = room_of(every), max(np.hypot(one.length, max(one.width, one.height)) for one in every)
        length = room + self.goes_on(track.extent)
        holes = (Hole(self.outline_on(track, length + 2.0 * size)),)
        return Standing(length, holes=holes, hangs=True, slot=self.span)

    def judged(self, met):
        if met.hanging:
            return met.verdict(met.one.over(self.span))
        first = self.entry.span
        over = met.over_slot(first)
        stem = met.held_by_shoulders(self.span) if over < -UNSURE else -np.inf
        if stem >= 0.0:
            return met.verdict(stem, hangs=True)
        held = met.held_by_head(self.span[1] - self.span[0], first[1] - first[0]) if over < 0.0 else -np.inf
        free = met.goes_down(first[0]) and met.hangs_free(self.span)
        if held > 0.0 and (met.wedges(first) or not free):
            return met.verdict(0.0, hangs=True)
        margin = min(held, -over) if held > 0.0 else over
        return met.verdict(margin, hangs=margin >= 0.0 and over < 0.0)

    @property
    def short(self):
        if not self.lead:
            return self.text
        near, far = (end / MM for end in self.lead[:2])
        return f"{written(self.span)}, lead-in {near:.6g} to {far:.6g} mm"

    @property
    def value_words(self):
        lead = f", lead-in {span_words(self.lead[:2])}" if self.lead else ""
        return f"slot {span_words(self.span)}{lead}"

    def told(self):
        if not self.lead:
            return super().told()
        names = ("from_mm", "to_mm", "length_mm", "taper_mm")
        return super().told() | {"lead_in": {name: size / MM for name, size in zip(names, self.lead)}}


def written(span, lead=()):
    """Return a slot [m] and its lead-in as a bowl file has them."""
    names = ("from", "to", "length", "taper")
    told = ", ".join(f"{name}: {size / MM:.9g} mm" for name, size in zip(names, lead))
    more = f", lead_in: {{{told}}}" if lead else ""
    return f"{{from: {span[0] / MM:.9g} mm, to: {span[1] / MM:.9g} mm{more}}}"
