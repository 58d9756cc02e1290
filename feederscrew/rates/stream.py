"""Every orientation of a part in the queue, and what becomes of it at each device."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.rates.spacing import needed
from feederscrew.rates.tipping import TrackTipping, marked
from feederscrew.tooling import orientations as tooling
from feederscrew.tooling.clearing import seconds
from feederscrew.tooling.devices.base import UNSURE
from feederscrew.tooling.fates import at_entry, course
from feederscrew.tooling.orientations import Orientation


@dataclass(frozen=True, eq=False)
class Orientations:
    """Every way a part can lie on the track, an aspect and a heading a row; M rows."""

    lying: tuple[Orientation, ...]  # the rows themselves
    stations: tuple[str, ...]  # the track itself, then each device
    passes: np.ndarray  # (M, stations) share each station lets pass; the rest goes back into the bowl
    margins: np.ndarray  # (M, stations) [m] by which it passes or fails; NaN where that is not known
    states: tuple[Orientation, ...]  # S of them parts may leave in: the rows, then those that hang
    leaving: np.ndarray  # (M, S) share of each row that leaves in each state
    leaves_as: np.ndarray  # (M,) int, the state in which parts wanted as a row are fed
    rules: dict[str, np.ndarray]  # (M,) probability of aspect and heading by each rule
    interval: np.ndarray  # (M, 2) lowest and highest probability by the recommended rule
    decided: np.ndarray  # (M,) bool, whether statics tells what the devices do; momentum may where they turn
    fates: tuple[str, ...]  # (M,) what becomes of most: carried, returned or stopped
    stops: np.ndarray  # (M, stations) share of each that stands before each station
    clearing: np.ndarray  # (M,) [s] how long what devices return blocks the track, in the mean of the row
    doubtful: np.ndarray  # (M,) [1] share of each that leaves as well where no verdict is sure to return it
    gap: float = 0.0  # [m] free between parts at the entry, which the devices need
    tipping: TrackTipping | None = None  # on the track of a bowl; None where no drive is known

    @property
    def names(self):
        """Of the stations: 'track', 'wiper_1', 'gap_2'."""
        return tuple(f"{name}_{place}" if place else name for place, name in enumerate(self.stations))

    @property
    def aspects(self):
        """(M,) names of the aspects."""
        return tuple(one.aspect for one in self.lying)

    @property
    def headings(self):
        """(M,) [rad]."""
        return np.array([one.heading for one in self.lying])

    @property
    def heading_shares(self):
        """(M,) of the parts on that aspect; headings equal under a turn of the part are one."""
        return np.array([one.heading_share for one in self.lying])

    @property
    def lengths(self):
        """(M,) [m] along the track."""
        return np.array([one.length for one in self.lying])

    @property
    def widths(self):
        """(M,) [m] across it."""
        return np.array([one.width for one in self.lying])

    @property
    def rolls_back(self):
        """(M,) bool, whether it lies on its round side, not along the track, and rolls down the climb."""
        return np.array([one.may_roll_back for one in self.lying], dtype=bool)

    @property
    def stays(self):
        """(M,) share that the bare track carries: what falls off, turns over or rolls back does not queue."""
        return np.where(self.rolls_back, 0.0, self.passes[:, 0])

    @property
    def leaves(self):
        """(M,) share that leaves the bowl, in any state."""
        return np.where(self.rolls_back, 0.0, self.through)

    @property
    def may_leave(self):
        """(M,) share that leaves the bowl, or is not sure to be returned."""
        return np.where(self.rolls_back, 0.0, self.through + self.doubtful)

    @property
    def carried(self):
        """The same orientations, were those that roll back carried as what slides."""
        return replace(self, lying=tuple(replace(one, may_roll_back=False) for one in self.lying))

    @property
    def through(self):
        """(M,) share that passes every station."""
        return self.passes.prod(axis=1)

    @property
    def margin(self):
        """(M,) [m] of the first device that returns it, or the least by which it passes all; NaN without any.

        One that momentum, friction or the wall may undo is none.
        To the devices behind the first that returns it, it does not come as it lies.
        """
        known = np.where(np.isnan(self.margins), np.inf, self.margins)
        returns = np.isfinite(known) & (self.passes < 0.5)
        first = np.take_along_axis(known, returns.argmax(axis=1)[:, None], axis=1)[:, 0]
        least = np.where(returns.any(axis=1), first, known.min(axis=1))
        return np.where(np.isinf(least) | (np.abs(least) <= UNSURE), np.nan, least)

    @property
    def sure(self):
        """(M,) bool, whether it comes along the bare track as it lies, and no momentum decides at a device.

        On the track it shall neither rock nor roll, nor a landing turn it: nothing holds what is round at
        the wall without a bank, and no bank brings back to it what rolls along the track, since that does not
        slip.
        """
        rocks = False if self.tipping is None else self.tipping.tips & ~self.tipping.over
        level = [one.kind == "rolling" and one.track.bank <= 0.0 for one in self.lying]
        loose = np.array(level, dtype=bool) | [one.along_a_bank for one in self.lying]
        tips, yaws = np.array([(one.may_tip, one.may_yaw) for one in self.lying], dtype=bool).T
        turns = tips | (yaws & ~self._gone_at_any_heading)
        return self.decided & ~(self.rolls_back | rocks | loose | turns)

    @property
    def _gone_at_any_heading(self):
        """(M,) bool, whether devices return every heading of its aspect by some margin."""
        gone = np.isfinite(self.margin) & (self.through <= 0.0)
        gone |= np.array([one.returned for one in self.lying], dtype=bool)
        left = {aspect for aspect, lost in zip(self.aspects, gone) if not lost}
        return np.array([aspect not in left for aspect in self.aspects], dtype=bool)


def orientations(part, aspects, track, chain=(), sigma=0.0, bowl=None):
    """Return every stable aspect and heading of a part, and what becomes of it at each device.

    Source: docs/tooling.md, "1. The method".

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    track : Track
    chain : sequence of Device
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    bowl : Bowl, optional
        Of that track: what its drive turns over on the track goes back, as what falls off does.

    Returns
    -------
    Orientations
    """
    return along(tooling.orientations(part, aspects, track), aspects, chain, sigma, bowl)


def along(lying, aspects, chain=(), sigma=0.0, bowl=None, rows=None):
    """Return what becomes of known orientations, or of some rows alone; the rest as for ``orientations``."""
    lying, tips = (lying, None) if bowl is None else marked(lying, bowl)
    lying = at_entry(lying, chain)
    found = course(chain, lying, sigma, rows)
    rules = {rule: np.array([one.chances[rule] for one in lying]) for rule in aspects.chances}
    return Orientations(
        lying=lying,
        stations=("track", *(device.kind for device in chain)),
        passes=found.passes,
        margins=found.margins,
        states=found.states,
        leaving=found.leaving,
        leaves_as=check.frozen(np.array([found.leaves_as(row) for row in range(len(lying))])),
        rules={rule: check.frozen(chance) for rule, chance in rules.items()},
        interval=check.frozen(_interval(aspects, lying)),
        decided=found.decided,
        fates=found.fates,
        stops=found.stops,
        clearing=check.frozen(_clearing(found, lying, chain, bowl)),
        doubtful=found.doubtful,
        gap=0.0 if bowl is None else needed(chain, lying, bowl),
        tipping=tips,
    )


def _clearing(found, lying, chain, bowl):
    """Time [s] for which each orientation blocks the track on its way off it, in the mean."""
    times = np.zeros(len(lying))
    for step, device in enumerate(chain if bowl is not None else ()):
        for row in np.flatnonzero(found.ends[:, 0, 1 + step] > 0.0):
            times[row] += found.ends[row, 0, 1 + step] * seconds(device, lying[row], bowl)
    return times


def _interval(aspects, lying):
    known = aspects.recommended
    if known is None:
        return np.full((len(lying), 2), np.nan)
    rows = [aspects.names.index(one.aspect) for one in lying]
    shares = np.array([one.heading_share for one in lying])
    return np.column_stack([known.low[rows] * shares, known.high[rows] * shares])
