"""What is written of a bowl and its devices is what was tried: it holds for those, and for no others."""

import math
from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import __version__ as VERSION
from feederscrew import bowl as bowls
from feederscrew.base import documents
from feederscrew.base.errors import FeederError
from feederscrew.bowl import device_list as devices
from feederscrew.bowl.device_list import value_text
from feederscrew.bowl.devices.air_assist import AirAssist
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.pneumatics import SENSOR_VIEWS
from feederscrew.bowl.reading import settings_of_text
from feederscrew.bowl.verified import SHARED, body_fingerprint, fingerprint
from feederscrew.designing import proposals
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.output import designs, proof
from feederscrew.part.record import AspectNames
from feederscrew.resting.aspects import find
from feederscrew.sorting.isolating.chain import Cut

BOWL, PART = bowls.default(), shapes.part(shapes.box(10, 10, 10))
BLOCK = {
    "status": "holds", "wanted": "A@0", "target": "10/min", "delivered": "12/min", "delivered_low": "11/min",
    "delivered_high": "13/min", "purity": "1", "jams": "0", "queue_seconds": "180 s", "draws": "20",
    "draws_held": "20", "version": f'"{VERSION}"', "part": f'"{PART.sha256[:16] or "0" * 16}"',
    "bowl": f'"{fingerprint(BOWL)}"',
}  # fmt: skip
OPTIONAL = {
    "up": '"A, B"', "outcome": "lying", "trial_parts": "6", "seed": "1", "tried": '"2020-02-29"',
    "body": f'"{body_fingerprint(PART)}"', "purity_low": "0.98",
}  # fmt: skip
SAME = replace(PART, sha256=BLOCK["part"].strip('"'))
NEVER = ("", "nan", ".inf", "-5", "-1/min", "1e400", "1_0", "٣", "[1]", "{a: 1}", '"\\e[31m"', '"a\\nb"')
WRONG = {
    "status": ("none", "Holds", "true"), "wanted": (f'"{"A" * 300}"',), "target": ("10", "1e9/min", "10 mm"),
    "delivered": ("12", "14/min", "10/min", "1e9/min", "0/min"),
    "delivered_low": ("12.5/min", "11 s", "5/min"), "delivered_high": ("11.5/min", "1e7/min"),
    "purity": ("500 %", "1.01", "0.5", "0", "none", "1/min"),
    "jams": ("-3", "3", "1.5", "1e1", "10" * 15), "queue_seconds": ("0 s", "180", "1e30 s", "-1 s"),
    "draws": ("0", "19", "100", "1" + 23 * "0", "20.5"), "draws_held": ("21", "10", "1" + 23 * "0"),
    "version": ("2", "x", '"0.2.0 or so"'),
    "part": ("abc", '"zcb9e5277f2576a5"', '"0"', f'"{"0" * 65}"'),
    "bowl": ("abc", '"0"', '"0000000000000000"'),
    "outcome": ("standing", "hanging"),  # the bowl has no rails
    "trial_parts": ("0", "1.5", "10" * 15), "seed": ("1.5",),
    "tried": ("2026-13-01", "yesterday", "2999-12-31", "2021-02-29"),
    "body": ("abc", '"0"'), "purity_low": ("0.9", "1.5", "96 %"),
}  # fmt: skip
# A text may be any name, and a name may look like a number.
NAMES = {"wanted": {"nan", ".inf", "-5", "-1/min", "1e400", "1_0", "٣"}, "up": set(NEVER)}
ANY_NAMES = ("A", "b 2", "side: up", "x, y", "[C]", "Größe", "#1")


def read(tmp_path, text):
    (tmp_path / "b.yaml").write_text(text)
    return bowls.read(tmp_path / "b.yaml")


@pytest.mark.parametrize("kind", KINDS)
def test_a_device_written_and_read_back_is_the_same_and_a_changed_one_is_not(tmp_path, kind):
    text = "track:\n  width: 40 mm\ndevices:\n  - {}: {}\n"
    bowl = read(tmp_path, text.format(kind, KINDS[kind].trade.example))
    (device,) = bowl.devices
    tried = fingerprint(bowl)
    assert fingerprint(read(tmp_path, text.format(kind, value_text(device)))) == tried
    for name in (field.name for field in fields(device) if field.name not in SHARED):
        value = getattr(device, name)
        if value is None or isinstance(value, float):
            changed = replace(device, **{name: 1.01 * value if value else 0.5})
            assert fingerprint(replace(bowl, devices=(changed,))) != tried, name


def test_what_is_not_given_stands_in_the_fingerprint_as_it_did(tmp_path):
    """The digits that version 0.2.0 gave this file, when what was not given was NaN."""
    text = "devices:\n  - wiper: 6 mm\n  - wiper: {clearance: 6 mm, sweep: 30 deg}\n"
    text += "  - sorter: {of: A@90, play: 0.5 mm, sees: outline}\n  - yield: {A: 0.9}\n"
    assert fingerprint(read(tmp_path, text)) == "180c20cb2caa5dea"


@pytest.fixture
def block(tmp_path):
    """What is read of a bowl file with this block; a key of None is left out."""

    def call(text=None, **changes):
        values = {**BLOCK, **OPTIONAL, **changes}.items()
        lines = [f"  {key}: {value}" for key, value in values if value is not None]
        (tmp_path / "b.yaml").write_text(text or "\n".join(["verified:", *lines]) + "\n")
        return bowls.verified(tmp_path / "b.yaml")

    return call


@pytest.fixture
def void(block):
    """Why a block does not count for a part and what is asked for."""
    return lambda of=None, asked="A@0", **changes: list(block(**changes).void(of, BOWL, VERSION, asked))


@pytest.mark.parametrize("part", [None, SAME])
def test_a_whole_block_holds(block, void, part):
    assert void(part) == []
    assert void(part, **dict.fromkeys(set(OPTIONAL) - {"body"})) == []
    tried = block()
    assert (tried.purity, tried.jams, tried.draws, tried.up) == (1.0, 0, 20, "A, B")
    assert "12/min (11 to 13) of A@0" in tried.sentence


@pytest.mark.parametrize("key", [*BLOCK, *OPTIONAL])
def test_a_block_that_cannot_be_true_is_void(void, key):
    for text in (*NEVER, *WRONG.get(key, ())):
        if text in NAMES.get(key, ()):
            continue
        reasons = void(**{key: text})
        assert reasons, text
        line = "; ".join(reasons)
        assert line.isprintable(), text
        assert not any(word in line for word in ("nan", "500", "-5", "-3", "1" + 23 * "0")), text
    if key in BLOCK:
        assert f"it has no {key}" in void(**{key: None})


def test_blocks_of_no_mapping_and_of_a_queue_that_nothing_left(block):
    for text in ("verified:\n", "verified: 3\n", "verified: [1, 2]\n"):
        assert "mapping" in next(block(text).void(None, BOWL, VERSION))
    nothing = dict.fromkeys(("delivered", "delivered_low", "delivered_high"), "0/min")
    tried = block(status="falls short", purity="none", purity_low="0", **nothing)
    assert tried.purity is None and "nothing left" in tried.sentence and "nan" not in tried.sentence


def test_a_trial_counts_for_what_was_wanted_and_for_nothing_else(block, void):
    for wanted in ("A", "A@0", "a@0", None):
        assert void(asked=wanted, up=None) == []
    for wanted in ("B", "B@0", "A@90", "A@1"):
        assert "another orientation" in void(asked=wanted, up=None)[0]
    for wanted in ("B", "B@90", "A@90"):
        assert void(asked=wanted) == []
    several = block(up=None, wanted='"A@0 or B"')
    assert [several.counts(name) for name in ("B@7", "A@0", "A@90")] == [True, True, False]
    assert void(asked="C")


def test_parts_leave_rails_hanging_and_other_devices_lying(block):
    rails = KINDS["rails"]("b.yaml", span=(1e-3, 5e-3))
    for own, outcome in (((), "lying"), ((rails,), "hanging")):
        bowl = replace(BOWL, devices=own)
        for written in ("lying", "hanging"):
            tried = block(outcome=written, bowl=f'"{fingerprint(bowl)}"')
            why = f"its outcome is {written}, and parts leave these devices {outcome}"
            assert list(tried.void(None, bowl, VERSION)) == ([] if written == outcome else [why])


def test_another_density_or_name_is_another_part_and_a_block_without_units_holds_for_none(void):
    """A washer of mm, read as cm, was given the rate of its trial."""
    names = AspectNames("n.yaml", "", (("top", (0.0, 0.0, 1.0)),))
    assert void(SAME) == []
    moved = SAME.centre_of_mass + 0.001
    for changes in ({"mass": 2.0 * SAME.mass}, {"centre_of_mass": moved}, {"names": names}):
        assert void(replace(SAME, **changes))
    (why,) = void(SAME, body=None)
    assert "units" in why


@pytest.mark.parametrize("wanted, leads", [("A@0", True), ("B@0", False), ("A@90", False)])
def test_a_trial_leads_for_its_own_orientation_only(block, wanted, leads):
    """The trial of A@0 was given as the rate of B."""
    tried = block(up=None)
    document = proof.with_trial({"parts_per_minute": 105.5}, tried, SAME, BOWL, wanted)
    assert document["parts_per_minute"] == pytest.approx(12.0 if leads else 105.5)
    assert (document["verified"] is not None) == leads
    (text,) = proof.warnings(tried, SAME, BOWL, wanted)
    assert ("its trial delivers 12/min" in text) == leads and ("void: A@0 was tried" in text) != leads
    # By the rule a screw lies and none leaves; hung between rails in its trial, 141 a minute do.
    document = proof.with_trial({"parts_per_minute": 0.0}, tried, SAME, BOWL, "A@0")
    assert document["parts_per_minute"] == pytest.approx(12.0) and document["parts_per_minute_static"] == 0.0


def draw(kind, rng):
    """A device of a kind; each attribute that it may leave out is there as often as not."""

    def number(low, high):
        return float(rng.uniform(low, high))

    def length(low=1e-3, high=2e-2):
        return number(low, high)

    def some(**values):
        return {name: value for name, value in values.items() if rng.random() < 0.5}

    def pick(choices):
        return choices[rng.integers(len(choices))]

    def like():
        return pick(ANY_NAMES), number(0.0, 2.0 * math.pi)

    (x, y, wide, high), first = (length() for _ in range(4)), length()
    hole = ((x, y), (x + wide, y), (x + wide, y + high), (x, y + high))
    jet = {"nozzle": length(1e-4), "pressure": number(1e3, 1e6), "height": length()}
    air = some(air=AirAssist(**jet))
    span = (first, first + length())
    contour = ((0.0, 2e-2), (length(), 1.5e-2), (3e-2, length()))
    values = {
        "wiper": lambda: {"limit": length(), **some(friction=number(0.0, 2.0), contour=contour),
                          **pick(({}, {"sweep": number(0.1, 1.5)}, {"sweep": number(0.1, 1.5), **air}))},
        "slot": lambda: {"span": span},
        "rails": lambda: {"span": span,
                          **some(lead=(span[0] - 5e-4, span[1] + length(), length(), length()))},
        "cut-out": lambda: {"corners": hole},
        "dish-out": lambda: {"limit": length(), "radius": length(1e-3)},
        "cap selector": lambda: {"limit": first, "length": length(3e-2, 4e-2), "tongue": length(),
                                 "reach": first + length()},
        "silhouette blade": lambda: {"limit": length(), "reach": first, "leaves": first + length(),
                                     "sweep": number(0.1, 1.5), **some(friction=number(0.0, 2.0))},
        "balance gap": lambda: {"limit": length(), "clearance": length(), "hold": length()},
        "curved deflector": lambda: {"limit": length(), "begin": number(0.1, 0.4), "end": number(0.5, 1.2),
                                     **air},
        "profile gate": lambda: pick(({"corners": hole}, {"like": (*like(), length())})),
        "V groove": lambda: {"angle": number(0.2, 1.0)},
        "twisted track": lambda: {"angle": number(1.14, 1.39), "length": number(0.02, 1.0)},
        "banked track": lambda: {"angle": number(0.0, 0.7)},
        "spacing section": lambda: {"angle": number(-0.7, 0.7)},
        "measured yield": lambda: {"shares": tuple((name, float(rng.random())) for name in ANY_NAMES[:3])},
        "air jet": lambda: jet,
        "vision reject": lambda: {
            "like": (*like(), length()), "sees": pick(SENSOR_VIEWS),
            **some(also=(like(), like()), resolution=length(), **jet, time=number(1e-3, 1.0),
                   nozzles=float(rng.integers(1, 21))),
        },
    }  # fmt: skip
    return KINDS[kind]("drawn", **values.get(kind, lambda: {"limit": length()})()).rewritten()


def read_back_device(device):
    root, faults = documents.load(f"- {device.kind}: {devices.value_text(device)}\n", "b.yaml")
    found = devices.listed(documents.Entry("devices", "b.yaml", root), faults)
    assert not faults, faults
    return found[0]


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_kind_is_read_back_as_it_was_drawn(kind):
    """Read twice each attribute is equal: what is not given must equal itself, as NaN does not."""
    rng = np.random.default_rng(sum(map(ord, kind)))
    for _ in range(20):
        device = draw(kind, rng)
        first, second = read_back_device(device), read_back_device(device)
        assert devices.differences(device, first) == []
        assert all(getattr(first, one.name) == getattr(second, one.name) for one in fields(device))
        devices.check_written((device,), "b.yaml")


@pytest.fixture(scope="module")
def lying():
    part = shapes.part(shapes.box(20, 12, 5))
    return proposals.follow_orientations(part, find(part), bowls.default()).lying


@pytest.mark.parametrize("kind", sorted(name for name, kind in KINDS.items() if kind.search.bound))
def test_a_value_that_is_moved_or_rounded_leaves_all_others_as_they_are(kind, lying):
    rng = np.random.default_rng(7)
    for _ in range(10):
        device = draw(kind, rng)
        if getattr(device, "contour", ()):
            continue  # a contour stands for the number
        cut = Cut(device, 1e-3, 1e-3, device, device, ())
        moved = proposals.move_cut(cut, 1.1 * device.limit, lying, 0)
        for other in (moved, proposals.round_cut(cut, lying, 0)):
            assert devices.differences(other.device, read_back_device(other.device)) == []
            own = read_back_device(other.device)
            assert devices.differences(device, own, ("where", "text", "limit")) == []
            assert other.device.limit == pytest.approx(own.limit)


def test_a_wiper_that_clears_itself_is_written_so(lying):
    """Not as '11.3 mm', which is straight across the track, and stops what it should sweep off."""
    wiper = KINDS["wiper"].proposal("design", 0.01128).rewritten()
    cut = Cut(wiper, 1e-3, 1e-3, wiper, wiper, ())
    for other in (proposals.move_cut(cut, 0.0113, lying, 0), proposals.round_cut(cut, lying, 0)):
        assert other.device.text == "{clearance: 11.3 mm, sweep: 30 deg}"
    # Play, pulse and slot leave all others as they are.
    rng = np.random.default_rng(3)
    for _ in range(30):
        sorter, rails = draw("vision reject", rng), draw("rails", rng)
        for other, changed in (
            (sorter.with_play(2e-3), {"like", "also"}),  # headings to a millionth of a degree
            (sorter.with_pulse(0.02), {"time"}),
            (rails.with_span((rails.span[0] + 1e-4, rails.span[1])), {"span"}),
        ):
            assert devices.differences(other, read_back_device(other)) == []
            own = sorter if other.kind == "vision reject" else rails
            assert devices.differences(own, read_back_device(other), {"where", "text", *changed}) == []
    assert proposals.PULSE_STEP_S > 0.0


@pytest.mark.parametrize("text", ["11.3 mm", "{clearance: 11.3 mm, sweep: 31 deg}", "11.3", "[1 mm]"])
def test_a_text_of_another_device_is_refused(text):
    wiper = replace(KINDS["wiper"].proposal("design", 0.0113), text=text)
    with pytest.raises(FeederError, match="not the device that was tried"):
        devices.check_written((wiper,), "design.yaml")


def study(bowl):
    request = DesignRequest(40.0 / 60.0)
    return DesignStudy(shapes.part(shapes.box(10, 10, 10)), request, bowl, "A@0", 0)


def test_drive_track_and_machine_are_read_back_as_they_were_tried():
    rng, plain = np.random.default_rng(11), bowls.default()

    def drawn(record, **ranges):
        return replace(record, **{name: float(rng.uniform(*ends)) for name, ends in ranges.items()})

    for _ in range(10):
        drive = drawn(plain.drive, amplitude=(1e-5, 1e-3), frequency=(20.0, 100.0), phase=(-1.0, 1.0))
        drive = drawn(drive, vibration_angle=(0.1, 0.6))
        track = drawn(plain.track, climb=(0.0, 0.1), bank=(0.0, 0.2), radius=(0.1, 0.4), width=(0.01, 0.05))
        machine = drawn(replace(plain.machine, spring_angle=0.3), bowl_mass=(1.0, 20.0))
        bowl = replace(plain, drive=drive, track=track)
        text = designs.bowl_file(study(bowl), (), SimpleNamespace(bowl=replace(bowl, machine=machine)))
        own = bowls.record(settings_of_text(text, "design.yaml"))
        for wanted, read_back in ((drive, own.drive), (track, own.track), (machine, own.machine)):
            assert devices.differences(wanted, read_back) == []


@pytest.mark.parametrize(
    "changed",
    [
        {"drive": {"second_harmonic": 0.1}}, {"friction": {"static": 0.41}}, {"gravity": 1.62},
        {"restitution": 0.31},
    ],
)  # fmt: skip
def test_a_value_that_the_file_would_not_give_back_is_refused(changed):
    bowl = bowls.default()
    ((name, value),) = changed.items()
    own = replace(getattr(bowl, name), **value) if isinstance(value, dict) else value
    with pytest.raises(FeederError, match="not the bowl that was tried"):
        designs.bowl_file(study(replace(bowl, **{name: own})), ())
