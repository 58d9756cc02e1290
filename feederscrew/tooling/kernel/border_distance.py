"""How far the border of one area lies from that of another one."""

import math

from feederscrew.geometry.compiled import entry


@entry
def farthest(places, sides):
    """Return how far the farthest of some places is from the nearest of some sides.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    places : (P, 2) float [m]
    sides : (S, 4) float [m]
        Start of each, and the way to its end, which is not 0.

    Returns
    -------
    float [m]
    """
    largest = 0.0
    for i in range(len(places)):
        nearest = math.inf
        for k in range(len(sides)):
            x, y = places[i, 0] - sides[k, 0], places[i, 1] - sides[k, 1]
            along, across = sides[k, 2], sides[k, 3]
            share = min(max((x * along + y * across) / (along * along + across * across), 0.0), 1.0)
            x, y = x - share * along, y - share * across
            nearest = min(nearest, x * x + y * y)
            if nearest <= largest:
                break
        largest = max(largest, nearest)
    return math.sqrt(largest)
