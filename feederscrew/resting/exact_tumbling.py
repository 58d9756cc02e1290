"""Exact quasi-static tumbling, where a body set down without momentum comes to rest, by class of aspect.

Source: docs/resting.md, "Exact tumbling" and "Barriers and the tipping graph".
"""

from dataclasses import dataclass

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.geometry import compiled, vectors
from feederscrew.base.units import GRAVITY
from feederscrew.part.hull import Hull
from feederscrew.part.record import Part
from feederscrew.resting import barriers, walks
from feederscrew.resting import half_edges as tumbling_edges
from feederscrew.resting.barriers import Tumbling
from feederscrew.resting.faces import Face
from feederscrew.resting.rules import formulas, registry
from feederscrew.resting.rules.registry import FaceQuantities

SHARE_SUM_TOLERANCE = 1e-6  # [1] what the shares may miss 1 by before the result is called doubtful
FACET_UNEVENNESS = 1e-7  # [1] of the radius: corners of a facet merged from needles lie so far off its plane


def tumble(hull: Hull) -> Tumbling:
    """Return basins, saddles and maxima of the quasi-static flow on a convex hull.

    A body without momentum rolls so that its centre of mass sinks. The directions from which it ends on a
    facet are that facet's basin, bounded by the ways up from the saddles. The area of a basin is summed along
    these ways, so the shares are exact.

    Parameters
    ----------
    hull : Hull
        The centre of mass must lie strictly inside.

    Returns
    -------
    Tumbling
        ``doubts`` names every self-check that failed: the areas fill the sphere, sinks - saddles + maxima =
        2, every walk falls from its saddle to a sink and rises from it to a maximum.

    References
    ----------
    K. Goldberg, B. Mirtich, Y. Zhuang, J. Craig, B. Carlisle, J. Canny, "Part pose statistics: estimators and
    experiments", IEEE Trans. Robot. Autom. 15(5), 849-857, 1999 (the model). H. Baktash, N. Sharp, Q. Zhou,
    A. Jacobson, K. Crane, "Putting rigid bodies to rest", ACM Trans. Graph. 44(4), 2025 (its Morse-Smale
    form; written here from the mathematics).
    """
    edges = tumbling_edges.half_edges(hull)
    sinks, saddles = tumbling_edges.sinks(edges), tumbling_edges.saddles(edges)
    maxima = tumbling_edges.maxima(edges)
    # feet of the centre of mass on the saddles' edges; heights over sinks and saddles
    u = edges.vertices[edges.origins[saddles]]
    along = edges.vertices[edges.targets[saddles]] - u
    feet = u - along * (edges.slopes[saddles] / np.einsum("ei,ei->e", along, along))[:, None]
    corners = edges.vertices[edges.origins[edges.facet_edges[sinks]]]
    heights, saddle_heights = np.einsum("si,si->s", edges.normals[sinks], corners), vectors.norm(feet)
    directions = feet / saddle_heights[:, None]
    # the sinks each saddle joins, the boundary integrals of their basins, and whether every walk arrived
    tops = np.zeros(len(edges.vertices), bool)
    tops[maxima] = True
    pairs, peaks = np.empty((2, len(saddles), 2), int)
    raw = np.zeros(len(edges.normals))
    trace = compiled.fitting(walks.trace_saddles, len(edges.origins))
    gauges = edges.normals + 1e-3 * np.array([0.5377, -0.8339, 0.1246])  # off every symmetry plane of a part
    gauges = gauges / vectors.norm(gauges)[:, None]
    trace(edges, tops, saddles, directions, gauges, pairs, peaks, raw)
    rank = np.full(len(edges.normals) + 1, -1)  # the last entry stands for a lost walk
    rank[sinks] = np.arange(len(sinks))
    pairs, raw, arrived = rank[pairs], raw[sinks], bool((pairs >= 0).all() and (peaks >= 0).all())
    areas = _areas(raw)
    falls = (pairs >= 0) & (heights[pairs] <= saddle_heights[:, None] + FACET_UNEVENNESS * hull.radius)
    whole, euler = areas.sum() / barriers.SPHERE, len(sinks) - len(saddles) + len(maxima)
    doubts = {
        f"the basins fill {whole:.6g} of the sphere": abs(whole - 1.0) > SHARE_SUM_TOLERANCE,
        "a basin has a negative area": (areas < 0.0).any(),
        f"sinks - saddles + maxima is {euler}, not 2": euler != 2,
        "a walk from a saddle does not fall to a sink and rise to a maximum": not (arrived and falls.all()),
    }
    return Tumbling(
        sinks=check.frozen(edges.facet_edges[sinks] // 3),
        normals=check.frozen(edges.normals[sinks]),
        heights=check.frozen(heights),
        areas=check.frozen(areas),
        pairs=check.frozen(pairs),
        saddle_heights=check.frozen(saddle_heights),
        saddle_axes=check.frozen(along / vectors.norm(along)[:, None]),
        maxima=check.frozen(maxima),
        doubts=tuple(text for text, wrong in doubts.items() if wrong),
    )


def _areas(raw: Floats) -> Floats:
    """Return basin areas from boundary integrals; those that hold the point opposite the gauge lack 4 pi."""
    if len(raw) == 1:
        return np.array([barriers.SPHERE])
    missing = max(round(1.0 - raw.sum() / barriers.SPHERE), 0)
    areas = raw.copy()
    if missing:
        areas[np.argsort(raw, kind="stable")[:missing]] += barriers.SPHERE
    return np.where((areas < 0.0) & (areas > -SHARE_SUM_TOLERANCE), 0.0, areas)


@dataclass(frozen=True, eq=False)
class Ground:
    """The faces a part can rest on and how they hang together; F faces, T hull triangles."""

    hull: Hull
    faces: tuple[Face, ...]
    rows: Ints  # (F,) row of each face's class among the aspects
    labels: Ints  # (T,) face of each hull triangle, -1 for none
    tips: barriers.Tipping


@dataclass(frozen=True, eq=False)
class Exact:
    """Exact tumbling of the aspects, A rows; NaN where the part does not rest."""

    probabilities: dict[str, Floats]  # (A,) [1] by every rule that weighs faces
    barriers: Floats  # (A,) [m] lowest lift that tips the part; NaN where nothing does
    barrier_energies: Floats  # (A,) [J]
    tip_angles: Floats  # (A,) [rad] of the floor, at which a part that does not slide tips


@dataclass(frozen=True)
class Transition:
    """The lowest way by which a part tips from one aspect into another (or into its equal)."""

    start: int  # row of the aspect it leaves
    end: int
    lift: float  # [m]
    axis: tuple[float, float, float]  # unit, along the edge it tips over, in the file's axes


def ground_faces(hull: Hull, faces: list[Face], rows: Ints) -> Ground:
    """Return exact basins and barriers of stable faces.

    Parameters
    ----------
    hull : Hull
    faces : list of F Face
    rows : (F,) int
        Row of each face's class among the aspects.

    Returns
    -------
    Ground
    """
    labels = np.full(len(hull.triangles), barriers.UNNAMED)
    for k, face in enumerate(faces):
        labels[face.triangles] = k
    tips = barriers.gather_tipping(tumble(hull), labels)
    return Ground(hull, tuple(faces), check.frozen(rows), check.frozen(labels), tips)


def tumble_classes(
    ground: Ground, part: Part, stable: Bools, exponent: float = formulas.EXPONENTS["hard"]
) -> Exact:
    """Return the columns that exact tumbling adds to the aspects of a part.

    Parameters
    ----------
    ground : Ground
    part : Part
    stable : (A,) bool
        Which aspects are stable.
    exponent : float [1]
        Exponent of the surface-weighted closed form.

    Returns
    -------
    Exact

    References
    ----------
    docs/resting.md, "Exact tumbling" and "Barriers and the tipping graph".
    """
    tips, count = ground.tips, len(stable)
    lifts = barriers.barriers(tips)
    lowest = _lowest(ground.rows, np.where(np.isfinite(lifts), lifts, np.nan), count)
    # tilt of the floor that tips the part off each face; NaN where nothing does
    faces = ground.faces
    angles = np.full(len(faces), np.nan)
    flat = np.array([face.kind == "flat" for face in faces])
    for k in np.flatnonzero(~flat & np.isfinite(lifts)):
        face, height, axis = faces[k], faces[k].height, faces[k].axis
        if np.isnan(axis).any():  # a ball with a flat leaves it over the saddle
            reach = np.sqrt(np.maximum((height + lifts[k]) ** 2 - height**2, 0.0))
        else:  # over the nearer end of the line of contact, which may lead from one circle to another
            along = vectors.unit(axis - vectors.dot(axis, face.normal) * face.normal)
            ends = vectors.product(face.polygon, along)
            reach = min(ends.max(), -ends.min())
        angles[k] = np.arctan2(reach, height)
    if flat.any():
        flats = [face for face in faces if face.kind == "flat"]
        angles[flat] = barriers.tip_angles([face.polygon for face in flats], [face.height for face in flats])
    quantities = FaceQuantities(
        tips=tips,
        faces=faces,
        shares=tips.shares,
        heights=tips.heights,
        radius=ground.hull.radius,
        exponent=exponent,
    )
    chances = {}  # of the classes, from the weights of their faces
    for rule, weights in registry.weights(quantities).items():
        sums = np.bincount(ground.rows, weights, minlength=count).astype(float)
        chances[rule] = check.frozen(formulas.normalise(sums, stable))
    return Exact(
        probabilities=chances,
        barriers=check.frozen(lowest),
        barrier_energies=check.frozen(part.mass * GRAVITY * lowest),
        tip_angles=check.frozen(_lowest(ground.rows, angles, count)),
    )


def transitions(ground: Ground) -> list[Transition]:
    """Return the lowest way of each ordered pair of classes; into an equal face as well.

    Parameters
    ----------
    ground : Ground

    Returns
    -------
    list of Transition
        By row.
    """
    lifts = barriers.rises(ground.tips)
    lowest: dict[tuple[int, int], Transition] = {}
    for pair, lift, axis in zip(ground.rows[ground.tips.pairs], lifts, ground.tips.axes):
        for start, end, up in ((*pair, lift[0]), (*pair[::-1], lift[1])):
            step = Transition(int(start), int(end), float(up), tuple(axis.tolist()))
            best = lowest.setdefault((step.start, step.end), step)
            if step.lift < best.lift:
                lowest[step.start, step.end] = step
    return [lowest[pair] for pair in sorted(lowest)]


def _lowest(rows: Ints, values: Floats, count: int) -> Floats:
    """Return the smallest value (A,) of each row's faces; NaN where there is none."""
    lowest = np.full(count, np.inf)
    np.fmin.at(lowest, rows, values)
    return np.where(np.isfinite(lowest), lowest, np.nan)
