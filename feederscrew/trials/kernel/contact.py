"""Compiled contacts of a part with anything, records of `workspace.CONTACT`, and the impulses at them.

A contact's Jacobian (6,) along one of its axes gives the speed there of a body's velocities and rates (6,).
Its response (6,) is what one unit of impulse along that axis adds to these.
"""

import math

from feederscrew.arrivals.kernel.body import Moves, moves_of, set_moves
from feederscrew.base.arrays import Floats, Row, Triple
from feederscrew.base.geometry.compiled import compiled, outlined
from feederscrew.trials.kernel.plate_views import cross, dot, rotate_back
from feederscrew.trials.kernel.workspace import Island, Surface, TrueSolid, Vec3, Workspace

KEYS_PER_SPOT = 8.0  # [1] of a contact's key: its kind, then what touches
STEEP_NORMAL = 0.9  # [1] of a normal along the track: its first axis is upwards then


@compiled
def set_axes(row: Row, tangent: Floats, normal: Triple) -> None:
    """Write the axes [1] of a contact with a normal, the first along the track where it can be."""
    nx, ny, nz = normal
    u, v, w = tangent[0], tangent[1], 0.0
    across = u * nx + v * ny
    if abs(across) > STEEP_NORMAL:
        u, v, w, across = 0.0, 0.0, 1.0, nz
    u, v, w = u - across * nx, v - across * ny, w - across * nz
    size = 1.0 / math.sqrt(u * u + v * v + w * w)
    along = u * size, v * size, w * size
    row.along_x, row.along_y, row.along_z = along
    row.aside_x, row.aside_y, row.aside_z = cross(normal, along)
    row.normal_x, row.normal_y, row.normal_z = normal


@compiled
def _arm(turn: Floats, inertia: Floats, spot: Vec3, axis: Triple) -> tuple[Triple, Triple, float]:
    """Lever (3,) in body axes of a spot there, along an axis in the bowl's frame; its rates; 1 / mass."""
    lever = cross(spot, rotate_back(turn, axis))
    rates = lever[0] / inertia[0], lever[1] / inertia[1], lever[2] / inertia[2]
    return lever, rates, 1.0 + dot(lever, rates)


@compiled
def set_levers(row: Row, turn: Floats, inertia: Floats, spot: Vec3) -> None:
    """Write the levers [L] of a contact at a spot (3,) [L] in body axes, its rates [1/L] and masses [1]."""
    lever, rates, along = _arm(turn, inertia, spot, (row.along_x, row.along_y, row.along_z))
    row.along_lever_x, row.along_lever_y, row.along_lever_z = lever
    row.along_rate_x, row.along_rate_y, row.along_rate_z = rates
    other, rates, aside = _arm(turn, inertia, spot, (row.aside_x, row.aside_y, row.aside_z))
    row.aside_lever_x, row.aside_lever_y, row.aside_lever_z = other
    row.aside_rate_x, row.aside_rate_y, row.aside_rate_z = rates
    lean, mean, both = 0.5 * (along - aside), 0.5 * (along + aside), dot(lever, rates)
    row.along_mass = row.aside_mass = 1.0 / (mean + math.sqrt(lean * lean + both * both))
    lever, rates, normal = _arm(turn, inertia, spot, (row.normal_x, row.normal_y, row.normal_z))
    row.normal_lever_x, row.normal_lever_y, row.normal_lever_z = lever
    row.normal_rate_x, row.normal_rate_y, row.normal_rate_z = rates
    row.normal_mass = 1.0 / normal


@compiled
def add_contact(
    work: Workspace,
    n: int,
    solid: TrueSolid,
    spot: Vec3,
    normal: Triple,
    gap: float,
    friction: float,
    key: float,
) -> None:
    """Add a contact of part n at a spot (3,) [L] in its axes, with a normal (3,) [1] in the bowl's frame."""
    count = work.counts[n]
    if count >= work.contacts.shape[1]:
        return
    row = work.contacts[n, count]
    row.normal_x, row.normal_y, row.normal_z = normal
    row.gap, row.friction, row.key = gap, friction, key
    row.spot_x, row.spot_y, row.spot_z = spot
    _complete(row, work.tangents[n], work.turns[n], solid.inertia)
    work.counts[n] = count + 1


@outlined
def _complete(row: Row, tangent: Floats, turn: Floats, inertia: Floats) -> None:
    """Write axes, levers, rates and masses of a contact with its normal and spot."""
    set_axes(row, tangent, (row.normal_x, row.normal_y, row.normal_z))
    set_levers(row, turn, inertia, (row.spot_x, row.spot_y, row.spot_z))


@compiled
def _along_response(row: Row) -> Moves:
    return row.along_x, row.along_y, row.along_z, row.along_rate_x, row.along_rate_y, row.along_rate_z


@compiled
def _aside_response(row: Row) -> Moves:
    return row.aside_x, row.aside_y, row.aside_z, row.aside_rate_x, row.aside_rate_y, row.aside_rate_z


@compiled
def _normal_response(row: Row) -> Moves:
    return row.normal_x, row.normal_y, row.normal_z, row.normal_rate_x, row.normal_rate_y, row.normal_rate_z


@compiled
def _speed(jacobian: Moves, moves: Moves) -> float:
    """The velocity along an axis of a contact, of a body's velocities and rates (6,)."""
    a, b, c, d, e, f = jacobian
    u, v, w, p, q, r = moves
    return a * u + b * v + c * w + d * p + e * q + f * r


@compiled
def along_speed(moves: Moves, row: Row) -> float:
    """Return the velocity [sqrt(g L)] along the track of a contact of a body that moves so (6,)."""
    direction = row.along_x, row.along_y, row.along_z
    return _speed((*direction, row.along_lever_x, row.along_lever_y, row.along_lever_z), moves)


@compiled
def aside_speed(moves: Moves, row: Row) -> float:
    """Return the velocity [sqrt(g L)] of a contact square to its normal and the track, as ``along_speed``."""
    direction = row.aside_x, row.aside_y, row.aside_z
    return _speed((*direction, row.aside_lever_x, row.aside_lever_y, row.aside_lever_z), moves)


@compiled
def normal_speed(moves: Moves, row: Row) -> float:
    """Return the velocity [sqrt(g L)] of a contact along its normal, as ``along_speed``."""
    direction = row.normal_x, row.normal_y, row.normal_z
    return _speed((*direction, row.normal_lever_x, row.normal_lever_y, row.normal_lever_z), moves)


@compiled
def _push(response: Moves, impulse: float, moves: Moves) -> Moves:
    """Velocities and rates (6,) of a body after an impulse along an axis of a contact."""
    a, b, c, d, e, f = response
    u, v, w, p, q, r = moves
    u, v, w = u + a * impulse, v + b * impulse, w + c * impulse
    return u, v, w, p + d * impulse, q + e * impulse, r + f * impulse


@compiled
def pair_speed(states: Floats, work: Workspace, k: int) -> float:
    """Return the velocity [sqrt(g L)] of a pair's first part against the second, along their normal."""
    first, second = moves_of(states[work.owners[k]]), moves_of(states[work.owners[k + 1]])
    return normal_speed(first, work.pairs[k]) - normal_speed(second, work.pairs[k + 1])


@compiled
def pair_slip(states: Floats, work: Workspace, k: int) -> tuple[float, float]:
    """Return the velocity (2,) [sqrt(g L)] of a pair's first part against the second, along and aside."""
    first, second = moves_of(states[work.owners[k]]), moves_of(states[work.owners[k + 1]])
    a, b = work.pairs[k], work.pairs[k + 1]
    return along_speed(first, a) - along_speed(second, b), aside_speed(first, a) - aside_speed(second, b)


@compiled
def _within_friction(along: float, aside: float, most: float) -> tuple[float, float]:
    """Impulses along a contact, of the size that friction allows at most."""
    size = along * along + aside * aside
    scale = most / math.sqrt(size) if size > most * most else 1.0
    return scale * along, scale * aside


@compiled
def _relax(row: Row, has_friction: bool, moves: Moves) -> tuple[Moves, float]:
    """One projected Gauss-Seidel step on a contact: velocities and rates (6,), its impulse's change."""
    x, y, z = row.along_impulse, row.aside_impulse, row.normal_impulse
    up = max(z + row.normal_mass * (row.target_speed - normal_speed(moves, row)), 0.0)
    moves = _push(_normal_response(row), up - z, moves)
    change = abs(up - z)
    if has_friction and (up > 0.0 or z > 0.0):
        along = x - row.along_mass * along_speed(moves, row)
        aside = y - row.aside_mass * aside_speed(moves, row)
        most = up * (row.friction_back if along > 0.0 else row.friction_ahead)
        along, aside = _within_friction(along, aside, most)
        moves = _push(_along_response(row), along - x, moves)
        moves = _push(_aside_response(row), aside - y, moves)
        row.along_impulse, row.aside_impulse = along, aside
        change += abs(along - x) + abs(aside - y)
    row.normal_impulse = up
    return moves, change


@compiled
def _push_pair(
    states: Floats, work: Workspace, k: int, responses: tuple[Moves, Moves], impulse: float
) -> None:
    """Give both parts of a pair's contact an impulse against each other, by their responses (2, 6)."""
    first, second = states[work.owners[k]], states[work.owners[k + 1]]
    set_moves(first, _push(responses[0], impulse, moves_of(first)))
    set_moves(second, _push(responses[1], -impulse, moves_of(second)))


@compiled
def _relax_pair(states: Floats, work: Workspace, k: int, has_friction: bool) -> float:
    """One step on a contact of two parts; the change of its impulse."""
    row, other = work.pairs[k], work.pairs[k + 1]
    x, y, z = row.along_impulse, row.aside_impulse, row.normal_impulse
    up = max(z + row.normal_mass * (row.target_speed - pair_speed(states, work, k)), 0.0)
    _push_pair(states, work, k, (_normal_response(row), _normal_response(other)), up - z)
    row.normal_impulse = up
    if not has_friction or (up == 0.0 and z == 0.0):
        return abs(up - z)
    along, aside = pair_slip(states, work, k)
    along, aside = x - row.along_mass * along, y - row.aside_mass * aside
    along, aside = _within_friction(along, aside, row.friction_ahead * up)
    _push_pair(states, work, k, (_along_response(row), _along_response(other)), along - x)
    _push_pair(states, work, k, (_aside_response(row), _aside_response(other)), aside - y)
    row.along_impulse, row.aside_impulse = along, aside
    return abs(up - z) + abs(along - x) + abs(aside - y)


@outlined
def solve(
    surface: Surface, work: Workspace, states: Floats, island: Island, has_friction: bool, warm: float
) -> None:
    """Find impulses that let each contact of some parts leave at its wanted speed or faster.

    ``states`` (N, 13) [L, sqrt(g L), 1, sqrt(g/L)] are those whose velocities are changed, of the parts that
    stand in ``work.order`` from ``island[0]`` up to, not including, ``island[1]``; ``has_friction`` is with
    friction. It is begun with the impulses in the contacts times ``warm`` [1].
    """
    for m in range(island[0], island[1]):
        n = work.order[m]
        moves = moves_of(states[n])
        for c in range(work.counts[n]):
            row = work.contacts[n, c]
            row.along_impulse *= warm
            row.aside_impulse *= warm
            row.normal_impulse *= warm
            if row.along_impulse != 0.0:
                moves = _push(_along_response(row), row.along_impulse, moves)
            if row.aside_impulse != 0.0:
                moves = _push(_aside_response(row), row.aside_impulse, moves)
            if row.normal_impulse != 0.0:
                moves = _push(_normal_response(row), row.normal_impulse, moves)
        set_moves(states[n], moves)
    pairs = work.pair_rows[0]
    for k in range(0, pairs, 2):
        row, other = work.pairs[k], work.pairs[k + 1]
        row.along_impulse *= warm
        row.aside_impulse *= warm
        row.normal_impulse *= warm
        _push_pair(states, work, k, (_along_response(row), _along_response(other)), row.along_impulse)
        _push_pair(states, work, k, (_aside_response(row), _aside_response(other)), row.aside_impulse)
        _push_pair(states, work, k, (_normal_response(row), _normal_response(other)), row.normal_impulse)
    for _ in range(surface.sweeps):
        change = size = 0.0
        for m in range(island[0], island[1]):
            n, own, normal = work.order[m], 0.0, 0.0
            moves = moves_of(states[n])
            for c in range(work.counts[n]):
                moves, more = _relax(work.contacts[n, c], has_friction, moves)
                own += more
                normal += work.contacts[n, c].normal_impulse
            set_moves(states[n], moves)
            change, size = change + own, size + normal
        for k in range(0, pairs, 2):
            change += _relax_pair(states, work, k, has_friction)
            size += work.pairs[k].normal_impulse
        if change <= surface.tolerance * size:
            break
