"""Compiled contacts of edges with borders and what runs back from their corners, and of faces with these."""

import math

from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel import plate_views, supports
from feederscrew.trial.kernel.contact import GAP, KEY, KINDS, SPOT, TOWARDS, put
from feederscrew.trial.kernel.crowd_records import (
    BEFORE,
    CORNERS,
    DEPTH,
    EDGES,
    LAST,
    MOVED,
    NORMAL,
    ONWARDS,
    POSTS,
    ROUNDED,
    RUBS,
)
from feederscrew.trial.kernel.plate_views import DEEP, PARALLEL, SLANT, in_body, in_bowl, placed

LEVEL = 0.7  # [1] of a normal against a plate's front: one that lies flatter stops a part
SUNK = (
    0.01  # in units of the part's length: what is deeper in something as the lists are made is not followed
)
ON = 0.9  # [1] cosine between borders of which one goes on from the other nearly straight
ONE = 1e-2  # edges that touch so near to each other, with ...
ALIKE = 0.995  # [1] ... normals so alike, are one contact


@compiled
def first_of(crowd, n, k, which):
    """Return where the candidates of a plate begin in a list of a part's."""
    return crowd.ends[n, k - 1, which] if k else 0


@compiled
def _dip(surface, plate, crowd, k):
    """How deep corners of the part come beside a border or one that goes on from it nearly straight."""
    low, n = crowd.dips[k], surface.borders[k]
    if k + 1 < plate[LAST]:
        m = surface.borders[k + 1]
        if m[0] == n[2] and m[1] == n[3] and n[NORMAL] * m[NORMAL] + n[NORMAL + 1] * m[NORMAL + 1] > ON:
            low = min(low, crowd.dips[k + 1])
    return low


@compiled
def _between(solid, k, a, b, c):
    """Whether a normal in body axes lies between the faces of an edge of the part."""
    s = solid.sides[k]
    if a * s[0] + b * s[1] + c * s[2] < -SLANT:
        return False
    return a * s[3] + b * s[4] + c * s[5] >= -SLANT


@compiled
def _put_edge(crowd, n, solid, at, normal, gap, rub, key):
    """Add a contact of an edge unless one as good as the same is there; the deeper of the two is kept."""
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        if row[KEY] % KINDS < 3.0:
            continue
        x, y, z = row[SPOT] - at[0], row[SPOT + 1] - at[1], row[SPOT + 2] - at[2]
        if x * x + y * y + z * z > ONE * ONE:
            continue
        if row[TOWARDS] * normal[0] + row[TOWARDS + 1] * normal[1] + row[TOWARDS + 2] * normal[2] > ALIKE:
            if gap < row[GAP]:
                count, crowd.counts[n] = crowd.counts[n], m
                put(crowd, n, solid, at, normal, gap, rub, key)
                crowd.counts[n] = count
            return
    put(crowd, n, solid, at, normal, gap, rub, key)


@compiled
def edges_on(surface, solid, crowd, n, k, reach, lying):
    """Add contacts of edges with a plate's borders within ``reach`` [L]; return how many carry it."""
    far = crowd.made[n, MOVED] + reach + SUNK
    for m in range(first_of(crowd, n, k, EDGES), crowd.ends[n, k, EDGES]):
        if crowd.edge_gaps[n, m] <= far:
            lying = _edge_on(surface, solid, crowd, n, k, (m, reach), lying)
    return lying


@compiled
def _edge_on(surface, solid, crowd, n, k, which, lying):
    """Add the contact of one edge with a border; as ``edges_on``."""
    plate, frame, (m, reach) = surface.plates[k], crowd.frame, which
    edge, border = crowd.edges[n, m, 0], surface.borders[crowd.edges[n, m, 1]]
    back = crowd.edges[n, m, 2] > 0
    i, j = solid.corners[solid.edges[edge, 0]], solid.corners[solid.edges[edge, 1]]
    ends = (-solid.onwards[edge, 0], 1.0 + solid.onwards[edge, 1])
    c = frame[6] * i[0] + frame[7] * i[1] + frame[8] * i[2] + frame[11]
    f = frame[6] * j[0] + frame[7] * j[1] + frame[8] * j[2] + frame[11]
    if back:
        c, f = -plate[DEPTH] - c, -plate[DEPTH] - f
    if min(c + ends[0] * (f - c), c + ends[1] * (f - c)) > reach:  # as high as that no border is
        return lying
    a, b, _ = placed(frame, i)
    d, e, _ = placed(frame, j)
    share, u, v, w, gap = crossing((a, b, c), (d - a, e - b, f - c), ends, border, reach)
    if gap == math.inf or (
        w < LEVEL and min(c, f, _dip(surface, plate, crowd, crowd.edges[n, m, 1])) > -plate[ROUNDED]
    ):
        return lying
    if back:
        w = -w
    x, y, z = in_body(frame, u, v, w)
    if not _between(solid, edge, x, y, z):
        return lying
    at = _along(i, j, share)
    key = 3.0 + back + KINDS * (edge + 1e6 * crowd.edges[n, m, 1])
    if w > supports.LEVEL:
        place = a + share * (d - a), b + share * (e - b)
        return supports.add(crowd.levels, lying, place, gap, at, key)
    _put_edge(crowd, n, solid, at, in_bowl(plate, u, v, w), gap, plate[RUBS], key)
    return lying


@compiled
def _along(i, j, share):
    return i[0] + share * (j[0] - i[0]), i[1] + share * (j[1] - i[1]), i[2] + share * (j[2] - i[2])


@compiled
def crossing(p, along, ends, border, reach):
    """Where an edge from p touches a border, as the plate sees them; ``ends`` are its least and most share.

    Returns
    -------
    share of the edge, normal (3), gap; the gap is infinite where they do not touch
    """
    a, b, c = along
    least, most = ends
    u, v = border[2] - border[0], border[3] - border[1]
    nx, ny, nz = -c * v, c * u, a * v - b * u  # edge x border
    square = nx * nx + ny * ny + nz * nz
    if square <= PARALLEL * PARALLEL * (a * a + b * b + c * c) * (u * u + v * v):
        return 0.0, 0.0, 0.0, 0.0, math.inf
    flat = nx * border[NORMAL] + ny * border[NORMAL + 1]
    size = math.sqrt(square)
    if nz + flat < 0.0:
        size = -size
    x, y, z = p[0] - border[0], p[1] - border[1], p[2]
    nx, ny, nz = nx / size, ny / size, nz / size
    gap = nx * x + ny * y + nz * z
    if gap > reach or gap < -DEEP or nz < -SLANT or flat / size < -SLANT:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    x, y, z = x - gap * nx, y - gap * ny, z - gap * nz
    # in the plane of both: share of the edge where it meets the border's line, then of the border
    mx, my, mz = -v * nz, u * nz, v * nx - u * ny  # normal x border
    share = -(x * mx + y * my + z * mz) / (a * mx + b * my + c * mz)
    place = ((x + share * a) * u + (y + share * b) * v) / (u * u + v * v)
    if not (least <= share <= most and -border[ONWARDS] <= place <= 1.0 + border[ONWARDS + 1]):
        return 0.0, 0.0, 0.0, 0.0, math.inf
    return share, nx, ny, nz, gap


@compiled
def edges_on_posts(surface, solid, crowd, n, k, reach):
    """Add contacts of edges within ``reach`` [L] of what runs back from convex corners of borders."""
    plate, frame = surface.plates[k], crowd.frame
    for m in range(first_of(crowd, n, k, POSTS), crowd.ends[n, k, POSTS]):
        edge, border = crowd.posts[n, m, 0], surface.borders[crowd.posts[n, m, 1]]
        i, j = solid.corners[solid.edges[edge, 0]], solid.corners[solid.edges[edge, 1]]
        a, b, c = placed(frame, i)
        d, e, f = placed(frame, j)
        ends = (-solid.onwards[edge, 0], 1.0 + solid.onwards[edge, 1])
        share, u, v, gap = post((a, b, c), (d - a, e - b, f - c), ends, border, reach)
        height = c + share * (f - c)
        if gap == math.inf or not -plate[DEPTH] < height < 0.0:
            continue
        low = min(height, _dip(surface, plate, crowd, crowd.posts[n, m, 1]))
        if low > -plate[ROUNDED] or gap < low:  # it is nearer to the surface
            continue
        x, y, z = in_body(frame, u, v, 0.0)
        if _between(solid, edge, x, y, z):
            at = _along(i, j, share)
            key = 5.0 + KINDS * (edge + 1e6 * crowd.posts[n, m, 1])
            _put_edge(crowd, n, solid, at, in_bowl(plate, u, v, 0.0), gap, plate[RUBS], key)


@compiled
def post(p, along, ends, border, reach):
    """Where an edge from p touches the line straight back from the start of a border; as ``crossing``.

    Returns
    -------
    share of the edge, normal (2) along the plate, gap; the gap is infinite where they do not touch
    """
    a, b, c = along
    square = a * a + b * b
    if square <= PARALLEL * PARALLEL * (square + c * c):
        return 0.0, 0.0, 0.0, math.inf
    x, y = border[0] - p[0], border[1] - p[1]
    share, size = (x * a + y * b) / square, math.sqrt(square)
    u, v = b / size, -a / size
    if u * (border[NORMAL] + border[BEFORE]) + v * (border[NORMAL + 1] + border[BEFORE + 1]) < 0.0:
        u, v = -u, -v
    gap = -(u * x + v * y)
    if not (ends[0] <= share <= ends[1] and -DEEP <= gap <= reach) or not _before_corner(border, u, v):
        return 0.0, 0.0, 0.0, math.inf
    return share, u, v, gap


@compiled
def _before_corner(border, u, v):
    """Whether the solid beside a border's start lies behind a normal along the plate."""
    along = -u * border[NORMAL + 1] + v * border[NORMAL]
    back = u * border[BEFORE + 1] - v * border[BEFORE]
    return along <= SLANT and back <= SLANT


@compiled
def faces_on(surface, solid, crowd, n, k, reach, lying):
    """Add contacts of faces within ``reach`` [L] of the convex corners of borders; as ``edges_on``."""
    plate, frame = surface.plates[k], crowd.frame
    m, last = first_of(crowd, n, k, CORNERS), crowd.ends[n, k, CORNERS]
    while m < last:
        k_border, back = crowd.corners[n, m, 0], crowd.corners[n, m, 1]
        border = surface.borders[k_border]
        level = -plate[DEPTH] if back else 0.0
        x, y, z = in_body(frame, border[0] - frame[9], border[1] - frame[10], level - frame[11])
        best, face = math.inf, -1
        while m < last and crowd.corners[n, m, 0] == k_border and crowd.corners[n, m, 1] == back:
            f = crowd.corners[n, m, 2]
            t, v = solid.normals[f], solid.vertices[solid.triangles[f, 0]]
            off = (x - v[0]) * t[0] + (y - v[1]) * t[1] + (z - v[2]) * t[2]
            nearer = (
                -DEEP < off < reach and abs(off) < abs(best) and plate_views.within(solid, f, x, y, z, 0.0)
            )
            if nearer and _points_to(surface, solid, crowd, plate, (k_border, back, f)):
                best, face = off, f
            m += 1
        if face >= 0:
            what = (k_border, back, face, x, y, z, best)
            lying = _put_face(surface, solid, crowd, n, k, what, lying)
    return lying


@compiled
def _seen_against(frame, t):
    """The normal of a face of the part as a plate sees it, away from the plate."""
    return (
        -(frame[0] * t[0] + frame[1] * t[1] + frame[2] * t[2]),
        -(frame[3] * t[0] + frame[4] * t[1] + frame[5] * t[2]),
        -(frame[6] * t[0] + frame[7] * t[1] + frame[8] * t[2]),
    )


@compiled
def _points_to(surface, solid, crowd, plate, which):
    """Whether a border's corner points to a face of the part: which border, front or back, which face."""
    (k_border, back, face), frame = which, crowd.frame
    u, v, w = _seen_against(frame, solid.normals[face])
    out = -w if back else w
    if out < -SLANT or not _before_corner(surface.borders[k_border], u, v):
        return False
    if out < LEVEL:
        low = _dip(surface, plate, crowd, k_border)
        for e in range(3):
            p = solid.vertices[solid.triangles[face, e]]
            c = frame[6] * p[0] + frame[7] * p[1] + frame[8] * p[2] + frame[11]
            low = min(low, -plate[DEPTH] - c if back else c)
        return low <= -plate[ROUNDED]
    return True


@compiled
def _put_face(surface, solid, crowd, n, k, what, lying):
    """Add the contact of a face of the part with a corner; as ``edges_on``."""
    plate = surface.plates[k]
    k_border, back, face, x, y, z, gap = what
    u, v, w = _seen_against(crowd.frame, solid.normals[face])
    key = 6.0 + back + KINDS * (face + 1e6 * k_border)
    if w > supports.LEVEL:
        border = surface.borders[k_border]
        return supports.add(crowd.levels, lying, (border[0], border[1]), gap, (x, y, z), key)
    put(crowd, n, solid, (x, y, z), in_bowl(plate, u, v, w), gap, plate[RUBS], key)
    return lying
