"""Paths over the devices of a trial: one scale in all panels, and what air blows off in its own colour."""

from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew.geometry.compiled import zero_rows
from feederscrew.output.trial import figures
from feederscrew.trial import course, runs
from feederscrew.trial.kernel import workspace
from feederscrew.trial.staging import Watch

RADIUS = 0.15  # [m] of the wall


def over(ways, off):
    """A path at a distance [m] from the wall to lengths along it [m]."""
    angles, r = np.array(ways) / RADIUS, RADIUS - off
    places = np.column_stack([r * np.sin(angles), RADIUS - r * np.cos(angles), 0.0 * angles])
    return np.column_stack([np.arange(len(ways)), places, np.zeros((len(ways), 4))])


def station(end, *watches):
    device = SimpleNamespace(name="device", value_words="")
    air = SimpleNamespace(watches=watches)
    bare = {"plates": zero_rows(1, workspace.PLATE_RECORD), "borders": zero_rows(0, workspace.BORDER)}
    return SimpleNamespace(device=device, begin=0.0, exit=end, air=air, **bare)


def test_panels_have_one_scale_and_blown_off_parts_their_colour():
    returned, gone = course.FATES.index("returned"), runs.PASSED + 1
    paths = np.stack([over([0.0, 0.01, 0.02, 0.03], 8e-3), over([0.0, 0.004, 0.008, 0.012], 8e-3)])
    tried = SimpleNamespace(
        course=SimpleNamespace(
            stations=[station(0.03), station(0.12, Watch(0.02, 0.03, None, slice(0, 1), 0.04))],
            rides=[
                SimpleNamespace(outcomes=np.full(2, outcome), paths=paths) for outcome in (runs.PASSED, gone)
            ],
            riders=[np.arange(2)] * 2,
            fates=np.full(2, returned),
        ),
        bowl=SimpleNamespace(track=SimpleNamespace(radius=RADIUS)),
    )
    figure = figures.paths(tried)
    first, second = figure.axes
    figure.draw_without_rendering()
    assert [np.ptp(axes.get_xlim()) for axes in figure.axes] == pytest.approx([124.0, 124.0])
    boxes = [axes.get_window_extent() for axes in figure.axes]
    scales = [(box.width / np.ptp(axes.get_xlim()), box.height / np.ptp(axes.get_ylim()))
              for box, axes in zip(boxes, figure.axes)]  # fmt: skip
    np.testing.assert_allclose(scales, scales[0][0], rtol=1e-6)  # along and across, in both panels
    colours = [line.get_color() for line in second.lines]
    assert figures.LOOKS["blown off"][0] in colours  # it came to the sensor
    assert figures.LOOKS["returned"][0] in colours  # it slid off before
    there = [line.get_color() for line in first.lines if len(line.get_xdata())]  # not the legend's
    assert figures.LOOKS["blown off"][0] not in there
