"""The study of ``feeder headings``: how a part lies along the track's wall."""

from __future__ import annotations

from dataclasses import dataclass, replace

from feederscrew.bowl.record import Track
from feederscrew.mechanics.wall import stable_headings as wall
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture, posture
from feederscrew.studies.aspects import answered


@dataclass(frozen=True, eq=False)
class HeadingsStudy(ReadableRecord):
    """The stable headings of a part on one or more aspects."""

    part: Part
    track: Track
    postures: tuple[Posture, ...]
    headings: tuple[wall.Headings, ...]  # one a posture
    chances: dict[str, float]  # probability of each aspect of the part by the answer that ranks them
    answer: str  # whose they are: 'hops, launch feed'

    def only(self, aspect: str) -> HeadingsStudy:
        """Return the study of one of its aspects."""
        kept = [k for k, one in enumerate(self.postures) if one.name == aspect]
        postures, found = tuple(self.postures[k] for k in kept), tuple(self.headings[k] for k in kept)
        return replace(self, postures=postures, headings=found)


def headings(
    part: Part, track: Track, aspect: str | None = None, aspects: Aspects | None = None
) -> HeadingsStudy:
    """Study the stable headings of a part's aspects.

    Parameters
    ----------
    part : Part
        From a mesh.
    track : Track
    aspect : str, optional
        Only this one; without it, every stable aspect.
    aspects : Aspects, optional
        Of the part, with the answer to take, where they are known already.

    Returns
    -------
    HeadingsStudy

    Raises
    ------
    FeederError
        If there is no such aspect, the bowl is smaller than the part, or the part is a card.
    """
    found = answered(part) if aspects is None else aspects
    names = [name for name, stays in zip(found.names, found.stable) if stays] if aspect is None else [aspect]
    postures = tuple(posture(part, found, name) for name in names)
    return HeadingsStudy(
        part=part,
        track=track,
        postures=postures,
        headings=tuple(wall.headings(one, track) for one in postures),
        chances=dict(zip(found.names, found.chances[found.ranking].tolist())),
        answer=found.source(found.ranking),
    )
