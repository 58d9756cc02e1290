"""Keys of the bowl as a solid: what its track, its drive and its maker need beside the sizes."""

from feederscrew.bowl.key import Key


def _choice(name: str, choices: tuple[str, ...], meaning: str) -> Key:
    return Key(name, f"sizing.{name.rpartition('.')[2]}", "choice", choices[0], choices[-1], choices[0],
               meaning, choices=choices)  # fmt: skip


def _length(name: str, lowest: str, highest: str, default: str, meaning: str) -> Key:
    return Key(name, f"sizing.{name.rpartition('.')[2]}", "length", lowest, highest, default, meaning)


def _count(name: str, lowest: str, highest: str, default: str, meaning: str) -> Key:
    return Key(name, f"sizing.{name.rpartition('.')[2]}", "count", lowest, highest, default, meaning)


HAND = (
    _choice(
        "track.hand", ("right", "left"),
        "of the helix: on a right-handed track parts climb counter-clockwise, seen from above; left is its "
        "mirror image",
    ),
)  # fmt: skip
DRIVE_MOUNT_KEYS = (
    _count("machine.bolts", "0", "100", "6", "that hold the bowl on its drive, beside the one in the middle"),
    _length("machine.bolt_hole", "1 mm", "100 mm", "9 mm", "diameter of the holes of these bolts"),
    _length(
        "machine.bolt_circle", "5 mm", "3000 mm", "120 mm",
        "diameter of the circle that they stand on; left out, a solid has them at sizing.bolt_share",
    ),
)  # fmt: skip
SUPPLY = (
    _choice(
        "machine.mains", ("50 Hz", "60 Hz"),
        "of the place where the bowl is to run: a drive makes the mains frequency (half wave) or twice it "
        "(full wave)",
    ),
    Key(
        "machine.controller", "sizing.control", "choice", "mains", "frequency", "mains",
        "what drives the magnets: 'mains', or a 'frequency' controller, which makes any frequency from 30 to "
        "140 Hz", choices=("mains", "frequency"),
    ),
)  # fmt: skip
SOLID_KEYS = (
    Key(
        "sizing.bolt_share", "sizing.bolt_share", "number", "0.05", "0.9", "0.4",
        "circle of the bolts below the bowl, over its diameter (assumption)",
    ),
    _choice(
        "sizing.shape", ("cylinder", "stepped", "conical"),
        "of the wall; where it steps outwards with the track each turn lies beside the one before, and not "
        "above it",
    ),
    _length(
        "sizing.outlet_height", "0 mm", "3000 mm", "0 mm",
        "of the outlet's surface over the floor's edge; 0: where the turns of the track end",
    ),
    Key(
        "sizing.outlet_angle", "sizing.outlet_angle", "angle", "-360 deg", "360 deg", "0 deg",
        "where the outlet leaves the wall, seen from above, from the X axis counter-clockwise",
    ),
    _count("sizing.drains", "0", "500", "0", "holes at the edge of the floor through which dust leaves"),
    _length("sizing.drain_hole", "0.2 mm", "100 mm", "4 mm", "diameter of these holes"),
)  # fmt: skip
