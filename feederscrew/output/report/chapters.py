"""The chapters of a report in their order, its limits, how to repeat it, and its files."""

import gc
import platform
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

from feederscrew import __version__
from feederscrew import bowl as bowls
from feederscrew.errors import FeederError
from feederscrew.output import slide, tables
from feederscrew.output.folder import LIBRARIES
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import Chapter, Code, CsvSheet, Notes, Page, Picture, Table, Text
from feederscrew.output.report import cutting, driving, moving, resting

CHANGED = "The bowl: the values that are not the default."
DEFAULTS = "The bowl: the values by default."
METHOD_LIMITS = (
    "How often a part lands on an aspect: the rules compute from the part's shape and mass alone; only "
    "p_recommended knows how the part is launched, and none considers other parts. They disagree, "
    "and on real parts each is right in some cases only. The interval of p_recommended holds for the launch "
    "it names. Where much depends on it, drop the part a few hundred times and let your own counts decide "
    "(feeder compare).",
    "The part is rigid and, unless its centre of mass was given, homogeneous. A mesh is a polyhedron: its "
    "curved sides are a little smaller than the part's. Two aspects that are mirror images have the same "
    "numbers.",
    "Friction is Coulomb's, with one static and one kinetic value. The limits of slip and hop are exact "
    "for that model; the coefficients are yours to measure, and velocity depends on them more than on "
    "anything else.",
    "The velocity is of a point mass on the track: tipping, turning and the push of the parts behind are "
    "left out. A flight ends in an impact with one coefficient of restitution.",
    "Forces on the floor and on the track are of one part alone, of the rigid body at each instant of the "
    "drive, as long as it keeps contact; what it does after it lifts off is not followed.",
    "The rate counts parts one behind the other with the gap given. A returned part is taken to land again "
    "like a fresh one; parts do not help or hinder each other at the devices.",
)


def limits_of_methods(case) -> Chapter:
    """What the methods leave out, in plain words."""
    return Chapter((Notes(METHOD_LIMITS),))


def how_to_repeat(case) -> Chapter:
    """The inputs: command, files, bowl values, versions, and the table of aspects to the last digit."""
    hashes = tables.frame({"input": list(case.inputs), "sha256": list(case.inputs.values())})
    return Chapter(
        (
            *((Code(case.command),) if case.command else ()),
            Text("The same program and inputs give this page again, byte for byte."),
            Table(hashes),
            Text(f"Versions: {', '.join(map(' '.join, _versions()))}."),
            *_bowl_values(case),
            Text("The aspects to six digits, as feeder aspects writes them."),
            resting.numbers(case),
        ),
    )


def _bowl_values(case) -> Iterator[Any]:
    """The values of the bowl that are not the default; on a screen the others as well."""
    usual = {setting.key.name: setting.text for setting in bowls.settings()}
    for is_changed, lead in ((True, CHANGED), (False, DEFAULTS)):
        chosen = [
            setting
            for setting in case.settings
            if (setting.is_own and setting.text != usual.get(setting.key.name)) == is_changed
        ]
        if chosen:
            frame = slide.settings(chosen).only(("key", "value", "from", "meaning"))
            files = [Path(origin).name for origin in frame["from"]]  # the inputs have their folders
            frame = tables.frame({name: files if name == "from" else frame[name] for name in frame})
            yield Text(lead, printed=is_changed)
            yield Table(frame, printed=is_changed)
    yield Text("A key that is not listed has its default (feeder config show).")


def _versions() -> Iterator[Any]:
    yield "feeder", __version__
    yield "python", platform.python_version()
    for name in LIBRARIES:
        yield name, metadata.version(name)


CHAPTERS = (  # anchor, title, what computes it
    ("aspects", "How it comes to rest", resting.aspects),
    ("tipping", "How it tips", resting.tips),
    ("headings", "How it lies along the wall", moving.headings),
    ("velocity", "How fast it travels", moving.convey),
    ("rate", "How many leave a minute", moving.rate),
    ("tooling", "Which orientations the devices return", cutting.tooling),
    ("trial", "What parts did that were sent through", cutting.trial),
    ("bowl", "The bowl and its drive", driving.bowl),
    ("track", "On the track, against the wall", moving.track),
    ("floor", "On the bowl floor", moving.floor),
    ("slip", "When a part slips", moving.slide),
    ("part", "The part", resting.the_part),
    ("limits", "Limitations", limits_of_methods),
    ("repeat", "Reproducibility", how_to_repeat),
)
FORMATS = ("html", "md")
BESIDE = "report/"  # folder of the pictures, beside the text


def page(case, step=nullcontext, chapters=CHAPTERS) -> Page:
    """Everything known of a part in a bowl.

    Parameters
    ----------
    case : ReportStudy
    step : callable
        Of a title; gives a context manager round the computation of that chapter.
    chapters : sequence
        Those wanted, rows of ``CHAPTERS``.

    Returns
    -------
    Page
    """
    part, bowl = case.part, case.path or "the default bowl"
    sections = (_chapter(case, anchor, title, compute, step) for anchor, title, compute in chapters)
    listed = tuple(section for section in sections if section is not None)
    return Page(part.name, f"{part.material}, in {bowl} · feeder {__version__}", listed, "report")


def _chapter(case, anchor, title, compute, step):
    """The chapter, or the reason there is none; None where it was not asked for."""
    try:
        with step(title):
            chapter = compute(case)
    except FeederError as fault:
        listed = tuple(f"{title}: {line}" for line in fault.lines)
        chapter = Chapter((Notes(fault.lines, loud=True),), warnings=listed)
    gc.collect()  # figures hold themselves: they would pile up
    return None if chapter is None else replace(chapter, anchor=anchor, title=title)


def write(folder, page, format) -> None:
    """Write one HTML file, or Markdown with its pictures beside it.

    Parameters
    ----------
    folder : ResultFolder
    page : Page
    format : str
        ``'html'`` or ``'md'``.
    """
    if format == "html":
        folder.write("report.html", html(page))
        return
    folder.write("report.md", markdown(page, BESIDE))
    for section in page.sections:
        for block in section.blocks:
            if isinstance(block, Picture):
                folder.write(f"{BESIDE}{block.file}", block.content)
            elif isinstance(block, CsvSheet):
                folder.write(f"{BESIDE}{block.file}", block.csv)
