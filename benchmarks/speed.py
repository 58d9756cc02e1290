"""Speed of exact tumbling and of the drop test, beside SciPy's hull, trimesh's poses and MuJoCo.

Example: python benchmarks/speed.py --mujoco 1000

Everything is timed in one run on one machine: take the ratios. MuJoCo is asked only if it is installed
(`pip install mujoco`); it gets explicit contact stiffness and damping for restitution 0.3, the elliptic
friction cone, a time step of 0.002 sqrt(L / g), and the same energy stop as the kernel.
"""

import argparse
import importlib.util
import sys
import time
from pathlib import Path

import numpy as np
import trimesh
from scipy.spatial import ConvexHull
from scipy.stats import chi2_contingency

from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.drop import body, ensemble, kernel
from feederscrew.resting.drop.launch import Launch, sample
from feederscrew.resting.drop.shape import shape_of_part
from feederscrew.resting.tumbling import tumble
from feederscrew.resting.tumbling_aspects import ground

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
import shapes

T_OUTLINE = [(-5.5, 0), (5.5, 0), (5.5, 12), (12.5, 12), (12.5, 25), (-12.5, 25), (-12.5, 12), (-5.5, 12)]
THROW = Launch("benchmark", (2.0, 2.0), (3.0, 3.0), (3.0, 3.0), (0.3, 0.3), (0.3, 0.3))
RINGS = ((4.5, 0.0), (4.5, 3.0), (2.5, 17.5), (2.25, 18.0))  # [mm] radius and height: a screw's hull
STEP = 0.002  # of MuJoCo, without dimensions
DAMPING = -np.log(0.3) / np.hypot(np.pi, np.log(0.3))  # of a contact that returns 0.3 of the speed
STIFFNESS = (np.pi / (20 * STEP)) ** 2 / (1.0 - DAMPING**2)  # contact lasts 20 steps


def seconds(job, *arguments, repeats=5):
    """Shortest processor time of a few runs."""
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
    """Print the cost of exact tumbling beside its hull and its peer."""
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
    """Corners and triangles of a hull."""
    hull = convex_hull(points, np.zeros(3))
    return hull.vertices, hull.triangles


def bodies():
    """Shapes by name."""
    turn = 2 * np.pi * np.arange(250) / 250
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(250, z)]) for r, z in RINGS]
    meshes = {
        "T shape, 12 corners": shapes.prism(T_OUTLINE, 15.0),
        "cuboid, 8 corners": shapes.box(10.0, 13.0, 17.0),
        "screw, 1,000 corners": trimesh.convex.convex_hull(np.concatenate(rings)),
    }
    for name, mesh in meshes.items():
        part = shapes.part(mesh)
        found = ground(part, find(part))
        yield name, shape_of_part(part, found)[0], found.rows


def rates(shape, count):
    """Drops a second and core, and the faces."""
    starts = sample(THROW, shape, count, np.random.default_rng(1))
    faces, times, work = np.empty(count, int), np.empty(count), kernel.scratch(shape)
    given = shape, work, starts.states, starts.restitutions, starts.frictions, kernel.Steps(), faces, times
    return count / seconds(kernel.settle_all, *given, repeats=2), faces


def jobs(shape):
    """Print what a second core gives, by the clock."""
    took = []
    for cores in (1, 2):
        start = time.perf_counter()
        ensemble.drop(shape, THROW, np.random.default_rng(1), count=40000, jobs=cores)
        took.append(time.perf_counter() - start)
    print(f"two jobs: {took[0] / took[1]:.2f} x one")


def world(shape):
    """The body over a plane as a MuJoCo model, without dimensions."""
    corners = " ".join(f"{x:.17g}" for x in shape.vertices.ravel())
    moments = " ".join(f"{x:.17g}" for x in shape.inertia)
    contact = f'solref="{-STIFFNESS} {-2 * DAMPING * np.sqrt(STIFFNESS)}" solimp="0.99 0.99 0.001"'
    return f"""<mujoco><option timestep="{STEP}" gravity="0 0 -1" cone="elliptic" iterations="50"/>
    <asset><mesh name="m" vertex="{corners}"/></asset><worldbody>
    <geom type="plane" size="50 50 1" friction="0.3 0 0" {contact}/>
    <body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{moments}"/>
    <geom type="mesh" mesh="m" friction="0.3 0 0" {contact}/></body></worldbody></mujoco>"""


def mujoco_drop(engine, model, data, shape, state):
    """Face of one drop in MuJoCo; the same stop below the lowest saddle."""
    engine.mj_resetData(model, data)
    data.qpos[:], data.qvel[:3], data.qvel[3:] = state[[0, 1, 2, 6, 7, 8, 9]], state[3:6], state[10:]
    turn, here = np.zeros(9), np.zeros(body.STATE)
    for _ in range(4000):
        engine.mj_step(model, data, 25)
        here[[0, 1, 2, 6, 7, 8, 9]], here[3:6], here[10:] = data.qpos, data.qvel[:3], data.qvel[3:]
        body.rotation(here, turn)
        corner, _ = body.lowest(shape.vertices, shape.links, turn, 0)
        face = kernel.decided(shape, here, turn, corner, 1, 0.3, 0, kernel.Steps())
        if face != kernel.UNSETTLED:
            return face
    return kernel.UNSETTLED


def against_mujoco(name, shape, rows, rate, count):
    """Print the speed beside MuJoCo's, and whether the two agree."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(world(shape))
    data = mujoco.MjData(model)
    states = sample(THROW, shape, count, np.random.default_rng(2)).states
    start = time.process_time()
    theirs = np.array([mujoco_drop(mujoco, model, data, shape, state) for state in states])
    slow = count / (time.process_time() - start)
    ours = rates(shape, 5000)[1]
    table = np.array([ensemble.counted(faces, rows, rows.max() + 1) for faces in (ours, theirs)])
    table = table[:, table.sum(axis=0) > 0]
    p = chi2_contingency(table).pvalue
    print(f"{name}: {rate / slow:.0f} x MuJoCo ({slow:.0f} drops/s/core); same profile with p = {p:.3g}")
    for label, counts in zip(("  kernel", "  MuJoCo"), table):
        print(label, np.round(100.0 * counts / counts.sum(), 1))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mujoco", type=int, default=500, help="drops of each body in MuJoCo")
    chosen = parser.parse_args()
    tumbling()
    installed = importlib.util.find_spec("mujoco") is not None
    for name, shape, rows in bodies():
        rate, _ = rates(shape, 4000)
        print(f"{name}: {rate:,.0f} drops a second and core")
        if installed and "screw" not in name:
            against_mujoco(name, shape, rows, rate, chosen.mujoco)
        if "T shape" in name:
            jobs(shape)
