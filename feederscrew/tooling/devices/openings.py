"""Devices with an edge across the track: gap and cut-out."""

import numpy as np

from feederscrew import value_forms as forms
from feederscrew.tooling.devices import hole_shapes, values
from feederscrew.tooling.devices.base import UNSURE, Device, carried, corners_text

DRAWN = forms.mapping(dxf=forms.TEXT_FORM, layer={"type": ["string", "number"]})


class Gap(Device):
    """A gap across the track."""

    kind = "gap"
    example = "9 mm"
    meaning = "gap of that length across the track, its edges parallel, the one that is left radial"
    bound = "lower"
    proposed = True
    rank = 2
    carries = True
    feature = "reach of the foot ahead of and behind the centre of mass"
    picture = "above"

    @classmethod
    def read(cls, entry):
        return values.length(entry)

    def hole_on(self, track):
        return hole_shapes.gap(self.limit, track.radius, track.extent)

    def outline_on(self, track, length):
        return hole_shapes.gap_outline(self.limit, track.radius, track.extent)

    @property
    def across(self):
        return 0.0

    @classmethod
    def needed(cls, one):
        return one.gap

    def more(self, met):
        return met.one.carry_ahead

    def judged(self, met):
        one = met.one
        return met.verdict(carried(one.gap - self.limit, self.limit - one.gap, one.carry_ahead))


class CutOut(Device):
    """A hole of several corners."""

    kind = "cut_out"
    trade = "cut-out"
    form = forms.either(forms.POLYGON, DRAWN)
    example = "[[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 8 mm]]"
    meaning = (
        "hole in the track: lengths along the wall and distances from it, unrolled; or "
        "{dxf: file, layer: CUT}"
    )
    picture = "above"
    carries = True
    searched = True

    @classmethod
    def read(cls, entry):
        return values.polygon(entry)

    def value_text(self):
        return corners_text(self.corners)

    def misfits(self, width):
        across = [y for _, y in self.corners]
        return [self.beside(width)] if max(across) <= 0.0 or min(across) >= width else []

    def hole_on(self, track):
        return hole_shapes.polygon(np.array(self.corners), track.radius)

    def outline_on(self, track, length):
        return np.array(self.corners)

    def goes_on(self, width):
        return max(x for x, _ in self.corners)

    def judged(self, met):
        one, hole = met.one, self.hole_on(met.one.track)
        margin, shift = met.over_hole(hole)
        if margin < 0.0 < one.carry:
            margin = carried(margin, met.unheld(hole), one.carry)
            length = float(np.ptp(np.array(self.corners)[:, 0]))
            margin = max(margin, -UNSURE) if met.rides(met.widest(self.corners), length) else margin
        return met.verdict(margin, shift)
