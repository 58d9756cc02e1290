"""The part in three dimensions over a cut: the orientation that leaves, and the nearest that falls."""

import textwrap
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from feederscrew.base.arrays import Floats, Points, Vector
from feederscrew.base.geometry.polygons import turned
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.record import Track
from feederscrew.cad import section as printed
from feederscrew.output import shading, style
from feederscrew.output.shading import Camera, Mesh
from feederscrew.output.tooling_figures import PASSED_COLOUR, REJECTED_COLOUR, left_words, margin_words
from feederscrew.sorting import device_passages
from feederscrew.sorting.device_passages import Passage
from feederscrew.sorting.isolating.chain import LEAST_SHARE
from feederscrew.sorting.orientations import Orientation
from feederscrew.sorting.tooled_track import PlacedDevice, TooledTrack, lay_out

# pixels of one view and of two lines over it
VIEW_WIDTH_PX = 620
VIEW_HEIGHT_PX = 520
VIEW_HEAD_PX = 96
CAPTION_LINE_PX = 24
NAME_LETTERS, CAPTION_LETTERS = 46, 64  # of a line that is no wider than a view
TO_VIEWER = np.array([0.55, 0.80, 0.85])  # to the viewer: ahead, inwards, up
SENSOR_COLOUR, SENSOR_LINE = "#009e73", 1.15  # of sensor, nozzles; heights of the part a sensor is over it
SENSOR_NOTE_EDGE = 0.04  # [1] of a view that stays free at its edges beside the word at a line of sight
CIRCLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)  # [rad]


def figure(
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted_row: int,
    left_in_trial: Collection[str] = (),
) -> Figure | None:
    """Draw the wanted orientation over its least cut, and the nearest that falls.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they come.
    wanted_row : int
    left_in_trial : collection of str
        Names of orientations of which a part left in a trial: none of them is drawn as what falls.

    Returns
    -------
    matplotlib.figure.Figure or None
        None without cuts.
    """
    views = _views(devices, orientations, shares, wanted_row, left_in_trial)
    if not views:
        return None
    captions = [_caption_lines(words) for _, words, _ in views]
    head = VIEW_HEAD_PX + CAPTION_LINE_PX * (max(map(len, captions)) - 2)
    count, high = len(views), head + VIEW_HEIGHT_PX
    page = style.page(VIEW_WIDTH_PX * count, high)
    for place, ((passage, _, colour), lines) in enumerate(zip(views, captions)):
        box = page.add_axes((place / count, 0.0, 1.0 / count, VIEW_HEIGHT_PX / high))
        _draw_view(box, passage, orientations, colour)
        for line, (text, is_name) in enumerate(lines):
            look = {"fontsize": 9, "fontweight": "bold"} if is_name else {"fontsize": 7.5}
            y = 1.0 - (30 + CAPTION_LINE_PX * line) / high
            page.text((place + 0.03) / count, y, text, va="center", color=colour, **look)
    return page


def _caption_lines(words: Sequence[str]) -> list[tuple[str, bool]]:
    """The lines over a view, none wider than it, each with whether it is of its name."""
    name, *more = words
    lines = [(line, True) for line in textwrap.wrap(name, NAME_LETTERS)]
    return lines + [(line, False) for text in more for line in textwrap.wrap(text, CAPTION_LETTERS)]


def _views(
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted_row: int,
    left_in_trial: Collection[str] = (),
) -> list[Any]:
    """Return what leaves, and what falls by least, of the frequent: passage, lines of text, colour."""
    placed, views, rejected = [device for device in devices if device.action.has_place], [], []
    passages = _drawable(device_passages.until_returned(placed, orientations[wanted_row], orientations))
    if passages:
        least = min(passages, key=lambda passage: passage.verdict.margin)
        words, colour = _caption(least, "passes"), PASSED_COLOUR
        if not least.verdict.passes > 0.0:  # by the rule
            fate = f"{least.fate} by {least.device.kind}"
            is_left = orientations[wanted_row].name in left_in_trial
            colour = PASSED_COLOUR if is_left else REJECTED_COLOUR
            name = least.orientation.name
            words = f"{name} {left_words(fate) if is_left else f'is {fate}'}", words[1]
        if least.verdict.hangs:
            words = f"{least.orientation.name} hangs between the rails", "by its head, from here on"
            least = replace(least, orientation=least.after)
        views.append((least, words, colour))
    for k, orientation in enumerate(orientations):
        is_left = k == wanted_row or orientation.name in left_in_trial
        if not is_left and shares[k] >= LEAST_SHARE and not orientation.returned:
            passages = device_passages.until_returned(placed, orientation, orientations)
            rejected += [last for last in passages[-1:] if last.verdict.passes <= 0.0 and _drawable([last])]
    if rejected:
        nearest = max(rejected, key=lambda passage: round(passage.verdict.margin, 9))
        word = "falls at" if _over_a_cut(nearest) else f"is {nearest.fate} at"
        views.append((nearest, _caption(nearest, word), REJECTED_COLOUR))
    return views


def _draw_view(box: Axes, passage: Passage, orientations: Sequence[Orientation], colour: str) -> None:
    section = section_of(passage, orientations)
    placed, radius = section.devices[0], section.track.radius
    corners, faces = part_on_section(passage, placed), passage.orientation.posture.facets
    angle = passage.angle(placed)
    centre = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    track, part = printed.solid(section), (corners, faces)
    half = 0.80 * np.ptp(corners, axis=0).max()
    (camera,) = clearest([track], [part], [centre], [angle], half)
    extent = VIEW_WIDTH_PX, VIEW_HEIGHT_PX
    image, frame, size = shading.pair_picture(track, part, centre, camera, half, *extent)
    box.imshow(image, extent=frame.extent, interpolation="none")

    def project(points: Points, at: float) -> Floats:
        return camera.project(_on_section(points, at, section.track) - centre) / size

    if _over_a_cut(passage) and passage.orientation.kind != "hanging":
        # hull of the support and the weight, seen through the part
        if len(passage.supported) > 1:
            hull = np.vstack([passage.supported, passage.supported[:1]])
            box.plot(*project(np.column_stack([hull, np.zeros(len(hull))]), angle).T, color=colour, lw=1.6)
        weight = np.array([[*passage.weight, 0.0]])
        box.plot(*project(weight, angle).T, "o", ms=6.0, color=colour, mec="white", mew=0.8)
    box.set(xlim=frame.extent[:2], ylim=frame.extent[2:])
    _draw_air(
        box,
        passage,
        section,
        size,
        lambda s, off, up: project(np.array([[0.0, off, up]]), (placed.begin + s) / radius)[0],
    )
    box.axis("off")


def poses(
    devices: Sequence[Device], orientations: Sequence[Orientation], shares: Floats, wanted_row: int
) -> list[tuple[Passage, str]]:
    """Return the passages worth a view, each with a few words: 'gap, margin +0.64 mm'.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they come.
    wanted_row : int

    Returns
    -------
    list of (Passage, str)
    """
    listed = []
    for passage, _, _ in _views(devices, orientations, shares, wanted_row):
        words = f"{passage.device.kind}, {margin_words(passage.verdict)}"
        listed.append((passage, "in the rails" if passage.orientation.kind == "hanging" else words))
    return listed


def _drawable(passages: Iterable[Passage]) -> list[Passage]:
    return [passage for passage in passages if passage.picture and passage.picture != "turned"]


def _over_a_cut(passage: Passage) -> bool:
    return passage.picture == "above" and passage.hole is not None


def _caption(passage: Passage, word: str) -> tuple[str, str]:
    kind = passage.device.kind
    where = "half way through" if passage.verdict.passes > 0.0 else "in front of it"
    if _over_a_cut(passage):
        where = "where it is supported least; outline: what supports it, dot: weight"
    return f"{passage.orientation.name} {word} the {kind}", f"{margin_words(passage.verdict)}, {where}"


def track_below(passage: Passage, orientations: Sequence[Orientation]) -> Mesh:
    """Return a passage's section of track: ahead, inwards, up from the part's foot.

    Parameters
    ----------
    passage : Passage
    orientations : sequence of Orientation

    Returns
    -------
    vertices : (V, 3) float [m]
    faces : (F, 3) int
    """
    section, orientation = section_of(passage, orientations), passage.orientation
    corners, faces = printed.solid(section)
    angle, radius = passage.angle(section.devices[0]), orientation.track.radius
    c, s, down = np.cos(angle), np.sin(angle), corners[:, 1] - radius
    ahead = c * corners[:, 0] + s * down
    from_wall = radius - s * corners[:, 0] + c * down
    # along the banked surface, and square to it
    c, s = np.cos(orientation.track.bank), np.sin(orientation.track.bank)
    inwards, up = c * from_wall + s * corners[:, 2], c * corners[:, 2] - s * from_wall
    return np.column_stack([ahead, inwards - orientation.distance, up]), faces


def part_on_section(passage: Passage, placed: PlacedDevice) -> Points:
    """Return the corners of the part of a passage on a track section that holds its device.

    Parameters
    ----------
    passage : Passage
    placed : PlacedDevice
        Where its device is on that section.

    Returns
    -------
    (V, 3) float [m]
    """
    orientation = passage.orientation
    points = np.array(orientation.posture.surface)
    flat = turned(points[:, :2], orientation.heading) + [0.0, orientation.distance]
    points = np.column_stack([flat, points[:, 2]])
    return _on_section(points, passage.angle(placed), orientation.track)


def _on_section(points: Points, angle: float, track: Track) -> Points:
    """Return points (N, 3) [m] as they lie at an angle of a section of a track.

    They are ahead, from the wall along the track's surface, and square to that.
    """
    c, s = np.cos(track.bank), np.sin(track.bank)
    from_wall, up = c * points[:, 1] - s * points[:, 2], c * points[:, 2] + s * points[:, 1]
    c, s, off = np.cos(angle), np.sin(angle), track.radius - from_wall
    return np.column_stack([c * points[:, 0] + s * off, track.radius + s * points[:, 0] - c * off, up])


def section_of(passage: Passage, orientations: Sequence[Orientation]) -> TooledTrack:
    """Return a track section with nothing but the device of a passage, and the part before it.

    Parameters
    ----------
    passage : Passage
    orientations : sequence of Orientation
        All of the part.

    Returns
    -------
    TooledTrack
    """
    longest = max(orientation.length for orientation in orientations)
    return lay_out(passage.orientation.track, [passage.device], orientations, lead=longest)


def clearest(
    tracks: Sequence[Mesh],
    parts: Sequence[Mesh],
    centres: Sequence[Vector],
    angles: Sequence[float],
    half: float,
) -> list[Camera]:
    """Return the views of some moments from the one side on which the track hides least of the part.

    Parameters
    ----------
    tracks, parts : sequence of ((V, 3) float [m], (F, 3) int)
        Of each moment.
    centres : sequence of (3,) float [m]
        Of the pictures.
    angles : sequence of float [rad]
        Of the part along the track.
    half : float [m]
        Seen to either side of the centres.

    Returns
    -------
    list of Camera
    """
    best, most = list[Camera](), -1.0
    for turn in np.radians([0.0, -69.0, -35.0, 25.0, -95.0]):  # the first that shows nine tenths
        views = [camera_at(angle, turn) for angle in angles]
        moments = zip(tracks, parts, centres, views)
        share = float(np.mean([shading.shown_share(*moment, half) for moment in moments]))
        if share > most:
            best, most = views, share
        if share >= 0.9:
            break
    return best


def camera_at(angle: float, turn: float = 0.0) -> Camera:
    """Return the view from inside the bowl and above the part.

    Parameters
    ----------
    angle : float [rad]
        Of the part along the track.
    turn : float [rad], optional
        From straight ahead of it.

    Returns
    -------
    Camera
    """
    ahead = np.array([np.cos(angle), np.sin(angle), 0.0])
    inwards, up = np.array([-ahead[1], ahead[0], 0.0]), np.array([0.0, 0.0, 1.0])
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = TO_VIEWER
    to_viewer = (c * x + s * y) * ahead + (c * y - s * x) * inwards + z * up
    to_viewer /= np.sqrt((to_viewer**2).sum())
    right = np.cross(up, to_viewer)
    right /= np.sqrt((right**2).sum())
    return Camera(right=right, up=np.cross(to_viewer, right), towards_viewer=to_viewer)


def _write_sensor(axes: Axes, ends: Floats) -> None:
    """Write what a line of sight is of, near its end as far as the view shows it, and within the view."""
    low, high = np.sort(np.column_stack([axes.get_xlim(), axes.get_ylim()]), axis=0)
    points = ends[1] + np.linspace(0.0, 1.0, 101)[:, None] * (ends[0] - ends[1])
    places = (points - low) / (high - low)
    shown = np.flatnonzero(((places > SENSOR_NOTE_EDGE) & (places < 1.0 - SENSOR_NOTE_EDGE)).all(axis=1))
    if not shown.size:
        return
    side, shift = ("right", -5) if places[shown[0], 0] > 0.5 else ("left", 5)
    style.note(axes, "sensor", points[shown[0]], (shift, -4), color=SENSOR_COLOUR, fontsize=7.5, ha=side)


def _draw_air(
    axes: Axes,
    passage: Passage,
    section: TooledTrack,
    size: float,
    project: Callable[[float, float, float], Vector],
) -> None:
    """The sensor's line of sight, its nozzles and their air; ``project`` takes places at a device [m]."""
    features, orientation = section.devices[0].features, passage.orientation
    reach = section.width + np.ptp(passage.outline[:, 1])
    if features.sensor is not None:
        middle, s = orientation.distance, features.sensor.at
        line = [(middle, 0.0), (middle, SENSOR_LINE * orientation.height)]
        if features.sensor.sees == "side":
            line = [(0.0, 0.5 * orientation.height), (reach, 0.5 * orientation.height)]
        ends = np.array([project(s, *end) for end in line])
        axes.plot(*ends.T, color=SENSOR_COLOUR, lw=1.4, ls=(0, (4, 2)))
        _write_sensor(axes, ends)
    blows = passage.verdict.passes <= 0.0 or features.sensor is None
    for jet in features.jets:
        s, off, up = jet.at
        long = min(jet.reach, reach)
        c, across, rise = np.asarray(jet.towards) / np.sqrt((np.asarray(jet.towards) ** 2).sum())
        mouth, end = project(s, off, up), project(s + c * long, off + across * long, up + rise * long)
        ring = [project(s + jet.radius * np.cos(a), off, up + jet.radius * np.sin(a)) for a in CIRCLE]
        axes.add_patch(Polygon(ring, fc=SENSOR_COLOUR, ec="white", lw=0.6, zorder=4))
        if blows:
            aside = np.array([mouth[1] - end[1], end[0] - mouth[0]])
            aside /= np.hypot(*aside) * size
            wide, wider = jet.radius * aside, (jet.radius + jet.spread * long) * aside
            cone = [mouth - wide, end - wider, end + wider, mouth + wide]
            axes.add_patch(Polygon(cone, fc=SENSOR_COLOUR, ec="none", alpha=0.16, zorder=3))
