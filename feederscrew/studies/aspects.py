"""The study of ``feeder aspects``: how one part rests, how often, and what tips it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import LAUNCH, Recommended, dropped
from feederscrew.resting.rules.surface import EXPONENTS
from feederscrew.resting.tumbling.by_class import Transition, ground, transitions

if TYPE_CHECKING:
    from feederscrew.dropping.ensemble import Tally


@dataclass(frozen=True, eq=False)
class AspectsStudy:
    """The resting aspects of one part, with a drop test of it where one was asked for."""

    part: Part
    aspects: Aspects
    tally: "Tally | None" = None  # of the drop test

    @property
    def recommended(self) -> Recommended | None:
        """The answer to take: the drop test where there is one, else the closed form; None of a card."""
        return self.aspects.recommended if self.tally is None else dropped(self.tally, self.aspects.stable)

    @property
    def doubtful(self) -> bool:
        """Whether a self-check of exact tumbling failed."""
        return self.aspects.ground is not None and bool(self.aspects.ground.tips.doubts)

    @property
    def transitions(self) -> list[Transition]:
        """The tipping graph: the lowest way from each aspect into each other and into its equal.

        Raises
        ------
        MeshError
            If the part is a card without a shape.
        """
        return transitions(ground(self.part, self.aspects))


def aspects(
    part: Part,
    *,
    unstable: bool = False,
    as_published: bool = False,
    surface: str | float = "hard",
    drops: int | None = None,
    progress=None,
) -> AspectsStudy:
    """Study how a part comes to rest.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    unstable : bool
        List the facets it rolls off as well.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    surface : str or float [1]
        What it lands on, for the surface-weighted rule: 'soft', 'medium', 'hard', or the exponent.
    drops : int, optional
        Drop it so often with the usual launches; their answer is then the recommended one.
    progress : function, optional
        As in ``ensemble.drop``.

    Returns
    -------
    AspectsStudy

    Raises
    ------
    FeederError
        If the centre of mass is not inside the convex hull, or a card is to be dropped.
    """
    exponent = EXPONENTS[surface] if isinstance(surface, str) else surface
    found = find(part, unstable=unstable, as_published=as_published, exponent=exponent)
    if drops is None:
        return AspectsStudy(part, found)
    from feederscrew.studies.drop import drop

    dropped_part = drop(part, LAUNCH, drops=drops, progress=progress, aspects=found)
    return AspectsStudy(part, found, dropped_part.result.tally)
