"""A part, a bowl file and the options of a command, damaged at once: faults that hide behind each other."""

from fuzz.mutate import mutated, pick

PARTS = (
    "parts/lbracket_30x20x15.stl", "parts/squarenut_m5.stl", "parts/dowel_6x20.stl",
    "parts/magnet.yaml", "parts/arc_chute.yaml",
)  # fmt: skip
BOWLS = ("configs/bowl.yaml", "configs/thesis.yaml")
DEVICES = b"""devices:
  - wiper: 6 mm
  - gap: 3 mm
  - slot: {from: 2 mm, to: 5 mm}
  - cut_out: [[0 mm, 0 mm], [4 mm, 0 mm], [4 mm, 3 mm]]
  - profile: {of: A@0, play: 0.2 mm}
  - yield: {A: 0.5}
machine: {leaves: 10, leaf_thickness: 2.5 mm}
sizing: {least_diameter: 250 mm}
"""
ODD = tuple("nan inf -1 0 1e308 1e-308 -0.0".split()) + (
    "", "x", "1e999", "5 furlong", "\u0663", "A" * 300, "--",
)  # fmt: skip
KEYS = (
    "drive.amplitude", "drive.peak_to_peak", "drive.frequency", "drive.vibration_angle", "drive.phase",
    "drive.direction", "drive.second_harmonic", "friction.static", "friction.kinetic", "friction.wall",
    "restitution", "gravity", "track.climb", "track.bank", "track.radius", "track.width",
    "machine.leaves", "machine.damping", "machine.supply", "sizing.packing", "sizing.slowest", "no.key",
)  # fmt: skip
VALUES = ("0.3 mm", "60 Hz", "25 deg", "0", "0.4", "9.81 m/s2", "150 mm", "1e-9 mm", "89.9 deg", "10 m", *ODD)
OF_A_PART = {
    "--density": ("steel", "7.85 g/cm3", "1e-9 g/cm3", *ODD), "--units": ("mm", "in", "m", *ODD),
    "--centre-of-mass": ("0,0,0", "1,2,3", "1e9,0,0", "a,b,c", *ODD),
}  # fmt: skip
CHAIN = {
    "--heading": ("0deg", "90", "3 rad", *ODD), "--gap": ("2 mm", "0 mm", *ODD), "--fill": ("0.5", "2", *ODD),
    "--rule": ("pmi", "recommended", "guess", *ODD),
}  # fmt: skip
ASPECTS = ("A", "B", "1", "ZZ", "", "a")
AT = {"--heading": CHAIN["--heading"]}
COMMANDS = {  # what each is called with, and the options it knows
    "aspects": ("PART --no-pictures", OF_A_PART),
    "inertia": ("PART", OF_A_PART),
    "headings": ("PART BOWL --no-pictures", OF_A_PART),
    "rate": ("PART ASPECT BOWL", OF_A_PART | CHAIN),
    "floor": ("PART BOWL --no-pictures", OF_A_PART | AT),
    "track": ("PART BOWL --no-pictures", OF_A_PART | AT),
    "convey": ("BOWL --no-pictures", {}),
    "slide": ("BOWL --no-pictures", {"--beta": ("20", "90 deg", "1e-300", *ODD)}),
    "bowl": ("BOWL --no-pictures", {}),
    "config show": ("BOWL", {}),  # it writes no folder
}
SHARE = 0.5  # of the files that are damaged, and of the options that are given


def job(root, rng):
    """The files (bytes by name) and the arguments of one call; seeds are read below the root."""
    command = pick(list(COMMANDS), rng)
    words, options = COMMANDS[command]
    part, bowl = pick(PARTS, rng), pick(BOWLS, rng)
    name = "part" + part[part.rindex(".") :]
    files = {name: _damaged(root, part, b"", rng), "bowl.yaml": _damaged(root, bowl, DEVICES, rng)}
    arguments = command.split()
    for word in words.split():
        typed = {"PART": [name], "BOWL": ["--config", "bowl.yaml", *_set(rng)]}
        typed["ASPECT"] = ["--aspect", pick(ASPECTS, rng)]
        arguments += typed.get(word, [word])
    for option, values in options.items():
        arguments += [option, pick(values, rng)] if rng.random() < SHARE * SHARE else []
    return files, arguments + ([] if command == "config show" else ["-o", "out"])


def _damaged(root, seed, more, rng):
    data = (root / seed).read_bytes()
    data += more if rng.random() < SHARE else b""
    return mutated(data, data[::-1], rng) if rng.random() < SHARE else data


def _set(rng):
    """Some values set on the command line."""
    count = int(rng.integers(3))
    return [text for _ in range(count) for text in ("--set", f"{pick(KEYS, rng)}={pick(VALUES, rng)}")]
