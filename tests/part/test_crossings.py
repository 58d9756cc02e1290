"""Surfaces that pass through themselves are found."""

import re
from pathlib import Path

import numpy as np
import part_files as files
import pytest

from feederscrew.part import crossings, load, mass, topology

PARTS = Path(__file__).parents[2] / "parts"


def twisted(turn):
    """A box of 10 mm whose upper face is turned, its corners in (8, 3)."""
    across = 5.0 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    c, s = np.cos(turn), np.sin(turn)
    upper = np.einsum("kx,yx->ky", across, np.array([[c, -s], [s, c]]))
    return np.column_stack([np.concatenate([across, upper]), np.repeat([0.0, 10.0], 4)])


def prism(corners):
    """Facets of a box of eight corners, (12, 3, 3)."""
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    quads = [(3, 2, 1, 0), (4, 5, 6, 7), *sides]
    return corners[np.array([(a, b, c) for a, b, c, _ in quads] + [(a, c, d) for a, _, c, d in quads])]


def spiked():
    """A box of 10 mm, the middle of its upper face drawn through the lower one."""
    box, tip = files.box((10, 10, 10)), np.array([5.0, 5.0, -4.0])
    upper = (box[:, :, 2] == 10.0).all(axis=1)
    ring = np.array([[0, 0, 10], [10, 0, 10], [10, 10, 10], [0, 10, 10.0]])
    return np.concatenate([box[~upper], np.stack([ring, np.roll(ring, -1, axis=0), [tip] * 4], axis=1)])


SWAPPED = twisted(0.0)[[0, 1, 2, 3, 5, 4, 6, 7]]  # two corners of the upper face in each other's place
CROSSING = r"the surface passes through itself: \d+ pairs? of facets cut each other, the deepest by .* mm at"


@pytest.mark.parametrize(
    "triangles", [prism(twisted(2.5)), prism(SWAPPED), spiked()], ids=["twisted", "swapped", "spiked"]
)
def test_a_surface_that_passes_through_itself_is_refused(tmp_path, triangles):
    path = files.written(tmp_path, triangles)
    assert re.match(f"{CROSSING}|encloses no volume", files.refused(path))


def test_a_box_turned_by_little_does_not_pass_through_itself(tmp_path):
    assert load(files.written(tmp_path, prism(twisted(0.6)))).warnings == ()


def test_crossings_do_not_hang_on_place_and_turn(rng):
    corners = spiked().reshape(-1, 3)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    places = np.einsum("nx,yx->ny", corners, turn) + rng.normal(size=3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    for vertices in (corners, places):
        joined = topology.weld_corners(np.round(vertices, 9), faces)
        assert len(crossings.find_crossings(*joined, 1e-6).pairs) == 4
    assert crossings.find_crossings(*joined, 1e-6).depths == pytest.approx([10.0 * 4.0 / 14.0] * 4, abs=1e-6)


def double_cone(turns, corners=7):
    """Two cones over one ring that goes round several times; its corners and facets."""
    angle = 2.0 * np.pi * turns * np.arange(corners) / corners
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(corners)])
    k, after = np.arange(corners), np.roll(np.arange(corners), -1)
    upper = np.column_stack([k, after, np.full(corners, corners)])
    lower = np.column_stack([after, k, np.full(corners, corners + 1)])
    return np.concatenate([ring, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]]), np.concatenate([upper, lower])


def unseen(vertices, faces):
    """Facets that the axis of what they enclose does not see alone."""
    return crossings.unseen_facets(vertices, faces, mass.integrate_solid(vertices[faces]))


def test_what_is_seen_whole_from_its_axis_is_not_searched(rng):
    """Facets that all face away from their feet cut each other only if the surface goes round them twice."""
    once, faces = double_cone(1)
    for vertices in (once, once * rng.uniform(1.0, 1.3, (len(once), 1))):
        assert len(unseen(vertices, faces)) == 0
        assert len(crossings.find_crossings(vertices, faces, 1e-9).pairs) == 0
    twice, _ = double_cone(2)
    assert len(crossings.find_crossings(twice, faces[unseen(twice, faces)], 1e-9).pairs) > 0


def tube(turns, rises, thick, along=24, around=5):
    """A tube about a curve that winds about two axes; its corners and facets."""
    s = 2.0 * np.pi * np.arange(along) / along
    out, turn = 2.0 + np.cos(rises * s), 2.0 * np.pi * np.arange(around) / around
    curve = np.column_stack([out * np.cos(turns * s), out * np.sin(turns * s), np.sin(rises * s)])
    ahead = np.roll(curve, -1, axis=0) - np.roll(curve, 1, axis=0)
    u = np.cross(ahead, [0.1, 0.2, 1.0])
    v = np.cross(ahead, u)
    u, v = (side / np.linalg.norm(side, axis=1)[:, None] for side in (u, v))
    rings = curve[:, None] + thick * (np.cos(turn)[:, None] * u[:, None] + np.sin(turn)[:, None] * v[:, None])
    i, j = np.divmod(np.arange(along * around), around)
    a, b, c, d = ((i + m) % along * around + (j + n) % around for m, n in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return rings.reshape(-1, 3), np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


@pytest.mark.parametrize("name", [path.name for path in sorted(PARTS.glob("*.stl"))])
def test_parts_do_not_pass_through_themselves(name):
    assert not any("through itself" in told for told in load(PARTS / name).warnings)
