"""DXF files, the one door to ezdxf: closed polylines read from a layer, and drawings written."""

import contextlib
import io
import logging
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from feederscrew import units
from feederscrew.errors import DAMAGE, ConfigError

MILLIMETRES = {0: 1.0, 1: 25.4, 4: 1.0, 5: 10.0, 6: 1000.0}  # by $INSUNITS; 0 states none
IN_MILLIMETRES = 4  # of $INSUNITS
FARTHEST = 1e3  # [m] from the origin of a drawing to a corner of a hole
LETTERS = 3.0  # [mm] height of texts


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer of a drawing."""

    name: str
    colour: int  # of AutoCAD's index: 1 red, 3 green, 5 blue, 7 white or black, 8 grey
    rings: tuple = ()  # of (K, 2) [m], each becomes a closed polyline
    lines: tuple = ()  # of (K, 2) [m], each becomes an open polyline
    texts: tuple[tuple[str, tuple[float, float]], ...] = ()  # with the place [m] where each begins


def closed_polylines(path: Path, layer: str, where: str) -> list[list[tuple[float, float]]]:
    """Read the closed polylines of one layer.

    Parameters
    ----------
    path : Path
    layer : str
    where : str
        Of the file's name in the bowl file, for the fault.

    Returns
    -------
    list of list of (float, float) [m]

    Raises
    ------
    ConfigError
        If the file cannot be read as DXF or has no such layer.
    """
    import ezdxf

    logging.getLogger(ezdxf.__name__).setLevel(logging.CRITICAL)  # our line says what is wrong
    try:
        found = _rings(ezdxf.readfile(path), layer)
    except FileNotFoundError:
        raise ConfigError(where, f"{path}: no such file", "check the path") from None
    except (*DAMAGE, ezdxf.DXFError):  # type: ignore[misc]
        raise ConfigError(
            where, f"{path} cannot be read as DXF", "save it as ASCII DXF R2000 or later"
        ) from None
    if not all(abs(place) <= FARTHEST for ring in found for corner in ring for place in corner):
        what = f"{path.name} has a corner farther than {FARTHEST:g} m from its origin, or at no finite place"
        raise ConfigError(where, what, "check the drawing's units, and save it again")
    if not found:
        what = f"{path.name} has no closed polyline on layer {units.shown(layer)}"
        raise ConfigError(where, what, "draw the hole as one closed polyline (LWPOLYLINE)")
    return found


def _rings(drawing: Any, layer: str) -> list[list[tuple[float, float]]]:
    """Corners (x, y) [m] of each closed polyline on a layer."""
    size = MILLIMETRES.get(drawing.units, 1.0) * 1e-3
    lines = drawing.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]') if _named(layer) else []
    return [[(x * size, y * size) for x, y in line.get_points("xy")] for line in lines if line.closed]


def written(layers: Iterable[Layer]) -> bytes:
    """Return a drawing as the bytes of a DXF file in millimetres, the same for the same layers.

    Parameters
    ----------
    layers : sequence of Layer

    Returns
    -------
    bytes
    """
    import ezdxf

    with _without_a_date(ezdxf.options):
        drawing = ezdxf.new("R2010", units=IN_MILLIMETRES)
        drawing.header["$MEASUREMENT"] = 1  # metric
        space = drawing.modelspace()
        for layer in layers:
            drawing.layers.add(layer.name, color=layer.colour)
            _draw(space, layer)
        # ezdxf would add those that it needs in the order of a set, another one in each process
        for kind in sorted(drawing.entitydb.dxf_types_in_use()):
            drawing.classes.add_class(kind)
        file = io.StringIO()
        drawing.write(file)
    return file.getvalue().encode()


def _draw(space: Any, layer: Layer) -> None:
    look = {"layer": layer.name}
    for closed, lines in ((True, layer.rings), (False, layer.lines)):
        for line in lines:
            corners = [(1e3 * float(x), 1e3 * float(y)) for x, y in line]
            space.add_lwpolyline(corners, close=closed, dxfattribs=look)
    for text, place in layer.texts:
        space.add_text(text, height=LETTERS, dxfattribs=look).set_placement([1e3 * float(x) for x in place])


@contextlib.contextmanager
def _without_a_date(options: Any) -> Iterator[None]:
    """Let ezdxf write neither a date nor a fresh identity into the file."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def _named(layer: str) -> bool:
    return layer.replace("_", "").replace("-", "").isalnum()
