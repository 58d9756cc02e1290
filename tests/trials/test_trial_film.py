"""The film of a trial, and the paths that the viewer of a report plays; what is refused beforehand."""

import base64
import os
import stat

import numpy as np
import pytest
import shapes
from PIL import Image
from scipy.spatial.transform import Rotation

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.output.page.blocks import Views
from feederscrew.output.report import report
from feederscrew.output.report_page import CHAPTERS, page
from feederscrew.output.trial import film, tables
from feederscrew.output.trial.figures import unroll_path
from feederscrew.output.trial.rides import rides_to_show
from feederscrew.trials.course import Fate
from feederscrew.trials.trial import trial


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    file = tmp_path_factory.mktemp("film") / "bowl.yaml"
    file.write_text(
        "track: {climb: 0 deg, width: 30 mm}\ndevices:\n"
        "  - sorter: {of: A@0, play: 2 mm, sees: outline, jet: {time: 25 ms}}\n"
    )
    block = shapes.part(shapes.box(20, 12, 5))
    return trial(block, [bowls.read(file)], "A", parts=6, queue=3, seconds=0.4, frames=5)


@pytest.fixture
def small(monkeypatch):
    for name, value in (("SECONDS", 1.0), ("QUEUE_FRAMES", 5), ("WIDTH", 96), ("HEIGHT", 60), ("SAMPLES", 1)):
        monkeypatch.setattr(film, name, value)


def test_air_is_drawn_while_the_sensor_lets_it_blow(study, small):
    """The part that lies across is blown off: its jets blow as it comes to them at its own speed."""
    run = study.runs[0]
    passing, rejected = rides_to_show(study.part, run)
    assert (passing.fate, passing.blows) == (Fate.PASSED, None) and rejected.fate is Fate.RETURNED
    stage, radius = run.course.stations[rejected.place], run.bowl.track.radius
    (watch,), (begin, end) = stage.air.watches, rejected.blows
    ways, _ = unroll_path(rejected.path, radius)
    where = np.interp([rejected.looked, begin], rejected.path[:, 0], ways)
    np.testing.assert_allclose(where, [watch.place, watch.nozzles], atol=5e-4)
    assert end - begin == pytest.approx(0.025)
    times = film.still_times(rejected, 0.012)
    assert len(times) == film.STILLS and rejected.looked in times
    assert begin < times[-1] <= 0.5 * (begin + end)  # it is gone before the air is
    scene = film.FilmSet(study.part, run, stage, rejected.path[:, 1:4])
    pose, steel = rejected.path[:1, 1:], [np.ones(3)]
    still, blown = (scene.drawn(pose, steel, [blows] * len(scene.air)) for blows in (False, True))
    bluer = (blown - still)[..., 2] - (blown - still)[..., 0] > 0.1
    outlet = np.array([[stage.air.jets[f"mouth_{e}"][0] for e in "xyz"]])
    mouth = scene.camera.project(outlet - scene.centre)[0]
    column = (mouth[0] - scene.across[0]) / (scene.across[1] - scene.across[0])
    assert bluer.sum() > 10 and np.abs(np.nonzero(bluer)[1] - column).min() < 3.0
    (pulses,) = run.queue.pulses  # every part that is blown off the queue has had one
    assert len(pulses) >= run.queue.returned
    assert [end - begin for begin, end in pulses] == pytest.approx([0.025] * len(pulses))


def test_a_part_is_drawn_where_it_is(study, small):
    """The coloured pixels lie about the projection of its centre of mass, which the camera gives."""
    run = study.runs[0]
    pose = run.queue.poses[0, :1]
    scene = film.FilmSet(study.part, run, run.queue.stage, run.queue.poses[:, 0, :3])
    image = scene.drawn(pose, [np.array([1.0, 0.0, 0.0])])
    red = (image[..., 0] > 0.3) & (image[..., 1] < 0.05)
    rows, columns = np.nonzero(red)
    assert len(rows) > 20
    x, y = scene.camera.project(pose[:, :3] - scene.centre)[0]
    pixel = scene.across[1] - scene.across[0]
    assert columns.mean() == pytest.approx((x - scene.across[0]) / pixel, abs=4.0)
    assert rows.mean() == pytest.approx((scene.up[0] - y) / pixel, abs=4.0)
    hidden = np.array(pose)
    hidden[0, 2] -= 0.2  # below the floor of the bowl: it shines through, and is not in front
    assert not ((scene.drawn(hidden, [np.array([1.0, 0.0, 0.0])])[..., 1] < 0.05) & red).any()


def test_the_film_is_a_gif_of_single_parts_and_the_queue(study, small, tmp_path):
    words = [caption for _, caption, _ in film.film_frames(study.part, study.runs[0])]
    assert len(words) == 12 and words[-1] == "queue of 3: 0 left, 0 returned"
    names = [one.partition(" at ")[0] for one in words[:7]]
    assert names == sorted(names)
    path = tmp_path / "film.gif"
    film.write_film(path, study)
    with Image.open(path) as picture:
        assert picture.format == "GIF" and picture.n_frames > 2
    assert [one.name for one in tmp_path.iterdir()] == ["film.gif"]  # nothing half-written is left


@pytest.mark.parametrize(("ending", "codec"), [("mp4", "libx264"), ("webm", "libvpx-vp9")])
def test_a_film_that_needs_ffmpeg_is_written_by_it(study, small, ending, codec, tmp_path, monkeypatch):
    """The program is stood in for by one that notes what it is called with."""
    program = tmp_path / "ffmpeg"
    # the last word is the file
    program.write_text('#!/bin/sh\nfor last; do :; done\ncat > /dev/null\necho "$@" > "$last"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    film.write_film(tmp_path / f"film.{ending}", study)
    words = (tmp_path / f"film.{ending}").read_text()
    assert codec in words and "yuv420p" in words


def test_what_cannot_be_written_is_said_before_anything_is_computed(run, tmp_path, monkeypatch):
    (tmp_path / "none.stl").write_text("")
    result = run("trial", "none.stl", "--film", "film.avi")
    assert result.exit_code == 2 and "end it in .gif, .mp4, .webm" in result.output
    monkeypatch.setenv("PATH", "/nowhere")
    for path, said in (("film.mp4", "needs ffmpeg"), ("missing/film.gif", "folder")):
        with pytest.raises(FeederError, match=said):
            film.require_writer(tmp_path / path)


def decoded(text):
    return np.frombuffer(base64.b64decode(text), "<f4")


def test_the_chapter_of_a_report_plays_the_path_of_the_part():
    case = report(shapes.part(shapes.box(20, 12, 5)), aspect="A", launch="feed", sent=7)
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
