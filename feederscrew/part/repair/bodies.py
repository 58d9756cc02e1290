"""Several bodies taken together as one part: each turned by itself, united where they overlap."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.errors import MeshError
from feederscrew.geometry.graphs import components
from feederscrew.part import mass
from feederscrew.part.repair import shells, weld

MAX_SHELLS = 1000
OVERLAP_SHARE = 1e-6  # [1] of the smallest body: less is the file's rounding
LISTED_BODIES = 3  # with their volume
SAVE_APART = "save each body as a file of its own, or unite them in CAD if they are one part"
INNER_CAVITY = "reverse the inner surface if it is a body, else leave it out"
CROSSING_CAVITY = "move the cavity inside the material, or turn the body inside out, in CAD"


@dataclass(frozen=True, eq=False)
class BodiesTogether:
    """The closed surface of several bodies as one part."""

    vertices: NDArray[np.float64]  # (V, 3) [unit of the file]
    faces: NDArray[np.int64]  # (F, 3) each body outwards, each cavity into it
    warnings: tuple[str, ...]


def take_together(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int64],
    shell: NDArray[np.int64],
    volume: NDArray[np.float64],
    where: str,
    unit: str,
) -> BodiesTogether:
    """Turn each body outwards and each cavity into it, and unite the bodies that overlap.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
        Closed.
    shell : (F,) int
        Which closed surface each facet belongs to.
    volume : (S,) float [cubed unit of the file]
        That each encloses, negative where it faces inwards.
    where, unit : str
        The file and its unit, for error lines.

    Returns
    -------
    BodiesTogether

    Raises
    ------
    MeshError
        If it is open to doubt what is material: a cavity within a cavity, or one that crosses a surface. Also
        if bodies overlap and cannot be united.

    Notes
    -----
    What lies in no other surface is a body. What lies in a body and faces the other way is its cavity; facing
    the same way it is material that is counted once. What lies in a cavity and faces the other way is a body.
    """
    if len(volume) > MAX_SHELLS:
        raise MeshError(where, f"holds {len(volume)} closed surfaces", SAVE_APART)
    parent, is_body = _nest(vertices, faces, shell, volume, where, unit)
    turned = is_body != (volume > 0.0)
    faces = np.where(turned[shell][:, None], faces[:, ::-1], faces)
    bodies = np.flatnonzero(is_body)
    listed = ", ".join(f"{v:.4g}" for v in np.sort(np.abs(volume[bodies]))[::-1][:LISTED_BODIES])
    listed += ", ..." if len(bodies) > LISTED_BODIES else ""
    warnings = [f"holds {len(bodies)} bodies, of {listed} {unit}3: taken together as one part (`allow_open`)"]
    reversed_bodies = int(turned[bodies].sum())
    if 0 < reversed_bodies < len(bodies):
        warnings.append(f"{reversed_bodies} of {len(bodies)} bodies pointed inwards; reversed")
    embedded = bodies[(parent[bodies] >= 0) & is_body[parent[bodies]]]
    if len(embedded):
        largest = np.abs(volume[embedded]).max()
        number = f"{len(embedded)} {'body lies' if len(embedded) == 1 else 'bodies lie'}"
        warnings.append(
            f"{number} wholly inside others, the largest of {largest:.4g} {unit}3, all facing the same way: "
            "counted once; a cavity must face the other way"
        )
    owner = np.where(is_body, np.arange(len(volume)), parent)
    before = float(mass.tetrahedra(vertices[faces]).sum())
    united = _unite(vertices, faces, owner[shell], bodies, where)
    if united is not None:
        vertices, faces = united
        after = float(mass.tetrahedra(vertices[faces]).sum())
        warnings.append(f"bodies overlap: united, {after:.4g} {unit}3 for {before:.4g} {unit}3 one by one")
    return BodiesTogether(vertices, faces, tuple(warnings))


def _nest(vertices, faces, shell, volume, where, unit):
    """(S,) int the surface next around each, -1 without one; (S,) bool whether it is a body, not a cavity."""
    low, high = _boxes(vertices, faces, shell, len(volume))
    order = np.argsort(-np.abs(volume), kind="stable")
    parent, is_body = np.full(len(volume), -1), np.ones(len(volume), dtype=bool)
    for place, inner in enumerate(order):
        larger = order[:place]
        meets = ((low[inner] < high[larger]) & (high[inner] > low[larger])).all(axis=1)
        for outer in larger[meets]:
            turns = np.abs(shells.turns_around(vertices, faces, shell, inner, outer))
            if (np.abs(turns - 1.0) < 0.1).all():
                parent[inner] = outer
            elif (turns > 0.1).any() and volume[inner] * volume[outer] < 0.0:
                what = f"a surface of {abs(volume[inner]):.4g} {unit}3 that faces inwards crosses another"
                raise MeshError(where, what, CROSSING_CAVITY)
        if parent[inner] < 0:
            continue
        same_way = bool(volume[inner] * volume[parent[inner]] > 0.0)
        is_body[inner] = is_body[parent[inner]] == same_way
        if same_way and not is_body[inner]:
            what = f"a cavity of {abs(volume[inner]):.4g} {unit}3 lies inside another"
            raise MeshError(where, what, INNER_CAVITY)
    return parent, is_body


def _boxes(vertices, faces, shell, number):
    """(S, 3) and (S, 3) the lowest and highest corner of each shell's box."""
    low, high = np.full((number, 3), np.inf), np.full((number, 3), -np.inf)
    for corner in faces.T:
        np.minimum.at(low, shell, vertices[corner])
        np.maximum.at(high, shell, vertices[corner])
    return low, high


def _unite(vertices, faces, owner, bodies, where):
    """The surface after bodies that overlap are united; None where none do."""
    low, high = _boxes(vertices, faces, owner, int(owner.max()) + 1)
    low, high = low[bodies], high[bodies]
    meets = ((low[:, None] < high) & (high[:, None] > low)).all(axis=2)
    i, j = np.nonzero(np.triu(meets, 1))
    number, group = components(i, j, len(bodies))
    pieces, changed = list[NDArray[np.float64]](), False
    for members in (bodies[group == k] for k in range(number)):
        own = [vertices[faces[owner == body]] for body in members]
        union = _union(own, where) if len(own) > 1 else None
        changed = changed or union is not None
        pieces += own if union is None else [union]
    if not changed:
        return None
    corners = np.concatenate(pieces)
    return weld.welded(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _union(bodies, where):
    """(F, 3, 3) [unit of the file] the union of bodies given as triangles; None where they only touch.

    The one door of this room to manifold3d.
    """
    from manifold3d import Error, Manifold, Mesh64, OpType

    volumes = [float(mass.tetrahedra(body).sum()) for body in bodies]
    solids = []
    for body in bodies:
        points, facets = weld.welded(body.reshape(-1, 3), np.arange(3 * len(body)).reshape(-1, 3))
        solids.append(Manifold(Mesh64(points, facets.astype(np.uint64))))
    if any(solid.status() != Error.NoError for solid in solids):
        raise MeshError(where, "holds bodies that may overlap and cannot be united", SAVE_APART)
    mesh = Manifold.batch_boolean(solids, OpType.Add).to_mesh64()
    corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts).astype(int)]
    if sum(volumes) - float(mass.tetrahedra(corners).sum()) <= OVERLAP_SHARE * min(volumes):
        return None
    return corners[np.lexsort(corners.reshape(-1, 9).T[::-1])]
