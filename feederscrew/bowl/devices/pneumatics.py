"""Air: the thrust of a nozzle, the vision reject that blows pulses, and the steady jet.

Source: isentropic flow through a nozzle; docs/tooling.md.
"""

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.base import units
from feederscrew.base import value_forms as forms
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.heavy import heavy
from feederscrew.bowl.devices import orientation_names, values
from feederscrew.bowl.devices.asked import Encounter, LyingPart
from feederscrew.bowl.devices.base import (
    GRIP,
    MM,
    UNSURE,
    ComparedValue,
    Device,
    Verdict,
    keeps,
    length_text,
    length_words,
    mapping_text,
    room_of,
)
from feederscrew.bowl.devices.features import Bore, Features, Jet, Sensor
from feederscrew.bowl.devices.trade import Action, ProposedBy, Trade, ValueSearch

if TYPE_CHECKING:
    from feederscrew.bowl.record import Track
    from feederscrew.resting.posture import Posture

optimize = heavy("scipy.optimize")
shapely = heavy("shapely")

AMBIENT_PRESSURE_PA = 101325.0  # [Pa]
CHOKED = ((1.4 + 1.0) / 2.0) ** (1.4 / 0.4)  # [1] of absolute pressures: beyond it the nozzle is choked
SPREAD = math.tan(math.radians(11.0))  # [1] growth of a free jet's radius: 10 to 12 deg to either side
RAYS, GOLDEN = 24, math.pi * (3.0 - math.sqrt(5.0))  # of a jet; [rad] from one to the next
TRIED, ENOUGH = 12, 0.5  # heights at which an orientation is blown at, and the least share of the thrust
JET_REACH_M = 0.5  # [m] no track is wider
ACROSS = (0.0, 1.0, 0.0)  # straight across the track
# [1] of a bore, that two bores one above the other leave between them at least. The housing of the table in
# docs/design.md takes 0.125: with 0.25 its nozzles stood farther apart, and two rejects were 96.1 % pure, for
# 98.8 %
NOZZLE_WEB = 0.1
# [m], [Pa], [s] of each nozzle: 1.28 N, 0.051 N s
PULSE_BORE_M = 2e-3
PULSE_PRESSURE_PA = 3e5
PULSE = 0.04
NOZZLE_COUNT = 4.0
BAR_PA, MS = units.factor("bar", "pressure"), units.factor("ms", "time")
REACTION = 0.01  # [s] of sensor and valve: 5 to 15 ms
SENSOR_TO_NOZZLE_M = 0.01  # [m] behind the sensor: a part is blown at as its middle comes to the nozzles
# of what stands at a vision reject
TRIGGER = "fibre of the trigger"
BRACKET_HOLE_M, BRACKET_THREAD = 3.3e-3, "M4"  # core of M4: ISO 2306
FIBRE_HOLE_M = 3e-3  # [m] of a fibre's head through the wall (assumption)
BRACKET_SIDE_M, BRACKET_OVER_M = 12e-3, 5e-3  # [m] beside the nozzles, over the tallest part (assumption)
SENSOR_VIEWS = ("outline", "side", "height", "relief")
RESOLUTION = {"outline": 1e-4, "side": 1e-4, "height": 1e-3, "relief": 1e-4}  # [m] camera, fibre, laser
SEEN_BY = {  # what sees a part so, and what it compares
    "outline": ("camera from above", "outlines that differ"),
    "side": ("camera from the side", "side views that differ"),
    "height": ("fibre sensor", "heights that differ"),
    "relief": ("laser along the middle", "height profiles that differ"),
}
NOZZLES = forms.mapping(
    ("nozzle", "pressure", "height", "time", "nozzles"),
    nozzle=forms.LENGTH_FORM,
    pressure=forms.quantity("pressure"),
    height=forms.LENGTH_FORM,
    time=forms.quantity("time"),
    nozzles=forms.quantity("count", "1", "20"),
)
# times the force that just moves a part off: within it, to either side, nothing is sure; and a reserve beyond
# that, of a jet that a design proposes
SURE_FORCE_RATIO, FORCE_RESERVE = 2.0, 1.1
JET_POSITIONS = 9  # along a part at which a jet meets it
NOZZLE_HEIGHTS = 6  # that a design tries, evenly up to the tallest orientation
MAX_JET_PRESSURE_PA, REGULATOR_STEP_PA = 4e5, 5e3  # of a usual compressed-air net, and of a regulator
NOZZLE_KEYS = ("nozzle", "pressure", "height")  # of a jet that blows all the time
JET_BORE_M, JET_PRESSURE_PA = 2e-3, 2e4  # [m], [Pa]


def thrust(diameter: float, pressure: float) -> float:
    """Return the thrust of a nozzle: isentropic flow of air, gamma = 1.4, of a convergent nozzle.

    With the pressure p0 in the nozzle and pa around it, both absolute, and the area A of the mouth: F = 2.4 A
    p0 / 1.893 - A pa where p0 / pa is beyond the critical ratio of 1.893, and the mouth has the critical
    pressure; below it F = 7 A p0 ((pa / p0)^(1/1.4) - pa / p0), and the mouth has the ambient one.

    Parameters
    ----------
    diameter : float [m]
        Of the mouth.
    pressure : float [Pa]
        Above the ambient.

    Returns
    -------
    float [N]

    References
    ----------
    The ideal nozzle; docs/validation.md, "Air jet".
    """
    area, whole = 0.25 * math.pi * diameter**2, pressure + AMBIENT_PRESSURE_PA
    if whole / AMBIENT_PRESSURE_PA > CHOKED:
        return 2.4 / CHOKED * whole * area - AMBIENT_PRESSURE_PA * area
    ratio = AMBIENT_PRESSURE_PA / whole
    return 2.0 * area * whole * 3.5 * (ratio ** (1.0 / 1.4) - ratio)


@dataclass(frozen=True)
class Nozzles:
    """Nozzles in the wall, one above the other, that blow straight across the track."""

    diameter: float  # [m] of each
    pressure: float  # [Pa] at the nozzles, above the ambient
    height: float | None = None  # [m] of the lowest over the track; None: as `heights` says
    count: int = 1

    @property
    def thrust(self) -> float:
        return thrust(self.diameter, self.pressure)

    @property
    def lowest(self) -> float:
        """The least height [m]: a bore stands upon the track, it does not cut into it."""
        return 0.5 * self.diameter

    @property
    def pitch(self) -> float:
        """The least distance [m] of two bores one above the other: they leave a web between them."""
        return (1.0 + NOZZLE_WEB) * self.diameter

    def has_room(self, height: float, others: Sequence[float]) -> bool:
        """Return whether a bore at a height leaves a web to the others.

        Parameters
        ----------
        height : float [m]
        others : sequence of float [m]

        Returns
        -------
        bool
        """
        return all(abs(height - other) >= self.pitch * (1.0 - 1e-9) for other in others)

    def heights(self, orientations: Sequence[LyingPart]) -> Floats:
        """Return their heights over the track, upwards.

        Where nothing is said of it, one nozzle blows at the lowest centre of mass. Several blow where each
        orientation has something before its centre of mass that is not a mere slope, as far as they are
        enough for that; the others are spread between those and the top of the tallest. No bore cuts into
        the track, and two of them leave a web between them. Where so many do not fit below the top of the
        tallest, they stand one above the other from the track on, and the upper ones blow past it.

        Parameters
        ----------
        orientations : sequence of LyingPart

        Returns
        -------
        (N,) float [m]
        """
        return np.array(_heights(self, tuple(orientations)))

    def moves(self, orientation: LyingPart, heights: Sequence[float]) -> float:
        """Return the force outwards, less the friction of that down, over the thrust of a nozzle.

        Parameters
        ----------
        orientation : LyingPart
        heights : sequence of float [m]
            Of the nozzles.

        Returns
        -------
        float [1]
        """
        pushes = [_share(orientation, self.diameter, float(height)) for height in heights]
        return sum(out - (orientation.grip or GRIP) * down for out, down in pushes)

    def push(
        self, orientation: LyingPart, orientations: Sequence[LyingPart], ahead: float = 0.0
    ) -> tuple[float, float]:
        """Return the forces on an orientation.

        Parameters
        ----------
        orientation : LyingPart
        orientations : sequence of LyingPart
            All of the part: they set the heights.
        ahead : float [m], optional
            By which the weight is ahead of the nozzles.

        Returns
        -------
        out, down : float [N]
        """
        heights = self.heights(orientations)
        pushes = [_share(orientation, self.diameter, float(height), ahead) for height in heights]
        out, down = (self.thrust * sum(push[k] for push in pushes) for k in range(2))
        return out, down

    def jets(
        self, place: float, orientations: Sequence[LyingPart], seconds: float = math.inf
    ) -> tuple[Jet, ...]:
        return tuple(
            Jet((place, 0.0, height), ACROSS, 0.5 * self.diameter, SPREAD, self.thrust, JET_REACH_M, seconds)
            for height in self.heights(orientations)
        )


@functools.lru_cache(maxsize=256)
def _heights(nozzles: Nozzles, orientations: Sequence[LyingPart]) -> tuple[float, ...]:
    low, count = nozzles.height, nozzles.count
    top = max(orientation.height for orientation in orientations)
    if low is None and count > 1:
        stack = nozzles.lowest + nozzles.pitch * np.arange(count)
        if stack[-1] > top:
            return tuple(stack.tolist())
        needed = _needed_heights(nozzles, orientations)
        if len(needed) <= count:
            return _spread(nozzles, needed, top)
    if low is None:
        low = max(min(orientation.posture.height for orientation in orientations), nozzles.lowest)
    high = max(top - low, low + nozzles.pitch * (count - 1))
    return tuple(np.linspace(low, high, count))


def _needed_heights(nozzles: Nozzles, orientations: Sequence[LyingPart]) -> list[float]:
    """Return the fewest heights so that each orientation has one in its lowest solid span at its weight.

    With them those that push most where nozzles blow at slopes, as far as there are nozzles. A height that
    leaves no web to another one is left out.
    """
    heights: list[float] = []
    spans = []
    for orientation in orientations:
        upright = shapely.LineString([(0.0, -orientation.height), (0.0, 2.0 * orientation.height)])
        pieces = [piece.bounds for piece in shapely.get_parts(orientation.aside.intersection(upright))]
        spans.append(min(((box[1], box[3]) for box in pieces), default=(0.0, orientation.height)))
    for bottom, end in sorted(spans, key=lambda span: span[1]):
        within = max(end - 0.5 * nozzles.diameter, 0.5 * (bottom + end), nozzles.lowest)
        if not any(bottom <= height <= end for height in heights) and nozzles.has_room(within, heights):
            heights.append(within)
    if len(heights) > nozzles.count:
        return heights
    for orientation in orientations:
        if len(heights) < nozzles.count and nozzles.moves(orientation, heights) < ENOUGH:
            tried = orientation.height * (np.arange(TRIED) + 0.5) / TRIED
            free = [h for h in tried.tolist() if h >= nozzles.lowest and nozzles.has_room(h, heights)]
            pushes = {height: nozzles.moves(orientation, [height]) for height in free}
            strongest = max(free, key=pushes.__getitem__, default=None)
            if strongest is not None and pushes[strongest] > nozzles.moves(orientation, heights):
                heights.append(strongest)
    return heights


def _spread(nozzles: Nozzles, heights: Sequence[float], top: float) -> tuple[float, ...]:
    """Return heights, filled up to so many nozzles, each amid the widest space up to the ``top`` [m].

    Where no space is wide enough, the next one stands above the highest; where that would be over the top,
    below the lowest. Without room there either it stands over the top, and blows past.
    """
    placed, pitch = sorted(heights), nozzles.pitch
    while len(placed) < nozzles.count:
        spaces = np.diff([*placed, top])
        k = int(np.argmax(np.round(spaces, 9)))
        amid = placed[k] + 0.5 * float(spaces[k])
        if nozzles.has_room(amid, placed):
            placed.insert(k + 1, amid)
        elif placed[-1] + pitch > top and placed[0] - pitch >= nozzles.lowest:
            placed.insert(0, placed[0] - pitch)
        else:
            placed.append(placed[-1] + pitch)
    return tuple(placed)


def _share(orientation: LyingPart, diameter: float, height: float, ahead: float = 0.0) -> tuple[float, float]:
    """Return the share of a jet's thrust that an orientation takes [1]: outwards from the wall, and down."""
    place = ahead, orientation.distance
    return shares_taken(orientation.posture, orientation.heading, place, diameter, height)[:2]


@functools.lru_cache(maxsize=4096)
def shares_taken(
    posture: "Posture", heading: float, place: tuple[float, float], diameter: float, height: float
) -> tuple[float, float, float]:
    """Return the shares of a jet's thrust that a part takes, in axes in which the jet blows along y.

    A jet without friction leaves a facet along it: what of its momentum is square to the facet stays. So each
    of ``RAYS`` equal rays gives the first facet that it meets (d . n) n of its share, d its direction and n
    the facet's normal. A facet that leans by a from upright takes cos^2 a outwards, sin a cos a down or up.

    Parameters
    ----------
    posture : Posture
    heading : float [rad]
        Of the part, about its weight.
    place : (float, float) [m]
        Of its weight from the mouth: to the right of the jet, and ahead along it.
    diameter : float [m]
        Of the mouth.
    height : float [m]
        Of the mouth over the track.

    Returns
    -------
    out, down, right : float [1]
        Along the jet, onto the track, and to the jet's right.

    References
    ----------
    Momentum of a jet on an inclined plate: F. M. White, "Fluid Mechanics", 8th ed., 2016, sec. 3.4.
    """
    points, faces = posture.surface, posture.facets
    plan = turned(points[:, :2], heading) + place
    corners = np.column_stack([plan, points[:, 2]])[faces]
    sides = vectors.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # those that face the wall, and that are no farther beside the jet than it is wide there
    wide = 0.5 * diameter + SPREAD * np.maximum(corners[..., 1].max(axis=1), 0.0)[:, None]
    x_and_z = corners[..., ::2] - [0.0, height]
    within = ((x_and_z.min(axis=1) <= wide) & (x_and_z.max(axis=1) >= -wide)).all(axis=1)
    corners, sides = (of[within & (sides[:, 1] < 0.0)] for of in (corners, sides))
    if not len(sides):
        return 0.0, 0.0, 0.0
    turn, off = GOLDEN * np.arange(RAYS), np.sqrt((np.arange(RAYS) + 0.5) / RAYS)
    places = off[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    directions = np.column_stack([SPREAD * places[:, 0], np.ones(RAYS), SPREAD * places[:, 1]])
    mouths = 0.5 * diameter * places + [0.0, height]
    mouths = np.column_stack([mouths[:, 0], np.zeros(RAYS), mouths[:, 1]])
    # how far each ray goes to each triangle that it meets
    slope = (sides * directions[:, None]).sum(axis=2)
    fall = ((corners[:, 0] - mouths[:, None]) * sides).sum(axis=2)
    far = np.divide(fall, slope, out=np.full(slope.shape, np.inf), where=slope < 0.0)
    ray, facet = np.nonzero(np.isfinite(far) & (far >= 0.0))
    spots = mouths[ray] + far[ray, facet][:, None] * directions[ray]
    inside = np.ones(len(ray), bool)
    for a in range(3):
        along, to = (corners[:, (a + 1) % 3] - corners[:, a])[facet], spots - corners[facet, a]
        inside &= (vectors.cross(along, to) * sides[facet]).sum(axis=1) >= 0.0
    ways = np.full(far.shape, np.inf)
    ways[ray[inside], facet[inside]] = far[ray[inside], facet[inside]]
    out = down = right = 0.0
    for direction, way in zip(directions, ways):
        if np.isfinite(way.min()):
            side = sides[way.argmin()]  # of the one it meets first
            size = np.sqrt((side**2).sum())
            into = (side * direction).sum() / (size * np.sqrt((direction**2).sum()))
            out, down = out + into * side[1] / size, down - into * side[2] / size
            right += into * side[0] / size
    return float(out) / RAYS, float(down) / RAYS, float(right) / RAYS


def pressure_for(diameter: float, force: float) -> float:
    """Return the pressure at which a nozzle has a thrust.

    Parameters
    ----------
    diameter : float [m]
        Of the mouth.
    force : float [N]
        At most that of ``MAX_JET_PRESSURE_PA``.

    Returns
    -------
    float [Pa]
        Above the ambient.

    Raises
    ------
    ValueError
        If no such pressure has that thrust.
    """
    return float(optimize.brentq(lambda bar: thrust(diameter, bar) - force, 0.0, MAX_JET_PRESSURE_PA))


@dataclass(frozen=True)
class VisionReject(Device):
    """A sensor that compares each part with the wanted one, and a pulse of air."""

    like: tuple[str, float, float] = ()  # type: ignore[assignment]  # it is always like something
    sees: str = "outline"
    resolution: float | None = None  # [m] of the sensor; None: as common
    nozzle: float = PULSE_BORE_M  # [m]
    pressure: float = PULSE_PRESSURE_PA  # [Pa] at the nozzle, above the ambient
    height: float | None = None  # [m] of the lowest nozzle over the track; None: low enough for the thinnest
    time: float = PULSE  # [s] of a pulse
    nozzles: float = NOZZLE_COUNT  # one above the other

    kind = "vision reject"
    trade = Trade(
        "{of: A@90, play: 0.5 mm, sees: outline}",
        "sensor and pulse of air: passes what is seen to differ from an orientation by less than play, blows "
        "the rest off the free edge; of may be a list, [A@90, A@270]: what is like any of them passes; "
        "sees outline (from above), side, height or relief (heights under a laser along the middle); "
        "resolution: 0.1 mm and "
        "jet: {nozzle: 2 mm, pressure: 3 bar, height: 4 mm, time: 40 ms, "
        "nozzles: 4} may follow; parts must come with gaps",
        forms.mapping(
            ("sees", "resolution", "jet"),
            of=forms.either(forms.NAMED, {"type": "array", "minItems": 1, "items": forms.NAMED}),
            play=forms.LENGTH_FORM,
            sees={"enum": list(SENSOR_VIEWS)},
            resolution=forms.LENGTH_FORM,
            jet=NOZZLES,
        ),
        old_name="sorter",
        measures="outline seen by a sensor",
        cost_class=3,
    )
    action = Action.SENSE
    search = ValueSearch(ProposedBy.VALUE)

    read = staticmethod(functools.partial(values.sensor, views=SENSOR_VIEWS))

    @property
    def blur(self) -> float:
        """By how much [m] what it sees is uncertain."""
        return RESOLUTION[self.sees] if self.resolution is None else self.resolution

    @property
    def names(self) -> tuple[tuple[str, float], ...]:
        """Aspects and headings [rad] of the orientations that it passes."""
        return (self.like[:2], *self.also)

    @classmethod
    def around(
        cls,
        encounter: Encounter,
        margin: float,
        where: str,
        unlike: Callable[[str], Sequence[LyingPart]] = lambda view: (),
    ) -> list["VisionReject"]:
        """Return the rejects of an orientation, one for each view.

        Parameters
        ----------
        encounter : Encounter
            With the orientation that passes.
        margin : float [m]
            By which what passes may differ, beside resolution, skew and hop.
        where : str
            What asks for them.
        unlike : callable, optional
            From a view to orientations that pass too, though they look otherwise: they are named beside it.

        Returns
        -------
        list of VisionReject
        """
        orientation, rejects = encounter.orientation, []
        for view in SENSOR_VIEWS:
            also = tuple((other.aspect, other.heading) for other in unlike(view))
            named = orientation.aspect, orientation.heading
            play = float(margin) + RESOLUTION[view] + encounter.askew(view)
            device = cls(where, like=(*named, play), sees=view, also=also)
            rejects.append(replace(device, like=(*named, play + device.hop_blur(orientation))))
        return rejects

    def with_play(self, play: float) -> Device:
        """Return the same vision reject with other play, and headings as its text has them.

        Parameters
        ----------
        play : float [m]

        Returns
        -------
        VisionReject
        """
        turns = [(name, f"{np.degrees(turn):.6g}") for name, turn in self.names]
        first, *also = ((name, float(np.radians(float(turn)))) for name, turn in turns)
        return replace(self, like=(*first, float(play)), also=tuple(also)).rewritten()

    def with_pulse(self, time: float) -> Device:
        return replace(self, time=time).rewritten()

    @property
    def compared_values(self) -> tuple[ComparedValue, ...]:
        # the order of the orientations that pass makes no difference
        first, *rest = sorted(self.names)
        ordered = replace(self, like=(*first, self.like[2]), also=tuple(rest))
        return super(VisionReject, ordered).compared_values

    def value_text(self) -> str:
        names = [orientation_names.written(*orientation) for orientation in self.names]
        # of nozzles and pulse what is not as by default
        nozzles = [
            ("nozzle", length_text(self.nozzle), self.nozzle != PULSE_BORE_M),
            ("pressure", f"{self.pressure / BAR_PA:.9g} bar", self.pressure != PULSE_PRESSURE_PA),
            ("height", "" if self.height is None else length_text(self.height), True),
            ("time", f"{self.time / MS:.9g} ms", self.time != PULSE),
            ("nozzles", f"{self.nozzles:.9g}", self.nozzles != NOZZLE_COUNT),
        ]
        jet = [(key, text) for key, text, changed in nozzles if changed and text]
        return mapping_text(
            (
                ("of", names[0] if len(names) == 1 else f"[{', '.join(names)}]"),
                ("play", length_text(self.like[2])),
                ("sees", self.sees),
                ("resolution", "" if self.resolution is None else length_text(self.resolution)),
                ("jet", mapping_text(jet) if jet else ""),
            )
        )

    @property
    def full_name(self) -> str:
        return f"{self.kind} ({SEEN_BY[self.sees][0]})"

    @property
    def value_words(self) -> str:
        what, most = SEEN_BY[self.sees][1], length_words(self.like[2])
        pulse = "" if self.time == PULSE else f", air for {self.time / MS:.4g} ms"
        return f"keeps {keeps(self.names)}, rejects {what} by more than {most}{pulse}"

    @property
    def shop_words(self) -> tuple[str, ...]:
        most = f"resolves {length_words(self.blur)}, rejects more than {length_words(self.like[2])}"
        nozzles = f"{self.nozzles:.0f} nozzles of {length_words(self.nozzle)} in the wall"
        valve = f"solenoid valve: opens within {REACTION / MS:.3g} ms, pulse of {self.time / MS:.4g} ms"
        return (
            f"{SEEN_BY[self.sees][0]}: {most}",
            f"{nozzles}, {self.pressure / BAR_PA:.4g} bar at the nozzle; {valve}",
        )

    def document_values(self) -> Document:
        return {
            "value_mm": self.like[2] / MM,
            "sees": self.sees,
            "resolution_mm": self.blur / MM,
            "thrust_N": self.jet.thrust,
        }

    def differs(self, encounter: Encounter) -> float:
        """Return by how much an orientation is seen to differ from the nearest of the wanted ones.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        float [m]
            At least, of what is not wanted; at most, of what is: either may come askew.
        """
        wanted, own = self.wanted(encounter.orientations), encounter.orientation
        if any((other.aspect, other.heading) == (own.aspect, own.heading) for other in wanted):
            return encounter.askew(self.sees)
        return min(encounter.differs(other, self.sees) for other in wanted)

    def wanted(self, orientations: Sequence[LyingPart]) -> tuple[LyingPart, ...]:
        source = self.where, f"{self.kind} names"
        places = (orientation_names.place_of(orientations, *named, *source) for named in self.names)
        return tuple(orientations[k] for k in places)

    @property
    def jet(self) -> Nozzles:
        return Nozzles(self.nozzle, self.pressure, self.height, round(self.nozzles))

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        room = room_of(orientations)
        middle = 0.5 * room
        sensor = Sensor(middle, self.sees, self.wanted(orientations), self.like[2], self.blur)
        nozzles = middle + SENSOR_TO_NOZZLE_M
        jets, mounts = self.jet.jets(nozzles, orientations, self.time), self._mounts(middle, orientations)
        return Features(room + SENSOR_TO_NOZZLE_M, jets=jets, mounts=mounts, sensor=sensor)

    def _mounts(self, middle: float, orientations: Sequence[LyingPart]) -> tuple[Bore, ...]:
        """Holes for the valve block, beside the nozzles over the tallest part, and for the trigger's fibre.

        The fibre is where the front of the wanted part is as its middle comes to the sensor, ``middle`` [m];
        at the begin of the window where nozzles are in the way there.
        """
        nozzles, wanted = middle + SENSOR_TO_NOZZLE_M, self.wanted(orientations)[0]
        trigger = middle + float(wanted.outline[:, 0].max())
        if trigger > nozzles - self.nozzle - FIBRE_HOLE_M:
            trigger = 0.0
        over = max(orientation.height for orientation in orientations) + BRACKET_OVER_M
        block = "valve block at the nozzles"
        beside = (nozzles - BRACKET_SIDE_M, nozzles + BRACKET_SIDE_M)
        return (
            *(Bore(block, place, over, BRACKET_HOLE_M, BRACKET_THREAD) for place in beside),
            Bore(TRIGGER, trigger, 0.5 * wanted.height, FIBRE_HOLE_M),
        )

    def hop_blur(self, orientation: LyingPart) -> float:
        return 0.0 if self.sees == "outline" else orientation.hop

    def gap(self, orientation: LyingPart, speed: float) -> float:
        beam = self.nozzle + 2.0 * SPREAD * orientation.width
        return max(beam + speed * (REACTION + self.time), self.blur)

    def judged(self, encounter: Encounter) -> Verdict:
        margin = self.like[2] - self.differs(encounter)
        margin = math.copysign(max(abs(margin) - self.blur, 0.0), margin)
        if margin < 0.0:
            lying = encounter.orientations or (encounter.orientation,)
            if encounter.blown(*self.jet.push(encounter.orientation, lying), self.time) <= 0.0:
                return encounter.verdict(0.0)  # it is carried on, whatever is seen
        return encounter.verdict(margin)


@dataclass(frozen=True)
class AirJet(Device):
    """A nozzle in the wall that blows all the time: it moves off what offers it enough area at its height."""

    nozzle: float = JET_BORE_M  # [m]
    pressure: float = JET_PRESSURE_PA  # [Pa] above the ambient
    height: float = 0.0  # [m] of the nozzle over the track

    kind = "air jet"
    trade = Trade(
        "{nozzle: 2 mm, pressure: 0.2 bar, height: 8 mm}",
        "nozzle in the wall that blows all the time, at a height over the track: returns what it moves over "
        "the free edge while it passes; sure where the force is twice as large or half as large as that "
        "takes",
        forms.mapping(
            nozzle=forms.LENGTH_FORM, pressure=forms.quantity("pressure"), height=forms.LENGTH_FORM
        ),
        old_name="jet",
        measures="area that it offers a jet",
        cost_class=2,
    )
    action = Action.BLOW
    search = ValueSearch(ProposedBy.VALUE)

    read = staticmethod(functools.partial(values.nozzle, needed=NOZZLE_KEYS))

    @classmethod
    def proposals(
        cls,
        wanted: Sequence[Encounter],
        competitors: Sequence[Encounter],
        orientations: Sequence[LyingPart],
        where: str,
    ) -> "list[AirJet]":
        """Return the jets that blow surely off some orientations and surely leave others, one a height.

        Each jet has the least pressure that blows off as many as the greatest one that leaves all that are
        wanted.

        Parameters
        ----------
        wanted, competitors : sequence of Encounter
            Those that it leaves, and those that it blows off.
        orientations : sequence of LyingPart
            All of the part.
        where : str
            What asks for them.

        Returns
        -------
        list of AirJet
        """
        jets, top = [], max(orientation.height for orientation in orientations)
        # no bore cuts into the track
        tried = np.maximum(top * (np.arange(NOZZLE_HEIGHTS) + 0.5) / NOZZLE_HEIGHTS, 0.5 * JET_BORE_M)
        for height in np.unique(np.round(tried, 4)):
            jet = cls(where, height=float(height))
            own, full, bore = jet.jet.thrust, thrust(jet.nozzle, MAX_JET_PRESSURE_PA), jet.nozzle
            ratio, most = SURE_FORCE_RATIO * FORCE_RESERVE, max(map(jet.most, wanted)) / own
            limit = min(full, 1.0 / (ratio * most) if most > 0.0 else full)
            thrusts = [ratio * own / max(jet.factor(encounter), 1e-12) for encounter in competitors]
            enough = max((force for force in thrusts if force <= limit), default=None)
            if enough is not None:
                steps = math.ceil(pressure_for(bore, enough) / REGULATOR_STEP_PA - 1e-6)
                jets.append(replace(jet, pressure=steps * REGULATOR_STEP_PA).rewritten())
        return jets

    @property
    def label(self) -> str:
        return f"{self.kind} {self.text}"

    def value_text(self) -> str:
        entries = (("nozzle", length_text(self.nozzle)), ("pressure", f"{self.pressure / BAR_PA:.9g} bar"))
        return mapping_text((*entries, ("height", length_text(self.height))))

    @property
    def value_words(self) -> str:
        bore, high = length_words(self.nozzle), length_words(self.height)
        return f"nozzle of {bore} at {self.pressure / BAR_PA:.4g} bar, {high} over the track"

    @property
    def shop_words(self) -> tuple[str, ...]:
        bore, bar = length_words(self.nozzle), f"{self.pressure / BAR_PA:.4g} bar"
        return (f"1 nozzle of {bore} in the wall, blows steadily: regulator {bar}",)

    def document_values(self) -> Document:
        return {
            "nozzle_mm": self.nozzle / MM,
            "pressure_bar": self.pressure / 1e5,
            "height_mm": self.height / MM,
            "thrust_N": self.jet.thrust,
        }

    @property
    def jet(self) -> Nozzles:
        return Nozzles(self.nozzle, self.pressure, self.height)

    def factor(self, encounter: Encounter) -> float:
        """Return its mean force on an orientation that passes, over the one that just moves it off.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        float [1]
        """
        return float(np.mean(self._factors(encounter)))

    def most(self, encounter: Encounter) -> float:
        """Return the greatest such factor at any place along an orientation.

        Parameters
        ----------
        encounter : Encounter

        Returns
        -------
        float [1]
        """
        return float(self._factors(encounter).max())

    def _factors(self, encounter: Encounter) -> Floats:
        """The same (JET_POSITIONS,) along its length: it may offer more ahead or behind than amid."""
        orientation = encounter.orientation
        lying = encounter.orientations or (orientation,)
        wide = self.nozzle + SPREAD * orientation.width + orientation.length
        first, last = orientation.outline[:, 0].min(), orientation.outline[:, 0].max()
        places = first + (np.arange(JET_POSITIONS) + 0.5) / JET_POSITIONS * (last - first)
        pushes = [self.jet.push(orientation, lying, -place) for place in places.tolist()]
        force = encounter.force_to_clear(wide, self.height)
        return np.array([out - encounter.grip * max(down, 0.0) for out, down in pushes]) / force

    def judged(self, encounter: Encounter) -> Verdict:
        if encounter.hanging:
            return encounter.verdict(0.0)
        factor, most = self.factor(encounter), self.most(encounter)
        distance = encounter.orientation.track.width - encounter.orientation.distance
        margin = distance * (1.0 - (most if factor < 1.0 else factor))
        if most > 1.0 / SURE_FORCE_RATIO and factor < SURE_FORCE_RATIO:
            margin = 0.0 if factor < 1.0 else -UNSURE
        return encounter.verdict(max(margin, -distance))

    def features(self, track: "Track", orientations: Sequence[LyingPart]) -> Features:
        room = room_of(orientations)
        return Features(room, jets=self.jet.jets(0.5 * room, orientations))
