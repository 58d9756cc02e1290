"""Keys of a bowl file as keywords and in a dict: the same bowl as from a file that says so."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from command_lines import PARTS
from design_counts import design_study

import feederscrew as fs
from feederscrew.bowl import device_list as devices
from feederscrew.bowl.schema import BOWL_KEYS
from feederscrew.bowl.schema import UNBALANCE_KEYS as TOGETHER
from feederscrew.bowl.values import BowlValues
from feederscrew.designing import design, loop

FILE = """
drive: {frequency: 60 Hz, peak_to_peak: 0.5 mm}
friction: {static: 0.5}
devices:
  - wiper: 10 mm
"""
OTHER = {  # neither the default nor the file's
    "track.hand": "left", "sizing.shape": "conical", "drive.peak_to_peak": 1e-3, "machine.leaves": 12.0,
    "sizing.leaves": 12.0, "friction.kinetic": 0.2, "friction.kinetic_backward": 0.2,
    "drive.second_harmonic_angle": 0.7, "machine.mains": "60 Hz", "machine.controller": "frequency",
}  # fmt: skip
SHARED = sorted(word for word, count in Counter(key.word for key in BOWL_KEYS).items() if count > 1)


def other_value(key):
    """A number in SI units, or a word, that a key may have."""
    if key.name in OTHER:
        return OTHER[key.name]
    if key.dimension == "count":
        return round(key.value(key.lowest)) + 1.0
    if key.choices:  # a word that changes something
        return key.choices[-1]
    default = key.default if key.default[:1].isdigit() else "0.7"
    low, value = key.value(key.lowest), key.value(default)
    return 0.9 * value + 0.1 * low if value > low else 0.9 * value + 0.1 * key.value(key.highest)


@pytest.fixture
def bowl(tmp_path):
    (tmp_path / "bowl.yaml").write_text(FILE)
    return tmp_path / "bowl.yaml"


def test_each_key_with_a_name_of_its_own_is_a_keyword_and_no_other():
    missing = {key.word for key in BOWL_KEYS} - set(SHARED) - set(BowlValues.__optional_keys__)
    assert missing == set(), "run docs/bowl_file.py"
    assert set(BowlValues.__optional_keys__) == {key.word for key in BOWL_KEYS} - set(SHARED)


@pytest.mark.parametrize("key", [key for key in BOWL_KEYS if key not in TOGETHER], ids=lambda key: key.name)
def test_a_setting_over_a_bowl_is_that_of_the_file_with_it(bowl, key):
    """Also what follows from it: kinetic friction from static, the drive from a machine's supply."""
    value = other_value(key)
    text = value if isinstance(value, str) else None
    by_dict = fs.read_bowl(bowl, {key.name: value})
    assert by_dict != fs.read_bowl(bowl)
    if text is not None:
        assert by_dict == fs.read_bowl(bowl, f"{key.name}={text}")
    if key.word not in SHARED:
        assert fs.read_bowl(bowl, **{key.word: value}) == by_dict
        assert fs.read_bowl(bowl).with_values(**{key.word: value}) == by_dict
    assert fs.read_bowl(bowl).with_values({key.name: value}) == by_dict


def test_keys_of_one_body_are_settings_together(bowl):
    values = {"centre_x": 3e-3, "inertia_x": 0.05, "inertia_y": 0.05}
    texts = ("machine.centre_x=3 mm", "machine.inertia_x=0.05 kg m2", "machine.inertia_y=0.05 kg m2")
    wanted = fs.read_bowl(bowl, texts)
    assert fs.read_bowl(bowl, **values) == wanted != fs.read_bowl(bowl)
    assert fs.read_bowl(bowl).with_values(**values) == wanted


def test_convey_with_an_amplitude_is_convey_of_that_bowl():
    plain, fast = fs.read_bowl(), fs.read_bowl(overrides="drive.amplitude=0.3 mm")
    velocity = fs.convey(fast).answer.velocity
    key = "drive.amplitude"
    overrides = ({key: "0.3 mm"}, {key: 0.3e-3}, "drive.amplitude=0.3 mm")
    for settings in (
        {"amplitude": "0.3 mm"}, {"amplitude": 0.3e-3}, {"peak_to_peak": "0.6 mm"},
        {"overrides": {key: "0.2 mm"}, "amplitude": "0.3 mm"}, *({"overrides": one} for one in overrides),
    ):  # fmt: skip
        assert fs.convey(plain.with_values(**settings)).answer.velocity == pytest.approx(
            velocity, rel=1e-12
        ), settings
    slow = fs.convey(plain).answer.velocity
    assert velocity > 1.2 * slow and fs.convey(plain.with_values(amplitude=None)).answer.velocity == slow


@pytest.mark.parametrize(
    ("wrong", "line"),
    [
        ({"amplitude": "2 s"}, "amplitude: '2 s' is a time, not a length - give it in mm"),
        ({"amplitude": -1.0}, "amplitude: '-1.0 m' is out of range - give 0 mm to 20 mm"),
        ({"hand": 3}, "hand: is 3 - give right or left"),
        ({"overrides": {"drive.amplitude": [1]}}, "drive.amplitude: is [1], not a number - give a number"),
        ({"overrides": {"drive.hertz": 1}}, "overrides drive.hertz: unknown key 'drive.hertz' - "),
        ({"overrides": 3}, "overrides: is 3 - give a dict"),
        ({"amplitude": "1 mm", "peak_to_peak": "1 mm"}, "both given - keep one of them"),
    ],
)
def test_a_setting_that_cannot_be_used_is_a_line_that_names_it(wrong, line):
    for call in (lambda: fs.read_bowl(**wrong), lambda: fs.read_bowl().with_values(**wrong)):
        with pytest.raises(fs.FeederError) as caught:
            call()
        assert line in str(caught.value)


def noting(calls, wanted):
    """A design that only notes what it is asked."""

    def designed(part, plain, keys, request, **own):
        calls.append(wanted(plain, keys, request))
        return design_study(part)

    return designed


def test_a_design_keeps_what_its_bowl_was_read_from_and_the_settings(monkeypatch, bowl):
    """As ``feeder design --config``: it kept the devices alone, without the names of the keys."""
    calls = []
    monkeypatch.setattr(loop, "design", noting(calls, lambda plain, keys, request: (plain, keys)))
    monkeypatch.setattr(design, "build_machine", lambda study, settings: None)
    monkeypatch.setattr(design, "with_machine", lambda study, built: study)
    part = fs.load(PARTS / "washer_m6.stl")
    fs.design(part, "60/min", fs.read_bowl(bowl).with_values(climb="2 deg", width="25 mm"))
    fs.design(part, "60/min", fs.read_bowl(frequency="60 Hz"))
    (first, keys), (second, own) = calls
    assert keys >= {"drive.frequency", "drive.peak_to_peak", "friction.static", "track.climb", "track.width"}
    assert not {"track.radius", "drive.amplitude"} & keys
    assert first.track.climb == pytest.approx(0.0349, rel=1e-3)
    assert own == {"drive.frequency"} and second.drive.frequency == 60.0


def test_keywords_of_the_release_before_give_the_same_and_a_warning_that_says_what_to_write(monkeypatch):
    plain, part = fs.read_bowl(), fs.load(PARTS / "washer_m6.stl")
    changed = plain.with_values({"track.climb": "2 deg"}, amplitude="0.3 mm")
    with pytest.warns(DeprecationWarning, match=r"bowl\.with_values\(amplitude=\.\.\.\)"):
        assert fs.convey(plain, amplitude="0.3 mm", overrides={"track.climb": "2 deg"}).bowl == changed
    with pytest.warns(DeprecationWarning, match=r"bowl\.with_values\(climb=\.\.\.\)"):
        assert fs.slide(plain, climb="2 deg").bowl.track.climb == changed.track.climb
    with pytest.warns(DeprecationWarning, match=r"bowl\.with_values\(gravity=\.\.\.\)"):
        studies = fs.shake(part, [plain, changed], drops=2, seconds=0.01, gravity=9.0).plates
    assert len(studies) == 2
    calls = []
    monkeypatch.setattr(loop, "design", noting(calls, lambda plain, keys, request: (keys, request)))
    monkeypatch.setattr(design, "build_machine", lambda study, settings: None)
    monkeypatch.setattr(design, "with_machine", lambda study, built: study)
    with pytest.warns(DeprecationWarning, match=r"search=DesignSearch\(draws=\.\.\.\)"):
        fs.design(part, "60/min", draws=7, budget=3, kept_keys={"track.width"}, frequency="60 Hz")
    keys, request = calls[0]
    assert keys == {"track.width", "drive.frequency"} and (request.draws, request.budget) == (7, 3)


def test_what_is_given_to_a_bowl_of_a_file_with_a_trial_leaves_that_file_its_source(bowl):
    """`size_bowl` looks there for a trial that still holds."""
    read = fs.read_bowl(bowl)
    assert read.source == read.with_values(climb="2 deg").source == str(bowl)
    assert fs.read_bowl().source is None


class Metres:
    """Stands for a quantity of pint."""

    def __init__(self, number, unit="m"):
        self.magnitude, self.unit = number, unit

    def to(self, unit):
        if (self.unit, unit) == ("mm", "m"):
            return Metres(1e-3 * self.magnitude)
        if self.unit != unit:
            raise TypeError(f"cannot convert {self.unit} to {unit}")
        return self


def test_a_quantity_of_another_library_is_taken():
    wanted = fs.read_bowl(amplitude="0.3 mm", frequency=60.0)
    assert fs.read_bowl(amplitude=Metres(0.3, "mm"), frequency=Metres(60.0, "Hz")) == wanted
    assert fs.read_bowl(overrides={"drive.amplitude": Metres(3e-4)}, frequency="60 Hz") == wanted
    part = fs.load(PARTS / "washer_m6.stl", density=Metres(2700.0, "kg/m**3"))
    assert part.density == pytest.approx(2700.0)
    with pytest.raises(fs.FeederError, match=r"amplitude: .* is not of length - give it in mm"):
        fs.read_bowl(amplitude=Metres(1.0, "s"))
    with pytest.raises(fs.FeederError, match=r"heading: .* is not of angle - give it in deg"):
        fs.rate(part, wanted, "A", heading=Metres(1.0))


@pytest.mark.needs("pint")
def test_quantities_of_pint_are_taken_in_every_dimension():
    unit = pytest.importorskip("pint").UnitRegistry()
    given = {
        "amplitude": 0.3 * unit.mm,
        "climb": 2.0 * unit.degree,
        "frequency": 60.0 / unit.s,
        "static": 0.4,
    }
    texts = {"amplitude": "0.3 mm", "climb": "2 deg", "frequency": "60 Hz", "static": 0.4}
    own = {"bowl_inertia": 0.5 * unit.kg * unit.m**2, "gravity": 9.8 * unit.m / unit.s**2}
    assert fs.read_bowl(**given) == fs.read_bowl(**texts)
    assert fs.read_bowl(**own) == fs.read_bowl(bowl_inertia=0.5, gravity=9.8)


@pytest.mark.parametrize(
    "values", [{}, {"amplitude": "0.3 mm"}, {"bowl_mass": "8 kg"}, {"static": 0.5, "hand": "left"}]
)
def test_a_bowl_as_a_file_is_read_back_as_the_same_bowl(bowl, tmp_path, values):
    """Also one that was changed as a record, whose settings are gone."""
    read = fs.read_bowl(bowl).with_values(**values)
    (tmp_path / "back.yaml").write_text(read.to_yaml())
    back = fs.read_bowl(tmp_path / "back.yaml")
    own = [[s.key.name for s in one.settings if s.is_own] for one in (read, back)]
    assert own[0] == own[1] and devices.differences(read, back) == []
    changed = replace(read, track=replace(read.track, width=1.0 / 30.0), drive=replace(read.drive, phase=0.1))
    (tmp_path / "back.yaml").write_text(changed.to_yaml())
    assert devices.differences(changed, fs.read_bowl(tmp_path / "back.yaml")) == []
    with pytest.raises(fs.FeederError, match=r"track\.width"):
        replace(read, track=replace(read.track, width=np.array([0.02, 0.03]))).to_yaml()
