"""The study of ``feeder headings``: how a part lies along the track's wall."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.arrivals.entry import arriving
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.columns import Column, Frame, of_pieces
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import former_keywords
from feederscrew.bowl.devices.orientation_names import split_name
from feederscrew.bowl.record import Bowl, Track
from feederscrew.motion import headings as wall
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import Posture, posture


@dataclass(frozen=True, eq=False)
class HeadingsStudy(ReadableRecord, view="headings.HEADINGS_VIEW"):
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

    def table(self) -> Frame:
        """Return every stable heading, a row each: ``headings.csv``."""
        return of_pieces(HEADINGS_COLUMNS, [(self, stable) for stable in self.headings])

    def only(self, aspect: str) -> HeadingsStudy:
        """Return the study of one of its aspects."""
        rows = [k for k, stance in enumerate(self.postures) if stance.name == aspect]
        postures, of_aspect = tuple(self.postures[k] for k in rows), tuple(self.headings[k] for k in rows)
        return replace(self, postures=postures, headings=of_aspect)


HEADINGS_COLUMNS: tuple[Column[tuple[HeadingsStudy, wall.Headings]], ...] = (  # a row a heading
    Column("aspect", lambda lying: lying[1].aspect),
    Column("heading_deg", lambda lying: lying[1].headings, "deg"),
    Column("share", lambda lying: lying[1].shares, "share"),
    Column("straight_wall_share", lambda lying: lying[1].straight_shares, "share"),
    Column(
        "aspect_share",
        lambda lying: lying[0].chances.get(lying[1].aspect, np.nan) * np.asarray(lying[1].shares),
        "share",
    ),
    Column("length_mm", lambda lying: lying[1].lengths, "mm"),
    Column("width_mm", lambda lying: lying[1].widths, "mm"),
    Column("overhang_mm", lambda lying: lying[1].overhangs, "mm"),
    Column("falls_off", lambda lying: lying[1].falls_off),
    Column("half_turn_of_deg", lambda lying: _heading_of(lying[1], lying[1].half_turns), "deg"),
    Column("mirror_of_deg", lambda lying: _heading_of(lying[1], lying[1].mirrors), "deg"),
    Column("contact_1_x_mm", lambda lying: lying[1].touching[:, 0, 0], "mm", hidden=True),
    Column("contact_1_y_mm", lambda lying: lying[1].touching[:, 0, 1], "mm", hidden=True),
    Column("contact_2_x_mm", lambda lying: lying[1].touching[:, 1, 0], "mm", hidden=True),
    Column("contact_2_y_mm", lambda lying: lying[1].touching[:, 1, 1], "mm", hidden=True),
)


def _heading_of(stable: wall.Headings, rows: Ints) -> Floats:
    """Return the headings [rad] of rows; NaN of the row -1, which stands for no heading."""
    return np.append(stable.headings, np.nan)[np.maximum(rows, -1)]


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
        Its name, 'A'; every stable one without it.
    aspects : Aspects, optional
        Of the part, with their probabilities, as ``aspects`` or ``shares`` found them. Without it the shares
        are those in which parts come from the bowl's moving floor.

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
