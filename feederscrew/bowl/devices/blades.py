"""Blades over the track: wiper, height bar and hold-down; and the profile gate."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np
import shapely

from feederscrew.base import value_forms as forms
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError
from feederscrew.bowl.devices import air_assist, orientation_names, values
from feederscrew.bowl.devices.air_assist import AirAssist
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import (
    RETURNED,
    Device,
    Verdict,
    angle_text,
    corners_text,
    degrees_words,
    gate_features,
    length_text,
    length_words,
    mapping_text,
    room_of,
    tall_of,
)
from feederscrew.bowl.devices.features import Blade, Features, Jet
from feederscrew.bowl.devices.pneumatics import AirJet
from feederscrew.bowl.devices.trade import IS_ANGLE, Action, Bound, ProposedBy, Trade, ValueSearch
from feederscrew.bowl.devices.values import Corner, DeviceFields

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

SQUARE_FACE_RAD = 0.5 * math.pi  # [rad] of the face to the direction of travel: straight across the track
PROPOSED_SWEEP_RAD = math.radians(30.0)  # [rad] that a design tries: 20 to 35 deg clear fastest
BEYOND_TRACK_M = 10.0  # [m] beyond any track
MAX_OPENING_HEIGHT_M = 1.0  # [m] no opening is higher
SWEPT = forms.mapping(
    ("sweep", "friction", "contour", "air"),
    clearance=forms.LENGTH_FORM,
    sweep=forms.ANGLE_FORM,
    friction=forms.quantity("number", "0", "5"),
    contour=forms.POLYGON | {"minItems": 1},
    air=air_assist.FORM,
)


@dataclass(frozen=True)
class Overhead(Device):
    """A blade over the track at one clearance, open to the free edge."""

    action: ClassVar[Action] = Action.OVERHEAD
    search: ClassVar[ValueSearch] = ValueSearch(bound=Bound.UPPER, limited_by="height")

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        free = shapely.box(0.0, 0.0, track.extent, self.limit)
        return gate_features(free, orientations, track.extent, is_gate=False)

    @property
    def value_words(self) -> str:
        return f"{length_words(self.limit)} over the track"

    def judged(self, encounter: Encounter, sweep: float = 0.0) -> Verdict:
        margin = self.limit - encounter.orientation.height
        return encounter.verdict(encounter.unless_laid_over(margin, self.limit, sweep))


@dataclass(frozen=True)
class SweptBlade(Overhead):
    """A blade whose face leads off the free edge, with or without air along it."""

    air: AirAssist | None = None  # a steady nozzle at its foot

    def chord(self, track: "Track") -> float:
        """Return the angle to the direction of travel of the straight way from its foot to its end.

        Parameters
        ----------
        track : Track

        Returns
        -------
        float [rad]
        """
        raise NotImplementedError

    @property
    def lowest(self) -> float:
        """Return the least height of its edge over the track [m]."""
        return self.limit

    @property
    def cost_class(self) -> int:
        return super().cost_class if self.air is None else max(super().cost_class, AirJet.trade.cost_class)

    def with_air(self, air: AirAssist | None) -> Self:
        """Return the same blade with other air along its face, or without.

        Parameters
        ----------
        air : AirAssist or None

        Returns
        -------
        SweptBlade
        """
        return replace(self, air=air).rewritten()

    def force_along_face(self, orientation: LyingPart) -> tuple[float, float]:
        if self.air is None:
            return 0.0, 0.0
        least = self.air.least_at_face(orientation, self.chord(orientation.track), self.lowest)
        return least.along, least.off

    def judged(self, encounter: Encounter, sweep: float = 0.0) -> Verdict:
        return self._with_air_on(encounter, super().judged(encounter, sweep))

    def _with_air_on(self, encounter: Encounter, verdict: Verdict) -> Verdict:
        """The verdict on a part with the air on it, where it passes below the blade."""
        if self.air is None or verdict.margin < 0.0:
            return verdict
        heading = self.chord(encounter.orientation.track)
        return encounter.verdict(self.air.passing_margin(encounter, heading, verdict.margin))

    def _jets(self, foot: float, track: "Track") -> tuple[Jet, ...]:
        return () if self.air is None else (self.air.jet(foot, self.chord(track)),)

    @property
    def _air_words(self) -> str:
        return "" if self.air is None else f", {self.air.words}"

    @property
    def shop_words(self) -> tuple[str, ...]:
        return () if self.air is None else (self.air.shop_words,)

    def document_values(self) -> Document:
        return super().document_values() | ({} if self.air is None else self.air.document_values())


@dataclass(frozen=True)
class StraightBlade(SweptBlade):
    """A blade whose face is one flat plate at an angle to the direction of travel."""

    sweep: float = field(
        default=SQUARE_FACE_RAD, metadata=IS_ANGLE
    )  # [rad] of the face to the direction of travel
    friction: float | None = None  # [1] of the face; None: that of the track

    def chord(self, track: "Track") -> float:
        return self.sweep

    @property
    def face(self) -> tuple[float, float | None] | None:
        """Its sweep [rad] and friction [1], None: that of the track; None of one straight across."""
        return (self.sweep, self.friction) if self.sweep < SQUARE_FACE_RAD else None

    def clear_of(self, grip: float) -> bool:
        """Tell whether its face sweeps parts off a track: sweep below 90 deg less the angle of friction.

        Parameters
        ----------
        grip : float [1]
            Friction of the track, that of a face of which nothing else is said.

        Returns
        -------
        bool
        """
        friction = grip if self.friction is None else self.friction
        return self.face is not None and self.sweep < SQUARE_FACE_RAD - math.atan(friction)

    def fate(self, encounter: Encounter) -> str:
        if encounter.hanging:  # rails hold what hangs
            return super().fate(encounter)
        clears = self.clear_of(encounter.grip)
        if not clears and self.air is not None:
            friction = encounter.grip if self.friction is None else self.friction
            clears = self.air.clears(encounter, self.sweep, friction, self.lowest)
        return RETURNED if clears else super().fate(encounter)

    def face_values(self) -> Document:
        """Return sweep and friction of its face for a document.

        Returns
        -------
        dict of str to float
        """
        own: Document = {"sweep_deg": math.degrees(self.sweep)}
        return own | ({} if self.friction is None else {"friction": self.friction})


@dataclass(frozen=True)
class Wiper(StraightBlade):
    """A blade over the track, which clears itself where its face sweeps parts off the free edge."""

    contour: tuple[tuple[float, float], ...] = ()  # [m] distance from the wall and clearance there

    kind = "wiper"
    trade = Trade(
        "6 mm",
        "blade at a clearance over the track that holds up orientations that stand higher; straight across "
        "it stops them, {clearance: 6 mm, sweep: 30 deg, friction: 0.2} sweeps them off the free edge: below "
        "90 deg - atan(friction); contour: [[0 mm, 6 mm], [9 mm, 4 mm]] gives it a lower edge of its own; "
        "air: {nozzle: 2 mm, pressure: 0.3 bar, height: 8 mm} blows steadily along a swept face and takes "
        "off what stands at it",
        forms.either(forms.LENGTH_FORM, SWEPT),
        measures="height",
    )
    search = ValueSearch(ProposedBy.VALUE, Bound.UPPER, "height", rank=5)

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
        fields = values.blade(entry, ("air",))
        air = next((item for item in entry.value.entries if item.key == "air"), None)
        if air is None:
            return fields
        if not fields.get("sweep", SQUARE_FACE_RAD) < SQUARE_FACE_RAD:
            what = "the air of wiper has no face to blow along"
            raise ConfigError(air.where, what, "give the wiper a sweep, as sweep: 30 deg")
        return fields | {"air": air_assist.read(air)}

    def misfits(self, width: float) -> list[ConfigError]:
        heights = [height for _, height in self.contour]
        if all(later <= before for before, later in itertools.pairwise(heights)):
            return []
        what = "the contour of wiper rises towards the free edge: parts slip below it as they are swept"
        return [ConfigError(self.where, what, "let it stay level or fall")]

    @classmethod
    def proposal(cls, where: str, limit: float) -> Self:
        return cls(where, limit=limit, sweep=PROPOSED_SWEEP_RAD)

    def value_text(self) -> str:
        if not (self.face or self.contour or self.friction is not None):
            return super().value_text()
        return mapping_text(
            (
                ("clearance", length_text(self.limit)),
                ("sweep", angle_text(self.sweep) if self.face else ""),
                ("friction", "" if self.friction is None else f"{self.friction:.9g}"),
                ("contour", corners_text(self.contour) if self.contour else ""),
                ("air", "" if self.air is None else self.air.text),
            )
        )

    @property
    def value_words(self) -> str:
        sweep = f", swept back {degrees_words(self.sweep)}" if self.face else ""
        edge = "edge of its own" if self.contour else f"{length_words(self.limit)} over the track"
        return edge + sweep + self._air_words

    @property
    def lowest(self) -> float:
        return min((height for _, height in self.contour), default=self.limit)

    def judged(self, encounter: Encounter, sweep: float = 0.0) -> Verdict:
        if not self.contour:
            return super().judged(encounter, self.sweep if self.face else 0.0)
        free = shapely.Polygon([(0.0, 0.0), *self._edge(BEYOND_TRACK_M), (BEYOND_TRACK_M, 0.0)])
        return self._with_air_on(encounter, encounter.verdict(encounter.through(free)))

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        room, lean = room_of(orientations), math.sin(self.sweep)
        edge = np.array(self._edge(track.extent))
        tall = tall_of(orientations, edge[:, 1].max())
        ring = [*((y / lean, z) for y, z in edge), (edge[-1, 0] / lean, tall), (0.0, tall)]
        blade = Blade(shapely.Polygon(ring), (0.5 * room, 0.0), self.sweep, friction=self.friction)
        ahead = 0.0 if self.face is None else track.extent / math.tan(self.sweep)
        return Features(0.5 * room + ahead, blades=(blade,), jets=self._jets(0.5 * room, track))

    def document_values(self) -> Document:
        return super().document_values() | (self.face_values() if self.face else {})

    def _edge(self, width: float) -> list[Corner]:
        """Its lower edge from the wall to the free edge: distances and heights [m]."""
        if not self.contour:
            return [(0.0, self.limit), (width, self.limit)]
        inner = [(y, z) for y, z in self.contour if 0.0 < y < width]
        return [(0.0, self.contour[0][1]), *inner, (width, self.contour[-1][1])]


@dataclass(frozen=True)
class HeightBar(Overhead):
    """A bar across the track."""

    kind = "height bar"
    trade = Trade(
        "6 mm",
        "bar across the track at a clearance: orientations that stand higher stop before it",
        old_name="height_bar",
        measures="height",
    )


@dataclass(frozen=True)
class HoldDown(Overhead):
    """A bar above the queue."""

    kind = "hold-down"
    trade = Trade(
        "6 mm",
        "bar above the queue that keeps parts down; orientations that do not fit below stop before it",
        old_name="hold_down",
        measures="height",
    )


class ProfileGate(Device):
    """A gate across the track with an opening."""

    kind = "profile gate"
    trade = Trade(
        "{of: A@90, play: 0.2 mm}",
        "gate with an opening: a polygon of distances from the wall and heights, or an orientation's own "
        "outline with play; what does not fit stops before it: for parts that come one by one",
        forms.either(forms.POLYGON, forms.mapping(of=forms.NAMED, play=forms.LENGTH_FORM)),
        old_name="profile",
        measures="outline seen along the track",
    )
    action = Action.GATE

    read = staticmethod(values.opening)

    def value_text(self) -> str:
        if not self.like:
            return corners_text(self.corners)
        aspect, heading, play = self.like
        return mapping_text((("of", orientation_names.written(aspect, heading)), ("play", length_text(play))))

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        free = self.free(orientations)
        if self.like:
            free = free.intersection(shapely.box(0.0, 0.0, track.extent, MAX_OPENING_HEIGHT_M))
        return gate_features(free, orientations, track.extent, is_gate=True)

    def free(self, orientations: Sequence[LyingPart]) -> shapely.Geometry:
        """Return the opening however wide the track is, in distances from the wall and heights.

        Parameters
        ----------
        orientations : sequence of LyingPart
            Of the part: the opening may name one.

        Returns
        -------
        shapely geometry [m]

        Raises
        ------
        ConfigError
            If the part does not have the orientation that it names.
        """
        if not self.like:
            return shapely.Polygon(self.corners)
        aspect, heading, play = self.like
        k = orientation_names.place_of(orientations, aspect, heading, self.where, f"{self.kind} names")
        outline = orientations[k].view_ahead.buffer(play)
        # what the part shows through a hole of its own is no island in the gate: nothing would carry it
        parts = [part for part in shapely.get_parts(outline) if part.geom_type == "Polygon"]
        return shapely.union_all([shapely.Polygon(part.exterior) for part in parts])

    def judged(self, encounter: Encounter) -> Verdict:
        return encounter.verdict(encounter.through(self.free(encounter.orientations)))
