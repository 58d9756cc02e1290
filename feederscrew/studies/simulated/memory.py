"""Simulations that a run has made already, or an earlier one, by all that decides them."""

import hashlib
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import numpy as np

from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.studies.simulated import on_disk

KEPT = 32  # of them
_MADE: OrderedDict = OrderedDict()


def once(
    part: Part, aspects: Aspects, more: tuple, make: Callable[[], Any], whole: Callable[[Any], bool]
) -> Any:
    """Return what was made of a part before; else make it, and keep it if it is whole.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    more : tuple
        All else that decides it, written out the same whenever it is the same.
    make : function
        Without arguments.
    whole : function
        Whether what was made may be taken again: not of a run that the user stopped.

    Returns
    -------
    object
        As ``make`` returns it, of this part or of one that no number tells from it.
    """
    key = _identity(part, aspects, more)
    if key not in _MADE:
        made = on_disk.read(key)
        if made is None:
            made = make()
            if not whole(made):
                return made
            on_disk.write(key, made)
        _MADE[key] = made
        while len(_MADE) > KEPT:
            _MADE.popitem(last=False)
    return _MADE[key]


def _identity(part: Part, aspects: Aspects, more: tuple) -> bytes:
    """All that decides what is made of a part."""
    arrays = (part.vertices, part.faces, part.centre_of_mass, part.inertia, aspects.normals, aspects.stable)
    text = hashlib.sha256(repr((float(part.mass), aspects.names, more)).encode())
    for array in arrays:
        text.update(np.ascontiguousarray(array).tobytes())
    return text.digest()


def forget() -> None:
    """Forget all that was made: for tests that make it otherwise."""
    _MADE.clear()
