"""Which format a part file has, recognised by its bytes; the name decides only where they do not."""

import re
from dataclasses import dataclass

from feederscrew.documents import POINTER, POINTER_HEAD

CARD, BINARY, ASCII = "card", "stl", "stl-ascii"
HEADER, FACET = 84, 50  # [bytes] of a binary STL
HEAD = 1 << 16  # [bytes] looked at


@dataclass(frozen=True)
class Format:
    """What a format is called, and the unit its specification or its files state."""

    title: str
    suffixes: tuple[str, ...]
    needs: tuple[str, ...] = ()  # modules of an extra
    extra: str = ""


FORMATS = {
    BINARY: Format("binary STL", ("stl",)),
    ASCII: Format("ASCII STL", ("stl",)),
    "obj": Format("OBJ", ("obj",)),
    "ply": Format("PLY", ("ply",)),
    "off": Format("OFF", ("off",)),
    "glb": Format("GLB", ("glb",)),
    "3mf": Format("3MF", ("3mf",)),
    "step": Format("STEP", ("step", "stp", "stpz"), ("cascadio",), "step"),
    CARD: Format("a part card", ("yaml", "yml")),
}
MARKS = (  # pattern at the start of a file, and its format
    (rb"glTF", "glb"),
    (rb"ply[ \t]*[\r\n]", "ply"),
    (rb"(?:#[^\n]*\n|\s)*(?:ST)?C?N?OFF\b", "off"),
    (rb"\s*(?:/\*[^*]*\*/\s*)?ISO-10303-21", "step"),
)
UTF16 = "is text in UTF-16"
ALIENS = (  # what people save under a mesh's name by mistake
    (re.escape(POINTER_HEAD), POINTER),
    (rb"\xff\xfe[\t-~]\0|\xfe\xff\0[\t-~]|(?:[\t-~]\0){8}|(?:\0[\t-~]){8}", UTF16),
    (rb"(?i)\s*solid\b[^\0]*\bfacet\s+normal[^\0]*\0", "is ASCII STL with NUL bytes in the middle"),
    (rb"(?is)\s*<.{,2000}?(?<=<)(?:!doctype\s+html|html\b|head\b|body\b)", "is an HTML page, not a part"),
    (rb"(?s)\s*<\?xml.*<amf", "is an AMF file, which is not read"),
    (rb"\s*<", "is an XML file, not a part"),
    (rb"PK\x03\x04", "is a ZIP archive without a 3MF model"),
    (rb"\x1f\x8b|7z\xbc\xaf|Rar!", "is a compressed archive"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8|BM", "is a picture, not a part"),
    (rb"%PDF", "is a PDF document, not a part"),
    (rb"\xd0\xcf\x11\xe0", "is a native CAD or Office file, which is not read"),
    (rb"\s*\{", "is a JSON file (glTF is read as .glb only)"),
)
ASCII_ONLY = bytes(byte if byte < 128 else ord("?") for byte in range(256))
OBJ_LINE = re.compile(rb"(?m)^[ \t]*v[ \t]+[-+.\d]\S*[ \t]+[-+.\d]\S*[ \t]+[-+.\d]")
MODEL_MEMBER = re.compile(rb"(?i)\.model")
STEP_MEMBER = re.compile(rb"(?i)\.ste?p")
STL_HEAD = re.compile(rb"(?i)(?:\s++|(?:#|//|;)[^\n]*\n)*+(?:solid\b|facet\s+normal\b)")
CARD_LINE = re.compile(rb"(?m)^(?:mass|centre_of_mass|inertia|aspects|floor|track)[ \t]*:")


def detect(data, suffix=""):
    """Return the format of a part file.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        Of its name, lower case, without the dot.

    Returns
    -------
    kind : str or None
        A key of ``FORMATS``; None where there is no mesh.
    alien : str or None
        What the file is instead.
    """
    if fits_binary_stl(data):
        return BINARY, None
    head = data.rstrip(b"\0")[:HEAD].removeprefix(b"\xef\xbb\xbf")
    kind = _marked(data, head) or _text(head, suffix)
    if kind:
        return kind, None
    alien = next((shown for mark, shown in ALIENS if re.match(mark, head)), None)
    if alien is None and (suffix == "stl" or (b"\0" in head and len(data) > HEADER)):
        return BINARY, None
    return None, alien or "is not a mesh: it has the marks of no known format"


def fits_binary_stl(data):
    """Return whether the facet count of a binary STL agrees with the file's size."""
    return len(data) > HEADER and len(data) == HEADER + FACET * claimed_facets(data)


def plain(text):
    """Return the text with '?' for every letter beyond ASCII: numbers have none, names and comments do."""
    return text.translate(ASCII_ONLY)


def claimed_facets(data):
    """Return the facet count in the header of a binary STL."""
    return int.from_bytes(data[HEADER - 4 : HEADER], "little")


def _marked(data, head):
    if head.startswith(b"PK\x03\x04"):
        return "3mf" if MODEL_MEMBER.search(data) else "step" if STEP_MEMBER.search(data) else None
    return next((kind for mark, kind in MARKS if re.match(mark, head, re.DOTALL)), None)


def _text(head, suffix):
    if b"\0" in head:
        return None
    if STL_HEAD.match(head) and re.search(rb"(?i)facet|endsolid", head):
        return ASCII
    if OBJ_LINE.search(head):
        return "obj"
    if suffix == "" and CARD_LINE.search(head):
        return CARD
    return None
