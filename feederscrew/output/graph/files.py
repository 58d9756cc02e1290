"""The tipping graph as a table and as files."""

import numpy as np
from scipy.constants import g

from feederscrew.output import tables
from feederscrew.output.columns import MM, UJ


def transitions(part, aspects, ways):
    """The tipping graph, one row a way from one aspect into another or into its equal.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    ways : sequence of Transition

    Returns
    -------
    DataFrame
        The columns of ``graph.csv``.
    """
    axes = np.array([way.axis for way in ways]).reshape(-1, 3)
    lifts = np.array([way.lift for way in ways], dtype=float)
    return tables.frame(
        {
            "from": [aspects.names[way.start] for way in ways],
            "to": [aspects.names[way.end] for way in ways],
            "barrier_mm": lifts / MM,
            "barrier_uJ": part.mass * g * lifts / UJ,
            "axis_x": axes[:, 0],
            "axis_y": axes[:, 1],
            "axis_z": axes[:, 2],
        }
    )


def write(folder, part, aspects, ways, shares, *, pictures=True):
    """The files of the tipping graph.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    aspects : Aspects
    ways : sequence of Transition
    shares : (A,) float [1]
        Quasi-static probabilities, for the size of the discs.
    pictures : bool
        False for the table only.
    """
    folder.write("graph.csv", tables.text(transitions(part, aspects, ways), "csv"))
    if pictures:
        from feederscrew.output import style
        from feederscrew.output.graph import figures as graph_plots

        folder.write("graph.png", style.png(graph_plots.graph(part.name, aspects, ways, shares)))
