"""Bowl files: defaults, overrides, origins, sweeps, and the exact line of every fault."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from feederscrew import bowl
from feederscrew.base import units
from feederscrew.base.errors import FeederError
from feederscrew.bowl import documentation, schema
from feederscrew.motion import conveying as answer
from feederscrew.motion import limits

CONFIGS = Path(__file__).parents[2] / "configs"
LOWER = "lower the kinetic coefficient or raise the static one"


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def write(text):
        Path("bowl.yaml").write_text(text)
        return "bowl.yaml"

    return write


def faults(call, *arguments):
    with pytest.raises(FeederError) as caught:
        call(*arguments)
    return list(caught.value.lines)


def values(path=None, *overrides):
    return {s.key.name: (s.text, s.origin) for s in bowl.settings(path, overrides)}


def test_the_defaults_keep_what_their_comment_promises():
    """It slides without hopping at 25 mm/s, for friction a fifth lower to half as high again."""
    plain = bowl.default()
    assert plain == bowl.read()
    drive, mu = plain.drive, plain.friction
    assert (drive.amplitude, drive.frequency, drive.vibration_angle) == (0.21e-3, 50.0, math.radians(25))
    assert mu.static == mu.kinetic == mu.wall == 0.6
    own = answer.answer(plain)
    assert (round(1e3 * own.velocity, 1), own.status) == (25.0, "periodic")
    for friction in (0.8, 1.0, 1.5):
        around = answer.answer(answer.scaled(plain, friction=friction))
        assert around.regime in ("forward", "both")
        assert 15e-3 < around.velocity < plain.sizing.fastest
    thrown = ("drive.frequency=100 Hz", "drive.amplitude=0.15 mm", "drive.vibration_angle=20 deg")
    assert round(1e3 * answer.answer(bowl.read(None, thrown)).velocity) == 56


def test_the_shipped_files(file):
    """The template holds the defaults; the schema beside it is as the program has it."""
    path = file(documentation.template())
    assert bowl.read(path) == bowl.default()
    assert values(path)["drive.amplitude"][1] == "bowl.yaml:13"
    assert values(path)["friction.kinetic"][1] == "as friction.static"
    assert (CONFIGS / "bowl.yaml").read_text() == documentation.template()
    assert (CONFIGS / documentation.SCHEMA_FILE).read_text() == documentation.schema_text()
    thesis = bowl.read(CONFIGS / "thesis.yaml")
    ratio = limits.acceleration_ratio(thesis.drive.amplitude, thesis.drive.frequency, thesis.gravity)
    assert ratio == pytest.approx(7.25, abs=0.005)
    assert math.degrees(math.asin(1 / ratio)) == pytest.approx(7.9, abs=0.05)
    # The schema agrees with the record.
    assert bowl.texts(bowl.settings()).keys() == {k.name for k in schema.BOWL_KEYS if k.section != "machine"}
    with_machine = bowl.settings(None, ["machine.leaves=10"])
    assert bowl.texts(with_machine).keys() == {key.name for key in schema.BOWL_KEYS}
    for key in (key for key in schema.BOWL_KEYS if not key.choices):
        low, high = (units.quantity(text, key.dimension) for text in (key.lowest, key.highest))
        assert low <= next(s.value for s in bowl.settings() if s.key is key) <= high


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("drive:\n  amplitud: 0.5 mm\n", "2:3: unknown key 'amplitud' - did you mean amplitude?"),
        ("drve:\n  amplitude: 0.5 mm\n", "1:1: unknown key 'drve' - did you mean drive?"),
        ("amplitude: 0.5 mm\n", "1:1: unknown key 'amplitude' - write amplitude below 'drive:'"),
        ("drive:\n  gravity: 9 m/s2\n", "2:3: unknown key 'gravity' - write gravity without indent"),
        ("drive:\n  frequency: 60\n", "2:14: drive.frequency: '60' has no unit - write 60 Hz"),
        ("friction:\n  static: yes\n",
         "2:11: friction.static: 'yes' is not a number - write digits with a decimal point, as in 0.4"),
        ("drive:\n  vibration_angle: 120 deg\n",
         "2:20: drive.vibration_angle: '120 deg' is out of range - give 0 deg to 90 deg"),
        ("restitution: -0.1\n", "1:14: restitution: '-0.1' is out of range - give 0 to 0.95"),
        ("restitution: [0.1]\n", "1:14: restitution is a list - write one value, such as 0.2"),
        ("gravity:\n", "1:9: gravity has no value - write 9.81 m/s2"),
        ("drive: 60 Hz\n", "1:8: 'drive' is a section, not a value - indent its keys below 'drive:'"),
        ("friction:\n  static: 0.4\n  kinetic: 0.6\n",
         "3:12: friction.kinetic 0.6 is above friction.static 0.4 (bowl.yaml:2:11) - lower the kinetic "
         "coefficient or raise the static one"),
        ("drive:\n  amplitude: 1 mm\n  peak_to_peak: 2 mm\n",
         "3:3: drive.peak_to_peak and drive.amplitude are both given - keep one of them"),
        ("gravity: 9 m/s2\ngravity: 8\n", "2:1: key 'gravity' is already in line 1 - keep one of them"),
        ("gravity: &g 9.81 m/s2\n", "1:10: anchor '&g' is not allowed - write the value alone"),
        ("drive:\n  <<: {frequency: 50 Hz}\n",
         "2:3: unknown key '<<' - known are amplitude, peak_to_peak, frequency, vibration_angle, "
         "direction, phase, second_harmonic, second_harmonic_phase, second_harmonic_angle"),
        ("- 1\n- 2\n", "1:1: no 'key: value' line - start from 'feeder config init'"),
    ],
)  # fmt: skip
def test_a_fault_in_a_file(file, text, line):
    assert faults(bowl.read, file(text)) == [f"bowl.yaml:{line}"]


def test_faults_of_a_file_and_of_set_together(file):
    path = file("drive:\n  amplitud: 0.5 mm\n  frequency: 60\nfriction:\n  kinetic: yes\n  kinetic: 0.4\n")
    lines = faults(bowl.read, path, ("gravity=9.81", "track.climb=50 deg"))
    places = [f"bowl.yaml:{place}" for place in ("2:3", "3:14", "5:12", "6:3")]
    assert [line.split(": ")[0] for line in lines] == [*places, "overrides gravity", "overrides track.climb"]
    path = file("friction:\n  static: 0.6\n  kinetic: 0.5\n")
    line = "friction.static: friction.kinetic 0.5 is above friction.static 0.4 (bowl.yaml:3:12)"
    assert faults(bowl.read, path, ["friction.static=0.4"]) == [f"overrides {line} - {LOWER}"]


@pytest.mark.parametrize(
    ("override", "line"),
    [
        ("frequency=50 Hz", "frequency: unknown key 'frequency' - did you mean drive.frequency?"),
        ("drive=1", "drive: 'drive' is a section, not a key - write one of its keys, as drive.amplitude"),
        ("devices=gap", "devices: devices are a list - write them in a bowl file"),
        ("gravity", "gravity: has no '=' - write KEY=VALUE, as in \"gravity=9.81 m/s2\""),
        ("gravity=", "gravity: has no value - write 9.81 m/s2"),
        ("friction.kinetic=0.9",
         f"friction.kinetic: friction.kinetic 0.9 is above friction.static 0.6 (default) - {LOWER}"),
        ("friction.static_backward=0.5|friction.kinetic_backward=0.7",
         "friction.kinetic_backward: friction.kinetic_backward 0.7 is above friction.static_backward 0.5 "
         f"(given as well) - {LOWER}"),
        ("friction.kinetic=0.6|friction.static=0.4", None),
        ("drive.amplitude=1 mm|drive.peak_to_peak=1 mm", None),
        ("track.hand=up", "track.hand: 'up' is not known - write right or left"),
        ("machine.mains=55 Hz", None),
    ],
)  # fmt: skip
def test_a_fault_in_set(override, line):
    (text,) = faults(bowl.read, None, override.split("|"))
    assert text == f"overrides {line}" if line else text.startswith("overrides ")


def test_set_goes_over_the_file_and_the_last_one_holds(file):
    path = file("restitution: 0.1\n")
    assert bowl.read(path, ["restitution=0.3", "restitution=0.0"]).restitution == 0.0
    assert bowl.read(path, ["track.radius=100 m"]).track.radius == 100.0
    assert bowl.read(path).restitution == 0.1
    # Either stroke replaces the other.
    path = file("drive:\n  amplitude: 0.5 mm\n")
    assert bowl.read(path, ["drive.peak_to_peak=3 mm"]).drive.amplitude == 1.5e-3
    path = file("drive:\n  peak_to_peak: 0.5 mm\n")
    assert bowl.read(path).drive.amplitude == 0.25e-3
    assert bowl.read(path, ["drive.amplitude=3 mm"]).drive.amplitude == 3e-3
    # Values given, and those that follow them.
    path = file("drive:\n  peak_to_peak: 0.5 mm\n")
    assert values(path, "friction.static=0.3").items() >= {
        "drive.peak_to_peak": ("0.5 mm", "bowl.yaml:2"),
        "drive.amplitude": ("0.25 mm", "from drive.peak_to_peak"), "friction.static": ("0.3", "--set"),
        "friction.kinetic": ("0.3", "as friction.static"), "friction.wall": ("0.3", "as friction.kinetic"),
        "friction.kinetic_backward": ("0.3", "as friction.kinetic"), "gravity": ("9.81 m/s2", "default"),
    }.items()  # fmt: skip
    both = bowl.read(None, ["friction.static=0.5", "friction.kinetic=0.4"]).friction
    assert (both.backward, replace(both, static=0.7).backward) == ((0.5, 0.4), (0.7, 0.4))
    other = bowl.read(None, ["friction.static=0.5", "friction.static_backward=0.9"])
    assert other.friction.backward == (0.9, 0.5)
    # An amplitude of 1e-300 mm gave a velocity of nan mm/s.
    own = bowl.read(None, ["drive.amplitude=1e-300 mm", "friction.kinetic=1e-310"])
    assert (own.drive.amplitude, own.friction.kinetic) == (0.0, 0.0)


def test_an_amplitude_that_is_said_twice_is_taken_once():
    twice = bowl.at_strokes(bowl.read(None, ["drive.amplitude=0.4 mm"]), "50%,0.2 mm,60%")
    assert [each.drive.amplitude for each in twice] == [2e-4, 2.4e-4]
    assert bowl.read(None, ["drive.amplitude=1e-9 mm"]).drive.amplitude == pytest.approx(1e-12)


def test_sweeps_and_ranges():
    strokes = np.array([[1e-3], [2e-3]])
    varied = {"friction.static": np.array([0.2, 0.4]), "drive.peak_to_peak": strokes}
    swept = bowl.swept(bowl.settings(None, ["drive.amplitude=1 mm"]), varied)
    assert swept.friction.wall.tolist() == [0.2, 0.4]
    assert swept.drive.amplitude.tolist() == [[0.5e-3], [1e-3]]
    assert swept.drive.frequency == 50.0
    texts = ["drive.vibration_angle=5:60:12", "drive.peak_to_peak = 0.1mm : 2 mm : 3"]
    angle, stroke = bowl.key_ranges(texts)
    assert np.allclose(np.degrees(angle.values), np.arange(5, 61, 5), rtol=1e-15, atol=0)
    assert stroke.values == pytest.approx((1e-4, 1.05e-3, 2e-3), rel=1e-15)
    assert (angle.key.column, stroke.key.column) == ("vibration_angle_deg", "peak_to_peak_mm")


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("track.clim=1:2:3", "track.clim: unknown key 'track.clim' - did you mean track.climb?"),
        ("friction.static=0:1",
         "friction.static: '0:1' is not a range - write FROM:TO:COUNT, as in friction.static=0:10:20"),
        ("friction.static=0.3:0.30:5",
         "friction.static: begins where it ends - give two different values, or set the one"),
        ("friction.static=0:1:1", "friction.static: '1' is not a count - give a whole number from 2 to 2000"),
        ("friction.static=0:11:5", "friction.static: '11' is out of range - give 0 to 10"),
        ("drive.amplitude=0:1:3|drive.peak_to_peak=0:1:3",
         "drive.peak_to_peak: is varied twice - vary two different keys"),
        ("track.hand=0:1:5", "track.hand: is a word, not a number - set it to right or left"),
    ],
)  # fmt: skip
def test_a_fault_in_a_range(text, line):
    assert faults(bowl.key_ranges, text.split("|")) == [f"vary {line}"]


@given(st.just(0.0) | st.floats(1e-12, 90.0))
def test_a_value_in_full_precision_comes_back(angle):
    drive = bowl.read(None, [f"drive.vibration_angle={angle!r} deg"]).drive
    assert drive.vibration_angle == angle * units.factor("deg", "angle")


def test_the_supply_follows_the_mains_and_the_drive_of_a_file_does_not():
    """A place with 60 Hz is no machine: the stroke of the defaults belongs to 50 Hz."""
    sixty = bowl.read(None, ("machine.mains=60Hz",))
    assert (sixty.sizing.mains_frequency, sixty.machine.supply, sixty.drive.frequency) == (60.0, 120.0, 50.0)
    own = bowl.read(None, ("machine.mains=60 hz", "machine.supply=50 Hz half wave"))
    assert (own.machine.supply, own.drive.frequency) == (50.0, 50.0)
    bolted = bowl.read(None, ("machine.bolts=4",))  # nor do bolts make a machine
    assert bolted.drive == bowl.default().drive and bolted.sizing.bolts == 4
    # Words are read however they are written.
    assert bowl.read(None, ("machine.controller=Frequency",)).sizing.control == "frequency"
    for text in ("left", " Left ", "LEFT"):
        assert bowl.read(None, (f"track.hand={text}",)).sizing.hand == "left"
