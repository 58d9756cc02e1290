"""A heap: what cannot hold comes single, what is linked does not."""

import numpy as np
import pytest
import shapely
import shapes
import trimesh
from scipy.spatial import ConvexHull

from feederscrew.arrivals.heap_count import HEAP_COLUMNS, HeapCount
from feederscrew.arrivals.kernel import body
from feederscrew.base.columns import values
from feederscrew.base.geometry.lattice import cells
from feederscrew.bowl import default
from feederscrew.trials import heap as heaps
from feederscrew.trials import part_poses, tangling
from feederscrew.trials.shape import solid_of
from feederscrew.trials.tangling import CELLS_ALONG_PART, PullTest, measure_limb, ring_discs

# [mm] a hook that opens upwards: a long leg, a pocket and a short leg
HOOK = [(0, 0), (12, 0), (12, 6), (10.5, 6), (10.5, 1.5), (1.5, 1.5), (1.5, 30), (0, 30)]
TURNED_OVER = np.diag([1.0, -1.0, -1.0])  # about its x axis
TURNED_ROUND = np.diag([-1.0, -1.0, 1.0])  # in its own plane


def ring(slit):
    """A ring of 1.5 mm wire, 17 mm wide, with a slit of so many degrees; closed without it."""
    if not slit:
        area = shapely.Point(0, 0).buffer(8.5, 8) - shapely.Point(0, 0).buffer(7.0, 8)
        return shapes.part(trimesh.creation.extrude_polygon(area, 1.5))
    turns = np.radians(np.linspace(0.5 * slit, 360.0 - 0.5 * slit, 15))
    arcs = [np.column_stack([r * np.cos(turns), r * np.sin(turns)]) for r in (8.5, 7.0)]
    return shapes.part(shapes.prism(np.concatenate([arcs[0], arcs[1][::-1]]), 1.5))


@pytest.mark.parametrize("body", [shapes.box(10, 10, 10), trimesh.creation.icosphere(1, 5.0)])
def test_convex_parts_come_single(body):
    """A plane lies between two convex bodies: whatever the heap, each comes alone."""
    count = heaps.heap(shapes.part(body))
    assert (count.parts, count.single, count.mixed) == (heaps.PARTS, heaps.PARTS, False)


def test_a_closed_ring_is_never_linked_and_an_open_one_hooks():
    """Rings that start apart cannot link (Gauss's linking number); through a slit of 3 mm they can."""
    washer, hook = heaps.heap(ring(0.0)), heaps.heap(ring(25.0))
    assert washer.mixed and washer.single == washer.parts >= heaps.PARTS - 2
    assert hook.mixed and hook.single < 0.8 * hook.parts
    assert heaps.heap(ring(25.0)).single == hook.single  # the same seed, the same heap


def test_two_linked_rings_reach_into_each_other_and_no_pull_parts_them():
    part = ring(0.0)
    solid, length, _ = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, CELLS_ALONG_PART)
    states = np.zeros((2, body.STATE))
    states[:, body.Q] = 1.0
    axis = int(np.argmin(np.ptp(solid.vertices, axis=0)))  # of the ring
    aside = (axis + 1) % 3
    states[1, aside] = 7.75e-3 / length  # the second's wire passes the middle of the first
    turn = trimesh.transformations.rotation_matrix(0.5 * np.pi, np.eye(3)[aside])[:3, :3]
    states[1, body.Q : body.Q + 4] = part_poses.quaternion(turn)
    assert heaps.reaching_pairs(grid, states, 2.0 * solid.radius) == [(1, 0)]
    pulled = PullTest(solid, grid, length, (0.5, 0.4))
    for direction in np.eye(3):
        assert pulled.pull_apart(turn, states[1, :3], direction) is False
    far = states.copy()
    far[1, axis] = 1.1 * 17e-3 / length
    assert heaps.reaching_pairs(grid, far, 2.0 * solid.radius) == []
    # what a closed ring encloses is its bore, of which the lattice knows the height to a cell
    discs = ring_discs(grid, measure_limb(grid).section)
    bore, cell = np.pi * 7e-3**2 * 1.5e-3, grid.size * length
    assert discs.sum() * cell**3 == pytest.approx(bore, rel=cell / 1.5e-3)


def laid(part, turn, shift):
    """States (2, 13) of a part and of a second one, turned (3, 3) and moved [mm] along the file's axes."""
    _, length, principal = solid_of(part)
    middle = part.centre_of_mass
    states = np.zeros((2, body.STATE))
    states[:, body.Q] = 1.0
    states[1, :3] = principal.T.dot(turn.dot(middle) + 1e-3 * np.array(shift) - middle) / length
    states[1, body.Q : body.Q + 4] = part_poses.quaternion(principal.T.dot(turn).dot(principal))
    return states


def seen_from(part, states, upwards):
    """The states in a bowl in which an axis of the file (3,) points upwards."""
    up = solid_of(part)[2].T.dot(upwards)
    aside = np.cross(up, np.roll(up, 1) + [0.1, 0.2, 0.4])
    aside = aside / np.sqrt((aside**2).sum())
    view, seen = np.array([aside, np.cross(up, aside), up]), states.copy()
    for state in seen:
        turn = view.dot(part_poses.matrix(state))
        state[:3] = view.dot(state[:3])
        state[body.Q : body.Q + 4] = part_poses.quaternion(turn)
    return seen


def test_a_part_that_reaches_into_another_one_way_alone_is_in_no_pair():
    """The end of a long leg in the other's pocket: no place of the other is in the hull beside that leg."""
    part = shapes.part(shapes.prism(HOOK, 6.0))
    solid, _, _ = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, CELLS_ALONG_PART)
    one_way, hooked = laid(part, TURNED_OVER, (5.25, 33, 0)), laid(part, TURNED_ROUND, (18, 7.8, 0))
    assert heaps.reaching_pairs(grid, hooked, 2.0 * solid.radius) == [(1, 0)]
    assert heaps.reaching_pairs(grid, one_way, 2.0 * solid.radius) == []
    assert heaps.reaching_pairs(grid, one_way[::-1], 2.0 * solid.radius) == []
    for states, pairs in ((hooked, [(1, 0)]), (one_way, [])):  # however they lie
        turned = seen_from(part, states, np.array([0.48, 0.6, 0.64]))
        assert heaps.reaching_pairs(grid, turned, 2.0 * solid.radius) == pairs
    for states, inside in ((hooked, (True, True)), (one_way, (True, False))):
        # by corners and hull planes of the drawing, the other's cells left out
        turns = [part_poses.matrix(state) for state in states]
        places = [state[:3] + grid.middles(grid.solid).dot(turn.T) for state, turn in zip(states, turns)]
        planes = ConvexHull(solid.vertices).equations
        found = []
        for own, other in ((1, 0), (0, 1)):
            seen = (places[own] - states[other, :3]).dot(turns[other])
            depth = -(seen.dot(planes[:, :3].T) + planes[:, 3]).max(axis=1)
            found.append(bool(depth.max() > heaps.WITHIN_HULL * grid.size))
        assert tuple(found) == inside


def test_poses_reach_into_each_other_both_ways():
    """Shares of cells within the planes of the other's hull: each way more than what counts as hooking."""
    part = shapes.part(shapes.prism(HOOK, 6.0))
    solid, _, _ = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, CELLS_ALONG_PART)
    own, planes = grid.middles(grid.solid), ConvexHull(solid.vertices).equations

    def share(points):
        return float(((points.dot(planes[:, :3].T) + planes[:, 3]).max(axis=1) < 0.0).mean())

    poses, cell = tangling.poses(grid, np.random.default_rng(5)), 0.01  # [1] what a cell may make of a share
    assert len(poses) == tangling.POSES
    both = [(share(place + own.dot(turn.T)), share((own - place).dot(turn))) for turn, place in poses]
    assert min(map(min, both)) > tangling.LEAST_DEPTH_SHARE - cell
    depths = np.array([min(shares) for shares in both])
    assert (np.diff(depths) < 2.0 * cell).all() and depths[0] > 1.5 * depths[-1]
    assert max(abs(one - other) for one, other in both) > 0.1


@pytest.mark.parametrize("upwards", [(0, 1, 0), (0, -1, 0)])
@pytest.mark.parametrize("turn, shift, holds", [(TURNED_ROUND, (18, 7.8, 0), True),
                                                (TURNED_OVER, (5, 19, 0), False)])  # fmt: skip
def test_the_upper_part_is_pulled_upwards(monkeypatch, turn, shift, holds, upwards):
    """Hooks hold where each bears on the other's pocket; two U that stand in each other come apart.

    The other way round, pulled into each other, hooks come apart and two U meet.
    """
    monkeypatch.setattr(tangling, "SHAKES", 0)
    letter_u = [(0, 0), (12, 0), (12, 16), (10, 16), (10, 2), (2, 2), (2, 16), (0, 16)]
    part = shapes.part(shapes.prism(HOOK if holds else letter_u, 6.0))
    solid, length, _ = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, CELLS_ALONG_PART)
    states = seen_from(part, laid(part, turn, shift), upwards)
    pairs = heaps.reaching_pairs(grid, states, 2.0 * solid.radius)
    assert pairs == [(1, 0)]
    held, unknown = heaps.pull_pairs(PullTest(solid, grid, length, (0.3, 0.25)), states, pairs)
    assert held.tolist() == [holds, holds] and not unknown.any()


def linked(part, one, other):
    """Whether two rings are links of a chain, by Gauss's linking number.

    It counts how often the second's wire crosses the disc of the first: one way less the other.
    """
    solid, length, _ = solid_of(part)
    axis = int(np.argmin(np.ptp(solid.vertices, axis=0)))
    across = [k for k in range(3) if k != axis]
    angles, wire = np.linspace(0.0, 2.0 * np.pi, 721), np.zeros((721, 3))
    wire[:, across] = 7.75e-3 / length * np.column_stack([np.cos(angles), np.sin(angles)])
    line = other[:3] + wire.dot(part_poses.matrix(other).T)
    seen = (line - one[:3]).dot(part_poses.matrix(one))
    above = seen[:, axis] > 0.0
    near = np.sqrt((seen[:, across] ** 2).sum(axis=1)) < 7.75e-3 / length
    crossings = (above[1:].astype(int) - above[:-1]) * (near[1:] & near[:-1])
    return crossings.sum() != 0


def test_closed_rings_are_laid_beside_each_other_and_never_linked():
    part = ring(0.0)
    solid, length, _ = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, 48)
    bucket = heaps.make_bucket(solid, grid, length, default())
    discs, none = ring_discs(grid, measure_limb(grid).section), np.zeros(grid.solid.shape, bool)
    links = []
    for enclosed in (discs, none):
        states = heaps.lay_heap(bucket, True, enclosed, np.random.default_rng(2))
        pairs = [(n, m) for n in range(len(states)) for m in range(n)]
        apart = [np.sqrt(((states[n, :3] - states[m, :3]) ** 2).sum()) for n, m in pairs]
        links.append(sum(linked(part, states[n], states[m]) for n, m in pairs))
        # so near that one reaches into the other's way
        assert min(apart) < 0.5 * bucket.size
    assert links[0] == 0 < links[1]


def test_the_count_has_wilsons_interval():
    """14 of 16: 63.98 to 96.50 % (Wilson 1927, by hand)."""
    count = HeapCount(16, 14, True, 3)
    assert (count.low, count.high) == pytest.approx((0.6398, 0.9650), abs=1e-4)
    row = values(HEAP_COLUMNS, count)
    assert row["single_share"] == 0.875 and row["seed"] == 3
    assert count.words.startswith("14 of 16 parts of a heap come single (64 to 97 %")
