"""Launch conditions as people give them, '20 mm:50 mm', and back."""

import numpy as np

from feederscrew.dropping.launches import named
from feederscrew.errors import ArgumentError
from feederscrew.units import GRAVITY, QuantityError, factor, quantity, quantity_text

KEYS = {  # argument: dimension, what it is divided by, from the part's length and gravity; lowest, highest
    "fall": ("length", lambda length, gravity: length, 0.0, 1000.0),
    "spin": ("angular velocity", lambda length, gravity: np.sqrt(gravity / length), 0.0, 100.0),
    "speed": ("velocity", lambda length, gravity: np.sqrt(gravity * length), 0.0, 100.0),
    "restitution": ("number", lambda length, gravity: 1.0, 0.0, 1.0),
    "friction": ("number", lambda length, gravity: 1.0, 0.0, 5.0),
}
NARROWEST, WIDEST = 1e-4, 0.5  # [1] half-widths of an interval that drops may go on for
SHOWN = {"length": "mm", "velocity": "mm/s", "angular velocity": "rad/s", "number": ""}  # units of limits


def launch_of(preset, length, texts, gravity=GRAVITY):
    """Return a preset with the user's own ranges in it.

    Source: docs/resting.md, "The drop test".

    Parameters
    ----------
    preset : str
        A key of ``launches.PRESETS``, or a former name.
    length : float [m]
        Of the part: cube root of its hull's volume.
    texts : dict of str to (str or None)
        By key of KEYS: a quantity, or two with a colon between; None keeps the preset's.
    gravity : float [m/s2]

    Returns
    -------
    Launch

    Raises
    ------
    ArgumentError
        If a text is no such quantity, or out of range.
    """
    ranges = {
        key: None if text is None else _range(key, text, length, gravity) for key, text in texts.items()
    }
    return named(preset).but(**ranges)


def single(text):
    """Return a number [1] as typed, if it is one value and no range such as '0.3:0.3'; else None."""
    return None if text is None or ":" in text else _read("restitution", text, "number")


def described(launch, length, gravity=GRAVITY):
    """Return the name and ranges of a launch in the units of the shop, for documents.

    Source: docs/resting.md, "The drop test".

    Parameters
    ----------
    launch : Launch
    length : float [m]
    gravity : float [m/s2]

    Returns
    -------
    dict
    """
    speed, rate = 1e3 * np.sqrt(gravity * length), np.sqrt(gravity / length)
    return {
        "name": launch.name,
        "height_mm": [1e3 * length * end for end in launch.fall],
        "spin_rad_s": [rate * end for end in launch.spin],
        "speed_mm_s": [speed * end for end in launch.speed],
        "restitution": list(launch.restitution),
        "friction": list(launch.friction),
        "axis": launch.axis,
    }


def share(text, where):
    """Read a share [1] above 0 and below 1 as typed, '1%' or '0.01'."""
    value = _read(where, text, "number")
    if not NARROWEST <= value <= WIDEST:
        limits = f"give {NARROWEST:.2%} to {WIDEST:.0%}"
        raise ArgumentError(where, f"{quantity_text(text)} is out of range", limits)
    return value


def _range(key, text, length, gravity):
    """Read (lowest, highest) without dimensions from 'a' or 'a:b'."""
    dimension, unit, lowest, highest = KEYS[key]
    size = unit(length, gravity)
    ends = [_read(key, end, dimension) / size for end in text.split(":")]
    if len(ends) > 2 or ends[0] > ends[-1]:
        what = f"{quantity_text(text)} is not a range"
        raise ArgumentError(key, what, "give one value, or the smaller and the larger as a:b")
    if not lowest <= ends[0] <= ends[-1] <= highest:
        limits = f"give {_limit(lowest * size, dimension)} to {_limit(highest * size, dimension)}"
        of_part = "" if dimension == "number" else " for this part"
        raise ArgumentError(key, f"{quantity_text(text)} is out of range", limits + of_part)
    return ends[0], ends[-1]


def _limit(value, dimension):
    """A limit in SI units as a user would type it, rounded down to three digits."""
    number = value / factor(SHOWN[dimension], dimension)
    step = 10.0 ** (np.floor(np.log10(number)) - 2.0) if number > 0.0 else 1.0
    return f"{np.floor(number / step + 1e-9) * step:.6g} {SHOWN[dimension]}".strip()


def _read(where, text, dimension):
    try:
        return quantity(text, dimension)
    except QuantityError as fault:
        raise ArgumentError(where, fault.what, fault.mend) from fault
