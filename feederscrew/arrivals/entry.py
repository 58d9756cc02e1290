"""The shares of a part's aspects at the track's entry: counted, or of parts fed onto the bowl's moving floor.

Source: own; docs/resting.md.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.arrivals import simulation_cache
from feederscrew.arrivals.aspects_study import aspects as resting
from feederscrew.arrivals.ensemble import wilson
from feederscrew.base import check
from feederscrew.base.errors import ArgumentError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import OnCores
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import former_keywords
from feederscrew.bowl.devices.orientation_names import rows, split_name
from feederscrew.bowl.record import Bowl
from feederscrew.motion.conveying import conveying
from feederscrew.part.record import Part
from feederscrew.resting import profiles
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.profiles import CountFile, one_profile
from feederscrew.resting.rules.recommended import LAUNCH, Recommended, launch_of_name, widen_for_launch
from feederscrew.resting.rules.registry import RECOMMENDED_ANSWER as RECOMMENDED
from feederscrew.resting.rules.registry import require_rule

if TYPE_CHECKING:
    from feederscrew.arrivals.arrival import Arrival

CHOOSING = 400  # parts that show which aspect is the likeliest, where its share is well above all others
FEED_SEED = 1  # of the parts that are fed onto the moving floor
TOO_LONG = (
    "the part is too small, or the drive too quick, to be followed on the moving floor: the closed form"
    " is taken"
)
NO_ARRIVALS_MESSAGE = "no part came to lie on the moving floor: the closed form is taken"


@dataclass(frozen=True, eq=False)
class Shares(ReadableRecord, view="record_lines.SHARES_VIEW"):
    """The aspects of a part with the one answer that is taken for their shares."""

    aspects: Aspects  # their ``recommended`` is that answer
    measured: profiles.CountFile | None = None  # the file it was read from, if it was
    fed: bool = False  # whether they are what lies on the bowl's moving floor, at its own drive

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of the file, by its path."""
        return {} if self.measured is None else {self.measured.source: self.measured.sha256}


@former_keywords()
def shares(
    part: Part,
    bowl: Bowl,
    *,
    launch: str | None = None,
    probabilities: str | PathLike[str] | None = None,
    rule: str = RECOMMENDED,
    fed: int | None = None,
    seed: int = FEED_SEED,
    jobs: int | None = None,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> Shares:
    """Return in which shares the aspects of a part come to the track, for ``rate``, ``tooling`` and others.

    Parts are fed from a hopper onto the moving floor of the bowl, and what lies at the track's entry is
    counted. With a launch they land on a floor at rest; with a file its counts are taken; with a rule nothing
    is simulated.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        Its drive and surface move the floor.
    launch : str, optional
        What is done to the part, on a floor at rest.
    probabilities : str or Path, optional
        File of counts that are taken instead, by aspect or by orientation.
    rule : str
        Whose probabilities are taken, 'csa'; with 'recommended' parts are fed onto the floor.
    fed : int, optional
        Parts that are fed onto the floor; without it as many as make every share known to 2.5 %.
    seed : int
        Of the parts on the floor.
    jobs : int, optional
        Cores for that; all there are without it. Nothing else depends on it.
    progress, before : callable, optional
        As for ``aspects``; of parts on the floor as well as of drops.

    Returns
    -------
    Shares
        To be handed on as ``aspect_shares``: what takes long is then computed once for several calls.

    Raises
    ------
    FeederError
        Every fault of the file; if the part has no shape to drop.
    """
    part, bowl = arguments.part_in_bowl(part, bowl)
    run = OnCores(jobs, progress, before)
    require_rule(rule)
    seed, fed = arguments.whole("seed", seed, 0), arguments.count("fed", fed)
    if probabilities is not None:
        aspects = resting(part, drops=0).aspects
        measured = profiles.read_profile(check.path("probabilities", probabilities), aspects.names)
        return Shares(counted(aspects, measured), measured)
    if launch is not None or rule != RECOMMENDED or part.vertices is None:
        drops = None if rule == RECOMMENDED else 0
        name = launch_of_name(launch or LAUNCH)
        found = resting(part, launch=name, drops=drops, jobs=jobs, progress=progress, before=before)
        return Shares(found.aspects)
    aspects = resting(part, drops=0).aspects
    if not bowl.gravity > 0.0:
        conveying(bowl)  # says so
    if np.count_nonzero(aspects.stable) < 2:
        return Shares(aspects)
    if too_long(aspects, bowl):
        return Shares(replace(aspects, warnings=(*aspects.warnings, TOO_LONG)))
    from feederscrew.arrivals import arrival as floor

    def make() -> Any:
        if run.before:
            run.before(None)
        return floor.arrival(part, aspects, bowl, drops=fed, seed=seed, jobs=run.cores, progress=run.progress)

    decides = (bowl.drive, bowl.restitution, bowl.friction.kinetic, bowl.gravity, fed, seed)
    arrival = simulation_cache.once(
        part,
        aspects,
        "arrival",
        decides,
        make,
        lambda arrived: not arrived.shaken.partial,
        floor.to_arrays,
        lambda arrays: floor.from_arrays(part, aspects, bowl, fed, arrays),
    )
    with_arrivals = arrived(aspects, arrival, seed)
    return Shares(with_arrivals, fed=with_arrivals.recommended is not aspects.recommended)


def check_wanted(part: Part, aspect: str | None, heading: float | None = None) -> None:
    """Refuse an aspect that a part does not have, or a heading without one, before anything is simulated.

    Parameters
    ----------
    part : Part
    aspect : str or None
    heading : float [rad], optional

    Returns
    -------
    None

    Raises
    ------
    ArgumentError
        If the part has no such aspect, or a heading is given alone.
    """
    check.of_an_aspect(aspect, heading)
    if aspect is not None and part.vertices is not None:
        name = split_name(aspect)[0]
        rows(resting(part, drops=0).aspects.names, name, f"aspect of {part.source}", ArgumentError)


def arriving(part: Part, bowl: Bowl, rule: str = RECOMMENDED) -> Aspects:
    """Return the aspects of a part with the shares that arrive at a bowl's track as their answer.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    rule : str
        Whose probabilities are the answer; parts are fed on the moving floor for the recommended one alone.

    Returns
    -------
    Aspects
    """
    return shares(part, bowl, rule=rule).aspects


def likeliest(part: Part, bowl: Bowl) -> Aspects:
    """Return the aspects of a part with the shares that arrive, of few parts where few decide.

    ``CHOOSING`` parts are fed first. If the 95 % interval of the most frequent aspect is above those of all
    others, they decide; else the answer is that of ``arriving``.

    Parameters
    ----------
    part : Part
    bowl : Bowl

    Returns
    -------
    Aspects

    References
    ----------
    Wilson's interval, ``arrivals.ensemble.wilson``.
    """
    from feederscrew.arrivals import arrival

    fed = min(CHOOSING, arrival.MAX_ARRIVALS)
    sample = shares(part, bowl, fed=fed)
    answer = sample.aspects.recommended
    if not sample.fed or answer is None:
        return sample.aspects
    low, high = wilson(np.nan_to_num(answer.p) * fed, fed)  # of the sample alone
    first = int(np.argmax(answer.p))
    is_clear = low[first] > np.delete(high, first).max(initial=0.0)
    return sample.aspects if is_clear else arriving(part, bowl)


def the_shares(aspect_shares: object) -> Shares | None:
    """Return shares as ``shares`` gave them; None stays None."""
    if aspect_shares is None:
        return None
    return check.kind("aspect_shares", aspect_shares, Shares, "give what shares returned")


def arrived(aspects: Aspects, arrival: "Arrival", seed: int) -> Aspects:
    """Return the aspects with what arrives at the track's entry as their recommended answer.

    Parameters
    ----------
    aspects : Aspects
    arrival : Arrival
    seed : int
        Of the launches.

    Returns
    -------
    Aspects
        With a warning where the shares are undecided, or no part came to lie on the floor.
    """
    parts = arrival.shaken.parts
    if not np.isfinite(arrival.p).all():
        return replace(aspects, warnings=(*aspects.warnings, NO_ARRIVALS_MESSAGE))
    remarks = [] if arrival.settled else [f"the shares at the track's entry are undecided: {arrival.reason}"]
    remarks += [f"the parts on the floor were stopped after {parts}"] if arrival.shaken.partial else []
    rule = f"fed onto the moving floor, {parts} parts, seed {seed}"
    low, high = widen_for_launch(arrival.p, arrival.low, arrival.high, aspects.stable)
    answer = Recommended(rule, LAUNCH, arrival.p, check.frozen(low), check.frozen(high))
    return replace(aspects, recommended=answer, warnings=(*aspects.warnings, *remarks))


def too_long(aspects: Aspects, bowl: Bowl) -> bool:
    """Return whether a part would take more steps on the floor of a bowl than one is followed for.

    Parameters
    ----------
    aspects : Aspects
    bowl : Bowl

    Returns
    -------
    bool
    """
    from feederscrew.arrivals.arrival import MAX_ARRIVAL_STEPS, steps_needed

    return aspects.ground is not None and steps_needed(aspects.ground.hull, bowl) > MAX_ARRIVAL_STEPS


def counted(aspects: Aspects, measured: CountFile) -> Aspects:
    """Return the aspects with measured counts as their recommended answer.

    Without facets the part rolls off. The interval is Wilson's, of 95 %; shares without counts have none.

    Parameters
    ----------
    aspects : Aspects
    measured : CountFile
        Of one column.

    Returns
    -------
    Aspects

    Raises
    ------
    FeederError
        If there are several columns.
    """
    column = one_profile(measured)
    p = column.fractions / column.fractions.sum()
    low, high = wilson(column.values, column.values.sum()) if column.has_counts else (p, p)
    total = f", {column.values.sum():.0f} parts" if column.has_counts else ""
    rule, launch = f"{measured.source}{total}", measured.head.launch or LAUNCH
    ends = check.frozen(np.minimum(low, p)), check.frozen(np.maximum(high, p))
    return replace(aspects, recommended=Recommended(rule, launch, check.frozen(p), *ends))
