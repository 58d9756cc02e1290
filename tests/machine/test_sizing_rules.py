"""What a bowl's rules and a length of track give, against sums done by hand."""

from dataclasses import replace

import awkward
import numpy as np
import pytest

from feederscrew.machine import sizing, throughput
from feederscrew.rates import stream

LYING = sizing.Lying(longest=0.031, tallest=0.026, length=0.03, width=0.0175)


@pytest.mark.parametrize(("tallest", "sheet"), [(0.026, 0.003), (0.04, 0.003), (0.04, 0.0055)])
def test_a_turn_rises_by_the_free_height_and_the_sheet_under_it(tallest, sheet):
    """Between the sheet of the next turn and the track there is the part's height and its headroom."""
    rules = replace(awkward.bowl().sizing, sheet=sheet, least_climb=0.0)
    found = sizing.size(replace(LYING, tallest=tallest), "a part", rules, sorts=False)
    assert found.pitch - sheet == pytest.approx(rules.headroom * tallest, rel=1e-9)
    assert found.pitch == pytest.approx(np.pi * found.diameter * np.tan(found.climb), rel=1e-9)


@pytest.mark.parametrize("wanted", [None, 0])
def test_parts_a_metre_are_those_counted_on_a_drawn_queue(wanted):
    """Parts of every orientation, laid end to end with their gap, counted over their length."""
    part, aspects = awkward.part()
    bowl = awkward.bowl()
    found = stream.orientations(part, aspects, bowl.track, bowl=bowl)
    target = None if wanted is None else (found.aspects[wanted], found.headings[wanted])
    gap, fill, count = 7.3e-3, 0.8, 400_000
    chances = found.rules["csa"] / found.rules["csa"].sum()
    drawn = np.random.default_rng(3).choice(len(chances), count, p=chances)
    way = (found.lengths[drawn] + gap).sum() / fill
    counts = found.through[drawn].sum() if wanted is None else found.leaving[drawn, wanted].sum()
    told = throughput.flow(found, "csa", target=target, gap=gap, fill=fill)
    assert told.parts == pytest.approx(counts / way, rel=0.01)
    assert told.parts < 0.9 * throughput.flow(found, "csa", target=target, fill=fill).parts
