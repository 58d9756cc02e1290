"""Recommendations of chapter 6.2 of the thesis for future work, where each is met here, and which are not."""

from dataclasses import dataclass

from feederscrew.base.columns import Column
from feederscrew.resting.aspects import find
from feederscrew.resting.inertia_products import find_products
from feederscrew.thesis import parts


@dataclass(frozen=True)
class Recommendation:
    """One of chapter 6.2."""

    number: int  # in the order of the text
    title: str  # what is recommended, and by what it is met, in few words
    what: str  # is recommended
    met: str  # where
    lacks: str  # what is not met


RECOMMENDATION_COLUMNS: tuple[Column[Recommendation], ...] = (
    Column("number", lambda item: item.number),
    Column("title", lambda item: item.title),
    Column("what", lambda item: item.what),
    Column("met", lambda item: item.met),
    Column("lacks", lambda item: item.lacks),
)


def recommendations() -> tuple[Recommendation, ...]:
    """Return the recommendations of chapter 6.2; the numbers in them are computed."""
    ratio, change = _largest_change()
    return (
        Recommendation(
            1,
            "more parts: feeder compare",
            "Test more parts, to check the accuracy of the PMI method.",
            "`feeder compare FILE...` sets PMI and every other rule beside counts of any number of parts. "
            "docs/validation.md lists the measured sets. `feeder sample t-shape --ratio 0.4` writes the T "
            "of any thickness as a part.",
            "Measured counts of a T of another thickness than that of Table 3-1.",
        ),
        Recommendation(
            2,
            "more tests: feeder drop",
            "Make more drop tests, for a better profile.",
            "`feeder drop --until 1%` drops a part until every share is known so well. `feeder compare` "
            "tests counts of real drops against each rule by chi-square (docs/counts.md).",
            "Simulated drops are no tests of a real bowl.",
        ),
        Recommendation(
            3,
            "products of inertia: p_pmi_principal of feeder aspects",
            "Study what products of inertia do to the PMI method, for complex geometries.",
            "`feeder aspects --columns all`: `product_of_inertia_g_mm2`, and `p_pmi_principal` by the moment "
            f"about the nearest principal axis. At most {100.0 * change:.2f} percentage points of a share of "
            f"the T change (ratio {ratio}): four of its five aspects lie square to a principal axis. For an "
            "asymmetric bracket it is 3.0 points (docs/resting.md).",
            "Counts of asymmetric parts that decide between the two.",
        ),
        Recommendation(
            4,
            "systems of screws: one part on several contacts",
            "Extend the analysis by screws to systems of screws, for several bodies.",
            "`feederscrew.motion.screws`: reactions and tipping twists of one part on any number of contacts "
            "(docs/method/screws.md). `feeder trial --queue` computes parts that touch, push and climb each "
            "other, by impulses at their contacts.",
            "A system of screws of several bodies: parts that touch are simulated, not reduced to screws.",
        ),
    )


def _largest_change() -> tuple[str, float]:
    """Aspect ratio of the T at which the products of inertia change a share most, and by how much [1]."""
    changes = {}
    for ratio in parts.T_RATIOS:
        part = parts.t_part(float(ratio))
        aspects = find(part, as_published=True)
        changes[ratio] = find_products(aspects, part.inertia).largest_change(aspects)
    ratio = max(changes, key=lambda ratio: changes[ratio])
    return ratio, changes[ratio]
