"""Verdict on a design: whether it holds, where it falls short, and what the cause is; all of it as data.

No sentence is made here, and none is read: ``verdict_texts`` says in words what this module decides.
"""

import enum
from dataclasses import dataclass
from typing import TYPE_CHECKING

from feederscrew.bowl.verified import DRAWS_HELD, HELD, PURE, RATE_KEPT, Status
from feederscrew.designing.fill_verdicts import (
    FillLack,
    FillState,
    judge_fill,
    lacks_of_fill,
    longest_time,
)
from feederscrew.designing.findings import Cause, FaultKind, Hooking
from feederscrew.trials.fills import FilledQueue, LeavingPose, PoseKind

if TYPE_CHECKING:
    from feederscrew.designing.record import Attempt, DesignRequest, DesignStudy, WantedTrials


class Shortage(enum.Enum):
    """In which way a design does not do what was asked, apart from what one of its fills lacks."""

    LOST_IN_TRIALS = enum.auto()  # in the short trials no chain let a wanted orientation pass
    NO_QUEUE = enum.auto()
    JAMS_OF_FILL = enum.auto()  # in a long proof
    JAMS = enum.auto()
    DRAWS = enum.auto()
    MACHINE = enum.auto()  # below the bowl


@dataclass(frozen=True, eq=False)
class Shortfall:
    """One thing in which a design does not do what was asked."""

    kind: Shortage | FillLack
    queue: FilledQueue | None = None  # of the fill, where it is of one
    trials: "WantedTrials | None" = None  # in which an orientation was lost
    machine: str = ""  # what the machine lacks, as its sheet says it


class BlameGround(enum.Enum):
    """Finding from which the cause follows."""

    NO_MACHINE = enum.auto()
    NOT_TOLD_APART = enum.auto()  # no device tells what is wanted from the rest
    FAULTS_OF_TRIAL = enum.auto()
    TOO_SELDOM = enum.auto()  # the wanted orientation comes too rarely
    JAMS = enum.auto()
    NOTHING_ARRIVES = enum.auto()  # at the outlet
    HEADINGS_TURN = enum.auto()
    OTHERS_PASS = enum.auto()
    NO_DEVICE = enum.auto()
    FAULT_OF_DRAWS = enum.auto()
    LITTLE_LEAVES = enum.auto()  # nothing leaves as wanted at the worst fill
    FEW_PARTS = enum.auto()  # to show that it is pure
    NONE_OF_THESE = enum.auto()  # what it lacks is all that is known
    SLOW = enum.auto()


@dataclass(frozen=True, eq=False)
class Blame:
    """Reason why a design does not hold, and the finding from which it follows."""

    cause: Cause = Cause.UNKNOWN
    ground: BlameGround | None = None
    attempt: "Attempt | None" = None  # the best short trial, where it decides


@dataclass(frozen=True, eq=False)
class DesignVerdict:
    """Verdict on a design."""

    status: Status
    tooling_status: Status  # of track and devices alone, whether or not a machine can drive them
    tooling_shortfalls: tuple[Shortfall, ...]
    shortfalls: tuple[Shortfall, ...]  # those of the tooling, then of the machine
    blame: Blame
    hooking: Hooking | None  # how two parts hook together; None if they separate by themselves

    @property
    def conditional(self) -> Hooking | None:
        """The hooking that has to be prevented; None if it holds without, or does not hold."""
        return self.hooking if self.tooling_status == Status.HOLDS_SINGLE else None


def judge_design(study: "DesignStudy") -> DesignVerdict:
    """Return the verdict on a design.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    DesignVerdict
    """
    hooking = next((risk.hooking for risk in study.risks if risk.hooking is not None), None)
    lacks = _tooling_shortfalls(study)
    tooling = _tooling_status(study, bool(lacks), hooking)
    status = Status.NO_MACHINE if tooling in HELD and study.machine_lacks else tooling
    machine = study.machine_lacks if study.bowl is not None else ()
    both = (*lacks, *(Shortfall(Shortage.MACHINE, machine=text) for text in machine))
    return DesignVerdict(status, tooling, lacks, both, _blame(study, status, lacks), hooking)


def _tooling_status(study: "DesignStudy", falls_short: bool, hooking: Hooking | None) -> Status:
    """The verdict of draws and queues; what was stopped, or not run, is no evidence either way."""
    if study.partial or study.request.quick:
        return Status.NOT_PROVED
    if study.bowl is None or not study.proof.delivered[0] > 0.0:
        return Status.FALLS_SHORT if study.bowl is not None and study.proof.queues else Status.NONE
    if falls_short:
        return Status.FALLS_SHORT
    return Status.HOLDS if hooking is None else Status.HOLDS_SINGLE


def fills_of(
    queues: tuple[FilledQueue, ...], request: "DesignRequest", state: FillState
) -> list[FilledQueue]:
    """Return the queues that are judged to be in one state at the rate that is asked for.

    Parameters
    ----------
    queues : tuple of FilledQueue
        One a fill.
    request : DesignRequest
    state : FillState

    Returns
    -------
    list of FilledQueue
    """
    least, longest = RATE_KEPT * request.target, longest_time(request.target)
    return [queue for queue in queues if judge_fill(queue, least, longest) is state]


def _tooling_shortfalls(study: "DesignStudy") -> tuple[Shortfall, ...]:
    """Where draws and queues do not do what was asked."""
    if study.bowl is None:
        return tuple(Shortfall(Shortage.LOST_IN_TRIALS, trials=one) for one in study.wanted_trials[:3])
    proof, lacks = study.proof, list[Shortfall]()
    refused = fills_of(proof.queues, study.request, FillState.REFUSED)
    for queue in refused or fills_of(proof.queues, study.request, FillState.OPEN):
        found = lacks_of_fill(queue, RATE_KEPT * study.request.target)
        lacks += [Shortfall(lack, queue) for lack in found if lack is not FillLack.JAM]  # told together below
    if not proof.queues and proof.robust.share >= DRAWS_HELD:  # draws that fail end a proof
        lacks.append(Shortfall(Shortage.NO_QUEUE))
    if study.request.is_long:
        lacks += [Shortfall(Shortage.JAMS_OF_FILL, queue) for queue in proof.queues if queue.jams]
    elif proof.jams:
        lacks.append(Shortfall(Shortage.JAMS))
    if proof.robust.share < DRAWS_HELD:
        lacks.append(Shortfall(Shortage.DRAWS))
    return tuple(lacks)


def _blame(study: "DesignStudy", status: Status, lacks: tuple[Shortfall, ...]) -> Blame:
    """The cause why a design does not hold; unknown of one that holds or was stopped.

    What its queues show comes first, then its draws, then its short trials.
    """
    if status in (*HELD, Status.NOT_PROVED):
        return Blame()
    if status is Status.NO_MACHINE:
        return Blame(Cause.DRIVE, BlameGround.NO_MACHINE)
    proof = study.proof
    if not proof.queues:  # draws that fail end a proof
        return _blame_of_draws(study) or _blame_of_trials(study)
    if proof.jams:
        return Blame(Cause.DEVICE, BlameGround.JAMS)
    if not proof.delivered[0] > 0.0 and not any(queue.left for queue in proof.queues):
        return Blame(Cause.DRIVE, BlameGround.NOTHING_ARRIVES)
    kinds = {lack.kind for lack in lacks}
    if not proof.purity[0] >= PURE or FillLack.PURITY_REFUSED in kinds:
        off = sum(count for pose, count in proof.left_instead if _is_heading_off(pose, study.wanted_aspect))
        if 2 * off >= sum(count for _, count in proof.left_instead) > 0:
            return Blame(Cause.DRIVE, BlameGround.HEADINGS_TURN)
        if study.devices:
            return Blame(Cause.DEVICE, BlameGround.OTHERS_PASS)
        return Blame(Cause.PART, BlameGround.NO_DEVICE)
    if (drawn := _blame_of_draws(study)) is not None:
        return drawn
    queue = proof.worst_fill
    if queue is None or not queue.right:
        return Blame(Cause.ARRIVAL, BlameGround.LITTLE_LEAVES)
    if proof.delivered[1] < RATE_KEPT * study.request.target:
        return Blame(Cause.ARRIVAL, BlameGround.SLOW)
    if kinds & {FillLack.PURITY_NOT_SHOWN, FillLack.PURITY_OPEN}:
        return Blame(Cause.ARRIVAL, BlameGround.FEW_PARTS)
    return Blame(Cause.UNKNOWN, BlameGround.NONE_OF_THESE)


def _blame_of_draws(study: "DesignStudy") -> Blame | None:
    """The blame taken from the fault that most draws show; None where enough of them sort."""
    robust = study.proof.robust
    fault = robust.main_fault
    if fault is None or robust.share >= DRAWS_HELD:
        return None
    if fault.is_at_device or (fault.kind is FaultKind.CARRIED and study.devices):
        return Blame(Cause.DEVICE, BlameGround.FAULT_OF_DRAWS)
    carried = fault.kind is FaultKind.CARRIED
    return Blame(Cause.PART if carried else Cause.DRIVE, BlameGround.FAULT_OF_DRAWS)


def _blame_of_trials(study: "DesignStudy") -> Blame:
    """The blame taken from the best short trial."""
    if not study.attempts:
        return Blame(Cause.PART, BlameGround.NOT_TOLD_APART)
    best = max(study.attempts_asked_for, key=lambda attempt: (attempt.efficiency, attempt.rate))
    if best.faults:
        return Blame(best.cause or Cause.PART, BlameGround.FAULTS_OF_TRIAL, best)
    return Blame(Cause.ARRIVAL, BlameGround.TOO_SELDOM, best)


def _is_heading_off(pose: LeavingPose, aspect: str) -> bool:
    return pose.kind is PoseKind.HEADING_OFF and pose.aspect == aspect
