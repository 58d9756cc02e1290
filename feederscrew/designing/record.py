"""What is asked of a design, and what it stands on."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import DRAWS_HELD, FALLS_SHORT, HOLDS, PURE, RATE_KEPT
from feederscrew.designing.hazards.risks import Risk
from feederscrew.dropping.ensemble import wilson
from feederscrew.machine.feasibility import DriveMismatch
from feederscrew.part.record import Part
from feederscrew.part.smallness import small_part_remarks
from feederscrew.records import Shown
from feederscrew.resting.rules.registry import require_rule
from feederscrew.running import RunSettings
from feederscrew.studies.tooling import ToolingStudy, listed
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.isolating.design import MARGIN
from feederscrew.trial.result import TrialRun
from feederscrew.units import counted

OUTCOMES = ("any", "lying", "hanging")
NONE, NOT_PROVED = "none", "not proved"


@dataclass(frozen=True)
class DesignRequest:
    """What shall leave a bowl, and what the search for it may use."""

    target: float  # [1/s]
    aspect: str | None = None
    heading: float | None = None  # [rad]
    up: tuple[str, ...] = ()  # aspects that count as the one wanted, whatever their heading
    outcome: str = "any"  # of OUTCOMES
    without: tuple[str, ...] = ()  # kinds of device that shall not be used
    diameter: tuple[float, float] | None = None  # [m] least and greatest
    rule: str = "recommended"
    tolerance: float = 1e-4  # [m] of the part's size, to either side
    budget: int = 16  # short trials
    draws: int = 20
    seed: int = 1
    jobs: int = 1

    @property
    def run(self) -> RunSettings:
        """Return how its trials and draws run."""
        return RunSettings(self.seed, self.jobs)

    def __post_init__(self) -> None:
        check.of_an_aspect(self.aspect, self.heading)
        require_rule(self.rule)
        for name in ("up", "without"):  # names may come as a text
            object.__setattr__(self, name, listed(getattr(self, name)))


@dataclass(frozen=True)
class Attempt:
    """One short trial of the loop: what was tried, and what came of it."""

    wanted: str  # 'A@2'
    chain: tuple[str, ...]  # 'gap: 9.5 mm'
    step: str  # why it was tried: 'proposed', 'gap nearer to A@2', 'margin 0.5 mm'
    bank: float  # [rad]
    velocity: float  # [m/s]
    parts: int
    efficiency: float  # [1]
    purity: float  # [1] NaN where nothing leaves
    stopped: float  # [1] share of the parts offered that stay at a device
    rate: float  # [1/s] that it would deliver
    faults: tuple[str, ...]  # 'C@66 is stopped at profile'

    @property
    def clean(self) -> bool:
        """Whether only what is wanted leaves and nothing stays."""
        return self.efficiency > 0.0 and not self.faults


@dataclass(frozen=True)
class RobustRun:
    """Draws of part, friction, drive and cuts; each tried with some parts."""

    draws: int
    held: int
    worst: str  # what went wrong most often; '' where nothing did
    slowest: float = np.nan  # [m/s] velocity of the slowest draw
    partial: bool = False

    @property
    def share(self) -> float:
        """Share of the draws that sort [1]; 0 of none."""
        return self.held / self.draws if self.draws else 0.0


@dataclass(frozen=True)
class FilledQueue:
    """What a queue did at one fill."""

    fill: str  # 'low', 'normal', 'high'
    gaps: float  # [1] mean free way between parts as they come, over their length
    parts: int
    seconds: float  # [s] followed
    counted: float  # [s] of them since the first part came to the outlet
    delivered: float  # parts that left
    right: int  # of the whole ones those in the wanted orientation
    left: int  # whole ones that left
    returned: int
    jams: int
    climbs: int
    partial: bool = False  # stopped by the user

    @property
    def rate(self) -> float:
        """Wanted parts [1/s]."""
        if not self.counted > 0.0 or not self.left:
            return 0.0
        return self.delivered / self.counted * self.right / self.left

    @property
    def ends(self) -> tuple[float, float]:
        """95 % interval of that rate [1/s]: of the share of what is offered that leaves right."""
        if not self.pace > 0.0:
            return 0.0, 0.0
        low, high = (float(end[0]) for end in wilson([self.right], self.offered))
        return self.pace * low, self.pace * high

    @property
    def offered(self) -> int:
        """Whole parts of which something became."""
        return self.left + self.returned

    @property
    def pace(self) -> float:
        """Parts [1/s] that are offered; 0 where none leaves as wanted."""
        return self.rate * self.offered / self.right if self.right else 0.0


@dataclass(frozen=True, eq=False)
class DesignStudy(Shown):
    """A bowl for a part and a rate, with everything that was tried on the way."""

    part: Part
    request: DesignRequest
    bowl: Bowl | None  # None where there is none
    wanted: str | None  # orientation that leaves: 'A@2', 'hanging'
    turn: int | None  # its place among the orientations
    cuts: tuple = ()  # of Cut: the chain with the values it may have
    before: tuple[Device, ...] = ()
    attempts: tuple[Attempt, ...] = ()
    robust: RobustRun = field(default_factory=lambda: RobustRun(0, 0, ""))
    queues: tuple[FilledQueue, ...] = ()
    risks: tuple[Risk, ...] = ()
    nearest: tuple[str, ...] = ()  # what would hold instead
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

    @property
    def devices(self) -> tuple[Device, ...]:
        """Every device along the track."""
        return () if self.bowl is None else self.bowl.devices

    @property
    def outcome(self) -> str:
        """Whether what leaves lies on the track or hangs by its head."""
        hangs = any(one.hangs for one in self.devices)
        return self.request.outcome if self.bowl is None else "hanging" if hangs else "lying"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each."""
        allowances = {"margin": MARGIN, "tolerance": self.request.tolerance}
        width = None if self.bowl is None else self.bowl.track.width
        remarks = small_part_remarks(self.part, allowances, width)
        return (*self.part.warnings, *remarks, *self.machine_warnings)

    @property
    def slowest(self) -> FilledQueue | None:
        """The queue to which parts come most slowly: the lowest of fill; None without one."""
        return min(self.queues, key=lambda one: one.pace, default=None)

    @property
    def delivered(self) -> tuple[float, float, float]:
        """Wanted parts [1/s] at the fill that brings least: value, low and high end.

        The share that leaves as wanted is that of all fills; the pace at which parts come is that fill's.
        """
        if self.slowest is None or not self.slowest.pace > 0.0:
            return 0.0, 0.0, 0.0
        right, offered = (sum(getattr(one, k) for one in self.queues) for k in ("right", "offered"))
        low, high = (float(end[0]) for end in wilson([right], offered))
        pace = self.slowest.pace
        return pace * (right / offered), pace * low, pace * high

    @property
    def worst(self) -> float:
        """Wanted parts [1/s] at the fill that brings least and at the worst friction."""
        return self.delivered[0] * self.slowed

    @property
    def purity(self) -> tuple[float, float]:
        """Share of the wanted orientation in what left all queues [1], and its lower end; NaN of nothing."""
        right, left = (sum(getattr(one, name) for one in self.queues) for name in ("right", "left"))
        if not left:
            return np.nan, 0.0
        return right / left, float(wilson([right], left)[0][0])

    @property
    def jams(self) -> int:
        """Parts that had to be taken out of the queues."""
        return sum(one.jams for one in self.queues)

    @property
    def queue_seconds(self) -> float:
        """Time that queues were followed [s]."""
        return float(sum(one.seconds for one in self.queues))

    @property
    def jams_per_hour_high(self) -> float:
        """Upper end of the jams an hour: three more than were seen, in the time they were looked for."""
        return 3600.0 * (self.jams + 3.0) / self.queue_seconds if self.queue_seconds else np.inf

    @property
    def trial_parts(self) -> int:
        """How many parts were tried one at a time."""
        return sum(one.parts for one in self.attempts)

    @property
    def status(self) -> str:
        """One of four words; what the user stopped is no evidence, neither for a design nor against it."""
        if self.partial:
            return NOT_PROVED
        if self.bowl is None or not self.delivered[0] > 0.0:
            return FALLS_SHORT if self.bowl is not None and self.queues else NONE
        return HOLDS if not self.shortfalls else FALLS_SHORT

    @property
    def proved_so_far(self) -> tuple[str, ...]:
        """What was counted until now, a sentence each; of a design that was stopped it decides nothing."""
        if self.bowl is None:
            return (f"{counted(len(self.attempts), 'short trial')} made, none of a design was proved",)
        robust = self.robust
        draws = f"{robust.held} of {counted(robust.draws, 'draw')} sort, {self.request.draws} are asked for"
        return (draws if robust.draws else "no draw was tried", *_followed(self.queues))

    @property
    def delivers(self) -> bool:
        """Whether any wanted part has left its queues, and it was not stopped: what may be built from."""
        return self.bowl is not None and not self.partial and self.delivered[0] > 0.0

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Where it does not do what was asked, a sentence each."""
        return tuple(_shortfalls(self))

    @property
    def why(self) -> str:
        """Why it does not hold: where it falls short and the nearest that would hold; '' where it holds."""
        if self.status == HOLDS:
            return ""
        if self.partial:
            return "; ".join(("stopped before all was tried", *self.proved_so_far))
        return "; ".join((*self.shortfalls, *self.nearest)) or "no orientation gets through its own trial"


def _followed(queues: tuple[FilledQueue, ...]) -> Iterator[str]:
    """What each queue has shown so far."""
    if not queues:
        yield "no queue was followed"
    for one in queues:
        end = "was stopped after" if one.partial else "was followed for"
        parts = f"{one.right} of {counted(one.left, 'part')} left as wanted"
        yield f"the queue at {one.fill} fill {end} {one.seconds:.3g} s: {parts}, {counted(one.jams, 'jam')}"


def _shortfalls(study: DesignStudy) -> Iterator[str]:
    minute, (purity, _) = 60.0, study.purity
    low = study.delivered[1]
    if study.bowl is None:
        for one in study.attempts[:3]:
            yield f"{one.wanted}: {', '.join(one.faults[:3]) or 'nothing leaves'}"
        return
    if low < RATE_KEPT * study.request.target:
        yield (
            f"delivers {minute * study.delivered[0]:.3g}/min (at least {minute * low:.3g}) of the "
            f"{minute * study.request.target:.3g}/min asked for"
        )
    for queue in study.queues:
        if queue.ends[1] < RATE_KEPT * study.request.target:
            yield (
                f"at {queue.fill} fill {minute * queue.rate:.3g}/min are delivered (at most "
                f"{minute * queue.ends[1]:.3g})"
            )
    if not purity >= PURE:
        text = "nothing left the queue" if np.isnan(purity) else f"purity {100.0 * purity:.3g} %"
        yield f"{text}, {100.0 * PURE:.3g} % are asked for"
    if study.jams:
        yield f"{counted(study.jams, 'jam')} in {study.queue_seconds:.3g} s of queue"
    if study.robust.share < DRAWS_HELD:
        worst = f": {study.robust.worst}" if study.robust.worst else ""
        yield f"{study.robust.held} of {study.robust.draws} draws of part, friction and drive sort{worst}"
    yield from study.machine_lacks
