"""``feeder bowl``: the machine under a bowl, and the bowl for a part and a rate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import cast

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import arriving, check_wanted
from feederscrew.base import check, units
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column, Frame, of_arrays, values
from feederscrew.base.errors import FeederError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import Keywords
from feederscrew.base.version import __version__
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.reading import Setting, has_machine
from feederscrew.bowl.record import Bowl, BowlGrid, Track, vibration_angle
from feederscrew.bowl.size import Size
from feederscrew.cad import solid as solidbowl
from feederscrew.cad.closed_body import BowlSolid
from feederscrew.cad.plan import SolidOptions, TrackTooLow
from feederscrew.feeding import stream, well_oriented
from feederscrew.feeding.rate import MIN_POSITIVE
from feederscrew.machine import checks, drive_sizing, sizing
from feederscrew.machine import springs as leaves
from feederscrew.motion import conveying as answer
from feederscrew.motion.hop import hop
from feederscrew.part.record import Part, small_part_remarks
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tipping import remark

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
    size: Size
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
class MachineSheet(ReadableRecord, view="machine.MACHINE_VIEW"):
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
    as_tried: bool = False  # whether a trial has run its devices at its drive

    def angles_table(self) -> Frame:
        """Return the direction of the motion over the radius: ``bowl_angles.csv``."""
        return of_arrays(ANGLE_COLUMNS, self)

    def emptying_table(self) -> Frame:
        """Return the bowl from full to empty, with rates where parts are counted: ``bowl_emptying.csv``."""
        rates = () if self.order is None else EMPTYING_RATE_COLUMNS
        return of_arrays([*EMPTYING_COLUMNS, *rates], self)

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


def _drive_kind(sheet: MachineSheet) -> str:
    """Return the kind of the drive as documents name it."""
    is_two_axis = drive_sizing.is_two_axis(sheet.bowl.drive)
    return drive_sizing.TWO_AXIS if is_two_axis else drive_sizing.LEAF_SPRING


DRIVE_COLUMNS: tuple[Column[MachineSheet], ...] = (  # the drive, at the head of the document
    Column("drive_kind", lambda sheet: _drive_kind(sheet)),
    Column("phase_deg", lambda sheet: sheet.bowl.drive.phase, "deg"),
)
MISMATCH_COLUMNS: tuple[Column[MachineSheet], ...] = (
    Column("springs_make_this_drive", lambda sheet: sheet.mismatch is None),
    Column(
        "drive_asked_for",
        lambda sheet: sheet.mismatch and values(drive_sizing.DRIVE_FIGURE_COLUMNS, sheet.mismatch.wanted),
    ),
    Column(
        "drive_of_the_springs",
        lambda sheet: sheet.mismatch and values(drive_sizing.DRIVE_FIGURE_COLUMNS, sheet.mismatch.machine),
    ),
)
MACHINE_COLUMNS: tuple[Column[MachineSheet], ...] = (  # the machine and what it does
    Column("turns", lambda sheet: sheet.turns),
    Column("bowl_depth_mm", lambda sheet: sheet.depth, "mm"),
    Column("leaf_stiffness_n_per_mm", lambda sheet: sheet.springs.leaf_stiffness, "N/mm"),
    Column("leaves", lambda sheet: int(sheet.bowl.machine.leaves)),
    Column("leaf_width_mm", lambda sheet: sheet.bowl.machine.leaf_width, "mm"),
    Column("leaf_thickness_mm", lambda sheet: sheet.bowl.machine.leaf_thickness, "mm"),
    Column("leaf_length_mm", lambda sheet: sheet.bowl.machine.leaf_length, "mm"),
    Column("stiffness_n_per_mm", lambda sheet: sheet.springs.stiffness, "N/mm"),
    Column("stiffness_with_over_without_twist", lambda sheet: sheet.springs.twist),
    Column("bowl_mass_kg", lambda sheet: sheet.bowl.machine.bowl_mass, "kg"),
    Column("bowl_inertia_kg_m2", lambda sheet: sheet.bowl.machine.bowl_inertia, "kg m2"),
    Column("base_mass_kg", lambda sheet: sheet.bowl.machine.base_mass, "kg"),
    Column("base_inertia_kg_m2", lambda sheet: sheet.bowl.machine.base_inertia, "kg m2"),
    Column("spring_radius_mm", lambda sheet: sheet.bowl.machine.spring_radius, "mm"),
    Column("spring_angle_deg", lambda sheet: sheet.bowl.machine.spring_angle, "deg"),
    Column("effective_mass_kg", lambda sheet: sheet.springs.effective_mass, "kg"),
    Column("effective_mass_base_held_kg", lambda sheet: sheet.springs.effective_mass_held, "kg"),
    Column("natural_frequency_hz", lambda sheet: sheet.springs.natural_frequency, "Hz"),
    Column(
        "natural_frequency_without_twist_hz",
        lambda sheet: sheet.springs.natural_frequency_without_twist,
        "Hz",
    ),
    Column("natural_frequency_base_held_hz", lambda sheet: sheet.springs.natural_frequency_held, "Hz"),
    Column("natural_frequency_rigid_clamps_hz", lambda sheet: sheet.springs.natural_frequency_rigid, "Hz"),
    Column(
        "natural_frequency_rigid_clamps_end_hz", lambda sheet: sheet.springs.natural_frequency_rigid_end, "Hz"
    ),
    Column("drive_frequency_hz", lambda sheet: sheet.stroke.frequency, "Hz"),
    Column("above_drive_percent", lambda sheet: sheet.detuning, "%"),
    Column("gain", lambda sheet: sheet.gain),
    Column("leaf_amplitude_mm", lambda sheet: sheet.stroke.springs, "mm"),
    Column("leaf_stress_mpa", lambda sheet: sheet.stress, "MPa"),
    Column("fatigue_stress_mpa", lambda sheet: sheet.bowl.sizing.fatigue_stress, "MPa"),
    Column("drive_force_n", lambda sheet: sheet.force, "N"),
    Column("magnet_force_n", lambda sheet: sheet.magnet, "N"),
    Column("magnet_force_mean_n", lambda sheet: leaves.mean_pull(sheet.magnet, sheet.stroke.frequency), "N"),
    Column("magnet_angle_deg", lambda sheet: 0.5 * np.pi, "deg"),
    Column("controller_percent", lambda sheet: sheet.bowl.sizing.controller, "%"),
    Column("peak_to_peak_mm", lambda sheet: sheet.stroke.peak_to_peak, "mm"),
    Column(
        "peak_to_peak_full_controller_mm",
        lambda sheet: sheet.stroke.peak_to_peak / sheet.bowl.sizing.controller,
        "mm",
    ),
    Column("sticker_mm", lambda sheet: sheet.stroke.peak_to_peak, "mm"),
    Column("accelerometer_m_s2", lambda sheet: values(leaves.ACCELEROMETER_COLUMNS, sheet.stroke), "m/s2"),
    Column("acceleration_ratio", lambda sheet: sheet.stroke.acceleration / sheet.bowl.gravity),
    Column("throw_number", lambda sheet: sheet.answer.throw_number),
    Column("hop_height_mm", lambda sheet: hop(sheet.bowl).height, "mm"),
    Column("hop_flight_mm", lambda sheet: hop(sheet.bowl).flight, "mm"),
    Column("vibration_angle_deg", lambda sheet: sheet.bowl.drive.vibration_angle, "deg"),
    Column("vibration_angle_at_the_track_deg", lambda sheet: sheet.bowl.drive.vibration_angle, "deg"),
    Column("vibration_angle_at_the_springs_deg", lambda sheet: sheet.bowl.machine.spring_angle, "deg"),
    Column("velocity_mm_s", lambda sheet: sheet.answer.velocity, "mm/s"),
    Column("regime", lambda sheet: sheet.answer.regime),
    Column("hardest_impact_mm_s", lambda sheet: sheet.answer.hardest_impact, "mm/s"),
)
ANGLE_COLUMNS: tuple[Column[MachineSheet], ...] = (  # a row a radius
    Column("radius_mm", lambda sheet: sheet.radii, "mm"),
    Column("vibration_angle_deg", lambda sheet: sheet.angles, "deg"),
    Column("to_the_track_deg", lambda sheet: sheet.angles - sheet.bowl.track.climb, "deg"),
)
FULL_BOWL_COLUMNS: tuple[Column[MachineSheet], ...] = (
    Column("filled_with", lambda sheet: sheet.filled_with),
    Column("volume_l", lambda sheet: sheet.fill.volume, "l"),
    Column("mass_kg", lambda sheet: sheet.fill.mass, "kg"),
    Column("inertia_kg_m2", lambda sheet: sheet.fill.inertia, "kg m2"),
    Column("mass_carried_kg", lambda sheet: sheet.fill.mass * sheet.bowl.sizing.carried, "kg"),
)
EMPTYING_COLUMNS: tuple[Column[MachineSheet], ...] = (  # a row a level
    Column("fill_percent", lambda sheet: sheet.emptying.levels, "%"),
    Column("parts_kg", lambda sheet: sheet.emptying.masses, "kg"),
    Column("natural_frequency_hz", lambda sheet: sheet.emptying.natural_frequencies, "Hz"),
    Column("gain", lambda sheet: sheet.emptying.gains),
    Column("stroke_over_that_of_the_empty_bowl", lambda sheet: sheet.emptying.strokes),
    Column("vibration_angle_at_the_track_deg", lambda sheet: sheet.emptying.angles, "deg"),
    Column("spring_stroke_over_that_of_the_empty_bowl", lambda sheet: sheet.emptying.springs),
    Column("velocity_mm_s", lambda sheet: sheet.velocities, "mm/s"),
    Column("velocity_controlled_mm_s", lambda sheet: sheet.controlled, "mm/s"),
)
EMPTYING_RATE_COLUMNS: tuple[Column[MachineSheet], ...] = (  # where parts are counted
    Column("rate_per_minute", lambda sheet: sheet.rates(sheet.velocities), "1/min"),
    Column("rate_controlled_per_minute", lambda sheet: sheet.rates(sheet.controlled), "1/min"),
)
ORDER_COLUMNS: tuple[Column[tuple[MachineSheet, Order]], ...] = (  # what was ordered, and the bowl for it
    Column("target_per_minute", lambda sized: sized[1].target, "1/min"),
    Column("parts_per_minute", lambda sized: sized[0].lowest.rate, "1/min"),
    Column("lowest_at_fill_percent", lambda sized: sized[0].lowest.level, "%"),
    Column("lowest_with", lambda sized: sized[0].lowest.control),
    Column("rate_at_this_stroke", lambda sized: float(sized[0].rates(sized[0].answer.velocity)), "1/min"),
    Column("rate_lowest_left_alone", lambda sized: sized[0].rates(sized[0].velocities).min(), "1/min"),
    Column("rate_lowest_controlled", lambda sized: sized[0].rates(sized[0].controlled).min(), "1/min"),
    Column("rate_full_bowl", lambda sized: sized[0].rates(sized[0].velocities)[0], "1/min"),
    Column("rate_empty_bowl", lambda sized: sized[0].rates(sized[0].velocities)[-1], "1/min"),
    Column("rate_full_bowl_controlled", lambda sized: sized[0].rates(sized[0].controlled)[0], "1/min"),
    Column("rate_empty_bowl_controlled", lambda sized: sized[0].rates(sized[0].controlled)[-1], "1/min"),
    Column("handbook_per_minute", lambda sized: sized[1].handbook, "1/min"),
    Column("aspect", lambda sized: sized[1].wanted and sized[1].wanted[0]),
    Column("heading_deg", lambda sized: sized[1].wanted and sized[1].wanted[1], "deg"),
    Column("rule", lambda sized: sized[1].rule),
    Column("answer", lambda sized: sized[1].answer),
    Column("share_counted", lambda sized: sized[1].flow.share, "share"),
    Column("mean_length_mm", lambda sized: sized[1].flow.length, "mm"),
    Column("longest_mm", lambda sized: sized[1].lying.longest, "mm"),
    Column("tallest_mm", lambda sized: sized[1].lying.tallest, "mm"),
    Column("part_width_mm", lambda sized: sized[1].lying.width, "mm"),
    Column("bowl_diameter_mm", lambda sized: sized[1].size.diameter, "mm"),
    Column("least_diameters_mm", lambda sized: dict(sized[1].size.least), "mm"),
    Column("track_width_mm", lambda sized: sized[1].size.track_width, "mm"),
    Column("clearance_mm", lambda sized: sized[1].size.clearance, "mm"),
    Column("bend_mm", lambda sized: sized[1].size.bend, "mm"),
    Column("climb_deg", lambda sized: sized[1].size.climb, "deg"),
    Column("steepest_climb_deg", lambda sized: sized[1].steepest, "deg"),
    Column("turn_rise_mm", lambda sized: sized[1].size.pitch, "mm"),
    Column("hopper_l", lambda sized: sized[1].hopper, "l"),
)


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
    counted: Keywords = {"rule": arguments.a_rule(rule, aspects), "gap": gap, "fill": fill}
    # the size: what the file says of the track is kept; a device that leads down may need a steeper one
    user_keys, own = drive_sizing.user_keys(settings, "track"), plain.track
    least = None
    greatest = float(np.ptp(np.asarray(part.vertices), axis=0).max())
    hanging = greatest if any(device.action is Action.HANG for device in plain.devices) else 0.0
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
    sheet = _sheet(driven, settings, size.depth, (search.bulk, PART), order)
    return replace(sheet, solid=body, as_tried=as_tried)


def _read_path(given: Keywords, path: object) -> None:
    if path is not None:
        given["bowl"] = bowls.read(check.path("path", path))


@former_keywords(former={"path": _read_path})
def size_bowl(
    part: Part,
    target: Quantity,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    rule: str = RECOMMENDED_ANSWER,
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
    heading : str or float [rad], optional
    rule : str
    gap : str or float [m]
    fill : float [1]
        These four as for ``rate``.
    bowl : Bowl, optional
        What its file or ``with_values`` gave is kept, its devices too; the rest is sized.

    Returns
    -------
    MachineSheet
        At the stroke that was tried, where the file has a trial that is still of this part and bowl.

    Raises
    ------
    FeederError
        If the part has no shape or no such aspect, nothing leaves, or no bowl within ``sizing`` brings the
        rate.

    References
    ----------
    docs/bowl.md, whose sections name the handbooks.
    """
    space = arguments.amount("gap", gap, "length", 0.0)
    wanted = arguments.amount("target", target, "rate", MIN_POSITIVE)
    aspect, angle = arguments.an_orientation(aspect, heading)
    solid, chosen = arguments.part_in_bowl(arguments.a_part(part), bowls.default() if bowl is None else bowl)
    effective = arguments.settings_of(chosen)
    name = aspect if aspect is None or angle is None else f"{aspect}@{round(np.degrees(angle)) % 360}"
    tried = bowls.verified(chosen.source)
    void = tried is None or any(tried.void(solid, chosen, __version__, name))
    return size_machine(
        effective,
        solid,
        wanted,
        aspect=aspect,
        heading=angle,
        rule=rule,
        gap=space,
        fill=fill,
        as_tried=not void,
    )


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
        many: BowlGrid = bowl
        amplitudes = np.minimum(bowl.drive.amplitude * strokes, most)
        drive = replace(many.drive, amplitude=amplitudes, vibration_angle=emptied.angles)
        return check.frozen(answer.cells(replace(many, drive=drive))["velocity"])

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
