"""Rules of exact tumbling: the basin itself, and the critical solid angle of a face."""

import numpy as np

from feederscrew.resting.basins.barriers import critical_solid_angles


def quasistatic(tips):
    """Return the share of the attitudes from which a part let go without speed ends on each face.

    Source: docs/resting.md, "Exact tumbling".

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
    As in `critical_solid_angles`.
    """
    heights, solid_angles = (
        np.array([getattr(face, name) for face in faces]) for name in ("height", "solid_angle")
    )
    shares = critical_solid_angles([face.polygon for face in faces], heights)
    return shares * solid_angles / heights
