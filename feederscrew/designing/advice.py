"""The study of ``feeder advise``: how hard a part is to feed, why, and which change of its shape helps.

A part is graded by the cheapest way to feed it: the orientation, the class of tooling that isolates it (steel
alone, steady air, a sensor) and the share of the parts that comes right. The same is looked for with each
small change of its shape (``changes``), by the static rule. The changes that gain most are tried by the
search of ``feeder tooling`` with parts of true shape, as the part itself is: a trial has the last word.
"""

import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from feederscrew.arrivals.entry import Shares, arriving
from feederscrew.base import check
from feederscrew.base.errors import FeederError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import with_shown_signature
from feederscrew.base.units import MINUTE
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.kinds import CostClass
from feederscrew.bowl.record import Bowl
from feederscrew.designing import tooling_trials
from feederscrew.designing.changes import Change, list_changes
from feederscrew.designing.hazards import risks
from feederscrew.designing.record import RiskKind
from feederscrew.feeding.rate import rate
from feederscrew.part.loading import load
from feederscrew.part.record import Part, refuse_many_facets
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER
from feederscrew.sorting.isolating.chain import Design
from feederscrew.sorting.orientations import Orientation, name_mirror_images, orientations
from feederscrew.sorting.tooling import ToolingSearch, ToolingStudy, tooling_without

ORIENTATIONS = 6  # the most frequent ones of a part that are looked at
OFTEN = 0.02  # [1] share from which an orientation is looked at
USEFUL_YIELD = 0.1  # [1] of the parts, that a chain has to let leave before its class counts as a way
TRIED_ORIENTATIONS = 2  # of a part, the one that the rule chose first; more where none of them has a way
TRIED_CHANGES = 3  # that gain most by the rule, and are tried
RARE_YIELD = 0.25  # [1] of the parts: below it most of what travels is returned, a grade less
SLOW_RATE = 30.0 / MINUTE  # [1/s] below it a grade less
GAIN = 1.1  # [1] of the rate, from which a change of the same class is a gain
SEARCH_SECONDS = 600.0  # [s] after which no further change is tried


class Grade(StrEnum):
    """How easy a part is to feed, from A, steel alone and most parts right, to E, no way found."""

    A = "A"
    B = "B"
    C = "C"
    D = "D"
    E = "E"

    def worse(self, steps: int) -> "Grade":
        """Return the grade some steps further down, at the most D: E is of parts without a way, and stays.

        Parameters
        ----------
        steps : int

        Returns
        -------
        Grade
        """
        if self is Grade.E:
            return self
        grades = list(Grade)
        return grades[min(grades.index(self) + steps, grades.index(Grade.D))]


class ReasonKind(StrEnum):
    """What a grade depends on."""

    CLASS = "class"
    YIELD = "yield"
    RATE = "rate"
    TANGLES = "tangles"
    NESTS = "nests"
    SHINGLES = "shingles"
    WEDGES = "wedges"


# risks between parts that count, and how many grades each takes
RISKS = {
    RiskKind.HOOKS: (ReasonKind.TANGLES, 2),
    RiskKind.NESTS: (ReasonKind.NESTS, 1),
    RiskKind.SHINGLES: (ReasonKind.SHINGLES, 0),
    RiskKind.WEDGES: (ReasonKind.WEDGES, 0),
}
BY_CLASS = {CostClass.STEEL: Grade.A, CostClass.AIR: Grade.B, CostClass.SENSOR: Grade.C}
CLASS_WORDS = {CostClass.STEEL: "steel", CostClass.AIR: "steady air", CostClass.SENSOR: "a camera"}


@dataclass(frozen=True, eq=False)
class Way:
    """The cheapest way that was found to feed a part in one orientation."""

    orientation: str  # how it arrives: 'A@188'
    heading: float  # [rad] of that orientation
    leaves_as: str  # 'A@188', or 'hanging'
    lies: str  # how it arrives, in words
    devices: tuple[Device, ...]
    efficiency: float  # [1] of the parts offered, that leave so
    purity: float  # [1] of what leaves
    rate: float  # [1/s] that leave so in this bowl
    offered: float  # [1/s] that arrive at the devices, in every orientation
    is_tried: bool = False  # by a trial; else by the static rule
    parts: int = 0  # that were tried, one at a time
    least_purity: float = 0.0  # [1] lower end of the 95 % interval of a trial's purity

    @property
    def cost_class(self) -> CostClass:
        """What the chain takes."""
        return CostClass.of(self.devices)

    @property
    def merit(self) -> tuple[int, float]:
        """What a way is chosen by: the cheaper class of what lets enough leave, then the rate."""
        return -self.cost_class.number if self.efficiency >= USEFUL_YIELD else -len(CostClass) - 1, self.rate

    @property
    def is_cheap(self) -> bool:
        """Whether nothing cheaper can be found: steel lets enough leave."""
        return self.cost_class is CostClass.STEEL and self.efficiency >= USEFUL_YIELD

    @property
    def text(self) -> str:
        """Say what the way takes and brings: 'steel, 120 a minute'."""
        return f"{CLASS_WORDS[self.cost_class]}, {MINUTE * self.rate:.3g} a minute"


@dataclass(frozen=True, eq=False)
class WaySearch:
    """What the search for a way found, and what it looked at."""

    way: Way | None
    looked_at: int  # orientations, of those that come often
    often: int  # orientations that come often
    by_trial: bool = False
    is_cut: bool = False  # by the user or the limit, before all was tried that would have been


@dataclass(frozen=True, eq=False)
class Reason:
    """One reason for a grade."""

    kind: ReasonKind
    value: float | None  # yield [1], rate [1/s]; None where there is no number
    steps: int  # grades that it takes
    text: str


@dataclass(frozen=True, eq=False)
class ChangedPart:
    """A change, the part that has it, and the cheapest way to feed that part."""

    change: Change
    part: Part
    found: WaySearch  # for the changed part
    found_before: WaySearch  # for the part as it is, judged alike: by the rule, or tried
    grade: Grade

    @property
    def way(self) -> Way | None:
        """The cheapest way to feed the changed part; None where none isolates."""
        return self.found.way

    @property
    def before(self) -> Way | None:
        """The cheapest way to feed the part as it is, judged alike."""
        return self.found_before.way

    @property
    def is_tried(self) -> bool:
        """Whether parts of true shape were sent through."""
        return self.found.by_trial

    @property
    def gains(self) -> bool:
        """Whether the change makes the part easier to feed: a cheaper class, or a tenth more parts."""
        if self.way is None:
            return False
        if self.before is None:
            return True
        own, former = self.way.merit, self.before.merit
        return own[0] > former[0] or (own[0] == former[0] and own[1] > GAIN * former[1])

    @property
    def text(self) -> str:
        """Say what the change brings: 'a flat ...: steel, 120 a minute, for a camera, 42 a minute'."""
        return f"{self.change.text}: {self.outcome}"

    @property
    def outcome(self) -> str:
        """Say how the changed part is fed, and how the part as it is: 'steel, 120 a minute, for ...'."""
        if self.way is None:
            return f"no way was found{'' if self.is_tried else ' by the static rule'}"
        former = "no way at all" if self.before is None else self.before.text
        return f"{self.way.text}, for {former}{'' if self.is_tried else ' (by the static rule)'}"


@dataclass(frozen=True, eq=False)
class AdviceStudy(ReadableRecord, view="advise.ADVICE_VIEW"):
    """How hard a part is to feed, why, and what changes of it would bring."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    grade: Grade
    reasons: tuple[Reason, ...]
    way: Way | None  # the cheapest that was found; None of none
    changes: tuple[ChangedPart, ...]  # the most useful first
    is_tried: bool = False  # the part itself, by a trial; else it is graded by the static rule
    partial: bool = False  # stopped by the user or the limit before all was tried

    @property
    def answer(self) -> str:
        """Say in a line how the part is fed: 'grade C: a camera, 42 a minute, as A@188'."""
        if self.way is None:
            return f"grade {self.grade}: no way to isolate an orientation was found"
        return f"grade {self.grade}: {self.way.text}, as {self.way.leaves_as}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return what a user must not overlook, a sentence each."""
        late = ("the advice was stopped before all was tried: raise the limit",) * self.partial
        return (*self.aspects.warnings, *late)


@dataclass(frozen=True, eq=False)
class _Feeding:
    """The search for a way to feed one part in a bowl."""

    bowl: Bowl
    rule: str
    seed: int
    until: float  # [s] of time.monotonic()

    def arriving(self, part: Part) -> Aspects:
        """What arrives at the track."""
        return arriving(part, self.bowl, self.rule)

    def often(self, part: Part, aspects: Aspects) -> tuple[Orientation, ...]:
        """The orientations that are looked at, the most frequent first."""
        every = name_mirror_images(orientations(part, aspects, self.bowl.track))
        order = sorted(every, key=lambda one: -np.nan_to_num(one.chances[self.rule]))
        chosen = [one for one in order if one.chances[self.rule] >= OFTEN][:ORIENTATIONS]
        return tuple(chosen or order[:ORIENTATIONS])

    @property
    def _search(self) -> ToolingSearch:
        return ToolingSearch(rule=self.rule, vary=False, seed=self.seed)

    def study(
        self,
        part: Part,
        aspects: Aspects,
        lying: Orientation,
        kinds: Sequence[str] = (),
        cost_class: CostClass | None = None,
    ) -> ToolingStudy:
        """The study of one orientation by the static rule, without a search for holes."""
        return tooling_without(
            kinds,
            part,
            self.bowl,
            lying.aspect,
            heading=lying.heading,
            aspect_shares=aspects,
            search=self._search,
            cost_class=cost_class,
        )

    def way_by_rule(self, part: Part) -> tuple[WaySearch, Aspects]:
        """The cheapest way by the static rule, and the aspects that arrive."""
        aspects = self.arriving(part)
        ways, every = [], self.often(part, aspects)
        for lying in every:
            study = self.study(part, aspects, lying)
            if study.design is not None and study.design.isolated and study.design.efficiency > 0.0:
                ways.append(self._way(part, aspects, study, study.design, lying))
        best = max(ways, key=lambda way: way.merit, default=None)
        return WaySearch(best, len(every), len(every)), aspects

    def way_by_trial(self, part: Part, aspects: Aspects, by_rule: Way | None) -> WaySearch:
        """The cheapest way that a trial confirms: of what the rule chose, then of what comes most often.

        After ``TRIED_ORIENTATIONS`` the search ends where one of them has a way; else it goes on through all
        that come often.
        """
        every = self.often(part, aspects)
        first = [one for one in every if by_rule is not None and one.name == by_rule.orientation]
        order = list(dict.fromkeys((*first, *every)))
        ways: list[Way] = []
        for done, lying in enumerate(order):
            is_enough = any(way.is_cheap for way in ways) or (bool(ways) and done >= TRIED_ORIENTATIONS)
            is_late = not is_enough and time.monotonic() > self.until
            if is_enough or is_late:
                return self._ended(ways, done, len(order), is_cut=is_late)
            way, is_stopped = self._try(part, aspects, lying)
            ways += [] if way is None else [way]
            if is_stopped or (way is None and time.monotonic() > self.until):
                return self._ended(ways, done + 1, len(order), is_cut=True)
        return self._ended(ways, len(order), len(order), is_cut=False)

    def _ended(self, ways: Sequence[Way], looked_at: int, often: int, *, is_cut: bool) -> WaySearch:
        best = max(ways, key=lambda way: way.merit, default=None)
        return WaySearch(best, looked_at, often, by_trial=True, is_cut=is_cut)

    def _try(self, part: Part, aspects: Aspects, lying: Orientation) -> tuple[Way | None, bool]:
        """The way of one orientation that a trial confirms, and whether the user stopped it."""
        study = self.study(part, aspects, lying)

        def propose(kinds: tuple[str, ...], cost_class: CostClass | None) -> ToolingStudy:
            return self.study(part, aspects, lying, kinds, cost_class)

        tried = tooling_trials.try_designs(study, propose, seed=self.seed, until=self.until)
        design = tried.design
        if design is None or not tried.trials or tried.trials[0].faults:
            return None, tried.partial
        shown = tried.trials[0]
        way = self._way(part, aspects, tried, design, lying)
        return replace(
            way,
            efficiency=shown.efficiency,
            purity=shown.purity,
            rate=shown.efficiency * way.offered,
            is_tried=True,
            parts=shown.parts,
            least_purity=shown.purity_ends[0],
        ), tried.partial

    def _way(
        self, part: Part, aspects: Aspects, study: ToolingStudy, design: Design, lying: Orientation
    ) -> Way:
        bowl = study.bowl if design.width is None else study.on_its_width(design.wanted).bowl
        answer = rate(part, bowl, devices=design.devices, rule=self.rule, aspect_shares=Shares(aspects)).rate
        return Way(
            orientation=lying.name,
            heading=lying.heading,
            leaves_as=study.leaves_as or lying.name,
            lies=lying.posture.lies,
            devices=design.devices,
            efficiency=answer.efficiency,
            purity=answer.purity,
            rate=float(answer.parts.value),
            offered=float(answer.offered.value),
        )


@with_shown_signature
def advise(
    part: Part,
    bowl: Bowl,
    *,
    rule: str = RECOMMENDED_ANSWER,
    seed: int = 1,
    seconds: Quantity = SEARCH_SECONDS,
    with_changes: bool = True,
    with_trials: bool = True,
    progress: Callable[[int, int], None] | None = None,
) -> AdviceStudy:
    """Grade how easy a part is to feed, and find the changes of its shape that help, as ``feeder advise``.

    The grade begins with the cheapest class that isolates one of the orientations that come often: A of
    steel alone, B of steady air, C of a camera, E where nothing does. It is one less below a yield of 25
    %, one less below 30 parts a minute, one less for parts that nest, two for parts that hook.

    Parameters
    ----------
    part : Part
        From a closed mesh.
    bowl : Bowl
        In which rates are computed; its own devices are left out.
    rule : str
        Whose probabilities are taken.
    seed : int
        Of the trials.
    seconds : str or float [s]
        After which nothing more is tried.
    with_changes : bool
        Whether changes are looked for; else the part is graded alone.
    with_trials : bool
        Whether the part and its best changes are tried; else all is by the static rule.
    progress : callable, optional
        Called with how many parts are judged, and of how many.

    Returns
    -------
    AdviceStudy
        Its changes have those that were tried first, then the others by what they gain by the rule. It is
        ``partial`` if the user stopped the search for changes.

    Raises
    ------
    FeederError
        If the part has no closed mesh or very many facets, or does not fit into the bowl.
    """
    begun = time.monotonic()
    part, bowl = arguments.a_part(part), arguments.a_bowl(bowl)
    refuse_many_facets(part)
    until = begun + arguments.amount("seconds", seconds, "time", 0.0)
    feeding = _Feeding(replace(bowl, devices=()), rule, arguments.whole("seed", seed, 0), until)
    changes = (
        list_changes(part) if check.kind("with_changes", with_changes, bool, "give True or False") else ()
    )
    tell = progress or (lambda _done, _of: None)
    count = 1 + len(changes) + (1 + min(TRIED_CHANGES, len(changes))) * with_trials
    tell(0, count)
    by_rule, aspects = feeding.way_by_rule(part)
    tell(1, count)
    found, partial, judged, done = by_rule, False, list[tuple[Change, Part, WaySearch, Aspects]](), 1
    try:
        if with_trials:
            found = feeding.way_by_trial(part, aspects, by_rule.way)
            partial = found.is_cut
            done += 1
            tell(done, count)
        for change in changes:
            if time.monotonic() > until:
                partial = True
                break
            changed = load((change.vertices, change.faces), units="m", density=part.density)
            changed = replace(changed, name=part.name, material=part.material, source=part.source)
            with contextlib.suppress(FeederError):  # too large for the track, as changed
                judged.append((change, changed, *feeding.way_by_rule(changed)))
            done += 1
            tell(done, count)
    except KeyboardInterrupt:
        partial = True
    if found.is_cut and found.way is None:  # not known by trials: the rule's is named as such
        found = replace(by_rule, is_cut=True)
    judged.sort(key=lambda each: _merit(each[2].way), reverse=True)
    ranked: list[ChangedPart] = []
    for place, (change, changed, own, own_aspects) in enumerate(judged):
        before = by_rule
        if found.by_trial and place < TRIED_CHANGES and not partial:
            try:
                tried = feeding.way_by_trial(changed, own_aspects, own.way)
                partial = tried.is_cut
                if not (tried.is_cut and tried.way is None):
                    own, before = tried, found
                done += 1
                tell(done, count)
            except KeyboardInterrupt:
                partial = True
        reasons = _reasons(changed, own_aspects, own, feeding)
        ranked.append(ChangedPart(change, changed, own, before, _grade(own.way, reasons)))
    ranked.sort(key=lambda each: (not each.is_tried, not each.gains))
    reasons = _reasons(part, aspects, found, feeding)
    return AdviceStudy(
        part=part,
        bowl=bowl,
        aspects=aspects,
        grade=_grade(found.way, reasons),
        reasons=reasons,
        way=found.way,
        changes=tuple(ranked),
        is_tried=found.by_trial,
        partial=partial,
    )


def _merit(way: Way | None) -> tuple[float, float]:
    return (-np.inf, 0.0) if way is None else way.merit


def _grade(way: Way | None, reasons: Sequence[Reason]) -> Grade:
    """The grade of a way, less the steps of each reason; E without one."""
    if way is None:
        return Grade.E
    return BY_CLASS[way.cost_class].worse(sum(reason.steps for reason in reasons))


def _reasons(part: Part, aspects: Aspects, found: WaySearch, feeding: _Feeding) -> tuple[Reason, ...]:
    """Why a part has its grade: what its way takes and brings, and what parts do to each other."""
    listed: list[Reason] = [_class_reason(found)]
    way = found.way
    if way is not None:
        rare, slow = way.efficiency < RARE_YIELD, way.rate < SLOW_RATE
        words = f"{100.0 * way.efficiency:.3g} % of the parts come right, the others are returned"
        listed.append(Reason(ReasonKind.YIELD, way.efficiency, int(rare), words))
        words = f"{MINUTE * way.rate:.3g} parts a minute leave in this bowl"
        listed.append(Reason(ReasonKind.RATE, way.rate, int(slow), words))
    every = feeding.often(part, aspects)
    own = next((one for one in every if way is not None and one.name == way.orientation), every[0])
    for risk in risks(own, feeding.bowl, (), orientations=every, seed=feeding.seed):
        if risk.kind in RISKS:
            kind, steps = RISKS[risk.kind]
            listed.append(Reason(kind, None, steps, risk.text))
    return tuple(listed)


def _class_reason(found: WaySearch) -> Reason:
    """Which class isolates, or that none does, and how that is known."""
    way, by = found.way, "by the static rule"
    if way is None:
        of = (
            "the orientation that comes"
            if found.often == 1
            else f"any of the {found.often} orientations that come"
        )
        by = "by trials" if found.by_trial else by
        text = f"no chain of steel, air or a camera isolates {of} often ({by})"
        return Reason(ReasonKind.CLASS, None, 0, text)
    if way.is_tried:
        least = f"{100.0 * way.least_purity:.3g} % or more of what leaves is right"
        by = f"by a trial of {way.parts} parts, one at a time: {least}"
    text = f"the cheapest class that isolates is {CLASS_WORDS[way.cost_class]} ({by}), as {way.leaves_as}"
    return Reason(ReasonKind.CLASS, None, 0, text)
