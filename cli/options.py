"""Every option that two commands share, once."""

import functools
import re
from typing import Any

import click

from feederscrew_cli import completion, talk


class Place(click.Path):
    """A path; the library says what is wrong with it, unless it is none, as of an unset shell variable."""

    def convert(self, value, param, ctx):
        """The path as typed, or a wrong call."""
        return (
            super().convert(value, param, ctx) if value else self.fail("is empty - give a path", param, ctx)
        )


FILE = Place(allow_dash=True)
MICRO_SIGNS = str.maketrans("\u00b5\u03bc", "uu")  # the sign of its own, and the Greek letter


class LengthUnit(click.Choice):
    """A unit of a file; that of a micrometre also with its sign."""

    def convert(self, value, param, ctx):
        """The unit, or a wrong call."""
        return super().convert(value.translate(MICRO_SIGNS) if isinstance(value, str) else value, param, ctx)


UNITS = LengthUnit(["mm", "cm", "m", "um", "in"])
LAUNCHES = click.Choice(["place", "drop", "flip", "roll", "feed", "tumble"])  # the last: once that of roll


class Named(click.Option):
    """An option that takes a name out of a list; its help lists them, looked up when help is asked for."""

    def __init__(self, *arguments, names, **keywords):
        super().__init__(*arguments, **keywords)
        self.names = names

    def get_help_record(self, context):
        """The help with the names behind it."""
        text = self.help or ""
        self.help = f"{text.removesuffix('.')}: {', '.join(self.names())}."
        try:
            return super().get_help_record(context)
        finally:
            self.help = text


WHOLE = re.compile(r"[+-]?[0-9]{1,30}")
DECIMAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")


class Renamed(click.Option):
    """An option with ``former`` names, which are still taken; its help shows the present one."""

    def __init__(self, *arguments, former, **keywords):
        super().__init__(*arguments, **keywords)
        self.present = list(self.opts)
        self.opts += former

    def get_help_record(self, context):
        """The help of the present name, which says the former."""
        taken, self.opts = self.opts, self.present
        try:
            names, text = super().get_help_record(context) or (self.present[0], "")
        finally:
            self.opts = taken
        former = ", ".join(name for name in taken if name not in self.present)
        return names, f"{text}  (once {former})"


class Number(click.FloatRange):
    """A number within limits, of the digits 0 to 9; not 'nan', which is within any."""

    name = "number"

    def convert(self, value, param, ctx):
        """The number, or a wrong call."""
        if isinstance(value, str) and not DECIMAL.fullmatch(value.strip()):
            self.fail(f"{value!r} is not a number", param, ctx)
        number = super().convert(value, param, ctx)
        return number if number == number else self.fail(f"{value!r} is not a number", param, ctx)


class Whole(click.IntRange):
    """A whole number within limits, of the digits 0 to 9: Python takes those of other scripts, and '1_0'."""

    def convert(self, value, param, ctx):
        """The number, or a wrong call."""
        if isinstance(value, str) and not WHOLE.fullmatch(value.strip()):
            self.fail(f"{value!r} is not a valid whole number - write digits, as 10", param, ctx)
        return super().convert(value, param, ctx)


def optional_part(command):
    """As ``part``, but PART may be left out: its ``source`` is None then."""
    return part(command, required=False)


def part(command, *, required=True):
    """PART and how to read it; the command receives the keywords of ``feederscrew.part.load``."""
    return stacked(
        packed(command, "part", ("source", *READING)),
        click.argument("source", metavar="PART" if required else "[PART]", type=FILE, required=required),
        *_reading(),
    )


def parts(command):
    """PART or many FILEs, and how to read the part: ``sources`` and ``reading``."""
    return stacked(
        packed(command, "reading", READING),
        click.argument("sources", metavar="PART|FILE...", nargs=-1, type=FILE, required=True),
        *_reading(),
    )


def _known_density(context, option, value):
    """The density as typed; a wrong one is told of before anything is read."""
    from feederscrew.part.density import find_density

    if value is not None:
        find_density(value)
    return value


DENSITY = click.option(
    "--density",
    callback=_known_density,
    metavar="DENSITY",
    shell_complete=completion.materials,
    help='A material of `feeder config materials`, or a value, as "7.85 g/cm3".  [default: steel]',
)
READING = ("units", "density", "centre_of_mass", "names", "body", "allow_open")


def _reading():
    """The options of READING."""
    return (
        click.option("--units", type=UNITS, help="Length unit of the file (STL has none).  [default: mm]"),
        DENSITY,
        click.option(
            "--centre-of-mass",
            metavar="X,Y,Z",
            help="Where it is, in the file's units and axes, if the part is not homogeneous.",
        ),
        click.option(
            "--names",
            metavar="FILE",
            type=Place(),
            help="Names of its aspects (names.yaml of aspects -o): they stay when the ranks change.",
        ),
        click.option(
            "--body",
            metavar="BODY",
            help="Which of several bodies in the file: its number, its name, or largest.",
        ),
        click.option(
            "--allow-open", is_flag=True, help="Compute from an open surface; every output says so."
        ),
    )


def bowl(command):
    """The bowl file; the command receives the keywords of ``feederscrew.bowl.read``."""
    return stacked(
        packed(command, "bowl", ("path", "overrides")),
        click.option(
            "--config", "path", metavar="FILE", type=FILE, help="Bowl file (YAML); without it, the defaults."
        ),
        overrides,
    )


def overrides(command):
    """``--set``; the command receives ``overrides``, a tuple of texts."""
    return click.option(
        "--set",
        "overrides",
        metavar="KEY=VALUE",
        multiple=True,
        shell_complete=completion.keys,
        help='Override one value: --set drive.frequency="50 Hz".',
    )(command)


def _known_rule(context, option, value):
    """The name of a rule; a mistyped one is told of before anything is read."""
    from feederscrew.resting.rules.registry import require_rule

    require_rule(value)
    return value


def rule(command):
    """``--rule``; the command receives its name."""
    return click.option(
        "--rule",
        default="recommended",
        show_default=True,
        metavar="NAME",
        cls=Named,
        names=completion.known_rules,
        callback=_known_rule,
        shell_complete=completion.rules,
        help="Whose probabilities are taken.",
    )(command)


def launch(command):
    """``--launch``; the command receives its name."""
    return click.option(
        "--launch", type=LAUNCHES, default="feed", show_default=True, help="What is done to the part."
    )(command)


def listed(text):
    """Return the names of a list that is typed with commas, as a tuple."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def pictures(command):
    """``--no-pictures``; the command receives ``pictures``, true unless it is given."""
    return click.option(
        "--no-pictures", "pictures", is_flag=True, flag_value=False, default=True, help="Tables only."
    )(command)


FORMAT = click.option(
    "--format",
    type=click.Choice(talk.FORMATS),
    default="table",
    show_default=True,
    help="What is printed on stdout.",
)


QUIET = click.option("-q", "--quiet", is_flag=True, help="Suppress warnings and messages.")


def printed(command):
    """``--format`` alone, for what writes no files; the command receives ``out``, a ``talk.Output``."""
    return stacked(packed(command, "out", ("format",), talk.Output.of), FORMAT)


def output(command):
    """Where results and talk go; the command receives ``out``, a ``talk.Output``."""
    return stacked(
        packed(command, "out", ("directory", "depfile", "format", "quiet", "verbose"), talk.Output.of),
        click.option(
            "-o",
            "--output",
            "directory",
            metavar="DIR",
            type=Place(),
            help="Write tables, pictures and run.json to DIR/<name>/.",
        ),
        click.option(
            "--depfile",
            metavar="FILE",
            type=Place(),
            help="Write a rule for make: what the files of -o are made from.",
        ),
        FORMAT,
        QUIET,
        click.option("-v", "--verbose", is_flag=True, help="Say what is read and how long each step takes."),
    )


TITLE_LETTERS = 40  # of a field of the title block


def _title_text(context, option, value):
    """A field of the title block: one short line."""
    if len(value) > TITLE_LETTERS or not value.isprintable():
        raise click.BadParameter(f"give one line of at most {TITLE_LETTERS} letters", context, option)
    return value


def title_block(command):
    """Fields of the title block of drawings; the command receives them as ``fields``, by keyword."""
    named: Any = {"default": "", "callback": _title_text, "metavar": "TEXT"}
    return stacked(
        packed(command, "fields", ("date", "revision")),
        click.option("--date", help="Date in the title block of the drawings.  [default: empty]", **named),
        click.option("--rev", "revision", help="Revision, in the same place.  [default: empty]", **named),
    )


def packed(command, name, keywords, pack=dict):
    """The command with several options handed to it as one argument: ``pack`` of them by keyword."""

    @functools.wraps(command)
    def handed(**options):
        options[name] = pack(**{keyword: options.pop(keyword) for keyword in keywords})
        return command(**options)

    return handed


def stacked(command, *decorators):
    """The command with several decorators, the first outermost: options are listed in this order."""
    for decorate in reversed(decorators):
        command = decorate(command)
    return command
