"""Speed of the resting aspects against a bare floor, on meshes of 10^3 to 10^6 facets.

Example: python benchmarks/aspects.py --largest 1e6 --repeats 5

Floor: trimesh.load_mesh + is_watertight + mass_properties + SciPy ConvexHull, what any tool must pay.
Each figure is the median ratio over alternating processes, the second of two runs in each: what a library
imports or loads once is not counted in the time, but is in the memory.
"""

import argparse
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import trimesh
import waits

SIZES = (1e3, 1e4, 1e5, 1e6)
SMALL = {1e3: 2.5, 1e4: 1.3}  # targets of the ratio of times by facets
TARGETS = {"box": 1.3, "screw": 1.3, "sphere": 2.0}  # of more facets
MEMORY = 1.5


def box(facets):
    """A box subdivided to about that many facets."""
    mesh = trimesh.creation.box((10.0, 20.0, 30.0))
    while len(mesh.faces) * 2 < facets:
        mesh = mesh.subdivide()
    return mesh


def sphere(facets):
    """A ball of longitudes and latitudes, every facet on the hull."""
    n = round(np.sqrt(facets / 8)) + 1
    return trimesh.creation.uv_sphere(radius=10.0, count=[n, 2 * n])


def screw(facets):
    """A ribbed shank under a round head: most of the surface lies inside the hull."""
    around = max(12, round(np.sqrt(facets / 20)))
    along = np.linspace(0.0, 15.9, round(facets / 2 / around) - 4)
    z = np.concatenate([[0.0], along, [16.0, 16.0, 20.0, 20.0]])
    ribbed = 2.0 - 0.4 * np.abs(((along / 0.7) % 1.0) - 0.5)
    radius = np.concatenate([[0.0], ribbed, [2.0, 3.5, 3.5, 0.0]])
    return trimesh.creation.revolve(np.column_stack([radius, z]), sections=around)


def floor(path):
    """What any tool must pay: read, check, integrate, hull."""
    from scipy.spatial import ConvexHull

    mesh = trimesh.load_mesh(path)
    assert mesh.is_watertight
    _ = mesh.mass_properties
    return len(ConvexHull(mesh.vertices).simplices)


def ours(path):
    """The whole of `feeder aspects` but printing."""
    import feederscrew.part
    from feederscrew.resting.aspects import find

    return len(find(feederscrew.part.load(path)).names)


JOBS = {"floor": floor, "ours": ours}


def measured(job, path):
    done = subprocess.run(
        [sys.executable, __file__, "--job", job, str(path)], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def run(job, path):
    import pandas
    import scipy.sparse.csgraph
    import scipy.spatial

    assert pandas and scipy
    if job != "floor":
        import numba

        import feederscrew.resting.aspects

        assert numba and feederscrew.resting.aspects
    JOBS[job](path)
    start = time.process_time()
    JOBS[job](path)
    seconds = time.process_time() - start
    print(json.dumps([seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))


def compare(first, second, path, repeats):
    pairs = [(measured(first, path), measured(second, path)) for _ in range(repeats)]
    ratio = [statistics.median(a[k] / b[k] for a, b in pairs) for k in (0, 1)]
    return *ratio, *(statistics.median(pair[k][0] for pair in pairs) for k in (0, 1))


def main(largest, repeats):
    print(f"{'mesh':8} {'facets':>9} {'floor s':>8} {'ours s':>8} {'time':>6} {'memory':>7}  target")
    with tempfile.TemporaryDirectory() as folder:
        for name, make in (("box", box), ("screw", screw), ("sphere", sphere)):
            for size in (s for s in SIZES if s <= largest):
                mesh = make(size)
                path = Path(folder) / f"{name}.stl"
                mesh.export(path)
                time_ratio, memory, a, b = compare("ours", "floor", path, repeats)
                target = SMALL.get(size, TARGETS[name])
                print(
                    f"{name:8} {len(mesh.faces):9,} {b:8.3f} {a:8.3f} {time_ratio:6.2f} {memory:7.2f}"
                    f"  time {target} {waits.verdict(time_ratio <= target)}"
                    f", memory {MEMORY} {waits.verdict(memory <= MEMORY)}",
                    flush=True,
                )
    print(waits.busy())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--largest", type=float, default=1e5, help="facets of the largest mesh")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--job", choices=JOBS, help=argparse.SUPPRESS)
    parser.add_argument("path", nargs="?", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.job:
        run(given.job, given.path)
    else:
        main(given.largest, given.repeats)
