"""Every kind of device, found in the modules of this folder: a new one is a class in a module here."""

import enum
import importlib
import pkgutil
import re
from collections.abc import Callable, Sequence
from typing import Any

from feederscrew.bowl import devices
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.leans import Lean
from feederscrew.bowl.devices.trade import Action

# class by kind, in the order of the modules; twist and rails, which end a chain, and what has no place last
KINDS: dict[str, type[Device]] = {}
_BY_SPELLING: dict[str, type[Device]] = {}  # the same by every name, as ``_spelling`` writes it
_ADDED = re.compile(r"\s*\([^()]*\)\s*$")  # what a full name says more: '(camera from above)'


class CostClass(enum.StrEnum):
    """What a chain takes, the dearest of its devices; members in the order in which chains are proposed."""

    STEEL = "steel"  # cuts, blades and rails alone
    AIR = "air"  # air that blows all the time as well
    SENSOR = "sensor"  # a camera or another sensor, with a valve

    @property
    def number(self) -> int:
        """Its place in the order of cost, from 1: the ``cost_class`` of a device."""
        return 1 + list(CostClass).index(self)

    @classmethod
    def of(cls, devices: Sequence[Device]) -> "CostClass":
        """Return the class of a chain of devices; steel where there is none."""
        return list(cls)[cost_class(devices) - 1]


def register_kinds() -> dict[str, type[Device]]:
    """Fill KINDS with the classes of all modules of this folder, and return it.

    Returns
    -------
    dict of str to class of Device
        By the names that files have.
    """
    classes = []
    for info in pkgutil.iter_modules(devices.__path__):
        module = importlib.import_module(f"{devices.__name__}.{info.name}")
        for value in vars(module).values():
            own = isinstance(value, type) and value.__module__ == module.__name__
            if own and issubclass(value, Device) and value is not Device and "kind" in vars(value):
                classes.append(value)
    ends = Action.TWIST, Action.HANG
    for value in sorted(classes, key=lambda value: (not value.action.has_place, value.action in ends)):
        KINDS.setdefault(value.kind, value)
        for name in filter(None, (value.kind, value.trade.old_name)):
            _BY_SPELLING.setdefault(_spelling(name), value)
    return KINDS


def find_kind(name: str) -> type[Device] | None:
    """Return the kind of device that a name means: the one place where names are looked up.

    Parameters
    ----------
    name : str
        Each name that something prints: 'vision reject', 'Vision reject (camera from above)', with blanks,
        hyphens or underscores, and the keys of bowl files of before, 'sorter'.

    Returns
    -------
    class of Device, or None
    """
    return _BY_SPELLING.get(_spelling(name))


def make_device(kind: str, where: str, **values: Any) -> Device:
    """Return a device of a kind by its name.

    Parameters
    ----------
    kind : str
        As ``find_kind`` takes it.
    where : str
        What asks for it, for its faults.
    **values : object
        Fields of the class, in SI units.

    Returns
    -------
    Device

    Raises
    ------
    KeyError
        There is no such kind.
    """
    return _BY_SPELLING[_spelling(kind)](where, **values)


def names(are: Callable[[type[Device]], bool]) -> tuple[str, ...]:
    """Return the names of the kinds of which something is true.

    Parameters
    ----------
    are : callable
        From a class of Device to a bool: ``lambda kind: kind.action.turns``.

    Returns
    -------
    tuple of str
    """
    return tuple(name for name, kind in KINDS.items() if are(kind))


def shaped() -> tuple[str, ...]:
    """Return the names of the kinds for whose shape a design looks, by many verdicts.

    Returns
    -------
    tuple of str
    """
    return names(lambda kind: kind.search.is_shape)


def cost_class(devices: Sequence[Device]) -> int:
    """Return the cost class of a chain, that of the dearest of its devices.

    Parameters
    ----------
    devices : sequence of Device

    Returns
    -------
    int
        1 steel alone, 2 steady air, 3 a sensor with a valve.
    """
    return max((device.cost_class for device in devices), default=1)


def dearer(cost: int) -> tuple[str, ...]:
    """Return the names of the kinds whose cost class is above one.

    Parameters
    ----------
    cost : int

    Returns
    -------
    tuple of str
    """
    return names(lambda kind: kind.trade.cost_class > cost)


def cheaper(cost: int) -> tuple[str, ...]:
    """Return the names of the kinds below a cost class that reject parts or let them hang: a tuple of str.

    What leans or spaces parts rejects none, and is not among them.
    """

    def rejects(kind: type[Device]) -> bool:
        return kind.search.is_proposed or kind.search.is_shape or kind.action is Action.HANG

    return names(lambda kind: kind.trade.cost_class < cost and rejects(kind))


def leaning() -> tuple[type[Lean], ...]:
    """Return the kinds that lean the track.

    Returns
    -------
    tuple of class of Lean
    """
    return tuple(kind for kind in KINDS.values() if issubclass(kind, Lean))


def _spelling(name: str) -> str:
    """A name in small letters, its words apart by blanks, without what a full name adds."""
    return " ".join(re.split(r"[\s_-]+", _ADDED.sub("", name).strip().casefold()))


register_kinds()
