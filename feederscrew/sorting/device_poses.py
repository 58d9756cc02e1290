"""Poses that come to each device, those that it lets pass and those that it returns: for drawings."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.bowl.devices.base import Device
from feederscrew.sorting.device_passages import until_returned
from feederscrew.sorting.isolating.chain import LEAST_SHARE
from feederscrew.sorting.orientations import Orientation


@dataclass(frozen=True, eq=False)
class SharedPose:
    """A pose at a device, and the share of all arriving parts that is in it there."""

    orientation: Orientation
    share: float  # [1]
    becomes: str  # name of the pose in which it goes on; its own where no device turns it, '' of none


@dataclass(frozen=True, eq=False)
class DevicePoses:
    """The poses that come to a device, in each group what is wanted first, then the most frequent."""

    device: Device
    passes: tuple[SharedPose, ...]
    returns: tuple[SharedPose, ...]
    stops: tuple[SharedPose, ...]  # a part stands there and blocks the track


def find_device_poses(
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    shares: Floats,
    kept: Collection[int] = (),
) -> list[DevicePoses]:
    """Return for each device the poses that it lets pass and those that it returns, as most parts go on.

    What a device returns does not come to the next ones; what it turns comes there in its new pose.

    Parameters
    ----------
    devices : (D,) sequence of Device
        In the order parts meet them; those without a place on the track are left out.
    orientations : (M,) sequence of Orientation
        As they lie at the entry.
    shares : (M,) [1]
        Of all arriving parts.
    kept : collection of int
        Rows that are shown however seldom they come; others from ``LEAST_SHARE`` on.

    Returns
    -------
    list of DevicePoses
        One for each device on the track.

    References
    ----------
    ``device_passages.until_returned``; docs/tooling.md, "1. The method".
    """
    placed = [device for device in devices if device.action.has_place]
    groups: list[dict[str, dict[str, SharedPose]]] = [
        {"passes": {}, "returns": {}, "stops": {}} for _ in placed
    ]
    known, first = np.nan_to_num(shares), {orientations[row].name for row in kept}
    for row, orientation in enumerate(orientations):
        if known[row] < LEAST_SHARE and row not in kept:
            continue
        for passage, group in zip(until_returned(placed, orientation, orientations), groups):
            # what is turned over where it falls off the track is returned too
            is_returned = passage.verdict.passes <= 0.0 or passage.after.returned
            fate = "passes" if not is_returned else "stops" if passage.fate == "stopped" else "returns"
            own = group[fate]
            before = own[passage.orientation.name].share if passage.orientation.name in own else 0.0
            becomes = passage.after.name if fate == "passes" else ""
            share = before + float(known[row])
            own[passage.orientation.name] = SharedPose(passage.orientation, share, becomes)
    return [
        DevicePoses(
            device,
            **{
                fate: tuple(
                    sorted(poses.values(), key=lambda one: (one.orientation.name not in first, -one.share))
                )
                for fate, poses in group.items()
            },
        )
        for device, group in zip(placed, groups)
    ]
