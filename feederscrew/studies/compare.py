"""The study of ``feeder compare``: what was measured on one part, or on many, against every rule."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from feederscrew.errors import Faults, FeederError
from feederscrew.part import load
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.resting import deviation, profiles
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.recommended import LAUNCH, Recommended
from feederscrew.studies import arguments
from feederscrew.studies.aspects import aspects as resting
from feederscrew.studies.passages import FeedingStudy, feeding

MAX_FILES = 500  # files of one comparison


@dataclass(frozen=True, eq=False)
class CompareStudy(ReadableRecord):
    """Profiles of one part, measured and by rule, and how far every two of them are apart."""

    part: Part
    aspects: Aspects
    measured: profiles.Measured
    rules: tuple[profiles.AspectProfile, ...]
    comparisons: tuple[deviation.Comparison, ...]  # of every two, in the order of the profiles

    @property
    def profiles(self) -> tuple[profiles.AspectProfile, ...]:
        """What was measured, then the rules."""
        return (*self.measured.profiles, *self.rules)

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of the file of counts, by its path."""
        return {self.measured.source: self.measured.sha256}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each."""
        return (*self.aspects.warnings, *self.measured.warnings(self.part))


@dataclass(frozen=True, eq=False)
class SetStudy(ReadableRecord):
    """One measured profile and every answer for its part."""

    part: Part
    aspects: Aspects
    measured: profiles.Measured
    profile: profiles.AspectProfile
    answers: dict[str, profiles.AspectProfile]  # by rule, and the recommended one where there is one

    @property
    def recommended(self) -> Recommended | None:
        """The answer for the launch that was used; None of a card."""
        return self.aspects.recommended

    @property
    def distances(self) -> dict[str, float]:
        """Total variation [1] of the profile from each answer."""
        mine = self.profile.fractions / self.profile.fractions.sum()
        return {
            name: deviation.total_variation(mine, answer.fractions / answer.fractions.sum())
            for name, answer in self.answers.items()
        }

    @property
    def inside(self) -> int | None:
        """How many aspects' shares lie in the interval of the recommended answer; None without one."""
        if self.recommended is None:
            return None
        shares = self.profile.fractions
        return int(((self.recommended.low <= shares) & (shares <= self.recommended.high)).sum())


@dataclass(frozen=True, eq=False)
class SetsStudy(ReadableRecord):
    """Many measured profiles, each against every answer for its part, and feeding tests."""

    sets: tuple[SetStudy, ...]
    inputs: dict[str, str]  # sha256 by path
    feedings: tuple[FeedingStudy, ...] = ()  # the files that count by device

    @property
    def answers(self) -> tuple[str, ...]:
        """Every answer that some set has, in their order."""
        return tuple(dict.fromkeys(name for study in self.sets for name in study.answers))

    @property
    def series(self) -> dict[str, tuple[SetStudy, ...]]:
        """The sets by the series they say they belong to, else by their file."""
        by_series: dict[str, list[SetStudy]] = {}
        for study in self.sets:
            name = study.measured.head.series or Path(study.measured.source).stem
            by_series.setdefault(name, []).append(study)
        return {name: tuple(sets) for name, sets in by_series.items()}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each."""
        listed = [line for study in self.sets for line in study.measured.warnings(study.part)]
        listed += [line for study in self.feedings for line in study.measured.warnings(study.part)]
        studies: tuple[SetStudy | FeedingStudy, ...] = (*self.sets, *self.feedings)
        listed += [f"{study.part.source}: {line}" for study in studies for line in study.aspects.warnings]
        return tuple(dict.fromkeys(listed))


def compare(
    part: Part,
    counts: str | PathLike[str],
    *,
    launch: str | None = None,
    as_published: bool = False,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> CompareStudy | FeedingStudy:
    """Set the rules' probabilities beside counts of a test, as ``feeder compare PART --with COUNTS``.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    counts : str or Path
        CSV file with one line an aspect, one column a profile; or with one line a device.
    launch : str, optional
        What was done to the part; without it what the head of the file says, else 'feed'.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    progress, before : function, optional
        Of the parts on the moving floor, as for ``rate.shares``; a file by device needs them.

    Returns
    -------
    CompareStudy or FeedingStudy
        The second of a file that counts by device.

    Raises
    ------
    FeederError
        Every fault of the file, each with its line.
    """
    part, counts = arguments.a_part(part), arguments.a_file("counts", counts)
    text, sha256 = profiles.read_count_text(counts)
    table = profiles.parse_count_sheet(text, str(counts))
    if profiles.counts_by_device(table):
        tested = profiles.device_counts(table, str(counts), sha256)
        return feeding(part, tested, launch=launch, progress=progress, before=before)
    aspects, rules = _answers(part, table.head, launch, as_published)
    names = [rule.name for rule in rules]
    measured = profiles.measured(table, str(counts), sha256, aspects.names, names)
    compared = deviation.compare((*measured.profiles, *rules))
    return CompareStudy(part, aspects, measured, rules, tuple(compared))


def compare_sets(
    files: Iterable[str | PathLike[str]],
    *,
    launch: str | None = None,
    as_published: bool = False,
    progress: Callable[..., None] | None = None,
) -> SetsStudy:
    """Study how far many measured sets are from every rule and from the recommended answer.

    The head of each of the ``files`` names the part file, from the folder of the counts; the rest is as
    for ``compare``. ``progress`` is called after every file with how many are done, and of how many.
    Raises every fault of the files.
    """
    names = [str(path) for path in files]
    if not 0 < len(names) <= MAX_FILES:
        raise FeederError("files", f"are {len(names)}", f"name 1 to {MAX_FILES} files of counts")
    faults: list[FeederError] = []
    studies: list[SetStudy | FeedingStudy] = []
    inputs: dict[str, str] = {}
    for done, path in enumerate(names, 1):
        try:
            studies += _studies(path, launch, as_published, inputs)
        except FeederError as fault:
            faults += fault.faults if isinstance(fault, Faults) else [fault]
        if progress:
            progress(done, len(names))
    if faults:
        raise Faults(faults)
    sets = tuple(study for study in studies if isinstance(study, SetStudy))
    return SetsStudy(sets, inputs, tuple(study for study in studies if isinstance(study, FeedingStudy)))


def _studies(
    path: str, launch: str | None, as_published: bool, inputs: dict[str, str]
) -> list[SetStudy | FeedingStudy]:
    """Every profile of one file against every answer; of a file by device one FeedingStudy."""
    text, sha256 = profiles.read_count_text(path)
    table = profiles.parse_count_sheet(text, path)
    if not table.head.part:
        raise FeederError(path, "does not say which part was counted", "add a line '# part: FILE' at its top")
    part_path = Path(path).parent / table.head.part
    names = str(Path(path).parent / table.head.names) if table.head.names else None
    part = load(str(part_path), names=names, **table.head.reading)
    inputs |= {path: sha256} | part.inputs
    if profiles.counts_by_device(table):
        fed = feeding(part, profiles.device_counts(table, path, sha256), launch=launch)
        inputs |= fed.inputs
        return [fed]
    aspects, rules = _answers(part, table.head, launch, as_published)
    answers = {rule.name: rule for rule in rules}
    measured = profiles.measured(table, path, sha256, aspects.names, list(answers))
    return [SetStudy(part, aspects, measured, profile, answers) for profile in measured.profiles]


def _answers(
    part: Part, head: profiles.Head, launch: str | None, as_published: bool
) -> tuple[Aspects, tuple[profiles.AspectProfile, ...]]:
    """The aspects of a part with the answer for a launch, and the profiles of all rules and of that."""
    launch = launch or head.launch or LAUNCH
    aspects = resting(part, as_published=as_published, launch=launch).aspects
    rules = profiles.of_rules(aspects)
    if aspects.recommended is not None:
        rules += (profiles.answer_profile(aspects.recommended.p[aspects.stable]),)
    return aspects, rules
