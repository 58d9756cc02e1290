"""Which moments of a followed drop tell its story."""

import numpy as np


def chosen(trace, count):
    """Return the rows of the stills: the first impact, the end, and others at equal shares of what goes on.

    That is, half by half, how far the part turns and how much energy it loses (in powers), and by a quarter
    how long it takes.

    Parameters
    ----------
    trace : DropTrace
    count : int

    Returns
    -------
    (count,) int
    """
    first = int(np.argmax(trace.impacts))
    turned = (trace.turns[first + 1 :] * trace.turns[first:-1].inv()).magnitude()
    lost = -np.diff(np.log(trace.energies[first:])).clip(max=0.0)
    lost = lost.clip(max=0.5 * lost.sum() / count)  # one hard hit is one still
    way = sum(
        share * np.cumsum(steps) / max(steps.sum(), 1e-9)
        for share, steps in ((0.5, turned), (0.5, lost), (0.25, np.diff(trace.times[first:])))
    )
    way = np.append(0.0, way)
    rows = first + np.searchsorted(way, np.linspace(0.0, way[-1], count) - 1e-9)
    rows = rows.clip(max=len(trace.times) - 1)
    rows[1:-1] -= trace.impacts[rows[1:-1] - 1]  # the hit, not the step after it
    return rows
