"""Compiled steps of parts that may touch each other, one or many: an island of them at a time.

Over a step gravity, the drive and jets change velocities, and each contact is told how it shall leave it: as
fast as it closes its gap, or, of one that strikes, as Newton's law of restitution says.
"""

import math

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel import floor_motion as floors
from feederscrew.arrivals.kernel.body import VX, W, X, Y, moves_of
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.base.arrays import Floats
from feederscrew.base.geometry.compiled import compiled, outlined
from feederscrew.trials.kernel import contact, jets
from feederscrew.trials.kernel.contact import along_speed, aside_speed, normal_speed, pair_slip, pair_speed
from feederscrew.trials.kernel.plate_views import axis_of, wall_of
from feederscrew.trials.kernel.workspace import Island, Surface, TrueSolid, Workspace

LEAST_REACH = 2e-3  # how far ahead contacts are looked for, more than the way of two steps
FREE_WORK = 1e-9  # work against gravity and the drive that is rounding, of one part alone, and ...
FREE_PAIR_WORK = 2e-6  # ... of parts that push each other, by impulses that are not wholly converged
DEPTH_LEFT = 3e-4  # depth that is left
DEEP_CONTACT = 6e-4  # depth from which on it is made less
LIFT_SHARE = 0.1  # of a greater depth, taken back in a step
MAX_LIFT = 0.01  # of so much at most
AT_ONCE = 0.02  # of a step: what happens sooner happens at its start
UPWARD = 0.5  # [1] of the normal: a part that is held so by another is carried
# columns of the strains
BEHIND = 0
BELOW = 1
# columns of the depths
IN_TRACK = 0
IN_PART = 1
STILL_SLIP = 1e-5  # speed along a contact below which it sticks while static friction holds
IMPACT_GAP = 2e-5  # [1] of the unit of length: what is further off takes no part in an impact
SPEED_ROUNDING = 1e-9  # speed that is rounding


@compiled
def reach_ahead(solid: TrueSolid, state: Floats, dt: float) -> float:
    """Return how far ahead [L] contacts of a part with a state (13,) are looked for in a step [sqrt(L/g)]."""
    u, v, w = body.velocity(state)
    return LEAST_REACH + 2.0 * dt * (math.sqrt(u**2 + v**2 + w**2) + solid.radius * body.rate(state))


@compiled
def place_along_wall(surface: Surface, state: Floats) -> float:
    """Return how far along the wall [L] the centre of mass of a state (13,) is."""
    along = surface.radius * math.atan2(state[X], surface.radius - state[Y])
    half = math.pi * surface.radius
    if along > surface.middle + half:
        return along - 2.0 * half
    return along + 2.0 * half if along < surface.middle - half else along


@compiled
def begin_step(surface: Surface, work: Workspace, island: Island) -> None:
    """Note where and how an island's parts are as a step begins, and how the track leans there."""
    for m in range(island[0], island[1]):
        n = work.order[m]
        state = work.states[n]
        body.keep(state, work.starts[n])
        body.rotation(state, work.turns[n])
        x, y = state[X], surface.radius - state[Y]
        off = math.sqrt(x * x + y * y)
        work.tangents[n, 0], work.tangents[n, 1] = y / off, x / off
        # how the track leans there; what is near a wall that turns is looked at anew
        slopes, last, leans = surface.slopes, len(surface.slopes) - 1, work.leans[n]
        place = place_along_wall(surface, state) if last else 0.0
        row, before = 0, wall_of(leans)[0]
        while row < last and place > slopes[row, 0]:
            row += 1
        between = row > 0 and place <= slopes[row, 0]
        share = (place - slopes[row - 1, 0]) / (slopes[row, 0] - slopes[row - 1, 0]) if between else 0.0
        for k in range(len(leans)):
            leans[k] = slopes[row, 1 + k]
            if between:
                leans[k] = slopes[row - 1, 1 + k] + share * (slopes[row, 1 + k] - slopes[row - 1, 1 + k])
        if wall_of(leans)[0] != before:
            work.list_states[n].reach = -1.0


@compiled
def _add_forces(
    surface: Surface, solid: TrueSolid, floor: Floor, work: Workspace, n: int, time: float, dt: float
) -> None:
    """Write the changes (6,) [sqrt(g L), sqrt(g/L)] of velocity and rates by gravity, drive and jets."""
    changes, state, turn = work.changes[n], work.starts[n], work.turns[n]
    c, s = work.tangents[n, 0], work.tangents[n, 1]
    x, y = state[X], surface.radius - state[Y]
    forth, rise = floors.quickening(floor, time, dt)
    leans = work.leans[n]
    (ahead, inwards, down), (lean, up) = (leans[0], leans[1], leans[2]), axis_of(leans)
    along = dt * ahead - forth * math.sqrt(x * x + y * y) / surface.radius
    across = dt * inwards - rise * lean
    changes[0] = c * along - s * across
    changes[1] = s * along + c * across
    changes[2] = dt * down - rise * up
    spin = forth / surface.radius
    for k in range(3):
        changes[3 + k] = -spin * (lean * (c * turn[3 + k] - s * turn[k]) + up * turn[6 + k])
    if len(surface.jets):
        jets.blow(surface, solid, floor, work, n, time, dt)


@compiled
def _want_no_strike(surface: Surface, work: Workspace, n: int, dt: float) -> tuple[float, float]:
    """Say how each contact of a part shall leave a step in which none strikes, and with which friction.

    Returned are the depth [L] of the deepest and the share [1] of the step after which the first strikes,
    infinite where none does.
    """
    deepest, share = 0.0, math.inf
    moves = moves_of(work.starts[n])
    for m in range(work.counts[n]):
        row = work.contacts[n, m]
        gap, fall = row.gap, normal_speed(moves, row)
        deepest = min(deepest, gap)
        row.target_speed = -max(gap, 0.0) / dt - max(fall, 0.0)
        share = min(share, _strikes_after(surface, gap, fall, dt))
        work.depths[n, IN_TRACK] = max(work.depths[n, IN_TRACK], -gap)
        if math.isnan(row.friction):
            slides = math.hypot(along_speed(moves, row), aside_speed(moves, row)) > STILL_SLIP
            row.friction_ahead = surface.friction[int(slides)]
            row.friction_back = surface.friction[2 + int(slides)]
        else:
            row.friction_ahead = row.friction_back = row.friction
    return deepest, share


@compiled
def _strikes_after(surface: Surface, gap: float, fall: float, dt: float) -> float:
    """Share of a step after which a contact strikes; infinite where it does not."""
    if fall < -surface.threshold and gap + fall * dt < -SPEED_ROUNDING * dt:
        return max(gap, 0.0) / (-fall * dt)
    return math.inf


@compiled
def _want_rebound(surface: Surface, work: Workspace, n: int, dt: float, start_share: float) -> None:
    """Say how contacts of a part shall leave an impact that begins a step: those that strike at once rebound.

    What is further off than IMPACT_GAP, and strikes later than a share ``start_share`` of the step or not at
    all, takes no part in the impact. The corners of a part that comes down a little out of level so strike
    one after the other, each with the speed that the one before has left it, and the part goes on rocking.
    """
    for m in range(work.counts[n]):
        row = work.contacts[n, m]
        fall = normal_speed(moves_of(work.starts[n]), row)
        if _strikes_after(surface, row.gap, fall, dt) <= start_share:
            gained = normal_speed(moves_of(work.states[n]), row) - fall
            row.target_speed = max(gained - surface.restitution * fall, 0.0)
        elif row.gap > IMPACT_GAP:
            row.target_speed = -math.inf


@compiled
def _stand_share(work: Workspace, n: int) -> float:
    """Return the share [1] of a step after which sliding comes to a stand, if it does; else 1.

    Of the contact that slides fastest. What friction did less than its most against the sliding is what it
    did after the stand: without that the contact would have gone on to slide back so much faster.
    """
    first, before = -1, STILL_SLIP
    begun, ended = moves_of(work.starts[n]), moves_of(work.states[n])
    for m in range(work.counts[n]):
        row = work.contacts[n, m]
        if row.normal_impulse > 0.0:
            quick = math.hypot(along_speed(begun, row), aside_speed(begun, row))
            if quick > before:
                first, before = m, quick
    if first < 0:
        return 1.0
    row = work.contacts[n, first]
    a, b = along_speed(begun, row) / before, aside_speed(begun, row) / before
    after = a * along_speed(ended, row) + b * aside_speed(ended, row)
    if after > STILL_SLIP:
        return 1.0
    spared = 0.0
    for m in range(work.counts[n]):
        row = work.contacts[n, m]
        most = row.friction_back if a < 0.0 else row.friction_ahead
        spared += most * row.normal_impulse + a * row.along_impulse + b * row.aside_impulse
    return before / (before - after + max(spared, 0.0))


@compiled
def _moving_energy(solid: TrueSolid, work: Workspace, island: Island) -> float:
    whole = 0.0
    for m in range(island[0], island[1]):
        whole += body.moving_energy(work.states[work.order[m]], solid.inertia)
    return whole


@compiled
def _scale_velocities(work: Workspace, island: Island, scale: float) -> None:
    for m in range(island[0], island[1]):
        for k in range(3):
            work.states[work.order[m], VX + k] *= scale
            work.states[work.order[m], W + k] *= scale


@compiled
def limit_energy_to_work(solid: TrueSolid, work: Workspace, island: Island, late_share: float) -> None:
    """Scale all velocities so that a step wins no more than gravity, drive and jets give along its way.

    The way is that of the velocities after the step, by a share ``late_share`` [1], and of those before it.
    """
    moving, begun, by_end = 0.0, 0.0, 0.0
    for m in range(island[0], island[1]):
        n = work.order[m]
        start, end, changes = work.starts[n], work.states[n], work.changes[n]
        moving += body.moving_energy(end, solid.inertia)
        begun += body.moving_energy(start, solid.inertia)
        for k in range(3):
            begun += (1.0 - late_share) * changes[k] * start[VX + k]
            by_end += late_share * changes[k] * end[VX + k]
            begun += 0.5 * changes[3 + k] * solid.inertia[k] * work.free_rates[n, k]
            by_end += 0.5 * changes[3 + k] * solid.inertia[k] * end[W + k]
    if moving > max(begun + by_end, 0.0):
        scale = (by_end + math.sqrt(max(by_end**2 + 4.0 * moving * begun, 0.0))) / (2.0 * moving)
        _scale_velocities(work, island, min(max(scale, 0.0), 1.0))


@compiled
def share_at_once(floor: Floor, dt: float) -> float:
    """Return the share [1] of a step ``dt`` [sqrt(L/g)] in which what happens, happens at its start."""
    return min(AT_ONCE * floor.step / dt, 1.0)


@outlined
def push_island(
    surface: Surface, solid: TrueSolid, floor: Floor, work: Workspace, island: Island, time: float, dt: float
) -> tuple[float, bool, float]:
    """Compute velocities after a step: gravity, drive, jets and contacts.

    Returned are the depth [L] of the deepest contact, whether one strikes, and the share [1] of the step
    after which its course changes.
    """
    deepest, first = 0.0, math.inf
    count, warm, start_share = work.pair_rows[0], 1.0, share_at_once(floor, dt)
    for k in range(0, count, 2):  # how contacts of two parts shall leave it, none striking
        row = work.pairs[k]
        fall = pair_speed(work.starts, work, k)
        deepest = min(deepest, row.gap)
        for m in range(2):
            n = work.owners[k + m]
            work.depths[n, IN_PART] = max(work.depths[n, IN_PART], -row.gap)
        row.target_speed = -max(row.gap, 0.0) / dt
        first = min(first, _strikes_after(surface, row.gap, fall, dt))
        along, aside = pair_slip(work.starts, work, k)
        row.friction_ahead = surface.friction[int(math.hypot(along, aside) > STILL_SLIP)]
    for m in range(island[0], island[1]):
        n = work.order[m]
        state = work.states[n]
        body.turn_freely(state, solid.inertia, dt)
        _add_forces(surface, solid, floor, work, n, time, dt)
        for k in range(3):
            state[VX + k] += work.changes[n, k]
            work.free_rates[n, k] = state[W + k]
            state[W + k] += work.changes[n, 3 + k]
        depth, share = _want_no_strike(surface, work, n, dt)
        deepest, first = min(deepest, depth), min(first, share)
        count += work.counts[n]
        warm = dt / work.last_steps[n] if warm > 0.0 and work.last_steps[n] > 0.0 else 0.0
    strikes, share = first <= 1.0, min(first, 1.0)
    if count == 0 or (strikes and share > start_share):
        return deepest, strikes, share
    if strikes:
        # Of two parts all that strike in the step rebound together: parts of a row meet face to face, and
        # what is nearer by a micrometre shall not turn them.
        for k in range(0, work.pair_rows[0], 2):
            row = work.pairs[k]
            fall = pair_speed(work.starts, work, k)
            if _strikes_after(surface, row.gap, fall, dt) <= 1.0:
                gained = pair_speed(work.states, work, k) - fall
                row.target_speed = max(gained - surface.restitution * fall, 0.0)
        for m in range(island[0], island[1]):
            _want_rebound(surface, work, work.order[m], dt, start_share)
    contact.solve(surface, work, work.states, island, True, 0.0 if strikes else warm)
    share = 1.0
    for m in range(island[0], island[1]):
        n = work.order[m]
        work.last_steps[n] = -1.0 if strikes else dt
        stands = _stand_share(work, n)
        share = min(share, stands) if stands > start_share else share
    limit_energy_to_work(solid, work, island, 1.0 if strikes else 0.5)
    if strikes:
        for m in range(island[0], island[1]):
            n, touches = work.order[m], 1.0  # after which share what took no part in the impact touches
            for k in range(work.counts[n]):
                row = work.contacts[n, k]
                if row.target_speed == -math.inf:
                    distance = -dt * normal_speed(moves_of(work.states[n]), row)
                    touches = row.gap / distance if distance * touches > row.gap else touches
            share = min(share, max(start_share, touches))
    return deepest, strikes, share


@outlined
def lift_island(surface: Surface, solid: TrueSolid, work: Workspace, island: Island, dt: float) -> None:
    """Take a part of what is too deep [L] back, without a speed, as far as the motion can pay for it."""
    push, cost = work.push, 0.0
    for m in range(island[0], island[1]):
        n = work.order[m]
        for k in range(body.STATE):
            push[n, k] = 0.0
        for k in range(work.counts[n]):
            row = work.contacts[n, k]
            row.target_speed = LIFT_SHARE * min(max(-row.gap - DEPTH_LEFT, 0.0), MAX_LIFT)
    for k in range(0, work.pair_rows[0], 2):
        row = work.pairs[k]
        row.target_speed = LIFT_SHARE * min(max(-row.gap - DEPTH_LEFT, 0.0), MAX_LIFT)
    contact.solve(surface, work, push, island, False, 0.0)
    for m in range(island[0], island[1]):
        n = work.order[m]
        for k in range(3):
            cost -= work.changes[n, k] * push[n, VX + k] / dt
    moving, cost = _moving_energy(solid, work, island), max(cost, 0.0)
    free = FREE_PAIR_WORK if work.pair_rows[0] else FREE_WORK
    share = moving / cost if cost > moving + free else 1.0
    for m in range(island[0], island[1]):
        n = work.order[m]
        for k in range(3):
            work.states[n, k] += share * push[n, VX + k]
        body.rotate(work.states[n], push[n, W], push[n, W + 1], push[n, W + 2], share)
    moving, limit = _moving_energy(solid, work, island), max(moving - share * cost, 0.0)
    if moving > limit:
        _scale_velocities(work, island, math.sqrt(limit / moving))


@compiled
def move_island(work: Workspace, island: Island, share: float, dt: float) -> None:
    """Move an island's parts by their velocities, a share of those after the step; keep their impulses."""
    for m in range(island[0], island[1]):
        n = work.order[m]
        work.last_counts[n] = work.counts[n]
        for k in range(work.counts[n]):
            row, impulses = work.contacts[n, k], work.last_impulses[n, k]
            impulses.key, impulses.along = row.key, row.along_impulse
            impulses.aside, impulses.normal = row.aside_impulse, row.normal_impulse
        state, saved = work.states[n], work.starts[n]
        for k in range(3):
            state[k] += dt * (share * state[VX + k] + (1.0 - share) * saved[VX + k])
        p = share * state[W] + (1.0 - share) * saved[W]
        q = share * state[W + 1] + (1.0 - share) * saved[W + 1]
        r = share * state[W + 2] + (1.0 - share) * saved[W + 2]
        body.rotate(state, p, q, r, dt)
    # what parts push each other along the track, and what they carry of each other
    for k in range(0, work.pair_rows[0], 2):
        row, i, j = work.pairs[k], work.owners[k], work.owners[k + 1]
        along = work.tangents[i, 0] * row.normal_x + work.tangents[i, 1] * row.normal_y
        work.strains[i, BEHIND] += max(along, 0.0) * row.normal_impulse
        work.strains[j, BEHIND] += max(-along, 0.0) * row.normal_impulse
        if abs(row.normal_z) > UPWARD:
            work.strains[i if row.normal_z > 0.0 else j, BELOW] += row.normal_impulse


@compiled
def energy_gain(solid: TrueSolid, work: Workspace, island: Island, dt: float) -> float:
    """Return what the energy over mass [g L] gains in a step beyond the work of gravity, drive and jets.

    Both in the bowl's frame, in which the drive is a force.
    """
    gain = 0.0
    for m in range(island[0], island[1]):
        n = work.order[m]
        start, end, changes = work.starts[n], work.states[n], work.changes[n]
        gain += body.moving_energy(end, solid.inertia) - body.moving_energy(start, solid.inertia)
        for k in range(3):
            gain -= changes[k] * (end[k] - start[k]) / dt
            gain -= changes[3 + k] * solid.inertia[k] * 0.5 * (work.free_rates[n, k] + end[W + k])
    return gain
