"""Many measured sets against every answer, as a table, a document and a picture."""

from pathlib import Path

import numpy as np

from feederscrew.output import offers as offer
from feederscrew.output import tables
from feederscrew.output.compare import feeding

DARK = 0.3  # [1] total variation drawn in the darkest shade
SPARE = (
    ("QUASISTATIC",),
    ("CRSA",),
    ("BARRIER",),
    ("HOPS",),
    ("STABILITY",),
)  # left out first of a wide table
ROW, COLUMN = 0.24, 0.78  # [in] of a cell of the picture


def offers(study):
    """Offer the table of a SetsStudy and its picture, as a list of Offer."""
    alt = "How far each rule and the recommended answer are from each measured set"
    offered = [offer.table("compare.csv", frame, study), offer.picture("compare.png", alt, figure, study)]
    tested = [offer.table(feeding.NAME, feeding.frame, study.feedings)]
    return (offered if study.sets else []) + (tested if study.feedings else [])


def shown(study, form):
    """Return what is printed: for people both tables, else that of the sets or of the feeding tests."""
    if form != "table":
        return [frame(study) if study.sets else feeding.frame(study.feedings)]
    tested = [feeding.printed(study.feedings)] if study.feedings else []
    return ([printed(study)] if study.sets else []) + tested


def frame(study):
    """Return the total variation of every set from every answer, a row a set, then a row a series.

    Parameters
    ----------
    study : SetsStudy

    Returns
    -------
    Frame
        The columns of ``compare.csv``; an answer that a set does not have is empty.
    """
    apart = [one.apart for one in study.sets]
    rows = [
        (label(one), _series(study, one), one.measured.head.launch or None, *_counted(one), away)
        for one, away in zip(study.sets, apart)
    ]
    rows += [_mean(name, sets) for name, sets in study.series.items() if len(sets) > 1]
    names = ("set", "series", "launch", "parts", "rule", "aspects", "inside")
    made = dict(zip(names, zip(*(row[:-1] for row in rows))))
    return tables.frame(made | {name: [row[-1].get(name) for row in rows] for name in study.answers})


def printed(study):
    """Return the same for people: fewer columns, whole numbers as such, three digits behind the point.

    Of the rules those in ``SPARE`` are left out where a line would have more letters than a page.
    """
    made = frame(study)
    columns = {"set": made["set"], "launch": made["launch"], "parts": _whole(made["parts"])}
    known = zip(_whole(made["inside"]), made["aspects"])
    columns["inside"] = [None if some is None else f"{some} of {all}" for some, all in known]
    return tables.frame(columns | {name: _three(made[name]) for name in study.answers})


def _three(values):
    """Numbers as texts with three digits behind the point; None where there is none."""
    return [None if np.isnan(value) else f"{value:.3f}" for value in values.astype(float)]


def _whole(values):
    return [None if value is None or value != value else f"{value:.0f}" for value in values]


def label(one):
    """Return how a SetStudy is called: its file, and its column where there are several."""
    stem = Path(one.measured.source).stem
    return stem if len(one.measured.profiles) == 1 else f"{stem}, {one.profile.name}"


def _series(study, one):
    return next(name for name, sets in study.series.items() if one in sets)


def _counted(one):
    """Parts counted, rule of the recommended answer, aspects, and how many of them it holds."""
    parts = int(one.profile.values.sum()) if one.profile.counted else None
    rule = None if one.recommended is None else one.recommended.rule
    return parts, rule, len(one.aspects.names), one.inside


def _mean(name, sets):
    """The row of a series: the mean over its sets."""
    apart, known = [one.apart for one in sets], [one.inside for one in sets if one.inside is not None]
    answers = dict.fromkeys(answer for away in apart for answer in away)
    means = {k: float(np.mean([away[k] for away in apart if k in away])) for k in answers}
    launches = {one.measured.head.launch or None for one in sets}
    parts = [int(one.profile.values.sum()) for one in sets if one.profile.counted]
    return (
        f"{name}, mean of {len(sets)}",
        name,
        launches.pop() if len(launches) == 1 else None,
        sum(parts) if len(parts) == len(sets) else None,
        None,
        sum(len(one.aspects.names) for one in sets),
        sum(known) if known else None,
        means,
    )


def document(study):
    """Return many measured sets and every answer for them as one JSON document.

    Parameters
    ----------
    study : SetsStudy

    Returns
    -------
    dict
    """
    return {
        "sets": [_one(one) for one in study.sets],
        "total_variation": frame(study),
        "feeding_tests": [feeding.document(one) for one in study.feedings],
    }


def _one(one):
    head = one.measured.head
    known = one.recommended
    return {
        "file": one.measured.source,
        "name": one.profile.name,
        **{key: value for key, value in vars(head).items() if value},
        "kind": one.profile.kind,
        "aspects": list(one.aspects.names),
        "values": one.profile.values,
        "fractions": one.profile.fractions,
        "answers": {name: answer.fractions for name, answer in one.answers.items()},
        "recommended": None if known is None else {"rule": known.rule, "low": known.low, "high": known.high},
        "total_variation": one.apart,
    }


def figure(study):
    """Draw the total variation of every set from every answer as a table of shades.

    Parameters
    ----------
    study : SetsStudy

    Returns
    -------
    Figure
    """
    from feederscrew.output import style
    from feederscrew.output.compare.figures import look

    answers = study.answers
    values = np.array([[one.apart.get(name, np.nan) for name in answers] for one in study.sets])
    made = style.figure(COLUMN * len(answers) + 2.6, ROW * len(study.sets) + 1.4)
    axes = made.add_subplot()
    axes.imshow(values, cmap="Blues", vmin=0.0, vmax=DARK, aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            colour = "white" if value > 0.6 * DARK else style.INK
            axes.text(column, row, f"{value:.3f}", ha="center", va="center", fontsize=7, color=colour)
    style.tidy(axes, title="Total variation between what was measured and each answer", grid="none")
    axes.set_xticks(range(len(answers)), [look(name)[0] for name in answers], rotation=30, ha="right")
    axes.set_yticks(range(len(study.sets)), [_told(one) for one in study.sets])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    return made


def _told(one):
    launch = one.measured.head.launch
    return f"{label(one)} ({launch})" if launch else label(one)
