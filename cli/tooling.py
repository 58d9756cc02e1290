"""``feeder tooling``."""

import dataclasses
import time
from functools import partial
from typing import TYPE_CHECKING, Any

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.interrupt import heed_interrupts
from feederscrew_cli.options import Output, Values

if TYPE_CHECKING:
    from feederscrew.sorting.tooling import ToolingStudy


@grouped.command(
    short_help="Which cuts let only one orientation leave the bowl.",
    rare=("lining", "step", "cutter", "play", "tolerance", "cad", "verdicts", "seconds"),
)
@options.part
@options.aspect("Aspect on which the part must leave.  [default: every orientation]")
@options.heading("DEG", "Heading of that aspect.  [default: the most frequent]")
@options.rule
@options.quantity(
    "--margin",
    "length",
    "0.15 mm",
    positive=True,
    text="Least margin by which the wanted one passes and others fail, beside play and tolerance.",
)
@options.quantity(
    "--purity",
    "number",
    "1",
    positive=True,
    most=1.0,
    text="Share of what leaves that must be as wanted: below 1 a shorter chain may do.",
)
@options.quantity(
    "--efficiency",
    "number",
    "0",
    most=1.0,
    text="Share of what is offered that must leave; else it is said what is missing.",
)
@options.choice(
    "--outcome",
    ["lying", "hanging", "any"],
    default="any",
    text="How parts must leave: as they lie, hanging between rails, or either.",
)
@options.choice(
    "--class cost_class",
    ["steel", "air", "sensor"],
    "What the chain takes: steel alone, steady air, or a sensor with a valve.  "
    "[default: the cheapest that isolates, in this order]",
)
@options.option(
    "--without", "KIND,...", "Kinds of devices that are not used: 'wiper,vision reject'.", default=""
)
@options.quantity(
    "--step",
    "length",
    "0.05 mm",
    positive=True,
    text="Step in which a shop makes dimensions: values are whole multiples of it.",
)
@options.option("--up", "NAME,...", "Other aspects that count as the one wanted: B,C.", default="")
@options.quantity("--cutter", "length", "0 mm", "Radius that corners of holes are rounded to.")
@options.quantity("--play", "length", "0.05 mm", "Play of parts at the wall, on top of every margin.")
@options.quantity("--tolerance", "length", "0.05 mm", "Tolerance of the part's size, on top of every margin.")
@options.flag("--cad", "Write tooling.step as well; needs feederscrew[cad].")
@options.flag("--turn", "Allow steps and ledges that turn parts over, before the cuts.")
@options.seed("Seed of the search for holes.")
@options.whole(
    "--verdicts",
    1,
    None,
    default=30000,
    text="Limit of the search for holes, in verdicts an orientation: it ends alike on every machine.",
)
@options.quantity(
    "--limit seconds",
    "time",
    "10 min",
    positive=True,
    text="Time after which the best so far is taken and no trial begins; the answer then says so.",
)
@options.flag("--static", "Do not send parts through what is proposed.")
@orientation.share_options
@options.bowl
@options.title_block
@options.drawn_output
def tooling(
    part: Values,
    cad: bool,
    static: bool,
    share_options: Values,
    bowl: Values,
    fields: Values,
    out: Output,
    **request: Any,
) -> None:
    """Example: feeder tooling lbracket_30x20x15.stl --aspect A --heading 270deg --config bowl.yaml

    Which way up is cheapest to feed, and what to cut so that only that one leaves. A few parts of each
    orientation are sent through what is proposed, and what that trial says comes first.

    Without an aspect, the table has every orientation with its share and its limits (least track width,
    greatest canyon and gap). It has the devices that isolate it, with margin, efficiency and purity. With
    an aspect, it has the chain of fewest devices. Each has the smallest cut that returns and the largest
    that passes. Devices of the bowl file stay before the design.

    Of the table the best three are tried. Where it denies the chain of one orientation, up to four others
    are tried, without one or more of its devices. In classes cheaper than what is confirmed, chains are
    looked for as with --aspect, for the first of the three. --static leaves the trial out. Ctrl-C ends it as
    not proved, with exit status 130: what was found so far is given, without drawings to build from.

    With -o: tooling.csv, tooling.json and tooling.png. An aspect adds tooling.yaml, a bowl file with the
    devices for feeder rate, report and batch. It adds tooling.dxf and tooling.svg, 1:1 in mm, unrolled and
    as bent, and tooling.stl, the section of track to print.
    """
    from feederscrew.base import columns
    from feederscrew.base.units import counted
    from feederscrew.cad.exact import exact_body
    from feederscrew.designing import tooling_trials
    from feederscrew.output import marking
    from feederscrew.output import tooling as tables
    from feederscrew.sorting.tooling import (
        ToolingSearch,
        check_named,
        may_be_left_out,
        next_class,
        tooling_without,
    )
    from feederscrew.sorting.tooling import tooling as study

    begun = time.monotonic()
    orientation.check_heading(request)
    if cad:
        exact_body.check()
    solid, settings, record = out.part_in_bowl(part, bowl)
    names = {name: request[name] for name in ("aspect", "heading", "up", "without")}
    check_named(solid, record.track, **names)
    aspect_shares = orientation.shares(out, solid, record, share_options, request)
    with out.folder_of(solid, aspect_shares.inputs, settings=settings) as folder:
        names_of_search = {field.name for field in dataclasses.fields(ToolingSearch)} & set(request)
        searched = {name: request.pop(name) for name in names_of_search}
        until = begun + searched["seconds"]
        values = {"aspect_shares": aspect_shares.aspects, "search": ToolingSearch(**searched), **request}
        with progress.bar(out, "orientations") as bar:
            result = study(solid, record, progress=heed_interrupts(bar.reach), **values)

        def propose(kinds: tuple[str, ...], cost_class: str | None) -> "ToolingStudy":
            return tooling_without(kinds, solid, record, **values | {"cost_class": cost_class})

        if not (static or result.partial):
            own = {name: request[name] for name in ("cost_class", "efficiency", "outcome")}
            own["without"] = may_be_left_out(request["without"])
            result = tooling_trials.try_designs(
                result,
                propose,
                kept_keys={s.key.name for s in settings if s.is_own},
                until=until,
                heading_given=request["heading"] is not None,
                before=lambda: progress.tell_compiling(out, "trial"),
                **own,
            )
            if time.monotonic() > until:
                count = counted(len(result.trials), "proposal was", "proposals were")
                out.warn(f"the time (--limit) is over: {count} sent through a trial, no other")
        if not result.partial:
            result = dataclasses.replace(result, dearer=next_class(result, partial(propose, ())))
        tried = [columns.values(tooling_trials.TRIED_COLUMNS, design) for design in result.trials]
        document = tables.document(result) | {"trial": tried}
        denied, agreed = tables.trials(result)
        out.warn(*result.warnings, *denied)
        out.say(*agreed, *tables.remarks(result, request["efficiency"]))
        out.write(folder, tables.offers(result, settings, cad, fields=marking.SheetFields(**fields)))
        summary = tables.summary(result, out.format)
        out.show(summary, document, hidden=tables.HIDDEN, spare=tables.TABLE_SPARE_COLUMNS)
