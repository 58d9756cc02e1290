"""``feeder headings``."""

import click

from feederscrew_cli import grouped, options


@grouped.command(short_help="How a part lies along the track's wall, and whether it stays on.")
@options.part
@click.option("--aspect", metavar="NAME", help="As `feeder aspects` names it.  [default: every one]")
@options.bowl
@options.pictures
@options.output
def headings(part, aspect, bowl, pictures, out):
    """Example: feeder headings parts/lbracket_30x20x15.stl --aspect A --set track.width="12 mm" -o results

    The headings in which PART, resting on an aspect and pushed outward, is stable against the bowl wall.
    Each has the share of all directions that ends in it, the length it takes along the track and the
    width it needs. A column says whether it falls off the track's free edge. A heading, its half turn
    and its mirror image are rows of their own.

    PART is a mesh. The wall has the bowl's radius. straight_wall_share is for a straight wall. With -o:
    headings.csv, headings.json and a picture of each aspect from above.
    """
    from feederscrew.bowl import record, texts
    from feederscrew.output import columns, offers
    from feederscrew.output import headings as headings_output
    from feederscrew.studies.headings import headings as study

    solid, bowl_settings = out.part(part), out.settings(bowl)
    conditions = columns.conditions(solid) | texts(bowl_settings)
    with out.folder(solid.name, solid.inputs, conditions) as folder:
        result = study(solid, record(bowl_settings), aspect)
        out.say(headings_output.answer(result), *headings_output.remarks(result))
        offers.write(folder, headings_output.offers(result), pictures=pictures)
    frame, document = headings_output.frame(result), headings_output.document(result)
    out.show(
        frame, document, hidden=headings_output.HIDDEN_HEADING_COLUMNS, spare=headings_output.SPARE_COLUMNS
    )
