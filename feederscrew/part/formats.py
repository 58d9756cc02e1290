"""Tools that readers of meshes share: formats by their bytes, numbers, facets of many corners, archives."""

import io
import lzma
import re
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Bools, Floats, Ints, Points, Triangles
from feederscrew.base.documents import POINTER, POINTER_HEAD
from feederscrew.base.geometry import vectors
from feederscrew.base.heavy import heavy

manifold3d = heavy("manifold3d")

MAX_MESH_BYTES = 1 << 29  # [bytes] of a file, or of what an archive unpacks to
MAX_TEXT_BYTES = 1 << 27  # [bytes] of a mesh in text: six hundred thousand facets of an ASCII STL
MAX_READ_FACETS = 2_000_000  # a hundred times what a fed part needs; checked in less than 3 GB
MAX_READ_CORNERS = 3 * MAX_READ_FACETS  # of facets that share none
ANNOUNCES_MORE = "it announces more than it holds"
CARD_FORMAT = "card"
BINARY_STL = "stl"
ASCII_STL = "stl-ascii"
STL_HEADER_BYTES, STL_FACET_BYTES = 84, 50  # [bytes] of a binary STL
FORMAT_HEAD_BYTES = 1 << 16  # [bytes] looked at


@dataclass(frozen=True)
class PartFile:
    """The bytes of a part file and what to call it."""

    source: str  # as given, '-' for standard input
    where: str  # for error lines
    name: str  # file stem, printable
    suffix: str  # lower case, without the dot; '' for standard input
    data: bytes | bytearray
    sha256: str


@dataclass(frozen=True, eq=False)
class CadFaces:
    """The faces of a CAD model that a kernel made into facets, and what their edges say of it."""

    of_facet: Ints  # (F,) int, which face each facet is of
    titles: tuple[str, ...]  # (N,) 'face 4 of 12, a sphere of radius 60 mm'
    leaving: Floats  # (N,) [unit of the file] how far its facets leave the box of edges
    is_turned: Bools  # (N,) whether its facets face the other way than the file and the other faces say
    is_wrong: Bools  # (N,) whether its facets are on the wrong side of its edges

    def of_body(self, facets: Ints) -> "CadFaces":
        """Return the faces as they concern some facets alone.

        Parameters
        ----------
        facets : (K,) int
            Indices of the facets that are kept.

        Returns
        -------
        CadFaces
            Of those K facets. A face with none of them keeps its title, and is neither turned nor wrong.
        """
        used = np.zeros(len(self.titles), dtype=bool)
        used[self.of_facet[facets]] = True
        return CadFaces(
            self.of_facet[facets], self.titles, self.leaving, self.is_turned & used, self.is_wrong & used
        )


@dataclass(frozen=True, eq=False)
class Soup:
    """Triangles as a file has them; corners that coincide are not yet joined."""

    vertices: Points  # (V, 3) [unit of the file] maybe not finite
    faces: Triangles  # (F, 3) int
    format: str  # a key of formats.MESH_FORMATS
    unit: str | None = None  # that the file or its format states
    warnings: tuple[str, ...] = ()
    names: tuple[str, ...] = ()  # of the objects, groups or solids that the file distinguishes; '' for none
    objects: Ints | None = None  # (F,) int, which of ``names`` each facet belongs to
    cad_faces: CadFaces | None = None  # of a CAD file


class DamageError(ValueError):
    """Damage of a file's bytes, in words for the user."""


class TooManyFacetsError(ValueError):
    """A mesh of more corners or facets than are read."""


class CommaError(ValueError):
    """Commas that may not stand for decimal points."""


class BombError(ValueError):
    """An archive that unpacks to more than is read."""


@dataclass(frozen=True)
class Format:
    """Name of a format, and the unit its specification or its files state."""

    title: str
    suffixes: tuple[str, ...]
    needs: tuple[str, ...] = ()  # modules of an extra
    extra: str = ""


MESH_FORMATS = {
    BINARY_STL: Format("binary STL", ("stl",)),
    ASCII_STL: Format("ASCII STL", ("stl",)),
    "obj": Format("OBJ", ("obj",)),
    "ply": Format("PLY", ("ply",)),
    "off": Format("OFF", ("off",)),
    "glb": Format("GLB", ("glb",)),
    "3mf": Format("3MF", ("3mf",)),
    "step": Format("STEP", ("step", "stp", "stpz"), ("cascadio",), "step"),
    CARD_FORMAT: Format("a part card", ("yaml", "yml")),
}
MESH_NAMES = tuple(  # as people say them: 'STL', 'OBJ' ...
    dict.fromkeys(form.title.split()[-1] for kind, form in MESH_FORMATS.items() if kind != CARD_FORMAT)
)
FORMAT_MARKS = (  # pattern at the start of a file, and its format
    (rb"glTF", "glb"),
    (rb"ply[ \t]*[\r\n]", "ply"),
    (rb"(?:#[^\n]*\n|\s)*(?:ST)?C?N?OFF\b", "off"),
    (rb"\s*(?:/\*[^*]*\*/\s*)?ISO-10303-21", "step"),
)
WIDE_TEXT_FAULTS = UTF16_FAULT, UTF32_FAULT = "is text in UTF-16", "is text in UTF-32"
OTHER_FILES = (  # what people save under a mesh's name by mistake
    (re.escape(POINTER_HEAD), POINTER),
    (rb"\xff\xfe\0\0|\0\0\xfe\xff|(?:[\t-~]\0{3}){8}|(?:\0{3}[\t-~]){8}", UTF32_FAULT),
    (rb"\xff\xfe[\t-~]\0|\xfe\xff\0[\t-~]|(?:[\t-~]\0){8}|(?:\0[\t-~]){8}", UTF16_FAULT),
    (rb"(?i)\s*solid\b[^\0]*\bfacet\s+normal[^\0]*\0", "is ASCII STL with NUL bytes in the middle"),
    (rb"(?is)\s*<.{,2000}?(?<=<)(?:!doctype\s+html|html\b|head\b|body\b)", "is an HTML page, not a part"),
    (rb"(?s)\s*<\?xml.*<amf", "is an AMF file, which is not read"),
    (rb"\s*<", "is an XML file, not a part"),
    (rb"PK\x03\x04", "is a ZIP archive without a 3MF model"),
    (rb"\x1f\x8b|7z\xbc\xaf|Rar!", "is a compressed archive"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8|BM", "is a picture, not a part"),
    (rb"%PDF", "is a PDF document, not a part"),
    (rb"\xd0\xcf\x11\xe0", "is a native CAD or Office file, which is not read"),
    (
        rb"(?s)(?:DBRep_DrawableShape)?\s*(?:CASCADE|Open CASCADE) Topology V",
        "is a BREP file, which is not read",
    ),
    (rb"[^\n]{72}S[ 0]{6}1\s", "is an IGES file, which is not read"),
    (rb"\*\*ABCDEFGHIJKLMNOPQRSTUVWXYZ|PS\0\0", "is a Parasolid file, which is not read"),
    (
        rb"\d{3,5} \d+ \d+ \d+\s*\n\d+ (?:\S+ )*|ACIS BinaryFile|ASM BinaryFile",
        "is an ACIS file (SAT), which is not read",
    ),
    (rb"Version \d+\.\d+ +JT ", "is a JT file, which is not read"),
    (rb"#VRML|#X3D", "is a VRML file, which is not read"),
    (rb"\s*0\s*\n\s*SECTION\b|AutoCAD Binary DXF", "is a DXF file, a drawing and not a part"),
    (rb"AC10\d\d", "is a DWG file, a drawing and not a part"),
    (rb"\s*\{", "is a JSON file (glTF is read as .glb only)"),
)
ASCII_ONLY = bytes(byte if byte < 128 else ord("?") for byte in range(256))
OBJ_LINE = re.compile(rb"(?m)^[ \t]*v[ \t]+[-+.\d]\S*[ \t]+[-+.\d]\S*[ \t]+[-+.\d]")
STL_HEAD = re.compile(rb"(?i)(?:\s++|(?:#|//|;)[^\n]*\n)*+(?:solid\b|facet\s+normal\b)")
CARD_LINE = re.compile(rb"(?m)^(?:mass|centre_of_mass|inertia|aspects|floor|track)[ \t]*:")


def detect_format(data: bytes | bytearray, suffix: str = "") -> tuple[str | None, str | None]:
    """Detect the format of a part file by its bytes; the suffix decides only where they do not.

    Parameters
    ----------
    data : bytes
        The whole file: a binary STL is known by its length.
    suffix : str, optional
        Of the file's name: lower case, without the dot.

    Returns
    -------
    format : str or None
        A key of ``MESH_FORMATS`` or ``CARD_FORMAT``; None for a file of no known format.
    alien : str or None
        Where the format is None, what the file is instead: the middle of an error line.
    """
    size = STL_HEADER_BYTES + STL_FACET_BYTES * claimed_facets(data)
    if len(data) > STL_HEADER_BYTES and len(data) == size:
        return BINARY_STL, None
    head = data.rstrip(b"\0")[:FORMAT_HEAD_BYTES].removeprefix(b"\xef\xbb\xbf")
    if head.startswith(b"PK\x03\x04"):
        is_3mf, is_step = re.search(rb"(?i)\.model", data), re.search(rb"(?i)\.ste?p", data)
        kind = "3mf" if is_3mf else "step" if is_step else None
    else:
        kind = next((kind for mark, kind in FORMAT_MARKS if re.match(mark, head, re.DOTALL)), None)
    if kind is None and b"\0" not in head:
        if STL_HEAD.match(head) and re.search(rb"(?i)facet|endsolid", head):
            kind = ASCII_STL
        elif OBJ_LINE.search(head):
            kind = "obj"
        elif suffix == "" and CARD_LINE.search(head):
            kind = CARD_FORMAT
    if kind:
        return kind, None
    alien = next((text for mark, text in OTHER_FILES if re.match(mark, head)), None)
    if alien is None and (suffix == "stl" or (b"\0" in head and len(data) > STL_HEADER_BYTES)):
        return BINARY_STL, None
    return None, alien or "is not a mesh: it has the marks of no known format"


def claimed_facets(data: bytes | bytearray) -> int:
    """Return the facet count in the header of a binary STL.

    Parameters
    ----------
    data : bytes
        The file; its bytes 80 to 83 hold the count, lowest byte first.

    Returns
    -------
    int
        The count as announced: the file may hold another number. Anything where the file is no binary STL.
    """
    return int.from_bytes(data[STL_HEADER_BYTES - 4 : STL_HEADER_BYTES], "little")


def mask_non_ascii(text: bytes) -> bytes:
    """Return the text with '?' for every letter beyond ASCII: numbers have none, names and comments do.

    Parameters
    ----------
    text : bytes

    Returns
    -------
    bytes
        As long as the text.
    """
    return text.translate(ASCII_ONLY)


def refuse_size(corners: int, facets: int) -> None:
    """Refuse numbers of corners or facets, announced or counted so far, that no fed part needs.

    Parameters
    ----------
    corners, facets : int

    Raises
    ------
    TooManyFacetsError
        Above ``MAX_READ_CORNERS`` or ``MAX_READ_FACETS``.
    """
    for count, most, noun in ((facets, MAX_READ_FACETS, "facets"), (corners, MAX_READ_CORNERS, "corners")):
        if count > most:
            raise TooManyFacetsError(f"has more than {most} {noun}")


def refuse_text_size(data: bytes | bytearray) -> None:
    """Refuse a mesh in text that is larger than ``MAX_TEXT_BYTES``.

    Parameters
    ----------
    data : bytes

    Raises
    ------
    TooManyFacetsError
        If it is larger.
    """
    if len(data) > MAX_TEXT_BYTES:
        raise TooManyFacetsError(f"is text of more than {MAX_TEXT_BYTES >> 20} MB")


COMMA_NUMBERS = re.compile(rb"(?:[-+]?(?:\d+(?:,\d*)?|,\d+)(?:[eE][-+]?\d+)?\s*)*")
FORTRAN_EXPONENT = re.compile(rb"(?<=[\d.])[dD](?=[-+]?\d)")
THOUSANDS = re.compile(rb"[-+]?\d{1,3}(?:,\d{3})+")  # thousands, or three decimals


class Decimals:
    """Reads the numbers of one file, and remembers whether they have points or commas."""

    def __init__(self) -> None:
        self.points = self.commas = self.whole = False  # whether there are such, and numbers with neither
        self.fortran = False  # whether there are exponents of D, as Fortran writes them
        self.grouped = True  # whether every comma has three digits behind it

    def read(self, words: list[bytes]) -> Floats:
        """Return words as numbers, and note in which notation they are written.

        Decimal commas are read as decimal points, exponents of D (Fortran) as E. Notations count over all
        calls: a file with points and commas is refused wherever the second turns up.

        Parameters
        ----------
        words : list of bytes
            One number each.

        Returns
        -------
        (N,) float [unit of the file]

        Raises
        ------
        CommaError
            If there are commas in other places than that of a decimal point, points in other numbers, or
            commas that may part thousands.
        ValueError
            If a word is not a number.
        """
        text = b" ".join(words)
        if b"_" in text:
            raise DamageError("an underscore in a number")
        self.points = self.points or b"." in text
        if FORTRAN_EXPONENT.search(text):
            self.fortran = True
            text = FORTRAN_EXPONENT.sub(b"e", text)
            words = text.split()
        if b"," in text:
            self.commas = True
            if not COMMA_NUMBERS.fullmatch(text):
                raise CommaError("a comma in a number")
            self.grouped = self.grouped and all(THOUSANDS.fullmatch(word) for word in words if b"," in word)
            self.whole = self.whole or any(b"," not in word for word in words)
            words = text.replace(b",", b".").split()
        elif words and not self.points:
            self.whole = True
        if self.points and self.commas:
            raise CommaError("numbers with a comma and numbers with a point")
        if self.commas and self.whole and self.grouped:
            raise CommaError("commas that may part thousands or decimals")
        return np.array(words, dtype=float)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return a sentence for each notation that was read in place of the usual one."""
        commas = ("its numbers have decimal commas: read as decimal points",) if self.commas else ()
        return (
            *commas,
            *(("its numbers have exponents of D, as in Fortran: read as E",) if self.fortran else ()),
        )


POINT_FACET_SIZE = 1e-300  # [unit of the file] a facet smaller than that is a point
STRAIGHT_CORNER_SHARE = 1e-9  # [1] of the facet's area: a corner that turns by less does not make a fan
MAX_FACET_CORNERS = 20_000  # of one facet


def split_facets(vertices: Floats, sizes: Ints, corners: Ints) -> tuple[Ints, Ints]:
    """Split facets into triangles, concave ones within their outline, and say which facet each is of.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    sizes : (N,) int
        The number of corners of each facet; one of fewer than three gives no triangle.
    corners : (sum of sizes,) int
        Those corners as rows of ``vertices``, facet after facet.

    Returns
    -------
    triangles : (F, 3) int
        In the order of the facets.
    facet : (F,) int
        The facet that each triangle is of.

    Raises
    ------
    DamageError
        If a facet names a corner that is not there, has more than ``MAX_FACET_CORNERS`` corners, or its
        outline crosses itself.
    """
    if len(corners) and (corners.min() < 0 or corners.max() >= len(vertices)):
        raise DamageError("a facet names a corner that is not there")
    if len(sizes) and sizes.max() > MAX_FACET_CORNERS:
        raise DamageError(f"a facet of more than {MAX_FACET_CORNERS} corners")
    start = np.cumsum(sizes) - sizes
    faces, facet = [np.empty((0, 3), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for size in np.unique(sizes[sizes >= 3]).tolist():
        chosen = np.flatnonzero(sizes == size)
        rings = corners[start[chosen][:, None] + np.arange(size)]
        faces.append(_split(vertices, rings).reshape(-1, 3))
        facet.append(np.repeat(chosen, size - 2))
    order = np.argsort(np.concatenate(facet), kind="stable")
    return np.concatenate(faces)[order], np.concatenate(facet)[order]


def _split(vertices: Points, rings: Ints) -> Ints:
    """(N, S - 2, 3) triangles of N facets of S corners."""
    size = rings.shape[1]
    fan = np.stack([np.zeros(size - 2, dtype=int), np.arange(1, size - 1), np.arange(2, size)], axis=1)
    faces = rings[:, fan]
    if size == 3:
        return faces
    points = np.nan_to_num(vertices[rings], posinf=0.0, neginf=0.0)
    points = points / np.maximum(np.abs(points).max(axis=(1, 2), keepdims=True), POINT_FACET_SIZE)
    points = points - points[:, :1]
    following = np.roll(points, -1, axis=1)
    normals = vectors.cross(points, following).sum(axis=1)  # Newell's: twice the area
    along = following - points
    turns = vectors.cross(np.roll(along, 1, axis=1), along)
    area = vectors.norm(normals)
    rising = np.einsum("nsi,ni->ns", turns, normals)
    concave = ~(rising > STRAIGHT_CORNER_SHARE * area[:, None] ** 2).all(axis=1)
    for ring in np.flatnonzero(concave & (area > 0.0)).tolist():
        axes = vectors.plane_axes(normals[ring] / area[ring])
        flat = vectors.product(points[ring], np.column_stack(axes))
        flat = flat / np.abs(flat).max()  # of a facet with an area
        ears = np.asarray(manifold3d.triangulate([flat]), dtype=np.int64).reshape(-1, 3)
        if len(ears) != size - 2:
            raise DamageError(f"the outline of a facet of {size} corners crosses itself")
        faces[ring] = rings[ring][ears]
    return faces


DAMAGED_ARCHIVE_ERRORS = (zipfile.BadZipFile, zlib.error, lzma.LZMAError)  # what damaged archives raise
MAX_ARCHIVE_MEMBERS = 20_000
MAX_PACKING_RATIO = 200  # of a member's size unpacked: coordinates pack to a tenth or a thirtieth
HARMLESS_SIZE_BYTES = 1 << 24  # [bytes] below it any packing is harmless


def open_archive(data: bytes) -> zipfile.ZipFile:
    """Open a ZIP archive of at most ``MAX_ARCHIVE_MEMBERS`` members.

    Parameters
    ----------
    data : bytes
        The whole archive.

    Returns
    -------
    zipfile.ZipFile
        To be closed by the caller, as by ``with``.

    Raises
    ------
    BombError
        If it has too many members.
    zipfile.BadZipFile, ValueError
        If it is damaged.
    """
    if data.count(b"PK\x01\x02") > MAX_ARCHIVE_MEMBERS:  # the mark of an entry
        raise BombError(f"is an archive of more than {MAX_ARCHIVE_MEMBERS} files")
    try:
        return zipfile.ZipFile(io.BytesIO(data))
    except (NotImplementedError, OSError):  # zipfile's, of a version or an offset of no archive
        raise DamageError("its archive is of a kind that is not read") from None


def unpack_pieces(archive: zipfile.ZipFile, name: str, most: int = MAX_MESH_BYTES) -> Iterator[bytes]:
    """Unpack a member of an archive piece by piece, of a megabyte each.

    Parameters
    ----------
    archive : zipfile.ZipFile
    name : str
        Of the member.
    most : int [bytes], optional
        That it may unpack to.

    Yields
    ------
    bytes

    Raises
    ------
    BombError
        As soon as more is unpacked than ``most``, or than a mesh of its packed size can be.
    ValueError
        If the member is locked by a password, packed in a way that is not read, or damaged.
    """
    entry, size = archive.getinfo(name), 0

    def refuse(size: int) -> None:
        if size > most:
            raise BombError(f"unpacks to more than {most >> 20} MB")
        if size > max(HARMLESS_SIZE_BYTES, MAX_PACKING_RATIO * entry.compress_size):
            raise BombError(f"unpacks to more than {MAX_PACKING_RATIO} times its size")

    refuse(entry.file_size)  # as announced, which may be a lie
    try:
        member = archive.open(name)
    except (OSError, RuntimeError):  # zipfile's, of a password or of a packing that it does not know
        locked = entry.flag_bits & 1  # APPNOTE.TXT of PKWARE, 4.4.4
        how = "locked by a password" if locked else "packed in a way that is not read"
        raise DamageError(f"its archive is {how}") from None
    with member:
        while True:
            try:
                piece = member.read(1 << 20)
            except OSError:  # bz2's
                raise DamageError("its archive is damaged") from None
            if not piece:
                return
            size += len(piece)
            refuse(size)
            yield piece
