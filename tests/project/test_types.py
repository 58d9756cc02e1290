"""A user's program is checked against the installed library: a correct one passes, a wrong one does not."""

import inspect
import re
import subprocess
import sys

import feederscrew as fs

PROGRAM = """
import io
from dataclasses import replace
from pathlib import Path

import numpy as np

import feederscrew as fs
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.record import BowlGrid

part: fs.Part = fs.load("p.stl", units="mm", density="abs", centre_of_mass=(0.0, 0.0, 1.0), allow_open=True)
piped = fs.load("-", density=7850, names=Path("names.yaml"), stdin=io.BytesIO())
bowl: fs.Bowl = fs.read_bowl("b.yaml", {"drive.frequency": "50 Hz", "machine.leaves": 4}, amplitude="0.3 mm")
plain = fs.read_bowl(overrides=["drive.frequency=50 Hz"])

resting = fs.aspects(part, unstable=True, surface="hard", launch="feed", drops=200)
found: fs.Aspects = fs.find_aspects(part)
names: tuple[str, ...] = found.names
standing: fs.Posture = fs.posture(part, found, names[0])
fs.write_names(part, found, Path("names.yaml"))
one: fs.Aspect = resting["A"]
print(fs.inertia(part).to_frame(), resting.plot("aspects"), part)
fs.compare(part, "counts.csv", launch="drop")
fs.calibrate(part, Path("counts.csv"))
fs.drop(part, launch="drop", drops=2000, seed=2, jobs=2, traced=3, fall=("20 mm", 0.05), friction="0.3")
fs.shake(part, [bowl, plain], seconds=1.0, restitution=0.2)

amplitude: float = bowl.drive.amplitude
grid: BowlGrid = bowl
many = replace(grid, drive=replace(grid.drive, amplitude=np.linspace(1e-4, 3e-4, 5)))
velocity: float = fs.convey(bowl.with_values({"track.climb": "2 deg"}, amplitude="0.3 mm")).answer.velocity
answer: fs.Answer = fs.convey(bowl.with_values(amplitude=0.3e-3)).answer
fs.slide(bowl, ["20 deg", 0.5])
fs.floor(part, bowl, "A", heading="90 deg")
fs.track(part, bowl, "A", heading=0.5)
fs.headings(part, bowl)

known: fs.Shares = fs.shares(part, bowl, launch="feed", fed=200, seed=2)
devices: tuple[Device, ...] = bowl.devices
rate: fs.Rate = fs.rate(part, bowl, "A", devices=devices, gap="2 mm", aspect_shares=known).rate
fs.tune(part, bowl, "A", "15/min", worst=True, rule="csa")
fs.size_bowl(part, 1.0, "A", bowl=bowl)
searched = fs.ToolingSearch(seconds="2 min", vary=False)
fs.tooling(part, bowl, "A", margin="0.1 mm", purity=0.98, without=["wiper"], search=searched)
fs.trial(part, bowl, "A", parts=40, queue=60, seconds=20, progress=print)
fs.trial(part, bowl, queue=fs.TrialQueue("high", wanted="A@188", up=["A"]), seconds="1 min")
study = fs.design(part, "60/min", bowl, up="B,C", diameter=("200 mm", 0.4), search=fs.DesignSearch(draws=10))
designed: fs.Bowl | None = study.bowl
family = fs.design([part, part], target=1.0, jobs=2)
worst: tuple[float, float, float] = family.members[0].delivered
advised: str | None = fs.advise(part, bowl, with_trials=False, seconds="1 min").grade
fs.report(part, "A", target="60/min", bowl=bowl, gap="2 mm")
frame = fs.sweep(fs.convey, bowl, frequency=["40 Hz", 50.0], amplitude=["0.1 mm"], jobs=2)
fs.reproduce().to_frame("3-9")
print(study.status, repr(answer), standing.height, rate.parts.low)
try:
    fs.load("open.stl")
except (fs.MeshError, fs.ConfigError, fs.Faults, fs.FeederError) as fault:
    print(fault.lines)
"""
WRONG = """
bowl.with_values(amplitud="0.3 mm")
fs.convey(part)
fs.rate(part, bowl, "A", gap=[2])
fs.tooling(part, bowl, purity="much")
wrong: int = fs.design(part, "60/min")
replace(bowl.drive, amplitude=np.linspace(1e-4, 3e-4, 5))
fs.convey(many)
"""


def test_a_program_that_calls_everything_type_checks(tmp_path):
    """It did not: `fs.design` was missing, and an editable install had no path to follow."""
    (tmp_path / "user.py").write_text(PROGRAM + WRONG)
    call = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", "cache", "user.py"]
    done = subprocess.run(call, capture_output=True, text=True, cwd=tmp_path)
    first = PROGRAM.count("\n") + 1  # of the wrong lines
    errors = [int(line) for line in re.findall(r"^user\.py:(\d+): error", done.stdout, re.MULTILINE)]
    wanted = [first + k for k in range(1, 1 + WRONG.strip().count("\n") + 1)]
    assert errors == wanted, done.stdout + done.stderr


def test_the_program_calls_every_public_function():
    functions = {name for name in fs.__all__ if inspect.isfunction(getattr(fs, name))}
    assert {name for name in functions if f"fs.{name}(" not in PROGRAM} == set()
    assert {name for name in fs.__all__ if f"fs.{name}" not in PROGRAM} == set()
