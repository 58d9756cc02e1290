"""Which aspect a part stands on where none is asked for."""

from typing import Any

from feederscrew.resting import aspects
from feederscrew.resting.posture import posture

LIKELIEST, LISTED = "the likeliest ({})", "the first of the card"


def standing(part, aspect, block, answered=aspects.find) -> tuple[Any, ...]:
    """Return the part on an aspect.

    Parameters
    ----------
    part : Part
    aspect : str or None
        Its name; None for the one that a card's block is of, else for the likeliest, of a card the first.
    block : str
        Of a part card: 'floor' or 'track'.
    answered : function
        From a part to its Aspects with the answer that says which is the likeliest; asked only for that.

    Returns
    -------
    tuple of Posture, str or None
        And why this aspect; None where it was asked for.

    Raises
    ------
    FeederError
        If there is no such aspect.
    """
    if aspect is not None:
        return posture(part, aspects.find(part), aspect), None
    analysed = (part.printed or {}).get(block, {}).get("aspect")
    if analysed is not None:
        return posture(part, aspects.find(part), analysed), f"the one of the card's {block} block"
    answer = answered(part)
    if answer.recommended is None:
        return posture(part, answer, answer.names[0]), LISTED
    return posture(part, answer, answer.likeliest), LIKELIEST.format(answer.recommended.rule)
