"""The kernels beside their targets, by processor time of one core.

Run: python benchmarks/kernels.py            (prints the table)
     python benchmarks/kernels.py --write    (puts it into docs/method/speed.md as well)

Each script of its own tells more: speed.py (tumbling, drops), conveying.py (beside plain Python
and SciPy's solver), aspects.py (meshes up to a million facets) and tooling.py (beside a scan with shapely).
"""

import statistics
import time
from pathlib import Path

import aspects
import conveying
import numpy as np
import speed
import waits

import feederscrew
from feederscrew import bowl as bowls
from feederscrew.arrivals.rounded_hull import shape_of_part
from feederscrew.motion import conveying as answer
from feederscrew.motion.operating_point import plain
from feederscrew.resting.aspects import find, require_ground
from feederscrew.sorting.orientations import orientations
from feederscrew.trials.queue import PartsQueue
from feederscrew.trials.supply import QueuePlan

POINTS = 20_000
PAIRS = 3
PARTS = Path(__file__).parent.parent / "parts"
QUEUE_SECONDS = 4.0
LOOK_SECONDS = 0.1  # after which it is asked how many parts are on the track
BOLTS = """
drive: {amplitude: 0.184 mm, frequency: 100 Hz, vibration_angle: 15 deg}
track: {climb: 3.5 deg, bank: 0 deg, radius: 150 mm, width: 34.2 mm}
devices:
  - narrowed track: 13.05 mm
  - rails: {from: 3.65 mm, to: 12.2 mm, lead_in: {from: 2.9 mm, to: 12.9 mm, length: 47.1 mm, taper: 31.4 mm}}
"""  # the chain of docs/designs.csv
# name: part, bowl file, parts in the row, part-seconds a CPU second to reach
QUEUES = {
    "12 M8 bolts that touch, rails": ("hexbolt_m8x25", BOLTS, 12, 30),
    "60 brackets that touch, bare track": ("lbracket_30x20x15", "", 60, 80),
}


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


def queues(folder):
    """Part-seconds a CPU second of queues, beside drops of the same part in the same run."""
    for name, (stem, text, count, wanted) in QUEUES.items():
        path = Path(folder) / "queue.yaml"
        path.write_text(text)
        part, bowl = feederscrew.load(PARTS / f"{stem}.stl"), bowls.read(path if text else None)
        aspects = find(part)
        every = orientations(part, aspects, bowl.track)
        supply = every, np.full(len(every), 1.0 / len(every))
        row = PartsQueue(part, bowl, aspects, supply, every, QueuePlan(count, 60.0, 0.0), 1)
        row.follow(LOOK_SECONDS)  # compiles
        part_seconds, start = 0.0, time.process_time()
        while row.time < QUEUE_SECONDS:
            row.follow(row.time + LOOK_SECONDS)
            part_seconds += LOOK_SECONDS * row.crowd.is_on.sum()
        rate = part_seconds / (time.process_time() - start)
        drops, _ = speed.rates(shape_of_part(part, require_ground(part, aspects))[0], 1000)
        beside = f"a part-second takes as long as {drops / rate:,.0f} drops of it"
        yield waits.Row(f"queue of {name}", wanted, rate, "part-s a CPU second", beside, more=True)


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
    yield from queues(folder)
    yield from facets(folder)


if __name__ == "__main__":
    waits.main("kernels", __doc__, kernels, page=waits.PAGE.parent / "method/speed.md")
