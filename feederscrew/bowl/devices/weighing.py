"""Balance gap: tells which end of a part is the heavy one, by a gap and a hold-down farther along the track.

The grounds of its formulas, and where they hold: docs/tooling.md, "A balance gap".
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.base import value_forms as forms
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.units import MM
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import (
    STOPPED,
    UNSURE,
    Verdict,
    length_text,
    length_words,
    mapping_text,
    tall_of,
)
from feederscrew.bowl.devices.features import BLADE, Blade, Features
from feederscrew.bowl.devices.ledges import SHOP_STEP_M
from feederscrew.bowl.devices.openings import Gap
from feederscrew.bowl.devices.trade import ProposedBy, Trade, ValueSearch
from feederscrew.bowl.devices.values import DeviceFields

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

BALANCE_GAP_KEYS = ("gap", "clearance", "hold")
BALANCE_GAP_EXAMPLE = "{gap: 23 mm, clearance: 8.3 mm, hold: 14 mm}"
# [rad] by which a part may tip back, nose up and tail down, until it meets the hold-down: in trials of a fork
# of 40 mm, 8 parts at each angle, all pass with up to 11 deg, and all stand with 15; half of 11 for others
MAX_TILT_RAD = math.radians(5.0)
TILT_PLACES = (
    9  # of a part on the far edge, from its tail's end to its weight, at which its tilt is looked at
)
FAR_M = 10.0  # [m] beyond any part
STEP_M = 5e-5  # [m] over the track: an underside that is nowhere higher than that slides over the far edge
# what a design tries
LEAST_WAY_M = 5e-4  # [m] of room, more than the flight along the track and than the hop below the hold-down


@dataclass(frozen=True)
class BalanceGap(Gap):
    """A gap across the track, and a hold-down farther along it.

    A gap alone treats both ends of a part alike: it has to be shorter than both ways from the part's weight
    to the ends of its foot. The hold-down keeps the tail up once the nose is below it. So the way ahead
    decides: a part with its light end ahead passes, and one with its heavy end ahead falls.
    """

    clearance: float = math.inf  # [m] of the hold-down over the track
    hold: float = 0.0  # [m] from the gap's far edge to the hold-down, along the wall

    kind = "balance gap"
    trade = Trade(
        BALANCE_GAP_EXAMPLE,
        "gap across the track, and behind it, at the way hold, a hold-down at that clearance: lets fall "
        "parts that come with their heavy end ahead, and carries those with their light end ahead",
        forms.mapping(**dict.fromkeys(BALANCE_GAP_KEYS, forms.LENGTH_FORM)),
        measures="reach of the foot ahead of the centre of mass",
    )
    search = ValueSearch(ProposedBy.VALUE)

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
        own = values.mapping(entry, BALANCE_GAP_KEYS, f"write {BALANCE_GAP_EXAMPLE}")
        gap, clearance, hold = (
            values.within(own, name, "length", 1e-5, values.MAX_LENGTH_M) for name in BALANCE_GAP_KEYS
        )
        return {"limit": gap, "clearance": clearance, "hold": hold}

    @property
    def lengths(self) -> tuple[float, ...]:
        """Gap, clearance and hold [m], in the order of a file."""
        return self.limit, self.clearance, self.hold

    def value_text(self) -> str:
        return mapping_text(zip(BALANCE_GAP_KEYS, map(length_text, self.lengths)))

    @property
    def value_words(self) -> str:
        bar = f"hold-down {length_words(self.clearance)} over the track"
        return f"{length_words(self.limit)}, {bar}, {length_words(self.hold)} behind it"

    def document_values(self) -> Document:
        own = {"clearance_mm": self.clearance / MM, "hold_mm": self.hold / MM}
        return {"value_mm": self.limit / MM} | own

    def bar_place(self, radius: float) -> float:
        """Return how far the hold-down is from the near edge along a wall of a radius, both [m]."""
        return radius * math.asin(min(self.limit / radius, 1.0)) + self.hold

    def hold_below(self, part: LyingPart) -> float:
        """Return the way from the far edge to the hold-down where the weight of a part goes [m].

        The hold-down is radial, the gap's edges are parallel: nearer to the bowl's axis the way is shorter.
        """
        radius = part.track.radius
        return (radius - part.distance) * self.bar_place(radius) / radius - self.limit

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        gap = super().features(track, orientations)
        plate = shapely.box(0.0, self.clearance, track.extent, tall_of(orientations, self.clearance))
        bar = Blade(plate, foot=(self.bar_place(track.radius), 0.0))
        return replace(gap, length=max(gap.length, bar.foot[0] + bar.thickness), blades=(bar,))

    def judged(self, encounter: Encounter) -> Verdict:
        """Return what it does with an orientation.

        One whose foot reaches less far ahead of its weight than the gap is long tips over the near edge. It
        surely falls where the gap is longer than its nose swings (``LyingPart.nose_swing``) and than it flies
        besides. Any other stands at the hold-down if it is higher, and passes if that holds it (``held``). It
        passes by what its foot reaches beyond the gap and its flight, and by what is free over its hop.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        Verdict
        """
        part = encounter.orientation
        if encounter.hanging:  # what hangs swings about its head
            return encounter.verdict(-UNSURE)
        if part.ahead < self.limit:
            return encounter.verdict(min(part.nose_swing + part.flight - self.limit, -UNSURE))
        below = self.clearance - part.height
        if below < 0.0:
            below = min(below + part.hop, -UNSURE)
            return encounter.verdict(encounter.unless_laid_over(below, self.clearance))
        margin = min(part.ahead - self.limit - part.flight, below - part.hop)
        held = self.held(encounter)
        return encounter.verdict(max(min(margin, held), 0.0) if held >= 0.0 else -UNSURE)

    def hop_blur(self, orientation: LyingPart) -> float:
        """Return 0: ``judged`` takes hop and flight off what they concern."""
        return 0.0

    def held(self, encounter: Encounter) -> float:
        """Return by how much the far edge and the hold-down carry an orientation whose tail is over the gap.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        float [m]
            The lesser of two ways: how far its top reaches beyond the hold-down as its tail leaves the near
            edge, less its flight; and, of what does not roll, how far its weight is from the sides of the
            foot on the far edge. Infinite where its tail rests on the near edge until its weight is on the
            far one. -inf where it tips back by more than ``MAX_TILT_RAD`` below the hold-down, or its
            underside has a step that meets the far edge.
        """
        part = encounter.orientation
        first = self.limit - part.behind  # how far ahead of the weight the far edge is as the tail leaves
        if first <= 0.0:
            return math.inf
        sole = part.aside.intersection(shapely.box(-part.behind, -FAR_M, first, STEP_M))
        ways = (shapely.box(piece.bounds[0], 0.0, piece.bounds[2], 1.0) for piece in shapely.get_parts(sole))
        if shapely.union_all(list(ways)).area < self.limit - STEP_M:
            return -math.inf
        hold = self.hold_below(part)
        level = self.clearance - hold * math.tan(MAX_TILT_RAD)
        for edge in np.linspace(first, 0.0, TILT_PLACES):
            place = edge + hold
            below = part.aside.intersection(shapely.box(place, -FAR_M, place + BLADE, FAR_M))
            if below.is_empty or below.bounds[3] < level:
                return -math.inf
        beyond = _foremost(part, level) - (first + hold + BLADE) - part.flight
        # what rolls cannot tip to its side
        return beyond if part.kind == "rolling" else min(beyond, encounter.astride(first))

    def swings_clear(self, orientation: LyingPart) -> bool:
        return orientation.nose_swing <= self.limit

    def fate(self, encounter: Encounter) -> str:
        part = encounter.orientation
        reaches = part.ahead >= self.limit or part.nose_swing > self.limit
        return STOPPED if reaches else super().fate(encounter)

    @classmethod
    def proposals(
        cls,
        wanted: Sequence[Encounter],
        competitors: Sequence[Encounter],
        orientations: Sequence[LyingPart],
        where: str,
    ) -> "list[BalanceGap]":
        """Return the gap midway between the foot that wanted ones have ahead and the widest swing of a nose.

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
        list of BalanceGap
            One; none where no competitor falls at it for sure, a gap alone carries what is wanted, or what
            is wanted hangs or does not pass for sure.
        """
        parts = [one.orientation for one in wanted]
        if any(one.hanging for one in wanted):
            return []
        ahead, way = min(part.ahead for part in parts), LEAST_WAY_M + max(part.flight for part in parts)
        swings = [one.orientation.nose_swing for one in competitors if not one.hanging]
        swings = [swing for swing in swings if swing <= ahead - 2.0 * way]
        if not swings:
            return []
        gap = _whole_steps(0.5 * (ahead + max(swings)))
        if min(part.behind for part in parts) >= gap:
            return []
        clear = max(part.height + part.hop + LEAST_WAY_M for part in parts)
        clearance = -_whole_steps(-clear)
        top = min(_foremost(part, part.height) - (gap - part.behind) for part in parts)
        below = top - BLADE - way  # from the far edge to the hold-down where the weight goes
        radius, off = parts[0].track.radius, min(part.distance for part in parts)
        plain = cls(where, gap, clearance=clearance)
        hold = _whole_steps(radius * (gap + below) / (radius - off) - plain.bar_place(radius))
        if hold <= 0.0:
            return []
        device = replace(plain, hold=hold).rewritten()
        return [device] if all(device.judged(one).margin > 0.0 for one in wanted) else []


def _whole_steps(length: float) -> float:
    """The multiple of a shop's step that is not above a length [m]."""
    return math.floor(length / SHOP_STEP_M + 1e-6) * SHOP_STEP_M


def _foremost(part: LyingPart, level: float) -> float:
    """How far ahead of its weight an orientation is as high as a level [m]; -inf where it is nowhere."""
    high = part.aside.intersection(shapely.box(-FAR_M, level - SHOP_STEP_M, FAR_M, FAR_M))
    return -math.inf if high.is_empty else float(high.bounds[2])
