"""A silhouette that clears itself: a blade off the wall, over a narrowed track."""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from feederscrew.base import value_forms as forms
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import (
    UNSURE,
    Verdict,
    angle_text,
    degrees_words,
    length_text,
    length_words,
    mapping_text,
    room_of,
    tall_of,
)
from feederscrew.bowl.devices.blades import PROPOSED_SWEEP_RAD, StraightBlade
from feederscrew.bowl.devices.features import Blade, Features, TrackOpening, box_ring
from feederscrew.bowl.devices.ledges import SHOP_STEP_M
from feederscrew.bowl.devices.trade import Action, ProposedBy, Trade, ValueSearch
from feederscrew.bowl.devices.values import DeviceFields

if TYPE_CHECKING:
    import shapely

    from feederscrew.bowl.record import Track
else:
    shapely = heavy("shapely")  # a bowl without devices needs none of it

SILHOUETTE_KEYS = ("clearance", "reach", "leaves")
SILHOUETTE_EXAMPLE = "{clearance: 5 mm, reach: 3.5 mm, leaves: 8 mm, sweep: 30 deg}"
MIN_SWEEP_RAD = math.radians(5.0)  # [rad] the least of a blade
HIGHEST_M = 10.0  # [m] above any part
MOST_LEFT = 6.0  # [1] rooms beyond what carries the wanted ones, from which the width is taken at most
# [1] of the way from what carries the wanted ones to what the others need: with 100 push buttons in a full
# track 4 others left at a half of it (reach 3 mm, 7.45 mm left), 1 at 3.25 and 7.2 mm, none at 3.6 and 7.2 mm
KEPT_SHARE = 1.0 / 3.0
BLADES = 2  # of each room, one for what the other leaves
HEIGHTS = 12  # clearances that a design tries, evenly up to the tallest orientation
# [m] that parts come off the wall and askew: draws lost a push button to which blade and edge left 0.5 mm, in
# 5 of 14
PLAY_M = 5e-4
# [m] that wanted ones lie below the edge, and others stand above it at least: behind a lower blade, push
# buttons 1 mm taller than those that are wanted did not stand at one 0.2 to 0.3 mm above these
HEIGHT_ROOM_M = 2.5e-4
# [1] by which a height over a part counts more than the same way off the wall: parts come askew by more than
# they hop. Push buttons, thrown 0.06 mm high, passed below edges 0.2 to 0.5 mm above them alike; no other
# part was tried
HEIGHT_WEIGHT = 2.0
# [1] by which the way from a lower edge up to the tops of what it pushes counts, beside the way down to what
# passes below. Chosen on the push button, which is 11 mm high: its lower blade comes to 7.75 mm for 5.8 mm,
# where one that was wanted stood, and its higher one stays at 11.3 mm, where none did
RIM_WEIGHT = 0.5
# [m] rooms beside the play, of which a design tries the blades that return most
ROOMS_M = (5e-4, 2.5e-4)


@dataclass(frozen=True)
class SilhouetteBlade(StraightBlade):
    """A blade that stands out from the wall over a narrowed track, and pushes off what is in its way.

    Its lower edge lies ``limit`` over the track, and it ends ``reach`` off the wall. Of a part that has
    material above that edge and nearer to the wall, it pushes this out as far as it reaches. The track below
    is only ``leaves`` wide: a part that is pushed so far that its weight lies beyond this falls off. A part
    whose silhouette leaves the blade room travels on along the wall. Nothing stands before it as before a
    profile gate, but where its face pushes at the rim of a tall part alone, that may tip and stand.
    """

    reach: float = 0.0  # [m] off the wall, up to which the blade stands out
    leaves: float = math.inf  # [m] width of the track that is left below it

    kind = "silhouette blade"
    trade = Trade(
        SILHOUETTE_EXAMPLE,
        "blade that stands out from the wall so far, at that clearance over a track of which that width is "
        "left: what has material in its way is pushed out by it, along a face of that sweep, and falls off "
        "the narrowed track; what leaves it room travels on along the wall; friction: 0.2 is that of the "
        "face",
        forms.mapping(
            ("friction",),
            **dict.fromkeys(SILHOUETTE_KEYS, forms.LENGTH_FORM),
            sweep=forms.ANGLE_FORM,
            friction=forms.quantity("number", "0", "5"),
        ),
        measures="distance of what stands above a height from the wall",
    )
    action = Action.PUSH
    search = ValueSearch(ProposedBy.VALUE)

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
        mend = f"write {SILHOUETTE_EXAMPLE}"
        own = values.mapping(entry, (*SILHOUETTE_KEYS, "sweep", "friction"), mend, ("friction",))
        fields: DeviceFields = {
            name: values.within(own, key, "length", 1e-5, values.MAX_LENGTH_M)
            for key, name in zip(SILHOUETTE_KEYS, ("limit", "reach", "leaves"))
        }
        fields["sweep"] = values.within(own, "sweep", "angle", MIN_SWEEP_RAD, 0.5 * math.pi)
        if "friction" in own:
            fields["friction"] = values.within(own, "friction", "number", 0.0, 5.0)
        return fields

    def misfits(self, width: float) -> list[ConfigError]:
        if self.reach < min(self.leaves, width):
            return []
        what = f"{self.kind} reaches over the free edge, {1e3 * min(self.leaves, width):.4g} mm off the wall"
        return [ConfigError(self.where, what, "give a smaller reach, or a wiper, which goes on so far")]

    def value_text(self) -> str:
        lengths = (self.limit, self.reach, self.leaves)
        return mapping_text(
            (
                *zip(SILHOUETTE_KEYS, map(length_text, lengths)),
                ("sweep", angle_text(self.sweep)),
                ("friction", "" if self.friction is None else f"{self.friction:.9g}"),
            )
        )

    @property
    def value_words(self) -> str:
        place = f"up to {length_words(self.reach)} off the wall, {length_words(self.limit)} over the track"
        return f"{place}, swept back {degrees_words(self.sweep)}; leaves {length_words(self.leaves)} of track"

    def document_values(self) -> Document:
        own = {"reach_mm": self.reach / MM, "leaves_mm": self.leaves / MM}
        return super().document_values() | own | self.face_values()

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        room, ahead = room_of(orientations), self.reach / math.tan(self.sweep)
        face = shapely.box(
            0.0, self.limit, self.reach / math.sin(self.sweep), tall_of(orientations, self.limit)
        )
        blade = Blade(face, (0.5 * room, 0.0), self.sweep, friction=self.friction)
        length = 1.5 * room + ahead  # what is pushed out has a room to fall
        if self.leaves >= track.extent:
            return Features(length, blades=(blade,))
        span = self.leaves, track.extent
        return Features(length, openings=(TrackOpening(box_ring(0.0, length, *span), span),), blades=(blade,))

    def cutting_more(self, by: float) -> "SilhouetteBlade | None":
        """Return the blade that reaches farther and leaves less track, each by a length.

        Parameters
        ----------
        by : float [m]

        Returns
        -------
        SilhouetteBlade or None
            None where it would reach nothing, or over the edge of what it leaves.
        """
        step = round(by / SHOP_STEP_M) * SHOP_STEP_M
        reach, leaves = self.reach + step, self.leaves - step
        return replace(self, reach=reach, leaves=leaves).rewritten() if 0.0 < reach < leaves else None

    def judged(self, encounter: Encounter, sweep: float = 0.0) -> Verdict:
        """Return what it does with an orientation.

        A part comes up to a play off the wall, ``PLAY_M``. Let d be the distance of the blade, longer by that
        play, from the part's outline seen along the track, heights counting twice. Let b be the width that
        carries the part, and w the width that is left. It passes by min(d, w - play - b); where w - b is
        from 0 up to the play it is not sure. One that is not carried fails by b - w. One with material in the
        way of the blade, up to h above the clearance and from n off the wall on, is pushed by r - n, r being
        the reach. It fails by min(h, r - n, b + r - n - w): it has to be in the way, and to lose its support.
        Where that is not positive it is not sure. One that is in the way and not carried either fails by the
        greater of the two. What the blade
        lays over falls off too: there is no track beside it.

        Parameters
        ----------
        encounter : Encounter
        sweep : float, optional
            Not used: it has its own.

        Returns
        -------
        Verdict
        """
        own = encounter.orientation
        needed = own.balcony if math.isfinite(own.balcony) else self.leaves + own.axial_foot.reach
        kept, view = self.leaves - needed, own.view_ahead
        carried = -UNSURE if 0.0 <= kept < PLAY_M else kept - PLAY_M
        in_way = shapely.clip_by_rect(view, -HIGHEST_M, self.limit, self.reach, HIGHEST_M)
        if in_way.is_empty or in_way.area <= 0.0:
            stretched = shapely.transform(view, lambda points: points * (1.0, HEIGHT_WEIGHT))
            edge, top = HEIGHT_WEIGHT * self.limit, HEIGHT_WEIGHT * HIGHEST_M
            room = stretched.distance(shapely.box(-HIGHEST_M, edge, self.reach + PLAY_M, top))
            return encounter.verdict(min(room, carried) if kept >= 0.0 and room > 0.0 else min(kept, -UNSURE))
        near, _, _, top = in_way.bounds
        pushed = min(self.reach - near, top - self.limit, self.reach - near - kept)
        return encounter.verdict(-max(-kept, pushed, UNSURE))

    @classmethod
    def proposals(
        cls,
        wanted: Sequence[Encounter],
        competitors: Sequence[Encounter],
        orientations: Sequence[LyingPart],
        where: str,
    ) -> "list[SilhouetteBlade]":
        """Return blades that let some orientations pass, the lowest first.

        At a clearance let n be the least distance of the wanted orientations' material from the wall, and b
        the greatest width that carries one of them (see ``judged``). A blade with the reach r = n - p - play
        gives them a room p beside the play. Another one of n', b' is pushed off every track narrower than
        b' + r - n', if r - n' >= p; without a push it falls where the track is narrower than b'. The width
        that is left lies a third of the way from b + play to the least of those widths, which counts up to
        ``MOST_LEFT`` rooms at most. Reach and width are whole steps of the shop. Of each
        room p of ``ROOMS_M`` the blade that returns most by pushing alone is taken, and the one that returns
        most of the rest. Then the same is done, and what falls without a push counts as well. Where several
        clearances return the same, that with the most room at its edge is taken (``_room_of_edge``).

        Parameters
        ----------
        wanted, competitors : sequence of Encounter
            Those that pass, and those that are pushed off.
        orientations : sequence of LyingPart
            All of the part.
        where : str
            What asks for them.

        Returns
        -------
        list of SilhouetteBlade
            None twice. A low blade meets others with more of its face. In a full track of push buttons,
            90 s of each order, none stood with the lower blade in front (89 of 91 left right), and 2 at the
            higher one where that was in front (82 of 83), before contacts at hollow edges were mended.
        """
        lying = [one.orientation for one in wanted]
        others = [one.orientation for one in competitors]
        carried = max((one.balcony for one in lying), default=math.inf)
        if not others or not math.isfinite(carried) or any(one.hanging for one in wanted):
            return []
        needed = np.array([min(one.balcony, HIGHEST_M) for one in others])  # of one that nothing carries
        views: list[tuple[float, float, Floats]] = []  # clearance, n, n' of the others
        for height in _clearances(lying, others):
            near = min(nearest_above(one, height - HEIGHT_ROOM_M) for one in lying)
            views.append(
                (height, near, np.array([nearest_above(one, height + HEIGHT_ROOM_M) for one in others]))
            )
        proposed: dict[str, SilhouetteBlade] = {}
        cuts_by_pushing: set[tuple[float, float]] = set()  # reach, and track that is left
        for room in ROOMS_M:
            falls_anyway = frozenset(np.flatnonzero(needed - carried >= 2.0 * room + PLAY_M).tolist())
            for by_pushing in (True, False):
                made: list[BladeCandidate] = []
                for height, near, other in views:
                    farthest = min(near - room - PLAY_M, carried)  # it ends over the track that is left
                    reach = math.floor(farthest / SHOP_STEP_M + 1e-6) * SHOP_STEP_M
                    pushed = reach - other
                    widths = np.where(pushed >= room, needed + pushed, -math.inf if by_pushing else needed)
                    falls = widths - carried >= 2.0 * room + PLAY_M
                    if reach > 0.0 and falls.any():
                        least = min(float(widths[falls].min()), carried + PLAY_M + MOST_LEFT * room)
                        width = carried + PLAY_M + KEPT_SHARE * (least - carried - PLAY_M)
                        leaves = math.floor(width / SHOP_STEP_M) * SHOP_STEP_M
                        met = [others[k] for k in np.flatnonzero(falls & (pushed >= room))]
                        room_of_edge = _room_of_edge(height, reach, lying, met)
                        returned = frozenset(np.flatnonzero(falls).tolist())
                        made.append(BladeCandidate(returned, height, reach, leaves, room_of_edge))
                for one in choose_blades(made, falls_anyway):
                    cut = one.reach, one.leaves
                    if by_pushing:
                        cuts_by_pushing.add(cut)
                    elif cut in cuts_by_pushing:  # proposed already, at a clearance with more room
                        continue
                    blade = cls(
                        where, limit=one.height, sweep=PROPOSED_SWEEP_RAD, reach=one.reach, leaves=one.leaves
                    )
                    if not blade.misfits(lying[0].track.extent):
                        proposed.setdefault(blade.value_text(), blade.rewritten())
        return sorted(proposed.values(), key=lambda blade: blade.limit)


@functools.lru_cache(maxsize=8192)
def nearest_above(orientation: LyingPart, height: float) -> float:
    """Return how near to the wall an orientation has material above a height.

    Parameters
    ----------
    orientation : LyingPart
    height : float [m]
        Over the track.

    Returns
    -------
    float [m]
        Infinite where nothing of it is so high.

    References
    ----------
    docs/tooling.md, "What becomes of a part that does not pass".
    """
    above = shapely.clip_by_rect(orientation.view_ahead, -HIGHEST_M, height, HIGHEST_M, HIGHEST_M)
    return math.inf if above.is_empty else float(above.bounds[0])


class BladeCandidate(NamedTuple):
    """A blade that may be proposed."""

    returned: frozenset[int]  # the other orientations that fall at it
    height: float  # [m] its clearance
    reach: float  # [m]
    leaves: float  # [m]
    room_of_edge: float  # [m] as of ``_room_of_edge``


def choose_blades(made: Sequence[BladeCandidate], falls_anyway: frozenset[int]) -> list[BladeCandidate]:
    """Return of candidates the one that returns most, and the one that returns most of the rest.

    Each in turn then gives way to the one whose edge has the most room, among those that leave no less track
    and return all that it alone returns. What falls without a push at both, ``falls_anyway``, is not asked of
    either.

    Parameters
    ----------
    made : sequence of BladeCandidate
    falls_anyway : frozenset of int
        Other orientations that no such track carries.

    Returns
    -------
    list of BladeCandidate
        ``BLADES`` at most; empty without candidates.
    """
    chosen: list[BladeCandidate] = []
    left = frozenset[int]().union(*(one.returned for one in made))
    while len(chosen) < BLADES and any(left & one.returned for one in made):
        best = max(made, key=lambda one: (len(left & one.returned), one.leaves, one.room_of_edge))
        chosen.append(best)
        left -= best.returned
    for k, one in enumerate(chosen):
        rest = (other.returned for other in chosen if other is not one)  # the first as it was chosen by now
        alone = one.returned.difference(falls_anyway, *rest)
        if alone:
            alike = [other for other in made if other.returned >= alone and other.leaves >= one.leaves]
            chosen[k] = max(alike, key=lambda other: other.room_of_edge)
    return chosen


@functools.lru_cache(maxsize=8192)
def _top_within(orientation: LyingPart, reach: float) -> float:
    """Height over the track [m] up to which an orientation has material nearer to the wall than a reach."""
    near = shapely.clip_by_rect(orientation.view_ahead, -HIGHEST_M, -HIGHEST_M, reach, HIGHEST_M)
    return 0.0 if near.is_empty else float(near.bounds[3])


def _room_of_edge(
    clearance: float, reach: float, wanted: Sequence[LyingPart], met: Sequence[LyingPart]
) -> float:
    """How far a lower edge lies above what passes below it, or half of how far below the tops of the others.

    The lesser of the two [m]. Low over what passes, the edge holds down a part that comes askew and is about
    to fall off. A face that pushes at the rim of a part tips it, and does not push it aside.
    """
    above = max(_top_within(one, reach) for one in wanted)
    tops = min((_top_within(one, reach) for one in met), default=HIGHEST_M)
    return min(clearance - above, RIM_WEIGHT * (tops - clearance))


def _clearances(wanted: Sequence[LyingPart], others: Sequence[LyingPart]) -> list[float]:
    """Clearances [m] that a design tries, each a whole multiple of ``SHOP_STEP_M``.

    Evenly up to the tallest orientation, and just above the tallest one that is wanted.
    """
    above = max(one.height for one in wanted)
    tallest = max(above, *(one.height for one in others))
    even = np.linspace(0.0, tallest, HEIGHTS + 2)[1:-1]
    steps = np.round(np.append(even, above + HEIGHT_ROOM_M + SHOP_STEP_M) / SHOP_STEP_M)
    return [float(step) * SHOP_STEP_M for step in np.unique(steps) if step > 0.0]
