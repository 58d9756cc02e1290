"""The study of ``feeder design``: from a part and a rate to a bowl that its own trial confirms."""

import functools
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any, TypedDict, Unpack, overload

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import Shares, the_shares
from feederscrew.base import check, units
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.base.signatures import Keywords
from feederscrew.bowl import arguments, schema
from feederscrew.bowl.arguments import Quantity, former_keywords
from feederscrew.bowl.device_list import DEVICES_SECTION
from feederscrew.bowl.devices.kinds import cost_class
from feederscrew.bowl.reading import Setting, of_device
from feederscrew.bowl.record import Bowl, Machine
from feederscrew.bowl.schema import BOWL_KEYS
from feederscrew.bowl.verified import HELD, Status
from feederscrew.cad import solid as solidbowl
from feederscrew.cad.plan import ARC_CHORD_M, STEEL_NAME
from feederscrew.designing import families, loop
from feederscrew.designing.calls import call_words
from feederscrew.designing.calm_drive import DriveKind
from feederscrew.designing.families import FamilyStudy
from feederscrew.designing.nearest import nearest_from_study
from feederscrew.designing.record import DesignRequest, DesignStudy, ProofKind
from feederscrew.feeding.rate import MIN_POSITIVE
from feederscrew.machine import checks, drive_sizing
from feederscrew.machine import sheet as machines
from feederscrew.machine.drive_sizing import is_two_axis, needed_angle
from feederscrew.machine.sheet import MachineSheet
from feederscrew.part.record import Part
from feederscrew.sorting.isolating.chain import OutcomeKind
from feederscrew.sorting.tooling import listed as names_of
from feederscrew.sorting.tooling import may_be_left_out


@dataclass(frozen=True)
class DesignSearch:
    """Limits of the search for a design and of its proof."""

    rule: str = DesignRequest.rule  # whose probabilities are taken
    budget: int = DesignRequest.budget  # short trials of the search, at most
    # whether the best of each cost class is proved (steel, steady air, a sensor with a valve), and not the
    # cheapest alone that holds
    alternatives: bool = DesignRequest.alternatives
    # trials of the answer with part, friction, drive and cuts drawn from their spread
    draws: int = DesignRequest.draws
    agreed_jams: Quantity = DesignRequest.agreed_jams  # that the buyer tolerates, '1/h'
    # 'usual', or 'long': what holds is followed until the agreed jams are shown, three hours of bowl time at
    # each fill for 1 an hour; runs are kept, and a proof that was stopped goes on
    proof: str = DesignRequest.proof
    # a bound on the rate and a first chain for a quotation: nothing is proved, and the status says so
    quick: bool = DesignRequest.quick


class DesignOptions(TypedDict, total=False):
    """The keywords of ``design`` for a type checker: of one part and of several it returns two records."""

    aspect: str | None
    heading: Quantity | None
    up: str | Sequence[str]
    outcome: str
    without: str | Sequence[str]
    diameter: Quantity | tuple[Quantity, Quantity] | None
    tolerance: Quantity
    drive: str
    aspect_shares: Shares | None
    search: DesignSearch | None
    seed: int
    jobs: int
    progress: Callable[[str], None] | None


def _keep_keys(given: Keywords, kept_keys: Collection[str]) -> None:
    bowl = arguments.a_bowl(given.get("bowl") or bowls.default())
    own = {setting.key.name: setting.text for setting in bowl.settings if setting.key.name in kept_keys}
    given["bowl"] = bowl.with_values(own)


@overload
def design(
    part: Part, target: Quantity, bowl: Bowl | None = None, **options: Unpack[DesignOptions]
) -> DesignStudy: ...


@overload
def design(
    part: Sequence[Part], target: Quantity, bowl: Bowl | None = None, **options: Unpack[DesignOptions]
) -> FamilyStudy: ...


@former_keywords(former={"kept_keys": _keep_keys}, search=DesignSearch)
def design(
    part: Part | Sequence[Part],
    target: Quantity,
    bowl: Bowl | None = None,
    *,
    aspect: str | None = DesignRequest.aspect,
    heading: Quantity | None = None,
    up: str | Sequence[str] = DesignRequest.up,
    outcome: str = DesignRequest.outcome,
    without: str | Sequence[str] = DesignRequest.without,
    diameter: Quantity | tuple[Quantity, Quantity] | None = None,
    tolerance: Quantity = DesignRequest.tolerance,
    drive: str = DesignRequest.drive,
    aspect_shares: Shares | None = None,
    search: DesignSearch | None = None,
    seed: int = DesignRequest.seed,
    jobs: int = DesignRequest.jobs,
    progress: Callable[[str], None] | None = None,
) -> DesignStudy | FamilyStudy:
    """Design a bowl for a part and a rate and try it, as ``feeder design``.

    Parameters
    ----------
    part : Part or sequence of Part
        From meshes. Several share one bowl as far as they can.
    target : str or float [1/s]
        Parts that shall leave, '60/min'.
    bowl : Bowl, optional
        What its file or ``with_values`` gave is kept, its devices too; the rest is designed.
    aspect : str, optional
        On which parts leave, 'A' or 'A@354'; the one that delivers most without it.
    heading : str or float [rad], optional
        Of that aspect.
    up : str or sequence of str
        Aspects that count as the one wanted, whatever their heading: 'A,B'.
    outcome : str
        How parts leave: 'lying', 'hanging' or 'any'.
    without : str or sequence of str
        Kinds of devices that are not used, 'profile,wiper'.
    diameter : str or float or pair of them [m], optional
        The least and the greatest of the bowl.
    tolerance : str or float [m]
        Of the part's size, to either side.
    drive : str
        'leaf-spring' (one magnet), 'two-axis' (two magnets) or 'any', leaf springs first.
    aspect_shares : Shares, optional
        Of ``shares``; what lies on the moving floor of the designed bowl without it.
    search : DesignSearch, optional
        Rule, trials, draws, the jams that a buyer tolerates, how it is proved; ``quick`` proves nothing.
    seed : int
        Of everything that is drawn.
    jobs : int
        Cores to use; the answer does not depend on it.
    progress : callable, optional
        Called with what is tried, a sentence.

    Returns
    -------
    DesignStudy
        Its ``status`` says whether it 'holds', ``why`` where not; its ``bowl`` has the devices. Of several
        parts a FamilyStudy: its ``members``, whether all is ``shared``, and the worst ``status``.

    Raises
    ------
    FeederError
        If a part has no shape or no such aspect, or an argument is out of range.
    """
    looked = check.kind("search", search or DesignSearch(), DesignSearch, "give a DesignSearch")
    wanted, angle = arguments.an_orientation(aspect, heading)
    request = DesignRequest(
        target=arguments.amount("target", target, "rate", MIN_POSITIVE),
        aspect=wanted,
        heading=angle,
        up=names_of(up),
        outcome=check.choice("outcome", outcome, OutcomeKind),
        without=may_be_left_out(without),
        diameter=None if diameter is None else arguments.pair("diameter", diameter, "length"),
        rule=looked.rule,
        drive=check.choice("drive", drive, DriveKind),
        tolerance=arguments.amount("tolerance", tolerance, "length", 0.0),
        budget=arguments.whole("budget", looked.budget),
        alternatives=bool(looked.alternatives),
        draws=arguments.whole("draws", looked.draws),
        agreed_jams=arguments.amount("agreed_jams", looked.agreed_jams, "rate", MIN_POSITIVE),
        proof=check.choice("proof", looked.proof, ProofKind),
        quick=bool(looked.quick),
        seed=arguments.whole("seed", seed, 0),
        jobs=arguments.whole("jobs", jobs),
    )
    plain = arguments.a_bowl(bowls.default() if bowl is None else bowl)
    if not isinstance(part, (list, tuple)):
        part, plain = arguments.part_in_bowl(part, plain)
    kept_keys = frozenset(setting.key.name for setting in plain.settings if setting.is_own)
    kept_settings = settings_of(plain, kept_keys)
    if isinstance(part, (list, tuple)) and part:
        if request.quick:
            raise ArgumentError("search", "a quick look is at one part", "design each part alone")
        parts = [arguments.a_part(given_part) for given_part in part]
        family = families.family(parts, plain, kept_keys, request, tell=progress)
        members = (complete_design(member, kept_settings) for member in family.members)
        return replace(family, members=tuple(members))
    shared = the_shares(aspect_shares)
    complete = functools.partial(complete_design, settings=kept_settings)
    solid = arguments.a_part(part)
    study = loop.design(solid, plain, kept_keys, request, shares=shared, tell=progress, complete=complete)
    study = replace(study, call=call_words(request, study.part, kept_settings))
    if request.quick:
        return study
    return complete_design(study, kept_settings)


def complete_design(study: DesignStudy, settings: Iterable[Setting]) -> DesignStudy:
    """Return a design with the machine below its bowl, sized for it.

    Parameters
    ----------
    study : DesignStudy
    settings : iterable of Setting
        As the user gave them.

    Returns
    -------
    DesignStudy
        Its status says if that machine cannot be made.
    """
    return with_machine(study, build_machine(study, settings))


DESIGNED_TEXTS = (
    ("drive", "frequency", 1.0, "Hz"),
    ("drive", "vibration_angle", np.radians(1.0), "deg"),
    ("drive", "phase", np.radians(1.0), "deg"),
    ("track", "climb", np.radians(1.0), "deg"),
    ("track", "bank", np.radians(1.0), "deg"),
    ("track", "radius", 1e-3, "mm"),
    ("track", "width", 1e-3, "mm"),
)


@dataclass(frozen=True, eq=False)
class Built:
    """Machine below the bowl of a design, and the bowl as a solid."""

    sheet: MachineSheet | None = None  # as it is driven; None where no machine can be
    drawn: MachineSheet | None = None  # the same with its order and its solid; None where there is no solid
    why: str = ""  # there is none
    remarks: tuple[str, ...] = ()  # of `feeder bowl` of that file with the part and the rate
    lacks: str = ""  # what keeps the leaves and magnets that were sized from making the drive


def build_machine(study: DesignStudy, settings: Iterable[Setting]) -> Built:
    """Return the machine below the bowl of a design, sized for it, and that bowl as a solid of steel.

    Parameters
    ----------
    study : DesignStudy
    settings : iterable of Setting
        As the user gave them.

    Returns
    -------
    Built
        Empty for a design without a bowl.
    """
    if study.bowl is None:
        return Built()
    listed = [s for s in settings if s.is_own and s.key.field != DEVICES_SECTION]
    # what the user gave, then drive and track of the design
    own = [
        f"{section}.{name}={getattr(getattr(study.bowl, section), name) / unit:.9g} {text}"
        for section, name, unit, text in DESIGNED_TEXTS
    ]
    words = {line.partition("=")[0] for line in own}
    words |= {"drive.amplitude", "drive.peak_to_peak", "sizing.fill_density"}
    kept_lines = [f"{s.key.name}={s.text}" for s in listed if s.key.name not in words]
    devices = tuple(of_device(k, device) for k, device in enumerate(study.devices, start=1))
    try:
        base_settings = bowls.settings(None, (*kept_lines, *own))
        stroke = f"drive.amplitude={1e3 * study.bowl.drive.amplitude:.9g} mm"
        tried = bowls.settings(None, (*kept_lines, *own, stroke))
        sized, why = _size_bowl((*base_settings, *devices), study, (*tried, *devices))
        driven = replace(sized.bowl, drive=study.bowl.drive)  # at the stroke that was tried
        words = drive_sizing.user_keys(listed, "machine")
        machine = driven.machine if "leaves" in words else drive_sizing.on_leaves(driven, words)
        under = [f"machine.{name}={text}" for name, text in _machine(machine)]
        lines = [*kept_lines, *own, stroke, *under]
        # what fills the bowl, and how high its outlet is: a bowl file says both without the part
        room = study.part.volume if study.part.hull is None else study.part.hull.volume
        if room:
            lines.append(f"sizing.fill_density={study.part.mass / room:.9g} kg/m3")
        if sized.solid is not None:  # rounded down: the cuts may stand as high as they just can
            lines.append(f"sizing.outlet_height={np.floor(1e9 * sized.depth) / 1e6:.9g} mm")
        last = {line.partition("=")[0]: line for line in lines}  # of several lines of one key
        own_settings = (*bowls.settings(None, tuple(last.values())), *devices)
        sheet = machines.machine(own_settings)
    except FeederError as fault:
        return Built(why=str(fault))
    as_tried = bool(study.proof.queues)
    sheet = replace(sheet, turns=sized.turns, as_tried=as_tried)
    owned = "leaves" in words or is_two_axis(sheet.bowl.drive)
    lacks = "" if owned else drive_sizing.leaf_shortfall(sheet.bowl)
    # what `feeder bowl` with the part and the rate warns of besides: it takes the drive that was tried
    target, warned = study.request.target, {*study.warnings, *checks.remarks(sheet)}
    try:
        sized_again = machines.size_machine(own_settings, study.part, target, as_tried=True)
        remarks = _new_remarks(replace(sized_again, as_tried=as_tried), sheet, warned)
    except FeederError as fault:
        rate = f"{target * units.MINUTE:.4g}/min"
        remarks = (f"feeder bowl finds no machine of this file for {rate}: {fault}",)
    drawn = None
    if sized.solid is not None:  # how the mass of the solid lies about the axis goes with it
        heavy = replace(sheet.bowl.machine, unbalance=sized.bowl.machine.unbalance)
        bowl = replace(sheet.bowl, machine=heavy)
        drawn = replace(sheet, bowl=bowl, order=sized.order, solid=sized.solid)
    return Built(sheet, drawn, why, remarks, lacks)


def _new_remarks(sheet: MachineSheet, known: MachineSheet, warned: Collection[str]) -> tuple[str, ...]:
    """The remarks on a machine that are not among some; a drive that both do not make is said once."""
    other, own = sheet.mismatch, known.mismatch
    again = other is not None and own is not None and other.reasons == own.reasons
    said = {*warned, *(map(str, checks.find_drive_faults(sheet)) if again else ())}
    return tuple(remark for remark in sheet.remarks if remark not in said)


def settings_of(bowl: Bowl, kept_keys: Collection[str] = ()) -> tuple[Setting, ...]:
    """Return a bowl as settings that the user gave, for the machine below a design of the library.

    Parameters
    ----------
    bowl : Bowl
        Its devices are left out: a design has its own. What differs from the defaults counts as given.
    kept_keys : collection of str, optional
        Names of keys that count as given though they have their default value.

    Returns
    -------
    tuple of Setting
    """
    usual, lines = bowls.default(), {}
    for key in BOWL_KEYS:
        if key.field in lines or key.word in schema.UNBALANCE_NAMES:
            continue
        pair: list[Any] = [reduce(getattr, key.field.split("."), record) for record in (bowl, usual)]
        value, default = pair
        if key.name == "machine.supply":  # follows the mains
            default = 2.0 * bowl.sizing.mains_frequency
        if value is None or (value == default and key.name not in kept_keys):
            continue
        if key.choices:
            lines[key.field] = f"{key.name}={value}"
        else:
            scale = key.share * (units.factor(key.unit, key.dimension) if key.unit else 1.0)
            lines[key.field] = f"{key.name}={value / scale:.12g} {key.unit}".strip()
    return bowls.settings(None, tuple(lines.values()))


def with_machine(study: DesignStudy, below: Built) -> DesignStudy:
    """Return a design that knows what its own machine is out of limits in, and what it cannot make.

    Where the leaf springs that are drawn do not make the drive that was tried, or its bowl makes no solid,
    its tooling holds and its machine cannot be made: its status says so, and the nearest machine that makes
    the drive is named. Where none does, a drive at a flatter angle that ``loop.design`` proved stays named.

    Parameters
    ----------
    study : DesignStudy
    below : Built
        As ``build_machine`` returns it.

    Returns
    -------
    DesignStudy
        Its ``warnings`` hold those of ``feeder bowl`` for its file.
    """
    sheet = below.sheet
    solid = (f"no solid of its bowl can be made: {below.why}",) if below.why else ()
    if study.bowl is None or sheet is None:
        return _with_its_alternative(replace(study, machine_lacks=solid)) if solid else study
    of_solid = () if below.drawn is None else checks.solid_remarks(below.drawn)
    warnings = (*checks.remarks(sheet), *of_solid, *below.remarks)
    other, lacking = sheet.mismatch, list[str]()
    if other is not None and other.other_angle and not other.two_axis:
        lacking.append(f"the vibration angle {other.text}")
    if below.lacks:
        lacking.append(f"the machine that is drawn does not make its drive: {below.lacks}")
    lacking += solid
    completed = replace(
        study,
        bowl=replace(study.bowl, machine=sheet.bowl.machine),
        machine_drawn=True,
        drive_mismatch=other,
        machine_warnings=tuple(dict.fromkeys(warnings)),
        machine_lacks=tuple(lacking),
    )
    if study.status not in HELD or not lacking:
        return completed
    completed = _with_its_alternative(completed)
    change = "" if solid else nearest_machine(sheet.bowl)
    if not change:
        return completed
    changed_springs = nearest_from_study(study, study.request.target, change, trials=len(study.attempts))
    return replace(completed, nearest=changed_springs)


def _with_its_alternative(study: DesignStudy) -> DesignStudy:
    """A design whose row among the alternatives has the status that it has with its machine."""
    if study.status is not Status.NO_MACHINE:
        return study
    own = cost_class(study.devices)
    rows = (
        replace(row, status=study.status, reasons=study.machine_lacks)
        if row.cost_class == own and row.status in HELD
        else row
        for row in study.alternatives
    )
    return replace(study, alternatives=tuple(rows))


def nearest_machine(bowl: Bowl) -> str:
    """Return the machine nearest to one that does not make its drive, and does: in words, '' without one.

    The springs stand on their own circle or as far out as the bowl has room for them, as steep as the drive
    asks for and no steeper than ``sizing.steepest_spring_angle``, on leaves that are chosen anew; each is
    computed as ``feeder bowl`` computes a machine.

    Parameters
    ----------
    bowl : Bowl
        With its drive, and the machine that does not make it.

    Returns
    -------
    str
        'springs that stand at 36 deg on a circle of 290 mm, 8 leaves of 40 x 3 x 100 mm'.

    References
    ----------
    Own; docs/bowl.md, "How it is computed".
    """
    track, machine = bowl.track, bowl.machine
    wanted = bowl.drive.vibration_angle + track.climb
    farthest = max(track.radius - 0.5 * machine.leaf_width, machine.spring_radius)
    for circle in dict.fromkeys((machine.spring_radius, farthest)):
        on_circle = replace(machine, spring_radius=circle)
        angle = float(np.radians(np.round(np.degrees(needed_angle(on_circle, track.radius, wanted)), 1)))
        if angle > bowl.sizing.steepest_spring_angle:
            continue
        turned = replace(bowl, machine=replace(on_circle, spring_angle=angle))
        words = {"spring_angle", "spring_radius", "bowl_mass", "bowl_inertia", "base_mass", "base_inertia"}
        built = replace(turned, machine=drive_sizing.on_leaves(turned, words))
        if drive_sizing.can_make(built) is None and not drive_sizing.leaf_shortfall(built):
            own = built.machine
            leaf = " x ".join(f"{1e3 * x:.3g}" for x in (own.leaf_width, own.leaf_thickness, own.leaf_length))
            return (
                f"springs that stand at {np.degrees(angle):.3g} deg on a circle of {2e3 * circle:.4g} mm, "
                f"{own.leaves:.0f} leaves of {leaf} mm"
            )
    return ""


def _size_bowl(
    settings: Sequence[Setting], study: DesignStudy, tried: Sequence[Setting]
) -> tuple[MachineSheet, str]:
    """The bowl of a design, with its solid, or else why there is none.

    Where the static rule lets nothing or too little through, it is the bowl at the stroke that was tried,
    whose settings are ``tried``; where that makes no solid, that of a track without devices.
    """
    wanted = solidbowl.solid_options(settings, solid=True, material=STEEL_NAME, chord=ARC_CHORD_M)
    target = study.request.target
    for own, as_tried in ((settings, False), (tried, True)):
        try:
            return machines.size_machine(own, study.part, target, solid=wanted, as_tried=as_tried), ""
        except FeederError as fault:
            why = str(fault)
    try:
        return machines.size_machine(settings, study.part, target), why
    except FeederError:
        plain = [s for s in settings if s.key.field != DEVICES_SECTION]
        return machines.size_machine(plain, study.part, MIN_POSITIVE), why


def _machine(machine: Machine) -> Iterator[tuple[str, str]]:
    yield "bowl_mass", f"{machine.bowl_mass:.6g} kg"
    yield "bowl_inertia", f"{machine.bowl_inertia:.6g} kg m2"
    yield "base_mass", f"{machine.base_mass:.6g} kg"
    yield "base_inertia", f"{machine.base_inertia:.6g} kg m2"
    yield "spring_radius", f"{1e3 * machine.spring_radius:.6g} mm"
    yield "spring_angle", f"{np.degrees(machine.spring_angle):.6g} deg"
    yield "leaf_width", f"{1e3 * machine.leaf_width:.6g} mm"
    yield "leaf_thickness", f"{1e3 * machine.leaf_thickness:.6g} mm"
    yield "leaf_length", f"{1e3 * machine.leaf_length:.6g} mm"
    yield "leaves", f"{machine.leaves:.0f}"
    for word, value in schema.unbalance_values(machine).items():
        yield word, f"{value:.12g} {'m' if word in schema.CENTRE else 'kg m2'}"
