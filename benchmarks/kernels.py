"""The kernels beside their targets, by processor time of one core.

Run: python benchmarks/kernels.py            (prints the table)
     python benchmarks/kernels.py --write    (puts it into docs/method/speed.md as well)

Each script of its own tells more: speed.py (tumbling, drops), conveying.py (beside plain Python
and SciPy's solver), aspects.py (meshes up to a million facets) and tooling.py (beside a scan with shapely).
"""

import statistics
from pathlib import Path

import aspects
import conveying
import numpy as np
import speed
import waits

from feederscrew.motion import conveying as answer
from feederscrew.motion.operating_point import plain

POINTS = 20_000
PAIRS = 3


def drops():
    for name, shape in speed.bodies():
        if name in speed.TARGETS:
            rate, _ = speed.rates(shape, 4000)
            yield waits.Row(f"drops of a {name}", speed.TARGETS[name], rate, "a CPU second", more=True)


def points():
    """Points a second and core, beside plain Python."""
    answer.sweep(np.array([plain(1.0, 0.5, 0.0, 0.4)]))
    for restitution, (wanted, _) in conveying.TARGETS.items():
        box = conveying.random_settings(POINTS, np.random.default_rng(1))
        settings = np.array([plain(*row, restitution) for row in box])
        took, _ = conveying.seconds(lambda: answer.sweep(settings, workers=1))  # noqa: B023
        few = max(20, POINTS // 500)
        slow, _ = conveying.seconds(lambda: conveying.plain_python(settings[:few]))  # noqa: B023
        beside = f"plain Python {few / slow:,.0f}"
        what = f"conveying, points at e = {restitution:g}"
        yield waits.Row(what, wanted, POINTS / took, "a CPU second", beside, more=True)


def facets(folder):
    """Aspects beside what any tool must pay: reading, checking, integrating, the hull; in turn."""
    for size, target in aspects.SMALL.items():
        for name, make in (("box", aspects.box), ("screw", aspects.screw), ("sphere", aspects.sphere)):
            mesh, path = make(size), Path(folder) / f"{name}.stl"
            mesh.export(path)
            pairs = [(aspects.measured("ours", path), aspects.measured("floor", path)) for _ in range(PAIRS)]
            ratio = statistics.median(ours[0] / bare[0] for ours, bare in pairs)
            beside = f"{1e3 * statistics.median(ours[0] for ours, _ in pairs):.1f} ms"
            yield waits.Row(f"aspects of a {name}, {len(mesh.faces):,} facets", target, ratio, "x", beside)


def kernels(_call, folder):
    yield from drops()
    yield from points()
    yield from facets(folder)


if __name__ == "__main__":
    waits.main("kernels", __doc__, kernels, page=waits.PAGE.parent / "method/speed.md")
