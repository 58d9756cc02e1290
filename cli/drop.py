"""``feeder drop``."""

import os
from dataclasses import replace

import click

from feederscrew_cli import grouped, options, progress
from feederscrew_cli.interrupt import held_back
from feederscrew_cli.values import Number, Place, Whole

# a launch preset and the ranges that replace its own
CONDITIONS = (
    click.option(
        "--height",
        "fall",
        metavar="LENGTH",
        help='Height from which it falls: "20 mm" or "5 mm:50 mm".',
    ),
    click.option("--spin", metavar="RATE", help='How fast it turns: "20 rad/s".'),
    click.option("--speed", metavar="SPEED", help='Velocity along the plane: "0.3 m/s".'),
    click.option(
        "--restitution",
        metavar="E",
        help="Coefficient of restitution where a corner hits: 0.3 or 0.1:0.5.",
    ),
    click.option("--friction", metavar="MU", help="Coefficient of friction on the plane: 0.4 or 0.3:0.6."),
)
TEST = (  # how often and how it is dropped
    click.option(
        "--drops",
        type=Whole(1, 10**7),
        help="How many drops.  [default: 10000; on a plate 400; 64 of each of --launches]",
    ),
    click.option(
        "--until", metavar="SHARE", help='Go on until no 95 % interval is wider: "1%" to either side.'
    ),
    options.seed("Seed of the random launches."),
    options.jobs,
    click.option(
        "--trace", type=Whole(1, 1000), metavar="K", help="With -o: the motion of the first K drops."
    ),
)
REPLACED_BY_FILE = {"fall": "--height", "spin": "--spin", "speed": "--speed"}  # what the file says instead
LAUNCHES = click.option(
    "--launches",
    metavar="FILE",
    type=Place(),
    help="Follow each launch of a CSV file from its own state, in place of random ones.",
)
PLATE_OPTIONS = {
    "paths": "--config",
    "overrides": "--set",
    "amplitudes": "--amplitude",
    "seconds": "--seconds",
}


def _plate_options(shaken, **others):
    """The options of a plate, or None; a wrong call where they come without ``--plate``."""
    if shaken:
        return others
    for keyword, option in PLATE_OPTIONS.items():
        if others[keyword]:
            raise click.UsageError(f"{option} is for a vibrating plate - give --plate as well")
    return None


PLATE = options.group(  # None unless it is given
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


@grouped.command(
    short_help="A virtual drop test: how often a part lands on each aspect.",
    rare=("spin", "speed", "restitution", "friction", "trace", "launches", "amplitudes", "seconds"),
)
@options.part
@options.launch
@options.group("own", *CONDITIONS)
@options.group("test", *TEST)
@LAUNCHES
@PLATE
@options.pictures
@options.output
def drop(part, launch, test, launches, plate, pictures, own, out):
    """Example: feeder drop parts/lbracket_30x20x15.stl --launch feed --until 1% -o results

    Drop PART on a hard plane, again and again, and count the aspects it comes to rest on. Each launch is
    drawn from the ranges of --launch, or from your own. --launch says what was done to the part: place
    (set down by hand), drop (let fall), flip (spun as a coin), roll (cast or poured; its former name is
    tumble), feed (from a hopper into a bowl).

    p_drop is the share of the drops that settled. unsettled counts the others. p_drop_low and
    p_drop_high are the 95 % interval. It holds the sampling, the numerical error and what the name of a
    launch leaves open. p_gentle and p_violent are the shares among the third of the launches with the
    least and with the most energy. p_restitution is how far the spread of restitution moves the share.
    One value of --restitution scatters by 16 %, as filmed impacts do, and widens the interval; 0.3:0.3
    is exactly 0.3. The same seed gives the same counts whatever the number of jobs. Ctrl-C ends the
    test early with exit status 130: what is counted so far is given, marked partial.

    With -o: drop.csv, drop.json, drop.png and run.json. --trace adds drop_traces.csv, where the part is
    and how it is turned from launch to rest. It also adds drop_trace.png, stills of the first traced drop
    that tumbles and lies still (else that tumbles, else the first).

    With --plate the plane vibrates with the drive of a bowl. The bowl's restitution and friction hold
    unless given. p_plate is the share of the time parts lie on each aspect, in the second half of the
    test. p_limit is where the rates of change lead in the end. The velocity on each aspect stands beside
    them. With -o: plate.csv, plate_drives.csv, plate_rates.csv, plate_time.csv, plate.json and plate.png.

    With --launches each toss of a file is followed from its own state until it lies still. The state is
    position, quaternion w x y z, velocity and spin (in the part's axes), in SI units. Its columns are
    toss, x0_m to z0_m, qw0 to qz0, vx0 to vz0, wx0 to wz0. face_up is the side of the part that points up
    at the end. x and y are the place of its centre of mass. p is the share of the runs that end so.
    In these, friction, restitution and the state vary by what is not known of them. Measured ends (xe_m,
    ye_m, face_up_end) stand beside them. With -o: tosses.csv, tosses.json and tosses.png.
    """
    until, trace = test.pop("until"), test.pop("trace")
    _fitting(until, trace, plate, out)
    if plate and launches:
        raise click.UsageError("--launches is for a plane at rest - leave out --launches or --plate")
    test["jobs"] = test["jobs"] or os.cpu_count()
    if plate:
        _on_plates(part, plate, launch, own, test, pictures, out)
    elif launches:
        _of_file(part, launches, own, test | {"until": until, "traced": trace}, pictures, out)
    else:
        _on_floor(part, launch, own, test | {"until": until, "traced": trace or 0}, pictures, out)


def _fitting(until, trace, plate, out):
    """Wrong calls."""
    for option, value in (("--until", until), ("--trace", trace)):
        if plate and value:
            raise click.UsageError(f"{option} is for a plane at rest - leave out {option} or --plate")
    if trace and out.directory is None:
        raise click.UsageError("--trace writes files: give -o DIR as well")


def _on_floor(part, launch, own, test, pictures, out):
    """Drop the part on a plane at rest, write and tell what becomes of it."""
    with held_back():
        from feederscrew.output import columns, offers
        from feederscrew.output import drop as drop_output
        from feederscrew.studies.drop import drop as drop_study

    solid = out.part(part)
    with out.folder(solid.name, solid.inputs, columns.conditions(solid)) as folder:
        with progress.bar(out, "drops") as bar:
            values = {"progress": bar.reach, "before": lambda: progress.drops(out)}
            study = drop_study(solid, launch, **own, **values, **test)
        out.warn(*drop_output.remarks(study))
        offers.write(folder, drop_output.offers(study), pictures=pictures)
    out.show(drop_output.counts(study), drop_output.document(study))


def _on_plates(part, plate, launch, own, test, pictures, out):
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
        with progress.bar(out, "parts") as bar:
            document = {"progress": bar.reach, "before": lambda: progress.plate(out)}
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


def _of_file(part, path, own, test, pictures, out):
    """Follow the launches of a file, write and tell where they lead."""
    context = click.get_current_context()
    has_launch = context.get_parameter_source("launch") is click.core.ParameterSource.COMMANDLINE
    foreign = ["--launch"] * has_launch + [
        option for key, option in REPLACED_BY_FILE.items() if own[key] is not None
    ]
    foreign += [option for key, option in (("until", "--until"), ("traced", "--trace")) if test[key]]
    if foreign:
        raise click.UsageError(f"{foreign[0]} cannot be combined with --launches - leave one of them out")
    with held_back():
        from feederscrew.output import columns, offers
        from feederscrew.output import drop as drop_output
        from feederscrew.studies import tosses as tosses_study

    out = replace(out, command="drop launches")
    solid = out.part(part)
    with progress.bar(out, "tosses") as bar:
        values = {"progress": bar.reach, "before": lambda: progress.drops(out)}
        run = {"runs": test["drops"], "seed": test["seed"], "jobs": test["jobs"]}
        study = tosses_study.follow(solid, path, own, **values, **run)
    inputs = solid.inputs | {study.launches.source: study.launches.sha256}
    with out.folder(solid.name, inputs, columns.conditions(solid)) as folder:
        out.warn(*drop_output.toss_remarks(study))
        out.say(*drop_output.toss_summary(study))
        offers.write(folder, drop_output.toss_offers(study), pictures=pictures)
    out.show(
        drop_output.tosses(study), drop_output.toss_document(study), hidden=drop_output.HIDDEN_TOSS_COLUMNS
    )
