"""Hop of a part over the track in a period of the drive: its height and its flight."""

import functools
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.base.columns import Column
from feederscrew.bowl.record import Bowl
from feederscrew.motion.conveying import LEAST_ACCELERATION_RATIO, settings
from feederscrew.motion.operating_point import FLIGHT, OperatingPoint, law, throw_number
from feederscrew.motion.point_motion import TALLY, TRAVEL, at_rest, step
from feederscrew.motion.steady import settle
from feederscrew.motion.waves import PERIOD_RAD, after, gain, onward, travel

FOLLOWED_PERIODS = 32  # periods of a motion that does not repeat
HOP_MARGIN_M = 2.5e-4  # that a static verdict has where it counts as sure
PEAK_HALVINGS = 60  # of the span in which a part is highest


@dataclass(frozen=True)
class Hop:
    """The motion of a part between two contacts with the track; all 0 where it never leaves the track."""

    height: float  # [m] greatest gap between part and track, along the normal of the track
    flight: float  # [m] longest way along the track, relative to the track, in one flight
    duration: float  # [periods] of the longest flight

    @property
    def text(self) -> str:
        """Return height and length in words."""
        return f"{1e3 * self.height:.2g} mm high and {1e3 * self.flight:.2g} mm far"


HOP_COLUMNS: tuple[Column[Hop], ...] = (
    Column("hop_height_mm", lambda leap: leap.height, "mm"),
    Column("hop_flight_mm", lambda leap: leap.flight, "mm"),
    Column("hop", lambda leap: leap.text),
)


def hop(bowl: Bowl) -> Hop:
    """Return how high and how far a point mass that does not rebound hops in the steady motion of a bowl.

    At the throw number k the part leaves the track at the angle asin(1 / k) of the drive. From there the gap
    grows by g (k sin(w t) - 1), integrated twice. Its height in units of g / w^2 and its duration in periods
    depend on k alone: 1.77 and 0.68 at 1.8, 3.79 and 0.81 at 2.3. So the height falls with the square of the
    frequency.

    Parameters
    ----------
    bowl : Bowl
        Single values; its devices and its restitution are not used.

    Returns
    -------
    Hop
        Heights [m] are 0 up to the throw number of 1.

    References
    ----------
    Sloot and Kruyt, Powder Technology 87, 203-210, 1996: the flight between two plastic impacts, as in
    ``answer.throw_of_flight``.
    """
    setting = OperatingPoint(*settings(replace(bowl, devices=())).tolist())
    if setting.ratio <= LEAST_ACCELERATION_RATIO:
        return Hop(0.0, 0.0, 0.0)
    height, flight, duration = _hop(setting._replace(restitution=0.0))
    amplitude = float(bowl.drive.amplitude)
    return Hop(height * amplitude, flight * amplitude, duration)


def remark(bowl: Bowl) -> tuple[str, ...]:
    """Return a sentence if a bowl's drive throws parts higher than ``HOP_MARGIN_M``.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    tuple of str
        Empty where it does not.
    """
    own = hop(bowl)
    text = (
        f"parts hop {own.text}: an edge, rail or blade that a part passes by less, and a hole that is "
        "shorter, are not sure to hold - feeder trial tries them"
    )
    return (text,) if own.height > HOP_MARGIN_M else ()


@functools.lru_cache(maxsize=4096)
def _hop(setting: OperatingPoint) -> tuple[float, float, float]:
    """Return the greatest gap [A], the longest flight relative to the track [A] and in periods."""
    rules = law(setting)
    if throw_number(rules) <= 1.0:
        return 0.0, 0.0, 0.0
    state, period = settle(rules, at_rest(rules))
    tally = np.zeros(TALLY)
    height = farthest = longest = distance = 0.0
    # One period more than those after which it repeats: a flight may begin in the last one.
    for _ in range(period + 1 if period > 0 else FOLLOWED_PERIODS):
        while state.angle < PERIOD_RAD:
            before = tally[TRAVEL]
            following = step(rules, state, tally)
            if state.phase == FLIGHT:
                span = following.angle - state.angle
                # The greatest height: it rises until the plate's pull turns, then until its speed is gone.
                arc = onward(rules.lift, state.angle)
                low = min(max(after(rules.lift.falls, state.angle) - state.angle, 0.0), span)
                high = span
                if state.rising + gain(arc, low) <= 0.0:
                    low = 0.0
                for _ in range(PEAK_HALVINGS):
                    middle = 0.5 * (low + high)
                    low, high = (middle, high) if state.rising + gain(arc, middle) > 0.0 else (low, middle)
                gap = max(state.height, state.height + state.rising * low + travel(arc, low))
                height = max(height, gap)
                distance = tally[TRAVEL] - before + (distance if state.aloft > 0.0 else 0.0)
                farthest, longest = max(farthest, abs(distance)), max(longest, state.aloft + span)
            state = following
        state = state._replace(angle=0.0)
    return height, farthest, longest / PERIOD_RAD
