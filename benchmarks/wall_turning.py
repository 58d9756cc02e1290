"""A block across a banked track, beside a rough wall: an independent simulation, the trial and the track.

Example: python benchmarks/wall_turning.py

Wall friction turns what lies across: its force acts at half the length, the wall carries over half the width.
The simulation here knows nothing of `feederscrew`: eight corners of a box against two planes, velocities and
impulses by Moreau's time stepping, projected Gauss-Seidel to 1e-9, steps of 10 us.
"""

import numpy as np
from numba import njit

GRAVITY, MU, BANK, CLIMB, BETA = 9.81, 0.4, np.radians(12.0), np.radians(2.0), np.radians(25.0)
TURN, STROKE = 2.0 * np.pi * 50.0, 0.15e-3
FRICTIONS = 0.4, 0.5, 0.6, 0.7, 0.8
STEP, SECONDS, SWEEPS, DONE, TOUCHES = 1e-5, 0.8, 300, 1e-9, 2e-6
BOWL = (
    "drive.amplitude=0.15 mm", "drive.frequency=50 Hz", "drive.vibration_angle=25 deg", "friction.static=0.4",
    "track.radius=2 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=12 deg",
)  # fmt: skip
UP = np.array([0.0, np.sin(BANK), np.cos(BANK)])  # the bowl's axis, in the track's frame
FLOOR = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # normal, along, across
WALL = np.array([[0.0, np.cos(BANK), -np.sin(BANK)], [1.0, 0.0, 0.0], [0.0, np.sin(BANK), np.cos(BANK)]])


@njit
def _give(velocity, rates, turn, inertia, arm, impulse):
    velocity += impulse
    rates += turn @ ((turn.T @ np.cross(arm, impulse)) / inertia)


@njit
def _solve(velocity, rates, turn, inertia, arms, gaps, planes, mu, impulses, masses):
    for _ in range(SWEEPS):
        change = 0.0
        for c in range(len(arms)):
            if gaps[c] > TOUCHES:
                continue
            old = impulses[c].copy()
            fall = (velocity + np.cross(rates, arms[c])) @ planes[c, 0]
            impulses[c, 0] = max(
                old[0] - (fall + gaps[c] / STEP * (0.2 if gaps[c] < 0.0 else 1.0)) * masses[c, 0], 0.0
            )
            _give(velocity, rates, turn, inertia, arms[c], (impulses[c, 0] - old[0]) * planes[c, 0])
            slip = velocity + np.cross(rates, arms[c])
            for e in (1, 2):
                impulses[c, e] -= slip @ planes[c, e] * masses[c, e]
            size, most = np.hypot(impulses[c, 1], impulses[c, 2]), mu[c] * impulses[c, 0]
            if size > most:
                impulses[c, 1:] *= most / size
            rub = (impulses[c, 1] - old[1]) * planes[c, 1] + (impulses[c, 2] - old[2]) * planes[c, 2]
            _give(velocity, rates, turn, inertia, arms[c], rub)
            change += np.abs(impulses[c] - old).sum()
        if change < DONE:
            break


@njit
def travelled(half, wall):
    """Return the velocity along the wall [mm/s] of a box of half sides (3,) [m], and its yaw [deg]."""
    points = np.array([[a, b, c] for a in (-1.0, 1.0) for b in (-1.0, 1.0) for c in (-1.0, 1.0)]) * half
    spots = np.concatenate((points[points[:, 2] < 0.0], points[points[:, 1] < 0.0]))
    planes, mu = np.empty((8, 3, 3)), np.empty(8)
    planes[:4], planes[4:], mu[:4], mu[4:] = FLOOR, WALL, MU, wall
    inertia = (np.sum(half**2) - half**2) / 3.0
    place = np.array([0.0, half[1] + 2.0 * half[2] * np.tan(BANK), half[2]])
    velocity, rates, turn = np.zeros(3), np.zeros(3), np.eye(3)
    impulses, masses, arms, gaps = np.zeros((8, 3)), np.empty((8, 3)), np.empty((8, 3)), np.empty(8)
    steps, begun, yaws = round(SECONDS / STEP), 0.0, np.zeros(2)
    along = np.array([1.0, 0.0, 0.0])
    for k in range(steps):
        felt = STROKE * TURN * (np.cos(TURN * k * STEP) - np.cos(TURN * (k + 1) * STEP))
        velocity += felt * (np.cos(BETA) * along + np.sin(BETA) * UP)
        velocity -= STEP * GRAVITY * (np.cos(CLIMB) * UP + np.sin(CLIMB) * along)
        for c in range(8):
            arms[c] = turn @ spots[c]
            gaps[c] = (place + arms[c]) @ planes[c, 0]
            for e in range(3):
                lever = turn.T @ np.cross(arms[c], planes[c, e])
                masses[c, e] = 1.0 / (1.0 + np.sum(lever * lever / inertia))
            if gaps[c] > TOUCHES:
                impulses[c] = 0.0
            _give(velocity, rates, turn, inertia, arms[c], impulses[c] @ planes[c])
        _solve(velocity, rates, turn, inertia, arms, gaps, planes, mu, impulses, masses)
        place += STEP * velocity
        angle = np.sqrt(np.sum(rates * rates)) * STEP
        if angle > 0.0:
            x, y, z = rates * STEP / angle
            spin = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
            turn = (np.eye(3) + np.sin(angle) * spin + (1.0 - np.cos(angle)) * (spin @ spin)) @ turn
        if k == steps // 2:
            begun = place[0]
        if k > steps // 2:
            yaw = np.degrees(np.arctan2(turn[1, 0], turn[0, 0]))
            yaws[0], yaws[1] = min(yaws[0], yaw), max(yaws[1], yaw)
    return 1e3 * (place[0] - begun) / ((steps - 1 - steps // 2) * STEP), yaws


def ours(part, wall):
    """Return velocities [mm/s] of A laid across: in the trial, and by the track's mechanics."""
    from feederscrew import bowl as bowls
    from feederscrew.output.floor.tables import mean_velocity
    from feederscrew.studies.track import track
    from feederscrew.studies.trial import trial

    bowl = bowls.read(None, (*BOWL, f"friction.wall={wall}"))
    made = trial(part, [bowl], "A", parts=16, seed=3).runs[0]
    own = [k for k, one in enumerate(made.known.lying) if one.name == "A@90"]
    there = [made.course.entered[n] in own for n in range(len(made.course.entered))]
    found = track(part, bowl, "A", heading=0.5 * np.pi)
    return 1e3 * np.mean(made.course.velocities[there]), 1e3 * mean_velocity(found)


def main():
    """Print a row for each friction of the wall."""
    import sys
    from pathlib import Path

    sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
    import shapes

    part = shapes.part(shapes.box(20, 12, 5), "block")
    print("| Friction of the wall | independent, along | across | its yaw | trial, across | `feeder track` |")
    print("|---:|---:|---:|---:|---:|---:|")
    for wall in FRICTIONS:
        straight, _ = travelled(np.array([10e-3, 6e-3, 2.5e-3]), wall)
        across, yaws = travelled(np.array([6e-3, 10e-3, 2.5e-3]), wall)
        trial, track = ours(part, wall)
        row = f"| {wall} | {straight:.2f} | {across:.2f} | {np.ptp(yaws):.2f} deg "
        print(f"{row}| {trial:.2f} | {track:.2f} |", flush=True)


if __name__ == "__main__":
    main()
