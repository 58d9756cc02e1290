"""What a queue counts: parts that left, fell back, stood, climbed, and how they travelled."""

from dataclasses import dataclass, field

import numpy as np

from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.columns import Column
from feederscrew.trials.staging import Stage

# [m] by which a part of a queue may be in another part or in the track. It is what is asked of single parts:
# a sixth of the thinnest wall among the parts of docs/method/trial.md, of which seven in eight keep it. A
# part that is deeper and stands is held by the trial's contacts, not by the device.
MAX_QUEUE_DEPTH_M = 1e-4


@dataclass(frozen=True, eq=False)
class QueuedParts:
    """Counts of a queue of N parts; D devices, S orientations in which parts may leave, A aspects."""

    parts: int  # N
    on_track: int  # of them at a time, at most; the others wait to enter
    is_poured: bool
    seconds: float  # [s] followed
    counted_seconds: float  # [s] of them since the first part came to the outlet; 0 where none did
    delivered: float  # parts that left the last device then, that in the outlet as the share of its length
    # (S + 1, A + 1) in which orientation whole ones left, the last is none of the known; on which aspect
    # those lay, whatever their heading, the last hung
    whole: Ints
    left_by_entry: Ints  # (M, S + 1, A + 1) the same by the orientation in which they came
    returned_by_entry: Ints  # (M,)
    returned: int  # fell back into the bowl
    jams: int  # stood at a device and were taken out, no deeper in anything than ``MAX_QUEUE_DEPTH_M``
    climbs: int  # times that a part came to lie on others
    velocity: float  # [m/s] mean of all parts
    gap: float  # [m] mean free way between neighbours
    touching: float  # [1] share of the parts that are pushed from behind
    pressure: Floats  # (D,) [N] greatest mean force of a period on a part that stands at a device
    # [m] the deepest that a part was in the track, its wall or a device, and in another part
    depth_in_track: float
    depth_in_part: float
    partial: bool  # stopped by the user: of the seconds until then
    # (M, D + 1) where those that were returned fell: on the bare track before the devices, at each device
    returned_at: Ints = field(default_factory=lambda: np.zeros((0, 0), int))
    # (M, D + 1) where those stood that were taken out, columns as of ``returned_at``
    jammed_at: Ints = field(default_factory=lambda: np.zeros((0, 0), int))
    overlaps: int = 0  # stood as a jam does, deeper in something: faults of the trial, taken out as well
    relieved: int = 0  # of those returned, backed up at a pressure break and pushed off there
    # (F, N, 7) position [m] and attitude w x y z (principal axes to bowl), evenly over the time; NaN of a
    # part that waits to enter
    poses: Floats = field(default_factory=lambda: np.zeros((0, 0, 7)))
    moments: tuple[tuple[float, int, int], ...] = ()  # time [s], parts left and returned by then, of each
    stage: Stage | None = None  # the track with all its devices, on which they lie
    pulses: tuple[tuple[tuple[float, float], ...], ...] = ()  # [s] begin and end of each, by sensor

    @property
    def rate(self) -> float:
        """Return delivered parts [1/s]; 0 where none came to the outlet."""
        return self.delivered / self.counted_seconds if self.counted_seconds > 0.0 else 0.0

    @property
    def depth(self) -> float:
        """Return the deepest that a part was in anything [m]."""
        return max(self.depth_in_track, self.depth_in_part)

    @property
    def leaving_counts(self) -> Ints:
        """Return (S + 1,) int, in which orientation whole parts left; the last is none of the known."""
        return self.whole.sum(axis=1)

    @property
    def aspects(self) -> Ints:
        """Return (A + 1,) int, on which aspect whole parts left, whatever their heading; the last hung."""
        return self.whole.sum(axis=0)


QUEUED_COLUMNS: tuple[Column[QueuedParts], ...] = (
    Column("parts", lambda queue: queue.parts),
    Column("on_track", lambda queue: queue.on_track),
    Column("poured", lambda queue: queue.is_poured),
    Column("seconds", lambda queue: queue.seconds),
    Column("counted_seconds", lambda queue: queue.counted_seconds),
    Column("delivered", lambda queue: queue.delivered),
    Column("returned", lambda queue: queue.returned),
    Column("backed_up", lambda queue: queue.relieved),
    Column("jams", lambda queue: queue.jams),
    Column("overlaps", lambda queue: queue.overlaps),
    Column("climbs", lambda queue: queue.climbs),
    Column("velocity_mm_s", lambda queue: queue.velocity, "mm/s"),
    Column("mean_gap_mm", lambda queue: queue.gap, "mm"),
    Column("touching", lambda queue: queue.touching),
    Column("penetration_in_track_mm", lambda queue: queue.depth_in_track, "mm"),
    Column("penetration_in_part_mm", lambda queue: queue.depth_in_part, "mm"),
    Column("largest_penetration_mm", lambda queue: queue.depth, "mm"),
)


class QueueCounts:
    """Counts of a queue as it goes on; lengths in units of the part's, times in seconds.

    Parameters
    ----------
    orientations, poses, aspects, devices : int
        M orientations in which parts come, S poses in which they may leave, A aspects, D devices.
    """

    def __init__(self, orientations: int, poses: int, aspects: int, devices: int) -> None:
        self.left = np.zeros((orientations, poses + 1, aspects + 1), int)  # as ``QueuedParts.left_by_entry``
        self.returned_at, self.jammed_at = np.zeros((2, orientations, devices + 1), int)
        self.returned = self.jams = self.climbs = self.relieved = self.whole = self.overlaps = 0
        self.max_on_track = 0
        self.pressure = np.zeros(devices)  # (D,) of the part's weight
        self.depths = np.zeros(2)  # [L] the deepest in the track, and in another part
        self.ways: list[float] = []  # [L] mean of all parts, a period each
        self.free_ways: list[float] = []  # [L] between neighbours
        self.touch_shares: list[float] = []  # [1] of the parts that are pushed, a period each
        self.first_time: float | None = None  # [s] when the first part came to the outlet
        self.first_share = 0.0  # [1] of it that had left then

    def note_first(self, time: float, share: float) -> None:
        """Note when the first part came to the outlet; of later ones nothing.

        Parameters
        ----------
        time : float [s]
        share : float [1]
            Of its length that has left by then.
        """
        if self.first_time is None:
            self.first_time, self.first_share = time, share

    def note_left(self, entry: int, pose: int, aspect: int) -> None:
        """Count a part that has left.

        Parameters
        ----------
        entry : int
            Row of the orientation in which it came.
        pose, aspect : int
            In which it left; -1 where it is not known.
        """
        self.whole += 1
        self.left[entry, pose, aspect] += 1

    def note_returned(self, entry: int, device: int) -> None:
        """Count a part that fell back into the bowl.

        Parameters
        ----------
        entry : int
            Row of the orientation in which it came.
        device : int
            Number of the last device it has come to, from 1; 0 before the first.
        """
        self.returned += 1
        self.returned_at[entry, device] += 1

    def note_jam(self, entry: int, device: int) -> None:
        """Count a part that stood at a device and was taken out.

        Parameters
        ----------
        entry : int
            Row of the orientation in which it came.
        device : int
            Number of the device, from 1.
        """
        self.jams += 1
        self.jammed_at[entry, device] += 1

    def note_pressure(self, device: int, force: float) -> None:
        """Keep the greatest force [1] of the weight on a part that stands at a device, counted from 0."""
        self.pressure[device] = max(self.pressure[device], force)

    def counted_seconds(self, time: float) -> float:
        """Return how long [s] parts have been counted at a time [s]; 0 where none came to the outlet."""
        return 0.0 if self.first_time is None else time - self.first_time
