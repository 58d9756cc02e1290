"""Files of `feeder sample`: by name, and parts of the families by their sizes.

The files of ``parts/`` are data of the package: a wheel has them as ``feederscrew/jobs/samples/parts``.
"""

import difflib
import secrets
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from feederscrew.base.columns import Column
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.bowl.documentation import template
from feederscrew.jobs.samples import families, solids

HERE = Path(__file__).parent
PART_FOLDERS = HERE / "parts", HERE.parents[2] / "parts"  # of a wheel, and of the sources
TOOLING = """# Tooling for lbracket_30x20x15.stl: feeder trial lbracket_30x20x15.stl --config tooling.yaml
drive:
  peak_to_peak: 0.3 mm
  frequency: 50 Hz
  vibration_angle: 25 deg
friction:
  static: 0.5
  kinetic: 0.4
track:
  width: 25 mm
devices:  # along the track, in the order parts meet them
  - wiper: 22 mm
  - gap: 9.35 mm
"""
COUNTS = """# Simulated, for an example: feeder drop lbracket_30x20x15.stl --drops 300 --seed 7
aspect,count
A,112
B,71
C,45
D,58
E,14
"""


GENERATED = {"bowl": template, "tooling": lambda: TOOLING, "counts": lambda: COUNTS}
FILES = {  # name: file and what it is; those that are not generated lie in the folder of the parts
    "washer_m6": ("washer_m6.stl", "plain washer M6, ISO 7089"),
    "squarenut_m5": ("squarenut_m5.stl", "square nut M5, DIN 557"),
    "hexbolt_m8x25": ("hexbolt_m8x25.stl", "hexagon bolt M8 x 25, ISO 4017"),
    "shcs_m3x8_simple": ("shcs_m3x8_simple.stl", "socket head cap screw M3 x 8, ISO 4762"),
    "dowel_6x20": ("dowel_6x20.stl", "dowel pin 6 x 20"),
    "key_a_d12x20": ("key_a_d12x20.stl", "parallel key for a shaft of 12 mm"),
    "cap_14x10": ("cap_14x10.stl", "deep drawn cap, 14 x 10 mm"),
    "lbracket_30x20x15": ("lbracket_30x20x15.stl", "bracket of 2 mm sheet with two holes"),
    "arc_chute": ("arc_chute.yaml", "the thesis's Arc Chute: inertia and aspects, no shape"),
    "magnet": ("magnet.yaml", "the thesis's Magnet: the same"),
    "bowl": ("bowl.yaml", "a bowl file of all defaults, each key with its meaning"),
    "tooling": ("tooling.yaml", "a bowl file with two devices for lbracket_30x20x15"),
    "counts": ("counts.csv", "counts of dropped parts, of lbracket_30x20x15"),
}


@dataclass(frozen=True)
class Sample:
    """A line of the list that `feeder sample` prints."""

    call: str  # what to type behind `feeder sample`
    file: str  # that it writes
    meaning: str


SAMPLE_COLUMNS: tuple[Column[Sample], ...] = (
    Column("call", lambda sample: sample.call),
    Column("file", lambda sample: sample.file),
    Column("meaning", lambda sample: sample.meaning),
)


def samples() -> list[Sample]:
    """Return every sample: the files, then each family with a size of it.

    Returns
    -------
    list of Sample
        In the order in which `feeder sample` lists them.
    """
    rows = [Sample(name, *row) for name, row in FILES.items()]
    for family in families.FAMILIES.values():
        file = f"{families.shape(family.name, family.size).name}.stl"
        rows.append(Sample(f"{family.name} {family.size}".strip(), file, family.meaning))
    return rows


def files(
    name: str, size: str = "", *, ratio: float | None = None, wall: float | None = None, step: bool = False
) -> dict[str, bytes]:
    """Return the contents of the files of a sample, by their names.

    Parameters
    ----------
    name : str
        Of a file, 'washer_m6', or of a family, 'hex-bolt'.
    size : str, optional
        Of a family, 'M8x25': ``families.shape``.
    ratio : float [1], optional
        Thickness over width of 't-shape'.
    wall : float [m], optional
        Thickness of what is made of sheet.
    step : bool, optional
        The exact faces of a part beside its mesh. Those of a family need OpenCASCADE.

    Returns
    -------
    dict of str to bytes
        One file, or two with ``step``.

    Raises
    ------
    ArgumentError
        If there is no such sample, or it has no such size or file.
    MissingPackage
        If ``step`` needs OpenCASCADE, which is not installed.
    """
    if name in families.FAMILIES:
        shape = families.shape(name, size, ratio=ratio, wall=wall)
        meshed = {f"{shape.name}.stl": solids.stl(shape)}
        return meshed | ({f"{shape.name}.step": solids.step(shape)} if step else {})
    if name not in FILES:
        near = difflib.get_close_matches(name.casefold(), [*FILES, *families.FAMILIES], n=1)
        mend = f"did you mean {near[0]}? " if near else ""
        raise ArgumentError("name", f"{name!r} is no sample", mend + "`feeder sample` alone lists them")
    for option, value in (("size", size or None), ("ratio", ratio), ("wall", wall)):
        if value is not None:
            what = f"{name} is one file, of one size"
            raise ArgumentError(option, what, f"leave it out, or name one of {', '.join(families.FAMILIES)}")
    file = FILES[name][0]
    if name in GENERATED:
        contents = {file: GENERATED[name]().encode()}
    else:
        contents = {file: (_part_folder() / file).read_bytes()}
    if step:
        exact = _part_folder() / f"{name}.step"
        if not exact.exists():
            raise ArgumentError("step", f"there is none of {name} here", "leave it out")
        contents[exact.name] = exact.read_bytes()
    return contents


def all_files() -> dict[str, bytes]:
    """Return the contents of the files that the examples of the commands name, by their names.

    Returns
    -------
    dict of str to bytes
        Those of ``FILES``; families have no file of their own.
    """
    return {file: content for name in FILES for file, content in files(name).items()}


def write(contents: dict[str, bytes], folder: Path, *, replace: bool = False) -> tuple[list[str], list[str]]:
    """Write files into a folder, all of them or none.

    Parameters
    ----------
    contents : dict of str to bytes
        By the names of the files.
    folder : Path
    replace : bool, optional
        Whether files of other content are replaced.

    Returns
    -------
    written, alike : list of str
        The names of files that were written, and of those that were there with the same content.

    Raises
    ------
    FeederError
        If a file is there with other content, unless ``replace``, or cannot be written.
    """
    paths = {name: folder / name for name in contents}
    alike = [name for name, path in paths.items() if path.is_file() and path.read_bytes() == contents[name]]
    fresh = [name for name in contents if name not in alike]
    if not replace:
        _check_free([paths[name] for name in fresh])
    _put(paths, contents, fresh)
    return fresh, alike


def _part_folder() -> Path:
    """The folder of the parts, in a wheel or in the sources."""
    for folder in PART_FOLDERS:
        if (folder / "washer_m6.stl").exists():
            return folder
    raise FeederError(PART_FOLDERS[0], "is not there", "install feederscrew again")


def _check_free(paths: Iterable[Path]) -> None:
    for path in paths:
        if path.exists() or path.is_symlink():
            what = "is a folder" if path.is_dir() else "exists already, with other content"
            mend = "rename it" if path.is_dir() else "rename it, or pass `replace` to write over it"
            raise FeederError(path.name, what, mend)


def _put(paths: dict[str, Path], contents: dict[str, bytes], names: Sequence[str]) -> None:
    """Write each under another name first: a full disk leaves no half file."""
    staged = {name: paths[name].with_name(f".{name}.{secrets.token_hex(4)}") for name in names}
    try:
        for name, path in staged.items():
            path.write_bytes(contents[name])
        for name, path in staged.items():
            path.replace(paths[name])
    except OSError as error:
        what = f"cannot be written ({error.strerror})"
        raise FeederError(error.filename or "the files", what, "go to a folder of yours") from None
    finally:
        for path in staged.values():
            path.unlink(missing_ok=True)
