"""One bowl for several parts: a chain whose values suit all of them, or else what is changed between them."""

from dataclasses import dataclass, replace
from typing import Any

from feederscrew.designing import calm_drive, exploring, loop, proposals
from feederscrew.designing.exploring import Search
from feederscrew.designing.loop import merit
from feederscrew.designing.record import FALLS_SHORT, HOLDS, NONE, NOT_PROVED, DesignStudy
from feederscrew.errors import FeederError
from feederscrew.records import ReadableRecord
from feederscrew.studies.aspects import answered
from feederscrew.tooling.devices.kinds import KINDS

PROPOSED = tuple(sorted(name for name, kind in KINDS.items() if kind.proposed))
TRACK = ("track.radius", "track.width", "track.bank", "track.climb")
OWN = "family"  # the folder of what is of all parts


@dataclass(frozen=True, eq=False)
class FamilyStudy(ReadableRecord):
    """Designs of several parts that are to run in one bowl."""

    members: tuple[DesignStudy, ...]
    stopped: bool = False  # by the user, before each part was designed and tried

    @property
    def status(self):
        """The worst word of its parts: holds where each does; not proved where the user stopped it."""
        if self.partial:
            return NOT_PROVED
        words = {one.status for one in self.members}
        return next(word for word in (NONE, FALLS_SHORT, HOLDS) if word in words)

    @property
    def shared(self) -> bool:
        """Whether all run on one track through one chain: only drive and sensors are set anew."""
        return all(one.bowl is not None and iron(one) == iron(self.members[0]) for one in self.members)

    @property
    def partial(self):
        """Whether the user stopped it."""
        return self.stopped or any(one.partial for one in self.members)


def iron(study) -> tuple[Any, ...]:
    """Return what of a design is steel: its track, and its devices but what a sensor is shown."""
    devices = tuple((one.kind, one.sees if one.senses else one.text) for one in study.devices)
    track = study.bowl.track
    return (track.radius, track.width, track.bank, track.climb), devices


def named_apart(parts) -> None:
    """Say which two parts have one name; raises FeederError."""
    names = [OWN, *(part.name.casefold() for part in parts)]
    for k, name in enumerate(names[1:]):
        if name in names[: k + 1]:
            raise FeederError(
                parts[k].source,
                f"is another part of the name {parts[k].name}: results would be overwritten",
                "rename a file",
            )


def family(parts, plain, given, request, *, told=None, before=None, progress=None) -> FamilyStudy:
    """Design one bowl for several parts, each tried in it.

    The part that needs the widest track is designed first; its track and its kinds of devices are offered
    to the others. Where each holds with them, one value is chosen for each device out of what all of them
    admit, and who has another one by that is tried again. Who does not gets devices of its own.

    Parameters
    ----------
    parts : sequence of Part
        Two or more, from meshes, of different names.
    plain : Bowl
    given : collection of str
    request : DesignRequest
        The same for each; no aspect, no heading.
    told, before, progress : callable, optional
        As for ``loop.design``.

    Returns
    -------
    FamilyStudy
        Its members as the parts; fewer where the user stopped it.

    Raises
    ------
    FeederError
        As ``loop.design``, and where two parts have one name.
    """
    named_apart(parts)
    told = told or (lambda text: None)
    plain, given, first = _common(parts, plain, frozenset(given), request)
    found: dict[int, DesignStudy] = {}
    try:
        for k in (first, *(k for k in range(len(parts)) if k != first)):
            told(f"{parts[k].name}:")
            lead = found.get(first)
            own = {"told": told, "before": before, "progress": progress}
            found[k] = _member(parts[k], lead, plain, given, request, own)
            if found[k].partial:
                return FamilyStudy(tuple(found[n] for n in sorted(found)))
        members = tuple(found[k] for k in range(len(parts)))
        return FamilyStudy(_of_one_chain(members, request, given, told, before))
    except KeyboardInterrupt:
        if not found:
            raise
        return FamilyStudy(tuple(found[n] for n in sorted(found)), stopped=True)


def _common(parts, plain, given, request) -> tuple[Any, ...]:
    """A bowl with a track on which each part fits, which keys are given then, and who needs the widest."""
    tracks = [
        calm_drive.section(part, answered(part), plain, given, diameter=request.diameter).bowl.track
        for part in parts
    ]
    widths = [track.width for track in tracks]
    track = replace(plain.track, radius=max(one.radius for one in tracks), width=max(widths))
    return replace(plain, track=track), given | {"track.radius", "track.width"}, widths.index(max(widths))


def _member(part, lead, plain, given, request, own):
    """The design of one part: with what the first one has where it holds so, else its own.

    ``own`` are the keywords of ``loop.design`` that say who is told.
    """
    if lead is None or lead.status != HOLDS:
        return loop.design(part, plain, given, request, **own)
    used = {one.kind for one in lead.devices}
    less = replace(request, without=(*request.without, *(name for name in PROPOSED if name not in used)))
    tracked = replace(plain, track=lead.bowl.track)
    found = loop.design(part, tracked, given | set(TRACK), less, **own, with_nearest=False)
    if found.status == HOLDS or found.partial:
        return replace(found, request=request)
    other = loop.design(part, plain, given, request, **own)
    return replace(max((found, other), key=merit), partial=other.partial)


def _of_one_chain(members, request, given, told, before):
    """The members with values that suit all, where there are such and each holds with them."""
    kinds = {tuple(one.kind for one in member.devices) for member in members}
    if len(kinds) > 1 or any(member.status != HOLDS for member in members):
        return members
    limits = common_limits([member.cuts for member in members])
    if limits is None:
        return members
    made = []
    for member in members:
        cuts = tuple(_at(cut, limit, member) for cut, limit in zip(member.cuts, limits, strict=True))
        if [cut.device.text for cut in cuts] != [cut.device.text for cut in member.cuts]:
            told(f"{member.part.name}: with the values of all")
            member = again(member, cuts, request, given | set(TRACK), told=told, before=before)
        if member is not None and member.partial:
            raise KeyboardInterrupt
        if member is None or member.status != HOLDS:
            return members
        made.append(member)
    return tuple(made)


def common_limits(chains):
    """Return the values [m] at which each device of several chains suits all of them.

    Parameters
    ----------
    chains : sequence of sequence of Cut
        Of devices of the same kinds in the same order.

    Returns
    -------
    list of float or None
        A value each, None of what has no number; that of one of the chains where all admit it, else the
        middle of what they admit. None where some device has no such value.
    """
    found: list[float | None] = []
    for cuts in zip(*chains, strict=True):
        own = [cut.device for cut in cuts]
        if own[0].senses or not own[0].bound:
            if not own[0].senses and len({one.text for one in own}) > 1:
                return None
            found.append(None)
            continue
        ends = [sorted((cut.smallest.limit, cut.largest.limit)) for cut in cuts]
        low, high = max(end[0] for end in ends), min(end[1] for end in ends)
        if low > high:
            return None
        found.append(next((one.limit for one in own if low <= one.limit <= high), 0.5 * (low + high)))
    return found


def _at(cut, limit, member):
    """A cut of a member at another value; itself where that is its own."""
    if limit is None or abs(limit - cut.device.limit) < 0.5 * proposals.VALUE_STEP_M:
        return cut
    return proposals.moved(cut, limit, member.tooling.orientations, member.turn)


def again(study, cuts, request, given, *, told, before):
    """Return a design with other values of its devices, proved as any; None where its trial denies it.

    Parameters
    ----------
    study : DesignStudy
        With a bowl.
    cuts : sequence of Cut
    request : DesignRequest
    given : collection of str
        Keys of its bowl that are kept.
    told, before : callable

    Returns
    -------
    DesignStudy or None
    """
    bare = replace(study.bowl, devices=())
    search = Search(study.part, request, bare, frozenset(given), told, None, before=before)
    search.known = exploring.arriving(search, bare)
    ways, weights = exploring.offered(search, bare)
    same = proposals.alike(ways.lying, study.turn, request.up)
    free = proposals.free_headings(ways.lying, study.turn, request)
    proposal = proposals.Proposal(study.turn, tuple(cuts), study.before, "the values of all", same, free)
    made = calm_drive.PlainBowl(bare, frozenset(given), None, request.drive)
    candidate = exploring.attempted(search, made, proposal, weights)
    if not candidate.attempt.clean:
        return None
    return loop.proved(search, candidate, whole=True)
