"""Tosses followed from their own state: closed forms, invariances, filmed ones, each fault's line."""

from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.spatial.transform import Rotation

from feederscrew.dropping import toss_runs
from feederscrew.dropping.toss_runs import FACE_NAMES, STATE_COLUMNS
from feederscrew.errors import Faults, FeederError
from feederscrew.part import load
from feederscrew.studies.drop import follow

CUBE = {"restitution": "0.125", "friction": "0.18"}
FILMED = "docs/measured/filmed/cube_tosses.csv"


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(40.0, 30.0, 20.0).export(path)
    return load(path)


def written(tmp_path, states, extra=""):
    """A file of launches, one for each (13,) state in the order of STATE."""
    path = tmp_path / "launches.csv"
    lines = [f"toss,{','.join(STATE_COLUMNS)}{extra and ',' + extra}"]
    lines += [
        ",".join([str(k), *map(repr, map(float, state))]) + "," * bool(extra)
        for k, state in enumerate(states)
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


def state(position=(0.0, 0.0, 0.05), turn=None, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0)):
    turn = Rotation.identity() if turn is None else turn
    return [*position, *np.roll(turn.as_quat(), 1), *velocity, *spin]


def test_a_box_that_slides_flat_stops_where_friction_says(box, tmp_path):
    path = written(tmp_path, [state((0.1, -0.2, 0.010001), velocity=(0.6, 0.8, 0.0))])
    told = follow(box, path, {"friction": "0.3", "restitution": "0.1"}, runs=1).result
    way = 1.0**2 / (2.0 * 0.3 * 9.81)
    assert FACE_NAMES[told.faces[0]] == "+z"
    assert told.places[0] == pytest.approx([0.1 + 0.6 * way, -0.2 + 0.8 * way], abs=0.003 * way)
    assert told.times[0] == pytest.approx(1.0 / (0.3 * 9.81), rel=0.05)


@pytest.mark.parametrize(("side", "axis"), [("+x", (0, -90, 0)), ("-y", (-90, 0, 0)), ("-z", (180, 0, 0))])
def test_the_side_set_up_is_the_side_told(box, tmp_path, side, axis):
    turn = Rotation.from_euler("xyz", axis, degrees=True)
    up = turn.inv().apply([0.0, 0.0, 1.0])
    assert np.abs(up).argmax() == "xyz".index(side[1]) and (up.sum() > 0.0) == (side[0] == "+")
    told = follow(box, written(tmp_path, [state(turn=turn)]), CUBE, runs=3).result
    assert FACE_NAMES[told.faces[0]] == side == FACE_NAMES[told.released[0]]
    assert told.shares[0].sum() == pytest.approx(1.0)


def test_turning_the_room_turns_the_answer(box, tmp_path, rng):
    turns, yaw = Rotation.random(6, random_state=5), Rotation.from_rotvec([0.0, 0.0, 0.7])
    ways, spins = rng.normal(size=(6, 3)) * 0.4, rng.normal(size=(6, 3)) * 8.0
    here = [state((0.02, 0.03, 0.06), t, v, w) for t, v, w in zip(turns, ways, spins)]
    there = [
        state(yaw.apply([0.02, 0.03, 0.06]), yaw * t, yaw.apply(v), w) for t, v, w in zip(turns, ways, spins)
    ]
    one, other = (follow(box, written(tmp_path, states), CUBE, runs=1).result for states in (here, there))
    same = one.faces == other.faces  # a drop is chaotic: a last digit may decide one of them
    assert same.sum() >= 5
    flat = yaw.apply(np.column_stack([one.places, np.zeros(6)]))[:, :2]
    near = np.hypot(*(flat - other.places).T)[same]
    assert np.median(near) < 1e-3


def test_filmed_tosses_of_a_cube_end_as_they_did(tmp_path):
    """A quarter of them with few runs; docs/validation.md has all."""
    lines = (Path(__file__).parents[2] / FILMED).read_text().splitlines()
    (tmp_path / "some.csv").write_text("\n".join(lines[:2] + lines[2::4]) + "\n")
    shapes.box(104.8, 104.8, 104.8).export(tmp_path / "cube.stl")
    study = follow(load(tmp_path / "cube.stl"), tmp_path / "some.csv", CUBE, runs=9)
    found = study.agreement
    assert found.tosses == 72 and found.right_share > 0.72 and found.at_release < 0.5
    assert found.median_off < 0.045
    assert found.expected - found.right_share < 0.06, "p must not promise far more than it keeps"
    assert found.right_share - found.expected < 0.06, "nor far less"


def test_more_is_uncertain_where_more_is_unknown(tmp_path):
    shapes.box(104.8, 104.8, 104.8).export(tmp_path / "cube.stl")
    cube = load(tmp_path / "cube.stl")
    turn = Rotation.from_euler("xyz", [30, 20, 10], degrees=True)
    start = [state((0.0, 0.0, 0.25), turn, (1.0, 0.2, 0.1), (3.0, -4.0, 2.0))]
    sharp = follow(cube, written(tmp_path, start), CUBE).result
    blurred = follow(cube, written(tmp_path, start, "frames_30Hz"), CUBE).result
    assert sharp.spreads[0] > 0.0 and blurred.spreads[0] > sharp.spreads[0]


def test_jobs_do_not_change_the_answer(box, tmp_path):
    path = written(tmp_path, [state(spin=(9.0, k, 3.0), velocity=(0.5, 0.0, 0.0)) for k in range(6)])
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


HEAD = f"toss,{','.join(STATE_COLUMNS)}"
WHOLE = ",".join(["0", *map(str, state())])
FAULTS = [
    ("", "has no launch - give the columns toss,"),
    (HEAD + "\n", "has no launch - give the columns toss,"),
    (
        f"toss,{','.join(STATE_COLUMNS[:-1])}\n{WHOLE}\n",
        ":1: there is no column wz0 - give the columns toss,",
    ),
    (f"{HEAD},x0_m\n{WHOLE},1\n", ":1: column x0_m is given twice - keep one of them"),
    (HEAD + "\n" + WHOLE.replace("0.05", "high") + "\n", "z0_m: 'high' is not a number"),
    (HEAD + "\n" + WHOLE.replace("0.05", "1_0") + "\n", "z0_m: '1_0' is not a number"),
    (HEAD + "\n" + WHOLE.replace("0.05", "\u0663") + "\n", "z0_m: '\u0663' is not a number"),
    (HEAD + "\n" + WHOLE.replace("1.0", "0.5", 1) + "\n", "the quaternion has the length 0.5"),
    (HEAD + "\n" + WHOLE.replace("0.05", "5e4") + "\n", "z0_m is 5e4 - give m, from -1000 to"),
    (f"{HEAD},face_up_end\n{WHOLE},top\n", "face_up_end: 'top' is not a side of the part"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line"), FAULTS)
def test_each_fault_of_a_file_is_a_line(tmp_path, text, line):
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises((FeederError, Faults)) as caught:
        toss_runs.read_launches(tmp_path / "bad.csv")
    assert line in str(caught.value) and "\n" not in str(caught.value)


def test_a_launch_below_the_plane_is_refused(box, tmp_path):
    path = written(tmp_path, [state(), state((0.0, 0.0, 0.004))])
    with pytest.raises(FeederError) as caught:
        follow(box, path, CUBE, runs=1)
    said = f"{path}:3: the launch begins 6 mm below the plane - give x0_m, y0_m, z0_m of the centre of mass"
    assert str(caught.value).startswith(said)
