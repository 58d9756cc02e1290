"""The study of ``feeder aspects``: how one part rests, how often, and what tips it."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from feederscrew.part.record import Part
from feederscrew.records import Shown
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules import recommended
from feederscrew.resting.rules.recommended import LAUNCH, Recommended
from feederscrew.resting.rules.surface import EXPONENTS
from feederscrew.resting.tumbling.by_class import Transition, ground, transitions

if TYPE_CHECKING:
    from feederscrew.dropping.ensemble import Tally

NEEDED = 2000  # drops of a test that nobody asked for: 0.011 of standard error on a share of a half


@dataclass(frozen=True, eq=False)
class AspectsStudy(Shown):
    """The resting aspects of one part, with a drop test of it where one was asked for or needed."""

    part: Part
    aspects: Aspects
    tally: "Tally | None" = None  # of the drop test

    @property
    def recommended(self) -> Recommended | None:
        """The answer to take: the drop test where there is one, else the closed form; None of a card."""
        return self.aspects.recommended

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
    surface: str | float | None = None,
    launch: str = LAUNCH,
    drops: int | None = None,
    progress=None,
    before=None,
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
    surface : str or float [1], optional
        What it lands on, 'soft', 'medium', 'hard', or the exponent: the surface-weighted rule is then the
        recommended closed form.
    launch : str
        What is done to the part: 'place', 'drop', 'flip', 'roll', 'feed'.
    drops : int, optional
        Drop it so often; the answer is then that of the drop test. Without it the part is dropped NEEDED
        times where no closed form is good enough; with 0 never.
    progress : function, optional
        As in ``ensemble.drop``.
    before : function, optional
        Called before a drop test begins, with the number of drops.

    Returns
    -------
    AspectsStudy

    Raises
    ------
    FeederError
        If the centre of mass is not inside the convex hull, or a card is to be dropped.
    """
    exponent = EXPONENTS[surface] if isinstance(surface, str) else surface
    found = find(part, unstable=unstable, as_published=as_published, exponent=exponent, launch=launch)
    if drops is None and found.recommended is not None and found.recommended.wants_drops:
        drops = NEEDED
    if not drops:
        return AspectsStudy(part, found)
    if before:
        before(drops)
    return _dropped(part, found, recommended.launch_named(launch), drops, progress)


def answered(part: Part) -> Aspects:
    """Return the aspects of a part with the recommended answer of the launch that is usual."""
    return aspects(part).aspects


def _dropped(part, found, launch, drops, progress):
    """The study with a drop test."""
    from feederscrew.studies.drop import drop

    return with_drops(part, found, drop(part, launch, drops=drops, progress=progress, aspects=found), launch)


def with_drops(part: Part, found: Aspects, test, launch: str) -> AspectsStudy:
    """Return the study with a drop test, whose answer takes the place of the closed form's.

    Parameters
    ----------
    part : Part
    found : Aspects
        With the closed form's answer for the launch.
    test : DropStudy
        Of that part.
    launch : str
        By its present name.

    Returns
    -------
    AspectsStudy
        Where the two answers have nothing in common, with wider intervals and a warning.
    """
    tally = test.result.tally
    answer, apart = recommended.reconciled(
        recommended.dropped(tally, found.stable, launch), found.recommended
    )
    said = _apart(found, tally, apart)
    return AspectsStudy(part, replace(found, recommended=answer, warnings=found.warnings + said), tally)


def _apart(found, tally, apart):
    """What a user must know where drop test and closed form disagree by more than both their intervals."""
    shares = [
        f"{found.names[k]} {tally.p[k]:.1%} and {found.recommended.p[k]:.1%}" for k in apart.nonzero()[0]
    ]
    if not shares:
        return ()
    rule = found.recommended.rule.partition(",")[0]
    return (
        f"the drop test and the closed form ({rule}) disagree beyond their intervals: {', '.join(shares)} - "
        "the interval is widened to hold both",
    )
