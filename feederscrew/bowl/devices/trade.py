"""A kind of device: what a catalogue says of it, what it does with parts, how a design finds its value."""

import enum
from dataclasses import dataclass, field

from feederscrew.base import value_forms as forms


class Action(enum.StrEnum):
    """What a device does with parts, one word each; the rest follows from its features."""

    BARE = "bare track"  # nothing
    MEASURED = "measured"  # a share of them passes, as measured; it has no place along the track
    CUT = "cut"  # lets fall what its opening does not carry
    NARROW = "narrow"  # lets fall over the free edge what the track does not carry
    RELIEVE = "relieve"  # the same, and what backs up leaves the track at it
    OVERHEAD = "overhead"  # holds up what is too high, by a blade that is open to the track's free edge
    PUSH = "push"  # pushes off a narrowed track what stands out to the wall above it, by a blade
    GATE = "gate"  # holds up what does not fit through its opening
    BLOW = "blow"  # blows off, all the time, what offers it enough area
    SENSE = "sense"  # blows off what a sensor sees to differ: air, no edge that is met
    PITCH = "pitch"  # turns parts over an edge across the track
    ROLL = "roll"  # turns parts over an edge along the track
    HANG = "hang"  # lets parts go on hanging by their heads
    CLIMB = "climb"  # lets the track climb otherwise
    BANK = "bank"  # leans the track towards its wall, which stands upright: a groove before it ends
    GROOVE = "groove"  # leans the track and its wall to a V, until a bank
    TWIST = "twist"  # leans the track and its wall together, to its end: parts go on on the side at the wall

    @property
    def has_place(self) -> bool:
        """Tell whether such a device has a place along the track."""
        return self is not Action.MEASURED

    @property
    def leans(self) -> bool:
        """Tell whether the track leans otherwise from such a device on."""
        return self in (Action.CLIMB, Action.BANK, Action.GROOVE, Action.TWIST)

    @property
    def turns(self) -> bool:
        """Tell whether it turns parts over instead of returning them."""
        return self in (Action.PITCH, Action.ROLL, Action.TWIST)

    @property
    def carries(self) -> bool:
        """Tell whether it leaves less of a foot that goes on over it."""
        return self in (Action.CUT, Action.NARROW, Action.RELIEVE)

    @property
    def suits_hanging(self) -> bool:
        """Tell whether it means anything to parts that hang between rails."""
        return not (self.turns or self in (Action.RELIEVE, Action.PUSH, Action.GROOVE))


class Bound(enum.StrEnum):
    """Which end of a scale the value of a device is: what passes needs no more, or bears no less."""

    UPPER = "upper"
    LOWER = "lower"


class ProposedBy(enum.StrEnum):
    """What a design finds of a kind that it proposes."""

    NEVER = "never"
    VALUE = "value"  # it tries one number, an orientation, or a nozzle
    SHAPE = "shape"  # it looks for an outline, by many verdicts


@dataclass(frozen=True)
class Trade:
    """What a catalogue says of a kind of device: value, words and cost; its name is the kind's."""

    example: str = ""  # of its value, as written after 'kind:'
    meaning: str = ""  # a sentence of a bowl file's page
    form: forms.JsonSchema = field(default_factory=lambda: forms.LENGTH_FORM)  # of its value in a bowl file
    old_name: str = ""  # what files of before call it, as these are read too; '': the same
    measures: str = ""  # of a part, in the part's own terms
    serves: str = ""  # what one that returns nothing is for
    cost_class: int = 1  # what it takes: 1 steel alone, 2 steady air, 3 a sensor with a valve


@dataclass(frozen=True)
class ValueSearch:
    """How a design finds the value of a device."""

    proposed: ProposedBy = ProposedBy.NEVER
    bound: Bound | None = None  # of a value that is one length; None of others
    limited_by: str = ""  # what of an ``Orientation`` is the value that it just passes
    rank: int = 0  # of those with a bound, which a design tries first

    @property
    def is_proposed(self) -> bool:
        """Tell whether a design tries it by a value: a number, an orientation, or a nozzle."""
        return self.proposed is ProposedBy.VALUE

    @property
    def is_shape(self) -> bool:
        """Tell whether a design looks for its shape."""
        return self.proposed is ProposedBy.SHAPE


IS_ANGLE = {"is_angle": True}  # metadata of a device's field that is an angle [rad]
