"""What a design of tooling says, from what the whole chain does with every orientation."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating import chain
from feederscrew.tooling.isolating.chain import Cut, DesignConstraints
from feederscrew.tooling.orientations import Orientation

LEAST_SHARE = 5e-3  # [1] orientations that come less often need not be returned
ISOLATED_PURITY = 0.98  # [1] of what leaves, from which an orientation is said to be isolated
MIN_ORIENTATION_SHARE = 1e-9  # [1] of an orientation: less comes of rounding
NEGLIGIBLE_SHARE = 1e-4  # [1] those that come less often change no number: no device is added for them
PRINTED_SHARE_STEP = 1e-4  # [1] shares that differ by less are printed alike


@dataclass(frozen=True, eq=False)
class Design:
    """What isolates one orientation, and what it does not."""

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
    least_purity: float = ISOLATED_PURITY  # [1] from which it is said to isolate
    surely: float = 0.0  # [1] of the efficiency, what does not roll or rock on its way: the least of it
    steady: bool = True  # the drive leaves the wanted orientation lying on what the cuts leave of its foot

    @cached_property
    def reasons(self) -> tuple[str, ...]:
        """Why, a sentence each: worked out when it is asked for, which of most proposals it never is."""
        stops = (
            f"{' '.join(cut.stops)} come to stand at the {cut.device.name}" for cut in self.cuts if cut.stops
        )
        return (*stops, *(chain.inseparable_reason(*pair) for pair in self.inseparable), *self.remarks)

    @property
    def purity_is_least(self) -> bool:
        """Whether the purity counts as leaving what no verdict is sure to return."""
        return self.hopeful is not None and self.hopeful > self.purity

    @property
    def least(self) -> float:
        """The least of the efficiency [1] that the static rule is sure of."""
        return min(self.surely, self.efficiency)

    @property
    def stands(self) -> bool:
        """Whether some orientation comes to stand at one of its devices."""
        return any(cut.stops for cut in self.cuts)

    @property
    def devices(self) -> tuple[Device, ...]:
        """Every device along the track: those of the bowl, then the design's own."""
        return (*self.before, *(cut.device for cut in self.cuts))


@dataclass(frozen=True)
class Goal:
    """How much of what a design has to reach is enough."""

    purity: float = 1.0  # [1] of what leaves; the chain is not made longer for more
    efficiency: float = 0.0  # [1] of what is offered: as long as it is missed, ways on are tried


ALL = Goal()


@dataclass(frozen=True, eq=False)
class DesignTask:
    """One orientation to be isolated behind some devices; M orientations."""

    orientations: tuple  # of Orientation
    shares: np.ndarray  # (M,) [1] probability of each
    wanted: int
    margin: float  # [m] to either side
    purity: float  # [1] of what leaves, that is enough
    before: tuple[Device, ...]  # of the bowl
    coming: np.ndarray  # (M,) [1] share that comes to the design lying so
    turners: tuple[Cut, ...] = ()  # turning devices of the design, before all that return
    constraints: DesignConstraints = field(default_factory=DesignConstraints)  # what it may use

    @property
    def stays(self) -> np.ndarray:
        """(M,) bool, whether the bare track carries it."""
        return np.array([not orientation.returned for orientation in self.orientations])

    @property
    def same(self) -> np.ndarray:
        """(M,) bool, which count as the wanted one: itself, and what lies on an aspect that may be up too."""
        up = {name.casefold() for name in self.constraints.up}
        equal = np.array([orientation.aspect.casefold() in up for orientation in self.orientations])
        return equal | (np.arange(len(self.orientations)) == self.wanted)

    @property
    def often(self) -> np.ndarray:
        """(M,) bool, whether it comes often enough to matter."""
        return self.coming >= LEAST_SHARE

    @property
    def allowed(self) -> float:
        """Share of others [1] that may leave beside the wanted one alone."""
        return self.allowed_beside(np.arange(len(self.orientations)) == self.wanted)

    def allowed_beside(self, same) -> float:
        """Return the share of others [1] that may leave beside those (M,) bool that leave as wanted."""
        return float(self.coming[same].sum() * (1.0 / self.purity - 1.0))


def design_task(
    orientations, shares, wanted, margin, purity, before, turners=(), constraints=None
) -> DesignTask:
    """Return what a design has to do behind the devices of the bowl and its own turning devices."""
    orientations = tuple(orientations)
    flow = course((*before, *(cut.device for cut in turners)), orientations)
    coming = (shares[:, None] * flow.leaving).sum(axis=0)[: len(orientations)]
    own = tuple(turners), constraints or DesignConstraints()
    return DesignTask(orientations, shares, wanted, margin, purity, tuple(before), coming, *own)


def weights(task) -> np.ndarray:
    """Return how much it matters to return each orientation, (M,) [1]: those that come often enough first."""
    weight = np.where(task.often, 1.0 + task.coming, 1e-3 * task.coming)
    weight = np.where(task.coming < NEGLIGIBLE_SHARE, 0.0, weight)
    return np.where(task.stays, weight, 0.0)


def propose(task, cuts, returned, same=None) -> Design:
    """Return the record of a chain, by what all of its devices do with every orientation.

    Parameters
    ----------
    task : DesignTask
    cuts : sequence of Cut
        Without turning devices.
    returned : (M,) bool
        Which are returned by the margin.
    same : (M,) bool, optional
        Which leave like the wanted one, hanging; only itself without it.
    """
    orientations, shares, wanted = task.orientations, task.shares, task.wanted
    same = task.same if same is None else same
    cuts = (*task.turners, *_separated(task, cuts))
    flow = course((*task.before, *(cut.device for cut in cuts)), orientations)
    # what comes to stand at each
    first, names = 1 + len(task.before), [orientation.name for orientation in orientations]
    stands = flow.stops * (shares > 0.0)[:, None]
    cuts = tuple(
        replace(cut, stops=tuple(name for name, share in zip(names, stands[:, first + k]) if share > 0.0))
        for k, cut in enumerate(cuts)
    )
    states = sorted({flow.leaves_as(k) for k in np.flatnonzero(task.same)})
    out = (shares[:, None] * flow.leaving).sum(axis=0)
    unsure = np.where(task.same | (flow.doubtful < MIN_ORIENTATION_SHARE), 0.0, shares * flow.doubtful)
    total, leaving, fed = shares.sum(), out.sum(), out[states].sum()
    hopeful, least = float(fed / leaving) if leaving > 0.0 else None, min(task.purity, ISOLATED_PURITY)
    remarks = []
    if hopeful is not None and hopeful < least:
        remarks = [f"only {100.0 * hopeful:.3g} % of what leaves is so"]
    impure = bool(remarks)
    against = np.array(names)[(unsure > 0.0) & task.often]
    if len(against):
        remarks.append(f"no verdict is sure to return {' '.join(against)}: the purity counts it as leaving")
    left = [k for k in np.flatnonzero(~returned & ~same) if task.often[k]]
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
    )


def _separated(task, cuts) -> tuple[Cut, ...]:
    """Cuts with a stretch that separates parts before the first of them that needs gaps.

    Before rails the track climbs as it did: where it falls, a head that comes first has no time to turn down.
    """
    steeper, own = task.constraints.separation, task.orientations[task.wanted]
    first = next((k for k, cut in enumerate(cuts) if cut.device.gap(own, own.speed) > 0.0), None)
    if steeper is None or first is None or any(device.leans for device in task.before):
        return tuple(cuts)
    last = next((k for k, cut in enumerate(cuts) if cut.device.hangs), len(cuts))
    slower = replace(steeper, angle=own.track.climb).rewritten()
    returning = (plain_cut(slower),) if last < len(cuts) else ()
    return (*cuts[:first], plain_cut(steeper), *cuts[first:last], *returning, *cuts[last:])


def plain_cut(device) -> Cut:
    """Return a stretch of track as a Cut: it passes all."""
    return Cut(device, np.nan, np.nan, device, device, ())


def without_device(task, why) -> Design:
    """Return the record of an orientation that nothing isolates, and why."""
    remark = f"{task.orientations[task.wanted].name} {why}"
    return Design(wanted=task.wanted, before=task.before, remarks=(remark,))


def propose_needed(task, cuts, returned, same=None) -> Design:
    """Return the record of a chain as ``propose`` does, without the devices that change nothing of it.

    It has as many of the cuts as it takes to keep what is isolated, efficiency and purity. The last ones are
    left out first: what drops parts stands before what has to clear itself or to see. Rails are what parts
    leave in, and stay. ``returned`` (M,) bool is by the track and the devices of the bowl too.

    Source: own; docs/tooling.md, "What a design takes".
    """
    cuts, proposal = list(cuts), propose(task, cuts, returned, same)
    # which orientations each cut returns by the margin
    by = {id(cut): chain.margins_at(cut.device, task.orientations) <= -task.margin for cut in cuts}
    gone = returned & ~np.any(list(by.values()), axis=0) if cuts else returned
    for cut in [cut for cut in reversed(cuts) if not cut.device.hangs]:
        rest = [other for other in cuts if other is not cut]
        other = propose(task, rest, np.any([gone, *(by[id(one)] for one in rest)], axis=0), same)
        if _same_numbers(other, proposal):
            cuts, proposal = rest, other
    return proposal


def _same_numbers(design, other) -> bool:
    """Whether a design says the same of what leaves as another, and no more stands in it."""
    first, second = (
        np.nan_to_num([k.efficiency, k.purity, -1.0 if k.hopeful is None else k.hopeful], nan=-1.0)
        for k in (design, other)
    )
    stands, others = ({name for cut in k.cuts for name in cut.stops} for k in (design, other))
    alike = bool((np.abs(first - second) < PRINTED_SHARE_STEP).all())
    return design.isolated >= other.isolated and alike and stands <= others
