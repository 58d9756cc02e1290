"""The study of ``feeder report``: what the other studies find of one part in one bowl, each on request."""

import os
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from typing import Any, TypedDict, Unpack

from feederscrew import bowl as bowls
from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.settings import Setting, has_machine
from feederscrew.errors import ArgumentError
from feederscrew.part.record import Part
from feederscrew.records import Shown
from feederscrew.resting.posture import posture
from feederscrew.running import ToldKeywords
from feederscrew.solidbowl.closed_body import BowlSolid
from feederscrew.studies import bowl as machines
from feederscrew.studies import convey, solidbowl
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.studies.bowl import MachineSheet
from feederscrew.studies.convey import ConveyMap, ConveyStudy
from feederscrew.studies.floor import FloorStudy, floor
from feederscrew.studies.headings import HeadingsStudy, headings
from feederscrew.studies.inertia import InertiaStudy, inertia
from feederscrew.studies.passages import PassagesStudy, passages
from feederscrew.studies.rate import RateStudy, Shares, Spacing, SpacingKeywords, rate, shares
from feederscrew.studies.slide import SlideStudy, slide
from feederscrew.studies.track import TrackStudy, track
from feederscrew.studies.trial import TrialStudy, trial

ANGLES, STROKES = 56, 48  # cells of the velocity map
LEAST_STROKE = 0.1e-3  # [m] the velocity map goes at least so far
RECOMMENDED = "recommended"  # the default rule
ROOM = 2.5  # and to so many times the bowl's own stroke


@dataclass(frozen=True, eq=False)
class ReportStudy(Shown):
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
        """Of the wanted aspect."""
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
        return headings(self.part, self.bowl.track, aspects=self.resting.aspects)

    @cached_property
    def convey(self) -> ConveyStudy:
        """Velocity at the bowl's own point, a ConveyStudy."""
        return convey.convey(self.bowl)

    @cached_property
    def velocity_map(self) -> ConveyMap:
        """Velocity over vibration angle and stroke, with the bowl's own point, a ConveyMap."""
        top = 1e3 * max(ROOM * self.bowl.drive.amplitude, LEAST_STROKE)
        strokes = f"drive.amplitude={0.02 * top:.4g}mm:{top:.4g}mm:{STROKES}"
        spans = bowls.key_ranges((f"drive.vibration_angle=5deg:60deg:{ANGLES}", strokes))
        return convey.velocity_map(self.settings, spans, drawn="point")

    @cached_property
    def rate(self) -> RateStudy:
        """Well-oriented parts, a RateStudy."""
        return rate(
            self.part, self.bowl, self.aspect, heading=self.heading, rule=self.rule,
            gap=self.gap, fill=self.fill, known=self.shares,
        )  # fmt: skip

    @cached_property
    def passages(self) -> PassagesStudy | None:
        """What the bowl's devices do with each orientation, a PassagesStudy; None without such devices."""
        if not any(device.placed for device in self.bowl.devices):
            return None
        return passages(self.part, self.bowl, self.resting.aspects, self.rule)

    @cached_property
    def trial(self) -> TrialStudy | None:
        """Parts sent through the devices one by one, a TrialStudy; None where it was not asked for."""
        if self.sent is None:
            return None
        jobs = os.cpu_count() or 1
        return trial(self.part, [self.bowl], rule=self.rule, known=self.shares, parts=self.sent, jobs=jobs)

    @cached_property
    def machine(self) -> MachineSheet | None:
        """The bowl for the target, or the machine of the bowl file; None without either."""
        if self.target is not None:
            heading = self.heading if self.counted else None
            return machines.bowl(
                self.settings, self.part, self.target,
                aspect=self.counted, heading=heading, rule=self.rule, gap=self.gap, fill=self.fill,
                known=self.resting.aspects, as_tried=self.as_tried,
            )  # fmt: skip
        given = has_machine({s.key.name for s in self.settings if s.given})
        return machines.machine(self.settings) if given else None

    @cached_property
    def solid(self) -> BowlSolid | None:
        """The bowl for the target as a BowlSolid; None without a target, or of a part without a mesh."""
        if self.target is None or self.part.vertices is None:
            return None
        return solidbowl.of_sheet(self.machine, self.settings, self.resting.aspects)

    @cached_property
    def track(self) -> TrackStudy:
        """The part on the track, a TrackStudy."""
        return track(self.part, self.bowl, self.aspect, self.heading)

    @cached_property
    def floor(self) -> FloorStudy:
        """The part on the floor, a FloorStudy."""
        return floor(self.part, self.bowl, self.aspect, self.heading or 0.0)

    @cached_property
    def slide(self) -> SlideStudy:
        """The sliding map, a SlideStudy."""
        return slide(self.bowl)


class AnswerKeywords(ToldKeywords, total=False):
    """Keywords of ``report`` that ``studies.rate.shares`` receives."""

    launch: str | None
    probabilities: str | PathLike[str] | None
    fed: int | None
    seed: int


class PageKeywords(TypedDict, total=False):
    """Keywords of ``report`` that its record receives."""

    command: str
    sent: int | None


class ReportKeywords(AnswerKeywords, PageKeywords, SpacingKeywords, total=False):
    """The keywords of ``report`` that few callers need."""


ANSWER, PAGE = AnswerKeywords.__optional_keys__, PageKeywords.__optional_keys__


def report(
    part: Part,
    path: str | PathLike[str] | None = None,
    overrides: Iterable[str] = (),
    *,
    aspect: str | None = None,
    heading: float | None = None,
    rule: str = RECOMMENDED,
    target: float | None = None,
    **options: Unpack[ReportKeywords],
) -> ReportStudy:
    """Check everything that can be wrong with the inputs of a report, before anything long is computed.

    Parameters
    ----------
    part : Part
    path, overrides
        As for ``bowl.read``.
    aspect : str, optional
        The wanted one; without it, the likeliest.
    heading : float [rad], optional
    rule : str
        Whose probabilities count for the rate.
    target : float [1/s], optional
        Rate that a bowl is sized for.
    **options
        gap : float [m], fill : float [1] : as for ``studies.rate.rate``.
        launch, probabilities, fed, seed, progress, before : as for ``studies.rate.shares``.
        command : str, that repeats the report.
        sent : int, parts of a trial, which is a chapter then.

    Returns
    -------
    ReportStudy

    Raises
    ------
    FeederError
        If there is no such aspect or rule, or the bowl file has faults.
    """
    spacing = check.options("report", Spacing, options, beside=ANSWER | PAGE)
    settings = bowls.settings(path, overrides)
    bowl = bowls.record(settings)
    known = shares(part, bowl, rule=rule, **_of(options, ANSWER))
    found = known.aspects
    rule = found.ranking if rule == RECOMMENDED else rule  # a card has no such answer
    if rule not in found.chances:
        names = ", ".join(found.chances)
        raise ArgumentError(f"rule {rule}", "has no probabilities of this part", f"choose one of {names}")
    return ReportStudy(
        resting=AspectsStudy(part, found),
        settings=settings,
        bowl=bowl,
        path=path,
        aspect=posture(part, found, found.likeliest if aspect is None else aspect).name,
        heading=heading,
        rule=rule,
        gap=spacing.gap,
        fill=spacing.fill,
        target=target,
        counted=aspect,
        shares=known,
        inputs=part.inputs | bowls.identity(path) | known.inputs,
        **_of(options, PAGE),
    )


def _of(options: Mapping[str, Any], names: Collection[str]) -> dict[str, Any]:
    """Those of some keywords that were given."""
    return {name: value for name, value in options.items() if name in names}
