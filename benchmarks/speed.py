"""Speed of exact tumbling and of the drop test, beside SciPy's hull and trimesh's poses.

Run: python benchmarks/speed.py

Everything is timed in one run on one machine: take the ratios.
"""

import sys
import time
from pathlib import Path

import numpy as np
import trimesh
import waits
from scipy.spatial import ConvexHull

from feederscrew.arrivals import ensemble
from feederscrew.arrivals.kernel import falling, one_drop
from feederscrew.arrivals.launch_conditions import Launch, sample
from feederscrew.arrivals.rounded_hull import shape_of_part
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find, require_ground
from feederscrew.resting.exact_tumbling import tumble

sys.path.insert(0, str(Path(__file__).parent.parent / "tests/support"))
import shapes

THROW = Launch("benchmark", (2.0, 2.0), (3.0, 3.0), (3.0, 3.0), (0.3, 0.3), (0.3, 0.3))
RINGS = ((4.5, 0.0), (4.5, 3.0), (2.5, 17.5), (2.25, 18.0))  # [mm] radius and height: a screw's hull
TARGETS = {"T shape, 12 corners": 10_000, "screw, 1,000 corners": 5_400}  # drops a second, at converged steps
JOBS = 1.8  # times as fast, with two


def seconds(job, *arguments, repeats=5):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        job(*arguments)
        times.append(time.process_time() - start)
    return min(times)


def ellipsoid(count):
    """Points on an ellipsoid, all of them corners of the hull."""
    points = np.random.default_rng(0).normal(size=(count, 3))
    return points * (1.0, 0.9, 0.8) / np.linalg.norm(points, axis=1, keepdims=True)


def tumbling():
    points, centre = ellipsoid(50000), np.zeros(3)
    tumble(convex_hull(points[:100], centre))
    hull = seconds(ConvexHull, points)
    ours = seconds(lambda: tumble(convex_hull(points, centre)))
    print(f"quasi-static with its hull, 10^5 facets: {ours / hull:.2f} x the SciPy hull alone ({hull:.2f} s)")
    points = ellipsoid(5000)
    mesh = trimesh.Trimesh(*hull_mesh(points), process=False)
    peer = seconds(lambda: trimesh.poses.compute_stable_poses(mesh, threshold=0.0), repeats=1)
    ours = seconds(lambda: tumble(convex_hull(points, centre)))
    print(f"quasi-static with its hull, 10^4 facets: {peer / ours:.0f} x as fast as trimesh's stable poses")


def hull_mesh(points):
    hull = convex_hull(points, np.zeros(3))
    return hull.vertices, hull.triangles


def bodies():
    turn = 2 * np.pi * np.arange(250) / 250
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(250, z)]) for r, z in RINGS]
    meshes = {
        "T shape, 12 corners": shapes.prism(shapes.T_OUTLINE, 15.0),
        "screw, 1,000 corners": trimesh.convex.convex_hull(np.concatenate(rings)),
    }
    for name, mesh in meshes.items():
        part = shapes.part(mesh)
        yield name, shape_of_part(part, require_ground(part, find(part)))[0]


def rates(shape, count):
    starts = sample(THROW, shape, count, np.random.default_rng(1))
    faces, times, work = np.empty(count, int), np.empty(count), falling.scratch(shape)
    given = shape, work, starts.launched(), falling.Steps(), faces, times
    return count / seconds(one_drop.settle_all, *given, repeats=2), faces


def jobs(shape):
    took = []
    for cores in (1, 2):
        start = time.perf_counter()
        ensemble.drop(shape, THROW, np.random.default_rng(1), count=40000, jobs=cores)
        took.append(time.perf_counter() - start)
    gain = took[0] / took[1]
    print(f"two jobs: {gain:.2f} x one by the clock, target {JOBS}: {waits.verdict(gain >= JOBS)}")


def main():
    tumbling()
    for name, shape in bodies():
        rate, _ = rates(shape, 4000)
        wanted = TARGETS.get(name, 0)
        told = f", target {wanted:,}: {waits.verdict(rate >= wanted)}" if wanted else ""
        print(f"{name}: {rate:,.0f} drops a second and core{told}")
        if "T shape" in name:
            jobs(shape)
    print(waits.busy())


if __name__ == "__main__":
    main()
