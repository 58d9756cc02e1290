"""Compiled lists of what of a part may come to touch what, made once in a while.

They hold as long as no corner of the part has moved further than the lists look around it: a part that slides
or lies moves by that in many steps, so that a step costs what touches and not what is in the file.
"""

import math

from feederscrew.arrivals.kernel.body import Q, X, Y, Z
from feederscrew.base.arrays import Floats, Row, Rows, Triple
from feederscrew.base.geometry.compiled import compiled, outlined
from feederscrew.trials.kernel.plate_views import (
    BLOCK,
    MAX_DEPTH,
    box_is_off,
    circle_height,
    circle_to_wall,
    crosses,
    distance_to_border,
    distance_to_wall,
    extent_of,
    height_over_face,
    is_over_face,
    is_solid,
    place_of,
    rotate,
    rotate_back,
    view_of,
    wall_of,
)
from feederscrew.trials.kernel.workspace import Surface, TrueSolid, Workspace

FREE_WAY = 0.25  # in units of the part's length: so far along a bare track its lists hold
# how far around a part is looked
LEAST_MARGIN = 0.02  # at least
MARGIN_SHARE = 3.0  # times the reach
NO_BEND = 1e-9  # [1] of the product of squares: two lines are parallel


@compiled
def lists_hold(surface: Surface, solid: TrueSolid, work: Workspace, n: int, reach: float) -> bool:
    """Return whether the lists of a part still hold for contacts ``reach`` [L] ahead."""
    state, lists = work.states[n], work.list_states[n]
    x, y = state[X] - lists.x, state[Y] - lists.y
    square, c, s = x * x + y * y, 1.0, 0.0
    if square < lists.free * lists.free:  # along the bare track, turned about its axis, it sees the same
        new = work.tangents[n]
        c = lists.tangent_x * new[0] + lists.tangent_y * new[1]
        s = lists.tangent_x * new[1] - lists.tangent_y * new[0]
        off = (state[X] * new[1]) + (surface.radius - state[Y]) * new[0] - lists.from_axis
        square = off * off
    square += (state[Z] - lists.z) ** 2
    half = math.sqrt(0.5 + 0.5 * c)
    p, q = half, 0.5 * s / half
    w, x = p * lists.qw - q * lists.qz, p * lists.qx - q * lists.qy
    y, z = p * lists.qy + q * lists.qx, p * lists.qz + q * lists.qw
    a, b, c, d = state[Q], state[Q + 1], state[Q + 2], state[Q + 3]
    same = (a - w) ** 2 + (b - x) ** 2 + (c - y) ** 2 + (d - z) ** 2
    opposite = (a + w) ** 2 + (b + x) ** 2 + (c + y) ** 2 + (d + z) ** 2
    lists.shift = math.sqrt(square) + 2.1 * solid.radius * math.sqrt(min(same, opposite))
    return lists.shift + reach < lists.reach


@outlined
def rebuild_lists(surface: Surface, solid: TrueSolid, work: Workspace, n: int, reach: float) -> None:
    """Make the lists of a part anew, of what may come within ``reach`` [L]."""
    state, lists, filled = work.states[n], work.list_states[n], work.list_counts[0]
    margin = reach + max(LEAST_MARGIN, MARGIN_SHARE * reach)
    lists.x, lists.y, lists.z = state[X], state[Y], state[Z]
    lists.qw, lists.qx, lists.qy, lists.qz = state[Q], state[Q + 1], state[Q + 2], state[Q + 3]
    lists.reach, lists.shift, lists.free = margin, 0.0, FREE_WAY
    lists.tangent_x, lists.tangent_y = work.tangents[n, 0], work.tangents[n, 1]
    lists.from_axis = state[X] * work.tangents[n, 1] + (surface.radius - state[Y]) * work.tangents[n, 0]
    # what of it is near the wall: corners of its hull, and circles
    x, y, count = state[X], surface.radius - state[Y], 0
    if math.sqrt(x * x + y * y) + solid.radius > (surface.radius - margin) * wall_of(work.leans[n])[1]:
        for j in range(len(solid.single_blocks)):
            block = solid.single_blocks[j]
            p = 0.5 * (block[0] + block[3]), 0.5 * (block[1] + block[4]), 0.5 * (block[2] + block[5])
            x, y, z = block[3] - p[0], block[4] - p[1], block[5] - p[2]
            if _point_to_wall(surface, work, n, p) > margin + math.sqrt(x * x + y * y + z * z):
                continue
            for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.singles))):
                q = solid.corners[solid.singles[m]]
                gap = _point_to_wall(surface, work, n, (q[0], q[1], q[2]))
                if gap < margin:
                    near = work.wall_corners[n, count]
                    near.corner, near.gap = solid.singles[m], gap
                    count += 1
    lists.wall_corners, lists.wall_circles = count, 0
    for k in range(len(solid.circles)):
        if circle_to_wall(surface, state, work.turns[n], work.leans[n], solid.circles[k])[0] < margin:
            work.wall_circles[n, lists.wall_circles] = k
            lists.wall_circles += 1
    filled.corners = filled.sides = filled.edges = filled.posts = 0
    filled.faces = filled.circles = filled.rounds = 0
    for k in range(len(surface.plates)):
        plate = surface.plates[k]
        view_of(plate, state, work.turns[n], work.frame)
        far, x, y, z = solid.radius + margin + FREE_WAY, work.frame[9], work.frame[10], work.frame[11]
        comes = -plate.depth - far <= z <= far  # a ball about its centre to the plate
        comes = comes and plate.least_x - far <= x <= plate.most_x + far
        if comes and plate.least_y - far <= y <= plate.most_y + far:
            if plate.front_z < 1.0 or _border_comes(solid, work, plate, surface.borders, margin + FREE_WAY):
                lists.free = 0.0
            _list_plate(surface, solid, work, n, k, margin)
        work.ends[n, k + 1] = work.list_counts[0]


@compiled
def _point_to_wall(surface: Surface, work: Workspace, n: int, p: Triple) -> float:
    """Return how far a point of a body is from the wall."""
    state = work.states[n]
    x, y, z = rotate(work.turns[n], p)
    return distance_to_wall(surface, work.leans[n], state[X] + x, state[Y] + y, state[Z] + z)


@compiled
def _list_plate(surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, margin: float) -> None:
    """Add what of a part is near one plate; ``work.frame`` is how that sees it."""
    plate, borders, box = surface.plates[k], surface.borders, work.box
    count = total = blocks = 0
    comes = _border_comes(solid, work, plate, borders, margin)
    for e in range(plate.begin, plate.end):  # a line along the plate from a point in the box may cross it
        border = borders[e]
        level = max(border.start_y, border.end_y) >= box[2] - margin
        level = level and min(border.start_y, border.end_y) <= box[3] + margin
        if level and max(border.start_x, border.end_x) >= box[0] - margin:
            work.rounds[n, work.list_counts[0].rounds] = e
            work.list_counts[0].rounds += 1
    if comes:
        # which blocks of edges come to the plate's height, and their box
        top, bottom = margin, -plate.depth - margin
        for e in range(2):
            box[2 * e], box[2 * e + 1] = math.inf, -math.inf
        for j in range(len(solid.edge_blocks)):
            low, high = extent_of(work.frame, solid.edge_blocks[j], 2)
            if low > top + MAX_DEPTH or high < bottom - MAX_DEPTH:
                continue
            work.blocks[blocks] = j
            blocks += 1
            for e in range(2 if low <= top and high >= bottom else 0):
                least, most = extent_of(work.frame, solid.edge_blocks[j], e)
                box[2 * e], box[2 * e + 1] = min(box[2 * e], least), max(box[2 * e + 1], most)
        for turn in range(2):  # the borders that come into the box, those where the drawing ends last
            for e in range(plate.begin, plate.end):
                if borders[e].drawn_end == (turn == 1) and _comes_into(borders[e], box, margin):
                    work.borders_near[total] = e
                    total += 1
            count = count if turn else total
    _list_circles(surface, solid, work, n, k, total, margin)
    _list_corners(surface, solid, work, n, k, count, total, margin)
    for m in range(count):
        _list_edges(surface, solid, work, n, plate, work.borders_near[m], blocks, margin)
        _list_faces(surface, solid, work, n, plate, work.borders_near[m], margin)


@compiled
def _comes_into(border: Row, box: Floats, margin: float) -> bool:
    """Tell whether a border may come into a box (4,) of places along a plate, or so near to it."""
    p, q, u, v = border.start_x, border.start_y, border.end_x, border.end_y
    if min(p, u) > box[1] + margin or max(p, u) < box[0] - margin:
        return False
    return min(q, v) <= box[3] + margin and max(q, v) >= box[2] - margin


@compiled
def _border_comes(solid: TrueSolid, work: Workspace, plate: Row, borders: Rows, margin: float) -> bool:
    """Tell whether any border of a plate comes into the box of a ball around the part, ``work.box``."""
    box, far, comes = work.box, solid.radius, False
    for e in range(2):
        box[2 * e], box[2 * e + 1] = work.frame[9 + e] - far, work.frame[9 + e] + far
    for k in range(plate.begin, plate.end):
        comes = _comes_into(borders[k], box, margin)
        if comes:
            break
    return comes


@compiled
def _is_over_solid(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, a: float, b: float
) -> bool:
    """Tell whether a point (a, b) [L] of a plate, below the part, is solid: within its borders.

    Of a point in the box of a ball around the part the ``work.rounds`` listed tell; of any other, as the
    middle of an arc may be, all borders.
    """
    plate, radius, odd = surface.plates[k], solid.radius, False
    if abs(b - work.frame[10]) > radius or a < work.frame[9] - radius:
        return is_solid(surface.borders, plate.begin, plate.end, a, b)
    for e in range(work.ends[n, k].rounds, work.list_counts[0].rounds):
        odd = odd != crosses(surface.borders[work.rounds[n, e]], a, b)
    return odd


@compiled
def _list_corners(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, count: int, total: int, margin: float
) -> None:
    """Add the corners near a plate, each with the borders near it, of so many."""
    plate, borders, box = surface.plates[k], surface.borders, work.box
    # where no border is near, corners of the hull that are on no circle: no others touch the plate
    which = solid.block_order if count else solid.singles
    blocks = solid.corner_blocks if count else solid.single_blocks
    corners, top, bottom = 0, margin, -plate.depth - margin
    for j in range(len(blocks)):
        low, high = extent_of(work.frame, blocks[j], 2)
        if low > top or high < bottom:
            continue
        for m in range(BLOCK * j, min(BLOCK * (j + 1), len(which))):
            a, b, c = place_of(work.frame, solid.corners[which[m]])
            if bottom <= c <= top:
                work.view_corners[corners] = which[m]
                work.views[corners, 0], work.views[corners, 1], work.views[corners, 2] = a, b, c
                corners += 1
    for begin in range(0, corners, BLOCK):
        end, close_count, is_bare = min(begin + BLOCK, corners), 0, True
        for e in range(2):
            box[2 * e] = box[2 * e + 1] = work.views[begin, e]
            for m in range(begin + 1, end):
                box[2 * e] = min(box[2 * e], work.views[m, e])
                box[2 * e + 1] = max(box[2 * e + 1], work.views[m, e])
        for e in range(total):
            if _comes_into(borders[work.borders_near[e]], box, margin + MAX_DEPTH):
                is_bare = False
                if e < count:
                    work.borders_close[close_count] = work.borders_near[e]
                    close_count += 1
        a, b = work.views[begin, 0], work.views[begin, 1]
        if not is_bare or _is_over_solid(surface, solid, work, n, k, a, b):
            for m in range(begin, end):
                _list_corner(surface, solid, work, n, k, m, close_count, is_bare, margin)


@compiled
def _list_corner(
    surface: Surface,
    solid: TrueSolid,
    work: Workspace,
    n: int,
    k: int,
    m: int,
    close_count: int,
    is_bare: bool,
    margin: float,
) -> None:
    """Add a corner with the borders near it, of those that come close to the corners around it."""
    borders, plate, filled = surface.borders, surface.plates[k], work.list_counts[0]
    a, b, c = work.views[m, 0], work.views[m, 1], work.views[m, 2]
    count, first = filled.corners, filled.sides
    sides, nearest = first, math.inf
    for e in range(close_count):
        off = distance_to_border(borders[work.borders_close[e]], a, b)
        if abs(off) < margin + MAX_DEPTH and sides < work.sides.shape[1]:
            work.sides[n, sides] = work.borders_close[e]
            sides += 1
            nearest = off if abs(off) < abs(nearest) else nearest
    corner = work.view_corners[m]
    if sides == first:
        if -plate.depth + MAX_DEPTH + margin < c and (c < -MAX_DEPTH - margin or solid.on_circle[corner]):
            return
        if not is_bare and not _is_over_solid(surface, solid, work, n, k, a, b):
            return
    if count < work.near_corners.shape[1]:
        near = work.near_corners[n, count]
        near.corner, near.first_side, near.last_side = corner, first, sides
        near.off = c if sides == first else max(c, nearest)
        box, p, new = work.groups[n, count // BLOCK], solid.corners[corner], count % BLOCK == 0
        for e in range(3):
            box[e] = p[e] if new else min(box[e], p[e])
            box[3 + e] = p[e] if new else max(box[3 + e], p[e])
        filled.corners, filled.sides = count + 1, sides


@compiled
def _list_circles(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, k: int, total: int, margin: float
) -> None:
    """Add the circles near a plate's surface, of so many near borders, within a margin [L].

    A circle to which no border comes near counts as it lies over what is solid; of any other each point is
    asked for.
    """
    plate, frame, box = surface.plates[k], work.frame, work.box
    whole = 0.5 * plate.depth >= MAX_DEPTH
    for m in range(len(solid.circles)):
        circle = solid.circles[m]
        low, _ = circle_height(frame, circle)
        if not -MAX_DEPTH - margin < low < margin:
            continue
        a, b, _ = place_of(frame, (circle.x, circle.y, circle.z))
        clear = total == 0
        if whole and not clear:
            for e in range(2):
                along = frame[3 * e] * circle.axis_x + frame[3 * e + 1] * circle.axis_y
                along += frame[3 * e + 2] * circle.axis_z
                half = circle.radius * math.sqrt(max(1.0 - along * along, 0.0))
                middle = a if e == 0 else b
                box[2 * e], box[2 * e + 1] = middle - half, middle + half
            clear = True
            for e in range(total):
                border = surface.borders[work.borders_near[e]]
                clear = clear and not _comes_into(border, box, margin + MAX_DEPTH)
        if clear and not _is_over_solid(surface, solid, work, n, k, a, b):
            continue
        near = work.near_circles[n, work.list_counts[0].circles]
        near.circle, near.clear = m, clear
        work.list_counts[0].circles += 1


@compiled
def _box_between(frame: Floats, first: Triple, second: Triple, margin: float, box: Floats) -> None:
    """Write the box in the body's axes of what a plate sees between two points, and so far around it."""
    p = rotate_back(frame, (first[0] - frame[9], first[1] - frame[10], first[2] - frame[11]))
    q = rotate_back(frame, (second[0] - frame[9], second[1] - frame[10], second[2] - frame[11]))
    for e in range(3):
        box[e], box[3 + e] = min(p[e], q[e]) - margin, max(p[e], q[e]) + margin


@compiled
def _list_edges(
    surface: Surface,
    solid: TrueSolid,
    work: Workspace,
    n: int,
    plate: Row,
    k: int,
    blocks: int,
    margin: float,
) -> None:
    """Add the edges near border k, in front or at the back, and near what runs back from its start."""
    border, depth, frame, filled = surface.borders[k], plate.depth, work.frame, work.list_counts[0]
    a, b, c, d, wide = border.start_x, border.start_y, border.end_x, border.end_y, margin + MAX_DEPTH
    for what in range(3 if border.convex else 2):
        level = -depth if what == 1 else 0.0
        second = (a, b, -depth) if what == 2 else (c, d, level)
        _box_between(frame, (a, b, level), second, wide, work.box)
        for i in range(blocks):
            j = work.blocks[i]
            if box_is_off(solid.edge_blocks[j], work.box[:3], work.box[3:], 0.0):
                continue
            for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.edges))):
                p = place_of(frame, solid.corners[solid.edges[m, 0]])
                q = place_of(frame, solid.corners[solid.edges[m, 1]])
                low, high = min(p[2], q[2]), max(p[2], q[2])
                passes = what == 2 and low <= margin and high >= -depth - margin
                if passes and filled.posts < work.near_posts.shape[1] and _passes_start(p, q, border, wide):
                    post = work.near_posts[n, filled.posts]
                    post.edge, post.border = m, k
                    filled.posts += 1
                # whether the boxes of both are further apart than that
                if what == 2 or low > level + wide or high < level - wide:
                    continue
                if min(p[0], q[0]) > max(a, c) + wide or max(p[0], q[0]) < min(a, c) - wide:
                    continue
                if min(p[1], q[1]) > max(b, d) + wide or max(p[1], q[1]) < min(b, d) - wide:
                    continue
                gap = _line_distance(p, q, border, level)
                if gap < wide and filled.edges < work.near_edges.shape[1]:
                    near = work.near_edges[n, filled.edges]
                    near.edge, near.border, near.back, near.gap = m, k, what == 1, gap
                    filled.edges += 1


@compiled
def _line_distance(p: Triple, q: Triple, border: Row, level: float) -> float:
    """Return how far apart an edge and a border, at a level of its plate, are."""
    a, b, c = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    u, v = border.end_x - border.start_x, border.end_y - border.start_y
    x, y, z = p[0] - border.start_x, p[1] - border.start_y, p[2] - level
    ee, ff, ef = a * a + b * b + c * c, u * u + v * v, a * u + b * v
    ex, fx = a * x + b * y + c * z, u * x + v * y
    flat = ee * ff - ef * ef
    share = min(max((ef * fx - ff * ex) / flat, 0.0), 1.0) if flat > NO_BEND * ee * ff else 0.0
    place = (fx + share * ef) / ff
    if place < 0.0 or place > 1.0:
        place = min(max(place, 0.0), 1.0)
        share = min(max((place * ef - ex) / ee, 0.0), 1.0)
    x, y, z = x + share * a - place * u, y + share * b - place * v, z + share * c
    return math.sqrt(x * x + y * y + z * z)


@compiled
def _passes_start(p: Triple, q: Triple, border: Row, wide: float) -> bool:
    """Tell whether an edge comes past the start of a border as near as that."""
    x, y, u, v = border.start_x - p[0], border.start_y - p[1], q[0] - p[0], q[1] - p[1]
    square = u * u + v * v
    share = min(max((x * u + y * v) / square, 0.0), 1.0) if square > 0.0 else 0.0
    x, y = x - share * u, y - share * v
    return x * x + y * y < wide * wide


@compiled
def _list_faces(
    surface: Surface, solid: TrueSolid, work: Workspace, n: int, plate: Row, k: int, margin: float
) -> None:
    """Add the faces of a part within ``margin`` [L] of the convex corner at the start of border k."""
    border, box, filled = surface.borders[k], work.box, work.list_counts[0]
    for at_back in range(2 if border.convex else 0):
        corner = (border.start_x, border.start_y, -plate.depth if at_back else 0.0)
        _box_between(work.frame, corner, corner, margin + MAX_DEPTH, box)
        x, y, z = 0.5 * (box[0] + box[3]), 0.5 * (box[1] + box[4]), 0.5 * (box[2] + box[5])
        for j in range(len(solid.face_blocks)):
            if box_is_off(solid.face_blocks[j], box[:3], box[3:], 0.0):
                continue
            for f in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.triangles))):
                off = height_over_face(solid, f, x, y, z)
                if not -margin - MAX_DEPTH < off < margin or filled.faces >= work.near_faces.shape[1]:
                    continue
                if is_over_face(solid, f, x, y, z, margin):
                    near = work.near_faces[n, filled.faces]
                    near.face, near.border, near.back = f, k, at_back > 0
                    filled.faces += 1
