"""Devices that turn parts over: step and tip."""

from typing import ClassVar

import numpy as np

from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.pieces import Hole, Standing

LOWER = 0.5  # of the part's greatest length: how far below a ledge the second track lies
LOWER_TRACK_LENGTHS = 10.0  # of the part's size: how far the lower track goes on
SETTLES = 2.0  # of the part's size: how far behind a turning device parts end
DRAWN_EDGE_M = 2e-4  # [m] the width with which an edge over which parts turn is drawn


class _Turner(Device):
    hanging: ClassVar[bool] = False
    turns: ClassVar[bool] = True
    picture: ClassVar[str] = "turned"
    inwards: ClassVar[bool] = False  # whether parts turn across the track

    @classmethod
    def read(cls, entry):
        return values.length(entry)

    def standing(self, track, every):
        drop, aside = self.lower(every)
        width, far = (
            track.extent,
            LOWER_TRACK_LENGTHS * max(np.hypot(one.length, max(one.width, one.height)) for one in every),
        )
        cut = Hole(np.array([[0.0, aside], [far, aside], [far, width], [0.0, width]]))
        return Standing(holes=(cut,), drop=drop, aside=aside, settles=SETTLES)


class Step(_Turner):
    """A drop of the track."""

    kind = "step"
    example = "5 mm"
    meaning = (
        "drop of the track by that height: orientations of a lower barrier pitch over their leading edge; "
        "quasi-static, until a trial confirms it"
    )
    layer = "STEP"

    def lower(self, every):
        return self.limit, 0.0

    def edge(self, start, length, width):
        middle = start + 0.5 * length
        return np.array(
            [[middle, 0.0], [middle + DRAWN_EDGE_M, 0.0], [middle + DRAWN_EDGE_M, width], [middle, width]]
        )

    def judged(self, met):
        turned, margin = met.pitched_over(self.limit)
        return met.turning(turned, margin)

    @classmethod
    def changes(cls, often):
        """Return the values [m] at which it changes what it does with some orientations, a Meeting each."""
        turns = [met.pitched() for met in often]
        return sorted({x for turn in turns for x in (turn.lift, turn.sure, turn.holds) if np.isfinite(x)})


class Tip(_Turner):
    """A ledge above a second track."""

    kind = "tip"
    trade = "tipping ledge"
    example = "6 mm"
    meaning = (
        "ledge of that width above a second track, half the part's greatest length lower: orientations whose "
        "weight lies beyond it turn over it if that drop takes them past their barrier; quasi-static, until "
        "a trial confirms it"
    )
    layer = "LEDGE"
    inwards = True

    def span_on(self, track):
        return (self.limit, track.extent) if self.limit < track.extent else None

    def lower(self, every):
        return below_ledge(every), self.limit

    def edge(self, start, length, width):
        low, high = self.limit, self.limit + DRAWN_EDGE_M
        return np.array([[start, low], [start + length, low], [start + length, high], [start, high]])

    def judged(self, met):
        needed = met.one.balcony
        margin = self.limit - needed if np.isfinite(needed) else -met.one.standing.reach
        beyond = 1.0 - met.share(margin)
        turned: tuple[tuple[int, float], ...] = ()
        if beyond > 0.0:
            turned, certain = met.rolled_over(self.limit)
            turned = tuple((place, beyond * part) for place, part in turned)
            margin = margin if margin >= 0.0 else min(-margin, certain)
        return met.turning(turned, margin)

    @classmethod
    def changes(cls, often):
        """Return the values [m] at which it changes what it does with some orientations, a Meeting each."""
        return sorted({met.one.balcony for met in often if np.isfinite(met.one.balcony)})


def below_ledge(every):
    """Return how far below a ledge the second track lies [m]: half the part's greatest length.

    Source: own; docs/tooling.md, "4. Turning parts over".
    """
    return LOWER * max(max(one.length, one.height) for one in every)
