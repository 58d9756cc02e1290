"""Every example of docs/method/conveying.md prints what the page says; samples of what it computed hold."""

import doctest
import importlib.util
from pathlib import Path

import numpy as np

from feederscrew.conveying import steady
from feederscrew.conveying.operating_point import Numbers, with_numbers

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "conveying.md"


def computed():
    """The script that fills the page."""
    spec = importlib.util.spec_from_file_location("conveying_map", DOCS / "conveying_map.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_true():
    found = doctest.testfile(str(DOCS / "method/conveying.md"), module_relative=False)
    assert found.attempted > 8
    assert found.failed == 0


def test_the_tables_are_as_computed():
    script, page = computed(), PAGE.read_text()
    for row in script._row(0.0, 30, 0.4), script._row(0.2, 40, 0.8):
        assert row in script.METHOD.read_text()
    assert script.phases() in page


def test_the_map_is_as_computed():
    shown = np.loadtxt(DOCS / "conveying_map.csv", delimiter=",", skiprows=1)
    assert shown.shape == (3500, 5)
    out = np.empty(steady.COLUMNS)
    for coupling, steepness, throw, restitution, velocity in shown[shown[:, 3] == 0.0][::97]:
        setting = with_numbers(Numbers(coupling, steepness, throw, restitution), 0.5)
        steady.survey(setting, out)
        assert abs(out[steady.VELOCITY] / np.cos(setting.angle) - velocity) < 5e-3  # four digits of coupling
