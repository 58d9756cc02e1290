"""STL files: records of one size, or text whose words add up."""

import re
from dataclasses import dataclass, field

import numpy as np

from feederscrew.errors import MeshError
from feederscrew.part.reading import facets
from feederscrew.part.reading.decimals import CommaError, Decimals
from feederscrew.part.reading.formats import ASCII, BINARY, FACET, HEADER, claimed_facets, plain
from feederscrew.part.reading.soup import LARGEST_TEXT, DamageError, Soup, TooManyFacetsError, refuse_crowds
from feederscrew.units import quantity_text

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
UNKNOWN_COUNTS = (0, 0xFFFFFFFF)  # what streaming exporters leave in the header
COMMENT_LINE = re.compile(rb"(?m)^[ \t]*(?:#|//|;)[^\n]*$")
COMMENT = re.compile(rb"(?:#|//|;)[^\n]*")
BEGIN = re.compile(rb"(?i)\s*solid\b([^\n]*?)(?=\bfacet\s+normal\b|\n|\Z)")  # a name ends with its line
END = re.compile(rb"(?i)\bendsolid\b[^\n]*?(?=\bsolid\b[^\n]{0,80}?\bfacet\s+normal\b|\n|\Z)")
NEXT = re.compile(rb"(?i)\bendfacet\s+(?=solid\b)")  # where a solid begins before the last one has ended
SOMETHING = re.compile(rb"\S")
LAST = 2000  # [bytes] at the end of a text, the last name in them
WORDS = 21  # of a facet of three corners
AGAIN = "export the part again, or copy the whole file"


def soup(data, kind, where):
    """Read the triangles of an STL file.

    Parameters
    ----------
    data : bytes
    kind : str
        'stl' or 'stl-ascii'.
    where : str
        The file, for error lines.

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If the file is cut short or not readable.
    """
    return _binary(data, where) if kind == BINARY else _ascii(data, where)


def _binary(data, where):
    data, said = _honest(data, where)
    refuse_crowds(0, (len(data) - HEADER) // FACET)
    records = np.frombuffer(data, dtype=RECORD, offset=HEADER)
    with np.errstate(invalid="ignore"):  # a signalling NaN; the gate names it
        vertices = records["corners"].reshape(-1, 3).astype(float)
    return Soup(vertices, np.arange(len(vertices)).reshape(-1, 3), BINARY, warnings=said)


def _honest(data, where):
    """A binary STL whose count agrees with its size, and what had to be done for that."""
    if len(data) < HEADER:
        raise MeshError(where, f"is cut short: {len(data)} bytes, less than an STL header", AGAIN)
    count = claimed_facets(data)
    whole, rest = divmod(len(data) - HEADER, FACET)
    if count == whole and rest == 0:
        return data, ()
    if rest == 0 and (count in UNKNOWN_COUNTS or count < whole):
        sentence = f"the header says {count} facets, the file has {whole}: all of them are read"
        return _recounted(data, whole), (sentence,)
    if count == 0 or count > whole:
        promised = "an unknown number of" if count in UNKNOWN_COUNTS else f"{count}"
        raise MeshError(where, f"is cut short: {promised} facets announced, {whole} are there", AGAIN)
    extra = len(data) - HEADER - FACET * count
    return data[:-extra], (f"{extra} bytes after the last facet are left out",)


def _recounted(data, count):
    return data[: HEADER - 4] + count.to_bytes(4, "little") + data[HEADER:]


def _ascii(data, where):
    whole = data.rstrip(b"\0")
    padding = len(data) - len(whole)
    warnings = (f"{padding} NUL bytes after the text are left out",) if padding else ()
    if len(whole) > LARGEST_TEXT:
        raise TooManyFacetsError(f"is text of more than {LARGEST_TEXT >> 20} MB")
    text = whole.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return _from_text(COMMENT_LINE.sub(b"", text), warnings, where)


class WordError(ValueError):
    """A word that a text STL has not, or not there."""


@dataclass
class StlText:
    """The facets of a text, as they are read."""

    sizes: list[int] = field(default_factory=list)
    words: list[bytes] = field(default_factory=list)  # coordinates
    names: list[bytes] = field(default_factory=list)  # of the solids
    solids: list[int] = field(default_factory=list)  # of each facet
    whole: bool = True  # whether the last facet ends

    def take(self, block: bytes, name: bytes) -> None:
        """Add the facets of one solid.

        Raises
        ------
        ValueError
            If a line that is no facet's is among them.
        """
        words = (COMMENT.sub(b"", block) if re.search(rb"#|//|;", block) else block).lower().split()
        first = len(self.sizes)
        if not self._triangles(words):
            self._facets(words)
        self.names.append(name.strip())
        self.solids += [len(self.names) - 1] * (len(self.sizes) - first)

    def _triangles(self, words):
        """Take words that are facets of three corners and nothing else."""
        if len(words) % WORDS:
            return False
        marks = (
            (0, b"facet"),
            (5, b"outer"),
            (7, b"vertex"),
            (11, b"vertex"),
            (15, b"vertex"),
            (20, b"endfacet"),
        )
        if any(set(words[at::WORDS]) - {mark} for at, mark in marks):
            return False
        count = len(words) // WORDS
        coordinates = [b""] * (9 * count)
        for k, at in enumerate((8, 9, 10, 12, 13, 14, 16, 17, 18)):
            coordinates[k::9] = words[at::WORDS]
        self.sizes += [3] * count
        self.words += coordinates
        return True

    def _facets(self, words):
        """Take the words one by one; a facet may have any number of corners, and its normal be missing."""
        at, last = 0, len(words)
        while at < last:
            if words[at] != b"facet":
                raise WordError(words[at])
            try:
                at = words.index(b"outer", at, at + 7) + 2
            except ValueError:
                self.whole = last - at > 7
                if self.whole:
                    raise WordError(words[at + 1]) from None
                return
            size = 0
            while words[at : at + 1] == [b"vertex"]:
                if at + 4 > last:
                    self.whole = False
                    return
                if b"vertex" in words[at + 1 : at + 4] or b"endloop" in words[at + 1 : at + 4]:
                    raise DamageError("a corner of fewer than three numbers")
                self.words += words[at + 1 : at + 4]
                size, at = size + 1, at + 4
            self.sizes.append(size)
            if words[at : at + 2] != [b"endloop", b"endfacet"][: last - at]:
                raise WordError(words[at])
            if at + 2 > last:
                self.whole = False
                return
            at += 2


def _from_text(text, warnings, where):
    read, decimals = StlText(), Decimals()
    try:
        ended = _solids(text, read)
        if not read.whole:
            raise _cut_short(where)
        refuse_crowds(len(read.words) // 3, sum(read.sizes) - 2 * len(read.sizes))
        vertices = decimals.read(read.words).reshape(-1, 3)
    except CommaError as error:
        raise MeshError(where, f"has {error}", "write numbers with a decimal point") from None
    except TooManyFacetsError:
        raise
    except WordError as error:
        if END.search(text, max(0, len(text) - LAST)) is None:
            raise _cut_short(where) from None
        word = quantity_text(error.args[0].decode(errors="replace"))
        raise MeshError(
            where, f"has {word} where an STL has none", "remove it, or export the part again"
        ) from None
    except ValueError:
        raise (_garbled if END.search(text, max(0, len(text) - LAST)) else _cut_short)(where) from None
    sizes = np.array(read.sizes, dtype=np.int64)
    faces, facet = facets.triangles(vertices, sizes, np.arange(len(vertices)))
    if not ended:
        warnings += ("the text does not end with 'endsolid', and its last facet is whole: read to there",)
    names = tuple(name.decode(errors="replace") for name in read.names)
    said = (*warnings, *decimals.warnings, *facets.split_warning(sizes))
    return Soup(
        vertices, faces, ASCII, warnings=said, names=names, objects=np.array(read.solids, np.int64)[facet]
    )


def _solids(text, read):
    """Take the text solid by solid; whether the last one ends."""
    at, end = 0, END.search(text)
    while SOMETHING.search(text, at):
        begin = BEGIN.match(text, at)
        name, at = (begin[1], begin.end()) if begin else (b"", at)
        end = END.search(text, at) if end else None  # after the last there is none
        following = NEXT.search(text, at, end.start() if end else len(text))
        stop = following.start() + len(b"endfacet") if following else end.start() if end else len(text)
        read.take(text[at:stop], plain(name))
        at = end.end() if end and not following else stop
    return end is not None


def _cut_short(where):
    return MeshError(where, "is cut short: the text does not end with 'endsolid'", AGAIN)


def _garbled(where):
    return MeshError(where, "has a 'vertex' line that is not three numbers", "export the part again")
