"""``feeder aspects``."""

import click

from feederscrew_cli import options

SURFACES = click.Choice(["soft", "medium", "hard"])


@click.command(short_help="Resting aspects of a part and how often it lands on each.")
@options.part
@click.option("--all", "unstable", is_flag=True, help="List the facets it rolls off as well.")
@click.option(
    "--as-published", is_flag=True, help="Count each class once in p_pmi, as Tables 3-8 and 3-9 do."
)
@click.option(
    "--surface", type=SURFACES, default="hard", show_default=True, help="What it lands on, for p_surface."
)
@click.option("--surface-exponent", type=options.Number(-10, 10), help="The same as a number, 0 to about 3.")
@click.option(
    "--drop", "drops", type=click.IntRange(1, 10**7), help="Drop it so often; adds p_drop, the answer then."
)
@click.option("--graph", is_flag=True, help="With -o: what tips into what over which barrier, CSV and PNG.")
@options.pictures
@options.output
def aspects(part, unstable, as_published, surface, surface_exponent, drops, graph, pictures, out):
    """Example: feeder aspects parts/lbracket_30x20x15.stl -o results

    List the resting aspects of PART, equal ones joined into classes, with their geometry and
    their probability by every rule, and what it takes to tip them.

    PART is a mesh (STL, OBJ, PLY, OFF, GLB, 3MF, STEP), a part card (YAML), or - for standard
    input. With -o: aspects.csv, aspects.json, aspects.png, probabilities.png and run.json.
    """
    from feederscrew.output import columns
    from feederscrew.output.aspects import files as sheets

    _files_wanted(graph, out)
    solid = out.part(part)
    lands = surface if surface_exponent is None else surface_exponent
    told = {"as_published": as_published, "unstable": unstable, "surface": lands}
    with out.folder(
        solid.name, {solid.source: solid.sha256}, columns.conditions(solid) | told | {"drops": drops}
    ) as folder:
        found = _found(solid, as_published, unstable, surface, surface_exponent, out)
        tally = _dropped(solid, found, drops, out)
        document = columns.document(found, solid, tally)
        if folder:
            out.say(*sheets.aspects(folder, solid, found, document, graph=graph, pictures=pictures))
    out.show(document["aspects"], document, hidden=columns.HIDDEN)


def _files_wanted(graph, out):
    if graph and out.directory is None:
        raise click.UsageError("--graph writes files: give -o DIR as well")


def _found(solid, as_published, unstable, surface, own, out):
    """The aspects, and what there is to say of them."""
    with out.step("aspects"):
        from feederscrew.resting.aspects import find, waits
        from feederscrew.resting.rules.surface import EXPONENTS

        if waits(solid):
            out.say("Compiling what large hulls need, once on this machine: about ten seconds.")
        exponent = EXPONENTS[surface] if own is None else own
        found = find(solid, unstable=unstable, as_published=as_published, exponent=exponent)
    out.say(f"Material: {solid.material}")
    out.warn(*found.warnings)
    return found


def _dropped(solid, found, drops, out):
    """Counts of a drop test with the usual launches; None without ``--drop``."""
    if drops is None:
        return None
    from feederscrew.dropping import runs
    from feederscrew.resting.rules.recommended import LAUNCH
    from feederscrew_cli.drop import announce, progress

    announce(out)
    with progress(out) as bar:
        return runs.test(solid, found, LAUNCH, {}, drops=drops, progress=bar.reach).tally
