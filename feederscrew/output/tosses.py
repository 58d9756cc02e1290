"""Files of ``feeder drop --launches``."""

from typing import Any

import numpy as np

from feederscrew.conveying.sensitivity import RESTITUTION_DOUBT
from feederscrew.dropping import toss_runs
from feederscrew.dropping.toss_runs import FACE_NAMES
from feederscrew.output import columns, style, tables
from feederscrew.output import offers as offer
from feederscrew.output.tables import Frame
from feederscrew.studies.drop import TossStudy
from feederscrew.units import MM

NONE = "none"  # the side that points up where no run came to rest
BY_SIDE = tuple(f"p_{'plus' if side[0] == '+' else 'minus'}_{side[1]}" for side in FACE_NAMES)
HIDDEN_TOSS_COLUMNS = (
    "p_low",
    "p_high",
    *BY_SIDE,
    "settled_runs",
    "time_s",
    "x_measured_mm",
    "y_measured_mm",
)


def tosses(study) -> Frame:
    """Return where each toss leads, one row a toss: the columns of ``tosses.csv``."""
    result, launches = study.result, study.launches
    count = len(result.faces)
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
            "aspect": [names[row] if row >= 0 else NONE for row in result.rows],
            "face_up": [FACE_NAMES[face] if face >= 0 else NONE for face in result.faces],
            "p": study.p,
            "p_low": low,
            "p_high": high,
            "x_mm": result.places[:, 0] / MM,
            "y_mm": result.places[:, 1] / MM,
            "half_within_mm": result.spreads / MM,
            "time_s": result.times,
            **dict(zip(BY_SIDE, result.shares.T)),
            "settled_runs": result.settled,
            **measured,
        }
    )


def document(study: TossStudy) -> dict[str, Any]:
    """Return the tosses as one JSON document."""
    agreement = study.agreement
    measured = None
    if agreement is not None:
        measured = {
            "tosses": agreement.tosses,
            "told": agreement.right_share,
            "low": agreement.low,
            "high": agreement.high,
            "at_release": agreement.at_release,
            "expected": agreement.expected,
            "sure": agreement.sure,
            "sure_told": agreement.sure_right_share,
            "median_off_mm": None if agreement.median_off is None else agreement.median_off / MM,
        }
    return {
        **columns.part(study.part),
        "launches": study.launches.source,
        "runs": study.result.runs,
        "seed": study.seed,
        "frame_s": study.launches.frame,
        "restitution": list(study.surface.restitution),
        "friction": list(study.surface.friction),
        "restitution_scatter": RESTITUTION_DOUBT,
        "friction_scatter": toss_runs.FRICTION_SPREAD,
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
        f"{100.0 * agreement.right_share:.1f} % of the upper sides are as measured "
        f"(95 % interval {100.0 * agreement.low:.1f} to {100.0 * agreement.high:.1f} %); the side nearest to "
        f"the top at the launch tells {100.0 * agreement.at_release:.1f} %"
    ]
    if agreement.median_off is not None:
        lines.append(f"half of the places are within {agreement.median_off / MM:.1f} mm of the measured ones")
    if agreement.sure:
        lines.append(
            f"of the {agreement.sure} answers with p of at least 0.95, "
            f"{100.0 * agreement.sure_right_share:.1f} % are as measured: p considers the surface "
            "and the launch, not the errors of the model"
        )
    return lines


def _numbered(names):
    """The names of the tosses, as numbers where all are whole numbers."""
    return np.array([int(name) for name in names]) if all(name.isdecimal() for name in names) else list(names)


def offers(study: TossStudy) -> list[offer.Offer]:
    """Offer where each toss leads."""
    offered = [
        offer.table("tosses.csv", tosses, study),
        offer.document("tosses.json", document, study),
    ]
    if study.launches.ends is not None:
        offered.append(offer.picture("tosses.png", "Places computed and measured", plan, study))
    return offered


TOSS_LOOKS = (  # what is computed of the upper side: label, marker, colour
    ("upper side as measured", "o", "#0072b2"),
    ("another upper side", "X", style.ACCENT),
    ("upper side not measured", "o", style.INK),
)


def plan(study):
    """Draw where each toss came to rest, from the place measured to the place computed."""
    computed = study.result.places / MM
    measured = study.launches.ends[: len(computed)] / MM
    figure = style.figure(6.4, 5.6)
    median = np.nanmedian(study.off) / MM
    title = f"{study.part.name}: {len(computed)} tosses, median distance {median:.3g} mm"
    axes = style.tidy(figure.add_subplot(), title=title, x="x [mm]", y="y [mm]")
    axes.set_aspect("equal")
    axes.plot(*np.stack([measured, computed]).transpose(2, 0, 1), color=style.FAINT, linewidth=0.8, zorder=1)
    kinds = _kinds(study)
    for kind, (label, marker, colour) in enumerate(TOSS_LOOKS):
        chosen = kinds == kind
        if chosen.any():
            look = {"marker": marker, "color": colour, "s": 18, "linewidths": 0.0}
            axes.scatter(*computed[chosen].T, label=f"computed, {label}", **look)
    axes.scatter(*measured.T, marker=".", s=6, color=style.INK, label="measured")
    figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    return figure


def _kinds(study):
    """(N,) index into LOOKS."""
    faces = study.result.faces
    if study.launches.faces is None:
        return np.full(len(faces), 2)
    measured = [FACE_NAMES.index(face) for face in study.launches.faces[: len(faces)]]
    return np.where(faces == measured, 0, 1)
