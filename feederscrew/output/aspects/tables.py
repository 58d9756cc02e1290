"""Resting aspects as a table and as a document."""

import numpy as np

from feederscrew.documents import hint
from feederscrew.errors import ArgumentError
from feederscrew.output import columns, tables
from feederscrew.output.columns import G_MM2, MM2, UJ
from feederscrew.resting import names_file
from feederscrew.resting.forms import postures
from feederscrew.units import DEG, MM, quantity_text

MOST = 24  # rows that a picture shows
NORMALS = ("normal_x", "normal_y", "normal_z")
RECOMMENDED = ("p_recommended", "p_recommended_low", "p_recommended_high")
PRINTED = (  # the table for people, unless they ask for more
    "aspect", "lies", "stable", "height_mm", *RECOMMENDED,
    "p_pmi", "p_csa", "p_stability", "surface", "tumbling",
)  # fmt: skip


def aspects(study):
    """Return the classes of resting aspects, one row each.

    Parameters
    ----------
    study : AspectsStudy
        An open surface is labelled in every row, and tumbling that fails a self-check.

    Returns
    -------
    Frame
        The columns of ``aspects.csv``.
    """
    found = study.aspects
    return tables.frame(
        {
            "aspect": found.names,
            "kind": found.kinds,
            "faces": found.faces,
            "stable": found.stable,
            **dict(zip(NORMALS, found.normals.T)),
            "height_mm": found.heights / MM,
            "contact_area_mm2": found.contact_areas / MM2,
            "solid_angle_sr": found.solid_angles,
            "polar_inertia_g_mm2": found.polar_inertias / G_MM2,
            **{f"p_{rule}": chance for rule, chance in found.probabilities.items()},
            **_barriers(found),
            "form": found.forms,
            **_lies(study),
            "rolling_circle_mm": np.where(np.isfinite(found.rolling_circles), found.rolling_circles, np.nan)
            / MM,
            **_interval("p_drop", study.tally),
            **_interval("p_recommended", study.recommended),
            **_labels("surface", "open", study.part.open_surface, len(found.names)),
            **_labels("tumbling", "doubtful", study.doubtful, len(found.names)),
        }
    )


def printed(frame, wanted=None):
    """Return the columns that are printed for people.

    Parameters
    ----------
    frame : Frame
        From ``aspects``.
    wanted : str, optional
        Names, or what the table heads them, with commas between, or 'all'; without it the columns of
        ``PRINTED`` that there are.

    Returns
    -------
    Frame

    Raises
    ------
    ArgumentError
        If there is no such column.
    """
    if wanted is None:
        return by_share(frame.only(name for name in PRINTED if name in frame))
    names = list(frame) if wanted.strip() == "all" else [name.strip() for name in wanted.split(",")]
    headed = _by_heading(frame)
    names = [name if name in frame else headed.get(name.casefold(), name) for name in names]
    for name in names:
        if name not in frame:
            raise ArgumentError(
                "columns", f"there is no column {quantity_text(name)}", hint(name, list(frame))
            )
    return frame.only(names)


def _by_heading(frame):
    """The columns by what a table heads them, 'height' and 'pmi'; without what heads several, 'low'."""
    words = [tables.heading(name)[0].casefold() for name in frame]
    return {word: name for word, name in zip(words, frame) if words.count(word) == 1}


def by_share(frame):
    """Return a table of aspects with the likeliest answer first; as it is where there is no answer."""
    if RECOMMENDED[0] not in frame:
        return frame
    order = np.argsort(
        -np.nan_to_num(np.asarray(frame[RECOMMENDED[0]], dtype=float), nan=-1.0), kind="stable"
    )
    return tables.frame({name: [column[row] for row in order] for name, column in frame.items()})


def _lies(study):
    """How the part lies, in words; nothing of a card, which has no shape."""
    hull, found = study.part.hull, study.aspects
    if hull is None:
        return {}
    return {"lies": postures(found.normals, found.contact_areas, found.kinds, hull)}


def _barriers(found):
    if found.barriers is None:
        return {}
    return {
        "barrier_mm": found.barriers / MM,
        "barrier_uJ": found.barrier_energies / UJ,
        "tip_angle_deg": found.tip_angles / DEG,
    }


def _interval(name, answer):
    """Probabilities with both ends of their interval; nothing where there are none."""
    return {} if answer is None else {name: answer.p, f"{name}_low": answer.low, f"{name}_high": answer.high}


def _labels(name, text, wanted, count):
    """A column that says the same in every row, where that is to be said."""
    return {name: [text] * count} if wanted else {}


def document(study):
    """Return all that is known of a part and its aspects.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    dict
        That of `columns.part`; ``recommended``, the rule of the columns ``p_recommended...``, None for a
        card; ``aspects``, the table.
    """
    answer = study.recommended
    rule = None if answer is None else answer.rule
    of_part = columns.part(study.part, study.aspects.warnings)
    return of_part | {"recommended": rule, "aspects": aspects(study)}


def names(study):
    """Return the text of ``names.yaml``: the aspects by name, to be edited and read again."""
    return names_file.text(study.part, study.aspects)


def profiles(study):
    """Return the names of the stable aspects that a chart shows, and their probabilities by rule.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    names : list of str
    profiles : dict of str to (A,) float [1]
    """
    found = study.aspects
    stable = np.flatnonzero(found.stable)[:MOST]
    return [found.names[row] for row in stable], {rule: p[stable] for rule, p in found.probabilities.items()}


def answer(study):
    """Return the recommended answer for `profiles`, (3, A): share, low, high; None of a card."""
    known = study.recommended
    if known is None:
        return None
    stable = np.flatnonzero(study.aspects.stable)[:MOST]
    return np.array([known.p[stable], known.low[stable], known.high[stable]])


def remarks(study):
    """Return what a user should know of pictures that are missing or not whole, a line each."""
    count = len(study.aspects.names)
    if study.part.vertices is None:
        return ["a part card has no shape to draw: no aspects.png"]
    return [f"aspects.png shows the first {MOST} of {count} rows"] if count > MOST else []
