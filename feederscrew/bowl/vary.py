"""One key of the bowl over a range, KEY=a:b:n."""

from collections.abc import Iterable
from dataclasses import dataclass

from feederscrew import documents, units
from feederscrew.bowl.key import Key
from feederscrew.bowl.reading import checked, named
from feederscrew.errors import ArgumentError, ConfigError

MAX_RANGE_VALUES = 2000  # values of one key


@dataclass(frozen=True)
class KeyRange:
    """Evenly spaced values of one key."""

    key: Key
    values: tuple[float, ...]  # [SI]


def ranges(texts: Iterable[str]) -> tuple[KeyRange, ...]:
    """Return the ranges of one command.

    Parameters
    ----------
    texts : sequence of str
        'drive.vibration_angle=5:60:200': from 5 to 60 in 200 values. Both ends may carry a
        unit, '0.05mm:0.6mm:20'; without one they are in the unit of the key's limits.

    Returns
    -------
    tuple of KeyRange

    Raises
    ------
    Faults
        Every fault of every text, one a line; also a field varied twice.
    """
    found: dict[str, KeyRange] = {}
    faults: list[ConfigError] = []
    for text in texts:
        try:
            one = _range(text)
            if one.key.field in found:
                raise ArgumentError(f"vary {one.key.name}", "is varied twice", "vary two different keys")
            found[one.key.field] = one
        except ConfigError as fault:
            faults.append(fault)
    documents.raise_all(faults)
    return tuple(found.values())


def _range(text: str) -> KeyRange:
    name, _, span = (part.strip() for part in text.partition("="))
    where = f"vary {units.one_line(name)}"
    key = named(name, where)
    if key.choices:
        raise ArgumentError(where, "is a word, not a number", f"set it to {key.bounds}")
    ends = span.split(":")
    if len(ends) != 3:
        what = f"{units.shown(span)} is not a range"
        raise ArgumentError(where, what, f"write FROM:TO:COUNT, as in {name}={_example(key)}")
    low, high = (checked(key, end, where, bare=True, kind=ArgumentError).value for end in ends[:2])
    if low == high:
        raise ArgumentError(where, "begins where it ends", "give two different values, or set the one")
    steps = _count(ends[2], where) - 1
    return KeyRange(key, tuple((low * (steps - i) + high * i) / steps for i in range(steps + 1)))


def _count(text: str, where: str) -> int:
    if text.strip().isascii() and text.strip().isdigit() and 2 <= int(text.strip()[:9]) <= MAX_RANGE_VALUES:
        return int(text.strip())
    raise ArgumentError(
        where, f"{units.shown(text)} is not a count", f"give a whole number from 2 to {MAX_RANGE_VALUES}"
    )


def _example(key: Key) -> str:
    return f"{key.lowest}:{key.highest}:20".replace(" ", "")
