"""Every key of a part card: one table for reading, checking and hints."""

from dataclasses import dataclass


@dataclass(frozen=True)
class CardKey:
    """One key of a part card."""

    word: str
    dimension: str  # of feederscrew.units, or 'text', 'section', 'rows'
    example: str
    required: bool = False
    shape: tuple[int, ...] = ()  # of a list; () for one value
    positive: bool = True
    choices: tuple[str, ...] = ()  # of a text; any text where it is empty


MATRIX = "three rows of three, as in [95.3 g mm2, 0 g mm2, -24.5 g mm2]"

AXES = ("tilted", "level")  # by the bank of the track, or not: of the printed track equations

CARD = (
    CardKey("mass", "mass", "1.98 g", required=True),
    CardKey("centre_of_mass", "length", "[3.3 mm, 0 mm, 9 mm]", required=True, shape=(3,), positive=False),
    CardKey("inertia", "inertia", MATRIX, required=True, shape=(3, 3), positive=False),
    CardKey("aspects", "rows", "- {aspect: 1, height: 6.9 mm}", required=True),
    CardKey("floor", "section", "{aspect: 1, drive_offset: 3.2 mm}"),
    CardKey("track", "section", "{wall_lever: 8 mm, wall_lever_angle: 64 deg}"),
)
ASPECT = (
    CardKey("aspect", "text", "1", required=True),
    CardKey("height", "length", "6.9 mm", required=True),
    CardKey("faces", "number", "2"),
    CardKey("polar_inertia", "inertia", "90.8 g mm2"),
    CardKey("contact_area", "area", "100 mm2"),
    CardKey("solid_angle", "solid angle", "1.8 sr"),
    CardKey("csa_height", "length", "10.1 mm"),
    CardKey("stability_height", "length", "10.1 mm"),
)
FLOOR = (
    CardKey("aspect", "text", "5"),
    CardKey("drive_offset", "length", "3.2 mm", positive=False),
    CardKey("centroid_height", "length", "3.3 mm"),
    CardKey("polar_inertia", "inertia", "95.3 g mm2"),
)
TRACK = (
    *FLOOR,
    CardKey("wall_lever", "length", "8 mm"),
    CardKey("wall_lever_angle", "angle", "64 deg"),
    CardKey("wall_x", "length", "[6.7 mm, 9 mm]", shape=(2,)),
    CardKey("wall_y", "length", "4 mm"),
    CardKey("wall_friction_y", "length", "4 mm"),
    CardKey("axes", "text", "tilted", choices=AXES),
)
