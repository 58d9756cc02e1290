"""The pose in which parts leave a bowl, and the poses that come to each of its devices."""

from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.bowl.devices.orientation_names import nearest, split_name
from feederscrew.bowl.verified import AMONG, Verified
from feederscrew.feeding.stream import Orientations
from feederscrew.machine.sheet import MachineSheet, Order
from feederscrew.sorting.device_poses import DevicePoses, find_device_poses
from feederscrew.sorting.orientations import HANGING, Hanging, Orientation
from feederscrew.sorting.pose_words import describe_pose


@dataclass(frozen=True, eq=False)
class OutletPoses:
    """The pose that leaves, and which poses come to each device."""

    leaving: Orientation
    devices: list[DevicePoses]

    @property
    def words(self) -> str:
        """The pose that leaves, by its name and in words."""
        name = self.leaving.name
        text = describe_pose(self.leaving)
        return text if name == HANGING else f"{name}: {text}"


def find_outlet_poses(study: MachineSheet, trial: Verified | None = None) -> OutletPoses | None:
    """Return the pose in which parts leave and the poses at each device; None without a mesh or a flow.

    A trial says what it counted, else the order what is wanted; else it is the pose that leaves most often.

    Parameters
    ----------
    study : MachineSheet
        With its order.
    trial : Verified, optional

    Returns
    -------
    OutletPoses or None
    """
    found = find_leaving(study, trial)
    if found is None or study.order is None or study.order.on_track is None:
        return None
    row, leaving = found
    coming = study.order.on_track
    shares = np.nan_to_num(coming.rules[study.order.rule])
    return OutletPoses(leaving, find_device_poses(study.bowl.devices, coming.lying, shares, (row,)))


def find_leaving(study: MachineSheet, trial: Verified | None = None) -> tuple[int, Orientation] | None:
    """Return the row that is wanted, and the pose in which it leaves; None without a mesh or a flow.

    Parameters
    ----------
    study : MachineSheet
        With its order.
    trial : Verified, optional
        Says what was counted.

    Returns
    -------
    (int, Orientation) or None
    """
    order = study.order
    coming = None if order is None else order.on_track
    if order is None or coming is None or not coming.lying or coming.lying[0].posture.solid is None:
        return None
    row, leaving = _leaving(coming, np.nan_to_num(coming.rules[order.rule]), order, trial)
    if any(device.on_side for device in study.bowl.devices):
        leaving = leaving.against_inner_wall()
    return row, leaving


def _leaving(
    coming: Orientations, shares: Floats, order: Order, trial: Verified | None
) -> tuple[int, Orientation]:
    """The row that is wanted, and the pose in which it leaves."""
    named: tuple[str, float | None] | None = order.wanted
    if trial is not None:
        named = split_name(trial.wanted.split(AMONG)[0])
    hanging = [k for k, state in enumerate(coming.states) if isinstance(state, Hanging)]
    flow = coming.leaving * shares[:, None]
    if named is not None and named[0].startswith(HANGING) and hanging:
        state = max(hanging, key=lambda k: float(flow[:, k].sum()))
        return int(np.argmax(flow[:, state])), coming.states[state]
    if named is not None and named[0].casefold() in {name.casefold() for name in coming.aspects}:
        rows = [k for k, name in enumerate(coming.aspects) if name.casefold() == named[0].casefold()]
        row = max(rows, key=lambda k: float(shares[k]))
        if named[1] is not None:
            row = nearest(coming.aspects, coming.headings, named[0], named[1])
        return row, coming.states[int(coming.leaves_as[row])]
    if flow.any():
        most, state = divmod(int(np.argmax(flow)), flow.shape[1])
        return most, coming.states[state]
    row = int(np.argmax(shares))
    return row, coming.lying[row]
