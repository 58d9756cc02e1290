"""What a design of tooling says, from what the whole chain does with every orientation."""

from dataclasses import dataclass, field, replace

import numpy as np

from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating import apart
from feederscrew.tooling.isolating.chain import Cut, Wishes

LEAST_SHARE = 5e-3  # [1] orientations that come less often need not be returned
ISOLATED_PURITY = 0.98  # [1] of what leaves, from which an orientation is said to be isolated
SLIGHT = 1e-9  # [1] of an orientation: less comes of rounding
NEVER = 1e-4  # [1] those that come less often change no number: no device is added for them


@dataclass(frozen=True, eq=False)
class Design:
    """What isolates one orientation, and what it does not."""

    wanted: int  # its place among the orientations
    isolated: bool  # all others that come often enough are returned, to either side by the margin
    before: tuple[Device, ...]  # devices of the bowl itself, which parts meet first
    cuts: tuple[Cut, ...]  # in the order parts meet them
    margin: float  # [m] the least, of passing and of returning; NaN without any device
    efficiency: float  # [1] share of the parts offered that leave in this orientation
    purity: float  # [1] share of what leaves, or is not sure to be returned, that is in this orientation
    left_over: tuple[str, ...]  # what leaves as well
    reasons: tuple[str, ...]  # why, a sentence each
    late: bool = False  # the time limit stopped the search: another machine may find more
    # [1] purity where a trial confirms what is not sure to be returned; None where nothing leaves
    hopeful: float | None = None
    width: float | None = None  # [m] of the track, where it is another than the bowl's
    least_purity: float = ISOLATED_PURITY  # [1] from which it is said to isolate
    surely: float = 0.0  # [1] of the efficiency, what does not roll or rock on its way: the least of it
    steady: bool = True  # the drive leaves the wanted orientation lying on what the cuts leave of its foot

    @property
    def purity_is_least(self):
        """Whether the purity counts as leaving what no verdict is sure to return."""
        return self.hopeful is not None and self.hopeful > self.purity

    @property
    def least(self):
        """The least of the efficiency [1] that the static rule is sure of."""
        return min(self.surely, self.efficiency)

    @property
    def stands(self):
        """Whether some orientation comes to stand at one of its devices."""
        return any(cut.stops for cut in self.cuts)

    @property
    def devices(self):
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

    every: tuple  # of Orientation
    shares: np.ndarray  # (M,) [1] probability of each
    wanted: int
    margin: float  # [m] to either side
    purity: float  # [1] of what leaves, that is enough
    before: tuple[Device, ...]  # of the bowl
    coming: np.ndarray  # (M,) [1] share that comes to the design lying so
    turners: tuple[Cut, ...] = ()  # turning devices of the design, before all that return
    wishes: Wishes = field(default_factory=Wishes)  # what it may use

    @property
    def stays(self):
        """(M,) bool, whether the bare track carries it."""
        return np.array([not one.returned for one in self.every])

    @property
    def same(self):
        """(M,) bool, which count as the wanted one: itself, and what lies on an aspect that may be up too."""
        up = {name.casefold() for name in self.wishes.up}
        alike = np.array([one.aspect.casefold() in up for one in self.every])
        return alike | (np.arange(len(self.every)) == self.wanted)

    @property
    def often(self):
        """(M,) bool, whether it comes often enough to matter."""
        return self.coming >= LEAST_SHARE

    @property
    def allowed(self):
        """Share of others [1] that may leave beside the wanted one alone."""
        return self.allowed_beside(np.arange(len(self.every)) == self.wanted)

    def allowed_beside(self, same):
        """Return the share of others [1] that may leave beside those (M,) bool that leave as wanted."""
        return float(self.coming[same].sum() * (1.0 / self.purity - 1.0))


def task(every, shares, wanted, margin, purity, before, turners=(), wishes=None):
    """Return what a design has to do behind the devices of the bowl and its own turning devices."""
    every = tuple(every)
    flow = course((*before, *(cut.device for cut in turners)), every)
    coming = (shares[:, None] * flow.leaving).sum(axis=0)[: len(every)]
    own = tuple(turners), wishes or Wishes()
    return DesignTask(every, shares, wanted, margin, purity, tuple(before), coming, *own)


def weights(given):
    """Return how much it matters to return each orientation, (M,) [1]: those that come often enough first."""
    weight = np.where(given.often, 1.0 + given.coming, 1e-3 * given.coming)
    weight = np.where(given.coming < NEVER, 0.0, weight)
    return np.where(given.stays, weight, 0.0)


def told(given, cuts, returned, same=None, late=False):
    """Return the record of a chain, by what all of its devices do with every orientation.

    Parameters
    ----------
    given : DesignTask
    cuts : sequence of Cut
        Without turning devices.
    returned : (M,) bool
        Which are returned by the margin.
    same : (M,) bool, optional
        Which leave like the wanted one, hanging; only itself without it.
    late : bool
        Whether the time limit stopped the search.

    Returns
    -------
    Design
    """
    every, shares, wanted = given.every, given.shares, given.wanted
    same = given.same if same is None else same
    cuts = (*given.turners, *_separated(given, cuts))
    flow = course((*given.before, *(cut.device for cut in cuts)), every)
    states = sorted({flow.leaves_as(k) for k in np.flatnonzero(given.same)})
    out = (shares[:, None] * flow.leaving).sum(axis=0)
    unsure = np.where(given.same | (flow.doubtful < SLIGHT), 0.0, shares * flow.doubtful)
    doubt = float(unsure.sum())  # may leave as well: no trial has said
    total, leaving = shares.sum(), out.sum()
    cuts = _with_stops(given, flow, cuts)
    hopeful = float(out[states].sum() / leaving) if leaving > 0.0 else None
    least = min(given.purity, ISOLATED_PURITY)
    impure = (
        [f"only {100.0 * hopeful:.3g} % of what leaves is so"]
        if hopeful is not None and hopeful < least
        else []
    )
    stands = any(cut.stops for cut in cuts)
    left = [k for k in np.flatnonzero(~returned & ~same) if given.often[k]]
    rest = given.coming[left].sum()
    margins = [end for cut in cuts for end in (cut.margin_pass, cut.margin_reject) if np.isfinite(end)]
    return Design(
        wanted=wanted,
        isolated=not (stands or impure) and (not left or bool(rest <= given.allowed_beside(same))),
        before=given.before,
        cuts=cuts,
        margin=float(min(margins, default=np.nan)),
        efficiency=float(out[states].sum() / total) if total > 0.0 else 0.0,
        purity=float(out[states].sum() / (leaving + doubt)) if leaving > 0.0 else np.nan,
        hopeful=hopeful,
        least_purity=least,
        surely=_surely(given, flow, states),
        left_over=tuple(one.name for k, one in enumerate(flow.states) if out[k] > 0.0 and k not in states),
        reasons=(
            *(f"{' '.join(cut.stops)} come to stand at the {cut.device.name}" for cut in cuts if cut.stops),
            *(apart.reason(every[wanted], every[k], given.margin) for k in left),
            *impure,
            *_against(np.array([one.name for one in every])[(unsure > 0.0) & given.often]),
        ),
        late=late,
    )


def _surely(given, flow, states):
    """Share of the parts offered [1] that leaves as wanted and lies still on its way: the least of it.

    What is on a round side with nothing that holds it at the wall may roll, what the drive tips may rock, and
    what it throws may come down otherwise.
    """
    total = given.shares.sum()
    loose = [
        one.returned
        or one.may_roll_back
        or one.may_tip
        or (one.kind == "rolling" and not one.groove and (one.track.bank <= 0.0 or one.along_a_bank))
        for one in given.every
    ]
    share = np.where(loose, 0.0, given.shares) * flow.leaving[:, states].sum(axis=1)
    return float(share.sum() / total) if total > 0.0 else 0.0


def _against(names):
    """What the purity counts as leaving though the devices reject it."""
    return (
        [f"no verdict is sure to return {' '.join(names)}: the purity counts it as leaving"]
        if len(names)
        else []
    )


def _separated(given, cuts):
    """Cuts with a stretch that separates parts before the first of them that needs gaps.

    Before rails the track climbs as it did: where it falls, a head that comes first has no time to turn down.
    """
    steeper, one = given.wishes.separation, given.every[given.wanted]
    first = next((k for k, cut in enumerate(cuts) if cut.device.gap(one, one.speed) > 0.0), None)
    if steeper is None or first is None or any(device.leans for device in given.before):
        return tuple(cuts)
    climb = one.track.climb
    slower = replace(steeper, angle=climb).rewritten()
    last = next((k for k, cut in enumerate(cuts) if cut.device.hangs), len(cuts))
    back = (plain_cut(slower),) if last < len(cuts) else ()
    return (*cuts[:first], plain_cut(steeper), *cuts[first:last], *back, *cuts[last:])


def plain_cut(device):
    """Return a stretch of track as a Cut: it passes all."""
    return Cut(device, np.nan, np.nan, device, device, ())


def _with_stops(given, flow, cuts):
    """Cuts with the names of those that come to stand at each."""
    first, names = 1 + len(given.before), [one.name for one in given.every]
    stands = flow.stops * (given.shares > 0.0)[:, None]
    return tuple(
        replace(cut, stops=tuple(name for name, share in zip(names, stands[:, first + k]) if share > 0.0))
        for k, cut in enumerate(cuts)
    )


def without(given, why):
    """Return the record of an orientation that nothing isolates, and why."""
    return Design(
        wanted=given.wanted,
        isolated=False,
        before=given.before,
        cuts=(),
        margin=np.nan,
        efficiency=0.0,
        purity=np.nan,
        left_over=(),
        reasons=(f"{given.every[given.wanted].name} {why}",),
    )
