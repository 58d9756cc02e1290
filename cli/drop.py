"""``feeder drop``: on a plane at rest, on vibrating plates, or from the launches of a file."""

import os
from dataclasses import replace
from typing import Any

import click

from feederscrew_cli import grouped, options, progress
from feederscrew_cli.interrupt import hold_interrupts
from feederscrew_cli.options import Number, Output, Values

# a launch preset and the ranges that replace its own
CONDITIONS = (
    options.option("--height fall", "LENGTH", 'Height from which it falls: "20 mm" or "5 mm:50 mm".'),
    options.option("--spin", "RATE", 'How fast it turns: "20 rad/s".'),
    options.option("--speed", "SPEED", 'Velocity along the plane: "0.3 m/s".'),
    options.option("--restitution", "E", "Coefficient of restitution where a corner hits: 0.3 or 0.1:0.5."),
    options.option("--friction", "MU", "Coefficient of friction on the plane: 0.4 or 0.3:0.6."),
)
TEST = (  # how often and how it is dropped
    options.whole(
        "--drops",
        1,
        10**7,
        "How many drops.  [default: 10000; on a plate 400; 64 of each of --launches]",
    ),
    options.option("--until", "SHARE", 'Go on until no 95 % interval is wider: "1%" to either side.'),
    options.seed("Seed of the random launches."),
    options.jobs,
    options.option("--trace", "K", "With -o: the motion of the first K drops.", type=options.Whole(1, 1000)),
)
PLATE = (
    options.flag("--plate is_plate", "The plane vibrates with a bowl's drive."),
    options.option(
        "--config paths",
        "FILE",
        type=options.FILE,
        multiple=True,
        text="With --plate: the bowl file (YAML); give it again for a further plate.",
    ),
    options.overrides,
    options.option(
        "--amplitude amplitudes",
        "LIST",
        "With --plate: a plate for each, '78%,80%,82%' of the bowl's or '0.3 mm,0.4 mm'.",
    ),
    options.option(
        "--seconds",
        None,
        "With --plate: how long each part is on it.  [default: 5]",
        type=Number(0.05, 3600.0),
    ),
)


@grouped.command(
    short_help="A virtual drop test: how often a part lands on each aspect.",
    rare=("spin", "speed", "restitution", "friction", "trace", "launches", "amplitudes", "seconds"),
)
@options.part
@options.launch
@options.group("conditions", *CONDITIONS)
@options.group("test", *TEST)
@options.path(
    "--launches", "FILE", "Follow each launch of a CSV file from its own state, in place of random ones."
)
@options.group("plate", *PLATE)
@options.drawn_output
def drop(
    part: Values,
    launch: str,
    test: Values,
    launches: str | None,
    plate: Values,
    conditions: Values,
    out: Output,
) -> None:
    """Example: feeder drop lbracket_30x20x15.stl --launch feed --until 1% -o results

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
    is_plate, traced = plate.pop("is_plate"), test.pop("trace")
    _check_call(test["until"], traced, launches, is_plate, out)
    with hold_interrupts():
        from feederscrew import bowl as bowls
        from feederscrew.arrivals import drop as studies
        from feederscrew.output import drop as drop_output
        from feederscrew.output import plate as plate_output

    study: Any
    test["jobs"] = test["jobs"] or os.cpu_count()
    before = {"before": lambda: progress.tell_compiling(out, "plate" if is_plate else "drops")}
    if launches:  # each of a file, from its own state
        out = replace(out, command="drop launches")
        solid = out.part(part)
        run = {"runs": test["drops"], "seed": test["seed"], "jobs": test["jobs"]} | before
        with progress.bar(out, "tosses") as bar:
            study = studies.follow(solid, launches, conditions, progress=bar.reach, **run)
        with out.folder_of(solid, {study.launches.source: study.launches.sha256}) as folder:
            out.warn(*drop_output.toss_remarks(study))
            out.say(*drop_output.toss_summary(study))
            out.write(folder, drop_output.toss_offers(study))
        out.show(study.table(), drop_output.toss_document(study))
    elif is_plate:  # a plate for each stroke of each bowl
        out = replace(out, command="drop plate")
        driven: list[Any] = []
        names: list[str] = []
        inputs: dict[str, str] = {}
        values = {}
        paths = plate["paths"] or (None,)
        for path, name in zip(paths, bowls.bowl_names(paths)):
            settings = bowls.settings(path, plate["overrides"])
            strokes = bowls.at_strokes(bowls.record(settings), plate["amplitudes"])
            driven += strokes
            names += [name] * len(strokes)
            inputs |= bowls.identity(path)
            values[name] = bowls.texts(settings)
        solid = out.part(part)
        out.say(*plate_output.notes(driven))
        run = {name: test[name] for name in ("drops", "seed", "jobs")} | conditions | before
        run |= {"names": names, "seconds": plate["seconds"]}
        with out.folder_of(solid, inputs, values=values) as folder:
            with progress.bar(out, "parts") as bar:
                study = studies.shake(solid, driven, launch, progress=bar.reach, **run)
            out.say(*plate_output.summary(study))
            out.warn(*plate_output.remarks(study))
            out.write(folder, plate_output.offers(study))
        frame = study.table()
        out.show(frame, plate_output.document(study), spare=plate_output.spare(frame))
    else:
        solid, run = out.part(part), conditions | test | before
        with out.folder_of(solid) as folder:
            with progress.bar(out, "drops") as bar:
                study = studies.drop(solid, launch, traced=traced or 0, progress=bar.reach, **run)
            out.warn(*drop_output.remarks(study))
            out.write(folder, drop_output.offers(study))
        out.show(study.table(), drop_output.document(study))


def _check_call(
    until: str | None, traced: int | None, launches: str | None, is_plate: bool, out: Output
) -> None:
    if not is_plate:
        for option in options.typed_options("paths", "overrides", "amplitudes", "seconds"):
            raise click.UsageError(f"{option} is for a vibrating plate - give --plate as well")
    elif until or traced or launches:
        option = "--until" if until else "--trace" if traced else "--launches"
        raise click.UsageError(f"{option} is for a plane at rest - leave out {option} or --plate")
    if traced and out.directory is None:
        raise click.UsageError("--trace writes files: give -o DIR as well")
    if launches:
        for option in options.typed_options("launch", "fall", "spin", "speed", "until", "trace"):
            raise click.UsageError(f"{option} cannot be combined with --launches - leave one of them out")
