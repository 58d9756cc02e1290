"""The page of `thesis_page` as Markdown and as one HTML file that needs no other."""

import base64
from html import escape

from feederscrew.output.thesis.page import VERDICT_CLASSES, Bullets, Grid, Heading, Paragraph, Picture
from feederscrew.thesis.cells import GIVEN

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #22303c; max-width: 60rem; margin: 2rem auto;
  padding: 0 1rem; }
h1, h2, h3 { line-height: 1.25; }
h2 { margin-top: 3rem; border-bottom: 1px solid #d5dbe1; }
h3 { margin-top: 2rem; }
table { border-collapse: collapse; margin: 1rem 0; font-size: 0.9rem; display: block; overflow-x: auto; }
th, td { padding: 0.2rem 0.7rem; border-bottom: 1px solid #d5dbe1; text-align: left; vertical-align: top; }
th { border-bottom: 2px solid #22303c; }
td { font-variant-numeric: tabular-nums; }
td:first-child { white-space: nowrap; }
.explained { background: #fdf3dc; }
.differs { background: #f7d6c8; font-weight: bold; }
.given { color: #6b7682; font-style: italic; }
img { max-width: 100%; }
a { color: #0072b2; }
"""


def markdown(blocks):
    """The page as Markdown, its pictures beside it.

    Parameters
    ----------
    blocks : sequence of block
        From `thesis_page.blocks`.

    Returns
    -------
    str
    """
    return "\n\n".join(_markdown(block) for block in blocks) + "\n"


def html(blocks, pictures):
    """The page as one HTML file, its pictures inside.

    Parameters
    ----------
    blocks : sequence of block
        From `thesis_page.blocks`.
    pictures : dict of str to bytes
        PNG by file name.

    Returns
    -------
    str
    """
    title = escape(next(block.text for block in blocks if isinstance(block, Heading)))
    head = (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
    )
    return head + "\n".join(_html(block, pictures) for block in blocks) + "\n</body>\n</html>\n"


def _markdown(block):
    match block:
        case Heading(level, text, anchor):
            mark = f'<a id="{anchor}"></a>\n\n' if anchor else ""
            return f"{mark}{'#' * level} {text}"
        case Paragraph(text):
            return text
        case Bullets(entries):
            return "\n".join(f"- [{label}](#{anchor}): {text}" for anchor, label, text in entries)
        case Grid(heads, rows):
            lines = [_row(heads), _row("---" for _ in heads)]
            return "\n".join(lines + [_row(_cell(*cell) for cell in row) for row in rows])
        case Picture(file, alt):
            return f"![{alt}]({file})"


def _row(cells):
    return "| " + " | ".join(cells) + " |"


def _cell(text, verdict):
    text = text.replace("|", "\\|").replace("_", "\\_")
    return f"*{text}*" if verdict == GIVEN else text


def _html(block, pictures):
    match block:
        case Heading(level, text, anchor):
            mark = f' id="{escape(anchor)}"' if anchor else ""
            return f"<h{level}{mark}>{escape(text)}</h{level}>"
        case Paragraph(text):
            return f"<p>{escape(text)}</p>"
        case Bullets(entries):
            lines = [f'<li><a href="#{escape(a)}">{escape(b)}</a>: {escape(c)}</li>' for a, b, c in entries]
            return "<ul>\n" + "\n".join(lines) + "\n</ul>"
        case Grid(heads, rows):
            head = "".join(f"<th>{escape(text)}</th>" for text in heads)
            body = "\n".join(f"<tr>{''.join(_html_cell(*cell) for cell in row)}</tr>" for row in rows)
            return f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"
        case Picture(file, alt):
            data = base64.b64encode(pictures[file]).decode()
            return f'<p><img src="data:image/png;base64,{data}" alt="{escape(alt)}"></p>'


def _html_cell(text, verdict):
    mark = f' class="{VERDICT_CLASSES[verdict]}"' if verdict else ""
    return f"<td{mark}>{escape(text)}</td>"
