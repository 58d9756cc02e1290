"""Blades over the track: wiper, height bar and hold-down."""

from typing import ClassVar

from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import Device


class _Overhead(Device):
    dimension: ClassVar[str] = ""
    bound: ClassVar[str] = "upper"
    overhead: ClassVar[bool] = True
    picture: ClassVar[str] = "side"
    feature: ClassVar[str] = "height"

    @classmethod
    def read(cls, entry):
        return values.length(entry)

    def opening(self, every, width):
        import shapely

        return shapely.box(0.0, 0.0, width, self.limit)

    @classmethod
    def needed(cls, one):
        return one.height

    def judged(self, met):
        return met.verdict(met.unless_laid_over(self.limit - met.one.height, self.limit))


class Wiper(_Overhead):
    """A blade over the track."""

    kind = "wiper"
    dimension = "length"
    example = "6 mm"
    meaning = "blade at a clearance over the track; returns orientations that stand higher"
    proposed = True
    rank = 1


class HeightBar(_Overhead):
    """A bar across the track."""

    kind = "height_bar"
    dimension = "length"
    example = "6 mm"
    meaning = "bar across the track at a clearance; returns orientations that stand higher"


class HoldDown(_Overhead):
    """A bar above the queue."""

    kind = "hold_down"
    dimension = "length"
    example = "6 mm"
    meaning = "bar above the queue that keeps parts down; returns orientations that do not fit below"
