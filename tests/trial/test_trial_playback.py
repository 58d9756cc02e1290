"""What the viewer of a report is given of a trial."""

import base64

import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew.output.page.blocks import Views
from feederscrew.output.report import CHAPTERS, page
from feederscrew.output.trial import tables
from feederscrew.studies.report import report


def decoded(text):
    return np.frombuffer(base64.b64decode(text), "<f4")


def test_the_chapter_plays_the_path_of_the_part():
    block = shapes.part(shapes.box(20, 12, 5))
    case = report(block, aspect="A", launch="feed", sent=7)
    (chapter,) = page(case, chapters=[one for one in CHAPTERS if one[0] == "trial"]).sections
    (views,) = (one for one in chapter.blocks if isinstance(one, Views))
    assert views.plays and len(views.captions) == len(views.scene["poses"]) == len(views.scene["paths"])
    assert sum(row["tried"] for row in tables.orientations(case.trial.runs[0])) == 7
    scene = views.scene
    path = decoded(scene["paths"][0]).reshape(-1, 8)
    points = decoded(scene["positions"]).reshape(-1, 3)
    lowest = [(Rotation.from_quat(row[4:]).apply(points)[:, 2] + row[3]).min() for row in path]
    np.testing.assert_allclose(lowest, 0.0, atol=0.02)  # [mm] it slides on the track
    assert (np.diff(path[:, 0]) > 0.0).all() and path[-1, 1] > path[0, 1] + 10.0
    track = decoded(scene["tracks"][0]["positions"]).reshape(-1, 3)
    assert track[:, 2].min() == pytest.approx(-4.0) and track[:, 2].max() > 10.0  # the wall


def test_the_stills_are_of_the_device_that_decides():
    """Where most do not pass while others do; a device that loses all shows nothing that passes."""
    from types import SimpleNamespace

    from feederscrew.output.trial.rides import deciding_station
    from feederscrew.trial import runs

    def lost(count):
        return SimpleNamespace(outcomes=np.where(np.arange(9) < count, runs.PASSED + 1, runs.PASSED))

    for counts, place in (((0, 1, 5, 2), 2), ((3, 0, 0, 0), 3), ((0, 2, 2), 1), ((0, 9, 1), 2)):
        assert deciding_station(SimpleNamespace(rides=[lost(count) for count in counts])) == place
