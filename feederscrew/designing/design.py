"""The study of ``feeder design``: from a part and a rate to a bowl that its own trial confirms."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import Unpack, overload

from feederscrew import bowl as bowls
from feederscrew.bowl import Bowl
from feederscrew.designing import built_bowl, families, loop
from feederscrew.designing.families import FamilyStudy
from feederscrew.designing.record import DESIGN_OUTCOMES, DesignRequest, DesignStudy
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.studies import arguments
from feederscrew.studies.arguments import BowlSettings, Overrides, Quantity, with_settings
from feederscrew.studies.rate import MIN_POSITIVE, Shares, the_shares
from feederscrew.studies.tooling import listed as names_of
from feederscrew.units import listed


class DesignOptions(BowlSettings, total=False):
    """The keywords of ``design`` for a type checker: of one part and of several it returns two records."""

    kept_keys: Collection[str]
    aspect: str | None
    heading: Quantity | None
    up: str | Sequence[str]
    outcome: str
    without: str | Sequence[str]
    diameter: Quantity | tuple[Quantity, Quantity] | None
    tolerance: Quantity
    rule: str
    drive: str
    budget: int
    alternatives: bool
    draws: int
    seed: int
    jobs: int
    aspect_shares: Shares | None
    progress: Callable[[str], None] | None
    overrides: Overrides


@overload
def design(
    part: Part, target: Quantity, bowl: Bowl | None = None, **options: Unpack[DesignOptions]
) -> DesignStudy: ...


@overload
def design(
    part: Sequence[Part], target: Quantity, bowl: Bowl | None = None, **options: Unpack[DesignOptions]
) -> FamilyStudy: ...


@with_settings
def design(
    part: Part | Sequence[Part],
    target: Quantity,
    bowl: Bowl | None = None,
    *,
    kept_keys: Collection[str] = frozenset(),
    aspect: str | None = DesignRequest.aspect,
    heading: Quantity | None = None,
    up: str | Sequence[str] = DesignRequest.up,
    outcome: str = DesignRequest.outcome,
    without: str | Sequence[str] = DesignRequest.without,
    diameter: Quantity | tuple[Quantity, Quantity] | None = None,
    tolerance: Quantity = DesignRequest.tolerance,
    rule: str = DesignRequest.rule,
    drive: str = DesignRequest.drive,
    budget: int = DesignRequest.budget,
    alternatives: bool = DesignRequest.alternatives,
    draws: int = DesignRequest.draws,
    seed: int = DesignRequest.seed,
    jobs: int = DesignRequest.jobs,
    aspect_shares: Shares | None = None,
    progress: Callable[[str], None] | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> DesignStudy | FamilyStudy:
    """Design a bowl for a part and a rate and try it, as ``feeder design``.

    Parameters
    ----------
    part : Part or sequence of Part
        From meshes. Several share one bowl as far as they can.
    target : str or float [1/s]
        Parts that shall leave, '60/min'.
    bowl : Bowl, optional
        What its file says is kept, its devices too; the rest is designed.
    kept_keys : collection of str
        Names of further keys of that bowl that are kept, 'track.width'.
    aspect : str, optional
        On which parts leave; the one that delivers most without it.
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
    rule : str
        Whose probabilities are taken.
    drive : str
        Kind of drive: 'leaf-spring' (one magnet), 'two-axis' (two magnets) or 'any', leaf springs first.
    budget : int
        Short trials of the search, at most.
    alternatives : bool
        Whether the best of each cost class is proved (steel, steady air, a sensor with a valve), and not the
        cheapest alone that holds.
    draws : int
        Trials of the answer with part, friction, drive and cuts drawn from their spread.
    seed : int
        Of everything that is drawn.
    jobs : int
        Cores to use; the answer does not depend on it.
    aspect_shares : Shares, optional
        Of ``shares``; what lies on the moving floor of the designed bowl without it.
    progress : callable, optional
        Called with what is tried, a sentence.
    overrides, **settings
        As for ``read_bowl``, frequency='50 Hz': they go over the bowl's own, and are kept.

    Returns
    -------
    DesignStudy
        Its ``status`` is one of four words, 'not proved' where the user stopped it; its ``bowl`` has the
        devices. Of several parts a FamilyStudy: its ``members``, whether all is ``shared``, and the worst
        ``status``.
    """
    request = DesignRequest(
        target=arguments.amount("target", target, "rate", MIN_POSITIVE),
        aspect=arguments.an_aspect(aspect),
        heading=arguments.angle("heading", heading),
        up=names_of(up),
        outcome=outcome,
        without=names_of(without),
        diameter=None if diameter is None else arguments.pair("diameter", diameter, "length"),
        rule=rule,
        drive=drive,
        tolerance=arguments.amount("tolerance", tolerance, "length", 0.0),
        budget=arguments.whole("budget", budget),
        alternatives=bool(alternatives),
        draws=arguments.whole("draws", draws),
        seed=arguments.whole("seed", seed, 0),
        jobs=arguments.whole("jobs", jobs),
    )
    if request.outcome not in DESIGN_OUTCOMES:
        raise ArgumentError("outcome", f"is {request.outcome!r}", f"give {listed(list(DESIGN_OUTCOMES))}")
    plain = arguments.a_bowl(bowls.default() if bowl is None else bowl, overrides, settings)
    kept_keys = frozenset(kept_keys) | {setting.key.name for setting in plain.settings if setting.is_own}
    kept_settings = built_bowl.settings_of(plain, kept_keys)
    if isinstance(part, (list, tuple)) and part:
        parts = [arguments.a_part(given_part) for given_part in part]
        family = families.family(parts, plain, kept_keys, request, tell=progress)
        members = (
            built_bowl.with_machine(member, built_bowl.built(member, kept_settings))
            for member in family.members
        )
        return replace(family, members=tuple(members))
    shared = the_shares(aspect_shares)
    study = loop.design(arguments.a_part(part), plain, kept_keys, request, shares=shared, tell=progress)
    return built_bowl.with_machine(study, built_bowl.built(study, kept_settings))
