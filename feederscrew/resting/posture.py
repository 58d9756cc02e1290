"""A part standing on one of its aspects, in axes of the floor."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import cast

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints, Points, Triangles
from feederscrew.base.errors import ArgumentError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import centroid, outline, sides, surrounds
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import with_shown_signature
from feederscrew.part.hull import convex_hull
from feederscrew.part.record import PART_MEND, CardBlock, Part
from feederscrew.resting.aspects import ASPECTS_MEND, Aspects
from feederscrew.resting.aspects import find as find_aspects
from feederscrew.resting.lying import TOUCHING_SHARE

COINCIDE = 1e-5  # of the part's size: a contact centroid nearer to the foot gives no direction
SIDE_TOLERANCE = 1e-6  # of the part's size: sides whose lengths differ by less are equally long


@dataclass(frozen=True, eq=False)
class Posture(ReadableRecord):
    """A part on an aspect, not yet turned: x and y in the floor, z up, origin below the centre of mass.

    Heading 0 has the body's own direction (the thesis's Z') along x: from the foot of the centre of mass to
    the centroid of the contact polygon; where the two coincide, along the longest side of the outline.
    """

    name: str  # of the aspect
    kind: str  # 'flat' or 'rolling'
    mass: float  # [kg]
    height: float  # [m] of the centre of mass
    inertia: Floats  # (3, 3) [kg m2] about the centre of mass; NaN where a card is silent
    contact: Points  # (K, 2) [m] contact polygon, counter-clockwise from above; (0, 2) of a card
    outline: Points  # (J, 2) [m] plan outline of the whole part, as above
    offset: float  # [m] e, from the foot to the contact polygon's centroid; NaN where a card is silent
    axis: Floats | None = None  # (2,) direction of the rolling axis in the floor
    printed: dict[str, CardBlock] | None = None  # a card's 'floor' and 'track' data, in SI units
    corners: Points | None = None  # (V, 3) [m] hull corners, z from the floor; None of a card
    solid: Part | None = None  # that stands so; None where only its plan is known
    axes: Floats | None = None  # (3, 3) [1] x, y, z of the posture as rows, in the file's axes
    rolling_circle: float = np.nan  # [m] as ``Aspects.rolling_circles``
    form: str = "flat"  # 'cylinder', 'cone', 'ball' and so on, as ``Aspects.forms``
    lies: str = ""  # 'on its largest face', one of ``lying.Lies``; '' of a card

    @property
    def rolls(self) -> bool:
        """Tell whether the part lies on a round side."""
        return self.kind == "rolling"

    @property
    def surface(self) -> Floats:
        """Return every corner (V, 3) [m] of the part's mesh as it stands, z from the floor."""
        body, axes = cast(Part, self.solid).corners, cast(Floats, self.axes)
        return np.einsum("ij,vj->vi", axes, body) + np.array([0.0, 0.0, self.height])

    @property
    def facets(self) -> Triangles:
        """Return the facets (F, 3) int of the part's mesh: corners by their rows in ``surface``."""
        return cast(Triangles, cast(Part, self.solid).faces)

    @cached_property
    def on_floor(self) -> Bools:
        """Return which corners (V,) of the mesh touch the floor.

        Where the low corners do not carry the part, none is taken and the part stands on its whole contact
        polygon: the polygon is of facets not quite in one plane, or the file has noise.
        """
        points = self.surface
        low = points[:, 2] < TOUCHING_SHARE * np.ptp(self.outline, axis=0).max()
        return low & surrounds(points[low, :2])

    @cached_property
    def feet(self) -> Floats:
        """Return the edges (E, 2, 2) [m] of the mesh on the floor; single corners are edges of no length.

        Of a part that rolls, of a card and where no corners carry it they are the sides of the contact
        polygon.
        """
        if self.solid is None or self.kind == "rolling" or not self.on_floor.any():
            return np.stack([self.contact, np.roll(self.contact, -1, axis=0)], axis=1)
        return self.surface[_borders(self.facets, self.on_floor), :2]

    @property
    def turning_inertia(self) -> float:
        """Return the moment of inertia [kg m2] about the vertical through the centre of mass."""
        return float(self.inertia[2, 2])


def _borders(faces: Triangles, low: Bools) -> Ints:
    """Return ends (E, 2) of edges between low corners, not those within low facets; lone corners twice."""
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    lying = np.tile(low[faces].all(axis=1), 3)
    low_edges = low[ends].all(axis=1)
    ends, lying = np.sort(ends[low_edges], axis=1), lying[low_edges]
    _, first, place = np.unique(ends[:, 0] * len(low) + ends[:, 1], return_index=True, return_inverse=True)
    edges = ends[first[np.bincount(place, lying) < 2.0]]
    alone = low.copy()
    alone[ends] = False
    return np.concatenate([edges, np.repeat(np.flatnonzero(alone)[:, None], 2, axis=1)])


@with_shown_signature
def posture(part: Part, aspects: Aspects, aspect: str) -> Posture:
    """Return how a part stands on one aspect: its contact, its outline and the height of its centre of mass.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    aspects : Aspects
        Of that part.
    aspect : str
        Its name; its case does not matter.

    Returns
    -------
    Posture

    Raises
    ------
    ArgumentError
        If the part has no such aspect; the line names those it has.
    """
    check.kind("part", part, Part, PART_MEND)
    check.kind("aspects", aspects, Aspects, ASPECTS_MEND)
    wanted = check.kind("aspect", aspect, str, "give the name of an aspect, 'A'").strip().casefold()
    rows = [row for row, own in enumerate(aspects.names) if own.casefold() == wanted]
    if not rows:
        where, what = f"aspect of {part.source}", f"there is no aspect {aspect[:20]!r}"
        raise ArgumentError(where, what, f"choose one of {', '.join(aspects.names)}")
    row = rows[0]
    return _of_card(part, aspects, row) if part.vertices is None else _of_mesh(part, aspects, row)


@lru_cache(maxsize=32)
def _of_mesh(part: Part, aspects: Aspects, row: int) -> Posture:
    """Return the posture of a part with a mesh on the aspect of a row."""
    hull = convex_hull(cast(Points, part.vertices), part.centre_of_mass, part.source)
    # some axes x, y, z as rows, with z up
    up = -aspects.normals[row]
    x = vectors.unit(vectors.cross(np.eye(3)[np.argmin(np.abs(up))], up))
    upright = np.array([x, vectors.cross(up, x), up])
    height = float(aspects.heights[row])
    corners = vectors.product(hull.vertices, upright.T)
    corners[:, 2] += height
    contact = vectors.product(aspects.polygons[row], upright.T)[::-1, :2]  # from below it runs the other way
    offset = float(np.hypot(*centroid(contact)))
    shape = outline(corners[:, :2])
    ahead = _forward(contact, shape, corners, hull.radius)
    turn = np.array([ahead, [-ahead[1], ahead[0]]])
    axes = np.eye(3)
    axes[:2, :2] = turn
    axes = vectors.product(axes, upright)
    rolling = None
    if np.isfinite(aspects.axes[row]).all():
        flat = vectors.product(axes, aspects.axes[row])[:2]
        rolling = check.frozen(flat / np.hypot(*flat))
    return Posture(
        name=aspects.names[row],
        kind=aspects.kinds[row],
        mass=part.mass,
        height=height,
        inertia=check.frozen(vectors.product(vectors.product(axes, part.inertia), axes.T)),
        contact=check.frozen(vectors.product(contact, turn.T)),
        outline=check.frozen(vectors.product(shape, turn.T)),
        offset=offset if offset > COINCIDE * hull.radius else 0.0,
        axis=rolling,
        corners=check.frozen(np.column_stack([vectors.product(corners[:, :2], turn.T), corners[:, 2]])),
        solid=part,
        axes=check.frozen(axes),
        rolling_circle=float(aspects.rolling_circles[row]),
        form=aspects.forms[row],
        lies=aspects.lies[row],
    )


def _forward(contact: Floats, shape: Floats, corners: Floats, size: float) -> Floats:
    """Return the unit vector of heading 0 in the floor."""
    towards = centroid(contact)
    if np.hypot(*towards) > COINCIDE * size:
        return towards / np.hypot(*towards)
    edges = sides(shape)
    lengths = np.hypot(*edges.T)
    longest = edges[lengths >= lengths.max() - SIDE_TOLERANCE * size]
    unit = longest / np.hypot(*longest.T)[:, None]

    def lopsidedness(along: Floats) -> tuple[float, ...]:
        """Return odd moments of the corners about one direction: they tell equal sides of any file apart."""
        across = np.column_stack([along, (-along[1], along[0])])
        x, y = vectors.product(corners[:, :2] / size, across).T
        z = corners[:, 2] / size
        moments = np.array([each.mean() for each in (x**3, y**3, x * z, y * z, x * y, x**2 * y)])
        return tuple(np.round(moments, 5) + 0.0)

    return max(unit, key=lopsidedness)


def _of_card(part: Part, aspects: Aspects, row: int) -> Posture:
    """Return the posture that the card prints; NaN where it is silent."""
    name, blocks = aspects.names[row], part.printed or {}
    printed = (blocks.get(block, {}) for block in ("floor", "track"))
    floor, track = (dict(block) if block.get("aspect") == name else {} for block in printed)
    analysed = {**track, **floor}
    turning = analysed.get("polar_inertia", float(aspects.polar_inertias[row]))
    # the analysed aspect stands with the file's x up and its z in the floor
    inertia = np.array(part.inertia[::-1, ::-1]) if analysed else np.full((3, 3), np.nan)
    inertia[2, 2] = turning
    nothing = check.frozen(np.empty((0, 2)))
    return Posture(
        name=name,
        kind=aspects.kinds[row],
        mass=part.mass,
        height=analysed.get("centroid_height", float(aspects.heights[row])),
        inertia=check.frozen(inertia),
        contact=nothing,
        outline=nothing,
        offset=analysed.get("drive_offset", np.nan),
        printed={"floor": floor, "track": track} if analysed else None,
    )


def choose_posture(
    part: Part, aspect: str | None, block: str, find_answer: Callable[[Part], Aspects] = find_aspects
) -> tuple[Posture, str | None]:
    """Return the part on an aspect, and why on this one.

    Parameters
    ----------
    part : Part
    aspect : str or None
        Name of the aspect. None takes the one that a card's block is about, else the likeliest, of a card the
        first.
    block : str
        Block of a part card: 'floor' or 'track'.
    find_answer : function of Part
        Returns its Aspects with the answer that says which is the likeliest; called only if that is needed.

    Returns
    -------
    Posture
    str or None
        Reason of the choice; None where the aspect was asked for.

    Raises
    ------
    FeederError
        If there is no such aspect.
    """
    if aspect is not None:
        return posture(part, find_aspects(part), aspect), None
    analysed = (part.printed or {}).get(block, {}).get("aspect")
    if analysed is not None:
        return posture(part, find_aspects(part), analysed), f"the one of the card's {block} block"
    answer = find_answer(part)
    if answer.recommended is None:
        return posture(part, answer, answer.names[0]), "the first of the card"
    return posture(part, answer, answer.likeliest), f"the likeliest ({answer.recommended.rule})"
