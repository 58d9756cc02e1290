"""A file of launches: how each toss of a part began, and where it came to rest if that was measured."""

import hashlib
import math
import re
from dataclasses import dataclass

import numpy as np

from feederscrew import check, documents
from feederscrew.errors import FeederError
from feederscrew.resting.counts.count_rows import Few, cells
from feederscrew.units import QuantityError, decimal, quantity_text

POSITION, ATTITUDE = ("x0_m", "y0_m", "z0_m"), ("qw0", "qx0", "qy0", "qz0")
VELOCITY, SPIN = ("vx0", "vy0", "vz0"), ("wx0", "wy0", "wz0")
STATE = (*POSITION, *ATTITUDE, *VELOCITY, *SPIN)
END, FACE = ("xe_m", "ye_m"), "face_up_end"
FACES = ("-x", "+x", "-y", "+y", "-z", "+z")  # sides of a part by the axes of its file
CAMERA = re.compile(r"frames_(\d+(?:\.\d+)?)Hz")
UNIT = 0.02  # [1] that the length of a quaternion may differ from 1 by
FASTEST, MOST_SPIN, FURTHEST = 1e3, 1e4, 1e3  # [m/s], [rad/s], [m]: beyond, the unit is not SI
LARGEST, ROWS = 5_000_000, 5_000  # [bytes], tosses
EXAMPLE = f"give the columns toss,{','.join(STATE)} in SI units"


@dataclass(frozen=True, eq=False)
class LaunchFile:
    """N launches of one part, each a state over the plane z = 0, and their measured ends."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    names: tuple[str, ...]  # of the tosses, as they stand in the file
    lines: tuple[int, ...]  # of the file
    positions: np.ndarray  # (N, 3) [m] of the centre of mass
    attitudes: np.ndarray  # (N, 4) unit quaternions w x y z, from the file's axes to the plane's
    velocities: np.ndarray  # (N, 3) [m/s] of the centre of mass
    spins: np.ndarray  # (N, 3) [rad/s] in the axes of the part file
    frame: float  # [s] from one picture of the camera to the next; 0 where the file does not say
    ends: np.ndarray | None  # (N, 2) [m] where the centre of mass came to rest, as measured
    faces: tuple[str, ...] | None  # (N,) of FACES: what points up at rest, as measured


def read(path):
    """Read a file of launches.

    Parameters
    ----------
    path : str or Path
        CSV in SI units: a column ``toss`` and those of STATE; ``xe_m``, ``ye_m`` and ``face_up_end`` where
        the end was measured; a column ``frames_148Hz`` says how many pictures a second the camera took.
        Lines that begin with '#' and other columns are left out.

    Returns
    -------
    LaunchFile

    Raises
    ------
    Faults
        Every fault of the file, one a line.
    FeederError
        If it cannot be read, is empty, too large or lacks a column.
    """
    data = documents.content(path, LARGEST, "a CSV file of launches", FeederError)
    if len(data) > LARGEST:
        raise FeederError(path, f"has more than {LARGEST // 1_000_000} MB", "split the file")
    header, rows = _table(documents.decoded(data, str(path)), str(path))
    few = Few(str(path))
    for number, row in rows:
        _checked(header, row, f"{path}:{number}", few)
    few.raise_any()
    return _launches(header, rows, str(path), hashlib.sha256(data).hexdigest())


def _table(text, where):
    """Header, and rows with the numbers of their lines, each a dict of cells by column."""
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip(", \t")]
    lines = [(k, line) for k, line in lines if not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise FeederError(where, "has no launch", EXAMPLE)
    if len(lines) > ROWS + 1:
        raise FeederError(where, f"has more than {ROWS} launches", "split the file")
    first, header = lines[0][0], cells(where, *lines[0], EXAMPLE)
    lacking = [name for name in ("toss", *STATE) if name not in header]
    if lacking:
        raise FeederError(f"{where}:{first}", f"there is no column {lacking[0]}", EXAMPLE)
    twice = [name for name in header if name and header.count(name) > 1]
    if twice:
        raise FeederError(f"{where}:{first}", f"column {twice[0]} is given twice", "keep one of them")
    split = [(number, cells(where, number, line, EXAMPLE)) for number, line in lines[1:]]
    return header, [(number, dict(zip(header, row))) for number, row in split]


def _checked(header, row, where, few):
    """Add what is wrong with one launch to the faults."""
    wanted = (*STATE, *(END if set(END) <= set(header) else ()))
    bad = [name for name in wanted if not _is_number(row.get(name, ""))]
    for name in bad:
        few.add(
            where, f"{name}: {quantity_text(row.get(name, ''))} is not a number", "give a number in SI units"
        )
    if not row["toss"]:
        few.add(where, "the toss has no name", "give each launch a name or number of its own")
    if FACE in header and row.get(FACE, "") not in FACES:
        what = f"{FACE}: {quantity_text(row.get(FACE, ''))} is not a side of the part"
        few.add(where, what, f"give one of {', '.join(FACES)}")
    if bad:
        return
    size = math.hypot(*(float(row[name]) for name in ATTITUDE))
    if abs(size - 1.0) > UNIT:
        few.add(where, f"the quaternion has the length {size:.3g}", "give one of length 1, as w x y z")
    for names, most, what in (
        (POSITION, FURTHEST, "m"),
        (VELOCITY, FASTEST, "m/s"),
        (SPIN, MOST_SPIN, "rad/s"),
    ):
        for name in names:
            if abs(float(row[name])) > most:
                few.add(where, f"{name} is {row[name]}", f"give {what}, from {-most:g} to {most:g}")


def _is_number(text):
    try:
        decimal(text)
    except QuantityError:
        return False
    return True


def _launches(header, rows, source, digest):
    """The record of a table without faults."""

    def columns(names):
        return check.frozen(np.array([[float(row[name]) for name in names] for _, row in rows]))

    attitudes = columns(ATTITUDE)
    rate = next((float(match[1]) for match in map(CAMERA.fullmatch, header) if match), 0.0)
    return LaunchFile(
        source=source,
        sha256=digest,
        names=tuple(row["toss"] for _, row in rows),
        lines=tuple(number for number, _ in rows),
        positions=columns(POSITION),
        attitudes=check.frozen(attitudes / np.sqrt((attitudes**2).sum(axis=1))[:, None]),
        velocities=columns(VELOCITY),
        spins=columns(SPIN),
        frame=1.0 / rate if rate > 0.0 else 0.0,
        ends=columns(END) if set(END) <= set(header) else None,
        faces=tuple(row[FACE] for _, row in rows) if FACE in header else None,
    )
