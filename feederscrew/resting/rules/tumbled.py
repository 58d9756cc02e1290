"""Rules of exact tumbling: the basin itself, and the critical solid angle of a face."""

import numpy as np

from feederscrew.resting.basins.barriers import critical_solid_angle


def quasistatic(tips):
    """Return the share of the attitudes from which a part let go without speed ends on each face.

    Parameters
    ----------
    tips : Tipping

    Returns
    -------
    (F,) float [1]
    """
    return tips.shares


def critical(faces):
    """Return the critical solid angle of each face over its height; of a rolling one, from its lowest strip.

    Parameters
    ----------
    faces : sequence of Face
        F faces.

    Returns
    -------
    (F,) float [sr/m]

    References
    ----------
    As in `critical_solid_angle`.
    """
    return np.array(
        [critical_solid_angle(face.polygon, face.height) * face.solid_angle / face.height for face in faces]
    )
