"""Speed of the conveying kernel: compiled, plain Python and SciPy's general solver, same random settings.

Run: python benchmarks/conveying.py [--points N]

Times are of this process's own processor time, one core. The targets are for a machine on which plain
Python manages 1,600 points a second without rebound and 300 with it; they scale with what it manages here.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests/support"))
import waits
from conveying_reference import Reference, random_settings

from feederscrew.motion import conveying as answer
from feederscrew.motion import limits, steady
from feederscrew.motion.operating_point import OperatingPoint, plain

TARGETS = {0.0: (60_000, 1_600), 0.3: (12_000, 300)}  # points a second: compiled, plain Python
SPEED_UP = 15.0
PERIODS = 100  # the general solver follows, where it cannot know that the motion has settled


def seconds(function):
    start = time.process_time()
    found = function()
    return time.process_time() - start, found


def plain_python(settings):
    out = np.empty((len(settings), steady.COLUMNS))
    for row, setting in zip(out, settings):
        steady.survey(OperatingPoint(*setting.tolist()), row)
    return out


def general(box, restitution):
    return [Reference(*row, row[3], restitution).velocity(PERIODS, 1) for row in box]


def race(restitution, count):
    box = random_settings(count, np.random.default_rng(1))
    settings = np.array([plain(*row, restitution) for row in box])
    few, fewer = max(20, count // 500), 5
    compiled, out = seconds(lambda: answer.sweep(settings, workers=1))
    python, same = seconds(lambda: plain_python(settings[:few]))
    scipy, _ = seconds(lambda: general(box[:fewer], restitution))
    rates = count / compiled, few / python, fewer / scipy
    wanted, reference = TARGETS[restitution]
    scaled = wanted * rates[1] / reference
    settled = out[:few, steady.STATUS] == steady.PERIODIC  # a motion without period grows every rounding
    worst = np.abs(out[:few, steady.VELOCITY] - same[:, steady.VELOCITY])[settled].max()
    print(f"\nrestitution {restitution:g}, {count} points, every start")
    print(f"  compiled      {rates[0]:10,.0f} points/s   target {wanted:,}, scaled to here {scaled:,.0f}")
    print(f"  plain Python  {rates[1]:10,.0f} points/s   compiled is {rates[0] / rates[1]:.1f} times as fast")
    print(
        f"  solve_ivp     {rates[2]:10,.1f} points/s   compiled is {rates[0] / rates[2]:,.0f} times as fast"
    )
    for code, name in enumerate(steady.STATUSES):
        print(f"  {name:<16}{np.mean(out[:, steady.STATUS] == code):8.2%}")
    print(f"  largest difference from plain Python, where periodic: {worst:.1e} of A w")
    held = rates[0] >= min(wanted, scaled) and rates[0] >= SPEED_UP * rates[1]
    print(f"  {waits.verdict(held)}: the target, and {SPEED_UP:g} times as fast as plain Python")
    return held


def thresholds():
    angle, ratio = np.radians(np.linspace(5, 60, 1000))[:, None], np.linspace(0.1, 6, 1000)[None, :]
    took, _ = seconds(lambda: limits.regimes(ratio, angle, 0.4, climb=0.05))
    print(f"\n10^6-point map of thresholds: {took:.2f} s (target: under 1 s): {waits.verdict(took < 1.0)}")
    return took < 1.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=100_000)
    count = parser.parse_args().points
    waited, _ = seconds(lambda: answer.sweep(np.array([plain(1.0, 0.5, 0.0, 0.4)])))
    print(f"compiling, or loading what was compiled before: {waited:.1f} s")
    held = [race(0.0, count), race(0.3, count), thresholds()]
    print("\nall targets hold" if all(held) else "\nsome targets are missed", f"({waits.busy()})")


if __name__ == "__main__":
    main()
