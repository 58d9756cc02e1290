"""The bowl's gravity rules everything that a command says of a bowl: what is scaled with it scales.

Dimensional analysis (E. Buckingham, Physical Review 4, 1914): lengths, angles, masses, friction and
restitution the same, gravity four times as large and frequencies twice: every velocity is twice as large,
every acceleration and force four times, every time half. Powers of two are exact in binary numbers, so that
motions that chance decides are the same as well.
"""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
from scipy.optimize import brentq

import feederscrew as fs
from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.tooling import verdicts
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.devices.pneumatics import thrust
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.verdicts import verdict

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


def pressure_of(force, nozzle=2e-3):
    """The pressure [Pa] at which a nozzle pushes with some force [N]."""
    return brentq(lambda pressure: thrust(nozzle, pressure) - force, 0.0, 1e8, xtol=1e-9, rtol=1e-15)


PUSH = thrust(2e-3, 2e4)


def texts():
    """The bowl, and the same where everything is scaled."""
    one = {"frequency": 50, "gravity": 9.75, "pressure": 2e4}
    other = {"frequency": 100, "gravity": 39, "pressure": pressure_of(TIMES * PUSH)}
    return BOWL.format(**one), BOWL.format(**other)


def compared(one, other, key="", path=""):
    """Compare what is a number in two documents, and return how many were compared by the power."""
    assert type(one) is type(other), path
    if isinstance(one, dict):
        one, other = (
            {each.get("unit") if k == "value" else k: v for k, v in each.items()} for each in (one, other)
        )
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
    found = "Hz" if key == "Hz" else ENDS.search(key)
    power = 0.5 if found == "Hz" else POWERS[found[0]] if found else 0.0
    assert other == pytest.approx(TIMES**power * one, rel=1e-6, abs=1e-12), f"{path}: {one} and {other}"
    return [power] if one else []


COMMANDS = {
    "slide": ["slide"],
    "convey": ["convey"],
    "floor": ["floor", "box.stl"],
    "track": ["track", "box.stl"],
    "headings": ["headings", "box.stl"],
    "rate": ["rate", "box.stl", "--aspect", "A", "--rule", "quasistatic"],
    "tooling": "tooling box.stl --aspect A --rule quasistatic --static --without sorter".split(),
    "bowl": ["bowl", "box.stl", "--rule", "quasistatic"],
    "drop": ["drop", "box.stl", "--plate", "--drops", "4"],
}


@pytest.mark.parametrize("name", COMMANDS)
def test_what_a_command_says_scales_with_gravity(run, name):
    shapes.box(20, 12, 5).export("box.stl")
    documents = []
    for k, text in enumerate(texts()):
        Path(f"{k}.yaml").write_text(text)
        own = {
            "drop": ["--seconds", (0.2, 0.1)[k]],
            "bowl": ["--target", f"{(20, 40)[k]}/min"],
        }.get(name, [])
        done = run(*COMMANDS[name], *own, "--config", f"{k}.yaml", "--format", "json", "--quiet")
        assert done.exit_code == 0, done.output
        answer = json.loads(done.stdout)
        documents.append({key: answer[key] for key in MOTION} if name == "bowl" else answer)
    assert compared(*documents)


def test_a_trial_scales_with_gravity(tmp_path):
    part, runs = shapes.part(shapes.box(20, 12, 5)), []
    for k, text in enumerate(texts()):
        (tmp_path / f"{k}.yaml").write_text(text)
        (one,) = fs.trial(part, bowls.read(tmp_path / f"{k}.yaml"), parts=6, rule="quasistatic").runs
        runs.append(one.course)
    one, other = runs
    assert np.array_equal(one.fates, other.fates) and np.array_equal(one.ended, other.ended)
    assert len(set(one.fates)) > 1 and np.isfinite(one.velocities).any()
    assert other.velocities == pytest.approx(2.0 * one.velocities, rel=1e-6, nan_ok=True)


def lying(*settings):
    """A box that travels in a bowl with some settings, in all its orientations."""
    bowl = bowls.read(None, ["track.width=30 mm", *settings])
    part = shapes.part(shapes.box(20, 12, 5))
    return travelling(orientations(part, find(part), bowl.track), bowl)


def device_of(kind, every, path):
    """A device of a kind with the values of its example, that names an orientation of the part."""
    path.write_text(f"devices:\n  - {kind}: {KINDS[kind].example.replace('A@90', every[0].name)}\n")
    return bowls.read(path).devices[0]


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_device_does_scales_with_gravity(kind, tmp_path):
    slow, fast = (
        lying(f"drive.frequency={frequency} Hz", f"gravity={gravity} m/s2")
        for frequency, gravity in ((50, 9.75), (100, 39))
    )
    device = device_of(kind, slow, tmp_path / "b.yaml")
    air = [(0.0, 0.0)]
    if hasattr(device, "pressure"):
        pressures = (1e2, 1e3, 3e3, 1e4, 2e4, 4e4, 1e5)
        air = [(pressure, pressure_of(TIMES * thrust(device.nozzle, pressure))) for pressure in pressures]
    verdicts = []
    for weak, strong in air:
        one = replace(device, pressure=weak) if weak else device
        other = replace(device, pressure=strong) if strong else device
        if hasattr(device, "time"):
            one, other = replace(one, height=4e-3), replace(other, height=4e-3, time=0.5 * device.time)
        verdicts += [(verdict(one, a, slow), verdict(other, b, fast)) for a, b in zip(slow, fast)]
    for one, other in verdicts:
        assert other.passes == one.passes and other.hangs == one.hangs
        assert other.margin == pytest.approx(one.margin, rel=1e-6, abs=1e-12, nan_ok=True)
        assert len(other.onto) == len(one.onto)
        assert np.reshape(other.onto, -1) == pytest.approx(np.reshape(one.onto, -1))
    if len(air) > 1:
        assert len({one.passes for one, _ in verdicts}) > 1  # of weak air and strong


@pytest.mark.parametrize("kind", ["jet", "sorter"])
def test_air_that_just_fails_on_earth_blows_off_on_the_moon(kind, tmp_path):
    """A sixth of the weight: friction and the weight over the foot hold a sixth of the force back."""
    earth, moon = (
        lying("gravity=9.81 m/s2"),
        lying("gravity=1.62 m/s2", f"drive.frequency={50 * 0.4064:g} Hz"),
    )
    device = device_of(kind, earth, tmp_path / "b.yaml")
    passing = {}
    for name, every in (("earth", earth), ("moon", moon)):
        weakest = [
            min(
                (
                    pressure
                    for pressure in np.geomspace(1e2, 1e5, 40)
                    if verdict(replace(device, pressure=pressure), one, every).passes == 0.0
                    and verdict(replace(device, pressure=pressure), one, every).margin != 0.0
                ),
                default=math.inf,
            )
            for one in every
        ]
        passing[name] = np.array(weakest)
    changed = np.isfinite(passing["earth"])
    assert changed.any() and (passing["moon"][changed] < passing["earth"][changed]).all()


@pytest.mark.parametrize("gravity", [9.81, 1.62])
def test_the_force_to_clear_is_that_of_the_bowls_gravity(gravity):
    """On a track at rest: friction times weight, or weight times foot over height, whichever is less."""
    for one in lying(f"gravity={gravity} m/s2"):
        still, height = replace(one, swing=0.0), 4e-3
        weight = one.posture.mass * gravity
        least = min(one.grip * weight, weight * one.foot_reach / height)
        assert verdicts.force_to_clear(still, 1.0, height) == pytest.approx(least, rel=1e-6)
