"""Stills of a part that passes a device and of one that does not, on the track as it is cut."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from feederscrew.output import shading, style
from feederscrew.output.tooling_views import clearest
from feederscrew.output.trial.section import section
from feederscrew.output.trial.shown import shown
from feederscrew.units import MM

STILLS, WIDTH, HEIGHT, GAP, EDGE, HEAD, CAPTION = 6, 250, 210, 10, 24, 54, 26  # stills of a row, pixels
VIEW = 1.6  # of the part's radius: what is seen to either side of it
WALL = 1.1  # of the part's radius: how high the wall is


def stills(part, run):
    """Draw one part that passes the device that decides, and one that is lost there.

    Parameters
    ----------
    part : Part
        With a mesh.
    run : TrialRun

    Returns
    -------
    Figure
    """
    found, rides = run.course, shown(run)
    width = 2 * EDGE + STILLS * (WIDTH + GAP) - GAP
    height = EDGE + len(rides) * (HEAD + HEIGHT + CAPTION)
    figure = style.page(width, height)
    page = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(0, height))
    page.set_axis_off()
    points = part.vertices - part.centre_of_mass
    radius = float(np.sqrt((points**2).sum(axis=1).max()))
    track = section(found.stations[rides[0].place], run.bowl.track, WALL * radius)
    for row, ride in enumerate(rides):
        top = height - row * (HEAD + HEIGHT + CAPTION)
        page.text(EDGE, top - 30, ride.title(found), fontsize=11, fontweight="bold", color=style.INK)
        moments = list(_chosen(ride.path, radius))
        inwards = Rotation.from_matrix(np.array(found.principal)).inv()
        bodies = [(place + (turn * inwards).apply(points), part.faces) for _, place, turn in moments]
        places = [place for _, place, _ in moments]
        angles = [np.arctan2(place[0], run.bowl.track.radius - place[1]) for place in places]
        views = clearest([track] * len(bodies), bodies, places, angles, VIEW * radius)
        for k, ((time, place, _), body, view) in enumerate(zip(moments, bodies, views)):
            left = EDGE + k * (WIDTH + GAP)
            box = (left / width, (top - HEAD - HEIGHT) / height, WIDTH / width, HEIGHT / height)
            axes = figure.add_axes(box, xticks=[], yticks=[])
            axes.spines[:].set_color(style.FAINT)
            image, _, _ = shading.pair_picture(track, body, place, view, VIEW * radius, WIDTH, HEIGHT)
            axes.imshow(image, interpolation="nearest")
            caption = f"{time:.2f} s, {place[2] / MM:.1f} mm high"
            page.text(left + 4, top - HEAD - HEIGHT - 16, caption, fontsize=7, color=style.INK)
    return figure


def _chosen(path, radius) -> Iterator[Any]:
    """Moments of a path, evenly along the way, the fall and the turns: time, place and attitude."""
    turns = Rotation.from_quat(path[:, [5, 6, 7, 4]])
    moves = np.linalg.norm(np.diff(path[:, 1:4], axis=0), axis=1)
    way = np.concatenate(
        [[0.0], np.cumsum(moves + 0.5 * radius * (turns[1:] * turns[:-1].inv()).magnitude())]
    )
    way += 1e-12 * np.arange(len(way))  # a part at rest has one place for many times
    times = np.interp(np.linspace(0.12, 1.0, STILLS) * way[-1], way, path[:, 0])
    between = Slerp(path[:, 0], turns)
    for time in times:
        yield time, np.array([np.interp(time, path[:, 0], path[:, k]) for k in (1, 2, 3)]), between(time)
