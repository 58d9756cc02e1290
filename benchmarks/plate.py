"""Parts on a vibrating plate: a flat one beside the exact motion of a point, the T shape at three sizes.

Example: python benchmarks/plate.py --parts 200

60 Hz, 20 deg, friction 0.4. Printed is the error of the velocity of a flat plate, of the drive's greatest
speed, and how many T shapes lie on their deepest aspect when they have come down and after 4 s more.
"""

import argparse
import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.dropping.plate import bowl_test
from feederscrew.resting.aspects import find

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
import shapes

TWO, FOUR = (replace(bowl_test.EXACT, seconds=seconds) for seconds in (2.0, 4.0))
ANGLE = math.radians(20.0)
NOTHING = dict.fromkeys(("fall", "spin", "speed", "restitution", "friction"))


def plate(ratio, restitution):
    """A bowl whose floor has a peak acceleration of ``ratio`` g along its normal."""
    stroke = ratio * 9.81 / (2.0 * math.pi * 60.0) ** 2 / math.sin(ANGLE)
    own = (
        f"drive.amplitude={1e3 * stroke} mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg",
        "track.climb=0 deg", "friction.static=0.4", f"restitution={restitution}",
    )  # fmt: skip
    return bowls.record(bowls.settings(None, own))


def flat():
    """Print the velocity of a flat plate beside the exact one."""
    part = shapes.part(shapes.box(30.0, 30.0, 6.0))
    print("peak acceleration [g], restitution: velocity, exact [mm/s], difference [% of the drive's speed]")
    for restitution in (0.0, 0.3):
        bowl_list = [plate(ratio, restitution) for ratio in (0.5, 0.9, 1.2, 1.5, 2.0, 2.5)]
        own = NOTHING | {"fall": "0 mm"}
        for bowl, seen in zip(
            bowl_list, bowl_test.test(part, find(part), bowl_list, "place", own, drops=20, pace=TWO)
        ):
            deepest = np.argmin(find(part).heights)
            ours, exact = seen.occupancy.velocities[deepest, 0], answer.answer(bowl).velocity
            quickest = 2.0 * math.pi * 60.0 * bowl.drive.amplitude * math.cos(ANGLE)
            away = 100.0 * (ours - exact) / quickest
            shown = f"{seen.throw_number:6.1f} {restitution:4.1f} {1e3 * ours:8.2f} {1e3 * exact:8.2f}"
            print(f"{shown} {away:6.1f}")


def t_shapes(parts):
    """Print how T shapes shift to their deepest aspect."""
    print("\nT shape, thickness 0.6 of the width: share on the deepest aspect, at first and after 4 s;")
    print("transitions seen; seconds of processor time a part")
    for width in (5.0, 10.0, 25.0):
        outline = [(x * width / 25.0, y * width / 25.0) for x, y in shapes.T_OUTLINE]
        part = shapes.part(shapes.prism(outline, 0.6 * width))
        aspects = find(part)
        deepest = np.argmin(aspects.heights)
        for ratio in (1.5, 2.0, 2.5):
            start = time.process_time()
            (seen,) = bowl_test.test(
                part, aspects, [plate(ratio, 0.3)], "drop", NOTHING, drops=parts, pace=FOUR
            )
            took = (time.process_time() - start) / parts
            course = seen.occupancy.course[:, deepest]
            print(
                f"{width:5.0f} mm {ratio:4.1f} g: {100 * seen.occupancy.start[deepest]:5.1f} % -> "
                f"{100 * course[-1]:5.1f} %, {seen.occupancy.counts.sum()} transitions, {took:.3f} s"
            )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--parts", type=int, default=200)
    chosen = parser.parse_args()
    flat()
    t_shapes(chosen.parts)
