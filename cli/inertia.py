"""``feeder inertia``."""

from feederscrew_cli import grouped, options


@grouped.command(short_help="Volume, mass, centre of mass and inertia of a part.")
@options.part
@options.output
def inertia(part, out):
    """Example: feeder inertia parts/hexbolt_m8x25.stl --density brass

    Volume, mass, centre of mass, inertia about the centre of mass and about the file's origin,
    principal moments and axes, convex hull and bounding box of PART.

    PART is a mesh (STL, OBJ, PLY, OFF, GLB, 3MF, STEP), a part card (YAML), or - for standard
    input; what a card does not give stays empty. With -o: inertia.csv, or inertia.json with
    --format json, and run.json.
    """
    from feederscrew.output import columns, offers
    from feederscrew.output import inertia as inertia_output
    from feederscrew.studies.inertia import inertia as inertia_study

    solid = out.part(part)
    study = inertia_study(solid)
    with out.folder(solid.name, solid.inputs, columns.conditions(solid)) as folder:
        out.say(f"Material: {solid.material}")
        offers.write(folder, inertia_output.offers(study, out.format))
    out.show(inertia_output.rows(study), inertia_output.document(study))
