"""From a file to a solid with mass properties: the first stage."""

from feederscrew.part.loading import load
from feederscrew.part.record import CardAspect, Part

__all__ = ["CardAspect", "Part", "load"]
