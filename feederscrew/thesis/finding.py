"""One thing a reader of the thesis should know."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """A slip, a silence, or what explains a number; its numbers are computed, never typed."""

    id: str
    where: str  # in the thesis
    what: str
    how: str  # how it shows, a template for the numbers of ``evidence``
    evidence: Callable[[], dict] = dict

    @property
    def shown(self):
        """How it shows, with the numbers filled in."""
        return self.how.format(**self.evidence())
