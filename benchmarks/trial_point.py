"""Velocity and headings in trials beside the exact answers: `feeder convey` and `feeder headings`.

Example: python benchmarks/trial_point.py

A flat block that slides, and that hops without rebound at throw numbers of 1.1 to 2; and a block and a key
that are laid down at random headings off the wall of a banked track, and travel until they lie against it.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.dropping.ensemble import wilson
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import course, looks, runs, shape, stations, whereabouts

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
import shapes

OWN = ("drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "friction.static=0.4", "track.width=60 mm",
       "track.climb=2 deg", "restitution=0", "track.radius=2 m")  # fmt: skip
BLOCK = shapes.part(shapes.box(20, 12, 5))
KEY = load(str(Path(__file__).parent.parent / "parts" / "key_a_d12x20.stl"))
AMPLITUDES = (0.15, 0.22, 0.26, 0.32, 0.35, 0.40)  # [mm] throw numbers of 0.74 to 1.98
TRIED, WAY, OFF = 60, 0.15, 0.012  # parts, [m] that they travel, [m] off the wall


def velocity(amplitude):
    """Throw number, mean velocity of four blocks lying flat, and that of the point mass [mm/s]."""
    bowl = bowls.read(None, (*OWN, f"drive.amplitude={amplitude} mm", "track.bank=0 deg"))
    every = orientations(BLOCK, find(BLOCK), bowl.track)
    flat = [k for k, one in enumerate(every) if one.height < 6e-3]
    seen = course.course(BLOCK, bowl, every, course.Sending(flat[:1] * 4, 4), ())
    found = float(np.nanmean(seen.velocities))
    return answer.throw_number(bowl), 1e3 * found, 1e3 * answer.answer(bowl).velocity


def headings(part):
    """How many parts come to lie at each heading, beside the share that `feeder headings` gives it."""
    bowl = bowls.read(None, (*OWN, "drive.amplitude=0.2 mm", "track.bank=8 deg", "friction.wall=0.2"))
    every = orientations(part, find(part), bowl.track)
    flat = [one for one in every if one.aspect == every[0].aspect]
    solid, length, principal = shape.solid_of(part)
    known, stage = runs.setting(solid, length, bowl), stations.plain(bowl.track, every, WAY)
    turns = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, TRIED)
    laid = [replace(flat[0], heading=turn, distance=OFF) for turn in turns]
    states = np.array([whereabouts.laid(one, principal, length, bowl.track, place=0.0) for one in laid])
    limits = course._limits(bowl, stage, every)
    ride = runs.ride(runs.past(known, stage, **limits), states, np.zeros(TRIED), jobs=2)
    seen = looks.Looks(every, solid, length, principal, bowl.track.radius).of(ride.states)
    for one in flat:
        count = int((seen == every.index(one)).sum())
        low, high = (float(end[0]) for end in wilson([count], TRIED))
        said = one.heading_share
        inside = "inside" if low <= said <= high else "OUTSIDE"
        print(f"  {one.name}: {count} of {TRIED} ({low:.3f} to {high:.3f}), said {said:.3f} {inside}")
    print(f"  none of them: {int((seen < 0).sum())}")


def main():
    for amplitude in AMPLITUDES:
        throw, found, exact = velocity(amplitude)
        off, within = 100.0 * (found / exact - 1.0), 5.0 if throw > 1.0 else 2.0
        told = "hops" if throw > 1.0 else "slides"
        print(
            f"{told} at a throw number of {throw:.2f}: {found:.3f} mm/s, exact {exact:.3f}, {off:+.2f} % "
            f"(asked {within:g} %): {'met' if abs(off) <= within else 'MISSED'}"
        )
    for part in (BLOCK, KEY):
        print(part.name)
        headings(part)


if __name__ == "__main__":
    main()
