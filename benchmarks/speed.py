"""Speed of exact tumbling and of the drop test, beside SciPy's hull, trimesh's poses and MuJoCo.

Example: python benchmarks/speed.py --mujoco 5000

Everything is timed in one run on one machine: take the ratios. MuJoCo is asked only if it is installed
(`pip install mujoco`). It gets explicit contact stiffness, the damping with which one contact returns 0.3 of
the speed, the elliptic friction cone, and the same energy stop as the kernel. Three ways to drop a part:

- Sticking: friction 3, no drift, hardly any contact slips; MuJoCo's friction is damped to hold within a step.
- Frictionless: no friction, spin or drift.
- Slipping: restitution and friction 0.3, spin and drift 3.

In the first two the models say the same of a corner that hits a hard floor, and falls are spread so that the
profile does not hang on some hundredths of restitution: the profiles should agree. In the third not:
MuJoCo's cone throws up a contact that slips, however stiff it is (docs/resting.md).
"""

import argparse
import importlib.util
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
import waits
from scipy.optimize import brentq
from scipy.spatial import ConvexHull
from scipy.stats import chi2_contingency

from feederscrew.dropping import ensemble
from feederscrew.dropping.kernel import body, one_drop
from feederscrew.dropping.launches import Launch, sample
from feederscrew.dropping.rigid_body import shape_of_part
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.tumbling.by_class import ground
from feederscrew.resting.tumbling.exact import tumble

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
import shapes

THROW = Launch("benchmark", (2.0, 2.0), (3.0, 3.0), (3.0, 3.0), (0.3, 0.3), (0.3, 0.3))
RINGS = ((4.5, 0.0), (4.5, 3.0), (2.5, 17.5), (2.25, 18.0))  # [mm] radius and height: a screw's hull
TARGETS = {"T shape, 12 corners": 10_000, "screw, 1,000 corners": 5_400}  # drops a second, at converged steps
JOBS = 1.8  # times as fast, with two
KERNEL_DROPS = 20000  # to compare profiles with
LOOK = 0.1  # time between two looks at MuJoCo's energy


@dataclass(frozen=True)
class Setting:
    """One way to drop a part in both, without dimensions."""

    launch: Launch
    step: float  # of MuJoCo
    length: int  # of a contact, in steps
    holds: bool  # friction stops a slip within a step
    alike: bool  # the models say the same here


SETTINGS = (
    Setting(
        Launch("sticking", (1.0, 6.0), (3.0, 3.0), (0.0, 0.0), (0.3, 0.3), (3.0, 3.0)), 5e-4, 10, True, True
    ),
    Setting(
        Launch("frictionless", (1.0, 6.0), (0.0, 0.0), (0.0, 0.0), (0.3, 0.3), (0.0, 0.0)),
        5e-4,
        20,
        False,
        True,
    ),
    Setting(
        Launch("slipping", (2.0, 2.0), (3.0, 3.0), (3.0, 3.0), (0.3, 0.3), (0.3, 0.3)), 2e-3, 20, False, False
    ),
)


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
        "T shape, 12 corners": shapes.prism(shapes.T_OUTLINE, 15.0),
        "cuboid, 8 corners": shapes.box(10.0, 13.0, 17.0),
        "screw, 1,000 corners": trimesh.convex.convex_hull(np.concatenate(rings)),
    }
    for name, mesh in meshes.items():
        part = shapes.part(mesh)
        found = ground(part, find(part))
        yield name, shape_of_part(part, found)[0], found.rows


def rates(shape, count, launch=THROW, steps=None):
    """Drops a second and core, and the faces."""
    starts = sample(launch, shape, count, np.random.default_rng(1))
    faces, times, work = np.empty(count, int), np.empty(count), one_drop.scratch(shape)
    steps = steps or one_drop.Steps()
    given = shape, work, starts.launched(), steps, faces, times
    return count / seconds(one_drop.settle_all, *given, repeats=2), faces


def jobs(shape):
    """Print what a second core gives, by the clock."""
    took = []
    for cores in (1, 2):
        start = time.perf_counter()
        ensemble.drop(shape, THROW, np.random.default_rng(1), count=40000, jobs=cores)
        took.append(time.perf_counter() - start)
    gain = took[0] / took[1]
    print(f"two jobs: {gain:.2f} x one by the clock, target {JOBS}: {waits.verdict(gain >= JOBS)}")


def spring(damping, length):
    """Stiffness in steps^-2, and damping in steps^-1, of a contact that lasts so many steps."""
    stiffness = (np.pi / length) ** 2 / (1.0 - damping**2)
    return stiffness, 2.0 * damping * np.sqrt(stiffness)


def returned(damping, length):
    """Share of the speed one contact returns, over all moments within a step at which it can begin.

    The floor never pulls: a contact ends before the spring is slack, and returns more than a damped
    oscillation does in half a period (T. Schwager, T. Poeschel, Granular Matter 9, 465-469, 2007).
    """
    stiffness, loss = spring(damping, length)
    depth, speed = (np.arange(32) + 0.5) / 32, np.ones(32)
    for _ in range(4 * length):
        speed = speed - np.where(depth > 0.0, np.maximum(stiffness * depth + loss * speed, 0.0), 0.0)
        depth = depth + speed
    return -speed.mean()


def world(shape, setting):
    """The body over a plane as a MuJoCo model, without dimensions."""
    restitution, friction = setting.launch.restitution[0], setting.launch.friction[0]
    damping = brentq(lambda d: returned(d, setting.length) - restitution, 0.05, 0.7)
    stiffness, loss = spring(damping, setting.length)
    stiffness, loss = stiffness / setting.step**2, loss / setting.step
    grip = f'solreffriction="-1e-6 {-0.9 / setting.step}"' if setting.holds else ""
    corners = " ".join(f"{x:.17g}" for x in shape.vertices.ravel())
    moments = " ".join(f"{x:.17g}" for x in shape.inertia)
    text = f"""<mujoco><option timestep="{setting.step}" gravity="0 0 -1" cone="elliptic" iterations="50"/>
    <asset><mesh name="m" vertex="{corners}"/></asset><worldbody>
    <geom name="floor" type="plane" size="50 50 1"/>
    <body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{moments}"/>
    <geom name="part" type="mesh" mesh="m"/></body></worldbody>
    <contact><pair geom1="floor" geom2="part" condim="3" friction="{friction} {friction} 0 0 0"
    solref="{-stiffness} {-loss}" solimp="0.99 0.99 0.001" {grip}/></contact></mujoco>"""
    return text, stiffness


def mujoco_drop(engine, model, data, shape, stiffness, friction, state):
    """Face of one drop in MuJoCo; the same stop below the lowest saddle, the contacts' springs counted."""
    engine.mj_resetData(model, data)
    data.qpos[:], data.qvel[:3], data.qvel[3:] = state[[0, 1, 2, 6, 7, 8, 9]], state[3:6], state[10:]
    turn, here, stride = np.zeros(9), np.zeros(body.STATE), round(LOOK / model.opt.timestep)
    for _ in range(2000):
        engine.mj_step(model, data, stride)
        here[[0, 1, 2, 6, 7, 8, 9]], here[3:6], here[10:] = data.qpos, data.qvel[:3], data.qvel[3:]
        here[2] += 0.5 * stiffness * np.sum(np.minimum(data.contact.dist, 0.0) ** 2)
        body.rotation(here, turn)
        corner, _ = body.lowest(shape.vertices, shape.solid.links, turn, 0)
        face = one_drop.decided(shape, here, turn, corner, max(data.ncon, 1), friction, 0, one_drop.Steps())
        if face != one_drop.UNSETTLED:
            return face
    return one_drop.UNSETTLED


def mujoco_faces(shape, setting, count, seed):
    """Drops a second and core in MuJoCo, and the faces."""
    import mujoco

    text, stiffness = world(shape, setting)
    model = mujoco.MjModel.from_xml_string(text)
    given = mujoco, model, mujoco.MjData(model), shape, stiffness, setting.launch.friction[0]
    states = sample(setting.launch, shape, count, np.random.default_rng(seed)).states
    mujoco_drop(*given, states[0])
    start = time.process_time()
    faces = np.array([mujoco_drop(*given, state) for state in states])
    return count / (time.process_time() - start), faces


def against_mujoco(name, shape, rows, count, seed):
    """Print the speed beside MuJoCo's, and whether the two agree."""
    for setting in SETTINGS:
        rate, ours = rates(shape, KERNEL_DROPS, setting.launch)
        slow, theirs = mujoco_faces(shape, setting, count, seed)
        table = np.array([ensemble.counted(faces, rows, rows.max() + 1) for faces in (ours, theirs)])
        table = table[:, table.sum(axis=0) > 0]
        p, alike = chi2_contingency(table).pvalue, "models alike" if setting.alike else "models differ"
        print(
            f"{name}, {setting.launch.name}: {rate / slow:.0f} x MuJoCo ({slow:.0f} drops/s/core); "
            f"{alike}, p = {p:.3g}"
        )
        for label, counts in zip(("  kernel", "  MuJoCo"), table):
            print(label, np.round(100.0 * counts / counts.sum(), 1), flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mujoco", type=int, default=1000, help="drops of each body and setting in MuJoCo")
    parser.add_argument("--seed", type=int, default=2, help="of MuJoCo's drops")
    chosen = parser.parse_args()
    tumbling()
    installed = importlib.util.find_spec("mujoco") is not None
    if not installed:
        print("MuJoCo is not installed: no comparison (pip install mujoco)")
    for name, shape, rows in bodies():
        rate, _ = rates(shape, 4000)
        wanted = TARGETS.get(name, 0)
        told = f", target {wanted:,}: {waits.verdict(rate >= wanted)}" if wanted else ""
        print(f"{name}: {rate:,.0f} drops a second and core{told}")
        if installed and "screw" not in name:
            against_mujoco(name, shape, rows, chosen.mujoco, chosen.seed)
        if "T shape" in name:
            jobs(shape)
    print(waits.busy())
