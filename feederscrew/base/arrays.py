"""Names of array types in annotations; docstrings say shapes and units."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Values = Any  # a number, or an array of them, where what is returned is of the same kind
Array = NDArray[Any]  # of any numbers
Reals = float | Floats  # one, or an array of them that broadcasts
Vector = Floats  # (2,) or (3,)
Points = Floats  # (N, 2) or (N, 3), a row a point
Triangles = Ints  # (F, 3), three corners of each
Triple = tuple[float, float, float]  # a point or a vector, for which no array is made
Row = np.record  # with fields of single numbers, which compiled code reads without making an array
Rows = np.recarray  # an array of them
