"""The queue at low, normal and high fill, as a buyer accepts a feeder."""

from feederscrew.designing import trying
from feederscrew.designing.record import NORMAL, FilledQueue

FILLS = (("low", 6, 15.0), (NORMAL, 12, 30.0), ("high", 18, 15.0))  # name, parts, seconds


def filled(part, bowl, aspects, known, shares, state, *, seed, told=None):
    """Follow a queue at each fill.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    aspects : Aspects
    known : Orientations
    shares : (M,) float [1]
    state : int
        In which parts are wanted to leave.
    seed : int
    told : callable, optional
        Called with how many periods are done of how many, of each fill.

    Returns
    -------
    tuple of FilledQueue
        Fewer where the user stopped it.
    """
    found = []
    for name, parts, seconds in FILLS:
        try:
            seen = trying.queue(
                part, bowl, aspects, known, shares, parts=parts, seconds=seconds, seed=seed,
                progress=told and told(name),
            )  # fmt: skip
        except KeyboardInterrupt:
            break
        found.append(_told(name, seen, state))
        if seen.partial:
            break
    return tuple(found)


def _told(name, seen, state):
    return FilledQueue(
        fill=name,
        parts=seen.parts,
        seconds=seen.seconds,
        counted=seen.counted,
        delivered=seen.delivered,
        right=int(seen.leaving[state]),
        left=int(seen.leaving.sum()),
        returned=seen.returned,
        jams=seen.jams,
        climbs=seen.climbs,
    )
