"""One steady cycle, drawn out: where plate and part are, and in which phase."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.conveying.harmonic import onward, travel
from feederscrew.conveying.law import law
from feederscrew.conveying.point_motion import TALLY, TRAVEL, at_rest, step
from feederscrew.conveying.setting import FLIGHT, FORWARD, STICK, TURN
from feederscrew.conveying.settling import settle

SHOWN = 4  # periods at most
SAMPLES = 240  # a period; every phase has at least a few


@dataclass(frozen=True, eq=False)
class CycleTrace:
    """Plate and part over a cycle; ways in units of the amplitude."""

    time: np.ndarray  # (N,) [periods]
    phase: np.ndarray  # (N,) places in ``setting.PHASES``
    plate_along: np.ndarray  # (N,) along the track
    part_along: np.ndarray
    plate_normal: np.ndarray  # (N,) along its normal
    part_normal: np.ndarray


def trace(setting):
    """Return the steady cycle a part falls into from rest.

    Parameters
    ----------
    setting : OperatingPoint

    Returns
    -------
    CycleTrace
        Of at most four periods; of a motion without a period, the last ones followed.
    """
    rules = law(setting)
    state, period = settle(rules, at_rest(rules))
    pieces, tally = [], np.zeros(TALLY)
    for count in range(min(period, SHOWN) if period > 0 else SHOWN):
        while state.angle < TURN:
            before = tally[TRAVEL]
            after = step(rules, state, tally)
            pieces.append(_piece(rules, state, after.angle, before, count))
            state = after
        state = state._replace(angle=0.0)
    time, phase, slip, height = np.concatenate(pieces, axis=1)
    return _around_plate(setting, time, phase.astype(int), slip, height)


def _piece(rules, state, end, way, count):
    """Time, phase, way relative to the plate and height in one phase, sampled to both of its ends."""
    span = end - state.angle
    samples = np.linspace(0.0, span, max(2, round(SAMPLES * span / TURN)))
    sign = 1.0 if state.phase in (FORWARD, FLIGHT) else -1.0
    growth = {STICK: None, FORWARD: rules.slip, FLIGHT: rules.free}.get(state.phase, rules.slip_back)
    slip, height = np.full_like(samples, way), np.zeros_like(samples)
    if growth is not None:
        arc = onward(growth, state.angle)
        slip += [state.speed * x + sign * travel(arc, x) for x in samples]
    if state.phase == FLIGHT:
        arc = onward(rules.lift, state.angle)
        height += [state.height + state.rising * x + travel(arc, x) for x in samples]
    time = count + (state.angle + samples) / TURN
    return np.stack([time, np.full_like(samples, state.phase), slip, height])


def _around_plate(setting, time, phase, slip, height):
    along = np.cos(setting.angle) * _displacement(setting, TURN * time + setting.lead)
    normal = np.sin(setting.angle) * _displacement(setting, TURN * time)
    ways = (time, phase, along, along + slip, normal, normal + height)
    return CycleTrace(*(check.frozen(array) for array in ways))


def _displacement(setting, angle):
    """Of the plate along its direction of vibration [A]."""
    return np.sin(angle) + setting.second * np.sin(2.0 * angle + setting.second_phase)
