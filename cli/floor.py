"""``feeder floor``."""

import click

from feederscrew_cli import grouped, options
from feederscrew_cli.values import Angle


@grouped.command(short_help="Forces and motion of a part on the bowl floor.")
@options.part
@click.option("--aspect", metavar="NAME", help="As `feeder aspects` names it.  [default: the likeliest]")
@click.option(
    "--heading", type=Angle(), metavar="ANGLE", default="0deg", help="theta, counter-clockwise from above."
)
@click.option("--as-published", is_flag=True, help="Solve the thesis's printed equations, [4.13] to [4.28].")
@options.bowl
@options.pictures
@options.output
def floor(part, aspect, heading, as_published, bowl, pictures, out):
    """Example: feeder floor parts/lbracket_30x20x15.stl --aspect A --heading 30deg -o results

    Forces on PART resting on an aspect, its acceleration and turning, and where the normal force acts.
    They say whether it sticks, slides, hops or tips, at the upper reversal and over a whole cycle.

    PART is a mesh or a part card. The table gives the upper reversal. --format csv gives the cycle. With -o:
    floor.json, the cycle, maps over (beta, mu) and (frequency, amplitude) as Figures 5-6 and 5-7, and
    theta'' over the heading, as CSV and PNG.
    """
    from feederscrew.bowl import record, texts
    from feederscrew.output import columns, offers
    from feederscrew.output import floor as floor_output
    from feederscrew.studies import floor as complete
    from feederscrew.thesis import motion as by_print

    solid, bowl_settings = out.part(part), out.settings(bowl)
    conditions = columns.conditions(solid) | texts(bowl_settings)
    with out.folder(solid.name, solid.inputs, conditions) as folder:
        study = (by_print if as_published else complete).floor(
            solid, record(bowl_settings), aspect, heading=heading
        )
        out.say(*floor_output.remarks(study), *(floor_output.map_remarks(study) if folder else ()))
        offers.write(folder, floor_output.offers(study), pictures=pictures)
    document = floor_output.document(study)
    out.show(floor_output.printed(document, out.format), document)
