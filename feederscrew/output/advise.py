"""Files of ``feeder advise``: the grade of a part, its reasons, and its changes before and after."""

import re

import numpy as np

from feederscrew.base.columns import Column, Document, Frame, of_records, values
from feederscrew.base.units import MINUTE
from feederscrew.designing.advice import CLASS_WORDS, AdviceStudy, ChangedPart, Reason, Way
from feederscrew.output import offers as offer
from feederscrew.output import poses, solid_files
from feederscrew.output.offers import RecordView
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import (
    Block,
    Chapter,
    Heading,
    MarkedCell,
    Matrix,
    Notes,
    Page,
    Picture,
    Table,
    Text,
    Tile,
)
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.posture import posture

GAINS = {True: "easier to feed", False: "no gain"}
SHOWN = 3  # changes with pictures of before and after, at least those that were tried
DRAWN_NAME = re.compile(r"(?P<aspect>[^@]+)@")

REASON_COLUMNS: tuple[Column[Reason], ...] = (
    Column("reason", lambda reason: reason.kind),
    Column("grades_less", lambda reason: reason.steps),
    Column("because", lambda reason: reason.text),
)
WAY_COLUMNS: tuple[Column[Way], ...] = (
    Column("class", lambda way: way.cost_class),
    Column("arrives_as", lambda way: way.orientation),
    Column("leaves_as", lambda way: way.leaves_as),
    Column("lies", lambda way: way.lies),
    Column("chain", lambda way: ", ".join(device.kind for device in way.devices) or "none"),
    Column("yield", lambda way: way.efficiency, "share"),
    Column("purity", lambda way: way.purity, "share"),
    Column("rate_per_minute", lambda way: way.rate, "1/min"),
    Column("tried", lambda way: way.is_tried),
)
CHANGE_COLUMNS: tuple[Column[ChangedPart], ...] = (
    Column("change", lambda changed: changed.change.text),
    Column("kind", lambda changed: changed.change.kind, hidden=True),
    Column("size_mm", lambda changed: changed.change.size, "mm", hidden=True),
    Column("volume_share", lambda changed: changed.change.share, "share", hidden=True),
    Column("gains", lambda changed: changed.gains),
    Column("tried", lambda changed: changed.is_tried),
    Column("grade", lambda changed: changed.grade),
    Column("class", lambda changed: changed.way and changed.way.cost_class),
    Column("yield", lambda changed: changed.way and changed.way.efficiency, "share"),
    Column("rate_per_minute", lambda changed: changed.way and changed.way.rate, "1/min"),
    Column("class_before", lambda changed: changed.before and changed.before.cost_class),
    Column("rate_before_per_minute", lambda changed: changed.before and changed.before.rate, "1/min"),
)


def summary(study: AdviceStudy) -> Frame:
    """Return what is printed: the changes that gain or were tried; without one the reasons of the grade."""
    told = [changed for changed in study.changes if changed.gains or changed.is_tried]
    return of_records(CHANGE_COLUMNS, told) if told else of_records(REASON_COLUMNS, study.reasons)


def document(study: AdviceStudy) -> Document:
    """Return an AdviceStudy as the JSON document."""
    return {
        "part": study.part.name,
        "answer": study.aspects.source(study.aspects.ranking),
        "grade": study.grade,
        "way": None if study.way is None else values(WAY_COLUMNS, study.way),
        "reasons": of_records(REASON_COLUMNS, study.reasons),
        "changes": of_records(CHANGE_COLUMNS, study.changes),
        "partial": study.partial,
    }


def remarks(study: AdviceStudy) -> list[str]:
    """Return what is said above the table: the grade, its reasons, and what the best changes bring."""
    lines = [f"{study.part.name}: {study.answer}"]
    lines += [_reason_text(reason) for reason in study.reasons]
    were_tried = any(changed.is_tried for changed in study.changes)
    best = [changed.text for changed in study.changes if changed.gains and changed.is_tried is were_tried]
    if not best and study.changes:
        judged = "that was tried" if were_tried else "of its shape, by the static rule,"
        best = [f"no change {judged} makes it easier"]
    told = [changed.is_tried for changed in study.changes if changed.gains or changed.is_tried]
    if len(set(told)) == 2:
        best = [
            *best[:SHOWN],
            "changes that were not tried stand beside the part by the same rule, untried too",
        ]
    return lines + best[: SHOWN + 1]


def _reason_text(reason: Reason) -> str:
    less = f" ({reason.steps} grade{'s' * (reason.steps > 1)} less)" if reason.steps else ""
    return f"{reason.text}{less}"


def offers(study: AdviceStudy) -> list[offer.Offer]:
    """Offer the files of an AdviceStudy: numbers, the page, and each changed part that was tried as STL."""
    shown = _shown(study)
    return [
        offer.document("advice.json", document, study),
        offer.table("changes.csv", of_records, CHANGE_COLUMNS, study.changes),
        *(
            offer.text(f"change_{number}.stl", _stl, changed.part)
            for number, changed in enumerate(shown, start=1)
        ),
        offer.text("advice.html", page, study),
    ]


def _shown(study: AdviceStudy) -> tuple[ChangedPart, ...]:
    tried = tuple(changed for changed in study.changes if changed.is_tried)
    return tried or tuple(changed for changed in study.changes if changed.gains)[:SHOWN]


def _stl(part: Part) -> bytes:
    corners = np.asarray(part.vertices)[np.asarray(part.faces)]
    return solid_files.binary_stl(corners, part.name)


def page(study: AdviceStudy) -> str:
    """Return the page of an AdviceStudy as HTML that needs no other file.

    Parameters
    ----------
    study : AdviceStudy

    Returns
    -------
    str
    """
    way = study.way
    tiles = (
        Tile("grade", study.grade, "A is steel alone and most parts right, E is no way found"),
        Tile("class", "-" if way is None else CLASS_WORDS[way.cost_class], "the cheapest that isolates"),
        Tile("come right", "-" if way is None else f"{100.0 * way.efficiency:.3g} %", "of the parts"),
        Tile(
            "parts per minute", "-" if way is None else f"{MINUTE * way.rate:.3g}", "in this bowl, one track"
        ),
    )
    blocks: list[Block] = [Notes(tuple(_reason_text(reason) for reason in study.reasons))]
    chapters = [Chapter(tuple(blocks), tiles, study.warnings, "answer", "How hard it is to feed")]
    tried = "Those that gain most by it are tried with parts of true shape."
    if not any(changed.is_tried for changed in study.changes):
        tried = "None of them was tried with parts of true shape."
    changes: list[Block] = [
        Text(
            f"Each change is made on the mesh, and the part that has it is judged by the static rule. {tried}"
        )
    ]
    for number, changed in enumerate(_shown(study), start=1):
        former = _cell(study.part, study.aspects, changed.before, f"before_{number}")
        now = _cell(changed.part, find(changed.part), changed.way, f"after_{number}")
        changes += [
            Heading(f"{number}. {changed.change.text}"),
            Text(f"{changed.outcome}: {GAINS[changed.gains]}."),
            Matrix(("as it is", "changed"), ((former, now),)),
        ]
    if study.changes:
        changes += [Heading("All changes"), Table(of_records(CHANGE_COLUMNS, study.changes))]
        chapters.append(Chapter(tuple(changes), anchor="changes", title="What would make it easier"))
    seen = [] if way is None else [(way.orientation, "arrives so")]
    return html(
        Page(
            study.part.name,
            f"advice on a part: grade {study.grade}",
            tuple(chapters),
            "advice",
            poses.opening(study.part, study.aspects, seen),
            poses.pose_finder(study.part, study.aspects),
        )
    )


def _cell(part: Part, aspects: Aspects, way: Way | None, name: str) -> MarkedCell:
    """A picture of a part as its way has it arrive, and what the way brings."""
    found = None if way is None else DRAWN_NAME.match(way.orientation)
    if way is None or found is None or found["aspect"] not in aspects.names:
        return MarkedCell("no way was found")
    drawn = poses.picture(posture(part, aspects, found["aspect"]), way.heading)
    return MarkedCell(way.text, picture=Picture(f"{name}.png", drawn, f"{part.name}, {way.orientation}"))


ADVICE_VIEW = RecordView(lambda study: f"{study.part.name}: {study.answer}", offers, "advise")
