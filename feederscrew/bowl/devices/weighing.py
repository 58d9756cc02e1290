"""Balance gap: tells which end of a part is the heavy one, by a gap and a hold-down behind it."""

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
# [rad] by which a part tips back below the hold-down: in trials of a fork of 40 mm, 8 parts each, all pass
# with up to 11 deg, and all stand with 15
MAX_TILT_RAD = math.radians(5.0)
TILT_PLACES = 9  # of the far edge below the part, at which the hold-down has to meet it
FAR_M = 10.0  # [m] beyond any part
STEP_M = 5e-5  # [m] over the track: a foot that is nowhere higher slides up over the far edge
# what a design tries
LEAST_WAY_M = 5e-4  # [m] beside the flight, by which parts pass, fall and are held
LEAST_PLAY_M = 3e-4  # [m] beside the hop, below the hold-down


@dataclass(frozen=True)
class BalanceGap(Gap):
    """A gap across the track, and a hold-down at a way behind it.

    A gap alone treats both ends of a part alike: the part needs it to be shorter than both ways from its
    weight to the ends of its foot. The hold-down keeps the tail up once the nose is below it. So only the way
    ahead counts: the light end first passes, the heavy end first falls.
    """

    clearance: float = math.inf  # [m] of the hold-down over the track
    hold: float = 0.0  # [m] from the gap's far edge to the hold-down

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

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        gap = super().features(track, orientations)
        plate = shapely.box(0.0, self.clearance, track.extent, tall_of(orientations, self.clearance))
        bar = Blade(plate, foot=(gap.length + self.hold, 0.0))
        return replace(gap, length=gap.length + self.hold + bar.thickness, blades=(bar,))

    def judged(self, encounter: Encounter) -> Verdict:
        """Return what it does with an orientation, by the way from its weight to the end of its foot ahead.

        It falls where its nose swings past the far edge: see ``LyingPart.nose_swing``. Where it tips over the
        near edge, but its nose may meet the far one, the verdict is not sure.

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
        """Return 0: each of its margins is less the hop or the flight already, as ``judged`` says."""
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
            foot on the far edge.
            Infinite where its tail reaches the near edge to the end. -inf where it tips back by more than
            ``MAX_TILT_RAD`` below the hold-down, or its underside has a step that meets the far edge.
        """
        part = encounter.orientation
        first = self.limit - part.behind  # of the far edge, ahead of the weight, as the tail leaves the near
        if first <= 0.0:
            return math.inf
        sole = part.aside.intersection(shapely.box(-part.behind, -FAR_M, first, STEP_M))
        ways = (shapely.box(piece.bounds[0], 0.0, piece.bounds[2], 1.0) for piece in shapely.get_parts(sole))
        if shapely.union_all(list(ways)).area < self.limit - STEP_M:
            return -math.inf
        level = self.clearance - self.hold * math.tan(MAX_TILT_RAD)
        for edge in np.linspace(first, 0.0, TILT_PLACES):
            place = edge + self.hold
            below = part.aside.intersection(shapely.box(place, -FAR_M, place + BLADE, FAR_M))
            if below.is_empty or below.bounds[3] < level:
                return -math.inf
        beyond = _foremost(part, level) - (first + self.hold + BLADE) - part.flight
        # what rolls cannot tip to its side
        return beyond if part.kind == "rolling" else min(beyond, encounter.astride(first))

    def swings_clear(self, orientation: LyingPart) -> bool:
        return orientation.nose_swing <= self.limit

    def fate(self, encounter: Encounter) -> str:
        part = encounter.orientation
        reaches = part.ahead >= self.limit or math.hypot(part.ahead, part.height) > self.limit
        return STOPPED if reaches else super().fate(encounter)

    @classmethod
    def proposals(
        cls,
        wanted: Sequence[Encounter],
        competitors: Sequence[Encounter],
        orientations: Sequence[LyingPart],
        where: str,
    ) -> "list[BalanceGap]":
        """Return the gap midway between what the wanted ones carry and what the heavy ends swing past.

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
            One; none where no competitor falls at it for sure, or a gap alone does the same.
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
        clear = max(part.height + max(LEAST_PLAY_M, part.hop + LEAST_WAY_M) for part in parts)
        clearance = -_whole_steps(-clear)
        top = min(_foremost(part, part.height) - (gap - part.behind) for part in parts)
        hold = _whole_steps(top - BLADE - way)
        if hold <= 0.0:
            return []
        device = cls(where, gap, clearance=clearance, hold=hold).rewritten()
        return [device] if all(device.judged(one).margin > 0.0 for one in wanted) else []


def _whole_steps(length: float) -> float:
    """The multiple of a shop's step that is not above a length [m]."""
    return math.floor(length / SHOP_STEP_M + 1e-6) * SHOP_STEP_M


def _foremost(part: LyingPart, level: float) -> float:
    """How far ahead of its weight an orientation is as high as a level [m]; -inf where it is nowhere."""
    high = part.aside.intersection(shapely.box(-FAR_M, level - SHOP_STEP_M, FAR_M, FAR_M))
    return -math.inf if high.is_empty else float(high.bounds[2])
