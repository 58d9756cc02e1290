"""How many parts of a heap come single: what `feederscrew.trials.heap` returns, and its columns."""

from dataclasses import dataclass

from feederscrew.arrivals.ensemble import wilson
from feederscrew.base.columns import Column


@dataclass(frozen=True)
class HeapCount:
    """How many parts of one heap came single as each was pulled out."""

    parts: int  # that were pulled, and of which the pull told
    single: int  # of them, with which no other part came along
    mixed: bool  # whether they were laid as after long mixing and may hook; else all started apart
    seed: int  # of the random places and poses

    @property
    def value(self) -> float:
        """Share of the parts that come single [1]."""
        return self.single / self.parts if self.parts else float("nan")

    @property
    def low(self) -> float:
        """Lower end of its 95 % interval [1]. Source: E. B. Wilson, JASA 22, 1927."""
        return float(wilson([self.single], self.parts)[0][0])

    @property
    def high(self) -> float:
        """Upper end of its 95 % interval [1]. Source: E. B. Wilson, JASA 22, 1927."""
        return float(wilson([self.single], self.parts)[1][0])

    @property
    def words(self) -> str:
        """Return the count and its interval in words."""
        ends = f"{100.0 * self.low:.0f} to {100.0 * self.high:.0f} %"
        return f"{self.single} of {self.parts} parts of a heap come single ({ends} at 95 % confidence)"


HEAP_COLUMNS: tuple[Column[HeapCount], ...] = (
    Column("parts", lambda heap: heap.parts),
    Column("single", lambda heap: heap.single),
    Column("single_share", lambda heap: heap, "share", interval=True),
    Column("mixed", lambda heap: heap.mixed),
    Column("seed", lambda heap: heap.seed),
)
