"""The ``verified`` block of a bowl file: what a trial of exactly this bowl with this part has shown."""

import hashlib
import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from os import PathLike

from feederscrew import documents, units
from feederscrew.bowl.record import Bowl
from feederscrew.part.record import Part
from feederscrew.tooling.devices.base import Device

SECTION = "verified"
SHARED = {one.name for one in fields(Device)}  # what every device has


@dataclass(frozen=True)
class Verified:
    """What was tried of a bowl, and what came of it."""

    status: str  # 'holds', 'falls short'
    wanted: str  # 'A@2', 'hanging'
    target: float  # [1/s]
    delivered: float  # [1/s] that the queue of the trial delivered
    low: float  # [1/s]
    high: float  # [1/s]
    purity: float  # [1]
    jams: int
    queue_seconds: float  # [s]
    draws: int
    held: int
    version: str
    part: str  # sha256 of its file
    bowl: str  # of ``fingerprint``
    up: str = ""  # aspects that counted as the wanted one, whatever their heading: 'A, B'

    def void(self, part: Part | None, bowl: Bowl, version: str) -> Iterator[str]:
        """Say what has changed since, a sentence each; nothing where the block still holds.

        Parameters
        ----------
        part : Part
        bowl : Bowl
        version : str
            Of this program.
        """
        if part is not None and part.sha256[: len(self.part)] != self.part:
            yield "the part is another one than was tried"
        if fingerprint(bowl) != self.bowl:
            yield "the bowl has been changed since it was tried"
        if self.version != version:
            yield f"version {self.version} tried it, this is {version}"

    @property
    def sentence(self) -> str:
        """What the trial showed, in a sentence."""
        minute = units.factor("/min", "rate")
        counted = f", {self.up} at any heading counted in: a rule counts one orientation" if self.up else ""
        return (
            f"its trial delivers {self.delivered / minute:.4g}/min ({self.low / minute:.3g} "
            f"to {self.high / minute:.3g}) of {self.wanted}{counted}, purity {100.0 * self.purity:.3g} %, "
            f"{self.jams} jams in {self.queue_seconds:.3g} s of queue, "
            f"{self.held} of {self.draws} draws sort: {self.status}"
        )


def fingerprint(bowl: Bowl) -> str:
    """Return a short text that another drive, friction, track or device changes.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    str
        Sixteen digits; the last digits of numbers do not count.
    """
    listed = [_told(getattr(bowl, name)) for name in ("drive", "friction", "track")]
    listed += [f"{bowl.restitution:.5g}", f"{bowl.gravity:.5g}"]
    listed += [_device(one) for one in bowl.devices]
    return hashlib.sha256("\n".join(listed).encode()).hexdigest()[:16]


def _told(record: object) -> str:
    return " ".join("-" if value is None else f"{value:.5g}" for value in vars(record).values())


def _device(one: Device) -> str:
    limit = f"{one.limit:.5g}" if math.isfinite(one.limit) else "-"
    flat = [end for pair in one.corners for end in pair]
    others = [end for other in one.also for end in other]
    numbers = " ".join(f"{end:.5g}" for end in (*one.span, *flat, *one.like[1:], *others[1::2]))
    own = (_own(getattr(one, each.name)) for each in fields(one) if each.name not in SHARED)
    return f"{one.kind} {limit} {(*one.like[:1], *others[::2])} {numbers} {' '.join(own)}"


def _own(value: object) -> str:
    """What only devices of some kinds have, such as an angle: to four digits, as files write six."""
    if isinstance(value, tuple):
        return f"({' '.join(map(_own, value))})"
    return f"{value:.4g}" if isinstance(value, float) and math.isfinite(value) else str(value)


def verified(path: str | PathLike[str] | None) -> Verified | None:
    """Return the ``verified`` block of a bowl file, or None where it has none that can be read.

    Parameters
    ----------
    path : str or Path or None
    """
    if path is None or str(path) == "-":
        return None
    root, _ = documents.read(path)
    entry = root.find(SECTION) if root.kind == "mapping" else None
    if entry is None or entry.value.kind != "mapping":
        return None
    text = {one.key: one.value.text for one in entry.value.entries}
    try:
        rates = (
            units.quantity(text[k], "rate")
            for k in ("target", "delivered", "delivered_low", "delivered_high")
        )
        target, delivered, low, high = rates
        return Verified(
            text["status"], text["wanted"], target, delivered, low, high,
            float(text["purity"]), int(text["jams"]),
            units.quantity(text["queue_seconds"], "time"), int(text["draws"]), int(text["draws_held"]),
            text["version"], text["part"], text["bowl"], text.get("up", ""),
        )  # fmt: skip
    except (KeyError, ValueError, units.QuantityError):
        return None
