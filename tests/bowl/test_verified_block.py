"""What a bowl file says was tried: it holds for the devices as they are written, and for no others."""

from dataclasses import fields, replace

import pytest
import shapes

from feederscrew import __version__ as VERSION
from feederscrew import bowl as bowls
from feederscrew.bowl.devices import value_text
from feederscrew.bowl.verified import SHARED, body_fingerprint, fingerprint
from feederscrew.output import proof
from feederscrew.part.record import AspectNames
from feederscrew.tooling.devices.kinds import KINDS


def of_one(tmp_path, kind, value):
    (tmp_path / "b.yaml").write_text(f"track:\n  width: 40 mm\ndevices:\n  - {kind}: {value}\n")
    return bowls.read(tmp_path / "b.yaml")


@pytest.mark.parametrize("kind", KINDS)
def test_a_device_written_and_read_back_is_the_same_and_a_changed_one_is_not(tmp_path, kind):
    bowl = of_one(tmp_path, kind, KINDS[kind].example)
    (one,) = bowl.devices
    tried = fingerprint(bowl)
    assert fingerprint(of_one(tmp_path, kind, value_text(one))) == tried
    for own in (each.name for each in fields(one) if each.name not in SHARED):
        value = getattr(one, own)
        if value is None or isinstance(value, float):
            changed = replace(one, **{own: 1.01 * value if value else 0.5})
            assert fingerprint(replace(bowl, devices=(changed,))) != tried, own


def test_what_is_not_given_stands_in_the_fingerprint_as_it_did(tmp_path):
    """The digits that version 0.2.0 gave this file, when what was not given was NaN."""
    (tmp_path / "b.yaml").write_text(
        "devices:\n  - wiper: 6 mm\n  - wiper: {clearance: 6 mm, sweep: 30 deg}\n"
        "  - sorter: {of: A@90, play: 0.5 mm, sees: outline}\n  - yield: {A: 0.9}\n"
    )
    assert fingerprint(bowls.read(tmp_path / "b.yaml")) == "180c20cb2caa5dea"


PART = shapes.part(shapes.box(10, 10, 10))
BOWL = bowls.default()
BLOCK = {
    "status": "holds",
    "wanted": "A@0",
    "target": "10/min",
    "delivered": "12/min",
    "delivered_low": "11/min",
    "delivered_high": "13/min",
    "purity": "1",
    "jams": "0",
    "queue_seconds": "180 s",
    "draws": "20",
    "draws_held": "20",
    "version": f'"{VERSION}"',
    "part": f'"{PART.sha256[:16] or "0" * 16}"',
    "bowl": f'"{fingerprint(BOWL)}"',
}
OPTIONAL = {
    "up": '"A, B"',
    "outcome": "lying",
    "trial_parts": "6",
    "seed": "1",
    "tried": '"2020-02-29"',
    "body": f'"{body_fingerprint(PART)}"',
}


def block(tmp_path, **changes):
    """What is read of a bowl file with this block; a key of None is left out."""
    lines = [f"  {key}: {text}" for key, text in {**BLOCK, **OPTIONAL, **changes}.items() if text is not None]
    (tmp_path / "b.yaml").write_text("\n".join(["verified:", *lines]) + "\n")
    return bowls.verified(tmp_path / "b.yaml")


def void(tmp_path, of=None, asked="A@0", **changes):
    found = block(tmp_path, **changes)
    return list(found.void(of, BOWL, VERSION, asked))


def test_a_block_that_does_not_say_which_units_and_density_is_void_for_a_part(tmp_path):
    """A washer of mm, read as cm, was given the rate of its trial."""
    part = replace(PART, sha256=BLOCK["part"].strip('"'))
    (why,) = void(tmp_path, part, body=None)
    assert "units" in why


@pytest.mark.parametrize("part", [None, replace(PART, sha256=BLOCK["part"].strip('"'))])
def test_a_whole_block_holds(tmp_path, part):
    assert void(tmp_path, part) == []
    assert void(tmp_path, part, **dict.fromkeys(set(OPTIONAL) - {"body"})) == []
    found = block(tmp_path)
    assert (found.purity, found.jams, found.draws, found.up) == (1.0, 0, 20, "A, B")
    assert "12/min (11 to 13) of A@0" in found.sentence


NEVER = ("", "nan", ".inf", "-5", "-1/min", "1e400", "1_0", "٣", "[1]", "{a: 1}", '"\\e[31m"', '"a\\nb"')
WRONG = {
    "status": ("none", "Holds", "true"),
    "wanted": (f'"{"A" * 300}"',),
    "target": ("10", "1e9/min", "10 mm"),
    "delivered": ("12", "14/min", "10/min", "1e9/min", "0/min"),
    "delivered_low": ("12.5/min", "11 s", "5/min"),
    "delivered_high": ("11.5/min", "1e7/min"),
    "purity": ("500 %", "1.01", "0.5", "0", "none", "1/min"),
    "jams": ("-3", "3", "1.5", "1e1", "10" * 15),
    "queue_seconds": ("0 s", "180", "1e30 s", "-1 s"),
    "draws": ("0", "19", "100", "1" + 23 * "0", "20.5"),
    "draws_held": ("21", "10", "1" + 23 * "0"),
    "version": ("2", "x", '"0.2.0 or so"'),
    "part": ("abc", '"zcb9e5277f2576a5"', '"0"', f'"{"0" * 65}"'),
    "bowl": ("abc", '"0"', '"0000000000000000"'),
    "outcome": ("standing", "hanging"),  # the bowl has no rails
    "trial_parts": ("0", "1.5", "10" * 15),
    "seed": ("1.5",),
    "tried": ("2026-13-01", "yesterday", "2999-12-31", "2021-02-29"),
    "body": ("abc", '"0"'),
}
# A text may be any name, and a name may look like a number.
NAMES = {"wanted": {"nan", ".inf", "-5", "-1/min", "1e400", "1_0", "٣"}, "up": set(NEVER)}


@pytest.mark.parametrize(
    "key, text",
    [
        (key, text)
        for key in (*BLOCK, *OPTIONAL)
        for text in (*NEVER, *WRONG.get(key, ()))
        if text not in NAMES.get(key, ())
    ],
)
def test_a_block_that_cannot_be_true_is_void(tmp_path, key, text):
    said = void(tmp_path, **{key: text})
    assert len(said) >= 1, text
    line = "; ".join(said)
    assert line.isprintable() and not any(word in line for word in ("nan", "500", "-5", "-3", "1" + 23 * "0"))


@pytest.mark.parametrize("key", BLOCK)
def test_a_block_without_a_field_is_void(tmp_path, key):
    assert f"it has no {key}" in void(tmp_path, **{key: None})


def test_a_trial_counts_for_what_was_wanted_and_for_nothing_else(tmp_path):
    for wanted in ("A", "A@0", "a@0", None):
        assert void(tmp_path, asked=wanted, up=None) == []
    for wanted in ("B", "B@0", "A@90", "A@1"):
        assert "another orientation" in void(tmp_path, asked=wanted, up=None)[0]
    for wanted in ("B", "B@90", "A@90"):
        assert void(tmp_path, asked=wanted) == []
    (several,) = [block(tmp_path, up=None, wanted='"A@0 or B"')]
    assert several.counts("B@7") and several.counts("A@0") and not several.counts("A@90")
    assert void(tmp_path, asked="C")


def test_parts_leave_rails_hanging_and_other_devices_lying(tmp_path):
    rails = KINDS["rails"]("b.yaml", span=(1e-3, 5e-3))
    for devices, outcome in (((), "lying"), ((rails,), "hanging")):
        bowl = replace(BOWL, devices=devices)
        for said in ("lying", "hanging"):
            found = block(tmp_path, outcome=said, bowl=f'"{fingerprint(bowl)}"')
            why = list(found.void(None, bowl, VERSION))
            assert why == (
                [] if said == outcome else [f"its outcome is {said}, and parts leave these devices {outcome}"]
            )


def test_another_density_or_name_is_another_part(tmp_path):
    same = replace(PART, sha256=BLOCK["part"].strip('"'))
    for other in (
        replace(same, mass=2.0 * same.mass),
        replace(same, centre_of_mass=same.centre_of_mass + 0.001),
        replace(same, names=AspectNames("n.yaml", "", (("top", (0.0, 0.0, 1.0)),))),
    ):
        assert void(tmp_path, other) and void(tmp_path, same) == []


def test_a_block_that_is_no_mapping_is_void(tmp_path):
    for text in ("verified:\n", "verified: 3\n", "verified: [1, 2]\n"):
        (tmp_path / "b.yaml").write_text(text)
        assert "mapping" in next(bowls.verified(tmp_path / "b.yaml").void(None, BOWL, VERSION))


def test_a_queue_that_nothing_left_has_no_purity(tmp_path):
    nothing = {"delivered": "0/min", "delivered_low": "0/min", "delivered_high": "0/min"}
    found = block(tmp_path, status="falls short", purity="none", **nothing)
    assert found.purity is None and "nothing left" in found.sentence and "nan" not in found.sentence


@pytest.mark.parametrize("wanted, leads", [("A@0", True), ("B@0", False), ("A@90", False)])
def test_a_trial_leads_for_its_own_orientation_only(tmp_path, wanted, leads):
    """The trial of A@0 was given as the rate of B."""
    part = replace(PART, sha256=BLOCK["part"].strip('"'))
    tried, own = block(tmp_path, up=None), {"parts_per_minute": 105.5}
    document = proof.with_trial(own, tried, part, BOWL, wanted)
    assert document["parts_per_minute"] == pytest.approx(12.0 if leads else 105.5)
    assert (document["verified"] is not None) == leads
    (said,) = proof.warnings(tried, part, BOWL, wanted)
    assert ("its trial delivers 12/min" in said) == leads and ("void: A@0 was tried" in said) != leads


def test_a_trial_leads_where_by_the_rule_nothing_leaves(tmp_path):
    """A screw hung between rails in its trial, 141 a minute; by the rule it lies, and none leaves."""
    part = replace(PART, sha256=BLOCK["part"].strip('"'))
    document = proof.with_trial({"parts_per_minute": 0.0}, block(tmp_path, up=None), part, BOWL, "A@0")
    assert document["parts_per_minute"] == pytest.approx(12.0) and document["parts_per_minute_static"] == 0.0
