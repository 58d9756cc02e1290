"""Which aspect a part stands on where none is asked for."""

from feederscrew.resting import aspects
from feederscrew.resting.posture import posture

LIKELIEST, LISTED = "the likeliest by CSA", "the first of the card"


def standing(part, aspect, block):
    """The part on an aspect.

    Parameters
    ----------
    part : Part
    aspect : str or None
        Its name; None for the one that a card's block is of, else for the first of ``resting.aspects.find``.
    block : str
        Of a part card: 'floor' or 'track'.

    Returns
    -------
    tuple of Posture, str or None
        And why this aspect; None where it was asked for.

    Raises
    ------
    FeederError
        If there is no such aspect.
    """
    found = aspects.find(part)
    if aspect is not None:
        return posture(part, found, aspect), None
    analysed = (part.printed or {}).get(block, {}).get("aspect")
    if analysed is not None:
        return posture(part, found, analysed), f"the one of the card's {block} block"
    return posture(part, found, found.names[0]), LISTED if part.vertices is None else LIKELIEST
