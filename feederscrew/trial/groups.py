"""Parts go through the whole chain in groups: what an interrupt keeps is a whole number of them."""

from dataclasses import fields

import numpy as np

from feederscrew import check
from feederscrew.trial.runs import Runs

SIZE = 40  # parts of a group, enough for eight cores


class Told:
    """Progress of one group over all stations."""

    def __init__(self, progress, before, parts, stations, group):
        self.progress, self.before, self.group = progress, before * stations, group
        self.total = parts * stations

    def of(self, place):
        """Return what one station tells."""
        before = self.before + place * self.group
        return self.progress and (lambda done: self.progress(before + done, self.total))


def joined(rides):
    """Return the Runs of several groups at one station as one."""
    names = [one.name for one in fields(Runs) if one.name != "partial"]
    arrays = {name: np.concatenate([getattr(ride, name) for ride in rides]) for name in names}
    return Runs(**{name: check.frozen(array) for name, array in arrays.items()}, partial=False)
