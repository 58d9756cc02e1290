"""Filmed tosses of a cube, ours beside MuJoCo in one run (``pip install mujoco``; without it, ours alone).

Example: python benchmarks/tosses.py

Both get the authors' friction and restitution; MuJoCo's contact is tried as stiff as its step allows.
"""

import time
from pathlib import Path

import numpy as np
import trimesh

from feederscrew.dropping import launch_file
from feederscrew.dropping.launch_file import FACES
from feederscrew.part import load
from feederscrew.studies.simulated.tosses import follow

FILMED = Path(__file__).parents[1] / "docs/measured/filmed/cube_tosses.csv"
SIDE, MASS, FRICTION, RESTITUTION = 0.1048, 0.37, 0.18, 0.125
SETTINGS = {"solref 0.002 0.6": (0.002, 0.6, 0.18), "solref 0.004 0.9": (0.004, 0.9, 0.18),
            "solref 0.002 0.6, friction 0.25": (0.002, 0.6, 0.25)}  # fmt: skip


def upward(quaternion):
    """Return the side that points up, of (4,) w x y z."""
    w, x, y, z = quaternion
    up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    axis = np.abs(up).argmax()
    return 2 * axis + (up[axis] > 0)


def mujoco_ends(launches, constant, ratio, friction):
    """Return (N,) sides and (N, 2) places where MuJoCo leaves the cube."""
    import mujoco

    half = SIDE / 2
    made = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="0.0005" cone="elliptic"/><default><geom solref="{constant} {ratio}" '
        f'friction="{friction} 0 0" condim="3"/></default><worldbody><geom type="plane" size="5 5 1"/>'
        f'<body><freejoint/><geom type="box" size="{half} {half} {half}" mass="{MASS}"/></body>'
        "</worldbody></mujoco>"
    )
    data, sides, places = mujoco.MjData(made), [], []
    for k in range(len(launches.names)):
        mujoco.mj_resetData(made, data)
        data.qpos[:] = *launches.positions[k], *launches.attitudes[k]
        data.qvel[:] = *launches.velocities[k], *launches.spins[k]
        for _ in range(4000):
            mujoco.mj_step(made, data)
        sides.append(upward(data.qpos[3:]))
        places.append(data.qpos[:2].copy())
    return np.array(sides), np.array(places)


def main():
    """Print one line for each answer."""
    launches = launch_file.read(FILMED)
    measured = np.array([FACES.index(face) for face in launches.faces])

    def line(name, sides, places, seconds):
        off = 1e3 * np.median(np.hypot(*(places - launches.ends).T))
        print(
            f"{name:40} {100 * (sides == measured).mean():6.1f} % {off:6.1f} mm {seconds:7.1f} s", flush=True
        )

    path = Path("/tmp/feeder_cube.stl")
    trimesh.creation.box((1e3 * SIDE,) * 3).export(path)
    cube = load(path, density=f"{MASS / SIDE**3:.1f} kg/m3")
    own = {"friction": str(FRICTION), "restitution": str(RESTITUTION)}
    for name, runs in (("feeder, one run of each toss", 1), ("feeder, 64 runs of each toss", 64)):
        start = time.process_time()
        found = follow(cube, FILMED, own, runs=runs).result
        line(name, found.faces, found.places, time.process_time() - start)
    try:
        for name, setting in SETTINGS.items():
            start = time.process_time()
            ends = mujoco_ends(launches, *setting)
            line(f"MuJoCo, {name}", *ends, time.process_time() - start)
    except ImportError:
        print("MuJoCo is not installed")


if __name__ == "__main__":
    main()
