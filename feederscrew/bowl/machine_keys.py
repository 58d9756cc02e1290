"""Keys of the machine under the bowl, and of the rules of thumb by which one is sized."""

from feederscrew.bowl.key import Key


def _machine(word: str, dimension: str, lowest: str, highest: str, default: str, meaning: str) -> Key:
    return Key(f"machine.{word}", f"machine.{word}", dimension, lowest, highest, default, meaning)


def _rule(
    word: str, dimension: str, lowest: str, highest: str, default: str, meaning: str, source: str
) -> Key:
    name = f"sizing.{word}"
    return Key(name, name, dimension, lowest, highest, default, f"{meaning} ({source})")


GENERATOR = "a published bowl generator"
RNA = "RNA, operating instructions"
ASSUMED = "assumption"

MACHINE_KEYS = (
    _machine(
        "bowl_mass", "mass", "0.01 kg", "2000 kg", "6 kg",
        "all that stands on the springs: bowl, top frame, tooling; without parts",
    ),
    _machine(
        "bowl_inertia", "inertia", "0.000001 kg m2", "5000 kg m2", "0.06 kg m2",
        "moment of inertia of the same about the bowl's axis",
    ),
    _machine(
        "base_mass", "mass", "0.01 kg", "20000 kg", "25 kg",
        "all that stands below the springs, on the rubber feet; very heavy: held fast",
    ),
    _machine(
        "base_inertia", "inertia", "0.000001 kg m2", "50000 kg m2", "0.25 kg m2",
        "moment of inertia of the same about the bowl's axis",
    ),
    _machine(
        "spring_radius", "length", "5 mm", "2000 mm", "90 mm",
        "from the bowl's axis to the middle of the springs",
    ),
    _machine(
        "spring_angle", "angle", "1 deg", "89 deg", "30 deg",
        "of the motion at the springs, from the horizontal: the leaves' own tilt from the vertical",
    ),
    _machine("leaf_width", "length", "1 mm", "500 mm", "40 mm", "of one leaf"),
    _machine("leaf_thickness", "length", "0.1 mm", "30 mm", "2.5 mm", "of one leaf"),
    _machine("leaf_length", "length", "5 mm", "1000 mm", "80 mm", "free length, between the clamps"),
    _machine(
        "leaf_modulus", "stress", "1 GPa", "1000 GPa", "206 GPa",
        "modulus of elasticity: spring steel; glass-fibre leaves have 20 to 45 GPa",
    ),
    _machine("leaves", "count", "1", "500", "9", "number of leaves in all banks together"),
    _machine(
        "damping", "number", "0", "0.9", "0.01",
        "of the critical damping, of the bowl on its springs; it limits the stroke at resonance only",
    ),
    _machine(
        "supply", "supply", "10 Hz half wave", "500 Hz full wave", "50 Hz full wave",
        "mains and waves: 50 or 60 Hz, 'half wave' drives at the mains frequency, 'full wave' at twice it",
    ),
)  # fmt: skip

SIZING_KEYS = (
    _rule("least_diameter", "length", "10 mm", "5000 mm", "300 mm", "least diameter of a bowl", GENERATOR),
    _rule(
        "diameter_per_length", "number", "0", "100", "5.8",
        "diameter over the length of the part along the track", GENERATOR,
    ),
    _rule(
        "diameter_per_width", "number", "0", "100", "7.8", "diameter over the width of the track", GENERATOR,
    ),
    _rule("greatest_diameter", "length", "50 mm", "50 m", "1200 mm", "no bowl is larger", ASSUMED),
    _rule("diameter_step", "length", "0.1 mm", "500 mm", "10 mm", "diameters are rounded up to it", ASSUMED),
    _rule("least_climb", "angle", "0 deg", "45 deg", "3.5 deg", "least climb of the track", GENERATOR),
    _rule("clearance", "number", "0", "2", "4.5 %", "play of the part on its track, of its width", GENERATOR),
    _rule("least_clearance", "length", "0 mm", "100 mm", "1.2 mm", "least play", GENERATOR),
    _rule("greatest_clearance", "length", "0 mm", "100 mm", "3 mm", "greatest play", GENERATOR),
    _rule(
        "headroom", "number", "0", "10", "1.3",
        "free height below the next turn of the track, of the height of the tallest aspect", ASSUMED,
    ),
    _rule("depth", "number", "0.01", "5", "0.3", "rise of the track over the bowl's diameter", ASSUMED),
    _rule(
        "fill_height", "number", "0.01", "1", "0.3333", "height of a full bowl's fill, of its depth",
        "trade: under a third",
    ),
    _rule("packing", "number", "0.01", "1", "0.5", "volume of the parts in the volume they fill", "trade"),
    _rule(
        "carried", "number", "0", "1", "10 %", "mass of the fill that vibrates with the bowl; the rest hops",
        ASSUMED,
    ),
    _rule(
        "fill_density", "density", "0 g/cm3", "30 g/cm3", "0 g/cm3",
        "mass of a part over the volume of its convex hull, for a fill without a part; 0: steel is assumed",
        "feeder design writes it",
    ),
    _rule("hopper_interval", "time", "1 s", "1000 h", "30 min", "from one filling to the next", ASSUMED),
    _rule("controller", "number", "1 %", "1", "80 %", "setting at which the wanted rate must come", RNA),
    _rule("retune", "number", "0", "1", "15 %", "deviation of that setting from which to tune again", RNA),
    _rule(
        "least_detuning", "number", "0", "1", "3 %", "natural frequency above the drive, at least", "trade",
    ),
    _rule(
        "greatest_detuning", "number", "0", "1", "8 %", "natural frequency above the drive, at most", "trade",
    ),
    _rule(
        "greatest_acceleration", "number", "0.1", "100", "12.1",
        "acceleration over gravity that drives are built for",
        "makers' strokes: 2.0 mm at 50 Hz, 1.5 at 60, 0.6 at 100, 0.4 at 120 are 10.1 to 12.1",
    ),
    _rule("greatest_stroke", "length", "0.01 mm", "40 mm", "3 mm", "peak to peak", "Eriez: never above"),
    _rule("leaves", "count", "1", "500", "9", "usual number of leaves: three banks of three", ASSUMED),
    _rule("banks", "count", "1", "24", "3", "banks that share the leaves, as many in each", ASSUMED),
    _rule(
        "fatigue_stress", "stress", "1 MPa", "2000 MPa", "250 MPa",
        "amplitude of bending stress that a clamped leaf bears without end",
        "assumption: half of what bare spring steel bears",
    ),
    _rule(
        "half_wave_diameter", "length", "10 mm", "50 m", "450 mm",
        "bowls larger than this take the mains frequency, smaller ones twice it", ASSUMED,
    ),
    _rule(
        "spring_radius", "number", "0.05", "2", "0.6", "radius of the springs over that of the bowl", ASSUMED,
    ),
    _rule("least_spring_angle", "angle", "1 deg", "89 deg", "10 deg", "angle of the springs", ASSUMED),
    _rule("greatest_spring_angle", "angle", "1 deg", "89 deg", "30 deg", "angle of the springs", ASSUMED),
    _rule(
        "greatest_spring_radius", "number", "0.05", "2", "0.9",
        "where drive.vibration_angle is given, springs move outwards up to this share of the bowl's radius",
        ASSUMED,
    ),
    _rule(
        "steepest_spring_angle", "angle", "1 deg", "89 deg", "45 deg",
        "angle of the springs that are as far out as they go, where drive.vibration_angle is given",
        ASSUMED,
    ),
    _rule("base_mass", "number", "0.1", "1000", "4.2", "mass of the base over that of the bowl", ASSUMED),
    _rule("sheet", "length", "0.1 mm", "50 mm", "3 mm", "thickness of the bowl's sheet", ASSUMED),
    _rule("sheet_density", "density", "0.1 g/cm3", "30 g/cm3", "7.9 g/cm3", "of the bowl", "stainless steel"),
    _rule("tooling_mass", "number", "0", "10", "30 %", "tooling and frame, of the bare bowl's mass", ASSUMED),
    _rule("slowest", "velocity", "0 mm/s", "10000 mm/s", "20 mm/s", "bowls seldom run slower", "trade"),
    _rule("fastest", "velocity", "0 mm/s", "10000 mm/s", "120 mm/s", "bowls seldom run faster", "trade"),
    _rule(
        "handbook_speed", "velocity", "1 mm/s", "1000 mm/s", "25 mm/s",
        "speed behind the handbook's estimate", "F = 1500 E / l parts a minute, l in mm",
    ),
)  # fmt: skip
