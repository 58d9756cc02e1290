"""Everything ``feeder headings`` finds of one part, in the order of the pipeline."""

from feederscrew.mechanics.wall.headings import headings
from feederscrew.resting import aspects
from feederscrew.resting.posture import posture


def analyse(part, track, aspect=None):
    """The stable headings of a part's aspects.

    Parameters
    ----------
    part : Part
        From a mesh.
    track : Track
    aspect : str, optional
        Only this one.

    Returns
    -------
    tuple of list of Posture, list of Headings, dict of str to float
        And the probability of each aspect, by the rule that ranks them (CSA).

    Raises
    ------
    FeederError
        If there is no such aspect, the bowl is smaller than the part, or the part is a card.
    """
    found = aspects.find(part)
    names = [name for name, stays in zip(found.names, found.stable) if stays] if aspect is None else [aspect]
    postures = [posture(part, found, name) for name in names]
    chances = dict(zip(found.names, found.probabilities["csa"].tolist()))
    return postures, [headings(one, track) for one in postures], chances
