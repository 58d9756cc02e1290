"""Faults in what the user gave us; the command line prints each as one line."""

import struct
from collections.abc import Iterable

DAMAGE: tuple[type[Exception], ...] = (  # what other people's readers raise on damaged files
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    LookupError,
    MemoryError,
    NameError,
    NotImplementedError,
    OSError,
    RecursionError,
    RuntimeError,
    StopIteration,
    TypeError,
    ValueError,
    struct.error,
    ImportError,  # of what only odd files need
    SyntaxError,  # lxml's
)


def printable(text: str) -> str:
    """Return a text on one line, with an escape for every letter that a terminal may take for a command.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    letters = " ".join(text.splitlines())
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in letters)


class Detail(str):
    """A remark that calls for no step of the user: documents have it, the command line says it with -v.

    It is a warning like the others for whoever reads a document. Pages keep it folded at the end of its
    chapter.
    """

    __slots__ = ()


class FeederError(Exception):
    """A fault in what the user gave: where it is, what is wrong and how to mend it.

    The line is printable, whatever texts of a file are in it. ``value`` is a text that is right in place of
    the wrong one, where one is likely: the command line prints it with its option, to be typed.

    Parameters
    ----------
    where : object
        The file with line and column, or the argument; ``str`` is taken of it.
    what : str
        Says what is wrong, as the rest of a sentence: 'is empty'.
    mend : str
        Says what to do: 'name a file'.
    value : str, optional
        The text that is right.
    """

    value: str | None = None

    def __init__(self, where: object, what: str, mend: str, *, value: str | None = None) -> None:
        super().__init__(printable(f"{where}: {what} - {mend}"))
        self.where, self.what, self.mend, self.value = where, what, mend, value

    @property
    def lines(self) -> tuple[str, ...]:
        """Return every fault as its own line."""
        return (str(self),)


class MeshError(FeederError):
    """A part file that gives no honest number."""


class SeveralBodiesError(MeshError):
    """A part file of more than one body."""


class ConfigError(FeederError):
    """A value in a YAML file or in an option that cannot be used."""


class ArgumentError(ConfigError):
    """A value that an argument cannot have; ``where`` begins with the argument's name, as a caller knows it.

    The command line names its option instead.
    """


class MissingPackage(ArgumentError):
    """An argument that asks for what a package does that is not installed; its value is not wrong."""


class Faults(FeederError):
    """All faults of one file, reported together.

    Parameters
    ----------
    faults : iterable of FeederError
        One at least.
    """

    def __init__(self, faults: Iterable[FeederError]) -> None:
        Exception.__init__(self, "\n".join(str(fault) for fault in faults))
        self.faults = tuple(faults)

    @property
    def lines(self) -> tuple[str, ...]:
        """Return every fault as its own line."""
        return tuple(str(fault) for fault in self.faults)
