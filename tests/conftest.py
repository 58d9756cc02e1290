"""What several test files share."""

import base64
import contextlib
import gc
import importlib.util
import json
import os
import shutil
import signal
from collections import OrderedDict

import compile_first
import entered
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import settings

from feederscrew.arrivals import arrival, simulation_cache
from feederscrew.arrivals import aspects_study as aspects
from feederscrew.output import shading as shading_output
from feederscrew.output import style
from feederscrew_cli.main import feeder

# A shell that starts the tests in the background ignores these, and so would every command they start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

os.environ["FEEDER_CACHE"] = ""  # what tests simulate is kept by none of their commands

settings.register_profile("same", derandomize=True, deadline=None)
settings.load_profile("same")  # the same examples everywhere: new ones are for `make fuzz` to look for


PIXEL = base64.b64decode(  # a picture as small as it can be
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="
)
COARSE = 40  # pixels of a picture to the inch of its figure
COMPILING = pytest.StashKey()


def pytest_configure(config):
    """Let ``entered``, which watches what is imported after it, print its figure."""
    config.pluginmanager.register(entered)


def pytest_sessionstart(session):
    """Compile for all processes before they begin, where the whole suite is run by several."""
    config = session.config
    whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    if whole and config.getoption("numprocesses", None) and not hasattr(config, "workerinput"):
        config.stash[COMPILING] = compile_first.compile_side_by_side()


def pytest_sessionfinish(session):
    """Wait for what is still compiled."""
    if COMPILING in session.config.stash:
        session.config.stash[COMPILING].wait()


EARLY = ("base", "cad", "arrivals", "motion", "resting", "part", "feeding", "thesis")


def _early(item):
    """Whether a test runs without the trial: as one of a stage before it, or of the bowl as a solid."""
    return item.path.parent.name in EARLY and item.path.name not in ("test_on_mesh.py", "test_naming.py")


# What `make test` does not install, and how to get it; a test that needs it skips without it.
EXTRAS = {
    "OCP": "pip install 'feederscrew[cad]'", "pinocchio": "pip install 'feederscrew[oracle]'",
    "pint": "pip install pint", "nbclient": "pip install 'feederscrew[docs]'",
    "chromium": "install Debian's package chromium", "prusa-slicer": "install Debian's package prusa-slicer",
}  # fmt: skip


@pytest.hookimpl(tryfirst=True)  # before pytest selects by markers
def pytest_collection_modifyitems(items):
    """Mark what needs an extra, skip it where that is missing, and put all in order."""
    for item in items:
        for name in (name for marker in item.iter_markers("needs") for name in marker.args):
            mend = EXTRAS.get(name, "pip install 'feederscrew[test]'")
            if name in EXTRAS:
                item.add_marker("extra")
            is_program = mend.startswith("install")
            if (shutil.which(name) if is_program else importlib.util.find_spec(name)) is None:
                item.add_marker(pytest.mark.skip(reason=f"needs {name}: {mend}"))
    _sort(items)


def _sort(items):
    """Let every process begin with tests that run while the trial is compiled, then with what takes longest.

    pytest-xdist hands each process one stretch of the list, all as long: files are dealt out to as many.
    """
    files = {}
    for item in sorted(items, key=lambda item: (not _early(item), item.get_closest_marker("long") is None)):
        files.setdefault((item.path, _early(item), item.get_closest_marker("long") is None), []).append(item)
    count = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    stretches, room = [[] for _ in range(count)], len(items) // count
    for tests in files.values():
        fits = [one for one in stretches[:-1] if len(one) + len(tests) <= room]
        min([*fits, stretches[-1]], key=len).extend(tests)
    items[:] = [item for one in stretches for item in one]


def pytest_collection_finish():
    """Collect garbage seldom, and not among what has been imported by now: it all stays."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)


@pytest.fixture(scope="session")
def trial_compiled():
    """The trial, once it is compiled."""
    compile_first.wait_for_the_trial()


@pytest.fixture(autouse=True)
def _compiled(request):
    if not _early(request.node):
        request.getfixturevalue("trial_compiled")


COUNTS = (  # of parts that are dropped or fed where nobody says how many
    (aspects, "MAX_DROPS"),
    *((arrival, name) for name in ("FIRST_PARTS", "MAX_ARRIVALS", "LONGER_TIME_PARTS")),
)
MANY = [getattr(module, name) for module, name in COUNTS]


def _set(patch, dropped, *fed):
    for (module, name), value in zip(COUNTS, (dropped, *(fed * 3)[:3]), strict=True):
        patch.setattr(module, name, value)


@pytest.fixture(scope="session", autouse=True)
def few():
    """Drop and feed few parts where a test does not ask how many."""
    with pytest.MonkeyPatch.context() as patch:
        _set(patch, 500, 60)
        yield


@pytest.fixture(scope="session")
def fewer():
    """A context in a test that is marked ``thorough`` for what is read by its headings alone."""

    @contextlib.contextmanager
    def context():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(simulation_cache, "_RECORDS", OrderedDict())
            _set(patch, 100, 20)
            yield

    return context


@pytest.fixture(autouse=True)
def many(request, monkeypatch):
    """As many as for a user in a test that is marked ``thorough``."""
    is_thorough = request.node.get_closest_marker("thorough")
    if is_thorough:
        simulation_cache.forget()
        _set(monkeypatch, *MANY)
    yield
    if is_thorough:
        simulation_cache.forget()


@pytest.fixture(scope="module", autouse=True)
def coarse(request):
    """Pictures with few pixels, or one, but where a file of tests looks at them."""
    with pytest.MonkeyPatch.context() as patch:
        if getattr(request.module, "UNDRAWN", False):
            patch.setattr(style, "png", lambda figure: PIXEL)
        if not getattr(request.module, "LOOKED_AT", False):
            patch.setattr(style, "DPI", COARSE)
            patch.setattr(shading_output, "RAYS_PER_PIXEL", 1)
            patch.setattr(shading_output, "PAIR_SAMPLES", 1)
        yield


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run one ``feeder`` command line inside an empty folder; gives click's result."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("feederscrew_cli.progress.LINE_EVERY_S", 1e9)  # what a slow machine says of itself

    def call(*arguments, stdin=None):
        return CliRunner().invoke(feeder, [str(argument) for argument in arguments], input=stdin)

    return call


@pytest.fixture
def run_json(run):
    """Run one ``feeder`` command line that has to end well; gives its answer as JSON."""

    def call(*arguments, **own):
        done = run(*arguments, "--format", "json", **own)
        assert done.exit_code == 0, done.output
        return json.loads(done.stdout)

    return call


@pytest.fixture
def rng():
    """One seed for every test that needs chance."""
    return np.random.default_rng(20260101)
