"""The published rules: how likely each resting aspect is, from its geometry alone.

Each gives the weight of a class of ``faces`` equal aspects; `normalised` makes probabilities of them.
"""

import numpy as np
from numpy.typing import NDArray


def pmi(faces, polar_inertia, height) -> NDArray[np.float64]:
    """Return polar moment of inertia over height: the thesis's rule, eq. [section 3.1].

    Parameters
    ----------
    faces : (A,) int
        Equal aspects in the class; Tables 3-8 and 3-9 count each class once.
    polar_inertia : (A,) float [kg m2]
        About the aspect's normal through the centre of mass.
    height : (A,) float [m]
        Of the centre of mass over the aspect.

    Returns
    -------
    (A,) float [kg m]
    """
    return faces * polar_inertia / height


def csa(faces, solid_angle, height) -> NDArray[np.float64]:
    """Return centroid solid angle over height, eq. [Table 3-2].

    Parameters
    ----------
    faces, height
        As in `pmi`.
    solid_angle : (A,) float [sr]
        Of one face, seen from the centre of mass.

    Returns
    -------
    (A,) float [sr/m]

    References
    ----------
    B. K. A. Ngoi, L. E. N. Lim, S. S. G. Lee, J. Electronics Manufacturing 5(3), 1995.
    """
    return faces * solid_angle / height


def stability(faces, contact_area, height) -> NDArray[np.float64]:
    """Return contact area over height, eq. [Table 3-3].

    Parameters
    ----------
    faces, height
        As in `pmi`.
    contact_area : (A,) float [m2]
        Of one face.

    Returns
    -------
    (A,) float [m]

    References
    ----------
    P. S. K. Chua, M. L. Tay, "Modelling the natural resting aspect of small regular shaped parts",
    J. Manufacturing Science and Engineering 120(3), 1998.
    """
    return faces * contact_area / height


def normalised(weights, stable) -> NDArray[np.float64]:
    """Return the probabilities of the stable aspects from their weights; the unstable ones have none.

    Source: docs/resting.md, "How were the parts launched?".

    Parameters
    ----------
    weights : (A,) float [any one unit]
    stable : (A,) bool

    Returns
    -------
    (A,) float [1]
        Sums to 1; NaN throughout where a weight is not known, or none is above 0.
    """
    weights = np.where(stable, weights, 0.0)
    total = weights.sum()
    return weights / (total if total != 0.0 else np.nan)
