"""The study of ``feeder tooling``: which orientation can be isolated, and by which cuts."""

import functools
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np

from feederscrew import check
from feederscrew.bowl.devices import check_written
from feederscrew.bowl.record import Bowl
from feederscrew.documents import hint
from feederscrew.errors import ArgumentError
from feederscrew.part.facets import refuse_many_facets
from feederscrew.part.record import Part
from feederscrew.part.smallness import small_part_remarks
from feederscrew.rates.tipping import marked, remark, steady
from feederscrew.records import Shown
from feederscrew.resting.aspects import Aspects
from feederscrew.studies.rate import arriving
from feederscrew.studies.wishes import ToolingKeywords, ToolingOptions, asked_for, listed
from feederscrew.tooling.devices.kinds import names
from feederscrew.tooling.fates import at_entry
from feederscrew.tooling.isolating import tracks
from feederscrew.tooling.isolating.design import MARGIN_M, PLAY_M, TOLERANCE_M, place
from feederscrew.tooling.isolating.hole_search import HoleSearch
from feederscrew.tooling.isolating.proposal import Design, Goal
from feederscrew.tooling.orientations import Orientation, name_mirror_images, orientations

WIDER = "the track has to be {:.4g} mm wide"
LATE = "the search stopped at the time limit: another machine may find more - raise the limit"


@dataclass(frozen=True, eq=False)
class ToolingStudy(Shown):
    """Every orientation of a part on a track, and what isolates it behind the bowl's devices; M of them."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    rule: str  # whose probabilities are taken
    margin: float  # [m] asked for to either side
    orientations: tuple[Orientation, ...]
    shares: np.ndarray  # (M,) [1]
    designs: tuple[Design | None, ...]  # (M,) None where it was not asked for
    wanted: int | None  # the orientation asked for; None for all of them
    up: tuple[str, ...] = ()  # aspects that count as the one wanted
    play: float = PLAY_M  # [m] of the part from the wall, within the margin
    tolerance: float = TOLERANCE_M  # [m] of its size, within the margin
    trials: tuple[Any, ...] = ()  # designing.own_trial.TriedDesign of what was tried, that of `design` first

    def trial_of(self, place: int) -> Any:
        """Return what the trial of an orientation's design said: its TriedDesign; None without one."""
        return next((one for one in self.trials if one.wanted == place), None)

    def isolates(self, place: int) -> bool:
        """Return whether an orientation is isolated: what leaves is pure, by the rule and by its trial.

        Where no trial was made, what no verdict is sure to return counts as leaving.
        """
        found, tried = self.designs[place], self.trial_of(place)
        if found is None or not found.isolated:
            return False
        if tried is not None:
            return not tried.faults
        return not found.purity < found.least_purity  # also where nothing that comes leaves

    @property
    def design(self) -> Design | None:
        """The design of the orientation asked for; None where all were."""
        return None if self.wanted is None else self.designs[self.wanted]

    def on_its_width(self, place: int) -> "ToolingStudy":
        """Return the study on the track that the design of an orientation asks for."""
        found = self.designs[place]
        if found is None or found.width is None:
            return self
        bowl = replace(self.bowl, track=replace(self.bowl.track, width=found.width))
        return replace(self, bowl=bowl, orientations=_coming(self.part, self.aspects, bowl))

    @property
    def answer(self) -> str:
        """Say whose probabilities are taken: 'hops, launch feed', 'csa'."""
        return self.aspects.source(self.rule)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each."""
        late = any(one is not None and one.late for one in self.designs)
        lines = (*self.aspects.warnings, *self.of_size, *remark(self.orientations))
        return (*lines, *([LATE] if late else []))

    @property
    def of_size(self) -> tuple[str, ...]:
        """What to say of a part that is not much larger than what is asked for, or than the track is wide."""
        margin = self.margin - self.play - self.tolerance
        allowances = {"margin": margin, "play": self.play, "tolerance": self.tolerance}
        return small_part_remarks(self.part, allowances, self.bowl.track.width)


def tooling(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: float | None = None,
    rule: str = "recommended",
    margin: float = MARGIN_M,
    known: Aspects | None = None,
    **wishes: Unpack[ToolingKeywords],
) -> ToolingStudy:
    """Study which orientations of a part can be isolated by cuts, and how.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        The one wanted; without it every orientation is designed for.
    heading : float [rad], optional
        Of that aspect; without one, its most frequent that stays on the track.
    rule : str
        Whose probabilities are taken.
    margin : float [m]
        By which the wanted orientation passes and the others fail, at least.
    known : Aspects, optional
        Of the part, with the answer to take, where they are known already.
    **wishes
        What a design is to reach and may use, with the defaults of ``ToolingOptions``.
        purity : float [1], of what leaves, that is enough.
        efficiency : float [1], of what is offered, that is asked for.
        outcome : str, how parts shall leave: 'lying', 'hanging' or 'any'.
        without : str or list of str, kinds of devices that are not used: 'wiper,cut_out'.
        step : float [m], of which values are whole multiples.
        up : str or list of str, other aspects that count as the one wanted: 'B,C'.
        cutter : float [m], the radius that corners of holes are rounded to.
        vary : bool, whether other banks, grooves and widths of the track and sweeps are tried where they
        give more.
        turn : bool, whether devices that turn parts over may be used, where returning them wastes too much.
        air : bool, whether air that blows all the time may be used, where cuts and blades are not enough.
        play, tolerance : float [m], of the part from the wall and of its size, which are added to the margin
        that is asked for.
        seed : int, of the search for holes.
        verdicts : int, most of them in the search for the holes of one orientation: then the best so far
        is taken.
        seconds : float [s], the last resort: what is found until then may differ from machine to machine,
        and is marked.
        told : callable, called with how many designs are done of how many, first with none.

    Returns
    -------
    ToolingStudy

    Raises
    ------
    FeederError
        If the part has no mesh or very many facets, is too large for the bowl, or has no such orientation or
        rule.
    """
    own = check.options("tooling", ToolingOptions, wishes)
    check.of_an_aspect(aspect, heading)
    refuse_many_facets(part)
    found = arriving(part, bowl, rule) if known is None else known
    every = _coming(part, found, bowl)
    if rule not in found.chances:
        raise ArgumentError(
            f"rule {rule}", "has no probabilities of this part", hint(rule, list(found.chances))
        )
    shares = np.nan_to_num([one.chances[rule] for one in every])
    wanted = None if aspect is None else place(every, aspect, heading, part.source)
    search = HoleSearch(seed=own.seed, verdicts=own.verdicts, until=time.monotonic() + own.seconds)
    margin += own.play + own.tolerance
    may_use = asked_for(part, bowl, found, own)
    asked_of_each = {"goal": Goal(own.purity, own.efficiency), "before": bowl.devices, "constraints": may_use}
    asked_of_each |= {"margin": margin, "search": search}
    asked = range(len(every)) if wanted is None else [wanted]
    designs: list[Design | None] = [None] * len(every)
    if own.told is not None:
        own.told(0, len(asked))
    cache: dict[float, _Track] = {bowl.track.width: _Track(bowl, every, shares, {})}
    for done, k in enumerate(asked):
        designs[k] = best = _best(part, found, rule, k, cache, asked_of_each)
        check_written(best.devices, "tooling.yaml")
        if own.told is not None:
            own.told(done + 1, len(asked))
    study = ToolingStudy(
        part=part,
        bowl=bowl,
        aspects=found,
        rule=rule,
        margin=margin,
        orientations=every,
        shares=shares,
        designs=tuple(designs),
        wanted=wanted,
        up=may_use.up,
        play=own.play,
        tolerance=own.tolerance,
    )
    return study if wanted is None else study.on_its_width(wanted)


@dataclass(frozen=True, eq=False)
class _Track:
    """What comes on a track of some width."""

    bowl: Bowl
    orientations: tuple[Orientation, ...]
    shares: np.ndarray
    cache: dict[Any, Any]  # of orientations where it leans


@functools.lru_cache(maxsize=32)
def _coming(part: Part, found: Aspects, bowl: Bowl) -> tuple[Orientation, ...]:
    """Every orientation of a part as it comes in a bowl."""
    every, _ = marked(name_mirror_images(orientations(part, found, bowl.track)), bowl)
    return at_entry(every, bowl.devices)


def _best(
    part: Part, found: Aspects, rule: str, wanted: int, cache: dict[float, _Track], asked: dict[str, Any]
) -> Design:
    """The design of an orientation on the bowl's track, or on one of another width that gives more."""
    own = next(iter(cache.values()))
    best = _designed(own, wanted, asked)
    if best.isolated or not asked["constraints"].vary or asked["before"]:
        return best
    for width in tracks.widths(own.orientations, own.shares, wanted, asked["margin"]):
        if width not in cache:
            bowl = replace(own.bowl, track=replace(own.bowl.track, width=width))
            cache[width] = _Track(bowl, _coming(part, found, bowl), own.shares, {})
        alike = [one.name for one in cache[width].orientations] == [one.name for one in own.orientations]
        other = _designed(cache[width], wanted, asked) if alike else None
        if other is not None and tracks.gains(other, best):
            best = replace(other, width=width, reasons=(*other.reasons, WIDER.format(1e3 * width)))
    return best


def _designed(there: _Track, wanted: int, asked: dict[str, Any]) -> Design:
    given = there.orientations, there.shares, wanted, there.bowl
    return tracks.design_with_track(*given, steady=steady, cache=there.cache, **asked)


def tooling_without(
    kinds: Sequence[str],
    part: Part,
    bowl: Bowl,
    aspect: str | None,
    *,
    without: str | Sequence[str] = (),
    **asked: Any,
) -> ToolingStudy:
    """Return the study of an orientation with fewer kinds of devices, at once: no holes are searched.

    Parameters
    ----------
    kinds : sequence of str
        Not used, beside those of ``without``.
    part, bowl, aspect, asked
        As for ``tooling``.
    """
    return tooling(part, bowl, aspect, without=(*listed(without), *kinds, *names(searched=True)), **asked)
