"""Request of a design, and the records on which the design stands."""

import enum
import functools
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column, in_unit, values
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import RunSettings
from feederscrew.base.units import counted
from feederscrew.bowl.device_list import shank_remarks
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import AGREED_JAMS, Status
from feederscrew.designing import texts, verdict_texts
from feederscrew.designing.calm_drive import DriveKind
from feederscrew.designing.fill_verdicts import (
    FillDifference,
    differing_fills,
)
from feederscrew.designing.findings import Cause, End, Fault, FaultKind, Hooking, Move, SeldomPart
from feederscrew.designing.proof import ROBUST_COLUMNS, Proof
from feederscrew.designing.verdict import DesignVerdict, judge_design
from feederscrew.machine.drive_sizing import DriveMismatch, is_two_axis
from feederscrew.part.record import Part, small_part_remarks
from feederscrew.resting.rules.registry import require_rule
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.sorting.isolating.design import DESIGN_MARGIN_M
from feederscrew.sorting.tooling import ToolingStudy, listed
from feederscrew.trials.result import TrialRun


class ProofKind(enum.StrEnum):
    """For how long a design that holds is followed."""

    USUAL = "usual"  # until each fill is settled
    LONG = "long"  # until the agreed jams an hour are shown


@dataclass(frozen=True)
class DesignRequest:
    """Request of a design: what shall leave a bowl, and what the search for it may use."""

    target: float  # [1/s]
    aspect: str | None = None
    heading: float | None = None  # [rad]
    up: tuple[str, ...] = ()  # aspects that count as the one wanted, whatever their heading
    outcome: OutcomeKind = OutcomeKind.ANY  # how parts leave
    without: tuple[str, ...] = ()  # kinds of device that shall not be used
    diameter: tuple[float, float] | None = None  # [m] least and greatest
    rule: str = "recommended"
    drive: DriveKind = DriveKind.LEAF_SPRING  # that may be proposed
    tolerance: float = 1e-4  # [m] of the part's size, to either side
    budget: int = 16  # short trials
    draws: int = 20
    seed: int = 1
    jobs: int = 1
    alternatives: bool = False  # whether dearer cost classes are searched too where one holds
    agreed_jams: float = AGREED_JAMS  # [1/s] that the buyer tolerates
    proof: ProofKind = ProofKind.USUAL  # of the design that holds
    quick: bool = False  # a bound on the rate and a first chain, and nothing is proved

    @property
    def is_long(self) -> bool:
        """Tell whether a design that holds is followed until the agreed jams an hour are shown."""
        return self.proof is ProofKind.LONG

    @property
    def run(self) -> RunSettings:
        """Return how its trials and draws run."""
        return RunSettings(self.seed, self.jobs)

    def __post_init__(self) -> None:
        check.of_an_aspect(self.aspect, self.heading)
        require_rule(self.rule)
        object.__setattr__(self, "drive", check.choice("drive", self.drive, DriveKind))
        object.__setattr__(self, "proof", check.choice("proof", self.proof, ProofKind))
        object.__setattr__(self, "outcome", check.choice("outcome", self.outcome, OutcomeKind))
        for name in ("up", "without"):  # names may come as a text
            object.__setattr__(self, name, listed(getattr(self, name)))


@dataclass(frozen=True)
class Attempt:
    """One short trial of the loop: what was tried, and what came of it."""

    wanted: str  # 'A@2'
    aspect: str  # 'A'; '' of parts that hang
    chain: tuple[str, ...]  # 'gap: 9.5 mm'
    move: Move  # why it was tried
    bank: float  # [rad]
    velocity: float  # [m/s]
    parts: int
    efficiency: float  # [1]
    purity: float  # [1] NaN where nothing leaves
    stopped: float  # [1] share of the parts offered that stay at a device
    rate: float  # [1/s] that it would deliver
    faults: tuple[Fault, ...]
    cause: Cause = Cause.UNKNOWN  # why what is wanted is lost, or others leave; unknown of a clean one
    peak_to_peak: float = 0.0  # [m] stroke of its drive
    throw_number: float = 0.0  # [1] of its drive
    cost_class: int = 1  # of its chain: 1 steel alone, 2 steady air, 3 a sensor with a valve
    chain_brief: tuple[str, ...] = ()  # 'gap 9.5 mm'; of a device of several values its name alone

    @property
    def step(self) -> str:
        """Why it was tried, in words."""
        return texts.move_text(self.move)

    @property
    def clean(self) -> bool:
        """Tell whether only what is wanted leaves and nothing stays."""
        return self.efficiency > 0.0 and not self.faults


ATTEMPT_COLUMNS: tuple[Column[tuple[int, Attempt]], ...] = (  # a row a short trial, numbered from 1
    Column("trial", lambda tried: tried[0]),
    Column("wanted", lambda tried: tried[1].wanted),
    Column("chain", lambda tried: ", ".join(tried[1].chain) or "none"),
    Column("why", lambda tried: tried[1].step),
    Column("bank_deg", lambda tried: tried[1].bank, "deg"),
    Column("velocity_mm_s", lambda tried: tried[1].velocity, "mm/s"),
    Column("parts", lambda tried: tried[1].parts),
    Column("efficiency", lambda tried: tried[1].efficiency, "share"),
    Column("purity", lambda tried: tried[1].purity, "share"),
    Column("stopped", lambda tried: tried[1].stopped, "share"),
    Column("peak_to_peak_mm", lambda tried: tried[1].peak_to_peak, "mm"),
    Column("throw_number", lambda tried: tried[1].throw_number),
    Column("rate_per_minute", lambda tried: tried[1].rate, "1/min"),
    Column("denied", lambda tried: "; ".join(texts.fault_texts(tried[1].faults))),
    Column("cause", lambda tried: tried[1].cause),
)


@dataclass(frozen=True)
class Alternative:
    """The best design of a cost class: 1 steel alone, 2 steady air, 3 a sensor with a valve."""

    cost_class: int
    status: Status
    delivered: tuple[float, float, float] | None = None  # wanted parts [1/s]: value, low and high end
    purity: float | None = None  # [1] of what left its queues
    efficiency: float | None = None  # [1] share of the parts offered in its queues that left as wanted
    chain: tuple[str, ...] = ()  # 'gap: 9.5 mm'
    chain_words: tuple[str, ...] = ()  # the same as the trade names it
    sees: tuple[str, ...] = ()  # what each of its sensors sees
    reasons: tuple[str, ...] = ()  # where it falls short, or why there is none; none of one that holds

    @property
    def why(self) -> str:
        """The same in one line."""
        return "; ".join(self.reasons)


ALTERNATIVE_COLUMNS: tuple[Column[Alternative], ...] = (
    Column("class", lambda option: option.cost_class),
    Column("status", lambda option: option.status),
    Column("delivered_per_minute", lambda option: option.delivered and option.delivered[0], "1/min"),
    Column("delivered_low", lambda option: option.delivered and option.delivered[1], "1/min"),
    Column("purity", lambda option: option.purity, "share"),
    Column("yield", lambda option: option.efficiency, "share"),
    Column("chain", lambda option: list(option.chain)),
)


@dataclass(frozen=True)
class WantedTrials:
    """Outcome of the short trials in which one orientation was wanted."""

    wanted: str  # 'A@2'; 'A' of an aspect that counts at any heading
    aspect: str
    trials: int
    ends: tuple[End, ...]  # where its parts were lost, the place of most trials first
    others: tuple[Fault, ...]  # what went wrong with other orientations, else with a trial, each once
    clean_rate: float | None = None  # [1/s] of the fastest that was clean; None where none was

    @classmethod
    def of(cls, attempts: Iterable[Attempt]) -> tuple["WantedTrials", ...]:
        """Return what became of each orientation in some trials, that of most trials first.

        Parameters
        ----------
        attempts : iterable of Attempt

        Returns
        -------
        tuple of WantedTrials
            One for each orientation that was wanted.
        """
        by_name: dict[str, list[Attempt]] = {}
        for attempt in attempts:
            by_name.setdefault(attempt.wanted, []).append(attempt)
        made = []
        for name, own in by_name.items():
            faults = [fault for attempt in own for fault in attempt.faults]
            lost = [fault for fault in faults if fault.kind is FaultKind.LOST]
            ends = Counter(end for fault in lost for end in dict.fromkeys(fault.ends))
            others = [fault for fault in faults if fault.kind in (FaultKind.CARRIED, FaultKind.STAYS)]
            others = others or [fault for fault in faults if fault.kind is not FaultKind.LOST]
            named = {(fault.kind, fault.orientation): fault for fault in others}
            order = tuple(end for end, _ in ends.most_common())
            fastest = max((attempt.rate for attempt in own if attempt.clean), default=None)
            made.append(cls(name, own[0].aspect, len(own), order, tuple(named.values()), fastest))
        return tuple(sorted(made, key=lambda one: -one.trials))


@dataclass(frozen=True)
class QuickAnswer:
    """Answer of a design without a proof on the rate, for a quotation."""

    wanted: str  # orientation of which it speaks: that of the chain, or the one that may bring most
    share: float  # [1] of the parts that come so
    fastest: float  # [m/s] of the fastest drive
    rate_at_most: float  # [1/s] of that orientation at the fastest drive, were all others returned
    short_trial: float | None  # [1/s] that the short trial of the chain would deliver; None without a chain
    clean: bool  # whether only what is wanted left that trial


QUICK_COLUMNS: tuple[Column[QuickAnswer], ...] = (
    Column("wanted", lambda quick: quick.wanted),
    Column("share", lambda quick: quick.share, "share"),
    Column("fastest_mm_s", lambda quick: quick.fastest, "mm/s"),
    Column("at_most_per_minute", lambda quick: quick.rate_at_most, "1/min"),
    Column("short_trial_per_minute", lambda quick: quick.short_trial, "1/min"),
    Column("clean", lambda quick: quick.clean),
)


@dataclass(frozen=True)
class NearestDesign:
    """Nearest design that holds where a design does not, as it was tried; or that nothing tried holds."""

    rate: float | None  # [1/s] that holds; None where none of what was tried does
    change: str  # what is changed for it: 'a lower rate', 'a calmer drive: 0.8 mm peak to peak'
    wanted: str | None = None  # orientation that leaves
    chain: tuple[str, ...] = ()  # 'gap: 9.5 mm'
    frequency: float | None = None  # [Hz] of the drive
    peak_to_peak: float | None = None  # [m]
    throw_number: float | None = None  # [1]
    trials: int = 0  # short trials that were made to find it, those of the search among them
    proofs: int = 0  # designs that went through draws and queues
    draws: int = 0  # of the one that holds
    draws_held: int = 0
    queue_seconds: float = 0.0  # [s]
    parts_right: int = 0  # left its queues as wanted
    parts_left: int = 0
    denied: tuple[str, ...] = ()  # what else was tried, and what came of it
    helps: tuple[str, ...] = ()  # what else was seen to help, or may
    request: DesignRequest | None = None  # that it was tried for; None where none holds
    settings: tuple[tuple[str, str], ...] = ()  # keys of the bowl that it changes, and their values

    @property
    def text(self) -> str:
        """The same in a sentence."""
        lead = "" if self.rate is None else "nearest that holds: "
        return f"{lead}{self.sentence}"

    @property
    def sentence(self) -> str:
        """The same for a row that is named "nearest that holds" already."""
        also = "".join(f"; {sentence}" for sentence in self.helps)
        if self.rate is None:
            counts = f"{counted(self.trials, 'short trial')}, {counted(self.proofs, 'design')} through draws"
            denied = "".join(f"; {sentence}" for sentence in self.denied)
            return f"nothing near it holds of what was tried ({counts} and queues){denied}{also}"
        figures = (
            f"tried: {self.draws_held} of {counted(self.draws, 'draw')} sort, {self.parts_right} of "
            f"{counted(self.parts_left, 'part')} left {self.queue_seconds:.3g} s of queue as wanted"
        )
        return f"{60.0 * self.rate:.3g}/min with {self.change} ({figures}){also}"


NEAREST_TRIED_COLUMNS: tuple[Column[NearestDesign], ...] = (
    Column("short_trials", lambda near: near.trials),
    Column("proofs", lambda near: near.proofs),
    Column("draws", lambda near: near.draws),
    Column("draws_held", lambda near: near.draws_held),
    Column("queue_seconds", lambda near: near.queue_seconds),
    Column("parts_left", lambda near: near.parts_left),
    Column("parts_right", lambda near: near.parts_right),
)
NEAREST_COLUMNS: tuple[Column[NearestDesign], ...] = (
    Column("frequency_hz", lambda near: near.frequency, "Hz"),
    Column("peak_to_peak_mm", lambda near: near.peak_to_peak, "mm"),
    Column("throw_number", lambda near: near.throw_number),
)


@dataclass(frozen=True, eq=False)
class Pair:
    """A part and another of its kind, or the walls that it stands between, as it is drawn."""

    axes: Floats  # (3, 3) [1] of the picture as rows, in the file's axes: along, across, up
    turn: Floats | None = None  # (3, 3) [1] of the second part, in the file's axes
    place: Floats | None = None  # (3,) [m] of its centre of mass from that of the first, in those axes
    walls: float = np.nan  # [m] apart, square to what is across; NaN of two parts


class RiskKind(enum.StrEnum):
    """In which way parts may hinder each other, or do what they should not; files print the word."""

    SHINGLES = "shingles"
    CLIMBS = "climbs"
    HOOKS = "hooks"
    NESTS = "nests"
    WEDGES = "wedges"
    LEAVES = "leaves"  # in another orientation than is wanted
    STANDS = "stands"  # at a device


@dataclass(frozen=True, eq=False)
class Risk:
    """Risk between parts, or with one that comes seldom."""

    kind: RiskKind
    text: str
    pair: Pair | None = None  # what is drawn of it
    hooking: Hooking | None = None  # of parts that hook
    seldom: SeldomPart | None = None  # of one that leaves or stands


@dataclass(frozen=True, eq=False)
class DesignStudy(ReadableRecord, view="design_pages.DESIGN_VIEW"):
    """A bowl for a part and a rate, with everything that was tried on the way."""

    part: Part
    request: DesignRequest
    bowl: Bowl | None  # None where there is none
    wanted: str | None  # orientation that leaves: 'A@2', 'hanging'
    turn: int | None  # its place among the orientations
    wanted_aspect: str = ""  # 'A'; '' of parts that hang
    cuts: tuple = ()  # of Cut: the chain with the values it may have
    before: tuple[Device, ...] = ()
    attempts: tuple[Attempt, ...] = ()
    proof: Proof = field(default_factory=Proof)  # its draws and queues
    risks: tuple[Risk, ...] = ()
    nearest: NearestDesign | None = None  # what holds instead; None of one that holds or was stopped
    partial: bool = False
    tooling: ToolingStudy | None = None  # the chain as `feeder tooling` knows it; None without one
    source: str = ""  # whose shares were taken
    static_rate: float = 0.0  # [1/s] that the static rule promises
    trials: tuple[TrialRun, ...] = ()  # its short trial: what is wanted, then the others
    machine_drawn: bool = False  # the machine of its bowl is the one that was sized for it
    drive_mismatch: DriveMismatch | None = None  # with the drive that its drawn machine makes
    machine_warnings: tuple[str, ...] = ()  # what of its drawn machine is out of limits
    machine_lacks: tuple[str, ...] = ()  # of the drive that was tried: why it does not hold
    alternatives: tuple[Alternative, ...] = ()  # the best of each cost class, the cheapest first
    arrivals: tuple[tuple[str, float], ...] = ()  # aspects, and the share [1] in which they come: first most
    quick: QuickAnswer | None = None  # of a design that is not proved because it was not asked for
    call: tuple[str, ...] = ()  # words of the command line that asked for it; () of the library

    @property
    def devices(self) -> tuple[Device, ...]:
        """Every device along the track."""
        return () if self.bowl is None else self.bowl.devices

    @property
    def outcome(self) -> OutcomeKind:
        """Return whether what leaves lies on the track or hangs by its head."""
        hangs = any(device.action is Action.HANG for device in self.devices)
        own = OutcomeKind.HANGING if hangs else OutcomeKind.LYING
        return self.request.outcome if self.bowl is None else own

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return a sentence for each thing that a user must not overlook."""
        allowances = {"margin": DESIGN_MARGIN_M, "tolerance": self.request.tolerance}
        width = None if self.bowl is None else self.bowl.track.width
        warnings = [*self.part.warnings, *small_part_remarks(self.part, allowances, width)]
        warnings += shank_remarks(self.devices)
        if (
            self.bowl is not None
            and self.request.drive == DriveKind.LEAF_SPRING
            and is_two_axis(self.bowl.drive)
        ):
            phase = np.degrees(self.bowl.drive.phase)
            warnings.append(
                f"drive.phase: {phase:.4g} deg is kept as given, which needs two magnets - set it to 0 deg "
                "for a leaf-spring drive"
            )
        warnings += self.machine_warnings
        if self.proof.long_ride is not None and self.proof.long_ride.warning:
            warnings.append(self.proof.long_ride.warning)
        return tuple(warnings)

    @property
    def differences(self) -> tuple[FillDifference, ...]:
        """Fills that are worse than the others by more than chance, with what goes wrong there."""
        return differing_fills(self.proof.queues, self.cuts)

    @property
    def trial_parts(self) -> int:
        """Return how many parts were tried one at a time."""
        return sum(attempt.parts for attempt in self.attempts)

    @property
    def attempts_asked_for(self) -> tuple[Attempt, ...]:
        """The trials of what was asked for; where other ways up were tried beside it, those are left out."""
        names = {name.casefold() for name in (*self.request.up, self.request.aspect or "") if name}
        own = [attempt for attempt in self.attempts if attempt.aspect.casefold() in names]
        return tuple(own) or self.attempts

    @property
    def wanted_trials(self) -> tuple[WantedTrials, ...]:
        """Return what became of each orientation that was asked for in its short trials."""
        return WantedTrials.of(self.attempts_asked_for)

    @property
    def delivered(self) -> tuple[float, float, float]:
        """Wanted parts [1/s] of the worst fill: value, low and high end of the 95 % interval."""
        return self.proof.delivered

    @property
    def purity(self) -> tuple[float, float]:
        """Share [1] of what left that is wanted, and its lower bound, of the worst fill; NaN of nothing."""
        return self.proof.purity

    @functools.cached_property
    def verdict(self) -> DesignVerdict:
        """Return whether it holds, where it falls short, and why."""
        return judge_design(self)

    @property
    def status(self) -> Status:
        """Return whether it holds."""
        return self.verdict.status

    @property
    def cause(self) -> Cause:
        """Return the cause why it does not hold; unknown of one that holds or was stopped."""
        return self.verdict.blame.cause

    @property
    def why(self) -> str:
        """Return why it does not hold, in words; the condition of one that has one."""
        return verdict_texts.why_text(self)

    @property
    def condition(self) -> str:
        """Return the condition under which it holds, as a sentence; '' of one without, or that does not."""
        return verdict_texts.condition_text(self)

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Return where it does not do what was asked, a sentence each."""
        return verdict_texts.shortfall_texts(self)

    @property
    def delivers(self) -> bool:
        """Tell whether it may be built from: a wanted part has left its queues, and it was not stopped."""
        is_proved = self.status is not Status.NOT_PROVED
        return self.bowl is not None and is_proved and self.proof.delivered[0] > 0.0

    def proved_by(self, **changes: Any) -> "DesignStudy":
        """Return the same design with changes of its proof.

        Parameters
        ----------
        **changes : any
            Fields of ``Proof``.

        Returns
        -------
        DesignStudy
        """
        return replace(self, proof=replace(self.proof, **changes))


DESIGN_STATUS_COLUMNS: tuple[Column[DesignStudy], ...] = (
    Column("status", lambda study: study.status),
    Column("wanted", lambda study: study.wanted),
    Column("up", lambda study: list(study.request.up)),
    Column("outcome", lambda study: study.outcome),
    Column("drive_asked_for", lambda study: study.request.drive),
    Column("target_per_minute", lambda study: study.request.target, "1/min"),
)
DESIGN_PROOF_COLUMNS: tuple[Column[DesignStudy], ...] = (
    Column("static_per_minute", lambda study: study.static_rate, "1/min"),
    Column("queue_seconds", lambda study: study.proof.queue_seconds),
    Column(
        "robust",
        lambda study: (
            values(ROBUST_COLUMNS, study.proof.robust)
            | {"tolerance_mm": in_unit(study.request.tolerance, "mm")}
        ),
    ),
    Column("chain", lambda study: [{"device": item.kind, "value": item.text} for item in study.devices]),
)
DESIGN_RUN_COLUMNS: tuple[Column[DesignStudy], ...] = (
    Column("trial_parts", lambda study: study.trial_parts),
    Column("answer", lambda study: study.source),
    Column("seed", lambda study: study.request.seed),
    Column("partial", lambda study: study.partial),
)
