"""The resting aspects of a part, equal ones joined into classes, named and ranked."""

from dataclasses import dataclass, field, replace

import numpy as np

from feederscrew import check
from feederscrew.geometry import compiled, vectors
from feederscrew.part.hull import convex_hull
from feederscrew.part.moments import Moments
from feederscrew.records import Shown
from feederscrew.resting import naming
from feederscrew.resting.basins.landscape import landscape
from feederscrew.resting.classes import body_frame, classes
from feederscrew.resting.faces import stable_faces, unstable_faces
from feederscrew.resting.forms import FLAT, LEVEL, forms, said
from feederscrew.resting.rules import published, recommended, registry, surface
from feederscrew.resting.rules.quantities import ClassQuantities
from feederscrew.resting.rules.recommended import Recommended
from feederscrew.resting.shallow import published_changes, remark, shallow_facets
from feederscrew.resting.tumbling import by_class, walk

CONVEX = 1e-6  # [1] of the hull's volume: a smaller difference breaks no symmetry
TIE = 1e-4  # probabilities that differ by less of themselves are equal but for rounding


@dataclass(frozen=True, eq=False)
class Aspects(Shown):
    """One row a class, the most likely first; A rows."""

    names: tuple[str, ...]
    kinds: tuple[str, ...]  # 'flat' or 'rolling'
    forms: tuple[str, ...]  # 'flat', or what rolls: 'cylinder', 'cone', 'ball'; ``forms.forms`` lists them
    faces: np.ndarray  # (A,) int, equal aspects in the class
    stable: np.ndarray  # (A,) bool
    normals: np.ndarray  # (A, 3) outward, of one face of the class; points down when the part rests on it
    axes: np.ndarray  # (A, 3) a rolling class turns about; NaN for a flat and a ball
    heights: np.ndarray  # (A,) [m] of the centre of mass
    contact_areas: np.ndarray  # (A,) [m2] of one face
    solid_angles: np.ndarray  # (A,) [sr] of one face
    polar_inertias: np.ndarray  # (A,) [kg m2] about the normal through the centre of mass
    polygons: tuple[np.ndarray, ...]  # (K, 3) [m] from the centre of mass, counter-clockwise from outside
    probabilities: dict[str, np.ndarray] = field(default_factory=dict)  # (A,) [1] by rule, of the class
    barriers: np.ndarray | None = None  # (A,) [m] least lift that tips the part; NaN where nothing does
    barrier_energies: np.ndarray | None = None  # (A,) [J]
    tip_angles: np.ndarray | None = None  # (A,) [rad] of a floor that tips a part that does not slide
    recommended: Recommended | None = None  # the one answer to take; None for a card
    closed: Recommended | None = None  # the closed form nearest to it
    ground: by_class.Ground | None = None  # faces, basins and barriers behind the rows
    complete: dict[str, np.ndarray] = field(default_factory=dict)  # (A,) [1] by published rule, all facets
    warnings: tuple[str, ...] = ()

    @property
    def chances(self):
        """Probability of each aspect by every name a user may ask for: the rules, 'closed', 'recommended'."""
        answers = {"closed": self.closed, "recommended": self.recommended}
        return self.probabilities | {name: one.p for name, one in answers.items() if one is not None}

    @property
    def rolling_circles(self):
        """(A,) [m] radius of the circle in which the centre of mass rolls; infinite where straight, else NaN.

        The axis of a cone, or of a part on two circles, meets the floor at a point that stays where it is.
        """
        down = (self.axes * self.normals).sum(axis=1)
        level, off = np.sqrt(np.maximum(1.0 - down**2, 0.0)), np.abs(down) > LEVEL
        return np.where(off, self.heights * level / np.where(off, np.abs(down), 1.0), np.inf + 0.0 * down)

    @property
    def likeliest(self):
        """Name of the aspect it rests on most often: by the recommended answer, of a card by CSA."""
        return self.names[int(np.argmax(np.nan_to_num(self.chances[self.ranking])))]

    def source(self, rule):
        """Say whose the probabilities of a rule are: 'csa', of an answer 'drop test, launch feed'."""
        return getattr({"closed": self.closed, "recommended": self.recommended}.get(rule), "rule", rule)

    @property
    def ranking(self):
        """Name of the answer that ranks the aspects: 'recommended', of a card 'csa'."""
        return "csa" if self.recommended is None else "recommended"


def find(part, *, as_published=False, unstable=False, exponent=None, launch=recommended.LAUNCH):
    """Find the resting aspects of a part, with their probability by every rule.

    Parameters
    ----------
    part : Part
        From a mesh, or from a part card with an aspect table.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    unstable : bool
        List the facets the part rolls off as well, with no probability.
    exponent : float [1], optional
        Of the surface-weighted closed form, which is then the recommended one; see `surface.EXPONENTS`.
    launch : str
        What is done to the part, one of `recommended.LAUNCHES` or a former name: the recommended closed
        form depends on it.

    Returns
    -------
    Aspects

    Raises
    ------
    MeshError
        If the centre of mass is not strictly inside the convex hull.
    ArgumentError
        If there is no such launch.
    """
    launch = recommended.launch_named(launch)
    if part.vertices is None:
        return _from_card(part)
    hull = part.hull or convex_hull(part.vertices, part.centre_of_mass, part.source)
    basins = landscape(hull)
    stable = stable_faces(hull, basins)
    faces = stable + (unstable_faces(hull, stable) if unstable else [])
    moments = _moments(part, hull)
    label = classes(faces, part, moments)
    groups = [[face for face, at in zip(faces, label) if at == k] for k in range(label.max() + 1)]
    table = _geometry(groups, part) | {"forms": forms(groups, hull)}
    chances = _probabilities(table, as_published)
    order = _ranked(table, chances["csa"], part, moments)
    names, result = naming.named([groups[k] for k in order], table["normals"][order], hull, part.names)
    shallow = shallow_facets(hull, basins, stable)
    weights = registry.weights(_quantities(table, as_published))
    complete = published_changes(shallow, weights, table["stable"], part.inertia, as_published)
    named = _named(names, table, chances, order, result)
    named = replace(
        named,
        complete={rule: check.frozen(chance[order]) for rule, chance in complete.items()},
        warnings=(
            *named.warnings,
            *remark(shallow, names, *(_in_order(of, order) for of in (chances, complete))),
        ),
    )
    ground = by_class.grounded(hull, stable, np.argsort(order)[label][: len(stable)])
    weighted = surface.EXPONENTS["hard"] if exponent is None else exponent
    return _answered(_tumbled(named, ground, part, weighted), launch, exponent)


def waits(part):
    """Return whether `find` must compile first: on a machine's first large hull, for some seconds."""
    if part.hull is None:
        return False
    return compiled.due(walk.trace_saddles, 3 * len(part.hull.triangles))


def _tumbled(named, ground, part, exponent):
    """The record with all that exact tumbling adds to it."""
    more = by_class.exact(ground, part, named, exponent)
    doubts = tuple(f"exact tumbling is doubtful: {doubt}" for doubt in more.doubts)
    return replace(
        named,
        probabilities=named.probabilities | more.probabilities,
        barriers=more.barriers,
        barrier_energies=more.barrier_energies,
        tip_angles=more.tip_angles,
        ground=ground,
        warnings=named.warnings + doubts,
    )


def _answered(known, launch, exponent):
    """The record with the closed form that is recommended for a launch, or for the user's own surface."""
    own = None if exponent is None else surface.named(exponent)
    form = recommended.closed_form(known.probabilities, known.stable, known.kinds, launch, own)
    return replace(known, recommended=form, closed=form)


def _moments(part, hull):
    """Moments of the part; from its hull, of fewer triangles, where the volumes are the same."""
    if abs(hull.volume - part.volume) < CONVEX * hull.volume:
        return Moments(hull.vertices, hull.triangles, np.zeros(3))
    return Moments(part.vertices, part.faces, part.centre_of_mass)


def _about(axes, inertia):
    """(N,) moments of inertia about unit axes (N, 3)."""
    return vectors.dot(vectors.product(axes, inertia), axes)


def _direction(face):
    """What orders the faces of a class: their direction in the file."""
    return tuple(np.round(face.normal, 6))


def _geometry(groups, part):
    """Columns of the table in the order of the groups; a class's numbers are its faces' means."""

    counts = np.array([len(group) for group in groups])
    every = [face for group in groups for face in group]

    def mean(values):
        return np.add.reduceat(values, np.cumsum(counts) - counts) / counts

    shown = [max(group, key=_direction) if len(group) > 1 else group[0] for group in groups]
    return {
        "kinds": [group[0].kind for group in groups],
        "faces": counts,
        "stable": np.array([group[0].stable for group in groups]),
        "normals": _clean(np.array([face.normal for face in shown])),
        "axes": _clean(np.array([face.axis for face in shown])),
        "heights": mean([face.height for face in every]),
        "contact_areas": mean([face.area for face in every]),
        "solid_angles": mean([face.solid_angle for face in every]),
        "polar_inertias": mean(_about(np.array([face.normal for face in every]), part.inertia)),
        "polygons": [face.polygon for face in shown],
    }


def _clean(directions):
    """Directions with rounding noise and minus zeros swept out."""
    return np.where(np.abs(directions) < 1e-9, 0.0, directions)


def _probabilities(table, as_published):
    """Probability of each class by every rule that weighs classes."""
    return _normalised(_quantities(table, as_published), table["stable"])


def _in_order(chances, order):
    """Probabilities by rule, rows in another order."""
    return {rule: chance[order] for rule, chance in chances.items()}


def _quantities(table, as_published):
    """What the rules weigh of each class."""
    faces, heights = table["faces"], table["heights"]
    return ClassQuantities(
        faces=faces,
        pmi_faces=np.ones_like(faces) if as_published else faces,
        heights=heights,
        csa_heights=heights,
        stability_heights=heights,
        polar_inertias=table["polar_inertias"],
        solid_angles=table["solid_angles"],
        contact_areas=table["contact_areas"],
    )


def _normalised(quantities, stable):
    """Probabilities by every rule that weighs classes."""
    weights = registry.weights(quantities)
    return {rule: published.normalised(weight, stable) for rule, weight in weights.items()}


def _ranked(table, chance, part, moments):
    """Order of the rows: by falling CSA probability, then by size, then by direction in the part.

    The last is taken in axes fixed in the part, so that a turned file keeps its names.
    """
    size = np.where(table["stable"], 1.0 + chance, table["faces"] * table["solid_angles"] / (4.0 * np.pi))
    order = np.argsort(-size, kind="stable")
    tied = np.concatenate([[False], -np.diff(size[order]) < TIE * size[order][1:]])
    if not tied.any():
        return order
    rank = np.empty(len(order), dtype=int)
    rank[order] = np.cumsum(~tied)
    direction = np.round(vectors.product(table["normals"], body_frame(part, moments)), 3)
    height = np.round(table["heights"] / table["heights"].max(), 4)
    return np.lexsort((*-direction.T, height, rank))


def _named(names, table, chances, order, told):
    """The record, rows in their order."""
    columns: dict = {k: check.frozen(v[order]) for k, v in table.items() if isinstance(v, np.ndarray)}
    columns |= {name: tuple(table[name][k] for k in order) for name in ("kinds", "forms", "polygons")}
    return Aspects(
        names=names,
        probabilities={rule: check.frozen(chance[order]) for rule, chance in chances.items()},
        warnings=(*said(table["forms"]), *told),
        **columns,
    )


def _from_card(part):
    """Aspects as the card's source gives them, by its own names and in its order."""
    rows = part.aspects
    quantities, stable = _printed(rows), check.frozen(np.ones(len(rows), dtype=bool))
    in_sr = np.array([row.solid_angle_in_sr for row in rows])
    nothing = check.frozen(np.full((len(rows), 3), np.nan))
    return Aspects(
        names=tuple(row.name for row in rows),
        kinds=(FLAT,) * len(rows),
        forms=(FLAT,) * len(rows),
        faces=quantities.faces,
        stable=stable,
        normals=nothing,
        axes=nothing,
        heights=quantities.heights,
        contact_areas=quantities.contact_areas,
        solid_angles=check.frozen(np.where(in_sr, quantities.solid_angles, np.nan)),
        polar_inertias=quantities.polar_inertias,
        polygons=(np.empty((0, 3)),) * len(rows),
        probabilities={k: check.frozen(p) for k, p in _normalised(quantities, stable).items()},
    )


def _printed(rows):
    """What the rows of a part card print; NaN where they are silent."""
    faces, heights = check.frozen(np.array([row.faces for row in rows])), _column(rows, "height")
    return ClassQuantities(
        faces=faces,
        pmi_faces=faces,
        heights=heights,
        csa_heights=_over(_column(rows, "csa_height"), heights),
        stability_heights=_over(_column(rows, "stability_height"), heights),
        polar_inertias=_column(rows, "polar_inertia"),
        solid_angles=_column(rows, "solid_angle"),
        contact_areas=_column(rows, "contact_area"),
    )


def _column(rows, quantity):
    values = [getattr(row, quantity) for row in rows]
    return check.frozen(np.array([np.nan if value is None else value for value in values], dtype=float))


def _over(own, heights):
    """Heights that a rule's own table gives, else those of the aspects."""
    return check.frozen(np.where(np.isnan(own), heights, own))
