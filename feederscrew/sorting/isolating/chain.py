"""The fewest devices of one number that let one orientation pass and return the others, in lengths of a shop;
why two orientations cannot be separated, and what change of the part would help; and what a design says, from
what the whole chain does with every orientation.

Source: own; docs/tooling.md, "1. The method".
"""

import enum
import functools
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
import shapely

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Points
from feederscrew.base.columns import Column
from feederscrew.bowl.devices.base import STOPPED, UNSURE, Device
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.leans import Lean
from feederscrew.bowl.devices.ledges import SHOP_STEP_M
from feederscrew.bowl.devices.pneumatics import VisionReject
from feederscrew.bowl.devices.trade import Action
from feederscrew.motion import sameness
from feederscrew.sorting.falling import surely_gone
from feederscrew.sorting.fates import course
from feederscrew.sorting.orientations import Orientation, hang
from feederscrew.sorting.sensor_views import difference
from feederscrew.sorting.verdicts import DeviceEncounter, opening_margin, verdict

SHOP_ROUNDING_M = 1e-7  # [m] to which a value is rounded
DESIGN_KEY = "design"
SIDE_NAMES = (("ahead", "behind"), ("on the inner side", "at the wall"), ("on top", "at the bottom"))
LEAST_SHARE = 5e-3  # [1] orientations that come less often need not be returned
ISOLATED_PURITY = 0.98  # [1] of what leaves, from which an orientation is said to be isolated
MIN_ORIENTATION_SHARE = 1e-9  # [1] of an orientation: less comes of rounding
NEGLIGIBLE_SHARE = 1e-4  # [1] those that come less often change no number: no device is added for them
PRINTED_SHARE_STEP = 1e-4  # [1] shares that differ by less are printed alike


def snap_to_shop_step(value: float, step: float, up: bool) -> float:
    """Return the nearest multiple of a step that is not below a value, or not above it.

    Parameters
    ----------
    value, step : float [m]
    up : bool
        Whether it is not below.

    Returns
    -------
    float [m]
    """
    count = value / step
    return float((np.ceil(count - 1e-6) if up else np.floor(count + 1e-6)) * step)


def in_mm(value: float) -> str:
    """Return a length as a bowl file has it: '9.25 mm'.

    Parameters
    ----------
    value : float [m]

    Returns
    -------
    str
    """
    return f"{1e3 * round_finely(value):.9g} mm"


def round_finely(value: float) -> float:
    """Return a length rounded to what a bowl file says of it.

    Parameters
    ----------
    value : float [m]

    Returns
    -------
    float [m]
    """
    return float(np.round(value / SHOP_ROUNDING_M)) * SHOP_ROUNDING_M


class OutcomeKind(enum.StrEnum):
    """Way in which parts leave the bowl."""

    ANY = "any"
    LYING = "lying"
    HANGING = "hanging"  # by a head, between rails


@dataclass(frozen=True)
class Cut:
    """One device of a design, with how much it may change."""

    device: Device
    margin_pass: float  # [m] by which the wanted orientation passes
    margin_reject: float  # [m] by which the nearest of those it must return fails
    smallest: Device  # the least cut that still returns them
    largest: Device  # the greatest cut that the wanted orientation still passes
    returns: tuple[str, ...]  # names of the orientations it returns
    turns: tuple[tuple[str, str, float], ...] = ()  # name, name it turns over into, share
    stops: tuple[str, ...] = ()  # names of the orientations that come to stand at it


CUT_COLUMNS: tuple[Column[Cut], ...] = (
    Column("margin_pass_mm", lambda cut: cut.margin_pass, "mm"),
    Column("margin_reject_mm", lambda cut: cut.margin_reject, "mm"),
)


@dataclass(frozen=True)
class DesignConstraints:
    """Devices that a design may use, and how finely it is made."""

    outcome: OutcomeKind = OutcomeKind.ANY  # how parts leave
    without: tuple[str, ...] = ()  # kinds of devices that are not used
    step: float = SHOP_STEP_M  # [m] a shop makes: values are whole multiples
    up: tuple[str, ...] = ()  # aspects that count as the one wanted
    cutter: float = 0.0  # [m] radius that corners of holes are rounded to
    spacing: Lean | None = None  # that comes before a device that needs gaps
    vary: bool = True  # other tracks and sweeps are tried where they give more
    gentle: bool = False  # cuts take no more of the wanted orientation's foot than they must
    turn: bool = False  # devices that turn parts over, where returning them wastes too much
    air: bool = False  # air that blows all the time, where cuts and blades are not enough
    at_rest: bool = True  # one for parts that are placed counts, where none isolates what travels
    isolating: bool = False  # a chain that does not isolate is of no use: none is looked for where none can

    def allows(self, *kinds: str) -> bool:
        """Tell whether some kinds of devices may all be used.

        Parameters
        ----------
        *kinds : str

        Returns
        -------
        bool
        """
        return not set(kinds) & set(self.without)

    @property
    def sensed(self) -> bool:
        """Tell whether a sensor may be used."""
        return any(self.allows(kind.kind) for kind in sensing_kinds())

    @property
    def clearing(self) -> bool:
        """Tell whether a blade that clears itself may be used."""
        return any(self.allows(kind.kind) for kind in numeric_kinds() if kind.action is Action.OVERHEAD)


# -- the devices that may do it


def candidates(
    orientations: Sequence[Orientation],
    wanted: int,
    margin: float,
    constraints: DesignConstraints | None = None,
    *,
    clearing: bool = True,
    air: bool = False,
    sensed: bool = False,
    same: Sequence[int] = (),
) -> dict[Device, Floats]:
    """Return every device of one number that the wanted orientation passes by a margin.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    wanted : int
        The place of the wanted one.
    margin : float [m]
    constraints : DesignConstraints, optional
    clearing, air, sensed : bool, optional
        Whether blades that clear themselves, jets and sensors are tried beside what drops parts.
    same : sequence of int, optional
        Places of those that count as the wanted one: a device of one number lets all of them pass.

    Returns
    -------
    dict of Device to (M,) float [m]
        Each with its value at which it returns the most, and the margins of the orientations at it; NaN of
        one that would come to stand there. What drops parts comes first, then what clears itself.
    """
    devices: list[Device] = []
    constraints = constraints or DesignConstraints()
    for kind in numeric_kinds():
        values, lower = limits(kind, orientations), kind.search.bound == "lower"
        first = pivot(kind, orientations, wanted, same)
        allowed = constraints.allows(kind.kind) and (clearing or kind.action is not Action.OVERHEAD)
        if not allowed or not np.isfinite(values[first]):
            continue
        play = margin + kind(DESIGN_KEY).hop_blur(orientations[first])
        if lower and values[first] <= 2.0 * play:
            continue
        limit = snap_to_shop_step(values[first] + (-play if lower else play), constraints.step, up=not lower)
        device = kind.proposal(DESIGN_KEY, limit)
        if limit > 0.0 and device.acts(orientations[wanted].track):
            devices.append(device)
    encounters = [DeviceEncounter(orientation, orientations) for orientation in orientations]
    rows = sorted({wanted, *same})
    competitors = [encounter for k, encounter in enumerate(encounters) if k not in rows]
    shaped: list[Any] = [
        kind
        for kind in KINDS.values()
        if kind.search.is_proposed and kind.action is not Action.SENSE and not kind.search.bound
    ]
    for kind in (kind for kind in shaped if constraints.allows(kind.kind)):
        if (kind.trade.cost_class > 1 and not air) or (kind.action is Action.PUSH and not clearing):
            continue
        devices += kind.proposals([encounters[k] for k in rows], competitors, orientations, DESIGN_KEY)

    def unlike(view: str) -> list[Orientation]:
        equals = [encounters[k] for k in same if k != wanted]
        return [one.orientation for one in equals if one.differs(orientations[wanted], view) > margin]

    for kind in sensing_kinds() if sensed else ():
        if constraints.allows(kind.kind):
            devices += kind.around(encounters[wanted], margin, DESIGN_KEY, unlike)
    return {device: margins_at(device, tuple(orientations)) for device in devices}


def pivot(
    kind: type[Device], orientations: Sequence[Orientation], wanted: int, same: Sequence[int] = ()
) -> int:
    """Return which of those that count as the wanted one a device of one number lets pass last.

    Parameters
    ----------
    kind : class of Device
    orientations : sequence of Orientation
    wanted : int
    same : sequence of int, optional
        Those that count as it.

    Returns
    -------
    int
    """
    values = limits(kind, orientations)
    rows = sorted({wanted, *same}, key=lambda k: k != wanted)
    return (max if kind.search.bound == "upper" else min)(rows, key=lambda k: values[k])


def sensing_kinds() -> list[Any]:
    """Return the kinds that a design tries with the wanted orientation's own outline.

    Returns
    -------
    list of class of Device
    """
    return [kind for kind in KINDS.values() if kind.search.is_proposed and kind.action is Action.SENSE]


def numeric_kinds() -> list[type[Device]]:
    """Return the kinds of one number that a design tries, in the order of their ranks: drops first.

    Returns
    -------
    list of class of Device
    """
    kinds = [kind for kind in KINDS.values() if kind.search.is_proposed and kind.search.bound]
    return sorted(kinds, key=lambda kind: kind.search.rank)


def limits(kind: type[Device], orientations: Sequence[Orientation]) -> Floats:
    """Return the value of a device of one number that each orientation just passes.

    Parameters
    ----------
    kind : class of Device
    orientations : sequence of Orientation

    Returns
    -------
    (M,) float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    return np.array([kind.needed(orientation) for orientation in orientations])


def margin_at(device: Device, orientation: Orientation, orientations: Sequence[Orientation]) -> float:
    """Return the margin of an orientation at a device.

    Parameters
    ----------
    device : Device
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part.

    Returns
    -------
    float [m]
        NaN of one that would come to stand there. A hair below 0 of one that travels and may be held there,
        though it is not supported.
    """
    margin = verdict(device, orientation, orientations).margin
    if not margin < 0.0:
        return margin
    if device.fate(DeviceEncounter(orientation, orientations)) == STOPPED:
        return np.nan
    return margin if orientation.grip <= 0.0 or surely_gone(device, orientation) else max(margin, -UNSURE)


@functools.lru_cache(maxsize=2048)
def margins_at(device: Device, orientations: tuple[Orientation, ...]) -> Floats:
    """Return ``margin_at`` of each orientation; it is remembered: designs of the next cost class ask again.

    Parameters
    ----------
    device : Device
    orientations : tuple of Orientation

    Returns
    -------
    (M,) float [m]
    """
    return check.frozen(np.array([margin_at(device, one, orientations) for one in orientations]))


# -- the fewest of them


def fewest(
    margins: dict[Device, Floats], competitors: Floats, margin: float, enough: float = 0.0
) -> tuple[Device, ...]:
    """Return the fewest devices, in the order of ``candidates``, that return the most of some orientations.

    Parameters
    ----------
    margins : dict of Device to (M,) float [m]
        As ``candidates`` returns them.
    competitors : (M,) float [1]
        How much each of the orientations to be returned weighs, 0 for those that need not be.
    margin : float [m]
        By which a device has to return one.
    enough : float [1], optional
        A chain that leaves no more over is not made longer.

    Returns
    -------
    tuple of Device
    """
    best: tuple[Device, ...] = ()
    weight, surest, total = 0.0, 0.0, float(competitors.sum())
    devices = [device for device, some in margins.items() if competitors[some <= -margin].any()]
    for count in range(1, len(devices) + 1):
        if total - weight <= enough:
            break
        for combination in itertools.combinations(devices, count):
            returned_by = -np.array([margins[device] for device in combination])
            is_returned = (returned_by >= margin).any(axis=0)
            held = float(competitors[is_returned].sum())
            # a blade that pushes parts off is the surer, the farther it pushes them
            pushes = len(best) == count and any(one.action is Action.PUSH for one in best)
            returns_more, returns_as_much = held > weight + 1e-12, held >= weight - 1e-12
            if not (returns_more or (pushes and returns_as_much)):
                continue
            if jams(margins, combination, competitors, margin):
                continue
            rows = is_returned & (competitors > 0.0)
            least = float(np.nanmax(returned_by[:, rows], axis=0).min(initial=np.inf))
            if returns_more or least > surest:
                best, weight, surest = combination, held, least
    return best


def jams(margins: dict[Device, Floats], devices: Sequence[Device], weights: Floats, margin: float) -> bool:
    """Tell whether an orientation that weighs comes to stand at a device, not returned before it.

    Parameters
    ----------
    margins : dict of Device to (M,) float [m]
        As ``candidates`` returns them.
    devices : sequence of Device
        The chain.
    weights : (M,) float [1]
    margin : float [m]
        By which a device has to return one.

    Returns
    -------
    bool
    """
    gone = np.asarray(weights) <= 0.0
    for device in devices:
        if np.any(np.isnan(margins[device]) & ~gone):
            return True
        gone = gone | (margins[device] <= -margin)
    return False


def place_devices(
    orientations: Sequence[Orientation],
    wanted: int,
    devices: Sequence[Device],
    must: Sequence[Bools],
    least: float = np.inf,
    step: float = SHOP_ROUNDING_M,
    same: Sequence[int] = (),
) -> tuple[Cut, ...]:
    """Return the cuts of a chain, each value in the middle of what it may be.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    wanted : int
    devices : sequence of Device
        The chain.
    must : sequence of (M,) bool
        Which orientations each device has to return.
    least : float [m], optional
        By no more than that a device that leaves less of a foot returns them: the wanted one has the rest.
    step : float [m], optional
        Values are whole multiples of it.
    same : sequence of int, optional
        As for ``candidates``.

    Returns
    -------
    tuple of Cut

    References
    ----------
    docs/tooling.md, "6. Where it ends".
    """
    cuts = []
    for device, some in zip(devices, must):
        row = pivot(type(device), orientations, wanted, same) if device.search.bound else wanted
        place: Callable[..., Cut] = _place_sensor if device.action is Action.SENSE else _place_number
        free = device.action is Action.SENSE or device.search.bound
        cut = place(orientations, row, device, some, least, step) if free else None
        cuts.append(cut or judge_cut(orientations, row, device, some, device, device))
    return tuple(cuts)


def _place_number(
    orientations: Sequence[Orientation], wanted: int, device: Device, must: Bools, least: float, step: float
) -> Cut:
    values, upper = limits(type(device), orientations), device.search.bound == "upper"
    # by how much more than placed each of the others passes it as it travels
    more = np.array([device.more(DeviceEncounter(orientation)) for orientation in orientations])
    values = values + np.where(np.arange(len(orientations)) == wanted, 0.0, more)
    nearest = (values[must].min() if upper else values[must].max()) if must.any() else values[wanted]
    middle = float(0.5 * (values[wanted] + nearest))

    def make(value: float) -> Device:
        value = snap_to_shop_step(value, step, up=not upper) if step > SHOP_ROUNDING_M else value
        return device.valued(round_finely(value))

    surest = _surest(orientations, must, make, middle if np.isfinite(nearest) else device.limit, device.limit)
    if device.action.carries and least < np.inf and np.isfinite(nearest):
        eased = max(surest.limit, nearest - least) if upper else min(surest.limit, nearest + least)
        surest = _surest(orientations, must, make, float(eased), surest.limit, least - 2.0 * SHOP_ROUNDING_M)
    ends = [device.valued(float(end)) for end in (nearest, values[wanted])]
    return judge_cut(orientations, wanted, surest, must, *ends)


def _place_sensor(
    orientations: Sequence[Orientation],
    wanted: int,
    device: VisionReject,
    must: Bools,
    least: float,
    step: float,
) -> Cut:
    play = device.like[2]
    seen = [device.differs(DeviceEncounter(orientation, orientations)) for orientation in orientations]
    widest = min((differs for differs, some in zip(seen, must) if some), default=2.0 * play)

    def make(value: float) -> Device:
        return device.with_play(round_finely(max(snap_to_shop_step(value, step, up=False), play)))

    surest = _surest(orientations, must, make, 0.5 * (seen[wanted] + widest), play)
    return judge_cut(orientations, wanted, surest, must, make(widest), make(play))


def _surest(
    orientations: Sequence[Orientation],
    must: Bools,
    make: Callable[[float], Device],
    middle: float,
    near: float,
    margin: float = UNSURE,
) -> Device:
    """The device of a value midway, or as near to that as it still returns what it has to, by a margin."""
    others = [orientation for orientation, some in zip(orientations, must) if some]

    def returns(device: Device) -> bool:
        return all(margin_at(device, orientation, orientations) < -margin for orientation in others)

    if returns(make(middle)):
        return make(middle)
    for _ in range(10):
        half = 0.5 * (near + middle)
        near, middle = (half, middle) if returns(make(half)) else (near, half)
    return make(near)


def judge_cut(
    orientations: Sequence[Orientation],
    wanted: int,
    device: Device,
    must: Bools,
    smallest: Device,
    largest: Device,
) -> Cut:
    """Return a device as a Cut, with its true margins and what it returns.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    wanted : int
    device : Device
    must : (M,) bool
        Which orientations it has to return.
    smallest, largest : Device
        With the least and the greatest value that do.

    Returns
    -------
    Cut
    """
    margins = np.array([verdict(device, orientation, orientations).margin for orientation in orientations])
    return Cut(
        device=device,
        margin_pass=float(margins[wanted]),
        margin_reject=float(-margins[must].max()) if must.any() else np.nan,
        smallest=smallest,
        largest=largest,
        returns=tuple(o.name for o, margin in zip(orientations, margins) if margin < 0.0),
    )


# -- why two orientations cannot be separated


def inseparable_reason(wanted: Orientation, other: Orientation, margin: float) -> str:
    """Return in one sentence why a chain leaves another orientation, and the smallest change that helps.

    Parameters
    ----------
    wanted, other : Orientation
    margin : float [m]

    Returns
    -------
    str
    """
    names = f"{wanted.name} and {other.name}"
    if wanted.mirror == other.name:
        return (
            f"{names} are mirror images fore and aft: no device of one number parts "
            f"them and no hole was found; a feature on one side only would, of {2e3 * margin:.2g} mm or more"
        )
    # the least [m] that has to be added to what some device measures of a part
    differences = [
        (-opening_margin(wanted.view_ahead, other), kind.kind, kind.trade.measures)
        for kind in KINDS.values()
        if hasattr(kind, "free")
    ]
    for kind in numeric_kinds():
        first, second = limits(kind, (wanted, other))
        step = second - first if kind.search.bound == "upper" else first - second
        differences.append((float(step) if np.isfinite(step) else -np.inf, kind.kind, kind.trade.measures))
    step, _, feature = max(differences)
    step = max(step, 0.0)
    need = f"{1e3 * (2.0 * margin - step):.2g} mm more in {feature} would part them"
    if step >= 2.0 * margin:
        need = f"{feature} differs by {1e3 * step:.2g} mm, but no chain that was tried can use it"
    shape, side, shift = find_difference(wanted, other)
    if shape < min(margin, 0.5 * max(map(abs, shift))):
        ahead, inwards, up = (1e3 * abs(by) for by in shift)
        seen = difference(other, wanted, "outline")
        camera = ""
        if seen > shape + UNSURE:  # through a bore it sees more than the outside
            camera = (
                f"; a camera from above sees them differ by {1e3 * seen:.2g} mm, which is too little for it"
            )
        return (
            f"{names} have the same outside to {1e3 * max(shape, 1e-5):.2f} mm, "
            f"only the inside differs, as by a bore off the middle or a closed end: the centre of mass lies "
            f"elsewhere by {ahead:.2f} mm along the track, {inwards:.2f} mm across it and {up:.2f} mm in "
            f"height; needs a feature on the outside; {need}{camera}"
        )
    if shape < 4.0 * margin:
        return (
            f"{names} differ by {1e3 * shape:.2g} mm at most, {side}, as by a chamfer or a rounding; {need}"
        )
    lower = other.height <= wanted.height + margin and other.width <= wanted.width + 2.0 * margin
    if lower and stands_on_all(other, wanted, margin):
        return (
            f"whatever carries {wanted.name} carries {other.name}, which stands on a larger foot and is no "
            f"higher or wider: only turning it over helps; {need}"
        )
    return (
        f"{names} differ by {1e3 * shape:.2g} mm {side}, which no device of one "
        f"number, gate or hole that was tried can use; {need}"
    )


def stands_on_all(orientation: Orientation, other: Orientation, margin: float) -> bool:
    """Tell whether one orientation stands on all that another stands on: no hole lets it fall alone.

    Parameters
    ----------
    orientation, other : Orientation
    margin : float [m]

    Returns
    -------
    bool
    """
    foot, within = (shapely.MultiPoint(k.foot.corners).convex_hull for k in (orientation, other))
    near = abs(orientation.distance - other.distance) < 2.0 * margin
    return bool(near and foot.buffer(margin).covers(within))


def find_difference(wanted: Orientation, other: Orientation) -> tuple[float, str, tuple[float, float, float]]:
    """Return how two orientations differ on the track.

    Their hulls are laid over each other as well as can be, by least squares over directions.

    Parameters
    ----------
    wanted, other : Orientation

    Returns
    -------
    distance : float [m]
        The greatest between the hulls.
    side : str
        Where that is.
    shift : (float, float, float) [m]
        By which the centre of mass lies elsewhere within the hull: ahead, inwards, up.
    """
    first, second = (
        sameness.looks(o.posture, [o.heading])[0][0, 0]
        * np.ptp(cast(Points, o.posture.corners), axis=0).max()
        for o in (wanted, other)
    )
    away, there, shift = first - second, sameness.directions(), np.zeros(3)
    for _ in range(4):  # least squares: the directions are spread evenly
        left = away - (there * shift).sum(axis=1)
        shift = shift + 3.0 * (there * left[:, None]).mean(axis=0)
    left = np.abs(away - (there * shift).sum(axis=1))
    where = there[int(np.argmax(np.round(left, 9)))]
    axis = int(np.argmax(np.abs(where)))
    x, y, z = map(float, shift)
    return float(left.max()), SIDE_NAMES[axis][int(where[axis] < 0.0)], (x, y, z)


# -- what a design says


@dataclass(frozen=True, eq=False)
class Design:
    """Chain that isolates one orientation, and what it leaves over."""

    wanted: int  # its place among the orientations
    isolated: bool = False  # all others that come often enough are returned, to either side by the margin
    before: tuple[Device, ...] = ()  # devices of the bowl itself, which parts meet first
    cuts: tuple[Cut, ...] = ()  # in the order parts meet them
    margin: float = np.nan  # [m] the least, of passing and of returning; NaN without any device
    efficiency: float = 0.0  # [1] share of the parts offered that leave in this orientation
    purity: float = np.nan  # [1] of what leaves, or is not sure to be returned, that is in this orientation
    left_over: tuple[str, ...] = ()  # what leaves as well
    remarks: tuple[str, ...] = ()  # why, beside what stands at a device and what cannot be separated
    inseparable: tuple[tuple[Orientation, Orientation, float], ...] = ()  # wanted, other, margin [m]
    late: bool = False  # the time limit stopped the search: another machine may find more
    # [1] purity where a trial confirms what is not sure to be returned; None where nothing leaves
    hopeful: float | None = None
    width: float | None = None  # [m] of the track, where it is another than the bowl's
    bank: float | None = None  # [rad] the same
    least_purity: float = ISOLATED_PURITY  # [1] from which it is said to isolate
    surely: float = 0.0  # [1] of the efficiency, what does not roll or rock on its way: the least of it
    steady: bool = True  # the drive leaves the wanted orientation lying on what the cuts leave of its foot
    leaves_as: str = ""  # name of the state in which it leaves, where it is known

    @cached_property
    def reasons(self) -> tuple[str, ...]:
        """Why, a sentence each: worked out when it is asked for, which of most proposals it never is."""
        stops = (
            f"{' '.join(cut.stops)} come to stand at the {cut.device.kind}" for cut in self.cuts if cut.stops
        )
        return (*stops, *(inseparable_reason(*pair) for pair in self.inseparable), *self.remarks)

    @property
    def surely_isolates(self) -> bool:
        """Tell whether it isolates though what no verdict is sure to return counts as leaving."""
        return self.isolated and not self.purity < self.least_purity  # also where nothing that comes leaves

    @property
    def purity_is_least(self) -> bool:
        """Tell whether the purity counts as leaving what no verdict is sure to return."""
        return self.hopeful is not None and self.hopeful > self.purity

    @property
    def least(self) -> float:
        """The least of the efficiency [1] that the static rule is sure of."""
        return min(self.surely, self.efficiency)

    @property
    def stands(self) -> bool:
        """Tell whether some orientation comes to stand at one of its devices."""
        return any(cut.stops for cut in self.cuts)

    @property
    def devices(self) -> tuple[Device, ...]:
        """Every device along the track: those of the bowl, then the design's own."""
        return (*self.before, *(cut.device for cut in self.cuts))


DESIGN_COLUMNS: tuple[Column[Design], ...] = (
    Column("track_width_mm", lambda design: design.width, "mm"),
    Column("track_bank_deg", lambda design: design.bank, "deg"),
    Column("margin_mm", lambda design: design.margin, "mm"),
)


@dataclass(frozen=True, eq=False)
class DesignTask:
    """One orientation to be isolated behind some devices; M orientations."""

    orientations: tuple  # of Orientation
    shares: Floats  # (M,) [1] probability of each
    wanted: int
    margin: float  # [m] to either side
    purity: float  # [1] of what leaves, that is enough
    before: tuple[Device, ...]  # of the bowl
    coming: Floats  # (M,) [1] share that comes to the design lying so
    turners: tuple[Cut, ...] = ()  # turning devices of the design, before all that return
    constraints: DesignConstraints = field(default_factory=DesignConstraints)  # what it may use

    @property
    def stays(self) -> Bools:
        """(M,) bool, whether the bare track carries it."""
        return np.array([not orientation.returned for orientation in self.orientations])

    @property
    def same(self) -> Bools:
        """(M,) bool, which count as the wanted one: itself, and what lies on an aspect that may be up too."""
        up = {name.casefold() for name in self.constraints.up}
        equal = np.array([orientation.aspect.casefold() in up for orientation in self.orientations])
        return equal | (np.arange(len(self.orientations)) == self.wanted)

    @property
    def often(self) -> Bools:
        """(M,) bool, whether it comes often enough to matter."""
        return self.coming >= LEAST_SHARE

    @property
    def allowed(self) -> float:
        """Share of others [1] that may leave beside the wanted one alone."""
        return self.allowed_beside(np.arange(len(self.orientations)) == self.wanted)

    def allowed_beside(self, same: Bools) -> float:
        """Return the share of others that may leave beside those that leave as wanted.

        With the share s of the wanted ones and the purity p it is s (1 / p - 1).

        Parameters
        ----------
        same : (M,) bool
            Which leave as wanted.

        Returns
        -------
        float [1]
        """
        return float(self.coming[same].sum() * (1.0 / self.purity - 1.0))


def design_task(
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted: int,
    margin: float,
    purity: float,
    before: Sequence[Device],
    turners: Sequence[Cut] = (),
    constraints: DesignConstraints | None = None,
) -> DesignTask:
    """Return what a design has to do behind the devices of the bowl and its own turning devices.

    Parameters
    ----------
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they come.
    wanted : int
    margin : float [m]
        To either side.
    purity : float [1]
        That is asked for.
    before : sequence of Device
        Of the bowl.
    turners : sequence of Cut, optional
        Of its own, before all others.
    constraints : DesignConstraints, optional

    Returns
    -------
    DesignTask
    """
    orientations = tuple(orientations)
    flow = course((*before, *(cut.device for cut in turners)), orientations)
    coming = (shares[:, None] * flow.leaving).sum(axis=0)[: len(orientations)]
    own = tuple(turners), constraints or DesignConstraints()
    return DesignTask(orientations, shares, wanted, margin, purity, tuple(before), coming, *own)


def weights(task: DesignTask) -> Floats:
    """Return how much it matters to return each orientation: those that come often enough first.

    Parameters
    ----------
    task : DesignTask

    Returns
    -------
    (M,) float [1]
    """
    weight = np.where(task.often, 1.0 + task.coming, 1e-3 * task.coming)
    weight = np.where(task.coming < NEGLIGIBLE_SHARE, 0.0, weight)
    return np.where(task.stays, weight, 0.0)


def propose(task: DesignTask, cuts: Sequence[Cut], is_returned: Bools, same: Bools | None = None) -> Design:
    """Return the record of a chain, by what all of its devices do with every orientation.

    Parameters
    ----------
    task : DesignTask
    cuts : sequence of Cut
        Without turning devices.
    is_returned : (M,) bool
        Which are returned by the margin.
    same : (M,) bool, optional
        Which leave like the wanted one, hanging; those of the task without it.

    Returns
    -------
    Design
    """
    orientations, shares, wanted = task.orientations, task.shares, task.wanted
    same = task.same if same is None else same
    cuts = _behind_rails((*task.turners, *_add_spacing(task, cuts)), orientations, wanted, same)
    flow = course((*task.before, *(cut.device for cut in cuts)), orientations)
    # what comes to stand at each
    first, names = 1 + len(task.before), [orientation.name for orientation in orientations]
    stands = flow.stops * (shares > 0.0)[:, None]
    cuts = tuple(
        replace(cut, stops=tuple(name for name, share in zip(names, stands[:, first + k]) if share > 0.0))
        for k, cut in enumerate(cuts)
    )
    states = sorted({flow.leaves_as(int(k)) for k in np.flatnonzero(task.same)})
    out = (shares[:, None] * flow.leaving).sum(axis=0)
    unsure = np.where(task.same | (flow.doubtful < MIN_ORIENTATION_SHARE), 0.0, shares * flow.doubtful)
    total, leaving, fed = shares.sum(), out.sum(), out[states].sum()
    hopeful, least = float(fed / leaving) if leaving > 0.0 else None, min(task.purity, ISOLATED_PURITY)
    remarks = []
    if hopeful is not None and hopeful < least:
        remarks = [f"only {100.0 * hopeful:.3g} % of what leaves is so"]
    impure = bool(remarks)
    becomes = flow.states[int(flow.leaving[wanted].argmax())].name
    if any(device.on_side for device in task.before) and flow.leaving[wanted].any() and not fed > 0.0:
        remarks.append(f"{orientations[wanted].name} leaves as {becomes}: ask for that one")
    against = np.array(names)[(unsure > 0.0) & task.often]
    if len(against):
        remarks.append(f"no verdict is sure to return {' '.join(against)}: the purity counts it as leaving")
    left = [k for k in np.flatnonzero(~is_returned & ~same) if task.often[k]]
    clean = not left or bool(task.coming[left].sum() <= task.allowed_beside(same))
    margins = [end for cut in cuts for end in (cut.margin_pass, cut.margin_reject) if np.isfinite(end)]
    # what lies still on its way: what is on a round side with nothing that holds it at the wall may roll,
    # what the drive tips may rock, and what it throws may come down otherwise
    loose = [
        one.returned
        or one.may_roll_back
        or one.may_tip
        or (one.kind == "rolling" and not one.groove and (one.track.bank <= 0.0 or one.along_a_bank))
        for one in orientations
    ]
    still = (np.where(loose, 0.0, shares) * flow.leaving[:, states].sum(axis=1)).sum()
    return Design(
        wanted=wanted,
        isolated=not (any(cut.stops for cut in cuts) or impure) and clean,
        before=task.before,
        cuts=cuts,
        margin=float(min(margins, default=np.nan)),
        efficiency=float(fed / total) if total > 0.0 else 0.0,
        purity=float(fed / (leaving + float(unsure.sum()))) if leaving > 0.0 else np.nan,
        hopeful=hopeful,
        least_purity=least,
        surely=float(still / total) if total > 0.0 else 0.0,
        left_over=tuple(
            state.name for k, state in enumerate(flow.states) if out[k] > 0.0 and k not in states
        ),
        inseparable=tuple((orientations[wanted], orientations[k], task.margin) for k in left),
        remarks=tuple(remarks),
        leaves_as=flow.states[flow.leaves_as(wanted)].name,
    )


def _add_spacing(task: DesignTask, cuts: Sequence[Cut]) -> tuple[Cut, ...]:
    """Cuts with a stretch that separates parts before the first of them that needs gaps."""
    steeper, own = task.constraints.spacing, task.orientations[task.wanted]
    first = next((k for k, cut in enumerate(cuts) if cut.device.gap(own, own.speed) > 0.0), None)
    if steeper is None or first is None or any(device.action.leans for device in task.before):
        return tuple(cuts)
    # before rails it climbs as it did: where it falls, a head that comes first has no time to turn down
    last = next((k for k, cut in enumerate(cuts) if cut.device.action is Action.HANG), len(cuts))
    slower = replace(steeper, angle=own.track.climb).rewritten()
    returning = (plain_cut(slower),) if last < len(cuts) else ()
    return (*cuts[:first], plain_cut(steeper), *cuts[first:last], *returning, *cuts[last:])


def plain_cut(device: Device) -> Cut:
    """Return a stretch of track as a Cut: it passes all.

    Parameters
    ----------
    device : Device

    Returns
    -------
    Cut
        Without margins.
    """
    return Cut(device, np.nan, np.nan, device, device, ())


def _behind_rails(
    cuts: Sequence[Cut], orientations: Sequence[Orientation], wanted: int, same: Bools
) -> tuple[Cut, ...]:
    """Cuts of which those behind rails have the margin of the part as it hangs there.

    Parts that lie have no number there, and what leaves hanging is returned by none of them.
    """
    judged: list[Cut] = []
    rails: Device | None = None
    own = {orientation.name for orientation, some in zip(orientations, same) if some}
    own.add(orientations[wanted].name)
    for cut in cuts:
        if rails is not None:
            margins = [cut.margin_pass]
            if verdict(rails, orientations[wanted], orientations).hangs:
                hung = hang(orientations[wanted], rails.span)
                margins.append(verdict(cut.device, hung, orientations).margin)
            known = [float(margin) for margin in margins if np.isfinite(margin) and margin > 0.0]
            passes = min(known, default=np.nan)
            returns = tuple(name for name in cut.returns if name not in own)
            cut = replace(cut, margin_pass=passes, returns=returns)
        rails = cut.device if cut.device.action is Action.HANG else rails
        judged.append(cut)
    return tuple(judged)


def propose_nothing(task: DesignTask, why: str) -> Design:
    """Return the record of an orientation that nothing isolates, and why.

    Parameters
    ----------
    task : DesignTask
    why : str
        The rest of a sentence that begins with its name.

    Returns
    -------
    Design
    """
    remark = f"{task.orientations[task.wanted].name} {why}"
    return Design(wanted=task.wanted, before=task.before, remarks=(remark,))


def propose_needed(
    task: DesignTask, cuts: Sequence[Cut], is_returned: Bools, same: Bools | None = None
) -> Design:
    """Return the record of a chain as ``propose`` does, without the devices that change nothing of it.

    Isolation, efficiency and purity [1] stay. The last ones are left out first: what drops parts stands
    before what has to clear itself or to see. Rails are what parts leave in, and stay.

    Parameters
    ----------
    task : DesignTask
    cuts : sequence of Cut
        Without turning devices.
    is_returned : (M,) bool
        Which are returned by the track and all devices, those of the bowl too.
    same : (M,) bool, optional
        As for ``propose``.

    Returns
    -------
    Design

    References
    ----------
    docs/tooling.md, "What a design takes".
    """

    def numbers(design: Design) -> Floats:
        hopeful = -1.0 if design.hopeful is None else design.hopeful
        return np.nan_to_num([design.efficiency, design.purity, hopeful], nan=-1.0)

    def stopped(design: Design) -> set[str]:
        return {name for cut in design.cuts for name in cut.stops}

    cuts, proposal = list(cuts), propose(task, cuts, is_returned, same)
    # which orientations each cut returns by the margin
    returned_by = {id(cut): margins_at(cut.device, task.orientations) <= -task.margin for cut in cuts}
    gone = is_returned & ~np.any(list(returned_by.values()), axis=0) if cuts else is_returned
    for cut in [cut for cut in reversed(cuts) if cut.device.action is not Action.HANG]:
        rest = [other for other in cuts if other is not cut]
        other = propose(task, rest, np.any([gone, *(returned_by[id(one)] for one in rest)], axis=0), same)
        alike = (np.abs(numbers(other) - numbers(proposal)) < PRINTED_SHARE_STEP).all()
        if alike and other.isolated >= proposal.isolated and stopped(other) <= stopped(proposal):
            cuts, proposal = rest, other
    return proposal
