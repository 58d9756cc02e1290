"""Orientations on a bare track: as small pictures beside their names, and for the viewer of a page."""

import re
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.output import batch
from feederscrew.output.page.blocks import Pose, Views
from feederscrew.output.shading import Mesh
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture, posture

shading = heavy("feederscrew.output.shading")
tooling_views = heavy("feederscrew.output.tooling_views")

ORIENTATION = re.compile(r"([^@\s]+)@(\d{1,3})")  # 'A@188': an aspect, a heading in whole degrees
IN_TEXT = re.compile(r"\b[^\W\d_][\w-]*@\d{1,3}(?![\w@])")  # the same, within words
ASPECT = re.compile(r"[A-Z]{1,2}")
NAMED = re.compile(r"([^@\s]+?)(?:@(\d{1,3}))?")  # the same, or an aspect alone
WIDTH_PX, HEIGHT_PX = 240, 180
MOST_FACETS = 20_000  # of a part that is drawn so small
# of the part's length: track before it, at its side, wall
AHEAD = 0.35
ASIDE = 0.25
THICK = 0.04
WALL = 0.45
ARROW = np.array([(0.0, -0.26), (0.0, 0.26), (1.0, 0.0)])  # of the direction of travel, ahead and inwards
WEDGE = np.array([(0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)])


def pose_finder(part: Part, aspects: Aspects) -> Callable[[str], Pose | None]:
    """Return the function that draws what a name stands for: an aspect 'A', or an orientation 'A@188'.

    Parameters
    ----------
    part : Part
        With a mesh; of a part card every name is unknown.
    aspects : Aspects
        Of that part.

    Returns
    -------
    callable
        Takes a name; returns its Pose, each made once, or None where the part has no such pose.
    """

    @cache
    def find(name: str) -> Pose | None:
        aspect, at, heading = name.partition("@")
        if part.vertices is None or aspect not in aspects.names:
            return None
        if not at:
            return Pose(batch.thumbnail(part, aspects, aspect), f"aspect {aspect}: a side on which it rests")
        if not ORIENTATION.fullmatch(name):
            return None
        words = f"aspect {aspect}, turned {heading} deg counter-clockwise seen from above; parts move to the "
        drawn = picture(posture(part, aspects, aspect), np.radians(float(heading)))
        return Pose(drawn, f"{words}arrow, the wall is behind")

    return find


def picture(lying: Posture, heading: float) -> bytes:
    """Return the picture of a posture against the wall, an arrow ahead of it.

    Parameters
    ----------
    lying : Posture
    heading : float [rad]

    Returns
    -------
    bytes
        PNG.
    """
    points = on_track(lying, heading)
    faces = np.asarray(lying.solid.faces) if lying.solid is not None else np.zeros((0, 3), int)
    points, faces = shading.reduced_mesh(points, faces, MOST_FACETS)
    track = bare_track(points)
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    camera = tooling_views.camera_at(0.0)
    reach = np.abs(camera.project(np.vstack([points, track[0]]) - centre)).max(axis=0)
    half = 1.04 * max(reach[0], reach[1] * WIDTH_PX / HEIGHT_PX)
    drawn, _, _ = shading.pair_picture(track, (points, faces), centre, camera, half, WIDTH_PX, HEIGHT_PX)
    return batch.png_of_pixels(np.clip(drawn, 0.0, 1.0))


def on_track(lying: Posture, heading: float) -> Floats:
    """Return the corners of a posture on the track: ahead, inwards, up from its foot.

    Parameters
    ----------
    lying : Posture
    heading : float [rad]

    Returns
    -------
    (V, 3) float [m]
    """
    points = np.array(lying.surface)
    return np.column_stack([turned(points[:, :2], heading), points[:, 2]])


def bare_track(points: Floats) -> Mesh:
    """Return the track and the wall about a part as a mesh, with an arrow ahead of the part.

    Parameters
    ----------
    points : (V, 3) array [m]
        Corners of the part as it lies, its heading along x.

    Returns
    -------
    Mesh
    """
    (left, wall, low), (right, edge, top) = points.min(axis=0), points.max(axis=0)
    long = max(right - left, edge - wall)
    begin, end = left - ASIDE * long, right + (AHEAD + ASIDE) * long
    thick = THICK * long
    high = low + min(WALL * long, 0.8 * (top - low))
    arrow = ARROW * 0.8 * AHEAD * long + [right + 0.2 * AHEAD * long, 0.5 * (wall + edge)]
    bodies = [
        shading.box_mesh((begin, wall, low - thick), (end, edge + 0.5 * ASIDE * long, low)),
        shading.box_mesh((begin, wall - thick, low - thick), (end, wall, high)),
        (
            np.vstack([np.column_stack([arrow, np.full(3, low + up)]) for up in (-0.5 * thick, 0.5 * thick)]),
            WEDGE,
        ),
    ]
    return shading.join_meshes(bodies)


def name_part(text: str, part: str) -> str:
    """Return a text in which each orientation is told of what part it is: 'A@188 of nut'.

    Parameters
    ----------
    text : str
        An aspect alone, 'A', or any text with orientations in it.
    part : str
        Its name.

    Returns
    -------
    str
    """
    if ASPECT.fullmatch(text):
        return f"{text} of {part}"
    return IN_TEXT.sub(lambda name: f"{name[0]} of {part}", text)


def opening(
    part: Part, aspects: Aspects, named: Sequence[tuple[str, str]], of: str = ""
) -> tuple[Views, ...]:
    """Return the view that a page opens with: orientations on the bare track, to be turned.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    named : sequence of (str, str)
        Names of orientations, 'A@188', or of aspects, 'A', each with what becomes of it; a name that is
        unknown is left out. An aspect lies as its posture does, at no heading of its own.
    of : str, optional
        The name of the part, which the captions tell where a page is of several.

    Returns
    -------
    tuple of Views
        One, or none where nothing can be drawn.
    """
    poses, tracks, captions = list[Document](), list[Document](), []
    for name, words in named:
        found = NAMED.fullmatch(name)
        if part.vertices is None or found is None or found[1] not in aspects.names:
            continue
        lying, heading = posture(part, aspects, found[1]), np.radians(float(found[2] or 0.0))
        c, s, (x, y, z) = np.cos(heading), np.sin(heading), np.asarray(lying.axes)
        axes = np.array([c * x - s * y, s * x + c * y, z])
        turn = Rotation.from_matrix(axes).as_quat(canonical=True)
        poses.append(
            {
                "name": name,
                "quaternion": [shading.short(q) for q in turn],
                "height": shading.short(lying.height / MM),
                "contact": [],
                "track": len(tracks),
            }
        )
        tracks.append(shading.track(*bare_track(on_track(lying, heading))))
        captions.append((f"{name} of {of}" if of else name, words, ()))
    if not poses:
        return ()
    scene = shading.scene_of_part(part, tooling_views.TO_VIEWER)
    scene |= {"reach": 1.55, "tracks": tracks, "poses": poses}
    hint = "On the track, parts move to the arrow. Drag to turn; double-click sets it back."
    return (
        Views(
            scene,
            tuple(captions),
            f"opening-{of}" if of else "opening",
            "Orientation",
            hint=hint,
            printed=True,
        ),
    )
