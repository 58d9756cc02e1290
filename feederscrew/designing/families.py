"""One bowl for several parts: a chain whose values suit all of them, or else what is changed between them."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

from feederscrew.arrivals.aspects_study import find_aspects
from feederscrew.base.errors import FeederError
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.verified import HELD, Status
from feederscrew.designing import calm_drive, exploring, loop, proposals
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.loop import merit
from feederscrew.designing.progress import Progress, SearchProgress
from feederscrew.designing.record import DesignRequest, DesignStudy, ProofKind
from feederscrew.designing.search import Search
from feederscrew.part.record import Part
from feederscrew.sorting.isolating.chain import Cut

PROPOSED = tuple(sorted(name for name, kind in KINDS.items() if kind.search.is_proposed))
SHARED_TRACK_KEYS = ("track.radius", "track.width", "track.bank", "track.climb")
FAMILY_FOLDER = "family"  # the folder of what is of all parts


@dataclass(frozen=True, eq=False)
class FamilyStudy(ReadableRecord, view="design_pages.FAMILY_VIEW"):
    """Designs of several parts that are to run in one bowl."""

    members: tuple[DesignStudy, ...]
    stopped: bool = False  # by the user, before each part was designed and tried

    @property
    def status(self) -> str:
        """The worst word of its parts: holds where each does; not proved where the user stopped it."""
        if self.partial:
            return Status.NOT_PROVED
        words = {member.status for member in self.members}
        return next(
            word
            for word in (Status.NONE, Status.FALLS_SHORT, Status.NO_MACHINE, *reversed(HELD))
            if word in words
        )

    @property
    def shared(self) -> bool:
        """Tell whether all run on one track through one chain: only drive and sensors are set anew."""
        steel: set[Any] = set()
        for member in self.members:
            if member.bowl is None:
                return False
            track, own = member.bowl.track, list[Any](member.devices)  # without what a sensor is taught
            devices = tuple(
                (device.kind, device.sees if device.action is Action.SENSE else device.text) for device in own
            )
            steel.add(((track.radius, track.width, track.bank, track.climb), devices))
        return len(steel) <= 1

    @property
    def partial(self) -> bool:
        """Tell whether the user stopped it."""
        return self.stopped or any(member.partial for member in self.members)


def check_names(parts: Sequence[Part]) -> None:
    """Refuse two parts of one name: the results of one would overwrite those of the other.

    Parameters
    ----------
    parts : sequence of Part

    Raises
    ------
    FeederError
    """
    names = [FAMILY_FOLDER, *(part.name.casefold() for part in parts)]
    for k, name in enumerate(names[1:]):
        if name in names[: k + 1]:
            what = f"is another part of the name {parts[k].name}: results would be overwritten"
            raise FeederError(parts[k].source, what, "rename a file")


def family(
    parts: Sequence[Part],
    plain: Bowl,
    kept_keys: Collection[str],
    request: DesignRequest,
    *,
    tell: Callable[[str], None] | None = None,
    before: Callable[[], None] | None = None,
    progress: Progress | None = None,
) -> FamilyStudy:
    """Design one bowl for several parts, each tried in it.

    The part that needs the widest track is designed first; its track and its kinds of devices are offered
    to the others. Where each holds with them, one value is chosen for each device out of what all of them
    admit, and who has another one by that is tried again. Who does not gets devices of its own.

    Parameters
    ----------
    parts : sequence of Part
        Two or more, from meshes, of different names.
    plain : Bowl
        As the user gave it, completed by the defaults.
    kept_keys : collection of str
        Names of keys that are kept of it.
    request : DesignRequest
        The same for each, with no aspect and no heading.
    tell, before, progress : callable, optional
        As for ``loop.design``.

    Returns
    -------
    FamilyStudy
        With members as the parts, fewer where the user stopped it.

    Raises
    ------
    FeederError
        As ``loop.design``, and where two parts have one name.
    """
    check_names(parts)
    tell = tell or (lambda text: None)
    # a track on which each part fits, led by the part that needs the widest
    tracks = [
        calm_drive.section(part, find_aspects(part), plain, kept_keys, diameter=request.diameter).bowl.track
        for part in parts
    ]
    widths = [track.width for track in tracks]
    track = replace(plain.track, radius=max(sized.radius for sized in tracks), width=max(widths))
    plain, first = replace(plain, track=track), widths.index(max(widths))
    keys = frozenset(kept_keys) | {"track.radius", "track.width"}

    asked, request = request, replace(request, proof=ProofKind.USUAL)  # a long proof is of what all share
    own: dict[str, Any] = {"tell": tell, "before": before, "progress": progress}

    def member(part: Part, lead: DesignStudy | None) -> DesignStudy:
        # with what the first one has where it holds so, else its own
        if lead is None or lead.bowl is None or lead.status not in HELD:
            return loop.design(part, plain, keys, request, **own)
        used = {device.kind for device in lead.devices}
        unused = tuple(name for name in PROPOSED if name not in used)
        less = replace(request, without=(*request.without, *unused))
        tracked = replace(plain, track=lead.bowl.track)
        design = loop.design(part, tracked, keys | set(SHARED_TRACK_KEYS), less, **own, with_nearest=False)
        if design.status in HELD or design.partial:
            return replace(design, request=request)
        other = loop.design(part, plain, keys, request, **own)
        return replace(max((design, other), key=merit), partial=other.partial)

    designs: dict[int, DesignStudy] = {}
    try:
        for k in (first, *(k for k in range(len(parts)) if k != first)):
            tell(f"{parts[k].name}:")
            designs[k] = member(parts[k], designs.get(first))
            if designs[k].partial:
                return FamilyStudy(tuple(designs[n] for n in sorted(designs)))
        members = tuple(designs[k] for k in range(len(parts)))
        members = _unify_chains(members, request, keys | set(SHARED_TRACK_KEYS), tell, before)
        if asked.proof is not ProofKind.LONG:
            return FamilyStudy(members)
        said = SearchProgress(tell, before, progress)
        for k, made in enumerate(members):
            asked_long = replace(made, request=replace(made.request, proof=asked.proof))
            designs[k] = loop.prove_long(asked_long, said) if made.status in HELD else asked_long
            if designs[k].partial:
                return FamilyStudy(tuple(designs[n] for n in sorted(designs)))
        return FamilyStudy(tuple(designs[k] for k in range(len(parts))))
    except KeyboardInterrupt:
        if not designs:
            raise
        return FamilyStudy(tuple(designs[n] for n in sorted(designs)), stopped=True)


def _unify_chains(
    members: tuple[DesignStudy, ...],
    request: DesignRequest,
    kept_keys: frozenset[str],
    tell: Callable[[str], None],
    before: Callable[[], None] | None,
) -> tuple[DesignStudy, ...]:
    """The members with values that suit all, where there are such and each holds with them."""
    kinds = {tuple(device.kind for device in member.devices) for member in members}
    if len(kinds) > 1 or any(member.status not in HELD for member in members):
        return members
    limits = common_limits([member.cuts for member in members])
    if limits is None:
        return members
    changed_members = []
    for member in members:
        tooling: Any = member.tooling
        cuts = [
            cut
            if limit is None or abs(limit - cut.device.limit) < 0.5 * proposals.VALUE_STEP_M
            else proposals.move_cut(cut, limit, tooling.orientations, member.turn or 0)
            for cut, limit in zip(member.cuts, limits, strict=True)
        ]
        changed: DesignStudy | None = member
        if [cut.device.text for cut in cuts] != [cut.device.text for cut in member.cuts]:
            tell(f"{member.part.name}: with the values of all")
            changed = prove_with_cuts(member, cuts, request, kept_keys, tell=tell, before=before)
        if changed is not None and changed.partial:
            raise KeyboardInterrupt
        if changed is None or changed.status not in HELD:
            return members
        changed_members.append(changed)
    return tuple(changed_members)


def common_limits(chains: Sequence[Sequence[Cut]]) -> list[float | None] | None:
    """Return the values at which each device of several chains suits all of them.

    Parameters
    ----------
    chains : sequence of sequence of Cut
        Of devices of the same kinds in the same order.

    Returns
    -------
    list of (float [m] or None), or None
        A value each, None of what has no number; that of one of the chains where all admit it, else the
        middle of what they admit. None in place of the list where some device has no such value.
    """
    limits: list[float | None] = []
    for cuts in zip(*chains, strict=True):
        own = [cut.device for cut in cuts]
        if own[0].action is Action.SENSE or not own[0].search.bound:
            if own[0].action is not Action.SENSE and len({device.text for device in own}) > 1:
                return None
            limits.append(None)
            continue
        ends = [sorted((cut.smallest.limit, cut.largest.limit)) for cut in cuts]
        low, high = max(end[0] for end in ends), min(end[1] for end in ends)
        if low > high:
            return None
        limits.append(
            next((device.limit for device in own if low <= device.limit <= high), 0.5 * (low + high))
        )
    return limits


def prove_with_cuts(
    study: DesignStudy,
    cuts: Sequence[Cut],
    request: DesignRequest,
    kept_keys: Collection[str],
    *,
    tell: Callable[[str], None],
    before: Callable[[], None] | None,
) -> DesignStudy | None:
    """Return a design with other values of its devices, proved as any.

    Parameters
    ----------
    study : DesignStudy
        With a bowl.
    cuts : sequence of Cut
        In place of its own.
    request : DesignRequest
    kept_keys : collection of str
        Names of keys of the bowl that are kept.
    tell, before : callable
        As for ``loop.design``.

    Returns
    -------
    DesignStudy or None
        None where its trial denies it.

    Raises
    ------
    ValueError
        If the design has no bowl.
    """
    if study.bowl is None or study.turn is None:
        raise ValueError("a design without a bowl has no devices")
    plain_bowl = replace(study.bowl, devices=())
    said = SearchProgress(tell, before)
    search = Search.begin(study.part, request, plain_bowl, kept_keys, progress=said)
    search.state.shares = exploring.entry_shares(search, plain_bowl)
    orientations, weights = exploring.weigh_orientations(search, plain_bowl)
    own = proposals.find_equivalents(orientations.lying, study.turn, request)
    proposal = proposals.Proposal(study.turn, tuple(cuts), study.before, Move(MoveKind.VALUES_OF_ALL), *own)
    track = calm_drive.PlainBowl(plain_bowl, frozenset(kept_keys), request.drive)
    candidate = exploring.try_proposal(search, track, proposal, weights)
    return loop.prove_design(search, candidate, whole=True) if candidate.attempt.clean else None
