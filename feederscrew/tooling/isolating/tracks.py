"""The track as part of a design: level, banked or a groove that holds what rolls, and how wide."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.tooling.devices.kinds import leaning, names
from feederscrew.tooling.fates import at_entry, course
from feederscrew.tooling.isolating.chain import DESIGN_KEY, values_around
from feederscrew.tooling.isolating.design import PURITY_GAIN, design
from feederscrew.tooling.isolating.proposal import LEAST_SHARE, Design, plain_cut
from feederscrew.tooling.orientations import place
from feederscrew.tooling.verdicts import DeviceEncounter

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


def design_with_track(orientations, shares, wanted, bowl, *, steady, cache=None, **options) -> Design:
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
    """
    cache, constraints = {} if cache is None else cache, options["constraints"]

    def behind(stretch) -> tuple[Any, ...]:
        """Orientations behind some stretches of track."""
        key = tuple((device.kind, device.angle) for device in stretch)
        if key not in cache:
            onward = orientations
            for device in stretch:
                onward = tuple(device.onward(orientation) for orientation in onward)
            cache[key] = onward
        return cache[key]

    def on_stretch(stretch, finding) -> Design | None:
        """The design on a track that leans, by what comes on so."""
        come = coming(orientations, shares, stretch)
        if not come[wanted] > 0.0:
            return None
        proposal = finding(behind(stretch), come)
        proposal = replace(proposal, efficiency=proposal.efficiency * float(come.sum() / shares.sum()))
        return _with_stretches(proposal, stretch if proposal.cuts else stretch[:1])

    def whole(lying, come) -> Design:
        return _on_this_track(lying, come, wanted, bowl, steady, options)

    # what rolls on the level comes on a bank or out of a groove
    best, holding = (
        None,
        holding_stretches(orientations[wanted], bowl.friction.wall, options["before"], constraints),
    )
    if holding:
        proposal = whole(behind(holding), shares)
        best = _with_stretches(proposal, holding) if proposal.isolated or proposal.cuts else None
    best = best or whole(orientations, shares)
    if not constraints.vary or options["before"] or orientations[wanted].returned:
        return best
    # other tracks that lean: quickly, without what is by far the longest search; in full where that gains
    quick = replace(constraints, turn=False, without=(*constraints.without, *names(searched=True)))
    for stretch in other_stretches(orientations[wanted], best, constraints):
        other = on_stretch(
            stretch, lambda lying, come: design(lying, come, wanted, **options | {"constraints": quick})
        )
        if gains(other, best):
            other = on_stretch(
                stretch,
                lambda lying, come: _on_this_track(
                    lying, come, wanted, bowl, steady, options | {"constraints": quick}
                ),
            )
            best = other if other is not None and gains(other, best) and other.steady >= best.steady else best
    return best


def holding_stretches(orientation, wall_friction, before, constraints) -> tuple[Any, ...]:
    """Return the stretches of track that hold an orientation which rolls on the level, devices in order.

    A bank; where it would have to be steep, a groove and a low bank behind it; none where the orientation, as
    it comes, holds or a device ``before`` leans the track already. ``wall_friction`` [1] is that of the wall.

    Source: own; docs/tooling.md, "What a design takes".
    """
    leans = orientation.track.bank > 0.0 or any(device.leans for device in before)
    if orientation.kind != "rolling" or leans:
        return ()
    stretches = (kind.holding(orientation, wall_friction, DESIGN_KEY) for kind in leaning())
    return min(_allowed(stretches, constraints), key=len, default=())


def other_stretches(orientation, proposal, constraints) -> list[Any]:
    """Return other stretches of track, devices in order, that may give an orientation more than a Design.

    Where that isolates, only what may turn more parts into the orientation is worth another track.

    Source: own; docs/tooling.md, "What a design takes".
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
    """Those that are any, and whose kinds of devices may be used."""
    return [one for one in stretches if one and constraints.allows(*(device.kind for device in one))]


def _with_stretches(proposal, stretch) -> Design:
    """A design with those stretches before its own devices."""
    return replace(proposal, cuts=(*map(plain_cut, stretch), *proposal.cuts))


def coming(orientations, shares, stretch) -> np.ndarray:
    """Return the share (M,) [1] of the parts that comes in each orientation behind stretches of track.

    What rolls back in a groove before it turns does not come.
    """
    there = at_entry(orientations, stretch)
    flow, flat = course(stretch, there), stretch[0].grooved and stretch[0].angle < MAX_GROOVE_FACE_RAD - 1e-9
    comes = np.array([0.0 if flat and orientation.may_roll_back else 1.0 for orientation in there])
    return (comes[:, None] * np.asarray(shares)[:, None] * flow.leaving).sum(axis=0)[: len(orientations)]


def gains(other, best) -> bool:
    """Return whether a design gives more than another: it isolates, is purer, or more efficient."""
    if other is None or other.isolated != best.isolated:
        return other is not None and other.isolated
    pure, before = (np.nan_to_num(proposal.purity) for proposal in (other, best))
    if abs(pure - before) > PURITY_GAIN:
        return bool(pure > before)
    return other.efficiency > LEAN_GAIN * best.efficiency


def widths(orientations, shares, wanted, margin) -> list[float]:
    """Return other widths [m] of the track that may give the wanted one more, the nearest to it first.

    Wide enough for an orientation that falls off; so narrow that the pulse of a sorter carries off it what
    stays on a wider one. ``shares`` (M,) [1] are those of the orientations, ``margin`` [m] that of the
    design.

    Source: own; docs/tooling.md, "What a design takes".
    """
    own, widths = orientations[wanted], []
    if own.falls_off:
        widths.append(WHOLE * math.ceil((own.width + BESIDE) / WHOLE))
    sensors = [kind(DESIGN_KEY, like=(own.aspect, own.heading, float(margin))) for kind in values_around()]
    competitors = [k for k, share in enumerate(shares) if share >= LEAST_SHARE and k != wanted]
    others = [orientations[k] for k in competitors if not orientations[k].returned]
    narrow = math.inf  # how far from the wall the pulse of each sensor's nozzles carries each of the others
    for sensor in sensors:
        for other in others:
            out, down = sensor.jet.push(other, orientations)
            blown = DeviceEncounter(other, orientations).blown(out, down, sensor.time)
            narrow = min(narrow, other.track.width + blown)
    narrow = WHOLE * math.floor(narrow / WHOLE) if narrow < math.inf else narrow
    least = max(own.width, own.balcony) + BESIDE
    if np.isfinite(own.balcony) and least <= narrow < own.track.width:
        widths.append(narrow)
    return widths


def _on_this_track(orientations, shares, wanted, bowl, steady, options) -> Design:
    """The design of an orientation that the drive leaves lying on what is cut; if there is none, said so."""

    def stays(proposal) -> bool:
        lying = [orientations[proposal.wanted]]
        return not proposal.cuts or bool(steady(proposal.devices, lying, bowl, options["margin"])[0])

    proposal = _isolating(orientations, shares, wanted, options)
    if stays(proposal):
        return proposal
    gentle = proposal
    if not any(cut.device.corners for cut in proposal.cuts):
        eased = options | {"constraints": replace(options["constraints"], gentle=True)}
        gentle = _isolating(orientations, shares, wanted, eased)
    first, second = ((one.isolated, one.efficiency, one.purity) for one in (gentle, proposal))
    if first == second and stays(gentle):
        return gentle
    reason = ROCKS.format(orientations[wanted].name)
    return replace(proposal, steady=False, remarks=(*proposal.remarks, reason))


def _isolating(orientations, shares, wanted, options) -> Design:
    """The design for parts that travel; where none isolates, one for parts that are placed, and said so."""
    proposal = design(orientations, shares, wanted, **options)
    if proposal.isolated or not any(orientation.carry > 0.0 for orientation in orientations):
        return proposal
    options = options | {"constraints": replace(options["constraints"], vary=False)}
    still = design(place(orientations), shares, wanted, **options)
    return replace(still, remarks=(*still.remarks, TRACK_REMARK)) if still.isolated else proposal
