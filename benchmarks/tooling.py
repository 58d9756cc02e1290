"""Speed of the verdict: which feet pass which cuts, compiled, beside a plain scan by shapely.

Run: python benchmarks/tooling.py [--feet N] [--positions N]

Times are of this process's own processor time, one core, on a foot of 30 corners. The scan agrees where it is
fine enough: it never finds a lower margin, and the more positions it looks at, the nearer it comes.
"""

import argparse
import time

import numpy as np
import shapely
import waits

from feederscrew.bowl.devices.openings import polygon
from feederscrew.sorting import footprints, kernel
from feederscrew.sorting.footprints import Footprint

RADIUS, DISTANCE, CORNERS = 0.15, 9e-3, 30
TARGETS = {"one-number verdicts": 100_000, "polygon verdicts": 2_000}  # a second and core
NEAR = 1e-4  # [m] to which the finest scan agrees on average
CLOSE = 1e-5  # [m] by which a scan's chords may lie lower


def foot_of(corners):
    turn = 2.0 * np.pi * np.arange(corners) / corners
    ring = np.column_stack([0.012 * np.cos(turn), 0.008 * np.sin(turn)])
    return Footprint((ring,), np.empty((0, 2, 2)), np.empty((0, 2)))


def random_hole(rng):
    turn = np.sort(rng.uniform(0.0, 2.0 * np.pi, 5))
    far = rng.uniform(0.003, 0.012, 5)[:, None]
    corners = [0.0, 0.009] + far * np.column_stack([np.cos(turn), 0.7 * np.sin(turn)])
    return corners if shapely.Polygon(corners).is_valid else random_hole(rng)


def scanned(ring, corners, positions, pieces=12):
    """The least margin over evenly spaced positions, by shapely."""
    share = np.arange(pieces)[:, None] / pieces
    border = np.concatenate([c + share * (d - c) for c, d in zip(corners, np.roll(corners, -1, axis=0))])
    foot, origin, least = shapely.Polygon(ring), shapely.Point(0.0, 0.0), np.inf
    span = (np.ptp(corners[:, 0]) + 0.026) / RADIUS
    for phi in np.linspace(-span, span, positions):
        theta, r = border[:, 0] / RADIUS + phi, RADIUS - border[:, 1]
        hole = np.column_stack([r * np.sin(theta), RADIUS - DISTANCE - r * np.cos(theta)])
        left = foot.difference(shapely.Polygon(hole)).convex_hull
        away = left.exterior.distance(origin) if left.area > 0.0 else left.distance(origin)
        least = min(least, away if left.covers(origin) else -away)
    return least


def judged(what, rate):
    wanted = TARGETS[what]
    return f"{rate:,.0f} a second, target {wanted:,}: {waits.verdict(rate >= wanted)}"


def rate(function, items):
    start = time.process_time()
    found = [function(item) for item in items]
    return len(items) / (time.process_time() - start), found


def polygons(count, positions, rng):
    print_foot = foot_of(CORNERS)
    foot = footprints.axial_foot(print_foot, DISTANCE, RADIUS)
    shapes = [random_hole(rng) for _ in range(count)]
    holes = [polygon(corners, RADIUS) for corners in shapes]
    work = footprints.scratch(foot, edges=16, nodes=max(len(hole.nodes) for hole in holes))
    footprints.least(foot, holes[0], work)
    compiled, exact = rate(lambda hole: footprints.least(foot, hole, work)[0], holes)
    few = min(count, 12)
    print(f"polygon verdicts, foot of {CORNERS} corners, holes of 5: {judged('polygon verdicts', compiled)}")
    agrees = True
    for number in (positions // 16, positions):
        scan, found = rate(lambda c: scanned(print_foot.rings[0], c, number), shapes[:few])  # noqa: B023
        apart = np.array(found) - exact[:few]
        print(
            f"  scan of {number:5d} positions: {scan:8.1f} a second, {compiled / scan:8,.0f} times slower, "
            f"margin higher by {1e3 * apart.mean():.4f} mm on average, {1e3 * apart.min():.5f} at least"
        )
        agrees &= bool(apart.min() > -CLOSE)
    near = agrees and apart.mean() < NEAR
    print(f"  the finest scan's margins agree to {1e3 * NEAR:g} mm on average: {waits.verdict(near)}")
    return compiled >= TARGETS["polygon verdicts"], near


def one_number(count, rng):
    def over_rings(foot, low, high, scratch, out):
        for k in range(len(out)):
            out[k] = kernel.over_ring(foot, low[k], high[k], scratch)

    foot = footprints.axial_foot(foot_of(CORNERS), DISTANCE, RADIUS)
    widths = rng.uniform(0.002, 0.016, count)
    out = np.empty(count)
    work = footprints.scratch(foot)
    over_rings(foot, 0.0 * widths, RADIUS - widths, work, out)
    start = time.process_time()
    over_rings(foot, 0.0 * widths, RADIUS - widths, work, out)
    fast = count / (time.process_time() - start)
    told = judged("one-number verdicts", fast)
    print(f"one-number verdicts (balcony), foot of {CORNERS} corners: {told}")
    return fast >= TARGETS["one-number verdicts"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--feet", type=int, default=1000)
    parser.add_argument("--positions", type=int, default=800)
    given = parser.parse_args()
    rng = np.random.default_rng(1)
    held = [one_number(50 * given.feet, rng), *polygons(given.feet, given.positions, rng)]
    print("all targets hold" if all(held) else "some targets are missed", f"({waits.busy()})")


if __name__ == "__main__":
    main()
