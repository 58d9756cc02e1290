"""The study of ``feeder tooling``: which orientations of a part can be isolated, and by which devices."""

import functools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, cast

import numpy as np

from feederscrew.arrivals.entry import Shares, arriving, the_shares
from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.documents import hint, nearest
from feederscrew.base.errors import ArgumentError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.units import quantity_text
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.device_list import check_written, shank_remarks
from feederscrew.bowl.devices.kinds import (
    KINDS,
    CostClass,
    cheaper,
    dearer,
    find_kind,
    leaning,
    names,
    shaped,
)
from feederscrew.bowl.devices.orientation_names import rows
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl, Track
from feederscrew.bowl.verified import HANGING
from feederscrew.part.record import Part, refuse_many_facets, small_part_remarks
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER
from feederscrew.sorting.fates import at_entry
from feederscrew.sorting.isolating import design as designing
from feederscrew.sorting.isolating.chain import (
    DESIGN_KEY,
    SHOP_ROUNDING_M,
    Design,
    DesignConstraints,
    OutcomeKind,
)
from feederscrew.sorting.isolating.design import DESIGN_MARGIN_M
from feederscrew.sorting.isolating.hole_search import HoleSearch
from feederscrew.sorting.orientations import Orientation, name_mirror_images, orientations, travel_speed
from feederscrew.sorting.tipping import marked, remark, steady

SEARCH_SECONDS = 600.0  # [s] the last resort: a search that it ends may differ from machine to machine
# by the width [m] of its track: a bowl, the orientations that come along it, a cache of those where it leans
Tracks: TypeAlias = dict[float, tuple[Bowl, tuple[Orientation, ...], dict[Any, Any]]]


def listed(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of a list, or of a text with commas."""
    names = names.split(",") if isinstance(names, str) else names
    return tuple(name.strip() for name in names if name.strip())


def may_be_left_out(without: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of kinds of devices that are not used, checked."""
    names, kinds = listed(without), []
    for name in names:
        kind = find_kind(name)
        if kind is None:
            near = nearest(name, KINDS)
            value = None if near is None else ",".join(near if each == name else each for each in names)
            what = f"unknown device {quantity_text(name)}"
            raise ArgumentError("without", what, hint(name, list(KINDS)), value=value)
        kinds.append(kind.kind)
    return tuple(kinds)


def may_be_up(part: Part, aspects: Aspects, up: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of aspects that may be up as well, once the part has them.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of the part.
    up : str or sequence of str
        Names; case does not matter.

    Returns
    -------
    tuple of str

    Raises
    ------
    ArgumentError
        If the part has no such aspect.
    """
    for name in listed(up):
        if name.casefold() not in {own.casefold() for own in aspects.names}:
            mend = f"choose one of {', '.join(aspects.names)}"
            raise ArgumentError("up", f"{part.name} has no aspect {quantity_text(name)}", mend)
    return listed(up)


def check_named(
    part: Part,
    track: Track,
    aspect: str | None,
    heading: float | None = None,
    *,
    up: str | Sequence[str] = (),
    without: str | Sequence[str] = (),
    aspects: Aspects | None = None,
) -> None:
    """Refuse names that are not there before anything is simulated: aspects, headings, kinds of devices.

    Parameters
    ----------
    part : Part
    track : Track
        Whose headings may be named.
    aspect : str or None
    heading : float [rad], optional
    up : str or sequence of str
        Aspects that may be up as well.
    without : str or sequence of str
        Kinds of devices to leave out.
    aspects : Aspects, optional
        Of the part, where they are known already.

    Returns
    -------
    None

    Raises
    ------
    ArgumentError
        If one of them is not there.
    """
    may_be_left_out(without)
    check.of_an_aspect(aspect, heading)
    if part.vertices is None or (aspect is None and not listed(up)):
        return
    aspects = find(part) if aspects is None else aspects
    may_be_up(part, aspects, up)
    if aspect is not None:
        rows(aspects.names, aspect, f"aspect of {part.source}", ArgumentError)
        if heading is not None:
            designing.place(orientations(part, aspects, track), aspect, heading, part.source)


LATE = "the search stopped at the time limit: another machine may find more - raise the limit"


@dataclass(frozen=True, eq=False)
class ToolingStudy(ReadableRecord, view="tooling.TOOLING_VIEW"):
    """Every orientation of a part on a track, and what isolates it behind the bowl's devices; M of them."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    rule: str  # whose probabilities are taken
    margin: float  # [m] asked for to either side
    orientations: tuple[Orientation, ...]
    shares: Floats  # (M,) [1]
    designs: tuple[Design | None, ...]  # (M,) None where it was not asked for
    wanted: int | None  # the orientation asked for; None for all of them
    up: tuple[str, ...] = ()  # aspects that count as the one wanted
    play: float = designing.PLAY_M  # [m] of the part from the wall, within the margin
    tolerance: float = designing.TOLERANCE_M  # [m] of its size, within the margin
    trials: tuple[Any, ...] = ()  # of TriedDesign: what was tried, that of `design` first
    partial: bool = False  # stopped by the user before all was searched and tried
    state: str = ""  # what leaves, as a design that was tried says it: 'hanging', 'A@2 or B'
    in_vain: tuple[tuple[CostClass, int], ...] = ()  # cheaper classes, and in how many trials no chain held
    # names of the orientations, as they come, of which a part left in the trial of `design`
    left_in_trial: tuple[str, ...] = ()
    dearer: Design | None = None  # of the next class that isolates the orientation asked for too

    @property
    def leaves_as(self) -> str:
        """Return how parts of the orientation asked for leave its design: 'A@188', or 'hanging' of rails.

        Empty where every orientation is studied.
        """
        if self.wanted is None or self.design is None:
            return ""
        own = HANGING if any(device.action is Action.HANG for device in self.design.devices) else ""
        return self.state or own or self.design.leaves_as or self.orientations[self.wanted].name

    def trial_of(self, place: int) -> Any:
        """Return what the trial of an orientation's design said: its TriedDesign; None without one."""
        return next((trial for trial in self.trials if trial.wanted == place), None)

    def isolates(self, place: int) -> bool:
        """Return whether an orientation is isolated: what leaves is pure, by the rule and by its trial.

        Where no trial was made, what no verdict is sure to return counts as leaving.
        """
        design, tried = self.designs[place], self.trial_of(place)
        if tried is not None:  # no rule overrules it
            return not tried.faults
        return design is not None and design.surely_isolates

    def class_of(self, place: int) -> CostClass | None:
        """Return what the chain takes that isolates an orientation; None where nothing does."""
        design = self.designs[place]
        return CostClass.of(design.devices) if design is not None and self.isolates(place) else None

    @property
    def design(self) -> Design | None:
        """The design of the orientation asked for; None where all were."""
        return None if self.wanted is None else self.designs[self.wanted]

    def on_its_width(self, place: int) -> "ToolingStudy":
        """Return the study on the track that the design of an orientation asks for."""
        design = self.designs[place]
        if design is None or design.width is None:
            return self
        bowl = replace(self.bowl, track=replace(self.bowl.track, width=design.width))
        return replace(self, bowl=bowl, orientations=_coming(self.part, self.aspects, bowl))

    def on_bank(self, bank: float) -> "ToolingStudy":
        """Return the study without designs on a track of another bank [rad]; itself on its own."""
        if bank == self.bowl.track.bank:
            return self
        bowl = replace(self.bowl, track=replace(self.bowl.track, bank=bank))
        coming = _coming(self.part, self.aspects, bowl)
        shares = np.nan_to_num([orientation.chances[self.rule] for orientation in coming])
        return replace(
            self, bowl=bowl, orientations=coming, shares=shares, designs=(None,) * len(coming), wanted=None
        )

    @property
    def answer(self) -> str:
        """Say whose probabilities are taken: 'hops, launch feed', 'csa'."""
        return self.aspects.source(self.rule)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what a user must not overlook, a sentence each."""
        late = any(design is not None and design.late for design in self.designs)
        proposed = (device for design in self.designs if design is not None for device in design.devices)
        shank = shank_remarks((*self.bowl.devices, *proposed))
        lines = (*self.aspects.warnings, *self.of_size, *remark(self.orientations), *shank)
        return (*lines, *([LATE] if late else []))

    @property
    def of_size(self) -> tuple[str, ...]:
        """Return sentences where a part is not much larger than what is asked for, or than the track."""
        margin = self.margin - self.play - self.tolerance
        allowances = {"margin": margin, "play": self.play, "tolerance": self.tolerance}
        return small_part_remarks(self.part, allowances, self.bowl.track.width)


@dataclass(frozen=True)
class ToolingSearch:
    """Limits of the search for cuts: what a workshop can make, and how long the search may take."""

    rule: str = RECOMMENDED_ANSWER  # whose probabilities are taken
    turn: bool = DesignConstraints.turn  # devices that turn parts over may be used
    vary: bool = DesignConstraints.vary  # other banks, grooves and widths of the track are tried
    step: Quantity = DesignConstraints.step  # [m] values of cuts are whole multiples of it
    cutter: Quantity = DesignConstraints.cutter  # [m] radius of the corners of holes
    seed: int = HoleSearch.seed  # of the search for holes
    verdicts: int = HoleSearch.verdicts  # the most in the search for the holes of one orientation
    seconds: Quantity = SEARCH_SECONDS  # [s] after which the search ends


@former_keywords(search=ToolingSearch)
def tooling(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    up: str | Sequence[str] = DesignConstraints.up,
    outcome: str = DesignConstraints.outcome,
    without: str | Sequence[str] = DesignConstraints.without,
    cost_class: str | None = None,
    margin: Quantity = DESIGN_MARGIN_M,
    play: Quantity = designing.PLAY_M,
    tolerance: Quantity = designing.TOLERANCE_M,
    purity: float = 1.0,
    efficiency: float = 0.0,
    aspect_shares: Shares | Aspects | None = None,
    search: ToolingSearch | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> ToolingStudy:
    """Find cuts that isolate an orientation of a part, as ``feeder tooling``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        The one wanted, 'A', or with its heading, 'A@354'; every orientation without it.
    heading : str or float [rad], optional
        Of that aspect.
    up : str or sequence of str
        Other aspects that count as the one wanted, 'B,C'.
    outcome : str
        How parts leave: 'lying', 'hanging' or 'any'.
    without : str or sequence of str
        Kinds of devices that are not used, 'wiper, cut-out'.
    cost_class : str, optional
        What the chain takes: 'steel', 'air' or 'sensor'. Without it the cheapest class that isolates, in this
        order; holes of several corners, which take by far the longest, are then searched for last.
    margin : str or float [m]
        By which the wanted orientation passes and the others fail, at least.
    play, tolerance : str or float [m]
        Of the part from the wall and of its size; both are added to the margin.
    purity : float [1]
        Of what leaves, that is enough.
    efficiency : float [1]
        Of what is offered, that is asked for.
    aspect_shares : Shares or Aspects, optional
        Of ``shares``.
    search : ToolingSearch, optional
        Rule, steps and cutter of the workshop, seed, and how long is looked for holes.
    progress : callable, optional
        Called with how many orientations are done, and of how many.

    Returns
    -------
    ToolingStudy
        Its ``design`` is that of the orientation asked for, ``designs`` are those of all. It is ``partial``
        if the user stopped the search: with the chains that were found until then.

    Raises
    ------
    FeederError
        If the part has no mesh or very many facets, is too large for the bowl, or has no such orientation or
        rule.
    """
    begun = time.monotonic()
    part, bowl = arguments.part_in_bowl(part, bowl)
    looked = check.kind("search", search or ToolingSearch(), ToolingSearch, "give a ToolingSearch")
    rule = looked.rule
    aspect, angle = arguments.an_orientation(aspect, heading)
    lengths = {"margin": margin, "play": play, "tolerance": tolerance}
    clear, play, tolerance = (arguments.amount(k, value, "length", 0.0) for k, value in lengths.items())
    clear += play + tolerance
    purity, efficiency = arguments.share("purity", purity), arguments.share("efficiency", efficiency)
    refuse_many_facets(part)
    if aspect_shares is None:
        check_named(part, bowl.track, aspect, angle, up=up, without=without)
        aspects = arriving(part, bowl, rule)
    elif isinstance(aspect_shares, Aspects):
        aspects = aspect_shares
    else:
        aspects = cast(Shares, the_shares(aspect_shares)).aspects
    coming = _coming(part, aspects, bowl)
    arguments.a_rule(rule, aspects)
    shares = np.nan_to_num([orientation.chances[rule] for orientation in coming])
    check.of_an_aspect(aspect, angle)
    wanted = None if aspect is None else designing.place(coming, aspect, angle, part.source)
    holes = HoleSearch(
        seed=arguments.whole("seed", looked.seed, 0),
        verdicts=arguments.whole("verdicts", looked.verdicts),
        until=begun + arguments.amount("seconds", looked.seconds, "time", 0.0),
    )
    may_use = DesignConstraints(
        outcome=check.choice("outcome", outcome, OutcomeKind),
        without=may_be_left_out(without),
        up=may_be_up(part, aspects, up),
        vary=bool(looked.vary),
        turn=looked.turn,
        step=arguments.amount("step", looked.step, "length", SHOP_ROUNDING_M),
        cutter=arguments.amount("cutter", looked.cutter, "length", 0.0),
    )
    for kind in leaning():  # the stretch that makes gaps in this bowl, where it may be used and makes some
        steeper = kind.parting(DESIGN_KEY) if may_use.allows(kind.kind) else None
        if steeper is None:
            continue
        track = replace(bowl.track, climb=steeper.angle)
        if travel_speed(replace(bowl, track=track)) > travel_speed(bowl):
            may_use = replace(may_use, spacing=steeper)
            break
    request = designing.ChainOptions(
        margin=clear,
        search=holes,
        purity=purity,
        efficiency=efficiency,
        before=bowl.devices,
        constraints=may_use,
    )
    asked = None if cost_class is None else CostClass(check.choice("cost_class", cost_class, CostClass))
    places = range(len(coming)) if wanted is None else [wanted]
    designs: list[Design | None] = [None] * len(coming)
    if progress is not None:
        progress(0, len(places))
    tracks: Tracks = {bowl.track.width: (bowl, coming, {})}
    is_stopped = False
    for done, k in enumerate(places):
        try:
            designs[k] = best = _cheapest(part, aspects, shares, k, tracks, request, asked)
            if progress is not None:
                progress(done + 1, len(places))
        except KeyboardInterrupt:
            is_stopped = True
            if done == 0 and designs[k] is None:  # the first chain there is, without a search for holes
                request["search"] = replace(holes, until=-math.inf)
                designs[k] = best = _cheapest(part, aspects, shares, k, tracks, request, asked)
        if designs[k] is not None:
            check_written(best.devices, "tooling.yaml")
        if is_stopped:
            break
    study = ToolingStudy(
        part,
        bowl,
        aspects,
        rule,
        clear,
        coming,
        shares,
        tuple(designs),
        wanted,
        up=may_use.up,
        play=play,
        tolerance=tolerance,
        partial=is_stopped,
    )
    return study if wanted is None else study.on_its_width(wanted)


def next_class(study: ToolingStudy, of_class: Callable[[CostClass], ToolingStudy]) -> Design | None:
    """Return the chain of the next dearer class that isolates the orientation that a study asks for.

    Parameters
    ----------
    study : ToolingStudy
        Of one orientation.
    of_class : callable
        Returns the study of the same orientation with a chain of a class.

    Returns
    -------
    Design or None
        As the static rule says; None where no dearer class isolates, or the study isolates nothing.
    """
    own = None if study.wanted is None else study.class_of(study.wanted)
    if own is None:
        return None
    for cost_class in list(CostClass)[own.number :]:
        design = of_class(cost_class).design
        if design is not None and design.isolated and CostClass.of(design.devices) is cost_class:
            return design
    return None


@functools.lru_cache(maxsize=32)
def _coming(part: Part, aspects: Aspects, bowl: Bowl) -> tuple[Orientation, ...]:
    coming, _ = marked(name_mirror_images(orientations(part, aspects, bowl.track)), bowl)
    return at_entry(coming, bowl.devices)


def _cheapest(
    part: Part,
    aspects: Aspects,
    shares: Floats,
    wanted: int,
    tracks: Tracks,
    request: designing.ChainOptions,
    asked: CostClass | None,
) -> Design:
    """The design of the class that is asked for, or of the cheapest that isolates; else the purest."""
    constraints: DesignConstraints = request["constraints"]

    def designed(cost_class: CostClass, without: Sequence[str] = (), at_rest: bool = True) -> Design:
        kinds = dict.fromkeys((*constraints.without, *dearer(cost_class.number), *without))
        air = cost_class is not CostClass.STEEL
        own = replace(constraints, without=tuple(kinds), air=air, at_rest=at_rest)
        return _best(part, aspects, shares, wanted, tracks, request | {"constraints": own})

    if asked is not None:
        design = designed(asked)
        if design.isolated and CostClass.of(design.devices) is not asked:  # cheaper devices do without it
            design = designed(asked, cheaper(asked.number))
        return design
    # holes are for one orientation alone, and by far the longest search: where nothing simpler isolates. So
    # are chains that are known to isolate parts at rest alone
    best = designed(CostClass.STEEL, shaped(), at_rest=False)
    for cost_class in (CostClass.AIR, CostClass.SENSOR):
        if best.surely_isolates and best.efficiency >= request["efficiency"]:
            break
        is_last = cost_class is CostClass.SENSOR
        own = names(lambda kind: kind.trade.cost_class == cost_class.number)  # noqa: B023
        if is_last or any(constraints.allows(kind) for kind in own):
            other = designed(cost_class, () if is_last else shaped(), is_last)
            best = other if designing.isolates_more(other, best) else best
    return best


def _best(
    part: Part,
    aspects: Aspects,
    shares: Floats,
    wanted: int,
    tracks: Tracks,
    request: designing.ChainOptions,
) -> Design:
    """The design of an orientation on the bowl's track, or on one of another width that gives more."""
    own, lying, _ = next(iter(tracks.values()))

    def designed(width: float) -> Design:
        bowl, coming, leaning = tracks[width]
        problem = coming, shares, wanted, bowl
        return designing.design_with_track(*problem, steady=steady, cache=leaning, **request)

    best = designed(own.track.width)
    if best.isolated or not request["constraints"].vary or request["before"]:
        return best
    names = [orientation.name for orientation in lying]
    for width in designing.widths(lying, shares, wanted, request["margin"]):
        if time.monotonic() > request["search"].until:
            break
        if width not in tracks:
            bowl = replace(own, track=replace(own.track, width=width))
            tracks[width] = bowl, _coming(part, aspects, bowl), {}
        if [orientation.name for orientation in tracks[width][1]] != names:
            continue
        other = designed(width)
        if designing.gains(other, best):
            wider = f"the track has to be {1e3 * width:.4g} mm wide"
            best = replace(other, width=width, remarks=(*other.remarks, wider))
    return best


def tooling_without(
    kinds: Sequence[str],
    part: Part,
    bowl: Bowl,
    aspect: str | None,
    *,
    without: str | Sequence[str] = (),
    **request: Any,
) -> ToolingStudy:
    """Return the study of an orientation without more kinds of devices, and without a search for holes.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of devices to leave out.
    part : Part
    bowl : Bowl
    aspect : str or None
        That is wanted.
    without : str or sequence of str
        Kinds that the user leaves out.
    **request
        As for ``tooling``.

    Returns
    -------
    ToolingStudy
        At once, as nothing is searched.

    Raises
    ------
    FeederError
        As of ``tooling``.
    """
    return tooling(
        part,
        bowl,
        aspect,
        without=(*listed(without), *kinds, *shaped()),
        **request,
    )
