"""Options: the kinds of values they take, how one is declared, and every option that two commands share."""

import functools
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import click

from feederscrew_cli.talk import PRINT_FORMATS, Output, typed

MICRO_SIGNS = str.maketrans("\u00b5\u03bc", "uu")  # the sign of its own, and the Greek letter
WHOLE_NUMBER = re.compile(r"[+-]?[0-9]{1,30}")
DECIMAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
MAX_ANGLE_RAD = 20.0 * math.pi  # further round, rounding begins to tell
TITLE_LETTERS = 40  # of a field of the title block
Values = dict[str, Any]  # of a group of options, by the argument that each is


class WrongValue(click.BadParameter):
    """A value of an option that is wrong; ``value`` is the one that is likely meant."""

    def __init__(self, what: str, mend: str, value: str | None = None, **keywords: Any) -> None:
        super().__init__(f"{what} - {mend}", **keywords)
        self.what, self.value = what, value

    def format_message(self) -> str:
        """Return the line, with the whole option to be typed where its value is known."""
        if self.value is None or not isinstance(self.param, click.Option):
            return super().format_message()
        text = f"{self.what} - write {typed(self.param.opts, self.value)}"
        return click.BadParameter(text, self.ctx, self.param, self.param_hint).format_message()


class Place(click.Path):
    """A path; the library says what is wrong with it, unless it is none, as of an unset shell variable."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the path as typed, or refuse an empty one as a wrong call.

        Parameters
        ----------
        value, param, ctx
            As click gives them.

        Returns
        -------
        str
        """
        if not value:
            self.fail("is empty - give a path", param, ctx)
        return super().convert(value, param, ctx)


class LengthUnit(click.Choice):
    """A unit of a file; that of a micrometre also with its sign."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the unit, or refuse another word as a wrong call.

        Parameters
        ----------
        value, param, ctx
            As click gives them.

        Returns
        -------
        str
        """
        return super().convert(value.translate(MICRO_SIGNS) if isinstance(value, str) else value, param, ctx)


class Number(click.FloatRange):
    """A number within limits, of the digits 0 to 9; not 'nan', which is within any."""

    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number, or refuse it as a wrong call.

        Parameters
        ----------
        value, param, ctx
            As click gives them.

        Returns
        -------
        float
        """
        if isinstance(value, str) and not DECIMAL.fullmatch(value.strip()):
            self.fail(f"{value!r} is not a number - write digits with a decimal point, as in 0.4", param, ctx)
        return _within(super().convert, value, self, param, ctx)


class Whole(click.IntRange):
    """A whole number within limits, of the digits 0 to 9: Python takes those of other scripts, and '1_0'."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number, or refuse it as a wrong call.

        Parameters
        ----------
        value, param, ctx
            As click gives them.

        Returns
        -------
        int
        """
        if isinstance(value, str) and not WHOLE_NUMBER.fullmatch(value.strip()):
            example = str(10 if self.max is None or self.max >= 10 else self.max)
            what, mend = f"{value!r} is not a valid whole number", f"write digits, as {example}"
            raise WrongValue(what, mend, example, ctx=ctx, param=param)
        return _within(super().convert, value, self, param, ctx)


def _within(
    convert: Callable, value: Any, kind: Any, param: click.Parameter | None, ctx: click.Context | None
) -> Any:
    """The number of a text; out of range the nearest bound is what mends it."""
    try:
        return convert(value, param, ctx)
    except click.BadParameter as error:
        number = float(value)
        bound = kind.min if kind.min is not None and number < kind.min else kind.max
        if bound is None or kind.min_open or kind.max_open:
            raise
        what, mend = error.message.rstrip("."), f"give {bound:g}"
        raise WrongValue(what, mend, f"{bound:g}", ctx=ctx, param=param) from None


def quantity_type(
    dimension: str, *, positive: bool = False, most: float = math.inf
) -> Callable[[str | float], float]:
    """Return the type of an option that takes a quantity: '0.5 mm', '120/min'.

    Parameters
    ----------
    dimension : str
        Of ``units.UNITS_BY_DIMENSION``.
    positive : bool, optional
        Whether 0 is refused; a number below it always is.
    most : float [SI], optional
        The greatest value.

    Returns
    -------
    callable
        From a text to the number in SI units.
    """

    def read(value: str | float) -> float:
        from feederscrew.base import units

        if not isinstance(value, str):
            return value
        try:
            number = units.quantity(value, dimension)
        except units.QuantityError as fault:
            raise WrongValue(fault.what, fault.mend, fault.value) from None
        if number <= most and (number > 0.0 or (number == 0.0 and not positive)):
            return number
        bounds = "more than 0" if positive else "at least 0"
        bounds += "" if most == math.inf else f" and at most {most:g}"
        raise click.BadParameter(f"{units.quantity_text(value)} is out of range - give {bounds}")

    return read


def angle(value: str | float) -> float:
    """Return an angle; a number alone is in degrees.

    Parameters
    ----------
    value : str or float
        As typed; a number that is no text is in radians already.

    Returns
    -------
    float [rad]

    Raises
    ------
    click.BadParameter
        If it is not an angle, or beyond ten turns.
    """
    from feederscrew.base.units import QuantityError, quantity

    try:
        number = quantity(value, "angle", bare="deg") if isinstance(value, str) else value
    except QuantityError as fault:
        raise WrongValue(fault.what, fault.mend, fault.value) from None
    if not abs(number) <= MAX_ANGLE_RAD:
        raise click.BadParameter(f"{value!r} is out of range - stay within ten turns")
    return number


def span(value: str) -> tuple[float, float]:
    """Return a least and a greatest length; one alone is both.

    Parameters
    ----------
    value : str
        '200mm:400mm' or '300mm'.

    Returns
    -------
    low, high : float [m]

    Raises
    ------
    click.BadParameter
        If an end is not a length above 0, or the ends run backwards.
    """
    ends = value.split(":")
    if len(ends) > 2:
        raise click.BadParameter(f"{value!r} has more than two ends - write 200mm:400mm")
    length = quantity_type("length", positive=True)
    low, high = length(ends[0]), length(ends[-1])
    if low > high:
        raise click.BadParameter(f"{value!r} runs backwards - write 200mm:400mm")
    return low, high


ENVIRONMENT_PREFIX = "FEEDER_"


class Option(click.Option):
    """An option with ``former`` names, still taken, and ``names`` behind its help, looked up late.

    ``example`` is a value to type where one is needed and missing.
    """

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        self.example: str | None = keywords.pop("example", None)
        self.names: Callable[[], Sequence[str]] | None = keywords.pop("names", None)
        self.former: Sequence[str] = keywords.pop("former", ())
        super().__init__(*arguments, **keywords)
        if self.envvar is None:  # FEEDER_FORMAT of --format; click reads it where the option is not typed
            word = max(self.opts, key=len).lstrip("-").replace("-", "_")
            self.envvar = f"{ENVIRONMENT_PREFIX}{word.upper()}"
        self.present = list(self.opts)
        self.opts += self.former

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Return the help of the present name, with the names behind it, and the former ones.

        Parameters
        ----------
        ctx
            As click gives it.

        Returns
        -------
        (str, str) or None
        """
        whole, self.opts, text = self.opts, self.present, self.help
        if self.names:
            self.help = f"{(text or '').removesuffix('.')}: {', '.join(self.names())}."
        try:
            record = super().get_help_record(ctx)
        finally:
            self.opts, self.help = whole, text
        if record and self.former:
            record = record[0], f"{record[1]}  (once {', '.join(self.former)})"
        return record


class AspectOption(Option):
    """An option of an aspect, which takes the name of an orientation, 'A@354', for both of its options."""

    def handle_parse_result(
        self, ctx: click.Context, opts: Mapping[str, Any], args: list[str]
    ) -> tuple[Any, list[str]]:
        """Take the aspect, and give ``--heading`` and ``--outcome`` what the name says of them.

        Options that are given are read before those that are not, so a heading that the name says is there
        when its option is read.

        Parameters
        ----------
        ctx, opts, args
            As click gives them; ``opts`` is changed.

        Returns
        -------
        tuple
            As click wants it.
        """
        text = opts.get("aspect")
        named = ORIENTATION.fullmatch(text.strip()) if isinstance(text, str) else None
        takes = {param.name for param in ctx.command.params}
        if named and "heading" in takes and isinstance(opts, dict):
            if opts.get("heading") is not None:
                raise WrongValue(f"{text!r} names a heading, as --heading does", "give one of both", ctx=ctx)
            opts |= {"aspect": named["aspect"], "heading": f"{named['degrees']}deg"}
            if named["hangs"] and "outcome" in takes:
                opts.setdefault("outcome", "hanging")
        return super().handle_parse_result(ctx, opts, args)


# as ``orientation_names.NAMED``, which loads numpy
ORIENTATION = re.compile(r"(?P<aspect>[^@\s]+)@(?P<degrees>\d{1,3}(\.\d+)?)(?P<hangs> +hanging( \d+)?)?")
FILE = Place(allow_dash=True)
LENGTH_UNITS = LengthUnit(["mm", "cm", "m", "um", "in"])
LAUNCHES = ("place", "drop", "flip", "roll", "feed", "tumble")  # the last: once that of roll
METAVARS = {"length": "LENGTH", "number": "SHARE", "rate": "RATE", "time": "TIME"}


# how an option is declared: its names, '--gap' or '--limit seconds', then its values and its help


def option(names: str, /, metavar: str | None, text: str, **keywords: Any) -> Callable:
    """Return an option of a text, or of a ``type``.

    Parameters
    ----------
    names : str
        As typed, and the parameter's where it is another one: '--limit seconds'.
    metavar : str or None
        The value, as the help shows it.
    text : str
        The help.
    **keywords : object
        As of ``click.option``; ``former`` are names that it once had.

    Returns
    -------
    callable
        A decorator of a command.
    """
    return click.option(*names.split(), cls=Option, metavar=metavar, help=text, **keywords)


def aspect(text: str, **keywords: Any) -> Callable:
    """Return the option ``--aspect``: the name of an aspect, or of one of its orientations, 'A@354'.

    Parameters
    ----------
    text : str
        The help.
    **keywords : object
        As of ``click.option``.

    Returns
    -------
    callable
        A decorator of a command.
    """
    return click.option("--aspect", cls=AspectOption, metavar="NAME", help=text, **keywords)


def flag(names: str, text: str, **keywords: Any) -> Callable:
    """Return an option without a value.

    Parameters
    ----------
    names, text : str
        As of ``option``.
    **keywords : object
        As of ``click.option``.

    Returns
    -------
    callable
        A decorator of a command.
    """
    return option(names, None, text, is_flag=True, **keywords)


def whole(names: str, low: int, high: int | None, text: str, **keywords: Any) -> Callable:
    """Return an option of a whole number within limits, which shows its default where it has one.

    Parameters
    ----------
    names, text : str
        As of ``option``.
    low : int
    high : int or None
        None for any.
    **keywords : object
        As of ``click.option``.

    Returns
    -------
    callable
        A decorator of a command.
    """
    shown = {"show_default": True} if keywords.get("default") else {}
    return option(names, "N", text, type=Whole(low, high), **shown, **keywords)


def choice(names: str, choices: Sequence[str], text: str, default: str | None = None) -> Callable:
    """Return an option of one of several words, which shows its default where it has one.

    Parameters
    ----------
    names, text : str
        As of ``option``.
    choices : sequence of str
    default : str, optional

    Returns
    -------
    callable
        A decorator of a command.
    """
    shown = {"default": default, "show_default": True} if default else {}
    return option(names, None, text, type=click.Choice(choices), **shown)


path = functools.partial(option, type=Place())  # of a file or a folder


def quantity(names: str, dimension: str, default: str, text: str, **more: Any) -> Callable:
    """Return an option of a quantity with a default, which its help shows.

    Parameters
    ----------
    names, text : str
        As of ``option``.
    dimension : str
        As of ``quantity_type``.
    default : str
        '0 mm'.
    **more : object
        As of ``click.option``; ``positive`` and ``most`` as of ``quantity_type``.

    Returns
    -------
    callable
        A decorator of a command.
    """
    bounds = {name: more.pop(name) for name in ("positive", "most") if name in more}
    more |= {"type": quantity_type(dimension, **bounds), "default": default, "show_default": True}
    return option(names, METAVARS[dimension], text, **more)


# options that commands declare alike but for their help
target = functools.partial(
    option, "--target", "RATE", type=quantity_type("rate", positive=True), example="60/min"
)
heading = functools.partial(option, "--heading", type=angle)
seed = functools.partial(whole, "--seed", 0, None, default=1)


def stack_decorators(command: Callable, *decorators: Callable) -> Callable:
    """Return the command with several decorators, the first outermost: options are listed in this order.

    Parameters
    ----------
    command : callable
    *decorators : callable

    Returns
    -------
    callable
    """
    for decorate in reversed(decorators):
        command = decorate(command)
    return command


def names(*decorators: Callable) -> list[str]:
    """Return the names of the parameters that decorators add to a command.

    Parameters
    ----------
    *decorators : callable

    Returns
    -------
    list of str
    """
    command = stack_decorators(lambda: None, *decorators)
    return [param.name for param in getattr(command, "__click_params__")]  # noqa: B009


def group(name: str, *decorators: Callable, pack: Callable = dict) -> Callable:
    """Return a decorator that adds options, which the command receives together.

    Parameters
    ----------
    name : str
        Of the command's argument.
    *decorators : callable
        An option each.
    pack : callable, optional
        Makes the value of that argument from the options as keywords; a dict without it.

    Returns
    -------
    callable
        A decorator of a command.
    """
    keywords = names(*decorators)

    def decorate(command: Callable) -> Callable:
        @functools.wraps(command)
        def with_group(**options: Any) -> Any:
            options[name] = pack(**{keyword: options.pop(keyword) for keyword in keywords})
            return command(**options)

        return stack_decorators(with_group, *decorators)

    return decorate


def is_typed(name: str) -> bool:
    """Tell whether the option of a parameter stands on the command line.

    Parameters
    ----------
    name : str
        Of the parameter.

    Returns
    -------
    bool
        False of a default, and of one from the environment.
    """
    context = click.get_current_context()
    return context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE


def typed_options(*names: str) -> Iterator[str]:
    """Yield the options, as '--bed', of those parameters that stand on the command line.

    Parameters
    ----------
    *names : str
        Of the parameters.

    Yields
    ------
    str
    """
    for param in click.get_current_context().command.params:
        if param.name in names and is_typed(param.name):
            yield param.opts[0]


# what the shell completes, and names that are checked before anything is read


def _complete(names: Callable[[], Sequence[str]]) -> Callable[..., list[str]]:
    """Return what a shell completes a word by: of the names, looked up when it asks, those that begin so."""
    return lambda context, option, typed: [name for name in names() if name.startswith(typed)]


def _bowl_keys() -> Sequence[str]:
    from feederscrew.bowl.schema import BY_NAME

    return [f"{name}=" for name in BY_NAME]


def _rules() -> Sequence[str]:
    from feederscrew.resting.rules.registry import CHOICES

    return CHOICES


def _materials() -> Sequence[str]:
    """Materials without blanks, which a shell would take for the end of the name."""
    from feederscrew.part.density import MATERIALS

    return [material.name.replace(" ", "_") for material in MATERIALS]


def _density(value: str) -> str:
    from feederscrew.part.density import find_density

    find_density(value)
    return value


def _rule(value: str) -> str:
    from feederscrew.resting.rules.registry import require_rule

    require_rule(value)
    return value


def _title(value: str) -> str:
    if len(value) > TITLE_LETTERS or not value.isprintable():
        raise click.BadParameter(f"give one line of at most {TITLE_LETTERS} letters")
    return value


# the part


DENSITY = option(
    "--density",
    "DENSITY",
    'Material or "7.85 g/cm3".  [default: steel]',
    type=_density,
    shell_complete=_complete(_materials),
)
READING = (
    option("--units", None, "Length unit (STL has none).  [default: mm]", type=LENGTH_UNITS),
    DENSITY,
    option(
        "--centre-of-mass",
        "X,Y,Z",
        "Where it is, in the file's units and axes, if the part is not homogeneous.",
    ),
    path(
        "--names",
        "FILE",
        "Names of its aspects (names.yaml of aspects -o): they stay when the ranks change.",
    ),
    option("--body", "BODY", "Which of several bodies in the file: its number, its name, or largest."),
    flag("--allow-open", "Compute from an open surface; every output says so."),
)


def _source(**keywords: Any) -> Callable:
    """The option group of a part; the command receives the keywords of ``feederscrew.part.load``."""
    return group("part", click.argument("source", type=FILE, **keywords), *READING)


part = _source(metavar="PART", required=True)
optional_part = _source(metavar="[PART]", required=False)  # without it its ``source`` is None
as_published = functools.partial(flag, "--as-published")


def parts(command: Callable) -> Callable:
    """Add PART or many FILEs to a command, and how to read the part.

    Parameters
    ----------
    command : callable

    Returns
    -------
    callable
        It receives ``sources`` and ``reading``.
    """
    sources = click.argument("sources", metavar="PART|FILE...", nargs=-1, type=FILE, required=True)
    return stack_decorators(command, sources, group("reading", *READING))


# the bowl, and how parts arrive in it


overrides = option(
    "--set overrides",
    "KEY=VALUE",
    'One value of it: --set drive.frequency="50 Hz".',
    multiple=True,
    shell_complete=_complete(_bowl_keys),
)


def _bowl_values(path: str | None, overrides: Sequence[str], lining: str | None) -> Values:
    """The bowl file and what goes over it; a lining is the key of that name."""
    return {
        "path": path,
        "overrides": overrides if lining is None else [*overrides, f"friction.lining={lining}"],
    }


bowl = group(  # the keywords of ``feederscrew.bowl.read``
    "bowl",
    option("--config path", "FILE", "Bowl file (YAML); without it, the defaults.", type=FILE),
    overrides,
    choice(
        "--lining",
        ("steel", "nickel", "pu", "brush"),
        "Lining of the track: friction of a table.",
    ),
    pack=_bowl_values,
)
rule = option(
    "--rule",
    "NAME",
    "Whose probabilities are taken.",
    names=_rules,
    default="recommended",
    show_default=True,
    type=_rule,
    shell_complete=_complete(_rules),
)
launch = choice("--launch", LAUNCHES, "What is done to the part.", default="feed")
jobs = whole("--jobs", 1, 256, "Cores to use.  [default: all]")


vary = functools.partial(
    option, "--vary spans", "KEY=FROM:TO:COUNT", multiple=True, shell_complete=_complete(_bowl_keys)
)


# what is printed and written


FORMAT = choice("--format", PRINT_FORMATS, "What is printed on stdout.", default="table")
QUIET = flag("-q --quiet", "Suppress warnings and messages.")
OUTPUT = (
    path("-o --output directory", "DIR", "Write tables, pictures to DIR/<name>/."),
    path("--depfile", "FILE", "Write a rule for make: what the files of -o are made from."),
    FORMAT,
    QUIET,
    flag("-v --verbose", "Say what is read and how long each step takes."),
)
PICTURES = flag("--no-pictures pictures", "Tables only.", flag_value=False, default=True)
printed = group("out", FORMAT, pack=Output.of_call)  # of what writes no files
output = group("out", *OUTPUT, pack=Output.of_call)
drawn_output = group("out", PICTURES, *OUTPUT, pack=Output.of_call)  # of what draws as well
title_field = functools.partial(option, metavar="TEXT", default="", type=_title)
title_block = group(
    "fields",
    title_field("--date", text="Date in the title block of the drawings.  [default: empty]"),
    title_field("--rev revision", text="Revision, in the same place.  [default: empty]"),
)
