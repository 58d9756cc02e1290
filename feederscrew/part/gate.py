"""The gate: from triangles as a file has them to one closed solid, or a line that says why not."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Floats, Ints, Points, Triangles, Vector
from feederscrew.base.errors import MeshError, SeveralBodiesError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.graphs import components
from feederscrew.base.heavy import heavy
from feederscrew.base.units import counted
from feederscrew.part import mass, mending, topology
from feederscrew.part.mending import EXPORT_SOLID
from feederscrew.part.topology import MeshEdges

manifold3d = heavy("manifold3d")
shapely = heavy("shapely")


MAX_TOGETHER_BODIES = 1000
BODY_OVERLAP_SHARE = 1e-6  # [1] of the smallest body: less is the file's rounding
SAVE_APART = "save each body as a file of its own, or unite them in CAD if they are one part"


def take_together(
    vertices: Points,
    faces: Triangles,
    shell: Ints,
    volume: Floats,
    where: str,
    unit: str,
) -> tuple[Points, Triangles, tuple[str, ...]]:
    """Turn each body outwards and each cavity into it, unite the bodies that overlap, and say so.

    What lies in no other surface is a body. What lies in a body and faces the other way is its cavity; facing
    the same way it is material that is counted once. What lies in a cavity and faces the other way is a body.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
        Of S closed surfaces.
    shell : (F,) int
        The closed surface that each facet belongs to.
    volume : (S,) float [cubed unit of the file]
        That each surface encloses, negative where it faces inwards.
    where, unit : str
        The file and its unit, for error lines.

    Returns
    -------
    vertices : (V', 3) float [unit of the file]
    faces : (F', 3) int
        Of all bodies, facing out of the material.
    warnings : tuple of str
        A sentence for everything that was done.

    Raises
    ------
    MeshError
        If it is open to doubt what is material: a cavity within a cavity, or one that crosses a surface. Also
        if bodies overlap and cannot be united, or if there are more than ``MAX_TOGETHER_BODIES``.
    """
    if len(volume) > MAX_TOGETHER_BODIES:
        raise MeshError(where, f"holds {len(volume)} closed surfaces", SAVE_APART)
    # the surface next around each, -1 without one, and whether it is a body, not a cavity
    low, high = topology.shell_boxes(vertices, faces, shell, len(volume))
    order = np.argsort(-np.abs(volume), kind="stable")
    parent, is_body = np.full(len(volume), -1), np.ones(len(volume), dtype=bool)
    for place, inner in enumerate(order):
        larger = order[:place]
        meets = ((low[inner] < high[larger]) & (high[inner] > low[larger])).all(axis=1)
        for outer in larger[meets]:
            turns = np.abs(topology.turns_around(vertices, faces, shell, inner, outer))
            if (np.abs(turns - 1.0) < 0.1).all():
                parent[inner] = outer
            elif (turns > 0.1).any() and volume[inner] * volume[outer] < 0.0:
                what = f"a surface of {abs(volume[inner]):.4g} {unit}3 that faces inwards crosses another"
                mend = "move the cavity inside the material, or turn the body inside out, in CAD"
                raise MeshError(where, what, mend)
        if parent[inner] >= 0:
            same_way = bool(volume[inner] * volume[parent[inner]] > 0.0)
            is_body[inner] = is_body[parent[inner]] == same_way
            if same_way and not is_body[inner]:
                what = f"a cavity of {abs(volume[inner]):.4g} {unit}3 lies inside another"
                mend = "reverse the inner surface if it is a body, else leave it out"
                raise MeshError(where, what, mend)
    turned = is_body != (volume > 0.0)
    faces = np.where(turned[shell][:, None], faces[:, ::-1], faces)
    bodies = np.flatnonzero(is_body)
    listed = topology.list_volumes(np.sort(np.abs(volume[bodies]))[::-1])
    warnings = [f"holds {len(bodies)} bodies, of {listed} {unit}3: taken together as one part (`allow_open`)"]
    reversed_bodies = int(turned[bodies].sum())
    if 0 < reversed_bodies < len(bodies):
        warnings.append(f"{reversed_bodies} of {len(bodies)} bodies pointed inwards; reversed")
    embedded = bodies[(parent[bodies] >= 0) & is_body[parent[bodies]]]
    if len(embedded):
        largest = np.abs(volume[embedded]).max()
        number = counted(len(embedded), "body lies", "bodies lie")
        warnings.append(
            f"{number} wholly inside others, the largest of {largest:.4g} {unit}3, all facing the same way: "
            "counted once; a cavity must face the other way"
        )
    owner = np.where(is_body, np.arange(len(volume)), parent)
    united = _unite_bodies(vertices, faces, owner[shell], bodies, where)
    if united is not None:
        before, after = (float(mass.tetrahedron_volumes(v[f]).sum()) for v, f in ((vertices, faces), united))
        warnings.append(f"bodies overlap: united, {after:.4g} {unit}3 for {before:.4g} {unit}3 one by one")
        vertices, faces = united
    return vertices, faces, tuple(warnings)


def _unite_bodies(
    vertices: Points, faces: Triangles, owner: Ints, bodies: Ints, where: str
) -> tuple[Points, Triangles] | None:
    """The surface after bodies that overlap are united; None where none do."""
    low, high = topology.shell_boxes(vertices, faces, owner, int(owner.max()) + 1)
    low, high = low[bodies], high[bodies]
    meets = ((low[:, None] < high) & (high[:, None] > low)).all(axis=2)
    i, j = np.nonzero(np.triu(meets, 1))
    number, group = components(i, j, len(bodies))
    pieces, changed = list[Floats](), False
    for members in (bodies[group == k] for k in range(number)):
        own = [vertices[faces[owner == body]] for body in members]
        solids = []
        for body in own if len(own) > 1 else ():
            points, facets = _weld_triangles(body)
            solids.append(manifold3d.Manifold(manifold3d.Mesh64(points, facets.astype(np.uint64))))
        if any(solid.status() != manifold3d.Error.NoError for solid in solids):
            raise MeshError(where, "holds bodies that may overlap and cannot be united", SAVE_APART)
        if solids:
            volumes = [float(mass.tetrahedron_volumes(body).sum()) for body in own]
            mesh = manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Add).to_mesh64()
            corners = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts).astype(int)]
            lost = sum(volumes) - float(mass.tetrahedron_volumes(corners).sum())
            if lost > BODY_OVERLAP_SHARE * min(volumes):  # else they only touch
                own, changed = [corners[np.lexsort(corners.reshape(-1, 9).T[::-1])]], True
        pieces += own
    return _weld_triangles(np.concatenate(pieces)) if changed else None


def _weld_triangles(corners: Floats) -> tuple[Points, Triangles]:
    """Triangles (F, 3, 3) with each distinct corner once."""
    return topology.weld_corners(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


FLAT_SOLID_SHARE = 1e-6  # [1] of the size: thinner is not a solid
EQUAL_CORNERS_SHARE = 1e-6  # [1] of the size: corners closer than that are one
LOST_SHAPE_SHARE, BLURRED_SHAPE_SHARE = 1e-2, 1e-5  # [1] of the size: steps of single precision
MAX_OPEN_EDGES = 100_000  # edges: with more it is not a surface with holes
FARTHEST_CORNER = 1e30  # [unit of the file]
EMPTY_VOLUME_SHARE = 1e-10  # [1] of the size cubed: less volume is rounding
HULL_OVERLAP_SHARE = 1e-6  # [1] of the hull's volume: more than the hull by so much is rounding
LEAST_FILL_SHARE, OPEN_LEAST_FILL_SHARE = 1e-5, 1e-3  # [1] of the hull's volume that a part fills
LOOSE_SHARE = 1e-3  # [1] of the area: so much may lie back to back where holes are filled
MOMENT_ROUNDING = 1e-9  # [1] of the largest: what rounding does to moments
MANY_CROSSINGS, MANY_CROSSINGS_SHARE = 50, 0.05  # pairs, and pairs of all facets [1]: a sheet lies on another
SHALLOW_CROSSING_SHARE, DEEP_CROSSING_SHARE = 1e-4, 2e-2  # [1] of the size: passed unsaid, and at all
CLOSE_IN_CAD = "close it in CAD, or pass `allow_open` to compute from what there is"
SEW_IN_CAD = "join (sew, stitch) its faces in CAD and export one solid"
UNITE_IN_CAD = "unite what overlaps in CAD, or pass `allow_open` to compute from what there is"
DELETE_SHEET = "delete or close it in CAD, or pass `allow_open` to compute from what there is"
MESH_AGAIN = "mesh it again, unite what overlaps in CAD, or pass `allow_open` to compute from what there is"
EXPORT_NEAR_ORIGIN = "export it near the origin"
# vertices, faces, what they enclose, whether open or of several bodies, warnings, facets that may cut others
Enclosed = tuple[Points, Triangles, mass.Solid, bool, tuple[str, ...], Ints]


@dataclass(frozen=True, eq=False)
class CheckedSurface:
    """One solid's surface, facing outwards, and what it encloses."""

    vertices: Points  # (V, 3) [unit of the file]
    faces: Triangles  # (F, 3) counter-clockwise seen from outside
    solid: mass.Solid  # [powers of the unit of the file]
    open_surface: bool  # or several bodies, with allow_open
    warnings: tuple[str, ...]
    crossings: "Crossings"  # facets that cut each other, among those that are looked at


class SelfCutError(MeshError):
    """A surface that passes through itself, with the facets that do."""

    def __init__(self, where: object, what: str, mend: str, crossings: "Crossings") -> None:
        super().__init__(where, what, mend)
        self.crossings = crossings


def check_surface(
    vertices: Points, faces: Triangles, where: str, unit: str, allow_open: bool = False
) -> CheckedSurface:
    """Make one solid of loose triangles: weld, mend, close, turn outwards; refuse what bounds no solid.

    Every step that changes the surface leaves a warning.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
        As the file has them, maybe not finite.
    faces : (F, 3) int
    where, unit : str
        The file and its unit, for error lines.
    allow_open : bool, optional
        Whether an open surface, several bodies, or facets that cut each other deeply are taken as they are;
        wide cracks are joined then.

    Returns
    -------
    CheckedSurface

    Raises
    ------
    MeshError
        If the triangles bound no volume, do not close, pass through themselves, have moments that no body
        has, or lie so far from the origin that single precision has lost their shape.
    SeveralBodiesError
        If they bound more than one body.
    """
    vertices, faces = _drop_infinite(vertices, faces, where, unit)
    facets = len(faces)
    vertices, faces = topology.weld_corners(vertices, faces)
    lost = facets - len(faces)
    slivers = (f"{counted(lost, 'facet')} without area removed: two corners in one place",) if lost else ()
    # its largest extent; what is all in one plane, line or point is refused
    if not len(faces):
        raise MeshError(where, "is a line or a point: no facet has an area", EXPORT_SOLID)
    size = float(np.ptp(np.ascontiguousarray(vertices.T), axis=1).max())
    offsets = (vertices - vertices.mean(axis=0)) / size
    _, axes = vectors.eigen(vectors.product(offsets.T, offsets))
    if np.ptp(vectors.product(offsets, axes[:, 0])) <= FLAT_SOLID_SHARE:
        raise MeshError(where, "is flat: all its corners lie in one plane", EXPORT_SOLID)
    # the step between neighbouring numbers of single precision there
    reach, blurred = float(np.abs(vertices).max()), tuple[str, ...]()
    step = float(np.spacing(np.float32(min(reach, 1e38))))
    if step <= BLURRED_SHAPE_SHARE * size or not np.array_equal(vertices.astype(np.float32), vertices):
        step = min(step, BLURRED_SHAPE_SHARE * size)
    else:
        text = f"lies {reach:.4g} {unit} from the origin, where single precision keeps {step:.2g} {unit}"
        if step > LOST_SHAPE_SHARE * size:
            raise MeshError(where, f"{text}: its shape is lost", EXPORT_NEAR_ORIGIN)
        blurred = (f"{text}: {EXPORT_NEAR_ORIGIN}",)
    tolerance = EQUAL_CORNERS_SHARE * size + 2.0 * step
    loose = vertices, faces
    vertices, faces, edges, mended = mending.mend_facets(vertices, faces, tolerance, where)
    joined = None
    if not edges.is_closed:
        joined = mending.join_cracks(vertices, faces, tolerance, size, where, allow_open)
        if joined is None or not joined.edges.is_closed:
            # Cracks about as wide as the tolerance are half joined: the rest then closes from the start only.
            corners, sides, _, warnings = mending.mend_facets(*loose, tolerance, where, corners=False)
            whole = mending.join_cracks(corners, sides, tolerance, size, where)
            joined, mended = (joined, mended) if whole is None else (whole, warnings)
    if joined is None or not joined.edges.is_closed:
        sheets = mending.find_sheets(vertices, faces, edges, tolerance, where)
        if sheets is not None and (sheets.is_flat or sheets.is_inside):
            noun = "a sheet that bounds nothing" if sheets.is_flat else "an open surface"
            side = "inside" if sheets.is_inside else "outside"
            what = f"{counted(sheets.facets, 'facet')} of {noun}, at ({_place(sheets.place)})"
            if not ((sheets.is_flat and sheets.is_inside) or allow_open):
                raise MeshError(where, f"has {what}, {side} its closed surface", DELETE_SHEET)
            if sheets.is_flat and sheets.is_inside:
                vertices, faces, edges, joined = sheets.vertices, sheets.faces, sheets.edges, None
                mended = (*mended, *sheets.notes, f"{what}, inside the body: left out")
    if joined is not None:
        vertices, faces, edges = joined.vertices, joined.faces, joined.edges
        counts = ((joined.corners, "corner"), (joined.seams, "edge"))
        pieces = " and ".join(counted(count, noun) for count, noun in counts if count)
        cracks = f"cracks up to {joined.width:.2g} {unit} wide between facets: {pieces} joined"
        mended, tolerance = (*mended, cracks), max(tolerance, joined.width)
    enclosed = _enclose_closed if edges.is_closed else _enclose_open
    vertices, faces, solid, is_open, warnings, unseen = enclosed(
        vertices, faces, edges, size, where, unit, allow_open
    )
    is_open = is_open or (joined is not None and joined.width > mending.JOIN_SHARE * size)
    if solid.volume < 0.0:
        faces, solid = faces[:, ::-1], solid.inside_out
        warnings += ("all facets pointed inwards; reversed",)
    if solid.volume <= EMPTY_VOLUME_SHARE * size**3:
        raise MeshError(where, "encloses no volume", EXPORT_SOLID)
    cuts = NO_CROSSINGS
    if len(unseen):
        cuts = find_crossings(vertices, faces[unseen], tolerance)
        deepest, pairs = float(cuts.depths.max(initial=0.0)), counted(len(cuts.pairs), "pair")
        many = len(cuts.pairs) > max(MANY_CROSSINGS, MANY_CROSSINGS_SHARE * len(faces))
        if deepest > SHALLOW_CROSSING_SHARE * size or many:
            what = f"the surface passes through itself: {pairs} of facets cut each other, the deepest"
            what += f" by {deepest:.2g} {unit} at ({_place(cuts.points[np.argmax(cuts.depths)])})"
            if (deepest > DEEP_CROSSING_SHARE * size or many) and not allow_open:
                raise SelfCutError(where, what, MESH_AGAIN if many else UNITE_IN_CAD, cuts)
            warnings += (f"{what}: what lies inside twice counts twice",)
    # second moments that no mass within the part's corners has: facets are missing or overlap
    spreads = vectors.eigen(0.5 * np.trace(solid.inertia) * np.eye(3) - solid.inertia)[0] / solid.volume
    reach = np.square(vertices - solid.centre).sum(axis=1).max()  # no mass is further off than a corner
    if spreads[0] < -MOMENT_ROUNDING * spreads[2] or spreads.sum() > (1.0 + MOMENT_ROUNDING) * reach:
        moments = ", ".join(f"{moment:.3g}" for moment in mass.principal_inertia(solid.inertia)[0])
        what = f"no body has the principal moments {moments} {unit}5 (at density 1)"
        raise MeshError(where, f"{what}: facets are missing or overlap", EXPORT_SOLID)
    return CheckedSurface(vertices, faces, solid, is_open, slivers + blurred + mended + warnings, cuts)


def check_hull(surface: CheckedSurface, hull_volume: float, where: str, unit: str) -> None:
    """Refuse a surface that encloses more than its convex hull, or less of it than any part does.

    A wire of 0.3 mm along three edges of a cube of 100 mm fills 1.3e-4 of its hull; a surface whose facets
    hang together nowhere fills what rounding leaves.

    Parameters
    ----------
    surface : CheckedSurface
    hull_volume : float [cubed unit of the file]
        Of the hull of all corners. The part's own hull leaves out corners of a plate's faces that rounding
        lifts, and with them as much as ten times what rounding changes in the volume.
    where, unit : str
        The file and its unit, for error lines.

    Raises
    ------
    MeshError
    """
    volume = surface.solid.volume
    if volume > hull_volume * (1.0 + HULL_OVERLAP_SHARE):
        what = f"its volume, {volume:.4g} {unit}3, is more than its convex hull's, {hull_volume:.4g}"
        raise MeshError(where, f"{what}: facets overlap", "unite the overlapping bodies in CAD")
    if volume < (OPEN_LEAST_FILL_SHARE if surface.open_surface else LEAST_FILL_SHARE) * hull_volume:
        share = f"{volume / hull_volume:.1g} of its convex hull"
        raise MeshError(where, f"encloses {volume:.3g} {unit}3, {share}: that is no solid", SEW_IN_CAD)


def _drop_infinite(vertices: Points, faces: Triangles, where: str, unit: str) -> tuple[Points, Triangles]:
    """Triangles whose corners are numbers, and not so large that their cubes are none."""
    reach = np.abs(vertices).max(initial=0.0)
    if np.isfinite(reach):
        if reach > FARTHEST_CORNER:
            raise MeshError(where, f"reaches {reach:.3g} {unit} from the origin", "check its scale")
        return vertices, faces
    bad = np.logical_not(np.isfinite(vertices).all(axis=1))
    hit = bad[faces].any(axis=1)
    if hit.any():
        what = f"facet {np.argmax(hit) + 1} of {len(faces)} has a corner that is not a finite number"
        raise MeshError(where, what, "export the part again")
    return _drop_infinite(*topology.drop_unused_corners(vertices, faces), where, unit)


def _enclose_open(
    vertices: Points, faces: Triangles, edges: MeshEdges, size: float, where: str, unit: str, allow_open: bool
) -> Enclosed:
    """Return what an open surface encloses, holes filled in; none of its facets is known to cut others."""
    open_edges = int(np.abs(edges.net).sum())
    if open_edges > MAX_OPEN_EDGES:
        raise MeshError(where, f"the surface is open: {open_edges} edges without a neighbour", EXPORT_SOLID)
    rims, across, middle = mending.find_holes(vertices, edges)
    cracks, rim_edges, width, place = mending.measure_gaps(vertices, edges, size)
    holes = counted(len(rims), "hole")
    if not allow_open:
        what = f"the surface is open: {counted(open_edges, 'edge')} without a neighbour"
        crack = f"cracks up to {width:.2g} {unit} wide, the widest at ({_place(place)})"
        if not rim_edges:
            limits = f"up to {mending.JOIN_SHARE * size:.2g} {unit} they are joined where no wall is as thin"
            wider = f"{mending.OPEN_JOIN_SHARE * size:.2g} {unit}"
            mend = f"{SEW_IN_CAD}, or pass `allow_open` to join up to {wider}"
            raise MeshError(where, f"{what} along {crack}; {limits}", mend)
        if cracks:
            what = f"{what}, {cracks} of them along {crack}, the others round holes"
            raise MeshError(where, what, CLOSE_IN_CAD)
        widest = f"{across:.3g} {unit} across at ({_place(middle)})"
        raise MeshError(where, f"{what} round {holes}, the widest {widest}", CLOSE_IN_CAD)
    warnings = (f"the surface is open: {holes} filled in for these numbers (`allow_open`)",)
    capped = np.concatenate([vertices[faces], mending.cap_holes(vertices, rims)])
    filled, facets = _weld_triangles(capped)
    if not len(facets):
        raise MeshError(where, "encloses no volume", EXPORT_SOLID)
    closed = topology.edge_table(facets, len(filled))
    if cracks and mending.folded_share(filled, facets, closed) > LOOSE_SHARE:
        what = (
            f"its facets hang loose: {cracks} open edges run along cracks up to {width:.2g} {unit} "
            "wide, which cannot be joined without loss of what is as thin"
        )
        raise MeshError(where, what, SEW_IN_CAD)
    several, unseen = _as_bodies(filled, facets, closed, where, unit, allow_open), np.empty(0, dtype=int)
    if several is None:
        return vertices, faces, mass.integrate_solid(capped), True, warnings, unseen
    vertices, faces, more = several
    return vertices, faces, mass.integrate_solid(vertices[faces]), True, (*warnings, *more), unseen


def _enclose_closed(
    vertices: Points, faces: Triangles, edges: MeshEdges, size: float, where: str, unit: str, allow_open: bool
) -> Enclosed:
    """A closed surface and what it encloses, cavities taken off; and which of its facets may cut others.

    A surface that an axis sees whole is one shell.
    """
    solid = mass.integrate_solid(vertices[faces])
    outwards = (faces[:, ::-1], solid.inside_out) if solid.volume < 0.0 else (faces, solid)
    unseen = unseen_facets(vertices, *outwards)
    several = _as_bodies(vertices, faces, edges, where, unit, allow_open) if len(unseen) else None
    if several is None:
        return vertices, faces, solid, False, (), unseen
    vertices, faces, warnings = several
    return vertices, faces, mass.integrate_solid(vertices[faces]), True, warnings, np.arange(len(faces))


def _as_bodies(
    vertices: Points, faces: Triangles, edges: MeshEdges, where: str, unit: str, allow_open: bool
) -> tuple[Points, Triangles, tuple[str, ...]] | None:
    """Several closed surfaces as bodies taken together; None where they are one body and its cavities."""
    number, shell = topology.split_shells(edges, faces)
    if number == 1:
        return None
    volume = np.bincount(shell, mass.tetrahedron_volumes(vertices[faces])).astype(float)
    empty = np.abs(volume) <= EMPTY_VOLUME_SHARE * np.abs(volume).max()
    if empty.any():  # a loose facet and its own cap
        shell = np.where(empty, -1, np.cumsum(~empty) - 1)[shell]
        faces, shell, volume = faces[shell >= 0], shell[shell >= 0], volume[~empty]
    if len(volume) < 2:
        return None
    outwards = np.sign(volume[np.argmax(np.abs(volume))])
    fault = topology.shell_fault(vertices, faces[:, :: int(outwards) or 1], shell, outwards * volume, unit)
    if fault is None:
        return None
    if not allow_open:
        several = fault[1] in (topology.SAVE_SHELLS, topology.REVERSE_INNER)
        raise (SeveralBodiesError if several else MeshError)(where, *fault)
    return take_together(vertices, faces, shell, volume, where, unit)


def _place(point: Vector) -> str:
    return ", ".join(f"{x:.4g}" for x in point + 0.0)


AXIS_END_SHARE = 0.25  # [1] of the part's reach across its axis: how far the axis ends before the part does
FACING_AWAY_SINE = 1e-12  # [1] beyond it rounding does not decide whether a facet faces away from a point
EQUAL_FEET_SHARE = 1e-9  # [1] of the axis: feet closer than that may be one
NARROW_STRETCH_SHARE = 1e-2  # [1] of the axis: shorter stretches are not looked at


def unseen_facets(vertices: Points, faces: Triangles, solid: mass.Solid) -> Ints:
    """Return the facets of a closed surface among which are all that cut each other.

    The axis is a segment of the line about which the part is most slender. Every point off it has a foot, the
    nearest point of the segment, and the rays from each foot through the points that have it fill space once.
    Of the facets that a ray meets, those that face away from its foot less those that face it are as many as
    the turns of the surface round the foot. Where all with a foot there face away and the surface goes round
    once, every ray meets one facet. Beside a line along which two facets cut each other it would meet both.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    solid : Solid
        Volume, centroid and inertia of what they enclose, in powers of that unit.

    Returns
    -------
    (N,) int
        Empty for a surface that the axis sees whole. Facets for which rounding might decide are among them.
    """
    along, across = vectors.eigen(solid.inertia)[1].T[:2]
    axes = np.array([along, across, vectors.cross(along, across)])
    places = np.einsum("ij,vj->iv", axes, vertices - solid.centre)
    short = AXIS_END_SHARE * np.sqrt((places[1] ** 2 + places[2] ** 2).max())
    low, high = min(places[0].min() + short, 0.0), max(places[0].max() - short, 0.0)
    # first and last foot of each facet, and whether it faces away from all of its feet
    a, b, c = places[:, faces.T].swapaxes(0, 1)
    u, v = b - a, c - a
    normal = vectors.cross_columns(u, v)
    i, j, k = np.clip(places[0], low, high)[faces.T]
    first, last = np.minimum(np.minimum(i, j), k), np.maximum(np.maximum(i, j), k)
    offset = vectors.dot_columns(normal, a)
    lengths = np.sqrt(vectors.dot_columns(u, u) * vectors.dot_columns(v, v))
    sure = FACING_AWAY_SINE * np.abs(places).max() * lengths
    away = np.minimum(offset - normal[0] * first, offset - normal[0] * last) > sure
    # stretches of the axis outside the feet of all facets that do not
    near = EQUAL_FEET_SHARE * (high - low)
    begin, stop = first[~away] - near, last[~away] + near
    order = np.argsort(begin)
    starts = np.append(-np.inf, np.maximum.accumulate(stop[order]))
    ends = np.append(begin[order], np.inf)
    wide = np.minimum(ends, high) - np.maximum(starts, low) >= NARROW_STRETCH_SHARE * (high - low)
    alone = np.zeros(len(faces), dtype=bool)
    for start, end in zip(starts[wide], ends[wide]):
        # whether the section of the surface across the axis at a foot goes round it once
        foot = 0.5 * (max(start, low) + min(end, high))
        above = places[0] > foot
        a, b, c = above[faces.T]
        through = faces[(a != b) | (b != c)]
        up, n, points = above[through], np.arange(len(through)), []
        onward = np.roll(up, -1, axis=1)
        for side in ((~up & onward).argmax(axis=1), (up & ~onward).argmax(axis=1)):
            # where that side of each facet passes through the plane
            tail, head = places[:, through[n, side]], places[:, through[n, (side + 1) % 3]]
            share = (foot - tail[0]) / (head[0] - tail[0])
            points.append(tail[1:] + share * (head[1:] - tail[1:]))
        (x, y), (z, w) = points
        if np.abs(np.arctan2(x * w - y * z, x * z + y * w).sum()) < 3.0 * np.pi:  # a whole number of 2 pi
            alone |= (first > start) & (last < end)
    return np.flatnonzero(~alone)


MAX_CROSSING_FACETS, MAX_BOX_PAIRS = 300_000, 20_000_000  # facets, and boxes that overlap: some seconds
PLANE_STEPS = 1e7  # steps of a unit in which planes are told apart
BOX_PAIRS_AT_ONCE = 4_000_000  # pairs of boxes at a time, at most: what a hundred MB hold


@dataclass(frozen=True, eq=False)
class Crossings:
    """Pairs of facets that cut each other."""

    pairs: Ints  # (N, 2) int
    depths: Floats  # (N,) [unit of the file] how far each goes through, the least of all directions
    points: Points  # (N, 3) [unit of the file] one point of each cut


NO_CROSSINGS = Crossings(np.empty((0, 2), dtype=int), np.empty(0), np.empty((0, 3)))


def find_crossings(vertices: Points, faces: Triangles, tolerance: float) -> Crossings:
    """Find the facets that cut others they share no side with, deeper than a tolerance.

    None are looked for in more than ``MAX_CROSSING_FACETS`` facets, nor after ``MAX_BOX_PAIRS`` pairs of
    boxes.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    tolerance : float [unit of the file]
        Corners this near to the plane of another facet lie on it; a cut must be longer, too.

    Returns
    -------
    Crossings

    References
    ----------
    T. Möller, "A fast triangle-triangle intersection test", J. Graphics Tools 2(2), 25-30, 1997.
    """
    corners = vertices[faces]
    # unit normals; zero for a facet without area
    a, b, c = np.moveaxis(corners, 1, 0)
    normals = vectors.cross(b - a, c - a)
    length = vectors.norm(normals)[:, None]
    normals = normals / np.where(length > 0.0, length, 1.0)
    # each has corners on both sides of the other, by half the tolerance; in columns, from one corner
    places = np.ascontiguousarray((corners - corners[0, 0]).transpose(1, 2, 0))
    columns = np.ascontiguousarray(normals.T)
    offsets = vectors.dot_columns(columns, places[0])
    near = [np.empty((0, 2), dtype=int)]
    for pairs in _candidates(corners, normals):
        for own, other in ((0, 1), (1, 0)):
            first, second = pairs[:, own], pairs[:, other]
            normal, offset = columns[:, second], offsets[second]
            a, b, c = (vectors.dot_columns(normal, corner[:, first]) - offset for corner in places)
            above, below = np.maximum(np.maximum(a, b), c), np.minimum(np.minimum(a, b), c)
            pairs = pairs[(above > 0.5 * tolerance) & (below < -0.5 * tolerance)]
        near.append(pairs)
    pairs = np.concatenate(near)
    if not len(pairs):
        return Crossings(pairs, np.empty(0), np.empty((0, 3)))
    # each passes through the plane of the other: none that share a side
    for own, other in ((0, 1), (1, 0)):
        through = _through(_sides(corners, normals, pairs[:, own], pairs[:, other], tolerance))
        pairs = pairs[through > 0.0]
    # along a line longer than the tolerance
    i, j = pairs.T
    along = vectors.cross(normals[i], normals[j])
    length = vectors.norm(along)
    along = along / np.where(length > 0.0, length, 1.0)[:, None]
    of_first, of_second = (_sides(corners, normals, *order, tolerance) for order in ((i, j), (j, i)))
    (a, b), (c, d) = _interval(corners[i], of_first, along), _interval(corners[j], of_second, along)
    start, end = np.maximum(a, c), np.minimum(b, d)
    depths = np.minimum(end - start, np.minimum(_through(of_first), _through(of_second)))
    cut = (end - start > tolerance) & (length > 0.0)
    # where cuts begin: on the line of the first facet's own crossing, at ``start`` along it
    onward, n = np.roll(of_first, -1, axis=1), np.arange(len(i))
    k = np.argmax(of_first * onward < 0.0, axis=1)
    first, second = of_first[n, k], onward[n, k]
    a, b = corners[i][n, k], corners[i][n, (k + 1) % 3]
    point = a + (first / np.where(first == second, 1.0, first - second))[:, None] * (b - a)
    point = point + (start - np.einsum("nx,nx->n", point, along))[:, None] * along
    return Crossings(pairs[cut], depths[cut], point[cut])


def _candidates(corners: Floats, normals: Floats) -> Iterator[Ints]:
    """(N, 2) pairs of facets whose boxes overlap, but for many of one plane, some at a time."""
    if len(corners) > MAX_CROSSING_FACETS:
        return
    a, b, c = corners.transpose(1, 0, 2)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    x, y, z = np.argsort(-np.ptp(low, axis=0), kind="stable")
    boxes = shapely.linestrings(np.stack([low[:, [x, y]], high[:, [x, y]]], axis=1))  # made sooner than boxes
    tree = shapely.STRtree(boxes)
    # the plane of each facet, those of one plane mostly the same: they do not cut each other
    offsets = np.einsum("fx,fx->f", normals, corners[:, 0]) / np.abs(corners).max()
    plane = topology.distinct_points(np.round(np.column_stack([normals, offsets]) * PLANE_STEPS))[1]
    floor, top = np.ascontiguousarray(low[:, z]), np.ascontiguousarray(high[:, z])
    box_pairs, step = 0, max(1, BOX_PAIRS_AT_ONCE // len(boxes))
    for start in range(0, len(boxes), step):
        i, j = tree.query(boxes[start : start + step])
        i, box_pairs = i + start, box_pairs + len(i)
        if box_pairs > MAX_BOX_PAIRS:
            return
        once = i < j
        i, j = i[once], j[once]
        overlaps = (plane[i] != plane[j]) & (floor[i] <= top[j]) & (floor[j] <= top[i])
        yield np.column_stack([i[overlaps], j[overlaps]])


def _sides(corners: Floats, normals: Floats, facets: Ints, planes: Ints, tolerance: float) -> Floats:
    """(N, 3) [unit of the file] how far corners of ``facets`` lie above ``planes``; 0 within tolerance."""
    above = np.einsum("nkx,nx->nk", corners[facets] - corners[planes, :1], normals[planes])
    return np.where(np.abs(above) <= tolerance, 0.0, above)


def _through(sides: Floats) -> Floats:
    """(N,) how far facets pass through planes: the less of both sides, 0 where they do not."""
    a, b, c = sides.T
    above, below = np.maximum(np.maximum(a, b), c), np.minimum(np.minimum(a, b), c)
    return np.minimum(above, -below).clip(0.0)


def _interval(corners: Floats, sides: Floats, along: Floats) -> tuple[Floats, Floats]:
    """Where facets meet planes they pass through: from and to, (N,) and (N,), along a direction."""
    t = np.einsum("nkx,nx->nk", corners, along)
    u, s = np.roll(t, -1, axis=1), np.roll(sides, -1, axis=1)
    across = sides * s < 0.0
    cut = np.where(across, t + (u - t) * sides / np.where(across, sides - s, 1.0), np.nan)
    crossings = np.concatenate([cut, np.where(sides == 0.0, t, np.nan)], axis=1)
    return np.fmin.reduce(crossings, axis=1), np.fmax.reduce(crossings, axis=1)
