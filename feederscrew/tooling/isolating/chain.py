"""The fewest devices of one number that let one orientation pass and return the others, in lengths of a shop;
and why two orientations cannot be separated, and what change of the part would help.
"""

import functools
import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from feederscrew import check
from feederscrew.mechanics import sameness
from feederscrew.tooling.devices.base import STOPPED, UNSURE, Device
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.falling import surely_gone
from feederscrew.tooling.verdicts import DeviceEncounter, opening_margin, verdict

SHOP_STEP_M = 5e-5  # [m] of values that a shop makes
SHOP_ROUNDING_M = 1e-7  # [m] to which a value is rounded
DESIGN_KEY = "design"
CUT_BISECTIONS = 10  # of the way from the value nearest to the wanted orientation to the middle
HULL_FIT_ROUNDS = 4  # of the fit of one hull over the other
SIDE_NAMES = (("ahead", "behind"), ("on the inner side", "at the wall"), ("on top", "at the bottom"))


def snap_to_shop_step(value, step, up) -> float:
    """Return the nearest multiple of a step [m] that is not below a value, or not above it."""
    count = value / step
    return float((np.ceil(count - 1e-6) if up else np.floor(count + 1e-6)) * step)


def in_mm(value) -> str:
    """Return a length [m] as a bowl file has it: '9.25 mm'."""
    return f"{1e3 * round_finely(value):.9g} mm"


def round_finely(value) -> float:
    """Return a length [m] rounded to what a bowl file says of it."""
    return float(np.round(value / SHOP_ROUNDING_M)) * SHOP_ROUNDING_M


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


@dataclass(frozen=True)
class DesignConstraints:
    """What a design may use, and how finely it is made."""

    outcome: str = "any"  # how parts leave: 'lying', 'hanging' or 'any'
    without: tuple[str, ...] = ()  # kinds of devices that are not used
    step: float = SHOP_STEP_M  # [m] a shop makes: values are whole multiples
    up: tuple[str, ...] = ()  # aspects that count as the one wanted
    cutter: float = 0.0  # [m] radius that corners of holes are rounded to
    separation: Device | None = None  # that comes before a device that needs gaps
    vary: bool = True  # other tracks and sweeps are tried where they give more
    gentle: bool = False  # cuts take no more of the wanted orientation's foot than they must
    turn: bool = False  # devices that turn parts over, where returning them wastes too much
    air: bool = False  # air that blows all the time, where cuts and blades are not enough
    isolating: bool = False  # a chain that does not isolate is of no use: none is looked for where none can

    def allows(self, *kinds) -> bool:
        """Return whether some kinds of devices may all be used."""
        return not set(kinds) & set(self.without)

    @property
    def sensed(self) -> bool:
        """Whether a sensor may be used."""
        return any(self.allows(kind.kind) for kind in values_around())

    @property
    def clearing(self) -> bool:
        """Whether a blade that clears itself may be used."""
        return any(self.allows(kind.kind) for kind in numbered() if kind.overhead)


# -- the devices that may do it


def candidates(
    orientations, wanted, margin, constraints=None, *, clearing=True, air=False, sensed=False, same=()
) -> dict[Device, np.ndarray]:
    """Return every device of one number that the wanted orientation passes by a margin.

    Source: own; docs/tooling.md, "1. The method".

    Each with its value at which it returns the most, and the margins (M,) [m] of the orientations at it; NaN
    of one that would come to stand there. What drops parts comes first, then what clears itself. ``wanted``
    is a place among the orientations; those of the places ``same`` count as it: a device of one number lets
    all of them pass. ``clearing``, ``air`` and ``sensed`` say whether what has to clear itself, air that
    blows all the time, and what sees, is tried beside what drops parts.
    """
    devices: list[Device] = []
    constraints = constraints or DesignConstraints()
    for kind in numbered():
        values, lower = limits(kind, orientations), kind.bound == "lower"
        first = pivot(kind, orientations, wanted, same)
        allowed = constraints.allows(kind.kind) and (clearing or not kind.overhead)
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
    blowing: list[Any] = [
        kind for kind in KINDS.values() if kind.proposed and not (kind.senses or kind.bound)
    ]
    for kind in blowing if air else ():
        devices += kind.proposals([encounters[k] for k in rows], competitors, orientations, DESIGN_KEY)

    def unlike(view) -> list[Any]:
        equals = [encounters[k] for k in same if k != wanted]
        return [one.orientation for one in equals if one.differs(orientations[wanted], view) > margin]

    for kind in values_around() if sensed else ():
        if constraints.allows(kind.kind):
            devices += kind.around(encounters[wanted], margin, DESIGN_KEY, unlike)
    return {device: margins_at(device, orientations) for device in devices}


def pivot(kind, orientations, wanted, same=()) -> int:
    """Return which of those that count as the wanted one a device of one number lets pass last."""
    values = limits(kind, orientations)
    rows = sorted({wanted, *same}, key=lambda k: k != wanted)
    return (max if kind.bound == "upper" else min)(rows, key=lambda k: values[k])


def values_around() -> list[Any]:
    """Return the kinds that a design tries with the wanted orientation's own outline."""
    return [kind for kind in KINDS.values() if kind.proposed and kind.senses]


def numbered() -> list[Any]:
    """Return the kinds of one number that a design tries, in the order of their ranks: drops first."""
    kinds = [kind for kind in KINDS.values() if kind.proposed and kind.bound]
    return sorted(kinds, key=lambda kind: kind.rank)


def limits(kind, orientations) -> np.ndarray:
    """Return the value [m] of a device of one number that each orientation just passes, (M,).

    Source: own; docs/tooling.md, "1. The method".
    """
    return np.array([kind.needed(orientation) for orientation in orientations])


def margin_at(device, orientation, orientations) -> float:
    """Return the margin [m] of an orientation at a device; NaN of one that would come to stand there.

    None, a hair below 0, of one that travels and may be held there, though it is not supported.
    """
    margin = verdict(device, orientation, orientations).margin
    if not margin < 0.0:
        return margin
    if device.fate(DeviceEncounter(orientation, orientations)) == STOPPED:
        return np.nan
    return margin if orientation.grip <= 0.0 or surely_gone(device, orientation) else max(margin, -UNSURE)


def margins_at(device, orientations) -> np.ndarray:
    """Return the same of all orientations, (M,) [m]."""
    return _margins_at(device, tuple(orientations))


@functools.lru_cache(maxsize=2048)
def _margins_at(device, orientations) -> np.ndarray:
    """The same, remembered: designs of one cost class after the other try a device again."""
    return check.frozen(np.array([margin_at(device, one, orientations) for one in orientations]))


# -- the fewest of them


def fewest(margins, competitors, margin, enough=0.0) -> tuple[Device, ...]:
    """Return the fewest devices, in the order of ``candidates``, that return the most of some orientations.

    Source: own; docs/tooling.md, "1. The method".

    ``margins`` are from ``candidates``; ``competitors`` (M,) [1] is how much each of the orientations to be
    returned weighs, 0 for those that need not be; a chain that leaves no more than ``enough`` [1] over is not
    made longer.
    """
    best: tuple[Device, ...] = ()
    weight, total = 0.0, float(competitors.sum())
    devices = [device for device, some in margins.items() if competitors[some <= -margin].any()]
    for count in range(1, len(devices) + 1):
        if total - weight <= enough:
            break
        for chosen in itertools.combinations(devices, count):
            returned = np.any([margins[device] <= -margin for device in chosen], axis=0)
            held = float(competitors[returned].sum())
            if held > weight + 1e-12 and not jams(margins, chosen, competitors, margin):
                best, weight = chosen, held
    return best


def jams(margins, chosen, competitors, margin) -> bool:
    """Return whether an orientation that weighs comes to stand at a device, not returned before it."""
    gone = np.asarray(competitors) <= 0.0
    for device in chosen:
        if np.any(np.isnan(margins[device]) & ~gone):
            return True
        gone = gone | (margins[device] <= -margin)
    return False


def place_devices(
    orientations, wanted, devices, must, least=np.inf, step=SHOP_ROUNDING_M, same=()
) -> tuple[Cut, ...]:
    """Return the cuts of a chain, each value in the middle of what it may be.

    Source: own; docs/tooling.md, "5. Where it ends".

    ``must`` says of each device which orientations (M,) bool it has to return; what leaves less of a foot
    returns them by no more than ``least`` [m]: the wanted one has the rest. Values are whole multiples of
    ``step`` [m]; ``same`` as for ``candidates``.
    """
    cuts = []
    for device, some in zip(devices, must):
        row = pivot(type(device), orientations, wanted, same) if device.bound else wanted
        place = _place_sensor if device.senses else _place_number
        free = device.senses or device.bound
        cut = place(orientations, row, device, some, least, step) if free else None
        cuts.append(cut or judge_cut(orientations, row, device, some, device, device))
    return tuple(cuts)


def shared_out(margins, devices, margin) -> list[np.ndarray]:
    """Return for each device (M,) which orientations it has to return: those that none before it does."""
    left, out = np.ones(len(next(iter(margins.values()))), dtype=bool), []
    for device in devices:
        out.append(left & (margins[device] <= -margin))
        left &= ~out[-1]
    return out


def _place_number(orientations, wanted, device, must, least, step) -> Cut:
    values, upper = limits(type(device), orientations), device.bound == "upper"
    # by how much more than placed each of the others passes it as it travels
    more = np.array([device.more(DeviceEncounter(orientation)) for orientation in orientations])
    values = values + np.where(np.arange(len(orientations)) == wanted, 0.0, more)
    nearest = (values[must].min() if upper else values[must].max()) if must.any() else values[wanted]
    middle = float(0.5 * (values[wanted] + nearest))

    def at(value) -> Device:
        value = snap_to_shop_step(value, step, up=not upper) if step > SHOP_ROUNDING_M else value
        return device.valued(round_finely(value))

    chosen = _surest(orientations, must, at, middle if np.isfinite(nearest) else device.limit, device.limit)
    if device.carries and least < np.inf and np.isfinite(nearest):
        eased = max(chosen.limit, nearest - least) if upper else min(chosen.limit, nearest + least)
        chosen = _surest(orientations, must, at, float(eased), chosen.limit, least - 2.0 * SHOP_ROUNDING_M)
    ends = [device.valued(float(end)) for end in (nearest, values[wanted])]
    return judge_cut(orientations, wanted, chosen, must, *ends)


def _place_sensor(orientations, wanted, device, must, least, step) -> Cut:
    play = device.like[2]
    seen = [device.differs(DeviceEncounter(orientation, orientations)) for orientation in orientations]
    widest = min((differs for differs, some in zip(seen, must) if some), default=2.0 * play)

    def at(value) -> Device:
        return device.with_play(round_finely(max(snap_to_shop_step(value, step, up=False), play)))

    chosen = _surest(orientations, must, at, 0.5 * (seen[wanted] + widest), play)
    return judge_cut(orientations, wanted, chosen, must, at(widest), at(play))


def _surest(orientations, must, at, middle, near, by=UNSURE) -> Device:
    """The device of a value midway, or as near to that as it still returns what it has to, by a margin."""
    others = [orientation for orientation, some in zip(orientations, must) if some]

    def returns(device) -> bool:
        return all(margin_at(device, orientation, orientations) < -by for orientation in others)

    if returns(at(middle)):
        return at(middle)
    for _ in range(CUT_BISECTIONS):
        half = 0.5 * (near + middle)
        near, middle = (half, middle) if returns(at(half)) else (near, half)
    return at(near)


def judge_cut(orientations, wanted, device, must, smallest, largest) -> Cut:
    """Return a device as a Cut, with its true margins and what it returns."""
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


@dataclass(frozen=True)
class Difference:
    """How two orientations differ as they lie on the track."""

    shape: float  # [m] greatest distance between their hulls, laid over each other as well as can be
    side: str  # where that is
    shift: tuple[float, float, float]  # [m] of the centre of mass within the hull: ahead, inwards, up


def inseparable_reason(wanted, other, margin) -> str:
    """Return in one sentence why a chain leaves another Orientation, and the smallest change that helps.

    ``margin`` [m] is what is asked for on either side.
    """
    names = f"{wanted.name} and {other.name}"
    if wanted.mirror == other.name:
        return (
            f"{names} are mirror images fore and aft: no device of one number parts "
            f"them and no hole was found; a feature on one side only would, of {2e3 * margin:.2g} mm or more"
        )
    difference, need = find_difference(wanted, other), _smallest_change(wanted, other, margin)
    if difference.shape < min(margin, 0.5 * max(map(abs, difference.shift))):
        ahead, inwards, up = (1e3 * abs(by) for by in difference.shift)
        return (
            f"{names} have the same outside to {1e3 * max(difference.shape, 1e-5):.2f} mm, "
            f"only the inside differs, as by a bore off the middle or a closed end: the centre of mass lies "
            f"elsewhere by {ahead:.2f} mm along the track, {inwards:.2f} mm across it and {up:.2f} mm in "
            f"height; needs a feature on the outside; {need}"
        )
    if difference.shape < 4.0 * margin:
        return (
            f"{names} differ by {1e3 * difference.shape:.2g} mm at most, {difference.side}, as by a chamfer "
            f"or a rounding; {need}"
        )
    lower = other.height <= wanted.height + margin and other.width <= wanted.width + 2.0 * margin
    if lower and stands_on_all(other, wanted, margin):
        return (
            f"whatever carries {wanted.name} carries {other.name}, which stands on a larger foot and is no "
            f"higher or wider: only turning it over helps; {need}"
        )
    return (
        f"{names} differ by {1e3 * difference.shape:.2g} mm {difference.side}, which no device of one "
        f"number, gate or hole that was tried can use; {need}"
    )


def _smallest_change(wanted, other, margin) -> str:
    """In words, the least [m] that has to be added to what some device measures of a part."""
    differences = [
        (-opening_margin(wanted.view_ahead, other), kind.kind, kind.feature)
        for kind in KINDS.values()
        if hasattr(kind, "free")
    ]
    for kind in numbered():
        first, second = limits(kind, (wanted, other))
        step = second - first if kind.bound == "upper" else first - second
        differences.append((float(step) if np.isfinite(step) else -np.inf, kind.kind, kind.feature))
    step, _, feature = max(differences)
    step = max(step, 0.0)
    if step >= 2.0 * margin:
        return f"{feature} differs by {1e3 * step:.2g} mm, but no chain that was tried can use it"
    return f"{1e3 * (2.0 * margin - step):.2g} mm more in {feature} would part them"


def stands_on_all(orientation, other, margin) -> bool:
    """Return whether one orientation stands on all that another stands on: no hole lets it fall alone."""
    foot, within = (shapely.MultiPoint(k.foot.corners).convex_hull for k in (orientation, other))
    near = abs(orientation.distance - other.distance) < 2.0 * margin
    return bool(near and foot.buffer(margin).covers(within))


def find_difference(wanted, other) -> Difference:
    """Return how two Orientations differ as they lie on the track."""
    first, second = (
        sameness.looks(o.posture, [o.heading])[0][0, 0] * np.ptp(o.posture.corners, axis=0).max()
        for o in (wanted, other)
    )
    away, there, shift = first - second, sameness.directions(), np.zeros(3)
    for _ in range(HULL_FIT_ROUNDS):  # least squares: the directions are spread evenly
        left = away - (there * shift).sum(axis=1)
        shift = shift + 3.0 * (there * left[:, None]).mean(axis=0)
    left = np.abs(away - (there * shift).sum(axis=1))
    where = there[int(np.argmax(np.round(left, 9)))]
    axis = int(np.argmax(np.abs(where)))
    x, y, z = map(float, shift)
    return Difference(float(left.max()), SIDE_NAMES[axis][int(where[axis] < 0.0)], (x, y, z))
