"""A page as one HTML file that needs no other: style, viewer, mesh and pictures are inside."""

import base64
import csv
import functools
import io
import json
import re
import struct
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape as html_escape
from html import unescape
from importlib import resources
from itertools import groupby

from feederscrew.base.columns import Frame
from feederscrew.base.errors import printable
from feederscrew.output import DPI, tables
from feederscrew.output.page import blocks as kinds
from feederscrew.output.page.words import GLOSSARY

POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
CSS_DPI = 96  # pixels of a page to the inch
HALF = 700  # [px] a broader picture is not put beside another
NARROW = 6  # columns of a table that is put beside something else
MANY = 10  # columns of a table that is printed in smaller letters
UNEVEN = 1.5  # times the height of a column: the other is so high that its table stands above both
PAIRS = 8  # rows from which a table of two columns that stands alone is set in two halves
ALONE = 1.4  # times the size of a picture that has the whole width
TALL = 1.5  # times its width: the height from which a picture has a page of paper to itself
BROAD = 1000  # [px] width from which a picture that is high as well takes half a page of paper
LINE, HEADING = 29, 70  # [px] about the height of a row of a table, and of its head
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
THREE = "vendor/three"  # the folder of three.js
RENAMED = r"([\w$]+) as ([\w$]+)"  # in the imports and exports of a module
SHORT = 3  # significant digits of a percentage, and of a number at the head of a page
LONG_LETTERS = 36  # of a cell that needs a wide column
CARD_LETTERS = 110  # of a cell that takes more than four lines of that column
NOTHING = "–"  # in an empty cell
WHERE_WORDS = "The glossary of feeder, docs/glossary.md, explains the words with pictures."
DETAILS = "Details for those who compare the rules"  # over remarks that call for no step
# In HTML, apart from scripts and tags: names of a part that is told, 'A of nut', orientations 'A@188',
# aspects that are 'A up' or 'A, at any heading', and what has nothing but 'A' in it.
NAMES = (
    r'<script.*?</script>|<table class="sheet".*?</table>'  # cells to copy stay as they are
    r'|(?P<td><(?P<tag>td|strong|small)(?: data-head="[^"]*")?>)(?P<cell>[^<>@\s]{1,12})</(?P=tag)>|<[^>]*>'
    r"|(?<![\w@])(?P<own>[^\W\d_][\w-]{0,11}(?:@\d{1,3})?) of (?P<part>{parts})(?!\w)"
    r"|(?P<name>[^\W\d_][\w-]{0,11}@\d{1,3})(?![\w@])"
    r"|(?<![\w@])(?P<aspect>[A-Z]{1,2})(?= up\b|, at any heading|, \d+ trials?:)"
)
NO_PART = r"(?!)"  # matches nothing
FOLLOWING = (  # what the script shows: its name, what a reader calls it
    ("velocity", "velocity"),
    ("regime", "the part"),
    ("throw", "throw number"),
    ("stroke", "stroke, end to end"),
    ("rate", "rate"),
)


def html(page: kinds.Page) -> str:
    """Return the page as HTML.

    Parameters
    ----------
    page : Page

    Returns
    -------
    str
    """
    all_blocks = [*page.opening, *(block for section in page.sections for block in section.blocks)]
    matrices = [block for block in all_blocks if isinstance(block, kinds.Matrix)]
    cells = (cell for block in matrices for row in block.rows for cell in row)
    linked = any(cell.picture and cell.picture.link for cell in cells)
    scripts = []
    if any(isinstance(block, kinds.Views) for block in all_blocks):
        licence = f"<!--\nThe 3-D views are drawn with three.js.\n\n{_asset(f'{THREE}/LICENSE')}-->"
        scripts = [licence, f"<script>\n{_three()}\n</script>", _script("viewer.js")]
    scripts += [_script("sorting.js")] * any(block.sortable for block in matrices)
    scripts += [_script("knobs.js")] * any(isinstance(block, kinds.Knobs) for block in all_blocks)
    policy = POLICY + " 'self' file:" * linked  # for pictures that lie beside the page
    head = [f"<header>\n<h1>{escape(page.title)}</h1>"]
    head += [f"<p>{escape(page.subtitle)}</p>"] if page.subtitle else []
    tiles = [
        f'<div class="tile"><span>{escape(tile.label)}</span><strong>{escape(tile.value)}</strong>'
        f"<small>{escape(tile.note)}</small></div>"
        for tile in page.tiles
    ]
    shown = ['<div class="tiles">', *tiles, "</div>"] if tiles else []
    shown.append(_list(page.warnings, "loud") if page.warnings else "")
    if page.opening:
        views = ["<div>", *map(_views, page.opening), "</div>"]
        shown = ['<div class="opening">', *views, "<div>", *shown, "</div>", "</div>"]
    names = PoseNames(page.pose, page.pose_of)
    head.append(names.marked("\n".join(shown)))
    links, sections = [], []
    for section in page.sections:
        anchor, title = f' id="{section.anchor}"' if section.anchor else "", escape(section.title)
        links += [f'<a href="#{section.anchor}">{title}</a>'] if title else []
        body = "\n".join(_run(*run) for run in groupby(section.blocks, _may_share_row))
        body += f"\n{_folded(DETAILS, _list(section.details, 'notes'))}" if section.details else ""
        title = f"<h2>{title}</h2>\n" if title else ""
        sections.append(f"<section{anchor}>\n{title}{names.marked(body)}\n</section>")
    head += ["<nav>", *links, "</nav>"] if links else []
    scripts += [_script("poses.js")] * bool(names.found)
    sections += [_glossary("".join(sections))] if links else []
    return "\n".join(
        [
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{escape(': '.join(filter(None, (page.title, page.kind))))}</title>",
            f"<style>\n{_asset('page.css')}{names.style()}</style>\n</head>\n<body>",
            *head,
            "</header>",
            *sections,
            *scripts,
            "</body>\n</html>\n",
        ]
    )


class PoseNames:
    """Marks the names of a page that stand for poses, and keeps the pictures of those that it found."""

    def __init__(
        self,
        find: Callable[[str], kinds.Pose | None] | None,
        find_of: Mapping[str, Callable[[str], kinds.Pose | None]] | None = None,
    ) -> None:
        self.find = find or (lambda name: None)
        self.find_of = {escape(part): own for part, own in (find_of or {}).items()}
        parts = "|".join(sorted(map(re.escape, self.find_of), key=len, reverse=True))
        self.pattern = re.compile(NAMES.replace("{parts}", parts or NO_PART), re.DOTALL)
        self.found: dict[str, kinds.Pose] = {}

    def marked(self, body: str) -> str:
        """Return HTML with its names marked; the first can have the focus, and has a picture on paper.

        Parameters
        ----------
        body : str

        Returns
        -------
        str
        """
        met: set[str] = set()

        def mark(match: re.Match[str]) -> str:
            name, find = match["name"] or match["cell"] or match["aspect"], self.find
            if match["own"]:
                name, find = match[0], lambda _: self.find_of[match["part"]](match["own"])
            pose = find(unescape(name)) if name else None
            if pose is None:
                return match[0]
            self.found[name] = pose
            is_first, place = name not in met, list(self.found).index(name)
            met.add(name)
            first = ' first" tabindex="0' if is_first else ""
            text = f'<span class="pose pose-{place}{first}" data-words="{escape(pose.words)}">{name}</span>'
            return f"{match['td']}{text}</{match['tag']}>" if match["cell"] else text

        return self.pattern.sub(mark, body)

    def style(self) -> str:
        """Return the style sheet's lines with the pictures."""
        return "".join(
            f'.pose-{place} {{ --pose: url("{_data("image/png", pose.content)}"); }}\n'
            for place, pose in enumerate(self.found.values())
        )


def escape(text: str) -> str:
    """Return a text as HTML, its lines kept, with an escape for every letter that is not printable.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    return html_escape("\n".join(map(printable, text.split("\n"))))


def _asset(name: str) -> str:
    return resources.files("feederscrew.output.page").joinpath(name).read_text(encoding="utf-8")


def _script(name: str) -> str:
    return f"<script>\n{_asset(name)}</script>"


@functools.cache
def _three() -> str:
    """Return three.js as a plain script that defines ``THREE``.

    Its release is two modules, and a page that is opened from a file may load none. Each becomes a function
    that takes what it imports and returns what it exports.
    """
    core, module = (_as_function(_asset(f"{THREE}/three.{name}.min.js")) for name in ("core", "module"))
    return f"const THREE = (() => {{ const core = ({core})(); return {{...core, ...({module})(core)}}; }})();"


def _as_function(module: str) -> str:
    """Return a module of JavaScript as a function of an object that holds all that it imports."""
    module = re.sub(r'export\{[^}]*\}from"[^"]*";', "", module)  # what it hands on stands in that object
    module = re.sub(r'import\{([^}]*)\}from"[^"]*";', _constants, module)
    module = re.sub(r"export\{([^}]*)\}", _returned, module)
    return f'given => {{ "use strict";\n{module}\n}}'


def _constants(found: re.Match[str]) -> str:
    """Return ``import{a as b}from"...";`` as constants that are taken from an object."""
    return "const{" + re.sub(RENAMED, r"\1:\2", found[1]) + "}=given;"


def _returned(found: re.Match[str]) -> str:
    """Return ``export{a as b}`` as the return of an object."""
    return "return{" + re.sub(RENAMED, r"\2:\1", found[1]) + "}"


def _may_share_row(block: kinds.Block) -> bool:
    if isinstance(block, kinds.Table):
        return len(block.frame) <= NARROW
    if not isinstance(block, kinds.Picture) or block.printed:
        return False
    width, height = _size(block)
    return width <= HALF and height <= TALL * width


def _run(in_columns: bool, run: Iterable[kinds.Block]) -> str:
    blocks = list(run)
    if not in_columns or len(blocks) == 1:
        return "\n".join(map(_block, blocks))
    # about what each takes in its column [px]
    heights = [
        _size(block)[1]
        if isinstance(block, kinds.Picture)
        else HEADING + LINE * max(map(len, block.frame.values()), default=0)
        for block in blocks
        if isinstance(block, kinds.Picture | kinds.Table)
    ]
    first = min(range(1, len(blocks)), key=lambda k: max(sum(heights[:k]), sum(heights[k:])))
    if _pairs(blocks[0]) and len(blocks) > 2 and sum(heights[first:]) > UNEVEN * sum(heights[:first]):
        return f"{_block(blocks[0])}\n{_run(in_columns, blocks[1:])}"
    cells = [_picture(block) if isinstance(block, kinds.Picture) else _block(block) for block in blocks]
    halves = ["<div>", *cells[:first], "</div>", "<div>", *cells[first:], "</div>"]
    return "\n".join(['<div class="beside">', *halves, "</div>"])


def _block(block: kinds.Block) -> str:
    match block:
        case kinds.Text(text, quiet, printed):
            names = " ".join(name for name, holds in (("quiet", quiet), ("on-screen", not printed)) if holds)
            mark = f' class="{names}"' if names else ""
            return f"<p{mark}>{escape(text)}</p>"
        case kinds.Notes(lines, loud):
            return _list(lines, "loud" if loud else "notes")
        case kinds.Code(text):
            return f"<pre>{escape(text)}</pre>"
        case kinds.Folded(title, text):
            return _folded(title, f"<pre>{escape(text)}</pre>")
        case kinds.Table(frame, printed=printed):
            return _table(frame) if printed else f'<div class="on-screen">{_table(frame)}</div>'
        case kinds.Knobs():
            return _knobs(block)
        case kinds.CsvSheet(file, text, on_page):
            source = _data("text/csv", tables.file_bytes(text))
            link = f'<p><a download="{file}" href="{source}">Save {file}</a></p>'
            if not on_page:
                return link
            head, *rows = csv.reader(io.StringIO(text))  # every cell as the CSV file writes it
            heads = "".join(f"<th>{escape(name)}</th>" for name in head)
            cells = [f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows]
            marks = f' class="sheet" id="{file}"'
            return f"{_grid(marks, heads, cells)}\n{link}"
        case kinds.Picture():
            return _picture(block, 1.0 if block.printed else ALONE)
        case kinds.Views():
            return _views(block)
        case kinds.Heading(text, anchor):
            return f'<h3 id="{escape(anchor)}">{escape(text)}</h3>' if anchor else f"<h3>{escape(text)}</h3>"
        case kinds.Links(entries):
            links = [
                f'<li><a href="#{escape(to)}">{escape(label)}</a>: {escape(text)}</li>'
                for to, label, text in entries
            ]
            return "\n".join(['<ul class="notes">', *links, "</ul>"])
        case kinds.Matrix(heads, rows, sortable):
            return _matrix(heads, rows, sortable)
    raise ValueError(f"{type(block).__name__} is not a block of a page")


def _glossary(body: str) -> str:
    """The words of a page that the glossary has, folded, and where there is more."""
    shown = re.sub(r"<script.*?</script>|<[^>]*>", " ", body, flags=re.S).lower()
    used = [
        (word, meaning)
        for word, meaning in GLOSSARY.items()
        if any(re.search(rf"\b{re.escape(each)}s?\b", shown) for each in word.split(", "))
    ]
    listed = "\n".join(f"<dt>{escape(word)}</dt><dd>{escape(meaning)}</dd>" for word, meaning in used)
    folded = f"{_folded('Words of this page', f'<dl>{listed}</dl>')}\n" if used else ""
    return f'<footer>\n{folded}<p class="quiet">{WHERE_WORDS}</p>\n</footer>'


def _folded(title: str, body: str) -> str:
    return f"<details>\n<summary>{escape(title)}</summary>\n{body}\n</details>"


def _list(lines: Iterable[str], mark: str) -> str:
    return "\n".join([f'<ul class="{mark}">', *(f"<li>{escape(line)}</li>" for line in lines), "</ul>"])


def _picture(picture: kinds.Picture, scale: float = 1.0) -> str:
    """The picture at its own size or smaller; one that stands alone is larger."""
    width, height = (round(scale * pixels) for pixels in _size(picture))
    kind = "stand-in" if picture.printed else "plain"
    kind += " scrolls" if width > 360 else ""  # on a telephone
    kind += " tall" if height > TALL * width else " broad" if width > BROAD and height > 0.7 * width else ""
    media = "image/svg+xml" if picture.file.endswith(".svg") else "image/png"
    return (
        f'<figure id="{picture.file}" class="{kind}"><img src="{_data(media, picture.content)}" '
        f'width="{width}" height="{height}" style="--own: {width}px" alt="{escape(picture.alt)}"></figure>'
    )


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def _size(picture: kinds.Picture) -> list[float]:
    """Width and height of a picture at its own size [px of a page]."""
    if picture.file.endswith(".svg"):
        size = re.search(rb'width="([\d.]+)pt" height="([\d.]+)pt"', picture.content)
        if size is None:
            raise ValueError(f"{picture.file} says no size in points")
        return [float(points) * CSS_DPI / 72 for points in size.groups()]
    return [pixels * CSS_DPI / DPI for pixels in struct.unpack(">2I", picture.content[16:24])]


def _table(frame: Frame) -> str:
    heads, numeric, columns = texts_of(frame)
    marks = [' class="number"' if number else "" for number in numeric]
    head = "".join(
        f"<th{mark}>{escape(name)} <small>{escape(unit)}</small></th>"
        for mark, (name, unit) in zip(marks, heads)
    )
    # the style sheet adds unseen what lines up the points of a column of numbers
    pads = [[""] * len(column) for column in columns]
    for pad, column, number in zip(pads, columns, numeric):
        decimals = [len(cell.partition(".")[2]) for cell in column]
        most = max((count for cell, count in zip(column, decimals) if "e" not in cell), default=0)
        for place, (cell, count) in enumerate(zip(column, decimals)):
            if number and count < most and "e" not in cell and cell != NOTHING:
                pad[place] = f' data-pad="{"" if count else "."}{"0" * (most - count)}"'
    # a text of several lines leaves the cells beside it white: on a phone each row of such a table is a card
    is_cards = len(columns) > 2 and any(len(cell) > CARD_LETTERS for column in columns for cell in column)
    titles = [f' data-head="{escape(" ".join(names).strip())}"' * is_cards for names in heads]
    lines = []
    for own, row in zip(zip(*pads), zip(*columns)):
        cells = (
            f"<td{_long(mark, cell)}{pad}{title if cell not in ('', NOTHING) else ''}>{escape(cell)}</td>"
            for mark, pad, title, cell in zip(marks, own, titles, row)
        )
        lines.append(f"<tr>{''.join(cells)}</tr>")
    names = ("pairs", _pairs(kinds.Table(frame))), ("many", len(heads) > MANY), ("cards", is_cards)
    kind = " ".join(name for name, holds in names if holds)
    return _grid(f' class="{kind}"' if kind else "", head, lines)


def _long(mark: str, cell: str) -> str:
    """The class of a cell: one of many words is no narrow column of them, which would make its row tall."""
    if mark or len(cell) <= LONG_LETTERS:
        return mark
    return ' class="long"' if len(cell) <= CARD_LETTERS else ' class="long longest"'


def texts_of(frame: Frame) -> tuple[list[tuple[str, str]], list[bool], list[list[str]]]:
    """Return a frame as a page shows it.

    Parameters
    ----------
    frame : Frame

    Returns
    -------
    list of (str, str), list of bool, list of list of str
        Heads of name and unit, which columns are of numbers, and cells by column.
    """
    numeric = [tables.is_numeric(column) for column in frame.values()]
    heads = [tables.head_of(frame, name) for name in frame]
    texts = [tables.cells(head, column, SHORT, NOTHING) for head, column in zip(heads, frame.values())]
    return [(head.heading, f"[{head.unit}]" if head.unit else "") for head in heads], numeric, texts


def _pairs(block: kinds.Block) -> bool:
    if not isinstance(block, kinds.Table) or len(block.frame) != 2:
        return False
    return len(next(iter(block.frame.values()))) >= PAIRS


def _grid(marks: str, head: str, lines: Iterable[str]) -> str:
    body = "\n".join(lines)
    return (
        f'<div class="wide"><table{marks}>\n<thead><tr>{head}</tr></thead>\n'
        f"<tbody>\n{body}\n</tbody>\n</table></div>"
    )


def _matrix(heads: Sequence[str], rows: Sequence[Sequence[kinds.MarkedCell]], sortable: bool) -> str:
    mark = ' class="number"'
    numbers = [any(row[place].mark == "number" for row in rows) for place in range(len(heads))]
    head = "".join(f"<th{mark * number}>{escape(text)}</th>" for number, text in zip(numbers, heads))
    lines = []
    for row in rows:
        line = ""
        for cell in row:
            body = escape(cell.text)
            if picture := cell.picture:
                source = escape(picture.link) if picture.link else _data("image/png", picture.content)
                loading = " loading=lazy" * bool(picture.link)
                body += f'<img src="{source}" alt="{escape(picture.alt)}"{loading}>'
            body = f'<a href="{escape(cell.link)}">{body}</a>' if cell.link else body
            line += f'<td class="{cell.mark}">{body}</td>' if cell.mark else f"<td>{body}</td>"
        lines.append(f"<tr>{line}</tr>")
    return _grid(f' class="matrix{" sortable" * sortable}"', head, lines)


def _json(values: object) -> str:
    return json.dumps(values, separators=(",", ":")).replace("<", "\\u003c")


def _views(views: kinds.Views) -> str:
    player, figures = PLAYER if views.plays else "", []
    across = f'<p class="across"><span>{escape(views.mark)}</span></p>\n' if views.mark else ""
    for place, (name, kind, bars) in enumerate(views.captions):
        texts = []
        for bar in bars:
            mark, line, number = "bar", "", f"{100.0 * bar.share:.1f} %"
            if bar.interval:
                low, high = (100.0 * end for end in bar.interval)
                line = f'<u style="left:{low:.2f}%;width:{high - low:.2f}%"></u>'
                mark, number = "bar answer", f"{100.0 * bar.share:.0f} % ({low:.0f}–{high:.0f})"
            width = f'<b style="width:{100.0 * bar.share:.2f}%;background:{bar.colour}"></b>'
            label = f'<div class="{mark}"><span>{escape(bar.label)}</span>'
            texts.append(f"{label}<i>{width}{line}</i><span>{number}</span></div>")
        shares = "\n".join(texts)
        label = f"{views.subject} {escape(name)} in three dimensions; arrow keys turn it"
        figures.append(
            f'<figure class="view">\n'
            f'<canvas data-pose="{place}" tabindex="0" role="img" aria-label="{label}"></canvas>\n{across}'
            f'<figcaption><button type="button">from below</button><strong>{escape(name)}</strong> '
            f"<span>{escape(kind)}</span>\n{player}{shares}</figcaption>\n</figure>"
        )
    drawn = "\n".join(figures)
    hint = views.hint or (PLAYED if views.plays else HINT)
    own = "turnable on-paper" if views.printed else "turnable"
    return (
        f'<div id="{escape(views.name)}" hidden class="{own}">\n'
        f'<p class="quiet">{hint}</p>\n<div class="{"views played" if views.plays else "views"}">\n'
        f"{drawn}\n</div>\n</div>\n"
        f'<script type="application/json" class="scene" data-views="{escape(views.name)}">'
        f"{_json(views.scene)}</script>"
    )


def _knobs(block: kinds.Knobs) -> str:
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
    return (
        f'<div class="knobs" hidden>\n<div class="tiles">\n{tiles}\n</div>\n<div class="turned">\n'
        f'<div class="sliders">\n{sliders}\n<button type="button">as in the bowl file</button>\n</div>\n'
        f'<figure><canvas width="720" height="440" role="img" aria-label="Regimes over vibration angle and '
        f'amplitude, with the operating point"></canvas>\n<figcaption>vibration angle across, amplitude '
        f'up; a click sets both\n<div class="keys">\n{keys}\n</div></figcaption></figure>\n</div>\n'
        f'<script type="application/json" class="knob-values">{_json(block.values)}</script>\n</div>'
    )
