"""Followed drops as a table and for the document."""

import numpy as np

from feederscrew.output import tables
from feederscrew.units import MM

NONE = "none"  # the class of a drop that never settles


def traces(study):
    """Return one row a moment of each followed drop.

    Parameters
    ----------
    study : DropStudy
        With at least one trace.

    Returns
    -------
    Frame
        The columns of ``drop_traces.csv``: the centre of mass over the plane, the quaternion from the
        file's axes to the plane's, total energy over m g, what happens, and the aspect the drop ends on.
    """
    followed = study.result.traces
    positions = np.concatenate([trace.positions for trace in followed]) / MM
    attitudes = np.concatenate([trace.attitudes for trace in followed])
    lengths = [len(trace.times) for trace in followed]
    return tables.frame(
        {
            "drop": np.repeat([trace.number for trace in followed], lengths),
            "time_s": np.concatenate([trace.times for trace in followed]),
            **dict(zip(("x_mm", "y_mm", "z_mm"), positions.T)),
            **dict(zip(("q_w", "q_x", "q_y", "q_z"), attitudes.T)),
            "energy_mm": np.concatenate([trace.energies for trace in followed]) / MM,
            "event": np.concatenate([_events(trace) for trace in followed]),
            "aspect": np.repeat([name(study.aspects, trace) for trace in followed], lengths),
        }
    )


def listed(study):
    """Return when each followed drop was counted, on what, and whether it was seen at rest."""
    return [
        {
            "drop": trace.number,
            "aspect": name(study.aspects, trace),
            "counted_s": trace.decided,
            "still": trace.still,
        }
        for trace in study.result.traces
    ]


def name(aspects, trace):
    """Return the aspect a drop is counted on."""
    return aspects.names[trace.row] if trace.row >= 0 else NONE


def _events(trace):
    events = np.where(trace.impacts, "impact", "").astype(object)
    events[0] = "launch"
    if trace.still:
        events[-1] = "still"
    return events
