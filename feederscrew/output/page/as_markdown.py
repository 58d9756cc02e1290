"""A page as Markdown."""

from feederscrew.output.page import blocks as kinds
from feederscrew.output.page.numbers import cells

ITALIC = "given"  # the mark of a cell that was not computed


def markdown(page, folder="") -> str:
    """Write a page as Markdown, without 3-D.

    Parameters
    ----------
    page : Page
    folder : str
        Folder of the pictures and tables, beside the text: 'report/', or '' for the same folder.

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
        title = f"## {section.title}" if section.title else ""
        parts += [title, *(_block(block, folder) for block in section.blocks)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _block(block, folder):
    match block:
        case kinds.Text(text):
            return _plain(text)
        case kinds.Notes(lines):
            return "\n".join(f"- {_plain(line)}" for line in lines)
        case kinds.Code(text):
            return f"```sh\n{text}\n```"
        case kinds.Table(frame):
            return _table(frame)
        case kinds.CsvSheet(file):
            return f"[{file}]({folder}{file})"
        case kinds.Picture(file=file, alt=alt):
            return f"![{alt}]({folder}{file})"
        case kinds.Views() | kinds.Knobs():
            return ""
        case kinds.Heading(text, anchor):
            return (f'<a id="{anchor}"></a>\n\n' if anchor else "") + f"### {text}"
        case kinds.Links(entries):
            return "\n".join(f"- [{label}](#{anchor}): {text}" for anchor, label, text in entries)
        case kinds.Matrix(heads, rows, _):
            grid = [heads, ["---"] * len(heads), *([_entry(entry) for entry in row] for row in rows)]
            return "\n".join(f"| {' | '.join(cells)} |" for cells in grid)
    raise ValueError(f"{type(block).__name__} is not a block of a page")


def _entry(entry):
    text = _plain(entry.text)
    return f"*{text}*" if entry.mark == ITALIC else text


def _table(frame) -> str:
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
