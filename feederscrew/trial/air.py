"""Jets of air and the lean of the track along a stretch of it, as the kernel takes them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.geometry.compiled import frozen_rows
from feederscrew.tooling.devices.base import Sensor
from feederscrew.trial.kernel.workspace import JET

BLEND, OPENS = 0.25, 1.0  # of the part's size: way over which a lean of track, or of wall, becomes the next


@dataclass(frozen=True, eq=False)
class Watch:
    """A sensor at its place, and which jets it sets off."""

    place: float  # [m] along the wall
    nozzles: float  # [m] where those jets are
    sensor: Sensor
    jets: slice  # rows of the stage's jets
    seconds: float  # [s] for which those blow


class Pulses:
    """Pulses of some jets that are set off, each for one part: they blow one after the other."""

    def __init__(self):
        self.spans = []  # (begin, end) of each, those that are over left out
        self.log = []  # (begin, end) of all

    def set_off(self, begin, seconds) -> None:
        """Let the jets blow from a time on, for so long."""
        self.spans.append((begin, begin + seconds))
        self.log.append((begin, begin + seconds))

    def next(self, now) -> tuple[Any, ...]:
        """Return when the jets next blow, from and to; what overlaps is one pulse, and (inf, inf) none."""
        self.spans = sorted(span for span in self.spans if span[1] > now)
        if not self.spans:
            return np.inf, np.inf
        begin, end = self.spans[0]
        for other in self.spans[1:]:
            if other[0] <= end:
                end = max(end, other[1])
        return begin, end


@dataclass(frozen=True, eq=False)
class Air:
    """What blows and leans along a stretch of track."""

    jets: np.recarray  # (J,) `trial.kernel.workspace.JET` [m], [1], [m/s2], [s]
    watches: tuple[Watch, ...]
    # [m] place, [rad] climb, bank and lean of the wall from there
    slopes: tuple[tuple[float, float | None, float | None, float | None], ...]


STILL_AIR = Air(frozen_rows([], JET), (), ())


def along(placed, track, orientations) -> Air:
    """Return what blows and leans along a stretch of track.

    Parameters
    ----------
    placed : sequence of (Standing, float [m], float [m])
        In the order parts meet them: where each begins along the wall, and its level.
    track : Track
    orientations : sequence of Orientation
        Of the part, which has one mass.

    Returns
    -------
    Air
    """
    rows: list[list[float]] = []
    mass, watches, slopes = orientations[0].posture.mass, [], []
    for standing, start, level in placed:
        first = len(rows)
        rows += [_row(jet, start, level, track.radius, mass) for jet in standing.jets]
        if standing.sensor is not None:
            seconds = max((jet.seconds for jet in standing.jets), default=0.0)
            own = slice(first, len(rows))
            watches.append(
                Watch(
                    start + standing.sensor.at, start + standing.jets[0].at[0], standing.sensor, own, seconds
                )
            )
        slopes += [(start + slope.begin, slope.climb, slope.bank, slope.wall) for slope in standing.slopes]
    return Air(frozen_rows(rows, JET), tuple(watches), tuple(slopes))


def _row(jet, start, level, radius, mass) -> list[Any]:
    """A jet in the bowl's frame; one that a sensor sets off does not blow."""
    x, y, z = jet.at
    theta, off = (start + x) / radius, radius - y
    ahead, inwards = (np.cos(theta), np.sin(theta), 0.0), (-np.sin(theta), np.cos(theta), 0.0)
    up, size = (0.0, 0.0, 1.0), np.sqrt(sum(part * part for part in jet.towards))
    direction = [
        sum(part * axis[k] for part, axis in zip(jet.towards, (ahead, inwards, up))) / size for k in range(3)
    ]
    mouth = off * ahead[1], radius - off * ahead[0], z + level
    times = (0.0, np.inf) if np.isinf(jet.seconds) else (np.inf, np.inf)
    return [*mouth, *direction, jet.radius, jet.spread, jet.thrust / mass, jet.reach, *times]


def blowing(rows, length, unit):
    """Return jets (J,) without dimensions; ``length`` [m] and ``unit`` [s] are 1."""
    out = rows.copy()
    for name in ("mouth_x", "mouth_y", "mouth_z", "radius", "reach"):
        out[name] /= length
    out["thrust"] *= unit**2 / length
    for name in ("begin", "end"):
        out[name] /= unit
    return out


def leaning(slopes, climb, bank, size, length) -> np.ndarray:
    """Return how gravity, the bowl's axis and the wall lie in the track's frame along the wall, (K, 8).

    Parameters
    ----------
    slopes : sequence of (float [m], float [rad] or None, float [rad] or None, float [rad] or None)
        Where another climb, bank or lean of the wall begins.
    climb, bank : float [rad]
        Before them, of the bowl's track.
    size : float [m]
        Of the part, over a share of which one lean becomes the next.
    length : float [m]
        Of the unit.
    """
    here = climb, bank, 0.0
    rows = [] if slopes else [(0.0, *here)]
    for place, *new in sorted(slopes, key=lambda one: one[0]):
        rows.append((place / length, *here))
        before, here = here, tuple(old if value is None else value for old, value in zip(here, new))
        blend = BLEND if here[-1] == before[-1] else OPENS
        rows.append((place / length + blend * size / length, *here))
    return np.array([_lean(*row) for row in rows])


def _lean(place, climb, bank, wall) -> list[Any]:
    c, s, off = np.cos(climb), np.sin(climb), bank - wall
    axis, upright = [np.sin(bank), np.cos(bank)], [np.sin(off), np.cos(off)]
    return [place, -s, -c * np.sin(bank), -c * np.cos(bank), *axis, *upright]
