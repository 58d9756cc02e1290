"""Resting aspects, screw mechanics and conveying of small parts in vibratory bowl feeders.

Shape letters in docstrings: V vertices, F mesh faces, T hull triangles, A aspects, K corners of a polygon,
N samples; other letters are explained where they stand. SI units and radians throughout; ``[1]`` means no
unit.
"""

from typing import TYPE_CHECKING

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
        aspects,
        convey,
        drop,
        find_aspects,
        load,
        posture,
        rate,
        read_bowl,
        shake,
        write_names,
    )  # fmt: skip

__all__ = [
    "Answer", "Aspects", "Bowl", "ConfigError", "Faults", "FeederError", "MeshError", "Part", "Posture",
    "Rate", "aspects", "convey", "drop", "find_aspects", "load", "posture", "rate", "read_bowl", "shake",
    "write_names",
]  # fmt: skip


def __getattr__(name: str) -> object:
    """A public name, its library imported when it is first asked for: ``feeder --help`` stays quick."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from feederscrew import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
