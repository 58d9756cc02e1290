"""Tosses followed from their own state: closed forms, invariances, filmed ones, each fault's line."""

from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew.arrivals import toss_runs
from feederscrew.arrivals.drop import follow
from feederscrew.arrivals.toss_runs import FACE_NAMES, STATE_COLUMNS
from feederscrew.base.errors import Faults, FeederError
from feederscrew.part import load

CUBE = {"restitution": "0.125", "friction": "0.18"}
FILMED = Path(__file__).parents[2] / "docs/measured/filmed/cube_tosses.csv"
HEAD = f"toss,{','.join(STATE_COLUMNS)}"
NO_LAUNCH = "has no launch - give the columns toss,"


@pytest.fixture
def box(tmp_path):
    shapes.box(40.0, 30.0, 20.0).export(tmp_path / "box.stl")
    return load(tmp_path / "box.stl")


@pytest.fixture
def cube(tmp_path):
    shapes.box(104.8, 104.8, 104.8).export(tmp_path / "cube.stl")
    return load(tmp_path / "cube.stl")


@pytest.fixture
def launches(tmp_path):
    """Writes a file of launches, one for each (13,) state in the order of STATE."""

    def write(*states, extra=""):
        lines = [HEAD + (extra and f",{extra}")]
        rows = (",".join([str(k), *map(repr, map(float, s))]) for k, s in enumerate(states))
        lines += [row + "," * bool(extra) for row in rows]
        (tmp_path / "launches.csv").write_text("\n".join(lines) + "\n")
        return tmp_path / "launches.csv"

    return write


def state(position=(0.0, 0.0, 0.05), turn=None, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0)):
    turn = Rotation.identity() if turn is None else turn
    return [*position, *np.roll(turn.as_quat(), 1), *velocity, *spin]


def test_a_box_that_slides_flat_stops_where_friction_says(box, launches):
    path = launches(state((0.1, -0.2, 0.010001), velocity=(0.6, 0.8, 0.0)))
    result = follow(box, path, {"friction": "0.3", "restitution": "0.1"}, runs=1).result
    way = 1.0**2 / (2.0 * 0.3 * 9.81)
    assert FACE_NAMES[result.faces[0]] == "+z"
    assert result.places[0] == pytest.approx([0.1 + 0.6 * way, -0.2 + 0.8 * way], abs=0.003 * way)
    assert result.times[0] == pytest.approx(1.0 / (0.3 * 9.81), rel=0.05)


@pytest.mark.parametrize(("side", "axis"), [("+x", (0, -90, 0)), ("-y", (-90, 0, 0)), ("-z", (180, 0, 0))])
def test_the_side_set_up_is_the_side_told(box, launches, side, axis):
    turn = Rotation.from_euler("xyz", axis, degrees=True)
    up = turn.inv().apply([0.0, 0.0, 1.0])
    assert np.abs(up).argmax() == "xyz".index(side[1]) and (up.sum() > 0.0) == (side[0] == "+")
    result = follow(box, launches(state(turn=turn)), CUBE, runs=3).result
    assert FACE_NAMES[result.faces[0]] == side == FACE_NAMES[result.released[0]]
    assert result.shares[0].sum() == pytest.approx(1.0)


def test_turning_the_room_turns_the_answer(box, launches, rng):
    turns, yaw = Rotation.random(6, random_state=5), Rotation.from_rotvec([0.0, 0.0, 0.7])
    ways, spins = rng.normal(size=(6, 3)) * 0.4, rng.normal(size=(6, 3)) * 8.0

    def ends(room):
        place, draws = room.apply([0.02, 0.03, 0.06]), zip(turns, ways, spins)
        states = (state(place, room * t, room.apply(v), w) for t, v, w in draws)
        return follow(box, launches(*states), CUBE, runs=1).result

    one, other = ends(Rotation.identity()), ends(yaw)
    same = one.faces == other.faces  # a drop is chaotic: a last digit may decide one of them
    assert same.sum() >= 5
    flat = yaw.apply(np.column_stack([one.places, np.zeros(6)]))[:, :2]
    assert np.median(np.hypot(*(flat - other.places).T)[same]) < 1e-3


def test_filmed_tosses_of_a_cube_end_as_they_did(tmp_path, cube):
    """A quarter of them with few runs; docs/validation.md has all."""
    lines = FILMED.read_text().splitlines()
    (tmp_path / "some.csv").write_text("\n".join(lines[:2] + lines[2::4]) + "\n")
    match = follow(cube, tmp_path / "some.csv", CUBE, runs=9).agreement
    assert match.tosses == 72 and match.right_share > 0.72 and match.at_release < 0.5
    assert match.median_off < 0.045
    assert abs(match.expected - match.right_share) < 0.06  # p promises about what it keeps


def test_blurred_launches_and_jobs(cube, launches, box):
    turn = Rotation.from_euler("xyz", [30, 20, 10], degrees=True)
    start = state((0.0, 0.0, 0.25), turn, (1.0, 0.2, 0.1), (3.0, -4.0, 2.0))
    sharp = follow(cube, launches(start), CUBE).result
    blurred = follow(cube, launches(start, extra="frames_30Hz"), CUBE).result
    assert sharp.spreads[0] > 0.0 and blurred.spreads[0] > sharp.spreads[0]
    path = launches(*(state(spin=(9.0, k, 3.0), velocity=(0.5, 0.0, 0.0)) for k in range(6)))
    one, two = (follow(box, path, CUBE, runs=5, jobs=jobs, seed=3).result for jobs in (1, 2))
    assert (one.places == two.places).all() and (one.shares == two.shares).all()


@pytest.mark.parametrize("ends", [(0.3, 0.3), (0.2, 0.6)])
def test_values_scatter_about_a_value_and_fill_a_range(ends, rng):
    values = toss_runs.scattered(ends, 0.16, rng.standard_normal(20000))
    assert toss_runs.scattered(ends, 0.16, np.zeros(1))[0] == pytest.approx(sum(ends) / 2)
    if ends[0] == ends[1]:
        quarters = np.percentile(values, [25, 75]) / 0.3
        assert quarters == pytest.approx([0.53 / 0.6, 0.66 / 0.6], abs=0.02)  # 1,718 filmed impacts
    else:
        assert values.min() > 0.2 and values.max() < 0.6
        assert np.percentile(values, [25, 50, 75]) == pytest.approx([0.3, 0.4, 0.5], abs=0.01)


WHOLE = ",".join(["0", *map(str, state())])


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("", NO_LAUNCH),
        (f"{HEAD}\n", NO_LAUNCH),
        (f"{HEAD.removesuffix(',wz0')}\n{WHOLE}\n", ":1: there is no column wz0 - give the columns toss,"),
        (f"{HEAD},x0_m\n{WHOLE},1\n", ":1: column x0_m is given twice - keep one of them"),
        *((f"{HEAD}\n{WHOLE}\n".replace("0.05", text), f"z0_m: '{text}' is not a number")
          for text in ("high", "1_0", "\u0663")),
        (f"{HEAD}\n{WHOLE}\n".replace("1.0", "0.5", 1), "the quaternion has the length 0.5"),
        (f"{HEAD}\n{WHOLE}\n".replace("0.05", "5e4"), "z0_m is 5e4 - give m, from -1000 to"),
        (f"{HEAD},face_up_end\n{WHOLE},top\n", "face_up_end: 'top' is not a side of the part"),
    ],
)  # fmt: skip
def test_each_fault_of_a_file_is_a_line(tmp_path, text, line):
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises((FeederError, Faults)) as caught:
        toss_runs.read_launches(tmp_path / "bad.csv")
    assert line in str(caught.value) and "\n" not in str(caught.value)


def test_a_launch_below_the_plane_is_refused(box, launches):
    path = launches(state(), state((0.0, 0.0, 0.004)))
    with pytest.raises(FeederError) as caught:
        follow(box, path, CUBE, runs=1)
    line = f"{path}:3: the launch begins 6 mm below the plane - give x0_m, y0_m, z0_m of the centre of mass"
    assert str(caught.value).startswith(line)
