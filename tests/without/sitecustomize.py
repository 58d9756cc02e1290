"""Hide packages and programs, as if they were not installed: those that TESTS_WITHOUT names.

Python runs this file at its start where the folder is on PYTHONPATH: ``make test-without`` puts it there, so
that commands which the tests start are without them as well.
"""

import os
import shutil
from importlib.machinery import PathFinder

HIDDEN = frozenset(os.environ.get("TESTS_WITHOUT", "").split(","))
_find_spec, _which = PathFinder.find_spec, shutil.which


def find_spec(finder, name, path=None, target=None):
    """Find a module, unless it or its package is hidden: as ``PathFinder.find_spec``."""
    return None if name.partition(".")[0] in HIDDEN else _find_spec(name, path, target)


def which(command, *arguments, **keywords):
    """Find a program, unless it is hidden: as ``shutil.which``."""
    return None if command in HIDDEN else _which(command, *arguments, **keywords)


PathFinder.find_spec, shutil.which = classmethod(find_spec), which  # type: ignore[assignment]
