"""The call of ``feeder design`` for a request: as it was typed with options changed, or from the request."""

import shlex
from collections.abc import Callable, Iterable, Sequence

from feederscrew.base.units import DEG, HOUR, MINUTE, MM
from feederscrew.bowl.device_list import DEVICES_SECTION
from feederscrew.bowl.reading import Setting
from feederscrew.designing.record import DesignRequest
from feederscrew.part.record import Part

PROGRAM, COMMAND = "feeder", "design"
USUAL_UNITS = "mm"  # of a file, where the call says nothing
FOLDER = ("-o", "results")  # of the files of a design, beside its part


def _target(request: DesignRequest) -> str:
    return f"{MINUTE * request.target:.6g}/min"


def _heading(request: DesignRequest) -> str | None:
    return None if request.heading is None else f"{request.heading / DEG:.6g}deg"


def _diameter(request: DesignRequest) -> str | None:
    ends = request.diameter
    return None if ends is None else ":".join(f"{end / MM:.6g}mm" for end in ends)


# options of the command by name: what of a request each says, None where it is not given
OPTIONS: dict[str, Callable[[DesignRequest], str | None]] = {
    "--target": _target,
    "--aspect": lambda request: request.aspect,
    "--heading": _heading,
    "--up": lambda request: ",".join(request.up) or None,
    "--outcome": lambda request: str(request.outcome),
    "--without": lambda request: ",".join(request.without) or None,
    "--drive": lambda request: str(request.drive),
    "--diameter": _diameter,
    "--tolerance": lambda request: f"{request.tolerance / MM:.6g}mm",
    "--trials": lambda request: f"{request.budget}",
    "--draws": lambda request: f"{request.draws}",
    "--agreed-jams": lambda request: f"{HOUR * request.agreed_jams:.6g}/h",
    "--proof": lambda request: str(request.proof),
    "--rule": lambda request: request.rule,
    "--seed": lambda request: f"{request.seed}",
}
FLAGS: dict[str, Callable[[DesignRequest], bool]] = {
    "--alternatives": lambda request: request.alternatives,
    "--quick": lambda request: request.quick,
}
FORMER = {"--budget": "--trials"}  # options by a name that they once had


def call_text(words: Sequence[str]) -> str:
    """Return a call as one types it, each word quoted where a shell needs that.

    Parameters
    ----------
    words : sequence of str

    Returns
    -------
    str
    """
    return shlex.join(words)


def call_words(request: DesignRequest, part: Part, settings: Iterable[Setting] = ()) -> tuple[str, ...]:
    """Return the words of the call that asks for a design, where none was typed.

    Parameters
    ----------
    request : DesignRequest
    part : Part
    settings : iterable of Setting
        Of the bowl, as the user gave them; devices are left out, which only a file can say.

    Returns
    -------
    tuple of str
        From 'design' on, without a folder.
    """
    usual, words = DesignRequest(request.target), [COMMAND, part.source]
    if part.units != USUAL_UNITS:
        words += ["--units", part.units]
    if part.density is not None and "default" not in part.material:
        words += ["--density", part.material]
    for name, text in OPTIONS.items():
        value = text(request)
        if value is not None and (name == "--target" or value != text(usual)):
            words += [name, value]
    words += [name for name, is_asked in FLAGS.items() if is_asked(request)]
    own = (each for each in settings if each.is_own and each.key.field != DEVICES_SECTION)
    return (*words, *(word for each in own for word in ("--set", f"{each.key.name}={each.text}")))


def call_of(
    request: DesignRequest,
    former: DesignRequest,
    call: Sequence[str],
    settings: Iterable[tuple[str, str]] = (),
) -> tuple[str, ...]:
    """Return the words of the call that asks for a request, with a folder for its files.

    Parameters
    ----------
    request : DesignRequest
        What is asked for.
    former : DesignRequest
        What was asked for.
    call : sequence of str
        The words that asked for ``former``, from 'design' on.
    settings : iterable of (str, str)
        Keys of the bowl with their values, beside those of the call.

    Returns
    -------
    tuple of str
        From 'feeder' on. Every option that is not changed stands in it as it was typed.
    """
    changed = changed_options(request, former)
    words = [PROGRAM, *_without(call, changed)]
    words += [word for name, text in changed.items() if text is not None for word in (name, text) if word]
    words += [word for key, text in settings for word in ("--set", f"{key}={text}")]
    return (*words, *FOLDER)


def changed_options(request: DesignRequest, former: DesignRequest) -> dict[str, str | None]:
    """Return the options of the command in which two requests differ.

    Parameters
    ----------
    request : DesignRequest
        What is asked for.
    former : DesignRequest
        What was asked for.

    Returns
    -------
    dict of str to str or None
        The value of each in ``request``: None of one that is not given there, '' of a flag that is.
    """
    changed = {name: text(request) for name, text in OPTIONS.items() if text(request) != text(former)}
    flags = (name for name, is_asked in FLAGS.items() if is_asked(request) != is_asked(former))
    return changed | {name: "" if FLAGS[name](request) else None for name in flags}


def _without(call: Sequence[str], options: Iterable[str]) -> list[str]:
    """The words of a call without some options and their values, nor the folder that it named."""
    left_out, words, skip = {*options, "-o", "--output"}, [], False
    for word in call:
        if skip:
            skip = False
            continue
        name, equals, _ = word.partition("=")
        name = FORMER.get(name, name)
        if name in left_out or (word.startswith("-o") and not word.startswith("--")):
            # the value of an option stands behind it, or in the same word
            skip = not equals and name in left_out and name not in FLAGS
            continue
        words.append(word)
    return words
