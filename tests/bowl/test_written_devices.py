"""What is written of a device is what was tried: each attribute of each kind, drawn, moved, read back."""

import math
from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew import documents
from feederscrew.bowl import devices
from feederscrew.bowl.reading import settings_of_text
from feederscrew.designing import proposals
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.errors import FeederError
from feederscrew.output import designs
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.devices.pneumatics import SENSOR_VIEWS
from feederscrew.tooling.isolating.chain import Cut

NAMES = ("A", "b 2", "side: up", "x, y", "[C]", "Größe", "#1")


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
        return pick(NAMES), number(0.0, 2.0 * math.pi)

    (x, y, wide, high), first = (length() for _ in range(4)), length()
    hole = ((x, y), (x + wide, y), (x + wide, y + high), (x, y + high))
    jet = {"nozzle": length(1e-4), "pressure": number(1e3, 1e6), "height": length()}
    span = (first, first + length())
    contour = ((0.0, 2e-2), (length(), 1.5e-2), (3e-2, length()))
    values = {
        "wiper": lambda: {"limit": length(), **some(sweep=number(0.1, 1.5), friction=number(0.0, 2.0),
                                                    contour=contour)},
        "slot": lambda: {"span": span},
        "rails": lambda: {"span": span,
                          **some(lead=(span[0] - 5e-4, span[1] + length(), length(), length()))},
        "cut_out": lambda: {"corners": hole},
        "profile": lambda: pick(({"corners": hole}, {"like": (*like(), length())})),
        "groove": lambda: {"angle": number(0.2, 1.0)},
        "bank": lambda: {"angle": number(0.0, 0.7)},
        "separation": lambda: {"angle": number(-0.7, 0.7)},
        "yield": lambda: {"shares": tuple((name, float(rng.random())) for name in NAMES[:3])},
        "jet": lambda: jet,
        "sorter": lambda: {
            "like": (*like(), length()), "sees": pick(SENSOR_VIEWS),
            **some(also=(like(), like()), resolution=length(), **jet, time=number(1e-3, 1.0),
                   nozzles=float(rng.integers(1, 21))),
        },
    }  # fmt: skip
    return KINDS[kind]("drawn", **values.get(kind, lambda: {"limit": length()})()).rewritten()


def read(device):
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
        first, second = read(device), read(device)
        assert devices.differences(device, first) == []
        assert all(getattr(first, one.name) == getattr(second, one.name) for one in fields(device))
        devices.check_written((device,), "b.yaml")


@pytest.fixture(scope="module")
def lying():
    part = shapes.part(shapes.box(20, 12, 5))
    return proposals.known_through(part, find(part), bowls.default()).lying


@pytest.mark.parametrize("kind", sorted(name for name, kind in KINDS.items() if kind.bound))
def test_a_value_that_is_moved_or_rounded_leaves_all_others_as_they_are(kind, lying):
    rng = np.random.default_rng(7)
    for _ in range(10):
        device = draw(kind, rng)
        if getattr(device, "contour", ()):
            continue  # a contour stands for the number
        cut = Cut(device, 1e-3, 1e-3, device, device, ())
        for other in (proposals.moved(cut, 1.1 * device.limit, lying, 0), proposals.rounded(cut, lying, 0)):
            assert devices.differences(other.device, read(other.device)) == []
            assert devices.differences(device, read(other.device), ("where", "text", "limit")) == []
            assert other.device.limit == pytest.approx(read(other.device).limit)


def test_a_wiper_that_clears_itself_is_written_so(lying):
    """Not as '11.3 mm', which is straight across the track, and stops what it should sweep off."""
    wiper = KINDS["wiper"].proposal("design", 0.01128).rewritten()
    cut = Cut(wiper, 1e-3, 1e-3, wiper, wiper, ())
    for other in (proposals.moved(cut, 0.0113, lying, 0), proposals.rounded(cut, lying, 0)):
        assert other.device.text == "{clearance: 11.3 mm, sweep: 30 deg}"


def test_play_pulse_and_slot_leave_all_others_as_they_are():
    rng = np.random.default_rng(3)
    for _ in range(30):
        sorter, rails = draw("sorter", rng), draw("rails", rng)
        for other, changed in (
            (sorter.with_play(2e-3), {"like", "also"}),  # headings to a millionth of a degree
            (sorter.with_pulse(0.02), {"time"}),
            (rails.with_span((rails.span[0] + 1e-4, rails.span[1])), {"span"}),
        ):
            assert devices.differences(other, read(other)) == []
            own = sorter if other.kind == "sorter" else rails
            assert devices.differences(own, read(other), {"where", "text", *changed}) == []
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
        {"drive": {"second_harmonic": 0.1}},
        {"friction": {"static": 0.41}},
        {"gravity": 1.62},
        {"restitution": 0.31},
    ],
)
def test_a_value_that_the_file_would_not_give_back_is_refused(changed):
    bowl = bowls.default()
    ((name, value),) = changed.items()
    own = replace(getattr(bowl, name), **value) if isinstance(value, dict) else value
    with pytest.raises(FeederError, match="not the bowl that was tried"):
        designs.bowl_file(study(replace(bowl, **{name: own})), ())
