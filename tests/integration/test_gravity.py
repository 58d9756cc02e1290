"""The bowl's gravity rules everything that a command says of a bowl: what is scaled with it scales.

Dimensional analysis (E. Buckingham, Physical Review 4, 1914): lengths, angles, masses, friction and
restitution the same, gravity four times as large and frequencies twice: every velocity is twice as large,
every acceleration and force four times, every time half. Powers of two are exact in binary numbers, so that
motions that chance decides are the same as well.
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.optimize import brentq

import feederscrew as fs
from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.pneumatics import thrust
from feederscrew.resting.aspects import find
from feederscrew.sorting import verdicts
from feederscrew.sorting.orientations import add_travel, orientations
from feederscrew.sorting.verdicts import verdict

BOWL = """\
drive: {{amplitude: 0.21 mm, frequency: {frequency} Hz, vibration_angle: 25 deg}}
gravity: {gravity} m/s2
track: {{width: 30 mm}}
devices:
  - wiper: 15 mm
  - gap: 3 mm
  - jet: {{nozzle: 2 mm, pressure: {pressure:.17g} Pa, height: 8 mm}}
"""
TIMES = 4.0  # gravity and air forces
POWERS = {  # ends of the keys of a document: power of gravity with which it scales
    "m_s": 0.5, "rad_s": 0.5, "per_minute": 0.5, "per_hour": 0.5, "per_s": 0.5, "rad_s2": 1.0, "m_s2": 1.0,
    "_N": 1.0, "_N_mm": 1.0, "_Hz": 0.5, "seconds": -0.5, "_s": -0.5,
}  # fmt: skip
ENDS = re.compile(rf"(?:{'|'.join(sorted(POWERS, key=len, reverse=True))})(?=(?:_low|_high|_less|_more)?$)")
FIXED = ("bowl", "part", "margins_by_drive", "volume")  # the inputs
MOTION = (  # of the bowl's sheet: its springs are of steel, which does not scale
    "parts_per_minute", "peak_to_peak_mm", "acceleration_ratio", "throw_number",
    "vibration_angle_deg", "velocity_mm_s", "regime", "hardest_impact_mm_s",
)  # fmt: skip
PART = shapes.part(shapes.box(20, 12, 5))


def pressure_of(force, nozzle=2e-3):
    """The pressure [Pa] at which a nozzle pushes with some force [N]."""
    return brentq(lambda pressure: thrust(nozzle, pressure) - force, 0.0, 1e8, xtol=1e-9, rtol=1e-15)


@pytest.fixture
def files(tmp_path):
    """The bowl, and the same where everything is scaled."""
    scaled, paths = pressure_of(TIMES * thrust(2e-3, 2e4)), [tmp_path / "one.yaml", tmp_path / "scaled.yaml"]
    for path, *values in zip(paths, (50, 100), (9.75, 39), (2e4, scaled)):
        path.write_text(BOWL.format(**dict(zip(("frequency", "gravity", "pressure"), values))))
    return paths


def compared(one, other, key="", path=""):
    """Compare what is a number in two documents, and return how many were compared by the power."""
    assert type(one) is type(other), path
    if isinstance(one, dict):
        one, other = ({d.get("unit") if k == "value" else k: v for k, v in d.items()} for d in (one, other))
        assert one.keys() == other.keys(), path
        inner = [(name, one[name], other[name]) for name in one if name not in FIXED]
        return [k for name, a, b in inner for k in compared(a, b, name, f"{path}.{name}")]
    if isinstance(one, list):
        assert len(one) == len(other), path
        return [k for a, b in zip(one, other) for k in compared(a, b, key, path)]
    if isinstance(one, bool) or not isinstance(one, int | float):
        if not isinstance(one, str) or not re.search(r"\d", one):  # units stand in a sentence
            assert one == other, path
        return []
    end = ENDS.search(key)
    power = 0.5 if key == "Hz" else POWERS[end[0]] if end else 0.0
    assert other == pytest.approx(TIMES**power * one, rel=1e-6, abs=1e-12), f"{path}: {one} and {other}"
    return [power] if one else []


COMMANDS = (  # what is two numbers is scaled as well
    "slide",
    "convey",
    "floor box.stl",
    "track box.stl",
    "headings box.stl",
    "rate box.stl --aspect A --rule quasistatic",
    "tooling box.stl --aspect A --rule quasistatic --static --without sorter",
    "bowl box.stl --rule quasistatic --target 20/min|40/min",
    "drop box.stl --plate --drops 4 --seconds 0.2|0.1",
)


@pytest.mark.parametrize("call", COMMANDS)
def test_what_a_command_says_scales_with_gravity(run_json, files, call):
    shapes.box(20, 12, 5).export("box.stl")
    documents = []
    for k, path in enumerate(files):
        words = [word.split("|")[k] if "|" in word else word for word in call.split()]
        answer = run_json(*words, "--config", path, "--quiet")
        documents.append({key: answer[key] for key in MOTION} if words[0] == "bowl" else answer)
    assert compared(*documents)


def test_a_trial_scales_with_gravity(files):
    trials = (fs.trial(PART, bowls.read(path), parts=6, rule="quasistatic") for path in files)
    one, other = (trial.runs[0].course for trial in trials)
    assert np.array_equal(one.fates, other.fates) and np.array_equal(one.end_stations, other.end_stations)
    assert len(set(one.fates)) > 1 and np.isfinite(one.velocities).any()
    assert other.velocities == pytest.approx(2.0 * one.velocities, rel=1e-6, nan_ok=True)


def lying(*settings):
    """A box that travels in a bowl with some settings, in all its orientations."""
    bowl = bowls.read(None, ["track.width=30 mm", *settings])
    return add_travel(orientations(PART, find(PART), bowl.track), bowl)


def device_of(kind, states):
    """A device of a kind with the values of its example, that names an orientation of the part."""
    example = KINDS[kind].trade.example.replace("A@90", states[0].name)
    Path("device.yaml").write_text(f"devices:\n  - {kind}: {example}\n")
    return bowls.read("device.yaml").devices[0]


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_device_does_scales_with_gravity(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    slow = lying("drive.frequency=50 Hz", "gravity=9.75 m/s2")
    fast = lying("drive.frequency=100 Hz", "gravity=39 m/s2")
    device, pairs = device_of(kind, slow), []
    pressures = (1e2, 1e3, 3e3, 1e4, 2e4, 4e4, 1e5) if hasattr(device, "pressure") else (0.0,)
    for pressure in pressures:
        one = other = device
        if pressure:
            strong = pressure_of(TIMES * thrust(device.nozzle, pressure))
            one, other = replace(device, pressure=pressure), replace(device, pressure=strong)
        if hasattr(device, "time"):
            one, other = replace(one, height=4e-3), replace(other, height=4e-3, time=0.5 * device.time)
        pairs += [(verdict(one, a, slow), verdict(other, b, fast)) for a, b in zip(slow, fast)]
    for one, other in pairs:
        assert (other.passes, other.hangs, len(other.onto)) == (one.passes, one.hangs, len(one.onto))
        assert other.margin == pytest.approx(one.margin, rel=1e-6, abs=1e-12, nan_ok=True)
        assert np.reshape(other.onto, -1) == pytest.approx(np.reshape(one.onto, -1))
    if len(pressures) > 1:
        assert len({one.passes for one, _ in pairs}) > 1  # of weak air and strong


@pytest.mark.parametrize("gravity", [9.81, 1.62])
def test_the_force_to_clear_is_that_of_the_bowls_gravity(gravity):
    """On a track at rest: friction times weight, or weight times foot over height, whichever is less."""
    for one in lying(f"gravity={gravity} m/s2"):
        still, height, weight = replace(one, swing=0.0), 4e-3, one.posture.mass * gravity
        least = min(one.grip * weight, weight * (one.foot.corners[:, 1].max() + one.shift) / height)
        assert verdicts.force_to_clear(still, 1.0, height) == pytest.approx(least, rel=1e-6)
