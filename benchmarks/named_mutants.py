"""Changes to the physics that once stayed unnoticed, and those that have no consequence: for `mutants.py`."""

SIZING = "tests/machine/test_sizing_rules.py"
ROCKING = "tests/rates/test_rocking_noticed.py"
HOLDING = "tests/tooling/test_holding_noticed.py"
DEVICES = "tests/tooling/test_devices_noticed.py"
CONDITION = "tests/machine/test_condition.py"
STEADY = "tests/rates/test_steadiness.py -k round"
JUDGED = "tests/resting/test_judged_by_measurement.py"
SLIDES = "tests/trial/test_trial_signs.py -k 'slides and 0.2'"
STANDS = "tests/trial/test_trial_signs.py -k stand"
BRAKES = "tests/trial/test_trial_signs.py -k 'brake and 0.7'"
TURNS = "tests/trial/test_trial_signs.py -k air"
APART = "tests/trial/test_trial_queue.py -k pushed_apart"
ENTER = "tests/trial/test_trial_queue.py -k 'enter or wait'"
ROLLED = "tests/dropping/test_drop_resistance.py"
RECOMMENDED = "resting/rules/recommended.py"

NAMED = (
    ("machine/sizing.py", "* part.tallest + rules.sheet", "* part.tallest", SIZING),
    ("machine/sizing.py", "STEEP * wide + 4.0 * rules.sheet", "STEEP * wide + 3.0 * rules.sheet", SIZING),
    ("machine/sizing.py", "value / step - 1e-9", "value / step + 1e-9", SIZING),
    ("machine/throughput.py", "(length + gap)", "length", SIZING),
    ("machine/throughput.py", "(length + gap)", "(length - gap)", SIZING),
    ("machine/throughput.py", "{2e3 * amplitude", "{1e3 * amplitude", SIZING),
    ("rates/rocking.py", "(still - beside * other)", "still", ROCKING),
    ("rates/rocking.py", "(still - beside * other)", "(still + beside * other)", ROCKING),
    ("rates/rocking.py", "(still + other**2), 0.0)", "(still + beside**2), 0.0)", ROCKING),
    ("rates/rocking.py", "gains[1 if speed > 0.0 else 2]", "gains[2 if speed > 0.0 else 1]", ROCKING),
    ("rates/rocking.py", "force[:, None] * inside", "force[:, None] / inside", ROCKING),
    ("rates/rocking.py", "SENSES = (0.0, 1.0, -1.0)", "SENSES = (0.0, -1.0, 1.0)", ROCKING),
    ("rates/rocking.py", "SETTLES, FOLLOWED = 12", "SETTLES, FOLLOWED = 1", ROCKING),
    ("rates/steadiness.py", "LANDINGS = 8", "LANDINGS = 1", ROCKING),
    ("rates/steadiness.py", "gyration(one, 0.5 * np.pi)", "gyration(one, 0.0)", ROCKING),
    ("rates/steadiness.py", "1.0 / bowl.drive.frequency", "1.25 / bowl.drive.frequency", ROCKING),
    ("rates/tipping.py", "> back * stroke", "> 2.0 * back * stroke", ROCKING),
    ("rates/tipping.py", "rate + np.sqrt(rate**2", "rate - np.sqrt(rate**2", ROCKING),
    ("tooling/holding.py", "[(0.0, -one.shift), (-FAR, -one.shift)]",
     "[(0.0, one.shift), (-FAR, one.shift)]", HOLDING),
    ("tooling/verdicts.py", "WORN = 2.5e-4", "WORN = 3e-4", HOLDING),
    ("tooling/verdicts.py", "WORN = 2.5e-4", "WORN = 2e-4", HOLDING),
    ("tooling/verdicts.py", "may_wedge(self.one, span)", "False", HOLDING),
    ("tooling/holding.py", "lean <= 2.0 * math.atan(one.grip)", "lean <= math.atan(one.grip)", HOLDING),
    ("tooling/devices/ledge_edges.py", "min(-margin, certain)", "certain", HOLDING),
    ("tooling/devices/ledge_edges.py", "min(-margin, certain)", "max(-margin, certain)", HOLDING),
    ("tooling/turning.py", "height * (1.0 - math.cos(tilt))\n    return _carr",
     "height * (1.0 + math.cos(tilt))\n    return _carr", HOLDING),
    ("tooling/turning.py", "foot.max(), foot.min(), one.posture",
     "foot.max(), foot.max(), one.posture", HOLDING),
    ("rates/stream.py", "one.track.bank <= 0.0", "one.track.bank > 0.0", STEADY),
    ("machine/condition.py", "1 if known >= drive", "1 if known < drive", CONDITION),
    ("machine/condition.py", "    if now > known:", "    if now < known:", CONDITION),
    ("tooling/strip.py", "max(needed) + BESIDE", "max(needed) - BESIDE", DEVICES),
    ("tooling/devices/blades.py", "(y / lean, z)", "(y * lean, z)", DEVICES),
    ("tooling/devices/blades.py", "edge[-1, 0] / lean", "edge[-1, 0] * lean", DEVICES),
    ("tooling/devices/blades.py", "track.extent / math.tan", "track.extent * math.tan", DEVICES),
    ("tooling/devices/blades.py", "lean = width / math.tan", "lean = width * math.tan", DEVICES),
    ("tooling/devices/steady_jets.py", "track.width - met.one", "track.width + met.one", DEVICES),
    ("tooling/devices/steady_jets.py", "out - met.grip", "out + met.grip", DEVICES),
    ("tooling/devices/steady_jets.py", "-float(ends[0]", "float(ends[0]", DEVICES),
    ("tooling/devices/openings.py", "return met.one.carry_ahead", "return met.one.carry", DEVICES),
    (RECOMMENDED, '"drop": 0.4', '"drop": 0.45', JUDGED),
    (RECOMMENDED, '"drop": 0.4', '"drop": 0.35', JUDGED),
    (RECOMMENDED, "LAUNCH_WIDTH = 0.11", "LAUNCH_WIDTH = 0.12", JUDGED),
    (RECOMMENDED, "LAUNCH_WIDTH = 0.11", "LAUNCH_WIDTH = 0.1", JUDGED),
    (RECOMMENDED, "WIDTH_FLOOR = 0.1", "WIDTH_FLOOR = 0.125", JUDGED),
    (RECOMMENDED, "WIDTH_FLOOR = 0.1", "WIDTH_FLOOR = 0.08", JUDGED),
    ("trial/kernel/pushes.py", "surface.friction[2 + int(slides)]", "surface.friction[int(slides)]", SLIDES),
    ("trial/kernel/contact.py", "row[BACK] if ahead > 0.0 else row[AHEAD]",
     "row[AHEAD] if ahead > 0.0 else row[BACK]", SLIDES),
    ("trial/kernel/track_leans.py", "surface.friction[4]", "surface.friction[1]", BRAKES),
    ("trial/kernel/pushes.py", "most = row[BACK] if a < 0.0 else row[AHEAD]",
     "most = row[AHEAD] if a < 0.0 else row[BACK]", STANDS),
    ("trial/kernel/pushes.py", "spin = forth", "spin = 0.0 * forth", TURNS),
    ("trial/kernel/pushes.py", "spin = forth", "spin = -forth", TURNS),
    ("trial/kernel/motion.py", "crowd.pairs[k, WANTED] = LIFT", "crowd.pairs[k, WANTED] = 0.0 * LIFT", APART),
    ("trial/kernel/motion.py", "crowd.pairs[k, WANTED] = LIFT", "crowd.pairs[k, WANTED] = -LIFT", APART),
    ("trial/queue.py", "2.0 * self.gaps * self.rng", "self.gaps * self.rng", ENTER),
    ("trial/queue.py", "min(end, 0.0) - gap - front", "min(end, 0.0) + gap - front", ENTER),
    ("dropping/kernel/falling.py", "lever = steps.rolling", "pass", ROLLED),
    ("dropping/kernel/falling.py", "1.0 - lever * body", "1.0 - 2.0 * lever * body", ROLLED),
)  # fmt: skip
"""File, text, changed text, and the tests that notice it."""

EQUIVALENT = {
    ("machine/sizing.py", "1e-09"): "any number between rounding and what is built tells a whole multiple",
    ("machine/sizing.py", "SETTLED ="): "a bound below every length that is printed",
    ("machine/sizing.py", "ROUNDS ="): "the search ends by itself long before",
    (
        "rates/rocking.py",
        "SETTLES, FOLLOWED =",
    ): "sliding repeats itself, and what goes over has, long before",
    ("rates/rocking.py", "QUIET ="): "a part that comes down so slowly is at rest within the same instant",
    ("rates/rocking.py", "after / side"): "the side is 1 or -1",
    (
        "rates/rocking.py",
        "_senses(motions,",
    ): "how the part slides does not depend on the unit of its velocity",
    ("rates/steadiness.py", "margin + SAME"): "any number about rounding tells the same",
    ("rates/tipping.py", "INSTANTS ="): "any number of instants that shows a stroke",
    ("rates/tipping.py", "BESIDE /"): "as with BESIDE itself",
    ("tooling/turning.py", "np.empty(2"): "only the first place is read",
    ("tooling/holding.py", "FAR ="): "any length beyond every foot",
    ("tooling/holding.py", ":3], one.heading"): "heights are not looked at",
    ("machine/throughput.py", "STEPS + 2"): "a stroke beyond the greatest is held at it",
    ("machine/throughput.py", "STEPS ="): "strokes so near each other find the same one",
    ("machine/throughput.py", "amplitudes[first - "): "between strokes farther apart lies the same one",
    ("machine/sizing.py", "across = m"): "from wherever it begins, the diameter settles at the same",
    ("rates/steadiness.py", "len(hull) >"): "what a strip leaves has more corners, along its edge",
    (
        "tooling/turning.py",
        "if np.ptp(foot) > 0.0 else",
    ): "a foot without length has nothing ahead to fall over",
    ("trial/course.py", "np.full((count + 1, parts), -"): "every number below -1 is of a part that is gone",
    ("rates/tipping.py", "BESIDE ="): "any width beyond every force's place: it tips over the ends alone",
}
"""File and what stands in a changed line of it, and why no test can notice the change."""
