"""A sensor along the track: what it sees of a part that comes by, and the pulse that it sets off."""

from dataclasses import fields, replace

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.tooling import sensor_views
from feederscrew.trial import part_poses, runs

STANDING_SPEED_M_S = 1e-3  # [m/s] below which a part stands


def blows_off(sensor, part_in_bowl, states, level=0.0) -> bool:
    """Return whether a sensor sees parts differ from all that it wants by more than its play.

    Parameters
    ----------
    sensor : Sensor
    part_in_bowl : runs.BowlOfPart
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
        top = max(_spots(part_in_bowl, state, states[0])[:, 2].max() for state in states) - level
        return all(abs(_stepped(top, fine) - view.height) > sensor.play for view in sensor.wanted)
    spots = np.concatenate([_spots(part_in_bowl, state, states[0]) for state in states])
    faces = np.concatenate(
        [part_in_bowl.solid.triangles + k * len(part_in_bowl.solid.vertices) for k in range(len(states))]
    )
    spots = spots - [0.0, 0.0, level]

    def differs(view):
        area = sensor_views.area(spots, faces, sensor.sees, fine, view.distance)
        wanted = sensor_views.outline(view, sensor.sees, view.distance)
        if sensor.sees == "outline":
            return sensor_views.fitted(area, wanted, sensor.play)
        return sensor_views.outline_distance(area, wanted)

    return all(differs(view) > sensor.play for view in sensor.wanted)


def _spots(part_in_bowl, state, first):
    """Corners (V, 3) [m] of a part, as seen at the place of the first one: along the wall, inwards, up."""
    to_first = -part_poses.ways_along_wall(first[None], part_in_bowl.radius)[0]
    there = part_poses.moved(state[None], to_first, part_in_bowl.radius)[0]
    return part_in_bowl.length * (
        there[:3] + vectors.product(part_in_bowl.solid.vertices, part_poses.matrix(there).T)
    )


def _stepped(value, step):
    return np.round(value / step) * step if step > 0.0 else value


def past(part_in_bowl, station, *, limits, interval, places):
    """Return the function that follows parts past one station, as `runs.past`, with what a sensor does.

    As its centre of mass comes to the sensor a part is looked at; if it differs, jets blow as it comes to
    them at its mean speed, as long as their pulse is. Without a sensor the station is one ride.
    """
    if not station.air.watches:
        return runs.past(part_in_bowl, station, limits=limits, interval=interval, places=places)
    watch = station.air.watches[0]
    own = {"limits": limits, "interval": interval, "places": places}
    before = runs.past(part_in_bowl, replace(station, exit=watch.place), **own)
    still = runs.past(part_in_bowl, station, **own)

    def follow(states, times):
        there = before(states, times)
        if not len(states) or there.outcomes[0] != runs.PASSED:
            return _doubled(there)
        now = times + there.seconds
        ride = still
        if blows_off(watch.sensor, part_in_bowl, there.states):
            speed = max((there.distances / there.seconds)[0], STANDING_SPEED_M_S)
            begin = now[0] + (watch.nozzles - watch.place) / speed
            ride = runs.past(part_in_bowl, pulsed(station, watch, begin), **own)
        return _join_rides(there, ride(there.states, now))

    return follow


def pulsed(station, watch, now):
    """Return a stage as its sensor sets off its jets at a time [s]."""
    jets = station.air.jets.copy()
    jets.begin[watch.jets], jets.end[watch.jets] = now, now + watch.seconds
    return replace(station, air=replace(station.air, jets=jets))


def _doubled(ride):
    """Runs with room for as many places again, as those have that went on."""
    return replace(ride, paths=np.concatenate([ride.paths, np.full_like(ride.paths, np.nan)], axis=1))


def _join_rides(first, second):
    """Two rides of one part, one after the other, as one."""
    paths = np.array(_doubled(first).paths)
    later, count = np.array(second.paths), int(np.isfinite(first.paths[0, :, 0]).sum())
    later[:, :, 0] += first.seconds[0]
    paths[:, count : count + later.shape[1]] = later
    values = {column.name: getattr(second, column.name) for column in fields(runs.Runs)}
    values |= {
        "seconds": first.seconds + second.seconds,
        "distances": first.distances + second.distances,
        "paths": paths,
    }
    values |= {name: np.maximum(getattr(first, name), getattr(second, name)) for name in ("depths", "gains")}
    return runs.Runs(**values)
