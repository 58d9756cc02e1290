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
    views = Views(scene, tuple((*item, ()) for item in captions), "trial-views", "Orientation", plays=True)
    matrix, paths, stills = (
        Picture(item.name, item.make(), item.alt) for item in trial_tables.pictures(study)
    )
    frame = trial_tables.frame(study, people=True)
    table = Table(tables_of.frame({name: frame[name] for name in columns(run.counts)}))
    blocks = (lead, result, views, replace(stills, printed=True), table, matrix, paths)
    return Chapter(blocks, warnings=study.warnings)


def columns(counts) -> tuple[Any, ...]:
    """Return the columns of the trial's table on a page, from the parts of each orientation by fate.

    A fate has a column where a part met it: without one a row of parts tried adds up to less.
    """
    fates = [name for name, count in zip(FATES, counts.sum(axis=0)) if count or name == "passed"]
    return (*CAME, *fates, *WENT)


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
    chain = study.devices, study.orientations, study.shares, study.wanted
    passages = tooling_views.poses(*chain)
    if not passages:
        return
    part = study.orientations[0].posture.solid
    scene = over_cuts(part, [passage for passage, _ in passages], study.orientations)
    yield Views(
        scene,
        tuple((passage.orientation.name, result, ()) for passage, result in passages),
        "cuts",
        "Orientation",
    )
    offered = tooling_files.solid_picture(*chain)
    yield Picture(offered.name, offered.make(), offered.alt, printed=True)


def over_cuts(part, passages, orientations):
    """Return what the viewer draws of a part over the cuts of a track.

    Parameters
    ----------
    part : Part
        With a mesh.
    passages : sequence of Passage
        Each becomes a pose, its device's section of track with it.
    orientations : sequence of Orientation
        Of the part.

    Returns
    -------
    dict
        As ``scene``, with ``tracks``: the sections in mm, ahead, inwards and up from the foot of the centre
        of mass; and ``reach``, how far the view goes, in radii of the part.
    """
    tracks = [shading.track(*tooling_views.track_below(passage, orientations)) for passage in passages]
    return shading.viewed(part, tooling_views.TO_VIEWER) | {
        "reach": REACH,
        "tracks": tracks,
        "poses": [_over_cut(passage, place) for place, passage in enumerate(passages)],
    }


def _over_cut(passage, place) -> dict[Any, Any]:
    """Name, rotation from the file's axes to the track's, height, hull of the support, and the track."""
    orientation = passage.orientation
    hull = np.zeros((0, 3))
    if passage.picture == "above" and orientation.kind != "hanging" and len(passage.supported) > 3:
        flat = passage.supported[:-1] - [0.0, orientation.distance]
        hull = np.column_stack([flat, np.full(len(flat), -orientation.posture.height)])
        hull = np.einsum("ni,ij->nj", hull, orientation.axes) / MM
    return {
        "name": orientation.name,
        "quaternion": [
            short(q) for q in Rotation.from_matrix(np.array(orientation.axes)).as_quat(canonical=True)
        ],
        "height": short(orientation.posture.height / MM),
        "contact": [short(x) for x in hull.ravel()],
        "track": place,
    }
