"""Device along the track: what it offers to those who read, judge, draw, make and try it.

A device says its `Features`, of no kind by name, and its verdict. `tooled_track` places the features of a
chain; trial, drawings and solids are made of them.
"""

import enum
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from feederscrew.base import units
from feederscrew.base import value_forms as forms
from feederscrew.base.columns import Document
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.bowl.devices import orientation_names, values
from feederscrew.bowl.devices.asked import Encounter, Lying, LyingPart
from feederscrew.bowl.devices.features import Blade, Features, TrackOpening
from feederscrew.bowl.devices.trade import Action, Trade, ValueSearch
from feederscrew.bowl.devices.values import Corner, DeviceFields

if TYPE_CHECKING:
    import shapely

    from feederscrew.bowl.record import Track
else:
    shapely = heavy("shapely")  # a bowl without devices needs none of it

GATE_FRAME_M = 5e-3  # [m] of a gate above its opening
GRIP = 0.6  # [1] friction of a dry steel track
LIMIT_TOLERANCE_M = 1e-9  # [m] a part this much over a limit still passes
UNSURE = 2e-9  # [m] by which one is returned at least that has no support for a while
WRITTEN_STEP_M = 1e-7  # [m] to which a length is written
ENDLESS_HOLE_LENGTHS = 3.0  # of the part's size: a hole that goes on along the track is as good as endless
YAML_MARKS = re.compile(r"[][{}:]")  # of a bowl file, which a value in words has none of
ROOM_PER_DEVICE = 1.3  # a device has so many lengths of the longest part to itself
WRITTEN_FIELDS = ("where", "text", "assumption")  # of a device, that say how it was written
COMPARED_DIGITS = 7  # decimals of a value in SI units: a tenth of a micrometre


class DeviceFate(enum.StrEnum):
    """Fate at a device of a part that does not pass it as it came; tables print the word."""

    RETURNED = "returned"
    STOPPED = "stopped"
    CARRIED = "carried"


RETURNED, STOPPED, CARRIED = DeviceFate
# what becomes of what does not pass, where the device alone decides; else it falls through or is stopped
REJECTED_BY = {
    Action.OVERHEAD: STOPPED,
    Action.PUSH: STOPPED,
    Action.GATE: STOPPED,
    Action.NARROW: RETURNED,
    Action.RELIEVE: RETURNED,
    Action.BLOW: RETURNED,
    Action.SENSE: RETURNED,
}


@dataclass(frozen=True)
class Verdict:
    """The answer of a device for one orientation."""

    passes: float  # [1] share that passes; the rest goes back into the bowl
    margin: float  # [m] by which it passes, negative: by which it fails; NaN of a measured share
    shift: float = 0.0  # [rad] of the device from the foot's radial line where the margin is least
    hangs: bool = False  # whether it goes on hanging by the head
    onto: tuple[tuple[int, float], ...] = ()  # orientations it goes on in, with their shares; () as it is
    lands: LyingPart | None = None  # how it goes on where that is none of the orientations of a level track

    @property
    def decided(self) -> bool:
        """Tell whether statics tells what becomes of it: where a device turns, momentum may."""
        return self.margin >= 0.0 or not (self.onto or self.lands)

    @property
    def sure(self) -> bool:
        """Tell whether its margin is one: not where momentum, friction or the wall may decide otherwise."""
        return not -UNSURE <= self.margin <= 0.0


class ComparedValue(NamedTuple):
    """A word or number of a device, to be compared with that of another one."""

    value: str | float | None
    is_angle: bool = False  # [rad]; other numbers are in SI units as well


@dataclass(frozen=True)
class Device:
    """One device of a chain: its values, and what its kind makes of them.

    A new kind is a class in a module of this folder: it gives ``kind``, ``trade`` and ``action``, and says
    below what differs from a device that does nothing. Nothing else names a kind.
    """

    where: str  # 'bowl.yaml:20:5'
    limit: float = math.inf  # [m] clearance, width or length; infinite where its value is no such length
    shares: tuple[tuple[str, float], ...] = ()  # measured: share that passes, by aspect
    span: tuple[float, ...] = ()  # [m] from the wall
    corners: tuple[tuple[float, float], ...] = ()  # [m] of a hole unrolled, of an opening (y, z)
    like: tuple[str, float, float] | tuple[()] = ()  # of an opening: aspect, heading [rad], play [m]
    also: tuple[tuple[str, float], ...] = ()  # of a sensor: other aspects and headings [rad] beside it
    text: str = ""  # its value as written
    assumption: str = ""  # what was taken for granted as it was read, a sentence; '' of nothing

    kind: ClassVar[str] = "track"  # what the trade calls it, in files and in sentences: 'vision reject'
    trade: ClassVar[Trade] = Trade()  # what a catalogue says of it
    action: ClassVar[Action] = Action.BARE  # what it does with parts
    search: ClassVar[ValueSearch] = ValueSearch()  # how a design finds its value

    # -- as it is read and written

    @staticmethod
    def read(entry: Entry) -> DeviceFields:
        """Return the fields that an entry of a bowl file gives: by default a length.

        Parameters
        ----------
        entry : Entry
            'kind: value'.

        Returns
        -------
        dict of str to object
            Keywords of the class, in SI units.

        Raises
        ------
        ConfigError
            If the value is not of the form that ``trade`` has.
        """
        return values.length(entry)

    def misfits(self, width: float) -> list[ConfigError]:
        """Return what is wrong with it on a track.

        Parameters
        ----------
        width : float [m]
            Of the track.

        Returns
        -------
        list of ConfigError
        """
        return []

    def value_text(self) -> str:
        """Return its value as a bowl file has it, with every attribute that is not as by default."""
        return length_text(self.limit)

    def rewritten(self) -> Self:
        """Return it with the text of its own attributes."""
        return replace(self, text=self.value_text())

    def valued(self, limit: float) -> Self:
        """Return it with another value, and with the text of that.

        Parameters
        ----------
        limit : float [m]

        Returns
        -------
        Device
            Of the same kind.
        """
        return replace(self, limit=limit).rewritten()

    def document_values(self) -> Document:
        """Return its values for a document, in mm."""
        if self.corners:
            return {"outline_mm": [[x / MM, y / MM] for x, y in self.corners]}
        if self.span:
            first, last = self.span
            return {"value_mm": (last - first) / MM, "span_mm": [first / MM, last / MM]}
        return {"value_mm": (self.like[2] if self.like else self.limit) / MM}

    @property
    def compared_values(self) -> tuple[ComparedValue, ...]:
        """Return everything that it does, as values in a row: the same for devices that do the same."""
        own = (one for one in fields(self) if one.name not in WRITTEN_FIELDS)
        return tuple(
            value
            for one in own
            for value in compared(getattr(self, one.name), is_angle="is_angle" in one.metadata)
        )

    @property
    def is_one_value(self) -> bool:
        """Tell whether a bowl file has one value of it, and neither a mapping nor a list."""
        return not self.text.startswith(("{", "["))

    @property
    def brief(self) -> str:
        """Return 'narrowed track 13.35 mm'; of a device of several values, which drawings have, its name."""
        return f"{self.kind} {self.text}".rstrip() if self.is_one_value else self.kind

    @property
    def label(self) -> str:
        """Return 'gap 9 mm': kind and value, the latter where it is one number."""
        return f"{self.kind} {self.text}" if math.isfinite(self.limit) else self.kind

    @property
    def full_name(self) -> str:
        """Return its kind, with what it works by where that differs: 'vision reject (camera from above)'."""
        return self.kind

    @property
    def short(self) -> str:
        """Return its value as a bowl file has it, headings in whole degrees."""
        return orientation_names.whole_degrees(self.text)

    @property
    def value_words(self) -> str:
        """Return its value in words, for a table: '9.25 mm', 'from 2 to 5 mm off the wall'."""
        if self.corners:
            return f"polygon of {len(self.corners)} corners"
        if self.like:
            aspect, heading, play = self.like
            return f"outline of {keeps(((aspect, heading),))}, with {length_words(play)} of play"
        return span_words(self.span) if self.span else YAML_MARKS.sub("", self.short)

    @property
    def shop_words(self) -> tuple[str, ...]:
        """Return a sentence for each thing that a shop buys and sets: sensor, valve; () of plain steel."""
        return ()

    @property
    def serves(self) -> str:
        """Return what it is for where it returns nothing; '' of others."""
        return self.trade.serves

    def hole_faults(
        self, width: float, near: float, far: float, *, endless: bool = True
    ) -> list[ConfigError]:
        """Return what is wrong with a hole between two distances off the wall.

        Parameters
        ----------
        width : float [m]
            Of the track.
        near, far : float [m]
            Between which the hole lies.
        endless : bool, optional
            Whether it goes on along the track, so that one as wide as the track leaves none.

        Returns
        -------
        list of ConfigError
        """
        wide, faults = f"the track is {1e3 * width:.4g} mm wide", []
        if endless and near <= 0.0 and far >= width:
            what = f"{self.kind} leaves no track: {wide}"
            faults.append(ConfigError(self.where, what, "give a smaller one, or a wider track"))
        if near >= width or far <= 0.0:
            what = f"{self.kind} lies beside the track: {wide}"
            faults.append(ConfigError(self.where, what, "move it onto the track"))
        return faults

    # -- as a design tries it

    @classmethod
    def needed(cls, orientation: LyingPart) -> float:
        """Return the value of a device of this kind that an orientation just passes.

        Parameters
        ----------
        orientation : LyingPart

        Returns
        -------
        float [m]

        Raises
        ------
        NotImplementedError
            If a device of this kind is not one number.
        """
        if not cls.search.limited_by:
            raise NotImplementedError(f"{cls.kind} is not one number")
        return getattr(orientation, cls.search.limited_by)

    @classmethod
    def proposal(cls, where: str, limit: float) -> Self:
        """Return the device of a value that a design tries.

        Parameters
        ----------
        where : str
            What asks for it.
        limit : float [m]

        Returns
        -------
        Device
            Of this kind.
        """
        return cls(where, limit=limit)

    @classmethod
    def relieving(cls, wanted: Sequence[LyingPart], margin: float, where: str) -> "Device | None":
        """Return the device before the tooling at which orientations leave where they back up.

        Parameters
        ----------
        wanted : sequence of LyingPart
        margin : float [m]
            By which it carries them.
        where : str
            What asks for it.

        Returns
        -------
        Device or None
            None where this kind is not for that, or cannot.
        """
        return None

    @classmethod
    def changes(cls, often: Sequence[Encounter]) -> list[float]:
        """Return the values at which a device that turns parts over changes what it does with some of them.

        Parameters
        ----------
        often : sequence of Encounter

        Returns
        -------
        list of float [m]
            Ascending, each once; none of a kind that a design does not try.
        """
        return []

    def cutting_more(self, by: float) -> "Device | None":
        """Return the device that returns more by a length, of a kind whose value is not one number.

        Parameters
        ----------
        by : float [m]
            By which the margin of what passes is less; below 0, by which it is more.

        Returns
        -------
        Device or None
            None of a kind that cannot be moved so.
        """
        return None

    # -- as it stands on the track

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        """Return all that it cuts out of the track, sets on it and changes of its way.

        Parameters
        ----------
        track : Track
            Its width and radius count.
        orientations : sequence of LyingPart
            Of the part: the longest sets how long a device is that goes on along the track, the tallest how
            high a gate stands, and an opening or a sensor may name one.

        Returns
        -------
        Features
            In coordinates of the device; none by default.

        Raises
        ------
        ConfigError
            It names an orientation that the part does not have.
        """
        return Features(room_of(orientations))

    @property
    def face(self) -> tuple[float, float | None] | None:
        """Return sweep [rad] and friction [1] or None of a blade's face that may clear itself; else None."""
        return None

    @property
    def cost_class(self) -> int:
        """Return what it takes, with its values: 1 steel alone, 2 steady air, 3 a sensor with a valve."""
        return self.trade.cost_class

    @property
    def takes_air(self) -> bool:
        """Tell whether it needs compressed air, steady or in pulses."""
        return self.cost_class > 1

    def force_along_face(self, orientation: LyingPart) -> tuple[float, float]:
        """Return the force of its air on an orientation that stands at its face.

        Parameters
        ----------
        orientation : LyingPart

        Returns
        -------
        along, off : float [N]
            Along the face towards the free edge, and square to it off the face; 0 without air.
        """
        return 0.0, 0.0

    # -- what it does with parts

    def judged(self, encounter: Encounter) -> Verdict:
        """Return what it does with an orientation, by what statics knows of it.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        Verdict
        """
        return encounter.passing()

    def fate(self, encounter: Encounter) -> str:
        """Return what becomes of an orientation that it does not let pass.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        DeviceFate
            RETURNED, or STOPPED before it.
        """
        if self.action in REJECTED_BY:
            return REJECTED_BY[self.action]
        opening = opening_at(self, encounter.orientation)
        if opening is None:
            return RETURNED
        span = opening.span
        if span is not None and span[0] > 0.0 and encounter.held_by_shoulders(span) >= 0.0:
            return STOPPED  # it hangs in the slot up to its end
        return RETURNED if encounter.falls_through(opening.ring) else STOPPED

    def swings_clear(self, orientation: LyingPart) -> bool:
        """Tell whether what tips over the near edge of its opening swings past the far edge for certain.

        Parameters
        ----------
        orientation : LyingPart

        Returns
        -------
        bool
            False where that is not known: its tilts between both edges tell then.
        """
        return False

    def onward(self, orientation: Lying) -> Lying:
        """Return an orientation that it lets pass as it goes on behind it.

        Parameters
        ----------
        orientation : LyingPart

        Returns
        -------
        LyingPart
        """
        return orientation

    def hop_blur(self, orientation: LyingPart) -> float:
        """Return what the hop of an orientation takes of its margin.

        Over an edge across the track its flight. Beside an edge along it, and where the margin is a height,
        how high it hops: a part off the track by so much is as far off its place.

        Parameters
        ----------
        orientation : LyingPart

        Returns
        -------
        float [m]
        """
        return orientation.hop

    def gap(self, orientation: LyingPart, speed: float) -> float:
        """Return the free way that it needs between parts.

        Parameters
        ----------
        orientation : LyingPart
        speed : float [m/s]
            At which they come.

        Returns
        -------
        float [m]
        """
        return 0.0

    @property
    def on_side(self) -> float:
        """Return the angle [rad] by which parts are on their side behind it; 0 where they lie as before."""
        return 0.0

    def acts(self, track: "Track") -> bool:
        """Tell whether it does anything at all on a track.

        Parameters
        ----------
        track : Track

        Returns
        -------
        bool
        """
        return True

    def more(self, encounter: Encounter) -> float:
        """Return by how much more an orientation that travels passes it than one that is placed.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        float [m]
        """
        return 0.0


def opening_at(device: Device, orientation: LyingPart) -> TrackOpening | None:
    """Return the opening that a device cuts below an orientation, or None.

    Parameters
    ----------
    device : Device
    orientation : LyingPart

    Returns
    -------
    TrackOpening or None
        One that goes on along the track lasts as good as endlessly for it. Beside a ledge it is what is
        missing of the upper track.
    """
    if device.like:  # it goes by other orientations of the part, and cuts nothing
        return None
    features = device.features(orientation.track, (orientation,))
    for opening in features.openings:
        return opening.lasting(ENDLESS_HOLE_LENGTHS * size_of(orientation))
    if features.drop is None or features.drop.aside <= 0.0:
        return None
    beside = features.drop.beside(orientation.track.extent)
    return beside.lasting(ENDLESS_HOLE_LENGTHS * size_of(orientation))


def gate_features(
    opening: "shapely.Geometry", orientations: Sequence[LyingPart], width: float, *, is_gate: bool
) -> Features:
    """Return a plate square across the track, with an opening.

    Parameters
    ----------
    opening : shapely geometry [m]
        Distances from the wall, and heights.
    orientations : sequence of LyingPart
        Of the part: the plate goes up over the tallest.
    width : float [m]
        Of the track.
    is_gate : bool
        Whether it is a part of its own, in a notch of the wall.

    Returns
    -------
    Features
    """
    room = room_of(orientations)
    plate = shapely.box(0.0, 0.0, width, tall_of(orientations, opening.bounds[3])).difference(opening)
    return Features(0.5 * room, blades=(Blade(plate, foot=(0.5 * room, 0.0), is_gate=is_gate),))


def tall_of(orientations: Sequence[LyingPart], least: float) -> float:
    """Return how tall a gate is made: as the tallest part, or the least height, and its frame.

    Parameters
    ----------
    orientations : sequence of LyingPart
    least : float [m]

    Returns
    -------
    float [m]
    """
    return max(max(orientation.height for orientation in orientations), least) + GATE_FRAME_M


def compared(value: Any, *, is_angle: bool = False) -> Iterator[ComparedValue]:
    """Yield the words and numbers of a value of a device, one after another.

    Parameters
    ----------
    value : str, number, None, or a tuple of such values
        A tuple that begins with the name of an aspect goes on with its heading [rad].
    is_angle : bool
        Whether a number is an angle.

    Yields
    ------
    ComparedValue
        Numbers in SI units, to ``COMPARED_DIGITS`` decimals.
    """
    if isinstance(value, tuple):
        yield ComparedValue(len(value))
        is_orientation = len(value) > 1 and isinstance(value[0], str)
        for k, item in enumerate(value):
            yield from compared(item, is_angle=is_angle or (is_orientation and k == 1))
    elif isinstance(value, int | float):
        yield ComparedValue(round(float(value), COMPARED_DIGITS), is_angle)
    else:
        yield ComparedValue(value)


def length_text(value: float) -> str:
    """Return a length as a bowl file has it, to a ten-thousandth of a millimetre: '9.25 mm'.

    Parameters
    ----------
    value : float [m]

    Returns
    -------
    str
    """
    steps = value / WRITTEN_STEP_M
    return f"{(round(steps) if math.isfinite(steps) else steps) * WRITTEN_STEP_M / MM:.9g} mm"


def degrees_words(angle: float) -> str:
    """Return an angle for people: '30 deg'.

    Parameters
    ----------
    angle : float [rad]

    Returns
    -------
    str
    """
    return f"{math.degrees(angle):.4g} deg"


def length_words(length: float) -> str:
    """Return a length for people: '8.35 mm'.

    Parameters
    ----------
    length : float [m]

    Returns
    -------
    str
    """
    return f"{length / MM:.4g} mm"


def span_words(span: tuple[float, ...]) -> str:
    """Return a span off the wall for people: 'from 2 to 5 mm off the wall'.

    Parameters
    ----------
    span : tuple of float [m]

    Returns
    -------
    str
    """
    return f"from {span[0] / MM:.4g} to {span[1] / MM:.4g} mm off the wall"


def keeps(orientations: Iterable[tuple[str, float]]) -> str:
    """Return orientations by their names: 'A@188, A@354 and B@90'.

    Parameters
    ----------
    orientations : iterable of (str, float [rad])
        Aspect and heading of each.

    Returns
    -------
    str
    """
    return units.listed([f"{aspect}@{round(math.degrees(turn)) % 360}" for aspect, turn in orientations])


def angle_text(value: float) -> str:
    """Return an angle as a bowl file has it: '30 deg'.

    Parameters
    ----------
    value : float [rad]

    Returns
    -------
    str
    """
    return f"{math.degrees(value):.9g} deg"


def corners_text(corners: Sequence[Corner]) -> str:
    """Return corners as a bowl file has them: '[[0 mm, 2 mm], [5 mm, 2 mm], ...]'.

    Parameters
    ----------
    corners : sequence of (float, float) [m]

    Returns
    -------
    str
    """
    return f"[{', '.join(f'[{length_text(x)}, {length_text(y)}]' for x, y in corners)}]"


def mapping_text(entries: Iterable[tuple[str, str]]) -> str:
    """Return pairs of a key and a text as a bowl file has them on one line: '{from: 2 mm, to: 5 mm}'.

    Parameters
    ----------
    entries : iterable of (str, str)
        Those of no text are left out.

    Returns
    -------
    str
    """
    return f"{{{', '.join(f'{key}: {text}' for key, text in entries if text)}}}"


def size_of(orientation: LyingPart) -> float:
    """Return the diagonal of an orientation: root of length squared plus the greater of width and height.

    Parameters
    ----------
    orientation : LyingPart

    Returns
    -------
    float [m]
    """
    return float(np.hypot(orientation.length, max(orientation.width, orientation.height)))


def room_of(orientations: Sequence[LyingPart]) -> float:
    """Return the length of track that a device has to itself, by the longest orientation.

    Parameters
    ----------
    orientations : sequence of LyingPart

    Returns
    -------
    float [m]
        ``ROOM_PER_DEVICE`` of their lengths.
    """
    return ROOM_PER_DEVICE * max(orientation.length for orientation in orientations)


def share(margin: float, sigma: float) -> float:
    """Return the share that passes at a margin: Phi(margin / sigma).

    Parameters
    ----------
    margin : float [m]
    sigma : float [m]
        Standard deviation of the margin; 0: all or nothing.

    Returns
    -------
    float [1]

    References
    ----------
    The normal distribution of what a margin scatters by.
    """
    if sigma > 0.0:
        return 0.5 * math.erfc(-margin / (sigma * math.sqrt(2.0)))
    return float(margin >= -LIMIT_TOLERANCE_M)


def carried(margin: float, travel: float, carry: float) -> float:
    """Return the margin of an orientation that travels, from that of one that is placed.

    A part that travels needs time to tip: what it travels on before it has tipped is taken from the way over
    which it is not supported. Within it the verdict has no margin.

    Parameters
    ----------
    margin : float [m]
        Of one that is placed.
    travel : float [m]
        The way over which it is not supported.
    carry : float [m]
        The way that it travels on before it has tipped.

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    return margin if margin >= 0.0 else min(max(margin, carry - travel), -UNSURE)


class MeasuredYield(Device):
    """A share that passes, by aspect."""

    kind = "measured yield"
    trade = Trade(
        "{A: 0.9}",
        "share that passes, by aspect, as measured; aspects not named pass",
        forms.by_name(forms.quantity("number", "0", "1")),
        old_name="yield",
    )
    action = Action.MEASURED

    read = staticmethod(values.shares)

    def value_text(self) -> str:
        return mapping_text((units.quoted(name), f"{share:.9g}") for name, share in self.shares)

    @property
    def value_words(self) -> str:
        return "passes " + ", ".join(f"{100.0 * share:.4g} % of {name}" for name, share in self.shares)

    def judged(self, encounter: Encounter) -> Verdict:
        shares = {name.casefold(): share for name, share in self.shares}
        return Verdict(shares.get(encounter.orientation.aspect.casefold(), 1.0), math.nan)
