"""``feeder track``."""

import click

from feederscrew_cli import completion, grouped, options
from feederscrew_cli.values import Angle


@grouped.command(short_help="Reactions and motion of a part on the track, against the wall.")
@options.part
@click.option("--aspect", metavar="NAME", help="As `feeder aspects` names it.  [default: the likeliest]")
@click.option("--heading", type=Angle(), metavar="ANGLE", help="As laid down.  [default: the most frequent]")
@click.option("--as-published", is_flag=True, help="Solve the thesis's printed equations, [4.29] to [4.62].")
@click.option(
    "--vary",
    "spans",
    metavar="KEY=FROM:TO:COUNT",
    multiple=True,
    shell_complete=completion.keys,
    help="Twice, for a map: track.bank=0:30:61.  [default: bank and climb, with -o]",
)
@options.bowl
@options.pictures
@options.output
def track(part, aspect, heading, as_published, spans, bowl, pictures, out):
    """Example: feeder track parts/lbracket_30x20x15.stl --set track.bank="10 deg" -o results

    Reactions on PART on the banked, climbing track against the bowl wall, its acceleration and the
    friction it needs. Also which contact opens first, and about which axis it then tips.

    PART is a mesh or a part card. A heading says how the part is laid. Pushed to the wall, it turns to
    the stable heading of that range (see `feeder headings`). The table gives the upper reversal.
    --format csv gives the cycle, or with --vary the map. With -o: track.json, the cycle, a map over two
    bowl values and the part from above and from behind, as CSV and PNG.
    """
    from feederscrew.bowl import key_ranges, record, texts
    from feederscrew.output import columns, offers
    from feederscrew.output import track as track_output
    from feederscrew.studies import track as complete
    from feederscrew.thesis import motion as by_print

    _fitting(spans)
    solid, bowl_settings, varied = out.part(part), out.settings(bowl), key_ranges(spans)
    conditions = columns.conditions(solid) | texts(bowl_settings)
    with out.folder(solid.name, solid.inputs, conditions) as folder:
        study = (by_print if as_published else complete).track(
            solid, record(bowl_settings), aspect, heading=heading
        )
        grid = study.over(bowl_settings, varied) if spans or folder else None
        out.say(*track_output.remarks(study), *(track_output.map_remarks(grid) if grid else ()))
        if folder:
            offers.write(folder, track_output.offers(study, grid), pictures=pictures)
    document = track_output.document(study)
    out.show(track_output.cells(grid) if spans else track_output.frame_of(document, out.format), document)


def _fitting(spans):
    """Wrong calls."""
    if len(spans) not in (0, 2):
        raise click.UsageError(f"--vary is given {len(spans)} times - give it twice, for a map")
