"""A slot between rails that is made wider, where a trial loses what shall hang in it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from feederscrew.tooling.isolating.chain import in_mm, judge_cut
from feederscrew.tooling.isolating.design import RAIL
from feederscrew.tooling.orientations import Orientation, neck

STEP = 5e-5  # [m] to which a shop makes a value
WIDER, HELD = 0.35, 0.8  # of what the head is wider than the slot; of the head, that a slot may be


def widened(proposal: Any, every: Sequence[Orientation]) -> Any:
    """Return the proposal with a wider slot between its rails; None without rails that can be wider.

    A part lies askew along the wall: it comes to rails narrowed to its shank beside them, and slides on. The
    slot grows towards the head, about its middle, as long as the head is held by the rails.
    """
    for place, cut in enumerate(proposal.cuts):
        found = neck(every[proposal.row]) if cut.device.hangs else None
        if found is None:
            continue
        first, last = cut.device.span
        more = float(np.round(0.5 * WIDER * (found.head - (last - first)) / STEP) * STEP)
        span = max(first - more, RAIL), last + more
        if more < STEP or span == cut.device.span or last - first > HELD * found.head:
            continue
        device = cut.device.with_span(span)
        must = np.array([one.name in cut.returns for one in every])
        other = judge_cut(every, proposal.row, device, must, cut.smallest, cut.largest)
        cuts = (*proposal.cuts[:place], other, *proposal.cuts[place + 1 :])
        return replace(proposal, cuts=cuts, step=f"slot widened to {in_mm(span[1] - span[0])}")
    return None
