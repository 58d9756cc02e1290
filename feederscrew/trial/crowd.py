"""Several parts on one track with all its devices: they push, carry and climb each other."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.dropping.kernel import body
from feederscrew.geometry.compiled import zero_rows
from feederscrew.trial import air, part_poses, runs, sensed_rides, staging
from feederscrew.trial.arrays import forget, move_on, workspace_of
from feederscrew.trial.kernel import travel, workspace

PERIODS = 8  # over which a sensor takes the speed of a part: within one it may hop or be pushed
TAIL = 1.2  # of the part's size: track behind the outlet, on which a whole part still lies as it leaves


@dataclass(frozen=True, eq=False)
class CrowdedTrack:
    """The bare track for a row, then the devices one behind the other; D devices."""

    stage: staging.Stage
    start: float  # [m] along the wall, where the drawn track begins
    windows: np.ndarray  # (D, 2) [m] where each device's stretch begins and ends
    levels: np.ndarray  # (D + 1,) [m] of the track before the first device and behind each
    outlet: float  # [m] behind the last of them


def crowded(bowl, orientations, devices, room):
    """Return the track for a row of parts.

    Parameters
    ----------
    bowl : Bowl
    orientations : sequence of Orientation
        Of the part.
    devices : sequence of Device
        In the order parts meet them.
    room : float [m]
        Bare track before them, up to the place 0.

    Returns
    -------
    CrowdedTrack
    """
    track, place, level, windows, placed, blows = bowl.track, 0.0, 0.0, [], [], []
    size = staging.size_of(orientations)
    for device in [device for device in devices if device.placed]:
        standing, start = device.standing(track, orientations), place + (0.5 + staging.SPARE_WAY) * size
        last = staging.passed(standing, start, size)
        placed.append((standing, start, last))
        blows.append((standing, start, level))
        level -= standing.drop
        windows.append((place, last, level))
        place = last
    if placed:  # a ledge goes on behind the outlet
        placed[-1] = (*placed[-1][:2], place + TAIL * size)
    ends = -room - size, place + TAIL * size
    blown = air.along(blows, track, orientations)
    first = [replace(slope, climb=None) for slope in staging.at_entry(devices, track, orientations)]
    blown = replace(blown, slopes=(*staging.before(first), *blown.slopes))  # they come apart on a steeper way
    geometry = staging.built(placed, track, size, ends)
    stage = staging.Stage(
        staging.BARE_TRACK,
        *geometry,
        begin=-room,
        exit=np.inf,
        air=blown,
        size=size,
        width=track.extent,
    )
    places = np.reshape(windows, (-1, 3))
    levels = np.append(0.0, places[:, 2])
    return CrowdedTrack(stage, -room, check.frozen(places[:, :2]), check.frozen(levels), place)


class PartsOnTrack:
    """N parts on a track, moved period by period; lengths in units of the part's, along the wall.

    Parameters
    ----------
    known : runs.BowlOfPart
    track : CrowdedTrack
    count : int
        Parts at most.
    """

    def __init__(self, part_in_bowl, track, count) -> None:
        self.part_in_bowl, self.solid, self.stage = part_in_bowl, part_in_bowl.solid, track.stage
        self.hull = part_in_bowl.solid.corners[part_in_bowl.solid.outer]
        self.windows, self.levels = track.windows, track.levels
        self.surface = runs.surface_of(part_in_bowl, track.stage)
        self.arrays, self.on = workspace_of(part_in_bowl.solid, self.surface, count), np.zeros(count, bool)
        self.period = 2.0 * np.pi / part_in_bowl.floor.rate
        self.passed = np.full((PERIODS, count), np.nan)  # ways of each, of the last periods
        self.pulses = [air.Pulses() for _ in track.stage.air.watches]

    def lay(self, n, state) -> None:
        """Put part n onto the track."""
        self.arrays.states[n] = state
        forget(self.arrays, n)
        self.passed[:, n] = np.nan
        self.on[n] = True

    def take(self, n) -> None:
        """Take part n off the track."""
        self.on[n] = False

    def ride(self, turn):
        """Move all through one period of the drive, the ``turn``-th; how deep anything was in anything."""
        journals = zero_rows(1, workspace.JOURNAL)
        steps = round(self.period / self.part_in_bowl.floor.step)
        together = workspace.Together(self.on, turn * self.period, steps, journals)
        move_on(self.part_in_bowl, self.surface, self.arrays, together)
        return float(journals.depth[0])

    def slides_off(self, n) -> bool:
        """Return whether part n is beyond the free edge, or too fast towards it to stay on the track."""
        out = travel.slides_to(self.surface, self.arrays.states[n])
        return bool(out > self.stage.width / self.part_in_bowl.length)

    def blown_off(self):
        """Return (N,) bool, which parts are beyond the free edge, where the track holds them no more."""
        states = self.arrays.states
        x, y = states[:, body.X], self.part_in_bowl.radius - states[:, body.Y]
        out = self.part_in_bowl.radius - np.sqrt(x * x + y * y)
        return out > self.stage.width / self.part_in_bowl.length + runs.OVER_EDGE_SHARE * self.solid.radius

    def watch(self, lying, before, after, turn) -> None:
        """Let sensors look at the parts whose centres of mass have come past them in a period.

        What is nearer to a part than the sensor can tell is one with it. Jets that a part sets off blow as
        it comes to them at its mean speed of the last periods, from the next one on, the ``turn``-th.
        """
        self.passed = np.roll(self.passed, 1, axis=0)
        self.passed[0] = before
        now = turn * self.period
        for watch, pulses in zip(self.stage.air.watches, self.pulses):
            place = watch.place / self.part_in_bowl.length
            for n in [n for n in lying if before[n] < place <= after[n]]:
                states = self.arrays.states[[n, *self.near(n, lying, watch.sensor.resolution)]]
                if sensed_rides.blows_off(watch.sensor, self.part_in_bowl, states, self.level(watch.place)):
                    left = max(watch.nozzles / self.part_in_bowl.length - after[n], 0.0)
                    pulses.set_off(
                        now + left / self.speed(n, after[n]), watch.seconds / self.part_in_bowl.unit
                    )
            self.surface.jets.begin[watch.jets], self.surface.jets.end[watch.jets] = pulses.next(now)

    def speed(self, n, along):
        """Return the mean speed of part n, that is at a way now, over the last periods."""
        noted = self.passed[np.isfinite(self.passed[:, n]), n]
        return (along - noted[-1]) / (len(noted) * self.period)

    def near(self, n, lying, resolution):
        """Return the parts of a row that are one with part n for a sensor of some resolution [m]."""
        reach = self.reaches(lying)
        touching, rear, front = [], reach[n][0], reach[n][1]
        wide = resolution / self.part_in_bowl.length
        for m in sorted(lying, key=lambda m: abs(reach[m][0] - reach[n][0])):
            if m != n and reach[m][0] < front + wide and reach[m][1] > rear - wide:
                touching.append(m)
                rear, front = min(rear, reach[m][0]), max(front, reach[m][1])
        return touching

    def level(self, place) -> float:
        """Return the level [m] of the track at a place [m] along the wall."""
        return float(self.levels[int(np.searchsorted(self.windows[:, 1], place))])

    @property
    def forces(self):
        """Return (N, 2) mean forces of others in the last period, from behind and below, over the weight."""
        return self.arrays.strains / self.period

    def reaches(self, rows) -> dict[Any, Any]:
        """Return, by part, how far it reaches along the wall, rear and front, and its lowest point."""
        states = self.arrays.states[list(rows)]
        return dict(zip(rows, part_poses.reaches(states, self.hull, self.part_in_bowl.radius).tolist()))
