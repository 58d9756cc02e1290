"""Which parts of a trial are worth a picture: one that passes a device and one that it stops."""

from dataclasses import dataclass

import numpy as np

from feederscrew.trial import course, runs


@dataclass(frozen=True, eq=False)
class ShownRide:
    """One part at one station."""

    place: int  # station
    orientation: str  # it was laid down in
    fate: str  # of course.FATES
    path: np.ndarray  # (K, 8) time [s], position [m], attitude w x y z (principal axes to bowl)

    def title(self, found) -> str:
        """'A@0 at gap 9 mm: returned'; of a device of several values its kind alone."""
        device = found.stations[self.place].device
        value = "" if device.short.startswith(("{", "[")) else device.short
        where = f"{device.name} {value}".strip()
        return f"{self.orientation} at {where}: {self.fate.replace('_', ' ')}"


def shown(*tried):
    """Return one part that passes and one that does not, at the device that decides.

    Parameters
    ----------
    *tried : TrialRun
        Of the same bowl: the device is that of the first of them that loses a part.

    Returns
    -------
    list of ShownRide
        One of them, where all do the same.
    """
    losing = next((run for run in tried if _loses(run.course)), tried[0])
    place = _station(losing.course)
    found = []
    for wanted in (True, False):
        ways = [(run, _which(run.course, place, wanted)) for run in tried]
        found += [_of(run, place, int(which[0])) for run, which in ways if len(which)][:1]
    return found


def _which(found, place, passes):
    """The parts that pass a station, or those that come to it and do not; none where none comes so far."""
    if place >= len(found.rides):
        return ()
    return np.flatnonzero((found.rides[place].outcomes == runs.PASSED) == passes)


def _loses(found) -> bool:
    """Whether a part gets no farther than one of the devices."""
    return any((ride.outcomes != runs.PASSED).any() for ride in found.rides[1:])


def _station(found):
    """The device that decides: where most do not pass while others do; where all do the last station."""
    lost = [int((ride.outcomes != runs.PASSED).sum()) for ride in found.rides]
    some = [0 < count < len(ride.outcomes) for count, ride in zip(lost, found.rides)]
    places = range(1, len(lost))
    if not any(lost[1:]):
        return len(lost) - 1
    return max(places, key=lambda place: (some[place], lost[place], -place))


def _of(run, place, n) -> ShownRide:
    found, ride = run.course, run.course.rides[place]
    one = found.riders[place][n]
    passed = ride.outcomes[n] == runs.PASSED
    fate = course.FATES[course.PASSED if passed else found.fates[one]]
    path = ride.paths[n][np.isfinite(ride.paths[n][:, 0])]
    return ShownRide(place, run.orientations.lying[found.entered[one]].name, fate, path)
