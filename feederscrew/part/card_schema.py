"""Every key of a part card: one table for reading, checking and hints."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Key:
    """One key of a part card."""

    word: str
    dimension: str  # of feederscrew.units, or 'text', 'section', 'rows'
    example: str
    required: bool = False
    shape: tuple[int, ...] = ()  # of a list; () for one value
    positive: bool = True


MATRIX = "three rows of three, as in [95.3 g mm2, 0 g mm2, -24.5 g mm2]"

CARD = (
    Key("mass", "mass", "1.98 g", required=True),
    Key("centre_of_mass", "length", "[3.3 mm, 0 mm, 9 mm]", required=True, shape=(3,), positive=False),
    Key("inertia", "inertia", MATRIX, required=True, shape=(3, 3), positive=False),
    Key("aspects", "rows", "- {aspect: 1, height: 6.9 mm}", required=True),
    Key("floor", "section", "{aspect: 1, drive_offset: 3.2 mm}"),
    Key("track", "section", "{wall_lever: 8 mm, wall_lever_angle: 64 deg}"),
)
ASPECT = (
    Key("aspect", "text", "1", required=True),
    Key("height", "length", "6.9 mm", required=True),
    Key("faces", "number", "2"),
    Key("polar_inertia", "inertia", "90.8 g mm2"),
    Key("contact_area", "area", "100 mm2"),
    Key("solid_angle", "solid angle", "1.8 sr"),
    Key("csa_height", "length", "10.1 mm"),
    Key("stability_height", "length", "10.1 mm"),
)
FLOOR = (
    Key("aspect", "text", "5"),
    Key("drive_offset", "length", "3.2 mm", positive=False),
    Key("centroid_height", "length", "3.3 mm"),
    Key("polar_inertia", "inertia", "95.3 g mm2"),
)
TRACK = (
    *FLOOR,
    Key("wall_lever", "length", "8 mm"),
    Key("wall_lever_angle", "angle", "64 deg"),
    Key("wall_x", "length", "[6.7 mm, 9 mm]", shape=(2,)),
    Key("wall_y", "length", "4 mm"),
    Key("wall_friction_y", "length", "4 mm"),
)
