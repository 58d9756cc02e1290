"""Every record that draws itself finds the module that offers its files: one had moved, and no test asked."""

from importlib import import_module

import pytest

from feederscrew.output import record_views


@pytest.mark.parametrize("name", record_views.OF)
def test_the_files_of_a_record_are_offered_where_it_looks(name):
    module, function, *_ = record_views.OF[name]
    assert callable(getattr(import_module(f"feederscrew.output.{module}"), function))
