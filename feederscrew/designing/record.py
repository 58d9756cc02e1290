"""Request of a design, and the records on which the design stands."""

import enum
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column, in_unit, values
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import RunSettings
from feederscrew.base.units import HOUR, MINUTE, counted
from feederscrew.bowl.device_list import shank_remarks
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import AGREED_JAMS, DRAWS_HELD, HELD, PURE, RATE_KEPT, SHOWN_PURITY, Status
from feederscrew.designing import texts
from feederscrew.designing.calm_drive import DriveKind
from feederscrew.designing.evidence import rate_at_most, share_at_least
from feederscrew.designing.fill_verdicts import (
    FillDifference,
    FillState,
    differing_fills,
    judge_fill,
    longest_time,
    shows_purity,
)
from feederscrew.designing.findings import Cause, End, Fault, FaultKind, Hooking, Move, SeldomPart
from feederscrew.machine.drive_sizing import DriveMismatch, is_two_axis
from feederscrew.part.record import Part, small_part_remarks
from feederscrew.resting.rules.registry import require_rule
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.sorting.isolating.design import DESIGN_MARGIN_M
from feederscrew.sorting.tooling import ToolingStudy, listed
from feederscrew.trials.fills import (
    FedRow,
    FilledQueue,
    LeavingCounts,
    LeavingPose,
    PoseKind,
    join_leaving_counts,
)
from feederscrew.trials.long_ride import LongRide
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
class RobustRun:
    """Draws of part, friction, drive and cuts; each tried with some parts."""

    draws: int
    held: int
    worst: Fault | None = None  # what went wrong most often; None where nothing did
    slowest: float = 0.0  # [m/s] velocity of the slowest draw; 0 of none
    partial: bool = False

    @property
    def worst_text(self) -> str:
        """Return the most frequent fault in words, and in how many draws it came; '' without any."""
        return "" if self.worst is None else texts.counted_fault_text(self.worst)

    @property
    def share(self) -> float:
        """Return the share of the draws that sort [1]; 0 without draws."""
        return self.held / self.draws if self.draws else 0.0


ROBUST_COLUMNS: tuple[Column[RobustRun], ...] = (
    Column("draws", lambda robust: robust.draws),
    Column("held", lambda robust: robust.held),
    Column("worst", lambda robust: robust.worst_text),
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
    others: tuple[Fault, ...]  # what went wrong with other orientations, each once

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
            others = (fault for fault in faults if fault.kind in (FaultKind.CARRIED, FaultKind.STAYS))
            named = {(fault.kind, fault.orientation): fault for fault in others}
            order = tuple(end for end, _ in ends.most_common())
            made.append(cls(name, own[0].aspect, len(own), order, tuple(named.values())))
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
    robust: RobustRun = field(default_factory=lambda: RobustRun(0, 0))
    queues: tuple[FilledQueue, ...] = ()
    risks: tuple[Risk, ...] = ()
    nearest: NearestDesign | None = None  # what holds instead; None of one that holds or was stopped
    partial: bool = False
    tooling: ToolingStudy | None = None  # the chain as `feeder tooling` knows it; None without one
    source: str = ""  # whose shares were taken
    static_rate: float = 0.0  # [1/s] that the static rule promises
    slowed: float = 1.0  # [1] of its velocity that the drive keeps at the worst friction
    trials: tuple[TrialRun, ...] = ()  # its short trial: what is wanted, then the others
    machine_drawn: bool = False  # the machine of its bowl is the one that was sized for it
    drive_mismatch: DriveMismatch | None = None  # with the drive that its drawn machine makes
    machine_warnings: tuple[str, ...] = ()  # what of its drawn machine is out of limits
    machine_lacks: tuple[str, ...] = ()  # of the drive that was tried: why it does not hold
    alternatives: tuple[Alternative, ...] = ()  # the best of each cost class, the cheapest first
    row: FedRow | None = None  # how parts were fed into its queues; None of what was not followed
    long_ride: LongRide | None = None  # from the track's entry to the tooling; None of what was not proved
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
        if self.long_ride is not None and self.long_ride.warning:
            warnings.append(self.long_ride.warning)
        return tuple(warnings)

    def _sum(self, name: str) -> int:
        return sum(getattr(queue, name) for queue in self.queues)

    @property
    def worst_fill(self) -> FilledQueue | None:
        """The queue of the fill that brings least; None without one."""
        return min(self.queues, key=lambda queue: queue.rate, default=None)

    @property
    def delivered(self) -> tuple[float, float, float]:
        """Wanted parts [1/s] of the worst fill: value, low and high end of the 95 % interval.

        Each is the least of all fills, so that nothing a cleaner fill does improves it.
        """
        if not self.queues:
            return 0.0, 0.0, 0.0
        lows, highs = zip(*(queue.ends for queue in self.queues), strict=True)
        return min(queue.rate for queue in self.queues), min(lows), min(highs)

    @property
    def worst(self) -> float:
        """Wanted parts [1/s] of the worst fill at the worst friction."""
        return self.delivered[0] * self.slowed

    @property
    def purity(self) -> tuple[float, float]:
        """Share [1] of what left that is wanted, and its lower bound, of the worst fill; NaN of nothing.

        The bound is one-sided, for 95 % confidence (``evidence.share_at_least``). Each is the least of all
        fills.
        """
        shares = [queue.right / queue.left for queue in self.queues if queue.left]
        lows = (share_at_least(queue.right, queue.left) for queue in self.queues)
        return min(shares, default=np.nan), min(lows, default=0.0)

    @property
    def efficiency(self) -> float:
        """Return the share [1] of offered parts that left as wanted, of the worst fill; NaN without."""
        shares = (queue.right / queue.offered for queue in self.queues if queue.offered)
        return min(shares, default=np.nan)

    @property
    def differences(self) -> tuple[FillDifference, ...]:
        """Fills that are worse than the others by more than chance, with what goes wrong there."""
        return differing_fills(self.queues, self.cuts)

    @property
    def jams(self) -> int:
        """Parts that had to be taken out of the queues."""
        return self._sum("jams")

    @property
    def queue_seconds(self) -> float:
        """Time that queues were followed [s]."""
        return float(self._sum("seconds"))

    @property
    def jams_per_hour_high(self) -> float:
        """Upper bound of the jams an hour, one-sided for 95 % confidence: 3 / T after T hours without one."""
        return HOUR * rate_at_most(self.jams, self.queue_seconds)

    @property
    def trial_parts(self) -> int:
        """Return how many parts were tried one at a time."""
        return sum(attempt.parts for attempt in self.attempts)

    @property
    def status(self) -> Status:
        """The verdict; what was stopped, or not run, is no evidence, neither for a design nor against it."""
        holds = self.tooling_status in HELD
        return Status.NO_MACHINE if holds and self.machine_lacks else self.tooling_status

    @property
    def tooling_status(self) -> Status:
        """The verdict of draws and queues on track and devices, whatever machine can be made below them."""
        if self.partial or self.request.quick:
            return Status.NOT_PROVED
        if self.bowl is None or not self.delivered[0] > 0.0:
            return Status.FALLS_SHORT if self.bowl is not None and self.queues else Status.NONE
        if self.tooling_shortfalls:
            return Status.FALLS_SHORT
        return Status.HOLDS if self.hooking is None else Status.HOLDS_SINGLE

    @property
    def hooking(self) -> Hooking | None:
        """Return how two of its parts hook; None of parts that come apart by themselves."""
        return next((risk.hooking for risk in self.risks if risk.hooking is not None), None)

    @property
    def condition(self) -> str:
        """The condition under which it holds, as a sentence; '' of one that holds without, or does not."""
        if self.tooling_status != Status.HOLDS_SINGLE or self.hooking is None:
            return ""
        return texts.condition_text(self.hooking)

    @property
    def proved_so_far(self) -> tuple[str, ...]:
        """Return what was counted until now, a sentence each; of a stopped design it decides nothing."""
        if self.bowl is None:
            return (f"{counted(len(self.attempts), 'short trial')} made, none of a design was proved",)
        robust = self.robust
        draws = f"{robust.held} of {counted(robust.draws, 'draw')} sort, {self.request.draws} are asked for"
        lines = [draws if robust.draws else "no draw was tried"]
        for queue in self.queues:
            end = "was stopped after" if queue.partial else "was followed for"
            parts = f"{queue.right} of {counted(queue.left, 'part')} left as wanted"
            jams = counted(queue.jams, "jam")
            lines.append(f"the queue at {queue.fill} fill {end} {queue.seconds:.3g} s: {parts}, {jams}")
        return (*lines, *(() if self.queues else ("no queue was followed",)))

    @property
    def delivers(self) -> bool:
        """Tell whether it may be built from: a wanted part has left its queues, and it was not stopped."""
        is_proved = self.status is not Status.NOT_PROVED
        return self.bowl is not None and is_proved and self.delivered[0] > 0.0

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Where it does not do what was asked, a sentence each: its tooling, then its machine."""
        return (*self.tooling_shortfalls, *(self.machine_lacks if self.bowl is not None else ()))

    @property
    def tooling_shortfalls(self) -> tuple[str, ...]:
        """Where its draws and its queues do not do what was asked, a sentence each."""
        if self.bowl is None:
            return tuple(
                texts.wanted_trials_text(one.wanted, one.trials, one.ends, one.others)
                for one in self.wanted_trials[:3]
            )
        lines = list[str]()
        for queue in self.undecided_fills if not self.refused_fills else self.refused_fills:
            lines += self._lacks_of(queue)
        if not self.queues and self.robust.share >= DRAWS_HELD:  # draws that fail end a proof
            lines.append("no queue was followed")
        if self.request.proof is ProofKind.LONG:
            lines += [self._jams_of(queue) for queue in self.queues if queue.jams]
        elif self.jams:
            stood = texts.jammed_text(row for queue in self.queues for row in queue.jammed)
            lines.append(f"{counted(self.jams, 'jam')} in {self.queue_seconds:.3g} s of queue{stood}")
        if self.robust.share < DRAWS_HELD:
            worst = "" if self.robust.worst is None else f": {self.robust.worst_text}"
            lines.append(
                f"{self.robust.held} of {self.robust.draws} draws of part, friction and drive sort{worst}"
            )
        return tuple(lines)

    @property
    def wanted_trials(self) -> tuple[WantedTrials, ...]:
        """Return what became of each orientation that was asked for in its short trials."""
        return WantedTrials.of(_asked_for(self))

    def fills_of(self, state: FillState) -> tuple[FilledQueue, ...]:
        """Return the queues of the fills of one state, for the rate that is asked for.

        Parameters
        ----------
        state : FillState

        Returns
        -------
        tuple of FilledQueue
        """
        least, longest = RATE_KEPT * self.request.target, longest_time(self.request.target)
        return tuple(queue for queue in self.queues if judge_fill(queue, least, longest) is state)

    @property
    def refused_fills(self) -> tuple[FilledQueue, ...]:
        """The queues of the fills that surely do not hold."""
        return self.fills_of(FillState.REFUSED)

    @property
    def undecided_fills(self) -> tuple[FilledQueue, ...]:
        """The queues of the fills whose parts decide nothing yet."""
        return self.fills_of(FillState.OPEN)

    def _lacks_of(self, queue: FilledQueue) -> list[str]:
        """Return what a fill lacks, a sentence each; its jams are counted with those of the others."""
        minute, (low, high), target = 60.0, queue.ends, self.request.target
        at, lines = f"at {queue.fill} fill", []
        if low < RATE_KEPT * target:
            lines.append(
                f"{at} {minute * queue.rate:.3g}/min are delivered (95 % interval {minute * low:.3g} to "
                f"{minute * high:.3g}), {minute * target:.3g}/min are asked for"
            )
        if queue.left and queue.right < PURE * queue.left:
            lines.append(
                f"{at} the purity is {100.0 * queue.right / queue.left:.3g} % ({queue.right} of "
                f"{counted(queue.left, 'part')}), {100.0 * PURE:.3g} % are asked for{_instead(self, queue)}"
            )
        elif not shows_purity(queue):
            shown = 100.0 * share_at_least(queue.right, queue.left)
            lines.append(
                f"{at} {queue.right} of {counted(queue.left, 'part')} left as wanted, which shows a purity "
                f"of {shown:.3g} % (lower bound, 95 %, one-sided), and more than "
                f"{100.0 * SHOWN_PURITY:.3g} % have to be shown"
            )
        if not (lines or queue.jams):
            lines.append(f"{at} parts were followed for {queue.seconds:.3g} s only")
        return lines

    def _jams_of(self, queue: FilledQueue) -> str:
        """Return how many jams a fill of a long proof had, what that shows, and what is agreed."""
        shown, agreed = HOUR * rate_at_most(queue.jams, queue.seconds), HOUR * self.request.agreed_jams
        return (
            f"at {queue.fill} fill {counted(queue.jams, 'jam')} in {queue.seconds / MINUTE:.3g} min: "
            f"fewer than {shown:.3g} an hour are shown (upper bound, 95 %, one-sided), and {agreed:.3g} an "
            "hour are agreed"
        )

    @property
    def cause(self) -> Cause:
        """Return the cause why it does not hold; unknown of one that holds or was stopped."""
        return self._cause[0]

    @property
    def _cause(self) -> tuple[Cause, str]:
        """The same with a sentence."""
        if self.status in (*HELD, Status.NOT_PROVED):
            return Cause.UNKNOWN, ""
        if self.status is Status.NO_MACHINE:
            return Cause.DRIVE, "the machine below it cannot be made; its track and devices hold"
        if not self.queues:  # what the trials say, of the best of them
            if not self.attempts:
                return Cause.PART, "no device tells an orientation that was asked for from the others"
            best = max(_asked_for(self), key=lambda attempt: (attempt.efficiency, attempt.rate))
            if best.faults:
                denied = f"{best.wanted}: {', '.join(texts.fault_texts(best.faults, 2))}"
                return best.cause or Cause.PART, "" if self.bowl is None else denied  # said of each
            return Cause.ARRIVAL, (
                f"{best.wanted} comes too seldom: {60.0 * best.rate:.3g}/min at the most - ask for less, "
                "or let other aspects count with --up"
            )
        chain = ", ".join(device.kind for device in self.devices) or "the track"
        if self.jams:
            return Cause.DEVICE, f"parts stand at {chain} and have to be taken out"
        purity, _ = self.purity
        if not self.delivered[0] > 0.0 and not any(queue.left for queue in self.queues):
            return Cause.DRIVE, "no part came to the outlet in its queues"
        if not purity >= PURE:
            off = sum(n for pose, n in self.left_instead if self._is_wanted_heading_off(pose))
            if 2 * off >= sum(n for _, n in self.left_instead) > 0:
                return Cause.DRIVE, f"it turns {self.wanted} to other headings in a queue"
            if self.devices:
                return Cause.DEVICE, f"what is not wanted gets through {chain} in a queue"
            return Cause.PART, "without a device nothing tells what is wanted from the rest"
        fault = self.robust.worst
        if self.robust.share < DRAWS_HELD and fault is not None:
            if fault.is_at_device:
                return Cause.DEVICE, self.robust.worst_text
            if fault.kind is FaultKind.CARRIED:
                return (Cause.DEVICE if self.devices else Cause.PART), self.robust.worst_text
            return Cause.DRIVE, self.robust.worst_text
        queue = self.worst_fill
        if queue is None or not queue.right:
            return Cause.ARRIVAL, "too little of what is wanted leaves its queues"
        if self.delivered[1] >= RATE_KEPT * self.request.target:  # the rate is enough
            return Cause.ARRIVAL, "too few parts left its queues to show that it is pure"
        share, need = queue.right / queue.offered, self.request.target / queue.pace
        return Cause.ARRIVAL, (
            f"at {queue.fill} fill {60.0 * queue.pace:.3g} parts a minute come along, and "
            f"{100.0 * share:.3g} % of them leave as {self.wanted}: "
            f"{60.0 * self.delivered[1] / RATE_KEPT:.2g}/min would hold, or a part of which "
            f"{100.0 * need:.3g} % come so"
        )

    @property
    def why(self) -> str:
        """Where it falls short, the cause, and the nearest that holds; the condition of one that has one."""
        if self.status in HELD:
            return self.condition
        if self.partial:
            return "; ".join(("stopped before all was tried", *self.proved_so_far))
        if self.request.quick:
            return "; ".join(("a quick look, without draws and queues", *self.proved_so_far))
        return "; ".join((self.reasons, *(() if self.nearest is None else (self.nearest.text,))))

    @property
    def reasons(self) -> str:
        """Where it falls short, and the cause; '' of a design that holds or was stopped."""
        return "; ".join(self.reason_lines)

    @property
    def reason_lines(self) -> tuple[str, ...]:
        """The same, a sentence each, none of them twice."""
        cause, sentence = self._cause
        if not cause:
            return ()
        differences = map(texts.difference_text, self.differences)
        lines = dict.fromkeys((*self.shortfalls, *differences))
        # a cause that was said already is named alone
        named = f"the cause is the {cause}"
        return (*lines, f"{named}: {sentence}" if sentence and sentence not in lines else named)

    @property
    def left_instead(self) -> LeavingCounts:
        """In which poses parts left all queues otherwise than wanted, and how many, the most first."""
        return join_leaving_counts(*(queue.left_instead for queue in self.queues))

    @property
    def aspects_heading_off(self) -> tuple[str, ...]:
        """Aspects on which parts left all queues at a heading that is none of the listed."""
        return tuple(pose.aspect for pose, _ in self.left_instead if pose.kind is PoseKind.HEADING_OFF)

    def _is_wanted_heading_off(self, pose: LeavingPose) -> bool:
        return pose.kind is PoseKind.HEADING_OFF and pose.aspect == self.wanted_aspect


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
    Column("queue_seconds", lambda study: study.queue_seconds),
    Column(
        "robust",
        lambda study: (
            values(ROBUST_COLUMNS, study.robust) | {"tolerance_mm": in_unit(study.request.tolerance, "mm")}
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


def _instead(study: DesignStudy, queue: FilledQueue) -> str:
    """Return the poses that left a fill instead of the wanted one, and the option that counts them."""
    if not queue.left_instead:
        return ""
    lines = []
    for pose, count in queue.left_instead[:3]:
        # through which device that should return it
        device = next((cut.device.kind for cut in reversed(study.cuts) if pose.name in cut.returns), "")
        through = f" (through the {device})" if device else ""
        lines.append(f"{pose.text}: {count} of {queue.left}{through}")
    own = study.wanted_aspect
    offer = f" (--up {own} counts {own} at any heading)" if own in study.aspects_heading_off else ""
    return f"; what left instead: {', '.join(lines)}{offer}"


def _asked_for(study: DesignStudy) -> tuple[Attempt, ...]:
    """The trials of what was asked for; where other ways up were tried beside it, those are left out."""
    names = {name.casefold() for name in (*study.request.up, study.request.aspect or "") if name}
    own = [attempt for attempt in study.attempts if attempt.aspect.casefold() in names]
    return tuple(own) or study.attempts
