"""The ``verified`` block of a bowl file: what a trial of exactly this bowl with this part has shown."""

import datetime
import enum
import hashlib
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from os import PathLike
from typing import Any

import numpy as np

from feederscrew.base import documents, units
from feederscrew.base.columns import Column
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.part.record import Part

VERIFIED_SECTION = "verified"
SHARED = {field.name for field in fields(Device)}  # what every device has
RATE_KEPT = 0.9  # [1] of the target
PURE = 0.98  # [1] of what leaves
SHOWN_PURITY = 0.97  # [1] that the lower bound (95 %, one-sided) of the purity is above
DRAWS_HELD = 0.95  # [1] of the draws
AGREED_JAMS = 1.0 / units.HOUR  # [1/s] that a buyer tolerates where nothing else is agreed
VERIFIED_TOLERANCE = 1e-3  # [1] of a number as the file writes it
NOTHING_LEFT = "none"  # the purity of a queue that nothing left
MAX_RATE = 1e6 / units.MINUTE  # [1/s]
MAX_QUEUE_S = 1e7  # [s] four months
MAX_COUNT = 10**6  # of parts, jams and draws
MAX_SEED = 2**64
MAX_TEXT, MAX_CONDITION = 200, 1000  # letters
HASH = re.compile(r"[0-9a-f]{16,64}", re.ASCII)
VERSION = re.compile(r"\d+(\.[0-9A-Za-z]+){1,5}([+-][0-9A-Za-z.]+)?", re.ASCII)
MAX_CLOCK_SKEW = datetime.timedelta(days=1)  # by which the clock of another machine may be wrong
# how parts leave
LYING = "lying"
HANGING = "hanging"
FILLS = ("low", "normal", "high")  # of a queue
AMONG = " or "  # between the names of what counts as one


class Status(enum.StrEnum):
    """Status of a design or of its trial; files print the word."""

    HOLDS = "holds"
    HOLDS_SINGLE = "holds if parts arrive single"  # two of them hook, and do not part by themselves
    NO_MACHINE = "tooling holds, its machine cannot be made"  # springs, drive or solid; never of a trial
    FALLS_SHORT = "falls short"
    NONE = "none"  # nothing delivers anything
    NOT_PROVED = "not proved"  # stopped by the user
    NOT_TRIED = "not tried"


HELD = (Status.HOLDS, Status.HOLDS_SINGLE)  # what a bowl may be built from
CONDITIONS = (Status.HOLDS_SINGLE, Status.NO_MACHINE)  # its tooling holds, and something else has to be met


@dataclass(frozen=True)
class VoidTrial:
    """A block that cannot be a record of a trial: nothing in it counts."""

    faults: tuple[str, ...]  # what is wrong with it, a sentence each

    def void(self, part: Part | None, bowl: Bowl, version: str, wanted: str | None = None) -> Iterator[str]:
        """Say what is wrong with it, as ``Verified.void`` does of a block that can be one.

        Parameters
        ----------
        part : Part or None
        bowl : Bowl
        version : str
        wanted : str, optional
            As for ``Verified.void``: nothing of them is looked at.

        Yields
        ------
        str
            A sentence for each fault.
        """
        yield from self.faults


@dataclass(frozen=True)
class Verified:
    """Trial of a bowl, as its file records it, and the outcome."""

    status: str  # one of HELD, or 'falls short'
    wanted: str  # 'A@2', 'hanging'
    target: float  # [1/s]
    delivered: float  # [1/s] that the queue of the trial delivered
    low: float  # [1/s]
    high: float  # [1/s]
    purity: float | None  # [1]; None where nothing left
    jams: int
    queue_seconds: float  # [s]
    draws: int
    held: int
    version: str
    part: str  # sha256 of its file
    bowl: str  # of ``fingerprint``
    up: str = ""  # aspects that counted as the wanted one, whatever their heading: 'A, B'
    body: str = ""  # of ``body_fingerprint``; '' where the file does not say
    outcome: str = ""  # LYING or HANGING; '' where the file does not say
    fill: str = ""  # the worst one, of which rate and purity are; '' where the file does not say
    condition: str = ""  # under which it holds, what meets it and what to change; '' of any other status
    purity_low: float | None = None  # [1] lower bound of the purity (one-sided, 95 %); None where not said

    def void(self, part: Part | None, bowl: Bowl, version: str, wanted: str | None = None) -> Iterator[str]:
        """Yield what is other than was tried, a sentence each; nothing where the block holds.

        Parameters
        ----------
        part : Part or None
        bowl : Bowl
        version : str
            Of this program.
        wanted : str, optional
            The aspect, 'A', or the orientation, 'A@2', that is counted now.

        Yields
        ------
        str
        """
        if part is not None and part.sha256[: len(self.part)] != self.part:
            yield "the part is another one than was tried"
        elif part is not None and not self.body:
            yield "it does not say of which units, density, centre of mass and names the part was (no body)"
        elif part is not None and body_fingerprint(part) != self.body:
            yield "the part has other units, density, centre of mass or names than was tried"
        if wanted is not None and not self.counts(wanted):
            tried, other = units.one_line(self.wanted), units.one_line(wanted)
            yield f"{tried} was tried, and {other} is another orientation"
        leaving = HANGING if any(device.action is Action.HANG for device in bowl.devices) else LYING
        if self.outcome not in ("", leaving):
            yield f"its outcome is {self.outcome}, and parts leave these devices {leaving}"
        if fingerprint(bowl) != self.bowl:
            yield "the bowl has been changed since it was tried"
        if self.version != version:
            yield f"version {self.version} tried it, this is {version}"

    def counts(self, wanted: str) -> bool:
        """Tell whether an aspect or an orientation is what the trial counted.

        A trial of 'A' counted that aspect at any heading.

        Parameters
        ----------
        wanted : str
            'A' or 'A@2'.

        Returns
        -------
        bool
        """
        first, *more = (name.casefold() for name in self.wanted.split(AMONG))
        up = {*more, *(name.strip().casefold() for name in self.up.split(",") if name.strip())}
        name = wanted.casefold()
        aspect = name.rpartition("@")[0] or name
        first_aspect = first.rpartition("@")[0] or first
        equal = name == first if "@" in name and "@" in first else aspect == first_aspect
        return equal or aspect in up or name in up

    @property
    def sentence(self) -> str:
        """Return what the trial showed, in a sentence."""
        minute = units.PER_MINUTE
        purity = "nothing left" if self.purity is None else f"purity {100.0 * self.purity:.3g} %"
        counted = f", {self.up} at any heading counted in: a rule counts one orientation" if self.up else ""
        at = f" at {self.fill} fill, the worst" if self.fill else ""
        return (
            f"its trial delivers {self.delivered / minute:.4g}/min ({self.low / minute:.3g} "
            f"to {self.high / minute:.3g}) of {self.wanted}{counted}, {purity}{at}, "
            f"{self.jams} jams in {self.queue_seconds:.3g} s of queue, "
            f"{self.held} of {self.draws} draws sort: {self.status}"
        )


VERIFIED_COLUMNS: tuple[Column[Verified], ...] = (  # who it is of
    Column("status", lambda trial: trial.status),
    Column("wanted", lambda trial: trial.wanted),
    Column("up", lambda trial: trial.up),
)
VERIFIED_RATE_COLUMNS: tuple[Column[Verified], ...] = (
    Column("parts_per_minute", lambda trial: trial.delivered, "1/min"),
    Column("parts_per_minute_low", lambda trial: trial.low, "1/min"),
    Column("parts_per_minute_high", lambda trial: trial.high, "1/min"),
)
VERIFIED_FIGURE_COLUMNS: tuple[Column[Verified], ...] = (
    Column("purity", lambda trial: trial.purity, "share"),
    Column("jams", lambda trial: trial.jams),
    Column("queue_seconds", lambda trial: trial.queue_seconds, "s"),
    Column("draws", lambda trial: trial.draws),
    Column("draws_held", lambda trial: trial.held),
)


LATER_KEYS = ("second_harmonic_angle",)  # since version 0.2.0
LATER_FIELDS = ("air",)  # of devices, since version 0.2.0


def fingerprint(bowl: Bowl) -> str:
    """Return a short text that another drive, friction, track or device changes.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    str
        Of sixteen digits; the last digits of numbers do not count.
    """
    listed = []
    for record in (bowl.drive, bowl.friction, bowl.track):
        # of a key that files of version 0.2.0 did not have only where it is given
        values = [v for name, v in vars(record).items() if v is not None or name not in LATER_KEYS]
        listed.append(" ".join("-" if value is None else f"{value:.5g}" for value in values))
    listed += [f"{bowl.restitution:.5g}", f"{bowl.gravity:.5g}"]
    for device in bowl.devices:
        limit = f"{device.limit:.5g}" if math.isfinite(device.limit) else "-"
        flat = [end for pair in device.corners for end in pair]
        also = [end for other in device.also for end in other]
        numbers = " ".join(f"{end:.5g}" for end in (*device.span, *flat, *device.like[1:], *also[1::2]))
        given = {e.name: getattr(device, e.name) for e in fields(device) if e.name not in SHARED}
        own = " ".join(
            _own(value) for key, value in given.items() if value is not None or key not in LATER_FIELDS
        )
        name = device.trade.old_name or device.kind  # as in the fingerprints of files that were tried before
        listed.append(f"{name} {limit} {(*device.like[:1], *also[::2])} {numbers} {own}")
    return hashlib.sha256("\n".join(listed).encode()).hexdigest()[:16]


def _own(value: object) -> str:
    """Return what only devices of some kinds have, such as an angle: to four digits, as files write six."""
    if isinstance(value, tuple):
        return f"({' '.join(map(_own, value))})"
    if value is None:
        return "nan"  # as it stands in the fingerprints of files that were tried before
    return f"{value:.4g}" if isinstance(value, float) and math.isfinite(value) else str(value)


def body_fingerprint(part: Part) -> str:
    """Return a short text that other units, density, centre of mass or names of a part change.

    Parameters
    ----------
    part : Part

    Returns
    -------
    str
        Of sixteen digits; the last digits of numbers do not count.
    """
    size = 1.0 if part.vertices is None else float(np.ptp(part.vertices, axis=0).max())
    centre = " ".join(f"{round(float(place) / size, 3) + 0.0:.3f}" for place in part.centre_of_mass)
    names = () if part.names is None else part.names.names
    listed = [f"{part.mass:.5g}", f"{size:.5g}", centre, repr(names)]
    return hashlib.sha256("\n".join(listed).encode()).hexdigest()[:16]


def verified(path: str | PathLike[str] | None) -> Verified | VoidTrial | None:
    """Return the ``verified`` block of a bowl file.

    Parameters
    ----------
    path : str or path or None

    Returns
    -------
    Verified, VoidTrial or None
        None where the file has no such block; a VoidTrial where what it says cannot be of a trial.
    """
    if path is None or str(path) == "-":
        return None
    root, _ = documents.read(path)
    entry = root.find(VERIFIED_SECTION) if root.kind == "mapping" else None
    if entry is None:
        return None
    if entry.value.kind != "mapping":
        return VoidTrial((f"{VERIFIED_SECTION} is no mapping",))
    text = {each.key: each.value.text for each in entry.value.entries}  # of a list or a mapping ''
    # what is wrong with single fields; what they say is not repeated
    values, faults = {}, []
    for key, (read, form) in (READERS | OPTIONAL).items():
        try:
            if key in text:
                values[key] = read(text[key])
            elif key in READERS:
                faults.append(f"it has no {key}")
        except ValueError:
            faults.append(f"{key} is not {form}")
    if faults:
        return VoidTrial(tuple(faults))
    renamed = {"delivered_low": "low", "delivered_high": "high", "draws_held": "held"}
    own = {renamed.get(key, key): value for key, value in values.items()}
    block = Verified(**{field.name: own[field.name] for field in fields(Verified) if field.name in own})
    faults = [*_contradictions(block)]
    return VoidTrial(tuple(faults)) if faults else block


def _number(dimension: str, low: float, high: float) -> Callable[[str], float]:
    """A reader of numbers from low to high, in SI units; of counts of whole numbers."""

    def read(text: str) -> float:
        if dimension == "count":
            value: float = int(text) if re.fullmatch(r"\d{1,20}", text, re.ASCII) else -1
        else:
            value = units.quantity(text, dimension)
        if not low <= value <= high:
            raise ValueError
        return value

    return read


def _form(fits: Callable[[str], object], most: int) -> Callable[[str], str]:
    """A reader of texts of one form, of so many letters at most."""

    def read(text: str) -> str:
        if len(text) > most or not fits(text):
            raise ValueError
        return text

    return read


def _date(text: str) -> datetime.date:
    date = datetime.date.fromisoformat(text) if text.isascii() else datetime.date.max
    if date > datetime.datetime.now(datetime.UTC).date() + MAX_CLOCK_SKEW:
        raise ValueError
    return date


_RATE = _number("rate", 0.0, MAX_RATE), "a rate from 0 to 1e6/min"
_COUNT = _number("count", 0, MAX_COUNT), "a whole number up to 1000000"
_SHARE = _number("number", 0.0, 1.0)
_TEXT = _form(lambda text: text.strip() and text.isprintable(), MAX_TEXT)
_HASH = _form(HASH.fullmatch, 64)
READERS: dict[str, tuple[Callable[[str], Any], str]] = {  # by key: how it is read, and what it must be
    "status": (
        _form((*HELD, Status.FALLS_SHORT).__contains__, MAX_TEXT),
        " or ".join(f"'{status}'" for status in (*HELD, Status.FALLS_SHORT)),
    ),
    "wanted": (_TEXT, "the name of an orientation"),
    "target": _RATE,
    "delivered": _RATE,
    "delivered_low": _RATE,
    "delivered_high": _RATE,
    "purity": (lambda text: None if text == NOTHING_LEFT else _SHARE(text), "a share from 0 to 1, or none"),
    "jams": _COUNT,
    "queue_seconds": (_number("time", 1e-3, MAX_QUEUE_S), "a time of more than 0 s"),
    "draws": _COUNT,
    "draws_held": _COUNT,
    "version": (_form(VERSION.fullmatch, 40), "a version"),
    "part": (_HASH, "16 digits of the sha256 of the part's file"),
    "bowl": (_HASH, "the 16 digits of a bowl"),
}
OPTIONAL: dict[str, tuple[Callable[[str], Any], str]] = {
    "up": (_TEXT, "names of aspects"),
    "outcome": (_form((LYING, HANGING).__contains__, MAX_TEXT), f"{LYING} or {HANGING}"),
    "condition": (_form(lambda text: text.strip() and text.isprintable(), MAX_CONDITION), "a sentence"),
    "fill": (_form(FILLS.__contains__, MAX_TEXT), f"one of {', '.join(FILLS)}"),
    "purity_low": (_SHARE, "a share from 0 to 1"),
    "trial_parts": (_number("count", 1, MAX_COUNT), "a whole number from 1 to 1000000"),
    "seed": (_number("count", 0, MAX_SEED), "a whole number"),
    "tried": (_date, "a date up to today"),
    "body": (_HASH, "the 16 digits of a part"),
}


def _contradictions(block: Verified) -> Iterator[str]:
    """Fields that cannot be true together, a sentence each."""
    if not block.low <= block.delivered <= block.high:
        yield "delivered is not between delivered_low and delivered_high"
    if block.held > block.draws:
        yield "draws_held is more than draws"
    if (block.purity or 0.0) <= 0.0 < block.delivered:
        yield "parts were delivered at a purity of 0"
    if block.purity and not block.delivered > 0.0:
        yield "nothing was delivered, and what left was pure"
    # why a design with these figures does not hold
    enough = 1.0 - VERIFIED_TOLERANCE
    shortfalls = {
        "less than the target was delivered": not block.target > 0.0
        or block.low < enough * RATE_KEPT * block.target,
        f"the purity is below {100.0 * PURE:.3g} %": (block.purity or 0.0) < enough * PURE,
        f"no purity above {100.0 * SHOWN_PURITY:.3g} % is shown": block.purity_low is not None
        and block.purity_low < enough * SHOWN_PURITY,
        "there were jams": block.jams > 0,
        "too few draws held": block.held < DRAWS_HELD * block.draws or not block.draws,
    }
    why = " and ".join(text for text, is_so in shortfalls.items() if is_so)
    if block.status in HELD and why:
        yield f"its status is '{block.status}', and {why}"
    if block.purity_low is not None and block.purity_low > (block.purity or 0.0) / enough:
        yield "purity_low is more than the purity"
    if block.condition and block.status != Status.HOLDS_SINGLE:
        yield f"its status is '{block.status}', and it has a condition under which it holds"
