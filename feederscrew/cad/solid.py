"""``feeder bowl --solid``: the bowl of a sheet as one closed body."""

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.reading import Setting
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.size import Size
from feederscrew.cad import riding, segments
from feederscrew.cad.closed_body import BowlSolid, body, screwed
from feederscrew.cad.exact import exact_body, exact_file
from feederscrew.cad.measuring import ways_down
from feederscrew.cad.plan import (
    ARC_CHORD_M,
    STEEL_NAME,
    BowlPlan,
    SolidOptions,
    TrackTooLow,
    material,
    plan,
)
from feederscrew.feeding import stream
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.orientations import hang, neck
from feederscrew.sorting.tooled_track import lay_out

CLIMB_STEP_RAD = np.radians(0.25)  # in which a climb is looked for that leaves room below the tooled stretch
STEEPEST_RAD = np.radians(10.0)  # up to which it is: from there on parts slide back with most frictions


def solid_options(
    settings: Sequence[Setting],
    *,
    solid: bool,
    material: str,
    chord: float,
    bed: str | None = None,
    step: bool = False,
    join: str | None = None,
) -> SolidOptions | None:
    """Return what is wanted of the solid, None where none is.

    Parameters
    ----------
    settings : sequence of Setting
        Of the bowl: shape, outlet, bolts and drains.
    solid : bool
        One is wanted.
    material : str
        Of ``plan.MATERIAL_NAMES``.
    chord : float [m]
        By how much an arc may be too flat.
    bed : str, optional
        Of a printer: '220x220x250mm'.
    step : bool
        A STEP file with exact faces is wanted.
    join : str, optional
        Of ``segments.JOINTS``; dowels without it.

    Returns
    -------
    SolidOptions or None

    Raises
    ------
    ArgumentError
        If the bed is not three lengths.
    MissingPackage
        If what writes STEP is not installed.
    """
    if not solid:
        return None
    rules = bowls.record(settings).sizing
    if step:
        exact_body.check()
    user_keys = {s.key.name for s in settings if s.is_own}
    return SolidOptions(
        chord=chord,
        material=material,
        shape=rules.shape,
        outlet_height=rules.outlet_height,
        outlet_angle=rules.outlet_angle,
        left=rules.hand == "left",
        bolts=int(rules.bolts),
        bolt=rules.bolt_hole,
        bolt_circle=rules.bolt_circle if "machine.bolt_circle" in user_keys else 0.0,
        bolt_share=rules.bolt_share,
        drains=int(rules.drains),
        drain=rules.drain_hole,
        step=step,
        bed=None if bed is None else segments.bed(bed),
        joint=segments.DOWELS if join is None else join,
    )


def drawable_climb(bowl: Bowl, part: Part, coming: stream.Orientations) -> float:
    """Return the climb of the track at which a bowl with its devices can be drawn as a solid.

    A device that leads the track down needs room below it, and a steeper track leaves more.

    Parameters
    ----------
    bowl : Bowl
    part : Part
    coming : Orientations
        Of the part along that track.

    Returns
    -------
    float [rad]
        The bowl's own climb where it is enough, or where none up to ``STEEPEST_RAD`` mends it.
    """
    rules, track = bowl.sizing, bowl.track
    depth = rules.outlet_height if rules.outlet_height > 0.0 else 2.0 * rules.depth * track.radius
    size = Size(2.0 * track.radius, {}, track.width, 0.0, 0.0, track.climb, depth, np.nan, np.nan)
    shape: dict[str, Any] = {"shape": rules.shape, "outlet_height": rules.outlet_height}
    wanted = SolidOptions(material=STEEL_NAME, friction=bowl.friction.static, **shape)
    thick = in_material(bowl, wanted)
    climb = None
    with contextlib.suppress(FeederError):  # another fault, which no climb mends
        try:
            _planned(thick, size, part, coming, wanted)
        except TrackTooLow:
            climb = _least_climb(thick, size, part, coming, wanted)
    return climb or track.climb


def in_material(bowl: Bowl, options: SolidOptions | None) -> Bowl:
    """Return the bowl with the thickness and density of its solid.

    Parameters
    ----------
    bowl : Bowl
    options : SolidOptions or None

    Returns
    -------
    Bowl
        As it is without options.
    """
    if options is None:
        return bowl
    made_of = material(options.material, bowl.sizing)
    rules = replace(bowl.sizing, sheet=made_of.plate, sheet_density=made_of.density)
    return replace(bowl, sizing=rules)


def solid(
    bowl: Bowl,
    size: Size,
    part: Part,
    coming: stream.Orientations,
    options: SolidOptions | None,
    counted: Mapping[str, Any],
) -> tuple[Size, BowlSolid | None]:
    """Return the size of a bowl and its solid.

    Rise, turns, mass and inertia of the solid take the place of the estimate.

    Parameters
    ----------
    bowl : Bowl
    size : Size
        As estimated.
    part : Part
    coming : Orientations
        Of the part along the bowl's track and devices.
    options : SolidOptions or None
        None where no solid is asked for.
    counted : mapping
        ``rule``, whose probabilities are taken, and ``target``, the aspect and heading that are wanted, or
        None.

    Returns
    -------
    Size
    BowlSolid or None
        None where none is asked for.

    Raises
    ------
    TrackTooLow
        If a device leads the track down too far; it has the climb that mends it, where there is one.
    FeederError
        If the track does not fit the bowl, or what falls through a cut does not reach the floor.
    """
    if options is None:
        return size, None
    options = replace(options, friction=bowl.friction.static)
    try:
        planned = _planned(bowl, size, part, coming, options)
    except TrackTooLow as fault:
        climb = _least_climb(bowl, size, part, coming, options)
        if climb is not None:
            mend = f"give a track.climb of at least {np.degrees(climb):.4g} deg, else {fault.mend}"
            fault = TrackTooLow(fault.where, fault.what, mend)
            fault.climb = climb
        raise fault from None
    closed = body(planned)
    wanted = 0.0 if options.outlet_height > 0.0 else size.turns
    closed = replace(closed, falls=ways_down(closed), turns_of_sheet=float(wanted))
    if options.bed is not None:
        closed = replace(closed, segments=segments.segments(closed, options.bed, options.joint))
        closed = screwed(closed, segments.WEIGHT)
    if options.step:
        closed = replace(closed, step=exact_file.step_file(closed))
    path = closed.plan.path
    room = float(path.wall_radius(path.end / 6.0))  # of a cylinder as roomy as the lowest third of the rise
    size = replace(size, depth=closed.plan.outlet_height, turns=closed.plan.turns, room=room)
    size = replace(size, mass=closed.mass, inertia=closed.inertia, unbalance=closed.unbalance)
    # parts to draw: as they come along most often among those that leave, and as they hang
    often = np.nan_to_num(coming.rules[counted["rule"]]) * coming.stays
    if counted["target"] is not None:
        often = often * (np.array(coming.aspects) == counted["target"][0])
    leaving = often * coming.through
    most_frequent = coming.lying[int(np.argmax(leaving if leaving.any() else often))]
    spans = [device.span for device in bowl.devices if device.action is Action.HANG]
    hanging = hang(most_frequent, spans[-1]) if spans and neck(most_frequent) else None
    return size, replace(closed, riders=tuple(riding.riders(closed.plan, most_frequent, hanging)))


def _planned(
    bowl: Bowl, size: Size, part: Part, coming: stream.Orientations, options: SolidOptions
) -> BowlPlan:
    """The measures of the solid, its tooled stretch on the track that devices bank."""
    is_tooled = any(device.action.has_place for device in bowl.devices)
    tooled = lay_out(bowl.track, bowl.devices, coming.lying) if is_tooled else None
    track = bowl.track if tooled is None else tooled.track
    extents = np.ptp(np.asarray(part.vertices), axis=0)
    return plan(size, track, material(options.material, bowl.sizing), tooled, options, extents=extents)


def _least_climb(
    bowl: Bowl, size: Size, part: Part, coming: stream.Orientations, options: SolidOptions
) -> float | None:
    """The least climb [rad], in whole steps, at which the solid has its measures; None up to STEEPEST_RAD."""
    first = int(np.floor(bowl.track.climb / CLIMB_STEP_RAD + 1e-9)) + 1
    for step in range(first, round(STEEPEST_RAD / CLIMB_STEP_RAD) + 1):
        track = replace(bowl.track, climb=step * CLIMB_STEP_RAD)
        with contextlib.suppress(FeederError):
            _planned(replace(bowl, track=track), size, part, coming, options)
            return track.climb
    return None


def of_sheet(sheet: Any, settings: Sequence[Setting], aspects: Aspects) -> BowlSolid | None:
    """Return the solid, in steel, of a machine that was sized without one.

    Parameters
    ----------
    sheet : MachineSheet
        With an order.
    settings : sequence of Setting
        Of the bowl.
    aspects : Aspects
        Of the part, with the answer that was taken.

    Returns
    -------
    BowlSolid or None

    Raises
    ------
    FeederError
        If the bowl cannot be drawn, as for ``solid``.
    """
    order, bowl = sheet.order, sheet.bowl
    coming = stream.follow_orientations(order.part, aspects, bowl.track, bowl.devices)
    wanted = solid_options(settings, solid=True, material=STEEL_NAME, chord=ARC_CHORD_M)
    counted = {"rule": order.rule, "target": order.wanted}
    return solid(bowl, order.size, order.part, coming, wanted, counted)[1]
