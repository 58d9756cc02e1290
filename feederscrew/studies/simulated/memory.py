"""Simulations that a run has made already, or an earlier one, by all that decides them."""

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.studies.simulated import on_disk

MAX_RECORDS = 32
_RECORDS: OrderedDict = OrderedDict()

Record = TypeVar("Record")


@dataclass(frozen=True)
class Simulation(Generic[Record]):
    """What is simulated of a part: how it is made, and how plain arrays on a disk stand for it."""

    kind: str  # 'arrival', 'drop'
    settings: tuple  # all that decides it beside the part, written out the same whenever it is the same
    make: Callable[[], Record]
    is_whole: Callable[[Record], bool]  # not of a run that the user stopped
    to_arrays: Callable[[Record], Mapping[str, np.ndarray]]
    from_arrays: Callable[
        [Mapping[str, np.ndarray]], Record
    ]  # ValueError or KeyError where they are not of one


def once(part: Part, aspects: Aspects, simulation: Simulation[Record]) -> Record:
    """Return what was simulated of a part before; else simulate it, and keep it if it is whole.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    simulation : Simulation

    Returns
    -------
    object
        As ``simulation.make`` returns it, of this part or of one that no number tells from it.
    """
    key = {
        "kind": simulation.kind,
        "part": _digest(part, aspects),
        "settings": repr(simulation.settings),
    }
    place = tuple(key.values())
    if place not in _RECORDS:
        record = _from_disk(key, simulation)
        if record is None:
            record = simulation.make()
            if not simulation.is_whole(record):
                return record
            on_disk.write(key, simulation.to_arrays(record))
        _RECORDS[place] = record
        while len(_RECORDS) > MAX_RECORDS:
            _RECORDS.popitem(last=False)
    return _RECORDS[place]


def _from_disk(key: Mapping[str, str], simulation: Simulation[Any]) -> Any:
    """The record of an entry on disk; None where there is none whose numbers can be of this simulation."""
    arrays = on_disk.read(key)
    if arrays is None:
        return None
    try:
        return simulation.from_arrays(arrays)
    except (ValueError, KeyError):
        return None


def _digest(part: Part, aspects: Aspects) -> str:
    """Of all that decides what a simulation makes of a part."""
    arrays = (part.vertices, part.faces, part.centre_of_mass, part.inertia, aspects.normals, aspects.stable)
    text = hashlib.sha256(repr((float(part.mass), aspects.names)).encode())
    for array in arrays:
        text.update(np.ascontiguousarray(array).tobytes())
    return text.hexdigest()


def forget() -> None:
    """Forget all that was simulated: for tests that simulate it otherwise."""
    _RECORDS.clear()
