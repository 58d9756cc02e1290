"""``feeder design``."""

import contextlib
import dataclasses
import os

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.interrupt import INTERRUPTED, held_back, noted
from feederscrew_cli.values import Angle, Span, Whole

REQUEST = (  # what shall leave, and what may be used
    options.target("Parts that must leave the bowl: 60/min."),
    click.option(
        "--aspect",
        metavar="NAME",
        help="Aspect on which they must leave.  [default: the one that delivers most]",
    ),
    click.option(
        "--heading",
        type=Angle(),
        metavar="DEG",
        help="Heading of that aspect.  [default: the one that delivers most]",
    ),
    click.option(
        "--up",
        default="",
        metavar="NAME,...",
        help="Aspects that count as one, whatever their heading: A,B.",
    ),
    click.option(
        "--outcome",
        type=click.Choice(["any", "lying", "hanging"]),
        default="any",
        show_default=True,
        help="Lying on the track, or hanging by the head between rails.",
    ),
    click.option(
        "--without", metavar="KINDS", default="", help="Kinds of devices that are not used: 'profile,wiper'."
    ),
    click.option(
        "--drive",
        type=click.Choice(["leaf-spring", "two-axis", "any"]),
        default="leaf-spring",
        show_default=True,
        help="Kind of drive: one magnet on leaf springs, or two magnets with a two-channel controller.",
    ),
    click.option(
        "--diameter",
        type=Span(),
        metavar="LOW:HIGH",
        help="Least and greatest diameter of the bowl: 200mm:400mm.",
    ),
    options.quantity(
        "--tolerance", "length", "0.1 mm", "How much larger or smaller than its file a part may be."
    ),
    click.option(
        "--trials",
        "budget",
        cls=options.Renamed,
        former=("--budget",),
        type=Whole(1, 1000),
        default=16,
        show_default=True,
        help="Short trials of the search, at most.",
    ),
    click.option(
        "--alternatives",
        is_flag=True,
        help="Prove the best design of each cost class: of steel, of steady air, of a sensor with a valve.",
    ),
    click.option(
        "--draws",
        type=Whole(1, 1000),
        default=20,
        show_default=True,
        help="Trials of the answer with part, friction, drive and cuts drawn from their spread.",
    ),
    options.seed("Seed of everything that is drawn."),
    options.jobs,
)


@grouped.command(
    short_help="From a part and a rate to a bowl that its own trial confirms.",
    rare=("heading", "budget", "draws", "tolerance"),
)
@options.part
@click.argument("more_parts", metavar="[PART...]", nargs=-1, type=options.FILE)
@options.group("request_options", *REQUEST)
@click.option(
    "--batch", "listed", is_flag=True, help="PART is a list of parts and targets: part,target,aspect."
)
@options.rule
@orientation.taken
@options.bowl
@options.pictures
@options.output
def design(part, more_parts, request_options, listed, rule, taken, bowl, pictures, out):
    """Example: feeder design parts/washer_m6.stl --target 40/min -o results

    Which way up to feed PART, the chain of devices, the track and the drive. Each proposal is tried, and
    what its trial denies is changed. What gets through goes through a queue at low, normal and high fill,
    and through draws of part, friction, drive and cuts. Chains of steel come first, then steady air, then
    cameras with a valve: the first that holds is taken. The answer is one of holds, falls short and none,
    with the numbers it rests on. What falls short says where, with the nearest design that would hold.

    The drive is the calmest on one set of leaf springs that is fast enough, at the frequency of the mains
    (machine.mains) or twice that. What --config says of track, drive, machine and friction is kept. Its
    devices stay before those of the design.
    The same seed gives the same answer whatever the number of jobs. Ctrl-C ends it
    with exit status 130 as not proved: it says what was counted so far, and writes no papers to build from.

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
    if request_options["target"] is None and not listed:
        raise click.MissingParameter(
            ctx=click.get_current_context(),
            param=next(p for p in click.get_current_context().command.params if p.name == "target"),
        )
    if more_parts or listed:
        _of_one_part(request_options, taken, part)
    if more_parts and listed:
        raise click.UsageError("--batch goes with one list - or name the parts without it")
    orientation.of_an_aspect(request_options)
    with held_back():
        from feederscrew import bowl as bowls
        from feederscrew.designing import loop
        from feederscrew.designing.record import DesignRequest
        from feederscrew.output import designs

    settings = bowls.settings(**bowl)
    out.warn(*bowls.assumptions(settings))
    record, user_keys = bowls.record(settings), {s.key.name for s in settings if s.is_own}
    own = request_options | {"jobs": request_options["jobs"] or os.cpu_count(), "rule": rule}
    if listed:
        _batch(out, part, own, (record, user_keys), (settings, bowl["path"], pictures))
        return
    request = DesignRequest(**own)
    named = any(value is not None for value in taken.values())
    if more_parts:
        parts = [out.part(part | {"source": source}) for source in (part["source"], *more_parts)]
        _family(out, parts, (record, user_keys, request), (settings, bowl["path"], pictures))
        return
    solid = out.part(part)
    aspect_shares = orientation.shares(out, solid, record, taken, rule) if named else None
    inputs = solid.inputs | (aspect_shares.inputs if aspect_shares else {}) | bowls.identity(bowl["path"])
    with _folder(out, solid, inputs, settings) as folder:
        with _stoppable(out) as search:
            study = loop.design(solid, record, user_keys, request, shares=aspect_shares, **search)
        study = _written(out, folder, study, settings, pictures)
        out.show(designs.summary(study), designs.document(study))
    _ended(study)


def _batch(out, part, own, bowl, written):
    """Each part of a list for a bowl of its own, and one table of what holds."""
    from feederscrew import bowl as bowls
    from feederscrew.batch import design_list
    from feederscrew.designing import loop
    from feederscrew.designing.record import DesignRequest
    from feederscrew.errors import FeederError
    from feederscrew.output import designs, offers

    (settings, path, pictures), (record, user_keys) = written, bowl
    orders = design_list.read_orders(part["source"])
    lacks = next((order for order in orders if (order.target or own["target"]) is None), None)
    if lacks:
        raise click.UsageError(f"{lacks.line} has no target, nor has the call - add --target 40/min")
    rows = []
    for order in orders:
        values = own | {"target": order.target or own["target"], "aspect": order.aspect}
        out.say(f"{order.line}: {order.source}")
        try:
            solid = out.part(part | {"source": order.source})
            with _folder(out, solid, solid.inputs | bowls.identity(path), settings) as folder:
                with _stoppable(out) as search:
                    study = loop.design(solid, record, user_keys, DesignRequest(**values), **search)
                study = _written(out, folder, study, settings, pictures)
        except FeederError as fault:
            out.say(f"Error: {fault}")
            rows.append(design_list.row_of_fault(order, values["target"], fault))
            continue
        rows.append(design_list.row_of(order, values["target"], designs.document(study)))
        if study.partial:
            break
    inputs = bowls.identity(part["source"]) | bowls.identity(path)
    with out.folder("designs", inputs, bowls.texts(settings)) as folder:
        offers.write(folder, [offers.table("designs.csv", design_list.table, rows)])
    out.show(design_list.table(rows), {"designs": rows})
    if rows[-1]["status"] == "not proved":
        click.get_current_context().exit(INTERRUPTED)
    click.get_current_context().exit(int(any(row["status"] == design_list.FAILED for row in rows)))


def _ended(study):
    """End as stopped where the user stopped it: what is not proved is no success."""
    if study.partial:
        click.get_current_context().exit(INTERRUPTED)


@contextlib.contextmanager
def _stoppable(out):
    """What tells of a search, and ends it where a Ctrl-C was dropped while something loaded."""
    with noted() as let_through:
        bar = progress.design(out)

        def tell(text):
            let_through()
            bar.clear()
            out.say(text)

        try:
            yield {"tell": tell, "before": lambda: progress.trial(out), "progress": bar.reach}
        finally:
            bar.end()


OF_ONE = (
    "aspect",
    "heading",
    "up",
    "probabilities",
    "names",
    "centre_of_mass",
)  # options that tell of a part


def _of_one_part(*groups):
    """Refuse options that are of one part where there are several."""
    for name in OF_ONE:
        if any(group.get(name) not in (None, "", ()) for group in groups):
            raise click.UsageError(f"--{name.replace('_', '-')} is of one part - design that one alone")


def _folder(out, solid, inputs, settings):
    from feederscrew import bowl as bowls
    from feederscrew.output import columns

    return out.folder(solid.name, inputs, columns.conditions(solid) | bowls.texts(settings))


def _written(out, folder, study, settings, pictures):
    """What one design leaves in its folder; returns the design with what its machine is out of limits in."""
    from feederscrew.designing import design
    from feederscrew.output import design_pages, designs, offers

    built = design.Built() if study.partial else design.built(study, settings)
    study = design.with_machine(study, built)
    if study.bowl is not None:  # read back and compared, whether or not it is kept
        designs.bowl_file(study, settings, built.sheet)
    out.warn(*study.warnings, *([f"no solid of the bowl is made: {built.why}"] if built.why else []))
    if not (study.partial and _keeps_earlier(out, folder, "design.html")):
        offers.write(folder, design_pages.offers(study, settings, built), pictures=pictures)
    return study


def _keeps_earlier(out, folder, page):
    """Leave a folder as it is where it holds a design that was proved to its end; whether it does."""
    if folder is None or not folder.has_file("design", page):
        return False
    folder.untouched = True
    out.warn(f"{folder.path} keeps the files of an earlier design: nothing of the stopped one is written")
    return True


def _family(out, parts, problem, written):
    """Several parts for one bowl."""
    from feederscrew import bowl as bowls
    from feederscrew.designing import families
    from feederscrew.output import design_pages, offers

    settings, path, pictures = written
    families.named_apart(parts)
    with _stoppable(out) as search:
        study = families.family(parts, *problem, **search)
    members = []
    for member in study.members:
        with _folder(out, member.part, member.part.inputs | bowls.identity(path), settings) as folder:
            members.append(_written(out, folder, member, settings, pictures))
    study = dataclasses.replace(study, members=tuple(members))
    inputs = {name: value for part in parts for name, value in part.inputs.items()}
    with out.folder("family", inputs | bowls.identity(path), bowls.texts(settings)) as folder:
        if not (study.partial and _keeps_earlier(out, folder, "family.html")):
            offers.write(folder, design_pages.family_offers(study), pictures=pictures)
        out.show(design_pages.family_summary(study), design_pages.family_document(study))
    _ended(study)
