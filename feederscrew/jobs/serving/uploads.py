"""Part files that a browser sent: each with an id, its name and the unit in which it is read."""

import itertools
import shutil
import threading
from dataclasses import dataclass
from pathlib import Path

from feederscrew import bowl as bowls
from feederscrew.arrivals.aspects_study import aspects
from feederscrew.base.errors import Detail, FeederError, printable
from feederscrew.base.units import MM
from feederscrew.jobs.serving.refusal import Refusal, in_words_of_the_page
from feederscrew.output.folder import safe_name
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import Chapter, Page, Table
from feederscrew.output.report_page import aspect_views
from feederscrew.part import load
from feederscrew.part.formats import CARD_FORMAT, MESH_FORMATS
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.orientations import orientations

PART_BYTES = 64 * 2**20  # that a part file may have
KEPT_BYTES = 1024 * 2**20  # of all part files that are kept: the oldest that no design needs go
BOWL_BYTES = 256 * 2**10
BOWL_ENDINGS = ("yaml", "yml")
MOST_UPLOADS = 200  # part files of one run
ENDINGS = tuple(
    suffix for name, form in MESH_FORMATS.items() if name != CARD_FORMAT for suffix in form.suffixes
)
UNITS = ("mm", "cm", "m", "um", "in")
NAME_LETTERS = 80  # of a file name that is shown
STEM_BYTES = 120  # of the name of a file or folder that is made of it
NO_PART = "that part is not here - drop its file on the page"


@dataclass(frozen=True, eq=False)
class Upload:
    """A part file that could be read, in one unit."""

    id: str
    name: str  # as it is shown
    units: str
    path: Path
    size_mm: tuple[float, float, float]  # of its box, as it lies in the file
    aspects: tuple[str, ...]
    lies: dict[str, str]  # how it lies on each aspect that is stable: 'on its largest face'
    headings: dict[str, tuple[str, ...]]  # [deg] at which it comes along the track, by its stable aspects

    @property
    def document(self) -> dict[str, object]:
        """Return the upload as the page gets it, as JSON has it."""
        return {
            "id": self.id,
            "name": self.name,
            "units": self.units,
            "size_mm": self.size_mm,
            "aspects": self.aspects,
            "lies": self.lies,
            "headings": self.headings,
        }

    def view(self) -> str:
        """Return the page of its resting aspects."""
        return (self.path.parent / "view.html").read_text(encoding="utf-8")


@dataclass(frozen=True)
class BowlUpload:
    """The file of a bowl at hand."""

    id: str
    name: str  # as it is shown
    path: Path

    @property
    def document(self) -> dict[str, str]:
        """Return the file as the page gets it, as JSON has it."""
        return {"id": self.id, "name": self.name}


class Uploads:
    """The part files of one run, each in a folder of its own below ``folder``.

    The name of a file is shown, and its letters name the file and its results; it is never used as a path.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.kept: dict[str, Upload] = {}  # by id, the oldest first
        self.bowls: dict[str, BowlUpload] = {}
        self._numbers = itertools.count(1)
        self._one_at_a_time = threading.Lock()

    def find(self, key: object) -> Upload:
        """Return an upload by its id.

        Parameters
        ----------
        key : object
            As a browser sent it.

        Returns
        -------
        Upload

        Raises
        ------
        Refusal
            If there is none.
        """
        upload = self.kept.get(key) if isinstance(key, str) else None
        if upload is None:
            raise Refusal(409, NO_PART)
        return upload

    def take(self, name: str, units: str, data: bytes, needed: frozenset[str] = frozenset()) -> Upload:
        """Keep a part file and read it.

        Parameters
        ----------
        name : str
            As the browser has it.
        units : str
            One of UNITS, in which its lengths are.
        data : bytes
            Its content.
        needed : frozenset of str
            Ids of uploads that are kept, whatever room they take.

        Returns
        -------
        Upload

        Raises
        ------
        Refusal
            If it is no part file, cannot be read or kept: then nothing of it is kept, and nothing else goes.
        """
        shown = printable(name)[-NAME_LETTERS:]
        stem, _, ending = shown.rpartition(".")
        ending = ending.lower()
        if not stem or ending not in ENDINGS:
            raise Refusal(415, f"{shown}: not a part file - give one that ends in .{', .'.join(ENDINGS)}")
        if units not in UNITS:
            raise Refusal(400, f"length unit {printable(units)[:20]} - choose one of {', '.join(UNITS)}")
        with self._one_at_a_time:
            number = next(self._numbers)
            if number > MOST_UPLOADS:
                raise Refusal(429, f"{MOST_UPLOADS} files were sent in this run - start feeder serve again")
            folder = self.folder / str(number)
            try:
                upload = self._read(str(number), shown, units, folder / f"{_file_stem(stem)}.{ending}", data)
            except BaseException:
                shutil.rmtree(folder, ignore_errors=True)
                raise
            self.kept[upload.id] = upload
            self._tidy(needed | {upload.id})
        return upload

    def read_again(self, key: object, units: str, needed: frozenset[str] = frozenset()) -> Upload:
        """Return an upload of the same file in another unit, which has an id of its own.

        Parameters
        ----------
        key : object
            The id of the upload.
        units : str
            One of UNITS. In the unit that the upload has, it is returned itself.
        needed : frozenset of str, optional
            Ids of uploads that are kept, whatever room they take.

        Returns
        -------
        Upload

        Raises
        ------
        Refusal
            If there is no such upload, or it cannot be read in that unit.
        """
        before = self.find(key)
        if before.units == units:
            return before
        return self.take(before.name, units, before.path.read_bytes(), needed)

    def find_bowl(self, key: object) -> BowlUpload:
        """Return a bowl file by its id.

        Parameters
        ----------
        key : object
            As a browser sent it.

        Returns
        -------
        BowlUpload

        Raises
        ------
        Refusal
            If there is none.
        """
        bowl = self.bowls.get(key) if isinstance(key, str) else None
        if bowl is None:
            raise Refusal(409, "that bowl file is not here - choose it again")
        return bowl

    def take_bowl(self, name: str, data: bytes) -> BowlUpload:
        """Keep a bowl file that can be read.

        Parameters
        ----------
        name : str
            As the browser has it.
        data : bytes
            Its content.

        Returns
        -------
        BowlUpload

        Raises
        ------
        Refusal
            If it is no bowl file, or cannot be read: then nothing of it is kept.
        """
        shown = printable(name)[-NAME_LETTERS:]
        stem, _, ending = shown.rpartition(".")
        if not stem or ending.lower() not in BOWL_ENDINGS:
            raise Refusal(
                415, f"{shown}: not a bowl file - give one that ends in .{', .'.join(BOWL_ENDINGS)}"
            )
        with self._one_at_a_time:
            number = next(self._numbers)
            if number > MOST_UPLOADS:
                raise Refusal(429, f"{MOST_UPLOADS} files were sent in this run - start feeder serve again")
            path = self.folder / str(number) / f"{_file_stem(stem)}.yaml"
            try:
                path.parent.mkdir(parents=True)
                path.write_bytes(data)
                bowls.read(path)
            except FeederError as fault:
                shutil.rmtree(path.parent, ignore_errors=True)
                lines = " ".join(fault.lines).replace(str(path), shown)
                raise Refusal(422, in_words_of_the_page(lines, "mend the file")) from fault
            except BaseException:
                shutil.rmtree(path.parent, ignore_errors=True)
                raise
            bowl = self.bowls[str(number)] = BowlUpload(str(number), shown, path)
        return bowl

    def _read(self, key: str, name: str, units: str, path: Path, data: bytes) -> Upload:
        path.parent.mkdir(parents=True)
        path.write_bytes(data)
        try:
            study = aspects(load(str(path), units=units))
            table = study.table().only(("aspect", "lies", "stable", "height_mm"))
            blocks = *aspect_views(study.part, study), Table(table)
            told = (text for text in study.aspects.warnings if not isinstance(text, Detail))
            warnings = tuple(map(in_words_of_the_page, told))
            view = html(Page(name, "", (Chapter(blocks, warnings=warnings),), "aspects"))
        except FeederError as fault:
            lines = " ".join(fault.lines).replace(str(path), name)
            raise Refusal(422, in_words_of_the_page(lines)) from fault
        (path.parent / "view.html").write_text(view, encoding="utf-8")
        corners = study.part.corners / MM
        size = (corners.max(axis=0) - corners.min(axis=0)).tolist()
        rows = [row for row in table.rows() if row["stable"]]
        headings = {row["aspect"]: () for row in rows} | _headings(study.part, study.aspects)
        lies = {row["aspect"]: str(row["lies"]) for row in rows}
        names = tuple(study.aspects.names)
        return Upload(key, name, units, path, (size[0], size[1], size[2]), names, lies, headings)

    def _tidy(self, needed: frozenset[str]) -> None:
        """Forget the oldest files that no design needs, until the others are within KEPT_BYTES."""
        sizes = {key: upload.path.stat().st_size for key, upload in self.kept.items()}
        for key in list(self.kept):
            if sum(sizes.values()) <= KEPT_BYTES:
                break
            if key not in needed:
                shutil.rmtree(self.kept.pop(key).path.parent, ignore_errors=True)
                del sizes[key]


def _headings(part: Part, resting: Aspects) -> dict[str, tuple[str, ...]]:
    """The headings [deg] at which a part comes along a track, as its orientations are named, by aspect."""
    by_aspect: dict[str, tuple[str, ...]] = {}
    try:
        coming = orientations(part, resting, bowls.default().track)
    except FeederError:  # too large for that bowl: the design says what it needs
        return by_aspect
    for orientation in coming:
        aspect, _, heading = orientation.name.partition("@")
        by_aspect[aspect] = (*by_aspect.get(aspect, ()), heading)
    return by_aspect


def _file_stem(stem: str) -> str:
    """The name of a part as a file may have it: no path, no option, no hidden file."""
    letters = safe_name(stem).lstrip(".-_ ") or "part"
    return letters.encode("utf-8", "replace")[:STEM_BYTES].decode("utf-8", "ignore")
