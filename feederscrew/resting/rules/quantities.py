"""What probability rules may weigh: quantities of the classes, and of the faces behind them."""

from dataclasses import dataclass

import numpy as np

from feederscrew.resting.basins.barriers import Tipping
from feederscrew.resting.faces import Face


@dataclass(frozen=True, eq=False)
class ClassQuantities:
    """Geometry of the classes; A rows, NaN where a part card is silent."""

    faces: np.ndarray  # (A,) int, equal aspects in the class
    pmi_faces: np.ndarray  # (A,) int, of these as the PMI rule counts them: 1 as published
    heights: np.ndarray  # (A,) [m] of the centre of mass
    csa_heights: np.ndarray  # (A,) [m] as the CSA rule takes them: a card's own, else the heights
    stability_heights: np.ndarray  # (A,) [m] likewise
    polar_inertias: np.ndarray  # (A,) [kg m2] about the normal through the centre of mass
    solid_angles: np.ndarray  # (A,) [sr] of one face; of a card in its own unit
    contact_areas: np.ndarray  # (A,) [m2] of one face


@dataclass(frozen=True, eq=False)
class FaceQuantities:
    """Exact tumbling of the part; F faces."""

    tips: Tipping  # basins, heights and the saddles between them
    faces: tuple[Face, ...]
    shares: np.ndarray  # (F,) [1] quasi-static
    heights: np.ndarray  # (F,) [m] of the centre of mass; NaN where the share is zero
    radius: float  # [m] largest distance from the centre of mass to a corner
    exponent: float  # [1] of the surface-weighted rule
