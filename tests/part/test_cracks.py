"""Cracks between facets: joined where that closes the surface, refused with their width; thin walls stay."""

import re

import numpy as np
import part_files as files
import pytest
import shapely
import trimesh
from readings import BOX, loaded, mm3, refused

from feederscrew.errors import FeederError

SIZE = 10.0  # [mm] of the parts here


def extruded(outline, height):
    """(F, 3, 3) triangles of a prism over an outline."""
    return np.array(trimesh.creation.extrude_polygon(shapely.Polygon(outline), height).triangles)


L_SHAPE = extruded([[0, 0], [10, 0], [10, 2], [2, 2], [2, 6], [0, 6]], 4.0)  # 112 mm3


def cracked(triangles, most, rng, by_plane=False):
    """An OBJ of the triangles with corners off by up to ``most``, each facet or each plane by itself."""
    if not by_plane:
        return files.obj(triangles + rng.uniform(-most, most, triangles.shape))
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    planes = np.unique(normals.round(6), axis=0, return_inverse=True)[1].ravel()
    return files.obj(triangles + rng.uniform(-most, most, (planes.max() + 1, 3))[planes][:, None])


def width(text):
    """Width [mm] that a line names."""
    return float(re.findall(r"up to ([\d.e+-]+) mm wide", text)[0])


@pytest.mark.parametrize("by_plane", [False, True], ids=["facets", "faces"])
@pytest.mark.parametrize("most", [1e-5, 5e-5, 2e-4])
def test_cracks_are_joined_with_their_width(rng, most, by_plane):
    part = loaded(cracked(L_SHAPE, most, rng, by_plane))
    assert mm3(part) == pytest.approx(112.0, abs=120.0 * most)
    assert not part.open_surface
    text = next(text for text in part.warnings if "crack" in text)
    assert "joined" in text
    assert 0.2 * most < width(text) < 4.0 * most  # two corners are at most 2 sqrt(3) apart


def test_cracks_along_which_edges_meet_several_shorter_ones(rng):
    x, y = np.meshgrid(np.linspace(0, 10, 4), np.linspace(0, 20, 6), indexing="ij")
    grid = np.stack([x, y, np.full_like(x, 30.0)], axis=-1) + rng.uniform(-3e-4, 3e-4, (*x.shape, 3))
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    top = np.concatenate([np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])
    part = loaded(files.obj(np.concatenate([BOX[[k for k in range(12) if k not in (1, 7)]], top])))
    assert mm3(part) == pytest.approx(6000.0, rel=1e-4)
    assert any("crack" in text and "4 edges" in text for text in part.warnings)


def test_wide_cracks_are_refused_with_their_width_and_joined_if_asked(rng):
    data = cracked(L_SHAPE, 5e-3, rng)
    line = refused(data)
    assert 2e-3 < width(line) < 2e-2  # not the 13 mm across a facet's outline
    assert "allow_open" in line
    part = loaded(data, allow_open=True)
    assert mm3(part) == pytest.approx(112.0, rel=1e-2)
    assert part.open_surface
    assert any("crack" in text for text in part.warnings)


def test_holes_beside_cracks_are_filled_after_these_are_joined(rng):
    data = cracked(BOX[1:], 1e-4, rng)
    assert "open" in refused(data)
    assert mm3(loaded(data, allow_open=True)) == pytest.approx(6000.0, rel=1e-3)  # it gave 1e-4 mm3


def test_no_thin_wall_slot_or_plate_is_joined_away(rng):
    outcomes = {"taken": 0, "refused": 0}
    for k in range(36):
        thin, most = SIZE * 10.0 ** rng.uniform(-4.7, -3.0), SIZE * 10.0 ** rng.uniform(-6.5, -3.7)
        fin = [[0, 0], [10, 0], [10, 2], [5 + thin, 2], [5 + thin, 4], [5, 4], [5, 2], [0, 2]]
        slot = [[0, 0], [10, 0], [10, 2], [5 + thin, 2], [5 + thin, 1], [5, 1], [5, 2], [0, 2]]
        plate = [[0, 0], [10, 0], [10, thin], [0, thin]]
        outline = (fin, slot, plate)[k % 3]
        data = cracked(extruded(outline, 6.0), most, rng)
        for allow_open in (False, True):
            try:
                part = loaded(data, allow_open=allow_open)
            except FeederError:
                outcomes["refused"] += 1
                continue
            outcomes["taken"] += 1
            assert len(part.vertices) >= 2 * len(outline)  # none of the corners on either side is lost
            slack = 0.25 if allow_open else 0.06
            assert mm3(part) == pytest.approx(6.0 * shapely.Polygon(outline).area, rel=slack), (k, thin, most)
    assert min(outcomes.values()) > 12


def test_loose_facets_are_refused_and_no_line_speaks_of_an_option_that_was_not_given(rng):
    for k in range(15):
        data = cracked(L_SHAPE, SIZE * 10.0 ** rng.uniform(-2.3, -0.5), rng)
        for allow_open in (False, True):
            try:
                part = loaded(data, allow_open=allow_open)
            except FeederError as error:
                assert "centre" not in str(error), k
                assert not (allow_open and "allow_open" in str(error)), k
            else:
                assert part.volume > 1e-3 * part.hull.volume, k


def test_a_tiny_share_of_the_hull_is_no_solid():
    wires = [files.box((100.0, 1e-2, 1e-2)), files.box((1e-2, 100.0, 1e-2)), files.box((1e-2, 1e-2, 100.0))]
    assert "convex hull" in refused(files.obj(np.concatenate(wires)), allow_open=True)


@pytest.mark.parametrize("count", [1, 3])
def test_stray_facets_on_a_line_are_left_out(count):
    stray = [[[0, 0, 0], [5, 0, 0], [10, 0, 0]], [[0, 0, 0], [0, 4, 0], [0, 20, 0]]]
    loose = [[[40.0, 0, 0], [41, 1, 0], [42, 2, 0]]]
    part = loaded(files.obj(np.concatenate([BOX, (stray + loose)[:count]])))
    assert (mm3(part), len(part.faces)) == (pytest.approx(6000.0), 12)
    assert np.ptp(part.vertices, axis=0) * 1e3 == pytest.approx([10.0, 20.0, 30.0])
    assert [text for text in part.warnings if "left out" in text]
