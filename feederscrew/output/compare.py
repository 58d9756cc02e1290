"""Files of ``feeder compare`` and ``feeder calibrate``: what was measured beside what is computed."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document, Frame, of_arrays, of_records, values
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM_S, counted
from feederscrew.feeding import compare as studies
from feederscrew.output import offers as offer
from feederscrew.output import style
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import calibrate_text
from feederscrew.resting.deviation import PAIR_COLUMNS, Comparison
from feederscrew.resting.profiles import PROFILE_COLUMNS
from feederscrew.resting.rules import registry
from feederscrew.resting.rules.recommended import RECOMMENDED_COLUMNS

mpl_patches = heavy("matplotlib.patches")

TESTS = ("chi_square", "degrees_of_freedom", "p_value")  # columns of the test, which needs counts


def _pair_frame(comparisons: Iterable[Comparison]) -> Frame:
    """Pairs of profiles, a row each: ``compare.csv``; the test is empty where neither holds counts."""
    return of_records(PAIR_COLUMNS, comparisons)


def offers(study: studies.CompareStudy | studies.FeedingStudy) -> list[offer.Offer]:
    """Offer the table of a CompareStudy and its picture, or the table of a FeedingStudy."""
    if isinstance(study, studies.FeedingStudy):
        return [offer.table(FEEDING_FILE, studies.feedings_table, [study])]
    alt = "What was measured beside each rule, and how far every two profiles are apart"
    measured, rules = ({p.name: p.fractions for p in some} for some in (study.measured.profiles, study.rules))
    pairs = {(pair.first.name, pair.second.name): pair.deviation for pair in study.comparisons}
    drawn = study.part.name, study.aspects.names, measured, rules, pairs
    return [
        offer.table("compare.csv", _pair_frame, study.comparisons),
        offer.picture("compare.png", alt, comparison, *drawn),
    ]


def printout(
    study: studies.CompareStudy | studies.FeedingStudy, format: str
) -> tuple[Frame, Document, Sequence[str]]:
    """Return what is printed of a CompareStudy or a FeedingStudy: table, document, columns to be hidden.

    With the ``format`` 'table' each measured profile stands with the rules, the nearest one first; else all
    pairs stand in the order of the study, as in the document.
    """
    if isinstance(study, studies.FeedingStudy):
        return studies.feedings_table([study]), _feeding_document(study), ()
    comparisons = _pair_frame(study.comparisons)
    document = {
        "part": study.part.name,
        "aspects": list(study.aspects.names),
        "profiles": [values(PROFILE_COLUMNS, profile) for profile in study.profiles],
        "comparisons": comparisons,
    }
    is_tested = any(pair.chi_square.degrees_of_freedom for pair in study.comparisons)
    if format != "table":
        return comparisons, document, ()
    order = [profile.name for profile in study.measured.profiles]
    own = [pair for pair in study.comparisons if pair.first.name in order]
    against_rules = [pair for pair in own if pair.second.name not in order]
    against_rules.sort(key=lambda pair: (order.index(pair.first.name), pair.total_variation))
    pairs = _pair_frame([*against_rules, *(pair for pair in own if pair.second.name in order)])
    return pairs, document, () if is_tested else TESTS


# --- Feeding tests ---

FEEDING_FILE = "devices.csv"


def _feeding_document(study: studies.FeedingStudy) -> Document:
    return {
        "part": study.part.name,
        "file": study.measured.source,
        **{key: value for key, value in vars(study.measured.head).items() if value and key != "part"},
        "answer": study.answer,
        "devices": studies.feedings_table([study]),
    }


# --- Many measured sets ---

SPARE_RULES = (("QUASISTATIC",), ("CRSA",), ("BARRIER",), ("HOPS",), ("STABILITY",))  # of a wide table


def sets_offers(study: studies.SetsStudy) -> list[offer.Offer]:
    """Offer the tables of a SetsStudy and its picture."""
    alt = "How far each rule and the recommended answer are from each measured set"
    offered = [
        offer.table("compare.csv", _sets_frame, study),
        offer.picture("compare.png", alt, _sets_figure, study),
    ]
    tested = [offer.table(FEEDING_FILE, studies.feedings_table, study.feedings)]
    return (offered if study.sets else []) + (tested if study.feedings else [])


def sets_printout(study: studies.SetsStudy, form: str) -> list[Frame]:
    """Return what is printed: for people both tables, else that of the sets or of the feeding tests."""
    if form != "table":
        return [_sets_frame(study) if study.sets else studies.feedings_table(study.feedings)]
    frames = []
    if study.sets:
        whole = _sets_frame(study)
        parts, inside = (
            [None if value is None or value != value else f"{value:.0f}" for value in whole[name]]
            for name in ("parts", "inside")
        )
        of_all = [some and f"{some} of {count}" for some, count in zip(inside, whole["aspects"])]
        columns = {**whole.only(("set", "launch")), "parts": parts, "inside": of_all}
        for name in study.answers:
            values = whole[name].astype(float)
            columns[name] = [None if np.isnan(value) else f"{value:.3f}" for value in values]
        frames.append(Frame.of(columns))
    if study.feedings:
        rows = studies.feedings_table(study.feedings)
        columns = rows.only(("set", "device", "passed", "rejected"))
        columns["set"] = [Path(name).name for name in rows["set"]]
        for name in ("measured", "predicted"):
            ends = zip(rows[name], rows[f"{name}_low"], rows[f"{name}_high"])
            columns[name] = [f"{value:.3f} ({low:.3f} to {high:.3f})" for value, low, high in ends]
        frames.append(Frame.of(columns | {"agrees": rows["agrees"]}))
    return frames


def _sets_frame(study: studies.SetsStudy) -> Frame:
    """The total variation of every set from every answer, then its mean over each series: ``compare.csv``."""
    series, rows = study.series.items(), []
    lines: list[tuple[str, str, Sequence[studies.SetStudy]]] = [
        (_set_label(item), name, [item]) for item in study.sets for name, sets in series if item in sets
    ]
    lines += [(f"{name}, mean of {len(sets)}", name, sets) for name, sets in series if len(sets) > 1]
    for label, group, items in lines:
        inside = [item.inside for item in items if item.inside is not None]
        launches = {item.measured.head.launch or None for item in items}
        parts = [int(item.profile.values.sum()) for item in items if item.profile.has_counts]
        answer = items[0].recommended if len(items) == 1 else None
        row: dict[str, str | float | None] = {
            "set": label,
            "series": group,
            "launch": launches.pop() if len(launches) == 1 else None,
            "parts": sum(parts) if len(parts) == len(items) else None,
            "rule": None if answer is None else answer.rule,
            "aspects": sum(len(item.aspects.names) for item in items),
            "inside": sum(inside) if inside else None,
        }
        for name in study.answers:
            distances = [item.distances[name] for item in items if name in item.distances]
            row[name] = float(np.mean(distances)) if distances else None
        rows.append(row)
    names = ("set", "series", "launch", "parts", "rule", "aspects", "inside", *study.answers)
    return Frame.of_rows(rows, names)


def _set_label(item: studies.SetStudy) -> str:
    stem = Path(item.measured.source).stem
    return stem if len(item.measured.profiles) == 1 else f"{stem}, {item.profile.name}"


def sets_document(study: studies.SetsStudy) -> Document:
    """Return many measured sets and every answer for them as one JSON document."""
    sets = [
        {
            **values(studies.SET_COLUMNS, item),
            **{key: value for key, value in vars(item.measured.head).items() if value},
            "kind": item.profile.kind,
            "aspects": list(item.aspects.names),
            "values": item.profile.values,
            "fractions": item.profile.fractions,
            "answers": {name: answer.fractions for name, answer in item.answers.items()},
            "recommended": item.recommended and values(RECOMMENDED_COLUMNS, item.recommended),
            "total_variation": item.distances,
        }
        for item in study.sets
    ]
    feedings = [_feeding_document(item) for item in study.feedings]
    return {"sets": sets, "total_variation": _sets_frame(study), "feeding_tests": feedings}


def _sets_figure(study: studies.SetsStudy) -> "style.Figure":
    answers = study.answers
    values = np.array([[item.distances.get(name, np.nan) for name in answers] for item in study.sets])
    figure = style.figure(0.78 * len(answers) + 2.6, 0.24 * len(study.sets) + 1.4)
    axes = figure.add_subplot()
    title = "Total variation between what was measured and each answer"
    _shades(axes, values, 0.3, 0.6 * 0.3, title, "auto")
    axes.set_xticks(range(len(answers)), [look(name)[0] for name in answers], rotation=30, ha="right")
    heads = [(_set_label(item), item.measured.head.launch) for item in study.sets]
    labels = [f"{label} ({launch})" if launch else label for label, launch in heads]
    axes.set_yticks(range(len(study.sets)), labels)
    return figure


def _shades(
    axes: "style.Axes",
    values: Floats,
    darkest: float,
    white_from: float,
    title: str,
    aspect: Literal["equal", "auto"],
) -> None:
    axes.imshow(values, cmap="Blues", vmin=0.0, vmax=darkest, aspect=aspect)
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            colour = "white" if value > white_from else style.INK
            axes.text(column, row, f"{value:.3f}", ha="center", va="center", fontsize=7, color=colour)
    style.tidy(axes, title=title, grid="none")
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)


# --- Charts of profiles ---

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
USER_COLOURS = ("#545f6b", "#cc79a7", "#a9b3bd", "#8f4a71", "#7d6b5d", "#5b3a8e")  # of profiles, in turn
BAR_WIDTH_IN = 0.20  # [in] of paper a bar gets
UPRIGHT_BAR_IN = 0.3  # [in] of a bar below which its number stands upright
LEAST_ROOM = 0.17  # [in] of a bar below which its number is left out


def look(name: str, place: int = 0) -> tuple[str, str]:
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


def bars(
    axes: "style.Axes",
    names: Sequence[str],
    profiles: Mapping[str, Floats],
    printed_shares: Mapping[str, Floats] | None = None,
    room: float = BAR_WIDTH_IN,
) -> None:
    """Draw grouped bars on an Axes, with a tick where print has the number.

    ``names`` are the A aspects, ``profiles`` (A,) shares [1] by name, ``printed_shares`` the published ones
    of some; ``room`` [in] is the width of paper that a bar has.
    """
    places, width = np.arange(len(names)), 1.0 / (len(profiles) + 0.9)
    for place, (name, shares) in enumerate(profiles.items()):
        label, colour = look(name, place)
        x = places + (place - 0.5 * (len(profiles) - 1)) * width
        axes.bar(x, 100.0 * shares, 0.92 * width, color=colour, label=label)
        if room >= LEAST_ROOM:
            style.numbers(axes, x, 100.0 * shares, 100.0 * shares, room < UPRIGHT_BAR_IN)
        if printed_shares and name in printed_shares:
            ends = x - 0.46 * width, x + 0.46 * width
            axes.hlines(100.0 * printed_shares[name], *ends, color=style.INK, linewidth=1.1, zorder=3)
    style.named_ticks(axes, places, names)
    axes.set_xlim(-0.55, len(names) - 0.45)
    above = 132.0 if LEAST_ROOM <= room < UPRIGHT_BAR_IN else 114.0  # upright numbers are kept off the title
    axes.set_ylim(0.0, above * max(shares.max() for shares in profiles.values()))


def comparison(
    title: str,
    names: Sequence[str],
    shares: dict[str, Floats],
    rules: dict[str, Floats],
    gaps: Mapping[tuple[str, str], float],
) -> "style.Figure":
    """Draw one chart a rule against everything measured, and how far each profile is from what was measured.

    ``names`` are the A aspects, ``shares`` what was measured and ``rules`` (A,) [1] by name, ``gaps`` the
    deviation [1] of each pair of profiles.
    """
    width = float(np.clip(len(names) * (len(shares) + 1.9) * BAR_WIDTH_IN + 1.0, 4.2, 12.0))
    side, tall = max(3.1, 0.42 * len(shares) + 1.5), 0.42 * (len(shares) + len(rules)) + 1.3
    across = max(1, min(len(rules), int(13.0 / width)))
    rows = -(-max(len(rules), 1) // across)
    figure = style.figure(across * width + side, max(2.2 * rows, tall))
    grid = figure.add_gridspec(rows, across + 1, width_ratios=(*[width] * across, side))
    charts = {name: {**shares, name: values} for name, values in rules.items()} or {title: shares}
    room = (width - 1.0) / (len(names) * (len(shares) + 1.9))
    for place, (rule, profiles) in enumerate(charts.items()):
        row, column = divmod(place, across)
        axes = figure.add_subplot(grid[row, column])
        heading = (f"{title}: " if place == 0 else "") + look(rule)[0] if rules else title
        x, y = "aspect" if place + across >= len(charts) else "", "share [%]" if column == 0 else ""
        style.tidy(axes, title=heading, x=x, y=y, grid="y")
        bars(axes, names, profiles, room=room)
    # one entry of the legend a profile, whatever chart it stands in
    looks = [look(name, place) for place, name in enumerate(shares)]
    looks += [look(name, len(shares)) for name in rules]
    handles = [mpl_patches.Patch(color=colour, label=label) for label, colour in looks]
    style.legend(figure, handles=handles, ncols=min(len(handles), 9))
    # deviations of every profile from those that were measured; the first has nothing before it
    profile_names, gap_of = [*shares, *rules], {frozenset(pair): gap for pair, gap in gaps.items()}
    values = np.full((len(profile_names), len(shares)), np.nan)
    for j, i in zip(*np.tril_indices(len(profile_names), -1, len(shares))):
        values[j, i] = gap_of.get(frozenset((profile_names[j], profile_names[i])), np.nan)
    top, side_axes = max(np.nanmax(values, initial=0.0), 0.1), figure.add_subplot(grid[:, across])
    heading = "Deviation from\nwhat was measured"
    _shades(side_axes, values[1:], 1.25 * top, 0.6 * top, heading, "equal")
    labels = [look(name, place)[0] for place, name in enumerate(profile_names)]
    side_axes.set_xticks(range(len(shares)), labels[: len(shares)], rotation=45, ha="right")
    side_axes.set_yticks(range(len(profile_names) - 1), labels[1:])
    return figure


# --- feeder compare --bowl: what explains measured velocities, and what remains of each ---


def fit_quantities(study: studies.BowlFit) -> Frame:
    """Return friction, restitution and stroke that explain the velocities of a BowlFit, one a row."""
    return of_arrays(studies.FIT_QUANTITY_COLUMNS, study)


def fit_velocities(study: studies.BowlFit) -> Frame:
    """Return each measured velocity of a BowlFit, ours beside it, and what remains."""
    return of_arrays(studies.FIT_VELOCITY_COLUMNS, study)


def fit_document(study: studies.BowlFit) -> Document:
    """Return a BowlFit as the JSON document; its ``remark`` says whether it explains the velocities."""
    before, after = (
        float(np.sqrt(np.mean((velocities - study.measured) ** 2))) / MM_S
        for velocities in (study.file, study.fitted)
    )
    remark = (
        f"remains {after:.3g} mm/s in the root of the mean square, {before:.3g} by the bowl file as it stands"
    )
    if study.misfit > 2.0:
        remark += "; more than the velocities' errors: a point on this track does not explain them"
    return {
        "quantities": fit_quantities(study),
        "velocities": fit_velocities(study),
        "misfit": None if np.isnan(study.misfit) else study.misfit,
        "remark": remark,
    }


def fit_offers(study: studies.BowlFit) -> list[offer.Offer]:
    """Offer the files of a BowlFit."""
    return [
        offer.table("bowl_fit.csv", fit_quantities, study),
        offer.table("velocities.csv", fit_velocities, study),
    ]


# --- feeder calibrate ---


def exponents(study: studies.CalibrateStudy) -> Frame:
    """Return the exponents of a CalibrateStudy, a row for each column of counts, as in ``calibrate.csv``."""
    return of_records(studies.FIT_COLUMNS, study.fits)


def calibration_document(study: studies.CalibrateStudy) -> Document:
    """Return a CalibrateStudy as one JSON document."""
    fitted = {fit.name: dict(zip(study.aspects.names, fit.calibration.shares)) for fit in study.fits}
    return {"part": study.part.name, "calibrations": exponents(study), "p_surface": fitted}


def calibration_remarks(study: studies.CalibrateStudy) -> list[str]:
    """Return what a user must know of a calibration, a line each."""
    lines = []
    for fit in study.fits:
        if fit.calibration.reaches_end:
            lines.append(f"{fit.name}: the counts limit the exponent on one side only")
        if (p_value := fit.calibration.chi_square.p_value) < 0.01:
            lines.append(f"{fit.name}: no exponent explains these counts (p {p_value:.2g})")
    return lines


def calibration_offers(study: studies.CalibrateStudy) -> list[offer.Offer]:
    """Offer the table and the document of a calibration."""
    return [
        offer.table("calibrate.csv", exponents, study),
        offer.document("calibrate.json", calibration_document, study),
    ]


COMPARE_VIEW = RecordView(
    lambda study: (
        f"{study.part.name}: {counted(len(study.rules), 'rule')} beside counts of {study.measured.source}"
    ),
    offers,
    "compare",
)
SETS_VIEW = RecordView(None, sets_offers, "compare")
FEEDING_VIEW = RecordView(None, offers, "compare")
CALIBRATE_VIEW = RecordView(calibrate_text, calibration_offers, "calibrate")
