"""Devices are named as the trade does, with their values in words; files keep kinds and values."""

import numpy as np
import pytest

from feederscrew.tooling.devices.kinds import make_device

CORNERS = ((0.0, 0.0), (12e-3, 3e-3), (14e-3, 9e-3))


@pytest.mark.parametrize(
    ("kind", "values", "name", "words"),
    [
        ("separation", {"angle": np.radians(-6.0)}, "spacing section", "goes down at 6 deg"),
        ("separation", {"angle": np.radians(3.0)}, "spacing section", "climbs at 3 deg"),
        ("jet", {"height": 8e-3}, "air jet", "nozzle of 2 mm at 0.2 bar, 8 mm over the track"),
        ("cut_out", {"corners": CORNERS}, "cut-out", "polygon of 3 corners"),
        ("narrowed_track", {"limit": 9e-3}, "narrowed track", "9 mm"),
        ("pressure_break", {"limit": 9.25e-3}, "pressure break", "9.25 mm"),
        ("height_bar", {"limit": 6e-3}, "height bar", "6 mm over the track"),
        ("wiper", {"limit": 6e-3}, "wiper", "6 mm over the track"),
        (
            "wiper",
            {"limit": 6e-3, "sweep": np.radians(30.0)},
            "wiper",
            "6 mm over the track, swept back 30 deg",
        ),
        ("slot", {"span": (2e-3, 5e-3)}, "slot", "from 2 to 5 mm off the wall"),
        ("rails", {"span": (4.5e-3, 8.5e-3)}, "rails", "slot from 4.5 to 8.5 mm off the wall"),
        ("bank", {"angle": np.radians(6.0)}, "banked track", "6 deg towards the wall"),
        ("groove", {"angle": np.radians(30.0)}, "V groove", "both faces rise at 30 deg"),
        ("yield", {"shares": (("A", 0.9), ("B", 0.1))}, "measured yield", "passes 90 % of A, 10 % of B"),
    ],
)
def test_a_device_has_a_name_of_the_trade_and_a_value_in_words(kind, values, name, words):
    device = make_device(kind, "here", **values).rewritten()
    assert (device.name, device.full_name, device.value_words) == (name, name, words)


@pytest.mark.parametrize(
    ("sees", "name", "what"),
    [
        ("outline", "vision reject (camera from above)", "outlines"),
        ("side", "vision reject (camera from the side)", "side views"),
        ("height", "vision reject (fibre sensor)", "heights"),
        ("relief", "vision reject (laser along the middle)", "height profiles"),
    ],
)
def test_a_vision_reject_says_what_sees_what_it_keeps_and_what_it_rejects(sees, name, what):
    like, also = ("A", np.radians(187.672), 8.35e-3), (("A", np.radians(353.592)), ("B", np.radians(359.8)))
    device = make_device("sorter", "here", like=like, also=also, sees=sees).rewritten()
    assert device.full_name == name
    keeps = "keeps A at heading 188 and 354 deg and B at heading 0 deg"
    words = f"{keeps}, rejects {what} that differ by more than 8.35 mm"
    assert device.value_words == words
    assert device.with_pulse(0.02).value_words == f"{words}, air for 20 ms"
