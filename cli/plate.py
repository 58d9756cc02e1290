"""``feeder drop --plate``: its options and its run."""

from dataclasses import replace

import click

from feederscrew_cli import options
from feederscrew_cli.interrupt import held_back
from feederscrew_cli.progress import Progress

KEYWORDS = ("shaken", "paths", "overrides", "amplitudes", "seconds")
OPTIONS = {"paths": "--config", "overrides": "--set", "amplitudes": "--amplitude", "seconds": "--seconds"}


def plate(command):
    """--plate and what goes with it; the command receives ``plate``, None unless it is given."""
    return options.stacked(
        options.packed(command, "plate", KEYWORDS, _given),
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
            type=options.Number(0.05, 3600.0),
            help="With --plate: how long each part is on it.  [default: 5]",
        ),
    )


def run(part, plate, launch, own, test, pictures, out):
    """Put the part on each plate, write and tell what becomes of it."""
    with held_back():
        from feederscrew.dropping.plate import runs
        from feederscrew.output import columns
        from feederscrew.output.plate import files as plate_sheets
        from feederscrew.output.plate import tables as plate_tables
        from feederscrew.resting.aspects import find

    bowls, names, files, values = _bowls(plate)
    out = replace(out, command="drop plate")
    solid = out.part(part)
    aspects = find(solid)
    _announce(out)
    out.say(*plate_tables.notes(bowls))
    told = columns.conditions(solid) | values
    with out.folder(solid.name, {solid.source: solid.sha256} | files, told) as folder:
        with Progress(None, not out.quiet, "parts") as bar:
            results = runs.test(
                solid, aspects, bowls, launch, own, **test, seconds=plate["seconds"], progress=bar.reach
            )
        document = plate_tables.document(solid, aspects, test["seed"], results, names)
        out.say(*plate_tables.told(results, names))
        out.warn(*plate_tables.remarks(document))
        if folder:
            plate_sheets.write(folder, solid, aspects, results, names, document, pictures=pictures)
    out.show(plate_tables.plates(aspects, results, names), document, hidden=plate_tables.HIDDEN)


def _given(shaken, **others):
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
    every = [bowls.strokes(bowls.record(one), plate["amplitudes"]) for one in settings]
    names = [name for name, plates in zip(bowls.named(paths), every) for _ in plates]
    files = {source: digest for path in paths for source, digest in bowls.identity(path).items()}
    values = {name: bowls.texts(one) for name, one in zip(bowls.named(paths), settings)}
    return [bowl for plates in every for bowl in plates], names, files, values


def _announce(out):
    from feederscrew.dropping.plate import rides

    if not rides.compiled():
        out.say("Compiling the plate's kernel, once on this machine: about twenty seconds.")
