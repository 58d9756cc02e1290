"""The studies of ``feeder aspects`` and ``inertia``: how a part rests, how often, what tips it; its mass."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.arrays import Array
from feederscrew.part.mass import MassBalance, mass_balance
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspect, Aspects, find, require_ground
from feederscrew.resting.exact_tumbling import Transition, transitions
from feederscrew.resting.rules import recommended
from feederscrew.resting.rules.recommended import LAUNCH, Recommended
from feederscrew.running import OnCores
from feederscrew.signatures import with_shown_signature
from feederscrew.studies import arguments, simulation_cache

if TYPE_CHECKING:
    from feederscrew.dropping.ensemble import Tally
    from feederscrew.studies.drop import DropStudy

# half the widest 95 % interval of the sampling at which a part is dropped no further: beside what a launch's
# name leaves open, some 10 %, it widens the interval that is printed by a hundredth
AIM = "1.6%"
MAX_DROPS = 20_000  # drops: a share of a half takes half of them


@dataclass(frozen=True, eq=False)
class AspectsStudy(ReadableRecord):
    """The resting aspects of one part, with a drop test of it where one was asked for or needed."""

    part: Part
    aspects: Aspects
    tally: "Tally | None" = None  # of the drop test

    def __len__(self) -> int:
        return len(self.aspects)

    def __iter__(self) -> Iterator[Aspect]:
        return iter(self.aspects)

    def __getitem__(self, name: str | int) -> Aspect:
        """Return the aspect of a name, 'A', or of a place, as ``Aspects`` does."""
        return self.aspects[name]

    @property
    def recommended(self) -> Recommended | None:
        """The answer to take: the drop test where there is one, else the closed form; None of a card."""
        return self.aspects.recommended

    @property
    def doubtful(self) -> bool:
        """Return whether a self-check of exact tumbling failed."""
        return self.aspects.ground is not None and bool(self.aspects.ground.tips.doubts)

    @property
    def transitions(self) -> list[Transition]:
        """The tipping graph: the lowest way from each aspect into each other and into its equal.

        Raises MeshError if the part is a card without a shape.
        """
        return transitions(require_ground(self.part, self.aspects))


@with_shown_signature
def aspects(
    part: Part,
    *,
    unstable: bool = False,
    as_published: bool = False,
    surface: str | float | None = None,
    launch: str | None = None,
    drops: int | None = None,
    jobs: int | None = None,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> AspectsStudy:
    """Find the resting aspects of a part and how often it lands on each, as ``feeder aspects``.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    unstable : bool
        List the facets that it rolls off too.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    surface : str or float [1], optional
        What it lands on, 'soft', 'medium', 'hard', or the exponent: the surface-weighted rule is then the
        answer, and the part is not dropped.
    launch : str, optional
        What is done to the part: 'place', 'drop', 'flip', 'roll', 'feed'; the last without it.
    drops : int, optional
        Drop it so often; with 0 never: the answer is then the closed form. Without it the part is dropped
        until every share is known to AIM.
    jobs : int, optional
        Cores to use; all there are without it. Nothing else depends on it.
    progress : callable, optional
        As in ``ensemble.drop``.
    before : callable, optional
        Called before a drop test begins, with the number of drops, None where that is not known.

    Returns
    -------
    AspectsStudy
        Its ``aspects`` are the record of arrays, in SI units; ``to_frame()`` is ``aspects.csv``.

    Raises
    ------
    FeederError
        If the centre of mass is not inside the convex hull, or a card is to be dropped.
    """
    part, exponent = arguments.a_part(part), arguments.surface(surface)
    launch = LAUNCH if launch is None else launch
    closed = find(part, unstable=unstable, as_published=as_published, exponent=exponent, launch=launch)
    wanted = part.vertices is not None and np.count_nonzero(closed.stable) > 1 and exponent is None
    if drops == 0 or (drops is None and not wanted):
        return AspectsStudy(part, closed)
    launch, run = recommended.launch_of_name(launch), OnCores(jobs, progress, before)
    from feederscrew.dropping.ensemble import drops_of
    from feederscrew.studies.drop import drop

    many: dict[str, Any] = {"drops": MAX_DROPS, "until": AIM} if drops is None else {"drops": drops}

    def make() -> "DropStudy":
        if run.before:
            run.before(many["drops"])
        return drop(part, launch, **many, jobs=run.cores, progress=run.progress, aspects=closed)

    def to_arrays(test: "DropStudy") -> dict[str, Array]:
        return {name: value for name, value in vars(test.result.drops).items() if name != "partial"}

    def from_arrays(arrays: Mapping[str, Array]) -> "DropStudy":
        return drop(part, launch, **many, dropped=drops_of(arrays, many["drops"]), aspects=closed)

    test = simulation_cache.once(
        part,
        closed,
        "drop",
        (launch, drops),
        make,
        lambda test: not test.result.drops.partial,
        to_arrays,
        from_arrays,
    )
    test = replace(test, part=part, aspects=closed)
    return with_drops(closed, test, launch)


@with_shown_signature
def find_aspects(part: Part, *, unstable: bool = False, as_published: bool = False) -> Aspects:
    """Return the resting aspects of a part as a record of arrays, in SI units.

    Parameters
    ----------
    part : Part
    unstable, as_published : bool
        As for ``aspects``.

    Returns
    -------
    Aspects
    """
    return aspects(part, unstable=unstable, as_published=as_published).aspects


def with_drops(closed: Aspects, test: "DropStudy", launch: str) -> AspectsStudy:
    """Return the study of a part with a drop test, whose answer takes the place of the closed form's.

    A warning says so where the user stopped the test, or nothing came to rest.

    Parameters
    ----------
    closed : Aspects
        With the closed form's answer for the launch.
    test : DropStudy
    launch : str
        Of the test: 'feed'.

    Returns
    -------
    AspectsStudy
        With the closed form's answer where nothing came to rest.
    """
    tally = test.result.tally
    warnings = list(closed.warnings)
    answer: Recommended | None = tally.answer(launch)
    if test.result.drops.partial:
        warnings.append(f"partial: stopped after {test.drops} drops")
    if not tally.counts.any():
        answer = closed.recommended
        warnings.append(f"none of {test.drops} drops came to rest: the closed form is taken")
    return AspectsStudy(test.part, replace(closed, recommended=answer, warnings=tuple(warnings)), tally)


@dataclass(frozen=True, eq=False)
class InertiaStudy(ReadableRecord):
    """A part, and what follows from its volume, mass and inertia."""

    part: Part
    balance: MassBalance


def inertia(part: Part) -> InertiaStudy:
    """Return the mass properties of a part, as ``feeder inertia``.

    Parameters
    ----------
    part : Part

    Returns
    -------
    InertiaStudy

    Raises
    ------
    ArgumentError
        If it is not a Part.
    """
    return InertiaStudy(arguments.a_part(part), mass_balance(part))
