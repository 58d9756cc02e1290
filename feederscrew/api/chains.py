"""Devices along the track: what isolates an orientation, a trial of a chain of them, and all on one page."""

from collections.abc import Callable, Sequence
from typing import Unpack

from feederscrew.api import asked
from feederscrew.api.asked import BowlFile, Path, Quantity
from feederscrew.api.bowl_settings import BowlSettings, Overrides, override_texts, with_settings
from feederscrew.bowl import Bowl
from feederscrew.part import Part
from feederscrew.rates.well_oriented import RECOMMENDED_RULE
from feederscrew.resting.counts.profiles import Measured
from feederscrew.studies import report as reports
from feederscrew.studies import tooling as isolating
from feederscrew.studies import trial as trials
from feederscrew.studies.rate import LEAST, Shares
from feederscrew.studies.report import ReportStudy
from feederscrew.studies.tooling import ToolingStudy
from feederscrew.studies.trial import TrialOptions, TrialStudy
from feederscrew.studies.wishes import ToolingOptions
from feederscrew.thesis.reproduction import Reproduction, reproduced


@with_settings
def tooling(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    rule: str = RECOMMENDED_RULE,
    margin: Quantity = isolating.MARGIN_M,
    purity: float = ToolingOptions.purity,
    efficiency: float = ToolingOptions.efficiency,
    outcome: str = ToolingOptions.outcome,
    up: str | Sequence[str] = ToolingOptions.up,
    without: str | Sequence[str] = ToolingOptions.without,
    turn: bool = ToolingOptions.turn,
    vary: bool = ToolingOptions.vary,
    step: Quantity = ToolingOptions.step,
    cutter: Quantity = ToolingOptions.cutter,
    play: Quantity = ToolingOptions.play,
    tolerance: Quantity = ToolingOptions.tolerance,
    seed: int = ToolingOptions.seed,
    verdicts: int = ToolingOptions.verdicts,
    seconds: Quantity = ToolingOptions.seconds,
    known: Shares | None = None,
    progress: Callable[[int, int], None] | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
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
    rule : str
        Whose probabilities are taken.
    margin : str or float [m]
        By which the wanted orientation passes and the others fail, at least.
    purity : float [1]
        Of what leaves, that is enough.
    efficiency : float [1]
        Of what is offered, that is asked for.
    outcome : str
        How parts leave: 'lying', 'hanging' or 'any'.
    up : str or sequence of str
        Other aspects that count as the one wanted, 'B,C'.
    without : str or sequence of str
        Kinds of devices that are not used, 'wiper,cut_out'.
    turn : bool
        Whether devices that turn parts over may be used.
    vary : bool
        Whether other banks, grooves and widths of the track are tried.
    step : str or float [m]
        Values of cuts are whole multiples of it.
    cutter : str or float [m]
        Radius of the corners of holes.
    play, tolerance : str or float [m]
        Of the part from the wall and of its size; both are added to the margin.
    seed : int
        Of the search for holes.
    verdicts : int
        The most in the search for the holes of one orientation.
    seconds : str or float [s]
        After which the search ends.
    known : Shares, optional
        Of ``shares``.
    progress : callable, optional
        Called with how many orientations are done, and of how many.
    overrides, **settings
        As for ``read_bowl``: in place of the bowl's own.

    Returns
    -------
    ToolingStudy
    """
    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl, overrides, settings)
    shared = asked.the_shares(known)
    return isolating.tooling(
        solid,
        bowl,
        asked.an_aspect(aspect),
        heading=asked.angle("heading", heading),
        rule=rule,
        margin=asked.amount("margin", margin, "length", 0.0),
        known=None if shared is None else shared.aspects,
        purity=asked.share("purity", purity),
        efficiency=asked.share("efficiency", efficiency),
        outcome=outcome,
        up=up,
        without=without,
        turn=turn,
        vary=vary,
        step=asked.amount("step", step, "length", 0.0),
        cutter=asked.amount("cutter", cutter, "length", 0.0),
        play=asked.amount("play", play, "length", 0.0),
        tolerance=asked.amount("tolerance", tolerance, "length", 0.0),
        seed=asked.whole("seed", seed, 0),
        verdicts=asked.whole("verdicts", verdicts),
        seconds=asked.amount("seconds", seconds, "time", 0.0),
        told=progress,
    )


@with_settings
def trial(
    part: Part,
    bowls: Bowl | Sequence[Bowl],
    aspect: str | None = None,
    *,
    parts: int | None = None,
    landing: int | None = None,
    queue: int | None = None,
    poured: bool = TrialOptions.poured,
    seconds: Quantity = TrialOptions.seconds,
    rule: str = RECOMMENDED_RULE,
    known: Shares | None = None,
    measured: Measured | None = None,
    seed: int = 1,
    jobs: int = 1,
    progress: Callable[[int, int], None] | None = None,
    before: Callable[[], None] | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
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
    landing : int, optional
        So many fall onto the moving track as well.
    queue : int, optional
        So many at once, which push each other.
    poured : bool
        Whether these fall onto the track in any attitude; in a row without it.
    seconds : str or float [s]
        For which the queue is followed.
    rule : str
        Whose probabilities say in which shares orientations come.
    known : Shares, optional
        Of ``shares``.
    measured : Measured, optional
        What left a bowl, beside the profile of the queue: ``feederscrew.studies.trial.at_outlet`` reads it.
    seed : int
        Of play and phase.
    jobs : int
        Cores to use; nothing else depends on it.
    progress : callable, optional
        Called with how many parts are done, and of how many.
    before : callable, optional
        Called before anything is compiled.
    overrides, **settings
        As for ``read_bowl``: in place of each bowl's own.

    Returns
    -------
    TrialStudy
        With a run for each bowl.
    """
    return trials.trial(
        asked.a_part(part, mesh=True),
        asked.some_bowls(bowls, overrides, settings),
        asked.an_aspect(aspect),
        rule=rule,
        known=asked.the_shares(known),
        measured=measured,
        parts=asked.count("parts", parts),
        landing=asked.count("landing", landing),
        queue=asked.count("queue", queue),
        poured=poured,
        seconds=asked.amount("seconds", seconds, "time", 0.0),
        seed=asked.whole("seed", seed, 0),
        jobs=asked.whole("jobs", jobs),
        progress=progress,
        before=before,
    )


@with_settings
def report(
    part: Part,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    target: Quantity | None = None,
    bowl: BowlFile | None = None,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    rule: str = RECOMMENDED_RULE,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
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
    gap, fill, rule, launch, probabilities, fed, seed
        As for ``rate``.
    overrides, **settings
        As for ``read_bowl``; they go over those of ``bowl``.

    Returns
    -------
    ReportStudy
        ``rate``, ``convey``, ``slide``, ``track``, ``machine`` ... are the records of those commands.
    """
    file = asked.a_file_of_bowl(bowl)
    path = file.get("path")
    texts = (*override_texts(file.get("overrides", ()), {}), *override_texts(overrides, settings))
    return reports.report(
        asked.a_part(part),
        None if path is None else asked.a_file("path", path),
        texts,
        aspect=aspect,
        heading=asked.angle("heading", heading),
        rule=rule,
        gap=asked.amount("gap", gap, "length", 0.0),
        fill=asked.share("fill", fill, LEAST),
        target=None if target is None else asked.amount("target", target, "rate"),
        launch=launch,
        probabilities=None if probabilities is None else asked.a_file("probabilities", probabilities),
        fed=asked.count("fed", fed),
        seed=asked.whole("seed", seed, 0),
    )


def reproduce() -> Reproduction:
    """Compute every table and figure of the thesis again, as ``feeder reproduce``.

    Returns
    -------
    Reproduction
        Its ``items``, a table or a figure each, have a verdict for every cell.
    """
    return reproduced()
