"""``feeder tooling``."""

import click

from feederscrew_cli import grouped, options, orientation, quantity, waiting
from feederscrew_cli.angle import Angle
from feederscrew_cli.interrupt import heeding
from feederscrew_cli.progress import Progress

ASKED = (
    *("aspect", "rule", "heading", "margin", "purity", "efficiency", "outcome", "without"),
    *("step", "up", "cutter", "play", "tolerance", "turn", "seed", "verdicts", "seconds"),
)


def _asked(command):
    """What the design shall keep to; the command receives ``asked``."""
    return options.packed(command, "asked", ASKED)


@grouped.command(
    short_help="Which cuts let only one orientation leave the bowl.",
    rare=("step", "cutter", "play", "tolerance", "cad", "verdicts", "seconds"),
)
@options.part
@click.option(
    "--aspect", metavar="NAME", help="Aspect on which the part must leave.  [default: every orientation]"
)
@click.option(
    "--heading", type=Angle(), metavar="DEG", help="Heading of that aspect.  [default: the most frequent]"
)
@options.rule
@quantity.with_default(
    "--margin",
    "length",
    "0.15 mm",
    "Least margin by which the wanted orientation passes and the others fail, beside play and tolerance.",
    positive=True,
)
@quantity.with_default(
    "--purity",
    "number",
    "1",
    "Share of what leaves that must be in the wanted orientation: below 1 a shorter chain may do.",
    positive=True,
    most=1.0,
)
@quantity.with_default(
    "--efficiency",
    "number",
    "0",
    "Share of what is offered that must leave: the search goes on until it does, or says what is missing.",
    most=1.0,
)
@click.option(
    "--outcome",
    type=click.Choice(["lying", "hanging", "any"]),
    default="any",
    show_default=True,
    help="How parts must leave: as they lie, hanging between rails, or either.",
)
@click.option(
    "--without",
    default="",
    metavar="KIND,...",
    help="Kinds of devices that are not used: wiper,cut_out.",
)
@quantity.with_default(
    "--step",
    "length",
    "0.05 mm",
    "Step in which a shop makes dimensions: values are whole multiples of it.",
    positive=True,
)
@click.option("--up", default="", metavar="NAME,...", help="Other aspects that count as the one wanted: B,C.")
@quantity.with_default("--cutter", "length", "0 mm", "Radius that corners of holes are rounded to.")
@quantity.with_default("--play", "length", "0.05 mm", "Play of parts at the wall, on top of every margin.")
@quantity.with_default(
    "--tolerance", "length", "0.05 mm", "Tolerance of the part's size, on top of every margin."
)
@click.option("--cad", is_flag=True, help="Write tooling.step as well; needs feederscrew[cad].")
@click.option("--turn", is_flag=True, help="Allow steps and ledges that turn parts over, before the cuts.")
@click.option(
    "--seed", type=options.Whole(min=0), default=1, show_default=True, help="Seed of the search for holes."
)
@click.option(
    "--verdicts",
    type=options.Whole(min=1),
    default=30000,
    show_default=True,
    help="Limit of the search for holes, in verdicts an orientation: it ends alike on every machine.",
)
@quantity.with_default(
    "--limit seconds",
    "time",
    "10 min",
    "Time after which the best so far is taken; the answer then says so.",
    positive=True,
)
@click.option("--static", is_flag=True, help="Do not send parts through what is proposed.")
@orientation.taken
@options.bowl
@options.title_block
@options.pictures
@options.output
@_asked
def tooling(part, asked, cad, static, taken, bowl, fields, pictures, out):
    """Example: feeder tooling parts/lbracket_30x20x15.stl --aspect A --heading 270deg --config bowl.yaml

    Which way up is cheapest to feed, and what to cut so that only that one leaves. Without an aspect, the
    table has every orientation with its share and its limits (least track width, greatest canyon and
    gap). It has the devices that isolate it, their margin, the efficiency and the purity. With an aspect,
    it has the chain of fewest devices. Each has the smallest cut that still returns and the largest that
    still passes. Devices that the bowl file already lists stay before the design.

    A few parts of each orientation are sent through what is proposed, of the table through the best
    three. What that trial says comes first. Where it denies the chain of one orientation, up to four others
    are tried, without one or more of its devices. --static leaves the trial out.

    With -o: tooling.csv, tooling.json and tooling.png. An aspect adds tooling.yaml, a bowl file with the
    devices for feeder rate, report and batch. It adds tooling.dxf and tooling.svg, 1:1 in mm, unrolled and
    as bent, and tooling.stl, the section of track to print.
    """
    from functools import partial

    from feederscrew import bowl as bowls
    from feederscrew.designing import own_trial
    from feederscrew.output import columns, marking, offers
    from feederscrew.output import tooling as files
    from feederscrew.output import tooling_tables as tables
    from feederscrew.solidbowl.exact import exact_body
    from feederscrew.studies.tooling import tooling as study
    from feederscrew.studies.tooling import tooling_without

    orientation.of_an_aspect(asked)
    if cad:
        exact_body.check()
    solid, settings = out.part(part), out.settings(bowl)
    effective = columns.conditions(solid) | bowls.texts(settings)
    record = bowls.record(settings)
    known = orientation.shares(out, solid, record, taken, asked["rule"])
    with out.folder(solid.name, solid.inputs | known.inputs, effective) as folder:
        given = {"known": known.aspects, **asked}
        with Progress(None, not out.quiet, "orientations") as bar:
            found = study(solid, record, progress=heeding(bar.reach), **given)
        if not static:
            again = partial(tooling_without, part=solid, bowl=record, **given)
            found = own_trial.own_trials(found, again, before=lambda: waiting.trial(out))
        document = tables.document(found) | {"trial": own_trial.document(found.trials)}
        denied, agreed = tables.trials(found)
        out.warn(*found.warnings, *denied)
        out.say(*agreed, *tables.remarks(found, asked["efficiency"]))
        made = files.offers(found, settings, cad, fields=marking.SheetFields(**fields))
        offers.write(folder, made, pictures=pictures)
        out.show(
            tables.summary(found, out.format),
            document,
            hidden=tables.HIDDEN,
            spare=tables.TABLE_SPARE_COLUMNS,
        )
