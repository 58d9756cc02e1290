"""What several test files share."""

import signal

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import settings

from feederscrew.dropping.plate import arrival
from feederscrew.studies import aspects
from feederscrew.studies.simulated import memory
from feederscrew_cli.main import feeder

# A shell that starts the tests in the background ignores these, and so would every command they start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

settings.register_profile("same", derandomize=True, deadline=None)
settings.load_profile("same")  # the same examples everywhere: new ones are for `make fuzz` to look for


def pytest_collection_modifyitems(items):
    """Begin with what takes longest, so that no process is left with it when the others are done."""
    items.sort(key=lambda item: item.get_closest_marker("long") is None)


@pytest.fixture(autouse=True)
def few(request, monkeypatch):
    """Drop and feed few parts where a test does not ask how many, unless it is marked ``thorough``."""
    if request.node.get_closest_marker("thorough"):
        memory.forget()
        yield
        memory.forget()
        return
    monkeypatch.setattr(aspects, "MOST", 500)
    for name in ("FIRST", "MOST", "LONGEST"):
        monkeypatch.setattr(arrival, name, 60)
    yield


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run one ``feeder`` command line inside an empty folder; gives click's result."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments, stdin=None):
        return CliRunner().invoke(feeder, [str(argument) for argument in arguments], input=stdin)

    return call


@pytest.fixture
def rng():
    """One seed for every test that needs chance."""
    return np.random.default_rng(20260101)
