"""The six cases of ``benchmarks/trial.py`` with MuJoCo (``pip install mujoco``): what it finds, and its cost.

Contacts as stiff as the step allows, elliptic friction cones of 0.4; everything in the frame of the plate, so
that a vibrating one is a gravity that changes with time. Parts that are not convex are unions of boxes.
"""

import time

import numpy as np

STEP = 1e-4  # [s] as fine as a part of 10 mm needs it there
G = 9.81
FLOOR = [("0.5 0.5 0.5", "-0.5 0 -0.5")]  # ends at x = 0, its surface at z = 0
RAILS = [("0.5 0.05 0.5", "0 0.053 -0.5"), ("0.5 0.05 0.5", "0 -0.053 -0.5")]  # 6 mm apart
BLOCK = [("0.01 0.006 0.0025", "0 0 0")]
CUBE = [("0.005 0.005 0.005", "0 0 0")]
ARCH = [("0.0015 0.006 0.002", "-0.0085 0 0.002"), ("0.0015 0.006 0.002", "0.0085 0 0.002"),
        ("0.01 0.006 0.002", "0 0 0.006")]  # fmt: skip
PIN = [("0.002 0.002 0.006", "0 0 -0.006"), ("0.002 0.004 0.0015", "0 0 0.0015")]


def model(part, placed, floor, ratio=1.0):
    """A part, boxes of half sides and middles, placed over fixed boxes."""
    import mujoco

    own = f'type="box" solref="{4 * STEP} {ratio}" solimp="0.99 0.999 0.0001" friction="0.4 0 0" condim="3"'
    fixed = "".join(f'<geom {own} size="{size}" pos="{pos}"/>' for size, pos in floor)
    loose = "".join(f'<geom {own} density="7850" size="{size}" pos="{pos}"/>' for size, pos in part)
    made = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{STEP}" cone="elliptic" impratio="20"/><worldbody>{fixed}'
        f"<body {placed}><freejoint/>{loose}</body></worldbody></mujoco>"
    )
    return mujoco, made, mujoco.MjData(made)


def end(part, placed, seconds, floor=FLOOR, pull=lambda time: (0.0, 0.0, -G), ratio=1.0):
    """Place and velocity of a part at each step, and the simulated seconds a second."""
    mujoco, made, data = model(part, placed, floor, ratio)
    path, start = np.empty((round(seconds / STEP), 4)), time.process_time()
    for row in path:
        made.opt.gravity[:] = pull(data.time + 0.5 * STEP)
        mujoco.mj_step(made, data)
        row[:] = *data.qpos[:3], data.qvel[2]
    return path, seconds / (time.process_time() - start)


def sliding():
    """Velocity [mm/s] on a plate: 0.15 mm, 60 Hz, 20 deg, climb 2 deg."""
    beta, climb, turn = np.radians(20.0), np.radians(2.0), 2.0 * np.pi * 60.0
    peak = 0.15e-3 * turn**2

    def pull(now):
        felt = peak * np.sin(turn * now)
        return felt * np.cos(beta) - G * np.sin(climb), 0.0, felt * np.sin(beta) - G * np.cos(climb)

    path, speed = end(BLOCK, 'pos="-0.3 0 0.0025"', 1.0, pull=pull)
    half = len(path) // 2
    return 1e3 * (path[-1, 0] - path[half, 0]) / ((len(path) - 1 - half) * STEP), speed


def edge(part, height, exact):
    """Where a part laid ever further over an edge falls [mm], by halving."""
    low, high, speeds = exact - 2e-3, exact + 2e-3, []
    for _ in range(8):
        middle = 0.5 * (low + high)
        path, speed = end(part, f'pos="{middle} 0 {height}"', 1.0)
        low, high = (low, middle) if path[-1, 2] < height - 5e-4 else (middle, high)
        speeds.append(speed)
    return 1e3 * 0.5 * (low + high), float(np.median(speeds))


def hanging():
    """Height of the centre of mass of a headed bar between rails [mm]: its head's underside is at 0."""
    path, speed = end(PIN, 'pos="0 0 0.0004"', 0.5, RAILS)
    heavy, head = 4.0 * 4.0 * 12.0, 8.0 * 4.0 * 3.0
    return 1e3 * path[-1, 2] + (1.5 * head - 6.0 * heavy) / (heavy + head), speed


def incline():
    """Slope at which a box begins to slide."""
    low, high, speeds = 0.2, 0.6, []
    for _ in range(10):
        slope = 0.5 * (low + high)
        tilted = np.array([-np.sin(np.arctan(slope)), 0.0, -np.cos(np.arctan(slope))]) * G
        path, speed = end(BLOCK, 'pos="-0.3 0 0.0025"', 0.3, pull=lambda now, felt=tilted: felt)
        creep = 0.5 * G * 0.09 * 0.005  # what half a hundredth of the slope would give
        low, high = (low, slope) if path[-1, 0] + 0.3 < -creep else (slope, high)
        speeds.append(speed)
    return 0.5 * (low + high), float(np.median(speeds))


def corner(ratio=0.5):
    """Restitution of a cube's corner, at the damping ratio that comes nearest to 0.3."""
    turned = 'pos="-0.2 0 0.03" quat="0.8805 0.3647 -0.2798 0.1159"'
    path, speed = end(CUBE, turned, 0.15, ratio=ratio)
    return float(path[:, 3].max() / -path[:, 3].min()), speed


CASES = {
    "sliding velocity on a vibrating plate": sliding,
    "block tipping over an edge, from its centre": lambda: edge(BLOCK, 2.5e-3, 0.0),
    "bridge on its legs over an edge": lambda: edge(ARCH, 0.0, -7e-3),
    "headed bar hanging in a slot": hanging,
    "box on an incline at its friction angle": incline,
    "restitution of a corner hit": corner,
}
