"""Devices that see a part and blow off what is not wanted: sorter."""

import math
from dataclasses import dataclass, replace

import numpy as np

from feederscrew import units
from feederscrew import value_forms as forms
from feederscrew.tooling.devices import named, values
from feederscrew.tooling.devices.base import (
    MM,
    RETURNED,
    Device,
    keeps,
    length_text,
    length_words,
    mapping_text,
    room_of,
)
from feederscrew.tooling.devices.nozzles import SPREAD, Nozzles
from feederscrew.tooling.devices.pieces import Sensor, Standing

VIEWS = ("outline", "side", "height", "relief")
RESOLUTION = {"outline": 1e-4, "side": 1e-4, "height": 1e-3, "relief": 1e-4}  # [m] camera, fibre, laser
BORE, PRESSURE, PULSE = 2e-3, 3e5, 0.04  # [m], [Pa], [s] of each nozzle: 1.28 N, 0.051 N s
NOZZLE_COUNT = 4.0
BAR, MS = units.factor("bar", "pressure"), units.factor("ms", "time")
REACTION = 0.01  # [s] of sensor and valve: 5 to 15 ms
NOZZLES = forms.mapping(
    ("nozzle", "pressure", "height", "time", "nozzles"),
    nozzle=forms.LENGTH,
    pressure=forms.quantity("pressure"),
    height=forms.LENGTH,
    time=forms.quantity("time"),
    nozzles=forms.quantity("count", "1", "20"),
)
SEEN_BY = {  # what sees a part so, and what it compares
    "outline": ("camera from above", "outlines that differ"),
    "side": ("camera from the side", "side views that differ"),
    "height": ("fibre sensor", "heights that differ"),
    "relief": ("laser along the middle", "height profiles that differ"),
}
AHEAD = 0.01  # [m] from the sensor to the nozzles: a part is blown at as its middle comes to them


@dataclass(frozen=True)
class Sorter(Device):
    """A sensor that compares each part with the wanted one, and a pulse of air."""

    like: tuple[str, float, float] = ()  # type: ignore[assignment]  # a sorter is always like something
    sees: str = "outline"
    resolution: float | None = None  # [m] of the sensor; None: as common
    nozzle: float = BORE  # [m]
    pressure: float = PRESSURE  # [Pa] at the nozzle, above the ambient
    height: float | None = None  # [m] of the lowest nozzle over the track; None: low enough for the thinnest
    time: float = PULSE  # [s] of a pulse
    nozzles: float = NOZZLE_COUNT  # one above the other

    kind = "sorter"
    cost_class = 3
    trade = "vision reject"
    form = forms.mapping(
        ("sees", "resolution", "jet"),
        of=forms.either(forms.NAMED, {"type": "array", "minItems": 1, "items": forms.NAMED}),
        play=forms.LENGTH,
        sees={"enum": list(VIEWS)},
        resolution=forms.LENGTH,
        jet=NOZZLES,
    )
    example = "{of: A@90, play: 0.5 mm, sees: outline}"
    meaning = (
        "sensor and pulse of air: passes what is seen to differ from an orientation by less than play, blows "
        "the rest off the free edge; of may be a list, [A@90, A@270]: what is like any of them passes; "
        "sees outline (from above), side, height or relief (heights under a laser along the middle); "
        "resolution: 0.1 mm and "
        "jet: {nozzle: 2 mm, pressure: 3 bar, height: 4 mm, time: 40 ms, "
        "nozzles: 4} may follow; parts must come with gaps"
    )
    proposed = True
    senses = True
    feature = "outline seen by a sensor"
    picture = "above"
    layer = "SENSOR"

    @classmethod
    def read(cls, entry):
        return values.sensor(entry, VIEWS)

    @property
    def blur(self):
        """By how much [m] what it sees is uncertain."""
        return RESOLUTION[self.sees] if self.resolution is None else self.resolution

    @classmethod
    def around(cls, met, margin, where, unlike=lambda view: ()):
        """Return the sorters of an orientation, with the play [m] by which what they pass may differ.

        Those that ``unlike`` gives for a view are named beside it: they pass too, though they look otherwise.
        """
        one, made = met.one, []
        for view in VIEWS:
            also = tuple((other.aspect, other.heading) for other in unlike(view))
            like = one.aspect, one.heading, float(margin) + RESOLUTION[view] + met.askew(view)
            device = cls(where, like=like, sees=view, also=also)
            made.append(replace(device, like=(*like[:2], like[2] + device.hop_blur(one))))
        return made

    def with_play(self, play):
        """Return the same sorter with other play [m], and headings as its text has them."""
        turns = [(name, f"{np.degrees(turn):.6g}") for name, turn in (self.like[:2], *self.also)]
        first, *also = ((name, float(np.radians(float(turn)))) for name, turn in turns)
        return replace(self, like=(*first, float(play)), also=tuple(also)).rewritten()

    @property
    def canonical_text(self):
        """Its value with what it lets pass in one order."""
        (aspect, heading, play), *also = self.like, *self.also
        first, *others = sorted([(aspect, heading), *also])
        return replace(self, like=(*first, play), also=tuple(others)).value_text()

    def with_pulse(self, time):
        """Return the same sorter with a pulse of some time [s]."""
        return replace(self, time=time).rewritten()

    def value_text(self):
        names = [named.written(*one) for one in (self.like[:2], *self.also)]
        return mapping_text(
            (
                ("of", names[0] if len(names) == 1 else f"[{', '.join(names)}]"),
                ("play", length_text(self.like[2])),
                ("sees", self.sees),
                ("resolution", "" if self.resolution is None else length_text(self.resolution)),
                ("jet", self._jet_text()),
            )
        )

    @property
    def full_name(self):
        return f"{self.name} ({SEEN_BY[self.sees][0]})"

    @property
    def value_words(self):
        what, most = SEEN_BY[self.sees][1], length_words(self.like[2])
        pulse = "" if self.time == PULSE else f", air for {self.time / MS:.4g} ms"
        return f"keeps {keeps((self.like[:2], *self.also))}, rejects {what} by more than {most}{pulse}"

    @property
    def shop_words(self):
        most = f"resolves {length_words(self.blur)}, rejects more than {length_words(self.like[2])}"
        nozzles = f"{self.nozzles:.0f} nozzles of {length_words(self.nozzle)} in the wall"
        valve = f"solenoid valve: opens within {REACTION / MS:.3g} ms, pulse of {self.time / MS:.4g} ms"
        return (
            f"{SEEN_BY[self.sees][0]}: {most}",
            f"{nozzles}, {self.pressure / BAR:.4g} bar at the nozzle; {valve}",
        )

    def _jet_text(self):
        """Its nozzles and its pulse as a bowl file has them, as far as they are not as by default."""
        nozzles = [
            ("nozzle", length_text(self.nozzle), self.nozzle != BORE),
            ("pressure", f"{self.pressure / BAR:.9g} bar", self.pressure != PRESSURE),
            ("height", "" if self.height is None else length_text(self.height), True),
            ("time", f"{self.time / MS:.9g} ms", self.time != PULSE),
            ("nozzles", f"{self.nozzles:.9g}", self.nozzles != NOZZLE_COUNT),
        ]
        told = [(key, text) for key, text, changed in nozzles if changed and text]
        return mapping_text(told) if told else ""

    def differs(self, met):
        """Return by how much [m] an orientation is seen to differ from the nearest of the wanted ones.

        At least, of what is not wanted; at most, of what is: either may come askew.
        """
        wanted = self.wanted(met.every)
        if any((one.aspect, one.heading) == (met.one.aspect, met.one.heading) for one in wanted):
            return met.askew(self.sees)
        return min(met.differs(one, self.sees) for one in wanted)

    def wanted(self, every):
        """Return the orientations that it passes."""
        said = self.where, f"{self.kind} names"
        return tuple(every[named.place_of(every, *one, *said)] for one in (self.like[:2], *self.also))

    @property
    def jet(self):
        """Its Nozzles."""
        return Nozzles(self.nozzle, self.pressure, self.height, round(self.nozzles))

    def standing(self, track, every):
        """Return the sensor half a room behind its begin, and the nozzles in the wall behind it."""
        room = room_of(every)
        middle = 0.5 * room
        sensor = Sensor(middle, self.sees, self.wanted(every), self.like[2], self.blur)
        return Standing(room + AHEAD, jets=self.jet.jets(middle + AHEAD, every, self.time), sensor=sensor)

    def hop_blur(self, one):
        """Return what the hop of an orientation takes of its margin [m]: nothing as it is seen from above."""
        return 0.0 if self.sees == "outline" else one.hop

    def gap(self, one, speed):
        """Return the free way [m] that it needs between parts that come with some speed [m/s]."""
        beam = self.nozzle + 2.0 * SPREAD * one.width
        return max(beam + speed * (REACTION + self.time), self.blur)

    def fate(self, met):
        return RETURNED

    def judged(self, met):
        margin = self.like[2] - self.differs(met)
        margin = math.copysign(max(abs(margin) - self.blur, 0.0), margin)
        if margin < 0.0 and met.blown(*self.jet.push(met.one, met.every or (met.one,)), self.time) <= 0.0:
            return met.verdict(0.0)  # it is carried on, whatever is seen
        return met.verdict(margin)

    def edge(self, start, length, width):
        """Return what it sees, unrolled: the track as far as the longest part."""
        return np.array([[start, 0.0], [start + length, 0.0], [start + length, width], [start, width]])

    def told(self):
        return {
            "value_mm": self.like[2] / MM,
            "sees": self.sees,
            "resolution_mm": self.blur / MM,
            "thrust_N": self.jet.thrust,
        }
