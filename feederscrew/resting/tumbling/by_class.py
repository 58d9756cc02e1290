"""Exact tumbling, barriers and the rules built on them, by class of resting aspect."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.errors import MeshError
from feederscrew.part.hull import Hull
from feederscrew.resting.basins import barriers
from feederscrew.resting.faces import Face
from feederscrew.resting.rules import published, registry, surface
from feederscrew.resting.rules.quantities import FaceQuantities
from feederscrew.resting.tumbling.exact import tumble
from feederscrew.units import GRAVITY


@dataclass(frozen=True, eq=False)
class Ground:
    """The faces a part can rest on and how they hang together; F faces, T hull triangles."""

    hull: Hull
    faces: tuple[Face, ...]
    rows: np.ndarray  # (F,) row of each face's class among the aspects
    labels: np.ndarray  # (T,) face of each hull triangle, -1 for none
    tips: barriers.Tipping


@dataclass(frozen=True, eq=False)
class Exact:
    """What exact tumbling adds to the aspects, A rows; NaN where the part does not rest."""

    probabilities: dict[str, np.ndarray]  # (A,) [1] by every rule that weighs faces
    barriers: np.ndarray  # (A,) [m] lowest lift that tips the part; NaN where nothing does
    barrier_energies: np.ndarray  # (A,) [J]
    tip_angles: np.ndarray  # (A,) [rad] of the floor, at which a part that does not slide tips
    doubts: tuple[str, ...]  # self-checks of the tumbling that failed


@dataclass(frozen=True)
class Transition:
    """The lowest way by which a part tips from one aspect into another (or into its equal)."""

    start: int  # row of the aspect it leaves
    end: int
    lift: float  # [m]
    axis: tuple[float, float, float]  # unit, along the edge it tips over, in the file's axes


def grounded(hull, faces, rows):
    """Compute the exact basins and barriers of the faces a part rests on.

    Parameters
    ----------
    hull : Hull
    faces : sequence of Face
        Stable ones.
    rows : (F,) int
        Row of each face's class among the aspects.

    Returns
    -------
    Ground
    """
    labels = np.full(len(hull.triangles), barriers.UNNAMED)
    for k, face in enumerate(faces):
        labels[face.triangles] = k
    tips = barriers.tipping(tumble(hull), labels)
    return Ground(hull, tuple(faces), check.frozen(rows), check.frozen(labels), tips)


def ground(part, aspects):
    """Return the faces of a part matched to the rows of its aspects, with exact basins and barriers.

    Parameters
    ----------
    part : Part
        With a mesh.
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


def exact(found, part, aspects, exponent=surface.EXPONENTS["hard"]):
    """Compute the columns that exact tumbling adds to the aspects of a part.

    Source: docs/resting.md, "Exact tumbling" and "Barriers and the tipping graph".

    Parameters
    ----------
    found : Ground
    part : Part
    aspects : Aspects
    exponent : float [1]
        Of the surface-weighted closed form.

    Returns
    -------
    Exact
    """
    tips, count = found.tips, len(aspects.names)
    lifts = barriers.barriers(tips)
    lowest = _lowest(found.rows, np.where(np.isfinite(lifts), lifts, np.nan), count)
    angles = _tip_angles(found.faces, lifts)
    return Exact(
        probabilities=_probabilities(found, aspects.stable, exponent),
        barriers=check.frozen(lowest),
        barrier_energies=check.frozen(part.mass * GRAVITY * lowest),
        tip_angles=check.frozen(_lowest(found.rows, angles, count)),
        doubts=tips.doubts,
    )


def _probabilities(found, stable, exponent):
    """Probability of each class by every rule that weighs faces."""
    tips = found.tips
    quantities = FaceQuantities(
        tips=tips,
        faces=found.faces,
        shares=tips.shares,
        heights=tips.heights,
        radius=found.hull.radius,
        exponent=exponent,
    )
    weights = registry.weights(quantities)
    return {rule: _by_class(found, weight, stable) for rule, weight in weights.items()}


def _by_class(found, weights, stable):
    """(A,) shares of the classes, from the (F,) weights of their faces."""
    sums = np.bincount(found.rows, weights, minlength=len(stable))
    return check.frozen(published.normalised(sums, stable))


def transitions(found):
    """Return the graph of what tips into what.

    Parameters
    ----------
    found : Ground

    Returns
    -------
    list of Transition
        The lowest way of each ordered pair of classes, by row; into an equal face as well.
    """
    lifts, ways = barriers.rises(found.tips), {}
    for pair, lift, axis in zip(found.rows[found.tips.pairs], lifts, found.tips.axes):
        for start, end, up in ((*pair, lift[0]), (*pair[::-1], lift[1])):
            way = Transition(int(start), int(end), float(up), tuple(axis.tolist()))
            best = ways.setdefault((way.start, way.end), way)
            if way.lift < best.lift:
                ways[way.start, way.end] = way
    return [ways[pair] for pair in sorted(ways)]


def _tip_angles(faces, lifts):
    """(F,) [rad] tilt of the floor that tips the part off each face; NaN where nothing does."""
    angles = np.array([_rolling_tip_angle(*face) for face in zip(faces, lifts)])
    flat = np.array([face.kind == "flat" for face in faces])
    if flat.any():
        flats = [face for face in faces if face.kind == "flat"]
        angles[flat] = barriers.tip_angles([face.polygon for face in flats], [face.height for face in flats])
    return angles


def _rolling_tip_angle(face, lift):
    if face.kind == "flat" or not np.isfinite(lift):
        return np.nan
    if np.isnan(face.axis).any():  # a ball with a flat leaves it over the saddle
        return barriers.tilt_over(face.height, face.height + lift)
    return barriers.line_tip_angle(face.polygon, face.normal, face.axis, face.height)


def _lowest(rows, values, count):
    """(A,) smallest value of each row's faces; NaN where there is none."""
    lowest = np.full(count, np.inf)
    np.fmin.at(lowest, rows, values)
    return np.where(np.isfinite(lowest), lowest, np.nan)
