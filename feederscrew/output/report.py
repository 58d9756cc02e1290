"""The study of ``feeder report``: what the other studies find of one part in one bowl, each on request."""

import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike

from feederscrew import bowl as bowls
from feederscrew.arrivals import entry
from feederscrew.arrivals.aspects_study import AspectsStudy
from feederscrew.arrivals.entry import Shares
from feederscrew.arrivals.floor import FloorStudy, floor
from feederscrew.base import check
from feederscrew.base.records import ReadableRecord
from feederscrew.bowl import arguments
from feederscrew.bowl.arguments import Path, Quantity, former_keywords
from feederscrew.bowl.reading import Setting, has_machine
from feederscrew.bowl.record import Bowl
from feederscrew.cad import solid as solidbowl
from feederscrew.cad.closed_body import BowlSolid
from feederscrew.feeding import rate as rates
from feederscrew.feeding.rate import MIN_POSITIVE
from feederscrew.machine import sheet as machines
from feederscrew.machine.sheet import MachineSheet
from feederscrew.motion import convey
from feederscrew.motion.convey import ConveyMap, ConveyStudy
from feederscrew.motion.slide import SlideStudy, slide
from feederscrew.part.inertia import InertiaStudy, inertia
from feederscrew.part.record import Part
from feederscrew.resting.posture import posture
from feederscrew.sorting.headings import HeadingsStudy, headings
from feederscrew.sorting.track import TrackStudy, track
from feederscrew.trials.trial import TrialStudy, trial

# cells of the velocity map
ANGLES = 56
STROKES = 48
LEAST_STROKE = 0.1e-3  # [m] the velocity map goes at least so far
RECOMMENDED = "recommended"  # the default rule
STROKE_RANGE = 2.5  # and to so many times the bowl's own stroke


@dataclass(frozen=True, eq=False)
class ReportStudy(ReadableRecord, view="report_page.REPORT_VIEW"):
    """A part, the aspect wanted of it, and a bowl, checked; every chapter's study when it is asked for."""

    resting: AspectsStudy
    settings: tuple[Setting, ...]
    bowl: Bowl
    path: str | PathLike[str] | None  # of the bowl file
    aspect: str  # the wanted one
    heading: float | None  # [rad]
    rule: str
    gap: float  # [m]
    fill: float  # [1]
    target: float | None  # [1/s] that a bowl is sized for
    counted: str | None  # aspect that counts for the target; None: whatever passes
    shares: Shares  # whose probabilities are taken
    inputs: dict[str, str] = field(default_factory=dict)  # sha256 by path
    command: str = ""  # that repeats it
    sent: int | None = None  # parts of a trial; None without one
    as_tried: bool = False  # a trial of the bowl file holds: its drive is kept for the target

    @property
    def part(self) -> Part:
        """The part."""
        return self.resting.part

    @property
    def row(self) -> int:
        """Return the row of the wanted aspect among the aspects."""
        return self.resting.aspects.names.index(self.aspect)

    @property
    def likeliest(self) -> str:
        """The aspect it rests on most often."""
        return self.resting.aspects.likeliest

    @cached_property
    def inertia(self) -> InertiaStudy:
        """Mass properties, an InertiaStudy."""
        return inertia(self.part)

    @cached_property
    def headings(self) -> HeadingsStudy:
        """The stable headings of every aspect, a HeadingsStudy."""
        return headings(self.part, self.bowl, aspects=self.resting.aspects)

    @cached_property
    def convey(self) -> ConveyStudy:
        """Velocity at the bowl's own point, a ConveyStudy."""
        return convey.convey(self.bowl)

    @cached_property
    def track(self) -> TrackStudy:
        """The part on the track, a TrackStudy."""
        return track(self.part, self.bowl, self.aspect, heading=self.heading)

    @cached_property
    def floor(self) -> FloorStudy:
        """The part on the floor, a FloorStudy."""
        return floor(self.part, self.bowl, self.aspect, heading=self.heading or 0.0)

    @cached_property
    def slide(self) -> SlideStudy:
        """When a part slips, a SlideStudy."""
        return slide(self.bowl)

    @cached_property
    def velocity_map(self) -> ConveyMap:
        """Velocity over vibration angle and stroke, with the bowl's own point, a ConveyMap."""
        top = 1e3 * max(STROKE_RANGE * self.bowl.drive.amplitude, LEAST_STROKE)
        strokes = f"drive.amplitude={0.02 * top:.4g}mm:{top:.4g}mm:{STROKES}"
        spans = bowls.key_ranges((f"drive.vibration_angle=5deg:60deg:{ANGLES}", strokes))
        return convey.velocity_map(self.settings, spans, drawn="point")

    @cached_property
    def rate(self) -> rates.RateStudy:
        """Well-oriented parts, a RateStudy: of the wanted aspect, without one of what leaves most often."""
        return rates.rate(
            self.part,
            self.bowl,
            self.counted,
            heading=self.heading,
            rule=self.rule,
            gap=self.gap,
            fill=self.fill,
            aspect_shares=self.shares,
        )

    @cached_property
    def passages(self) -> rates.PassagesStudy | None:
        """Return the passage of each orientation through the bowl's devices; None without such devices."""
        if not any(device.action.has_place for device in self.bowl.devices):
            return None
        return rates.passages(self.part, self.bowl, self.resting.aspects, self.rule)

    @cached_property
    def trial(self) -> TrialStudy | None:
        """Parts sent through the devices one by one, a TrialStudy; None where it was not asked for."""
        if self.sent is None:
            return None
        jobs, own = os.cpu_count() or 1, (self.part, [self.bowl])
        return trial(*own, rule=self.rule, aspect_shares=self.shares, parts=self.sent, jobs=jobs)

    @cached_property
    def machine(self) -> MachineSheet | None:
        """The bowl for the target, or the machine of the bowl file; None without either."""
        if self.target is not None:
            heading = self.heading if self.counted else None
            return machines.size_machine(
                self.settings,
                self.part,
                self.target,
                aspect=self.counted,
                heading=heading,
                rule=self.rule,
                gap=self.gap,
                fill=self.fill,
                aspects=self.resting.aspects,
                as_tried=self.as_tried,
            )
        has_own_machine = has_machine({s.key.name for s in self.settings if s.is_own})
        if not has_own_machine:
            return None
        return replace(machines.machine(self.settings), as_tried=self.as_tried)

    @cached_property
    def solid(self) -> BowlSolid | None:
        """The bowl for the target as a BowlSolid; None without a target, or of a part without a mesh."""
        if self.target is None or self.part.vertices is None:
            return None
        return solidbowl.of_sheet(self.machine, self.settings, self.resting.aspects)


@former_keywords()
def report(
    part: Part,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    target: Quantity | None = None,
    bowl: Bowl | None = None,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    rule: str = RECOMMENDED,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    sent: int | None = None,
    command: str = "",
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> ReportStudy:
    """Gather all that is known of a part in a bowl, as ``feeder report``: each chapter when it is asked for.

    Parameters
    ----------
    part : Part
    aspect : str, optional
        The one wanted. Without it the likeliest, and of the rate what leaves most often.
    heading : str or float [rad], optional
        Of that aspect.
    target : str or float [1/s], optional
        Rate that a bowl is sized for.
    bowl : Bowl, optional
        As ``read_bowl`` returns it; that of the defaults without it.
    gap : str or float [m]
    fill : float [1]
    rule : str
    launch : str, optional
    probabilities : str or Path, optional
    fed : int, optional
    seed : int
        These seven as for ``rate``.
    sent : int, optional
        Parts of a trial, which is a chapter then.
    command : str
        Call that repeats the report; it stands at its head.
    progress, before : callable, optional
        As for ``shares``.

    Returns
    -------
    ReportStudy
        ``rate``, ``convey``, ``slide``, ``track``, ``machine`` ... are the records of those commands.

    Raises
    ------
    FeederError
        If there is no such aspect or rule, or the bowl file has faults.
    """
    if isinstance(bowl, Mapping):
        text = "report() takes a dict as bowl for one more release: write bowl=read_bowl(path, overrides)"
        warnings.warn(text, DeprecationWarning, stacklevel=3)
        bowl = arguments.bowl_of_file(bowl)
    chosen = arguments.a_bowl(bowls.default() if bowl is None else bowl)
    part = arguments.a_part(part)
    aspect, angle = arguments.an_orientation(aspect, heading)
    space = arguments.amount("gap", gap, "length", 0.0)
    check.argument("fill", fill, MIN_POSITIVE, 1.0)
    wanted = None if target is None else arguments.amount("target", target, "rate")
    entry.check_wanted(part, aspect, angle)
    aspect_shares = entry.shares(
        part,
        chosen,
        rule=rule,
        launch=launch,
        probabilities=probabilities,
        fed=fed,
        seed=seed,
        progress=progress,
        before=before,
    )
    aspects = aspect_shares.aspects
    rule = aspects.ranking if rule == RECOMMENDED else rule  # a card has no such answer
    return ReportStudy(
        resting=AspectsStudy(part, aspects),
        settings=arguments.settings_of(chosen),
        bowl=chosen,
        path=chosen.source,
        aspect=posture(part, aspects, aspects.likeliest if aspect is None else aspect).name,
        heading=angle,
        rule=arguments.a_rule(rule, aspects),
        gap=space,
        fill=fill,
        target=wanted,
        counted=aspect,
        shares=aspect_shares,
        inputs=part.inputs | bowls.identity(chosen.source) | aspect_shares.inputs,
        command=command,
        sent=sent,
    )
