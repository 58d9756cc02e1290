"""Friction, restitution and stroke that explain velocities, beside those that made them."""

import pytest
from command_lines import names

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.feeding.compare import fit_bowl
from feederscrew.motion import conveying as answer

MADE = ("friction.static=0.45", "restitution=0.3")  # with strokes 4 % larger than the file of velocities says
HEAD = "drive.amplitude,velocity_mm_s,spread_mm_s,parts\n"
OFF = (1.01, 0.99, 1.005, 1.0, 0.995)  # of each velocity, as a film has it


def test_the_intervals_hold_what_made_the_velocities(run_json, tmp_path):
    """Agrees with the friction, restitution and stroke that the velocities were computed with."""
    (tmp_path / "bowl.yaml").write_text("drive:\n  frequency: 60 Hz\n")
    lines = []
    for amplitude, off in zip((0.15, 0.2, 0.25, 0.3, 0.35), OFF):
        keys = (*MADE, "drive.frequency=60 Hz", f"drive.amplitude={1.04 * amplitude} mm")
        velocity = off * 1e3 * answer.answer(bowls.read(None, keys)).velocity
        lines.append(f"{amplitude} mm,{velocity:.3f},1.5,10\n")
    (tmp_path / "velocities.csv").write_text("# a bowl that nobody has\n" + HEAD + "".join(lines))
    document = run_json("compare", "velocities.csv", "--bowl", "bowl.yaml", "-o", "out")
    for row, value, assumed in zip(document["quantities"], (0.45, 0.3, 1.04), (0.6, 0.2, 1.0)):
        assert row["low"] <= value <= row["high"] and row["high"] - row["low"] < 0.2, row
        assert row["bowl_file"] == assumed and row["decided"] == "yes"
    velocities = document["velocities"]
    rest = max(abs(row["remains_mm_s"]) for row in velocities)
    before = max(abs(row["measured_mm_s"] - row["bowl_file_mm_s"]) for row in velocities)
    assert document["misfit"] < 2.0 and rest < 2.0 < before
    assert names(tmp_path / "out/bowl_fit") == {"bowl_fit.csv", "velocities.csv", "run.json"}


FAULTS = {
    "aspect,n\nA,3\n": "velocities.csv: has no column 'velocity_mm_s'",
    HEAD + "0.2 mm,fast,1,1\n" * 3: "velocity_mm_s 'fast' is not a number",
    HEAD + "0.2 mm,20,1,1\n": "has 1 velocities",
    HEAD.replace("amplitude", "amplitud") + "0.2 mm,20,1,1\n" * 3: "amplitude",
}


@pytest.mark.parametrize("text", FAULTS)
def test_a_file_that_cannot_be_used_is_one_line(tmp_path, text):
    (tmp_path / "velocities.csv").write_text(text)
    with pytest.raises(FeederError) as fault:
        fit_bowl(tmp_path / "velocities.csv")
    assert FAULTS[text] in str(fault.value) and "\n" not in str(fault.value)
