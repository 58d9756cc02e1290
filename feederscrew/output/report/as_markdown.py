"""A report as Markdown."""

from feederscrew.output.report import blocks as kinds
from feederscrew.output.report.blocks import cells

BESIDE = "report"  # folder of the pictures, beside the text


def markdown(page):
    """The page as Markdown, without 3-D.

    Parameters
    ----------
    page : Page

    Returns
    -------
    str
    """
    tiles = [f"- {tile.label} **{_plain(tile.value)}**: {_plain(tile.note)}" for tile in page.tiles]
    warnings = [f"- {_plain(line)}" for line in page.warnings]
    parts = [f"# {_plain(page.title)}", _plain(page.subtitle), "\n".join(tiles)]
    if warnings:
        parts += ["**To watch**", "\n".join(warnings)]
    for section in page.sections:
        parts += [f"## {section.title}", *(_block(block) for block in section.blocks)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _block(block):
    match block:
        case kinds.Text(text):
            return _plain(text)
        case kinds.Notes(lines):
            return "\n".join(f"- {_plain(line)}" for line in lines)
        case kinds.Code(text):
            return f"```sh\n{text}\n```"
        case kinds.Table(frame):
            return _table(frame)
        case kinds.Sheet(file):
            return f"[{file}]({BESIDE}/{file})"
        case kinds.Picture(file, _, alt):
            return f"![{alt}]({BESIDE}/{file})"
        case kinds.Views():
            return ""
    raise ValueError(f"{type(block).__name__} is no block of a report")


def _table(frame):
    heads, numeric, rows = cells(frame)
    lines = [
        [f"{name} {unit}".strip() for name, unit in heads],
        ["---:" if n else "---" for n in numeric],
        *rows,
    ]
    return "\n".join(f"| {' | '.join(_plain(cell) for cell in line)} |" for line in lines)


def _plain(text):
    """Text that Markdown takes as it is."""
    for mark in "\\|_*<`":
        text = text.replace(mark, f"\\{mark}")
    return text
