"""Resting aspects, screw mechanics and conveying of small parts in vibratory bowl feeders.

Shape letters in docstrings: V vertices, F mesh faces, T hull triangles, A aspects, K corners of a polygon,
N samples; other letters are explained where they stand. SI units and radians throughout; ``[1]`` means no
unit.
"""

import functools
import importlib
import sys
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

__version__ = "0.2.0"

if TYPE_CHECKING:
    from feederscrew.api import (
        Answer,
        Aspects,
        Bowl,
        ConfigError,
        Faults,
        FeederError,
        MeshError,
        Part,
        Posture,
        Rate,
        Shares,
        aspects,
        calibrate,
        compare,
        convey,
        drop,
        find_aspects,
        floor,
        headings,
        inertia,
        load,
        posture,
        rate,
        read_bowl,
        report,
        reproduce,
        shake,
        shares,
        size_bowl,
        slide,
        tooling,
        track,
        trial,
        tune,
        write_names,
    )

__all__ = [
    "Answer", "Aspects", "Bowl", "ConfigError", "Faults", "FeederError", "MeshError", "Part", "Posture",
    "Rate", "Shares", "aspects", "calibrate", "compare", "convey", "design", "drop", "find_aspects",
    "floor", "headings", "inertia", "load", "posture", "rate", "read_bowl", "report", "reproduce", "shake",
    "shares",
    "size_bowl", "slide", "tooling", "track", "trial", "tune", "write_names",
]  # fmt: skip


ROOMS = ("tooling", "trial")  # functions that share their name with a folder of the package


class _FunctionAndRoom:
    """A function that has the modules of the room of its name as attributes.

    ``feederscrew.tooling(part, bowl)`` is a call, ``import feederscrew.tooling.orientations as ways`` works.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        functools.update_wrapper(self, function)

    def __call__(self, *given: Any, **named: Any) -> Any:
        return self.__wrapped__(*given, **named)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(importlib.import_module(f"{__name__}.{self.__name__}"), name)


class _Library(ModuleType):
    """The package: ``tooling`` and ``trial`` are functions of it, though rooms of those names are in it."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in __all__ and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Library


def __getattr__(name: str) -> object:
    """A public name, its library imported when it is first asked for: ``feeder --help`` stays quick."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return _public(name)


@functools.cache
def _public(name: str) -> object:
    from feederscrew import api

    found = getattr(api, name)
    return _FunctionAndRoom(found) if name in ROOMS else found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
