"""The tipping graph as a table."""

import numpy as np

from feederscrew.output import tables
from feederscrew.output.columns import UJ
from feederscrew.units import GRAVITY, MM


def transitions(study):
    """Return the tipping graph, one row a way from one aspect into another or into its equal.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    Frame
        The columns of ``graph.csv``.
    """
    ways, names = study.transitions, study.aspects.names
    axes = np.array([way.axis for way in ways]).reshape(-1, 3)
    lifts = np.array([way.lift for way in ways], dtype=float)
    return tables.frame(
        {
            "from": [names[way.start] for way in ways],
            "to": [names[way.end] for way in ways],
            "barrier_mm": lifts / MM,
            "barrier_uJ": study.part.mass * GRAVITY * lifts / UJ,
            "axis_x": axes[:, 0],
            "axis_y": axes[:, 1],
            "axis_z": axes[:, 2],
        }
    )
