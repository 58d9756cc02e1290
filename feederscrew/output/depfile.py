"""Rules for make: what results are made from, in the form that compilers write."""

import os
import tempfile
from pathlib import Path

from feederscrew.errors import FeederError


def write(path, targets, inputs) -> None:
    """Write one rule, and an empty one for each input so that make goes on when it is gone.

    Parameters
    ----------
    path : str or Path
        The file to be included by a Makefile; replaced whole.
    targets, inputs : iterable of str or Path
        What is made, and from what.

    Raises
    ------
    FeederError
        If the file cannot be written.
    """
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, staged = tempfile.mkstemp(dir=path.parent, prefix=".depfile.")
        with os.fdopen(handle, "wb") as file:
            file.write(os.fsencode(rule(targets, inputs)))
        Path(staged).chmod(0o644)
        Path(staged).replace(path)
    except OSError as error:
        raise FeederError(path, f"cannot be written ({error.strerror})", "give another `depfile`") from error


def rule(targets, inputs) -> str:
    """Return the text of the rule."""
    target_words, input_words = ([_escaped(path) for path in paths] for paths in (targets, inputs))
    lines = [
        " ".join(target_words) + ": " + " \\\n  ".join(input_words),
        *(f"{path}:" for path in input_words),
    ]
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _escaped(path) -> str:
    """A path with what make takes for its own marked."""
    text = Path(path).as_posix().replace("$", "$$")
    return "".join(f"\\{letter}" if letter in " #:%" else letter for letter in text)
