"""The trial of what the static rule proposes: both verdicts side by side."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.designing import trying
from feederscrew.designing.proposals import alike
from feederscrew.designing.robust import denied
from feederscrew.errors import FeederError
from feederscrew.rates import stream
from feederscrew.running import RunSettings
from feederscrew.studies.tooling import ToolingStudy
from feederscrew.tooling.devices.kinds import KINDS, names
from feederscrew.tooling.isolating.proposal import Design

EACH = 2  # parts of each orientation
BEST = 3  # designs of a table that are tried
TRIES = 5  # designs of one orientation that are tried where the first ones are denied
SEARCHES = 8  # designs that are looked for after a denied one
# stretches that reject nothing: to leave them out makes no other chain
KEPT = tuple(name for name in names(leans=True) if not KINDS[name].grooved)
OFTEN = 0.02  # [1] shares of the orientations that are tried, and the one that is wanted


@dataclass(frozen=True)
class TriedDesign:
    """A chain of ``feeder tooling``, tried with a few parts of each orientation that comes often."""

    name: str  # of the orientation wanted
    wanted: int  # its place among the orientations
    devices: tuple[str, ...]  # of the chain, as a bowl file has them
    static_efficiency: float  # [1]
    efficiency: float  # [1] of those tried
    purity: float  # [1] NaN where nothing leaves
    parts: int
    faults: tuple[str, ...]  # what the trial denies, a sentence each

    @property
    def sentence(self) -> str:
        """Both verdicts."""
        said = "the trial agrees" if not self.faults else "the trial denies it: " + "; ".join(self.faults)
        return (
            f"{self.name}: the static rule lets {100.0 * self.static_efficiency:.3g} % leave, of {self.parts}"
            f" parts tried {100.0 * self.efficiency:.3g} % do; {said}"
        )


def own_trials(
    study: ToolingStudy,
    again: Callable[[tuple[str, ...]], ToolingStudy] | None = None,
    *,
    seed: int = 1,
    jobs: int = 1,
    before: Callable[[], Any] | None = None,
) -> ToolingStudy:
    """Try the chain of the orientation that was asked for, or the best three of a table.

    Parameters
    ----------
    study : ToolingStudy
    again : callable, optional
        Given kinds of devices, returns the same study without them: where the trial denies the chain of the
        orientation that was asked for, others are tried, five in all. The most efficient of those that the
        trial confirms is taken.
    seed, jobs : int
    before : callable, optional
        Called before anything is compiled.

    Returns
    -------
    ToolingStudy
        With its ``trials``: of a chain that the trial confirms where one is found, else of the first. Chains
        that isolate nothing are not tried.
    """
    known = [one for one in study.designs if one is not None and one.devices and one.efficiency > 0.0]
    best = sorted(known, key=lambda one: (-one.isolated, -one.efficiency, one.wanted))
    run = RunSettings(seed, jobs, before=before)
    tried = tuple(_tried(study, one, run) for one in best[:BEST])
    first = replace(study, trials=tried)
    if study.design is None or again is None or not tried or not tried[0].faults:
        return first
    others, ways, searched = [study], _ways_on((), study.design), 0
    while ways and searched < SEARCHES and len(tried) < TRIES:
        kinds, searched = ways.pop(0), searched + 1
        other = again(kinds)
        found = other.design
        if found is None or not _isolates(found) or _devices(found) in [one.devices for one in tried]:
            continue
        others, tried = [*others, other], (*tried, _tried(other, found, run))
        if not tried[-1].faults and found.efficiency >= study.design.efficiency:
            break
        ways += _ways_on(kinds, found) if tried[-1].faults else []
    holds = [k for k, one in enumerate(tried) if not one.faults]
    taken = max(holds, key=lambda k: tried[k].static_efficiency, default=0)
    return replace(others[taken], trials=(tried[taken], *tried[:taken], *tried[taken + 1 :]))


def _isolates(found: Design) -> bool:
    return found.isolated and bool(found.cuts) and found.efficiency > 0.0


def _ways_on(without: tuple[str, ...], found: Design) -> list[tuple[str, ...]]:
    """Kinds of devices to do without as well: each of a chain alone, the last one first, then all of them."""
    kinds = list(dict.fromkeys(cut.device.kind for cut in reversed(found.cuts)))
    kinds = [kind for kind in kinds if kind not in KEPT]
    every = [(kind,) for kind in kinds] + ([tuple(kinds)] if len(kinds) > 1 else [])
    return [(*without, *more) for more in every]


def _devices(found: Design) -> tuple[str, ...]:
    return tuple(f"{device.kind}: {device.text}" for device in found.devices)


def _tried(study: ToolingStudy, one: Design, run: RunSettings) -> TriedDesign:
    """One design with parts of its own, on a track of its own width."""
    study = study.on_its_width(one.wanted)
    bowl = replace(study.bowl, devices=one.devices)
    ways = stream.along(study.orientations, study.aspects, bowl.devices, bowl=bowl)
    name, total = ways.lying[one.wanted].name, study.shares.sum()
    shares = study.shares / total if total > 0.0 else np.full(len(study.shares), 1.0 / len(study.shares))
    rows = [k for k in trying.often(shares, (one.wanted,)) if shares[k] >= OFTEN or k == one.wanted]
    try:
        tried = trying.single(
            study.part, bowl, ways, shares, (one.wanted, *alike(ways.lying, one.wanted, study.up)), rows=rows,
            each=EACH, run=run, aspects=study.aspects,
            any_heading=trying.aspects_at_any_heading(ways.lying, one.wanted, study.up),
        )  # fmt: skip
    except FeederError as fault:  # the bowl does not convey
        return TriedDesign(name, one.wanted, _devices(one), one.efficiency, 0.0, np.nan, 0, (fault.what,))
    return TriedDesign(
        name=name,
        wanted=one.wanted,
        devices=_devices(one),
        static_efficiency=one.efficiency,
        efficiency=tried.efficiency,
        purity=tried.purity,
        parts=int(tried.parts.sum()),
        faults=tuple(denied(tried)),
    )


def document(tried: Iterable[TriedDesign]) -> list[dict[str, Any]]:
    """Return TriedDesigns as a list of dicts."""
    return [
        {
            "orientation": one.name,
            "devices": list(one.devices),
            "efficiency_static": one.static_efficiency,
            "efficiency_tried": one.efficiency,
            "purity_tried": None if np.isnan(one.purity) else one.purity,
            "parts": one.parts,
            "sorts": not one.faults,
            "denied": list(one.faults),
        }
        for one in tried
    ]
