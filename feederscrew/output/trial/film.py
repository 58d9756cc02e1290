"""A trial in its bowl to be looked at: parts at the device that decides, stills and film, then the queue."""

import math
import os
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import shapely
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation, Slerp

from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.errors import FeederError, MissingPackage
from feederscrew.base.units import MM
from feederscrew.output import DPI, shading, style
from feederscrew.output.shading import STEEL_COLOUR, Camera, Mesh, Rays, join_meshes
from feederscrew.output.tooling_views import camera_at
from feederscrew.output.trial import rides as shown
from feederscrew.output.trial.figures import LOOKS, solids
from feederscrew.output.trial.rides import WALL, DeviceRide
from feederscrew.part.record import Part
from feederscrew.sorting import solid
from feederscrew.sorting.tooled_track import along_wall
from feederscrew.trials.course import Fate
from feederscrew.trials.queue_counts import QueuedParts
from feederscrew.trials.result import TrialRun
from feederscrew.trials.staging import Stage
from feederscrew.trials.trial import TrialStudy

Frame = tuple[Floats, str, str]  # image (rows, columns, 3), caption, time
ENDINGS = ("gif", "mp4", "webm")
SECONDS, FRAMES_PER_S = 10.0, 12
QUEUE_FRAMES = 60  # of them for the queue, where there is one
WIDTH, HEIGHT = 640, 400  # [px] of the picture
HEAD = 34  # [px] above it for the caption
SAMPLES = 2  # rays a pixel, each way
POT, FITTING = np.array([0.80, 0.83, 0.86]), np.array([0.33, 0.42, 0.55])  # bare bowl; sensor, nozzles
AIR = np.array([0.16, 0.56, 0.93])
SHADES = 40  # of the light on a surface: few make small files
WALL_HEIGHT, FLOOR_DEPTH = 1.1, 3.0  # of the part's radius: wall above the track, floor below it
STILLS, IN_A_ROW = 6, 3  # of one part
STILL_SIZE = (400, 280)  # [px]
GAP = 10  # [px] between stills
RIM = 24  # round all
TITLE = 54  # above a part's
LINE = 26  # below each


def require_writer(path: str | os.PathLike[str]) -> None:
    """Refuse a film that cannot be written, and say what to install.

    Parameters
    ----------
    path : str or path-like

    Raises
    ------
    FeederError
        If the name does not end in one of ``ENDINGS``, or there is no such folder.
    MissingPackage
        If it needs ffmpeg, which is not installed.
    """
    from matplotlib.animation import FFMpegWriter

    ending = Path(path).suffix.lower().removeprefix(".")
    if ending not in ENDINGS:
        raise FeederError(path, "is not a name for a film", f"end it in .{', .'.join(ENDINGS)}")
    if not Path(path).absolute().parent.is_dir():
        raise FeederError(path, "lies in no folder that exists", "make the folder first")
    if ending != "gif" and not FFMpegWriter.isAvailable():
        mend = "install ffmpeg (Debian: apt install ffmpeg), or give a name that ends in .gif"
        raise MissingPackage("film", f"of .{ending} needs ffmpeg, which is not installed", mend)


def write_film(path: str | os.PathLike[str], study: TrialStudy) -> None:
    """Write a film of ten seconds of the first run of a trial.

    Parameters
    ----------
    path : str or path
        Its ending is the format: gif, mp4, webm.
    study : TrialStudy
        The queue is seen if it has its poses: ``trial(..., frames=QUEUE_FRAMES)``.

    Raises
    ------
    FeederError
        As ``require_writer``, or if the file cannot be written.
    """
    from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter

    require_writer(path)
    target, ending = Path(path), Path(path).suffix.lower()
    writer: AbstractMovieWriter = PillowWriter(fps=FRAMES_PER_S)
    if ending != ".gif":
        webm = ending == ".webm"
        codec = ("libvpx-vp9", "-b:v", "0", "-crf", "36") if webm else ("libx264", "-crf", "23")
        options = ["-c:v", *codec, "-pix_fmt", "yuv420p", "-map_metadata", "-1", "-fflags", "+bitexact"]
        writer = FFMpegWriter(fps=FRAMES_PER_S, extra_args=options)
    figure = style.page(WIDTH, HEIGHT + HEAD)
    axes = figure.add_axes((0.0, 0.0, 1.0, HEIGHT / (HEIGHT + HEAD)))
    axes.set_axis_off()
    shot = axes.imshow(np.ones((HEIGHT, WIDTH, 3)), interpolation="nearest", aspect="auto")
    place = {"y": 1.0 - 0.5 * HEAD / (HEIGHT + HEAD), "va": "center", "color": style.INK}
    caption = figure.text(12 / WIDTH, s="", fontsize=9, fontweight="bold", **place)
    clock = figure.text(1.0 - 12 / WIDTH, s="", fontsize=8, ha="right", **place)
    try:
        with tempfile.TemporaryDirectory(prefix=".feeder.", dir=target.absolute().parent) as folder:
            unfinished = Path(folder) / f"film{ending}"
            with writer.saving(figure, unfinished, dpi=DPI):
                for image, words, time in film_frames(study.part, study.runs[0]):
                    shot.set_data(image)
                    caption.set_text(words)
                    clock.set_text(time)
                    writer.grab_frame()
            unfinished.replace(target)
    except OSError as error:
        mend = "give a name in a folder that may be written to"
        raise FeederError(path, f"cannot be written ({error.strerror})", mend) from error


def film_frames(part: Part, run: TrialRun) -> Iterator[Frame]:
    """Yield the frames of a film: single parts, then the queue.

    Parameters
    ----------
    part : Part
    run : TrialRun

    Yields
    ------
    Frame
        Image (rows, columns, 3), caption, and time.
    """
    queue = run.queue if run.queue is not None and len(run.queue.poses) else None
    frames = round(SECONDS * FRAMES_PER_S) - (0 if queue is None else QUEUE_FRAMES)
    rides = shown.rides_to_show(part, run)
    places = np.concatenate([ride.path[:, 1:4] for ride in rides])
    scene = FilmSet(part, run, run.course.stations[rides[0].place], places)
    for k, ride in enumerate(rides):
        count = frames * (k + 1) // len(rides) - frames * k // len(rides)
        path = ride.path
        moved = np.flatnonzero(np.abs(path[:, 1:4] - path[-1, 1:4]).max(axis=1) > 5e-5)  # [m]
        begin, end = path[0, 0], path[min(moved[-1] + 1 if len(moved) else 0, len(path) - 1), 0]
        moving = max(count - round(0.4 * FRAMES_PER_S), 1)  # a part that has ended stays to be seen
        speed = _speed((end - begin) / (moving / FRAMES_PER_S))
        times = np.minimum(np.linspace(begin, end + (end - begin) * (count - moving) / moving, count), end)
        before = begin
        for time, pose in zip(times, _poses(path, times)):
            image = scene.drawn(pose[None], [_colour(ride)], _jets_blow(scene, ride, before, time))
            yield image, ride.title(run.course), f"{time - begin:.2f} s, {speed}"
            before = time
    if queue is not None:
        yield from _queue(part, run, queue)


class FilmSet:
    """A stretch of tooled track, ``stage``, in its bowl, seen by a camera that stands still; drawn once.

    All ``places`` (K, 3) [m] where parts come are to be seen; ``size`` are the pixels of the picture.
    """

    def __init__(
        self, part: Part, run: TrialRun, stage: Stage, places: Floats, size: tuple[int, int] | None = None
    ) -> None:
        columns, rows = size or (WIDTH, HEIGHT)
        self.part = Rays(np.asarray(part.vertices), np.asarray(part.faces), part.centre_of_mass)
        self.principal = Rotation.from_matrix(np.array(run.course.principal)).inv()
        radius = run.bowl.track.radius
        angles = along_wall(places[:, :2], radius, stage.middle) / radius
        self.camera = camera_at(0.5 * (angles.min() + angles.max()))
        track = shown.section(stage, run.bowl.track, WALL_HEIGHT * self.part.size)
        pot = _bowl_around(stage, run, WALL_HEIGHT * self.part.size, FLOOR_DEPTH * self.part.size)
        bodies = [track, pot, *shown.fittings(stage, radius, self.part.size)]
        (corners, faces), room, lowered = join_meshes(bodies), 1.5, 0.12
        if np.ptp(angles) > 1.2:
            # of a long stretch the whole bowl, more steeply down, over the wall that is nearer
            to_viewer = self.camera.towards_viewer * [0.45, 0.45, 1.0]
            to_viewer /= np.linalg.norm(to_viewer)
            right, places, room, lowered = self.camera.right, corners, 1.05, 0.0
            self.camera = Camera(right, np.cross(to_viewer, right), to_viewer)
        flat = self.camera.project(places)
        spans = np.ptp(flat, axis=0) + (0.0 if places is corners else 3.0 * self.part.size)
        half = 0.5 * room * max(spans[0], spans[1] * columns / rows)
        middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        middle[1] -= lowered * half  # below the parts
        self.centre = middle @ np.array([self.camera.right, self.camera.up])
        self.centre += (places.mean(axis=0) @ self.camera.towards_viewer) * self.camera.towards_viewer
        rays = Rays(corners, faces, self.centre)
        pixel = 2.0 * half / columns
        frame = shading.Shot(-half, -0.5 * rows * pixel, pixel, columns, rows)
        self.across, self.up = frame.positions(SAMPLES)  # [m]
        depths, normals, facets = self.camera.meet(rays, self.across / rays.size, self.up / rays.size)
        self.samples = np.ones((*depths.shape, 3))
        ends = np.cumsum([0, len(track[1]), len(pot[1]), len(faces)])
        for first, last, colour in zip(ends, ends[1:], (shading.METAL, POT, FITTING)):
            mask = (facets != shading.MISSED) & (first <= facets) & (facets < last)
            self.samples[mask] = _shade(normals[mask], self.camera, colour)
        step = (self.up[0] - self.up[1]) / rays.size
        self.samples[shading.edges(depths, normals, self.camera, step)] = shading.EDGE_COLOUR
        self.image = shading.average_samples(self.samples, SAMPLES)
        self.nearness = (shading.AWAY - depths) * rays.size  # [m] towards the viewer; -inf where nothing is
        self.air = []  # of each jet, how much of each pixel (rows, columns, 1) its cone covers, from 0 to 1
        for cone in shown.air_cones(stage, run.bowl.track.width):
            rays = Rays(*cone, self.centre)
            depths = self.camera.meet(rays, self.across / rays.size, self.up / rays.size)[0]
            covered = np.isfinite(depths) & ((shading.AWAY - depths) * rays.size > self.nearness)
            covered = np.repeat(covered[..., None].astype(float), 3, axis=2)
            self.air.append(shading.average_samples(covered, SAMPLES)[..., :1])

    def drawn(self, poses: Floats, colours: list[Floats], jets_blow: Sequence[bool] = ()) -> Floats:
        """Return the image with parts in their poses, and their air.

        Parameters
        ----------
        poses : (N, 7) array
            Places [m] and attitudes w x y z; a part whose pose is not finite is left out.
        colours : list of array
            Of each part.
        jets_blow : sequence of bool, optional
            Whether each jet blows.

        Returns
        -------
        (R, C, 3) array
        """
        samples, nearness, image = self.samples.copy(), self.nearness.copy(), self.image.copy()
        there = [(pose, colour) for pose, colour in zip(poses, colours) if np.isfinite(pose).all()]
        boxes = [self._draw(samples, nearness, pose, colour) for pose, colour in there]
        for box in filter(None, boxes):
            pixels = tuple(slice(side.start // SAMPLES, side.stop // SAMPLES) for side in box)
            image[pixels] = shading.average_samples(samples[box], SAMPLES)
        for cloud, blows in zip(self.air, jets_blow):
            if blows:
                image += 0.38 * cloud * (AIR - image)
        return image

    def _draw(
        self, samples: Floats, nearness: Floats, pose: Floats, colour: Floats
    ) -> tuple[slice, slice] | None:
        """Add one part, its rays cast along its own axes: its mesh is prepared once; where it is drawn."""
        turn = (Rotation.from_quat(pose[[4, 5, 6, 3]]) * self.principal).as_matrix()
        axes = [turn.T @ axis for axis in (self.camera.right, self.camera.up, self.camera.towards_viewer)]
        camera, size = Camera(*axes), self.part.size
        offset = pose[:3] - self.centre
        x, y = offset @ self.camera.right, offset @ self.camera.up
        low, high = (end(camera.project(self.part.points), axis=0) * size for end in (np.min, np.max))
        columns = _whole_pixels((self.across > x + low[0]) & (self.across < x + high[0]))
        rows = _whole_pixels((self.up > y + low[1]) & (self.up < y + high[1]))
        if rows is None or columns is None:
            return None
        box = rows, columns
        across, up = (self.across[columns] - x) / size, (self.up[rows] - y) / size
        depths, normals, _ = camera.meet(self.part, across, up)
        own = (shading.AWAY - depths) * size + offset @ self.camera.towards_viewer
        inside = np.isfinite(depths)
        shades = np.ones((*depths.shape, 3))
        shades[inside] = _shade(normals[inside], camera, colour)
        edges = shading.edges(depths, normals, camera, (self.up[0] - self.up[1]) / size)
        shades[edges & inside] = shading.EDGE_COLOUR
        front = inside & (own >= nearness[box] - 1e-3 * size)
        hidden = inside & ~front
        samples[box][front] = shades[front]
        samples[box][hidden] += 0.45 * (shades[hidden] - samples[box][hidden])
        nearness[box][front] = own[front]
        return box


def _shade(normals: Floats, camera: Camera, colour: Floats) -> Floats:
    return np.round(shading.lit(normals, camera, np.ones(3)) * SHADES) / SHADES * colour


def _whole_pixels(covered: Bools) -> slice | None:
    """The range of samples from the first to the last that is covered, in whole pixels; None without one."""
    places = np.flatnonzero(covered)
    if not len(places):
        return None
    return slice(places[0] // SAMPLES * SAMPLES, -(-(places[-1] + 1) // SAMPLES) * SAMPLES)


def _bowl_around(stage: Stage, run: TrialRun, above: float, below: float) -> Mesh:
    """The rest of the bowl as a mesh: bare track and wall over the rest of the turn, a floor below."""
    radius, width = run.bowl.track.radius, run.bowl.track.width
    corners = np.concatenate(solids(stage))
    along = along_wall(corners, radius, stage.middle)
    first, last = along.min() / radius, along.max() / radius
    middle = shapely.Point(0.0, radius)
    inner, full, outer = (middle.buffer(r, quad_segs=64) for r in (radius - width, radius, radius + WALL))
    deep = -stage.plates.depth[0]
    bodies = [solid.prism(outer, -below - WALL, -below), solid.prism(outer.difference(full), -below, deep)]
    if last - first < 2.0 * math.pi - 0.05:
        turns = np.linspace(last, first + 2.0 * math.pi, 181)
        edge = 3.0 * radius * np.column_stack([np.sin(turns), -np.cos(turns)]) + [0.0, radius]
        rest = shapely.make_valid(shapely.Polygon([(0.0, radius), *edge]))
        for area, low, high in ((full.difference(inner), deep, 0.0), (outer.difference(full), deep, above)):
            bodies.append(solid.prism(area.intersection(rest), low, high))
    return join_meshes(bodies)


def _poses(path: Floats, times: Floats) -> Floats:
    """Position [m] and attitude w x y z (K, 7) of a part at times (K,) [s] of its path."""
    if len(path) == 1:
        return np.tile(path[-1, 1:], (len(times), 1))
    places = np.column_stack([np.interp(times, path[:, 0], path[:, k]) for k in (1, 2, 3)])
    turns = Slerp(path[:, 0], Rotation.from_quat(path[:, [5, 6, 7, 4]]))(times).as_quat()
    return np.column_stack([places, turns[:, [3, 0, 1, 2]]])


def _colour(ride: DeviceRide) -> Floats:
    if ride.fate is Fate.PASSED:
        return STEEL_COLOUR
    return np.array([int(LOOKS[ride.fate][0][n : n + 2], 16) / 255 for n in (1, 3, 5)])


def _jets_blow(scene: FilmSet, ride: DeviceRide, begin: float, end: float) -> list[bool]:
    on = ride.blows is not None and ride.blows[0] <= end and begin < ride.blows[1]
    return [on] * len(scene.air)


def _queue(part: Part, run: TrialRun, queue: QueuedParts) -> Iterator[Frame]:
    places = queue.poses[..., :3].reshape(-1, 3)
    lowest = -FLOOR_DEPTH * float(np.linalg.norm(part.corners, axis=1).max())
    places = places[np.isfinite(places[:, 0]) & (places[:, 2] > lowest)]
    if queue.stage is None or not len(places):
        return
    scene, air = FilmSet(part, run, queue.stage, places), queue.stage.air
    speed = _speed(queue.seconds / (len(queue.poses) / FRAMES_PER_S))
    before = 0.0
    for poses, (time, left, returned) in zip(queue.poses, queue.moments):
        blowing = np.isinf(air.jets.end) & (air.jets.begin <= 0.0)  # the steady ones
        for watch, pulses in zip(air.watches, queue.pulses):
            blowing[watch.jets] = any(begin <= time and before < end for begin, end in pulses)
        words = f"queue of {queue.parts}: {left} left, {returned} returned"
        image = scene.drawn(poses, [STEEL_COLOUR] * len(poses), blowing.tolist())
        yield image, words, f"{time:.2f} s, {speed}"
        before = time


def _speed(times: float) -> str:
    """'real time', '2.5 times as fast' or '4 times slower': seconds of the trial in one of the film."""
    if 0.95 < times < 1.05:
        return "real time"
    return f"{times:.2g} times as fast" if times > 1.0 else f"{1.0 / max(times, 1e-9):.2g} times slower"


def stills(part: Part, run: TrialRun) -> Figure:
    """Draw six moments of one part that passes the device that decides, and of one that is lost there.

    Parameters
    ----------
    part : Part
    run : TrialRun

    Returns
    -------
    matplotlib.figure.Figure
    """
    rides, (wide, high) = shown.rides_to_show(part, run), STILL_SIZE
    panels = style.Panels(IN_A_ROW, wide, [high] * (STILLS // IN_A_ROW), LINE, TITLE, 0, RIM, GAP)
    width, block = panels.page  # of one part
    height = RIM + len(rides) * block
    figure, page = style.sheet(width, height)
    radius = float(np.linalg.norm(part.corners, axis=1).max())
    for row, ride in enumerate(rides):
        top = height - row * block
        page.text(RIM, top - 30, ride.title(run.course), fontsize=11, fontweight="bold", color=style.INK)
        times = still_times(ride, radius)
        poses = _poses(ride.path, times)
        scene = FilmSet(part, run, run.course.stations[ride.place], poses[:, :3], STILL_SIZE)
        for k, (time, pose) in enumerate(zip(times, poses)):
            left, foot, _, _ = panels.place(k)
            foot += top - block
            axes = style.inset(figure, page, (left, foot, wide, high), xticks=[], yticks=[])
            axes.spines[:].set_color(style.FAINT)
            blowing = _jets_blow(scene, ride, time, time)
            axes.imshow(scene.drawn(pose[None], [_colour(ride)], blowing), interpolation="nearest")
            words = f"{time:.2f} s, {pose[2] / MM:.1f} mm high" + ", the sensor looks" * bool(
                time == ride.looked
            )
            words += ", air blows" * (any(blowing) and ride.blows != shown.ALWAYS)
            page.text(left + 4, foot - 16, words, fontsize=7, color=style.INK)
    return figure


def still_times(ride: DeviceRide, radius: float) -> Floats:
    """Return moments of a ride, evenly along way, fall and turns.

    One is when the sensor looks, one in the middle of the pulse of air, or as the part is gone before it.

    Parameters
    ----------
    ride : DeviceRide
    radius : float [m]
        Of the part.

    Returns
    -------
    (STILLS,) float [s]
    """
    path = ride.path
    turns = Rotation.from_quat(path[:, [5, 6, 7, 4]])
    moves = np.linalg.norm(np.diff(path[:, 1:4], axis=0), axis=1)
    arcs = 0.5 * radius * (turns[1:] * turns[:-1].inv()).magnitude()
    progress = np.concatenate([[0.0], np.cumsum(moves + arcs)])
    progress += 1e-12 * np.arange(len(progress))  # a part at rest has one place for many times
    times = np.interp(np.linspace(0.12, 1.0, STILLS) * progress[-1], progress, path[:, 0])
    middle = np.nan if ride.blows in (None, shown.ALWAYS) else min(0.5 * sum(ride.blows), path[-1, 0])
    for moment in (ride.looked, middle):
        if path[0, 0] < moment <= path[-1, 0]:
            free = [k for k in range(STILLS) if times[k] != ride.looked]
            times[min(free, key=lambda k: abs(times[k] - moment))] = moment
    return np.sort(times)
