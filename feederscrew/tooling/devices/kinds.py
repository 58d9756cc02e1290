"""Every kind of device, found in the modules of this folder: a new one is a class in a module here."""

import importlib
import pkgutil

from feederscrew.tooling import devices
from feederscrew.tooling.devices.base import Device

# class by kind, in the order of the modules; rails, which end a chain, and what has no place last
KINDS: dict[str, type[Device]] = {}


def found():
    """Fill KINDS with the classes of all modules of this folder, and return it."""
    classes = []
    for info in pkgutil.iter_modules(devices.__path__):
        module = importlib.import_module(f"{devices.__name__}.{info.name}")
        for one in vars(module).values():
            if isinstance(one, type) and issubclass(one, Device) and one.dimension:
                classes.append(one)
    for one in sorted(classes, key=lambda one: (not one.placed, one.hangs)):
        KINDS.setdefault(one.kind, one)
    return KINDS


def made(kind, where, **values):
    """Return a device of a kind by its name."""
    return KINDS[kind](where, **values)


found()
