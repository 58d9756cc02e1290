"""What the devices of a bowl do with each orientation of a part: the chapter on tooling of a report."""

from dataclasses import dataclass

import numpy as np

from feederscrew.bowl.devices import Device
from feederscrew.bowl.record import Bowl
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.tooling.orientations import Orientation, orientations
from feederscrew.tooling.passages import Passage, until_returned


@dataclass(frozen=True, eq=False)
class PassagesStudy:
    """Each orientation at the worst place of each device that it meets; M orientations."""

    devices: tuple[Device, ...]  # without measured yields
    orientations: tuple[Orientation, ...]
    shares: np.ndarray  # (M,) [1]
    passages: tuple[tuple[Passage, ...], ...]  # (M,) up to the device that returns it

    @property
    def wanted(self):
        """Place of the most frequent orientation that leaves; of the most frequent one where none does."""
        leaves = [not one.falls_off and all(k.verdict.passes > 0.0 for k in met)
                  for one, met in zip(self.orientations, self.passages)]  # fmt: skip
        shares = np.round(self.shares, 9)
        return int(np.argmax(np.where(leaves, shares, 0.0) if any(leaves) else shares))


def passages(part: Part, bowl: Bowl, aspects: Aspects, rule: str) -> PassagesStudy:
    """Study what a bowl's devices do with each orientation of a part.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspects : Aspects
        Of that part.
    rule : str
        Whose probabilities are taken.

    Returns
    -------
    PassagesStudy
    """
    every = orientations(part, aspects, bowl.track)
    devices = tuple(device for device in bowl.devices if device.kind != "yield")
    return PassagesStudy(
        devices=devices,
        orientations=every,
        shares=np.nan_to_num([one.chances[rule] for one in every]),
        passages=tuple(tuple(until_returned(devices, one, every)) for one in every),
    )
