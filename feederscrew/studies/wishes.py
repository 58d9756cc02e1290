"""What ``feeder tooling`` may use for a design, and how long it looks for one: its keywords, checked."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypedDict

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.documents import hint
from feederscrew.errors import ArgumentError
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.kinds import KINDS, leaning
from feederscrew.tooling.isolating.chain import DESIGN_KEY, SHOP_ROUNDING_M, DesignConstraints
from feederscrew.tooling.isolating.design import PLAY_M, TOLERANCE_M
from feederscrew.tooling.isolating.hole_search import HoleSearch
from feederscrew.tooling.isolating.proposal import Goal
from feederscrew.tooling.orientations import travel_speed
from feederscrew.units import shown

OUTCOMES = ("lying", "hanging", "any")


@dataclass(frozen=True)
class ToolingOptions:
    """The goal, the means and the limits of a search; an option means what it means for ``tooling``."""

    purity: float = Goal.purity
    efficiency: float = Goal.efficiency
    outcome: str = DesignConstraints.outcome
    without: str | Sequence[str] = DesignConstraints.without
    step: float = DesignConstraints.step
    up: str | Sequence[str] = DesignConstraints.up
    cutter: float = DesignConstraints.cutter
    vary: bool = DesignConstraints.vary
    turn: bool = DesignConstraints.turn
    air: bool = DesignConstraints.air
    play: float = PLAY_M
    tolerance: float = TOLERANCE_M
    seed: int = HoleSearch.seed
    verdicts: int = HoleSearch.verdicts
    seconds: float = 600.0
    told: Callable[[int, int], None] | None = None


class ToolingKeywords(TypedDict, total=False):
    """The same as keywords."""

    purity: float
    efficiency: float
    outcome: str
    without: str | Sequence[str]
    step: float
    up: str | Sequence[str]
    cutter: float
    vary: bool
    turn: bool
    air: bool
    play: float
    tolerance: float
    seed: int
    verdicts: int
    seconds: float
    told: Callable[[int, int], None] | None


def asked_for(part: Part, bowl: Bowl, found: Aspects, own: ToolingOptions) -> DesignConstraints:
    """Return what a design may use, checked, as DesignConstraints."""
    if own.outcome not in OUTCOMES:
        raise ArgumentError("outcome", f"{own.outcome!r} is unknown", f"choose {', '.join(OUTCOMES)}")
    check.argument("step", own.step, SHOP_ROUNDING_M)
    kinds = may_be_left_out(own.without)
    wishes = DesignConstraints(
        outcome=own.outcome,
        without=kinds,
        step=float(own.step),
        up=may_be_up(part, found, own.up),
        cutter=float(own.cutter),
        vary=bool(own.vary),
        turn=own.turn,
        air=own.air,
    )
    return replace(wishes, separation=_separation(bowl, wishes))


def listed(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of a list, or of a text with commas."""
    names = names.split(",") if isinstance(names, str) else names
    return tuple(name.strip() for name in names if name.strip())


def may_be_left_out(without: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of kinds of devices that are not used, checked."""
    kinds = listed(without)
    for kind in kinds:
        if kind not in KINDS:
            raise ArgumentError("without", f"unknown device {shown(kind)}", hint(kind, list(KINDS)))
    return kinds


def may_be_up(part: Part, found: Aspects, up: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of aspects that may be up as well, checked."""
    known = {name.casefold() for name in found.names}
    for name in listed(up):
        if name.casefold() not in known:
            mend = f"choose one of {', '.join(found.names)}"
            raise ArgumentError("up", f"{part.name} has no aspect {shown(name)}", mend)
    return listed(up)


def _separation(bowl: Bowl, wishes: DesignConstraints) -> Device | None:
    """The stretch that makes gaps in this bowl; None where it may not be used or makes none."""
    for kind in leaning():
        steeper = kind.parting(DESIGN_KEY) if wishes.allows(kind.kind) else None
        if steeper is not None and travel_speed(steeper.onward(bowl)) > travel_speed(bowl):
            return steeper
    return None
