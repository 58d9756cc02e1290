"""What the bowl's devices do with each orientation of the part, by the rule and in a trial."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.output import shading, tooling_tables, tooling_views
from feederscrew.output import tables as tables_of
from feederscrew.output import tooling as tooling_files
from feederscrew.output.page.blocks import Chapter, Notes, Picture, Table, Text, Views
from feederscrew.output.shading import short
from feederscrew.output.trial import playback
from feederscrew.output.trial import tables as trial_tables
from feederscrew.rates.tipping import remark
from feederscrew.trial.course import FATES
from feederscrew.units import MM

REACH = 1.25  # of the part's radius: how much of the track around it is seen
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
    matrix, paths, stills = (Picture(one.name, one.make(), one.alt) for one in trial_tables.pictures(study))
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


def over_cuts(part, met, every):
    """Return what the viewer draws of a part over the cuts of a track.

    Parameters
    ----------
    part : Part
        With a mesh.
    met : sequence of Passage
        Each becomes a pose, its device's section of track with it.
    every : sequence of Orientation
        Of the part.

    Returns
    -------
    dict
        As ``scene``, with ``tracks``: the sections in mm, ahead, inwards and up from the foot of the centre
        of mass; and ``reach``, how far the view goes, in radii of the part.
    """
    tracks = [shading.track(*tooling_views.track_below(one, every)) for one in met]
    return shading.viewed(part, tooling_views.VIEW) | {
        "reach": REACH,
        "tracks": tracks,
        "poses": [_over_cut(one, place) for place, one in enumerate(met)],
    }


def _over_cut(met, place) -> dict[Any, Any]:
    """Name, rotation from the file's axes to the track's, height, hull of the support, and the track."""
    one = met.orientation
    hull = np.zeros((0, 3))
    if met.picture == "above" and one.kind != "hanging" and len(met.supported) > 3:
        flat = met.supported[:-1] - [0.0, one.distance]
        hull = np.column_stack([flat, np.full(len(flat), -one.posture.height)])
        hull = np.einsum("ni,ij->nj", hull, one.axes) / MM
    return {
        "name": one.name,
        "quaternion": [short(q) for q in Rotation.from_matrix(np.array(one.axes)).as_quat(canonical=True)],
        "height": short(one.posture.height / MM),
        "contact": [short(x) for x in hull.ravel()],
        "track": place,
    }
