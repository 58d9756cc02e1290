"""How long a thrown part flies."""

import math

from feederscrew import check


def throw_of_flight(periods):
    """Return the throw number at which a part that does not rebound flies for a given time.

    Source: Sloot and Kruyt 1996, by the parabola between two impacts; docs/conveying.md, "The model".

    Parameters
    ----------
    periods : float [1 period]
        Length of the flight, above 0; of one that starts from contact.

    Returns
    -------
    float [1]
        sqrt(1 + pi^2) for one period.
    """
    turn = 2.0 * math.pi * check.positive("periods", periods)
    return math.hypot(1.0, (0.5 * turn * turn - 1.0 + math.cos(turn)) / (turn - math.sin(turn)))
