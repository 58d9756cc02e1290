"""A page as Markdown."""

from feederscrew.output.page import blocks as kinds
from feederscrew.output.page.as_html import WHERE_WORDS, texts_of

ITALIC = "given"  # the mark of a cell that was not computed


def markdown(page: kinds.Page, folder: str = "") -> str:
    """Return a page as Markdown, without 3-D.

    Parameters
    ----------
    page : Page
    folder : str, optional
        Where its pictures and tables are: 'report/', or ''.

    Returns
    -------
    str
    """
    tiles = [f"- {tile.label} **{_plain(tile.value)}**: {_plain(tile.note)}" for tile in page.tiles]
    parts = [f"# {_plain(page.title)}", _plain(page.subtitle), "\n".join(tiles)]
    if page.warnings:
        parts += ["**To watch**", "\n".join(f"- {_plain(line)}" for line in page.warnings)]
    for section in page.sections:
        parts += [f"## {section.title}" if section.title else ""]
        parts += [_block(block, folder) for block in section.blocks]
        parts += ["\n".join(f"- {_plain(line)}" for line in section.details)]
    parts += [WHERE_WORDS] if any(section.title for section in page.sections) else []
    return "\n\n".join(part for part in parts if part) + "\n"


def _block(block: kinds.Block, folder: str) -> str:
    match block:
        case kinds.Text(text):
            return _plain(text)
        case kinds.Notes(lines):
            return "\n".join(f"- {_plain(line)}" for line in lines)
        case kinds.Code(text):
            return f"```sh\n{text}\n```"
        case kinds.Folded(title, text):
            return f"{_plain(title)}\n\n```\n{text.rstrip()}\n```"
        case kinds.Table(frame):
            heads, numeric, columns = texts_of(frame)
            names = [f"{name} {unit}".strip() for name, unit in heads]
            grid = [names, ["---:" if number else "---" for number in numeric], *zip(*columns)]
            return "\n".join(f"| {' | '.join(map(_plain, line))} |" for line in grid)
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
            cells = [
                [f"*{_plain(cell.text)}*" if cell.mark == ITALIC else _plain(cell.text) for cell in row]
                for row in rows
            ]
            return "\n".join(f"| {' | '.join(line)} |" for line in (heads, ["---"] * len(heads), *cells))
    raise ValueError(f"{type(block).__name__} is not a block of a page")


def _plain(text: str) -> str:
    for mark in "\\|_*<`":
        text = text.replace(mark, f"\\{mark}")
    return text
