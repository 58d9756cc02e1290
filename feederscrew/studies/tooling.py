"""The study of ``feeder tooling``: which orientation can be isolated, and by which cuts."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.documents import hint
from feederscrew.errors import ArgumentError
from feederscrew.part.record import Part
from feederscrew.rates.steadiness import steady
from feederscrew.rates.tipping import marked, remark
from feederscrew.records import Shown
from feederscrew.resting.aspects import Aspects
from feederscrew.studies.rate import arriving
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.kinds import KINDS, made
from feederscrew.tooling.fates import at_entry
from feederscrew.tooling.isolating import held
from feederscrew.tooling.isolating.chain import FINE, STEP, WHERE, Wishes
from feederscrew.tooling.isolating.design import MARGIN, PLAY, TOLERANCE, design, place
from feederscrew.tooling.isolating.hole_search import VERDICTS, HoleSearch
from feederscrew.tooling.isolating.proposal import Design
from feederscrew.tooling.mirrored import named
from feederscrew.tooling.orientations import Orientation, orientations, placed, speed
from feederscrew.units import shown

CARRIED = (
    "quasi-static: at the bowl's speed a part may be carried over a cut that returns it, laid over by a "
    "blade or wedged between rails - see feeder trial"
)
ROCKS = (
    "{} may rock on what these cuts leave below it, and no safer value lies between the limits - try it "
    "with feeder trial"
)
STEEP = np.radians(-6.0)  # [rad] climb of a stretch that separates parts
OUTCOMES = ("lying", "hanging", "any")
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
    trials: tuple[Any, ...] = ()  # designing.own_trial.TriedDesign of what was tried, that of `design` first

    def trial_of(self, place: int) -> Any:
        """Return what the trial of an orientation's design said: its TriedDesign; None without one."""
        return next((one for one in self.trials if one.wanted == place), None)

    def isolates(self, place: int) -> bool:
        """Return whether an orientation is isolated: by the static rule, and not denied by its trial."""
        found, tried = self.designs[place], self.trial_of(place)
        return found is not None and found.isolated and not (tried is not None and tried.faults)

    @property
    def design(self) -> Design | None:
        """The design of the orientation asked for; None where all were."""
        return None if self.wanted is None else self.designs[self.wanted]

    @property
    def answer(self) -> str:
        """Say whose probabilities are taken: 'hops, launch feed', 'csa'."""
        return self.aspects.source(self.rule)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each."""
        late = any(one is not None and one.late for one in self.designs)
        return (*self.aspects.warnings, *remark(self.orientations), *([LATE] if late else []))


def tooling(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: float | None = None,
    rule: str = "recommended",
    margin: float = MARGIN,
    purity: float = 1.0,
    efficiency: float = 0.0,
    turn: bool = False,
    seed: int = 1,
    verdicts: int = VERDICTS,
    seconds: float = 600.0,
    told: Callable[[int, int], None] | None = None,
    known: Aspects | None = None,
    **wishes: Any,
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
    purity : float [1]
        Of what leaves, that is enough.
    efficiency : float [1]
        Of what is offered, that is asked for.
    turn : bool
        Whether devices that turn parts over may be used, where returning them wastes too much.
    seed : int
        Of the search for holes.
    verdicts : int
        Most of them in the search for the holes of one orientation: then the best so far is taken.
    seconds : float [s]
        The last resort: what is found until then may differ from machine to machine, and is marked.
    told : callable, optional
        Called with how many designs are done of how many, first with none.
    known : Aspects, optional
        Of the part, with the answer to take, where they are known already.
    **wishes
        What a design may use, as ``Wishes``: outcome, how parts shall leave ('lying', 'hanging' or 'any');
        without, kinds of devices that are not used ('wiper,cut_out'); step [m], of which values are whole
        multiples; up, other aspects that count as the one wanted ('B,C'); cutter [m], the radius that corners
        of holes are rounded to; play and tolerance [m], of the part from the wall and of its size, which are
        added to the margin that is asked for.

    Returns
    -------
    ToolingStudy

    Raises
    ------
    FeederError
        If the part has no mesh, is too large for the bowl, or has no such orientation or rule.
    """
    found = arriving(part, bowl, rule) if known is None else known
    every, _ = marked(named(orientations(part, found, bowl.track)), bowl)
    every = at_entry(every, bowl.devices)
    if rule not in found.chances:
        raise ArgumentError(
            f"rule {rule}", "has no probabilities of this part", hint(rule, list(found.chances))
        )
    shares = np.nan_to_num([one.chances[rule] for one in every])
    wanted = None if aspect is None else place(every, aspect, heading, part.source)
    search = HoleSearch(seed=seed, verdicts=verdicts, until=time.monotonic() + seconds)
    margin += wishes.pop("play", PLAY) + wishes.pop("tolerance", TOLERANCE)
    may_use = asked_for(part, bowl, found, **wishes)
    asked_of_each = {"purity": purity, "efficiency": efficiency, "turn": turn, "before": bowl.devices}
    asked_of_each |= {"wishes": may_use}
    asked = range(len(every)) if wanted is None else [wanted]
    designs: list[Design | None] = [None] * len(every)
    if told is not None:
        told(0, len(asked))
    for done, k in enumerate(asked):
        designs[k] = _designed(every, shares, k, bowl, margin=margin, search=search, **asked_of_each)
        if told is not None:
            told(done + 1, len(asked))
    return ToolingStudy(
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
    )


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
    return tooling(part, bowl, aspect, without=(*listed(without), *kinds, "cut_out"), **asked)


def asked_for(
    part: Part,
    bowl: Bowl,
    found: Aspects,
    *,
    outcome: str = "any",
    without: str | Sequence[str] = (),
    step: float = STEP,
    up: str | Sequence[str] = (),
    cutter: float = 0.0,
) -> Wishes:
    """Return what a design may use, checked, as Wishes."""
    if outcome not in OUTCOMES:
        raise ArgumentError("outcome", f"{outcome!r} is unknown", f"choose {', '.join(OUTCOMES)}")
    check.argument("step", step, FINE)
    kinds = listed(without)
    for kind in kinds:
        if kind not in KINDS:
            raise ArgumentError("without", f"unknown device {shown(kind)}", hint(kind, list(KINDS)))
    wishes = Wishes(outcome, kinds, float(step), may_be_up(part, found, up), float(cutter))
    return replace(wishes, separation=_separation(bowl, wishes))


def listed(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of a list, or of a text with commas."""
    names = names.split(",") if isinstance(names, str) else names
    return tuple(name.strip() for name in names if name.strip())


def may_be_up(part: Part, found: Aspects, up: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of aspects that may be up as well, checked."""
    known = {name.casefold() for name in found.names}
    for name in listed(up):
        if name.casefold() not in known:
            mend = f"choose one of {', '.join(found.names)}"
            raise ArgumentError("up", f"{part.name} has no aspect {shown(name)}", mend)
    return listed(up)


def _separation(bowl: Bowl, wishes: Wishes) -> Device | None:
    """The stretch that makes gaps in this bowl; None where it may not be used or makes none."""
    steeper = made("separation", WHERE, angle=STEEP, text=f"{{climb: {np.degrees(STEEP):.6g} deg}}")
    there = replace(bowl, track=replace(bowl.track, climb=STEEP))
    return steeper if wishes.allows("separation") and speed(there) > speed(bowl) else None


def _designed(
    every: Sequence[Orientation], shares: np.ndarray, wanted: int, bowl: Bowl, **asked: Any
) -> Design:
    """The design of an orientation; one that rolls on the level comes on a bank or out of a groove."""
    leaning = held.stretches(every[wanted], bowl.friction.wall, asked["before"], asked["wishes"])
    if leaning:
        found = _on_this_track(held.led_on(every, leaning), shares, wanted, bowl, **asked)
        if found.isolated or found.cuts:
            return held.with_stretches(found, leaning)
    return _on_this_track(every, shares, wanted, bowl, **asked)


def _on_this_track(
    every: Sequence[Orientation], shares: np.ndarray, wanted: int, bowl: Bowl, **asked: Any
) -> Design:
    """The design of an orientation that the drive leaves lying on what is cut; if there is none, said so."""
    found = _isolating(every, shares, wanted, **asked)
    if _steady(found, every, bowl, asked["margin"]):
        return found
    holes = any(cut.device.corners for cut in found.cuts)
    gentle = found if holes else _isolating(every, shares, wanted, gentle=True, **asked)
    same = (gentle.isolated, gentle.efficiency, gentle.purity) == (
        found.isolated, found.efficiency, found.purity,
    )  # fmt: skip
    if same and _steady(gentle, every, bowl, asked["margin"]):
        return gentle
    said = ROCKS.format(every[wanted].name)
    return replace(found, steady=False, reasons=(*found.reasons, said))


def _steady(found: Design, every: Sequence[Orientation], bowl: Bowl, margin: float) -> bool:
    """Whether the drive leaves the wanted orientation lying at every cut of a design."""
    return not found.cuts or bool(steady(found.devices, [every[found.wanted]], bowl, margin)[0])


def _isolating(every: Sequence[Orientation], shares: np.ndarray, wanted: int, **asked: Any) -> Design:
    """The design for parts that travel; where none isolates, one for parts that are placed, and said so."""
    found = design(every, shares, wanted, **asked)
    if found.isolated or not any(one.carry > 0.0 for one in every):
        return found
    still = design(placed(every), shares, wanted, **asked)
    return replace(still, reasons=(*still.reasons, CARRIED)) if still.isolated else found
