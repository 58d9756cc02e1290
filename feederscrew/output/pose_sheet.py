"""Poses of a part on drawing sheets: three views at the outlet, and small ones beside each device."""

import textwrap
from collections.abc import Sequence

import numpy as np
import shapely

from feederscrew.base.arrays import Floats, Points, Triangles
from feederscrew.base.geometry import vectors
from feederscrew.base.units import MM
from feederscrew.output import shading
from feederscrew.output import solidbowl_views as views
from feederscrew.output.drafting import Drawing, scale_words
from feederscrew.output.shading import Camera
from feederscrew.sorting.device_poses import DevicePoses, SharedPose
from feederscrew.sorting.orientations import HANGING, Hanging, Orientation
from feederscrew.sorting.pose_words import describe_pose

SCALES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02)  # ISO 5455
MOST_FACETS = 6_000  # of a part that is drawn as lines
# azimuth, elevation [deg]
FROM_ABOVE = (-90.0, 90.0)
FROM_THE_WALL = (-90.0, 0.0)
FROM_AHEAD = (0.0, 0.0)
SMALL_VIEW = 125.0, 32.0  # [deg] azimuth and elevation of a small picture: from inside the bowl, ahead
VIEWS_GAP_MM = 7.0  # [mm] of paper between two views
# [mm] over the views, below them and left of them
HEAD_MM = 11.0
SIZES_MM = 9.0
BESIDE_MM = 8.0
LABEL_MM = 19.0  # [mm] of paper from one label of a view to the next
ARROW_MM = 7.0  # [mm] of paper: the way parts travel
# of a device's row, and of all rows of a sheet
LEAST_ROW_MM = 36.0
GREATEST_ROW_MM = 60.0
ROWS_MM = 250.0
# of a device's name, of a pose; [1] of it the picture
NAME_MM = 42.0
COLUMN_MM = 41.5
PICTURE_SHARE = 0.84
MOST_PICTURES = 8  # of a device: what passes first, then what is returned
CAPTION_LETTERS, CAPTION_LINES = 33, 3  # below a picture


def part_on_track(orientation: Orientation) -> tuple[Points, Triangles]:
    """Return a part in its pose over the track, of few facets.

    Parameters
    ----------
    orientation : Orientation

    Returns
    -------
    (V, 3) array [m], (F, 3) array of int
        Corners ahead, from the wall and over the track; faces. Behind a twist the wall is at the inner side,
        and places from it are below 0.
    """
    posture = orientation.posture
    corners = vectors.product(orientation.solid.corners, orientation.axes.T)
    off = -orientation.distance if orientation.at_inner_wall else orientation.distance
    corners = corners + [0.0, off, posture.height]
    return shading.reduced_mesh(corners, np.asarray(posture.facets), MOST_FACETS)


def _seen(corners: Points, faces: Triangles, view: Camera) -> Floats:
    """The visible edges (N, 2, 2) of a part, across and up the view, in its own axes [mm]."""
    return np.round(views.lines(corners, faces, view) / MM, 4)


def _draw_edges(drawing: Drawing, pieces: Floats) -> None:
    if len(pieces):
        merged = shapely.line_merge(shapely.multilinestrings(pieces))
        drawing.lines(shapely.get_coordinates(line) for line in shapely.get_parts(merged))


def draw_outlet_views(drawing: Drawing, leaving: Orientation, box: tuple[float, float, float, float]) -> None:
    """Draw the part as it leaves, from above, from the wall and from ahead, with its sizes.

    Parts travel to the right; the view from the wall lies below that from above, the one from ahead to the
    right of it (ISO 128-3, labelled views). Behind a twist the wall is at the inner side, above the part in
    the view from above, and that from the side is from the free edge.

    Parameters
    ----------
    drawing : Drawing
    leaving : Orientation
    box : left, low, right, high [mm]
        Of the paper.
    """
    corners, faces = part_on_track(leaving)
    low, high = corners.min(axis=0) / MM, corners.max(axis=0) / MM
    long, wide = (high - low)[:2]
    left, bottom, right, top = box
    # across the track, the wall at 0: from and to [mm]
    edge, far = (
        (low[1] - 0.15 * wide, 0.0) if leaving.at_inner_wall else (0.0, max(high[1], 0.0) + 0.15 * wide)
    )
    reach = far - edge
    below = min(low[2], 0.0)  # what hangs is below the track
    room_x = right - left - BESIDE_MM - VIEWS_GAP_MM - 5.0
    room_y = top - bottom - HEAD_MM - VIEWS_GAP_MM - SIZES_MM
    fits = (s for s in SCALES if s * (long + reach) <= room_x and s * (reach + high[2] - below) <= room_y)
    scale = next(fits, SCALES[-1])
    drawing.text(left, top - 3.0, f"part at the outlet  {scale_words(scale)}", 3.0, bold=True)
    x0 = left + BESIDE_MM - low[0] * scale
    y_above = top - HEAD_MM - far * scale  # the wall, seen from above
    y_wall = y_above + (edge - high[2]) * scale - VIEWS_GAP_MM  # the track, seen from the wall
    # the wall, from ahead
    x_ahead = left + BESIDE_MM + max(long * scale + VIEWS_GAP_MM + 5.0, LABEL_MM) - edge * scale
    span = np.array([low[0] - 0.1 * long, high[0] + 0.1 * long]) * scale + x0
    for (azimuth, elevation), at in (
        (FROM_ABOVE, (x0, y_above)),
        (FROM_THE_WALL, (x0, y_wall)),
        (FROM_AHEAD, (x_ahead, y_wall)),
    ):
        pieces = _seen(corners, faces, views.camera(azimuth, elevation))
        _draw_edges(drawing, pieces * scale + np.array(at))
    # wall and track, or the rails
    drawing.lines([[(span[0], y_above), (span[1], y_above)]], "OUTLINE")
    drawing.lines([[(span[0], y_wall), (span[1], y_wall)]], "CENTRE")
    drawing.lines([[(x_ahead, y_wall), (x_ahead, y_wall + high[2] * scale)]], "OUTLINE")
    ends = [edge, far]
    if isinstance(leaving, Hanging):
        ends = [
            0.0,
            leaving.span[0] / MM,
            leaving.span[1] / MM,
            max(far, leaving.span[1] / MM + 0.3 * wide),
        ]
        for rail in leaving.span:
            y = y_above + rail / MM * scale
            drawing.lines([[(span[0], y), (span[1], y)]], "CENTRE")
    track = [
        [(x_ahead + a * scale, y_wall), (x_ahead + b * scale, y_wall)] for a, b in zip(ends[::2], ends[1::2])
    ]
    drawing.lines(track, "OUTLINE")
    # the way parts travel, and the sizes
    x, y = span[1] + 2.0, y_above + 0.5 * (edge + far) * scale
    _draw_arrow(drawing, (x, y), (min(ARROW_MM, 8.0), 0.0))
    start, end = (low[0] * scale + x0, y_wall + below * scale), (high[0] * scale + x0, y_wall + below * scale)
    drawing.length(start, end, (0.0, -5.5), scale, decimals=1)
    start, end = (
        (x_ahead + low[1] * scale, y_wall + below * scale),
        (x_ahead + high[1] * scale, y_wall + below * scale),
    )
    drawing.length(start, end, (0.0, -5.5), scale, decimals=1)
    start, end = (
        (low[0] * scale + x0, y_wall + low[2] * scale),
        (low[0] * scale + x0, y_wall + high[2] * scale),
    )
    drawing.length(start, end, (-4.0, 0.0), scale, decimals=1)
    labels = ("above", "free edge") if leaving.at_inner_wall else ("below", "wall")
    drawing.text(x0 + low[0] * scale, top - 8.5, f"from above, wall {labels[0]}", 1.9)
    drawing.text(x0 + low[0] * scale, y_wall + high[2] * scale + 1.5, f"from the {labels[1]}", 1.9)
    drawing.text(x_ahead + edge * scale, y_wall + high[2] * scale + 1.5, "from ahead", 1.9)


def _draw_arrow(drawing: Drawing, start: tuple[float, float], way: tuple[float, float]) -> None:
    """Draw an arrow on paper [mm], along a way (2,)."""
    at, way_vector = np.array(start), np.array(way)
    tip, square = at + way_vector, np.array([-way_vector[1], way_vector[0]])
    drawing.lines([[at, tip]], "NOTE")
    back = tip - 0.35 * way_vector
    drawing.lines([[back + 0.18 * square, tip, back - 0.18 * square]], "NOTE")


def draw_pose(drawing: Drawing, orientation: Orientation, box: tuple[float, float, float, float]) -> None:
    """Draw a part in its pose as lines, seen from ahead and from its free edge, on its piece of track.

    That is from inside the bowl, but behind a twist, which stands the floor up at the inner side.

    Parameters
    ----------
    drawing : Drawing
    orientation : Orientation
    box : left, low, right, high [mm]
        Of the paper; the picture is as large as it allows.
    """
    corners, faces = part_on_track(orientation)
    inwards = -1.0 if orientation.at_inner_wall else 1.0
    view = views.camera(inwards * SMALL_VIEW[0], SMALL_VIEW[1])
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = float(np.max(high - low))
    near, far = low[0] - 0.15 * size, high[0] + 0.15 * size
    inner = min(low[1], 0.0) - 0.1 * size if orientation.at_inner_wall else max(high[1], 0.0) + 0.1 * size
    edges = [(0.0, inner)]
    if isinstance(orientation, Hanging):
        edges = [
            (0.0, orientation.span[0]),
            (orientation.span[1], max(inner, orientation.span[1] + 0.2 * size)),
        ]
    track = [[[near, a, 0.0], [far, a, 0.0], [far, b, 0.0], [near, b, 0.0], [near, a, 0.0]] for a, b in edges]
    wall_top = max(0.35 * size, 0.6 * float(high[2]))
    wall = [[near, 0.0, 0.0], [near, 0.0, wall_top], [far, 0.0, wall_top], [far, 0.0, 0.0]]
    arrow_at = np.array([far + 0.08 * size, 0.5 * inner, 0.0])
    arrow = (
        np.array([[0.0, 0, 0], [0.3, 0, 0], [0.2, 0.07, 0], [0.3, 0, 0], [0.2, -0.07, 0]]) * size + arrow_at
    )
    part = _seen(corners, faces, view)
    around = [view.project(np.array(line)) / MM for line in (*track, wall, arrow)]
    everything = np.vstack([part.reshape(-1, 2), *around])
    least, most = everything.min(axis=0), everything.max(axis=0)
    left, bottom, right, top = box
    scale = float(min((right - left) / (most - least)[0], (top - bottom) / (most - least)[1]))
    shift = np.array([0.5 * (left + right), 0.5 * (bottom + top)]) - 0.5 * scale * (least + most)
    drawing.lines((line * scale + shift for line in around[:-1]), "CENTRE")
    drawing.lines([around[-1] * scale + shift], "NOTE")
    _draw_edges(drawing, part * scale + shift)


def draw_device_poses(
    drawing: Drawing, rows: Sequence[tuple[int, DevicePoses]], left: float, top: float
) -> None:
    """Draw the poses beside each device, a row each: what it lets pass, then what it returns or stops.

    Parameters
    ----------
    drawing : Drawing
    rows : sequence of (int, DevicePoses)
        With the number of the device on the sheet of the devices.
    left, top : float [mm]
        Of the paper.
    """
    row_mm = float(np.clip(ROWS_MM / max(len(rows), 1), LEAST_ROW_MM, GREATEST_ROW_MM))
    for k, (number, poses) in enumerate(rows):
        high = top - row_mm * k
        drawing.lines([[(left, high), (left + 375.0, high)]], "TABLE")
        drawing.text(left, high - 4.5, f"{number}  {poses.device.kind}", 2.8, bold=True)
        for line, words in enumerate(textwrap.wrap(poses.device.value_words, 27)[:6]):
            drawing.text(left, high - 8.5 - 3.4 * line, words, 2.0)
        listed: list[tuple[str, SharedPose]] = []
        for fate in ("passes", "returns", "stops"):
            listed += [(fate, pose) for pose in getattr(poses, fate)]
        for column, (fate, pose) in enumerate(listed[:MOST_PICTURES]):
            x = left + NAME_MM + COLUMN_MM * column
            foot = high - row_mm + 3.0 * CAPTION_LINES
            draw_pose(drawing, pose.orientation, (x, foot + 2.5, x + PICTURE_SHARE * COLUMN_MM, high - 5.4))
            ink, words = "TEXT" if fate == "passes" else "NOTE", f"{fate} {pose.orientation.name}"
            drawing.text(x, high - 3.8, f"{words}, {100.0 * pose.share:.2g} %", 2.0, bold=True, layer=ink)
            caption = describe_pose(pose.orientation)
            if pose.becomes not in ("", pose.orientation.name):
                caption = (
                    f"goes on {'as ' * (pose.becomes[: len(HANGING)] != HANGING)}{pose.becomes}; {caption}"
                )
            caption_lines = textwrap.wrap(caption, CAPTION_LETTERS)[:CAPTION_LINES]
            for line, words in enumerate(caption_lines):
                drawing.text(x, foot - 2.7 * line, words, 1.7)
        if len(listed) > MOST_PICTURES:
            drawing.text(left, high - row_mm + 3.0, f"and {len(listed) - MOST_PICTURES} more", 2.0)
