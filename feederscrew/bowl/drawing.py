"""Closed polylines of a DXF file."""

from feederscrew import units
from feederscrew.errors import ConfigError

MILLIMETRES = {0: 1.0, 1: 25.4, 4: 1.0, 5: 10.0, 6: 1000.0}  # by $INSUNITS; 0 states none


def closed_polylines(path, layer, where):
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

    try:
        drawing = ezdxf.readfile(path)
    except FileNotFoundError:
        raise ConfigError(where, f"{path}: no such file", "check the path") from None
    except (OSError, ezdxf.DXFError, UnicodeDecodeError, ValueError):
        raise ConfigError(
            where, f"{path} cannot be read as DXF", "save it as ASCII DXF R2000 or later"
        ) from None
    size = MILLIMETRES.get(drawing.units, 1.0) * 1e-3
    lines = drawing.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]') if _named(layer) else []
    found = [[(x * size, y * size) for x, y in line.get_points("xy")] for line in lines if line.closed]
    if not found:
        what = f"{path.name} has no closed polyline on layer {units.shown(layer)}"
        raise ConfigError(where, what, "draw the hole as one closed polyline (LWPOLYLINE)")
    return found


def _named(layer):
    return layer.replace("_", "").replace("-", "").isalnum()
