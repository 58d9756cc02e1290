"""What ``feeder trial`` leaves in its folder."""

from typing import Any

from feederscrew.output import offers as offer
from feederscrew.output.trial import tables


def offers(study) -> list[Any]:
    """Offer the files of a TrialStudy, as a list of Offer."""
    run = study.runs[0]
    return [
        offer.table("trial.csv", tables.frame, study),
        offer.table("trial_stations.csv", tables.stations, run),
        *([] if run.landing is None else [offer.table("trial_landing.csv", tables.landed, study, run)]),
        *([] if run.queue is None else [offer.table("trial_outlet.csv", tables.outlet, study, run)]),
        offer.document("trial.json", tables.document, study),
        *pictures(study),
    ]


def pictures(study) -> list[Any]:
    """Offer the pictures of its first run: orientations in and out, paths, stills."""
    return [
        offer.picture("trial.png", "Orientations in and out", _matrix, study),
        offer.picture("trial_paths.png", "Paths over each device, from above", _paths, study),
        offer.picture("trial_stills.png", "A part that passes and one that does not", _stills, study),
    ]


def _matrix(study):
    from feederscrew.output.trial import figures

    return figures.matrix(study.runs[0])


def _paths(study):
    from feederscrew.output.trial import figures

    return figures.paths(study.runs[0])


def _stills(study):
    from feederscrew.output.trial import film

    return film.stills(study.part, study.runs[0])
