"""The sentences that people read of what a design's trials found: made here, and read by no decision."""

from collections import Counter
from collections.abc import Iterable

import numpy as np

from feederscrew.base.units import counted
from feederscrew.bowl.verified import PURE
from feederscrew.designing.fill_verdicts import DifferenceKind, FillDifference
from feederscrew.designing.findings import End, Fault, FaultKind, Hooking, Move, MoveKind, SeldomPart
from feederscrew.sorting.isolating.chain import in_mm
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import JammedParts, LeavingCounts


def end_text(end: End) -> str:
    """Return how and where a part ended: 'returned at gap', 'turned on the track'.

    Parameters
    ----------
    end : End

    Returns
    -------
    str
    """
    place = "on the track" if end.on_bare_track else f"at {end.kind}"
    return f"{end.fate.word.replace('_', ' ')} {place}"


def ends_text(ends: Iterable[End]) -> str:
    """Return how parts ended, each way once.

    Parameters
    ----------
    ends : iterable of End

    Returns
    -------
    str
    """
    return ", ".join(dict.fromkeys(map(end_text, ends)))


def fault_text(fault: Fault) -> str:
    """Return a fault as a sentence: 'A@188 is lost (returned at gap)'.

    Parameters
    ----------
    fault : Fault

    Returns
    -------
    str
    """
    match fault.kind:
        case FaultKind.NOTHING_LEAVES:
            text = "nothing leaves as wanted"
        case FaultKind.LOST:
            text = f"{fault.orientation} is lost ({ends_text(fault.ends) or Fate.TURNED.word})"
        case FaultKind.CARRIED:
            text = f"{fault.orientation} leaves too"
        case FaultKind.STAYS:
            text = f"{fault.orientation} stays ({ends_text(fault.ends)})"
        case FaultKind.NOT_RUN:
            text = fault.reason
        case FaultKind.IMPURE:
            purity, low, high, least = fault.shares
            text = f"{percent(purity, (low, high))} of what leaves is wanted, of {100.0 * least:.3g} %"
    return f"in draws {counted_fault_text(fault, text)}" if fault.draws else text


def counted_fault_text(fault: Fault, text: str = "") -> str:
    """Return a fault with the draws that show it: 'A@188 is lost (...) in 2 of 20'.

    Parameters
    ----------
    fault : Fault
    text : str, optional
        The fault in words; made here without it.

    Returns
    -------
    str
    """
    return f"{text or fault_text(fault.counted_in_draws(0, 0))} in {fault.failures} of {fault.draws}"


def fault_texts(faults: Iterable[Fault], most: int | None = None) -> list[str]:
    """Return faults as sentences.

    Parameters
    ----------
    faults : iterable of Fault
    most : int, optional
        So many, the first ones; all without it.

    Returns
    -------
    list of str
    """
    return [fault_text(fault) for fault in tuple(faults)[:most]]


def wanted_trials_text(
    wanted: str, trials: int, ends: Iterable[End], others: Iterable[Fault], clean_rate: float | None
) -> str:
    """Return what became of one orientation in its trials: 'A@270, 4 trials: lost (returned at gap)'.

    Parameters
    ----------
    wanted : str
        Name of the orientation.
    trials : int
        Short trials in which it was wanted.
    ends : iterable of End
        Where its parts were lost.
    others : iterable of Fault
        What went wrong with other orientations, or with a trial as a whole.
    clean_rate : float [1/s] or None
        Of the fastest of these trials in which nothing went wrong; None where there was none.

    Returns
    -------
    str
    """
    lost = ends_text(ends)
    lines = [f"lost ({lost})"] if lost else fault_texts(others, 2)
    if clean_rate is not None:  # what it lacks is in its draws, its queue or its rate
        lines.append(f"clean, {60.0 * clean_rate:.3g}/min")
    return f"{wanted}, {counted(trials, 'trial')}: {', '.join(lines) or 'nothing leaves as wanted'}"


def percent(value: float, ends: tuple[float, float]) -> str:
    """Return a share in percent, with its interval: '98.2 % (95.1 to 99.4)'.

    Parameters
    ----------
    value : float [1]
    ends : (float, float) [1]

    Returns
    -------
    str
    """
    low, high = (f"{100.0 * end:.3g}" for end in ends)
    return f"{100.0 * value:.4g} % ({low} to {high})"


def move_text(move: Move) -> str:
    """Return a step of the search in words: 'proposed with margins of 0.5 mm'.

    Parameters
    ----------
    move : Move

    Returns
    -------
    str
    """
    match move.kind:
        case MoveKind.PROPOSED:
            return f"proposed with margins of {in_mm(move.value)}"
        case MoveKind.NO_DEVICE:
            return "no device"
        case MoveKind.VALUES_OF_ALL:
            return "the values of all"
        case MoveKind.VALUE:
            return f"{move.device} moved to {move.device_text}"
        case MoveKind.SWEEP:
            return f"{move.device} swept {round(np.degrees(move.value))} deg"
        case MoveKind.WIDER_SLOT:
            return f"slot widened to {in_mm(move.value)}"
        case MoveKind.RAILS:
            return "rails for its head"
        case MoveKind.SLOT_PLACE:
            side = "farther off" if move.value > 0.0 else "nearer to"
            return f"slot {in_mm(abs(move.value))} {side} the wall"
        case MoveKind.LEAD_IN:
            return f"lead-in {move.value:.3g} times as long"
        case MoveKind.BLADE_BEHIND:
            return f"{move.device} of {move.device_text} behind the rails"
        case MoveKind.BLADE_HEIGHT:
            higher = "higher" if move.value > 0.0 else "lower"
            return f"blade behind the rails {in_mm(abs(move.value))} {higher}"
        case MoveKind.CUTS_BEFORE:
            return "cuts before the rails by what hangs in the trial"
        case MoveKind.OTHER_CUTS:
            return "other cuts before the rails, for those at which parts stand"
        case MoveKind.JET_BEFORE:
            return f"{move.device} of {move.device_text} before the rails, for what stands at them"
        case MoveKind.AIR_ASSIST:
            return f"air of {move.device_text} along the face of {move.device}, for what stands at it"
        case MoveKind.LONGER_PULSE:
            return f"pulse of {1e3 * move.value:.0f} ms"
        case MoveKind.DROP_BEFORE:
            return f"{move.device} of {move.device_text} before it"
        case MoveKind.PRESSURE_BREAK:
            return f"{move.device} of {move.device_text} before it, for what backs up"
        case MoveKind.SECOND_SENSOR:
            return f"a second {move.device} behind the first, for what a full track lets past one"
        case MoveKind.SPACING:
            return f"{move.device} of {move.device_text}, for parts that touch"
        case MoveKind.CALMER_DRIVE:
            return f"calmer drive, {1e3 * move.value:.3g} mm peak to peak"
        case MoveKind.LIVELIER_DRIVE:
            return f"livelier drive, {1e3 * move.value:.3g} mm peak to peak"
        case MoveKind.FLATTER_DRIVE:
            return f"drive at a flatter angle, {1e3 * move.value:.3g} mm peak to peak"


MOST_JAMMED = 3  # orientations of which it is said where they stood
SEPARATORS = ("a de-tangling drum", "bursts of air", "a magazine that keeps them single")  # before the bowl


def condition_text(hooking: Hooking) -> str:
    """Return under which condition a bowl holds whose parts hook: what separates them, what to change.

    Parameters
    ----------
    hooking : Hooking

    Returns
    -------
    str
    """
    heap = "" if hooking.heap is None else f"; {hooking.heap.words}"
    return (
        f"two parts hook into each other ({hooking.held} of {counted(hooking.pulls, 'pull')} do not part "
        f"them{heap}), and no queue was tried with parts that hang together; separate them before the bowl "
        f"by {', '.join(SEPARATORS[:-1])} or {SEPARATORS[-1]}; {change_text(hooking)}"
    )


def change_text(hooking: Hooking) -> str:
    """Return what to change on a part so that two of them do not hook.

    Parameters
    ----------
    hooking : Hooking

    Returns
    -------
    str
    """
    limb = in_mm(hooking.section)
    if np.isfinite(hooking.opening):
        return (
            f"on the part, close its mouth of {in_mm(hooking.opening)} to less than the {limb} of its "
            "thinnest limb, or make that limb thicker than the mouth"
        )
    return f"on the part, close its openings, or make them narrower than its thinnest limb, {limb}"


def seldom_text(seldom: SeldomPart) -> str:
    """Return that an orientation leaves or stays too, from which share on that matters, and its share.

    Parameters
    ----------
    seldom : SeldomPart

    Returns
    -------
    str
    """
    own = f"{100.0 * seldom.share:.2g} % of the parts come so, {100.0 * seldom.share_high:.2g} % at the most"
    of = counted(seldom.parts, "part")
    if seldom.break_even is None:
        stays = f"({seldom.held} of {of} tried)"
        return f"{seldom.orientation} stands at a device and blocks the track {stays}; {own}"
    return (
        f"{seldom.orientation} leaves too ({seldom.left} of {of} tried): from "
        f"{100.0 * seldom.break_even:.2g} % of {seldom.orientation} on, purity is below "
        f"{100.0 * PURE:.3g} %; {own}"
    )


def difference_text(difference: FillDifference) -> str:
    """Return a fill that is worse than the others, with its cause, as a sentence.

    Parameters
    ----------
    difference : FillDifference

    Returns
    -------
    str
    """
    d = difference
    counts = f"{d.right} of {d.total} parts", f"{d.right_elsewhere} of {d.total_elsewhere}"
    chance = f"p = {d.chance:.1g}, Fisher's exact test"
    place = f"at the {d.device}" if d.device else "on the bare track"
    match d.kind:
        case DifferenceKind.PURITY:
            text = f"at {d.fill} fill {counts[0]} that left are as wanted, elsewhere {counts[1]} ({chance})"
            if d.pose is None:
                return text
            through = f", past the {d.device}" if d.device else ""
            return f"{text}: {d.pose.text} leaves there ({d.count}{through})"
        case DifferenceKind.YIELD:
            text = f"at {d.fill} fill {counts[0]} leave as wanted, elsewhere {counts[1]} ({chance})"
            if not d.count:
                return f"{text}: fewer come as wanted there"
            return f"{text}: parts that came as wanted fall back {place} ({d.count})"


def jammed_text(jammed: Iterable[JammedParts]) -> str:
    """Return what stood in queues and was taken out: ' (came as B@0, stood at rails: 2)'.

    Parameters
    ----------
    jammed : iterable of JammedParts

    Returns
    -------
    str
        '' of nothing.
    """
    counts = Counter[str]()
    for some in jammed:
        where = f"at {some.kind}" if some.kind else "on the track"
        counts[f"came as {some.name}, stood {where}"] += some.parts
    words = ", ".join(f"{text}: {number}" for text, number in counts.most_common(MOST_JAMMED))
    return f" ({words})" if words else ""


def leaving_texts(counts: LeavingCounts) -> dict[str, int]:
    """Return how many parts left in each pose, by its text.

    Parameters
    ----------
    counts : LeavingCounts

    Returns
    -------
    dict of str to int
        The most first.
    """
    return {pose.text: count for pose, count in counts}
