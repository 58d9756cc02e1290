"""Whether the drive lets a part lie on what a device leaves of its foot."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.geometry.polygons import convex, inset
from feederscrew.mechanics.cycle import phases
from feederscrew.mechanics.floor.balance import HOP
from feederscrew.mechanics.track import balance
from feederscrew.mechanics.track.frame import Seat
from feederscrew.rates.rocking import Rocker, goes_over, over_period
from feederscrew.rates.tipping import FLAT_KIND, landing_energy, may_tip, plain, seated
from feederscrew.tooling import footprints
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.falling import surely_gone
from feederscrew.tooling.orientations import Orientation, gyration, rolls_across, travel_speed

STEADINESS_PHASES = 12  # of one period
LANDINGS = 8  # instants of the period at which it comes to lie on the far edge
SUPPORT_LOSS_TOLERANCE_M = (
    1e-9  # [m] a device that leaves this much less of the support takes nothing from it
)


def steady(devices: Sequence[Device], lying: Sequence[Orientation], bowl: Bowl, margin: float) -> np.ndarray:
    """Return which orientations the drive leaves lying on what a chain of devices leaves of their feet.

    Source: own; docs/trial.md, "What other parts said of the rules".

    Parameters
    ----------
    devices : sequence of Device
        Those up to the first that lets parts hang or turns them over are looked at.
    lying : sequence of Orientation
        M of them, that the devices let pass.
    bowl : Bowl
        Single values.
    margin : float [m]
        By which they shall not rock beside an edge along the track.

    Returns
    -------
    (M,) bool
        True also where that is not known: a drive that is not straight.

    Notes
    -----
    A ledge, a canyon or a slot goes on: there the force of the track has to stay within what is left of the
    foot all through the cycle, as on the bare track, or the part rocks. Over an edge across the track every
    part rocks in the end, since its weight comes near that edge. It is steady if rocking, followed from
    stroke to stroke, does not take it over: ahead where least carries it, however long it stands there, and
    back over the far edge, from which it travels on at the velocity of the point mass. A landing of a part
    that hops must not tip it over what a ledge, a canyon or a slot leaves of its foot, less the margin; over
    an edge across the track the verdict itself is less the flight.
    """
    known, energy = plain(bowl), landing_energy(bowl)
    if energy > 0.0:
        return np.array([_lands(devices, one, bowl, margin, energy) for one in lying], dtype=bool)
    return np.array([not known or _steady(devices, one, bowl, margin) for one in lying], dtype=bool)


def gone(devices: Sequence[Device], lying: Sequence[Orientation], passes: np.ndarray) -> np.ndarray:
    """Return which orientations the first device that does not let them pass is sure to get rid of.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    devices : sequence of Device
    lying : sequence of Orientation
        M of them.
    passes : (M, 1 + D) float [1]
        Share that the track and each device let pass.

    Returns
    -------
    (M,) bool
        True also of what no device returns.
    """
    found = np.ones(len(lying), dtype=bool)
    for row, (one, shares) in enumerate(zip(lying, np.asarray(passes)[:, 1:])):
        first = next((k for k, share in enumerate(shares) if share < 0.5), None)
        if first is not None and not one.returned:
            found[row] = surely_gone(devices[first], one)
    return found


def _steady(devices: Sequence[Device], one: Orientation, bowl: Bowl, margin: float) -> bool:
    """Whether one orientation is steady at every device."""
    if one.returned or one.touching is None:
        return True
    if one.kind != FLAT_KIND and rolls_across(one):
        return not any(_takes(device, one) for device in _met(devices))
    place = seated(one, bowl.track.bank)
    if (balance.motion(place, bowl, phases(STEADINESS_PHASES)).state == HOP).any():
        return True
    force, offset = over_period(place, bowl)
    for device in _met(devices):
        span, hole = device.span_on(one.track), device.hole_on(one.track)
        if span is not None and not _keeps_down(one, span, offset, margin):
            return False
        if hole is not None and not _keeps_upright(one, hole, place, force, offset, bowl):
            return False
    return True


def _lands(devices: Sequence[Device], one: Orientation, bowl: Bowl, margin: float, energy: float) -> bool:
    """Whether no landing may tip an orientation at any device, by a margin [m]."""
    if one.returned or one.touching is None:
        return True
    if one.kind != FLAT_KIND and rolls_across(one):
        return not any(_takes(device, one) for device in _met(devices))
    for device in _met(devices):
        span = device.span_on(one.track)
        if span is not None and _takes(device, one):
            left = footprints.beside(one.foot, span, one.distance, one.track.radius).corners
            if may_tip(left, one, bowl, energy, margin):
                return False
    return True


def _met(devices: Sequence[Device]) -> Iterator[Device]:
    """Those that leave less of a foot, as far as parts come to them as they lie."""
    for device in devices:
        if device.turns or device.hangs:
            break
        if device.carries:
            yield device


def _takes(device: Device, one: Orientation) -> bool:
    """Whether a device takes anything from what carries an orientation."""
    span, hole = device.span_on(one.track), device.hole_on(one.track)
    if span is not None:
        (first, last), radius = span, one.track.radius
        high = radius - first if first > 0.0 else 2.0 * radius
        return (
            footprints.over_ring(one.standing, max(radius - last, 0.0), high)
            <= one.margin - SUPPORT_LOSS_TOLERANCE_M
        )
    return (
        hole is not None and footprints.least(one.standing, hole)[0] <= one.margin - SUPPORT_LOSS_TOLERANCE_M
    )


def _keeps_down(one: Orientation, span: tuple[float, float], offset: np.ndarray, margin: float) -> bool:
    """Whether the force of the track stays within what is left of a foot beside a hole along the track."""
    (first, last), radius = span, one.track.radius
    high = radius - first if first > 0.0 else 2.0 * radius
    if (
        footprints.over_ring(one.standing, max(radius - last, 0.0), high)
        > one.margin - SUPPORT_LOSS_TOLERANCE_M
    ):
        return True
    left = footprints.beside(one.foot, span, one.distance, radius).corners
    hull = left[convex(left)]
    return len(hull) > 2 and bool(inset(hull, offset).min() >= margin)


def _keeps_upright(
    one: Orientation, hole: Any, place: Seat, force: np.ndarray, offset: np.ndarray, bowl: Bowl
) -> bool:
    """Whether a part neither rocks over the edge that it leaves nor back over the one that it comes to."""
    support, _ = footprints.least(one.standing, hole)
    if support > one.margin - SUPPORT_LOSS_TOLERANCE_M:
        return True
    reach, period = one.foot.corners[:, 0], 1.0 / bowl.drive.frequency
    leaving = Rocker(
        near=max(support, 0.0),
        far=float(-reach.min()),
        height=place.height,
        spread=gyration(one, 0.5 * np.pi),
        force=force,
        offset=offset[:, 0],
    )
    coming = replace(leaving, far=float(reach.max()), offset=-offset[:, 0], growth=travel_speed(bowl))
    starts = range(0, len(force), len(force) // LANDINGS)
    return not (goes_over(leaving, period) or any(goes_over(coming, period, start) for start in starts))
