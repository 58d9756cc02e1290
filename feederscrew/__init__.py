"""Resting aspects, screw mechanics and conveying of small parts in vibratory bowl feeders.

A function has the name of its command, and returns the record that the command writes its files from: a
short text, its table by ``to_frame()``, its picture by ``plot()``. Quantities are texts, '2 mm', or numbers
in SI units; shares are fractions.

Shape letters in docstrings: V vertices, F mesh faces, T hull triangles, A aspects, K corners of a polygon,
N samples; other letters are explained where they stand. SI units and radians throughout; ``[1]`` means no
unit.
"""

import lazy_loader

from feederscrew.base import views as _views
from feederscrew.base.version import __version__ as __version__

_views.place = "feederscrew.output.record_views"  # tables and pictures of records, made when one is asked for

_of_stub, _names_of_stub, __all__ = lazy_loader.attach_stub(__name__, __file__)
for _name in ("__version__", "errors"):  # ``fs.errors``: the module, for what has no name of its own here
    __all__.remove(_name)


def __getattr__(name: str) -> object:
    """Import a public name when it is first used: ``import feederscrew`` stays quick."""
    value = _of_stub(name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the library's names alone: what a shell completes after ``fs.``."""
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
