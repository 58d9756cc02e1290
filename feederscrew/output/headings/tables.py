"""Stable headings as tables and as a document, in the units of the shop."""

import numpy as np

from feederscrew.output import tables
from feederscrew.part.smallness import small_part_remarks
from feederscrew.units import MM

HIDDEN = ("contact_1_x_mm", "contact_1_y_mm", "contact_2_x_mm", "contact_2_y_mm")
SPARE = (
    ("straight_wall_share",),
    ("half_turn_of_deg", "mirror_of_deg"),
)  # left out of a table that is too wide


def rows(study):
    """Return every stable heading of a HeadingsStudy, one a dict, under the columns of ``headings.csv``."""
    return [_row(one, row, study.chances) for one in study.headings for row in range(len(one.headings))]


def frame(study):
    """Return the rows of a HeadingsStudy as a frame."""
    found = rows(study)
    return tables.frame({name: [row[name] for row in found] for name in found[0]})


def document(study, settings):
    """Return a HeadingsStudy as the JSON document.

    Parameters
    ----------
    study : HeadingsStudy
    settings : dict of str to str
        The bowl's values in effect.

    Returns
    -------
    dict
    """
    return {
        "part": study.part.name,
        "answer": study.answer,
        "headings": rows(study),
        "bowl": settings,
    }


def answer(study):
    """Say whose probabilities of the aspects a HeadingsStudy takes."""
    return f"Aspect share: {study.answer}"


def remarks(study):
    """Return what a reader of a HeadingsStudy should know, a sentence each."""
    lines, width = list(small_part_remarks(study.part, {}, study.track.width)), study.track.width / MM
    for one in study.headings:
        if one.rounded:
            lines.append(f"aspect {one.aspect} is round in plan: it takes any heading")
        if one.falls_off.all():
            lines.append(f"aspect {one.aspect} falls off the track of {width:.4g} mm in every heading")
    return lines


def _row(one, row, chances):
    degrees = np.degrees(one.headings)
    return {
        "aspect": one.aspect,
        "heading_deg": float(degrees[row]),
        "share": float(one.shares[row]),
        "straight_wall_share": float(one.straight_shares[row]),
        "aspect_share": chances.get(one.aspect, np.nan) * float(one.shares[row]),
        "length_mm": float(one.lengths[row]) / MM,
        "width_mm": float(one.widths[row]) / MM,
        "overhang_mm": float(one.overhangs[row]) / MM,
        "falls_off": bool(one.falls_off[row]),
        "half_turn_of_deg": _partner(degrees, one.half_turns[row]),
        "mirror_of_deg": _partner(degrees, one.mirrors[row]),
        **{
            f"contact_{k + 1}_{axis}_mm": float(one.touching[row, k, i]) / MM
            for k in (0, 1)
            for i, axis in enumerate("xy")
        },
    }


def _partner(degrees, place):
    return float(degrees[place]) if place >= 0 else np.nan
