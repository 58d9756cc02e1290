"""What a device may ask of a part that comes: of how it lies, and of its encounter with the device.

Devices are known before a part is placed on a track. So they say here what they need, and ``sorting`` gives
it: its ``Orientation`` is a ``LyingPart``, its ``DeviceEncounter`` an ``Encounter``.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol, Self, TypeAlias, TypeVar

from feederscrew.base.arrays import Points

if TYPE_CHECKING:
    import shapely

    from feederscrew.bowl.devices.base import Verdict
    from feederscrew.bowl.devices.openings import HoleEdges
    from feederscrew.bowl.record import Track
    from feederscrew.resting.posture import Posture

PlaceShares: TypeAlias = tuple[tuple[int, float], ...]  # places of orientations, and the share [1] of each
Lying = TypeVar("Lying", bound="LyingPart")


class StandingFoot(Protocol):
    """Where a part touches the track."""

    @property
    def reach(self) -> float:
        """Return how far the foot reaches from below the centre of mass [m]."""


class PartTurn(Protocol):
    """A part that turns over an edge."""

    @property
    def lift(self) -> float:
        """Return by how much its centre of mass is lifted on the way [m]."""

    @property
    def sure(self) -> float:
        """Return the drop of the track from which it turns over without any momentum [m]."""

    @property
    def holds(self) -> float:
        """Return the drop from which its momentum may carry it further [m]; infinite where none does."""


class LyingPart(Protocol):
    """One aspect of a part at one heading against the wall, in track axes from the foot of its weight."""

    def __hash__(self) -> int:
        """Return a number by which what was worked out of it is found again."""

    @property
    def posture(self) -> "Posture":
        """The part on that aspect, not yet turned."""

    @property
    def track(self) -> "Track":
        """The track that it lies on."""

    @property
    def aspect(self) -> str:
        """Name of the aspect."""

    @property
    def heading(self) -> float:
        """Angle to the wall [rad]."""

    @property
    def name(self) -> str:
        """Aspect and heading in whole degrees: 'D@179'."""

    @property
    def kind(self) -> str:
        """'flat', 'rolling' or 'hanging'."""

    @property
    def length(self) -> float:
        """Length along the track [m]."""

    @property
    def width(self) -> float:
        """Width of track that it covers [m]."""

    @property
    def height(self) -> float:
        """Height over the track [m]."""

    @property
    def distance(self) -> float:
        """Distance of the centre of mass from the wall [m]."""

    @property
    def outline(self) -> Points:
        """Convex outline from above (J, 2) [m], counter-clockwise."""

    @property
    def view_ahead(self) -> "shapely.Geometry":
        """Outline seen along the track: distance from the wall, and height [m]."""

    @property
    def aside(self) -> "shapely.Geometry":
        """Outline seen from the bowl's axis: ahead of its weight, and heights [m]."""

    @property
    def axial_foot(self) -> StandingFoot:
        """Where it touches the track."""

    @property
    def balcony(self) -> float:
        """Least width of track that carries it [m]; infinite where none does."""

    @property
    def canyon(self) -> float:
        """Greatest width of a strip removed along the wall that it passes [m]; 0 for none."""

    @property
    def gap(self) -> float:
        """Greatest gap across the track that it passes [m]; 0 for none."""

    @property
    def ahead(self) -> float:
        """Return how far its foot reaches ahead of its weight [m]."""

    @property
    def behind(self) -> float:
        """Return how far its foot reaches behind its weight [m]."""

    @property
    def nose_swing(self) -> float:
        """Return how far from an edge across the track the top of its nose swings as it tips over it [m]."""

    @property
    def carry(self) -> float:
        """Way that it travels on unsupported before it has tipped [m]; 0 of one that is only placed."""

    @property
    def carry_ahead(self) -> float:
        """The same over an edge across the track [m]."""

    @property
    def hop(self) -> float:
        """Greatest height over the track, where the drive throws it [m]."""

    @property
    def flight(self) -> float:
        """Length along the track of its longest flight [m]."""

    @property
    def grip(self) -> float:
        """Friction of the track [1]; 0 of one that is only placed."""

    @property
    def wall_grip(self) -> float:
        """Friction of the wall [1]."""

    @property
    def gravity(self) -> float:
        """Gravity where it travels [m/s2]."""

    @property
    def rolls_along(self) -> bool:
        """Tell whether the axis about which it rolls lies more along the track than across it."""

    @property
    def may_roll_back(self) -> bool:
        """Tell whether it lies on its round side, not along a climbing track: no verdict is sure."""

    def on_track(self, track: "Track", **changes: Any) -> Self:
        """Return it on another stretch of track, with changes of its own fields."""

    def against_inner_wall(self) -> Self:
        """Return it as it lies behind a twist: its wall is the floor that stands at the inner side."""


class HangingPart(LyingPart, Protocol):
    """A part that hangs by its head between rails."""

    def over(self, span: tuple[float, ...]) -> float:
        """Return the margin by which shank and head fit rails at another distance [m]."""


class Encounter(Protocol):
    """One orientation at a device: answers what a device asks of it, and makes verdicts."""

    @property
    def orientation(self) -> LyingPart:
        """How the part lies."""

    @property
    def orientations(self) -> Sequence[LyingPart]:
        """All orientations of the part; empty where they are not known."""

    @property
    def hanging(self) -> bool:
        """Whether the part hangs between rails."""

    @property
    def grip(self) -> float:
        """Friction of the track [1]: of a part that is only placed, that of a bowl of the defaults."""

    @property
    def mouth(self) -> float:
        """Way from its weight to the rim that it stands on [m]: of a cup mouth down; else 0."""

    def passing(self) -> "Verdict":
        """Return the verdict of a device that does nothing."""

    def verdict(self, margin: float, shift: float = 0.0, hangs: bool = False) -> "Verdict":
        """Return the verdict of a margin [m], which is the least at a shift [rad] of a hole."""

    def turning(self, shares: PlaceShares, margin: float) -> "Verdict":
        """Return the verdict of a device that turns shares of the part into other orientations."""

    def laid_in_groove(self, angle: float) -> "Verdict":
        """Return the verdict of a groove whose faces rise at an angle [rad]."""

    def stood_on_side(self, angle: float) -> "Verdict":
        """Return the verdict of a track that twists by an angle [rad], with its wall."""

    def share(self, margin: float) -> float:
        """Return the share that passes at a margin [m]."""

    def over_span(self, span: tuple[float, ...]) -> float:
        """Return its margin [m] on a track without what lies between two distances [m] off the wall."""

    def over_slot(self, span: tuple[float, ...]) -> float:
        """Return its margin [m] as ``over_span``; not sure where it may ride over the hole on its sides."""

    def over_hole(self, hole: "HoleEdges") -> tuple[float, float]:
        """Return its least margin [m] over a hole, and the shift [rad] at which it has it."""

    def unheld(self, hole: "HoleEdges") -> float:
        """Return the longest way [m] over a hole on which nothing holds it."""

    def astride(self, ahead: float) -> float:
        """Return how far its weight is from the sides of its foot, from below it up to a way ahead [m]."""

    def leans(self, width: float) -> float:
        """Return by how much the wall holds it over a strip of some width [m] removed along the wall."""

    def rides(self, width: float, length: float) -> bool:
        """Tell whether it may ride over a hole of some width and length [m] on its sides."""

    def falls_through(self, cut: Points) -> bool:
        """Tell whether it falls through a hole of some corners [m]."""

    def held_by_shoulders(self, span: tuple[float, ...]) -> float:
        """Return by how much its shoulders hold it over a slot [m]; negative where they do not."""

    def held_by_head(self, width: float, widest: float) -> float:
        """Return by how much a slot lets the shank down and holds the head [m]."""

    def may_catch(self, entry: tuple[float, ...], span: tuple[float, ...]) -> bool:
        """Tell whether its head may stick between rails as a wedge, or its shank not turn down."""

    def through(self, opening: "shapely.Geometry") -> float:
        """Return its margin in the opening of a gate [m]."""

    def unless_laid_over(self, margin: float, low: float, sweep: float = 0.0) -> float:
        """Return the margin [m] of a part that a blade holds up; not sure where it may lay the part over."""

    def blown(self, force: float, down: float, seconds: float) -> float:
        """Return how far a force [N] carries it over a still track, less its way to the edge [m]."""

    def force_to_clear(self, wide: float, height: float) -> float:
        """Return the force [N] of a jet at some height [m] that moves it off the track."""

    def differs(self, other: LyingPart, sees: str) -> float:
        """Return by how much a view of it differs from that of another orientation [m]."""

    def askew(self, sees: str) -> float:
        """Return by how much a view of it may differ from itself [m], as parts lie askew."""

    def pitched(self, inwards: bool) -> PartTurn:
        """Return how it turns over an edge ahead or to its side."""

    def pitched_over(self, height: float) -> tuple[PlaceShares, float]:
        """Return what it becomes over a step of some height [m], and the margin [m]."""

    def rolled_over(self, width: float) -> tuple[PlaceShares, float]:
        """Return what it becomes beyond a ledge of some width [m], and the margin [m]."""
