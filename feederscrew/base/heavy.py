"""Libraries and modules that take long to import: each is loaded by the function that needs it first."""

from importlib import import_module
from types import ModuleType
from typing import Any


class _Heavy(ModuleType):
    """Stands for a module, which its first attribute imports."""

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module(self.__name__), name)


def heavy(name: str) -> Any:
    """Return a stand-in for a module until an attribute of it is needed: that imports it.

    Parameters
    ----------
    name : str
        Of the module: 'matplotlib.patches'.

    Returns
    -------
    module
    """
    return _Heavy(name)
