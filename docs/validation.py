"""Bring docs/validation.md and its page in docs/method up to date: every measured set, ours beside it.

Example: python docs/validation.py          (writes both pages: half a minute)
         python docs/validation.py --check  (status 1 if a table of QUICK is out of date)
"""

import csv
import sys
import tempfile
from pathlib import Path

import generated
import numpy as np

from feederscrew.arrivals.aspects_study import aspects
from feederscrew.arrivals.drop import SURE_SHARE, follow
from feederscrew.arrivals.ensemble import wilson
from feederscrew.arrivals.toss_runs import FACE_NAMES
from feederscrew.feeding.compare import compare_sets
from feederscrew.part import load

PAGE = Path(__file__).resolve().parent / "validation.md"
METHOD = PAGE.parent / "method/validation.md"
MEASURED = PAGE.parent / "measured"
SETS = {"cuboids": "cuboid_*", "cubes": "short_cube", "coin": "coin*", "t shape": "t_shape"}
CARDS = {"magnet": "magnet", "arc chute": "arc_chute"}
RULES = ("CSA", "STABILITY", "PMI")
SIDE, MASS = 104.8, 0.37  # [mm], [kg] of the filmed cube
CUBE = {"friction": "0.18", "restitution": "0.125"}  # as its authors give them
AMBIENT, GAMMA = 1.013, 1.4  # [bar], [1] of air
DROPS = 6000  # of each cuboid that was held out
QUICK = ("magnet", "arc chute", "air jet")


def percent(share, digits=1):
    """Return a share for people."""
    return f"{100.0 * share:.{digits}f}"


def table(head, rows):
    """Return a Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(map(str, cells))} |\n" for cells in lines)


def shares(pattern):
    """Return the measured shares of meshes, the recommended answer beside each."""
    rows, head = (
        [],
        ["set", "parts", "aspect", "measured [%]", "ours [%]", "interval [%]", "error [points]", "CSA [%]"],
    )
    for one in compare_sets(sorted(MEASURED.glob(f"{pattern}.csv"))).sets:
        measured, ours = one.profile.fractions, one.recommended
        csa = one.answers["CSA"].fractions
        counted = int(one.profile.values.sum()) if one.profile.kind == "counts" else ""
        names = one.measured.names if hasattr(one.measured, "names") else one.aspects.names
        for k, name in enumerate(names[:1] if len(names) == 2 else names):  # of two the other has the rest
            ends = f"{percent(max(ours.low[k], 0.0))} to {percent(min(ours.high[k], 1.0))}"
            held = "" if ours.low[k] <= measured[k] <= ours.high[k] else " (outside)"
            rows.append([
                Path(one.measured.source).stem if k == 0 else "", counted if k == 0 else "", name,
                percent(measured[k]), percent(ours.p[k]), ends + held,
                f"{100.0 * (ours.p[k] - measured[k]):+.1f}", percent(csa[k] / csa.sum()),
            ])  # fmt: skip
    return table(head, rows)


def held_out():
    """Return the measured shares of the cuboids that nothing was chosen on, a drop test beside each."""
    from trimesh import creation

    with (MEASURED / "held_out/cuboids.csv").open() as file:
        found = list(csv.DictReader(line for line in file if not line.startswith("#")))
    rows = []
    for row in found:
        x, measured = float(row["x_over_y"]), float(row["p_square"])
        with tempfile.TemporaryDirectory() as folder:
            creation.box((10.0 * x, 10.0, 10.0)).export(f"{folder}/cuboid.stl")
            known = aspects(load(f"{folder}/cuboid.stl"), launch="roll", drops=DROPS).aspects
        k, ours = int(np.abs(known.heights - 0.005 * x).argmin()), known.recommended
        ends = f"{percent(max(ours.low[k], 0.0))} to {percent(min(ours.high[k], 1.0))}"
        rows.append([row["x_over_y"], row["n"], percent(measured), percent(ours.p[k]), ends,
                     f"{100.0 * (ours.p[k] - measured):+.1f}"])  # fmt: skip
    head = ["x/y", "tosses", "measured [%]", "ours [%]", "interval [%]", "error [points]"]
    return table(head, rows)


def cards(pattern):
    """Return the measured shares of published cards, the rules of the thesis beside each."""
    sets = compare_sets([MEASURED / f"{pattern}.csv"]).sets
    rules = [rule for rule in RULES if rule in sets[0].answers]
    rows = []
    for k, name in enumerate(sets[0].aspects.names):
        ours = [one / one.sum() for one in (sets[0].answers[rule].fractions for rule in rules)]
        rows.append(
            [name, *(percent(one.profile.fractions[k]) for one in sets), *(percent(own[k]) for own in ours)]
        )
    apart = [np.mean([one.distances[rule] for one in sets]) for rule in rules]
    rows.append(["total variation, mean", *[""] * len(sets), *(f"{value:.3f}" for value in apart)])
    head = [
        "aspect",
        *(f"measured, {one.profile.name} [%]" for one in sets),
        *(f"{rule} [%]" for rule in rules),
    ]
    return table(head, rows)


def tosses():
    """Return how our answers agree with the filmed tosses."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        from trimesh import creation

        creation.box((SIDE,) * 3).export(f"{folder}/cube.stl")
        cube = load(f"{folder}/cube.stl", density=f"{MASS / (1e-3 * SIDE) ** 3:.1f} kg/m3")
    for name, runs in (("one run of each toss", 1), ("64 runs of each toss", 64)):
        study = follow(cube, MEASURED / "filmed/cube_tosses.csv", CUBE, runs=runs)
        found = study.agreement
        rows.append([
            name, f"{percent(found.right_share)} ({percent(found.low)} to {percent(found.high)})",
            percent(found.at_release), f"{1e3 * found.median_off:.1f}",
            f"{1e3 * np.percentile(study.off, 75):.1f}",
            *([percent(found.expected), f"{found.sure}: {percent(found.sure_right_share)}"] if runs > 1
              else "  "),
        ])  # fmt: skip
    rows.append(["of these, those no width was chosen on", *judged(study)])
    head = ["ours", "upper side as measured [%]", "nearest at release [%]", "median distance [mm]",
            "three quarters within [mm]", "mean p [%]", "p of at least 0.95: right [%]"]  # fmt: skip
    return table(head, rows)


def judged(study):
    """Return what the other half of the tosses says, of which MODEL_DOUBT knows nothing."""
    half = slice(1, None, 2)
    measured = np.array([FACE_NAMES.index(face) for face in study.launches.faces])
    right, p, off = (study.result.faces == measured)[half], study.p[half], 1e3 * study.off[half]
    (low, high), sure = wilson(right.sum(), len(right)), p >= SURE_SHARE
    return [
        f"{percent(right.mean())} ({percent(low)} to {percent(high)})",
        percent((study.result.released == measured)[half].mean()),
        *(f"{np.percentile(off, share):.1f}" for share in (50, 75)),
        percent(p.mean()), f"{sure.sum()}: {percent(right[sure].mean())}",
    ]  # fmt: skip


def air_jet():
    """Return the measured force over that at 2 bar, the thrust of an ideal nozzle beside it."""
    with (MEASURED / "filmed/air_jet.csv").open() as file:
        found = list(csv.DictReader(line for line in file if not line.startswith("#")))
    middle = next(row for row in found if float(row["target_bar"]) == 2.0)
    unit, own = float(middle["force_plateau_N"]), thrust(float(middle["before_valve_bar"]))
    rows = []
    for row in found:
        force, pressure = float(row["force_plateau_N"]), float(row["before_valve_bar"])
        ours = thrust(pressure) / own * unit
        rows.append([row["target_bar"], row["before_valve_bar"], f"{force:.3f}", f"{ours:.3f}",
                     f"{100.0 * (ours / force - 1.0):+.1f}"])  # fmt: skip
    head = [
        "pressure set [bar]",
        "before the valve [bar]",
        "measured [N]",
        "ideal nozzle, set equal at 2.0 bar [N]",
        "error [%]",
    ]
    return table(head, rows)


def thrust(gauge):
    """Return the thrust of an ideal nozzle over its area [bar], from the gauge pressure [bar] before it."""
    ratio = AMBIENT / (AMBIENT + gauge)
    if 1.0 / ratio > 1.89:  # choked
        return 1.268 * (AMBIENT + gauge) - AMBIENT
    return 2.0 * (AMBIENT + gauge) * GAMMA / (GAMMA - 1.0) * (ratio ** (1.0 / GAMMA) - ratio)


def made(name):
    """Return one table of the page by its name."""
    if name in SETS:
        return shares(SETS[name])
    if name in CARDS:
        return cards(CARDS[name])
    return {"held out": held_out, "tosses": tosses, "air jet": air_jet}[name]()


def filled(text, names):
    """Return the page with some tables as they are now."""
    for name in names:
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        before, _, rest = text.partition(begin)
        text = before + begin + made(name) + end + rest.partition(end)[2]
    return text


def main():
    """Write or check; the exit status."""
    check, status = generated.is_checking(__doc__), 0
    whole = {PAGE: (*SETS, "held out", *CARDS, "tosses"), METHOD: ("air jet",)}
    for page, names in whole.items():
        old = page.read_text(encoding="utf-8")
        new = filled(old, [name for name in names if not check or name in QUICK])
        status = max(status, generated.bring_up(page, new, check))
    return status


if __name__ == "__main__":
    sys.exit(main())
