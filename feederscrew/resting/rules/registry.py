"""Every probability rule, once, and the quantities of classes and faces that a rule may weigh.

A rule is a function in a module of this folder and an entry here. Probabilities, tables, pictures, the
names of rules and the table in ``docs/resting.md`` are made from these entries, in this order.
"""

from collections.abc import Callable
from dataclasses import dataclass

from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.documents import hint, nearest
from feederscrew.base.errors import ArgumentError
from feederscrew.base.units import quantity_text
from feederscrew.resting import barriers
from feederscrew.resting.barriers import Tipping
from feederscrew.resting.faces import Face
from feederscrew.resting.rules import formulas


@dataclass(frozen=True, eq=False)
class ClassQuantities:
    """Geometry of the classes; A rows, NaN where a part card is silent."""

    faces: Ints  # (A,) int, equal aspects in the class
    pmi_faces: Ints  # (A,) int, of these as the PMI rule counts them: 1 as published
    heights: Floats  # (A,) [m] of the centre of mass
    csa_heights: Floats  # (A,) [m] as the CSA rule takes them: a card's own, else the heights
    stability_heights: Floats  # (A,) [m] likewise
    polar_inertias: Floats  # (A,) [kg m2] about the normal through the centre of mass
    solid_angles: Floats  # (A,) [sr] of one face; of a card in its own unit
    contact_areas: Floats  # (A,) [m2] of one face


@dataclass(frozen=True, eq=False)
class FaceQuantities:
    """Exact tumbling of the part; F faces."""

    tips: Tipping  # basins, heights and the saddles between them
    faces: tuple[Face, ...]
    shares: Floats  # (F,) [1] quasi-static
    heights: Floats  # (F,) [m] of the centre of mass; NaN where the share is zero
    radius: float  # [m] largest distance from the centre of mass to a corner
    exponent: float  # [1] of the surface-weighted rule


RECOMMENDED_ANSWER = "recommended"  # the answer that is made from the rules; a name beside theirs


@dataclass(frozen=True)
class Rule:
    """One rule: how it is called, how it is shown, and how it weighs."""

    name: str  # in options and documents; its column is p_<name>
    label: str  # in pictures; all capitals also in the headings of tables
    colour: str  # the colours are told apart by colour-blind eyes (Okabe and Ito)
    of: type  # whose quantities it weighs: ClassQuantities or FaceQuantities
    needs: tuple[str, ...]  # names of these, in the order of the arguments of ``weights``
    weights: Callable[..., Floats]  # (A,) or (F,) weights, not normalised
    meaning: str  # in a few words
    use: str  # when to trust it
    reference: str  # whose it is

    @property
    def column(self) -> str:
        """Name of its column in tables."""
        return f"p_{self.name}"


RULES = (
    Rule(
        name="pmi",
        label="PMI",
        colour="#0072b2",
        of=ClassQuantities,
        needs=("pmi_faces", "polar_inertias", "heights"),
        weights=formulas.pmi,
        meaning="polar moment of inertia over height",
        use="to compare with published tables",
        reference="the thesis, section 3.1",
    ),
    Rule(
        name="csa",
        label="CSA",
        colour="#e69f00",
        of=ClassQuantities,
        needs=("faces", "solid_angles", "csa_heights"),
        weights=formulas.csa,
        meaning="centroid solid angle over height",
        use="to compare with published tables",
        reference="Ngoi, Lim and Lee (1995)",
    ),
    Rule(
        name="stability",
        label="stability",
        colour="#009e73",
        of=ClassQuantities,
        needs=("faces", "contact_areas", "stability_heights"),
        weights=formulas.stability,
        meaning="contact area over height",
        use="to compare with published tables",
        reference="Chua and Tay (1998)",
    ),
    Rule(
        name="quasistatic",
        label="quasi-static",
        colour="#cc79a7",
        of=FaceQuantities,
        needs=("tips",),
        weights=formulas.quasistatic,
        meaning="exact tumbling without momentum",
        use="soft, dead landings",
        reference="own: exact basins",
    ),
    Rule(
        name="crsa",
        label="CRSA",
        colour="#56b4e9",
        of=FaceQuantities,
        needs=("faces",),
        weights=formulas.critical,
        meaning="critical solid angle",
        use="hard surfaces, chunky parts",
        reference="Ngoi, Lye and Chen (1996), restated",
    ),
    Rule(
        name="barrier",
        label="barrier",
        colour="#8c8c8c",
        of=FaceQuantities,
        needs=("tips",),
        weights=barriers.balance,
        meaning="balance of transitions over the energy barriers",
        use="as a published method",
        reference="Boothroyd and Redford (1968), restated",
    ),
    Rule(
        name="surface",
        label="surface",
        colour="#d55e00",
        of=FaceQuantities,
        needs=("shares", "heights", "radius", "exponent"),
        weights=formulas.surface_weights,
        meaning="tumbling, weighted for bounces",
        use="hard surfaces; calibrate it with your own counts",
        reference="own: see below",
    ),
    Rule(
        name="hops",
        label="hops",
        colour="#5b3a8e",
        of=FaceQuantities,
        needs=("tips", "radius"),
        weights=formulas.hop_shares,
        meaning="a cascade of hops over the barriers",
        use="beside `p_surface`; parts with shallow faces",
        reference="own: see below",
    ),
)
RULE_OF = {rule.name: rule for rule in RULES}
RULE_NAMES = tuple(RULE_OF)
CLOSED = "closed"  # of the rules the one that is nearest to the recommended answer: the quick look
CHOICES = (*RULE_NAMES, CLOSED, RECOMMENDED_ANSWER)  # what a user may ask for


def heading(rule: str) -> str:
    """Return a rule's name as a table heads its column: 'PMI', 'quasistatic'."""
    is_short = rule in RULE_OF and RULE_OF[rule].label == rule.upper()
    return rule.upper() if is_short else rule.replace("_", " ")


def require_rule(rule: str) -> None:
    """Refuse a rule that there is not; the fault names the nearest one.

    Parameters
    ----------
    rule : str

    Raises
    ------
    ArgumentError
    """
    if rule not in CHOICES:
        what, near = f"unknown rule {quantity_text(str(rule))}", nearest(str(rule), CHOICES)
        raise ArgumentError("rule", what, hint(str(rule), CHOICES), value=near)


def weights(quantities: ClassQuantities | FaceQuantities) -> dict[str, Floats]:
    """Return the weights of every rule that weighs these quantities, not normalised.

    Parameters
    ----------
    quantities : ClassQuantities or FaceQuantities

    Returns
    -------
    dict of str to (A,) or (F,) float [any]
        By the rules' names in their order; NaN where a quantity is not known.
    """
    rules = [rule for rule in RULES if isinstance(quantities, rule.of)]
    return {rule.name: rule.weights(*(getattr(quantities, name) for name in rule.needs)) for rule in rules}
