"""``feeder convey``."""

from dataclasses import replace

import click

from feederscrew_cli import completion, grouped, options, waiting

COMMAND_BY_RANGES = {1: "convey curve", 2: "convey map"}  # by how many keys are varied


@grouped.command(short_help="How fast a part travels on the track, and how.")
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
@click.option(
    "--best-phase", is_flag=True, help="Find the best phase of an elliptical drive, and what it gains."
)
@options.pictures
@options.output
def convey(bowl, spans, curve, best_phase, pictures, out):
    """Example: feeder convey --config bowl.yaml --set drive.frequency="50 Hz" -o results

    Integrate a part on the bowl's track exactly, from event to event. Printed are its velocity, how it
    slips and hops, the limits and the margins to them. So is the velocity when stroke, friction or
    angle are a little off.

    With -o: convey.json and convey.png. --vary adds convey_curve or convey_map, .csv and .png. --bowl adds
    the curve over the radius, convey_radius.csv and .png, or draws it into the map. --best-phase adds
    convey_phase.json, .csv and .png.
    """
    from feederscrew import bowl as bowls

    _fitting(spans, curve, best_phase)
    settings, ranges, path = out.settings(bowl), bowls.key_ranges(spans), bowl["path"]
    alone = "convey radius" if curve else "convey phase" if best_phase else "convey"
    out = replace(out, command=COMMAND_BY_RANGES[len(ranges)] if ranges else alone)
    with out.folder(bowls.name(path), bowls.identity(path), bowls.texts(settings)) as folder:
        if len(ranges) == 2:
            _map(settings, ranges, curve, pictures, folder, out)
        elif ranges or curve:
            _curve(settings, ranges, pictures, folder, out)
        elif best_phase:
            _phase(settings, pictures, folder, out)
        else:
            _point(settings, pictures, folder, out)


def _fitting(spans, curve, best_phase):
    """Wrong calls."""
    if best_phase and (spans or curve):
        raise click.UsageError("--best-phase stands alone - leave out --vary and --bowl")
    if len(spans) > len(COMMAND_BY_RANGES):
        raise click.UsageError(
            f"--vary is given {len(spans)} times - give it once for a curve, twice for a map"
        )
    if curve and len(spans) == 1:
        raise click.UsageError("--bowl cannot be combined with exactly one --vary - leave one of them out")


def _point(settings, pictures, folder, out):
    from feederscrew import bowl as bowls
    from feederscrew.output import convey as convey_output
    from feederscrew.output import offers
    from feederscrew.studies import convey as studies

    study, texts = studies.convey(bowls.record(settings)), bowls.texts(settings)
    document = convey_output.document(study) | {"bowl": texts}
    out.warn(*convey_output.remarks(document), *study.warnings)
    offers.write(folder, convey_output.offers(study, texts), pictures=pictures)
    out.show(convey_output.summary(document), document, spare=())


def _map(settings, ranges, curve, pictures, folder, out):
    from feederscrew.output import convey as convey_output
    from feederscrew.output import offers
    from feederscrew.studies import convey as studies

    waiting.conveying(out)
    with out.step("map"):
        study = studies.velocity_map(settings, ranges, drawn="radius" if curve else None)
    out.say(*convey_output.map_remarks(study))
    offers.write(folder, convey_output.map_offers(study), pictures=pictures)
    frame = convey_output.cells(study)
    out.show(frame, {"cells": frame})


def _curve(settings, ranges, pictures, folder, out):
    from feederscrew import bowl as bowls
    from feederscrew.output import convey as convey_output
    from feederscrew.output import offers
    from feederscrew.studies import convey as studies

    waiting.conveying(out)
    study = studies.curve(settings, *ranges) if ranges else studies.along_radius(bowls.record(settings))
    out.say(*convey_output.curve_remarks(study))
    offers.write(folder, convey_output.curve_offers(study), pictures=pictures)
    frame = convey_output.points(study)
    out.show(frame, {"cells": frame})


def _phase(settings, pictures, folder, out):
    from feederscrew import bowl as bowls
    from feederscrew.output import convey as convey_output
    from feederscrew.output import offers
    from feederscrew.studies import convey as studies

    waiting.conveying(out)
    study, texts = studies.best_phase(bowls.record(settings)), bowls.texts(settings)
    best = convey_output.phase_document(study.best)
    offers.write(folder, convey_output.phase_offers(study, texts), pictures=pictures)
    out.show(convey_output.phase_summary(best), {"best_phase": best, "bowl": texts})
