"""What the spread of restitution does to the answers of the commands: a table of docs/method/validation.md.

Example: python benchmarks/restitution.py --write    (ten minutes of one core)

Each command runs at the bowl's restitution of 0.2 and at both ends of the even range round it whose standard
deviation is that of filmed impacts. All else is as the bowl's defaults, but for what a row names.
"""

import json
import subprocess
import sys
from pathlib import Path

from feederscrew.motion.conveying import even_range

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/method/validation.md"
HERE = 0.2
BRACKET, BOLT = "parts/lbracket_30x20x15.stl", "parts/hexbolt_m8x25.stl"
THROWN = "--set drive.amplitude=0.3mm --set drive.frequency=60Hz"
TOOLED = "--config docs/measured/example/bowl.yaml"
HARDER = "--set drive.peak_to_peak=0.6mm --set drive.frequency=60Hz"
FEW = "--rule quasistatic --parts 36"
ROW = "--rule quasistatic --parts 1 --queue 6 --seconds 15"


def answers(line):
    """Return the documents of a command at the low end, as the bowl is, and at the high end."""
    low, high = even_range(HERE)
    program = Path(sys.executable).parent / "feeder"
    for value in (low, HERE, high):
        call = [program, *line.split(), "--set", f"restitution={value:.6g}", "--format", "json"]
        yield json.loads(subprocess.run(call, capture_output=True, text=True, check=True, cwd=ROOT).stdout)


def velocity(found):
    speeds = ", ".join(f"{one['velocity_mm_s']:.3g}" for one in found)
    periods = ", ".join(str(one["period"]) for one in found)
    return f"{speeds} mm/s; the motion repeats after {periods} strokes"


def plate(found):
    """Return shares of the most frequent aspect on the plate, and velocities."""
    plates = [one["plates"][0] for one in found]
    first = max(plates[1]["aspects"], key=lambda row: row["p_plate"])["aspect"]
    rows = [next(row for row in one["aspects"] if row["aspect"] == first) for one in plates]
    shares = ", ".join(f"{100 * row['p_plate']:.1f}" for row in rows)
    speeds = ", ".join(f"{one['velocity_mm_s']:.1f}" for one in plates)
    ends = f"{100 * rows[1]['p_plate_low']:.0f} to {100 * rows[1]['p_plate_high']:.0f}"
    return f"{first} {shares} %, of which the middle one may be {ends}; {speeds} mm/s"


def rate(found):
    rates = ", ".join(f"{one['parts_per_minute']:.3g}" for one in found)
    ends = " to ".join(f"{found[1][f'parts_per_minute_{end}']:.3g}" for end in ("low", "high"))
    return f"{rates} a minute; the interval is {ends}"


def trial(found):
    speeds = ", ".join(f"{one['velocity_mm_s']:.4g}" for one in found)
    fates = ("passed", "turned", "returned", "hanging", "stopped", "rolled_back", "stuck")
    ended = [
        {(row["aspect"], row["heading_deg"]): [row[fate] for fate in fates] for row in one["orientations"]}
        for one in found
    ]
    other = [sum(rows[name] != ended[1][name] for name in rows) for rows in ended]
    ends = f"{other[0]} and {other[2]} of {len(found[1]['orientations'])} orientations end otherwise"
    return f"{speeds} mm/s; {ends}"


def queue(found):
    """Return what a queue delivers, and how fast its parts travel."""
    speeds = ", ".join(f"{one['queue']['velocity_mm_s']:.3g}" for one in found)
    counts = ", ".join(f"{one['queue']['delivered']:.0f}" for one in found)
    return f"{speeds} mm/s; {counts} parts leave in {found[1]['queue']['counted_seconds']:.0f} s"


ROWS = (
    ("`feeder convey`, throw number 1.23", THROWN.replace("0.3", "0.2"), velocity),
    ("`feeder convey`, throw number 1.84", THROWN, velocity),
    ("`feeder convey`, throw number 2.45", THROWN.replace("0.3", "0.4"), velocity),
    ("`feeder drop --plate`, throw number 0.89, bracket", f"{BRACKET} --drops 200", plate),
    ("the same, bolt", f"{BOLT} --drops 200", plate),
    ("`feeder rate`, throw number 0.89, bracket", f"{BRACKET} --aspect A", rate),
    ("the same, bolt", f"{BOLT} --aspect A", rate),
    ("`feeder rate`, throw number 1.84, bracket", f"{BRACKET} --aspect A {THROWN}", rate),
    ("`feeder trial`, throw number 0.64, bracket", f"{BRACKET} {TOOLED} {FEW}", trial),
    ("`feeder trial`, throw number 1.84, bracket", f"{BRACKET} {TOOLED} {HARDER} {FEW}", trial),
    ("its queue of six, no devices", f"{BRACKET} {THROWN} {ROW}", queue),
)  # fmt: skip
COMMANDS = {velocity: "convey", plate: "drop --plate", rate: "rate", trial: "trial", queue: "trial"}


def table():
    """Return the table in Markdown, a row at a time on stderr."""
    lines = ["| Where | Typed behind it | At 0.145, 0.2 and 0.255 |\n", "|---|---|---|\n"]
    for title, typed, shown in ROWS:
        command = COMMANDS[shown]
        first, *more = typed.split(" ", 1) if shown is not velocity else ("", typed)
        line = " ".join(filter(None, (command.split()[0], first, *command.split()[1:], *more)))
        lines.append(f"| {title} | `{line.partition(' ')[2]}` | {shown(list(answers(line)))} |\n")
        print(lines[-1], end="", file=sys.stderr, flush=True)
    return "".join(lines)


def main():
    made = table()
    if "--write" not in sys.argv:
        print(made)
        return
    begin, end = "<!-- restitution -->\n", "<!-- end of restitution -->"
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(begin)
    PAGE.write_text(before + begin + made + end + rest.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
