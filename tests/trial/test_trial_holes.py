"""A hole in the trial is the hole that is drawn, also where its sides run slanting into wall or free edge."""

import numpy as np
import pytest
import shapely
import shapes

from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.verdicts import verdict
from feederscrew.trial import course, staging

SLANTED = [(0.0, 6.75), (2.05, 0.0), (19.55, 0.0), (23.5, 7.35), (16.85, 9.1), (12.85, 9.25)]  # [mm]
PART = shapes.part(shapes.box(21.62, 11.89, 7.12))


@pytest.fixture(scope="module")
def slanted(tmp_path_factory):
    """A bowl whose hole leaves a wedge of track in two corners at the wall."""
    path = tmp_path_factory.mktemp("hole") / "bowl.yaml"
    text = ", ".join(f"[{x} mm, {y} mm]" for x, y in SLANTED)
    path.write_text(f"devices:\n  - cut_out: [{text}]\n")
    return bowls.read(path, ["track.width=25 mm"])


def test_the_trial_has_the_hole_that_is_drawn(slanted):
    """Area of the track that it takes, about the bowl's axis, between the wall and the free edge."""
    every = orientations(PART, find(PART), slanted.track)
    stage = staging.stage(slanted.devices[0], slanted.track, every)
    borders = stage.borders[stage.plates[0].begin : stage.plates[0].end]
    ring = np.column_stack([borders.start_x, borders.start_y])
    radius, track = slanted.track.radius, slanted.track
    theta = np.arctan2(ring[:, 0], radius - ring[:, 1])
    floor = shapely.Polygon(
        np.column_stack([radius * theta, radius - np.hypot(ring[:, 0], radius - ring[:, 1])])
    )
    over = shapely.box(-5e-3, 0.0, 28e-3, track.width)
    missing = over.difference(floor).area
    assert missing == pytest.approx(1e-6 * shapely.Polygon(SLANTED).area, rel=2e-3)


def test_a_block_that_the_corners_carry_gets_over(slanted):
    every = travelling(orientations(PART, find(PART), slanted.track), slanted)
    row = next(k for k, one in enumerate(every) if one.length > 0.0216 and one.height < 0.0072)
    said = verdict(slanted.devices[0], every[row], every)
    assert said.passes == 1.0 and said.margin > 1e-3
    seen = course.course(PART, slanted, every, course.Sending([row], 3), slanted.devices, run=RunSettings(3))
    assert list(seen.fates) == [course.PASSED] * 3
