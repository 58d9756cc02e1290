"""The module of tables and pictures of records: the library's root names it, which knows all stages."""

from importlib import import_module
from types import ModuleType

place = ""  # dotted name of the module


def views() -> ModuleType:
    """Import the module of views; its first use takes as long as the libraries of its tables."""
    return import_module(place)
