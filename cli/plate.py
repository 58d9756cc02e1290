"""``feeder drop --plate``: its options and its run."""

from dataclasses import replace

import click

from feederscrew_cli import options, waiting
from feederscrew_cli.interrupt import held_back
from feederscrew_cli.values import Number

OPTIONS = {"paths": "--config", "overrides": "--set", "amplitudes": "--amplitude", "seconds": "--seconds"}


def run(part, plate, launch, own, test, pictures, out):
    """Put the part on each plate, write and tell what becomes of it."""
    with held_back():
        from feederscrew.output import columns, offers
        from feederscrew.output import plate as plate_output
        from feederscrew.studies.plate import shake

    bowls, names, inputs, values = _bowls(plate)
    out = replace(out, command="drop plate")
    solid = out.part(part)
    out.say(*plate_output.notes(bowls))
    inputs = solid.inputs | inputs
    with out.folder(solid.name, inputs, columns.conditions(solid) | values) as folder:
        with waiting.bar(out, "parts") as bar:
            document = {"progress": bar.reach, "before": lambda: waiting.plate(out)}
            study = shake(
                solid, bowls, launch, **own, names=names, seconds=plate["seconds"], **document, **test
            )
        out.say(*plate_output.summary(study))
        out.warn(*plate_output.remarks(study))
        offers.write(folder, plate_output.offers(study), pictures=pictures)
    frame = plate_output.plates(study)
    out.show(
        frame,
        plate_output.document(study),
        hidden=plate_output.HIDDEN_PLATE_COLUMNS,
        spare=plate_output.spare(frame),
    )


def _plate_options(shaken, **others):
    """The options of a plate, or None; a wrong call where they come without ``--plate``."""
    if shaken:
        return others
    for keyword, option in OPTIONS.items():
        if others[keyword]:
            raise click.UsageError(f"{option} is for a vibrating plate - give --plate as well")
    return None


def _bowls(plate):
    """The Bowl of every plate, what each is called, the files they come from, and their values."""
    from feederscrew import bowl as bowls

    paths = plate["paths"] or (None,)
    settings = [bowls.settings(path, plate["overrides"]) for path in paths]
    driven = [
        bowls.at_strokes(bowls.record(bowl_settings), plate["amplitudes"]) for bowl_settings in settings
    ]
    names = [name for name, plates in zip(bowls.bowl_names(paths), driven) for _ in plates]
    files = {source: digest for path in paths for source, digest in bowls.identity(path).items()}
    values = {
        name: bowls.texts(bowl_settings) for name, bowl_settings in zip(bowls.bowl_names(paths), settings)
    }
    return [bowl for plates in driven for bowl in plates], names, files, values


plate = options.group(  # None unless it is given
    "plate",
    click.option("--plate", "shaken", is_flag=True, help="The plane vibrates with a bowl's drive."),
    click.option(
        "--config",
        "paths",
        metavar="FILE",
        type=options.FILE,
        multiple=True,
        help="With --plate: the bowl file (YAML); give it again for a further plate.",
    ),
    options.overrides,
    click.option(
        "--amplitude",
        "amplitudes",
        metavar="LIST",
        help="With --plate: a plate for each, '78%,80%,82%' of the bowl's or '0.3 mm,0.4 mm'.",
    ),
    click.option(
        "--seconds",
        type=Number(0.05, 3600.0),
        help="With --plate: how long each part is on it.  [default: 5]",
    ),
    pack=_plate_options,
)
