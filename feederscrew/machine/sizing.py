"""The bowl that a part needs: diameter, track, climb, turns; its fill; and the stroke that brings a rate."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.polygons import turned
from feederscrew.bowl.devices.orientation_names import nearest
from feederscrew.bowl.record import (
    RIGHT_ANGLE_RAD,
    Bowl,
    BowlGrid,
    Machine,
    Sizing,
    Track,
    shares,
)
from feederscrew.bowl.size import MIN_WALL_ABOVE_PART_M, Size
from feederscrew.feeding import well_oriented
from feederscrew.machine.springs import analyse_springs, gain, greatest_amplitude
from feederscrew.motion import conveying as answer
from feederscrew.motion.headings import headings
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.posture import posture

STRAIGHT_TRACK = Track(climb=0.0, bank=0.0, radius=1e3, width=1.0)  # [m] a wall without a bend
MAX_SIZING_ITERATIONS = 200  # of a search that halves its error in each
DIAMETER_TOLERANCE_M = 1e-12  # [m]
MAX_WALL_SLOPE = 0.9  # slope, a little over 40 deg, of a wall between two turns that lie beside each other


@dataclass(frozen=True)
class Lying:
    """A part on its stable aspects along a straight wall."""

    longest: float  # [m] along the wall, of every stable orientation
    tallest: float  # [m]
    length: float  # [m] along the wall, of the longest orientation that is wanted
    width: float  # [m] from the wall, of the widest orientation that is wanted
    hanging: float = 0.0  # [m] greatest length of a part that leaves hanging; 0 where none does


@dataclass(frozen=True, eq=False)
class SizedShape:
    """One part against the wall, seen from above; x ahead, y inwards, from its centre of mass."""

    outline: Floats  # (J, 2) [m]
    to_wall: float  # [m] from the foot of the centre of mass
    length: float  # [m] along the wall


def find_lying(part: Part, aspects: Aspects, wanted: tuple[str, float] | None = None) -> Lying:
    """Compute the room that a part takes along a wall on its stable aspects.

    The wall is straight: the bend of the bowl that is not yet sized is added by ``size_bowl``.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    wanted : (str, float [rad]), optional
        Aspect and heading that are to leave the bowl; every stable orientation without it.

    Returns
    -------
    Lying

    Raises
    ------
    FeederError
        If the part is a card without an outline.

    References
    ----------
    docs/bowl.md, "1. The part, and the rate".
    """
    stood = [posture(part, aspects, aspects.names[row]) for row in np.flatnonzero(aspects.stable)]
    stable = [headings(posed, STRAIGHT_TRACK) for posed in stood]
    rows = [
        (on_aspect.aspect, *row)
        for on_aspect in stable
        for row in zip(on_aspect.headings, on_aspect.lengths, on_aspect.widths)
    ]
    counted = rows
    if wanted is not None:
        counted = [rows[nearest([row[0] for row in rows], [row[1] for row in rows], *wanted)]]
    return Lying(
        longest=float(max(row[2] for row in rows)),
        tallest=float(max(np.max(np.asarray(posed.corners)[:, 2]) for posed in stood)),
        length=float(max(row[2] for row in counted)),
        width=float(max(row[3] for row in counted)),
    )


def size_shape(
    part: Part, aspects: Aspects, track: Track, wanted: tuple[str, float] | None = None
) -> SizedShape:
    """Return the outline of one orientation against the wall, seen from above.

    Parameters
    ----------
    part : Part
    aspects : Aspects
    track : Track
    wanted : (str, float [rad]), optional
        Aspect and heading; the nearest stable heading is taken. Without it, the most frequent heading of the
        first stable aspect.

    Returns
    -------
    SizedShape

    References
    ----------
    ``motion.headings``.
    """
    name = aspects.names[int(np.flatnonzero(aspects.stable)[0])] if wanted is None else wanted[0]
    stood = posture(part, aspects, name)
    stable = headings(stood, track)
    row = 0
    if wanted is not None:
        row = nearest([name] * len(stable.headings), list(stable.headings), *wanted)
    outline = check.frozen(turned(stood.outline, stable.headings[row]))
    return SizedShape(outline, float(stable.distances[row]), float(stable.lengths[row]))


def size_bowl(
    part: Lying,
    drive_text: str,
    rules: Sizing,
    *,
    sorts: bool,
    diameter: float | None = None,
    width: float | None = None,
    climb: float | None = None,
) -> Size:
    """Compute the bowl that holds and carries a part.

    The diameter D is the largest of what each rule asks for, rounded up to the next step: no bowl is smaller;
    a multiple of the longest part; a multiple of the track's width w = b + c + l^2 / (2 D). There b is the
    part's width, c its play and l its length; the last term is the sagitta of the wall on both sides of the
    part. As w hangs on D, both are found in turn. The climb is the least at which parts pass below the next
    turn: phi = atan(rise / (pi D)).

    Parameters
    ----------
    part : Lying
    drive_text : str
        What a fault names: the part's file.
    rules : Sizing
    sorts : bool
        A given width may be too little for some orientations, which then fall off it.
    diameter : float [m], optional
        Of a bowl that exists.
    width : float [m], optional
        Of its track.
    climb : float [rad], optional
        Of its track.

    Returns
    -------
    Size
        Its ``turns`` NaN on a level track.

    Raises
    ------
    FeederError
        If it takes a bowl that nobody builds, or the given one is smaller than the part.

    References
    ----------
    A published bowl generator; docs/bowl.md and the keys of ``sizing``, each with its own source.
    """
    play = float(np.clip(rules.clearance * part.width, rules.least_clearance, rules.greatest_clearance))
    # the diameter that each rule asks for [m]; width and bend of the track hang on each other
    least = {
        "no bowl is smaller": rules.least_diameter,
        "length of the part": rules.diameter_per_length * part.longest,
    }
    if width is None:
        across = max(least.values())
        for _ in range(MAX_SIZING_ITERATIONS):
            before, wide = across, part.width + play + part.length**2 / (2.0 * across)
            across = max(*least.values(), rules.diameter_per_width * wide)
            if abs(across - before) < DIAMETER_TOLERANCE_M:
                break
        least["width of the track"] = rules.diameter_per_width * wide
    else:
        room = width - part.width - play
        least["width of the track"] = rules.diameter_per_width * width
        if room > 0.0 or not sorts:
            least["bend on this track"] = part.length**2 / (2.0 * room) if room > 0.0 else np.inf
    across = float(np.ceil(max(least.values()) / rules.diameter_step - 1e-9) * rules.diameter_step)
    if diameter is not None:
        across = diameter
    if np.isinf(across):
        what = f"needs {1e3 * part.width:.4g} mm of track and its play, more than track.width"
        raise FeederError(drive_text, what, "widen the track, or leave track.width out")
    if across > rules.greatest_diameter:
        what = f"needs a bowl of {1e3 * across:.4g} mm, and none is larger than"
        mend = "feed it from a step or belt feeder, or raise sizing.greatest_diameter"
        raise FeederError(drive_text, f"{what} {1e3 * rules.greatest_diameter:.4g} mm", mend)
    if diameter is not None and across < 2.0 * part.longest:
        what = f"{500.0 * across:.4g} mm is too small for a part {1e3 * part.longest:.4g} mm long"
        raise FeederError("track.radius", what, "leave it out, to have the bowl sized")
    bend = part.length**2 / (2.0 * across)
    wide = part.width + play + bend if width is None else width
    depth = rules.outlet_height if rules.outlet_height > 0.0 else rules.depth * across
    angle = climb
    if angle is None:  # the least: parts pass below the next turn, or below the slope that leads to it
        rise, length = rules.headroom * part.tallest + rules.sheet, np.pi * across
        if rules.shape != "cylinder":
            tallest = [tall for tall in (part.tallest, part.hanging) if tall > 0.0]
            free = sum(max(rules.headroom * tall, tall + MIN_WALL_ABOVE_PART_M) for tall in tallest)
            rise = free + MAX_WALL_SLOPE * wide + 4.0 * rules.sheet
            length = np.pi * (across - wide)
        angle = max(rules.least_climb, np.arctan(rise / length))
    pitch = np.pi * across * np.tan(angle)
    turns = depth / pitch if pitch > 0.0 else np.nan
    return Size(across, least, wide, play, bend, float(angle), depth, float(turns), float(pitch))


FILL_LEVEL_COUNT = 21  # of the curve, from full to empty


@dataclass(frozen=True)
class Fill:
    """A full bowl."""

    volume: float  # [m3] that the parts take up, gaps included
    mass: float  # [kg] of the parts
    inertia: float  # [kg m2] of the parts about the bowl's axis, spread evenly over its floor


@dataclass(frozen=True, eq=False)
class Emptying:
    """A bowl from full to empty; N levels."""

    levels: Floats  # (N,) [1] of the full bowl, from 1 to 0
    masses: Floats  # (N,) [kg] in the bowl
    natural_frequencies: Floats  # (N,) [Hz]
    gains: Floats  # (N,) [1]
    springs: Floats  # (N,) [1] stroke between bowl and base over that of the empty bowl
    strokes: Floats  # (N,) [1] stroke of the bowl at its track over that of the empty bowl, left alone
    angles: Floats  # (N,) [rad] from the track to the bowl's motion there
    controlled: Floats  # (N,) [1] the same under amplitude control, as far as the controller reaches


def full_bowl(radius: float, depth: float, bulk: float, rules: Sizing) -> Fill:
    """Compute the parts in a full bowl: V = pi R^2 H f, m = V p rho and I = m R^2 / 2.

    Parameters
    ----------
    radius : float [m]
        R, of the inside.
    depth : float [m]
        H, rise of the track.
    bulk : float [kg/m3]
        rho: mass of a part over the volume of its hull, as neighbours keep out of its hollows.
    rules : Sizing
        f ``fill_height``, p ``packing``.

    Returns
    -------
    Fill
        Spread evenly over the floor.

    References
    ----------
    The keys of the section ``sizing``, each with its own source.
    """
    volume = np.pi * radius**2 * depth * rules.fill_height
    mass = volume * rules.packing * bulk
    return Fill(volume, mass, 0.5 * mass * radius**2)


def loaded_bowl(machine: Machine, fill: Fill, share: float) -> Machine:
    """Return the machine with a share of a fill vibrating with its bowl.

    The fill lies flat over the floor: about an upright axis it has its inertia, about a level one half of it.

    Parameters
    ----------
    machine : Machine
    fill : Fill
    share : float [1]

    Returns
    -------
    Machine
    """
    around, own = share * fill.inertia, machine.unbalance
    upright = own.upright[0] + 0.5 * around, own.upright[1] + 0.5 * around  # spread flat over the floor
    return replace(
        machine,
        bowl_mass=machine.bowl_mass + share * fill.mass,
        bowl_inertia=machine.bowl_inertia + around,
        unbalance=replace(own, upright=upright),
    )


def emptying(bowl: Bowl, fill: Fill) -> Emptying:
    """Compute how the stroke changes as a bowl empties.

    Natural frequency and gain are computed at each level, from full to empty. The springs move by force times
    gain over stiffness. Of that the bowl rises by the share m2 / (m1 + m2) and turns by I2 / (I1 + I2). The
    force of the magnet and the damping ratio stay as they are; the damping that parts add is left out, so
    that a real stroke near resonance is less than the one here.

    Parameters
    ----------
    bowl : Bowl
        Empty, with the drive of the empty bowl. Its ``sizing`` says the share of the fill that is carried.
    fill : Fill
        Of the full bowl.

    Returns
    -------
    Emptying
        At ``FILL_LEVEL_COUNT`` levels.

    References
    ----------
    Two free bodies on springs; docs/bowl.md, "Why it feeds 220 for half a minute and then 165".
    """
    machine, rules, drive = bowl.machine, bowl.sizing, bowl.drive
    levels = np.linspace(1.0, 0.0, FILL_LEVEL_COUNT)
    laden = [loaded_bowl(machine, fill, rules.carried * u) for u in levels]
    natural = np.array([analyse_springs(machine_at_level).natural_frequency for machine_at_level in laden])
    gains = gain(drive.frequency, natural, machine.damping)
    # the last level is the empty bowl: the force is that which moves it
    relative = gains / gains[-1]
    rises, turns = np.array([shares(machine_at_level) for machine_at_level in laden]).T
    upright = drive.vibration_angle + bowl.track.climb
    along = relative * turns / turns[-1] * np.cos(upright)
    up = relative * rises / rises[-1] * np.sin(upright)
    strokes = np.hypot(along, up)
    angles = np.clip(np.arctan2(up, along) - bowl.track.climb, 0.0, RIGHT_ANGLE_RAD)
    angles[-1], strokes[-1] = drive.vibration_angle, 1.0  # without rounding
    reach = np.minimum(1.0, strokes / rules.controller)
    columns = (levels, levels * fill.mass, natural, gains, relative, strokes, angles, reach)
    return Emptying(*(check.frozen(a) for a in columns))


STROKE_SAMPLES = 120  # strokes that are looked at
STROKES_AT_A_TIME = 12  # of them: those beyond the first that is enough are not needed
STROKE_BISECTIONS = 40
CLIMB_BISECTIONS = 30  # halvings of the search for the steepest climb
MAX_CLIMB_RAD = np.radians(45.0)


@dataclass(frozen=True)
class Flow:
    """Parts that leave the bowl, for one metre of track."""

    parts: float  # [1/m] counted parts on a length of track
    share: float  # [1] of all parts that climb the track, those that are counted
    length: float  # [m] mean length along the track of a part


def flow(
    queue: well_oriented.Orientations,
    rule: str,
    *,
    target: tuple[str, float] | None = None,
    gap: float = 0.0,
    fill: float = 1.0,
) -> Flow:
    """Compute how many parts a length of track delivers.

    For all orientations that leave: n = f s / (l + g), with the fill f, the gap g, the mean length l along
    the track, and s the share of the parts on the track that leave, sum of p (leaves) / sum of p (stays).

    Parameters
    ----------
    queue : Orientations
        On the track, through the devices.
    rule : str
        Whose probabilities are taken.
    target : (str, float [rad]), optional
        Aspect and heading that count; without it, every orientation that stays on the track and that the
        devices let pass.
    gap : float [m]
        Between parts.
    fill : float [1]
        Share of the track that parts cover, gaps included.

    Returns
    -------
    Flow

    Raises
    ------
    FeederError
        If nothing leaves.

    References
    ----------
    docs/bowl.md, "1. The part, and the rate".
    """
    # one orientation counts: its own share and length
    if target is not None:
        parts = well_oriented.parts_per_metre(queue, target, rule, gap=gap, fill=fill)
        row = list(zip(queue.aspects, queue.headings)).index(target)
        share, length = well_oriented.efficiency(queue, row, rule), well_oriented.fed(queue, row).length
        return Flow(parts, share, float(length))
    chances = np.nan_to_num(queue.rules[rule])
    leaving = float((chances * queue.leaves).sum())
    if not leaving > 0.0:
        if float((chances * queue.through).sum()) > 0.0:
            what = f"the part {well_oriented.ROLLS_BACK_REMARK}"
            raise FeederError("track.climb", what, well_oriented.HOLD_ADVICE)
        raise FeederError("devices", "let no part pass", "see what each returns in feeder rate")
    share, length = leaving / float((chances * queue.stays).sum()), well_oriented.mean_length(queue, rule)
    return Flow(fill * share / (length + gap), share, length)


def amplitude_for(
    bowl: Bowl, velocity: float, strokes: ArrayLike = (1.0,), angles: ArrayLike | None = None
) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Return the smallest stroke from which on a part travels at least so fast.

    The amplitude of the bowl is not used. Where a part hops, velocity does not only grow with the stroke: a
    stroke is preferred from which on the velocity holds over the range that is tuned with the controller.
    ``STROKE_SAMPLES`` strokes are looked at, then the first that is enough is bisected down to its lower
    neighbour.

    Parameters
    ----------
    bowl : Bowl
    velocity : float [m/s]
        At which the part travels at the slowest of ``strokes``, at least.
    strokes : (N,) array_like [1]
        Strokes as the bowl empties, over the one that is sought.
    angles : (N,) array_like [rad], optional
        Vibration angles there; that of the bowl without them.

    Returns
    -------
    (float [m], float [m/s]) or None
        Amplitude and velocity; None where no stroke that drives are built for is enough.
    (float [m/s], float [m]) or None
        Then velocity and amplitude of the fastest; None where one is enough.

    References
    ----------
    docs/bowl.md, "Why it feeds 220 for half a minute and then 165".
    """
    amplitudes = greatest_amplitude(bowl) * np.arange(1, STROKE_SAMPLES + 1) / STROKE_SAMPLES
    # the first stroke from which on all is fast over the range that is tuned; else the first fast one
    last = np.searchsorted(amplitudes, (1.0 + bowl.sizing.retune) * amplitudes, side="right")
    speeds, first = np.empty(0), None
    for k in range(STROKE_SAMPLES):
        if len(speeds) < last[k]:
            ahead = amplitudes[len(speeds) : max(last[k], len(speeds) + STROKES_AT_A_TIME)]
            speeds = np.append(speeds, _speeds(bowl, ahead, strokes, angles))
        if (speeds[k : last[k]] >= velocity).all():
            first = k
            break
    if first is None:
        places = np.flatnonzero(speeds >= velocity)
        if not places.size:
            best = int(np.argmax(speeds))
            return None, (float(speeds[best]), float(amplitudes[best]))
        first = int(places[0])
    # between the last sample that is too slow and the first that is fast enough
    low, high = (amplitudes[first - 1] if first else 0.0), amplitudes[first]
    for _ in range(STROKE_BISECTIONS):
        middle = 0.5 * (low + high)
        enough = _speeds(bowl, middle, strokes, angles) >= velocity
        low, high = (low, middle) if enough else (middle, high)
    return (float(high), float(_speeds(bowl, high, strokes, angles))), None


def steepest_climb(bowl: Bowl) -> float:
    """Return the climb up to which a part travels, the springs left as they are.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [rad]
        NaN where it does not travel on the level.
    """
    upright = bowl.drive.vibration_angle + bowl.track.climb

    def travels(climb: float) -> bool:
        drive = replace(bowl.drive, vibration_angle=max(upright - climb, 0.0))
        there = replace(bowl, drive=drive, track=replace(bowl.track, climb=climb))
        return float(answer.cells(there)["velocity"]) > 0.0

    low, high = 0.0, min(MAX_CLIMB_RAD, upright)
    if not travels(low):
        return float("nan")
    for _ in range(CLIMB_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if travels(middle) else (low, middle)
    return low


def _speeds(bowl: Bowl, amplitudes: Floats, strokes: ArrayLike, angles: ArrayLike | None) -> Floats:
    """Slowest velocities of strokes as the bowl empties [m/s]; minus infinity where there is none.

    No stroke is beyond what drives are built for: there the magnet strikes.
    """
    many: BowlGrid = bowl
    each = np.minimum(np.multiply.outer(amplitudes, strokes), greatest_amplitude(bowl))
    drive = replace(many.drive, amplitude=each)
    if angles is not None:
        drive = replace(drive, vibration_angle=np.broadcast_to(angles, each.shape))
    velocities = answer.cells(replace(many, drive=drive))["velocity"]
    return np.where(np.isfinite(velocities), velocities, -np.inf).min(axis=-1)
