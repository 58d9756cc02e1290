"""The track as part of a design: level, banked or a groove that holds what rolls, and how wide."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.tooling.devices.kinds import leaning, names
from feederscrew.tooling.fates import at_entry, course
from feederscrew.tooling.isolating.chain import DESIGN_KEY, values_around
from feederscrew.tooling.isolating.design import PURITY_GAIN, design
from feederscrew.tooling.isolating.proposal import LEAST_SHARE, plain_cut
from feederscrew.tooling.orientations import place
from feederscrew.tooling.verdicts import DeviceEncounter


def holding_stretches(orientation, wall_friction, before, constraints):
    """Return the stretches of track that hold an orientation which rolls on the level, devices in order.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    orientation : Orientation
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
    leans = orientation.track.bank > 0.0 or any(device.leans for device in before)
    if orientation.kind != "rolling" or leans:
        return ()
    stretches = (kind.holding(orientation, wall_friction, DESIGN_KEY) for kind in leaning())
    return min(_allowed(stretches, constraints), key=len, default=())


def other_stretches(orientation, proposal, constraints) -> list[Any]:
    """Return other stretches of track that may give an orientation more than a design does, one by one.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    orientation : Orientation
        As it comes.
    proposal : Design
        Where it isolates, only what may turn more parts into the orientation is worth another track.
    constraints : DesignConstraints

    Returns
    -------
    list of tuple of Device
    """
    if orientation.track.bank > 0.0:
        return []
    present = {(cut.device.kind, cut.device.text) for cut in proposal.cuts}
    stretches = _allowed(
        (stretch for kind in leaning() for stretch in kind.leanings(orientation, DESIGN_KEY)), constraints
    )
    stretches = [stretch for stretch in stretches if (stretch[0].kind, stretch[0].text) not in present]
    return sorted((stretch for stretch in stretches if stretch[0].grooved or not proposal.isolated), key=len)


def _allowed(stretches, constraints) -> list[Any]:
    """Those of some ways to lean the track that are any, and whose kinds of devices may be used."""
    return [
        stretch
        for stretch in stretches
        if stretch and constraints.allows(*(device.kind for device in stretch))
    ]


def led_on(orientations, leaning) -> tuple[Any, ...]:
    """Return orientations as they are behind some stretches of track."""
    for device in leaning:
        orientations = tuple(device.onward(orientation) for orientation in orientations)
    return tuple(orientations)


def with_stretches(proposal, leaning):
    """Return a design with those stretches before its own devices."""
    return replace(proposal, cuts=(*(plain_cut(device) for device in leaning), *proposal.cuts))


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


def design_with_track(orientations, shares, wanted, bowl, *, steady, cache=None, **options):
    """Return the design of an orientation, on the track as it is or as it leans best.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    orientations : sequence of Orientation
    shares : (M,) float [1]
    wanted : int
    bowl : Bowl
    steady : callable
        Given devices, orientations, a bowl and a margin: whether the drive leaves them lying.
    cache : dict, optional
        Of orientations on tracks that lean, kept for other designs of the same part.
    **options
        As of ``design``: margin, search, goal, before and constraints.

    Returns
    -------
    Design
    """
    cache = {} if cache is None else cache
    best = _held(orientations, shares, wanted, bowl, steady, cache, options)
    if not options["constraints"].vary or options["before"] or orientations[wanted].returned:
        return best
    constraints = options["constraints"]
    # on tracks that lean
    quick = replace(constraints, turn=False, without=(*constraints.without, *names(searched=True)))
    there = bowl, steady, cache, options | {"constraints": quick}
    for stretch in other_stretches(orientations[wanted], best, constraints):
        other = _leaning(orientations, shares, wanted, stretch, there, quick=True)
        if gains(other, best):
            whole = _leaning(orientations, shares, wanted, stretch, there)
            best = whole if gains(whole, best) and whole.steady >= best.steady else best
    return best


def _held(orientations, shares, wanted, bowl, steady, cache, options):
    """The design of an orientation; one that rolls on the level comes on a bank or out of a groove."""
    leaning = holding_stretches(
        orientations[wanted], bowl.friction.wall, options["before"], options["constraints"]
    )
    if leaning:
        proposal = _on_this_track(_led(orientations, leaning, cache), shares, wanted, bowl, steady, options)
        if proposal.isolated or proposal.cuts:
            return with_stretches(proposal, leaning)
    return _on_this_track(orientations, shares, wanted, bowl, steady, options)


def _leaning(orientations, shares, wanted, leaning, there, quick=False):
    """The design on a track that leans, by what comes on so; ``quick``: what is not looked for in full."""
    bowl, steady, cache, options = there
    behind, come = _led(orientations, leaning, cache), coming(orientations, shares, leaning)
    if not come[wanted] > 0.0:
        return None
    if quick:
        proposal = design(behind, come, wanted, **options)
    else:
        proposal = _on_this_track(behind, come, wanted, bowl, steady, options)
    proposal = replace(proposal, efficiency=proposal.efficiency * float(come.sum() / shares.sum()))
    return with_stretches(proposal, leaning if proposal.cuts else leaning[:1])


def _led(orientations, leaning, cache):
    """Orientations behind some stretches of track, from a cache of those made before."""
    key = tuple((device.kind, device.angle) for device in leaning)
    if key not in cache:
        cache[key] = led_on(orientations, leaning)
    return cache[key]


def coming(orientations, shares, leaning):
    """Return the share (M,) [1] of the parts that comes in each orientation behind stretches of track.

    What rolls back in a groove before it turns does not come.
    """
    there = at_entry(orientations, leaning)
    flow, flat = course(leaning, there), leaning[0].grooved and leaning[0].angle < MAX_GROOVE_FACE_RAD - 1e-9
    comes = np.array([0.0 if flat and orientation.may_roll_back else 1.0 for orientation in there])
    return (comes[:, None] * np.asarray(shares)[:, None] * flow.leaving).sum(axis=0)[: len(orientations)]


def gains(other, best):
    """Return whether a design gives more than another: it isolates, is purer, or more efficient."""
    if other is None or other.isolated != best.isolated:
        return other is not None and other.isolated
    pure, before = (np.nan_to_num(orientation.purity) for orientation in (other, best))
    if abs(pure - before) > PURITY_GAIN:
        return bool(pure > before)
    return other.efficiency > LEAN_GAIN * best.efficiency


def widths(orientations, shares, wanted, margin):
    """Return other widths [m] of the track that may give more, the nearest to it first.

    Source: own; docs/tooling.md, "What a design takes".

    Parameters
    ----------
    orientations : sequence of Orientation
    shares : (M,) float [1]
    wanted : int
    margin : float [m]

    Returns
    -------
    list of float [m]
        Wide enough for an orientation that falls off; so narrow that the pulse of a sorter carries off it
        what stays on a wider one.
    """
    orientation, widths = orientations[wanted], []
    if orientation.falls_off:
        widths.append(WHOLE * math.ceil((orientation.width + BESIDE) / WHOLE))
    sensors = [
        kind(DESIGN_KEY, like=(orientation.aspect, orientation.heading, float(margin)))
        for kind in values_around()
    ]
    competitors = [k for k, share in enumerate(shares) if share >= LEAST_SHARE and k != wanted]
    blown = [orientations[k] for k in competitors if not orientations[k].returned]
    distances = [_blown(sensor, other, orientations) for sensor in sensors for other in blown]
    narrow = WHOLE * math.floor(min(distances, default=math.inf) / WHOLE) if distances else math.inf
    least = max(orientation.width, orientation.balcony) + BESIDE
    if np.isfinite(orientation.balcony) and least <= narrow < orientation.track.width:
        widths.append(narrow)
    return widths


def _blown(sensor, orientation, orientations):
    """How far from the wall [m] the pulse of a sensor's nozzles carries an orientation."""
    encounter = DeviceEncounter(orientation, orientations)
    outwards, down = sensor.jet.push(orientation, orientations)
    return orientation.track.width + encounter.blown(outwards, down, sensor.time)


def _on_this_track(orientations, shares, wanted, bowl, steady, options):
    """The design of an orientation that the drive leaves lying on what is cut; if there is none, said so."""

    def stays(proposal):
        lying = [orientations[proposal.wanted]]
        return not proposal.cuts or bool(steady(proposal.devices, lying, bowl, options["margin"])[0])

    proposal = _isolating(orientations, shares, wanted, **options)
    if stays(proposal):
        return proposal
    cut = any(cut.device.corners for cut in proposal.cuts)
    options = options | {"constraints": replace(options["constraints"], gentle=True)}
    gentle = proposal if cut else _isolating(orientations, shares, wanted, **options)
    same = (gentle.isolated, gentle.efficiency, gentle.purity) == (
        proposal.isolated, proposal.efficiency, proposal.purity,
    )  # fmt: skip
    if same and stays(gentle):
        return gentle
    reason = ROCKS.format(orientations[wanted].name)
    return replace(proposal, steady=False, remarks=(*proposal.remarks, reason))


def _isolating(orientations, shares, wanted, **options):
    """The design for parts that travel; where none isolates, one for parts that are placed, and said so."""
    proposal = design(orientations, shares, wanted, **options)
    if proposal.isolated or not any(orientation.carry > 0.0 for orientation in orientations):
        return proposal
    options["constraints"] = replace(options["constraints"], vary=False)
    still = design(place(orientations), shares, wanted, **options)
    return replace(still, remarks=(*still.remarks, TRACK_REMARK)) if still.isolated else proposal
