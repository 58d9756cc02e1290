"""Does a tall block on a vibrating track lie flat or rock? An independent rigid code: docs/trial.md.

Example: python benchmarks/rocking.py

It knows nothing of `feederscrew`: eight corners of a box against track and wall, velocities and impulses by
Moreau's time stepping, projected Gauss-Seidel, steps of 2 us. What comes faster than 3 mm/s rebounds.
"""

import numpy as np
from numba import njit

GRAVITY = 9.80665  # [m/s2]
FREQUENCY, ANGLE, CLIMB = 60.0, np.radians(25.0), np.radians(3.0)
HALF = np.array([4e-3, 4e-3, 10e-3])  # [m] of the block
THROW, FRICTION, PARTS, SECONDS, STEP = 1.2, 0.3, 8, 1.5, 2e-6
WALL_GAP, SLOW, ROCKS = 3e-5, 3e-3, 15e-3  # [m], [m/s] without rebound, [m/s] from which a block rocks
SWEEPS, DONE = 100, 1e-11


@njit
def travelled(e, tiltvec, phase):
    """Return velocity [m/s] and root mean square tilt [deg] of the block, over the second half of its time.

    ``e`` is the restitution, ``tiltvec`` (3,) [rad] how it begins out of level, ``phase`` [rad] of the drive.
    """
    half, throw, mu, muw, freq, beta, climb = HALF, THROW, FRICTION, FRICTION, FREQUENCY, ANGLE, CLIMB
    seconds, step, wallgap, slow, G = SECONDS, STEP, WALL_GAP, SLOW, GRAVITY
    w = 2 * np.pi * freq
    A = throw * G * np.cos(climb) / (w * w * np.sin(beta))
    pts = np.empty((8, 3))
    n = 0
    for a in (-1.0, 1.0):
        for b in (-1.0, 1.0):
            for c in (-1.0, 1.0):
                pts[n, 0] = a * half[0]
                pts[n, 1] = b * half[1]
                pts[n, 2] = c * half[2]
                n += 1
    moments = (np.sum(half**2) - half**2) / 3.0
    ang = np.sqrt(np.sum(tiltvec**2))
    R = np.eye(3)
    if ang > 0:
        x, y, z = tiltvec / ang
        K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        R = np.eye(3) + np.sin(ang) * K + (1 - np.cos(ang)) * (K @ K)
    sp = pts @ R.T
    pos = np.array([0.0, wallgap - sp[:, 1].min(), -sp[:, 2].min()])
    v = np.zeros(3)
    om = np.zeros(3)
    N = int(seconds / step)
    x0 = 0.0
    s2 = 0.0
    cnt = 0
    lam = np.zeros(16)
    g1 = np.zeros(16)
    g2 = np.zeros(16)
    want = np.zeros(16)
    act = np.zeros(16, np.int64)
    arms = np.zeros((16, 3))
    for k in range(N):
        t = k * step
        a = A * w * w * np.sin(w * t + phase)
        v[0] += step * (-G * np.sin(climb) + a * np.cos(beta))
        v[2] += step * (-G * np.cos(climb) + a * np.sin(beta))
        na = 0
        for c in range(8):
            ax = R[0, 0] * pts[c, 0] + R[0, 1] * pts[c, 1] + R[0, 2] * pts[c, 2]
            ay = R[1, 0] * pts[c, 0] + R[1, 1] * pts[c, 1] + R[1, 2] * pts[c, 2]
            az = R[2, 0] * pts[c, 0] + R[2, 1] * pts[c, 1] + R[2, 2] * pts[c, 2]
            for s in range(2):
                gap = pos[2] + az if s == 0 else pos[1] + ay
                if gap <= 0.0:
                    arms[na, 0] = ax
                    arms[na, 1] = ay
                    arms[na, 2] = az
                    act[na] = s
                    lam[na] = g1[na] = g2[na] = 0.0
                    vy = v[1] + om[2] * ax - om[0] * az
                    vz = v[2] + om[0] * ay - om[1] * ax
                    vn = vz if s == 0 else vy
                    want[na] = -e * vn if vn < -slow else 0.0
                    na += 1
        if na:
            # world inverse inertia
            Ii = np.zeros((3, 3))
            for i in range(3):
                for j in range(3):
                    for m in range(3):
                        Ii[i, j] += R[i, m] * R[j, m] / moments[m]
            for _ in range(SWEEPS):
                ch = 0.0
                for c in range(na):
                    s = act[c]
                    r = arms[c]
                    for ax_ in range(3):
                        # order: normal, x, other
                        if ax_ == 0:
                            d = 2 if s == 0 else 1
                        elif ax_ == 1:
                            d = 0
                        else:
                            d = 1 if s == 0 else 2
                        # r x e_d
                        if d == 0:
                            rx, ry, rz = 0.0, r[2], -r[1]
                        elif d == 1:
                            rx, ry, rz = -r[2], 0.0, r[0]
                        else:
                            rx, ry, rz = r[1], -r[0], 0.0
                        ux = Ii[0, 0] * rx + Ii[0, 1] * ry + Ii[0, 2] * rz
                        uy = Ii[1, 0] * rx + Ii[1, 1] * ry + Ii[1, 2] * rz
                        uz = Ii[2, 0] * rx + Ii[2, 1] * ry + Ii[2, 2] * rz
                        m = 1.0 / (1.0 + rx * ux + ry * uy + rz * uz)
                        sp_ = v[d] + om[0] * rx + om[1] * ry + om[2] * rz
                        if ax_ == 0:
                            new = max(lam[c] + m * (want[c] - sp_), 0.0)
                            dl = new - lam[c]
                            lam[c] = new
                        elif ax_ == 1:
                            lim = (mu if s == 0 else muw) * lam[c]
                            lim = np.sqrt(max(lim * lim - g2[c] * g2[c], 0.0))
                            new = min(max(g1[c] - m * sp_, -lim), lim)
                            dl = new - g1[c]
                            g1[c] = new
                        else:
                            lim = (mu if s == 0 else muw) * lam[c]
                            lim = np.sqrt(max(lim * lim - g1[c] * g1[c], 0.0))
                            new = min(max(g2[c] - m * sp_, -lim), lim)
                            dl = new - g2[c]
                            g2[c] = new
                        v[d] += dl
                        om[0] += dl * ux
                        om[1] += dl * uy
                        om[2] += dl * uz
                        ch += abs(dl)
                if ch < DONE:
                    break
        pos += step * v
        # gyroscopic neglected for tiny rates? include: body torque-free
        wb = R.T @ om
        wb[0] += step * (moments[1] - moments[2]) / moments[0] * wb[1] * wb[2]
        wb[1] += step * (moments[2] - moments[0]) / moments[1] * wb[2] * wb[0]
        wb[2] += step * (moments[0] - moments[1]) / moments[2] * wb[0] * wb[1]
        an = np.sqrt(np.sum(om**2)) * step
        om0 = om.copy()
        om[:] = R @ wb
        if an > 1e-15:
            x, y, z = om0 * step / an
            K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
            R = (np.eye(3) + np.sin(an) * K + (1 - np.cos(an)) * (K @ K)) @ R
        if R[2, 2] < 0.3:
            return np.nan, 99.0
        if k == N // 2:
            x0 = pos[0]
        if k > N // 2:
            s2 += 1 - R[2, 2] ** 2
            cnt += 1
    return (pos[0] - x0) / (0.5 * seconds), np.degrees(np.sqrt(max(s2, 0.0) / cnt))


def main():
    for restitution in (0.0, 0.3, 0.6):
        for about in ("the axis across", "any axis"):
            for degrees in (0.2, 1.0):
                rng, speeds = np.random.default_rng(1), []
                for _ in range(PARTS):
                    if about == "any axis":
                        way = 2.0 * np.pi * rng.random()
                        axis = np.array([np.cos(way), np.sin(way), 0.0])
                    else:
                        axis = np.array([0.0, 1.0, 0.0]) * (1.0 if rng.random() > 0.5 else -1.0)
                    phase = 2.0 * np.pi * rng.random()
                    speeds.append(travelled(restitution, axis * np.radians(degrees), phase)[0])
                share = np.mean(np.array(speeds) > ROCKS)
                print(
                    f"e {restitution}, {degrees} deg about {about}: {share:.2f} rock",
                    1e3 * np.round(speeds, 4),
                )


if __name__ == "__main__":
    main()
