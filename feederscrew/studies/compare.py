"""The study of ``feeder compare``: what was measured on one part against every rule."""

from dataclasses import dataclass
from os import PathLike

from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.counts import deviation, profiles


@dataclass(frozen=True, eq=False)
class CompareStudy:
    """Profiles of one part, measured and by rule, and how far every two of them are apart."""

    part: Part
    aspects: Aspects
    measured: profiles.Measured
    rules: tuple[profiles.Profile, ...]
    comparisons: tuple[deviation.Comparison, ...]  # of every two, in the order of the profiles

    @property
    def profiles(self) -> tuple[profiles.Profile, ...]:
        """What was measured, then the rules."""
        return (*self.measured.profiles, *self.rules)


def compare(part: Part, counts: str | PathLike[str], *, as_published: bool = False) -> CompareStudy:
    """Study how far counts or fractions by aspect are from every rule.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    counts : str or Path
        CSV file with one line an aspect, one column a profile.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.

    Returns
    -------
    CompareStudy

    Raises
    ------
    FeederError
        Every fault of the file, each with its line.
    """
    found = find(part, as_published=as_published)
    rules = profiles.of_rules(found)
    measured = profiles.read(counts, found.names, [rule.name for rule in rules])
    compared = deviation.compare((*measured.profiles, *rules))
    return CompareStudy(part, found, measured, rules, tuple(compared))
