"""Orders to try where a design does not hold: a few that differ from it by one value each."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from feederscrew.bowl.verified import HELD
from feederscrew.jobs.serving.orders import ANY_HEADING, MayUse, PageOrder

MOST_STEPS = 3
TWO_AXIS = "two"


@dataclass(frozen=True)
class NextStep:
    """One value that is changed, in the words of the page."""

    label: str
    change: dict[str, Any]  # of the values of an order

    @property
    def document(self) -> dict[str, Any]:
        """Return the step as the page gets it, as JSON has it."""
        return {"label": self.label, "change": self.change}


def next_steps(order: PageOrder, answer: Mapping[str, Any]) -> list[NextStep]:
    """Return at most MOST_STEPS orders to try after one that does not hold, the likeliest first.

    Parameters
    ----------
    order : PageOrder
    answer : mapping
        ``design.json`` of it; empty where there is none.

    Returns
    -------
    list of NextStep
        Empty of a design that holds.
    """
    status = answer.get("status")
    if not isinstance(status, str) or status in HELD:
        return []
    if answer.get("partial"):
        return [NextStep("Design it again, to the end", {})]
    return list(_ways(order, answer))[:MOST_STEPS]


def _ways(order: PageOrder, answer: Mapping[str, Any]) -> Iterator[NextStep]:
    """All that can be changed, the likeliest first."""
    # what was tried and holds comes first
    nearest = answer.get("nearest")
    rate = nearest.get("rate_per_minute") if isinstance(nearest, Mapping) else None
    if isinstance(rate, int | float) and 0.0 < rate < order.rate:
        yield NextStep(
            f"Ask for {_rounded_down(rate):g} parts a minute, which holds", {"rate": _rounded_down(rate)}
        )
    # then what was ruled out by the order itself
    for use in MayUse:
        if use not in order.may_use:
            yield NextStep(f"Allow {use.label}", {"may_use": [*order.may_use, use]})
    if order.up and order.heading != ANY_HEADING:
        yield NextStep(f"{order.up} up at any heading", {"heading": ANY_HEADING})
    wanted = answer.get("wanted")
    if not order.up and isinstance(wanted, str):
        aspect = wanted.partition("@")[0]
        if "@" in wanted and aspect in order.upload.headings:
            yield NextStep(f"{aspect} up at any heading", {"up": aspect, "heading": ANY_HEADING})
    if order.outcome != "any":
        yield NextStep("Lying or hanging", {"outcome": "any"})
    if order.diameter is not None:
        yield NextStep("A bowl of any diameter", {"diameter": None})
    if order.up:
        yield NextStep("Whichever side delivers most", {"up": "", "heading": ANY_HEADING})
    # then another side, the first ones come most often, and another drive
    if not order.up:
        for aspect in list(order.upload.headings)[: MOST_STEPS - 1]:
            yield NextStep(f"{aspect} up at any heading", {"up": aspect, "heading": ANY_HEADING})
    if order.machine != TWO_AXIS:
        yield NextStep("Two-axis drive", {"machine": TWO_AXIS})


def _rounded_down(rate: float) -> float:
    """A rate [1/min] of two digits that is not above it."""
    digits = 10.0 ** (len(f"{rate:.0f}") - 2) if rate >= 1.0 else 0.1
    return float(f"{rate // digits * digits:.6g}") or rate
