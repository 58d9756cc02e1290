"""``feeder aspects``."""

import click

from cli import options


@click.command(short_help="Resting aspects of a part and how often it lands on each.")
@options.part
@click.option("--all", "unstable", is_flag=True, help="List the facets it rolls off as well.")
@click.option(
    "--as-published", is_flag=True, help="Count each class once in p_pmi, as Tables 3-8 and 3-9 do."
)
@options.pictures
@options.output
def aspects(part, unstable, as_published, pictures, out):
    """Example: feeder aspects parts/lbracket_30x20x15.stl -o results

    List the resting aspects of PART, equal ones joined into classes, with their geometry and
    their probability by every rule.

    PART is a mesh (STL, OBJ, PLY, OFF, GLB, 3MF, STEP), a part card (YAML), or - for standard
    input. With -o: aspects.csv, aspects.json, aspects.png, probabilities.png and run.json.
    """
    from feederscrew.output import columns, sheets

    solid = out.part(part)
    effective = columns.conditions(solid) | {"as_published": as_published, "unstable": unstable}
    with out.folder(solid.name, {solid.source: solid.sha256}, effective) as folder:
        with out.step("aspects"):
            from feederscrew.resting.aspects import find

            found = find(solid, unstable=unstable, as_published=as_published)
        out.say(f"Material: {solid.material}")
        out.warn(*found.warnings)
        document = columns.part(solid, found.warnings) | {"aspects": columns.aspects(found, solid)}
        if folder:
            out.say(*sheets.aspects(folder, solid, found, document, pictures=pictures))
    out.show(document["aspects"], document, hidden=columns.NORMALS)
