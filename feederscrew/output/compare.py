"""Files of ``feeder compare``: profiles of a part, feeding tests by device, and many measured sets."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from feederscrew.heavy import heavy
from feederscrew.output import offers as offer
from feederscrew.output import style, tables
from feederscrew.output.tables import Frame
from feederscrew.resting.rules import registry
from feederscrew.studies.compare import CompareStudy, FeedingStudy, SetsStudy

mpl_patches = heavy("matplotlib.patches")

TESTS = ("chi_square", "degrees_of_freedom", "p_value")  # columns of the test, which needs counts


def comparisons(study: CompareStudy) -> Frame:
    """Return every pair of profiles, a row each: the columns of ``compare.csv``.

    Those of the test are empty where neither profile holds counts.
    """
    return _frame(study.comparisons)


def printed(study: CompareStudy, format: str) -> Frame:
    """Return what is printed: for people each measured profile with the rules, the nearest one first.

    The table leaves out how far rules are from each other, which the files hold.
    """
    if format != "table":
        return comparisons(study)
    order = [profile.name for profile in study.measured.profiles]
    own = [each for each in study.comparisons if each.first.name in order]
    against_rules = [each for each in own if each.second.name not in order]
    against_rules.sort(key=lambda each: (order.index(each.first.name), each.total_variation))
    return _frame([*against_rules, *(each for each in own if each.second.name in order)])


def _frame(compared):
    tests = [each.chi_square for each in compared]
    return tables.frame(
        {
            "first": [each.first.name for each in compared],
            "second": [each.second.name for each in compared],
            "deviation": [each.deviation for each in compared],
            "total_variation": [each.total_variation for each in compared],
            "chi_square": [test.statistic for test in tests],
            "degrees_of_freedom": [test.degrees_of_freedom or None for test in tests],
            "p_value": [test.p_value for test in tests],
        }
    )


def hidden(study):
    """Return the columns that a table for people leaves out, as they hold nothing."""
    return () if any(each.chi_square.degrees_of_freedom for each in study.comparisons) else TESTS


def document(study: CompareStudy) -> dict[str, Any]:
    """Return the comparison as one JSON document."""
    listed = [
        {"name": p.name, "kind": p.kind, "values": p.values, "fractions": p.fractions} for p in study.profiles
    ]
    return {
        "part": study.part.name,
        "aspects": list(study.aspects.names),
        "profiles": listed,
        "comparisons": comparisons(study),
    }


FEEDING_FILE = "devices.csv"


def feeding_offers(study) -> list[Any]:
    """Offer the table of a FeedingStudy, as a list of Offer."""
    return [offer.table(FEEDING_FILE, device_comparisons, study)]


def device_comparisons(study: FeedingStudy) -> Frame:
    """Return what passed each device, measured and predicted, a row a device: the columns of ``devices.csv``.

    They are shares of the parts that came to the device.
    """
    return feeding_frame([study])


def feeding_printed(study, _):
    """Return what is printed in any format: ``comparisons``."""
    return device_comparisons(study)


def feeding_frame(studies):
    """Return the same of several feeding tests; the answer of a rule that a test does not have is empty."""
    rows = [row for study in studies for row in _rows(study)]
    names = dict.fromkeys(name for row in rows for name in row)
    return tables.frame({name: [row.get(name) for row in rows] for name in names})


def feeding_table(studies):
    """Return the table for people: without the rules, each share with its interval, files without folders."""
    rows = feeding_frame(studies)
    columns = rows.only(("set", "device", "passed", "rejected"))
    columns["set"] = [Path(name).name for name in rows["set"]]
    for name in ("measured", "predicted"):
        ends = zip(rows[name], rows[f"{name}_low"], rows[f"{name}_high"])
        columns[name] = ["{:.3f} ({:.3f} to {:.3f})".format(*three) for three in ends]
    return tables.frame(columns | {"agrees": rows["agrees"]})


def feeding_hidden(study) -> tuple[Any, ...]:
    """Return the columns that a table for people leaves out: the file, and what the rules predict."""
    return ("set", *_rules([study]))


def feeding_document(study: FeedingStudy) -> dict[str, Any]:
    """Return one feeding test as a JSON document."""
    head = study.measured.head
    return {
        "part": study.part.name,
        "file": study.measured.source,
        **{key: value for key, value in vars(head).items() if value and key != "part"},
        "answer": study.answer,
        "devices": device_comparisons(study),
    }


def _rules(studies) -> tuple[Any, ...]:
    return tuple(dict.fromkeys(f"p_{rule}" for study in studies for rule in _own(study)))


def _own(study) -> list[Any]:
    """The rules whose own prediction stands beside the recommended answer's."""
    return [rule for rule in study.answers if rule != "recommended"]


def _rows(study) -> Iterator[Any]:
    counts, ends = study.measured, study.ends
    for k, station in enumerate(study.stations):
        yield {
            "set": counts.source,
            "device": station,
            "passed": int(counts.passed[k]),
            "rejected": int(counts.rejected[k]),
            "measured": float(counts.shares[k]),
            "measured_low": ends[k, 0],
            "measured_high": ends[k, 1],
            "predicted": float(study.answers["recommended"][k]),
            "predicted_low": float(study.low[k]),
            "predicted_high": float(study.high[k]),
            "agrees": bool(study.agrees[k]),
            **{f"p_{rule}": float(study.answers[rule][k]) for rule in _own(study)},
        }


DARKEST_VARIATION = 0.3  # [1] total variation drawn in the darkest shade
SPARE_RULES = (
    ("QUASISTATIC",),
    ("CRSA",),
    ("BARRIER",),
    ("HOPS",),
    ("STABILITY",),
)  # left out first of a wide table
ROW_IN, COLUMN_IN = 0.24, 0.78  # [in] of a cell of the picture


def sets_offers(study):
    """Offer the table of a SetsStudy and its picture, as a list of Offer."""
    alt = "How far each rule and the recommended answer are from each measured set"
    offered = [
        offer.table("compare.csv", sets_frame, study),
        offer.picture("compare.png", alt, sets_figure, study),
    ]
    tested = [offer.table(FEEDING_FILE, feeding_frame, study.feedings)]
    return (offered if study.sets else []) + (tested if study.feedings else [])


def sets_printed(study, form):
    """Return what is printed: for people both tables, else that of the sets or of the feeding tests."""
    if form != "table":
        return [sets_frame(study) if study.sets else feeding_frame(study.feedings)]
    tested = [feeding_table(study.feedings)] if study.feedings else []
    return ([sets_table(study)] if study.sets else []) + tested


def sets_frame(study: SetsStudy) -> Frame:
    """Return the total variation of every set from every answer, a row a set, then a row a series.

    The columns of ``compare.csv``; an answer that a set does not have is empty.
    """
    distances = [set_study.distances for set_study in study.sets]
    rows = [
        (
            set_label(set_study),
            _series(study, set_study),
            set_study.measured.head.launch or None,
            *_counted(set_study),
            away,
        )
        for set_study, away in zip(study.sets, distances)
    ]
    rows += [_mean(name, sets) for name, sets in study.series.items() if len(sets) > 1]
    names = ("set", "series", "launch", "parts", "rule", "aspects", "inside")
    columns = dict(zip(names, zip(*(row[:-1] for row in rows))))
    return tables.frame(columns | {name: [row[-1].get(name) for row in rows] for name in study.answers})


def sets_table(study):
    """Return the same for people: fewer columns, whole numbers as such, three digits behind the point.

    Of the rules those in ``SPARE`` are left out where a line would have more letters than a page.
    """
    whole = sets_frame(study)
    columns = {"set": whole["set"], "launch": whole["launch"], "parts": _whole(whole["parts"])}
    inside = zip(_whole(whole["inside"]), whole["aspects"])
    columns["inside"] = [None if some is None else f"{some} of {all}" for some, all in inside]
    return tables.frame(columns | {name: _three(whole[name]) for name in study.answers})


def _three(values) -> list[Any]:
    """Numbers as texts with three digits behind the point; None where there is none."""
    return [None if np.isnan(value) else f"{value:.3f}" for value in values.astype(float)]


def _whole(values) -> list[Any]:
    return [None if value is None or value != value else f"{value:.0f}" for value in values]


def set_label(set_study):
    """Return how a SetStudy is called: its file, and its column where there are several."""
    stem = Path(set_study.measured.source).stem
    return stem if len(set_study.measured.profiles) == 1 else f"{stem}, {set_study.profile.name}"


def _series(study, set_study):
    return next(name for name, sets in study.series.items() if set_study in sets)


def _counted(set_study) -> tuple[Any, ...]:
    """Parts counted, rule of the recommended answer, aspects, and how many of them it holds."""
    parts = int(set_study.profile.values.sum()) if set_study.profile.counted else None
    rule = None if set_study.recommended is None else set_study.recommended.rule
    return parts, rule, len(set_study.aspects.names), set_study.inside


def _mean(name, sets) -> tuple[Any, ...]:
    """The row of a series: the mean over its sets."""
    distances, inside = (
        [set_study.distances for set_study in sets],
        [set_study.inside for set_study in sets if set_study.inside is not None],
    )
    answers = dict.fromkeys(answer for away in distances for answer in away)
    means = {k: float(np.mean([away[k] for away in distances if k in away])) for k in answers}
    launches = {set_study.measured.head.launch or None for set_study in sets}
    parts = [int(set_study.profile.values.sum()) for set_study in sets if set_study.profile.counted]
    return (
        f"{name}, mean of {len(sets)}",
        name,
        launches.pop() if len(launches) == 1 else None,
        sum(parts) if len(parts) == len(sets) else None,
        None,
        sum(len(set_study.aspects.names) for set_study in sets),
        sum(inside) if inside else None,
        means,
    )


def sets_document(study: SetsStudy) -> dict[str, Any]:
    """Return many measured sets and every answer for them as one JSON document."""
    return {
        "sets": [_set_document(set_study) for set_study in study.sets],
        "total_variation": sets_frame(study),
        "feeding_tests": [feeding_document(set_study) for set_study in study.feedings],
    }


def _set_document(set_study) -> dict[Any, Any]:
    head = set_study.measured.head
    recommended = set_study.recommended
    return {
        "file": set_study.measured.source,
        "name": set_study.profile.name,
        **{key: value for key, value in vars(head).items() if value},
        "kind": set_study.profile.kind,
        "aspects": list(set_study.aspects.names),
        "values": set_study.profile.values,
        "fractions": set_study.profile.fractions,
        "answers": {name: answer.fractions for name, answer in set_study.answers.items()},
        "recommended": None
        if recommended is None
        else {"rule": recommended.rule, "low": recommended.low, "high": recommended.high},
        "total_variation": set_study.distances,
    }


def sets_figure(study: SetsStudy):
    """Draw the total variation of every set from every answer as a table of shades."""
    answers = study.answers
    values = np.array(
        [[set_study.distances.get(name, np.nan) for name in answers] for set_study in study.sets]
    )
    figure = style.figure(COLUMN_IN * len(answers) + 2.6, ROW_IN * len(study.sets) + 1.4)
    axes = figure.add_subplot()
    axes.imshow(values, cmap="Blues", vmin=0.0, vmax=DARKEST_VARIATION, aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            colour = "white" if value > 0.6 * DARKEST_VARIATION else style.INK
            axes.text(column, row, f"{value:.3f}", ha="center", va="center", fontsize=7, color=colour)
    style.tidy(axes, title="Total variation between what was measured and each answer", grid="none")
    axes.set_xticks(range(len(answers)), [look(name)[0] for name in answers], rotation=30, ha="right")
    axes.set_yticks(range(len(study.sets)), [_set_and_launch(set_study) for set_study in study.sets])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    return figure


def _set_and_launch(set_study):
    launch = set_study.measured.head.launch
    return f"{set_label(set_study)} ({launch})" if launch else set_label(set_study)


def offers(study: CompareStudy) -> list[offer.Offer]:
    """Offer the table of comparisons and their picture."""
    alt = "What was measured beside each rule, and how far every two profiles are apart"
    return [
        offer.table("compare.csv", comparisons, study),
        offer.picture("compare.png", alt, _comparison, study),
    ]


def _comparison(study):
    measured, rules = ({p.name: p.fractions for p in some} for some in (study.measured.profiles, study.rules))
    pairs = {(each.first.name, each.second.name): each.deviation for each in study.comparisons}
    return comparison(study.part.name, study.aspects.names, measured, rules, pairs)


RAMPS = {  # test series: one hue each, darker with the amplitude
    "MDBT": ("#c3c8ce", "#8d97a2", "#545f6b"),
    "MDFT": ("#e3c4d6", "#cc79a7", "#8f4a71"),
}
FIXED = {
    "CSA_at_0.4": ("CSA at ratio 0.4", "#f3c565"),
    "CSA_Table_3-1": ("CSA, Table 3-1", "#b67c00"),
    "CSA_mixed_heights": ("CSA, mixed heights", "#f3c565"),
    "experiment": ("experiment", "#545f6b"),
    "recommended": ("recommended", style.ANSWER),
}
USER_COLOURS = (
    "#545f6b",
    "#cc79a7",
    "#a9b3bd",
    "#8f4a71",
    "#7d6b5d",
    "#5b3a8e",
)  # a user's profiles, in turn
BAR_WIDTH_IN = 0.20  # [in] of paper a bar gets
MAX_CHARTS_IN = 13.0  # [in] of all charts side by side
UPRIGHT_BAR_IN = 0.3  # [in] of a bar below which its number stands upright
LEAST_ROOM = 0.17  # [in] of a bar below which its number is left out


def look(name: str, place=0):
    """Return label and colour of a profile, the same in every chart.

    ``name`` is a rule in any case, 'MDBT_80', or a user's own; ``place`` is that of a user's own profile
    among others of its kind.
    """
    series, _, amplitude = name.rpartition("_")
    if series in RAMPS and amplitude in ("78", "80", "82"):
        return f"{series} {amplitude} %", RAMPS[series][("78", "80", "82").index(amplitude)]
    if name in FIXED:
        return FIXED[name]
    if name.lower() in registry.RULE_OF:
        return style.method(name.lower())
    return name.replace("_", " "), USER_COLOURS[place % len(USER_COLOURS)]


def bars(axes, names, profiles, printed=None, room=BAR_WIDTH_IN) -> None:
    """Draw grouped bars on an Axes, with a tick where print has the number.

    ``names`` are the A aspects, ``profiles`` (A,) shares [1] by name, ``printed`` the published ones of some;
    ``room`` [in] is the width of paper that a bar has.
    """
    places, width = np.arange(len(names)), 1.0 / (len(profiles) + 0.9)
    for place, (name, values) in enumerate(profiles.items()):
        label, colour = look(name, place)
        x = places + (place - 0.5 * (len(profiles) - 1)) * width
        axes.bar(x, 100.0 * values, 0.92 * width, color=colour, label=label)
        if room >= LEAST_ROOM:
            _numbers(axes, x, 100.0 * values, upright=room < UPRIGHT_BAR_IN)
        if name in (printed or {}):
            _ticks(axes, x, 100.0 * printed[name], width)
    style.named_ticks(axes, places, names)
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(-0.55, len(names) - 0.45)
    above = (
        132.0 if LEAST_ROOM <= room < UPRIGHT_BAR_IN else 114.0
    )  # numbers that stand upright are kept off the title
    axes.set_ylim(0.0, above * max(values.max() for values in profiles.values()))


def comparison(title: str, names, measured, rules, compared):
    """Draw one chart a rule against everything measured, and how far each profile is from what was measured.

    ``names`` are the A aspects, ``measured`` and ``rules`` (A,) shares [1] by name, ``compared`` the
    deviation [1] of each pair of profiles.
    """
    width = float(np.clip(len(names) * (len(measured) + 1.9) * BAR_WIDTH_IN + 1.0, 4.2, 12.0))
    side, tall = max(3.1, 0.42 * len(measured) + 1.5), 0.42 * (len(measured) + len(rules)) + 1.3
    across = max(1, min(len(rules), int(MAX_CHARTS_IN / width)))
    rows = -(-max(len(rules), 1) // across)
    figure = style.figure(across * width + side, max(2.2 * rows, tall))
    grid = figure.add_gridspec(rows, across + 1, width_ratios=(*[width] * across, side))
    charts = {name: {**measured, name: values} for name, values in rules.items()} or {title: measured}
    room = (width - 1.0) / (len(names) * (len(measured) + 1.9))
    for place, (rule, profiles) in enumerate(charts.items()):
        row, column = divmod(place, across)
        axes = figure.add_subplot(grid[row, column])
        heading = (f"{title}: " if place == 0 else "") + look(rule)[0] if rules else title
        lowest, first = place + across >= len(charts), column == 0
        style.tidy(
            axes, title=heading, x="aspect" if lowest else "", y="share [%]" if first else "", grid="y"
        )
        bars(axes, names, profiles, room=room)
    _legend(figure, measured, rules)
    _matrix(figure.add_subplot(grid[:, across]), list(measured), list(rules), compared)
    return figure


def _legend(figure, measured, rules) -> None:
    """One entry a profile, whatever chart it stands in."""
    looks = [look(name, place) for place, name in enumerate(measured)]
    looks += [look(name, len(measured)) for name in rules]
    handles = [mpl_patches.Patch(color=colour, label=label) for label, colour in looks]
    figure.legend(
        handles=handles, loc="outside lower center", ncols=min(len(handles), 9), frameon=False, fontsize=8
    )


def _matrix(axes, measured, rules, compared) -> None:
    """Deviations of every profile from those that were measured, as a table of shades."""
    names, deviations = [*measured, *rules], {frozenset(pair): value for pair, value in compared.items()}
    values = np.full((len(names), len(measured)), np.nan)
    for j, i in zip(*np.tril_indices(len(names), -1, len(measured))):
        values[j, i] = deviations.get(frozenset((names[j], names[i])), np.nan)
    rows = slice(1, None)  # the first has nothing before it
    top = max(np.nanmax(values, initial=0.0), 0.1)
    axes.imshow(values[rows], cmap="Blues", vmin=0.0, vmax=1.25 * top, aspect="equal")
    for (j, i), value in np.ndenumerate(values[rows]):
        if np.isfinite(value):
            colour = "white" if value > 0.6 * top else style.INK
            axes.text(i, j, f"{value:.3f}", ha="center", va="center", fontsize=7, color=colour)
    labels = [look(name, place)[0] for place, name in enumerate(names)]
    style.tidy(axes, title="Deviation from\nwhat was measured", grid="none")
    axes.set_xticks(range(len(measured)), labels[: len(measured)], rotation=45, ha="right")
    axes.set_yticks(range(len(names) - 1), labels[1:])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)


def _numbers(axes, x, percent, upright) -> None:
    for at, value in zip(x, percent):
        text = f"{value:.1f}"
        axes.annotate(
            text, (at, value), (0, 2), textcoords="offset points", ha="center", va="bottom", fontsize=6.5,
            rotation=90 if upright else 0, color=style.INK,
        )  # fmt: skip


def _ticks(axes, x, percent, width) -> None:
    axes.hlines(percent, x - 0.46 * width, x + 0.46 * width, color=style.INK, linewidth=1.1, zorder=3)


def of_kind(study) -> tuple[Any, ...]:
    """Return the functions of a CompareStudy or a FeedingStudy: offers, what is printed, hidden, document."""
    if isinstance(study, FeedingStudy):
        return feeding_offers, feeding_printed, feeding_hidden, feeding_document
    return offers, printed, hidden, document
