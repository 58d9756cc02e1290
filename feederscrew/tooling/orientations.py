"""Every way a part can lie on the track, and what a device sees of it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from feederscrew.bowl.record import Track
from feederscrew.geometry.polygons import turned
from feederscrew.mechanics.wall import sameness
from feederscrew.mechanics.wall.headings import headings
from feederscrew.resting.posture import Posture, posture
from feederscrew.tooling import contact
from feederscrew.tooling import foot as feet
from feederscrew.tooling.silhouette import silhouette

BEYOND = 1e-3  # [m] a gap reaches farther than the foot does


@dataclass(frozen=True, eq=False)
class Orientation:
    """One aspect at one heading against the wall, in track axes from the foot of the centre of mass."""

    posture: Posture  # the part on that aspect, not yet turned
    track: Track
    aspect: str
    heading: float  # [rad]
    heading_share: float  # [1] of the parts on that aspect
    chances: dict[str, float]  # [1] probability by rule
    length: float  # [m] along the track
    width: float  # [m] of track it covers
    height: float  # [m]
    distance: float  # [m] from the wall to the foot of the centre of mass
    falls_off: bool  # the bare track does not carry it
    kind: str  # 'flat', 'rolling' or 'hanging'
    mirror: str = ""  # name of its mirror image, fore and aft; '' where there is none
    touching: np.ndarray | None = (
        None  # of its corners, where it touches the wall; None where that is not known
    )
    turns_over: bool = False  # the drive tips it over on the track

    @property
    def name(self):
        """'D@179': aspect and heading in whole degrees."""
        return f"{self.aspect}@{np.degrees(self.heading):.0f}"

    @property
    def returned(self):
        """Whether the track itself does not carry it."""
        return self.falls_off or self.turns_over

    @property
    def shift(self):
        """By how much the weight meets a banked track nearer to the wall [m]."""
        return self.posture.height * np.tan(self.track.bank)

    @cached_property
    def axes(self):
        """(3, 3) [1] the track's axes as rows, in the file's axes."""
        c, s, (x, y, z) = np.cos(self.heading), np.sin(self.heading), self.posture.axes
        return np.array([c * x - s * y, s * x + c * y, z])

    @cached_property
    def foot(self):
        """What of it touches the track: a Footprint."""
        whole = contact.footprint(self.posture, self.heading)
        return contact.within(whole, self.distance, self.track.radius, self.track.width)

    @cached_property
    def standing(self):
        """Its foot as the compiled verdict takes it."""
        return feet.standing(self.foot, self.distance, self.track.radius, self.shift)

    @cached_property
    def margin(self):
        """How far the foot of the centre of mass lies inside the supported hull on the whole track [m]."""
        return feet.over_ring(self.standing, 0.0, 0.0)

    @cached_property
    def outline(self):
        """(J, 2) [m] convex outline from above, counter-clockwise."""
        return turned(self.posture.outline, self.heading)

    @cached_property
    def silhouette(self):
        """Outline seen along the track: rings (K, 2) [m] of distance from the wall and height."""
        return silhouette(self.posture, self.heading, self.distance, self.track.radius)

    @cached_property
    def balcony(self):
        """Least width of track that carries it [m]; infinite where none does."""
        return feet.balcony(self.standing, self.track.radius)

    @cached_property
    def canyon(self):
        """Greatest width of a strip removed along the wall that it passes [m]; 0 for none."""
        return feet.canyon(self.standing, self.track.radius)

    @cached_property
    def gap(self):
        """Greatest gap across the track that it passes [m]; 0 for none."""
        return feet.longest_gap(self.standing, self.track.radius)


def orientations(part, aspects, track):
    """Return every stable aspect and heading of a part on a track.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    track : Track

    Returns
    -------
    tuple of Orientation
        In the order of the aspects, the most frequent heading first; those that a turn of the part maps onto
        each other are one.

    Raises
    ------
    FeederError
        If the part is a card without an outline, or larger than the bowl.
    """
    found = []
    for row in np.flatnonzero(aspects.stable):
        lying = posture(part, aspects, aspects.names[row])
        chances = {rule: float(chance[row]) for rule, chance in aspects.chances.items()}
        known = headings(lying, track)
        found += [_orientation(lying, known, k, chances, track) for k in range(len(known.headings))]
    return tuple(found)


def named(found):
    """Return orientations with the names of their mirror images, fore and aft.

    Parameters
    ----------
    found : sequence of Orientation

    Returns
    -------
    tuple of Orientation
    """
    from dataclasses import replace

    looks = [_look(one) for one in found]
    pairs = {}
    for i in range(len(found)):
        for j in range(len(found)):
            near = abs(found[i].length - found[j].length) < 1e-2 * found[i].length
            if i != j and near and sameness.alike(looks[i], looks[j], mirrored=True):
                pairs[i] = found[j].name
    return tuple(replace(one, mirror=pairs.get(k, "")) for k, one in enumerate(found))


def _look(one):
    supports, moments = sameness.looks(one.posture, [one.heading])
    return supports[0], None if moments is None else moments[0]


def _orientation(lying, known, row, chances, track):
    share = float(known.shares[row])
    return Orientation(
        posture=lying,
        track=track,
        aspect=lying.name,
        heading=float(known.headings[row]),
        heading_share=share,
        chances={rule: chance * share for rule, chance in chances.items()},
        length=float(known.lengths[row]),
        width=float(known.widths[row]),
        height=float(lying.corners[:, 2].max()),
        distance=float(known.distances[row]),
        falls_off=bool(known.falls_off[row] and known.overhangs[row] > 0.0),  # one that rolls stays on
        kind=lying.kind,
        touching=known.touching[row],
    )
