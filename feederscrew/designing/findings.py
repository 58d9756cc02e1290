"""Findings of trials, and the moves that the search makes because of them: records, and no sentence.

The search decides on these. ``designing.texts`` makes the sentences that people read of them.
"""

import enum
from collections.abc import Iterable
from dataclasses import dataclass, replace

from feederscrew.arrivals.heap_count import HeapCount
from feederscrew.base.columns import Column
from feederscrew.trials.course import Fate


class Cause(enum.StrEnum):
    """Cause why a design does not hold; files print the word."""

    UNKNOWN = ""  # it holds, or was stopped
    DRIVE = "drive"
    DEVICE = "device"
    ARRIVAL = "arrival"
    PART = "part"


@dataclass(frozen=True)
class End:
    """End of a part, or its turn into another orientation: the fate and the place."""

    fate: Fate  # TURNED of one that left otherwise, at the last station that turned it
    station: int = 0  # place along the chain of what stands on the track; 0 is the bare track
    kind: str = ""  # of the device there; '' on the bare track

    @property
    def on_bare_track(self) -> bool:
        """Tell whether it happened before any device."""
        return not self.kind

    @property
    def came_back(self) -> bool:
        """Tell whether the part was returned, and comes along once more."""
        return self.fate is Fate.RETURNED


class FaultKind(enum.Enum):
    """In which way a chain fails to do what it should."""

    NOTHING_LEAVES = enum.auto()  # as wanted
    LOST = enum.auto()  # a wanted orientation that did not leave as wanted
    CARRIED = enum.auto()  # another orientation that leaves
    STAYS = enum.auto()  # another orientation that stays at a device
    NOT_RUN = enum.auto()  # the bowl conveys nothing, or the part does not fit it
    IMPURE = enum.auto()  # too little of what leaves is wanted


@dataclass(frozen=True)
class Fault:
    """A fault that trials or draws show, of one orientation."""

    kind: FaultKind
    orientation: str = ""  # its name; '' where the fault is of no single one
    row: int = -1  # its place among the orientations of the design; -1 where there is none
    ends: tuple[End, ...] = ()  # how its parts ended, each once
    reason: str = ""  # of one that was not run: the message of the error
    shares: tuple[float, ...] = ()  # [1] of an impure one: purity, its 95 % interval, the least asked for
    failures: int = 0  # draws that show it; 0 of a trial
    draws: int = 0  # of so many

    @property
    def is_stopped(self) -> bool:
        """Tell whether the first of its parts that were lost stands at a device."""
        return bool(self.ends) and self.ends[0].fate is Fate.STOPPED

    @property
    def is_at_device(self) -> bool:
        """Tell whether some of its parts ended or were turned at a device."""
        return any(not end.on_bare_track for end in self.ends)

    @property
    def is_on_bare_track(self) -> bool:
        """Tell whether some of its parts ended or were turned before any device."""
        return any(end.on_bare_track for end in self.ends)

    def stops_at(self, kinds: Iterable[str]) -> bool:
        """Tell whether some of its parts stand at a device of one of some kinds.

        Parameters
        ----------
        kinds : iterable of str

        Returns
        -------
        bool
        """
        kinds = set(kinds)
        return any(end.fate is Fate.STOPPED and end.kind in kinds for end in self.ends)

    def counted_in_draws(self, failures: int, draws: int) -> "Fault":
        """Return the fault as so many of some draws show it.

        Parameters
        ----------
        failures : int
            Draws that show it.
        draws : int

        Returns
        -------
        Fault
        """
        return replace(self, failures=failures, draws=draws)


class MoveKind(enum.Enum):
    """Why the search tries a chain."""

    PROPOSED = enum.auto()  # by the static rule, with a margin
    NO_DEVICE = enum.auto()
    VALUES_OF_ALL = enum.auto()  # of a family of parts that share one bowl
    VALUE = enum.auto()  # the value of a device is moved
    SWEEP = enum.auto()  # a blade is set at another angle
    WIDER_SLOT = enum.auto()
    SLOT_PLACE = enum.auto()  # the slot of the rails lies elsewhere, by a value [m]
    LEAD_IN = enum.auto()  # its lead-in is so many times as long
    BLADE_BEHIND = enum.auto()  # a blade behind the rails sweeps off what does not hang
    CUTS_BEFORE = enum.auto()  # cuts before the rails, by what a trial has shown to hang
    OTHER_CUTS = enum.auto()  # cuts of another kind before the rails, which return the same
    JET_BEFORE = enum.auto()  # one device more: a steady jet before the rails, for what stands behind it
    AIR_ASSIST = enum.auto()  # air along the face of a blade, for what stands at it
    BLADE_HEIGHT = enum.auto()  # it stands higher, by a value [m], or lower
    RAILS = enum.auto()  # rails for a head, before any trial
    LONGER_PULSE = enum.auto()
    DROP_BEFORE = enum.auto()  # one device more: what others fall through
    PRESSURE_BREAK = enum.auto()  # one device more: where parts back up they leave the track
    SECOND_SENSOR = enum.auto()  # the same sensor and valve once more behind the first
    SPACING = enum.auto()  # a spacing section before the devices, or a steeper one: parts come apart
    CALMER_DRIVE = enum.auto()
    LIVELIER_DRIVE = enum.auto()
    FLATTER_DRIVE = enum.auto()  # its vibration angle is flatter: leaf springs do not make its own


@dataclass(frozen=True)
class Move:
    """A step of the search: what is tried, and the value that is new in it."""

    kind: MoveKind
    value: float = 0.0  # margin, slot or stroke peak to peak [m], sweep [rad], pulse [s] or pressure [Pa]
    device: str = ""  # kind of the device that is changed or added
    device_text: str = ""  # its value as a bowl file writes it


@dataclass(frozen=True)
class SeldomPart:
    """An orientation, not wanted, that leaves or stays in its short trial, and is let be: it comes seldom."""

    orientation: str  # its name
    parts: int  # that were tried
    left: int  # of them
    held: int  # of them that stay at a device
    share: float  # [1] in which it comes
    share_high: float  # [1] upper end of the interval of that share
    break_even: float | None  # [1] share from which the purity is too low; None where none leaves

    @property
    def may_spoil(self) -> bool:
        """Tell whether it may come often enough to make the purity too low."""
        return self.break_even is not None and self.share_high >= self.break_even


SELDOM_COLUMNS: tuple[Column[SeldomPart], ...] = (
    Column("orientation", lambda seldom: seldom.orientation),
    Column("parts", lambda seldom: seldom.parts),
    Column("left", lambda seldom: seldom.left),
    Column("held", lambda seldom: seldom.held),
    Column("share", lambda seldom: seldom.share, "share"),
    Column("share_high", lambda seldom: seldom.share_high, "share"),
    Column("break_even", lambda seldom: seldom.break_even),
)


@dataclass(frozen=True)
class Hooking:
    """Two parts of one kind that hold each other."""

    pulls: int
    held: int  # of them that do not part the two
    opening: float  # [m] the mouth through which they come to hook; NaN of none
    section: float  # [m] the thinnest limb of the part
    heap: HeapCount | None = None  # how many of a heap come single


HOOKING_COLUMNS: tuple[Column[Hooking], ...] = (
    Column("pulls", lambda hooking: hooking.pulls),
    Column("held", lambda hooking: hooking.held),
    Column("opening_mm", lambda hooking: hooking.opening, "mm"),
    Column("thinnest_mm", lambda hooking: hooking.section, "mm"),
    Column("heap_parts", lambda hooking: hooking.heap and hooking.heap.parts),
    Column("heap_single", lambda hooking: hooking.heap and hooking.heap.single),
    Column("heap_single_share_low", lambda hooking: hooking.heap and hooking.heap.low, "share"),
    Column("heap_single_share_high", lambda hooking: hooking.heap and hooking.heap.high, "share"),
)
