"""Devices along the track: what isolates an orientation, a trial of a chain of them, and all on one page."""

from collections.abc import Sequence
from typing import Any, Unpack

from feederscrew import check
from feederscrew.api import asked
from feederscrew.api.asked import BowlFile, ProbabilitySource, Quantity
from feederscrew.bowl import Bowl
from feederscrew.part import Part
from feederscrew.studies.rate import LEAST
from feederscrew.studies.report import ReportStudy
from feederscrew.studies.tooling import ToolingStudy
from feederscrew.studies.trial import TrialStudy
from feederscrew.thesis.reproduced import Reproduction

SEARCH = {
    "rule": "any", "purity": "share", "efficiency": "share", "turn": "any", "seed": "seed",
    "verdicts": "count", "seconds": "time", "told": "any", "outcome": "any", "without": "any", "up": "any",
    "step": "length", "cutter": "length", "play": "length", "tolerance": "length",
}  # fmt: skip
TRIED = {
    "rule": "any", "known": "any", "measured": "any", "landing": "count", "poured": "any",
    "seconds": "time", "progress": "any", "before": "any",
}  # fmt: skip


def tooling(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    margin: Quantity | None = None,
    known: asked.Shares | None = None,
    **search: Any,
) -> ToolingStudy:
    """Find cuts that isolate an orientation of a part, as ``feeder tooling``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        The one wanted; every orientation without it.
    heading : str or float [rad], optional
        Of that aspect.
    margin : str or float [m], optional
        By which the wanted orientation passes and the others fail, at least.
    known : Shares, optional
        Of ``shares``.
    **search
        rule, purity, efficiency, turn, seed, verdicts, seconds, outcome, without, up, step, cutter, play,
        tolerance: as for ``feeder tooling``.

    Returns
    -------
    ToolingStudy
    """
    from feederscrew.studies.tooling import tooling as study

    own = asked.searched(search, SEARCH)
    if margin is not None:
        own["margin"] = asked.amount("margin", margin, "length", 0.0)
    solid, lies = asked.a_part(part, mesh=True), asked.angle("heading", heading)
    shared = asked.the_shares(known)
    found = None if shared is None else shared.aspects
    return study(solid, asked.a_bowl(bowl), asked.an_aspect(aspect), heading=lies, known=found, **own)


def trial(
    part: Part,
    bowls: Bowl | Sequence[Bowl],
    aspect: str | None = None,
    *,
    parts: int | None = None,
    queue: int | None = None,
    seed: int = 1,
    jobs: int = 1,
    **others: Any,
) -> TrialStudy:
    """Send parts along the vibrating, tooled track of one or several bowls, as ``feeder trial``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowls : Bowl or sequence of Bowl
        With their devices.
    aspect : str, optional
        Only its orientations.
    parts : int, optional
        One at a time; 200 without it, 60 beside a queue.
    queue : int, optional
        So many at once, which push each other.
    seed : int
        Of play and phase.
    jobs : int
        Cores to use; nothing else depends on it.
    **others
        rule, known, landing, poured, seconds: as for ``feeder trial``.

    Returns
    -------
    TrialStudy
        With a run for each bowl.
    """
    from feederscrew.studies.trial import trial as study

    solid, driven = asked.a_part(part, mesh=True), asked.some_bowls(bowls)
    parts, queue = asked.count("parts", parts), asked.count("queue", queue)
    own = asked.searched(others, TRIED)
    asked.the_shares(own.get("known"))
    own |= {"seed": asked.count("seed", seed, 0), "jobs": asked.count("jobs", jobs)}
    return study(solid, driven, asked.an_aspect(aspect), parts=parts, queue=queue, **own)


def report(
    part: Part,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    target: Quantity | None = None,
    bowl: BowlFile | None = None,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    **answer: Unpack[ProbabilitySource],
) -> ReportStudy:
    """Gather all that is known of a part in a bowl, as ``feeder report``: each chapter when it is asked for.

    Parameters
    ----------
    part : Part
    aspect : str, optional
        The one wanted; the likeliest without it.
    heading : str or float [rad], optional
    target : str or float [1/s], optional
        Rate that a bowl is sized for.
    bowl : dict, optional
        path, overrides: as for ``read_bowl``.
    gap, fill, **answer
        As for ``rate``.

    Returns
    -------
    ReportStudy
        ``rate``, ``convey``, ``slide``, ``track``, ``machine`` ... are the records of those commands.
    """
    from feederscrew.studies.report import report as study

    own: dict[str, Any] = {name: value for name, value in answer.items() if name not in ("rule", "known")}
    file = asked.a_file_of_bowl(bowl)
    path = file.get("path")
    return study(
        asked.a_part(part),
        None if path is None else asked.a_file("path", path),
        asked.overrides(file.get("overrides", ())),
        aspect=aspect,
        heading=asked.angle("heading", heading),
        rule=asked.rule(answer),
        gap=asked.amount("gap", gap, "length", 0.0),
        fill=check.argument("fill", fill, LEAST, 1.0),
        target=None if target is None else asked.amount("target", target, "rate"),
        **own,
    )


def reproduce() -> Reproduction:
    """Compute every table and figure of the thesis again, as ``feeder reproduce``.

    Returns
    -------
    Reproduction
        Its ``items``, a table or a figure each, have a verdict for every cell.
    """
    from feederscrew.thesis.reproduced import reproduced

    return reproduced()
