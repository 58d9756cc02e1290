"""The study of ``feeder aspects``: how a part rests, how often, and what tips it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.arrivals import simulation_cache
from feederscrew.arrivals.heap_count import HeapCount
from feederscrew.base.arrays import Array, Floats
from feederscrew.base.columns import Column, Frame, of_arrays, of_records
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import OnCores
from feederscrew.base.signatures import with_shown_signature
from feederscrew.base.units import GRAVITY
from feederscrew.bowl import arguments
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspect, Aspects, find, require_ground
from feederscrew.resting.exact_tumbling import Transition, transitions
from feederscrew.resting.inertia_products import InertiaProducts, find_products
from feederscrew.resting.rules import recommended, registry
from feederscrew.resting.rules.recommended import LAUNCH, Recommended

if TYPE_CHECKING:
    from feederscrew.arrivals.drop import DropStudy
    from feederscrew.arrivals.ensemble import Tally

# half the widest 95 % interval of the sampling at which a part is dropped no further: beside what a launch's
# name leaves open, some 10 %, it widens the interval that is printed by a hundredth
AIM = "1.6%"
MAX_DROPS = 20_000  # drops: a share of a half takes half of them


@dataclass(frozen=True, eq=False)
class AspectsStudy(ReadableRecord, view="aspects.ASPECTS_VIEW"):
    """The resting aspects of one part, with a drop test of it where one was asked for or needed."""

    part: Part
    aspects: Aspects
    tally: "Tally | None" = None  # of the drop test
    heap: HeapCount | None = None  # of a heap, where one was asked for

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

    def table(self) -> Frame:
        """Return the classes of resting aspects, a row each: ``aspects.csv``."""
        return of_arrays(aspect_columns(self), self)

    def transitions_table(self) -> Frame:
        """Return the tipping graph, a row a way from one aspect into another or its equal: ``graph.csv``."""
        return of_records(TRANSITION_COLUMNS, [(self, tip) for tip in self.transitions])


def aspect_columns(study: AspectsStudy) -> list[Column[AspectsStudy]]:
    """Return the columns of the aspects of a study: those that its part, rules and drop test have.

    An open surface is labelled in every row, and tumbling that fails a self-check. A card has no shape and
    does not say how it lies.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    list of Column
        Of arrays, a row an aspect.
    """
    resting, part, count = study.aspects, study.part, len(study.aspects)
    lying = () if part.hull is None else LYING_COLUMNS
    columns = [*NAME_COLUMNS, *lying, *ASPECT_COLUMNS]
    columns += [_rule_column(rule) for rule in resting.probabilities]
    if part.hull is not None and part.inertia is not None:
        products: InertiaProducts = find_products(resting, part.inertia)
        columns += [
            Column("product_of_inertia_g_mm2", lambda _: products.products, "g mm2"),
            Column("p_pmi_principal", lambda _: products.probabilities, "share", "pmi principal"),
        ]
    if resting.barriers is not None:
        columns += BARRIER_COLUMNS
    columns.append(Column("rolling_circle_mm", lambda study: _finite(study.aspects.rolling_circles), "mm"))
    for name, answer in (("drop", study.tally), ("recommended", study.recommended)):
        if answer is not None:
            columns += _answer_columns(name, answer)
    if part.open_surface:
        columns.append(Column("surface", lambda _: ["open"] * count))
    if study.doubtful:
        columns.append(Column("tumbling", lambda _: ["doubtful"] * count))
    return columns


NAME_COLUMNS: tuple[Column[AspectsStudy], ...] = (Column("aspect", lambda study: study.aspects.names),)
LYING_COLUMNS: tuple[Column[AspectsStudy], ...] = (  # of a part with a shape
    Column("lies", lambda study: study.aspects.lies),
    Column("rolls", lambda study: study.aspects.rolls),
)
ASPECT_COLUMNS: tuple[Column[AspectsStudy], ...] = (  # of every part
    Column("faces", lambda study: study.aspects.faces),
    Column("stable", lambda study: study.aspects.stable),
    Column("normal_x", lambda study: study.aspects.normals[:, 0]),
    Column("normal_y", lambda study: study.aspects.normals[:, 1]),
    Column("normal_z", lambda study: study.aspects.normals[:, 2]),
    Column("height_mm", lambda study: study.aspects.heights, "mm"),
    Column("contact_area_mm2", lambda study: study.aspects.contact_areas, "mm2"),
    Column("solid_angle_sr", lambda study: study.aspects.solid_angles, "sr"),
    Column("polar_inertia_g_mm2", lambda study: study.aspects.polar_inertias, "g mm2"),
)
BARRIER_COLUMNS: tuple[Column[AspectsStudy], ...] = (  # of a part with a shape
    Column("barrier_mm", lambda study: study.aspects.barriers, "mm"),
    Column("barrier_uJ", lambda study: study.aspects.barrier_energies, "uJ"),
    Column("tip_angle_deg", lambda study: study.aspects.tip_angles, "deg"),
)
TRANSITION_COLUMNS: tuple[Column[tuple[AspectsStudy, Transition]], ...] = (
    Column("from", lambda way: way[0].aspects.names[way[1].start]),
    Column("to", lambda way: way[0].aspects.names[way[1].end]),
    Column("barrier_mm", lambda way: way[1].lift, "mm"),
    Column("barrier_uJ", lambda way: way[0].part.mass * GRAVITY * way[1].lift, "uJ"),
    Column("axis_x", lambda way: way[1].axis[0]),
    Column("axis_y", lambda way: way[1].axis[1]),
    Column("axis_z", lambda way: way[1].axis[2]),
)


def _rule_column(rule: str) -> Column[AspectsStudy]:
    """The column of a probability rule, by its name."""
    heading = registry.heading(rule)
    return Column(f"p_{rule}", lambda study: study.aspects.probabilities[rule], "share", heading)


def _answer_columns(name: str, answer: "Recommended | Tally") -> list[Column[AspectsStudy]]:
    """The columns of an answer with the ends of its interval."""
    return [
        Column(f"p_{name}", lambda _: answer.p, "share", name),
        Column(f"p_{name}_low", lambda _: answer.low, "share", "low"),
        Column(f"p_{name}_high", lambda _: answer.high, "share", "high"),
    ]


def _finite(lengths: Floats) -> Floats:
    return np.where(np.isfinite(lengths), lengths, np.nan)


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
        until every share is known to 1.6 % to either side (95 %).
    jobs : int, optional
        Cores to use; all there are without it. Nothing else depends on it.
    progress : callable, optional
        Called as drops end: how many are done, of how many at most, and how wide the longest interval of a
        share is [1].
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
    from feederscrew.arrivals.drop import drop
    from feederscrew.arrivals.ensemble import drops_of

    most, until = (MAX_DROPS, AIM) if drops is None else (drops, None)

    def make() -> "DropStudy":
        if run.before:
            run.before(most)
        return drop(
            part, launch, drops=most, until=until, jobs=run.cores, progress=run.progress, aspects=closed
        )

    def to_arrays(test: "DropStudy") -> dict[str, Array]:
        return {name: value for name, value in vars(test.result.drops).items() if name != "partial"}

    def from_arrays(arrays: Mapping[str, Array]) -> "DropStudy":
        return drop(part, launch, drops=most, until=until, dropped=drops_of(arrays, most), aspects=closed)

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
        Those of ``aspects`` alone: a row a class, the likeliest named 'A'.

    Raises
    ------
    FeederError
        As for ``aspects``.
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
