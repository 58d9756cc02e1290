"""What every reader of a mesh hands on: triangles as the file has them."""

from dataclasses import dataclass

import numpy as np

LARGEST = 1 << 29  # [bytes] ten million facets: five hundred times what a fed part needs


@dataclass(frozen=True, eq=False)
class Soup:
    """Triangles as a file has them; corners that coincide are not yet joined."""

    vertices: np.ndarray  # (V, 3) [unit of the file] maybe not finite
    faces: np.ndarray  # (F, 3) int
    format: str  # a key of read_format.FORMATS
    unit: str | None = None  # that the file or its format states
    warnings: tuple[str, ...] = ()
