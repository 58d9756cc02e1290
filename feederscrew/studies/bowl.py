"""``feeder bowl``: the machine under a bowl, and the bowl for a part and a rate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, cast

import numpy as np

from feederscrew import bowl as bowls
from feederscrew import check, units
from feederscrew.arrays import Floats
from feederscrew.bowl.reading import Setting, has_machine
from feederscrew.bowl.record import Bowl, Track, vibration_angle
from feederscrew.conveying import answer
from feederscrew.errors import FeederError
from feederscrew.machine import checks, drive_sizing, sizing
from feederscrew.machine import springs as leaves
from feederscrew.part.record import Part, small_part_remarks
from feederscrew.rates import stream, well_oriented
from feederscrew.rates.tipping import remark
from feederscrew.rates.well_oriented import RECOMMENDED_RULE
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.solidbowl.closed_body import BowlSolid
from feederscrew.solidbowl.plan import SolidOptions, TrackTooLow
from feederscrew.studies import arguments, solidbowl
from feederscrew.studies.arguments import Quantity, former_keywords
from feederscrew.studies.rate import MIN_POSITIVE, arriving, check_wanted
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import orientations
from feederscrew.version import __version__

ASSUMED_DENSITY = 7850.0  # [kg/m3] of a fill of which nothing is known: steel, solid
# where a fill comes from
PART = "of the part"
FILE = "as sizing.fill_density says"
ASSUMED = "steel assumed: give the part"
TARGET_TOLERANCE = 1.0 - 1e-6  # of a target
SAME_STROKE = 1e-3  # [1] strokes that are nearer than this are one


@dataclass(frozen=True, eq=False)
class Order(ReadableRecord):
    """The part, what is wanted of it, and the bowl for it."""

    part: Part
    target: float  # [1/s]
    wanted: tuple[str, float] | None  # aspect and heading [rad] that count; None: whatever passes
    rule: str  # whose probabilities were taken
    answer: str  # the same in words: 'hops, launch feed'
    tipping: tuple[str, ...]  # what the drive turns over on the track, a sentence or none
    lying: sizing.Lying
    size: sizing.Size
    steepest: float  # [rad] climb up to which the part travels
    flow: sizing.Flow
    hopper: float  # [m3]
    handbook: float  # [1/s] the handbook's estimate for the same share
    shape: sizing.SizedShape  # one part on the track, to draw
    climb_for_devices: bool = False  # whether a device that leads the track down asks for the climb
    static_drive: str = ""  # what the static rule takes, where the drive is that of a trial; '' elsewhere
    on_track: stream.Orientations | None = None  # every way the part comes along track and devices, to draw


@dataclass(frozen=True)
class Lowest:
    """The lowest rate of a bowl that empties."""

    rate: float  # [1/s]
    level: float  # [1] of the full bowl, there
    control: str  # how the amplitude is held meanwhile, of ``drive_sought.WAYS``


@dataclass(frozen=True, eq=False)
class MachineSheet(ReadableRecord):
    """A machine and what it does; with an order, that of the sized bowl."""

    bowl: Bowl
    has_machine: bool  # a key of ``machine`` was given
    springs: leaves.Springs
    stroke: leaves.Stroke
    answer: answer.Answer  # how a part travels
    detuning: float  # [1] natural frequency above the drive
    gain: float  # [1]
    stress: float  # [Pa] amplitude in a leaf
    force: float  # [N] amplitude along the springs' motion that keeps the stroke
    magnet: float  # [N] amplitude of a magnet that pulls upright
    radii: Floats  # (N,) [m]
    angles: Floats  # (N,) [rad] of the motion to the horizontal
    changes: tuple[leaves.LeafSet, ...]
    sets: tuple[leaves.LeafSet, ...]
    depth: float  # [m] of the bowl
    fill: sizing.Fill
    filled_with: str  # of PART, FILE and ASSUMED
    turns: float  # [1] of the track from the floor to the outlet; NaN of a level one
    mismatch: drive_sizing.DriveMismatch | None  # with the drive that the machine makes; None where it does
    emptying: sizing.Emptying
    velocities: Floats  # (M,) [m/s] at each level of the emptying bowl, the controller left alone
    controlled: Floats  # (M,) [m/s] the same under amplitude control
    order: Order | None
    solid: BowlSolid | None = None  # where it was asked for

    @property
    def remarks(self) -> tuple[str, ...]:
        """Return what must not be overlooked, a tuple of str."""
        own = () if self.solid is None else self.solid.remarks
        order, track = self.order, self.bowl.track
        if order is None:
            return (*checks.remarks(self), *own)
        lines = [order.static_drive] if order.static_drive else []
        if not self.bowl.devices:
            wide = f"its track of {1e3 * track.width:.4g} mm carries every way up, and parts leave so"
            mend = "feeder tooling PART --aspect NAME -o DIR finds devices: give its tooling.yaml as --config"
            sorts = "no device sorts the parts in this bowl"
            what = sorts if order.wanted else "this bowl is for every way up"
            lines.append(f"{what}: {wide}. For one way up: {mend}")
        if order.climb_for_devices:
            climb = f"{np.degrees(track.climb):.4g} deg"
            lines.append(f"the track climbs at {climb}, so that parts pass below the stretch that leads down")
        return (*lines, *checks.remarks(self), *small_part_remarks(order.part, {}, track.width), *own)

    @property
    def rocking(self) -> tuple[leaves.Rocking, leaves.Rocking] | None:
        """Stroke round the bowl where its track ends, as it is and with its weight; None without a solid."""
        return None if self.solid is None else leaves.both_rocking_modes(self.bowl, self.solid)

    @property
    def lowest(self) -> Lowest:
        """The Lowest rate from the full bowl to the empty one; of a sheet with an order."""
        rates, controlled = (self.rates(v) for v in (self.velocities, self.controlled))
        control, target = drive_sizing.ALONE, cast(Order, self.order).target
        if rates.min() < min(TARGET_TOLERANCE * target, controlled.min()):
            rates, control = controlled, drive_sizing.CONTROLLED
        row = int(np.argmin(rates))
        label = drive_sizing.STROKE_CONTROL_LABELS[control]
        return Lowest(float(rates[row]), float(self.emptying.levels[row]), label)

    def rates(self, velocities: Floats | float) -> Floats:
        """Return counted parts [1/s] at velocities; of a sheet with an order."""
        return np.nan_to_num(np.maximum(velocities, 0.0)) * cast(Order, self.order).flow.parts


def machine(settings: Sequence[Setting]) -> MachineSheet:
    """Compute what a machine does with the bowl of a file: a MachineSheet without an order."""
    bowl, rules = answer.conveying(bowls.record(settings)), bowls.record(settings).sizing
    # at the frequency and angle of its machine, were it only the default one, unless given
    by_machine = {
        "frequency": bowl.machine.supply,
        "vibration_angle": float(vibration_angle(bowl.machine, bowl.track.radius, bowl.track.climb)),
    }
    user_keys = drive_sizing.user_keys(settings, "drive")
    own = {name: value for name, value in by_machine.items() if name not in user_keys}
    bowl = replace(bowl, drive=replace(bowl.drive, **own))
    density = rules.fill_density
    filled_with = FILE if density > 0.0 else ASSUMED
    depth = rules.outlet_height if rules.outlet_height > 0.0 else 2.0 * rules.depth * bowl.track.radius
    return _sheet(bowl, settings, depth, (density or ASSUMED_DENSITY, filled_with), None)


def size_machine(
    settings: Sequence[Setting],
    part: Part,
    target: float,
    *,
    aspect: str | None = None,
    heading: float | None = None,
    rule: str = "recommended",
    aspects: Aspects | None = None,
    as_tried: bool = False,
    gap: float = 0.0,
    fill: float = 1.0,
    solid: SolidOptions | None = None,
) -> MachineSheet:
    """Compute the bowl, the drive and the stroke that bring a part at a rate.

    Track, drive, machine and devices stay as far as the settings give them; the rest is sized. With a solid,
    its rise and mass take the place of the estimate.

    Parameters
    ----------
    settings : sequence of Setting
        Of the bowl file and the overrides.
    part : Part
    target : float [1/s]
        Counted parts.
    aspect : str, optional
        That counts; without it, each that leaves the bowl.
    heading : float [rad], optional
        Of that aspect; its most frequent one without it.
    rule : str
        Whose probabilities are taken.
    aspects : Aspects, optional
        With the answer to take, where they are known already.
    as_tried : bool
        A trial has shown what the settings say. So their drive is kept, and the limits of the static rule are
        remarks only.
    gap : float [m]
        Between parts.
    fill : float [1]
        Share of the track that parts cover, gaps included.
    solid : SolidOptions, optional

    Returns
    -------
    MachineSheet
        With its order.

    Raises
    ------
    FeederError
        If no bowl is so large, or none reaches the target; the latter not if it was tried.

    References
    ----------
    docs/bowl.md, "1. The part, and the rate".
    """
    plain = solidbowl.in_material(answer.conveying(bowls.record(settings)), solid)
    check_wanted(part, aspect, heading)
    aspects = arriving(part, plain, rule) if aspects is None else aspects
    straight = replace(sizing.STRAIGHT_TRACK, climb=plain.track.climb)
    wanted = None
    if aspect is not None:
        wanted = well_oriented.wanted(part, aspects, straight, aspect, heading, plain.devices)
    lying = sizing.find_lying(part, aspects, wanted)
    counted: dict[str, Any] = {"rule": arguments.a_rule(rule, aspects), "gap": gap, "fill": fill}
    # the size: what the file says of the track is kept; a device that leads down may need a steeper one
    user_keys, own = drive_sizing.user_keys(settings, "track"), plain.track
    least = None
    greatest = float(np.ptp(np.asarray(part.vertices), axis=0).max())
    hanging = greatest if any(device.hangs for device in plain.devices) else 0.0
    while True:
        size = sizing.size_bowl(
            replace(lying, hanging=hanging),
            part.source,
            plain.sizing,
            sorts=wanted is None,
            diameter=2.0 * own.radius if "radius" in user_keys else None,
            width=own.width if "width" in user_keys else None,
            climb=own.climb if "climb" in user_keys else least,
        )
        track = replace(own, radius=0.5 * size.diameter, width=size.track_width, climb=size.climb)
        counts = None if wanted is None else well_oriented.wanted(part, aspects, track, *wanted)
        orientations_at = _orientations_by_drive(part, aspects, track, plain.devices)
        coming, own_bowl = orientations_at(None), replace(plain, track=track)
        try:
            size, body = solidbowl.solid(own_bowl, size, part, coming, solid, counted | {"target": counts})
            break
        except TrackTooLow as fault:
            if fault.climb is None or "climb" in user_keys:
                raise
            least = fault.climb
    wanted, counted["target"], plain = counts, counts, own_bowl
    room = cast(float, part.volume if part.hull is None else part.hull.volume)  # a card has no size
    search = drive_sizing.DriveSearch(plain, size, tuple(settings), target, part.mass / room)
    bare = _orientations_by_drive(part, aspects, track, ()) if as_tried else None

    def flow(driven: Bowl | None) -> sizing.Flow:
        return sizing.flow(orientations_at(driven), **counted)

    note = ""  # what the static rule takes, where it is another drive than the one that was tried
    if bare is None:
        driven, flowing = drive_sizing.bring_target(search, flow)
    else:
        driven = drive_sizing.with_own_drive(search)
        rate, tried = f"{target * units.MINUTE:.4g}/min", 2e3 * driven.drive.amplitude
        note = f"the drive is the one that was tried, {tried:.3g} mm peak to peak: the static rule"
        try:
            stroke = 2e3 * drive_sizing.bring_target(search, flow)[0].drive.amplitude
        except FeederError:
            note = f"{note} finds none for {rate}"
            try:
                flowing = flow(driven)
            except FeederError as fault:  # by the rule nothing leaves: what the track without devices carries
                note = f"{note}: {fault}"
                flowing = sizing.flow(bare(driven).carried, **counted)
        else:
            is_same = np.isclose(stroke, tried, rtol=SAME_STROKE, atol=0.0)
            note = "" if is_same else f"{note} takes {stroke:.3g} mm for {rate}"
            flowing = flow(driven)
    order = Order(
        part=part,
        target=target,
        wanted=wanted,
        rule=rule,
        answer=aspects.source(rule),
        tipping=remark(orientations_at(driven).lying),
        lying=lying,
        size=size,
        steepest=sizing.steepest_climb(driven),
        flow=flowing,
        hopper=target * plain.sizing.hopper_interval * room / plain.sizing.packing,
        handbook=plain.sizing.handbook_speed * flowing.share / flowing.length,
        shape=sizing.size_shape(part, aspects, track, wanted),
        climb_for_devices=least is not None,
        static_drive=note,
        on_track=orientations_at(driven),
    )
    return replace(_sheet(driven, settings, size.depth, (search.bulk, PART), order), solid=body)


def _read_path(given: dict[str, Any], path: object) -> None:
    if path is not None:
        given["bowl"] = bowls.read(check.path("path", path))


@former_keywords(former={"path": _read_path})
def size_bowl(
    part: Part,
    target: Quantity,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    rule: str = RECOMMENDED_RULE,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    bowl: Bowl | None = None,
) -> MachineSheet:
    """Size the bowl for a part and a rate, with its springs, tuning and drift, as ``feeder bowl``.

    Parameters
    ----------
    part : Part
        From a mesh.
    target : str or float [1/s]
        '60/min' of parts that count.
    aspect : str, optional
        That counts; whatever passes the devices without it.
    heading, rule, gap, fill
        As for ``rate``.
    bowl : Bowl, optional
        What its file or ``with_values`` gave is kept, its devices too; the rest is sized.

    Returns
    -------
    MachineSheet
        At the stroke that was tried, where the file has a trial that is still of this part and bowl.
    """
    space = arguments.amount("gap", gap, "length", 0.0)
    wanted = arguments.amount("target", target, "rate", MIN_POSITIVE)
    aspect, angle = arguments.an_orientation(aspect, heading)
    solid, chosen = arguments.part_in_bowl(arguments.a_part(part), bowls.default() if bowl is None else bowl)
    effective = arguments.settings_of(chosen)
    name = aspect if aspect is None or angle is None else f"{aspect}@{round(np.degrees(angle)) % 360}"
    tried = bowls.verified(chosen.source)
    void = tried is None or any(tried.void(solid, chosen, __version__, name))
    own: dict[str, Any] = {"aspect": aspect, "heading": angle, "rule": rule, "gap": space, "fill": fill}
    return size_machine(effective, solid, wanted, as_tried=not void, **own)


def _orientations_by_drive(
    part: Part, aspects: Aspects, track: Track, devices: Sequence[Device]
) -> Callable[[Bowl | None], stream.Orientations]:
    on_the_track = orientations(part, aspects, track)
    return cache(lambda driven: stream.along(on_the_track, aspects, devices, bowl=driven))


def _sheet(
    bowl: Bowl, settings: Sequence[Setting], depth: float, bulk: tuple[float, str], order: Order | None
) -> MachineSheet:
    """Everything of a bowl with its machine; ``bulk`` is the density of what fills it, and whence it is."""
    under, rules, moved = bowl.machine, bowl.sizing, leaves.stroke(bowl)
    springs = leaves.analyse_springs(under)
    magnified = float(leaves.gain(moved.frequency, springs.natural_frequency, under.damping))
    room = None if order is None else order.size.room
    fill = sizing.full_bowl(room or bowl.track.radius, depth, bulk[0], rules)
    emptied = sizing.emptying(bowl, fill)
    # turns of a track of one climb; NaN where it is level, or where devices may lead it otherwise
    rise = 2.0 * np.pi * bowl.track.radius * np.tan(bowl.track.climb)
    led = bool(bowl.devices) and rules.outlet_height > 0.0
    turns = depth / rise if rise > 0.0 and not led else np.nan
    radii, turned = leaves.angles(under, bowl.track)
    force = float(springs.stiffness * moved.springs / magnified)

    def velocities(strokes: Floats) -> Floats:
        """At multiples of the bowl's stroke [m/s]; the stroke ends where the magnet would strike."""
        most = max(leaves.greatest_amplitude(bowl), bowl.drive.amplitude)
        amplitudes: Any = np.minimum(bowl.drive.amplitude * strokes, most)
        drive = replace(bowl.drive, amplitude=amplitudes, vibration_angle=cast(Any, emptied.angles))
        return check.frozen(answer.cells(replace(bowl, drive=drive))["velocity"])

    return MachineSheet(
        bowl=bowl,
        has_machine=has_machine({s.key.name for s in settings if s.is_own}),
        springs=springs,
        stroke=moved,
        answer=answer.answer(bowl),
        detuning=springs.natural_frequency / moved.frequency - 1.0,
        gain=magnified,
        stress=float(leaves.leaf_stress(under, moved.springs)),
        force=force,
        magnet=leaves.upright_pull(force, under),
        radii=check.frozen(radii),
        angles=check.frozen(turned),
        changes=leaves.leaf_changes(under, moved.frequency, moved.springs, int(rules.banks)),
        sets=leaves.tuned_leaf_sets(under, moved.frequency, moved.springs, rules),
        depth=depth,
        fill=fill,
        filled_with=bulk[1],
        turns=float(turns if order is None else order.size.turns),
        mismatch=drive_sizing.can_make(bowl),
        emptying=emptied,
        velocities=velocities(emptied.strokes),
        controlled=velocities(emptied.controlled),
        order=order,
    )
