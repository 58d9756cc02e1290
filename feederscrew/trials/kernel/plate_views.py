"""Compiled views: how a plate sees a body, and how far points and circles are from borders and the wall."""

import math

from feederscrew.arrivals.kernel.body import X, Y, Z
from feederscrew.base.arrays import Floats, Row, Rows, Triple
from feederscrew.base.geometry.compiled import compiled
from feederscrew.trials.kernel.workspace import Surface, TrueSolid, Vec3

MAX_DEPTH = 0.04  # how far behind a surface anything may be found, in units of the part's length
NORMAL_SLACK = 0.02  # [1] by which a contact's normal may lie beyond the faces it is between
CROSSING_SINE = 1e-3  # [1] of the angle below which two edges do not cross: their ends touch instead
EDGE_EXTENSION = 3e-3  # of the unit of length: an edge goes on so far where a hollow edge meets its end
BORDER_END_SHARE = 1.0 - 1e-9  # a border's end counts for the next border's start
BLOCK = 16  # corners, edges, or faces, that have a box together


@compiled
def dot(a: Vec3, b: Vec3) -> float:
    """Return the scalar product of two vectors (3,), in the product of their units [any]."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def cross(a: Vec3, b: Vec3) -> Triple:
    """Return the vector product (3,) of two vectors (3,), in the product of their units [any]."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def subtract(a: Vec3, b: Vec3) -> Triple:
    """Return the difference (3,) of two vectors (3,), in their unit [any]."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@compiled
def point_along(p: Vec3, length: float, direction: Vec3) -> Triple:
    """Return the point (3,) [L] a length [L] along a direction (3,) [1] from p."""
    return p[0] + length * direction[0], p[1] + length * direction[1], p[2] + length * direction[2]


@compiled
def view_of(plate: Row, state: Floats, turn: Floats, frame: Floats) -> None:
    """Write how a plate sees a body to ``frame`` (12,): rotation [1], row by row, and place [L]."""
    x, y, z = state[X] - plate.origin_x, state[Y] - plate.origin_y, state[Z] - plate.origin_z
    for e in range(3):
        u, v, w = plate.first_x, plate.first_y, plate.first_z
        if e == 1:
            u, v, w = plate.second_x, plate.second_y, plate.second_z
        elif e == 2:
            u, v, w = plate.front_x, plate.front_y, plate.front_z
        for k in range(3):
            frame[3 * e + k] = u * turn[k] + v * turn[3 + k] + w * turn[6 + k]
        frame[9 + e] = u * x + v * y + w * z


@compiled
def place_of(frame: Floats, p: Vec3) -> Triple:
    """Return where a point (3,) [L] of the body is, as a plate sees it [L]; frame (12,) of ``view_of``."""
    x, y, z = rotate(frame, p)
    return x + frame[9], y + frame[10], z + frame[11]


@compiled
def height_of(frame: Floats, p: Vec3) -> float:
    """Return how high a point (3,) [L] of the body is over a plate [L]; frame (12,) of ``view_of``."""
    return frame[6] * p[0] + frame[7] * p[1] + frame[8] * p[2] + frame[11]


@compiled
def extent_of(frame: Floats, block: Floats, axis: int) -> tuple[float, float]:
    """Return between which places [L] along an axis of a plate, the last its height, a box (6,) [L] is."""
    middle, half = frame[9 + axis], 0.0
    for e in range(3):
        middle += 0.5 * frame[3 * axis + e] * (block[e] + block[3 + e])
        half += 0.5 * abs(frame[3 * axis + e]) * (block[3 + e] - block[e])
    return middle - half, middle + half


@compiled
def box_is_off(box: Floats, p: Vec3, q: Vec3, reach: float) -> bool:
    """Return whether the box around two points lies farther than ``reach`` [L] from another along an axis."""
    for e in range(3):
        least, most = min(p[e], q[e]), max(p[e], q[e])
        if least > box[3 + e] + reach or most < box[e] - reach:
            return True
    return False


@compiled
def bowl_vector(plate: Row, x: float, y: float, z: float) -> Triple:
    """Return a vector that a plate sees, in the bowl's frame and its own unit [any]."""
    return (
        x * plate.first_x + y * plate.second_x + z * plate.front_x,
        x * plate.first_y + y * plate.second_y + z * plate.front_y,
        x * plate.first_z + y * plate.second_z + z * plate.front_z,
    )


@compiled
def rotate(turn: Floats, p: Vec3) -> Triple:
    """Return a vector (3,) of the body in the bowl's frame, or as a plate sees it, by its rotation [1]."""
    return (
        turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2],
        turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2],
        turn[6] * p[0] + turn[7] * p[1] + turn[8] * p[2],
    )


@compiled
def rotate_back(turn: Floats, p: Vec3) -> Triple:
    """Return a vector (3,) of the bowl's frame, or that a plate sees, in the body's axes by its turn [1]."""
    return (
        turn[0] * p[0] + turn[3] * p[1] + turn[6] * p[2],
        turn[1] * p[0] + turn[4] * p[1] + turn[7] * p[2],
        turn[2] * p[0] + turn[5] * p[1] + turn[8] * p[2],
    )


@compiled
def axis_of(leans: Floats) -> tuple[float, float]:
    """Return the bowl's axis (2,) [1], inwards and up, where the track leans (7,) so."""
    return leans[3], leans[4]


@compiled
def wall_of(leans: Floats) -> tuple[float, float]:
    """Return the direction (2,) [1] along which the wall stands, inwards and up, where the track leans so."""
    return leans[5], leans[6]


@compiled
def distance_to_wall(surface: Surface, leans: Floats, x: float, y: float, z: float) -> float:
    """Return how far a point is from the wall [L]: upright also on a bank, the other face of a groove's V."""
    lean, up = wall_of(leans)
    y -= surface.radius
    return up * (surface.radius - math.sqrt(x * x + y * y)) - lean * z


@compiled
def is_solid(borders: Rows, first: int, last: int, a: float, b: float) -> bool:
    """Return whether a point (a, b) [L] of a plate is solid: within its borders (B,), holes left out."""
    odd = False
    for k in range(first, last):
        odd = odd != crosses(borders[k], a, b)
    return odd


@compiled
def crosses(border: Row, a: float, b: float) -> bool:
    """Return whether a line from a point (a, b) [L] of a plate along its first axis crosses a border."""
    p, q, r, s = border.start_x, border.start_y, border.end_x, border.end_y
    return (q > b) != (s > b) and a < p + (b - q) / (s - q) * (r - p)


@compiled
def distance_to_border(border: Row, a: float, b: float) -> float:
    """Return how far a point is from a border [L], negative where it is solid; infinite at its end."""
    u, v = border.end_x - border.start_x, border.end_y - border.start_y
    x, y = a - border.start_x, b - border.start_y
    share = (x * u + y * v) / (u * u + v * v)
    if share >= BORDER_END_SHARE:
        share = 1.0
    share = min(max(share, 0.0), 1.0)
    x, y = x - share * u, y - share * v
    off = math.sqrt(x * x + y * y)
    nx, ny = border.normal_x, border.normal_y
    if share == 0.0:
        nx, ny = nx + border.previous_x, ny + border.previous_y
    elif share == 1.0:
        off += 1e-12 + 1e-9 * off  # the next border tells
    return -off if nx * x + ny * y < 0.0 else off


@compiled
def is_over_face(solid: TrueSolid, k: int, x: float, y: float, z: float, margin: float) -> bool:
    """Return whether a point [L] lies over triangle k, or no further than ``margin`` [L] outside it."""
    n = solid.normals[k]
    for i in range(3):
        p, q = solid.vertices[solid.triangles[k, i]], solid.vertices[solid.triangles[k, (i + 1) % 3]]
        along = subtract(q, p)
        inside = dot(n, cross(along, subtract((x, y, z), p)))
        if inside < 0.0 and inside < -margin * math.sqrt(dot(along, along)):
            return False
    return True


@compiled
def distance_beside_face(solid: TrueSolid, k: int, x: float, y: float, z: float) -> float:
    """Return how far [L] a point lies outside triangle k, along it; negative where it lies over it."""
    n, most = solid.normals[k], -math.inf
    for i in range(3):
        p, q = solid.vertices[solid.triangles[k, i]], solid.vertices[solid.triangles[k, (i + 1) % 3]]
        along = subtract(q, p)
        most = max(most, -dot(n, cross(along, subtract((x, y, z), p))) / math.sqrt(dot(along, along)))
    return most


@compiled
def height_over_face(solid: TrueSolid, k: int, x: float, y: float, z: float) -> float:
    """Return how far a point [L] lies outside the plane of triangle k [L]."""
    return dot(subtract((x, y, z), solid.vertices[solid.triangles[k, 0]]), solid.normals[k])


@compiled
def circle_height(frame: Floats, circle: Row) -> tuple[float, float]:
    """Return the height [L] of a circle's lowest point as a plate sees it, and the sine of its tilt [1]."""
    middle = frame[6] * circle.x + frame[7] * circle.y + frame[8] * circle.z + frame[11]
    up = frame[6] * circle.axis_x + frame[7] * circle.axis_y + frame[8] * circle.axis_z
    tilt = math.sqrt(max(1.0 - up * up, 0.0))
    return middle - circle.radius * tilt, tilt


@compiled
def circle_to_wall(
    surface: Surface, state: Floats, turn: Floats, leans: Floats, circle: Row
) -> tuple[float, float]:
    """Return how near [L] a circle comes to the wall, or a little less, and the sine of its tilt to it."""
    lean, up = wall_of(leans)
    p = rotate(turn, (circle.x, circle.y, circle.z))
    x, y, z = p[0] + state[X], p[1] + state[Y] - surface.radius, p[2]
    off = math.sqrt(x * x + y * y)
    a, b, c = up * x / off, up * y / off, lean
    n = rotate(turn, (circle.axis_x, circle.axis_y, circle.axis_z))
    along = a * n[0] + b * n[1] + c * n[2]
    tilt = math.sqrt(max(a * a + b * b + c * c - along * along, 0.0))
    bent = 0.5 * circle.radius**2 / surface.radius  # by which the wall comes nearer to either side
    gap = distance_to_wall(surface, leans, x, y + surface.radius, z + state[Z])
    return gap - circle.radius * tilt - bent, tilt
