"""``feeder bowl``."""

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.options import Output, Values

SOLID_OPTIONS = (
    options.flag("--solid", "Make the bowl as one closed body: STL, 3MF and a drawing."),
    options.choice(
        "--print material",
        ["pla", "pa12", "steel"],
        default="steel",
        text="What the solid is made of: thickness of wall and floor.",
    ),
    options.option(
        "--bed",
        "XxYxZ",
        "Cut it into segments that fit a printer: 220x220x250mm; with holes for dowels at the seams.",
    ),
    options.choice(
        "--join",
        ["dowels", "screws"],
        "What holds the segments together: dowels, or screws in lugs outside the wall as well.  "
        "[default: dowels]",
    ),
    options.flag("--step", "Write bowl.step, of exact faces; needs feederscrew[cad]."),
    options.quantity(
        "--chord",
        "length",
        "0.05 mm",
        "Greatest distance of the solid's flat facets from the true arc.",
        positive=True,
    ),
)


@grouped.command(
    short_help="Size the bowl for a part and a rate; its springs, tuning and drift.",
    rare=("heading", "gap", "fill", "material", "bed", "join", "step", "chord"),
)
@options.optional_part
@options.target("Parts that must leave the bowl: 120/min.  [needed with PART]")
@options.group(
    "chain_options",
    *orientation.any_chain(
        "Aspect that must leave the bowl.  [default: every one that passes the track and the devices]"
    ),
)
@options.group("solid_request", *SOLID_OPTIONS)
@options.option(
    "--measured",
    "VALUES",
    "What was measured at the machine, 'acceleration=64 m/s2, stroke=0.3 mm, frequency=50 Hz, fill=50 %' "
    "or some of it, beside what it should be.",
)
@options.bowl
@options.title_block
@options.drawn_output
def bowl(
    part: Values,
    target: float | None,
    solid_request: Values,
    measured: str | None,
    bowl: Values,
    fields: Values,
    out: Output,
    chain_options: Values,
) -> None:
    """Example: feeder bowl lbracket_30x20x15.stl --target 60/min -o results

    With PART and --target: the diameter, track, climb, turns, fill, hopper, drive, stroke and leaf springs
    that bring the rate through the devices of the bowl file. This is the sheet that a quotation asks for.

    Without PART, the machine of the bowl file (section 'machine') is computed: natural frequency, gain, leaf
    stress and vibration angle over the radius. Sets of leaves that tune it follow, and what it does from
    full to empty.

    --measured sets what the machine does now beside what it should at that fill, and names the likely cause.

    What the bowl file says of track, drive and machine is kept. Section 'sizing' has the rules of thumb.
    With -o: bowl.json, bowl.csv, bowl_angles.csv, bowl_leaves.csv, bowl_leaf_changes.csv,
    bowl_emptying.csv and bowl.png. --solid adds bowl.stl and bowl.3mf, the bowl as one closed body with
    its track, cuts, blades and outlet. It also adds the drawing sheets as bowl.pdf and
    bowl.dxf, and bowl_solid.png. The
    mass and inertia of that body take the place of the estimate.
    """
    from feederscrew import bowl as bowls
    from feederscrew.base.errors import FeederError
    from feederscrew.cad import solid as solids
    from feederscrew.machine import condition
    from feederscrew.machine import sheet as study
    from feederscrew.output import machine, marking, proof

    _check_call(part, target, solid_request, measured, chain_options)
    out.tell_unread(bowl["path"])
    settings, path = bowls.settings(**bowl), bowl["path"]
    if measured is not None:  # the machine of the bowl file as it was found
        diagnosis = condition.diagnose(study.machine(settings), condition.read(measured))
        out.show(machine.measured_summary(diagnosis), machine.measured_document(diagnosis))
        return
    out.warn(*bowls.assumptions(settings))
    solid = out.part(part) if part["source"] else None
    if solid is not None:
        settings = bowls.with_part_material(settings, solid.material)
        out.warn(*bowls.friction_remarks(settings, solid.material))
    inputs = bowls.identity(path)
    if solid:
        place = out.folder_of(solid, inputs, settings=settings)
    else:
        place = out.folder(bowls.name(path), inputs, bowls.texts(settings))
    with place as folder:
        progress.tell_compiling(out, "conveying")
        shape = solids.solid_options(settings, **solid_request)
        tried, own = bowls.verified(path), (solid, bowls.record(settings), orientation.name(chain_options))
        holding = tried if proof.holds(tried, *own) else None
        try:
            sheet = (
                study.size_machine(
                    settings, solid, target, **chain_options, solid=shape, as_tried=holding is not None
                )
                if solid and target is not None
                else study.machine(settings)
            )
        except FeederError as fault:  # a bowl that was tried has its machine, whatever the static rule says
            if solid_request["solid"] or holding is None:
                raise
            out.warn(f"{fault}; what follows is the machine as it was tried")
            sheet = study.machine(settings)
        out.warn(*sheet.remarks, *proof.warnings(tried, *own))
        out.write(folder, machine.offers(sheet, holding, fields=marking.SheetFields(**fields)))
        document = proof.with_trial(machine.document(sheet), tried, *own)
        out.show(machine.summary(sheet, holding), document)


def _check_call(
    part: Values, target: float | None, solid_request: Values, measured: str | None, chain_options: Values
) -> None:
    has_part, solid = bool(part["source"]), solid_request["solid"]
    of_solid = () if solid else options.typed_options("material", "bed", "step", "chord")
    of_part = (*options.READING, *orientation.CHAIN_OPTIONS)
    without_part = ["--solid"] * solid + list(options.typed_options(*options.names(*of_part)))
    without_part += ["--target"] * (target is not None)
    if measured is not None and has_part:
        raise click.UsageError("--measured is given with PART - leave PART out: the bowl file says it all")
    if without_part and not has_part:
        raise click.UsageError(f"{without_part[0]} is given without PART - name the part's file")
    for option in of_solid:
        raise click.UsageError(f"{option} is given without --solid - add --solid")
    if solid_request["join"] and not solid_request["bed"]:
        raise click.UsageError("--join is given without --bed - give the printer's bed: --bed 220x220x250mm")
    orientation.check_heading(chain_options)
    if has_part and target is None:
        raise click.UsageError("PART is given without --target - give the rate as well: --target 120/min")
