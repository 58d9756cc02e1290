"""Signatures of the library's functions as ``help()`` shows them: on lines that fit a screen."""

import inspect
import re
import textwrap
from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])
LINE_LETTERS = 100  # of a line of parameters
# Arguments of a function, or fields of a record that ``replace`` changes, by name. They are handed on with
# ``**`` where it is known only as it runs which of them are given: types of the values are not checked.
Keywords = dict[str, Any]
MODULES = re.compile(r"\b(?:[a-z_]\w*\.)+(?=\w)")  # 'collections.abc.' of a type's name


class ShownSignature(inspect.Signature):
    """A signature whose text is broken into lines, with types by their own names alone."""

    def __str__(self) -> str:
        text = MODULES.sub("", super().__str__()).replace("NoneType", "None")
        if len(text) <= LINE_LETTERS:
            return text
        inner, _, returned = text.removeprefix("(").rpartition(")")
        parameters = textwrap.wrap(
            inner,
            LINE_LETTERS,
            break_long_words=False,
            break_on_hyphens=False,
            initial_indent="    ",
            subsequent_indent="    ",
        )
        return "\n".join(["(", *parameters, f"){returned}"])


def with_shown_signature(function: Function) -> Function:
    """Return a function whose ``help()`` has lines that fit a screen; a decorator.

    Parameters
    ----------
    function : callable
        Its parameters stay the same; ``__signature__`` is set on it.

    Returns
    -------
    callable
        The function given.
    """
    signature = inspect.signature(function)
    shown = ShownSignature([*signature.parameters.values()], return_annotation=signature.return_annotation)
    function.__signature__ = shown  # type: ignore[attr-defined]
    return function
