"""Cuts of a set shape from the free edge of the track: the dish-out."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew import value_forms as forms
from feederscrew.arrays import Points
from feederscrew.documents import Entry
from feederscrew.errors import ConfigError
from feederscrew.sorting.devices import values
from feederscrew.sorting.devices.base import Verdict, length_text, length_words, mapping_text, room_of
from feederscrew.sorting.devices.features import Features, TrackOpening
from feederscrew.sorting.devices.openings import Across, judge_hole
from feederscrew.units import MM

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track
    from feederscrew.sorting.orientations import Orientation
    from feederscrew.sorting.verdicts import DeviceEncounter

DISH_CHORD_M = 1e-5  # [m] by which the arc of a dish may be seen too flat
MAX_DISH_RADIUS_M = 1.0  # [m] of a dish


@dataclass(frozen=True)
class DishOut(Across):
    """A round bay in the free edge of the track, which leaves a waist of track beside the wall."""

    radius: float = 0.0  # [m] of the bay; its ends go on straight to the free edge

    kind = "dish-out"
    form = forms.mapping(leaves=forms.LENGTH_FORM, radius=forms.LENGTH_FORM)
    example = "{leaves: 7 mm, radius: 12 mm}"
    meaning = (
        "round bay in the free edge that leaves a waist of track of that width; returns orientations whose "
        "weight lies beyond the waist and which are too short along the track to bridge the bay"
    )

    @staticmethod
    def read(entry: Entry) -> dict[str, Any]:
        own = values.mapping(entry, ("leaves", "radius"), "write {leaves: 7 mm, radius: 12 mm}")
        return {
            "limit": values.within(own, "leaves", "length", 0.0, values.MAX_LENGTH_M),
            "radius": values.within(own, "radius", "length", DISH_CHORD_M, MAX_DISH_RADIUS_M),
        }

    def value_text(self) -> str:
        return mapping_text((("leaves", length_text(self.limit)), ("radius", length_text(self.radius))))

    @property
    def value_words(self) -> str:
        return f"leaves {length_words(self.limit)} of track, radius {length_words(self.radius)}"

    def document_values(self) -> dict[str, Any]:
        return {"value_mm": self.limit / MM, "radius_mm": self.radius / MM}

    def misfits(self, width: float) -> list[ConfigError]:
        return self.hole_faults(width, self.limit, width, endless=False)

    def ring(self, width: float) -> Points:
        """Return the outline of the bay on a track.

        Parameters
        ----------
        width : float [m]
            Of the track.

        Returns
        -------
        (K, 2) float [m]
            Along the wall, and from it; its first and last corner lie on the free edge.
        """
        depth, radius = width - self.limit, self.radius
        half = math.acos(max(1.0 - depth / radius, 0.0))  # of the arc that is cut, from its middle
        pieces = math.ceil(half / math.acos(max(1.0 - DISH_CHORD_M / radius, 0.0)))
        turns = np.linspace(-half, half, 2 * pieces + 1)
        chord = radius * math.sin(half)
        arc = np.column_stack([chord + radius * np.sin(turns), self.limit + radius * (1.0 - np.cos(turns))])
        if depth <= radius:
            return arc
        return np.vstack([[[0.0, width]], arc, [[2.0 * radius, width]]])

    def features(self, track: "Track", orientations: "Sequence[Orientation]") -> Features:
        ring = self.ring(track.extent)
        length = float(ring[:, 0].max())
        return Features(length, takes=room_of(orientations) + length, openings=(TrackOpening(ring),))

    def judged(self, encounter: "DeviceEncounter") -> Verdict:
        return judge_hole(encounter, self.ring(encounter.orientation.track.extent))
