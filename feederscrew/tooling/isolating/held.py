"""What holds a part on its round side on the track: a bank towards the wall, or a groove."""

from dataclasses import replace

from feederscrew.tooling.devices.kinds import leaning
from feederscrew.tooling.isolating.chain import DESIGN_KEY
from feederscrew.tooling.isolating.proposal import plain_cut


def stretches(one, wall_friction, before, wishes):
    """Return the stretches of track that hold an orientation which rolls on the level, devices in order.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    one : Orientation
        As it comes.
    wall_friction : float [1]
    before : sequence of Device
        Of the bowl file: where one leans the track already, nothing is added.
    wishes : Wishes

    Returns
    -------
    tuple of Device
        A bank; where it would have to be steep, a groove and a low bank behind it; none where it holds.
    """
    leans = one.track.bank > 0.0 or any(device.leans for device in before)
    if one.kind != "rolling" or leans:
        return ()
    ways = (kind.holding(one, wall_friction, DESIGN_KEY) for kind in leaning())
    return min(_allowed(ways, wishes), key=len, default=())


def others(one, found, wishes):
    """Return other stretches of track that may give an orientation more than a design does, one by one.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    one : Orientation
        As it comes.
    found : Design
        Where it isolates, only what may turn more parts into the orientation is worth another track.
    wishes : Wishes

    Returns
    -------
    list of tuple of Device
    """
    if one.track.bank > 0.0:
        return []
    known = {(cut.device.kind, cut.device.text) for cut in found.cuts}
    ways = _allowed((way for kind in leaning() for way in kind.leanings(one, DESIGN_KEY)), wishes)
    ways = [way for way in ways if (way[0].kind, way[0].text) not in known]
    return sorted((way for way in ways if way[0].grooved or not found.isolated), key=len)


def _allowed(ways, wishes):
    """Those of some ways to lean the track that are any, and whose kinds of devices may be used."""
    return [way for way in ways if way and wishes.allows(*(device.kind for device in way))]


def led_on(every, leaning):
    """Return orientations as they are behind some stretches of track."""
    for device in leaning:
        every = tuple(device.onward(one) for one in every)
    return tuple(every)


def with_stretches(found, leaning):
    """Return a design with those stretches before its own devices."""
    return replace(found, cuts=(*(plain_cut(device) for device in leaning), *found.cuts))
