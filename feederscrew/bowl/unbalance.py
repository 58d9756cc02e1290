"""Where the mass of a bowl lies about its axis, as keys of its machine."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from feederscrew.bowl.key import Key
from feederscrew.bowl.record import Unbalance
from feederscrew.errors import FeederError

CENTRE = "centre_x", "centre_y", "centre_z"
INERTIA_NAMES = "inertia_x", "inertia_y"
PRODUCT_OF_INERTIA_NAMES = "product_yz", "product_xz", "product_xy"
UNBALANCE_NAMES = (*CENTRE, *INERTIA_NAMES, *PRODUCT_OF_INERTIA_NAMES)
UNBALANCE_TOLERANCE = 1e-9  # of what is rounded in a file


def _key(word: str, dimension: str, lowest: str, highest: str, default: str, meaning: str) -> Key:
    return Key(f"machine.{word}", f"machine.{word}", dimension, lowest, highest, default, meaning)


def _centre(word: str, place: str) -> Key:
    return _key(word, "length", "-3000 mm", "3000 mm", "0 mm", f"of the bowl's centre of mass, {place}")


def _upright(word: str) -> Key:
    meaning = f"moment of inertia of the bowl about {word[-1].upper()}, at the upper ends of the leaves"
    return _key(word, "inertia", "0 kg m2", "5000 kg m2", "0 kg m2", meaning)


def _product(word: str) -> Key:
    meaning = f"sum of its masses times {word[-2]} times {word[-1]}, from there"
    return _key(word, "inertia", "-5000 kg m2", "5000 kg m2", "0 kg m2", meaning)


UNBALANCE_KEYS = (
    _centre("centre_x", "off its axis; all zero: balanced"),
    _centre("centre_y", "off its axis"),
    _centre("centre_z", "over the upper ends of the leaves"),
    *map(_upright, INERTIA_NAMES),
    *map(_product, PRODUCT_OF_INERTIA_NAMES),
)


def known(values: Mapping[str, Any], hand: str) -> dict[str, Any]:
    """Return the fields of a Machine, with its unbalance in place of the keys that say it.

    Parameters
    ----------
    values : dict of str to float [SI]
        By word of a key of the machine.
    hand : str
        Of the track: 'left' turns the other way as it rises.

    Returns
    -------
    dict [SI]
        Without unbalance where all those keys are zero: nothing is known.

    Raises
    ------
    FeederError
        If no body has them.
    """
    rest = {word: value for word, value in values.items() if word not in UNBALANCE_NAMES}
    if not any(np.any(values.get(word, 0.0)) for word in UNBALANCE_NAMES):
        return rest
    x, y, z = (values["bowl_mass"] * values[word] for word in CENTRE)
    xx, yy = (values[word] for word in INERTIA_NAMES)
    yz, xz, xy = (values[word] for word in PRODUCT_OF_INERTIA_NAMES)
    if not any(np.ndim(value) for value in values.values()):
        _check(values)
    return rest | {"unbalance": Unbalance((x, y, z), (xx, yy), (yz, xz, xy), -1.0 if hand == "left" else 1.0)}


def _check(values: Mapping[str, Any]) -> None:
    """Raise the fault of a tensor that no body has: second moments about its centre are not below 0."""
    x, y, z = (values[word] for word in CENTRE)
    mass, total = (
        values["bowl_mass"],
        0.5 * (values["inertia_x"] + values["inertia_y"] + values["bowl_inertia"]),
    )
    xx, yy, zz = (
        total - values[word] - mass * at * at
        for word, at in (("inertia_x", x), ("inertia_y", y), ("bowl_inertia", z))
    )
    yz, xz, xy = (
        values[word] - mass * one * other
        for word, one, other in zip(PRODUCT_OF_INERTIA_NAMES, (y, x, x), (z, z, y))
    )
    whole = xx * yy * zz + 2.0 * xy * xz * yz - xx * yz * yz - yy * xz * xz - zz * xy * xy
    if min(xx, xx * yy - xy * xy, whole) < -UNBALANCE_TOLERANCE * total**2 * max(total, 1.0):
        what = "no body has such a centre of mass, moments and products of inertia"
        raise FeederError("machine.inertia_x", what, "give all eight of one body, or leave them out")


def told(machine: Any) -> dict[str, float]:
    """Return the values of those keys of a Machine, by word; none where nothing is known.

    Parameters
    ----------
    machine : Machine
    """
    own = machine.unbalance
    moments = [one / machine.bowl_mass for one in own.moment]
    found = dict(zip(UNBALANCE_NAMES, (*moments, *own.upright, *own.products)))
    return found if any(found.values()) else {}
