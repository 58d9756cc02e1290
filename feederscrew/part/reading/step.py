"""STEP files, tessellated by OpenCASCADE in a process of its own: a damaged file can end that process."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from feederscrew.part.reading.soup import DamageError

FLATNESS, TURN = 0.01, 0.1  # [mm, rad] between a curved face and its facets, and from facet to facet
PATIENCE = 60  # [s]
MOST_MEMORY = 3 << 30  # [bytes]
CONVERT = """
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
sys.exit(cascadio.step_to_glb(source, target, *map(float, tolerances), use_parallel=False))
""".replace("PATIENCE", str(PATIENCE)).replace("MOST_MEMORY", str(MOST_MEMORY))
UNITS = ((rb"CONVERSION_BASED_UNIT\s*\(\s*'INCH", "in"), (rb"\.CENTI\.\s*,\s*\.METRE\.", "cm"))
METRE = rb"SI_UNIT\s*\(\s*\$\s*,\s*\.METRE\."


def glb(data):
    """Convert a STEP file to GLB, in metres.

    Parameters
    ----------
    data : bytes

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        If it cannot be converted.
    """
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "part.step"), Path(folder, "part.glb")
        source.write_bytes(data)
        call = [sys.executable, "-c", CONVERT, str(source), str(target), str(FLATNESS), str(TURN)]
        try:
            done = subprocess.run(call, capture_output=True, timeout=PATIENCE, check=False)
        except subprocess.TimeoutExpired:
            raise DamageError(f"not converted within {PATIENCE} s") from None
        if done.returncode != 0 or not target.exists():
            raise DamageError("OpenCASCADE cannot convert it")
        return target.read_bytes()


def unit(data):
    """Return the length unit a STEP file is drawn in; millimetres where it does not tell."""
    for pattern, name in UNITS:
        if re.search(pattern, data):
            return name
    return "m" if re.search(METRE, data) else "mm"
