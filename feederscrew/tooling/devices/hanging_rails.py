"""Rails: headed parts hang between them."""

import numpy as np

from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import Device, room_of
from feederscrew.tooling.devices.ledges import between
from feederscrew.tooling.devices.pieces import Hole, Standing


class Rails(Device):
    """A slot between two rails in which headed parts hang."""

    kind = "rails"
    dimension = "span"
    example = "{from: 4.5 mm, to: 8.5 mm}"
    meaning = (
        "slot between two rails, by their distances from the wall: headed parts whose centre of mass lies "
        "over it hang in it by the head from there on; what falls through is returned"
    )
    hangs = True
    picture = "above"

    @classmethod
    def read(cls, entry):
        return values.span(entry)

    def misfits(self, width):
        return between(self, width)

    def span_on(self, track):
        return self.span

    def standing(self, track, every):
        """Return its slot, which goes on behind it: those that hang do not come back onto the track."""
        room, size = room_of(every), max(np.hypot(one.length, max(one.width, one.height)) for one in every)
        return Standing(room, holes=(Hole(self.outline_on(track, room + 2.0 * size)),), hangs=True)

    def judged(self, met):
        if met.hanging:
            return met.verdict(met.one.over(self.span))
        over = met.over_slot(self.span)
        held = met.held_by_head(self.span[1] - self.span[0]) if over < 0.0 else -np.inf
        if held > 0.0 and met.wedges(self.span):
            return met.verdict(0.0, hangs=True)
        margin = min(held, -over) if held > 0.0 else over
        return met.verdict(margin, hangs=margin >= 0.0 and over < 0.0)
