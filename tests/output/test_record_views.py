"""What a record shows: each has its view, and each view has its files."""

from importlib import import_module
from pathlib import Path

import pytest

import feederscrew as fs
from feederscrew.output import record_views
from feederscrew.studies.tooling import tooling


@pytest.mark.parametrize("name", [name for name, view in record_views.VIEWS.items() if view.offers])
def test_the_files_of_a_record_are_offered_by_a_function_that_is_there(name):
    """Those of a ToolingStudy stood in a module that had gone: it had no table."""
    module, _, function = record_views.VIEWS[name].offers.rpartition(".")
    assert callable(getattr(import_module(f"feederscrew.output.{module}"), function))


def test_a_study_of_tooling_has_a_table():
    part = fs.load(Path(__file__).parents[2] / "parts/squarenut_m5.stl")
    study = tooling(part, fs.read_bowl(), "A", rule="csa", seconds=1.0, verdicts=20)
    assert {"aspect", "share"} <= set(study.to_frame().columns)
