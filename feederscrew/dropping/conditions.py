"""Launch conditions as people give them, '20 mm:50 mm', and back."""

import numpy as np
from scipy.constants import g

from feederscrew.dropping.launches import PRESETS
from feederscrew.errors import ConfigError
from feederscrew.units import QuantityError, quantity

KEYS = {  # option: dimension, what it is divided by, from the part's length and gravity; lowest, highest
    "fall": ("length", lambda length, gravity: length, 0.0, 1000.0),
    "spin": ("angular velocity", lambda length, gravity: np.sqrt(gravity / length), 0.0, 100.0),
    "speed": ("velocity", lambda length, gravity: np.sqrt(gravity * length), 0.0, 100.0),
    "restitution": ("number", lambda length, gravity: 1.0, 0.0, 1.0),
    "friction": ("number", lambda length, gravity: 1.0, 0.0, 5.0),
}
OPTIONS = {"fall": "--height"}  # where the option is not called as the range is


def launch_of(preset, length, texts, gravity=g):
    """A preset with the user's own ranges in it.

    Parameters
    ----------
    preset : str
        A key of PRESETS.
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
    ConfigError
        If a text is no such quantity, or out of range.
    """
    ranges = {
        key: None if text is None else _range(key, text, length, gravity) for key, text in texts.items()
    }
    return PRESETS[preset].but(**ranges)


def described(launch, length, gravity=g):
    """Name and ranges of a launch in the units of the shop, for documents.

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
        "forward": launch.forward,
    }


def share(text, where):
    """A share above 0 and below 1 as typed, '1%' or '0.01'."""
    return _within(where, _read(where, text, "number"), 1e-4, 0.5, text)


def _range(key, text, length, gravity):
    """(lowest, highest) without dimensions from 'a' or 'a:b'."""
    dimension, unit, lowest, highest = KEYS[key]
    where = OPTIONS.get(key, f"--{key}")
    ends = [_read(where, end, dimension) / unit(length, gravity) for end in text.split(":")]
    if len(ends) > 2 or ends[0] > ends[-1]:
        raise ConfigError(
            where, f"{text!r} is no range", "give one value, or the smaller and the larger as a:b"
        )
    return tuple(_within(where, end, lowest, highest, text) for end in (ends[0], ends[-1]))


def _read(where, text, dimension):
    try:
        return quantity(text, dimension)
    except QuantityError as fault:
        raise ConfigError(where, fault.what, fault.mend) from fault


def _within(where, value, lowest, highest, text):
    if not lowest <= value <= highest:
        raise ConfigError(
            where, f"{text!r} is out of range", f"stay from {lowest:g} to {highest:g} (for this part)"
        )
    return value
