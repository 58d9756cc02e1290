"""Followed drops as a table, and one of them as a picture."""

import numpy as np

from feederscrew.output import tables
from feederscrew.output.columns import MM

NONE = "none"  # the class of a drop that never settles


def table(aspects, traces):
    """One row a moment of each drop.

    Parameters
    ----------
    aspects : Aspects
    traces : sequence of Trace
        At least one.

    Returns
    -------
    DataFrame
        The columns of ``drop_traces.csv``: the centre of mass over the plane, the quaternion from the
        file's axes to the plane's, total energy over m g, what happens, and the aspect the drop ends on.
    """
    positions = np.concatenate([trace.positions for trace in traces]) / MM
    attitudes = np.concatenate([trace.attitudes for trace in traces])
    lengths = [len(trace.times) for trace in traces]
    return tables.frame(
        {
            "drop": np.repeat([trace.number for trace in traces], lengths),
            "time_s": np.concatenate([trace.times for trace in traces]),
            **dict(zip(("x_mm", "y_mm", "z_mm"), positions.T)),
            **dict(zip(("q_w", "q_x", "q_y", "q_z"), attitudes.T)),
            "energy_mm": np.concatenate([trace.energies for trace in traces]) / MM,
            "event": np.concatenate([_events(trace) for trace in traces]),
            "aspect": np.repeat([name(aspects, trace) for trace in traces], lengths),
        }
    )


def listed(aspects, traces):
    """Each followed drop for the JSON document: when it was counted, on what, and if it was seen at rest."""
    return [
        {
            "drop": trace.number,
            "aspect": name(aspects, trace),
            "counted_s": trace.decided,
            "still": trace.still,
        }
        for trace in traces
    ]


def name(aspects, trace):
    """The aspect a drop is counted on."""
    return aspects.names[trace.row] if trace.row >= 0 else NONE


def write(folder, part, aspects, result, *, pictures=True):
    """The files of ``feeder drop --trace``.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    aspects : Aspects
    result : feederscrew.dropping.runs.Result
        With traces.
    pictures : bool
        False for the table only.
    """
    folder.write("drop_traces.csv", tables.text(table(aspects, result.traces), "csv"))
    if pictures:
        from feederscrew.dropping.traces import telling
        from feederscrew.output import style
        from feederscrew.output.drop import trace_strip as drop_trace_strip

        trace = telling(result.traces)
        title = f"{part.name}: drop {trace.number}, {result.launch['name']}"
        strip = drop_trace_strip.strip(part, aspects, trace, title)
        folder.write("drop_trace.png", style.png(strip))


def _events(trace):
    events = np.where(trace.impacts, "impact", "").astype(object)
    events[0] = "launch"
    if trace.still:
        events[-1] = "still"
    return events
