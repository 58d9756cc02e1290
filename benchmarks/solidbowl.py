"""CPU seconds and memory of a bowl of 300 mm as a solid, with its files: at most 60 s and 1 GB."""

import importlib.util
import itertools
import resource
import time

import numpy as np

from feederscrew.bowl.reading import effective, record
from feederscrew.bowl.record import Track
from feederscrew.machine.sizing import Size
from feederscrew.output import solid_files
from feederscrew.solidbowl import segments
from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.exact import exact_file
from feederscrew.solidbowl.plan import SolidOptions, material, plan

TRACK = Track(climb=np.radians(4.5), bank=0.0, radius=0.15, width=0.02)


def main():
    """Print one line a shape: facets, CPU seconds of body, files, segments and STEP, memory."""
    for shape in ("cylinder", "stepped", "conical"):
        rise = 2.0 * np.pi * TRACK.radius * np.tan(TRACK.climb)
        size = Size(0.3, {}, TRACK.width, 0.0, 0.0, TRACK.climb, 1.8 * rise, 1.8, rise)
        rules, times = record(effective({})).sizing, [time.process_time()]
        made = body(plan(size, TRACK, material("pla", rules), None, SolidOptions(shape=shape),
                         extents=(18e-3, 14e-3, 12e-3)))  # fmt: skip
        times.append(time.process_time())
        files = solid_files.bowl_stl(made), solid_files.bowl_3mf(made, "bowl")
        times.append(time.process_time())
        pieces = segments.segments(made, (0.22, 0.22, 0.25)).pieces
        times.append(time.process_time())
        if importlib.util.find_spec("OCP") is not None:
            exact_file.step_file(made)
        times.append(time.process_time())
        own = ", ".join(f"{b - a:.2f}" for a, b in itertools.pairwise(times))
        most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"{shape}: {len(made.faces)} facets, {len(pieces)} segments, "
            f"{sum(map(len, files)) / 1e6:.1f} MB; "
            f"{own} s CPU of body, files, segments, STEP; {most:.0f} MB"
        )


if __name__ == "__main__":
    main()
