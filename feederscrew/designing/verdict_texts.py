"""The verdict on a design in sentences, for people; no decision reads them."""

from typing import TYPE_CHECKING

from feederscrew.base.units import HOUR, MINUTE, counted, digits_text, rounded_down
from feederscrew.bowl.verified import HELD, PURE, RATE_KEPT, SHOWN_PURITY
from feederscrew.designing import texts
from feederscrew.designing.evidence import rate_at_most, share_at_least
from feederscrew.designing.fill_verdicts import GOOD_PURITY, FillLack
from feederscrew.designing.verdict import Blame, BlameGround, Shortage, Shortfall
from feederscrew.trials.fills import FilledQueue, PoseKind
from feederscrew.trials.queue_counts import MAX_QUEUE_DEPTH_M

if TYPE_CHECKING:
    from feederscrew.designing.record import DesignStudy, WantedTrials


def condition_text(study: "DesignStudy") -> str:
    """Return the condition under which a design holds, as a sentence; '' of one without, or that does not."""
    hooking = study.verdict.conditional
    return "" if hooking is None else texts.condition_text(hooking)


def proved_so_far(study: "DesignStudy") -> tuple[str, ...]:
    """Return what was counted until now, a sentence each; of a stopped design it decides nothing."""
    if study.bowl is None:
        return (f"{counted(len(study.attempts), 'short trial')} made, none of a design was proved",)
    robust, queues = study.proof.robust, study.proof.queues
    draws = f"{robust.held} of {counted(robust.draws, 'draw')} sort, {study.request.draws} are asked for"
    lines = [draws if robust.draws else "no draw was tried"]
    for queue in queues:
        end = "was stopped after" if queue.partial else "was followed for"
        parts = f"{queue.right} of {counted(queue.left, 'part')} left as wanted"
        jams = counted(queue.jams, "jam")
        lines.append(f"the queue at {queue.fill} fill {end} {queue.seconds:.3g} s: {parts}, {jams}")
    return (*lines, *(() if queues else ("no queue was followed",)))


def why_text(study: "DesignStudy") -> str:
    """Return where a design falls short, why, and the nearest that holds; of one that holds its condition."""
    if study.status in HELD:
        return condition_text(study)
    if study.partial:
        return "; ".join(("stopped before all was tried", *proved_so_far(study)))
    if study.request.quick:
        return "; ".join(("a quick look, without draws and queues", *proved_so_far(study)))
    return "; ".join((reasons_text(study), *(() if study.nearest is None else (study.nearest.text,))))


def reasons_text(study: "DesignStudy") -> str:
    """Return where a design falls short, and the cause; '' of one that holds or was stopped."""
    return "; ".join(reason_lines(study))


def reason_lines(study: "DesignStudy") -> tuple[str, ...]:
    """Return the same, a sentence each, none of them twice."""
    cause = study.verdict.blame.cause
    if study.verdict.blame.ground is None:
        return ()
    sentence = blame_text(study, study.verdict.blame)
    differences = map(texts.difference_text, study.differences)
    lines = dict.fromkeys((*shortfall_texts(study), *differences))
    if not cause:  # what it lacks says all that is known
        return tuple(lines)
    # a cause that was said already is named alone
    named = f"the cause is the {cause}"
    return (*lines, f"{named}: {sentence}" if sentence and sentence not in lines else named)


def shortfall_texts(study: "DesignStudy") -> tuple[str, ...]:
    """Return where a design does not do what was asked, a sentence each: its tooling, then its machine."""
    return tuple(shortfall_text(study, one) for one in study.verdict.shortfalls)


def trials_text(one: "WantedTrials") -> str:
    """Return what became of one orientation in its short trials: 'A@270, 4 trials: lost (...)'."""
    return texts.wanted_trials_text(one.wanted, one.trials, one.ends, one.others, one.clean_rate)


def shortfall_text(study: "DesignStudy", lack: Shortfall) -> str:
    """Return one shortfall of a design as a sentence.

    Parameters
    ----------
    study : DesignStudy
    lack : Shortfall
        Of its verdict.

    Returns
    -------
    str
    """
    if lack.queue is not None:
        return _text_of_fill(study, lack.kind, lack.queue)
    proof = study.proof
    if lack.kind is Shortage.LOST_IN_TRIALS and lack.trials is not None:
        return trials_text(lack.trials)
    if lack.kind is Shortage.NO_QUEUE:
        return "no queue was followed"
    if lack.kind is Shortage.JAMS:
        stood = texts.jammed_text(row for queue in proof.queues for row in queue.jammed)
        return f"{counted(proof.jams, 'jam')} in {proof.queue_seconds:.3g} s of queue{stood}"
    if lack.kind is Shortage.DRAWS:
        fault = "" if proof.robust.main_fault is None else f": {proof.robust.main_fault_text}"
        drawn = f"{proof.robust.held} of {proof.robust.draws}"
        return f"{drawn} draws of part, friction and drive sort{fault}"
    return lack.machine


def _text_of_fill(study: "DesignStudy", kind: Shortage | FillLack, queue: FilledQueue) -> str:
    """A shortfall of the queue at one fill."""
    minute, (low, high), target = 60.0, queue.ends, study.request.target
    at = f"at {queue.fill} fill"
    match kind:
        case FillLack.OVERLAP:
            return (
                f"{at} {counted(queue.overlaps, 'part')} stood more than {1e3 * MAX_QUEUE_DEPTH_M:g} mm deep "
                "in another part or in the track: a fault of the trial, which shows no jam and excludes none"
            )
        case FillLack.RATE:
            return (
                f"{at} {minute * queue.rate:.3g}/min are delivered (95 % interval {minute * low:.3g} to "
                f"{minute * high:.3g}), {minute * target:.3g}/min are asked for"
            )
        case FillLack.PURITY:
            return (
                f"{at} the purity is {100.0 * queue.right / queue.left:.3g} % ({queue.right} of "
                f"{counted(queue.left, 'part')}), {100.0 * PURE:.3g} % are asked for{_instead(study, queue)}"
            )
        case FillLack.PURITY_NOT_SHOWN:
            shown = 100.0 * share_at_least(queue.right, queue.left)
            return (
                f"{at} {queue.right} of {counted(queue.left, 'part')} left as wanted, which shows a purity "
                f"of {shown:.3g} % (lower bound, 95 %, one-sided), and more than "
                f"{100.0 * SHOWN_PURITY:.3g} % have to be shown"
            )
        case FillLack.PURITY_REFUSED | FillLack.PURITY_OPEN:
            says = "refuses" if kind is FillLack.PURITY_REFUSED else "has not yet decided for"
            return (
                f"{at} {queue.right} of {counted(queue.left, 'part')} left as wanted: the sequential test "
                f"{says} a purity of {100.0 * GOOD_PURITY:.3g} % against {100.0 * SHOWN_PURITY:.3g} %"
                f"{_instead(study, queue)}"
            )
        case Shortage.JAMS_OF_FILL:
            shown, agreed = HOUR * rate_at_most(queue.jams, queue.seconds), HOUR * study.request.agreed_jams
            return (
                f"{at} {counted(queue.jams, 'jam')} in {queue.seconds / MINUTE:.3g} min: "
                f"fewer than {digits_text(shown)} an hour are shown (upper bound, 95 %, one-sided), and "
                f"{digits_text(agreed)} an hour are agreed"
            )
    return f"{at} parts were followed for {queue.seconds:.3g} s only"


def _instead(study: "DesignStudy", queue: FilledQueue) -> str:
    """The poses that left a fill instead of the wanted one, and the option that counts them."""
    if not queue.left_instead:
        return ""
    lines = []
    for pose, count in queue.left_instead[:3]:
        # through which device that should return it
        device = next((cut.device.kind for cut in reversed(study.cuts) if pose.name in cut.returns), "")
        through = f" (through the {device})" if device else ""
        lines.append(f"{pose.text}: {count} of {queue.left}{through}")
    own = study.wanted_aspect
    is_off = any(pose.kind is PoseKind.HEADING_OFF and pose.aspect == own for pose, _ in queue.left_instead)
    offer = f" (--up {own} counts {own} at any heading)" if is_off else ""
    return f"; what left instead: {', '.join(lines)}{offer}"


def blame_text(study: "DesignStudy", blame: Blame) -> str:
    """Return the finding from which a cause follows, as a sentence; '' where it was said already.

    Parameters
    ----------
    study : DesignStudy
    blame : Blame
        Of its verdict.

    Returns
    -------
    str
    """
    proof, best = study.proof, blame.attempt
    chain = ", ".join(device.kind for device in study.devices) or "the track"
    match blame.ground:
        case BlameGround.NO_MACHINE:
            return "the machine below it cannot be made; its track and devices hold"
        case BlameGround.NOT_TOLD_APART:
            return "no device tells an orientation that was asked for from the others"
        case BlameGround.FAULTS_OF_TRIAL if best is not None and study.bowl is not None:
            return f"{best.wanted}: {', '.join(texts.fault_texts(best.faults, 2))}"  # else said of each
        case BlameGround.TOO_SELDOM if best is not None:
            return (
                f"{best.wanted} comes too seldom: {60.0 * best.rate:.3g}/min at the most - ask for less, "
                "or let other aspects count with --up"
            )
        case BlameGround.JAMS:
            return f"parts stand at {chain} and have to be taken out"
        case BlameGround.NOTHING_ARRIVES:
            return "no part came to the outlet in its queues"
        case BlameGround.HEADINGS_TURN:
            return f"it turns {study.wanted} to other headings in a queue"
        case BlameGround.OTHERS_PASS:
            return f"what is not wanted gets through {chain} in a queue"
        case BlameGround.NO_DEVICE:
            return "without a device nothing tells what is wanted from the rest"
        case BlameGround.FAULT_OF_DRAWS:
            return proof.robust.main_fault_text
        case BlameGround.LITTLE_LEAVES:
            return "too little of what is wanted leaves its queues"
        case BlameGround.FEW_PARTS:
            return "too few parts left its queues to show that it is pure"
        case BlameGround.SLOW if (queue := proof.worst_fill) is not None:
            share, need = queue.right / queue.offered, study.request.target / queue.pace
            other = f", or a part of which {100.0 * need:.3g} % come so" if need <= 1.0 else ""
            return (
                f"at {queue.fill} fill {60.0 * queue.pace:.3g} parts a minute come along, and "
                f"{100.0 * share:.3g} % of them leave as {study.wanted}: "
                f"{rounded_down(MINUTE * proof.delivered[1] / RATE_KEPT):.4g}/min would hold{other}"
            )
    return ""
