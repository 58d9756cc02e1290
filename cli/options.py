"""Every option that two commands share, once."""

import functools
from typing import Any

import click

from feederscrew_cli import completion, talk
from feederscrew_cli.values import LengthUnit, Place, Quantity, Whole

FILE = Place(allow_dash=True)
METAVARS = {"length": "LENGTH", "number": "SHARE", "time": "TIME"}
LENGTH_UNITS = LengthUnit(["mm", "cm", "m", "um", "in"])
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


def stacked(command, *decorators):
    """The command with several decorators, the first outermost: options are listed in this order."""
    for decorate in reversed(decorators):
        command = decorate(command)
    return command


def names(*decorators):
    """Return the names of the parameters that decorators add to a command."""

    def bare():
        """Take the options, to say their names."""

    return [option.name for option in stacked(bare, *decorators).__click_params__]


def group(name, *decorators, pack=dict):
    """Return a decorator that adds options; the command receives all of them as the argument ``name``.

    It is ``pack`` of them by keyword.
    """
    keywords = names(*decorators)

    def decorate(command):
        @functools.wraps(command)
        def with_group(**options):
            options[name] = pack(**{keyword: options.pop(keyword) for keyword in keywords})
            return command(**options)

        return stacked(with_group, *decorators)

    return decorate


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
READING = (
    click.option("--units", type=LENGTH_UNITS, help="Length unit of the file (STL has none).  [default: mm]"),
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
    click.option("--allow-open", is_flag=True, help="Compute from an open surface; every output says so."),
)


def _source(**keywords):
    """The option group of a part; the command receives the keywords of ``feederscrew.part.load``."""
    return group("part", click.argument("source", type=FILE, **keywords), *READING)


part = _source(metavar="PART", required=True)
optional_part = _source(metavar="[PART]", required=False)  # without it its ``source`` is None


def parts(command):
    """PART or many FILEs, and how to read the part: ``sources`` and ``reading``."""
    sources = click.argument("sources", metavar="PART|FILE...", nargs=-1, type=FILE, required=True)
    return stacked(command, sources, group("reading", *READING))


overrides = click.option(
    "--set",
    "overrides",
    metavar="KEY=VALUE",
    multiple=True,
    shell_complete=completion.keys,
    help='Override one value: --set drive.frequency="50 Hz".',
)
bowl = group(  # the keywords of ``feederscrew.bowl.read``
    "bowl",
    click.option(
        "--config", "path", metavar="FILE", type=FILE, help="Bowl file (YAML); without it, the defaults."
    ),
    overrides,
)


def _known_rule(context, option, value):
    """The name of a rule; a mistyped one is told of before anything is read."""
    from feederscrew.resting.rules.registry import require_rule

    require_rule(value)
    return value


rule = click.option(
    "--rule",
    default="recommended",
    show_default=True,
    metavar="NAME",
    cls=Named,
    names=completion.known_rules,
    callback=_known_rule,
    shell_complete=completion.rules,
    help="Whose probabilities are taken.",
)
launch = click.option(
    "--launch", type=LAUNCHES, default="feed", show_default=True, help="What is done to the part."
)
jobs = click.option("--jobs", type=Whole(1, 256), metavar="N", help="Cores to use.  [default: all]")


def quantity(names, dimension, default, meaning, former=(), **bounds):
    """Return an option of a quantity with a default, which its help shows; bounds as of ``Quantity``."""
    renamed: Any = {"cls": Renamed, "former": former} if former else {}
    return click.option(
        *names.split(),
        type=Quantity(dimension, **bounds),
        default=default,
        show_default=True,
        metavar=METAVARS[dimension],
        help=meaning,
        **renamed,
    )


def target(meaning, *, required=False):
    """Return ``--target``, the rate [1/s] that ``meaning`` speaks of."""
    rate = Quantity("rate", positive=True)
    return click.option("--target", type=rate, required=required, metavar="RATE", help=meaning)


def seed(meaning):
    """Return ``--seed``, of what ``meaning`` says."""
    return click.option("--seed", type=Whole(0), default=1, show_default=True, help=meaning)


pictures = click.option(
    "--no-pictures", "pictures", is_flag=True, flag_value=False, default=True, help="Tables only."
)
FORMAT = click.option(
    "--format",
    type=click.Choice(talk.PRINT_FORMATS),
    default="table",
    show_default=True,
    help="What is printed on stdout.",
)


QUIET = click.option("-q", "--quiet", is_flag=True, help="Suppress warnings and messages.")


printed = group("out", FORMAT, pack=talk.Output.of)  # of what writes no files
output = group(
    "out",
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
    pack=talk.Output.of,
)


TITLE_LETTERS = 40  # of a field of the title block


def _title_text(context, option, value):
    """A field of the title block: one short line."""
    if len(value) > TITLE_LETTERS or not value.isprintable():
        raise click.BadParameter(f"give one line of at most {TITLE_LETTERS} letters", context, option)
    return value


_TITLE: Any = {"default": "", "callback": _title_text, "metavar": "TEXT"}
title_block = group(
    "fields",
    click.option("--date", help="Date in the title block of the drawings.  [default: empty]", **_TITLE),
    click.option("--rev", "revision", help="Revision, in the same place.  [default: empty]", **_TITLE),
)
