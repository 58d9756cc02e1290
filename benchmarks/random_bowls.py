"""Bowls drawn by seeds, each checked as a solid; and parts that ride their meshes.

Example: python benchmarks/random_bowls.py 82000-82039            (closed, heights, widths, parts laid)
         python benchmarks/random_bowls.py 82000-82039 slice      (each file sliced as well, by prusa-slicer)
         python benchmarks/random_bowls.py 83000-83029 rides      (how parts end, on the mesh and without it)

A bowl is refused in a line where its draw does not fit together; that line is printed.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import trial_parts

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.base.running import RunSettings
from feederscrew.cad import facets, measuring, riding
from feederscrew.cad.closed_body import body
from feederscrew.cad.measuring import ways_down
from feederscrew.cad.plan import MATERIAL_NAMES, SolidOptions, material, plan
from feederscrew.output import solid_files
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooled_track import lay_out
from feederscrew.trials import course

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "solidbowl"))
import on_mesh

MM = 1e-3
NEAR = 5e-5  # [m] of height and width from the formula
PLACES, LAID = 200, 50
LIFT, ASIDE = 3e-4, 5e-4  # [m] off the track and inwards, from where a corner's way to the wall is measured
DRIVE = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4",
]  # fmt: skip
COARSE = ["--layer-height", "1", "--first-layer-height", "1", "--nozzle-diameter", "1.4",
          "--fill-density", "0%", "--bed-shape", "0x0,900x0,900x900,0x900", "--max-print-height", "900",
          "--center", "450,450"]  # fmt: skip
RIDDEN = ("tip", "groove", "bank", "rails", "gap", "narrowed_track", "wiper", "step")


def devices(rng, size, width):
    """One device of each kind that a chain is drawn of, a line of a bowl file by kind; lengths [mm]."""
    length, broad, high = size
    a, b, c = rng.uniform(0.0, 1.0, 3)
    return {
        "gap": f"{length * (0.3 + 0.6 * a):.2f} mm",
        "narrowed_track": f"{broad * (0.35 + 0.5 * a):.2f} mm",
        "rails": f"{{from: {0.12 * width:.2f} mm, to: {width * (0.3 + 0.25 * a):.2f} mm}}",
        "wiper": f"{high * (1.05 + 0.5 * a):.2f} mm",
        "hold_down": f"{high * (1.1 + 0.5 * a):.2f} mm",
        "slot": f"{{from: {0.15 * width:.2f} mm, to: {width * (0.25 + 0.3 * a):.2f} mm}}",
        "canyon": f"{width * (0.1 + 0.3 * a):.2f} mm",
        "jet": f"{{nozzle: {1.0 + 1.5 * a:.2f} mm, pressure: 0.2 bar, height: {2.0 + 4.0 * b:.2f} mm}}",
        "step": f"{2.0 + 4.0 * a:.2f} mm",
        "tip": f"{broad * (0.3 + 0.4 * a):.2f} mm",
        "bank": f"{20.0 * a:.1f} deg",
        "groove": f"{{angle: {12.0 + 46.0 * c:.1f} deg}}",
        "separation": f"{{climb: {4.0 * a - 3.0:.2f} deg}}",
    }


def drawn(seed, ridden=False):
    """A bowl drawn by a seed: its part, its bowl file as read, and its plan."""
    rng = np.random.default_rng((27, seed))
    part = trial_parts.drawn(seed)
    size = np.sort(np.ptp(np.asarray(part.vertices), axis=0))[::-1] / MM
    radius = rng.uniform(max(60.0, 3.5 * size[0]), 190.0)
    width = min(rng.uniform(0.8, 1.4) * size[0], 0.45 * radius)
    shape = str(rng.choice(["cylinder", "stepped", "conical"], p=[0.5, 0.35, 0.15]))
    made_of = str(rng.choice(MATERIAL_NAMES))
    chain = _chain(rng, size, width, ridden) if shape != "conical" else []
    hanging = size[0] if any("rails" in one for one in chain) else 0.0
    climb = rng.uniform(2.5, 5.0)
    if shape == "stepped":
        rise = size[0] + 10.0 + 1.05 * (width + 1.0) + 12.0 + hanging
        climb = np.degrees(np.arctan(rise / (2.0 * np.pi * radius))) * rng.uniform(1.0, 1.4)
    bank = 4.0 if ridden else float(rng.choice([0.0, rng.uniform(0.0, 12.0)]))
    own = [f"track.radius={radius:.3f} mm", f"track.width={width:.3f} mm", f"track.climb={climb:.3f} deg",
           f"track.bank={bank:.2f} deg"]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bowl.yaml"
        path.write_text("devices:" + ("".join(f"\n  - {one}" for one in chain) or " []") + "\n")
        bowl = bowls.read(path, [*DRIVE, *own])
    asked = SolidOptions(
        shape=shape, left=bool(rng.integers(2)), outlet_angle=float(rng.uniform(0.0, 6.2)),
        material=made_of, drains=int(rng.integers(0, 7)), drain=1.5e-3, bolts=int(rng.integers(3, 7)),
        bolt=6e-3,
    )  # fmt: skip
    text = f"{part.name} {made_of} {shape} R{radius:.0f} w{width:.1f} climb {climb:.1f} bank {bank:.1f}"
    return SimpleNamespace(part=part, bowl=bowl, asked=asked, turns=rng.uniform(1.1, 1.9), rng=rng,
                           text=f"{text} {'left ' * asked.left}{'; '.join(chain)}")  # fmt: skip


def _chain(rng, size, width, ridden):
    lines = devices(rng, size, width)
    kinds = list(RIDDEN if ridden else lines)
    some = [str(one) for one in rng.choice(kinds, size=int(rng.integers(1, 4)), replace=False)]
    some.sort(key=lambda one: one == "rails")  # what hangs stays so
    return [f"{one}: {lines[one]}" for one in some]


def made(one):
    """The solid of a drawn bowl, its orientations, and the bowl with the bank of its entry."""
    every = orientations(one.part, find(one.part), one.bowl.track)
    tooled = lay_out(one.bowl.track, one.bowl.devices, every) if one.bowl.devices else None
    track = one.bowl.track if tooled is None else tooled.track
    depth = one.turns * 2.0 * np.pi * track.radius * np.tan(track.climb)
    size = SimpleNamespace(diameter=2.0 * track.radius, depth=depth)
    planned = plan(size, track, material(one.asked.material, one.bowl.sizing), tooled, one.asked,
                   extents=np.ptp(np.asarray(one.part.vertices), axis=0))  # fmt: skip
    return body(planned), every


def faults(one, solid, every):
    """What is wrong with a solid, a list of str; and its figures, a dict."""
    found, seen, planned = [], {}, solid.plan
    seen["volume"], open_sides = _closed(solid)
    seen["bodies"] = len(facets.placed(solid).decompose())
    found += [f"{open_sides} open sides"] * (open_sides > 0) + ["not one body"] * (seen["bodies"] != 1)
    found += ["another volume told"] * (abs(seen["volume"] / solid.volume - 1.0) > 1e-6)
    seen["falls"] = ways_down(solid)
    whole = facets.unplaced(solid)
    last = planned.first if planned.stretch is not None else planned.way.end
    low = max(0.05, float(planned.way.rises(planned.width)) + 0.05)
    s = one.rng.uniform(min(low, 0.5 * last), last, PLACES)
    y = one.rng.uniform(3e-4, planned.width - 3e-4, PLACES)
    heights = [measuring.track_heights(planned, whole, *at) for at in zip(s, y)]
    off = np.abs(np.array(heights, float) - planned.way.height(s, y))
    wide = s[planned.way.angle(s) > planned.way.angle(0.0) + 0.4]
    widths = np.array([measuring.track_width(planned, whole, at) for at in wide]) - planned.width
    seen["height_mm"], seen["width_mm"] = (1e3 * np.abs(x).max(initial=0.0) for x in (off, widths))
    found += [f"{key} {seen[key]:.3f}" for key in ("height_mm", "width_mm") if not seen[key] <= NEAR / MM]
    seen["foot_mm"], seen["side_mm"], into = _laid(one, planned, whole, every, low, last)
    found += [f"a part {into:.3f} mm in the bowl"] * (into > 0.06)
    found += [f"a foot {seen['foot_mm']:.3f}"] * (not seen["foot_mm"] <= NEAR / MM)
    lifted = 1e3 * LIFT * float(riding.leaning(planned, np.array(0.0)))  # a cone is wider there
    found += [f"a side {seen['side_mm']:.3f}"] * (not seen["side_mm"] <= 0.1 + lifted)
    again = made(one)[0]
    same = solid_files.bowl_stl(again) == solid_files.bowl_stl(solid)
    same &= solid_files.bowl_3mf(again, "bowl") == solid_files.bowl_3mf(solid, "bowl")
    return found + ["other bytes the second time"] * (not same), seen


def _closed(solid):
    """Volume [m3] of the surface as its STL has it, and the sides of facets that no other facet has."""
    corners = (solid.vertices / MM).astype(np.float32)
    _, place = np.unique(corners, axis=0, return_inverse=True)
    faces = place.reshape(-1)[solid.faces]
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ways, often = np.unique(sides, axis=0, return_counts=True)
    open_sides = len(set(map(tuple, ways)) ^ set(map(tuple, ways[:, ::-1]))) + int((often > 1).sum())
    a, b, c = np.moveaxis(corners.astype(float)[solid.faces], 1, 0)
    return float((a * np.cross(b, c)).sum()) / 6.0 * MM**3, open_sides


def _laid(one, planned, whole, every, low, last):
    """Of parts laid on the mesh: the highest foot, the farthest side, and how deep anything is in it [mm]."""
    own = np.asarray(one.part.vertices) - one.part.centre_of_mass
    fitting = [x for x in every if x.distance + 0.5 * x.width < planned.width] or every[:1]
    feet, sides, into = [], [], []
    if planned.stairs is None:  # not below the turn above, or where the outlet leaves the wall open
        low = max(low, float(planned.way.at(-2.0 * np.pi)) + planned.outlet + 0.02)
    for k, s in enumerate(one.rng.uniform(min(low, 0.9 * last), last - 0.015, LAID)):
        lying = fitting[k % len(fitting)]
        points = facets.as_planned(planned, riding.place_rider(planned, lying, own, s))
        near = points[_lowest(planned, lying, points, s)]
        gaps = [_gap(planned, whole, at) for at in near]
        feet.append(min((abs(x) for x in gaps if x is not None), default=np.inf))
        into += [-x for x in gaps if x is not None]
        sides.append(min(_to_wall(whole, at) for at in points))
    return 1e3 * max(feet), 1e3 * max(np.abs(sides)), 1e3 * max([*into, 0.0])


def _lowest(planned, lying, points, s):
    """Which corners of a part touch the track."""
    _, _, up = riding.frame(planned, s, lying.distance)
    over = (points * up).sum(axis=1)
    return over < over.min() + 2e-5


def _gap(planned, whole, at):
    """How far a corner lies over the mesh [m]; None beyond the free edge."""
    inward = at * [0.9995, 0.9995, 1.0]  # not into the wall
    met = facets.below(whole, inward + [0.0, 0.0, 2e-3])
    return None if met is None or inward[2] - met > 1e-3 else float(inward[2] - met)


def _to_wall(whole, at):
    """How far outwards from a corner the wall is [m]; it lies within where the distance is negative."""
    out = at[:2] / np.hypot(*at[:2])
    start = at - [*(ASIDE * out), -LIFT]  # not along the track
    met = facets.first_met(whole, start, start + 0.5 * np.array([*out, 0.0]))
    return met[0] - ASIDE if met else np.inf


def sliced(solid):
    """What a slicer says against the STL and the 3MF of a bowl, a list of str."""
    found, program = [], shutil.which("prusa-slicer")
    with tempfile.TemporaryDirectory() as folder:
        for name, data in {
            "b.stl": solid_files.bowl_stl(solid),
            "b.3mf": solid_files.bowl_3mf(solid, "b"),
        }.items():
            (Path(folder) / name).write_bytes(data)
            told = subprocess.run([program, "--info", name], cwd=folder, capture_output=True, text=True)
            found += [f"{name} is not manifold"] * ("manifold = yes" not in told.stdout)
            call = [program, "--export-gcode", *COARSE, "-o", "b.gcode", name]
            done = subprocess.run(call, cwd=folder, capture_output=True, text=True)
            told = (done.stdout + done.stderr).lower()
            found += [f"{name}: {told.splitlines()[-1:]}"] * (done.returncode != 0 or "repair" in told)
    return found


def rides(one):
    """How parts end on the analytic track and on the mesh, one a row: orientation, fate, fate."""
    solid, every = made(one)
    bowl = one.bowl
    found, stations = on_mesh.ridden(solid, bowl, every)
    rows = tuple(range(min(3, len(every))))
    longest = max(x.length for x in every)
    tooled = 0.0 if solid.plan.stretch is None else solid.plan.stretch.length
    course.RUN_UP = max(np.pi * bowl.track.radius - tooled, longest) / longest  # half a turn in all
    seen = [
        course.course(one.part, own, every, course.SentParts(rows, len(rows)), some, run=RunSettings(3))
        for own, some in ((bowl, bowl.devices), (found, stations))
    ]
    names = [course.FATES[fate] for fate in seen[0].fates], [course.FATES[fate] for fate in seen[1].fates]
    return list(zip([every[k].name for k in rows], *names, seen[0].end_stations, seen[1].end_stations))


def main():
    first, _, last = sys.argv[1].partition("-")
    what, good, refused, bad, alike, most = sys.argv[2:], 0, 0, 0, [], {}
    for seed in range(int(first), int(last or first) + 1):
        try:
            one = drawn(seed, ridden="rides" in what)
            print(seed, one.text, flush=True)
            if "rides" in what:
                ends = rides(one)
                alike += [a == b and c == d for _, a, b, c, d in ends]
                print("   ", "; ".join(f"{n} {a} {b} {c} {d}" for n, a, b, c, d in ends), flush=True)
                continue
            solid, every = made(one)
            wrong, seen = faults(one, solid, every)
            wrong += sliced(solid) if "slice" in what else []
            good, bad = good + (not wrong), bad + bool(wrong)
            for key in (k for k in seen if k.endswith("_mm")):
                most[key] = max(most.get(key, 0.0), seen[key])
            figures = " ".join(f"{k} {v:.4f}" for k, v in seen.items() if k.endswith("_mm"))
            print("   ", "; ".join(wrong) or "good", figures, seen["falls"] or "", flush=True)
        except FeederError as line:
            refused += 1
            print("    refused:", line, flush=True)
    print(f"rides alike {sum(alike)} of {len(alike)}" if alike else f"good {good}, bad {bad}", end="")
    print(f"; refused {refused};", ", ".join(f"{k} {v:.4f}" for k, v in most.items()))


if __name__ == "__main__":
    main()
