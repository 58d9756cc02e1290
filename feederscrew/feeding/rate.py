"""The study of ``feeder rate``: well-oriented parts per minute of one part from one bowl."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.arrivals.entry import Shares, check_wanted, shares, the_shares
from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column, Frame, of_arrays
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Path, Quantity, former_keywords
from feederscrew.bowl.device_list import shank_remarks, unknown_aspects
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.feeding import stream, well_oriented
from feederscrew.feeding.stream import orientation_columns
from feederscrew.motion import hop
from feederscrew.motion.conveying import speed_remark
from feederscrew.part.record import Part, refuse_many_facets, small_part_remarks
from feederscrew.resting import profiles
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER as RECOMMENDED
from feederscrew.resting.rules.registry import require_rule
from feederscrew.sorting.device_passages import Passage, until_returned
from feederscrew.sorting.isolating.design import PLAY_M, TOLERANCE_M
from feederscrew.sorting.orientations import Orientation, orientations
from feederscrew.sorting.tipping import marked

EQUAL_SHARE_RATIO = 1.0 - 1e-9  # of the most frequent orientation: as frequent
MIN_POSITIVE = 1e-6  # of what must be above 0
LEAST_CARRIED_SHARE = 0.05  # [1] of the parts: a rate of fewer asks for twenty times as many at the entry


@dataclass(frozen=True, eq=False)
class RateStudy(ReadableRecord, view="rate.RATE_VIEW"):
    """The rate of one orientation, and the chain of factors behind it."""

    part: Part
    bowl: Bowl
    aspects: Aspects
    devices: tuple[Device, ...]  # in the order parts meet them
    rule: str  # whose probabilities are taken
    rate: well_oriented.Rate
    measured: profiles.CountFile | None = None  # the counts that are taken, if they are
    sigma: float = 0.0  # [m] of play and tolerance together
    as_tried: bool = False  # whether a trial has run these devices at this drive

    @property
    def of_size(self) -> tuple[str, ...]:
        """Return what to say of a part not much larger than play and tolerance, or than its track is wide."""
        usual = "play and tolerance as usual" if self.sigma == 0.0 else "play and tolerance"
        allowances = {usual: self.sigma or float(np.hypot(PLAY_M, TOLERANCE_M))} if self.devices else {}
        return small_part_remarks(self.part, allowances, self.bowl.track.width)

    @property
    def parts(self) -> well_oriented.Range:
        """Well-oriented parts per second [1/s]."""
        return self.rate.parts

    @property
    def answer(self) -> str:
        """Say whose probabilities are taken: 'hops, launch feed', 'csa'."""
        return self.aspects.source(self.rule)

    def orientations_table(self) -> Frame:
        """Return what each station does with each orientation, a row each: ``orientations.csv``."""
        queue = self.rate.orientations
        return of_arrays(orientation_columns(queue, self.rule), queue)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return a sentence for each thing that a user must not overlook: devices, aspects, velocity."""
        odd = speed_remark(self.rate.velocity.value, self.bowl.sizing)
        other = () if self.measured is None else self.measured.warnings(self.part)
        return (
            *unknown_aspects(self.devices, self.aspects.names),
            *shank_remarks(self.devices),
            *self.aspects.warnings,
            *self.of_size,
            *other,
            *odd,
            *(hop.remark(self.bowl) if self.devices and not self.as_tried else ()),
        )


def _heading_share(study: RateStudy) -> float:
    """Return the share [1] of the parts on the wanted aspect that lie in its heading."""
    return study.rate.orientations.heading_shares[study.rate.row]


RATE_COLUMNS: tuple[Column[RateStudy], ...] = (  # of the document, and of the printed table unless hidden
    Column("parts_per_minute", lambda study: study.rate.parts, "1/min", interval=True),
    Column("aspect", lambda study: study.rate.orientations.aspects[study.rate.row]),
    Column("heading_deg", lambda study: study.rate.orientations.headings[study.rate.row], "deg"),
    Column("offered_per_minute", lambda study: study.rate.offered, "1/min", interval=True),
    Column("efficiency", lambda study: study.rate.efficiency, "share"),
    Column("purity", lambda study: study.rate.purity, "share"),
    Column("velocity_mm_s", lambda study: study.rate.velocity, "mm/s", interval=True),
    Column("length_mm", lambda study: study.rate.orientations.lengths[study.rate.row], "mm"),
    Column("gap_mm", lambda study: study.rate.gap, "mm"),
    Column("pitch_mm", lambda study: study.rate.pitch, "mm"),
    Column("rule", lambda study: study.rule, hidden=True),
    Column("answer", lambda study: study.answer),
    Column(
        "p_orientation",
        lambda study: study.rate.probability,
        "share",
        "probability of the orientation",
        interval=True,
    ),
    Column(
        "p_aspect", lambda study: study.rate.probability.value / _heading_share(study), "share", hidden=True
    ),
    Column("p_heading", lambda study: _heading_share(study), "share", hidden=True),
    Column("passes_devices", lambda study: study.rate.through, "share"),
    Column("fill", lambda study: study.rate.fill, "share"),
    Column("well_oriented_of_leaving", lambda study: study.rate.purity, "share", hidden=True),
    Column("jams_per_hour", lambda study: study.rate.jams, "1/h"),
    Column("clearing_s", lambda study: study.rate.clearing, "s"),
    Column(
        "quasi_static",
        lambda study: [device.kind for device in study.devices if device.action.turns],
        hidden=True,
    ),
    Column(
        "rolls_back",
        lambda study: [way.name for way in study.rate.orientations.lying if way.may_roll_back],
        hidden=True,
    ),
)


@former_keywords()
def rate(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    devices: Sequence[Device] | None = None,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    sigma: float = 0.0,
    rule: str = RECOMMENDED,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    aspect_shares: Shares | None = None,
) -> RateStudy:
    """Compute the well-oriented parts per second, with each factor, as ``feeder rate``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        The one wanted, 'A', or with its heading, 'A@354'; without it the orientation that leaves most often.
    heading : str or float [rad], optional
        Without one, the most frequent that stays on the track.
    devices : sequence of Device
        From ``feederscrew.bowl.devices``; those of the bowl without it.
    gap : str or float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    rule : str
        Whose probabilities are taken.
    launch : str, optional
        What is done to the part on a floor at rest: 'place', 'drop', 'flip', 'roll' or 'feed'; without it
        parts are fed onto the moving floor of the bowl.
    probabilities : str or Path, optional
        File of counts whose shares are taken.
    fed : int, optional
        How many parts are fed; without it until every share is known to 2.5 %.
    seed : int
        Of these parts.
    aspect_shares : Shares, optional
        What ``shares`` returned, in place of all of them.

    Returns
    -------
    RateStudy
        Its ``parts`` are parts per second with an interval.

    Raises
    ------
    FeederError
        If the part has no outline, more facets than can be followed past devices, or no such aspect, no such
        rule has probabilities of it, or the bowl has no steady state.
    """
    part, bowl = arguments.part_in_bowl(part, bowl)
    mend = "give devices in a list, as a bowl's devices are"
    chain = bowl.devices if devices is None else arguments.several("devices", devices, Device, mend)
    aspect_shares = the_shares(aspect_shares)
    aspect, angle = arguments.an_orientation(aspect, heading)
    space = arguments.amount("gap", gap, "length", 0.0)
    check.argument("fill", fill, MIN_POSITIVE, 1.0)
    check.argument("sigma", sigma, 0.0)
    require_rule(rule)
    if aspect_shares is None:
        check_wanted(part, aspect, angle)
        aspect_shares = shares(
            part, bowl, launch=launch, probabilities=probabilities, rule=rule, fed=fed, seed=seed
        )
    check.of_an_aspect(aspect, angle)
    if any(device.action.has_place for device in chain):
        refuse_many_facets(part)
    aspects = aspect_shares.aspects
    target = None if aspect is None else well_oriented.wanted(part, aspects, bowl.track, aspect, angle, chain)
    followed = stream.follow_orientations(part, aspects, bowl.track, chain, sigma, bowl)
    lying = stream.oriented(followed, aspect_shares.measured)
    speed = well_oriented.velocity(stream.queueing(bowl, lying.lying))
    hung = any(device.action is Action.HANG for device in chain)
    target = most_frequent(lying, rule, hung=hung) if target is None else target
    rates = well_oriented.rate(lying, speed, target, rule, gap=space, fill=fill)
    return RateStudy(part, bowl, aspects, chain, rule, rates, aspect_shares.measured, sigma)


def most_frequent(
    leaving_as: well_oriented.Orientations, rule: str, *, hung: bool = False
) -> tuple[str, float]:
    """Return the orientation in which most parts leave the bowl.

    Parts that roll back do not count. If less than ``LEAST_CARRIED_SHARE`` of the parts leave without rolling
    back, they count as well. If none leaves, the orientations most likely to land in are taken.

    Parameters
    ----------
    leaving_as : Orientations
        On the track, through the devices.
    rule : str
        Whose probabilities are taken.
    hung : bool
        The bowl ends in rails. Parts that roll count there, as only a trial tells whether they come to the
        rails.

    Returns
    -------
    str
        Aspect.
    float [rad]
        Heading. Of equals the first.
    """
    chance = np.nan_to_num(leaving_as.rules[rule])
    carried = np.where(leaving_as.rolls_back, 0.0, chance)
    share = (carried[:, None] * leaving_as.leaving).sum()
    is_carried = not hung and share >= LEAST_CARRIED_SHARE * chance.sum()
    coming = carried if is_carried else chance
    leaving = (coming[:, None] * leaving_as.leaving).sum(axis=0)[leaving_as.leaves_as]
    weight = leaving if leaving.any() else chance
    row = int(np.argmax(weight >= EQUAL_SHARE_RATIO * weight.max()))  # of equals the first
    return leaving_as.aspects[row], leaving_as.headings[row]


@dataclass(frozen=True, eq=False)
class PassagesStudy(ReadableRecord):
    """Each orientation at the worst place of each device that it meets; M orientations."""

    devices: tuple[Device, ...]  # without measured yields
    orientations: tuple[Orientation, ...]
    shares: Floats  # (M,) [1]
    passages: tuple[tuple[Passage, ...], ...]  # (M,) up to the device that returns it

    @property
    def wanted(self) -> int:
        """Place of the most frequent orientation that leaves; of the most frequent one where none does."""
        leaves = [
            not orientation.returned and all(k.verdict.passes > 0.0 for k in until_gone)
            for orientation, until_gone in zip(self.orientations, self.passages)
        ]
        shares = np.round(self.shares, 9)
        return int(np.argmax(np.where(leaves, shares, 0.0) if any(leaves) else shares))


def passages(part: Part, bowl: Bowl, aspects: Aspects, rule: str) -> PassagesStudy:
    """Study what a bowl's devices do with each orientation of a part from a mesh.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
        Its track and devices.
    aspects : Aspects
        Of the part.
    rule : str
        Whose probabilities are the shares.

    Returns
    -------
    PassagesStudy

    Raises
    ------
    FeederError
        If the part has very many facets.
    """
    if any(device.action.has_place for device in bowl.devices):
        refuse_many_facets(part)
    coming, _ = marked(orientations(part, aspects, bowl.track), bowl)
    devices = tuple(device for device in bowl.devices if device.action.has_place)
    return PassagesStudy(
        devices=devices,
        orientations=coming,
        shares=np.nan_to_num([orientation.chances[rule] for orientation in coming]),
        passages=tuple(tuple(until_returned(devices, orientation, coming)) for orientation in coming),
    )
