"""What becomes of every orientation along a chain of devices: one matrix a device."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from feederscrew import check
from feederscrew.bowl.devices import unfit
from feederscrew.tooling import footprints
from feederscrew.tooling.devices.base import CARRIED, RETURNED, STOPPED, Device, Verdict
from feederscrew.tooling.falling import surely_gone
from feederscrew.tooling.orientations import Hanging, Orientation, hang
from feederscrew.tooling.verdicts import DeviceEncounter, verdict


@dataclass(frozen=True, eq=False)
class DeviceFlow:
    """Parts along a chain of D devices; M orientations that lie, S states with those that hang as well."""

    states: tuple[Orientation, ...]  # (S,) the M orientations, then what hangs between rails
    verdicts: tuple[tuple[Verdict | None, ...], ...]  # (D, S) None for a state that none is in yet
    matrices: np.ndarray  # (D, S, S) [1] share that goes on from a row's state in a column's
    starts: np.ndarray  # (M,) [1] share that the bare track carries
    devices: tuple[Device, ...]  # (D,) in the order parts meet them
    came: tuple[tuple[Orientation, ...], ...]  # (D,) the states as they are at each device

    @cached_property
    def leaving(self):
        """(M, S) [1] share of each orientation that leaves in each state."""
        return check.frozen(self._reached[-1])

    @cached_property
    def passes(self):
        """(M, 1 + D) [1] share that the track and each device let on, of those that come to it."""
        reached, found = self._reached, [self.starts]
        for step, matrix in enumerate(self.matrices):
            there, on = reached[step].sum(axis=1), reached[step + 1].sum(axis=1)
            alone = matrix[: len(self.starts)].sum(axis=1)
            found.append(np.where(there > 0.0, on / np.where(there > 0.0, there, 1.0), alone))
        return check.frozen(np.column_stack(found))

    @cached_property
    def margins(self):
        """(M, 1 + D) [m] by which most of it passes or fails each device; NaN: not known."""
        rows, reached = np.arange(len(self.starts)), self._reached
        found = [np.full(len(rows), np.nan)]
        for step, shown in enumerate(self.verdicts):
            most = np.where(reached[step].sum(axis=1) > 0.0, reached[step].argmax(axis=1), rows)
            found.append(np.array([np.nan if shown[k] is None else shown[k].margin for k in most]))
        return check.frozen(np.column_stack(found))

    @cached_property
    def decided(self):
        """(M,) bool, whether statics tells what every device that it comes to does with it."""
        found = np.ones(len(self.starts), bool)
        for reached, shown in zip(self._reached, self.verdicts):
            moved = np.array([one is not None and not one.decided for one in shown])
            found &= ~(reached[:, moved] > 0.0).any(axis=1)
        return check.frozen(found)

    @cached_property
    def ends(self):
        """(M, 2, 1 + D) [1] share that the track and each device return, and that they stop."""
        count, reached = len(self.starts), self._reached
        found = np.zeros((count, 2, 1 + len(self.devices)))
        found[:, 0, 0] = 1.0 - self.starts
        for step, device in enumerate(self.devices):
            lost = reached[step] * np.array(
                [0.0 if k is None else 1.0 - k.passes for k in self.verdicts[step]]
            )
            for state in np.flatnonzero((lost > 0.0).any(axis=0)):
                met = DeviceEncounter(self.came[step][state], self.came[0][:count])
                found[:, int(device.fate(met) == STOPPED), 1 + step] += lost[:, state]
        return check.frozen(found)

    @cached_property
    def doubtful(self):
        """(M,) [1] share of each orientation that leaves as well where no verdict is sure to return it."""
        reached = self.starts[:, None] * np.eye(len(self.starts), len(self.states))
        for step, (matrix, shown) in enumerate(zip(self.matrices, self.verdicts)):
            unsure = [one is not None and self._may_stay(step, k, one) for k, one in enumerate(shown)]
            ways = np.where(np.array(unsure)[:, None], np.eye(len(matrix)), matrix)
            reached = np.einsum("ms,st->mt", reached, ways)
        return check.frozen(np.maximum(reached.sum(axis=1) - self.leaving.sum(axis=1), 0.0))

    def _may_stay(self, step, state, shown):
        """Whether a device is not sure to return a state that it does not let pass, nor to stop it."""
        if shown.passes >= 1.0:
            return False
        device, one = self.devices[step], self.came[step][state]
        if one.along_a_bank:  # off the wall, where a device may miss it
            return True
        stands = one.grip <= 0.0 or device.fate(DeviceEncounter(one, self.came[0])) == STOPPED
        return not shown.sure or not (stands or surely_gone(device, one))

    @property
    def stops(self):
        """(M, 1 + D) [1] share of each orientation that stands before each device."""
        return self.ends[:, 1]

    @cached_property
    def fates(self):
        """(M,) str, what becomes of most of each orientation: carried, returned or stopped."""
        shares = np.column_stack([self.leaving.sum(axis=1), self.ends.sum(axis=2)])
        return tuple((CARRIED, RETURNED, STOPPED)[k] for k in np.round(shares, 9).argmax(axis=1))

    def leaves_as(self, row):
        """Return the state in which an orientation is fed: its own, or how it hangs if none leaves lying."""
        becomes = int(self.leaving[row].argmax())
        return row if self.leaving[:, row].any() or becomes < len(self.starts) else becomes

    @cached_property
    def _reached(self):
        """(1 + D) arrays (M, S) [1]: share of each orientation that comes on in each state."""
        reached = [self.starts[:, None] * np.eye(len(self.starts), len(self.states))]
        for matrix in self.matrices:
            reached.append(np.einsum("ms,st->mt", reached[-1], matrix))
        return reached


def course(devices, every, sigma=0.0, rows=None):
    """Return what becomes of every orientation along a chain of devices.

    Source: a chain of conditional shares; docs/tooling.md, "1. The method".

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    every : sequence of Orientation
        Of the part.
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    rows : sequence of int, optional
        Those that are followed, with what they become; the others count as if they did not come.

    Returns
    -------
    DeviceFlow

    Raises
    ------
    ConfigError
        If a device means nothing behind rails, or in a groove.
    """
    for fault in unfit(devices):
        raise fault
    every = tuple(every)
    states, here = list(every), list(every)  # `here`: as they are at this device, a slot below them or not
    starts = [float(not one.returned and (rows is None or k in rows)) for k, one in enumerate(every)]
    ways: list[list] = []  # a list a device, a tuple of Way an orientation
    verdicts, came = [], []
    for device in devices:
        came.append(tuple(here))
        asked = _followed(ways, len(here), rows)
        listed = [verdict(device, one, every, sigma) if k in asked else None for k, one in enumerate(here)]
        ways.append([
            _way(device, k, one, found, states) if found else ()
            for k, (one, found) in enumerate(zip(here, listed))
        ])  # fmt: skip
        verdicts.append(listed)
        here = [device.onward(one) for one in here] + states[len(here) :]
        if device.hangs:
            here = [astride(one, device.span) for one in here]
    return DeviceFlow(
        states=tuple(states),
        verdicts=tuple(tuple(listed + [None] * (len(states) - len(listed))) for listed in verdicts),
        matrices=check.frozen(_matrices(ways, len(states))),
        devices=tuple(devices),
        came=tuple(came),
        starts=check.frozen(np.array(starts)),
    )


def _followed(ways, count, rows):
    """The states (set of int) in which some rows come to the next device; all where None are given."""
    if rows is None:
        return set(range(count))
    found = set(rows)
    for way in ways:
        found = {onto for k in found for onto, share in way[k] if share > 0.0}
    return found


def at_entry(every, devices):
    """Return orientations as they come: where devices that lean the track come first, they begin there."""
    for device in leading(devices):
        every = tuple(device.onward(one) for one in every)
    return tuple(every)


def leading(devices):
    """Return the devices that come first and lean the track from its entry on, up to the end of a groove."""
    found, grooved = [], False
    for device in devices:
        if not device.leans or (grooved and device.grooved is False):
            break
        found.append(device)
        grooved = grooved or bool(device.grooved)
    return tuple(found)


def _way(device, place, one, found, states):
    """Where a state goes on from a device: (place, share) of what passes; new hanging states are added."""
    if found.onto:
        return [(onto, share) for onto, share in found.onto if not states[onto].returned]
    if not found.hangs:
        return [(place, found.passes)]
    known = [other for other in states if isinstance(other, Hanging)]
    down = hang(one, device.span, known)
    if down not in states:
        states.append(down)
    return [(states.index(down), found.passes)]


def _matrices(ways, count):
    out = np.zeros((len(ways), count, count))
    for matrix, rows in zip(out, ways):
        for place, row in enumerate(rows):
            for onto, share in row:
                matrix[place, onto] += share
    return out


def astride(one, span):
    """Return an orientation over the rails' slot, which goes on: lying, it stands on what is beside it."""
    if isinstance(one, Hanging) or one.falls_off:
        return one
    foot = footprints.beside(one.foot, span, one.distance, one.track.radius)
    if not len(foot.corners):  # it fell
        return one
    over = replace(one)
    vars(over)["foot"] = foot  # a cached property of its own
    return over
