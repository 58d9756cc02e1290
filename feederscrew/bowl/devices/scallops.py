"""Cuts of a set shape from the free edge of the track: the dish-out and the cap selector."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base import value_forms as forms
from feederscrew.base.arrays import Points
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError
from feederscrew.base.units import MM
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import (
    UNSURE,
    Verdict,
    length_text,
    length_words,
    mapping_text,
)
from feederscrew.bowl.devices.features import Features, TrackOpening
from feederscrew.bowl.devices.ledges import SHOP_STEP_M
from feederscrew.bowl.devices.openings import Across, judge_hole
from feederscrew.bowl.devices.trade import ProposedBy, Trade, ValueSearch
from feederscrew.bowl.devices.values import DeviceFields

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

DISH_CHORD_M = 1e-5  # [m] by which the arc of a dish may be seen too flat
MAX_DISH_RADIUS_M = 1.0  # [m] of a dish
CAP_SELECTOR_KEYS = ("land", "length", "tongue", "reach")
CAP_SELECTOR_EXAMPLE = "{land: 2 mm, length: 20 mm, tongue: 4 mm, reach: 11 mm}"
LEAST_MOUTH_M = 1e-3  # [m] from the weight to the rim: nearer to it no tongue fits
# what a design tries of a cap selector
LANDS = (0.2, 0.3, 0.4, 0.55)  # [1] of the way from the wall to the weight
# [1] of the mouth's radius, beyond the part's length: in trials of a cap of 14 mm on its mouth, 24 a bay,
# 2 of 96 stayed in bays of 1.35, 2 of 72 in those of 1.0 and 5 of 24 in one of 0.65
LENGTHS = (1.35, 1.7)
TONGUES = (0.5, 0.75, 1.0)  # [1] of the same: the tongue's width
REACHES = (0.3, 0.5, 0.65, 0.8)  # [1] of the same: beyond the weight


class _Bay(Across):
    """A bay in the free edge of the track."""

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
        raise NotImplementedError

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        ring = self.ring(track.extent)
        return Features(float(ring[:, 0].max()), openings=(TrackOpening(ring),))

    def judged(self, encounter: Encounter) -> Verdict:
        return judge_hole(encounter, self.ring(encounter.orientation.track.extent))


@dataclass(frozen=True)
class DishOut(_Bay):
    """A round bay in the free edge of the track, which leaves a waist of track beside the wall."""

    radius: float = 0.0  # [m] of the bay; its ends go on straight to the free edge

    kind = "dish-out"
    trade = Trade(
        "{leaves: 7 mm, radius: 12 mm}",
        "round bay in the free edge that leaves a waist of track of that width; returns orientations whose "
        "weight lies beyond the waist and which are too short along the track to bridge the bay",
        forms.mapping(leaves=forms.LENGTH_FORM, radius=forms.LENGTH_FORM),
    )

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
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

    def document_values(self) -> Document:
        return {"value_mm": self.limit / MM, "radius_mm": self.radius / MM}

    def ring(self, width: float) -> Points:
        depth, radius = width - self.limit, self.radius
        half = math.acos(max(1.0 - depth / radius, 0.0))  # of the arc that is cut, from its middle
        pieces = math.ceil(half / math.acos(max(1.0 - DISH_CHORD_M / radius, 0.0)))
        turns = np.linspace(-half, half, 2 * pieces + 1)
        chord = radius * math.sin(half)
        arc = np.column_stack([chord + radius * np.sin(turns), self.limit + radius * (1.0 - np.cos(turns))])
        if depth <= radius:
            return arc
        return np.vstack([[[0.0, width]], arc, [[2.0 * radius, width]]])


@dataclass(frozen=True)
class CapSelector(_Bay):
    """A bay that leaves a land along the wall and a tongue in its middle.

    What stands on a closed bottom is carried over it by land and tongue. Of what stands on the rim of its
    mouth the tongue carries nothing while it is within the mouth, and the part falls off the land.
    """

    length: float = 0.0  # [m] of the bay along the wall
    tongue: float = 0.0  # [m] width of the tongue along the wall, in the middle of the bay
    reach: float = 0.0  # [m] off the wall, to which the tongue goes

    kind = "cap selector"
    trade = Trade(
        CAP_SELECTOR_EXAMPLE,
        "bay in the free edge that leaves a land of that width along the wall and in its middle a tongue, so "
        "wide and up to that reach off the wall: carries caps and cups that stand on their bottom and lets "
        "fall those that stand on the rim of their mouth",
        forms.mapping(**dict.fromkeys(CAP_SELECTOR_KEYS, forms.LENGTH_FORM)),
        measures="mouth around the weight",
    )
    search = ValueSearch(ProposedBy.VALUE)

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
        own = values.mapping(entry, CAP_SELECTOR_KEYS, f"write {CAP_SELECTOR_EXAMPLE}")
        land, length, tongue, reach = (
            values.within(own, name, "length", 1e-5, values.MAX_LENGTH_M) for name in CAP_SELECTOR_KEYS
        )
        if reach <= land or tongue >= length:
            what = "the tongue of cap selector is no tongue in its bay"
            raise ConfigError(entry.value.where, what, "give reach above land, and tongue below length")
        return {"limit": land, "length": length, "tongue": tongue, "reach": reach}

    @property
    def lengths(self) -> tuple[float, ...]:
        """Land, length, tongue and reach [m], in the order of a file."""
        return self.limit, self.length, self.tongue, self.reach

    def value_text(self) -> str:
        return mapping_text(zip(CAP_SELECTOR_KEYS, map(length_text, self.lengths)))

    @property
    def value_words(self) -> str:
        size = f"bay of {length_words(self.length)}, land of {length_words(self.limit)}"
        return f"{size}, tongue of {length_words(self.tongue)} up to {length_words(self.reach)} off the wall"

    def document_values(self) -> Document:
        own = zip(CAP_SELECTOR_KEYS[1:], self.lengths[1:])
        return {"value_mm": self.limit / MM} | {f"{name}_mm": size / MM for name, size in own}

    def misfits(self, width: float) -> list[ConfigError]:
        if self.reach < width:
            return super().misfits(width)
        what = f"the tongue of cap selector reaches over the track: it is {1e3 * width:.4g} mm wide"
        return [ConfigError(self.where, what, "give a smaller reach, or a wider track")]

    def ring(self, width: float) -> Points:
        land, end, tongue, reach = self.lengths
        first, last = 0.5 * (end - tongue), 0.5 * (end + tongue)
        return np.array(
            [
                (0.0, width), (0.0, land), (first, land), (first, reach),
                (last, reach), (last, land), (end, land), (end, width),
            ]
        )  # fmt: skip

    def judged(self, encounter: Encounter) -> Verdict:
        """Return what it does with an orientation; not sure of one that rolls: it may ride from edge to edge.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        Verdict
        """
        outcome, rolls = super().judged(encounter), encounter.orientation.kind == "rolling"
        if not (rolls and outcome.margin < 0.0):
            return outcome
        return encounter.verdict(max(outcome.margin, -UNSURE), outcome.shift)

    @classmethod
    def proposals(
        cls,
        wanted: Sequence[Encounter],
        competitors: Sequence[Encounter],
        orientations: Sequence[LyingPart],
        where: str,
    ) -> "list[CapSelector]":
        """Return the surest selector for parts with a mouth, that of the least margin and free way.

        Parameters
        ----------
        wanted, competitors : sequence of Encounter
            Those that pass, and those that fall.
        orientations : sequence of LyingPart
            All of the part.
        where : str
            What asks for them.

        Returns
        -------
        list of CapSelector
            One; none where no competitor stands on a rim around its weight, or a wanted one does.
        """
        mouths = [one for one in competitors if one.mouth > LEAST_MOUTH_M]
        if not mouths or any(one.mouth > 0.0 or one.hanging for one in wanted):
            return []
        mouth = min(one.mouth for one in mouths)
        middle = max(one.orientation.distance for one in (*wanted, *mouths))
        longest = max(one.orientation.length for one in mouths)
        best, most = None, 0.0
        sizes = list(itertools.product(LANDS, LENGTHS, TONGUES, REACHES))
        for land, length, tongue, reach in sorted(sizes, key=lambda size: -_free_way(*size[1:])):
            free = _free_way(length, tongue, reach) * mouth
            if free <= most:  # nor has any of the rest a longer one
                break
            made = [
                round(size / SHOP_STEP_M) * SHOP_STEP_M
                for size in (land * middle, longest + length * mouth, tongue * mouth, middle + reach * mouth)
            ]
            selector = cls(where, made[0], length=made[1], tongue=made[2], reach=made[3])
            if selector.misfits(wanted[0].orientation.track.extent):
                continue
            margin = free
            for sign, encounters in ((1.0, wanted), (-1.0, mouths)):
                for one in encounters:
                    margin = min(margin, sign * selector.judged(one).margin) if margin > most else 0.0
            if margin > most:
                best, most = selector, margin
        return [best.rewritten()] if best else []


def _free_way(length: float, tongue: float, reach: float) -> float:
    """The way [1] over which neither tongue nor ends hold the rim: on a short one it catches as it tips.

    All are shares of the mouth's radius, the length that by which the bay is longer than the part.
    """
    return min(length, 2.0 * math.sqrt(1.0 - reach**2) - tongue)
