"""``feeder floor``, ``track``, ``headings`` and ``slide``: a part on the floor and at the wall."""

import click

from feederscrew_cli import grouped, options
from feederscrew_cli.options import Output, Values

LIKELIEST = "As `feeder aspects` names it.  [default: the likeliest]"


def vibration_angle(value: str) -> float:
    """Return a vibration angle, within the limits of the bowl file's.

    Parameters
    ----------
    value : str
        '20' or '20 deg'.

    Returns
    -------
    float [rad]

    Raises
    ------
    click.BadParameter
        If it is not an angle, or out of the limits.
    """
    from feederscrew.base.errors import ConfigError
    from feederscrew.bowl.reading import checked
    from feederscrew.bowl.schema import BY_NAME

    key = BY_NAME["drive.vibration_angle"]
    try:
        return checked(key, value, key.name, bare=True).value
    except ConfigError as fault:
        raise click.BadParameter(f"{fault.what} - {fault.mend}") from None


@grouped.command(short_help="Forces and motion of a part on the bowl floor.")
@options.part
@options.aspect(LIKELIEST)
@options.heading("ANGLE", "theta, counter-clockwise from above.", default="0deg")
@options.as_published("Solve the thesis's printed equations, [4.13] to [4.28].")
@options.bowl
@options.drawn_output
def floor(
    part: Values, aspect: str | None, heading: float, as_published: bool, bowl: Values, out: Output
) -> None:
    """Example: feeder floor lbracket_30x20x15.stl --aspect A --heading 30deg -o results

    Forces on PART resting on an aspect, its acceleration and turning, and where the normal force acts.
    They say whether it sticks, slides, hops or tips, at the upper reversal and over a whole cycle.

    PART is a mesh or a part card. The table gives the upper reversal. --format csv gives the cycle. With -o:
    floor.json, the cycle, maps over (beta, mu) and (frequency, amplitude) as Figures 5-6 and 5-7, and
    theta'' over the heading, as CSV and PNG.
    """
    from feederscrew.arrivals import floor as complete
    from feederscrew.output import floor as floor_output
    from feederscrew.thesis import motion as by_print

    solid, settings, record = out.part_in_bowl(part, bowl)
    with out.folder_of(solid, settings=settings) as folder:
        study = (by_print if as_published else complete).floor(solid, record, aspect, heading=heading)
        out.say(*floor_output.remarks(study), *(floor_output.map_remarks(study) if folder else ()))
        out.write(folder, floor_output.offers(study))
    document = floor_output.document(study)
    out.show(floor_output.printout(document, out.format, floor_output.summary), document)


@grouped.command(short_help="Reactions and motion of a part on the track, against the wall.")
@options.part
@options.aspect(LIKELIEST)
@options.heading("ANGLE", "As laid down.  [default: the most frequent]")
@options.as_published("Solve the thesis's printed equations, [4.29] to [4.62].")
@options.vary("Twice, for a map: track.bank=0:30:61.  [default: bank and climb, with -o]")
@options.bowl
@options.drawn_output
def track(
    part: Values,
    aspect: str | None,
    heading: float | None,
    as_published: bool,
    spans: tuple[str, ...],
    bowl: Values,
    out: Output,
) -> None:
    """Example: feeder track lbracket_30x20x15.stl --set track.bank="10 deg" -o results

    Reactions on PART on the banked, climbing track against the bowl wall, its acceleration and the
    friction it needs. Also which contact opens first, and about which axis it then tips.

    PART is a mesh or a part card. A heading says how the part is laid. Pushed to the wall, it turns to
    the stable heading of that range (see `feeder headings`). The table gives the upper reversal.
    --format csv gives the cycle, or with --vary the map. With -o: track.json, the cycle, a map over two
    bowl values and the part from above and from behind, as CSV and PNG.
    """
    from feederscrew.bowl import key_ranges
    from feederscrew.output import track as track_output
    from feederscrew.output.floor import printout
    from feederscrew.sorting import track as complete
    from feederscrew.thesis import motion as by_print

    if len(spans) not in (0, 2):
        raise click.UsageError(f"--vary is given {len(spans)} times - give it twice, for a map")
    solid, settings, record = out.part_in_bowl(part, bowl)
    varied = key_ranges(spans)
    with out.folder_of(solid, settings=settings) as folder:
        study = (by_print if as_published else complete).track(solid, record, aspect, heading=heading)
        grid = study.over(settings, varied) if spans or folder else None
        out.say(*track_output.remarks(study), *(track_output.map_remarks(grid) if grid else ()))
        if folder:
            out.write(folder, track_output.offers(study, grid))
    document = track_output.document(study)
    table = (
        track_output.cells(grid) if spans and grid else printout(document, out.format, track_output.summary)
    )
    out.show(table, document)


@grouped.command(short_help="How a part lies along the track's wall, and whether it stays on.")
@options.part
@options.aspect("As `feeder aspects` names it.  [default: every one]")
@options.bowl
@options.drawn_output
def headings(part: Values, aspect: str | None, bowl: Values, out: Output) -> None:
    """Example: feeder headings lbracket_30x20x15.stl --aspect A --set track.width="12 mm" -o results

    The headings in which PART, resting on an aspect and pushed outward, is stable against the bowl wall.
    Each has the share of all directions that ends in it, the length it takes along the track and the
    width it needs. A column says whether it falls off the track's free edge. A heading, its half turn
    and its mirror image are rows of their own.

    PART is a mesh. The wall has the bowl's radius. straight_wall_share is for a straight wall. With -o:
    headings.csv, headings.json and a picture of each aspect from above.
    """
    from feederscrew.output import headings as headings_output
    from feederscrew.sorting.headings import headings as study

    solid, settings, record = out.part_in_bowl(part, bowl)
    with out.folder_of(solid, settings=settings) as folder:
        result = study(solid, record, aspect)
        out.say(headings_output.answer(result), *headings_output.remarks(result))
        out.write(folder, headings_output.offers(result))
    document = headings_output.document(result)
    out.show(result.table(), document, spare=headings_output.SPARE_COLUMNS)


@grouped.command(short_help="Map of when a part slips, and which way.")
@options.option(
    "--beta betas",
    "DEG",
    "Vibration angle; repeatable.  [default: the bowl's]",
    type=vibration_angle,
    multiple=True,
)
@options.as_published("Keep mu_limit where [4.27] is negative, as past the hop.")
@options.bowl
@options.drawn_output
def slide(betas: tuple[float, ...], as_published: bool, bowl: Values, out: Output) -> None:
    """Example: feeder slide --beta 20 --set friction.static=0.4 -o results

    Map the limiting friction over alpha - theta (from the part's heading to the vibration) and the
    acceleration ratio G = A w2/g. A second map shows what a part does there at the bowl's own friction:
    it sticks, slips forward, back or both ways within a cycle, or hops.

    mu_limit is the thesis's [4.27] for a level floor. mu_forward and mu_backward are the friction that
    stops either slip on the bowl's track, whose smooth wall takes the force across it. Beyond 90 deg
    the drive points back and the two change places. The table sums up the bowl's own point.
    --format csv prints every cell. With -o: slide.csv, a surface, contour lines and regimes for
    each angle, and curves over all, as PNG.
    """
    from feederscrew.bowl import identity, name, record, texts
    from feederscrew.motion.slide import slide as study
    from feederscrew.output import slide as slide_output

    settings, path = out.settings(bowl), bowl["path"]
    with out.folder(name(path), identity(path), texts(settings)) as folder:
        result = study(record(settings), betas, as_published=as_published)
        out.write(folder, slide_output.offers(result))
    out.say(*slide_output.remarks(result))
    out.show(slide_output.printed(result, out.format), slide_output.document(result))
