"""The library's front door: what a script needs, by plain names; ``feederscrew`` itself hands them on.

A function has the name of its command, and returns the record that the command writes its files from: a
short text, its table by ``to_frame()``, its picture by ``plot()``. Quantities are texts, '2 mm', or numbers
in SI units; shares are fractions.
"""

from feederscrew.api.asked import Shares
from feederscrew.api.chains import report, reproduce, tooling, trial
from feederscrew.api.designs import design
from feederscrew.api.drives import convey, floor, headings, read_bowl, slide, track
from feederscrew.api.lying import (
    aspects,
    calibrate,
    compare,
    find_aspects,
    inertia,
    load,
    posture,
    write_names,
)
from feederscrew.api.output_rates import rate, shares, size_bowl, tune
from feederscrew.api.tosses import drop, shake
from feederscrew.bowl import Bowl
from feederscrew.conveying.answer import Answer
from feederscrew.errors import ConfigError, Faults, FeederError, MeshError
from feederscrew.part import Part
from feederscrew.rates.well_oriented import Rate
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture

__all__ = [
    "Answer", "Aspects", "Bowl", "ConfigError", "Faults", "FeederError", "MeshError", "Part", "Posture",
    "Rate", "Shares", "aspects", "calibrate", "compare", "convey", "design", "drop", "find_aspects",
    "floor", "headings", "inertia", "load", "posture", "rate", "read_bowl", "report", "reproduce", "shake",
    "shares",
    "size_bowl", "slide", "tooling", "track", "trial", "tune", "write_names",
]  # fmt: skip
