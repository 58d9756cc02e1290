"""Compiled contacts of a part with what stands along the track and with the wall, among what is near it.

Of a plate there can touch: a corner or a circle of the part its surface, a corner its back or a side; an edge
of the part a border, in front or at the back, or what runs straight back from a border's convex corner; such
a corner a face of the part. Each is a contact where it is a least distance of both: the normal lies between
the faces of either.

What lies on a surface by many corners, circles, edges and faces is carried as well by a few of them:
`keep_outermost` chooses those.
"""

import math

from feederscrew.arrivals.kernel.body import X, Y, Z
from feederscrew.base.arrays import Floats, Row, Rows, Triple
from feederscrew.base.geometry.compiled import compiled, outlined
from feederscrew.trials.kernel.contact import KEYS_PER_SPOT, add_contact
from feederscrew.trials.kernel.neighbours import lists_hold, rebuild_lists
from feederscrew.trials.kernel.plate_views import (
    BLOCK,
    CROSSING_SINE,
    MAX_DEPTH,
    NORMAL_SLACK,
    axis_of,
    bowl_vector,
    circle_height,
    circle_to_wall,
    crosses,
    distance_to_border,
    distance_to_wall,
    dot,
    extent_of,
    height_of,
    height_over_face,
    is_over_face,
    place_of,
    point_along,
    rotate,
    rotate_back,
    subtract,
    view_of,
    wall_of,
)
from feederscrew.trials.kernel.workspace import Surface, TrueSolid, Vec3, Workspace

SHALLOW = 1e-3  # a contact less deep is not looked at again
PLACE_ROUNDING = 1e-9  # more than rounding moves a point
SHADOW_DEPTHS = 4.0  # times its depth: a deeper contact is none where so near to it another is shallower
UPRIGHT_WALL = 1e-9  # [1] a wall that leans by more from the bowl's axis is the other face of a groove

WAYS = 6  # directions in which supports are kept
FALL = 100.0  # a lower support counts so much more than one further out
HALF_TURN = tuple(2.0 * math.pi * m / WAYS for m in range(WAYS // 2))
COSINES = (*map(math.cos, HALF_TURN), *(-math.cos(angle) for angle in HALF_TURN), 0.0)  # of none at last
SINES = (*map(math.sin, HALF_TURN), *(-math.sin(angle) for angle in HALF_TURN), 0.0)
SUPPORT_SPACING = 0.02  # so near to each other two supports are one: it is the lower
LEVEL_NORMAL = 1.0 - 1e-5  # [1] against a surface's normal: less than it looks around parts tilt so

TILTED_CIRCLE = 0.25  # [1] sine of the tilt from which on it touches at its lowest point only
FLAT_CIRCLE = 1e-6  # [1] a circle that is not tilted by more has no lowest point
CIRCLE_KEYS = 5e5  # contacts of circles are counted from here, those of corners from 0
PLATE_KEYS = 1e6  # and of each plate, or border, from so much more

STEEP_EDGE_NORMAL = 0.7  # [1] against a plate's front: one that lies flatter stops a part
LIST_DEPTH = 0.01  # in units of the part's length: what is deeper in something as the lists are made is left
STRAIGHT_BORDERS = 0.9  # [1] cosine between borders of which one goes on from the other nearly straight
# edges that touch so near, with normals so alike, are one contact
EDGE_SPACING = 1e-2
SAME_NORMAL = 0.995


@outlined
def find_contacts(surface: Surface, solid: TrueSolid, work: Workspace, n: int, reach: float) -> None:
    """Find every contact of part n within ``reach`` [L]; its turn and tangent are of its place."""
    if not lists_hold(surface, solid, work, n, reach):
        rebuild_lists(surface, solid, work, n, reach)
    work.counts[n] = 0
    if work.list_states[n].wall_corners or work.list_states[n].wall_circles:
        _add_wall(surface, solid, work, n, reach)
    for k in range(len(surface.plates)):
        first, last = work.ends[n, k], work.ends[n, k + 1]
        near = first.corners < last.corners or first.edges < last.edges or first.posts < last.posts
        if not (near or first.circles < last.circles or first.faces < last.faces):
            continue
        view_of(surface.plates[k], work.states[n], work.turns[n], work.frame)
        begun = work.counts[n]
        _measure_dips(solid, work, n, k)
        count = _add_corners(surface, solid, work, n, k, reach)
        count = _add_circles(surface, solid, work, n, k, reach, count)
        count = _add_edges(surface, solid, work, n, k, reach, count)
        _add_posts(surface, solid, work, n, k, reach)
        count = _add_faces(surface, solid, work, n, k, reach, count)
        plate = surface.plates[k]
        normal = bowl_vector(plate, 0.0, 0.0, 1.0)
        for m in range(keep_outermost(work.supports, work.best, count)):
            support = work.supports[m]
            spot = support.spot_x, support.spot_y, support.spot_z
            add_contact(work, n, solid, spot, normal, support.gap, plate.friction, support.key)
        _drop_shadowed(work, n, begun)
    start = 0  # they begin with the impulses that they had a step before
    for m in range(work.counts[n]):
        row = work.contacts[n, m]
        row.along_impulse = row.aside_impulse = row.normal_impulse = 0.0
        for k in range(start, work.last_counts[n]):  # they come in nearly the same order
            before = work.last_impulses[n, k]
            if before.key == row.key:
                row.along_impulse, row.aside_impulse = before.along, before.aside
                row.normal_impulse = before.normal
                start = k + 1
                break


@compiled
def wall_friction(surface: Surface, leans: Floats) -> float:
    """Return the friction [1] of the wall; NaN, that of the track, where it is the other face of a groove."""
    (lean, up), (inwards, rise) = wall_of(leans), axis_of(leans)
    leaning = lean * rise - up * inwards
    return math.nan if math.fabs(leaning) > UPRIGHT_WALL else surface.friction[4]


@compiled
def _add_wall(surface: Surface, solid: TrueSolid, work: Workspace, n: int, reach: float) -> None:
    """Add contacts with the wall, a cone in the track's frame where that is banked."""
    state, turn, leans, lists, count = work.states[n], work.turns[n], work.leans[n], work.list_states[n], 0
    (lean, up), radius = wall_of(leans), surface.radius
    friction = wall_friction(surface, leans)
    far = lists.shift + reach
    for m in range(lists.wall_corners):
        near = work.wall_corners[n, m]
        if near.gap > far:
            continue
        p = solid.corners[near.corner]
        x, y, z = rotate(turn, p)
        gap = distance_to_wall(surface, leans, state[X] + x, state[Y] + y, state[Z] + z)
        if gap < reach:
            place = work.tangents[n, 0] * x + work.tangents[n, 1] * y, z
            count = add_support(work.supports, count, place, gap, p, -KEYS_PER_SPOT * (1 + near.corner))
    for m in range(lists.wall_circles):
        k = work.wall_circles[n, m]
        circle = solid.circles[k]
        gap, tilt = circle_to_wall(surface, state, turn, leans, circle)
        if gap > reach:
            continue
        for e in range(WAYS if tilt > TILTED_CIRCLE else 0, WAYS + 1 if tilt > FLAT_CIRCLE else WAYS):
            # its point furthest towards the wall, and ahead or up as well, in body axes
            s, t, p = work.tangents[n, 0], work.tangents[n, 1], (circle.x, circle.y, circle.z)
            for _ in range(2):  # the wall is curved: once more from where that is
                x, y, z = rotate(turn, p)
                x, y = x + state[X], y + state[Y] - radius
                size = FALL * up / math.sqrt(x * x + y * y)
                p = x * size + COSINES[e] * s, y * size + COSINES[e] * t, FALL * lean + SINES[e]
                p = _furthest_point(circle, rotate_back(turn, p))
            x, y, z = rotate(turn, p)
            gap = distance_to_wall(surface, leans, state[X] + x, state[Y] + y, state[Z] + z)
            if gap < reach:
                place = work.tangents[n, 0] * x + work.tangents[n, 1] * y, z
                key = -KEYS_PER_SPOT * (1 + CIRCLE_KEYS + 8 * k + e)
                count = add_support(work.supports, count, place, gap, p, key)
    for m in range(keep_outermost(work.supports, work.best, count)):
        row = work.supports[m]
        p = row.spot_x, row.spot_y, row.spot_z
        x = state[X] + turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
        y = state[Y] + turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2] - radius
        off = math.sqrt(x * x + y * y)
        add_contact(work, n, solid, p, (-up * x / off, -up * y / off, -lean), row.gap, friction, row.key)


@compiled
def add_support(
    supports: Rows, count: int, place: tuple[float, float], gap: float, spot: Vec3, key: float
) -> int:
    """Note a contact at a place (2,) [L] along the surface, a spot (3,) [L] in body axes; return how many."""
    if count == len(supports):
        return count
    row = supports[count]
    row.place_x, row.place_y, row.gap, row.key = place[0], place[1], gap, key
    row.spot_x, row.spot_y, row.spot_z = spot[0], spot[1], spot[2]
    return count + 1


@outlined
def keep_outermost(supports: Rows, best: Floats, count: int) -> int:
    """Move the lowest supports and those furthest out to the front; how many.

    ``best`` (WAYS + 1, 2), a score and which support, is worked in.
    """
    chosen = count
    if count <= WAYS + 1:
        for m in range(count):
            best[m, 1] = m
    else:
        for m in range(WAYS + 1):
            best[m, 0] = -math.inf
        for n in range(count):
            x, y, fall = supports[n].place_x, supports[n].place_y, FALL * supports[n].gap
            for m in range(WAYS + 1):
                score = COSINES[m] * x + SINES[m] * y - fall
                if score > best[m, 0]:
                    best[m, 0], best[m, 1] = score, n
        chosen = 0
        for m in range(WAYS + 1):  # each once
            first, new = int(best[m, 1]), True
            for e in range(m):
                new = new and int(best[e, 1]) != first
            if new:
                best[chosen, 1] = first
                chosen += 1
    count = 0
    for m in range(chosen):  # what is as near as SUPPORT_SPACING to a lower one is left out
        row, lowest = supports[int(best[m, 1])], True
        for e in range(chosen):
            other = supports[int(best[e, 1])]
            x, y = row.place_x - other.place_x, row.place_y - other.place_y
            if x * x + y * y < SUPPORT_SPACING * SUPPORT_SPACING and e != m:
                lowest = lowest and (row.gap < other.gap or (row.gap == other.gap and m < e))
        if lowest:
            best[WAYS - count, 0] = best[m, 1]
            count += 1
    for m in range(count):
        best[m, 1] = best[WAYS - m, 0]
    for m in range(count):  # the smallest first: none is moved before its turn
        least = m
        for e in range(m + 1, count):
            if best[e, 1] < best[least, 1]:
                least = e
        best[m, 1], best[least, 1] = best[least, 1], best[m, 1]
        supports[m] = supports[int(best[m, 1])]
    return count


@compiled
def _is_foremost(solid: TrueSolid, k: int, direction: Vec3) -> bool:
    """Tell whether a corner is the part's foremost against a direction, as far as its neighbours tell."""
    for n in range(solid.firsts[k], solid.firsts[k + 1]):
        away = subtract(solid.corners[solid.neighbours[n]], solid.corners[k])
        ahead = dot(direction, away)
        if ahead < 0.0 and ahead * ahead > NORMAL_SLACK * NORMAL_SLACK * dot(away, away):
            return False
    return True


@compiled
def _measure_dips(solid: TrueSolid, work: Workspace, n: int, k: int) -> None:
    """Write how deep corners of the part come beside each border near them."""
    first, last = work.ends[n, k].corners, work.ends[n, k + 1].corners
    if first == last:
        return
    first_side, last_side = work.near_corners[n, first].first_side, work.near_corners[n, last - 1].last_side
    if first_side == last_side:
        return
    for e in range(first_side, last_side):
        work.dips[work.sides[n, e]] = 0.0
    for g in range(first // BLOCK, (last + BLOCK - 1) // BLOCK):
        if extent_of(work.frame, work.groups[n, g], 2)[0] > PLACE_ROUNDING:
            continue
        for m in range(max(first, BLOCK * g), min(last, BLOCK * (g + 1))):
            near = work.near_corners[n, m]
            height = height_of(work.frame, solid.corners[near.corner])
            for e in range(near.first_side, near.last_side):
                side = work.sides[n, e]
                work.dips[side] = min(work.dips[side], height)


@compiled
def _add_corners(surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, reach: float) -> int:
    """Add contacts of the part's corners with a plate's sides and back; how many lie on its surface."""
    plate, frame, count, far = surface.plates[k], work.frame, 0, work.list_states[n].shift + reach
    first, last = work.ends[n, k].corners, work.ends[n, k + 1].corners
    for g in range(first // BLOCK, (last + BLOCK - 1) // BLOCK):
        if extent_of(frame, work.groups[n, g], 2)[0] > reach + PLACE_ROUNDING:
            continue
        for m in range(max(first, BLOCK * g), min(last, BLOCK * (g + 1))):
            near = work.near_corners[n, m]
            p = solid.corners[near.corner]
            c = height_of(frame, p)
            if near.off > far or c > reach or c < -plate.depth - reach:
                continue
            a, b, c = place_of(frame, p)
            counts = not solid.on_circle[near.corner]  # else its circle touches, unless a border is near
            key = KEYS_PER_SPOT * (near.corner + PLATE_KEYS * k)
            if near.first_side == near.last_side:
                on_top = c > -MAX_DEPTH
                down = -frame[6], -frame[7], -frame[8]
                if plate.depth + c < MAX_DEPTH and _is_foremost(solid, near.corner, down):
                    normal, spot = bowl_vector(plate, 0.0, 0.0, -1.0), (p[0], p[1], p[2])
                    add_contact(work, n, solid, spot, normal, -plate.depth - c, plate.friction, 1.0 + key)
            else:
                on_top = _add_corner_by_borders(surface, solid, work, n, k, near, reach, (a, b, c))
                counts = True
            if on_top and counts:
                count = add_support(work.supports, count, (a, b), c, p, key)
    return count


@compiled
def _add_corner_by_borders(
    surface: Surface,
    solid: TrueSolid,
    work: Workspace,
    n: int,
    k: int,
    near: Row,
    reach: float,
    place: Triple,
) -> bool:
    """Add the contact of a corner near borders with a side or the back; whether it touches the surface."""
    plate, frame, corner, (a, b, c) = surface.plates[k], work.frame, near.corner, place
    depth, off, side = plate.depth, math.inf, 0
    for e in range(near.first_side, near.last_side):
        far = distance_to_border(surface.borders[work.sides[n, e]], a, b)
        if abs(far) < abs(off):
            off, side = far, work.sides[n, e]
    catches = min(c, work.dips[side]) < -plate.rounding and -depth < c < 0.0
    if off > 0.0 and (off > reach or not catches):
        return False
    on_top, best, kind = False, MAX_DEPTH, 0.0
    u = v = w = 0.0
    if off <= 0.0 and c > -best and _is_foremost(solid, corner, (frame[6], frame[7], frame[8])):
        on_top, best = True, -c
    if off <= 0.0 and depth + c < best and _is_foremost(solid, corner, (-frame[6], -frame[7], -frame[8])):
        best, on_top, kind = depth + c, False, 1.0
        u, v, w = 0.0, 0.0, -1.0
    if -off < best and catches:
        border = surface.borders[side]
        if _is_foremost(solid, corner, rotate_back(frame, (border.normal_x, border.normal_y, 0.0))):
            best, on_top, kind = -off, False, 2.0
            u, v, w = border.normal_x, border.normal_y, 0.0
    if kind > 0.0:
        p, normal = solid.corners[corner], bowl_vector(plate, u, v, w)
        key = kind + KEYS_PER_SPOT * (corner + PLATE_KEYS * k)
        add_contact(work, n, solid, (p[0], p[1], p[2]), normal, -best, plate.friction, key)
    return on_top


@compiled
def _drop_shadowed(work: Workspace, n: int, first: int) -> None:
    """Leave out contacts with a plate that are deeper than others near them: those are what is to be left."""
    count = first
    for m in range(first, work.counts[n]):
        row, shadowed = work.contacts[n, m], False
        if row.gap < -SHALLOW:
            for e in range(first, work.counts[n]):
                other = work.contacts[n, e]
                if 0.5 * row.gap < other.gap < SHALLOW and e != m:
                    x, y = row.spot_x - other.spot_x, row.spot_y - other.spot_y
                    z = row.spot_z - other.spot_z
                    shadowed = shadowed or x * x + y * y + z * z < (SHADOW_DEPTHS * row.gap) ** 2
        if not shadowed:
            work.indices[count - first] = m
            count += 1
    if count < work.counts[n]:
        for m in range(first, count):
            work.contacts[n, m] = work.contacts[n, work.indices[m - first]]
        work.counts[n] = count


@compiled
def _furthest_point(circle: Row, direction: Triple) -> Triple:
    """The furthest point of a circle in a direction, all in body axes."""
    a, b, c = direction
    along = a * circle.axis_x + b * circle.axis_y + c * circle.axis_z
    a, b, c = a - along * circle.axis_x, b - along * circle.axis_y, c - along * circle.axis_z
    size = circle.radius / math.sqrt(a * a + b * b + c * c)
    return circle.x + a * size, circle.y + b * size, circle.z + c * size


@outlined
def _add_circles(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, reach: float, count: int
) -> int:
    """Add what of circles lies within ``reach`` [L] on a plate's surface; return how many carry it.

    Of a circle touch the lowest point and, where it lies nearly flat, those furthest out, as
    ``keep_outermost`` chooses among corners.
    """
    frame = work.frame
    for m in range(work.ends[n, k].circles, work.ends[n, k + 1].circles):
        near = work.near_circles[n, m]
        circle = solid.circles[near.circle]
        low, tilt = circle_height(frame, circle)
        if low > reach:
            continue
        for e in range(WAYS if tilt > TILTED_CIRCLE else 0, WAYS + 1 if tilt > FLAT_CIRCLE else WAYS):
            p = _furthest_point(circle, rotate_back(frame, (COSINES[e], SINES[e], -FALL)))
            a, b, c = place_of(frame, p)
            if -MAX_DEPTH < c < reach and (near.clear or _is_on_top(surface, work, n, k, (a, b, c))):
                key = KEYS_PER_SPOT * (CIRCLE_KEYS + 8 * near.circle + e + PLATE_KEYS * k)
                count = add_support(work.supports, count, (a, b), c, p, key)
    return count


@compiled
def _is_on_top(surface: Surface, work: Workspace, n: int, k: int, place: Triple) -> bool:
    """Tell whether a point lies on a plate's surface: over what is solid, and not at a side."""
    plate, (a, b, c), odd = surface.plates[k], place, False
    for e in range(work.ends[n, k].rounds, work.ends[n, k + 1].rounds):
        odd = odd != crosses(surface.borders[work.rounds[n, e]], a, b)
    if not odd:
        return False
    if c > -plate.rounding:
        return True
    for e in range(plate.begin, plate.end):
        if abs(distance_to_border(surface.borders[e], a, b)) < -c:
            return False
    return c > -0.5 * plate.depth


@compiled
def _dip_of(surface: Surface, plate: Row, work: Workspace, k: int) -> float:
    """Return how deep corners come beside a border or one that goes on from it nearly straight."""
    low, border = work.dips[k], surface.borders[k]
    if k + 1 < plate.end:
        after = surface.borders[k + 1]
        cosine = border.normal_x * after.normal_x + border.normal_y * after.normal_y
        if after.start_x == border.end_x and after.start_y == border.end_y and cosine > STRAIGHT_BORDERS:
            low = min(low, work.dips[k + 1])
    return low


@compiled
def _is_between_faces(solid: TrueSolid, k: int, normal: Triple) -> bool:
    """Tell whether a normal in body axes lies between the faces of an edge of the part."""
    side = solid.sides[k]
    return dot(normal, side[:3]) >= -NORMAL_SLACK and dot(normal, side[3:]) >= -NORMAL_SLACK


@compiled
def _add_edge_once(
    work: Workspace,
    n: int,
    solid: TrueSolid,
    spot: Vec3,
    normal: Triple,
    gap: float,
    friction: float,
    key: float,
) -> None:
    """Add a contact of an edge unless one as good as the same is there; the deeper of the two is kept."""
    for m in range(work.counts[n]):
        row = work.contacts[n, m]
        if row.key % KEYS_PER_SPOT < 3.0:
            continue
        x, y, z = row.spot_x - spot[0], row.spot_y - spot[1], row.spot_z - spot[2]
        if x * x + y * y + z * z > EDGE_SPACING * EDGE_SPACING:
            continue
        if row.normal_x * normal[0] + row.normal_y * normal[1] + row.normal_z * normal[2] > SAME_NORMAL:
            if gap < row.gap:
                count, work.counts[n] = work.counts[n], m
                add_contact(work, n, solid, spot, normal, gap, friction, key)
                work.counts[n] = count
            return
    add_contact(work, n, solid, spot, normal, gap, friction, key)


@compiled
def _add_edges(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, reach: float, count: int
) -> int:
    """Add contacts of edges with a plate's borders within ``reach`` [L]; return how many carry it."""
    plate, frame, far = surface.plates[k], work.frame, work.list_states[n].shift + reach + LIST_DEPTH
    for m in range(work.ends[n, k].edges, work.ends[n, k + 1].edges):
        near = work.near_edges[n, m]
        if near.gap > far:
            continue
        edge, border = near.edge, surface.borders[near.border]
        i, j = solid.corners[solid.edges[edge, 0]], solid.corners[solid.edges[edge, 1]]
        ends = (-solid.extensions[edge, 0], 1.0 + solid.extensions[edge, 1])
        c, f = height_of(frame, i), height_of(frame, j)
        if near.back:
            c, f = -plate.depth - c, -plate.depth - f
        if min(c + ends[0] * (f - c), c + ends[1] * (f - c)) > reach:  # as high as that no border is
            continue
        a, b, _ = place_of(frame, i)
        d, e, _ = place_of(frame, j)
        share, u, v, w, gap = crossing((a, b, c), (d - a, e - b, f - c), ends, border, reach)
        if gap == math.inf:
            continue
        if w < STEEP_EDGE_NORMAL and min(c, f, _dip_of(surface, plate, work, near.border)) > -plate.rounding:
            continue
        if near.back:
            w = -w
        if not _is_between_faces(solid, edge, rotate_back(frame, (u, v, w))):
            continue
        spot = point_along(i, share, subtract(j, i))
        key = 3.0 + near.back + KEYS_PER_SPOT * (edge + PLATE_KEYS * near.border)
        if w > LEVEL_NORMAL:
            place = a + share * (d - a), b + share * (e - b)
            count = add_support(work.supports, count, place, gap, spot, key)
        else:
            _add_edge_once(work, n, solid, spot, bowl_vector(plate, u, v, w), gap, plate.friction, key)
    return count


@compiled
def crossing(
    p: Triple, along: Triple, ends: tuple[float, float], border: Row, reach: float
) -> tuple[float, float, float, float, float]:
    """Where an edge from p touches a border, as the plate sees them.

    Its share, between ``ends``, the normal (3,) and the gap; inf where it does not.
    """
    a, b, c = along
    least, most = ends
    u, v = border.end_x - border.start_x, border.end_y - border.start_y
    nx, ny, nz = -c * v, c * u, a * v - b * u  # edge x border
    square = nx * nx + ny * ny + nz * nz
    if square <= CROSSING_SINE * CROSSING_SINE * (a * a + b * b + c * c) * (u * u + v * v):
        return 0.0, 0.0, 0.0, 0.0, math.inf
    flat = nx * border.normal_x + ny * border.normal_y
    size = math.sqrt(square)
    if nz + flat < 0.0:
        size = -size
    x, y, z = p[0] - border.start_x, p[1] - border.start_y, p[2]
    nx, ny, nz = nx / size, ny / size, nz / size
    gap = nx * x + ny * y + nz * z
    if gap > reach or gap < -MAX_DEPTH or nz < -NORMAL_SLACK or flat / size < -NORMAL_SLACK:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    x, y, z = x - gap * nx, y - gap * ny, z - gap * nz
    # in the plane of both: share of the edge where it meets the border's line, then of the border
    mx, my, mz = -v * nz, u * nz, v * nx - u * ny  # normal x border
    share = -(x * mx + y * my + z * mz) / (a * mx + b * my + c * mz)
    place = ((x + share * a) * u + (y + share * b) * v) / (u * u + v * v)
    if not (least <= share <= most and -border.extension_start <= place <= 1.0 + border.extension_end):
        return 0.0, 0.0, 0.0, 0.0, math.inf
    return share, nx, ny, nz, gap


@compiled
def _add_posts(surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, reach: float) -> None:
    """Add contacts of edges within ``reach`` [L] of what runs back from convex corners of borders."""
    plate, frame = surface.plates[k], work.frame
    for m in range(work.ends[n, k].posts, work.ends[n, k + 1].posts):
        near = work.near_posts[n, m]
        edge, border = near.edge, surface.borders[near.border]
        i, j = solid.corners[solid.edges[edge, 0]], solid.corners[solid.edges[edge, 1]]
        p = place_of(frame, i)
        a, b, c = subtract(place_of(frame, j), p)
        square = a * a + b * b
        if square <= CROSSING_SINE * CROSSING_SINE * (square + c * c):
            continue
        x, y = border.start_x - p[0], border.start_y - p[1]
        share, size = (x * a + y * b) / square, math.sqrt(square)
        u, v = b / size, -a / size
        if u * (border.normal_x + border.previous_x) + v * (border.normal_y + border.previous_y) < 0.0:
            u, v = -u, -v
        gap, height = -(u * x + v * y), p[2] + share * c
        if not -solid.extensions[edge, 0] <= share <= 1.0 + solid.extensions[edge, 1]:
            continue
        touches = -MAX_DEPTH <= gap <= reach and -plate.depth < height < 0.0
        if not touches or not _is_before_corner(border, u, v):
            continue
        low = min(height, _dip_of(surface, plate, work, near.border))
        if low > -plate.rounding or gap < low:  # it is nearer to the surface
            continue
        if _is_between_faces(solid, edge, rotate_back(frame, (u, v, 0.0))):
            spot = point_along(i, share, subtract(j, i))
            key = 5.0 + KEYS_PER_SPOT * (edge + PLATE_KEYS * near.border)
            _add_edge_once(work, n, solid, spot, bowl_vector(plate, u, v, 0.0), gap, plate.friction, key)


@compiled
def _is_before_corner(border: Row, u: float, v: float) -> bool:
    """Tell whether what is solid at a border's start lies behind a normal along the plate."""
    along = -u * border.normal_y + v * border.normal_x
    behind = u * border.previous_y - v * border.previous_x
    return along <= NORMAL_SLACK and behind <= NORMAL_SLACK


@compiled
def _add_faces(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, reach: float, count: int
) -> int:
    """Add contacts of faces within ``reach`` [L] of the convex corners of borders; as ``_add_edges``."""
    plate, frame = surface.plates[k], work.frame
    m, last = work.ends[n, k].faces, work.ends[n, k + 1].faces
    while m < last:
        first = work.near_faces[n, m]
        border = surface.borders[first.border]
        level = -plate.depth if first.back else 0.0
        spot = rotate_back(frame, (border.start_x - frame[9], border.start_y - frame[10], level - frame[11]))
        x, y, z = spot
        gap, face = math.inf, -1
        while m < last:
            near = work.near_faces[n, m]
            if near.border != first.border or near.back != first.back:
                break
            off = height_over_face(solid, near.face, x, y, z)
            nearer = -MAX_DEPTH < off < reach and abs(off) < abs(gap)
            nearer = nearer and is_over_face(solid, near.face, x, y, z, 0.0)
            if nearer and _points_to_face(surface, solid, work, plate, near):
                gap, face = off, near.face
            m += 1
        if face >= 0:
            u, v, w = _against_face(frame, solid.normals[face])
            key = 6.0 + first.back + KEYS_PER_SPOT * (face + PLATE_KEYS * first.border)
            if w > LEVEL_NORMAL:
                place = border.start_x, border.start_y
                count = add_support(work.supports, count, place, gap, spot, key)
            else:
                add_contact(work, n, solid, spot, bowl_vector(plate, u, v, w), gap, plate.friction, key)
    return count


@compiled
def _against_face(frame: Floats, t: Floats) -> Triple:
    """The normal of a face of the part as a plate sees it, away from the plate."""
    u, v, w = rotate(frame, t)
    return -u, -v, -w


@compiled
def _points_to_face(surface: Surface, solid: TrueSolid, work: Workspace, plate: Row, near: Row) -> bool:
    """Tell whether a border's corner, in front or at the back, points to a face of the part."""
    frame = work.frame
    u, v, w = _against_face(frame, solid.normals[near.face])
    out = -w if near.back else w
    if out < -NORMAL_SLACK or not _is_before_corner(surface.borders[near.border], u, v):
        return False
    if out < STEEP_EDGE_NORMAL:
        low = _dip_of(surface, plate, work, near.border)
        for e in range(3):
            c = height_of(frame, solid.vertices[solid.triangles[near.face, e]])
            low = min(low, -plate.depth - c if near.back else c)
        return low <= -plate.rounding
    return True
