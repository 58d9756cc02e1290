"""``feeder convey``."""

from dataclasses import replace
from typing import Any

import click

from feederscrew_cli import grouped, options, progress
from feederscrew_cli.options import Output, Values


@grouped.command(short_help="How fast a part travels on the track, and how.")
@options.bowl
@options.vary("Once for a curve, twice for a map: drive.vibration_angle=5:60:200.")
@options.flag("--bowl curve", "Follow this bowl inwards, where its angle is steeper.")
@options.flag("--best-phase", "Find the best phase of an elliptical drive, and what it gains.")
@options.drawn_output
def convey(bowl: Values, spans: tuple[str, ...], curve: bool, best_phase: bool, out: Output) -> None:
    """Example: feeder convey --config bowl.yaml --set drive.frequency="50 Hz" -o results

    Integrate a part on the bowl's track exactly, from event to event. Printed are its velocity, how it
    slips and hops, the limits and the margins to them. So is the velocity when stroke, friction or
    angle are a little off.

    With -o: convey.json and convey.png. --vary adds convey_curve or convey_map, .csv and .png. --bowl adds
    the curve over the radius, convey_radius.csv and .png, or draws it into the map. --best-phase adds
    convey_phase.json, .csv and .png.
    """
    from feederscrew import bowl as bowls
    from feederscrew.motion import convey as studies
    from feederscrew.output import convey as convey_output

    if best_phase and (spans or curve):
        raise click.UsageError("--best-phase stands alone - leave out --vary and --bowl")
    if len(spans) > 2:
        what = f"--vary is given {len(spans)} times - give it once for a curve, twice for a map"
        raise click.UsageError(what)
    if curve and len(spans) == 1:
        raise click.UsageError("--bowl cannot be combined with exactly one --vary - leave one of them out")
    settings, ranges, path = out.settings(bowl), bowls.key_ranges(spans), bowl["path"]
    record = bowls.record(settings)
    alone = "convey radius" if curve else "convey phase" if best_phase else "convey"
    out = replace(out, command=(alone, "convey curve", "convey map")[len(ranges)])
    study: Any
    with out.folder(bowls.name(path), bowls.identity(path), bowls.texts(settings)) as folder:
        if ranges or curve or best_phase:
            progress.tell_compiling(out, "conveying")
        if len(ranges) == 2:
            with out.step("map"):
                study = studies.velocity_map(settings, ranges, drawn="radius" if curve else None)
            out.say(*convey_output.cell_remarks(study.statuses, study.grid.values["several"]))
            offered, frame = convey_output.map_offers(study), study.table()
            document = {"cells": frame}
        elif ranges or curve:
            study = studies.curve(settings, *ranges) if ranges else studies.along_radius(record)
            out.say(*convey_output.cell_remarks(study.statuses, study.several))
            offered, frame = convey_output.curve_offers(study), study.table()
            document = {"cells": frame}
        elif best_phase:
            study = studies.best_phase(record)
            offered, document = convey_output.phase_offers(study), convey_output.phase_document(study)
            frame = convey_output.phase_summary(document)
        else:
            study = studies.convey(record)
            offered, document = convey_output.offers(study), convey_output.document(study)
            out.warn(*convey_output.remarks(document), *study.warnings)
            frame = convey_output.summary(document)
        out.write(folder, offered)
        out.show(frame, document, spare=None if ranges or curve or best_phase else ())
