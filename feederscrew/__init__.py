"""Resting aspects, screw mechanics and conveying of small parts in vibratory bowl feeders.

A function has the name of its command, and returns the record that the command writes its files from: a
short text, its table by ``to_frame()``, its picture by ``plot()``. Quantities are texts, '2 mm', or numbers
in SI units; shares are fractions.

Shape letters in docstrings: V vertices, F mesh faces, T hull triangles, A aspects, K corners of a polygon,
N samples; other letters are explained where they stand. SI units and radians throughout; ``[1]`` means no
unit.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from feederscrew.version import __version__ as __version__

if TYPE_CHECKING:
    from feederscrew.batch.sweep import sweep
    from feederscrew.bowl.record import Bowl
    from feederscrew.conveying.answer import Answer
    from feederscrew.designing.design import DesignSearch, design
    from feederscrew.errors import ConfigError, Faults, FeederError, MeshError
    from feederscrew.part.loading import load
    from feederscrew.part.record import Part
    from feederscrew.rates.well_oriented import Rate
    from feederscrew.resting.aspects import Aspect, Aspects, write_names
    from feederscrew.resting.posture import Posture, posture
    from feederscrew.studies.arguments import read_bowl
    from feederscrew.studies.aspects import aspects, find_aspects, inertia
    from feederscrew.studies.bowl import size_bowl
    from feederscrew.studies.compare import calibrate, compare
    from feederscrew.studies.convey import convey
    from feederscrew.studies.drop import drop, shake
    from feederscrew.studies.floor import floor
    from feederscrew.studies.headings import headings
    from feederscrew.studies.rate import Shares, rate, shares
    from feederscrew.studies.report import report
    from feederscrew.studies.slide import slide
    from feederscrew.studies.tooling import ToolingSearch, tooling
    from feederscrew.studies.track import track
    from feederscrew.studies.trial import trial
    from feederscrew.studies.tune import tune
    from feederscrew.thesis.reproduction import reproduce

__all__ = [
    "Answer", "Aspect", "Aspects", "Bowl", "ConfigError", "DesignSearch", "Faults", "FeederError",
    "MeshError", "Part", "Posture", "Rate", "Shares", "ToolingSearch", "aspects", "calibrate",
    "compare", "convey", "design", "drop", "find_aspects", "floor", "headings", "inertia", "load",
    "posture", "rate", "read_bowl", "report", "reproduce", "shake", "shares", "size_bowl", "slide",
    "sweep", "tooling", "track", "trial", "tune", "write_names",
]  # fmt: skip

HOMES = {  # module: the names that it offers
    "batch.sweep": "sweep",
    "bowl.record": "Bowl",
    "conveying.answer": "Answer",
    "designing.design": "DesignSearch design",
    "errors": "ConfigError Faults FeederError MeshError",
    "part.loading": "load",
    "part.record": "Part",
    "rates.well_oriented": "Rate",
    "resting.aspects": "Aspect Aspects write_names",
    "resting.posture": "Posture posture",
    "studies.arguments": "read_bowl",
    "studies.aspects": "aspects find_aspects inertia",
    "studies.bowl": "size_bowl",
    "studies.compare": "calibrate compare",
    "studies.convey": "convey",
    "studies.drop": "drop shake",
    "studies.floor": "floor",
    "studies.headings": "headings",
    "studies.rate": "Shares rate shares",
    "studies.report": "report",
    "studies.slide": "slide",
    "studies.tooling": "ToolingSearch tooling",
    "studies.track": "track",
    "studies.trial": "trial",
    "studies.tune": "tune",
    "thesis.reproduction": "reproduce",
}
HOME = {name: f"{__name__}.{module}" for module, names in HOMES.items() for name in names.split()}
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
    value = getattr(import_module(HOME[name]), name)
    if name in ROOMS:  # `import feederscrew.tooling.fates as x` looks for `fates` in the function
        folder = import_module(f"{__name__}.{name}").__dict__
        folder.update(value.__dict__)
        value.__dict__ = folder
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the library's names alone: what a shell completes after ``fs.``."""
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
