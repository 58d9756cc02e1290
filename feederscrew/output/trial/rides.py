"""Which parts of a trial are worth a picture: one that passes a device and one that it stops."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.dropping.kernel import body
from feederscrew.output.trial.figures import unrolled
from feederscrew.part.record import Part
from feederscrew.trial import course, runs
from feederscrew.trial.result import TrialRun
from feederscrew.trial.shape import solid_of
from feederscrew.trial.staging import Stage

ALWAYS = (-np.inf, np.inf)  # [s] when a steady jet blows


@dataclass(frozen=True, eq=False)
class DeviceRide:
    """One part at one station."""

    place: int  # station
    orientation: str  # it was laid down in
    fate: str  # of course.FATES
    path: np.ndarray  # (K, 8) time [s], position [m], attitude w x y z (principal axes to bowl)
    looked: float = np.nan  # [s] when the sensor looks at it; NaN without one
    blows: tuple[float, float] | None = None  # [s] from when to when jets blow at it; None where none does

    def title(self, sent: course.Course) -> str:
        """'A@0 at gap 9 mm: returned'; of a device of several values its kind alone."""
        device = sent.stations[self.place].device
        value = "" if device.short.startswith(("{", "[")) else device.short
        where = f"{device.name} {value}".strip()
        return f"{self.orientation} at {where}: {self.fate.replace('_', ' ')}"


def rides_to_show(part: Part, *tried: TrialRun) -> list[DeviceRide]:
    """Return one part that passes and one that does not, at the device that decides.

    Parameters
    ----------
    part : Part
        From a mesh.
    *tried : TrialRun
        Of the same bowl: the device is that of the first of them that loses a part.

    Returns
    -------
    list of DeviceRide
        One of them, where all do the same.
    """
    losing = next((run for run in tried if _loses_parts(run.course)), tried[0])
    place = deciding_station(losing.course)
    rides = []
    for passes in (True, False):
        candidates = [(run, _riders(run.course, place, passes)) for run in tried]
        rides += [_ride(part, run, place, int(which[0])) for run, which in candidates if len(which)][:1]
    return rides


def deciding_station(sent: course.Course) -> int:
    """Return the device where most do not pass while others do; where all do the last station."""
    lost = [int((ride.outcomes != runs.PASSED).sum()) for ride in sent.rides]
    some = [0 < count < len(ride.outcomes) for count, ride in zip(lost, sent.rides)]
    if not any(lost[1:]):
        return len(lost) - 1
    return max(range(1, len(lost)), key=lambda place: (some[place], lost[place], -place))


def _loses_parts(sent: course.Course) -> bool:
    """Whether a part gets no farther than one of the devices."""
    return any((ride.outcomes != runs.PASSED).any() for ride in sent.rides[1:])


def _riders(sent: course.Course, place: int, passes: bool) -> NDArray[np.int64]:
    """The parts that pass a station, or those that come to it and do not; none where none comes so far."""
    if place >= len(sent.rides):
        return np.zeros(0, int)
    return np.flatnonzero((sent.rides[place].outcomes == runs.PASSED) == passes)


def _ride(part: Part, run: TrialRun, place: int, rider: int) -> DeviceRide:
    sent, ride = run.course, run.course.rides[place]
    number = sent.riders[place][rider]
    passed = ride.outcomes[rider] == runs.PASSED
    fate = course.FATES[course.PASSED if passed else sent.fates[number]]
    path = ride.paths[rider][np.isfinite(ride.paths[rider][:, 0])]
    looked, blows = air_at(part, run, sent.stations[place], path)
    return DeviceRide(place, run.orientations.lying[sent.entered[number]].name, fate, path, looked, blows)


def air_at(
    part: Part, run: TrialRun, stage: Stage, path: NDArray[np.float64]
) -> tuple[float, tuple[float, float] | None]:
    """Return when the sensor of a station looks at a part, and from when to when jets blow there.

    Parameters
    ----------
    part : Part
    run : TrialRun
    stage : Stage
        The station.
    path : (K, 8) float [s], [m], [1]
        Of the part.

    Returns
    -------
    looked : float [s]
        NaN without a sensor, or where the part does not come to it.
    blows : (float, float) [s] or None
    """
    if not stage.air.watches:
        return np.nan, ALWAYS if len(stage.air.jets) else None
    watch, along = stage.air.watches[0], unrolled(path, run.bowl.track.radius)[0]
    if not (along >= watch.place).any():
        return np.nan, None
    first = int(np.argmax(along >= watch.place))
    looked, (solid, length, _) = float(path[first, 0]), solid_of(part)
    state = np.zeros((1, body.STATE))
    state[0, :3], state[0, body.Q : body.Q + 4] = path[first, 1:4] / length, path[first, 4:]
    if not runs.blows_off(watch.sensor, runs.setting(solid, length, run.bowl), state):
        return looked, None
    speed = max((along[first] - along[0]) / max(looked - path[0, 0], 1e-9), runs.STANDING_SPEED_M_S)
    begin = looked + max(watch.nozzles - along[first], 0.0) / speed
    return looked, (begin, begin + watch.seconds)
