"""What a part does on the track of its bowl, in one paragraph: what the chapters tell apart, put together."""

import numpy as np

from feederscrew.mechanics.floor_balance import HOP
from feederscrew.output.page.numbers import SHORT, number
from feederscrew.rates import tipping
from feederscrew.units import MM_S

SLIDES_DOWN = "On this track the part slides down continuously: it does not travel."
THROWN = "It is thrown: the reactions below are those of the contact; conveying follows its flights."
WORDS = {  # what the rate has it do
    tipping.STAYS: "It stays on its aspect through the stroke.",
    tipping.THROWN: THROWN,
    tipping.OVER: "The drive turns it over: it goes back into the bowl, and the rate is 0.",
    tipping.BACK: "It lies on its round side and rolls back down the climb, so the rate is 0.",
    tipping.ROCKS: (
        "It rocks: at an instant the line of action leaves the contact, a stroke tilts it by {:.2g} deg, and"
        " only from {:.3g} deg on would it turn over."
    ),
}


def on_track(case, words):
    """Return what a part does on the track, in the reader's words.

    Parameters
    ----------
    case : ReportStudy
    words : dict of str to str
        Of each regime.
    """
    found, stands = case.convey.answer, case.track.stands
    if found.status == "no steady state":
        return SLIDES_DOWN
    speed = number(found.velocity / MM_S, SHORT)
    regime = words.get(found.regime, found.regime)
    said = [f"On this track the part travels at {speed} mm/s and {regime}: the rate is computed with that."]
    if HOP in case.track.cycle.state and stands and stands.verdict != tipping.THROWN:
        said.append(THROWN)
    said += [WORDS[stands.verdict].format(*np.degrees((stands.tilt, stands.lean)))] if stands else []
    return " ".join(said)
