"""``feeder design``."""

import contextlib
import dataclasses
import functools
import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.interrupt import exit_status, hold_interrupts, note_interrupts
from feederscrew_cli.options import Output, Values

if TYPE_CHECKING:
    from feederscrew.arrivals.entry import Shares
    from feederscrew.bowl import Bowl
    from feederscrew.bowl.reading import Setting
    from feederscrew.designing.families import FamilyStudy
    from feederscrew.designing.record import DesignRequest, DesignStudy
    from feederscrew.output.folder import ResultFolder
    from feederscrew.part.record import Part

REQUEST = (  # what shall leave, and what may be used
    options.target("Parts that must leave the bowl: 60/min."),
    options.aspect(
        "Aspect on which they must leave.  [default: the one that delivers most]",
    ),
    options.heading("DEG", "Heading of that aspect.  [default: the one that delivers most]"),
    options.option("--up", "NAME,...", "Aspects that count as one, whatever their heading: A,B.", default=""),
    options.choice(
        "--outcome",
        ["any", "lying", "hanging"],
        default="any",
        text="Lying on the track, or hanging by the head between rails.",
    ),
    options.option(
        "--without", "KINDS", "Kinds of devices that are not used: 'wiper,vision reject'.", default=""
    ),
    options.choice(
        "--drive",
        ["leaf-spring", "two-axis", "any"],
        default="leaf-spring",
        text="Kind of drive: one magnet on leaf springs, or two magnets with a two-channel controller.",
    ),
    options.option(
        "--diameter",
        "LOW:HIGH",
        "Least and greatest diameter of the bowl: 200mm:400mm.",
        type=options.span,
    ),
    options.quantity(
        "--tolerance",
        "length",
        "0.1 mm",
        "How much larger or smaller than its file a part may be.",
    ),
    options.whole(
        "--trials budget",
        1,
        1000,
        "Short trials of the search, at most; those of air for what stands at steel come on top.",
        default=16,
        former=("--budget",),
    ),
    options.flag(
        "--alternatives",
        "Prove the best design of each class: steel, steady air, sensor with valve.",
    ),
    options.flag(
        "--quick",
        "A bound on the rate and a first chain within 30 s, for a quotation: not proved.",
    ),
    options.quantity(
        "--agreed-jams",
        "rate",
        "1/h",
        "Jams that the buyer tolerates: what acceptance.csv demands.",
        positive=True,
    ),
    options.choice(
        "--proof",
        ["usual", "long"],
        default="usual",
        text="How long the design that holds is followed. 'long': until --agreed-jams is shown, hours of "
        "computing; started again it goes on where it was.",
    ),
    options.whole(
        "--draws",
        1,
        1000,
        default=20,
        text="Trials of the answer with part, friction, drive and cuts drawn from their spread.",
    ),
    options.seed("Seed of everything that is drawn."),
    options.jobs,
)
CONDITIONAL = 3  # exit status of a design that holds under a condition only
OF_ONE_PART = ("aspect", "heading", "up", "probabilities", "names", "centre_of_mass")  # options


@grouped.command(
    short_help="From a part and a rate to a bowl that its own trial confirms.",
    rare=("heading", "budget", "draws", "tolerance", "agreed_jams", "proof"),
)
@options.part
@click.argument("more_parts", metavar="[PART...]", nargs=-1, type=options.FILE)
@options.group("request_options", *REQUEST)
@options.flag("--batch is_list", "PART is a list of parts and targets: part,target,aspect.")
@options.rule
@orientation.share_options
@options.bowl
@options.drawn_output
def design(
    part: Values,
    more_parts: tuple[str, ...],
    request_options: Values,
    is_list: bool,
    rule: str,
    share_options: Values,
    bowl: Values,
    out: Output,
) -> None:
    """Example: feeder design washer_m6.stl --target 40/min -o results

    Which way up to feed PART, the chain of devices, the track and the drive. Each proposal is tried, and
    what its trial denies is changed. What gets through goes through a queue at low, normal and high fill,
    and through draws of part, friction, drive and cuts. Chains of steel come first, then steady air, then
    cameras with a valve: the first that holds is taken. What falls short says where, with the nearest
    design that would hold, and ends in commands to try.

    The answer is holds, falls short or none. Two answers hold under a condition: holds if parts arrive single
    (two of them hook), and tooling holds, its machine cannot be made. The exit status is 3 of these two, and
    else 0 of a run that came to its end.

    The drive is the calmest on one set of leaf springs that is fast enough, at the frequency of the mains
    (machine.mains) or twice that. What --config says of track, drive, machine and friction is kept. Its
    devices stay before those of the design.
    The same seed gives the same answer whatever the number of jobs. Ctrl-C ends it
    with exit status 130 as not proved: it says what was counted so far, and writes no papers to build from.

    --quick looks for a quotation: a bound on the rate, and the first chain of at most six short trials. No
    draw and no queue is run, so its answer is always not proved, on every paper, and the exit status is 0.

    Of several parts each is designed for one track and one chain of devices, as far as they go: what is
    changed from one to the next is listed in family/changeover.csv and on the page family/family.html. Each
    has its own folder.

    --batch designs each part of a list for a bowl of its own, one after the other. A line without a target
    has that of --target. One table says what holds (designs.csv); a part that fails does not stop the others.

    With -o: design.yaml, a bowl file that says what its trial showed, and design.html, the page to hand on.
    Also alternatives.csv, acceptance.csv, design_trials.csv, and the files of feeder tooling and feeder
    bowl, with the bowl as a solid. Drawings of what falls short bear a mark across; what delivers nothing
    has none.
    """
    context = click.get_current_context()
    if request_options["target"] is None and not is_list:
        param = next(param for param in context.command.params if param.name == "target")
        raise click.MissingParameter(ctx=context, param=param)
    for name in OF_ONE_PART if more_parts or is_list else ():
        if any(group.get(name) not in (None, "", ()) for group in (request_options, share_options, part)):
            raise click.UsageError(f"--{name.replace('_', '-')} is of one part - design that one alone")
    if more_parts and is_list:
        raise click.UsageError("--batch goes with one list - or name the parts without it")
    if more_parts and request_options["quick"]:
        raise click.UsageError("--quick is of one part - design that one alone")
    orientation.check_heading(request_options)
    with hold_interrupts():
        from feederscrew import bowl as bowls
        from feederscrew.bowl.verified import CONDITIONS
        from feederscrew.designing import calls, loop
        from feederscrew.designing.design import complete_design
        from feederscrew.designing.record import DesignRequest
        from feederscrew.output import designs

    out.tell_unread(bowl["path"])
    settings, path = bowls.settings(**bowl), bowl["path"]
    out.warn(*bowls.assumptions(settings))
    own = request_options | {"jobs": request_options["jobs"] or os.cpu_count(), "rule": rule}

    def in_effect(settings: Sequence["Setting"]) -> "tuple[Bowl, set[str]]":
        """The bowl of some settings, and the names of the keys that the user gave."""
        return bowls.record(settings), {s.key.name for s in settings if s.is_own}

    def design_part(
        solid: "Part", values: Values, aspect_shares: "Shares | None" = None, *, is_shown: bool = False
    ) -> "DesignStudy":
        own_settings = bowls.with_part_material(settings, solid.material)
        out.warn(*bowls.friction_remarks(own_settings, solid.material))
        record, user_keys = in_effect(own_settings)
        inputs = (aspect_shares.inputs if aspect_shares else {}) | bowls.identity(path)
        request = DesignRequest(**values)
        with out.folder_of(solid, inputs, settings=own_settings) as folder:
            with _stoppable(out) as search:
                complete = functools.partial(complete_design, settings=own_settings)
                study = loop.design(
                    solid, record, user_keys, request, shares=aspect_shares, complete=complete, **search
                )
            call = out.arguments if is_shown else calls.call_words(request, solid, own_settings)
            study = dataclasses.replace(study, call=call)
            study = _write(out, folder, study, own_settings)
            if is_shown:
                out.show(designs.summary(study), designs.document(study))
        return study

    if is_list:
        context.exit(_batch(out, part, own, design_part, settings, path))
    if more_parts:
        parts = [out.part(part | {"source": source}) for source in (part["source"], *more_parts)]
        study: FamilyStudy | DesignStudy = _family(
            out, parts, (*in_effect(settings), DesignRequest(**own)), settings, path
        )
    else:
        solid, aspect_shares = out.part(part), None
        if any(value is not None for value in share_options.values()):
            record, _ = in_effect(bowls.with_part_material(settings, solid.material))
            loop.check_request(solid, record, DesignRequest(**own))
            aspect_shares = orientation.shares(out, solid, record, share_options, own)
        study = design_part(solid, own, aspect_shares, is_shown=True)
    if study.partial:  # what is not proved is no success
        context.exit(exit_status())
    if study.status in CONDITIONS:  # who goes by the exit status must not miss the condition
        context.exit(CONDITIONAL)


def _batch(
    out: Output,
    part: Values,
    own: Values,
    design_part: Callable[..., "DesignStudy"],
    settings: Sequence["Setting"],
    path: str | None,
) -> int:
    """Each part of a list for a bowl of its own, and one table of what holds; the exit status."""
    from feederscrew import bowl as bowls
    from feederscrew.base.errors import FeederError
    from feederscrew.bowl.verified import CONDITIONS
    from feederscrew.jobs.batch import inputs as lists
    from feederscrew.output import designs, offers

    orders = lists.read_orders(part["source"])
    lacks = next((order for order in orders if (order.target or own["target"]) is None), None)
    if lacks:
        raise click.UsageError(f"{lacks.line} has no target, nor has the call - add --target 40/min")
    inputs, rows = bowls.identity(part["source"]) | bowls.identity(path), []
    is_stopped = False
    out.check_folder("designs", inputs)
    for order in orders:
        values = own | {"target": order.target or own["target"], "aspect": order.aspect}
        out.say(f"{order.line}: {order.source}")
        try:
            study = design_part(out.part(part | {"source": order.source}), values)
        except FeederError as fault:
            out.fault(fault)
            failed = {"status": lists.FAILED, "why": str(fault)}
            rows.append(lists.order_row(order, values["target"], failed))
            continue
        rows.append(lists.order_row(order, values["target"], designs.document(study)))
        is_stopped = study.partial
        if is_stopped:
            break
    with out.folder("designs", inputs, bowls.texts(settings)) as folder:
        out.write(folder, [offers.table("designs.csv", lists.order_table, rows)])
    out.show(lists.order_table(rows), {"designs": rows})
    if is_stopped:
        return exit_status()
    if any(row["status"] == lists.FAILED for row in rows):
        return 1
    return CONDITIONAL if any(row["status"] in CONDITIONS for row in rows) else 0


@contextlib.contextmanager
def _stoppable(out: Output) -> Iterator[Values]:
    """Yield keywords that tell of a search, and end it where a Ctrl-C was dropped while something loaded."""
    with note_interrupts() as let_through:
        bar = progress.StageBar(not out.quiet)

        def tell(text: str) -> None:
            let_through()
            bar.clear()
            out.say(text)

        try:
            before = lambda: progress.tell_compiling(out, "trial")  # noqa: E731
            yield {"tell": tell, "before": before, "progress": bar.reach}
        finally:
            bar.clear()


def _write(
    out: Output, folder: "ResultFolder | None", study: "DesignStudy", settings: Sequence["Setting"]
) -> "DesignStudy":
    """Write the files of one design; return it with the limits that its machine is out of."""
    from feederscrew.bowl.verified import Status
    from feederscrew.designing import design
    from feederscrew.output import design_pages, designs

    is_proved = study.status is not Status.NOT_PROVED
    built = design.build_machine(study, settings) if is_proved else design.Built()
    study = design.with_machine(study, built)
    if study.bowl is not None:  # read back and compared, whether or not it is kept
        designs.bowl_file(study, settings, built.sheet)
    out.warn(*study.warnings, *([f"no solid of the bowl is made: {built.why}"] if built.why else []))
    if is_proved or not _keeps_earlier(out, folder, "design.html"):
        out.write(folder, design_pages.offers(study, settings, built), jobs=study.request.jobs)
    return study


def _keeps_earlier(out: Output, folder: "ResultFolder | None", page: str) -> bool:
    """Leave a folder as it is where it holds a design that was proved to its end; whether it does."""
    from feederscrew.bowl.verified import Status

    command, document = "design", page.replace(".html", ".json")
    if folder is None or not folder.has_file(command, page):
        return False
    if folder.document(document).get("status") == Status.NOT_PROVED:  # an earlier quick look
        return False
    folder.untouched = True
    out.warn(
        f"{folder.path} keeps the files of an earlier design: nothing of one that is not proved is written"
    )
    return True


def _family(
    out: Output,
    parts: Sequence["Part"],
    problem: tuple["Bowl", set[str], "DesignRequest"],
    settings: Sequence["Setting"],
    path: str | None,
) -> "FamilyStudy":
    """Several parts for one bowl; the study of all of them."""
    from feederscrew import bowl as bowls
    from feederscrew.designing import families
    from feederscrew.output import design_pages

    families.check_names(parts)
    inputs = {name: value for part in parts for name, value in part.inputs.items()} | bowls.identity(path)
    out.check_folder("family", inputs)
    with _stoppable(out) as search:
        study = families.family(parts, *problem, **search)
    members = []
    for member in study.members:
        with out.folder_of(member.part, bowls.identity(path), settings=settings) as folder:
            members.append(_write(out, folder, member, settings))
    study = dataclasses.replace(study, members=tuple(members))
    with out.folder("family", inputs, bowls.texts(settings)) as folder:
        if not (study.partial and _keeps_earlier(out, folder, "family.html")):
            out.write(folder, design_pages.family_offers(study))
        out.show(design_pages.family_summary(study), design_pages.family_document(study))
    return study
