"""A page as one HTML file that needs no other: style, viewer, mesh and pictures are inside."""

import base64
import csv
import io
import json
import re
import struct
from collections.abc import Iterator
from html import escape as html_escape
from importlib import resources
from itertools import groupby
from typing import Any

from feederscrew.errors import printable
from feederscrew.output import DPI, tables
from feederscrew.output.page import blocks as kinds
from feederscrew.output.page.numbers import NOTHING, cells

POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
LINKED_PICTURES = " 'self' file:"  # what the policy of a page allows as well whose pictures lie beside it
CSS_DPI = 96  # pixels of a page to the inch
HALF = 700  # [px] a broader picture is not put beside another
NARROW = 6  # columns of a table that is put beside something else
MANY = 10  # columns of a table that is printed in smaller letters
UNEVEN = 1.5  # times the height of a column: the other is so high that its table stands above both
PAIRS = 8  # rows from which a table of two columns that stands alone is set in two halves
ALONE = 1.4  # times the size of a picture that has the whole width
TALL = 1.5  # times its width: the height from which a picture has a page of paper to itself
SCREEN = 360  # [px] of a telephone: a broader picture scrolls there, and says so
BROAD = 1000  # [px] width from which a picture that is high as well takes half a page of paper
LINE, HEADING = 29, 70  # [px] about the height of a row of a table, and of its head
SCRIPTS = ("three.js", "viewer.js")
HINT = (
    "Drag a view to turn it, or use the arrow keys; double-click sets it back. "
    "Orange is the face it rests on, the dot its centre of mass."
)
PLAYED = (
    "Play runs the trial, in real time or, where it takes longer than ten seconds, faster; the bar goes to "
    "any moment. Drag a view to turn it, or use the arrow keys; double-click sets it back."
)
PLAYER = (
    '<span class="player"><button type="button" class="play">play</button> '
    '<input type="range" min="0" max="1" step="any" value="0" aria-label="moment of the trial"> '
    "<output>0.00 s</output></span>"
)
LICENCE = "three.LICENSE.txt"
SVG_SIZE = re.compile(rb'width="([\d.]+)pt" height="([\d.]+)pt"')


def html(page) -> str:
    """Return the page as HTML.

    Parameters
    ----------
    page : Page

    Returns
    -------
    str
    """
    all_blocks = [block for section in page.sections for block in section.blocks]
    views = any(isinstance(block, kinds.Views) for block in all_blocks)
    sortable = any(isinstance(block, kinds.Matrix) and block.sortable for block in all_blocks)
    knobs = any(isinstance(block, kinds.Knobs) for block in all_blocks)
    rows = (row for block in all_blocks if isinstance(block, kinds.Matrix) for row in block.rows)
    linked = any(entry.picture and entry.picture.link for row in rows for entry in row)
    policy = POLICY + LINKED_PICTURES * linked
    return "\n".join(
        [
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{escape(': '.join(filter(None, (page.title, page.kind))))}</title>",
            f"<style>\n{_asset('page.css')}</style>\n</head>\n<body>",
            _head(page),
            *(_section(section) for section in page.sections),
            *(_scripts() if views else ()),
            *((f"<script>\n{_asset('sorting.js')}</script>",) if sortable else ()),
            *((f"<script>\n{_asset('knobs.js')}</script>",) if knobs else ()),
            "</body>\n</html>\n",
        ]
    )


def escape(text: str) -> str:
    """Return a text as HTML, its lines kept, with an escape for every letter that is not printable."""
    return html_escape("\n".join(map(printable, text.split("\n"))))


def _asset(name):
    return resources.files("feederscrew.output.page").joinpath(name).read_text(encoding="utf-8")


def _scripts() -> Iterator[Any]:
    yield f"<!--\nThe 3-D views are drawn with three.js.\n\n{_asset(LICENCE)}-->"
    for name in SCRIPTS:
        yield f"<script>\n{_asset(name)}</script>"


def _head(page) -> str:
    tiles = "\n".join(
        f'<div class="tile"><span>{escape(tile.label)}</span><strong>{escape(tile.value)}</strong>'
        f"<small>{escape(tile.note)}</small></div>"
        for tile in page.tiles
    )
    titled = [section for section in page.sections if section.title]
    links = "\n".join(f'<a href="#{section.anchor}">{escape(section.title)}</a>' for section in titled)
    warnings = _list(page.warnings, "loud") if page.warnings else ""
    return (
        f"<header>\n<h1>{escape(page.title)}</h1>\n"
        + (f"<p>{escape(page.subtitle)}</p>\n" if page.subtitle else "")
        + (f'<div class="tiles">\n{tiles}\n</div>\n' if tiles else "")
        + f"{warnings}\n"
        + (f"<nav>\n{links}\n</nav>\n" if titled else "")
        + "</header>"
    )


def _section(section) -> str:
    body = "\n".join(_run(*run) for run in groupby(section.blocks, _may_share_row))
    anchor = f' id="{section.anchor}"' if section.anchor else ""
    title = f"<h2>{escape(section.title)}</h2>\n" if section.title else ""
    return f"<section{anchor}>\n{title}{body}\n</section>"


def _may_share_row(block):
    """Whether a block may stand beside another in a wide window: a picture or a small table."""
    if isinstance(block, kinds.Table):
        return len(block.frame) <= NARROW
    if not isinstance(block, kinds.Picture) or block.printed:
        return False
    width, height = _size(block)
    return width <= HALF and height <= TALL * width


def _run(in_columns, blocks) -> str:
    """Blocks that follow each other, in two columns of about the same height if they may be."""
    blocks = list(blocks)
    if not in_columns or len(blocks) == 1:
        return "\n".join(map(_block, blocks))
    heights = [_height(block) for block in blocks]
    first = min(range(1, len(blocks)), key=lambda k: max(sum(heights[:k]), sum(heights[k:])))
    if _pairs(blocks[0]) and len(blocks) > 2 and sum(heights[first:]) > UNEVEN * sum(heights[:first]):
        return f"{_block(blocks[0])}\n{_run(in_columns, blocks[1:])}"
    halves = ("\n".join(map(_in_column, half)) for half in (blocks[:first], blocks[first:]))
    return '<div class="beside">\n' + "\n".join(f"<div>\n{half}\n</div>" for half in halves) + "\n</div>"


def _in_column(block) -> str:
    return _picture(block) if isinstance(block, kinds.Picture) else _block(block)


def _height(block):
    """[px] about what a picture or a table takes in its column."""
    if isinstance(block, kinds.Picture):
        return _size(block)[1]
    return HEADING + LINE * max(map(len, block.frame.values()), default=0)


def _block(block) -> str:
    match block:
        case kinds.Text(text, quiet, printed):
            names = " ".join(name for name, holds in (("quiet", quiet), ("on-screen", not printed)) if holds)
            mark = f' class="{names}"' if names else ""
            return f"<p{mark}>{escape(text)}</p>"
        case kinds.Notes(lines, loud):
            return _list(lines, "loud" if loud else "notes")
        case kinds.Code(text):
            return f"<pre>{escape(text)}</pre>"
        case kinds.Table(frame, printed=printed):
            return _table(frame) if printed else f'<div class="on-screen">{_table(frame)}</div>'
        case kinds.Knobs():
            return _knobs(block)
        case kinds.CsvSheet(file, text, shown):
            return _sheet(file, text) if shown else _saved(file, text)
        case kinds.Picture():
            return _picture(block, 1.0 if block.printed else ALONE)
        case kinds.Views():
            return _views(block)
        case kinds.Heading(text, anchor):
            return f'<h3 id="{escape(anchor)}">{escape(text)}</h3>' if anchor else f"<h3>{escape(text)}</h3>"
        case kinds.Links(entries):
            return _links(entries)
        case kinds.Matrix(heads, rows, sortable):
            return _matrix(heads, rows, sortable)
    raise ValueError(f"{type(block).__name__} is not a block of a page")


def _picture(picture, scale=1.0) -> str:
    """The picture at its own size or smaller; one that stands alone is larger."""
    width, height = (round(scale * pixels) for pixels in _size(picture))
    kind = "stand-in" if picture.printed else "plain"
    kind += " scrolls" if width > SCREEN else ""
    kind += " tall" if height > TALL * width else " broad" if width > BROAD and height > 0.7 * width else ""
    return (
        f'<figure id="{picture.file}" class="{kind}"><img src="{_data(_kind(picture), picture.content)}" '
        f'width="{width}" height="{height}" style="--own: {width}px" alt="{escape(picture.alt)}"></figure>'
    )


def _kind(picture) -> str:
    return "image/svg+xml" if picture.file.endswith(".svg") else "image/png"


def _size(picture) -> list[Any]:
    """Width and height of a picture at its own size [px of a page]."""
    if picture.file.endswith(".svg"):
        size = SVG_SIZE.search(picture.content)
        if size is None:
            raise ValueError(f"{picture.file} says no size in points")
        return [float(points) * CSS_DPI / 72 for points in size.groups()]
    return [pixels * CSS_DPI / DPI for pixels in struct.unpack(">2I", picture.content[16:24])]


def _list(lines, mark) -> str:
    return f'<ul class="{mark}">\n' + "\n".join(f"<li>{escape(line)}</li>" for line in lines) + "\n</ul>"


def _table(frame) -> str:
    heads, numeric, rows = cells(frame)
    marks = [' class="number"' if n else "" for n in numeric]
    head = "".join(
        f"<th{mark}>{escape(name)} <small>{escape(unit)}</small></th>"
        for mark, (name, unit) in zip(marks, heads)
    )
    pads = [_paddings(column) if n else [""] * len(rows) for n, column in zip(numeric, zip(*rows))]
    lines = [
        f"<tr>{''.join(f'<td{m}{pad}>{escape(cell)}</td>' for m, pad, cell in zip(marks, own, row))}</tr>"
        for own, row in zip(zip(*pads), rows)
    ]
    kind = ' class="pairs"' if _pairs(kinds.Table(frame)) else ' class="many"' if len(heads) > MANY else ""
    return _grid(kind, head, lines)


def _paddings(column) -> list[Any]:
    """What the style sheet adds unseen behind each number of a column, so that their points line up."""
    decimals = [len(cell.partition(".")[2]) for cell in column]
    most = max((count for cell, count in zip(column, decimals) if "e" not in cell), default=0)
    return [
        f' data-pad="{"" if count else "."}{"0" * (most - count)}"'
        if count < most and "e" not in cell and cell != NOTHING
        else ""
        for cell, count in zip(column, decimals)
    ]


def _pairs(block):
    """Whether it is a table of names and values that is long enough for two halves beside each other."""
    if not isinstance(block, kinds.Table) or len(block.frame) != 2:
        return False
    return len(next(iter(block.frame.values()))) >= PAIRS


def _sheet(file, text) -> str:
    """Every cell as the CSV file writes it, and the file itself to save."""
    head, *rows = csv.reader(io.StringIO(text))
    heads = "".join(f"<th>{escape(name)}</th>" for name in head)
    lines = [f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows]
    marks = f' class="sheet" id="{file}"'
    return f"{_grid(marks, heads, lines)}\n{_saved(file, text)}"


def _saved(file, text) -> str:
    """A link that saves the file."""
    return f'<p><a download="{file}" href="{_data("text/csv", tables.encoded(text))}">Save {file}</a></p>'


def _grid(marks, head, lines) -> str:
    body = "\n".join(lines)
    return (
        f'<div class="wide"><table{marks}>\n<thead><tr>{head}</tr></thead>\n'
        f"<tbody>\n{body}\n</tbody>\n</table></div>"
    )


def _links(entries) -> str:
    lines = [
        f'<li><a href="#{escape(to)}">{escape(label)}</a>: {escape(text)}</li>' for to, label, text in entries
    ]
    return '<ul class="notes">\n' + "\n".join(lines) + "\n</ul>"


def _matrix(heads, rows, sortable) -> str:
    kind = "matrix sortable" if sortable else "matrix"
    numbers = [any(row[place].mark == "number" for row in rows) for place in range(len(heads))]
    marks = [' class="number"' if number else "" for number in numbers]
    head = "".join(f"<th{mark}>{escape(text)}</th>" for mark, text in zip(marks, heads))
    return _grid(f' class="{kind}"', head, [f"<tr>{''.join(map(_entry, row))}</tr>" for row in rows])


def _entry(entry) -> str:
    mark = f' class="{entry.mark}"' if entry.mark else ""
    body = escape(entry.text)
    if entry.picture:
        picture = entry.picture
        source = escape(picture.link) if picture.link else _data("image/png", picture.content)
        body += f'<img src="{source}" alt="{escape(picture.alt)}"{" loading=lazy" * bool(picture.link)}>'
    if entry.link:
        body = f'<a href="{escape(entry.link)}">{body}</a>'
    return f"<td{mark}>{body}</td>"


def _views(views) -> str:
    player = PLAYER if views.plays else ""
    figures = "\n".join(
        _view(views.of, place, name, kind, bars, player, views.mark)
        for place, (name, kind, bars) in enumerate(views.captions)
    )
    scene = json.dumps(views.scene, separators=(",", ":")).replace("<", "\\u003c")
    hint = views.hint or (PLAYED if views.plays else HINT)
    kind = "turnable on-paper" if views.printed else "turnable"
    return (
        f'<div id="{views.name}" hidden class="{kind}">\n<p class="quiet">{hint}</p>\n'
        f'<div class="{"views played" if views.plays else "views"}">\n{figures}\n</div>\n</div>\n'
        f'<script type="application/json" class="scene" data-views="{views.name}">{scene}</script>'
    )


FOLLOWING = (  # what the script shows: its name, what a reader calls it
    ("velocity", "velocity"), ("regime", "the part"), ("throw", "throw number"),
    ("stroke", "stroke, end to end"), ("rate", "rate"),
)  # fmt: skip


def _knobs(block) -> str:
    sliders = "\n".join(
        f'<label><span>{escape(knob.label)}</span><input type="range" name="{knob.name}" min="{knob.low:g}" '
        f'max="{knob.high:g}" step="any" value="{knob.own:.10g}" data-own="{knob.own:.10g}" '
        f'data-unit="{escape(knob.unit)}"><output></output></label>'
        for knob in block.knobs
    )
    tiles = "\n".join(
        f'<div class="tile"><span>{label}</span><strong data-shows="{name}"></strong></div>'
        for name, label in FOLLOWING
        if name != "rate" or block.values["rate"]
    )
    keys = "\n".join(
        f'<span><i style="background:{colour}"></i>{escape(words)}</span>'
        for _, colour, words in block.values["regimes"]
    )
    values = json.dumps(block.values, separators=(",", ":")).replace("<", "\\u003c")
    return (
        f'<div class="knobs" hidden>\n<div class="tiles">\n{tiles}\n</div>\n<div class="turned">\n'
        f'<div class="sliders">\n{sliders}\n<button type="button">as in the bowl file</button>\n</div>\n'
        f'<figure><canvas width="720" height="440" role="img" aria-label="Regimes over vibration angle and '
        f'amplitude, with the operating point"></canvas>\n<figcaption>vibration angle across, amplitude '
        f'up; a click sets both\n<div class="keys">\n{keys}\n</div></figcaption></figure>\n</div>\n'
        f'<script type="application/json" class="knob-values">{values}</script>\n</div>'
    )


def _view(of, place, name, kind, bars, player, mark) -> str:
    label = f"{of} {escape(name)} in three dimensions; arrow keys turn it"
    shares = "\n".join(_bar(bar) for bar in bars)
    across = f'<p class="across"><span>{escape(mark)}</span></p>\n' if mark else ""
    return (
        f'<figure class="view">\n'
        f'<canvas data-pose="{place}" tabindex="0" role="img" aria-label="{label}"></canvas>\n{across}'
        f'<figcaption><button type="button">from below</button><strong>{escape(name)}</strong> '
        f"<span>{escape(kind)}</span>\n{player}{shares}</figcaption>\n</figure>"
    )


def _bar(bar) -> str:
    mark, line, number = "bar", "", f"{100.0 * bar.share:.1f} %"
    if bar.interval:
        low, high = (100.0 * end for end in bar.interval)
        line = f'<u style="left:{low:.2f}%;width:{high - low:.2f}%"></u>'
        mark, number = "bar answer", f"{100.0 * bar.share:.0f} % ({low:.0f}–{high:.0f})"
    width = f'<b style="width:{100.0 * bar.share:.2f}%;background:{bar.colour}"></b>'
    return (
        f'<div class="{mark}"><span>{escape(bar.label)}</span><i>{width}{line}</i><span>{number}</span></div>'
    )


def _data(kind, content) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"
