"""Parts one at a time past one station: starts, runs on several cores, and what became of them.

With it what a sensor along the track sees of a part that comes by, and the pulse that it sets off.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple, cast

import numpy as np

from feederscrew.arrivals import plate_test
from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.arrivals.pool import in_batches
from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import on_disk, zero_rows
from feederscrew.bowl.devices.features import Sensor
from feederscrew.bowl.record import Bowl
from feederscrew.sorting import sensor_views
from feederscrew.sorting.orientations import Orientation
from feederscrew.trials import part_poses, staging
from feederscrew.trials.kernel import travel, workspace
from feederscrew.trials.kernel.plate_views import BLOCK
from feederscrew.trials.kernel.track_contacts import WAYS
from feederscrew.trials.kernel.workspace import Limits, QueueSteps, Rows, Solo, Surface, TrueSolid, Workspace
from feederscrew.trials.part_poses import States
from feederscrew.trials.staging import Stage

RUNNING = travel.RUNNING
PASSED = travel.PASSED
RETURNED = travel.RETURNED
STANDS = travel.STANDS
ROLLED = travel.ROLLED
OVER_EDGE_SHARE = 0.1  # of its size: with its centre of mass so far over the free edge a part does not return
# steps of a period of the drive
STEPS_OF_PERIOD = 48
STEPS_OF_HOPPING = 96  # where parts hop
# of the contact solver
SWEEPS = 60  # at most
SWEEP_TOLERANCE = 1e-4  # what a sweep may still change
BORDER_EXTENSION = 5e-3  # of the unit of length: a border goes on so far where its corner is not convex
PARTS_PER_TASK = 5  # parts a core takes at a time
STANDING_SPEED_M_S = 1e-3  # below which a part stands
MAX_TRACK_CONTACTS = 96  # of a part with the track at a time
MAX_PAIR_CONTACTS = 400  # contacts between parts at a time
PARTNERS = 8  # other parts of which a part has lists
MAX_NEAR_FACES = 400  # corners and faces that are listed of two parts: where more are near, none are
MAX_CROSSINGS = 800  # edges of both, the same
MAX_NEAR_EDGES = 4000  # edges near borders at a time, and faces near their corners
MEAN_BORDERS_PER_CORNER = 12  # borders near a corner, in the mean
NO_CROWD = QueueSteps(active=np.zeros(0, bool), time=0.0, steps=0, journals=zero_rows(1, workspace.JOURNAL))
NO_PARTS_SENT = Solo(
    limits=Limits(*(0.0 for _ in Limits._fields)),
    states=np.zeros((0, body.STATE)),
    times=np.zeros(0),
    stride=1,
    paths=np.zeros((0, 0, 8)),
    journals=zero_rows(0, workspace.JOURNAL),
    outcomes=np.zeros(0, np.int64),
)


@dataclass(frozen=True, eq=False)
class Runs:
    """Outcomes of N parts at one station, in SI units; K places of each."""

    outcomes: Ints  # (N,) PASSED, RETURNED, STANDS, ROLLED or RUNNING
    states: Floats  # (N, 13) at the end, without dimensions
    seconds: Floats  # (N,) [s]
    distances: Floats  # (N,) [m] along the wall
    depths: Floats  # (N,) [m] the deepest that anything was in anything
    gains: Floats  # (N,) [m] largest rise of the energy over what gravity and the drive gave, as a height
    paths: Floats  # (N, K, 8) time [s], position [m], attitude; NaN after the end
    partial: bool  # stopped by the user before all parts were done


RUN_COLUMNS = tuple(field.name for field in fields(Runs) if field.name != "partial")


@dataclass(frozen=True, eq=False)
class BowlOfPart:
    """A part in a bowl, without dimensions."""

    solid: TrueSolid
    length: float  # [m] the unit of length
    unit: float  # [s] the unit of time
    floor: Floor
    radius: float  # of the wall
    climb: float  # [rad]
    bank: float  # [rad]
    friction: Floats  # (5,)
    restitution: float
    threshold: float


class RideLimits(NamedTuple):
    """Limits of a ride: how long a part has at a station, and how often its place is noted."""

    longest: float  # [s] after which it is given up
    patience: float  # [s] in which it must get on ...
    progress: float  # [m] ... so far
    retreat: float  # [m] it may go back from where it began
    interval: float  # [s] from one place noted to the next, in whole steps
    places: int  # noted at most


# What follows parts past a station, from their states and times [s].
Follow = Callable[[States, Floats], Runs]


def setting(solid: TrueSolid, length: float, bowl: Bowl) -> BowlOfPart:
    """Return a part in a bowl, without dimensions, as the kernel takes it.

    Units are L, the length given, and sqrt(L/g). A period of the drive has ``STEPS_OF_PERIOD`` steps, or
    ``STEPS_OF_HOPPING`` where the throw number is above 1.

    Parameters
    ----------
    solid : TrueSolid
    length : float [m]
        The unit of length of the solid.
    bowl : Bowl

    Returns
    -------
    BowlOfPart
    """
    floor, track, friction = plate_test.floor_of(bowl, length), bowl.track, bowl.friction
    if bowl.drive.amplitude == 0.0:
        floor = floor._replace(along=0.0, up=0.0)
    steps = STEPS_OF_HOPPING if plate_test.throw_number(bowl) > 1.0 else STEPS_OF_PERIOD
    return BowlOfPart(
        solid=solid,
        length=length,
        unit=float(np.sqrt(length / bowl.gravity)),
        floor=floor._replace(step=2.0 * np.pi / floor.rate / steps),
        radius=track.radius / length,
        climb=track.climb,
        bank=track.bank,
        friction=np.array([friction.static, friction.kinetic, *friction.backward, friction.wall]),
        restitution=bowl.restitution,
        threshold=plate_test.steps_of(floor).threshold,
    )


def ride(
    follow: Follow,
    states: States,
    times: Floats,
    *,
    jobs: int = 1,
    progress: Callable[[int], None] | None = None,
) -> Runs:
    """Follow parts past one station, on several cores.

    Parameters
    ----------
    follow : Follow
        As ``make_follower`` returns it.
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        In which parts begin.
    times : (N,) float [s]
        When they begin: the phase of the drive.
    jobs : int, optional
        Cores; the outcome does not depend on it.
    progress : callable, optional
        Told after every batch how many parts are done.

    Returns
    -------
    Runs
        After an interrupt from the keyboard those of the batches finished, up to the first that was not.

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """
    follow(states[:0], times[:0])  # compiled here, if need be

    def batch(cut: slice) -> list[Array]:
        runs = follow(states[cut], times[cut])
        return [getattr(runs, name) for name in RUN_COLUMNS]

    columns, stopped = in_batches(batch, len(states), PARTS_PER_TASK, jobs, progress)
    return Runs(**{name: check.frozen(value) for name, value in zip(RUN_COLUMNS, columns)}, partial=stopped)


def join_runs(rides: Sequence[Runs]) -> Runs:
    """Return the Runs of several parts at one station as one.

    Parameters
    ----------
    rides : sequence of Runs
        All with as many places; one at least.

    Returns
    -------
    Runs
        In their order, not partial.
    """
    columns = {name: np.concatenate([getattr(ride, name) for ride in rides]) for name in RUN_COLUMNS}
    return Runs(**{name: check.frozen(value) for name, value in columns.items()}, partial=False)


def is_compiled() -> bool:
    """Tell whether the kernel of the trial is on disk already.

    Returns
    -------
    bool
    """
    return on_disk(travel.ride)


def make_plain_follower(part_in_bowl: BowlOfPart, station: Stage, limits: RideLimits) -> Follow:
    """Return the function that follows parts past one station, one after the other; no sensor looks.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    station : Stage
    limits : RideLimits

    Returns
    -------
    Follow
        From states (N, 13) and times (N,) [s] to Runs.
    """
    length, unit, width = part_in_bowl.length, part_in_bowl.unit, station.width / part_in_bowl.length
    surface = surface_of(part_in_bowl, station)
    bounds = Limits(
        exit=station.exit / length,
        drop=station.drop / length,
        fall_height=-np.inf if station.leaves_hanging else -station.drop / length,
        longest=limits.longest / unit,
        patience=limits.patience / unit,
        progress=limits.progress / length,
        back_limit=(station.begin - limits.retreat) / length,
        edge=width,
        free=width + OVER_EDGE_SHARE * part_in_bowl.solid.radius,
    )
    stride = max(round(limits.interval / unit / part_in_bowl.floor.step), 1)

    def follow(states: States, times: Floats) -> Runs:
        ends, count = np.array(states, float), len(states)
        outcomes, journals = np.zeros(count, np.int64), zero_rows(count, workspace.JOURNAL)
        paths = np.full((count, limits.places, 8), np.nan)
        solo = Solo(bounds, ends, np.asarray(times) / unit, stride, paths, journals, outcomes)
        work = workspace_of(part_in_bowl.solid, surface, 1)
        travel.ride(surface, part_in_bowl.solid, part_in_bowl.floor, work, solo, NO_CROWD)
        paths *= np.array([unit, length, length, length, 1.0, 1.0, 1.0, 1.0])
        return Runs(
            outcomes=outcomes,
            states=ends,
            seconds=journals.time * unit,
            distances=journals.way * length,
            depths=journals.depth * length,
            gains=journals.gain * length,
            paths=paths,
            partial=False,
        )

    return follow


def surface_of(part_in_bowl: BowlOfPart, station: Stage) -> Surface:
    """Return a station without dimensions, as the kernel takes it.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    station : Stage

    Returns
    -------
    Surface
        Its jets are its own: a sensor sets them off in place.
    """
    length = part_in_bowl.length
    plates, borders = station.plates.copy(), station.borders.copy()
    box = ("least_x", "most_x", "least_y", "most_y")
    for name in ("origin_x", "origin_y", "origin_z", "depth", "rounding", *box):
        plates[name] /= length
    for name in ("start_x", "start_y", "end_x", "end_y"):
        borders[name] /= length
    # How far borders go on within the solid before their starts and behind their ends. At a corner that is
    # not convex the solid goes on behind either: an edge that comes down into it meets the one or the other.
    starts = np.column_stack([borders.start_x, borders.start_y])
    ends = np.column_stack([borders.end_x, borders.end_y])
    shares = BORDER_EXTENSION / np.hypot(*(ends - starts).T)
    borders["extension_start"] = np.where(borders.convex, 0.0, shares)
    for plate in plates:
        own = slice(plate.begin, plate.end)
        near = [np.argmin(((starts[own] - end) ** 2).sum(axis=1)) for end in ends[own]]
        after = plate.begin + np.array(near)
        borders["extension_end"][own] = np.where(borders.convex[after], 0.0, shares[own])
    slopes = station.air.slopes
    return Surface(
        radius=part_in_bowl.radius,
        middle=station.middle / length,
        slopes=staging.tabulate_leans(slopes, part_in_bowl.climb, part_in_bowl.bank, station.size, length),
        plates=plates,
        borders=borders,
        jets=staging.scale_jets(station.air.jets, length, part_in_bowl.unit),
        friction=part_in_bowl.friction,
        restitution=part_in_bowl.restitution,
        threshold=part_in_bowl.threshold,
        sweeps=SWEEPS,
        tolerance=SWEEP_TOLERANCE,
    )


def workspace_of(solid: TrueSolid, surface: Surface, count: int) -> Workspace:
    """Return the arrays in which the kernel works, empty.

    Parameters
    ----------
    solid : TrueSolid
    surface : Surface
    count : int
        Of parts.

    Returns
    -------
    Workspace
        In [L, sqrt(g L), 1, sqrt(g/L)].
    """
    corners, edges, plates = len(solid.corners), len(solid.edges), len(surface.plates)
    circles, borders = len(solid.circles), len(surface.borders)
    pairs, lists = (2 * MAX_PAIR_CONTACTS, PARTNERS) if count > 1 else (0, 0)

    def numbers(*shape: int) -> Floats:
        return np.zeros((count, *shape))

    def places(*shape: int) -> Ints:
        return np.zeros((count, *shape), np.int64)

    def records(kind: np.dtype, *shape: int) -> Rows:
        return zero_rows((count, *shape), kind)

    work = Workspace(
        states=numbers(body.STATE),
        starts=numbers(body.STATE),
        push=numbers(body.STATE),
        turns=numbers(9),
        reaches=numbers(),
        tangents=numbers(2),
        leans=numbers(7),
        changes=numbers(6),
        free_rates=numbers(3),
        jet_loads=numbers(6),
        jets_until=numbers(),
        contacts=records(workspace.CONTACT, MAX_TRACK_CONTACTS),
        counts=places(),
        last_impulses=records(workspace.IMPULSES, MAX_TRACK_CONTACTS),
        last_counts=places(),
        last_steps=numbers(),
        list_states=records(workspace.LIST_STATE),
        ends=records(workspace.LIST_COUNTS, plates + 1),
        list_counts=zero_rows(1, workspace.LIST_COUNTS),
        near_corners=records(workspace.NEAR_CORNER, 2 * corners),
        groups=numbers(2 * corners // BLOCK + 1, 6),
        sides=places(MEAN_BORDERS_PER_CORNER * corners + 100),
        near_edges=records(workspace.NEAR_EDGE, MAX_NEAR_EDGES),
        near_posts=records(workspace.NEAR_POST, MAX_NEAR_EDGES),
        near_faces=records(workspace.NEAR_FACE, MAX_NEAR_EDGES),
        near_circles=records(workspace.NEAR_CIRCLE, plates * circles),
        rounds=places(borders),
        wall_corners=records(workspace.NEAR_WALL, corners),
        wall_circles=places(circles),
        frame=np.zeros(12),
        views=np.zeros((corners, 3)),
        view_corners=np.zeros(corners, np.int64),
        blocks=np.zeros(edges, np.int64),
        indices=np.zeros(max(corners, MAX_TRACK_CONTACTS), np.int64),
        supports=zero_rows(corners + 8 * circles + 2 * MAX_TRACK_CONTACTS, workspace.SUPPORT),
        best=np.zeros((WAYS + 1, 2)),
        borders_near=np.zeros(max(borders, 1), np.int64),
        borders_close=np.zeros(max(borders, 1), np.int64),
        dips=np.zeros(borders),
        box=np.zeros(6),
        pairs=zero_rows(pairs, workspace.CONTACT),
        owners=np.zeros(pairs, np.int64),
        pair_rows=np.zeros(1, np.int64),
        pair_lists=records(workspace.PAIR_LISTS, lists),
        next_lists=places(),
        pair_frames=numbers(lists, 12),
        own_corners=records(workspace.PAIR_NEAR, lists, MAX_NEAR_FACES),
        their_corners=records(workspace.PAIR_NEAR, lists, MAX_NEAR_FACES),
        near_crossings=records(workspace.PAIR_NEAR, lists, MAX_CROSSINGS),
        faces_of_corner=zero_rows(len(solid.triangles) if lists else 0, workspace.PAIR_NEAR),
        strains=numbers(2),
        depths=numbers(2),
        order=places(),
        islands=np.zeros(count + 1, np.int64),
        least=np.array(solid.vertices.min(axis=0)),
        most=np.array(solid.vertices.max(axis=0)),
        first_edges=np.zeros(edges, np.int64),
        second_blocks=np.zeros(edges, np.int64),
        face_blocks=np.zeros(len(solid.triangles), np.int64),
    )
    work.pair_lists["partner"] = -1
    forget(work, slice(None))
    return work


def forget(work: Workspace, n: int | slice) -> None:
    """Let no list of a part hold, and no impulse or jet be known of it.

    Parameters
    ----------
    work : Workspace
        Changed in place.
    n : int or slice
        The part, or some.
    """
    work.list_states["reach"][n] = work.last_steps[n] = work.jets_until[n] = -1.0


def move_crowd(part_in_bowl: BowlOfPart, surface: Surface, work: Workspace, crowd: QueueSteps) -> None:
    """Move a crowd on, all of it at once.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    surface : Surface
    work : Workspace
        Its states move; ``strains`` and ``depths`` are filled.
    crowd : QueueSteps
        Which parts, from when on and how many steps; its journal is filled.
    """
    work.strains[:] = work.depths[:] = 0.0
    travel.ride(surface, part_in_bowl.solid, part_in_bowl.floor, work, NO_PARTS_SENT, crowd)


def make_follower(part_in_bowl: BowlOfPart, station: Stage, limits: RideLimits) -> Follow:
    """Return the function that follows parts past one station, with what its sensor does.

    As its centre of mass comes to the sensor a part is looked at; if it differs, jets blow as it comes to
    them at its mean speed, as long as their pulse is. Without a sensor the station is one ride.

    Parameters
    ----------
    part_in_bowl : BowlOfPart
    station : Stage
        Of its sensors the first looks.
    limits : RideLimits

    Returns
    -------
    Follow
        From states (N, 13) and times (N,) [s] to Runs. With a sensor it takes one part at a time, or none.
    """
    if not station.air.watches:
        return make_plain_follower(part_in_bowl, station, limits)
    watch = station.air.watches[0]
    before = make_plain_follower(part_in_bowl, replace(station, exit=watch.place), limits)
    still = make_plain_follower(part_in_bowl, station, limits)

    def follow(states: States, times: Floats) -> Runs:
        first = before(states, times)
        # as many places again
        room = np.concatenate([first.paths, np.full_like(first.paths, np.nan)], axis=1)
        if not len(states) or first.outcomes[0] != PASSED:
            return replace(first, paths=room)
        now, rest = times + first.seconds, still
        if blows_off(watch.sensor, part_in_bowl, first.states):  # and sets off its jets
            speed = max((first.distances / first.seconds)[0], STANDING_SPEED_M_S)
            begin, jets = now[0] + (watch.nozzles - watch.place) / speed, station.air.jets.copy()
            jets.begin[watch.jets], jets.end[watch.jets] = begin, begin + watch.seconds
            blown = replace(station, air=replace(station.air, jets=jets))
            rest = make_plain_follower(part_in_bowl, blown, limits)
        # Both rides as one.
        second = rest(first.states, now)
        later, count = np.array(second.paths), int(np.isfinite(first.paths[0, :, 0]).sum())
        later[:, :, 0] += first.seconds[0]
        room[:, count : count + later.shape[1]] = later
        return replace(
            second,
            seconds=first.seconds + second.seconds,
            distances=first.distances + second.distances,
            paths=room,
            depths=np.maximum(first.depths, second.depths),
            gains=np.maximum(first.gains, second.gains),
        )

    return follow


def blows_off(sensor: Sensor, part_in_bowl: BowlOfPart, states: States, level: float = 0.0) -> bool:
    """Tell whether a sensor sees parts differ from all that it wants by more than its play.

    Parameters
    ----------
    sensor : Sensor
    part_in_bowl : BowlOfPart
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        Of the part before the sensor, and of others that it cannot tell from that one.
    level : float [m], optional
        Of the track there.

    Returns
    -------
    bool
    """
    fine, solid = sensor.resolution, part_in_bowl.solid
    # corners (V, 3) [m] of each, as seen at the place of the first one: along the wall, inwards, up
    back = -part_poses.ways_along_wall(states[:1], part_in_bowl.radius)[0]
    parts = [
        part_in_bowl.length * (there[:3] + vectors.product(solid.vertices, part_poses.matrix(there).T))
        for there in part_poses.move_along_wall(states, back, part_in_bowl.radius)
    ]
    if sensor.sees == "height":
        top = max(spots[:, 2].max() for spots in parts) - level
        top = np.round(top / fine) * fine if fine > 0.0 else top
        return all(abs(top - view.height) > sensor.play for view in sensor.wanted)
    faces = np.concatenate([solid.triangles + k * len(solid.vertices) for k in range(len(states))])
    spots = np.concatenate(parts) - [0.0, 0.0, level]
    for view in cast(tuple[Orientation, ...], sensor.wanted):
        area = sensor_views.visible_area(spots, faces, sensor.sees, fine, view.distance)
        wanted = sensor_views.outline(view, sensor.sees, view.distance)
        if sensor.sees == "outline":
            differs = sensor_views.fit_difference(area, wanted, sensor.play)
        else:
            differs = sensor_views.outline_distance(area, wanted)
        if not differs > sensor.play:
            return False
    return True
