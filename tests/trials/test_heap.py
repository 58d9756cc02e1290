"""A heap: what cannot hold comes single, what is linked does not."""

import numpy as np
import pytest
import shapely
import shapes
import trimesh

from feederscrew.arrivals.heap_count import HEAP_COLUMNS, HeapCount
from feederscrew.arrivals.kernel import body
from feederscrew.base.columns import values
from feederscrew.base.geometry.lattice import cells
from feederscrew.trials import heap as heaps
from feederscrew.trials import part_poses
from feederscrew.trials.shape import solid_of
from feederscrew.trials.tangling import CELLS_ALONG_PART, PullTest, measure_limb, ring_discs


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


def test_the_count_has_wilsons_interval():
    """14 of 16: 63.98 to 96.50 % (Wilson 1927, by hand)."""
    count = HeapCount(16, 14, True, 3)
    assert (count.low, count.high) == pytest.approx((0.6398, 0.9650), abs=1e-4)
    row = values(HEAP_COLUMNS, count)
    assert row["single_share"] == 0.875 and row["seed"] == 3
    assert count.words.startswith("14 of 16 parts of a heap come single (64 to 97 %")
