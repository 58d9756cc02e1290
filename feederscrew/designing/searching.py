"""What the loop knows while it runs."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.designing import proposals, trying
from feederscrew.designing.record import Attempt, DesignRequest, RobustRun
from feederscrew.part.record import Part
from feederscrew.rates.stream import Orientations
from feederscrew.studies.rate import Shares

RESERVE = 1.6  # of the target, for which a bowl is driven: queues bring less than rows, counts scatter


@dataclass(eq=False)
class Search:
    """What the loop knows while it runs."""

    part: Part
    request: DesignRequest
    plain: Bowl  # as given
    given: frozenset[str]
    told: Callable[[str], None]  # of a sentence
    known: Shares | None = None
    attempts: list = field(default_factory=list)
    passed: list = field(default_factory=list)  # (rate, Candidate) of clean attempts
    failed: list = field(default_factory=list)  # the same of others that deliver
    before: Callable[[], None] | None = None
    reserve: float = RESERVE
    least: float = 0.0  # [m/s] through tooling, where what is wanted was lost at a slower drive
    avoided: dict = field(default_factory=dict)  # kinds of devices at which a row was lost, by row
    most: float = np.inf  # short trials that are worth it
    shares_given: bool = False  # the user says what arrives

    @property
    def spent(self) -> bool:
        """Whether the budget of trials is used up."""
        return len(self.attempts) >= min(self.request.budget, self.most)

    def avoid(self, proposal: proposals.Proposal, tried: trying.Tried) -> None:
        """Note the devices of a chain at which what is wanted is lost; rails are the only way to hang."""
        lost = {cut.device.kind for cut in proposal.cuts if not cut.device.hangs}
        kinds = sorted(kind for kind in lost if proposals.lost_at(tried, kind))
        known = self.avoided.get(proposal.row, ())
        self.avoided[proposal.row] = tuple(dict.fromkeys((*known, *kinds)))

    @property
    def best_rate(self) -> float:
        """The most that a clean attempt would deliver [1/s]."""
        return max((one.attempt.rate for one in self.passed), default=0.0)


@dataclass(frozen=True, eq=False)
class Candidate:
    """A chain on its bowl, as it was tried."""

    proposal: proposals.Proposal
    bowl: Bowl
    ways: Orientations
    weights: np.ndarray  # (M,)
    tried: trying.Tried
    attempt: Attempt
    drawn: RobustRun | None = None  # some draws that it did not all hold
