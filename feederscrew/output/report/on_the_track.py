"""What a part does on the track of its bowl, in one paragraph: what the chapters tell apart, put together."""

import numpy as np

from feederscrew.mechanics.floor.balance import HOP
from feederscrew.output.page.numbers import SHORT, number
from feederscrew.units import factor

MM_S = factor("mm/s", "velocity")
SLIDES_DOWN = "On this track the part slides down continuously: it does not travel."
THROWN = "It is thrown: the reactions below are those of the contact; conveying follows its flights."
NOTHING = "A contact that opens at 0 times the drive is one that carries nothing even at rest."


def on_track(case, words):
    """Return what a part does on the track, in the reader's words.

    Parameters
    ----------
    case : ReportStudy
    words : dict of str to str
        Of each regime.
    """
    found = case.convey.answer
    if found.status == "no steady state":
        return SLIDES_DOWN
    speed = number(found.velocity / MM_S, SHORT)
    regime = words.get(found.regime, found.regime)
    said = [f"On this track the part travels at {speed} mm/s and {regime}: the rate is reckoned with that."]
    if HOP in case.track.cycle.state:
        said.append(THROWN)
    said += _stands(case)
    if case.track.opening.drive_factor == 0.0:
        said.append(NOTHING)
    return " ".join(said)


def _stands(case):
    """Whether it rocks, turns over or rolls back, as the rate has it; nothing of a part card."""
    if case.part.vertices is None:
        return
    known, row = case.rate.rate.orientations, case.rate.rate.row
    if known.lying[row].turns_over:
        yield "The drive turns it over: it goes back into the bowl, and the rate is 0."
    elif known.rolls_back[row]:
        yield "It lies on its round side and rolls back down the climb, so the rate is 0."
    elif known.tipping is not None and known.tipping.tips[row]:
        tilt, lean = (np.degrees(a[row]) for a in (known.tipping.tilt, known.tipping.balance))
        yield (
            f"It rocks: 'tips' is said of an instant, a stroke tilts it by {tilt:.2g} deg, and only from "
            f"{lean:.3g} deg on would it turn over."
        )
