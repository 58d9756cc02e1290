"""``feeder slide``."""

import click

from feederscrew_cli import grouped, options


class VibrationAngle(click.ParamType):
    """A vibration angle, '20' or '20 deg', within the limits of the bowl file's; in radians."""

    name = "angle"

    def convert(self, value, param, ctx):
        """The angle, or a wrong call."""
        from feederscrew.bowl.reading import checked
        from feederscrew.bowl.schema import BY_NAME
        from feederscrew.errors import ConfigError

        key = BY_NAME["drive.vibration_angle"]
        try:
            return checked(key, value, key.name, bare=True).value
        except ConfigError as fault:
            return self.fail(f"{fault.what} - {fault.mend}", param, ctx)


@grouped.command(short_help="Map of when a part slips, and which way.")
@click.option(
    "--beta",
    "betas",
    type=VibrationAngle(),
    metavar="DEG",
    multiple=True,
    help="Vibration angle; repeatable.  [default: the bowl's]",
)
@click.option("--as-published", is_flag=True, help="Keep mu_limit where [4.27] is negative, as past the hop.")
@options.bowl
@options.pictures
@options.output
def slide(betas, as_published, bowl, pictures, out):
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
    from feederscrew.output import offers
    from feederscrew.output import slide as slide_output
    from feederscrew.studies.slide import slide as study

    bowl_settings, path = out.settings(bowl), bowl["path"]
    with out.folder(name(path), identity(path), texts(bowl_settings)) as folder:
        result = study(record(bowl_settings), betas, as_published=as_published)
        offers.write(folder, slide_output.offers(result), pictures=pictures)
    out.say(*slide_output.remarks(result))
    out.show(slide_output.printed(result, out.format), slide_output.document(result))
