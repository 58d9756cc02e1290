"""What a bowl file says was tried: it holds for the devices as they are written, and for no others."""

from dataclasses import fields, replace

import pytest

from feederscrew import bowl as bowls
from feederscrew.bowl.devices import value_text
from feederscrew.bowl.verified import SHARED, fingerprint
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
        if isinstance(value, float):
            changed = replace(one, **{own: 1.01 * value if value == value and value else 0.5})
            assert fingerprint(replace(bowl, devices=(changed,))) != tried, own


def test_another_view_or_climb_or_bank_is_another_bowl(tmp_path):
    """Each of them once left what was tried as it was."""
    pairs = (
        ("sorter", "{of: A@90, play: 1 mm, sees: outline}", "{of: A@90, play: 1 mm, sees: side}"),
        ("separation", "{climb: -6 deg}", "{climb: -2 deg}"),
        ("bank", "6 deg", "8 deg"),
    )
    for kind, first, second in pairs:
        assert fingerprint(of_one(tmp_path, kind, first)) != fingerprint(of_one(tmp_path, kind, second))
