"""The trial of what the static rule proposes: both verdicts side by side."""

import functools
import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.arrays import Floats, Ints
from feederscrew.designing import short_trials, texts
from feederscrew.designing.findings import Fault, FaultKind
from feederscrew.designing.proposals import equivalent_rows
from feederscrew.designing.short_trials import find_denials
from feederscrew.dropping.ensemble import wilson
from feederscrew.errors import FeederError
from feederscrew.rates import stream
from feederscrew.running import RunSettings
from feederscrew.studies.tooling import ToolingStudy
from feederscrew.tooling.devices.kinds import KINDS, names
from feederscrew.tooling.isolating.chain import Design
from feederscrew.trial.wanted import aspects_at_any_heading

PARTS_OF_EACH = 2  # parts of each orientation
MORE_PARTS = 20  # parts beside those where the trial denies nothing, by the shares of the orientations
BEST = 3  # designs of a table that are tried
TRIES = 5  # designs of one orientation that are tried where the first ones are denied
SEARCHES = 8  # designs that are looked for after a denied one
# stretches that reject nothing: to leave them out makes no other chain
KEPT = tuple(name for name in names(leans=True) if not KINDS[name].grooved)
OFTEN_SHARE = 0.02  # [1] shares of the orientations that are tried, and the one that is wanted
RARE_SHARE = 1e-3  # [1] of the wanted share: what comes less often than that changes no purity
FURTHER = 8  # orientations that come less often than OFTEN and may leave, and are tried as well
SLIGHT = 1e-9  # [1] of rounding


@dataclass(frozen=True)
class TriedDesign:
    """A chain of ``feeder tooling``, tried with a few parts of each orientation that comes often."""

    name: str  # of the orientation wanted
    wanted: int  # its place among the orientations
    devices: tuple[str, ...]  # of the chain, as a bowl file has them
    static_efficiency: float  # [1]
    efficiency: float  # [1] of all that is offered
    purity: float  # [1] NaN where nothing leaves
    parts: int
    faults: tuple[Fault, ...]  # what the trial denies
    efficiency_ends: tuple[float, float] = (0.0, 1.0)  # [1] 95 % interval
    purity_ends: tuple[float, float] = (0.0, 1.0)  # [1]
    devices_words: tuple[str, ...] = ()  # of the chain, as the trade names them

    @property
    def agrees(self) -> bool:
        """Tell whether the trial denies nothing and the rule's efficiency lies in its interval."""
        low, high = self.efficiency_ends
        return not self.faults and low - SLIGHT <= self.static_efficiency <= high + SLIGHT

    @property
    def verdict(self) -> str:
        """Return the verdict of the trial on the rule."""
        if self.faults:
            return "the trial denies it: " + "; ".join(texts.fault_texts(self.faults))
        return (
            "the trial agrees" if self.agrees else "the trial sorts too, but the rule's efficiency is not its"
        )

    @property
    def figures(self) -> str:
        """Return the shares that leave, with their intervals."""
        purity = "nothing leaves"
        if not np.isnan(self.purity):
            purity = f"{texts.percent(self.purity, self.purity_ends)} of what leaves"
        return f"{texts.percent(self.efficiency, self.efficiency_ends)} do, {purity}"

    @property
    def verdicts(self) -> str:
        """Return the verdicts of the static rule and of the trial."""
        return (
            f"the static rule lets {100.0 * self.static_efficiency:.3g} % leave, of {self.parts} parts tried "
            f"{self.figures}; {self.verdict}"
        )

    @property
    def sentence(self) -> str:
        """Both verdicts on the orientation."""
        return f"{self.name}: {self.verdicts}"


def try_designs(
    study: ToolingStudy,
    without_kinds: Callable[[tuple[str, ...]], ToolingStudy] | None = None,
    *,
    seed: int = 1,
    jobs: int = 1,
    before: Callable[[], None] | None = None,
    until: float = math.inf,
) -> ToolingStudy:
    """Try the chain of the orientation that was asked for, or the best three of a table.

    ``without_kinds`` returns the same study without some kinds of devices: where the trial denies the chain
    of the orientation that was asked for, others are tried, five in all, and the most efficient of those that
    the trial confirms is taken. ``before`` is called before anything is compiled. No trial begins
    after ``until``, a ``time.monotonic()`` [s]; one that has begun ends. The study has its
    ``trials``: of a chain that the trial confirms where one is found, else of the first. Chains that isolate
    nothing are not tried. After an interrupt from the keyboard it is ``partial``, with the trials that ended.
    """
    candidates = [
        design
        for design in study.designs
        if design is not None and design.devices and design.efficiency > 0.0
    ]
    best = sorted(candidates, key=lambda design: (-design.isolated, -design.efficiency, design.wanted))
    run = RunSettings(seed, jobs, before=before)
    trials: tuple[TriedDesign, ...] = ()
    try:
        for proposed in best[:BEST]:
            if time.monotonic() > until:
                break
            trials = (*trials, _try_design(study, proposed, run))
    except KeyboardInterrupt:
        return replace(study, trials=trials, partial=True)
    first = replace(study, trials=trials)
    if study.design is None or without_kinds is None or not trials or not trials[0].faults:
        return first
    studies, pending, searched, is_stopped = [study], _ways_on((), study.design), 0, False
    while pending and searched < SEARCHES and len(trials) < TRIES and time.monotonic() <= until:
        kinds, searched = pending.pop(0), searched + 1
        try:
            other = without_kinds(kinds)
        except KeyboardInterrupt:
            is_stopped = True
            break
        if other.partial:
            is_stopped = True
            break
        design = other.design
        if design is None or not (design.isolated and design.cuts and design.efficiency > 0.0):
            continue
        if _devices(design) in [trial.devices for trial in trials]:
            continue
        try:
            tried = _try_design(other, design, run)
        except KeyboardInterrupt:
            is_stopped = True
            break
        studies, trials = [*studies, other], (*trials, tried)
        if not trials[-1].faults and design.efficiency >= study.design.efficiency:
            break
        pending += _ways_on(kinds, design) if trials[-1].faults else []
    holds = [k for k, trial in enumerate(trials) if not trial.faults]
    taken = max(holds, key=lambda k: trials[k].static_efficiency, default=0)
    sorted_trials = trials[taken], *trials[:taken], *trials[taken + 1 :]
    return replace(studies[taken], trials=sorted_trials, partial=is_stopped)


def _ways_on(excluded_kinds: tuple[str, ...], design: Design) -> list[tuple[str, ...]]:
    """Kinds of devices to do without as well: each of a chain alone, the last one first, then all of them."""
    kinds = list(dict.fromkeys(cut.device.kind for cut in reversed(design.cuts)))
    kinds = [kind for kind in kinds if kind not in KEPT]
    choices = [(kind,) for kind in kinds] + ([tuple(kinds)] if len(kinds) > 1 else [])
    return [(*excluded_kinds, *more) for more in choices]


def _devices(design: Design) -> tuple[str, ...]:
    return tuple(f"{device.kind}: {device.text}" for device in design.devices)


def _try_design(study: ToolingStudy, design: Design, run: RunSettings) -> TriedDesign:
    """One design with parts of its own, on a track of its own width."""
    study = study.on_its_width(design.wanted)
    bowl = replace(study.bowl, devices=design.devices)
    oriented = stream.along(study.orientations, study.aspects, bowl.devices, bowl=bowl)
    name, total = oriented.lying[design.wanted].name, study.shares.sum()
    shares = study.shares / total if total > 0.0 else np.full(len(study.shares), 1.0 / len(study.shares))
    # those that come often, and of the others those that may leave
    order = np.argsort(-shares, kind="stable")
    often = [k for k in order if shares[k] >= OFTEN_SHARE or k == design.wanted]
    may = (oriented.may_leave > 0.0) & (shares >= RARE_SHARE * shares[design.wanted]) & (shares > 0.0)
    seldom = [k for k in order if may[k] and k not in often]
    rows = [int(k) for k in (*often, *seldom[:FURTHER])]
    wanted = (design.wanted, *equivalent_rows(oriented.lying, design.wanted, study.up))
    free = aspects_at_any_heading(oriented.lying, design.wanted, study.up)
    single = functools.partial(
        short_trials.try_parts, study.part, bowl, oriented, shares, wanted,
        aspects=study.aspects, any_heading=free,
    )  # fmt: skip
    try:
        trial = single(rows=rows, count=PARTS_OF_EACH, run=run)
        further = further_parts(shares[rows])
        if not list(find_denials(trial)) and further.any():
            further_run = replace(run, seed=run.seed + 1, before=None)
            more = [row for row, count in zip(rows, further) if count]
            trial = trial.join(single(rows=more, count=further[further > 0], run=further_run))
    except FeederError as fault:  # the bowl does not convey
        return TriedDesign(
            name,
            design.wanted,
            _devices(design),
            design.efficiency,
            0.0,
            np.nan,
            0,
            (Fault(FaultKind.NOT_RUN, reason=fault.what),),
        )
    efficiency, (value, low, high) = shares_leaving(trial)
    faults = [*find_denials(trial)]
    if value < design.least_purity:
        faults.append(Fault(FaultKind.IMPURE, shares=(value, low, high, design.least_purity)))
    return TriedDesign(
        name=name,
        wanted=design.wanted,
        devices=_devices(design),
        static_efficiency=design.efficiency,
        efficiency=efficiency[0],
        purity=value,
        parts=int(trial.parts.sum()),
        faults=tuple(faults),
        efficiency_ends=efficiency[1:],
        purity_ends=(low, high),
        devices_words=tuple(f"{device.full_name}: {device.value_words}" for device in design.devices),
    )


def further_parts(shares: Floats) -> Ints:
    """Return how many (R,) of MORE_PARTS are of each orientation, of shares (R,) [1].

    As the interval of a sum of shares asks for. Its width is the root of the sum of the squares of share
    times proportion's interval, which is least where parts go with the shares (J. Neyman, J. R. Statist. Soc.
    97, 558-625, 1934, for even spreads).
    """
    total = float(shares.sum())
    return (
        np.floor(MORE_PARTS * shares / total + 0.5).astype(int) if total > 0.0 else np.zeros(len(shares), int)
    )


def shares_leaving(
    trial: short_trials.ShortTrial,
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return efficiency and purity [1] of a short trial, each as value, low and high end.

    What was not tried counts as the static rule says; what that is not sure to return, as wrong at the lower
    end. The intervals are those of 95 %, of shares of all parts offered; purity is NaN where nothing leaves.

    Source of the sums of shares: G. Y. Zou, A. Donner, Statist. Med. 27, 1693-1702, 2008.
    """
    orientations, shares = trial.orientations, trial.shares / max(trial.shares.sum(), 1e-300)
    rest = np.setdiff1d(np.arange(len(shares)), trial.rows)
    as_ruled = orientations.leaving[rest][:, list(trial.states)].sum(axis=1) * (
        orientations.leaves[rest] > 0.0
    )
    right = _sum_shares(shares[trial.rows], trial.right, trial.parts)
    wrong = _sum_shares(shares[trial.rows], trial.wrong, trial.parts)
    more = float((shares[rest] * as_ruled).sum())
    other = float((shares[rest] * np.maximum(orientations.leaves[rest] - as_ruled, 0.0)).sum())
    doubt = float((shares[rest] * np.maximum(orientations.may_leave[rest] - as_ruled, 0.0)).sum())
    efficiency = right[0] + more, right[1], min(right[2] + more, 1.0)
    against = wrong[0] + other, wrong[1], wrong[2] + doubt
    if not efficiency[0] + against[0] > 0.0:
        return efficiency, (np.nan, 0.0, 1.0)
    pure = [a / (a + b) if a > 0.0 else 0.0 for a, b in zip(efficiency, (against[0], against[2], against[1]))]
    return efficiency, (pure[0], pure[1], pure[2])


def _sum_shares(shares: Floats, counts: Ints, parts: Ints) -> tuple[float, float, float]:
    """The sum of shares [1] times proportions, with its 95 % interval."""
    ends = [wilson([count], total) for count, total in zip(counts, parts, strict=True)]
    low, high = (np.array([float(end[k][0]) for end in ends]) for k in range(2))
    value = counts / np.maximum(parts, 1)
    total = float((shares * value).sum())
    down, up = (float(np.sqrt(((shares * off) ** 2).sum())) for off in (value - low, high - value))
    return total, max(total - down, 0.0), min(total + up, 1.0)


def document(designs: Iterable[TriedDesign]) -> list[dict[str, Any]]:
    """Return TriedDesigns as a list of dicts."""
    return [
        {
            "orientation": design.name,
            "devices": list(design.devices),
            "efficiency_static": design.static_efficiency,
            "efficiency_tried": design.efficiency,
            "efficiency_low": design.efficiency_ends[0],
            "efficiency_high": design.efficiency_ends[1],
            "purity_tried": None if np.isnan(design.purity) else design.purity,
            "purity_low": design.purity_ends[0],
            "purity_high": design.purity_ends[1],
            "parts": design.parts,
            "sorts": not design.faults,
            "agrees": design.agrees,
            "denied": texts.fault_texts(design.faults),
        }
        for design in designs
    ]
