"""Stills of a part that passes a device and of one that does not, on the track as it is cut."""

import numpy as np
from matplotlib.path import Path

from feederscrew.output import style
from feederscrew.output.columns import MM
from feederscrew.output.solid import render, shading
from feederscrew.output.solid.shading import Shot
from feederscrew.output.solid.stance import outermost, placed
from feederscrew.output.trial.figures import solids
from feederscrew.output.trial.shown import shown
from feederscrew.trial import runs

STILLS, WIDTH, HEIGHT, GAP, EDGE, HEAD, CAPTION = 6, 250, 210, 10, 24, 54, 26  # stills of a row, pixels
VIEW = 2.9  # [size] across a still
GROUND = np.array([0.87, 0.90, 0.92])
RIM = np.array([0.35, 0.42, 0.48])


def stills(part, run):
    """Draw one part that passes the first device where some are lost, and one that is lost there.

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
    solid = render.Rays(part.vertices, part.faces, part.centre_of_mass)
    width = 2 * EDGE + STILLS * (WIDTH + GAP) - GAP
    height = EDGE + len(rides) * (HEAD + HEIGHT + CAPTION)
    figure = style.page(width, height)
    page = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(0, height))
    page.set_axis_off()
    for row, ride in enumerate(rides):
        top = height - row * (HEAD + HEIGHT + CAPTION)
        page.text(EDGE, top - 30, ride.title(found), fontsize=11, fontweight="bold", color=style.INK)
        for k, at in enumerate(_chosen(ride.path)):
            left = EDGE + k * (WIDTH + GAP)
            box = (left / width, (top - HEAD - HEIGHT) / height, WIDTH / width, HEIGHT / height)
            axes = figure.add_axes(box, xticks=[], yticks=[])
            axes.spines[:].set_color(style.FAINT)
            image = _still(solid, found, ride.place, run.bowl.track.radius, ride.path, at)
            axes.imshow(image, interpolation="nearest")
            told = f"{ride.path[at, 0]:.2f} s, {ride.path[at, 3] / MM:.1f} mm high"
            page.text(left + 4, top - HEAD - HEIGHT - 16, told, fontsize=7, color=style.INK)
    return figure


def _chosen(path):
    """Rows of a path, evenly along the way and the fall."""
    moves = np.linalg.norm(np.diff(path[:, 1:4], axis=0), axis=1)
    turns = np.linalg.norm(np.diff(path[:, 4:8], axis=0), axis=1) * np.abs(path[:, 1:4]).std()
    way = np.concatenate([[0.0], np.cumsum(moves + turns)])
    return [int(np.searchsorted(way, share * way[-1])) for share in np.linspace(0.12, 1.0, STILLS)]


def _still(solid, found, place, radius, path, at):
    """The image (rows, columns, 3) of one still: the part, its shadow and the track with its cuts."""
    state = np.zeros(13)
    state[6:10] = path[at, 4:8]
    turn = runs.matrix(state) @ found.principal.T  # from the file's axes to the bowl's
    centre, size = path[at, 1:4], solid.size
    theta = np.arctan2(centre[0], radius - centre[1])
    ahead = np.array([np.cos(theta), np.sin(theta), 0.0])
    standing = placed(
        outermost(solid.points), -turn.T @ [0.0, 0.0, 1.0], max(centre[2] / size, 0.0), turn.T @ ahead
    )
    pixel = VIEW / WIDTH
    frame = Shot(-0.5 * VIEW, -0.45 * HEIGHT * pixel, pixel, WIDTH, HEIGHT)
    image = shading.picture(solid, standing, frame)
    depths, _ = standing.camera.cast(solid, *frame.positions())
    origins = standing.camera.origins(*frame.positions()).reshape(-1, 3) @ turn.T * size + centre
    back = turn @ standing.camera.back
    reach = origins[:, 2] / back[2]
    spots = (origins - reach[:, None] * back)[:, :2]
    inside = _on_track(found.stations[place], radius, spots).reshape(depths.shape)
    nearer = inside & (reach.reshape(depths.shape) < depths * size - 1e-5)
    track = np.where(_rim(inside)[..., None], RIM, GROUND)
    part = np.isfinite(depths)
    shade = np.where(part[..., None], 1.0, image)
    out = np.where(inside[..., None], track * shade, 1.0)
    return np.where((part & ~nearer)[..., None], image, out)


def _on_track(station, radius, spots):
    """Which spots (N, 2) [m] are solid track, within the wall."""
    odd = np.zeros(len(spots), bool)
    for ring in solids(station):
        odd ^= Path(np.vstack([ring, ring[:1]])).contains_points(spots)
    return odd & (np.hypot(spots[:, 0], radius - spots[:, 1]) < radius)


def _rim(inside):
    """Pixels of the track beside what is cut away."""
    rim = np.zeros_like(inside)
    rim[1:] |= inside[1:] & ~inside[:-1]
    rim[:-1] |= inside[:-1] & ~inside[1:]
    rim[:, 1:] |= inside[:, 1:] & ~inside[:, :-1]
    rim[:, :-1] |= inside[:, :-1] & ~inside[:, 1:]
    return rim
