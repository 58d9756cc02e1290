"""The chapters of a report in their order; one that cannot be computed says why."""

import gc
from contextlib import nullcontext
from dataclasses import replace

from feederscrew import __version__
from feederscrew.errors import FeederError
from feederscrew.output.page.blocks import Chapter, Notes, Page
from feederscrew.output.report import closing, cutting, driving, moving, resting

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
    ("limits", "Limitations", closing.limits),
    ("repeat", "Reproducibility", closing.repeat),
)


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
            found = compute(case)
    except FeederError as fault:
        listed = tuple(f"{title}: {line}" for line in fault.lines)
        found = Chapter((Notes(fault.lines, loud=True),), warnings=listed)
    gc.collect()  # figures hold themselves: they would pile up
    return None if found is None else replace(found, anchor=anchor, title=title)
