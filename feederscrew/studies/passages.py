"""What the devices of a bowl do with each orientation of a part, and what passed them in a feeding test."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.dropping.ensemble import wilson
from feederscrew.errors import ArgumentError, FeederError
from feederscrew.part.record import Part, refuse_many_facets
from feederscrew.rates import stream
from feederscrew.rates.tipping import marked
from feederscrew.records import ReadableRecord
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.profiles import DeviceCounts
from feederscrew.studies.rate import shares
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.orientations import Orientation, orientations
from feederscrew.tooling.track_sections import Passage, until_returned


@dataclass(frozen=True, eq=False)
class PassagesStudy(ReadableRecord):
    """Each orientation at the worst place of each device that it meets; M orientations."""

    devices: tuple[Device, ...]  # without measured yields
    orientations: tuple[Orientation, ...]
    shares: np.ndarray  # (M,) [1]
    passages: tuple[tuple[Passage, ...], ...]  # (M,) up to the device that returns it

    @property
    def wanted(self) -> int:
        """Place of the most frequent orientation that leaves; of the most frequent one where none does."""
        leaves = [not orientation.returned and all(k.verdict.passes > 0.0 for k in until_gone)
                  for orientation, until_gone in zip(self.orientations, self.passages)]  # fmt: skip
        shares = np.round(self.shares, 9)
        return int(np.argmax(np.where(leaves, shares, 0.0) if any(leaves) else shares))


def passages(part: Part, bowl: Bowl, aspects: Aspects, rule: str) -> PassagesStudy:
    """Study what a bowl's devices do with each orientation of a part from a mesh.

    The rule is whose probabilities are taken. Raises FeederError if the part has very many facets.
    """
    if any(device.placed for device in bowl.devices):
        refuse_many_facets(part)
    coming, _ = marked(orientations(part, aspects, bowl.track), bowl)
    devices = tuple(device for device in bowl.devices if device.placed)
    return PassagesStudy(
        devices=devices,
        orientations=coming,
        shares=np.nan_to_num([orientation.chances[rule] for orientation in coming]),
        passages=tuple(tuple(until_returned(devices, orientation, coming)) for orientation in coming),
    )


@dataclass(frozen=True, eq=False)
class FeedingStudy(ReadableRecord):
    """A feeding test of one part in one bowl; D devices that were counted."""

    part: Part
    bowl: Bowl
    config: str  # path of the bowl file
    aspects: Aspects
    measured: DeviceCounts
    stations: tuple[str, ...]  # (D,) as 'gap_2'
    answers: dict[str, np.ndarray]  # (D,) [1] share that passes, by whose shares of the aspects
    low: np.ndarray  # (D,) [1] of the recommended answer's interval
    high: np.ndarray  # (D,) [1]

    @property
    def answer(self) -> str:
        """Say whose shares of the aspects the prediction takes."""
        return self.aspects.source("recommended")

    @property
    def ends(self) -> np.ndarray:
        """(D, 2) [1] the 95 % interval of the share that was measured."""
        pairs = zip(self.measured.passed, self.measured.rejected)
        return np.array([[float(end[0]) for end in wilson([on], on + off)] for on, off in pairs])

    @property
    def agrees(self) -> np.ndarray:
        """(D,) bool, whether the predicted and the measured interval have something in common."""
        low, high = self.ends.T
        return (self.low <= high) & (low <= self.high)

    @property
    def inputs(self) -> dict[str, str]:
        """The sha256 of the files, by path."""
        return {self.measured.source: self.measured.sha256} | bowls.identity(self.config)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user must not overlook, a sentence each."""
        return (*self.aspects.warnings, *self.measured.warnings(self.part))


def feeding(
    part: Part,
    counts: DeviceCounts,
    *,
    launch: str | None = None,
    progress: Callable[..., None] | None = None,
    before: Callable[..., None] | None = None,
) -> FeedingStudy:
    """Study what passed the devices of the bowl that a feeding test names.

    The launch is what was done to the part; without it what the head of the file says, else parts are fed
    onto the moving floor of that bowl. ``progress`` and ``before`` are as for ``rate.shares``. Raises
    FeederError if the file names no bowl, or a device that the bowl does not have.
    """
    config, bowl = bowl_of(counts)
    launch = launch or counts.head.launch or None
    aspects = shares(part, bowl, launch=launch, progress=progress, before=before).aspects
    flow, stations = counted_flow(part, aspects, bowl, counts)
    if (answer := aspects.recommended) is None:
        raise ArgumentError("part", "is a part card, which meets no device", "give a mesh")
    low, high = stream.passing_ends(flow, answer.low, answer.high)
    return FeedingStudy(
        part=part,
        bowl=bowl,
        config=config,
        aspects=aspects,
        measured=counts,
        stations=stations,
        answers={rule: check.frozen(stream.passing_shares(flow, p)) for rule, p in aspects.chances.items()},
        low=check.frozen(low),
        high=check.frozen(high),
    )


def bowl_of(counts: DeviceCounts) -> tuple[str, Bowl]:
    """Return the path of the bowl file that a feeding test names, and its Bowl."""
    if not counts.head.config:
        what = "counts by device but does not name the bowl"
        raise FeederError(counts.source, what, "add a line '# config: FILE' at its top")
    config = str(Path(counts.source).parent / counts.head.config)
    return config, bowls.read(config)


def counted_flow(
    part: Part, aspects: Aspects, bowl: Bowl, counts: DeviceCounts
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return which share of each aspect's parts comes to each counted device, and which goes on from it.

    (2, D, A) [1], and the names of the D devices. The bowl has its devices and its drive, as ``feeder
    rate`` takes them.
    """
    followed = stream.follow_orientations(part, aspects, bowl.track, bowl.devices, bowl=bowl)
    places = stream.counted_stations(followed, counts)
    flow = stream.station_shares(followed, aspects.names)[:, places]
    return flow, tuple(followed.names[place] for place in places)
