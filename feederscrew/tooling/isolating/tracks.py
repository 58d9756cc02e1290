"""The track as part of a design: level, banked or a groove that holds what rolls, and how wide."""

import math
from dataclasses import replace

import numpy as np

from feederscrew.tooling.devices.kinds import leaning, names
from feederscrew.tooling.fates import at_entry, course
from feederscrew.tooling.isolating.chain import DESIGN_KEY, values_around
from feederscrew.tooling.isolating.design import PURITY_GAIN, design
from feederscrew.tooling.isolating.proposal import LEAST_SHARE, plain_cut
from feederscrew.tooling.orientations import place
from feederscrew.tooling.verdicts import DeviceEncounter


def holding_stretches(one, wall_friction, before, constraints):
    """Return the stretches of track that hold an orientation which rolls on the level, devices in order.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    one : Orientation
        As it comes.
    wall_friction : float [1]
    before : sequence of Device
        Of the bowl file: where one leans the track already, nothing is added.
    constraints : DesignConstraints

    Returns
    -------
    tuple of Device
        A bank; where it would have to be steep, a groove and a low bank behind it; none where it holds.
    """
    leans = one.track.bank > 0.0 or any(device.leans for device in before)
    if one.kind != "rolling" or leans:
        return ()
    ways = (kind.holding(one, wall_friction, DESIGN_KEY) for kind in leaning())
    return min(_allowed(ways, constraints), key=len, default=())


def other_stretches(one, found, constraints):
    """Return other stretches of track that may give an orientation more than a design does, one by one.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    one : Orientation
        As it comes.
    found : Design
        Where it isolates, only what may turn more parts into the orientation is worth another track.
    constraints : DesignConstraints

    Returns
    -------
    list of tuple of Device
    """
    if one.track.bank > 0.0:
        return []
    known = {(cut.device.kind, cut.device.text) for cut in found.cuts}
    ways = _allowed((way for kind in leaning() for way in kind.leanings(one, DESIGN_KEY)), constraints)
    ways = [way for way in ways if (way[0].kind, way[0].text) not in known]
    return sorted((way for way in ways if way[0].grooved or not found.isolated), key=len)


def _allowed(ways, constraints):
    """Those of some ways to lean the track that are any, and whose kinds of devices may be used."""
    return [way for way in ways if way and constraints.allows(*(device.kind for device in way))]


def led_on(every, leaning):
    """Return orientations as they are behind some stretches of track."""
    for device in leaning:
        every = tuple(device.onward(one) for one in every)
    return tuple(every)


def with_stretches(found, leaning):
    """Return a design with those stretches before its own devices."""
    return replace(found, cuts=(*(plain_cut(device) for device in leaning), *found.cuts))


TRACK_REMARK = (
    "quasi-static: at the bowl's speed a part may be carried over a cut that returns it, laid over by a "
    "blade or wedged between rails - see feeder trial"
)
ROCKS = (
    "{} may rock on what these cuts leave below it, and no safer value lies between the limits - try it "
    "with feeder trial"
)
# [rad] of a groove in which what rolls across it turns along it first. In trials of a dowel 4 of 4 did at 55
# and 60 deg, 2 of 4 at 50; at 15 and 30 deg 12 of 12 rolled back
MAX_GROOVE_FACE_RAD = math.radians(55.0)
LEAN_GAIN = 1.05  # times the efficiency for which a track leans that need not
BESIDE, WHOLE = 1e-3, 1e-3  # [m] that a track is wider than what lies on it, and the step of its width


def design_with_track(every, shares, wanted, bowl, *, steady, cache=None, **asked):
    """Return the design of an orientation, on the track as it is or as it leans best.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    every : sequence of Orientation
    shares : (M,) float [1]
    wanted : int
    bowl : Bowl
    steady : callable
        Given devices, orientations, a bowl and a margin: whether the drive leaves them lying.
    cache : dict, optional
        Of orientations on tracks that lean, kept for other designs of the same part.
    **asked
        As of ``design``: margin, search, goal, before and constraints.

    Returns
    -------
    Design
    """
    cache = {} if cache is None else cache
    best = _held(every, shares, wanted, bowl, steady, cache, asked)
    if not asked["constraints"].vary or asked["before"] or every[wanted].returned:
        return best
    constraints = asked["constraints"]
    # on tracks that lean
    quick = replace(constraints, turn=False, without=(*constraints.without, *names(searched=True)))
    there = bowl, steady, cache, asked | {"constraints": quick}
    for stretch in other_stretches(every[wanted], best, constraints):
        other = _leaning(every, shares, wanted, stretch, there, quick=True)
        if gains(other, best):
            whole = _leaning(every, shares, wanted, stretch, there)
            best = whole if gains(whole, best) and whole.steady >= best.steady else best
    return best


def _held(every, shares, wanted, bowl, steady, cache, asked):
    """The design of an orientation; one that rolls on the level comes on a bank or out of a groove."""
    leaning = holding_stretches(every[wanted], bowl.friction.wall, asked["before"], asked["constraints"])
    if leaning:
        found = _on_this_track(_led(every, leaning, cache), shares, wanted, bowl, steady, asked)
        if found.isolated or found.cuts:
            return with_stretches(found, leaning)
    return _on_this_track(every, shares, wanted, bowl, steady, asked)


def _leaning(every, shares, wanted, leaning, there, quick=False):
    """The design on a track that leans, by what comes on so; ``quick``: what is not looked for in full."""
    bowl, steady, cache, asked = there
    behind, come = _led(every, leaning, cache), coming(every, shares, leaning)
    if not come[wanted] > 0.0:
        return None
    if quick:
        found = design(behind, come, wanted, **asked)
    else:
        found = _on_this_track(behind, come, wanted, bowl, steady, asked)
    found = replace(found, efficiency=found.efficiency * float(come.sum() / shares.sum()))
    return with_stretches(found, leaning if found.cuts else leaning[:1])


def _led(every, leaning, cache):
    """Orientations behind some stretches of track, from a cache of those made before."""
    key = tuple((device.kind, device.angle) for device in leaning)
    if key not in cache:
        cache[key] = led_on(every, leaning)
    return cache[key]


def coming(every, shares, leaning):
    """Return the share (M,) [1] of the parts that comes in each orientation behind stretches of track.

    What rolls back in a groove before it turns does not come.
    """
    there = at_entry(every, leaning)
    flow, flat = course(leaning, there), leaning[0].grooved and leaning[0].angle < MAX_GROOVE_FACE_RAD - 1e-9
    comes = np.array([0.0 if flat and one.may_roll_back else 1.0 for one in there])
    return (comes[:, None] * np.asarray(shares)[:, None] * flow.leaving).sum(axis=0)[: len(every)]


def gains(other, best):
    """Return whether a design gives more than another: it isolates, is purer, or more efficient."""
    if other is None or other.isolated != best.isolated:
        return other is not None and other.isolated
    pure, before = (np.nan_to_num(one.purity) for one in (other, best))
    if abs(pure - before) > PURITY_GAIN:
        return bool(pure > before)
    return other.efficiency > LEAN_GAIN * best.efficiency


def widths(every, shares, wanted, margin):
    """Return other widths [m] of the track that may give more, the nearest to it first.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    every : sequence of Orientation
    shares : (M,) float [1]
    wanted : int
    margin : float [m]

    Returns
    -------
    list of float [m]
        Wide enough for an orientation that falls off; so narrow that the pulse of a sorter carries off it
        what stays on a wider one.
    """
    one, found = every[wanted], []
    if one.falls_off:
        found.append(WHOLE * math.ceil((one.width + BESIDE) / WHOLE))
    sensors = [kind(DESIGN_KEY, like=(one.aspect, one.heading, float(margin))) for kind in values_around()]
    others = [k for k, share in enumerate(shares) if share >= LEAST_SHARE and k != wanted]
    blown = [every[k] for k in others if not every[k].returned]
    ways = [_blown(sensor, other, every) for sensor in sensors for other in blown]
    narrow = WHOLE * math.floor(min(ways, default=math.inf) / WHOLE) if ways else math.inf
    least = max(one.width, one.balcony) + BESIDE
    if np.isfinite(one.balcony) and least <= narrow < one.track.width:
        found.append(narrow)
    return found


def _blown(sensor, one, every):
    """How far from the wall [m] the pulse of a sensor's nozzles carries an orientation."""
    met = DeviceEncounter(one, every)
    outwards, down = sensor.jet.push(one, every)
    return one.track.width + met.blown(outwards, down, sensor.time)


def _on_this_track(every, shares, wanted, bowl, steady, asked):
    """The design of an orientation that the drive leaves lying on what is cut; if there is none, said so."""

    def stays(found):
        lying = [every[found.wanted]]
        return not found.cuts or bool(steady(found.devices, lying, bowl, asked["margin"])[0])

    found = _isolating(every, shares, wanted, **asked)
    if stays(found):
        return found
    cut = any(one.device.corners for one in found.cuts)
    asked = asked | {"constraints": replace(asked["constraints"], gentle=True)}
    gentle = found if cut else _isolating(every, shares, wanted, **asked)
    same = (gentle.isolated, gentle.efficiency, gentle.purity) == (
        found.isolated, found.efficiency, found.purity,
    )  # fmt: skip
    if same and stays(gentle):
        return gentle
    said = ROCKS.format(every[wanted].name)
    return replace(found, steady=False, reasons=(*found.reasons, said))


def _isolating(every, shares, wanted, **asked):
    """The design for parts that travel; where none isolates, one for parts that are placed, and said so."""
    found = design(every, shares, wanted, **asked)
    if found.isolated or not any(one.carry > 0.0 for one in every):
        return found
    asked["constraints"] = replace(asked["constraints"], vary=False)
    still = design(place(every), shares, wanted, **asked)
    return replace(still, reasons=(*still.reasons, TRACK_REMARK)) if still.isolated else found
