"""Holes in the track about the bowl's axis, and the devices with an edge across it: gap and cut-out."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
import shapely

from feederscrew.base import check
from feederscrew.base import value_forms as forms
from feederscrew.base.arrays import Points
from feederscrew.base.errors import ConfigError
from feederscrew.base.geometry.compiled import frozen_rows, record_type
from feederscrew.bowl.devices import values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import UNSURE, Device, Verdict, carried, corners_text
from feederscrew.bowl.devices.features import WALL_OVERCUT_M, Features, TrackOpening, through_the_wall
from feederscrew.bowl.devices.trade import Action, Bound, ProposedBy, Trade, ValueSearch
from feederscrew.bowl.devices.values import Corner

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track

SAGITTA = 4e-6  # of the radius: by which a hole's bulging edge may be seen too flat ...
FLATTEST = 2e-6  # [m] ... and at most; a short base of the support makes up to ten times that of the margin
FAR_M = 10.0  # [m] beyond any hole across the track
GAP_EDGE_POINTS = 33  # points along the edge of a gap that is parallel to a radial one
DRAWN = forms.mapping(dxf=forms.TEXT_FORM, layer={"type": ["string", "number"]})
# theta = alpha + kappa r + asin(gamma / r) between the radii low and high; an arc of the radius low from the
# angle alpha to kappa. Where it bulges, track is left on the side of the axis.
HOLE_EDGE = record_type("arc", "alpha", "kappa", "gamma", "low", "high", "bulge", flags=("arc", "bulge"))


class HoleEdges(NamedTuple):
    """Edges of a hole in the track, about the bowl's axis."""

    edges: np.recarray  # (M,) HOLE_EDGE
    nodes: Points  # (P, 3) [rad, m] points of its border that what is left may end in; 1: corner


def polygon(corners: Points, radius: float) -> HoleEdges:
    """Return a hole about the bowl's axis from its unrolled polygon, straight edges when unrolled.

    Parameters
    ----------
    corners : (K, 2) float [m]
        Along the wall, and from it, either way round.
    radius : float [m]
        Of the wall.

    Returns
    -------
    HoleEdges

    Raises
    ------
    ValueError
        If the shape is wrong or an entry is not finite.
    """
    ring = check.shaped("corners", corners, (-1, 2)).tolist()
    # counter-clockwise, length along to the right and distance from the wall upwards
    left = sum(s0 * y1 - y0 * s1 for (s0, y0), (s1, y1) in _sides(ring)) > 0.0
    sides = _sides(through_the_wall(ring if left else ring[::-1]))
    rows, nodes = [], []
    for (s0, y0), (s1, y1) in sides:
        # from a later to an earlier angle the hole, on its left, lies nearer to the wall: the track bulges
        theta0, r0, theta1, r1 = s0 / radius, radius - y0, s1 / radius, radius - y1
        if r0 == r1:
            rows.append([1.0, min(theta0, theta1), max(theta0, theta1), 0.0, r0, r0, float(theta1 < theta0)])
            continue
        kappa, bulges = (theta1 - theta0) / (r1 - r0), float(theta1 < theta0)
        rows.append([0.0, theta0 - kappa * r0, kappa, 0.0, min(r0, r1), max(r0, r1), bulges])
    for ((s0, y0), (s1, y1)), (_, (s2, y2)) in zip((sides[-1], *sides), sides):
        bend = (s1 - s0) * (y2 - y1) - (y1 - y0) * (s2 - s1)
        if bend < 0.0:  # it points into the hole: a corner of the track
            nodes.append((s1 / radius, radius - y1, 1.0))
    for (s0, y0), (s1, y1) in sides:  # points along an edge beyond which the track left bulges
        if s1 >= s0:
            continue
        flat = min(SAGITTA * radius, FLATTEST)
        r = max(radius - max(y0, y1), 1e-3 * radius)
        pieces = math.ceil(abs(s1 - s0) * r / radius / math.sqrt(8.0 * r * flat))
        shares = [k / pieces for k in range(1, pieces)]
        nodes += [((s0 + k * (s1 - s0)) / radius, radius - (y0 + k * (y1 - y0)), 0.0) for k in shares]
    return HoleEdges(edges=frozen_rows(rows, HOLE_EDGE), nodes=np.array(nodes).reshape(-1, 3))


def gap(length: float, radius: float, width: float) -> HoleEdges:
    """Return a gap across the track: the edge left is radial, the edge met parallel to it.

    Parameters
    ----------
    length : float [m]
        Between both edges.
    radius : float [m]
        Of the wall, from which it reaches ...
    width : float [m]
        ... so far.

    Returns
    -------
    HoleEdges
    """
    low, high = max(radius - width, 1e-3 * radius, 1.000001 * length), radius + WALL_OVERCUT_M
    rows = [[0.0, 0.0, 0.0, 0.0, low, high, 0.0], [0.0, 0.0, 0.0, length, low, high, 0.0]]
    inner = [1.0, 0.0, np.arcsin(length / low), 0.0, low, low, 1.0]
    return HoleEdges(edges=frozen_rows([*rows, inner], HOLE_EDGE), nodes=np.empty((0, 3)))


def hole_edges(opening: TrackOpening | None, track: "Track") -> HoleEdges | None:
    """Return the edges of an opening about the bowl's axis, if it has one across the track.

    Parameters
    ----------
    opening : TrackOpening or None
    track : Track

    Returns
    -------
    HoleEdges or None
        None of an opening that goes on along the track.
    """
    if opening is None or opening.span is not None:
        return None
    if opening.gap > 0.0:
        return gap(opening.gap, track.radius, track.extent)
    return polygon(opening.ring, track.radius)


def _sides(corners: Sequence[Corner]) -> list[tuple[Corner, Corner]]:
    return list(zip(corners, (*corners[1:], corners[0])))


class Across(Device):
    """A hole with an edge across the track."""

    action: ClassVar[Action] = Action.CUT

    def hop_blur(self, orientation: LyingPart) -> float:
        """Return its flight [m]: over an edge across the track it lands so much further."""
        return orientation.flight


class Gap(Across):
    """A gap across the track."""

    kind = "gap"
    trade = Trade(
        "9 mm",
        "gap of that length across the track, its edges parallel, the one that is left radial",
        measures="reach of the foot ahead of and behind the centre of mass",
    )
    search = ValueSearch(ProposedBy.VALUE, Bound.LOWER, "gap", rank=2)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        radius, width = track.radius, track.extent
        off = np.linspace(width, 0.0, GAP_EDGE_POINTS)
        left, met = (
            radius * (edge.alpha + np.arcsin(np.minimum(edge.gamma / (radius - off), 1.0)))
            for edge in gap(self.limit, radius, width).edges[:2]
        )
        ring = np.vstack([[[left[0], width], [left[-1], 0.0]], np.column_stack([met, off])[::-1]])
        return Features(float(ring[:, 0].max()), openings=(TrackOpening(ring, gap=self.limit),))

    def more(self, encounter: Encounter) -> float:
        return encounter.orientation.carry_ahead

    def judged(self, encounter: Encounter) -> Verdict:
        needed, carry = encounter.orientation.gap, encounter.orientation.carry_ahead
        return encounter.verdict(carried(needed - self.limit, self.limit - needed, carry))


class CutOut(Across):
    """A hole of several corners."""

    kind = "cut-out"
    trade = Trade(
        "[[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 8 mm]]",
        "hole in the track: lengths along the wall and distances from it, unrolled; or "
        "{dxf: file, layer: CUT}",
        forms.either(forms.POLYGON, DRAWN),
        old_name="cut_out",
    )
    search = ValueSearch(ProposedBy.SHAPE)

    read = staticmethod(values.polygon)

    def value_text(self) -> str:
        return corners_text(self.corners)

    def misfits(self, width: float) -> list[ConfigError]:
        across = [y for _, y in self.corners]
        return self.hole_faults(width, min(across), max(across), endless=False)

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        ring = np.array(self.corners)
        return Features(float(ring[:, 0].max()), openings=(TrackOpening(ring),))

    def judged(self, encounter: Encounter) -> Verdict:
        return judge_hole(encounter, np.array(self.corners))


def judge_hole(encounter: Encounter, ring: Points) -> Verdict:
    """Return what a hole of an outline does with an orientation: that of one that travels needs time to tip.

    Parameters
    ----------
    encounter : Encounter
    ring : (K, 2) float [m]
        The outline: along the wall, and from it.

    Returns
    -------
    Verdict

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    orientation = encounter.orientation
    hole = polygon(ring, orientation.track.radius)
    margin, shift = encounter.over_hole(hole)
    if margin < 0.0 < orientation.carry:
        margin = carried(margin, encounter.unheld(hole), orientation.carry)
        area = shapely.Polygon(ring)
        across = (shapely.LineString([(x, -FAR_M), (x, FAR_M)]) for x in ring[:, 0])
        if encounter.rides(max(area.intersection(line).length for line in across), float(np.ptp(ring[:, 0]))):
            margin = max(margin, -UNSURE)
    return encounter.verdict(margin, shift)
