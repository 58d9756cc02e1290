"""The part in three dimensions over a cut: the orientation that leaves, and the nearest that falls."""

from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.patches import Polygon

from feederscrew.geometry.polygons import turned
from feederscrew.output import shading, style
from feederscrew.output.shading import Camera
from feederscrew.output.tooling_figures import PASSED_COLOUR, REJECTED_COLOUR, margin_words
from feederscrew.tooling import solid, track_sections
from feederscrew.tooling.isolating.proposal import (
    LEAST_SHARE,  # what comes less often is not the nearest that falls
)
from feederscrew.tooling.track_sections import build_section

VIEW_WIDTH_PX, VIEW_HEIGHT_PX, VIEW_HEAD_PX = 620, 520, 96  # pixels of one view and of the lines over it
TO_VIEWER = np.array([0.55, 0.80, 0.85])  # to the viewer: ahead, inwards, up
CAMERA_TURNS_RAD = np.radians(
    [0.0, -69.0, -35.0, 25.0, -95.0]
)  # [rad] of the view about the upright; the first that shows enough
MIN_SHOWN_SHARE = 0.9  # [1] of the part that a view shows
SENSOR_COLOUR, SENSOR_LINE = (
    "#009e73",
    1.15,
)  # colour of sensor and nozzles; heights of the part that a sensor is over it
CIRCLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)  # [rad]
VIEW_HALF_EXTENTS = 0.80  # of the part's largest extent, to each side of it


def figure(devices, orientations, shares, wanted):
    """Draw the wanted orientation over the cut that it passes least, and the nearest of those that fall.

    Parameters
    ----------
    devices : sequence of Device
    orientations : sequence of Orientation
    shares : (M,) float [1]
    wanted : int

    Returns
    -------
    Figure or None
        None where no device cuts or gates the track.
    """
    placed = [device for device in devices if device.placed]
    views = [
        view
        for view in (_leaves(placed, orientations, wanted), _falls(placed, orientations, shares, wanted))
        if view
    ]
    if not views:
        return None
    page = style.page(VIEW_WIDTH_PX * len(views), VIEW_HEAD_PX + VIEW_HEIGHT_PX)
    for place, (passage, words, colour) in enumerate(views):
        box = page.add_axes(
            (place / len(views), 0.0, 1.0 / len(views), VIEW_HEIGHT_PX / (VIEW_HEAD_PX + VIEW_HEIGHT_PX))
        )
        image, frame, camera, centre = _image(passage, orientations)
        box.imshow(image, extent=frame.extent, interpolation="none")
        _marks(box, passage, orientations, camera, centre, colour)
        _draw_air(box, passage, orientations, camera, centre)
        box.set(xlim=frame.extent[:2], ylim=frame.extent[2:])
        box.axis("off")
        for line, text in enumerate(words):
            page.text(
                (place + 0.03) / len(views), 1.0 - (30 + 24 * line) / (VIEW_HEAD_PX + VIEW_HEIGHT_PX), text,
                va="center",
                fontsize=9 if line == 0 else 7.5, color=colour, fontweight="bold" if line == 0 else "normal",
            )  # fmt: skip
    return page


def poses(devices, orientations, shares, wanted) -> list[Any]:
    """Return the passages worth a view, of what leaves and of what falls by least, each with a few words."""
    placed = [device for device in devices if device.placed]
    views = [_leaves(placed, orientations, wanted), _falls(placed, orientations, shares, wanted)]
    return [(passage, _short(passage)) for passage, _, _ in (view for view in views if view)]


def _short(passage) -> str:
    """'gap, margin +0.64 mm': device and margin."""
    if passage.orientation.kind == "hanging":
        return "in the rails"
    return f"{passage.device.name}, {margin_words(passage.verdict)}"


def _drawable(passages) -> list[Any]:
    return [passage for passage in passages if passage.picture and passage.picture != "turned"]


def _over_a_cut(passage):
    """Whether a passage leads over something that is cut out of the track."""
    return passage.picture == "above" and passage.device.cuts


def _leaves(devices, orientations, wanted) -> tuple[Any, ...] | None:
    """The passage of the wanted orientation with the least margin, with lines of text."""
    passages = _drawable(track_sections.until_returned(devices, orientations[wanted], orientations))
    if not passages:
        return None
    least = min(passages, key=lambda passage: passage.verdict.margin)
    if least.verdict.hangs:
        words = f"{least.orientation.name} hangs between the rails", "by its head, from here on"
        return replace(least, orientation=least.after), words, PASSED_COLOUR
    return least, _caption(least, "passes"), PASSED_COLOUR


def _falls(devices, orientations, shares, wanted) -> tuple[Any, ...] | None:
    """The passage of the orientation that fails by least, with lines of text."""
    rejected = []
    for k, orientation in enumerate(orientations):
        if k != wanted and shares[k] >= LEAST_SHARE and not orientation.returned:
            passages = track_sections.until_returned(devices, orientation, orientations)
            rejected += [last for last in passages[-1:] if last.verdict.passes <= 0.0 and _drawable([last])]
    if not rejected:
        return None
    nearest = max(rejected, key=lambda orientation: round(orientation.verdict.margin, 9))
    word = "falls at" if _over_a_cut(nearest) else f"is {nearest.fate} at"
    return nearest, _caption(nearest, word), REJECTED_COLOUR


def _caption(passage, word) -> tuple[Any, ...]:
    kind = passage.device.name
    where = "half way through" if passage.verdict.passes > 0.0 else "in front of it"
    if _over_a_cut(passage):
        where = "where it bears least; outline: hull of its support, dot: its weight"
    return f"{passage.orientation.name} {word} the {kind}", f"{margin_words(passage.verdict)}, {where}"


def track_below(passage, orientations) -> tuple[Any, ...]:
    """Return the section of track of a passage, as the part stands on it.

    Parameters
    ----------
    passage : Passage
    orientations : sequence of Orientation
        Of the part.

    Returns
    -------
    vertices : (V, 3) float [m]
        Ahead, inwards and up from the foot of the centre of mass.
    faces : (F, 3) int
    """
    section, orientation = station_of(passage, orientations), passage.orientation
    corners, faces = solid.solid(section)
    angle, radius = passage.angle(section.stations[0]), orientation.track.radius
    c, s, down = np.cos(angle), np.sin(angle), corners[:, 1] - radius
    ahead = c * corners[:, 0] + s * down
    from_wall = radius - s * corners[:, 0] + c * down
    return np.column_stack([ahead, from_wall - orientation.distance, corners[:, 2]]), faces


def part_on_section(passage, station) -> np.ndarray:
    """Return the corners (V, 3) [m] of the part of a passage on a track section that holds its station."""
    orientation = passage.orientation
    points = np.array(orientation.posture.surface)
    flat = turned(points[:, :2], orientation.heading) + [0.0, orientation.distance]
    return on_section(np.column_stack([flat, points[:, 2]]), passage.angle(station), orientation.track.radius)


def on_section(points, angle, radius) -> np.ndarray:
    """Return points (N, 3) [m], ahead, from the wall and up, as they lie at an angle of a track section."""
    c, s, up = np.cos(angle), np.sin(angle), radius - points[:, 1]
    return np.column_stack([c * points[:, 0] + s * up, radius + s * points[:, 0] - c * up, points[:, 2]])


def station_of(passage, orientations):
    """Return a track section with nothing but the device of a passage, and the part before it."""
    return build_section(passage.orientation.track, [passage.device], orientations, lead=1.0)


def _image(passage, orientations) -> tuple[Any, ...]:
    """The rendered view of a passage, its place, the camera, and the point in its middle."""
    section = station_of(passage, orientations)
    corners, faces = part_on_section(passage, section.stations[0]), passage.orientation.posture.solid.faces
    angle = passage.angle(section.stations[0])
    centre = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    track, sides = solid.solid(section)
    half = VIEW_HALF_EXTENTS * np.ptp(corners, axis=0).max()
    camera = clearest([(track, sides)], [(corners, faces)], [centre], [angle], half)[0]
    image, frame, size = shading.pair_picture(
        (track, sides), (corners, faces), centre, camera, half, VIEW_WIDTH_PX, VIEW_HEIGHT_PX
    )
    return image, frame, (camera, size), centre


def clearest(tracks, parts, centres, angles, half):
    """Return the views of some moments from the one side on which the track hides least of the part.

    Parameters
    ----------
    tracks, parts : sequence of ((V, 3) float [m], (F, 3) int)
        Corners and faces of each moment.
    centres : sequence of (3,) float [m]
    angles : sequence of float [rad]
        Of the part along the track.
    half : float [m]
        What is seen to either side of the centre.

    Returns
    -------
    list of Camera
    """
    best, most = None, -1.0
    for turn in CAMERA_TURNS_RAD:
        views = [camera_at(angle, turn) for angle in angles]
        moments = zip(tracks, parts, centres, views)
        share = float(np.mean([shading.shown_share(*moment, half) for moment in moments]))
        if share > most:
            best, most = views, share
        if share >= MIN_SHOWN_SHARE:
            break
    return best


def camera_at(angle, turn=0.0) -> Camera:
    """Return the view from inside the bowl and above the part, ahead of it or ``turn`` [rad] from there."""
    ahead = np.array([np.cos(angle), np.sin(angle), 0.0])
    inwards, up = np.array([-ahead[1], ahead[0], 0.0]), np.array([0.0, 0.0, 1.0])
    c, s = np.cos(turn), np.sin(turn)
    to_viewer = (
        (c * TO_VIEWER[0] + s * TO_VIEWER[1]) * ahead
        + (c * TO_VIEWER[1] - s * TO_VIEWER[0]) * inwards
        + TO_VIEWER[2] * up
    )
    to_viewer /= np.sqrt((to_viewer**2).sum())
    right = np.cross(up, to_viewer)
    right /= np.sqrt((right**2).sum())
    return Camera(right=right, up=np.cross(to_viewer, right), towards_viewer=to_viewer)


def _marks(axes, passage, orientations, camera, centre, colour) -> None:
    """Hull of the support and the weight, seen through the part."""
    if not _over_a_cut(passage) or passage.orientation.kind == "hanging":
        return
    camera, size = camera
    radius = passage.orientation.track.radius
    angle = passage.angle(station_of(passage, orientations).stations[0])

    def project(flat):
        points = np.column_stack([flat, np.zeros(len(flat))])
        return camera.project(on_section(points, angle, radius) - centre) / size

    if len(passage.supported) > 1:
        hull = project(np.vstack([passage.supported, passage.supported[:1]]))
        axes.plot(*hull.T, color=colour, lw=1.6)
    axes.plot(*project(np.array([passage.weight])).T, "o", ms=6.0, color=colour, mec="white", mew=0.8)


def _draw_air(axes, passage, orientations, camera, centre) -> None:
    """The line along which a sensor sees the part, its nozzles in the wall, and their air where it blows."""
    camera, size = camera
    section = station_of(passage, orientations)
    station, radius = section.stations[0], section.track.radius
    standing, reach = station.standing, section.width + np.ptp(passage.outline[:, 1])

    def project(s, off, up):
        points = on_section(np.array([[0.0, off, up]]), (station.start + s) / radius, radius)
        return (camera.project(points - centre) / size)[0]

    if standing.sensor is not None:
        middle, s = passage.orientation.distance, standing.sensor.at
        line = [(middle, 0.0), (middle, SENSOR_LINE * passage.orientation.height)]
        if standing.sensor.sees == "side":
            line = [(0.0, 0.5 * passage.orientation.height), (reach, 0.5 * passage.orientation.height)]
        ends = np.array([project(s, *end) for end in line])
        axes.plot(*ends.T, color=SENSOR_COLOUR, lw=1.4, ls=(0, (4, 2)))
        axes.annotate(
            "sensor", ends[1], xytext=(5, -4), textcoords="offset points", color=SENSOR_COLOUR, fontsize=7.5,
            annotation_clip=True,
        )  # fmt: skip
    blows = passage.verdict.passes <= 0.0 or standing.sensor is None
    for jet in standing.jets:
        s, off, up = jet.at
        long = min(jet.reach, reach)
        mouth, end = project(s, off, up), project(s, off + long, up)
        ring = [project(s + jet.radius * np.cos(a), off, up + jet.radius * np.sin(a)) for a in CIRCLE]
        axes.add_patch(Polygon(ring, fc=SENSOR_COLOUR, ec="white", lw=0.6, zorder=4))
        if blows:
            aside = np.array([mouth[1] - end[1], end[0] - mouth[0]])
            aside /= np.hypot(*aside) * size
            wide, wider = jet.radius * aside, (jet.radius + jet.spread * long) * aside
            cone = [mouth - wide, end - wider, end + wider, mouth + wide]
            axes.add_patch(Polygon(cone, fc=SENSOR_COLOUR, ec="none", alpha=0.16, zorder=3))
