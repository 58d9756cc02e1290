"""``feeder convey``."""

from dataclasses import replace

import click

from feederscrew_cli import completion, options

WAYS = {1: "convey curve", 2: "convey map"}  # by how many keys are varied


@click.command(short_help="How fast a part travels on the track, and how.")
@options.bowl
@click.option(
    "--vary",
    "spans",
    metavar="KEY=FROM:TO:COUNT",
    multiple=True,
    shell_complete=completion.keys,
    help="Once for a curve, twice for a map: drive.vibration_angle=5:60:200.",
)
@click.option("--bowl", "curve", is_flag=True, help="Follow this bowl inwards, where its angle is steeper.")
@options.pictures
@options.output
def convey(bowl, spans, curve, pictures, out):
    """Example: feeder convey --config bowl.yaml --set drive.frequency="50 Hz" -o results

    Integrate a part on the bowl's track exactly, from event to event: its velocity, how it slips
    and hops, the limits and the margins to them, and what becomes of it when stroke, friction or
    angle are a little off.

    With -o: convey.json and convey.png; with --vary, convey_curve or convey_map, .csv and .png; with
    --bowl, the curve over the radius in convey_radius.csv and .png, or drawn into the map.
    """
    from feederscrew import bowl as bowls

    _fitting(spans, curve)
    settings, ranges, path = bowls.settings(**bowl), bowls.ranges(spans), bowl["path"]
    out = replace(out, command=WAYS[len(ranges)] if ranges else "convey radius" if curve else "convey")
    with out.folder(bowls.name(path), bowls.identity(path), bowls.texts(settings)) as folder:
        if len(ranges) == 1:
            _curve(settings, ranges[0], pictures and folder, folder, out)
        elif ranges:
            _map(settings, ranges, curve, pictures and folder, folder, out)
        elif curve:
            _inwards(bowls.record(settings), pictures and folder, folder, out)
        else:
            _point(settings, pictures and folder, folder, out)


def _fitting(spans, curve):
    """Wrong calls."""
    if len(spans) > len(WAYS):
        raise click.UsageError(
            f"--vary is given {len(spans)} times - give it once for a curve, twice for a map"
        )
    if curve and len(spans) == 1:
        raise click.UsageError("--bowl goes with no --vary or with two - leave one of them out")


def _point(settings, picture_folder, folder, out):
    from feederscrew import bowl as bowls
    from feederscrew.conveying import answer, sensitivity, trace
    from feederscrew.machine import speeds
    from feederscrew.output import tables
    from feederscrew.output.convey import tables as convey_tables

    bowl = bowls.record(settings)
    found = answer.answer(bowl)
    around = sensitivity.sensitivity(bowl), sensitivity.friction_doubt(bowl)
    document = convey_tables.document(bowl, found, *around) | {"bowl": bowls.texts(settings)}
    out.warn(*convey_tables.remarks(document), *speeds.remark(found.velocity, bowl.sizing))
    if folder:
        folder.write("convey.json", tables.json_text(document))
    if picture_folder:
        from feederscrew.output import style
        from feederscrew.output.convey import figures as convey_plots

        figure = convey_plots.cycle(trace.trace(found.setting), bowl.drive.amplitude, found)
        folder.write("convey.png", style.png(figure))
    out.show(convey_tables.summary(document), document)


def _map(settings, ranges, curve, picture_folder, folder, out):
    from feederscrew import bowl as bowls
    from feederscrew.output import tables
    from feederscrew.output.convey import tables as convey_tables

    announce(out)
    with out.step("map"):
        grid = convey_tables.grid(ranges, lambda values: bowls.swept(settings, values))
    frame = convey_tables.cells(grid)
    out.say(*convey_tables.map_remarks(grid))
    if folder:
        folder.write("convey_map.csv", tables.text(frame, "csv"))
    if picture_folder:
        from feederscrew.conveying import radius
        from feederscrew.output import style
        from feederscrew.output.convey import figures as convey_plots

        line = convey_plots.on_axes(ranges, radius.inwards(bowls.record(settings))) if curve else None
        folder.write("convey_map.png", style.png(convey_plots.velocity_map(grid, line)))
    out.show(frame, {"cells": frame})


def _curve(settings, span, picture_folder, folder, out):
    from feederscrew import bowl as bowls
    from feederscrew.output import tables
    from feederscrew.output.convey import tables as convey_tables

    announce(out)
    frame = convey_tables.along_key(span, bowls.swept(settings, convey_tables.values(span)))
    out.say(*convey_tables.curve_remarks(frame))
    if folder:
        folder.write("convey_curve.csv", tables.text(frame, "csv"))
    if picture_folder:
        from feederscrew.output import style
        from feederscrew.output.convey import figures as convey_plots

        folder.write("convey_curve.png", style.png(convey_plots.curve(frame, convey_tables.title(span))))
    out.show(frame, {"cells": frame})


def _inwards(bowl, picture_folder, folder, out):
    from feederscrew.conveying import radius
    from feederscrew.output import tables
    from feederscrew.output.convey import tables as convey_tables

    announce(out)
    frame = convey_tables.along_radius(radius.inwards(bowl))
    if folder:
        folder.write("convey_radius.csv", tables.text(frame, "csv"))
    if picture_folder:
        from feederscrew.output import style
        from feederscrew.output.convey import figures as convey_plots

        folder.write("convey_radius.png", style.png(convey_plots.curve(frame, "Velocity over the radius")))
    out.show(frame, {"cells": frame})


def announce(out):
    """Say so when the first map on this machine must wait for the compiler."""
    from feederscrew.conveying import sweep

    if not sweep.compiled():
        out.say("Compiling the conveying kernel, once on this machine: about ten seconds.")
