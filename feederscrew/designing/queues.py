"""The queue at low, normal and high fill, as a buyer accepts a feeder."""

from feederscrew.designing import trying
from feederscrew.designing.record import NORMAL, PURE, FilledQueue

FILLS = (("low", 6, 20.0), (NORMAL, 12, 60.0), ("high", 18, 20.0))  # name, parts, seconds


def filled(part, bowl, aspects, known, shares, states, *, seed, whole=True, told=None):
    """Follow a queue at each fill.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    aspects : Aspects
    known : Orientations
    shares : (M,) float [1]
    states : sequence of int
        In which parts are wanted to leave.
    seed : int
    whole : bool
        Whether it goes on after a fill that jams or is not pure.
    told : callable, optional
        Called with what is being followed, a sentence.

    Returns
    -------
    tuple of FilledQueue
        Fewer where the user stopped it, or where one does not hold.
    """
    found = []
    for name, parts, seconds in FILLS:
        if told:
            told(f"queue of {parts} at {name} fill, {seconds:g} s")
        seen = trying.queue(
            part, bowl, aspects, known, shares, states, parts=parts, seconds=seconds, seed=seed
        )
        found.append(_told(name, seen, states))
        if seen.partial or not (whole or _holds(found[-1])):
            break
    return tuple(found)


def _holds(one):
    """Whether a fill may be one of a design that holds."""
    return not one.jams and one.right >= PURE * one.left - 1


def _told(name, seen, states):
    return FilledQueue(
        fill=name,
        parts=seen.parts,
        seconds=seen.seconds,
        counted=seen.counted,
        delivered=seen.delivered,
        right=int(sum(seen.leaving[k] for k in states)),
        left=int(seen.leaving.sum()),
        returned=seen.returned,
        jams=seen.jams,
        climbs=seen.climbs,
        partial=seen.partial,
    )
