"""Fates of every orientation along a chain of devices: one matrix a device."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import cast

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats
from feederscrew.bowl.device_list import unfit
from feederscrew.bowl.devices.base import CARRIED, RETURNED, STOPPED, Device, Verdict
from feederscrew.bowl.devices.trade import Action
from feederscrew.sorting import footprints
from feederscrew.sorting.falling import surely_gone
from feederscrew.sorting.orientations import Hanging, Orientation, hang, may_hang
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

SAME_HEADING_RAD = np.radians(5.0)  # [rad] poses on one aspect that are turned by less are one


@dataclass(frozen=True, eq=False)
class DeviceFlow:
    """Parts along a chain of D devices; M orientations that lie, S states with those that hang as well."""

    states: tuple[Orientation, ...]  # (S,) the M orientations, then what hangs between rails
    verdicts: tuple[tuple[Verdict | None, ...], ...]  # (D, S) None for a state that none is in yet
    matrices: Floats  # (D, S, S) [1] share that goes on from a row's state in a column's
    starts: Floats  # (M,) [1] share that the bare track carries
    devices: tuple[Device, ...]  # (D,) in the order parts meet them
    came: tuple[tuple[Orientation, ...], ...]  # (D,) the states as they are at each device
    # the state in which each row hangs at the last rails, if it comes to hang; of those that may
    hangs_as: dict[int, int] = field(default_factory=dict)

    @cached_property
    def leaving(self) -> Floats:
        """Return the share of each orientation that leaves in each state, (M, S) [1]."""
        return check.frozen(self._reached[-1])

    @cached_property
    def passes(self) -> Floats:
        """(M, 1 + D) [1] share that the track and each device let on, of those that come to it."""
        reached, shares = self._reached, [self.starts]
        for step, matrix in enumerate(self.matrices):
            there, on = reached[step].sum(axis=1), reached[step + 1].sum(axis=1)
            alone = matrix[: len(self.starts)].sum(axis=1)
            shares.append(np.where(there > 0.0, on / np.where(there > 0.0, there, 1.0), alone))
        return check.frozen(np.column_stack(shares))

    @cached_property
    def margins(self) -> Floats:
        """(M, 1 + D) [m] by which most of it passes or fails each device; NaN: not known."""
        rows, reached = np.arange(len(self.starts)), self._reached
        columns = [np.full(len(rows), np.nan)]
        for step, verdicts in enumerate(self.verdicts):
            most = np.where(reached[step].sum(axis=1) > 0.0, reached[step].argmax(axis=1), rows)
            columns.append(np.array([np.nan if verdicts[k] is None else verdicts[k].margin for k in most]))
        return check.frozen(np.column_stack(columns))

    @cached_property
    def decided(self) -> Bools:
        """(M,) bool, whether statics tells what every device that it comes to does with it."""
        sure = np.ones(len(self.starts), bool)
        for reached, verdicts in zip(self._reached, self.verdicts):
            moved = np.array([verdict is not None and not verdict.decided for verdict in verdicts])
            sure &= ~(reached[:, moved] > 0.0).any(axis=1)
        return check.frozen(sure)

    @cached_property
    def ends(self) -> Floats:
        """(M, 2, 1 + D) [1] share that the track and each device return, and that they stop."""
        count, shares = len(self.starts), np.zeros((len(self.starts), 2, 1 + len(self.devices)))
        shares[:, 0, 0] = 1.0 - self.starts
        for step, device in enumerate(self.devices):
            returned = np.array([0.0 if k is None else 1.0 - k.passes for k in self.verdicts[step]])
            lost = self._reached[step] * returned
            for state in np.flatnonzero((lost > 0.0).any(axis=0)):
                encounter = DeviceEncounter(self.came[step][state], self.came[0][:count])
                shares[:, int(device.fate(encounter) == STOPPED), 1 + step] += lost[:, state]
        return check.frozen(shares)

    @cached_property
    def doubtful(self) -> Floats:
        """(M,) [1] share of each orientation that leaves as well where no verdict is sure to return it."""
        reached = self._reached[0]
        for step, (matrix, verdicts) in enumerate(zip(self.matrices, self.verdicts)):
            device, unsure = self.devices[step], np.zeros(len(verdicts), bool)
            for k, outcome in enumerate(verdicts):
                if outcome is None or outcome.passes >= 1.0:
                    continue
                orientation = self.came[step][k]
                if orientation.along_a_bank or not outcome.sure:  # off the wall a device may miss it
                    unsure[k] = True
                elif orientation.grip > 0.0 and not surely_gone(device, orientation):
                    unsure[k] = device.fate(DeviceEncounter(orientation, self.came[0])) != STOPPED
            stays = np.where(unsure[:, None], np.eye(len(matrix)), matrix)
            reached = np.einsum("ms,st->mt", reached, stays)
        return check.frozen(np.maximum(reached.sum(axis=1) - self.leaving.sum(axis=1), 0.0))

    @property
    def stops(self) -> Floats:
        """(M, 1 + D) [1] share of each orientation that stands before each device."""
        return self.ends[:, 1]

    @cached_property
    def fates(self) -> tuple[str, ...]:
        """(M,) what becomes of most of each orientation: carried, returned or stopped."""
        shares = np.column_stack([self.leaving.sum(axis=1), self.ends.sum(axis=2)])
        return tuple((CARRIED, RETURNED, STOPPED)[k] for k in np.round(shares, 9).argmax(axis=1))

    def leaves_as(self, row: int) -> int:
        """Return the state in which an orientation is fed: its own, or how it hangs if none leaves lying.

        Parameters
        ----------
        row : int
            Of the orientation.

        Returns
        -------
        int
            Of ``states``.
        """
        becomes = int(self.leaving[row].argmax())
        if row in self.hangs_as and not self.leaving[row].any():
            return self.hangs_as[row]
        return row if self.leaving[:, row].any() or becomes < len(self.starts) else becomes

    @cached_property
    def _reached(self) -> list[Floats]:
        """(1 + D) arrays (M, S) [1]: share of each orientation that comes on in each state."""
        reached = [self.starts[:, None] * np.eye(len(self.starts), len(self.states))]
        for matrix in self.matrices:
            reached.append(np.einsum("ms,st->mt", reached[-1], matrix))
        return reached


def course(
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    sigma: float = 0.0,
    rows: Iterable[int] | None = None,
) -> DeviceFlow:
    """Return what becomes of every orientation along a chain of devices.

    Each device is a matrix of the shares that go on from a state in another; the chain is their product.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    orientations : sequence of Orientation
        The M of the part.
    sigma : float [m], optional
        Standard deviation of play and tolerance together, of every device.
    rows : iterable of int, optional
        Orientations that are followed, with what they become; the others count as if they did not come. All
        without it.

    Returns
    -------
    DeviceFlow

    Raises
    ------
    ConfigError
        If a device means nothing behind rails, or in a groove.

    References
    ----------
    A chain of conditional shares; docs/tooling.md, "1. The method".
    """
    for fault in unfit(devices):
        raise fault
    orientations = tuple(orientations)
    states, here = list(orientations), list(orientations)  # `here`: as they are at this device
    starts = [float(not o.returned and (rows is None or k in rows)) for k, o in enumerate(orientations)]
    followed = range(len(states)) if rows is None else set(rows)  # the states in which some come
    transitions: list[list] = []  # a list a device, of each orientation (place, share) of what goes on
    verdicts, came, hangs_as = [], [], dict[int, int]()
    for device in devices:
        came.append(tuple(here))
        outcomes: list[Verdict | None] = [
            verdict(device, o, orientations, sigma) if k in followed else None for k, o in enumerate(here)
        ]
        onward = []
        for k, outcome in enumerate(outcomes):
            place = k
            # a state of its own, also of what a trial alone can tell whether it comes to hang
            if (
                outcome
                and device.action is Action.HANG
                and not outcome.onto
                and may_hang(here[k], device.span)
            ):
                hanging = [other for other in states if isinstance(other, Hanging)]
                down = hang(here[k], device.span, hanging)
                if down not in states:
                    states.append(down)
                place = states.index(down) if outcome.hangs else k
                hangs_as[k] = states.index(down)
            if outcome and outcome.lands is not None:
                place = _find_state(cast(Orientation, outcome.lands), states, len(orientations))
            if outcome and outcome.onto:
                onward.append([row for row in outcome.onto if not device.onward(states[row[0]]).returned])
            else:
                onward.append([(place, outcome.passes)] if outcome else [])
        transitions.append(onward)
        verdicts.append(outcomes)
        here = [device.onward(orientation) for orientation in here] + states[len(here) :]
        if device.action is Action.HANG:
            here = [stand_astride(orientation, device.span) for orientation in here]
        if rows is None:
            followed = range(len(here))
        else:
            followed = {onto for k in followed for onto, share in onward[k] if share > 0.0}
    matrices = np.zeros((len(transitions), len(states), len(states)))
    for matrix, onward in zip(matrices, transitions):
        for place, row in enumerate(onward):
            for onto, share in row:
                matrix[place, onto] += share
    return DeviceFlow(
        states=tuple(states),
        verdicts=tuple(tuple(row + [None] * (len(states) - len(row))) for row in verdicts),
        matrices=check.frozen(matrices),
        devices=tuple(devices),
        came=tuple(came),
        starts=check.frozen(np.array(starts)),
        hangs_as=hangs_as,
    )


def _find_state(pose: Orientation, states: list[Orientation], lying: int) -> int:
    """Return the place of a pose behind those that lie; it is added where there is none alike."""
    for place, other in enumerate(states[lying:], start=lying):
        away = np.angle(np.exp(1j * (other.heading - pose.heading)))
        if other.aspect == pose.aspect and abs(away) < SAME_HEADING_RAD:
            return place
    states.append(pose)
    return len(states) - 1


def at_entry(orientations: Sequence[Orientation], devices: Sequence[Device]) -> tuple[Orientation, ...]:
    """Return orientations as they come: where devices that lean the track come first, they begin there.

    Parameters
    ----------
    orientations : sequence of Orientation
    devices : sequence of Device
        In the order parts meet them.

    Returns
    -------
    tuple of Orientation
    """
    for device in leading_devices(devices):
        orientations = tuple(device.onward(orientation) for orientation in orientations)
    return tuple(orientations)


def leading_devices(devices: Sequence[Device]) -> tuple[Device, ...]:
    """Return the devices that come first and lean the track from its entry on.

    Of banks and grooves the first one does: a second one begins at its own place, and so does a twist.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.

    Returns
    -------
    tuple of Device
    """
    first_devices, is_banked = [], False
    for device in devices:
        banks = device.action in (Action.BANK, Action.GROOVE)
        if not device.action.leans or device.on_side or (is_banked and banks):
            break
        first_devices.append(device)
        is_banked = is_banked or banks
    return tuple(first_devices)


def stand_astride(orientation: Orientation, span: tuple[float, ...]) -> Orientation:
    """Return an orientation over the rails' slot, which goes on: lying, it stands on what is beside it.

    Parameters
    ----------
    orientation : Orientation
    span : tuple of float [m]
        The slot: from and to, off the wall.

    Returns
    -------
    Orientation
        The one given where it hangs, or nothing beside the slot would carry it.
    """
    if isinstance(orientation, Hanging) or orientation.falls_off:
        return orientation
    foot = footprints.rest_beside_slot(orientation.foot, span, orientation.distance, orientation.track.radius)
    if not len(foot.corners):  # it fell
        return orientation
    over = replace(orientation)
    vars(over)["foot"] = foot  # a cached property of its own
    return over
