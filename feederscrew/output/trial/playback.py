"""Parts that go through a device, for the viewer: mesh and track once, and where the part is when."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.output import shading, tooling_views
from feederscrew.output.shading import encoded, short
from feederscrew.output.trial.rides import rides_to_show
from feederscrew.output.trial.section import section
from feederscrew.units import MM

REACH = 1.9  # of the part's radius: how much of the track around it is seen
ABOVE = 1.5  # of the part's radius: how high the wall is
STILL, AFTER = 0.05, 0.3  # [mm], [s] a part that moves no more than that to the end is left out after so long


def scene(part, *tried) -> tuple[Any, ...]:
    """What the viewer plays: one part that passes a device and one that does not.

    Parameters
    ----------
    part : Part
        With a mesh.
    *tried : TrialRun
        Of the same bowl.

    Returns
    -------
    scene : dict
        For JSON: mesh, ``tracks`` and view as in the report's other scenes; ``paths`` (K, 8) float32 in
        base64: time [s], centre of mass [mm] and attitude x y z w, from the file's axes to the bowl's;
        ``poses`` at the start of each, with the number of its path.
    captions : list of (str, str)
        What each pose is, and what becomes of it.
    """
    rides, run, sent = rides_to_show(part, *tried), tried[0], tried[0].course
    view = shading.viewed(part, tooling_views.TO_VIEWER)
    cut = section(sent.stations[rides[0].place], run.bowl.track, ABOVE * view["radius"] * MM)
    paths = [_path(ride.path, sent.principal) for ride in rides]
    return view | {
        "reach": REACH,
        "tracks": [shading.track(*cut)],
        "paths": [encoded(path, "<f4") for path in paths],
        "poses": [_pose(ride, path, k) for k, (ride, path) in enumerate(zip(rides, paths))],
    }, [(ride.orientation, ride.title(sent).partition(" ")[2]) for ride in rides]


def _pose(ride, path, place) -> dict[Any, Any]:
    """Where it starts."""
    return {
        "name": ride.orientation,
        "quaternion": [short(q) for q in path[0, 4:]],
        "height": short(path[0, 3]),
        "contact": [],
        "track": 0,
        "path": place,
    }


def _path(path, principal):
    """Time [s], place [mm] and attitude, x y z w, up to where it moves no more (K, 8)."""
    turns = Rotation.from_quat(path[:, [5, 6, 7, 4]]) * Rotation.from_matrix(np.array(principal)).inv()
    result = np.column_stack([path[:, 0], path[:, 1:4] / MM, turns.as_quat()])
    moving = np.flatnonzero(np.abs(result[:, 1:4] - result[-1, 1:4]).max(axis=1) > STILL)
    last = result[moving[-1], 0] + AFTER if len(moving) else AFTER
    return result[result[:, 0] <= max(last, result[min(1, len(result) - 1), 0])]
