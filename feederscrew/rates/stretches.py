"""The bowl as parts travel along a stretch of its track that leans otherwise."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.tooling.orientations import Orientation


def on_stretch(bowl: Bowl, one: Orientation) -> Bowl:
    """Return a bowl in which parts travel as on the stretch on which an orientation lies.

    Source: the balance of forces of a part on both faces of a groove; docs/tooling.md, "A groove".

    Parameters
    ----------
    bowl : Bowl
    one : Orientation
        As it is there: its track, and the groove that it lies in.

    Returns
    -------
    Bowl
        In a groove each face carries 1 / (2 cos(angle)) of the weight, so friction acts as mu / cos(angle).
    """
    if not one.groove:
        return replace(bowl, track=replace(bowl.track, climb=one.track.climb, bank=one.track.bank))
    mu, more = bowl.friction, 1.0 / np.cos(one.groove)
    back, kinetic_back = mu.backward
    friction = replace(
        mu,
        static=mu.static * more,
        kinetic=mu.kinetic * more,
        static_backward=back * more,
        kinetic_backward=kinetic_back * more,
    )
    return replace(bowl, friction=friction, track=replace(bowl.track, climb=one.track.climb, bank=0.0))


def queueing(bowl: Bowl, lying: Sequence[Orientation]) -> Bowl:
    """Return the bowl as parts queue in it, before the first device that does more than lean the track.

    Source: own; docs/tooling.md, "A groove".

    Parameters
    ----------
    bowl : Bowl
    lying : sequence of Orientation
        As they are at its entry: a bank or a groove that is listed first begins there. A steeper stretch
        does not: it is where a queue comes apart.
    """
    one = lying[0]
    return on_stretch(bowl, replace(one, track=replace(one.track, climb=bowl.track.climb)))
