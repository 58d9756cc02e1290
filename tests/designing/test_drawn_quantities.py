"""Every drawn quantity of the robust run: mean, spread and ends against closed forms.

A number that is drawn evenly over a width w about c has the mean c and the standard deviation w / sqrt(12).
All samples are of fixed seeds: the Kolmogorov-Smirnov test of each is a number, not a chance.
"""

from dataclasses import replace

import numpy as np
import pytest
import shapes
import trimesh
from scipy import stats

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Friction
from feederscrew.designing import exploring, short_trials
from feederscrew.designing.exploring import Search
from feederscrew.designing.record import Attempt, DesignRequest
from feederscrew.tooling.devices.kinds import make_device

DRAWS = 1500
MM = 1e-3
LEAST_P = 0.01  # of the Kolmogorov-Smirnov tests: all samples below are above it
FRICTION = {"static": 0.5, "kinetic": 0.42, "static_backward": 0.62, "kinetic_backward": 0.55, "wall": 0.27}
HOLE = np.array([[0.0, 2.0], [9.0, 2.0], [9.0, 6.0], [0.0, 6.0]]) * MM
SIDES = np.array([24.0, 14.0, 6.0]) * MM  # of a box, no two alike


def is_even(values, centre, half):
    """Whether values are drawn evenly from ``half`` below to ``half`` above a centre, and reach near both."""
    values = np.asarray(values)
    assert values.mean() == pytest.approx(centre, abs=4.0 * half / np.sqrt(3.0 * len(values)))
    assert values.std() == pytest.approx(half / np.sqrt(3.0), rel=0.06)
    ends = centre - half, centre + half
    assert ends[0] <= values.min() < centre - 0.98 * half and centre + 0.98 * half < values.max() <= ends[1]
    return stats.kstest(values, stats.uniform(ends[0], 2.0 * half).cdf).pvalue > LEAST_P


@pytest.fixture(scope="module")
def bowl(block):
    """A bowl with a cut, a strip, a hole and a sensor, and frictions that all differ."""
    one = block.ways.lying[0]
    devices = (
        make_device("gap", "test", limit=9.5 * MM, text="test"),
        make_device("slot", "test", span=(2.0 * MM, 5.0 * MM), text="test"),
        make_device("cut_out", "test", corners=tuple(map(tuple, HOLE)), text="test"),
        make_device("sorter", "test", like=(one.aspect, one.heading, 1.2 * MM), text="test"),
    )
    plain = bowls.read(None, ["drive.amplitude=0.2 mm", "restitution=0.3"])
    return replace(plain, devices=devices, friction=Friction(**FRICTION))


def draw(block, bowl, seed, count):
    lying = block.ways.lying
    return [short_trials.drawn_bowl(bowl, lying, np.random.default_rng((seed, k))) for k in range(count)]


def test_what_is_drawn_of_a_bowl_is_even_and_does_not_go_together(block, bowl):
    """Friction from 0.6 to 1.4 times, stroke from 0.9 to 1.1, every cut by 0.1 mm to either side.

    Correlations of so many independent draws stay within four times 1 / sqrt(N).
    """
    drawn = draw(block, bowl, 7, DRAWS)
    friction = {k: np.array([getattr(one.friction, k) for one in drawn]) / v for k, v in FRICTION.items()}
    strokes = [one.drive.amplitude / bowl.drive.amplitude for one in drawn]
    gaps, play = ([one.devices[k] for one in drawn] for k in (0, 3))
    gaps, play = [one.limit for one in gaps], [one.like[2] for one in play]
    ends = np.array([one.devices[1].span for one in drawn])
    assert is_even(friction["static"], 1.0, 0.4)
    for ratios in friction.values():  # all coefficients alike
        assert ratios == pytest.approx(friction["static"], rel=1e-12)
    assert is_even(strokes, 1.0, 0.1)
    assert {replace(one.drive, amplitude=1.0) for one in drawn} == {replace(bowl.drive, amplitude=1.0)}
    for values, size in ((gaps, 9.5), (ends[:, 0], 2.0), (ends[:, 1], 5.0), (play, 1.2)):
        assert is_even(values, size * MM, 0.1 * MM)
    hole = np.array([np.ptp(np.array(one.devices[2].corners), axis=0) for one in drawn])
    assert is_even(hole[:, 0], 9.0 * MM, 0.2 * MM)  # both sides of a hole by the same
    assert hole[:, 0] - 9.0 * MM == pytest.approx(hole[:, 1] - 4.0 * MM, abs=1e-9)
    restitutions = np.array([one.restitution for one in drawn])
    columns = np.array([friction["static"], strokes, restitutions, gaps, *ends.T, play])
    assert np.abs(np.corrcoef(columns) - np.eye(len(columns))).max() < 4.0 / np.sqrt(DRAWS)
    # restitution is normal with the scatter of 1,718 filmed impacts, quartiles 0.53, 0.60, 0.66:
    # docs/validation.md
    ratios = restitutions / 0.3
    assert ratios.mean() == pytest.approx(1.0, abs=4.0 * 0.16 / np.sqrt(DRAWS))
    assert ratios.std() == pytest.approx(0.16, rel=0.06)
    assert stats.kstest(ratios, stats.norm(1.0, 0.16).cdf).pvalue > LEAST_P
    assert np.ptp(np.quantile(ratios, (0.25, 0.75))) == pytest.approx((0.66 - 0.53) / 0.60, rel=0.08)


@pytest.mark.parametrize("restitution", [0.0, 0.95])
def test_restitution_stays_between_none_and_all(block, restitution):
    drawn = draw(block, replace(bowls.default(), restitution=restitution), 3, 200)
    values = [one.restitution for one in drawn]
    assert min(values) >= 0.0 and max(values) <= 1.0
    assert (len(set(values)) > 50) == (restitution > 0.0)


def drawn_sides(part, tolerance, axes, count):
    """Drawn parts, and their sizes (count, 3) [m] along axes (3, 3), the rows of a rotation."""
    parts = [short_trials.drawn_part(part, tolerance, np.random.default_rng((11, k))) for k in range(count)]
    return parts, np.array([[np.ptp(one.vertices @ axis) for axis in axes] for one in parts])


@pytest.fixture(scope="module")
def askew():
    """The box turned askew, and the axes (3, 3) of its sides."""
    turn = trimesh.transformations.euler_matrix(0.4, -0.7, 1.1)
    mesh = shapes.box(*SIDES / MM)
    mesh.apply_transform(turn)
    return shapes.part(mesh), turn[:3, :3].T


def test_a_part_is_off_along_each_principal_axis_by_up_to_its_tolerance(askew):
    part, axes = askew
    (first, *_), sides = drawn_sides(part, 0.1 * MM, axes, 400)
    for k in range(3):
        assert is_even(sides[:, k], SIDES[k], 0.1 * MM)
    assert np.abs(np.corrcoef(sides.T) - np.eye(3)).max() < 4.0 / np.sqrt(400)
    volume = sides[0].prod()
    assert (first.mass, first.volume) == pytest.approx((shapes.STEEL * volume, volume), rel=1e-9)
    assert (first.hull.vertices @ axes.T).max(axis=0) == pytest.approx(0.5 * sides[0], rel=1e-9)
    # I = m / 12 (b^2 + c^2), for sides that are off by so much that a wrong power shows
    for one, side in zip(*drawn_sides(part, 2.0 * MM, axes, 20)):
        square = side**2
        moments = shapes.STEEL * side.prod() / 12.0 * (square.sum() - square)
        assert axes @ one.inertia @ axes.T == pytest.approx(np.diag(moments), rel=1e-9, abs=1e-9 * moments[0])


def test_a_round_part_stays_round():
    part = shapes.part(shapes.cylinder(5, 14, 64))
    _, sides = drawn_sides(part, 0.1 * MM, np.eye(3), 60)
    assert sides[:, 0] == pytest.approx(sides[:, 1], rel=1e-9)
    assert np.ptp(sides[:, 0]) > 0.15 * MM and np.ptp(sides[:, 2]) > 0.15 * MM
    assert abs(np.corrcoef(sides[:, 0], sides[:, 2])[0, 1]) < 4.0 / np.sqrt(60)


def test_each_draw_tries_the_wanted_orientation_and_others_by_their_shares(block):
    count = len(block.ways.lying)
    shares = np.arange(1.0, count + 1.0)
    shares /= shares.sum()
    rng, seen = np.random.default_rng(5), np.zeros(count)
    for _ in range(2000):
        rows = short_trials.drawn_rows(block.ways, shares, np.array([2]), rng)
        assert rows[0] == 2 and len(rows) == len(set(rows)) <= 1 + short_trials.OTHERS_DRAWN
        seen[rows] += 1
    absent = (1.0 - shares) ** 3  # of three parts as they come
    expected = np.where(np.arange(count) == 2, 1.0, 1.0 - absent)
    assert seen / 2000.0 == pytest.approx(expected, abs=4.0 * 0.5 / np.sqrt(2000.0))


@pytest.fixture
def quarter(block):
    """A quarter of the first orientation and the rest of the second: shares, and their mean length [m]."""
    shares = np.zeros(len(block.ways.lying))
    shares[:2] = 0.25, 0.75
    return shares, 0.25 * block.ways.lengths[0] + 0.75 * block.ways.lengths[1]


@pytest.mark.parametrize("apart", [0.0, 7.0 * MM])
def test_a_bowl_is_driven_for_1_6_times_what_is_asked_for(block, quarter, apart):
    """Parts 1.5 lengths and a gap apart at 0.5 a second, of which a quarter is wanted."""
    weights, mean = quarter
    search = Search(block.part, DesignRequest(0.5), bowls.default(), frozenset(), lambda text: None)
    needed = 1.6 * 0.5 * (1.5 * mean + apart) / 0.25
    found = exploring.required_velocity(search, block.ways, weights, 0.25, apart)
    assert found == pytest.approx(needed, rel=1e-12)


def test_a_row_brings_its_velocity_over_its_pitch_times_what_leaves(block, quarter):
    """Half a length between parts, and what the devices need; never closer than wanted ones in a row."""
    ways, (shares, mean) = block.ways, quarter
    own = {"velocity": 0.06, "state": 0, "states": (0,), "deepest": 0.0, "places": ({}, {})}
    counts = (np.array([2, 2]), np.array([2, 0]), np.array([0, 0]), np.array([0, 2]))
    seen = short_trials.Tried(ways, shares, np.array([0, 1]), *counts, **own)
    for spacing in (0.0, 8.0 * MM):
        rate = 0.06 / (1.5 * mean + spacing) * 0.25
        assert replace(seen, spacing=spacing).rate == pytest.approx(rate, rel=1e-12)
    for state in (0, 1):
        as_it_lies = replace(seen, right=np.array([2, 2]), states=(state,)).rate
        longest = max(mean, ways.states[state].length)
        assert as_it_lies == pytest.approx(0.06 / (1.5 * longest), rel=1e-12)


@pytest.mark.parametrize(("rate", "share"), [(0.5, 0.9), (0.6, 0.75), (5.0, 0.5), (0.1, 1.0)])
def test_what_may_come_back_in_a_draw_is_what_the_target_does_not_take(rate, share):
    """0.9 of the target of 0.5 a second, over the rate of the short trial; half at least."""
    search = Search(None, DesignRequest(0.5), bowls.default(), frozenset(), lambda text: None)
    attempt = Attempt("A@0", (), "", 0.0, 0.1, 2, 1.0, 1.0, 0.0, rate, ())
    assert search.enough(attempt) == pytest.approx(share)
