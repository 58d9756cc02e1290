"""The study of ``feeder headings``: how a part lies along the track's wall."""

from __future__ import annotations

from dataclasses import dataclass, replace

from feederscrew.bowl.record import Bowl, Track
from feederscrew.mechanics import headings as wall
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture, posture
from feederscrew.studies import arguments
from feederscrew.studies.arguments import former_keywords
from feederscrew.studies.rate import arriving
from feederscrew.tooling.devices.orientation_names import split_name


@dataclass(frozen=True, eq=False)
class HeadingsStudy(ReadableRecord):
    """The stable headings of a part on one or more aspects."""

    part: Part
    bowl: Bowl
    postures: tuple[Posture, ...]
    headings: tuple[wall.Headings, ...]  # one a posture
    chances: dict[str, float]  # probability of each aspect of the part by the answer that ranks them
    answer: str  # whose they are: 'hops, launch feed'

    @property
    def track(self) -> Track:
        """The bowl's track."""
        return self.bowl.track

    def only(self, aspect: str) -> HeadingsStudy:
        """Return the study of one of its aspects."""
        rows = [k for k, stance in enumerate(self.postures) if stance.name == aspect]
        postures, of_aspect = tuple(self.postures[k] for k in rows), tuple(self.headings[k] for k in rows)
        return replace(self, postures=postures, headings=of_aspect)


@former_keywords()
def headings(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    aspects: Aspects | None = None,
) -> HeadingsStudy:
    """Find how a part lies along the track's wall, as ``feeder headings``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        One alone; every stable one without it.
    aspects : Aspects, optional
        Of the part, with the answer to take; what arrives from the bowl's moving floor without it.

    Returns
    -------
    HeadingsStudy

    Raises
    ------
    FeederError
        If there is no such aspect, the bowl is smaller than the part, or the part is a card.
    """
    part, bowl = arguments.a_part(part), arguments.a_bowl(bowl)
    track = bowl.track
    resting = arriving(part, bowl) if aspects is None else aspects
    stable = [name for name, stays in zip(resting.names, resting.stable) if stays]
    postures = tuple(
        posture(part, resting, name) for name in (stable if aspect is None else [split_name(aspect)[0]])
    )
    stable_headings = tuple(wall.headings(stance, track) for stance in postures)
    chances = dict(zip(resting.names, resting.chances[resting.ranking].tolist()))
    return HeadingsStudy(part, bowl, postures, stable_headings, chances, resting.source(resting.ranking))
