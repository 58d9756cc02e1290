"""Tosses followed from a file of launches, as a table and as a document."""

from dataclasses import asdict
from typing import Any

import numpy as np

from feederscrew.conveying.sensitivity import RESTITUTION_DOUBT
from feederscrew.dropping import toss_runs
from feederscrew.dropping.launch_file import FACES
from feederscrew.output import columns, tables
from feederscrew.units import MM

NONE = "none"  # the side that points up where no run came to rest
BY_SIDE = tuple(f"p_{'plus' if side[0] == '+' else 'minus'}_{side[1]}" for side in FACES)
HIDDEN = ("p_low", "p_high", *BY_SIDE, "settled_runs", "time_s", "x_measured_mm", "y_measured_mm")


def tosses(study):
    """Return where each toss leads, one row a toss.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    Frame
        The columns of ``tosses.csv``.
    """
    found, launches = study.result, study.launches
    count = len(found.faces)
    low, high = study.intervals
    names = study.aspects.names
    measured: dict[str, Any] = {}
    if launches.ends is not None:
        ends = launches.ends[:count] / MM
        measured |= {"x_measured_mm": ends[:, 0], "y_measured_mm": ends[:, 1], "off_mm": study.off / MM}
    if launches.faces is not None:
        measured["face_up_measured"] = list(launches.faces[:count])
    return tables.frame(
        {
            "toss": _numbered(launches.names[:count]),
            "aspect": [names[row] if row >= 0 else NONE for row in found.rows],
            "face_up": [FACES[face] if face >= 0 else NONE for face in found.faces],
            "p": study.p,
            "p_low": low,
            "p_high": high,
            "x_mm": found.places[:, 0] / MM,
            "y_mm": found.places[:, 1] / MM,
            "half_within_mm": found.spreads / MM,
            "time_s": found.times,
            **dict(zip(BY_SIDE, found.shares.T)),
            "settled_runs": found.settled,
            **measured,
        }
    )


def document(study):
    """Return the tosses as one JSON document.

    Parameters
    ----------
    study : TossStudy

    Returns
    -------
    dict
    """
    agreement = study.agreement
    measured = None if agreement is None else asdict(agreement)
    if measured is not None:
        off = measured.pop("median_off")
        measured["median_off_mm"] = None if off is None else off / MM
    return {
        **columns.part(study.part),
        "launches": study.launches.source,
        "runs": study.result.runs,
        "seed": study.seed,
        "frame_s": study.launches.frame,
        "restitution": list(study.surface.restitution),
        "friction": list(study.surface.friction),
        "restitution_scatter": RESTITUTION_DOUBT,
        "friction_scatter": toss_runs.FRICTION,
        "partial": study.result.partial,
        "measured": measured,
        "tosses": tosses(study),
    }


def remarks(study):
    """Return what a user must know of the tosses, a line each."""
    lost = int((study.result.faces < 0).sum())
    lines = [f"partial: stopped after {len(study.result.faces)} tosses"] * study.result.partial
    if lost:
        lines.append(f"{lost} of {len(study.result.faces)} tosses came to rest in no run")
    if study.launches.frame == 0.0:
        lines.append(
            "the file does not say how many pictures a second the camera took: each state is taken as exact "
            "- name a column frames_148Hz"
        )
    return lines


def summary(study):
    """Return how the answers agree with what was measured, a line each; empty where nothing was."""
    agreement = study.agreement
    if agreement is None:
        return []
    lines = [
        f"{100.0 * agreement.told:.1f} % of the upper sides are as measured "
        f"(95 % interval {100.0 * agreement.low:.1f} to {100.0 * agreement.high:.1f} %); the side nearest to "
        f"the top at the launch tells {100.0 * agreement.at_release:.1f} %"
    ]
    if agreement.median_off is not None:
        lines.append(f"half of the places are within {agreement.median_off / MM:.1f} mm of the measured ones")
    if agreement.sure:
        lines.append(
            f"of the {agreement.sure} answers with p of at least 0.95, {100.0 * agreement.sure_told:.1f} % "
            f"are as measured: p considers the surface and the launch, not the errors of the model"
        )
    return lines


def _numbered(names):
    """The names of the tosses, as numbers where all are whole numbers."""
    return np.array([int(name) for name in names]) if all(name.isdecimal() for name in names) else list(names)
