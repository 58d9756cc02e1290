"""``feeder tooling``."""

import click

from feederscrew_cli import grouped, options, orientation, waiting
from feederscrew_cli.angle import Angle
from feederscrew_cli.progress import Progress
from feederscrew_cli.quantity import Quantity

ASKED = (
    *("heading", "margin", "purity", "efficiency", "outcome", "without"),
    *("step", "up", "cutter", "play", "tolerance", "turn", "seed", "verdicts", "seconds"),
)


def _asked(command):
    """What the design shall keep to; the command receives ``asked``."""
    return options.packed(command, "asked", ASKED)


@grouped.command(short_help="Which cuts let only one orientation leave the bowl.")
@options.part
@click.option(
    "--aspect", metavar="NAME", help="Aspect the part shall leave on.  [default: every orientation]"
)
@click.option(
    "--heading", type=Angle(), metavar="DEG", help="Heading of that aspect.  [default: the most frequent]"
)
@options.rule
@click.option(
    "--margin",
    type=Quantity("length", positive=True),
    default="0.25 mm",
    show_default=True,
    metavar="LENGTH",
    help="Least margin by which the wanted orientation passes and the others fail.",
)
@click.option(
    "--purity",
    type=Quantity("number", positive=True, most=1.0),
    default="1",
    show_default=True,
    metavar="SHARE",
    help="Share of what leaves that is enough in the wanted orientation: a shorter chain may do.",
)
@click.option(
    "--efficiency",
    type=Quantity("number", most=1.0),
    default="0",
    show_default=True,
    metavar="SHARE",
    help="Share of what is offered that shall leave: the search goes on for it, or says what is missing.",
)
@click.option(
    "--outcome",
    type=click.Choice(["lying", "hanging", "any"]),
    default="any",
    show_default=True,
    help="How parts shall leave: as they lie, hanging between rails, or either.",
)
@click.option(
    "--without",
    default="",
    metavar="KIND,...",
    help="Kinds of devices that are not used: wiper,cut_out.",
)
@click.option(
    "--step",
    type=Quantity("length", positive=True),
    default="0.05 mm",
    show_default=True,
    metavar="LENGTH",
    help="What a shop makes: values are whole multiples of it.",
)
@click.option("--up", default="", metavar="NAME,...", help="Other aspects that count as the one wanted: B,C.")
@click.option(
    "--cutter",
    type=Quantity("length"),
    default="0 mm",
    show_default=True,
    metavar="LENGTH",
    help="Radius that corners of holes are rounded to.",
)
@click.option(
    "--play",
    type=Quantity("length"),
    default="0 mm",
    show_default=True,
    metavar="LENGTH",
    help="Of parts from the wall: every margin is larger by it.",
)
@click.option(
    "--tolerance",
    type=Quantity("length"),
    default="0 mm",
    show_default=True,
    metavar="LENGTH",
    help="Of the part's size: every margin is larger by it.",
)
@click.option("--cad", is_flag=True, help="Write tooling.step as well; needs feederscrew[cad].")
@click.option("--turn", is_flag=True, help="Allow steps and ledges that turn parts over, before the cuts.")
@click.option(
    "--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the search for holes."
)
@click.option(
    "--verdicts",
    type=click.IntRange(min=1),
    default=30000,
    show_default=True,
    help="Most verdicts in the search for holes of one orientation: the same end on every machine.",
)
@click.option(
    "--limit",
    "seconds",
    type=Quantity("time", positive=True),
    default="10 min",
    show_default=True,
    metavar="TIME",
    help="Time after which the best so far is taken; the answer then says so.",
)
@click.option("--static", is_flag=True, help="Leave out the trial of what is proposed.")
@orientation.taken
@options.bowl
@options.pictures
@options.output
@_asked
def tooling(part, aspect, rule, asked, cad, static, taken, bowl, pictures, out):
    """Example: feeder tooling parts/lbracket_30x20x15.stl --aspect A --heading 270deg --config bowl.yaml

    Which way up is cheapest to feed, and what to cut so that only that one leaves. Without an aspect:
    every orientation with its share, its limits (least track width, greatest canyon and gap), the
    devices that isolate it, their margin, the efficiency and the purity. With one: the chain of fewest
    devices, each with the smallest cut that still returns and the largest that still passes. Devices that
    the bowl file lists already stay, and the design is found behind them.

    What is proposed is tried with a few parts of each orientation, of the table the best three, and both
    verdicts are told; --static leaves that out.

    With -o: tooling.csv, tooling.json and tooling.png; with an aspect also tooling.yaml, a bowl file with
    the devices for feeder rate, report and batch, tooling.dxf and tooling.svg, 1:1 in mm, unrolled and as
    bent, and tooling.stl, the section of track to print.
    """
    from feederscrew import bowl as bowls
    from feederscrew.designing import own_trial
    from feederscrew.output import columns, offers
    from feederscrew.output.tooling import files, tables
    from feederscrew.studies.tooling import tooling as study

    if cad:
        from feederscrew.output.tooling import written_step as steps

        steps.check()
    solid, settings = out.part(part), out.settings(bowl)
    effective = columns.conditions(solid) | bowls.texts(settings)
    record = bowls.record(settings)
    known = orientation.shares(out, solid, record, taken, rule)
    with out.folder(solid.name, solid.inputs | known.inputs, effective) as folder:
        with Progress(None, not out.quiet, "orientations") as bar:
            found = study(solid, record, aspect, known=known.aspects, rule=rule, told=bar.reach, **asked)
        tried = () if static else own_trial.own_trials(found, before=lambda: waiting.trial(out))
        document = tables.document(found) | {"trial": own_trial.document(tried)}
        out.warn(*found.warnings, *(one.sentence for one in tried if one.faults))
        out.say(*(one.sentence for one in tried if not one.faults))
        out.say(*tables.remarks(found, asked["efficiency"]))
        offers.write(folder, files.offers(found, settings, cad), pictures=pictures)
        out.show(tables.summary(found), document, hidden=tables.HIDDEN, spare=tables.SPARE)
