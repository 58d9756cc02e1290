"""A sensor along the track: what it sees of a part that comes by, and the pulse that it sets off."""

from dataclasses import fields, replace

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.tooling import sensor_views
from feederscrew.trial import runs, whereabouts
from feederscrew.trial.kernel import jets

SLOW = 1e-3  # [m/s] below which a part stands


def blows_off(sensor, known, states, level=0.0) -> bool:
    """Return whether a sensor sees parts differ from all that it wants by more than its play.

    Parameters
    ----------
    sensor : Sensor
    known : runs.BowlOfPart
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        Of the part before it and of others that it cannot tell from that one.
    level : float [m]
        Of the track there.

    Returns
    -------
    bool
    """
    fine = sensor.resolution
    if sensor.sees == "height":
        top = max(_spots(known, state, states[0])[:, 2].max() for state in states) - level
        return all(abs(_stepped(top, fine) - one.height) > sensor.play for one in sensor.wanted)
    spots = np.concatenate([_spots(known, state, states[0]) for state in states])
    faces = np.concatenate(
        [known.solid.triangles + k * len(known.solid.vertices) for k in range(len(states))]
    )
    spots = spots - [0.0, 0.0, level]

    def differs(one):
        seen = sensor_views.area(spots, faces, sensor.sees, fine, one.distance)
        wanted = sensor_views.outline(one, sensor.sees, one.distance)
        if sensor.sees == "outline":
            return sensor_views.fitted(seen, wanted, sensor.play)
        return sensor_views.outline_distance(seen, wanted)

    return all(differs(one) > sensor.play for one in sensor.wanted)


def _spots(known, state, first):
    """Corners (V, 3) [m] of a part, as seen at the place of the first one: along the wall, inwards, up."""
    back = -whereabouts.ways(first[None], known.radius)[0]
    there = whereabouts.moved(state[None], back, known.radius)[0]
    return known.length * (there[:3] + vectors.product(known.solid.vertices, whereabouts.matrix(there).T))


def _stepped(value, step):
    return np.round(value / step) * step if step > 0.0 else value


def past(known, station, *, limits, every, places):
    """Return the function that follows parts past one station, as `runs.past`, with what a sensor does.

    As its centre of mass comes to the sensor a part is looked at; if it differs, jets blow as it comes to
    them at its mean speed, as long as their pulse is. Without a sensor the station is one ride.
    """
    if not station.air.watches:
        return runs.past(known, station, limits=limits, every=every, places=places)
    watch = station.air.watches[0]
    own = {"limits": limits, "every": every, "places": places}
    before = runs.past(known, replace(station, exit=watch.place), **own)
    still = runs.past(known, station, **own)

    def follow(states, times):
        there = before(states, times)
        if not len(states) or there.outcomes[0] != runs.PASSED:
            return _doubled(there)
        now = times + there.seconds
        ride = still
        if blows_off(watch.sensor, known, there.states):
            speed = max((there.ways / there.seconds)[0], SLOW)
            begin = now[0] + (watch.nozzles - watch.place) / speed
            ride = runs.past(known, pulsed(station, watch, begin), **own)
        return _one(there, ride(there.states, now))

    return follow


def pulsed(station, watch, now):
    """Return a stage as its sensor sets off its jets at a time [s]."""
    rows = np.array(station.air.jets)
    rows[watch.jets, jets.BEGIN], rows[watch.jets, jets.END] = now, now + watch.seconds
    return replace(station, air=replace(station.air, jets=check.frozen(rows)))


def _doubled(ride):
    """Runs with room for as many places again, as those have that went on."""
    return replace(ride, paths=np.concatenate([ride.paths, np.full_like(ride.paths, np.nan)], axis=1))


def _one(first, second):
    """Two rides of one part, one after the other, as one."""
    paths = np.array(_doubled(first).paths)
    later, count = np.array(second.paths), int(np.isfinite(first.paths[0, :, 0]).sum())
    later[:, :, 0] += first.seconds[0]
    paths[:, count : count + later.shape[1]] = later
    values = {one.name: getattr(second, one.name) for one in fields(runs.Runs)}
    values |= {"seconds": first.seconds + second.seconds, "ways": first.ways + second.ways, "paths": paths}
    values |= {name: np.maximum(getattr(first, name), getattr(second, name)) for name in ("depths", "gains")}
    return runs.Runs(**values)
