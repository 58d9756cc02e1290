"""The awkward case is as awkward as it says."""

import awkward
import numpy as np


def test_nothing_maps_the_body_onto_itself():
    """Three different principal moments leave half turns and their mirrors; skewness changes under all."""
    mesh = awkward.mesh()
    moments, axes = np.linalg.eigh(mesh.moment_inertia)
    assert (np.diff(moments) > 0.05 * moments[-1]).all()
    points = (mesh.triangles_center - mesh.center_mass) @ axes
    skewness = (mesh.area_faces[:, None] * points**3).sum(axis=0) / mesh.area / mesh.scale**3
    mixed = (mesh.area_faces * points.prod(axis=1)).sum() / mesh.area / mesh.scale**3
    assert (np.abs(skewness) > 1e-4).all() or abs(mixed) > 1e-4
    assert np.count_nonzero(np.abs([*skewness, mixed]) > 1e-4) >= 3


def test_the_bowl_tells_every_direction_and_coefficient_from_the_others():
    bowl = awkward.bowl()
    values = [bowl.friction.static, bowl.friction.kinetic, *bowl.friction.backward, bowl.friction.wall]
    assert len(set(values)) == 5
    assert bowl.track.bank > 0.0 and bowl.track.climb > 0.0 and bowl.track.radius < 0.2
    one = awkward.lying()[0]
    assert awkward.off_the_wall(one).distance > one.distance and one.shift > 0.0
