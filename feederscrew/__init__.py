"""Resting aspects, screw mechanics and conveying of small parts in vibratory bowl feeders.

Shape letters in docstrings: V vertices, F mesh faces, T hull triangles, A aspects, K corners of a polygon,
N samples; other letters are explained where they stand. SI units and radians throughout; ``[1]`` means no
unit.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

__version__ = "0.2.0"

if TYPE_CHECKING:
    from feederscrew.api import *  # noqa: F403

__all__ = [
    "Answer", "Aspects", "Bowl", "ConfigError", "Faults", "FeederError", "MeshError", "Part", "Posture",
    "Rate", "Shares", "aspects", "calibrate", "compare", "convey", "design", "drop", "find_aspects",
    "floor", "headings", "inertia", "load", "posture", "rate", "read_bowl", "report", "reproduce", "shake",
    "shares", "size_bowl", "slide", "tooling", "track", "trial", "tune", "write_names",
]  # fmt: skip

ROOMS = ("tooling", "trial")  # functions that share their name with a folder of the package


class _Library(ModuleType):
    """The package: importing the folder `feederscrew.tooling` does not replace the function of that name."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in __all__ and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Library


def __getattr__(name: str) -> object:
    """Import a public name when it is first used: ``import feederscrew`` stays quick."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.api"), name)
    if name in ROOMS:  # `import feederscrew.tooling.orientations as x` looks for `mirrored` in the function
        folder = import_module(f"{__name__}.{name}").__dict__
        folder.update(value.__dict__)
        value.__dict__ = folder
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the library's names alone: what a shell completes after ``fs.``."""
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
