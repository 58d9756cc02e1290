"""Curved deflector: its face, its verdict in closed form, and what a file says of it."""

from dataclasses import replace

import numpy as np
import pytest
from on_track import LEVEL, block, device, lying, pick, read

from feederscrew.base.errors import ConfigError, Faults
from feederscrew.sorting.verdicts import DeviceEncounter, verdict


def deflector(clearance, begin=12.0, end=50.0):
    """A curved deflector of a clearance [mm] and two angles [deg]."""
    return device("curved deflector", limit=1e-3 * clearance, begin=np.radians(begin), end=np.radians(end))


def test_it_passes_what_is_lower_by_the_difference():
    """Nothing else than its height, 5 and 12 mm, decides on a block that is only placed."""
    flat, on_edge = (pick(lying(block()), length=20, height=high) for high in (5, 12))
    assert verdict(deflector(6.3), flat).margin == pytest.approx(1.3e-3)
    assert verdict(deflector(6.3), on_edge).margin == pytest.approx(-5.7e-3)


@pytest.mark.parametrize(("end", "fate"), [(50.0, "returned"), (61.0, "returned"), (64.0, "stopped")])
def test_its_last_piece_has_to_sweep_parts_on(end, fate):
    """At friction 0.6 up to 59 deg: the middle of the last of 7 pieces from 12 to 61 deg is 57.5 deg."""
    on_edge = replace(pick(lying(block()), length=20, height=12), grip=0.6)
    assert deflector(6.3, end=end).fate(DeviceEncounter(on_edge)) == fate


def test_its_pieces_follow_an_arc_from_the_wall_to_the_free_edge():
    """Chords of an arc of turn b - a over a width w have its radius w / (cos a - cos b), to 0.1 %."""
    features = deflector(6.3).features(replace(LEVEL, width=18e-3), lying(block()))
    feet = np.array([blade.foot for blade in features.blades])
    last = features.blades[-1]
    end = feet[-1] + last.solid.bounds[2] * last.axes[0]
    assert end == pytest.approx([features.length, 18e-3], abs=1e-6)  # on a wall of 100 m
    assert feet[0, 1] == 0.0 and np.all(np.diff(np.degrees([b.heading for b in features.blades])) <= 7.0)
    radius = 18e-3 / (np.cos(np.radians(12.0)) - np.cos(np.radians(50.0)))
    centre = feet[0] + radius * np.array([-np.sin(np.radians(12.0)), np.cos(np.radians(12.0))])
    assert np.hypot(*(np.vstack([feet, end]) - centre).T) == pytest.approx(radius, rel=1e-3)


def test_what_a_file_says_of_a_deflector_comes_back_as_it_was(tmp_path):
    words = "{clearance: 6.3 mm, from: 12 deg, to: 50 deg}"
    blade = read(tmp_path, f"curved deflector: {words}").devices[0]
    assert blade.value_text() == words
    assert blade.document_values() == pytest.approx({"value_mm": 6.3, "from_deg": 12.0, "to_deg": 50.0})
    with pytest.raises(Faults, match="bends back"):
        read(tmp_path, "curved deflector: {clearance: 6 mm, from: 40 deg, to: 30 deg}")


def test_a_face_that_meets_the_wall_again_is_refused():
    """A chord of 14.7 deg leaves a wall of 80 mm by R (1 - cos) at most, 2.6 mm: no piece reaches 24 mm."""
    with pytest.raises(ConfigError, match="its face from 12 deg on meets the wall before the free edge"):
        deflector(6.3, end=15.0).features(replace(LEVEL, radius=80e-3, width=24e-3), lying(block()))
