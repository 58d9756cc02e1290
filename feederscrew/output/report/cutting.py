"""What the bowl's devices do with each orientation of the part, by the rule and in a trial."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from feederscrew.output import tables as tables_of
from feederscrew.output import tooling as tooling_files
from feederscrew.output import tooling_tables, tooling_views
from feederscrew.output.page.blocks import Chapter, Notes, Picture, Table, Text, Views
from feederscrew.output.report.scene import over_cuts
from feederscrew.output.trial import files as trial_files
from feederscrew.output.trial import playback
from feederscrew.output.trial import tables as trial_tables
from feederscrew.rates.tipping import remark
from feederscrew.trial.course import FATES

CAME = ("aspect", "heading_deg", "share", "tried")  # columns of the trial's table that a page has room for
WENT = ("leaves_as", "ended_at", "predicted", "margin_mm", "disagrees")


def tooling(case) -> Chapter | None:
    """Where each orientation passes or falls; None in a bowl without devices."""
    study = case.passages
    if study is None:
        return None
    lead = Text(
        "Each orientation at each device that it meets, until one returns it; the margin is by how much it "
        "passes or fails. Verdicts are quasi-static: they hold while the part slides without hopping."
    )
    drawn = tooling_files.chain_picture(study.devices, study.orientations, study.shares)
    picture = Picture(drawn.name, drawn.make(), drawn.alt)
    blocks = (lead, *_turning(study), *_views(study), Table(tooling_tables.passages(study)), picture)
    return Chapter(blocks, warnings=remark(study.orientations))


def trial(case) -> Chapter | None:
    """Parts that were sent along the track one by one; None where no trial was asked for."""
    study = case.trial
    if study is None:
        return None
    run = study.runs[0]
    lead = Text(
        f"{len(run.course.entered)} parts of true shape, one at a time and their orientations in turn, on "
        "the track as it is cut while it vibrates; beside each orientation what the static rule says."
    )
    result = Notes(tuple(trial_tables.summary(study)))
    scene, captions = playback.scene(study.part, run)
    views = Views(scene, tuple((*one, ()) for one in captions), "trial-views", "Orientation", plays=True)
    matrix, paths, stills = (Picture(one.name, one.make(), one.alt) for one in trial_files.pictures(study))
    frame = trial_tables.frame(study, people=True)
    table = Table(tables_of.frame({name: frame[name] for name in columns(run.counts)}))
    blocks = (lead, result, views, replace(stills, printed=True), table, matrix, paths)
    return Chapter(blocks, warnings=study.warnings)


def columns(counts) -> tuple[Any, ...]:
    """Return the columns of the trial's table on a page, from the parts of each orientation by fate.

    A fate has a column where a part met it: without one a row of parts tried adds up to less.
    """
    met = [name for name, count in zip(FATES, counts.sum(axis=0)) if count or name == "passed"]
    return (*CAME, *met, *WENT)


def _turning(study) -> Iterator[Any]:
    """What is not certain of the devices."""
    kinds = [device.name for device in study.devices if device.turns]
    if kinds:
        yield Text(
            f"Where parts land that {' and '.join(dict.fromkeys(kinds))} turn over is quasi-static, until a "
            "trial confirms it."
        )


def _views(study) -> Iterator[Any]:
    """The part over the track, to be turned: the most frequent that leaves, and the nearest that falls."""
    given = study.devices, study.orientations, study.shares, study.wanted
    shown = tooling_views.poses(*given)
    if not shown:
        return
    part = study.orientations[0].posture.solid
    scene = over_cuts(part, [met for met, _ in shown], study.orientations)
    yield Views(
        scene, tuple((met.orientation.name, result, ()) for met, result in shown), "cuts", "Orientation"
    )
    offered = tooling_files.solid_picture(*given)
    yield Picture(offered.name, offered.make(), offered.alt, printed=True)
