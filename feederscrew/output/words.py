"""Field words of tables and legends: motions, regimes, and what an orientation such as A@188 means."""

import re

PHASE_WORDS = {"stick": "sticks", "forward": "slips forward", "backward": "slips back", "flight": "flies"}
REGIME_WORDS = {  # of a regime's name in files
    "stick": "sticks", "forward": "slips forward only", "backward": "slips back only",
    "both": "slips both ways", "hop": "hops",
}  # fmt: skip


def regime_words(regime: str) -> str:
    """Return a regime as people read it: 'slips back only' for 'backward'."""
    return REGIME_WORDS.get(regime, regime)


ORIENTATION = re.compile(r"\b([A-Z]+)@(\d+)")
IN_WORDS = re.compile(r"\bat heading \d")
COLUMN = re.compile(r"\bheading\b")  # of the first line of a table
ZERO = (
    "at heading 0 the middle of the face it rests on lies ahead of its centre of mass, in the direction of "
    "travel (where it lies below it: the longest side of the outline lies along the track)"
)


def heading_note(text) -> str:
    """Return what the headings in a text are turned from, a sentence; '' where the text names none.

    Parameters
    ----------
    text : str
        A table or a message, as printed.

    Returns
    -------
    str
        'A@188: aspect A, turned 188 deg counter-clockwise (seen from above): at heading 0 ...'.

    References
    ----------
    ``resting.posture.Posture``: heading 0 has the thesis's Z' along the track; docs/tooling.md, section 1.
    """
    named = ORIENTATION.search(text)
    if named:
        name, turn = named[1], named[2]
        return f"{named[0]}: aspect {name}, turned {turn} deg counter-clockwise seen from above; {ZERO}"
    if IN_WORDS.search(text) or COLUMN.search(text.partition("\n")[0]):
        return f"heading: by how much a part is turned, counter-clockwise seen from above; {ZERO}"
    return ""
