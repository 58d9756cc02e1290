"""STEP, made into triangles by OpenCASCADE in a process of its own."""

import importlib.util
import re
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path, PurePosixPath

import numpy as np

from feederscrew.base import units
from feederscrew.base.errors import MeshError
from feederscrew.base.units import listed, quantity_text
from feederscrew.part import cad_faces, glb
from feederscrew.part.formats import MESH_FORMATS, DamageError, Soup, open_archive, unpack_pieces

TESSELLATION_MM, TESSELLATION_RAD = 0.01, 0.1  # between a curved face and its facets, and from facet to facet
STEP_TIMEOUT_S = 60  # [s]
STEP_MEMORY_BYTES = 3 << 30  # [bytes]
CONVERT_STEP_SCRIPT = """
import ctypes, signal, sys
if sys.platform == "linux":
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # it ends when its parent does, however that ends
if hasattr(signal, "alarm"):
    signal.alarm(PATIENCE + 5)  # and after its time in any case
try:
    import resource  # what it needs beyond that is no fed part
    least = min(bytes for bytes in (MOST_MEMORY, *resource.getrlimit(resource.RLIMIT_AS)) if bytes > 0)
    resource.setrlimit(resource.RLIMIT_AS, (least, least))
except (ImportError, ValueError, OSError):
    pass
import cascadio
source, target, *tolerances = sys.argv[1:]
sys.exit(cascadio.step_to_glb(source, target, *map(float, tolerances), use_parallel=False, include_brep=True))
""".replace("PATIENCE", str(STEP_TIMEOUT_S)).replace("MOST_MEMORY", str(STEP_MEMORY_BYTES))
STEP_UNIT_PATTERNS = (  # the first that a file has; millimetres where there is none
    (rb"CONVERSION_BASED_UNIT\s*\(\s*'INCH", "in"),
    (rb"\.CENTI\.\s*,\s*\.METRE\.", "cm"),
    (rb"SI_UNIT\s*\(\s*\$\s*,\s*\.METRE\.", "m"),
)

LISTED_REFERENCES = 5  # names of other files in one line
STEP_REFERENCE = re.compile(  # of "External References", MBx Interoperability Forum
    rb"\b(?:DOCUMENT_FILE|EXTERNAL_SOURCE|\w*EXTERNAL_IDENTIFICATION_ASSIGNMENT)\s*\(([^;]{0,2000})\)\s*;"
)
STEP_FILE_NAME = re.compile(
    rb"'([^']{1,200}\.(?:stpx?z?|step|p21|prt|sldprt|ipt|catpart|par|jt))'", re.IGNORECASE
)


def read_step(data: bytes, where: str) -> Soup:
    """Return the triangles of a STEP file, in the unit it was drawn in; objects are its solids.

    Parameters
    ----------
    data : bytes
        The whole file, or a ZIP archive of one (.stpz).
    where : str
        The file, for error lines.

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If cascadio is not installed.
    ValueError
        If the file is damaged, or its conversion takes too long.
    """
    format = MESH_FORMATS["step"]
    if not all(importlib.util.find_spec(module) for module in format.needs):
        what = f"{format.title} needs {' and '.join(format.needs)}, not installed"
        raise MeshError(where, what, f'pip install "feederscrew[{format.extra}]"')
    if data.startswith(b"PK"):  # zipped (.stpz)
        with open_archive(data) as archive:
            names = archive.namelist()
            members = [name for name in names if re.search(r"(?i)\.ste?p$", PurePosixPath(name).name)]
            if len(members) != 1:
                raise DamageError(f"an archive of {len(members)} STEP files")
            data = b"".join(unpack_pieces(archive, members[0]))
    unit = next((name for pattern, name in STEP_UNIT_PATTERNS if re.search(pattern, data)), "mm")
    others = _referred_files(data)
    titles_of_others = listed([quantity_text(name) for name in others[:LISTED_REFERENCES]]) if others else ""
    beyond = f" and {len(others) - LISTED_REFERENCES} more" if len(others) > LISTED_REFERENCES else ""
    try:
        document = glb.Document(convert(data), where)
        pieces = list(document.pieces())
    except DamageError:
        if not others:
            raise
        pieces = []
    if others and not pieces:
        what = f"has no shape of its own, it refers to {titles_of_others}{beyond}"
        raise MeshError(where, what, "give one of those files, or export the assembly as one file")
    titles = {piece.instance: piece.mesh or piece.node for piece in pieces}
    soup = glb.merge(pieces, tuple(titles.values()), "step", unit)
    faces = cad_faces.find_cad_faces(document, pieces, data, unit)
    # facets without area, at poles of spheres and tips of cones
    places = soup.vertices[soup.faces]
    whole = np.flatnonzero((places != np.roll(places, 1, axis=1)).any(axis=2).all(axis=1))
    return replace(
        soup,
        vertices=soup.vertices / units.factor(unit, "length"),  # from metres
        faces=soup.faces[whole],
        objects=None if soup.objects is None else soup.objects[whole],
        cad_faces=faces.of_body(whole),
        warnings=(*soup.warnings, f"refers to {titles_of_others}{beyond}: left out")
        if others
        else soup.warnings,
    )


def _referred_files(data: bytes) -> list[str]:
    """Names of the CAD files that a STEP file refers to, each once, as they come."""
    names: dict[str, None] = {}
    for entity in STEP_REFERENCE.finditer(data):
        for name in STEP_FILE_NAME.findall(entity[1]):
            names.setdefault(name.decode("utf-8", errors="replace"))
    return list(names)


def convert(data: bytes) -> bytes:
    """Return a STEP file as GLB, in metres, converted by OpenCASCADE in a process of its own.

    Parameters
    ----------
    data : bytes
        The whole STEP file.

    Returns
    -------
    bytes

    Raises
    ------
    DamageError
        If OpenCASCADE cannot convert it, or takes longer than ``STEP_TIMEOUT_S``.
    """
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "part.step"), Path(folder, "part.glb")
        source.write_bytes(data)
        arguments = [str(each) for each in (source, target, TESSELLATION_MM, TESSELLATION_RAD)]
        call = [sys.executable, "-c", CONVERT_STEP_SCRIPT, *arguments]
        try:
            done = subprocess.run(call, capture_output=True, timeout=STEP_TIMEOUT_S, check=False)
        except subprocess.TimeoutExpired:
            raise DamageError(f"not converted within {STEP_TIMEOUT_S} s") from None
        if done.returncode != 0 or not target.exists():
            raise DamageError("OpenCASCADE cannot convert it")
        return target.read_bytes()
