"""A row of parts that push each other through a chain of devices: a reduced model in one dimension."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.trial import course as fates
from feederscrew.trial.kernel import row

ENGINE = "one-dimensional row"
SPREAD = 0.03  # [1] standard deviation of the friction from part to part
GAPS = 0.2  # of a part's length: mean free way between parts as they come
HOLD = 1.0  # [s] a part that stays at a device is taken out by hand after so long
PERIOD = 800  # steps of a period of the drive: a stop within a step is not sought


@dataclass(frozen=True, eq=False)
class PushedRow:
    """What a row of N parts did; D devices."""

    seconds: float  # [s]
    delivered: float  # parts that left the last device, that in the outlet as the share of its length
    leaving: np.ndarray  # (M,) int, in which orientation whole ones left
    returned: int  # thrown back by a device
    jams: int  # stayed at a device and were taken out
    velocity: float  # [m/s] mean of all parts
    gap: float  # [m] mean free way between neighbours
    touching: float  # [1] share of the parts that push the one ahead in a period of the drive
    pressure: np.ndarray  # (D,) [N] greatest mean force on a part held at a device; 0 where none was
    partial: bool  # stopped by the user: of the seconds until then


def row_of(known, mass, every, shares, seen, places, *, parts, seconds, seed):
    """Follow a row of parts that come without end: one that leaves is offered again at the end of the row.

    Parameters
    ----------
    known : runs.BowlOfPart
    mass : float [kg]
    every : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they come; sums to 1.
    seen : Course
        What became of single parts, from which each draws its fate at each device.
    places : (D,) float [m]
        Where the devices are, from the start of the row ahead.
    parts : int
        In the row.
    seconds : float [s]
    seed : int

    Returns
    -------
    PushedRow
    """
    lined = _Lined(known, every, np.cumsum(shares), seen, places, np.random.default_rng((seed, parts)))
    lined.fill(parts)
    unit, period = known.unit, 2.0 * np.pi / known.floor.rate
    count = max(round(seconds / unit / period), 1)
    try:
        for turn in range(count):
            lined.ride(turn * period)
            lined.look(period * unit)
    except KeyboardInterrupt:
        if not lined.looks:
            raise
    return lined.told(lined.looks * period * unit, mass, partial=lined.looks < count)


class _Lined:
    """The row while it moves; lengths in units of the part's."""

    def __init__(self, known, every, chances, seen, places, rng):
        self.known, self.every, self.chances, self.seen, self.rng = known, every, chances, seen, rng
        self.devices = np.asarray(places) / known.length
        self.outlet = self.devices[-1] if len(places) else 0.0
        self.floor = known.floor._replace(step=2.0 * np.pi / known.floor.rate / PERIOD)
        self.leaving, self.whole, self.returned, self.jams = np.zeros(len(every), int), 0, 0, 0
        self.way, self.free, self.touch, self.looks = 0.0, 0.0, 0, 0
        self.pressure = np.zeros(len(places))

    def fill(self, parts):
        """Lay so many parts in a row, the first about to enter."""
        self.parts, self.order = np.zeros((parts, 8)), []
        self.lying, self.next = np.zeros(parts, int), np.zeros(parts, int)
        self.held = np.zeros(parts)
        for n in range(parts):
            self.enter(n)
        self.start = self.fraction()

    def enter(self, n):
        """Offer a part anew at the end of the row."""
        k = int(np.searchsorted(self.chances, self.rng.random() * self.chances[-1]))
        k = min(k, len(self.every) - 1)
        length = self.every[k].length / self.known.length
        apart = length * GAPS * self.rng.random() * 2.0
        last = self.parts[self.order[-1]] if self.order else None
        end = 0.0 if last is None else min(last[row.PLACE] - 0.5 * last[row.LENGTH], 0.0)
        friction = self.known.friction[1] * max(1.0 + SPREAD * self.rng.standard_normal(), 0.1)
        self.parts[n] = end - apart - 0.5 * length, 0.0, 0.0, 0.0, length, friction, 0.0, 0.0
        self.lying[n], self.next[n], self.held[n] = k, 0, 0.0
        self.order.append(n)

    def ride(self, time):
        """Move all for one period of the drive."""
        order, count = np.array(self.order), len(self.order)
        before = self.parts[order, row.PLACE].copy()
        self.parts[:, row.PUSH] = 0.0
        row.follow(
            self.parts, order, self.known.gravity, self.floor, time, self.known.restitution, PERIOD,
            np.zeros(count), np.zeros(count), np.zeros(count),
        )  # fmt: skip
        self.way += (self.parts[order, row.PLACE] - before).mean()
        ahead, behind = self.parts[order[:-1]], self.parts[order[1:]]
        free = (
            ahead[:, row.PLACE] - behind[:, row.PLACE] - 0.5 * (ahead[:, row.LENGTH] + behind[:, row.LENGTH])
        )
        if len(free):
            self.free += free.mean()
            self.touch += float((behind[:, row.PUSH] > 0.0).mean())
        self.looks += 1

    def look(self, period):
        """Let devices act on the parts that have come to them, and the outlet take what has left."""
        for n in list(self.order):
            if self.parts[n, row.HELD] > 0.5:
                self.stay(n, period)
            while n in self.order and self.next[n] < len(self.devices) and not self.parts[n, row.HELD]:
                if self.parts[n, row.PLACE] < self.devices[self.next[n]]:
                    break
                self.meet(n)
        while self.order:
            first = self.order[0]
            if self.parts[first, row.PLACE] - 0.5 * self.parts[first, row.LENGTH] < self.outlet:
                break
            self.whole += 1
            self.leaving[self.lying[first]] += 1
            self.again(first)

    def meet(self, n):
        """Draw what a device does with a part, from what it did with single ones."""
        place = self.next[n] + 1  # the first station is the bare track
        came = np.flatnonzero(self.seen.orientations[place] == self.lying[n])
        self.next[n] += 1
        if not len(came):
            return
        one = came[int(self.rng.integers(len(came)))]
        after = self.seen.orientations[place + 1][one]
        if self.seen.ended[one] > place:
            self.lying[n] = after if after >= 0 else self.lying[n]
            self.parts[n, row.LENGTH] = self.every[self.lying[n]].length / self.known.length
        elif self.seen.fates[one] == fates.RETURNED:
            self.returned += 1
            self.again(n)
        else:
            self.parts[n, row.HELD] = 1.0

    def stay(self, n, period):
        """A part that a device holds: what pushes it, until it is taken out."""
        self.held[n] += period
        k = self.order.index(n)
        pushed = self.parts[self.order[k + 1], row.PUSH] if k + 1 < len(self.order) else 0.0
        device = self.next[n] - 1
        self.pressure[device] = max(self.pressure[device], pushed / (period / self.known.unit))
        if self.held[n] >= HOLD:
            self.jams += 1
            self.again(n)

    def again(self, n):
        """Take a part out of the row and offer it anew."""
        self.order.remove(n)
        self.enter(n)

    def fraction(self):
        """How much of the part in the outlet has left [1]."""
        if not self.order:
            return 0.0
        first = self.parts[self.order[0]]
        share = (first[row.PLACE] + 0.5 * first[row.LENGTH] - self.outlet) / first[row.LENGTH]
        return float(min(max(share, 0.0), 1.0))

    def told(self, seconds, mass, partial):
        """What they did, in SI units."""
        length, unit = self.known.length, self.known.unit
        return PushedRow(
            seconds=seconds,
            delivered=self.whole + self.fraction() - self.start,
            leaving=check.frozen(self.leaving),
            returned=self.returned,
            jams=self.jams,
            velocity=self.way * length / seconds,
            gap=self.free * length / max(self.looks, 1),
            touching=self.touch / max(self.looks, 1),
            pressure=check.frozen(self.pressure * mass * length / unit**2),
            partial=partial,
        )
