"""The options that say which parts are wanted: shared by the commands that count them."""

import click

from feederscrew_cli import options, waiting
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


LEAVES_MOST = click.option(
    "--aspect",
    metavar="NAME",
    help="Aspect the part shall leave the bowl on.  [default: the one that leaves most often]",
)


def any_chain(command):
    """As ``chain``, but ``aspect`` may be left out."""
    for option in reversed((LEAVES_MOST, *CHAIN[1:])):
        command = option(command)
    return command


FED = click.option(
    "--launch",
    type=options.LAUNCHES,
    help="What is done to the part.  [default: fed onto the moving floor of --config, else feed]",
)
PROBABILITIES = click.option(
    "--probabilities",
    metavar="CSV",
    type=options.Place(),
    help="Take the shares of a file of counts, or of drop.csv.",
)


def taken(command):
    """Add the options that say whose shares of the aspects are taken; the command receives ``taken``."""
    return options.stacked(options.packed(command, "taken", ("launch", "probabilities")), FED, PROBABILITIES)


def shares(out, part, bowl, taken, path=None):
    """Return the aspects of a part with the answer that the options name, a ``studies.rate.Shares``.

    Without any, parts are fed onto the moving floor of the bowl of ``path``; where that is None, the
    recommended answer is taken.
    """
    from feederscrew.studies import rate as study

    return study.shares(part, bowl, **choice(taken, path), **telling(out))


def arriving(out, part, taken, path=None):
    """Return a function from a bowl to what ``shares`` returns of it; it shows how far the first one is."""
    from feederscrew.studies import rate as study

    known = {}

    def found(bowl):
        if bowl not in known:
            told = {} if known else telling(out)
            known[bowl] = study.shares(part, bowl, **choice(taken, path), **told)
        return known[bowl]

    return found


def choice(taken, path=None):
    """Return the keywords of ``studies.rate.shares`` that the options name; a wrong call if two clash."""
    asked = click.get_current_context().get_parameter_source("rule") is click.core.ParameterSource.COMMANDLINE
    others = [name for name, given in (("--launch", taken["launch"]), ("--rule", asked)) if given]
    if taken["probabilities"] is not None and others:
        raise click.UsageError(f"--probabilities takes the place of {others[0]} - leave one of them out")
    named = asked or any(value is not None for value in taken.values())
    return {**taken, "fed": path is not None and not named}


def telling(out):
    """Return the keywords of ``studies.rate.shares`` that tell how far it is."""
    bar = waiting.bar(out, "parts")

    def before(_):
        waiting.drops(out)
        click.get_current_context().with_resource(bar)

    return {"before": before, "progress": bar.reach}


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
