"""Devices that take the track away along its way: narrowed track, canyon, slot; and the pressure break."""

import math
from typing import ClassVar

import numpy as np

from feederscrew import value_forms as forms
from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import RETURNED, UNSURE, Device, carried, length_text, mapping_text

SHOP_STEP_M = 5e-5  # [m] of which a value that is proposed is a whole multiple
DISTANCE = "distance from the wall to the centre of mass"


class _OneNumber(Device):
    picture: ClassVar[str] = "above"

    @classmethod
    def read(cls, entry):
        return values.length(entry)


class NarrowedTrack(_OneNumber):
    """A track of a lesser width."""

    kind = "narrowed_track"
    example = "9 mm"
    meaning = (
        "track of a lesser width, a balcony; returns orientations whose foot of the centre of mass is not "
        "supported"
    )
    bound = "upper"
    proposed = True
    rank = 3
    carries = True
    feature = DISTANCE

    def acts(self, track):
        return self.limit < track.width

    def fate(self, met):
        return RETURNED

    def span_on(self, track):
        return (self.limit, track.extent) if self.limit < track.extent else None

    @classmethod
    def needed(cls, one):
        return one.balcony

    def judged(self, met):
        needed = met.one.balcony
        return met.verdict(self.limit - needed if math.isfinite(needed) else -met.one.standing.reach)


class PressureBreak(_OneNumber):
    """A ledge before the tooling, from which parts that back up leave the track."""

    kind = "pressure_break"
    serves = "takes off parts that back up"
    example = "10 mm"
    meaning = (
        "ledge of that width before the tooling: returns what it does not carry; where parts back up, those "
        "that stand on it and reach over it are pushed off, so that a queue behind it is no longer pushed"
    )
    hanging = False
    relieves = True
    bound = "upper"
    carries = True
    feature = DISTANCE

    def span_on(self, track):
        return (self.limit, track.extent) if self.limit < track.extent else None

    def fate(self, met):
        return RETURNED

    @classmethod
    def needed(cls, one):
        return one.balcony

    @classmethod
    def relieving(cls, wanted, margin, where):
        """Return the break that carries some orientations by a margin [m], each of which reaches over it.

        Parameters
        ----------
        wanted : sequence of Orientation
            That shall pass it alone, and leave it where they back up.
        margin : float [m]
            Beside what their hop takes of it.
        where : str

        Returns
        -------
        PressureBreak or None
            None where one of them would not reach over the ledge.
        """
        least = max(one.balcony + margin + cls(where).hop_blur(one) for one in wanted)
        limit = math.ceil(least / SHOP_STEP_M - 1e-6) * SHOP_STEP_M
        reach = min(one.width for one in wanted)
        return cls(where).valued(limit) if limit + margin <= reach else None

    def judged(self, met):
        needed = met.one.balcony
        return met.verdict(self.limit - needed if math.isfinite(needed) else -met.one.standing.reach)


class Canyon(_OneNumber):
    """A strip removed along the wall."""

    kind = "canyon"
    example = "8 mm"
    meaning = "strip of that width removed along the wall; returns orientations whose foot lies over it"
    bound = "lower"
    proposed = True
    rank = 1
    carries = True
    feature = DISTANCE

    def misfits(self, width):
        return [self.whole(width)] if self.limit >= width else []

    def span_on(self, track):
        return 0.0, self.limit

    @classmethod
    def needed(cls, one):
        return one.canyon

    def more(self, met):
        return met.leans(self.limit)

    def judged(self, met):
        margin = met.one.canyon - self.limit
        return met.verdict(carried(margin, -margin, self.more(met) if margin < 0.0 else 0.0))


class Slot(Device):
    """A long hole along the track."""

    kind = "slot"
    form = forms.mapping(from_=forms.LENGTH_FORM, to=forms.LENGTH_FORM)
    example = "{from: 2 mm, to: 5 mm}"
    meaning = "long hole along the track between two distances from the wall"
    picture = "above"
    carries = True

    @classmethod
    def read(cls, entry):
        return values.span(entry)

    def value_text(self):
        return span_text(self.span)

    def misfits(self, width):
        return between(self, width)

    def span_on(self, track):
        return self.span

    def judged(self, met):
        margin = met.over_span(self.span)
        first, last = self.span
        return met.verdict(max(margin, -UNSURE) if met.rides(last - first, np.inf) else margin)


def span_text(span):
    """Return a span [m] off the wall as a bowl file has it."""
    return mapping_text(zip(("from", "to"), map(length_text, span)))


def between(device, width):
    """Return the faults [ConfigError] of a hole between two distances off the wall of a track."""
    first, last = device.span
    found = [device.whole(width)] if first <= 0.0 and last >= width else []
    return found + ([device.beside(width)] if first >= width else [])
