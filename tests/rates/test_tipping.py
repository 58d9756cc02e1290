"""Orientations that the drive turns over on the track, and those that it only rocks."""

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.mechanics.floor.balance import TIP
from feederscrew.output.rate import tables
from feederscrew.rates.stream import orientations
from feederscrew.rates.tipping import tipping
from feederscrew.resting.aspects import find
from feederscrew.studies.rate import Shares, rate
from feederscrew.studies.track import track

ROUGH = ("friction.static=0.9", "track.climb=1 deg")
BOWL = bowls.read(None, ROUGH)


def pin(size):
    """A square pin four times as high as it is wide [mm]; its aspect B stands."""
    part = shapes.part(shapes.box(size, size, 4 * size))
    return part, find(part)


def studied(size, aspect=None, bowl=BOWL):
    part, found = pin(size)
    return rate(part, bowl, aspect, rule="csa", known=Shares(found))


def tilts(size, bowl=BOWL):
    part, found = pin(size)
    known = orientations(part, found, bowl.track)
    return known, tipping(known.lying, bowl)


def test_what_tips_over_lowers_the_rate_to_zero_and_is_said():
    study = studied(1, "B")
    row = study.rate.row
    assert study.rate.parts.all == (0.0, 0.0, 0.0) and study.rate.orientations.passes[row, 0] == 0.0
    (line,) = tables.remarks(study)
    assert line == "B@0 can tip over on the track at this drive and count as returned; rate is 0"
    assert study.rate.orientations.leaving[:, row].sum() == 0.0


def test_the_other_orientation_leaves_pure():
    study = studied(1, "A")
    assert study.rate.orientations.aspects.count("B") == 1 and study.rate.through == 1.0
    assert study.rate.purity > studied(10, "A").rate.purity
    assert tables.remarks(study)[0].startswith("B@0 can tip over")


def test_a_large_pin_rocks_and_passes():
    study = studied(10, "B")
    assert study.rate.parts.value > 0.0
    (line,) = tables.remarks(study)
    assert line.startswith("B@0 rocks on the track: a stroke tilts it by 1.6") and "from 14 deg" in line


def test_tilt_goes_with_size_and_the_square_of_the_period():
    """M / (m (r^2 + h^2)) has the unit 1/length at one throw; half a period enters squared."""
    one, large = (tilts(size)[1] for size in (1, 10))
    slow = bowls.read(None, (*ROUGH, "drive.frequency=25 Hz", "drive.amplitude=0.84 mm"))
    row = int(np.argmax(one.tips))
    assert one.tilt[row] == pytest.approx(10.0 * large.tilt[row], rel=2e-2)
    assert tilts(10, slow)[1].tilt[row] == pytest.approx(4.0 * large.tilt[row], rel=1e-6)
    assert np.degrees(one.balance[row]) == pytest.approx(np.degrees(np.arctan(0.25)), rel=1e-9)


def test_it_tips_where_feeder_track_says_so():
    part, _ = pin(10)
    known, told = tilts(10)
    for one, tips in zip(known.lying, told.tips):
        states = track(part, BOWL, one.aspect, one.heading).cycle.state
        assert tips == (TIP in states)


def test_nothing_is_said_where_flights_or_another_drive_are_not_followed():
    for more in ("drive.amplitude=0.5 mm", "drive.second_harmonic=0.3"):
        _, told = tilts(1, bowls.read(None, (*ROUGH, more)))
        assert not told.tips.any() and not told.over.any()
