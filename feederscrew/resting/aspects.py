"""The resting aspects of a part: equal ones joined into classes, named and ranked.

Equal faces are those that a rotation symmetry of the part carries into each other. Names are letters by
rank, or those a user has given, matched by direction. Facets on which the part stands, but which are merged
with a deeper neighbour, change the published rules alone.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from string import ascii_uppercase

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints, Points
from feederscrew.base.errors import ArgumentError, ConfigError, Detail, FeederError, MeshError
from feederscrew.base.geometry import compiled, vectors
from feederscrew.base.geometry.graphs import component_of
from feederscrew.base.records import ReadableRecord
from feederscrew.base.signatures import with_shown_signature
from feederscrew.base.units import MM, one_line
from feederscrew.part.hull import Hull, convex_hull
from feederscrew.part.mass import Moments
from feederscrew.part.record import PART_MEND, AspectNames, Part
from feederscrew.resting import exact_tumbling, lying, walks
from feederscrew.resting.faces import EQUAL_HEIGHT_SHARE, ONE_PLANE, Face, stable_faces, unstable_faces
from feederscrew.resting.landscape import SMOOTH_ANGLE, Landscape, angle, landscape
from feederscrew.resting.rules import formulas, recommended, registry
from feederscrew.resting.rules.recommended import Recommended
from feederscrew.resting.rules.registry import ClassQuantities

FLAT = "flat"
CYLINDER = "cylinder"
CONE = "cone"
BALL = "ball"
OFF_CENTRE = "off-centre ball"
WITH_A_FLAT = "ball with a flat"
ASPECTS_MEND = "give Aspects, as find_aspects returns them"
LEVEL_SLOPE = 1e-3  # [1] slope of an axis that counts as level: a file's noise on a short cylinder
BALL_REMARK = "the part is a ball: it rests on no aspect, its one class rolls in every direction"
CENTRED_BALL_REMARK = (
    "a rolling class is the side of a ball about the centre of mass: it rolls in every direction"
)
ROCKING_REMARK = (
    "a rolling class is the side of {}, whose middle is not the centre of mass: it rests on one point of it"
    " and rocks in every direction"
)
CONVEX = 1e-6  # [1] of the hull's volume: a smaller difference breaks no symmetry
CHANCE_TIE = 1e-4  # probabilities that differ by less of themselves are equal but for rounding
NAMING_REACH = {"flat": np.radians(3.0), "rolling": np.radians(15.0)}  # off the direction of a name
NAMING_TOLERANCE = np.radians(0.05)  # a direction closer than this to an aspect means that one
SYMMETRY_ANGLE = np.radians(3.0)  # a turned face lies on another when their normals agree this well
SYMMETRY_HEIGHT_SHARE = 0.007  # ... and their heights
MAX_ROTATIONS = 400  # rotations tried at most: more equal faces than that are a curve
MIN_INSIDE_SHARE = 1e-2  # [1] of the radius: a foot nearer to a facet's border is one of the file's noise
MAX_SHALLOW = 500  # facets with the foot inside, the furthest from a border first: with more it is a curve
MIN_CHANGE = 5e-4  # [1] of a probability: less does not show in a table
ALIKE_DIGITS = 4  # of height and area, in which equal facets agree


@dataclass(frozen=True, eq=False)
class Aspect(ReadableRecord):
    """One resting aspect of a part, as ``aspects["A"]`` gives it."""

    name: str
    lies: str  # 'on its largest face', one of ``lying.Lies``; '' of a card
    rolls: bool  # whether it lies on a round side
    faces: int  # equal ones of the part
    stable: bool
    share: float  # [1] by the recommended answer, of a card by CSA; NaN where none is known
    low: float  # [1] ends of its interval; NaN of a card
    high: float  # [1]
    height: float  # [m] of the centre of mass
    contact_area: float  # [m2] of one face
    normal: Floats  # (3,) outward; points down when the part rests on it
    polygon: Points  # (K, 3) [m] of the contact, from the centre of mass
    probabilities: dict[str, float]  # [1] by rule
    barrier: float  # [m] least lift that tips the part; NaN where nothing does
    tip_angle: float  # [rad] of a floor that tips a part that does not slide


@dataclass(frozen=True, eq=False)
class Aspects(ReadableRecord, view="record_lines.ASPECTS_VIEW"):
    """One row a class, the most likely first; A rows."""

    names: tuple[str, ...]
    kinds: tuple[str, ...]  # 'flat' or 'rolling'
    forms: tuple[str, ...]  # 'flat', or what rolls: 'cylinder', 'cone', 'ball', as ``_form`` says
    lies: tuple[str, ...]  # 'on its largest face', each one of ``lying.Lies``; '' of a card
    faces: Ints  # (A,) int, equal aspects in the class
    stable: Bools  # (A,) bool
    normals: Floats  # (A, 3) outward, of one face of the class; points down when the part rests on it
    axes: Floats  # (A, 3) a rolling class turns about; NaN for a flat and a ball
    heights: Floats  # (A,) [m] of the centre of mass
    contact_areas: Floats  # (A,) [m2] of one face
    solid_angles: Floats  # (A,) [sr] of one face
    polar_inertias: Floats  # (A,) [kg m2] about the normal through the centre of mass
    polygons: tuple[Points, ...]  # (K, 3) [m] from the centre of mass, counter-clockwise from outside
    probabilities: dict[str, Floats] = field(default_factory=dict)  # (A,) [1] by rule, of the class
    barriers: Floats | None = None  # (A,) [m] least lift that tips the part; NaN where nothing does
    barrier_energies: Floats | None = None  # (A,) [J]
    tip_angles: Floats | None = None  # (A,) [rad] of a floor that tips a part that does not slide
    recommended: Recommended | None = None  # the one answer to take; None for a card
    closed: Recommended | None = None  # the closed form nearest to it
    ground: exact_tumbling.Ground | None = None  # faces, basins and barriers behind the rows
    complete: dict[str, Floats] = field(default_factory=dict)  # (A,) [1] by published rule, all facets
    warnings: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[Aspect]:
        return (self._aspect(row) for row in range(len(self.names)))

    def __getitem__(self, name: str | int) -> Aspect:
        """Return the aspect of a name, 'A', or of a place, 0 for the likeliest.

        Raises
        ------
        KeyError, IndexError
            If there is no such aspect; the line names those there are.
        """
        if isinstance(name, str):
            if name not in self.names:
                raise KeyError(f"no aspect {name!r}, known are {', '.join(self.names)}")
            return self._aspect(self.names.index(name))
        return self._aspect(range(len(self.names))[name])

    def _aspect(self, row: int) -> Aspect:
        share = self.chances.get(self.ranking)
        answer = self.recommended
        return Aspect(
            name=self.names[row],
            lies=self.lies[row],
            rolls=bool(self.rolls[row]),
            faces=int(self.faces[row]),
            stable=bool(self.stable[row]),
            share=math.nan if share is None else float(share[row]),
            low=math.nan if answer is None else float(answer.low[row]),
            high=math.nan if answer is None else float(answer.high[row]),
            height=float(self.heights[row]),
            contact_area=float(self.contact_areas[row]),
            normal=self.normals[row],
            polygon=self.polygons[row],
            probabilities={rule: float(p[row]) for rule, p in self.probabilities.items()},
            barrier=math.nan if self.barriers is None else float(self.barriers[row]),
            tip_angle=math.nan if self.tip_angles is None else float(self.tip_angles[row]),
        )

    @property
    def chances(self) -> dict[str, Floats]:
        """Return the probability (A,) [1] of each aspect by every name that a user may ask for.

        They are the rules, 'closed' and 'recommended'.
        """
        answers = {"closed": self.closed, "recommended": self.recommended}
        return self.probabilities | {name: answer.p for name, answer in answers.items() if answer is not None}

    @property
    def rolls(self) -> Bools:
        """Which rows (A,) lie on a round side."""
        return np.array([kind != FLAT for kind in self.kinds], dtype=bool)

    @property
    def rolling_circles(self) -> Floats:
        """(A,) [m] radius of the circle in which the centre of mass rolls; infinite where straight, else NaN.

        The axis of a cone, or of a part on two circles, meets the floor at a point that stays where it is.
        """
        down = (self.axes * self.normals).sum(axis=1)
        level, off = np.sqrt(np.maximum(1.0 - down**2, 0.0)), np.abs(down) > LEVEL_SLOPE
        return np.where(off, self.heights * level / np.where(off, np.abs(down), 1.0), np.inf + 0.0 * down)

    @property
    def likeliest(self) -> str:
        """Return the name of the likeliest aspect: by the recommended answer, of a card by CSA."""
        return self.names[int(np.argmax(np.nan_to_num(self.chances[self.ranking])))]

    def source(self, rule: str) -> str:
        """Return whose the probabilities of a rule are: 'csa', of an answer 'drop test, launch feed'."""
        return getattr({"closed": self.closed, "recommended": self.recommended}.get(rule), "rule", rule)

    @property
    def ranking(self) -> str:
        """Return the name of the answer that ranks the aspects: 'recommended', of a card 'csa'."""
        return "csa" if self.recommended is None else "recommended"


def find(
    part: Part,
    *,
    as_published: bool = False,
    unstable: bool = False,
    exponent: float | None = None,
    launch: str = recommended.LAUNCH,
) -> Aspects:
    """Find the resting aspects of a part, with their probability by every rule.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.
    as_published : bool
        Count each class once in the PMI rule, as the thesis's tables do.
    unstable : bool
        List the facets the part rolls off as well; their probability is 0.
    exponent : float [1] or None
        Exponent of the surface-weighted closed form, which is then the recommended one; see
        ``formulas.EXPONENTS``.
    launch : str
        One of ``recommended.LAUNCH_NAMES`` or a former name; the recommended closed form depends on it.

    Returns
    -------
    Aspects
        A rows, the most likely first.

    Raises
    ------
    MeshError
        If the centre of mass is not strictly inside the convex hull.
    ArgumentError
        If there is no such launch.
    """
    launch = recommended.launch_of_name(launch)
    if part.vertices is None:
        return _from_card(part)
    hull = part.hull or convex_hull(part.vertices, part.centre_of_mass, part.source)
    basins = landscape(hull)
    stable = stable_faces(hull, basins)
    faces = stable + (unstable_faces(hull, basins, stable) if unstable else [])
    # moments of the part; from its hull, of fewer triangles, where the volumes are the same
    if part.volume is not None and abs(hull.volume - part.volume) < CONVEX * hull.volume:
        moments = Moments(hull.vertices, hull.triangles, np.zeros(3))
    else:
        moments = Moments(part.vertices, np.asarray(part.faces), part.centre_of_mass)
    label = join_classes(faces, part, moments)
    groups = [[face for face, at in zip(faces, label) if at == k] for k in range(label.max() + 1)]
    table = _tabulate(groups, part, hull)
    noise = max((face.roughness for face in faces if face.kind == FLAT), default=0.0)
    lies = lying.describe_lying(part, hull, basins, [group[0] for group in groups], noise)
    # probabilities by the rules that weigh classes, with the facets that are no aspect and without
    heights = table.heights
    quantities = ClassQuantities(
        faces=table.faces,
        pmi_faces=np.ones_like(table.faces) if as_published else table.faces,
        heights=heights,
        csa_heights=heights,
        stability_heights=heights,
        polar_inertias=table.polar_inertias,
        solid_angles=table.solid_angles,
        contact_areas=table.contact_areas,
    )
    weights = registry.weights(quantities)
    chances = {rule: formulas.normalise(weight, table.stable) for rule, weight in weights.items()}
    shallow = shallow_facets(hull, basins, stable)
    complete = published_changes(shallow, weights, table.stable, part.inertia, as_published)
    # rows in their order, named
    order = _rank_classes(table, chances["csa"], part, moments)
    names, warnings = name_classes([groups[k] for k in order], table.normals[order], hull, part.names)
    chances, complete = (
        {rule: check.frozen(chance[order]) for rule, chance in of.items()} for of in (chances, complete)
    )
    ground = exact_tumbling.ground_faces(hull, stable, np.argsort(order)[label][: len(stable)])
    aspects = Aspects(
        names=names,
        kinds=tuple(table.kinds[k] for k in order),
        forms=tuple(table.forms[k] for k in order),
        lies=tuple(lies[k] for k in order),
        polygons=tuple(table.polygons[k] for k in order),
        faces=check.frozen(table.faces[order]),
        stable=check.frozen(table.stable[order]),
        normals=check.frozen(table.normals[order]),
        axes=check.frozen(table.axes[order]),
        heights=check.frozen(heights[order]),
        contact_areas=check.frozen(table.contact_areas[order]),
        solid_angles=check.frozen(table.solid_angles[order]),
        polar_inertias=check.frozen(table.polar_inertias[order]),
        probabilities=chances,
        complete=complete,
        ground=ground,
    )
    # all that exact tumbling adds, and the closed form for a launch or for the user's own surface
    weighted = formulas.EXPONENTS["hard"] if exponent is None else exponent
    more = exact_tumbling.tumble_classes(ground, part, aspects.stable, weighted)
    all_chances = aspects.probabilities | more.probabilities
    own = None if exponent is None else formulas.surface_name(exponent)
    form = recommended.closed_form(all_chances, aspects.stable, aspects.kinds, launch, own)
    return replace(
        aspects,
        probabilities=all_chances,
        barriers=more.barriers,
        barrier_energies=more.barrier_energies,
        tip_angles=more.tip_angles,
        recommended=form,
        closed=form,
        warnings=(
            *form_remarks(table.forms),
            *warnings,
            *shallow_remark(shallow, names, chances, complete),
            *(f"exact tumbling is doubtful: {doubt}" for doubt in ground.tips.doubts),
        ),
    )


def require_ground(part: Part, aspects: Aspects) -> exact_tumbling.Ground:
    """Return the faces a part rests on, matched to the rows of its aspects, with exact basins and barriers.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.

    Returns
    -------
    Ground

    Raises
    ------
    MeshError
        If the part is a card without a shape.
    """
    if aspects.ground is None:
        raise MeshError(part.source, "is a part card, it has no shape to tumble", "give a mesh file")
    return aspects.ground


def waits(part: Part) -> bool:
    """Return whether ``find`` must compile first: on a machine's first large hull, for some seconds."""
    return part.hull is not None and compiled.due(walks.trace_saddles, 3 * len(part.hull.triangles))


def _form(face: Face, hull: Hull, flats: bool) -> str:
    """Return the form of a class, from one of its faces; ``flats`` says whether the part has any flat.

    'flat'; 'cylinder', which rolls straight; 'cone', which rolls in a circle, as a part on two unlike circles
    does; 'ball', about the centre of mass; 'off-centre ball' and 'ball with a flat', which rest on one point
    of a ball's side and rock. The first of these two has no other class, the second has flats as well.
    """
    if face.kind == FLAT:
        return FLAT
    if np.isfinite(face.axis).all():
        return CYLINDER if abs(vectors.dot(face.axis, face.normal)) < LEVEL_SLOPE else CONE
    if np.ptp(hull.heights[face.triangles]) < EQUAL_HEIGHT_SHARE * face.height:
        return BALL
    return WITH_A_FLAT if flats else OFF_CENTRE


def form_remarks(forms_of_classes: list[str]) -> tuple[str, ...]:
    """Return what a user must know of the forms (A,) of the classes, a sentence each."""
    if list(forms_of_classes) == [BALL]:
        return (BALL_REMARK,)
    rocks = dict.fromkeys(form for form in forms_of_classes if form in (OFF_CENTRE, WITH_A_FLAT))
    listed = (CENTRED_BALL_REMARK,) if BALL in forms_of_classes else ()
    return (*listed, *(ROCKING_REMARK.format(f"{'an' if form[0] == 'o' else 'a'} {form}") for form in rocks))


@dataclass(frozen=True, eq=False)
class _ClassTable:
    """Classes of faces (C,) in the order in which they were found; numbers are the means of their faces."""

    kinds: list[str]
    forms: list[str]
    faces: Ints  # (C,) how many
    stable: Bools  # (C,)
    normals: Floats  # (C, 3) [1] of a face of each
    axes: Floats  # (C, 3) [1] of the same face
    polygons: list[Points]  # [m] of the same face
    heights: Floats  # (C,) [m]
    contact_areas: Floats  # (C,) [m2]
    solid_angles: Floats  # (C,) [sr]
    polar_inertias: Floats  # (C,) [kg m2]


def _tabulate(groups: list[list[Face]], part: Part, hull: Hull) -> _ClassTable:
    counts = np.array([len(group) for group in groups])
    faces = [face for group in groups for face in group]
    flats = any(group[0].kind == FLAT for group in groups)
    normals = np.array([face.normal for face in faces])

    def mean(values: Sequence[float] | Floats) -> Floats:
        return np.add.reduceat(values, np.cumsum(counts) - counts) / counts

    examples = [max(group, key=lambda face: tuple(np.round(face.normal, 6))) for group in groups]
    # directions with rounding noise and minus zeros swept out
    directions = [np.array([getattr(face, name) for face in examples]) for name in ("normal", "axis")]
    example_normals, example_axes = (np.where(np.abs(each) < 1e-9, 0.0, each) for each in directions)
    return _ClassTable(
        kinds=[group[0].kind for group in groups],
        forms=[_form(group[0], hull, flats) for group in groups],
        faces=counts,
        stable=np.array([group[0].stable for group in groups]),
        normals=example_normals,
        axes=example_axes,
        polygons=[face.polygon for face in examples],
        heights=mean([face.height for face in faces]),
        contact_areas=mean([face.area for face in faces]),
        solid_angles=mean([face.solid_angle for face in faces]),
        polar_inertias=mean(vectors.dot(vectors.product(normals, part.inertia), normals)),
    )


def _rank_classes(table: _ClassTable, chance: Floats, part: Part, moments: Moments) -> Ints:
    """Return the order of the rows: by falling CSA probability, then by size, then by direction in the part.

    The direction is taken in axes fixed in the part, so that a turned file keeps its names.
    """
    size = np.where(table.stable, 1.0 + chance, table.faces * table.solid_angles / (4.0 * np.pi))
    order = np.argsort(-size, kind="stable")
    tied = np.concatenate([[False], -np.diff(size[order]) < CHANCE_TIE * size[order][1:]])
    if not tied.any():
        return order
    rank = np.empty(len(order), dtype=int)
    rank[order] = np.cumsum(~tied)
    # axes fixed in the part: the principal ones, pointed by the solid's third moments; where the part is
    # symmetric they are not told apart, and the file's decide
    _, axes = vectors.eigen(part.inertia)
    skew = moments.directional(axes.T)[:, 2]
    clear = np.abs(skew) > moments.error
    largest = axes[np.argmax(np.abs(axes), axis=0), np.arange(3)]
    axes = axes * np.where(clear, np.sign(skew), np.sign(largest))
    if clear.sum() == 2:  # the third follows: a mirror plane leaves no skew across it, but a hand
        axes[:, ~clear] *= vectors.determinant(axes)
    direction = np.round(vectors.product(table.normals, axes), 3)
    height = np.round(table.heights / table.heights.max(), 4)
    return np.lexsort((*-direction.T, height, rank))


def _from_card(part: Part) -> Aspects:
    """Return the aspects of a card by its own names and in its order; NaN where the card is silent."""
    rows = part.aspects

    def column(quantity: str, instead: Floats | float = np.nan) -> Floats:
        """Return a quantity of every row; where a rule's own table is silent, ``instead``."""
        values = [getattr(row, quantity) for row in rows]
        numbers = np.array([np.nan if value is None else value for value in values], dtype=float)
        return check.frozen(np.where(np.isnan(numbers), instead, numbers))

    faces, heights = check.frozen(np.array([row.faces for row in rows])), column("height")
    quantities = ClassQuantities(
        faces=faces,
        pmi_faces=faces,
        heights=heights,
        csa_heights=column("csa_height", heights),
        stability_heights=column("stability_height", heights),
        polar_inertias=column("polar_inertia"),
        solid_angles=column("solid_angle"),
        contact_areas=column("contact_area"),
    )
    stable = check.frozen(np.ones(len(rows), dtype=bool))
    in_sr = np.array([row.solid_angle_in_sr for row in rows])
    nothing = check.frozen(np.full((len(rows), 3), np.nan))
    weights = registry.weights(quantities)
    return Aspects(
        names=tuple(row.name for row in rows),
        kinds=(FLAT,) * len(rows),
        forms=(FLAT,) * len(rows),
        lies=("",) * len(rows),
        faces=faces,
        stable=stable,
        normals=nothing,
        axes=nothing,
        heights=heights,
        contact_areas=quantities.contact_areas,
        solid_angles=check.frozen(np.where(in_sr, quantities.solid_angles, np.nan)),
        polar_inertias=quantities.polar_inertias,
        polygons=(np.empty((0, 3)),) * len(rows),
        probabilities={k: check.frozen(formulas.normalise(w, stable)) for k, w in weights.items()},
    )


def name_classes(
    groups: list[list[Face]], normals: Floats, hull: Hull, user_names: AspectNames | None
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Name the classes of aspects: by a user's names, matched by direction, else by letters.

    Of all pairs of a name and a class the nearest is joined first, then the nearest of those left.

    Parameters
    ----------
    groups : list of A lists of Face
        Faces of each class, in the order of the rows.
    normals : (A, 3) float [1]
        Direction that is down when the part rests on each.
    hull : Hull
    user_names : AspectNames or None
        A class without a name takes the first letter that is free.

    Returns
    -------
    tuple of A str
        Names.
    tuple of str
        Warnings: names that fit no aspect, and aspects without a name.

    Raises
    ------
    ConfigError
        If a name fits two aspects and lies on neither.

    References
    ----------
    Own; docs/resting.md, "Names that stay".
    """
    # A, B ... Z, AA, AB ...
    words = (itertools.product(ascii_uppercase, repeat=size) for size in itertools.count(1))
    letters = map("".join, itertools.chain.from_iterable(words))
    if user_names is None:
        return tuple(itertools.islice(letters, len(groups))), ()
    source, own_names = user_names.source, user_names.names
    # from each direction given to the nearest of a class; infinite out of reach
    down, columns = np.array([direction for _, direction in user_names.directions]), []
    for faces in groups:
        rolls = faces[0].kind == "rolling"
        own = np.concatenate([hull.normals[f.triangles] if rolls else f.normal[None] for f in faces])
        nearest = angle(down[:, None], own[None]).min(axis=1)
        within = faces[0].stable & (nearest <= NAMING_REACH[faces[0].kind])
        columns.append(np.where(within, nearest, np.inf))
    angles = np.column_stack(columns)
    # class by name: the nearest two first, each once
    place: dict[int, int] = {}
    for k, row in zip(*np.unravel_index(np.argsort(angles, axis=None, kind="stable"), angles.shape)):
        if np.isfinite(angles[k, row]) and k not in place and row not in place.values():
            place[int(k)] = int(row)
    for k, row in place.items():  # off its own aspect while another is within reach: either may be meant
        rest = np.delete(angles[k], row)
        if angles[k, row] >= NAMING_TOLERANCE and np.isfinite(rest).any():
            off = " and ".join(f"{np.degrees(off_by):.2g}" for off_by in (angles[k, row], rest.min()))
            what = f"the direction of {own_names[k]!r} is {off} deg off two aspects of the part"
            raise ConfigError(source, what, "write the direction of the one that is meant")
    names = {row: own_names[k] for k, row in place.items()}
    taken = {name.casefold() for name in own_names}
    free = (name for name in letters if name.casefold() not in taken)
    all_names = tuple(names[row] if row in names else next(free) for row in range(len(groups)))
    warnings = []
    for k, (name, direction) in enumerate(user_names.directions):
        if k in place:
            continue
        row = int(np.argmin(angles[k]))
        if np.isfinite(angles[k, row]):
            other = next(own_names[m] for m, at in place.items() if at == row)
            warnings.append(f"{source}: {name!r} is one aspect with {other!r} and goes by that name")
        else:
            text = _direction_text(direction)
            warnings.append(f"{source}: the part rests on no aspect {name!r} ({text} down)")
    for row, faces in enumerate(groups):
        if row not in names and faces[0].stable:
            text = f"the aspect with {_direction_text(normals[row])} down"
            warnings.append(f"{source} has no name for {text}: it is called {all_names[row]}")
    return all_names, tuple(warnings)


def _direction_text(direction: Floats | tuple[float, ...]) -> str:
    return ", ".join(f"{x + 0.0:.3g}" for x in vectors.unit(np.asarray(direction)).round(4))


def join_classes(faces: list[Face], part: Part, moments: Moments) -> Ints:
    """Return labels of equal faces, numbered in order of first appearance.

    Equal faces are those that a rotation carries into each other. Only rotations count: a feeder cannot
    reflect a part, so mirror images stay apart. The rotation must be a symmetry of the solid, not just of its
    hull.

    Parameters
    ----------
    faces : list of N Face
    part : Part
    moments : Moments
        Of the part; they judge whether a rotation leaves the solid as it is.

    Returns
    -------
    (N,) int [label]

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    middles, equal = np.array([face.middle for face in faces]), _are_equal(faces)
    axes = np.array([face.axis for face in faces])
    if equal.sum() == len(faces):
        return np.arange(len(faces))
    # candidates: rotations that carry the landmarks onto each other, and half turns about the principal axes,
    # which are all there are where the principal moments differ
    tolerance = moments.error + 2.0 * max(face.roughness for face in faces) / moments.size
    rotations = _by_landmarks(faces)
    if rotations is None:
        flats = [face for face in faces if face.kind == FLAT]
        rotations = _half_turns((flats or faces)[0].normal, moments)
    principal = vectors.eigen(part.inertia)[1].T
    half_turns = 2.0 * principal[:, :, None] * principal[:, None, :] - np.eye(3)
    rotations = np.concatenate([rotations, half_turns])
    carried = np.zeros_like(equal)
    for rotation in rotations[moments.mismatch(rotations) < tolerance]:
        # parallel to the axis of another face; true where one has none
        there = ~(np.abs(vectors.product(vectors.product(axes, rotation.T), axes.T)) < np.cos(SYMMETRY_ANGLE))
        # mean normals: of a round side the lowest strip says nothing, it lies where the tessellation begins
        gaps = vectors.product(middles, rotation.T)[:, None] - middles
        carried |= there & (vectors.norm(gaps) < 2.0 * np.sin(0.5 * SYMMETRY_ANGLE))
    return component_of(np.argwhere(carried & equal), len(faces))


def _are_equal(faces: list[Face]) -> Bools:
    """Return (N, N) bool: of one kind and of one height, as far as the file's noise lets us tell."""
    heights, kinds = (np.array([getattr(face, of) for face in faces]) for of in ("height", "kind"))
    noise = 2.0 * max(face.roughness for face in faces)
    gaps = np.abs(heights[:, None] - heights)
    near = gaps < SYMMETRY_HEIGHT_SHARE * np.minimum(heights[:, None], heights) + noise
    return near & (kinds[:, None] == kinds)


def _by_landmarks(faces: list[Face]) -> Floats | None:
    """Return rotations that carry one pair of unlike directions onto another; None where all are parallel."""
    normals, heights = (np.array([getattr(face, of) for face in faces]) for of in ("normal", "height"))
    like, flat = _are_equal(faces), np.array([face.kind == FLAT for face in faces])
    rarest = np.lexsort((-heights, like.sum(axis=1), ~flat))
    rarest = rarest[flat[rarest]]
    for a, b in ((a, b) for a in rarest[:1] for b in rarest[1:]):
        if vectors.length(vectors.cross(normals[a], normals[b])) > np.sin(SYMMETRY_ANGLE):
            # rotations that take normals a and b to every pair of images that keeps their angle
            images = (np.flatnonzero(like[k] & flat) for k in (a, b))
            c, d = (pairs.ravel() for pairs in np.meshgrid(*images, indexing="ij"))
            between = angle(normals[a], normals[b])
            same_angle = np.abs(angle(normals[c], normals[d]) - between) < SYMMETRY_ANGLE
            pairs = np.flatnonzero(same_angle & ((c != a) | (d != b)))[:MAX_ROTATIONS]
            ends = _frames(normals[c[pairs]], normals[d[pairs]])
            return vectors.product(ends, _frames(normals[a], normals[b]).T)
    return None


def _half_turns(axis: Floats, moments: Moments) -> Floats:
    """Return half turns about axes across ``axis``: the likeliest, where the solid changes least."""
    u, v = vectors.plane_axes(axis)

    def turns(phases: Floats) -> Floats:
        across = np.cos(phases)[:, None] * u + np.sin(phases)[:, None] * v
        return 2.0 * across[:, :, None] * across[:, None, :] - np.eye(3)

    best, width = 0.0, np.pi / 2
    for _ in range(4):  # the mismatch is a Fourier sum of the phase up to order six: a coarse grid finds it
        phases = best + width * np.linspace(-1.0, 1.0, 61)
        best, width = phases[np.argmin(moments.mismatch(turns(phases)))], width / 20
    across = turns(np.array([best]))
    along = 2.0 * np.outer(axis, axis) - np.eye(3)
    return np.concatenate([across, along[None], vectors.product(across, along)])


def _frames(first: Floats, second: Floats) -> Floats:
    """Return (..., 3, 3) right-handed axes as columns: along first (..., 3), and in the plane of both."""
    across = vectors.unit(vectors.cross(first, second))
    return np.stack([vectors.cross(across, first), across, first], axis=-1)


@dataclass(frozen=True, eq=False)
class ShallowFacets:
    """K facets with the foot of the centre of mass within them that were merged with a deeper neighbour."""

    normals: Floats  # (K, 3) outward
    heights: Floats  # (K,) [m] of the centre of mass
    areas: Floats  # (K,) [m2]
    solid_angles: Floats  # (K,) [sr]
    inside: Floats  # (K,) [m] of the foot from the nearest border


def shallow_facets(hull: Hull, basins: Landscape, faces: list[Face]) -> ShallowFacets:
    """Find the facets on which a body stands and which are not among its stable faces.

    The foot of the centre of mass lies inside them, but next to nothing tips the part to a deeper neighbour.
    Facets of a curved side that rolls are left out: they are those of the tessellation.

    Parameters
    ----------
    hull : Hull
    basins : Landscape
    faces : list of Face
        Stable faces.

    Returns
    -------
    ShallowFacets
        K rows, the one with the foot furthest inside first.

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    bends = angle(*(hull.normals[basins.pairs[:, k]] for k in (0, 1)))
    side = component_of(basins.pairs[bends < SMOOTH_ANGLE], len(hull.triangles))
    free = np.ones(len(hull.triangles), dtype=bool)
    for face in faces:
        free[face.triangles] = False
        if face.kind == "rolling":
            free[np.isin(side, side[face.triangles])] = False
            free[np.isin(basins.basins, basins.basins[face.triangles])] = False
    plane = component_of(basins.pairs[bends < ONE_PLANE], len(free))
    candidates = np.unique(plane[basins.lows])
    candidates = candidates[~np.isin(candidates, np.unique(plane[~free]))]
    order = np.argsort(plane, kind="stable")
    bounds = np.searchsorted(plane[order], [candidates, candidates + 1])
    rows = []
    for start, end in bounds.T:
        # Normal, height, area and solid angle of the triangles of one plane. An edge is on the border if no
        # other triangle of the plane has it the other way round; the foot is inside by its least distance.
        facet = order[start:end]
        areas, corners = hull.areas[facet], hull.triangles[facet]
        normal = vectors.unit(np.einsum("t,tx->x", areas, hull.normals[facet]))
        height = float(np.einsum("t,t->", areas, hull.heights[facet]) / areas.sum())
        starts, ends = corners.ravel(), corners[:, [1, 2, 0]].ravel()
        border = ~np.isin(starts * len(hull.vertices) + ends, ends * len(hull.vertices) + starts)
        p, q = hull.vertices[starts[border]], hull.vertices[ends[border]]
        inwards = vectors.unit(vectors.cross(normal, q - p))
        inside = float(np.einsum("ex,ex->e", height * normal - p, inwards).min())
        if inside > MIN_INSIDE_SHARE * hull.radius:
            rows.append((normal, height, areas.sum(), hull.solid_angles[facet].sum(), inside))
    largest = sorted(rows, key=lambda row: -row[4])[:MAX_SHALLOW]
    normals, *columns = zip(*largest) if largest else (np.empty((0, 3)), *[np.empty(0)] * 4)
    return ShallowFacets(np.array(normals), *(np.array(column) for column in columns))


def published_changes(
    shallow: ShallowFacets,
    weights: dict[str, Floats],
    stable: Bools,
    inertia: Floats,
    as_published: bool,
) -> dict[str, Floats]:
    """Return the probabilities by the published rules with every facet on which the body stands.

    Parameters
    ----------
    shallow : ShallowFacets
    weights : dict of str to (A,) float [any one unit]
        Of the aspects, by rule.
    stable : (A,) bool
    inertia : (3, 3) float [kg m2]
        About the centre of mass.
    as_published : bool
        Count equal facets once in the PMI rule.

    Returns
    -------
    dict of str to (A,) float [1]
        Of the aspects; the rest, up to 1, belongs to the facets.

    References
    ----------
    The rules of the thesis, chapter 3, over more faces.
    """
    heights, areas = shallow.heights, shallow.areas
    ones = once = np.ones(len(heights), dtype=int)
    moments = vectors.dot(vectors.product(shallow.normals, inertia), shallow.normals)
    if as_published and len(ones):
        columns = np.column_stack([heights / heights.max(), areas / areas.max()])
        _, first = np.unique(columns.round(ALIKE_DIGITS), axis=0, return_index=True)
        once = np.zeros_like(ones)
        once[first] = 1
    more = {
        "pmi": formulas.pmi(once, moments, heights),
        "csa": formulas.csa(ones, shallow.solid_angles, heights),
        "stability": formulas.stability(ones, areas, heights),
    }
    changed = {}
    for rule, weight in more.items():
        own = np.where(stable, weights[rule], 0.0)
        changed[rule] = own / (own.sum() + weight.sum())
    return changed


def shallow_remark(
    shallow: ShallowFacets, names: tuple[str, ...], chances: dict[str, Floats], complete: dict[str, Floats]
) -> tuple[Detail, ...]:
    """Return a sentence about the published rules with every facet, if they differ; else nothing.

    Parameters
    ----------
    shallow : ShallowFacets
    names : tuple of A str
    chances : dict of str to (A,) float [1]
        By rule, over the aspects alone.
    complete : dict of str to (A,) float [1]
        By rule, over every facet.

    Returns
    -------
    tuple of Detail
        One sentence, or no sentence: the recommended rule does not depend on it.
    """
    changes = {rule: np.abs(chances[rule] - complete[rule]) for rule in complete}
    if not len(shallow.inside) or max(change.max() for change in changes.values()) < MIN_CHANGE:
        return ()
    rows = {rule: int(np.argmax(change)) for rule, change in changes.items()}
    pieces = ", ".join(
        f"p_{rule} of {names[k]} {complete[rule][k]:.3f} for {chances[rule][k]:.3f}"
        for rule, k in rows.items()
    )
    count = len(shallow.inside)
    facets, them = (
        ("1 facet is no aspect", "it") if count == 1 else (f"{count} facets are no aspects", "them")
    )
    return (
        Detail(
            f"{facets} here, although the part stands on {them} (foot of the centre of "
            f"mass up to {shallow.inside.max() / MM:.2g} mm inside), because next to nothing tips it to a "
            f"neighbour; the rules as published count {them}: {pieces}"
        ),
    )


def names_text(part: Part, aspects: Aspects) -> str:
    """Return the names of a part's stable aspects as the text of a file for ``read_aspect_names``.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.

    Returns
    -------
    str
        YAML: a name and the direction of the part's file that is down, a line each.
    """
    lines = [
        f"# Aspects of {one_line(part.name)}: which direction of its file is down on each.",
        "# Change a name and leave its direction, then give this file as the names of the part.",
        "aspects:",
    ]
    for row in np.flatnonzero(aspects.stable):
        lines.append(f"  {aspects.names[row]}: [{', '.join(f'{x:.7g}' for x in aspects.normals[row])}]")
    return "\n".join([*lines, ""])


@with_shown_signature
def write_names(part: Part, aspects: Aspects, path: str | PathLike[str]) -> None:
    """Write the names of a part's aspects to a file that ``load`` takes as ``names``.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    path : str or Path
        File to write anew. A user changes a name there and leaves its direction.

    Returns
    -------
    None

    Raises
    ------
    FeederError
        If the part is a card, which has its own names, or the file cannot be written.
    """
    check.kind("part", part, Part, PART_MEND)
    check.kind("aspects", aspects, Aspects, ASPECTS_MEND)
    if part.vertices is None:
        raise ArgumentError("part", "a part card has its own names", "give a mesh")
    check.path("path", path)
    try:
        Path(path).write_text(names_text(part, aspects), encoding="utf-8")
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
        raise FeederError(path, what, "give another path") from None
