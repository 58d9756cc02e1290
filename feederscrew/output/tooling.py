"""Files of ``feeder tooling``: tables, documents, the bowl file, drawings."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Cells, ColumnHead, Document, Frame, heads, share_head, values
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM, counted
from feederscrew.bowl.arguments import settings_of
from feederscrew.bowl.device_list import DEVICES_SECTION, check_written, value_text
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.kinds import CostClass
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.reading import Setting
from feederscrew.designing import texts
from feederscrew.feeding.rate import PassagesStudy
from feederscrew.output import marking, part_facts
from feederscrew.output import offers as offer
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import tooling_text
from feederscrew.sorting import device_passages
from feederscrew.sorting.fates import course
from feederscrew.sorting.isolating.chain import (
    CUT_COLUMNS,
    DESIGN_COLUMNS,
    LEAST_SHARE,
    Cut,
    Design,
    in_mm,
    margins_at,
)
from feederscrew.sorting.orientations import (
    ORIENTATION_NAME_COLUMNS,
    ORIENTATION_SIZE_COLUMNS,
    Orientation,
)
from feederscrew.sorting.tooled_track import TooledTrack, lay_out
from feederscrew.sorting.tooling import ToolingStudy

if TYPE_CHECKING:
    from feederscrew.designing.tooling_trials import TriedDesign

solid_files = heavy("feederscrew.output.solid_files")
tooling_drawing = heavy("feederscrew.output.tooling_drawing")
tooling_figures = heavy("feederscrew.output.tooling_figures")
tooling_views = heavy("feederscrew.output.tooling_views")

LEAVING = (  # efficiency and purity, of the trial where there is one
    "efficiency",
    "efficiency_low",
    "efficiency_high",
    "purity",
    "purity_low",
    "efficiency_static",
    "purity_static",
)
ROW_HEADS = heads((*ORIENTATION_NAME_COLUMNS, *ORIENTATION_SIZE_COLUMNS)) | heads(DESIGN_COLUMNS)
ROW_HEADS |= {name: share_head(name) for name in ("share", *LEAVING)}
HIDDEN = ("reasons", *(name for name in LEAVING if "_" in name))  # the sentences of the trial have them
SURE_M = 1e-6  # [m] a smaller margin stands for a verdict that is not sure
TABLE_SPARE_COLUMNS = (  # left out of a table for people that is too wide, the first ones first
    ("smallest_cut", "largest_cut"),
    ("mirror", "wall_distance_mm", "balcony_mm", "canyon_mm", "gap_mm"),
    ("height_mm", "track_width_mm", "track_bank_deg"),
    ("length_mm", "width_mm"),
    ("steady",),
    ("status",),
    ("purity",),
    ("left_over",),
)
CLASS_NAMES = {  # what a chain takes, as the trade says it
    CostClass.STEEL: "steel",
    CostClass.AIR: "steady air",
    CostClass.SENSOR: "a camera or another sensor",
}
NOT_PROVED = "not proved"
STOPPED = f"{NOT_PROVED}: stopped before all was searched and tried"
QUASI_STATIC = "quasi-static, until a trial confirms it"


def document(study: ToolingStudy) -> Document:
    """Return a ToolingStudy as the JSON document."""
    entries = {
        **part_facts.part(study.part, (*study.aspects.warnings, *study.of_size)),
        "rule": study.rule,
        "margin_asked_mm": study.margin / MM,
        "partial": study.partial,
        "orientations": _rows(study),
    }
    if study.design is None:
        return entries
    (design, wanted_row), chain = _asked_for(study), []
    orientation, cuts = study.orientations[wanted_row], design.cuts
    for cut, earlier in _with_earlier(cuts):
        fails_by = _fails_by(study, cut, earlier) / MM
        entry = {
            "device": cut.device.kind,
            **cut.device.document_values(),
            **values(CUT_COLUMNS, cut) | {"margin_reject_mm": None if np.isnan(fails_by) else fails_by},
            "smallest": cut.smallest.document_values(),
            "largest": cut.largest.document_values(),
            "returns": [name for name in cut.returns if name not in cut.stops],
            "stops": list(cut.stops),
            "text": cut.device.text,
            "serves": cut.device.serves or None,
        }
        chain.append(entry)
        if cut.device.action.turns:  # what it does, and how sure that is
            entry["turns"] = [{"from": start, "to": end, "share": share} for start, end, share in cut.turns]
            entry["basis"] = QUASI_STATIC
    return entries | {
        **values(ORIENTATION_NAME_COLUMNS, orientation),
        "leaves_as": study.leaves_as,
        "isolated": study.isolates(wanted_row),
        "status": status(study, wanted_row),
        "class": study.class_of(wanted_row),
        "next_class": _next_class(study),
        "isolated_static": design.isolated,
        "steady": design.steady,
        "track_width_mm": study.bowl.track.width / MM,
        "track_bank_deg": float(np.degrees(study.bowl.track.bank)),
        **efficiency_and_purity(design, study.trial_of(wanted_row)),
        "before": [f"{device.kind}: {device.text}" for device in design.before],
        "chain": chain,
        "quasi_static": [cut.device.kind for cut in cuts if cut.device.action.turns],
        "reasons": list(design.reasons),
    }


def _asked_for(study: ToolingStudy) -> tuple[Design, int]:
    """The design of the orientation asked for, and its place."""
    if study.design is None or study.wanted is None:
        raise ValueError("the study is of every orientation, not of one that was asked for")
    return study.design, study.wanted


def _rows(study: ToolingStudy) -> list[Cells]:
    rows = []
    for place, (item, share) in enumerate(zip(study.orientations, study.shares)):
        design = study.designs[place]
        row = {
            **values(ORIENTATION_NAME_COLUMNS, item),
            "share": float(share),
            **values(ORIENTATION_SIZE_COLUMNS, item),
        }
        names = ("isolated", "status", "class", "devices", *(one.name for one in DESIGN_COLUMNS), "steady")
        row |= dict.fromkeys((*names, *LEAVING, "left_over", "reasons"))
        if design is not None:
            row |= {
                "isolated": study.isolates(place),
                "status": status(study, place),
                "class": study.class_of(place),
                "devices": [cut.device.kind for cut in design.cuts],
                **values(DESIGN_COLUMNS, design),
                "steady": design.steady if design.cuts else None,
                **efficiency_and_purity(design, study.trial_of(place)),
                "left_over": list(design.left_over),
                "reasons": list(design.reasons),
            }
        rows.append(row)
    return rows


def _next_class(study: ToolingStudy) -> Document | None:
    """The chain of the next dearer class by the static rule; None without one."""
    design = study.dearer
    if design is None:
        return None
    return {
        "class": CostClass.of(design.devices),
        "devices": [cut.device.kind for cut in design.cuts],
        "efficiency_static": design.efficiency,
        "purity_static": design.purity,
    }


def next_class_words(study: ToolingStudy) -> str:
    """Say what the next dearer class would let leave, and how to ask for it.

    Parameters
    ----------
    study : ToolingStudy

    Returns
    -------
    str
        '' without one.
    """
    design = study.dearer
    if design is None or study.wanted is None or study.design is None:
        return ""
    own = efficiency_and_purity(study.design, study.trial_of(study.wanted))["efficiency"]
    word = CostClass.of(design.devices)
    return (
        f"{CLASS_NAMES[word]} would let {100.0 * design.efficiency:.3g} % leave for {100.0 * own:.3g} %, "
        f"as the static rule says: --class {word}"
    )


def efficiency_and_purity(design: Design, trial: "TriedDesign | None") -> Document:
    """Return efficiency and purity of an orientation's design.

    Of its trial where one was made, with the 95 % interval. Else the least by the static rule: without what
    may roll or rock on its way, and with what no verdict is sure to return counted as leaving.

    Parameters
    ----------
    design : Design
    trial : TriedDesign or None

    Returns
    -------
    dict of str to float or None [1]
        By the names of ``LEAVING``.
    """
    if trial is not None:
        pure = (None, None) if np.isnan(trial.purity) else (trial.purity, trial.purity_ends[0])
        leaving = (trial.efficiency, *trial.efficiency_ends, *pure)
    else:
        leaving = (design.least, design.least, design.efficiency, design.purity, design.purity)
    return dict(zip(LEAVING, (*leaving, design.efficiency, design.purity), strict=True))


def status(study: ToolingStudy, place: int) -> str:
    """Return how far the design of an orientation is shown.

    Parameters
    ----------
    study : ToolingStudy
    place : int
        Row of the orientation.

    Returns
    -------
    str
        'confirmed' or 'denied' by its trial, 'static' without one, 'none' where nothing isolates it, 'not
        proved' where the run was stopped before its trial.
    """
    tried = study.trial_of(place)
    if tried is not None and tried.faults:
        return "denied"
    if not study.isolates(place):
        return "none"
    if tried is None:
        return NOT_PROVED if study.partial else "static"
    return "confirmed"


def frame(study: ToolingStudy) -> Frame:
    """Return the rows as a table.

    Parameters
    ----------
    study : ToolingStudy

    Returns
    -------
    Frame
    """
    rows = _rows(study)
    for row in rows:
        for name, between in (("devices", ", "), ("left_over", " "), ("reasons", "; ")):
            row[name] = between.join(row[name] or ())
    return Frame.of_rows(rows).headed(ROW_HEADS)


def summary(study: ToolingStudy, format: str = "csv") -> Frame:
    """Return what is printed: every orientation, or the chain that isolates the one asked for.

    Parameters
    ----------
    study : ToolingStudy
    format : str, optional
        'csv', or 'table', which names devices as the trade does, has values in words, headings that say whose
        margin it is, and the first names of many that are returned.

    Returns
    -------
    Frame
    """
    people, rows = format == "table", []
    if study.design is None:
        return frame(study)
    orientations: dict[str, set[str]] = {}  # of each aspect
    for orientation in study.orientations:
        orientations.setdefault(orientation.aspect, set()).add(orientation.name)
    margins = ("passes_by_mm", "others_fail_by_mm") if people else ("margin_pass_mm", "margin_reject_mm")
    for cut, earlier in _with_earlier(study.design.cuts):
        # 'A@2 A@90, all of B, C': aspects of which every orientation is returned come last
        whole = [aspect for aspect, names in orientations.items() if names <= set(cut.returns)]
        returns = [k for k in cut.returns if not any(k in orientations[aspect] for aspect in whole)]
        words = ", ".join(filter(None, (" ".join(returns), f"all of {', '.join(whole)}" if whole else "")))
        if people and len(words) > 34:  # as many as have room, and how many more
            first = words.split(" ")
            count = len(first)
            while len(first) > 1 and len(" ".join(first)) > 34:
                first = first[:-1]
            words = " ".join(first) + (f" and {count - len(first)} more" if count > len(first) else "")
        if not words:  # what a turning device does, 'turns A@0 to C@90 (80 %)', or what one is for
            turns = [f"{a} to {b}{'' if x > 0.9995 else f' ({100.0 * x:.3g} %)'}" for a, b, x in cut.turns]
            serves = f"({cut.device.serves})" if cut.device.serves else ""
            words = f"turns {', '.join(turns)}; {QUASI_STATIC}" if turns else serves
        device = cut.device.full_name if people else cut.device.kind
        value = cut.device.value_words if people else cut.device.short
        ends = cut.margin_pass / MM, _fails_by(study, cut, earlier) / MM, cut.smallest.text, cut.largest.text
        rows.append((device, value, *ends, words))
    names = ("device", "value", *margins, "smallest_cut", "largest_cut", "returns")
    return Frame.of_cells(names, rows).headed({name: ColumnHead.of_name(name, "mm") for name in margins})


def _with_earlier(cuts: Sequence[Cut]) -> Iterator[tuple[Cut, set[str]]]:
    """Yield each cut with the names of what those before it return."""
    earlier: set[str] = set()
    for cut in cuts:
        yield cut, set(earlier)
        earlier |= {*cut.returns}


def _fails_by(study: ToolingStudy, cut: Cut, earlier: Collection[str]) -> float:
    """By how much [m] the nearest fails of those that a cut returns, also of those it returns too narrowly.

    What the bare track or an earlier cut returns does not count. Behind rails, and where it has to return
    none, it is the cut's own number.
    """
    design = study.design
    if design is None or not np.isfinite(cut.margin_reject):
        return cut.margin_reject
    if any(device.action is Action.HANG for device in design.devices):
        return cut.margin_reject
    margins = margins_at(cut.device, study.orientations)
    own = [
        -float(margin)
        for one, margin in zip(study.orientations, margins, strict=True)
        if one.name in cut.returns and one.name not in earlier and not one.returned and -margin > SURE_M
    ]
    return min([cut.margin_reject, *own])


def remarks(study: ToolingStudy, efficiency: float = 0.0) -> list[str]:
    """Return what a reader should know: of one orientation first what becomes of it.

    Parameters
    ----------
    study : ToolingStudy
    efficiency : float [1], optional
        That is asked for, as for ``isolation_words``.

    Returns
    -------
    list of str
    """
    stopped, shares = [STOPPED] if study.partial else [], f"Orientation shares: {study.answer}"
    if study.design is None:
        return [*stopped, isolation_words(study, efficiency), shares]
    design, wanted_row = _asked_for(study)
    orientation, tried = study.orientations[wanted_row], study.trial_of(wanted_row)
    at_least = "at least " * (design.least < design.efficiency)
    pure_at_least = "at least " * bool(design.purity_is_least)
    as_what = "so" if study.leaves_as == orientation.name else study.leaves_as
    leave = (
        f"{at_least}{100.0 * design.least:.3g} % of the parts offered leave {as_what}, {pure_at_least}"
        f"{100.0 * design.purity:.4g} % of what leaves"
    )
    if not design.efficiency > 0.0:
        leave = f"none of the parts offered leaves {as_what}"
    if tried is not None and tried.faults:
        lead = f"{orientation.name} is not isolated: {tried.verdicts}"
    elif tried is None:
        verb = "is" if study.isolates(wanted_row) else "is not"
        lead = f"{orientation.name} {verb} isolated by the static rule, no chain was tried: {leave}"
    else:
        lead = (
            f"{orientation.name} is isolated: of {tried.parts} parts tried {tried.figures}; "
            f"by the static rule {100.0 * design.efficiency:.3g} % of those offered leave {as_what}, "
            f"and {tried.verdict}"
        )
    reasons = list(design.reasons)
    if tried is not None and not tried.faults and not design.isolated:  # the trial has the last word
        reasons = [f"by the static rule: {reason}" for reason in reasons]
    cheaper = [
        f"no chain of {CLASS_NAMES[one]} held in {counted(n, 'trial')}" for one, n in study.in_vain if n
    ]
    if design.bank is not None:
        lead = f"{lead}; the track has to lean {np.degrees(design.bank):.3g} deg towards the wall"
    return [*stopped, lead, *cheaper, *filter(None, [next_class_words(study)]), *reasons, shares]


def trials(study: ToolingStudy) -> tuple[list[str], list[str]]:
    """Return what the trials of other chains, or of a table's best, said.

    Parameters
    ----------
    study : ToolingStudy

    Returns
    -------
    list of str, list of str
        Denied and confirmed, a sentence each.
    """
    sentences: tuple[list[str], list[str]] = [], []
    for trial in study.trials if study.design is None else study.trials[1:]:
        chain = "; ".join(trial.devices_words or trial.devices)
        lead = "" if study.design is None else f"tried as well, {chain}: "
        further = ""
        if study.design is None and trial.faults:
            further = f"; --aspect {study.orientations[trial.wanted].name} tries other chains"
        sentences[not trial.faults].append(f"{lead}{trial.sentence}{further}")
    return sentences


def isolation_words(study: ToolingStudy, efficiency: float = 0.0) -> str:
    """Say how many of the orientations that come often enough to matter can be isolated.

    Parameters
    ----------
    study : ToolingStudy
    efficiency : float [1], optional
        Designs of less do not count.

    Returns
    -------
    str
    """
    often = np.flatnonzero(study.shares >= LEAST_SHARE).tolist()
    designs = [(k, design) for k in often if (design := study.designs[k]) is not None]
    good = [study.isolates(k) and design.efficiency >= efficiency for k, design in designs]
    least = f" with an efficiency of {100.0 * efficiency:.3g} % or more" if efficiency > 0.0 else ""
    rarer = len(study.designs) - len(often)
    unsearched = len(often) - len(designs) if study.partial else 0
    apart = (
        f"{rarer} rarer not counted" if rarer else "",
        f"{unsearched} not searched" if unsearched else "",
    )
    left_out = f" ({', '.join(filter(None, apart))})" if any(apart) else ""
    come = f"in which {100.0 * LEAST_SHARE:g} % or more of the parts come"
    return f"{sum(good)} of {len(good)} orientations {come} can be isolated{least}{left_out}"


def passages(study: PassagesStudy) -> Frame:
    """Return the margin of each orientation at each device, and what becomes of it.

    Parameters
    ----------
    study : PassagesStudy

    Returns
    -------
    Frame
        A row for each orientation.
    """
    names = [orientation.name for orientation in study.orientations]
    table: Cells = {"orientation": names, "of all parts": study.shares}
    above = {"of all parts": share_head("of all parts")}
    for place, device in enumerate(study.devices):
        verdicts = [ridden[place].verdict if place < len(ridden) else None for ridden in study.passages]
        margins = [verdict.margin / MM if verdict and verdict.sure else None for verdict in verdicts]
        table[name := f"{device.kind} {place + 1}_mm"] = margins
        above[name] = ColumnHead.of_name(name, "mm")
    outcomes = table["outcome"] = []
    for orientation, ridden in zip(study.orientations, study.passages):
        if ridden and (last := ridden[-1]).verdict.passes <= 0.0:
            doubt = "" if last.verdict.sure else ", not sure"
            outcomes.append(f"{last.fate} by the {last.device.kind}{doubt}")
        else:
            outcomes.append(device_passages.passage_fate(orientation, ridden))
    return Frame.of(table, above)


def bowl_file(study: ToolingStudy, settings: Sequence[Setting]) -> str:
    """Return a bowl file with the devices of a tooling study.

    Parameters
    ----------
    study : ToolingStudy
        Of one orientation.
    settings : sequence of Setting
        That the user gave: they are kept.

    Returns
    -------
    str
    """
    design, wanted_row = _asked_for(study)
    tried, orientation, width = study.trial_of(wanted_row), study.orientations[wanted_row], design.width
    check_written(design.devices, "tooling.yaml")
    asked = {"width": width and in_mm(width), "bank": design.bank and f"{np.degrees(design.bank):.4g} deg"}
    track = {name: text for name, text in asked.items() if text}
    left_out = (DEVICES_SECTION, *(f"track.{name}" for name in track))
    own = [s for s in settings if s.is_own and s.key.field not in left_out]
    lines = [
        f"# Tooling that lets {orientation.name} leave.",
        f"# By the static rule: efficiency {'at least ' * (design.least < design.efficiency)}"
        f"{100.0 * design.least:.4g} %, purity {'at least ' * bool(design.purity_is_least)}"
        f"{100.0 * design.purity:.4g} %, by {study.answer}.",
    ]
    if study.partial:
        lines.append(f"# {STOPPED[0].upper()}{STOPPED[1:]}.")
    if tried is None:
        lines.append("# By the static rule, not tried: see feeder trial.")
    elif tried.faults:  # the first thing to know of a design that its trial denies
        lines.append(f"# DENIED by its trial: {'; '.join(texts.fault_texts(tried.faults))}.")
    else:
        lines.append(f"# Of {tried.parts} parts tried {tried.figures}.")
    sections: dict[str, list[str]] = {s.key.section: [] for s in own if s.key.section}
    if track:
        sections["track"] = [f"  {name}: {text}  # as the design asks for" for name, text in track.items()]
    lines += settings_lines(own, sections)
    lines += [f"{DEVICES_SECTION}:  # along the track, in the order parts meet them"]
    strip = lay_out(study.bowl.track, design.devices, study.orientations)
    for device, shop in zip(design.devices, tooling_drawing.shop_comments(strip, design.devices)):
        words = [QUASI_STATIC * device.action.turns, shop]
        lines += [f"  - {device.kind}: {value_text(device)}{comment(*words)}"]
    return "\n".join(lines) + "\n"


def comment(*words: str) -> str:
    """Return words as a comment behind a line of a bowl file; '' without words.

    Parameters
    ----------
    *words : str
        Empty ones are left out.

    Returns
    -------
    str
    """
    said = "; ".join(each for each in words if each)
    return f"  # {said}" if said else ""


def settings_lines(settings: Sequence[Setting], sections: Mapping[str, Sequence[str]]) -> list[str]:
    """Return lines of a bowl file.

    Parameters
    ----------
    settings : sequence of Setting
        Written as they were.
    sections : mapping of str to sequence of str
        A section's own lines, which stand below its settings.

    Returns
    -------
    list of str
    """
    lines = [f"{s.key.word}: {s.text}" for s in settings if not s.key.section]
    for section in dict.fromkeys((*sections, *(s.key.section for s in settings if s.key.section))):
        lines += [f"{section}:", *(f"  {s.key.word}: {s.text}" for s in settings if s.key.section == section)]
        lines += sections.get(section, ())
    return lines


def offers(
    study: ToolingStudy,
    settings: Sequence[Setting],
    step: bool = False,
    mark: str = "",
    fields: marking.SheetFields | None = None,
) -> list[offer.Offer]:
    """Offer the files of a tooling study: table, document and picture.

    Of one orientation with devices that isolate it the bowl file and the drawings as well; of a run that was
    stopped no drawings.

    Parameters
    ----------
    study : ToolingStudy
    settings : sequence of Setting
        Of its bowl.
    step : bool, optional
        Whether the section of track is offered as STEP too, which needs OpenCASCADE.
    mark : str, optional
        Stands on every drawing, picture and solid.
    fields : SheetFields, optional
        Date and revision of the drawing.

    Returns
    -------
    list of Offer
    """
    what = "Orientations and what isolates them"
    files = [offer.table("tooling.csv", frame, study), offer.document("tooling.json", document, study)]
    if study.design is None or not study.design.devices:
        words = isolation_words(study)
        drawn = offer.picture("tooling.png", what, lambda: tooling_figures.limits(study, words))
        return marking.pictures([*files, drawn], mark)
    design, wanted_row = _asked_for(study)
    devices, chain = (
        design.devices,
        (design.devices, study.orientations, study.shares, wanted_row, study.left_in_trial),
    )

    if study.partial:
        drawn = offer.picture("tooling.png", what, lambda: tooling_figures.chain(*chain))
        files += [drawn, offer.text("tooling.yaml", bowl_file, study, settings)]
        return marking.pictures(files, NOT_PROVED.upper())

    def section() -> TooledTrack:
        return lay_out(study.bowl.track, devices, study.orientations)

    files += [
        offer.picture("tooling.png", what, lambda: tooling_figures.chain(*chain)),
        offer.text("tooling.yaml", bowl_file, study, settings),
        offer.text("tooling.dxf", _draw_section, "dxf", study, section, mark, fields),
        offer.text("tooling.svg", _draw_section, "svg", study, section, mark, fields),
        offer.text(marking.file_name("tooling.stl", mark), lambda: solid_files.section_stl(section(), mark)),
    ]
    if step:
        files.append(offer.text(marking.file_name("tooling.step", mark), _step, section, mark))
    placed = [device for device in devices if device.action.has_place]
    seen = {device.features(study.bowl.track, study.orientations).seen_from for device in placed}
    if seen - {"", "turned"}:  # a cut to see
        files.append(solid_picture(*chain))
    return marking.pictures(files, mark)


def chain_picture(
    devices: Sequence[Device], orientations: Sequence[Orientation], shares: Floats
) -> offer.Offer:
    """Offer the picture of a bowl's own devices.

    Parameters
    ----------
    devices : sequence of Device
    orientations : sequence of Orientation
        M of them.
    shares : (M,) array [1]
        In which they come.

    Returns
    -------
    Offer
    """
    alt = "Each orientation where each device supports it least"
    return offer.picture("tooling.png", alt, lambda: tooling_figures.chain(devices, orientations, shares))


def solid_picture(
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted_row: int,
    left_in_trial: Collection[str] = (),
) -> offer.Offer:
    """Offer the picture of a part over the cuts, in three dimensions.

    Parameters
    ----------
    devices : sequence of Device
    orientations : sequence of Orientation
        M of them.
    shares : (M,) array [1]
        In which they come.
    wanted_row : int
    left_in_trial : collection of str
        Names of orientations of which a part left in a trial.

    Returns
    -------
    Offer
    """
    alt = "The part over the cut: what passes, and the nearest that falls"
    chain = devices, orientations, shares, wanted_row, left_in_trial
    return offer.picture("tooling_3d.png", alt, lambda: tooling_views.figure(*chain))


def _draw_section(
    kind: str,
    study: ToolingStudy,
    section: Callable[[], TooledTrack],
    mark: str,
    fields: marking.SheetFields | None,
) -> str | bytes:
    """The drawing as 'dxf' or 'svg', with the outline of the part before the devices and at each."""
    strip, ghosts = section(), []
    comes, *at_devices = _poses_along(study, [placed.device for placed in strip.devices])
    places = [(placed.start + 0.5 * placed.length, pose) for placed, pose in zip(strip.devices, at_devices)]
    shown = [place for placed, place in zip(strip.devices, places) if not placed.openings]
    for place, pose in ((0.6 * comes.length, comes), *shown):
        ghosts.append((np.add(pose.outline, [0.0, pose.distance]), place))
    titles = [("tooling for", study.part.name), ("leaves as", study.leaves_as)]
    look = {"thickness": study.bowl.sizing.sheet, "fields": fields, "titles": titles}
    return getattr(tooling_drawing, kind)(strip, ghosts, mark, **look)


def _poses_along(study: ToolingStudy, devices: Sequence[Device]) -> list[Orientation]:
    """How a part that leaves as it is wanted lies: as it comes, and at each device.

    It comes in the orientation of which most become the wanted one. On a track that has twisted it is shown
    as it came there: it has turned with floor and wall, along which all is drawn.
    """
    _, wanted_row = _asked_for(study)
    every, flow = study.orientations, course(devices, study.orientations)
    becomes = study.shares * flow.leaving[:, flow.leaves_as(wanted_row)]
    if not becomes[wanted_row] > 0.0 and becomes.any():
        wanted_row = int(np.argmax(becomes))
    poses = [every[wanted_row]]
    for passage in device_passages.until_returned(devices, every[wanted_row], every):
        poses.append(poses[-1] if passage.orientation.at_inner_wall else passage.orientation)
    return poses + [poses[-1]] * (1 + len(devices) - len(poses))


def _step(section: Callable[[], TooledTrack], mark: str) -> bytes:
    from feederscrew.cad.exact import exact_file

    strip = section()
    return marking.mark_step(exact_file.section_file(strip), mark, tooling_drawing.shop_names(strip))


TOOLING_VIEW = RecordView(
    tooling_text,
    lambda study: offers(study, ()),
    "tooling",
    lambda study: offers(study, settings_of(study.bowl)),  # with a bowl file that says what its bowl is
)
