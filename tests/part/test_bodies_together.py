"""Several bodies as one part: each turned by itself, united where they overlap; moments stay possible."""

import numpy as np
import part_files as files
import pytest
import trimesh

from feederscrew.errors import FeederError
from feederscrew.part import load, mass

LARGE, SMALL = files.box((10, 10, 10)), files.box((4, 4, 4))


def together(folder, *bodies):
    path = files.written(folder, files.obj(np.concatenate(bodies)), "bodies.obj")
    return load(path, allow_open=True)


def mm3(part):
    return part.volume * 1e9


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("second", [False, True])
def test_bodies_apart_are_added_however_they_face(tmp_path, first, second):
    bodies = LARGE, SMALL + [20, 0, 0]
    turned = [files.inside_out(body) if turn else body for body, turn in zip(bodies, (first, second))]
    part = together(tmp_path, *turned)
    assert mm3(part) == pytest.approx(1064.0)  # it was 936 where one is inside out
    assert part.centre_of_mass[0] * 1e3 == pytest.approx((1000 * 5 + 64 * 22) / 1064)
    assert any("reversed" in text for text in part.warnings) == (first != second)


def test_cavities_stay_cavities_in_each_body(tmp_path):
    cavity = files.inside_out(SMALL + 3.0)
    inner = files.box((1, 1, 1), (4.5, 4.5, 4.5))
    bodies = LARGE, cavity, files.inside_out(np.concatenate([LARGE, cavity]) + [20, 0, 0])
    assert mm3(together(tmp_path, *bodies)) == pytest.approx(2 * (1000 - 64))
    assert mm3(together(tmp_path, *bodies, inner)) == pytest.approx(2 * (1000 - 64) + 1)


@pytest.mark.parametrize("offset", [(8, 3, 3), (8, 0, 0), (6, 6, 6)])
def test_bodies_that_overlap_are_united(tmp_path, offset):
    overlap = float(np.prod(np.clip(10.0 - np.array(offset), 0.0, 4.0)))
    part = together(tmp_path, LARGE, SMALL + np.array(offset))
    assert mm3(part) == pytest.approx(1064.0 - overlap)  # it was 1064, without a word
    assert any("overlap" in text for text in part.warnings)
    edges = np.sort(part.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] % 2 == 0).all()  # closed


def test_three_bodies_in_a_chain_are_united_with_their_inertia(tmp_path):
    bodies = [files.box((4, 4, 4), (3 * k, 0, 0)) for k in range(3)]
    part = together(tmp_path, *bodies)
    whole = load(files.written(tmp_path, files.box((10, 4, 4))))
    assert mm3(part) == pytest.approx(160.0)
    np.testing.assert_allclose(part.inertia, whole.inertia, atol=1e-9 * whole.inertia.max())


def test_a_body_within_another_counts_once(tmp_path):
    part = together(tmp_path, LARGE, SMALL + 3.0)
    assert mm3(part) == pytest.approx(1000.0)  # it was 1064
    assert any("cavity" in text for text in part.warnings)


def test_a_cavity_that_crosses_a_surface_is_refused(tmp_path):
    triangles = np.concatenate([LARGE, files.inside_out(SMALL + [8, 3, 3])])
    line = files.refused(files.written(tmp_path, triangles), allow_open=True)
    assert "crosses" in line
    assert "allow_open" not in line


def damaged(triangles, rng):
    """Triangles after one to three damages: lost, turned, moved, repeated, shaken or swapped corners."""
    triangles = triangles.copy()
    for _ in range(rng.integers(1, 4)):
        count = max(1, int(len(triangles) * 10.0 ** rng.uniform(-2.0, -0.4)))
        some = rng.integers(len(triangles), size=count)
        far = np.ptp(triangles) * 10.0 ** rng.uniform(-6.0, -0.2)
        kind = rng.integers(6)
        if kind == 0:
            triangles = np.delete(triangles, some, axis=0)
        elif kind == 1:
            triangles[some] = triangles[some][:, ::-1]
        elif kind == 2:
            triangles[some, rng.integers(3)] += rng.normal(size=(count, 3)) * far
        elif kind == 3:
            triangles = np.concatenate([triangles, triangles[some]])
        elif kind == 4:
            triangles = triangles + rng.normal(size=triangles.shape) * far
        else:
            triangles[some, 0] = triangles[some[::-1], 1]
    return triangles


def test_no_damaged_mesh_gives_moments_that_no_body_has(tmp_path):
    rng = np.random.default_rng(43)
    tube = np.array(trimesh.creation.annulus(3.0, 5.0, 8.0, sections=12).triangles)
    parts = [LARGE, tube, np.concatenate([tube, SMALL + 2.0]), np.concatenate([LARGE, tube + [12, 0, 0]])]
    taken = 0
    for k in range(80):
        path = files.written(tmp_path, files.obj(damaged(parts[k % 4], rng)), "damaged.obj")
        try:
            part = load(path, allow_open=True)
        except FeederError as error:
            assert len(error.lines) == 1
            continue
        taken += 1
        low, middle, high = mass.principal_inertia(part.inertia)[0]
        assert low > 0.0, k
        assert low + middle >= high * (1.0 - 1e-6), k
        assert 0.0 < part.volume <= part.hull.volume * (1.0 + 1e-5), k
    assert taken > 13
