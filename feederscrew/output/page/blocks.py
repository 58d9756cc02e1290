"""Blocks of a page; the two writers turn each kind of block into HTML or Markdown."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from feederscrew.base.columns import Document, Frame
from feederscrew.base.errors import Detail


@dataclass(frozen=True)
class Text:
    """A paragraph; ``quiet`` for what explains rather than tells."""

    text: str
    quiet: bool = False
    printed: bool = True  # also on paper


@dataclass(frozen=True)
class Notes:
    """Lines to be read one by one; ``loud`` for warnings."""

    lines: tuple[str, ...]
    loud: bool = False


@dataclass(frozen=True)
class Code:
    """Text that one types."""

    text: str


@dataclass(frozen=True, eq=False)
class Table:
    """A frame for people."""

    frame: Frame
    printed: bool = True  # also on paper


@dataclass(frozen=True)
class CsvSheet:
    """A CSV file to save; cell by cell to copy from, unless a table beside it shows the same."""

    file: str
    csv: str
    on_page: bool = True


@dataclass(frozen=True)
class Picture:
    """A PNG, or an SVG sized in points; ``printed`` for one that stands in for the 3-D views on paper."""

    file: str
    content: bytes
    alt: str
    printed: bool = False
    link: str = ""  # of a cell's picture that is not within the page: its address; ``content`` is empty


@dataclass(frozen=True)
class ShareBar:
    """A share as a bar with its number; the answer that has an ``interval`` is drawn larger."""

    label: str
    colour: str
    share: float  # [1]
    interval: tuple[float, ...] = ()  # [1] low and high


@dataclass(frozen=True)
class Pose:
    """Meaning of a name like A@188: a small picture (PNG) and words."""

    content: bytes
    words: str


@dataclass(frozen=True, eq=False)
class Views:
    """The part, to be turned: on each aspect, over cuts, or on its way; ``scene`` is JSON for the viewer."""

    scene: Document
    captions: tuple[tuple[str, str, tuple[ShareBar, ...]], ...]  # name, kind, bars
    name: str = "views"  # of the block; no two of a page have the same
    subject: str = "Aspect"  # what the captions name
    plays: bool = False  # each has a path that the part moves along
    hint: str = ""  # what one can do with it, where it is not the part on a face
    printed: bool = False  # also on paper: no picture stands in for it
    mark: str = ""  # written across each


@dataclass(frozen=True)
class Knob:
    """A slider: its name in the script, label, unit, ends and the bowl's own value, in that unit."""

    name: str
    label: str
    unit: str
    low: float
    high: float
    own: float


@dataclass(frozen=True, eq=False)
class Knobs:
    """Sliders that turn the drive of a bowl, what follows from them at once, and a map with the point."""

    knobs: tuple[Knob, ...]
    # JSON for the script: ``bowl``, ``rate``, ``regimes`` (name, colour, words), ``top``: ``report.knobs``
    values: Document


@dataclass(frozen=True)
class Heading:
    """The title of a part of a section; ``anchor`` is where links lead."""

    text: str
    anchor: str = ""


@dataclass(frozen=True)
class Links:
    """Lines that each lead to an anchor of the page: (anchor, label, text)."""

    entries: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True)
class MarkedCell:
    """One cell of a `Matrix`: its text, a mark for the style sheet, and what lies behind it."""

    text: str
    mark: str = ""  # class names of the style sheet: 'number', 'exact', 'failed' ...
    link: str = ""
    picture: Picture | None = None


@dataclass(frozen=True)
class Matrix:
    """A table whose cells are marked one by one."""

    heads: tuple[str, ...]
    rows: tuple[tuple[MarkedCell, ...], ...]
    sortable: bool = False  # a click on a heading sorts it, words that are typed choose rows


@dataclass(frozen=True)
class Folded:
    """Text of a file or of details under a title that opens it; on paper the title alone."""

    title: str
    text: str


Block = Text | Notes | Code | Folded | Table | CsvSheet | Picture | Views | Knobs | Heading | Links | Matrix


@dataclass(frozen=True)
class Tile:
    """One answer at the head of the page."""

    label: str
    value: str
    note: str


@dataclass(frozen=True)
class Chapter:
    """A chapter of the page; its place and title are the page's to give, '' for one without."""

    blocks: tuple[Any, ...]  # each a Block
    tiles: tuple[Tile, ...] = ()
    warnings: tuple[str, ...] = ()
    anchor: str = ""
    title: str = ""

    @property
    def details(self) -> tuple[str, ...]:
        """The warnings that call for no step of the reader."""
        return tuple(line for line in self.warnings if isinstance(line, Detail))


@dataclass(frozen=True)
class Page:
    """A whole page; ``kind`` is what its window is called after the title."""

    title: str
    subtitle: str
    sections: tuple[Chapter, ...]
    kind: str = ""
    opening: tuple[Views, ...] = ()  # what it begins with, to be turned
    pose: Callable[[str], Pose | None] | None = None  # what a name of its texts stands for
    # the same for 'A@188 of nut', where a page is of several parts: by the name of the part
    pose_of: Mapping[str, Callable[[str], Pose | None]] = field(default_factory=dict)

    @property
    def tiles(self) -> tuple[Tile, ...]:
        """The answers of all sections, in their order."""
        return tuple(tile for section in self.sections for tile in section.tiles)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return the lines that a reader must not overlook, each once."""
        lines = dict.fromkeys(line for section in self.sections for line in section.warnings)
        return tuple(line for line in lines if not isinstance(line, Detail))
