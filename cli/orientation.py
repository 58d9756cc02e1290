"""The options that say which parts are wanted: shared by the commands that count them."""

import click

from feederscrew_cli import options
from feederscrew_cli.angle import Angle
from feederscrew_cli.quantity import Quantity

CHAIN = (
    click.option("--aspect", required=True, metavar="NAME", help="Aspect the part shall leave the bowl on."),
    click.option(
        "--heading",
        type=Angle(),
        metavar="DEG",
        help="Heading it is laid down in, which the wall turns to the next stable one.  "
        "[default: the most frequent that stays on the track]",
    ),
    options.rule,
    click.option(
        "--gap",
        type=Quantity("length"),
        default="0 mm",
        show_default=True,
        metavar="LENGTH",
        help="Between one part and the next.",
    ),
    click.option(
        "--fill",
        type=Quantity("number", positive=True, most=1.0),
        default="1",
        show_default=True,
        metavar="SHARE",
        help="Share of the track that is occupied.",
    ),
)


def chain(command):
    """Add the options of the wanted orientation, and of what the rate depends on.

    The command receives ``aspect``, ``heading``, ``rule``, ``gap`` and ``fill``.
    """
    for option in reversed(CHAIN):
        command = option(command)
    return command


def doubt(command):
    """How far part and cut may be off; the command receives ``play`` and ``tolerance``."""
    for name, text in reversed(DOUBT):
        command = click.option(
            name, type=Quantity("length"), default="0 mm", show_default=True, metavar="LENGTH", help=text
        )(command)
    return command


DOUBT = (
    ("--play", "Standard deviation of where a part is over a cut."),
    ("--tolerance", "Standard deviation of where a cut's edge is."),
)
