"""Devices that see a part and blow off what is not wanted: sorter."""

import math
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.tooling.devices import named, values
from feederscrew.tooling.devices.base import MM, RETURNED, Device

VIEWS = ("outline", "side", "height")
RESOLUTION = {"outline": 1e-4, "side": 1e-4, "height": 1e-3}  # [m] of a camera, of a fibre
PULSE = 0.05  # [N s] of four nozzles for 100 ms at 2 bar of the regulator, as measured


@dataclass(frozen=True)
class Sorter(Device):
    """A sensor that compares each part with the wanted one, and a pulse of air."""

    sees: str = "outline"
    resolution: float = math.nan  # [m] of the sensor; NaN: as common
    pulse: float = PULSE  # [N s]

    kind = "sorter"
    dimension = "sensor"
    example = "{of: A@90, play: 0.5 mm, sees: outline}"
    meaning = (
        "sensor and pulse of air: passes what is seen to differ from an orientation by less than play, blows "
        "the rest off the free edge; sees outline (from above), side or height; resolution: 0.1 mm and "
        "pulse: 0.05 may follow; parts must come with gaps"
    )
    proposed = True
    feature = "outline seen by a sensor"
    picture = "above"
    layer = "SENSOR"

    @classmethod
    def read(cls, entry):
        return values.sensor(entry, VIEWS)

    @property
    def blur(self):
        """By how much [m] what it sees is uncertain."""
        return RESOLUTION[self.sees] if math.isnan(self.resolution) else self.resolution

    @classmethod
    def around(cls, one, margin, where):
        """Return the sorters of an orientation, with the play [m] by which what they pass may differ."""
        views = [view for view in VIEWS if view != "side"]
        like = {view: (one.aspect, one.heading, float(margin) + RESOLUTION[view]) for view in views}
        return [cls(where, like=like[view], sees=view) for view in views]

    def with_play(self, play, text):
        """Return the same sorter with other play [m], written as some text."""
        aspect, heading, _ = self.like
        written = f"{{of: {aspect}@{np.degrees(heading):.6g}, play: {text}, sees: {self.sees}}}"
        return replace(self, like=(aspect, heading, float(play)), text=written)

    def differs(self, met):
        """Return by how much [m] an orientation is seen to differ from the wanted one."""
        aspect, heading, _ = self.like
        wanted = met.every[named.place_of(met.every, aspect, heading, self.where, f"{self.kind} names")]
        return met.differs(wanted, self.sees)

    def fate(self, met):
        return RETURNED

    def judged(self, met):
        margin = self.like[2] - self.differs(met)
        margin = math.copysign(max(abs(margin) - self.blur, 0.0), margin)
        if margin < 0.0 and not met.blown_off(self.pulse):
            return met.verdict(0.0)  # it is carried on, whatever is seen
        return met.verdict(margin)

    def edge(self, start, length, width):
        """Return what it sees, unrolled: the track as far as the longest part."""
        return np.array([[start, 0.0], [start + length, 0.0], [start + length, width], [start, width]])

    def told(self):
        return {"value_mm": self.like[2] / MM, "sees": self.sees, "resolution_mm": self.blur / MM}
