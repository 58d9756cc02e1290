"""Surfaces that are closed by the places of their corners alone, as readers of STL see them."""

from dataclasses import replace

import numpy as np
import pytest
from manifold3d import Manifold
from test_solid import TRACK, closed, planned

from feederscrew.solidbowl.closed_body import body
from feederscrew.solidbowl.plan import SolidOptions
from feederscrew.tooling import whole_surface
from feederscrew.tooling.devices.kinds import make_device


class Surface:
    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces


def cube(*at):
    return Manifold.cube((10.0, 10.0, 10.0)).translate(at)


@pytest.mark.parametrize(
    ("other", "volume"),
    [
        (cube(10.0, 10.0, 0.0), 2000.0),  # in an edge
        (cube(10.0, 10.0, 5.0), 2000.0),  # in half an edge
        (cube(10.0, 10.0, 10.0), 2000.0),  # in a corner
        (cube(10.00005, 10.00005, 0.0), 2000.0),  # almost
        (cube(10.0, 0.0, 0.0), 2000.0),  # in a face: one body
    ],
)
def test_bodies_that_touch_share_no_edge(other, volume):
    surface = Surface(*whole_surface.mesh(cube(0.0, 0.0, 0.0) + other))
    assert closed(surface) == pytest.approx(volume, rel=1e-3)


def test_a_film_of_air_within_a_body_is_filled():
    film = Manifold.cube((1.0, 1.0, 1e-2)).translate((5.0, 5.0, 5.0))
    vertices, faces = whole_surface.mesh(cube(0.0, 0.0, 0.0) - film)
    assert (len(vertices), len(faces)) == (8, 12)


def test_a_corner_near_zero_is_one():
    """Single precision tells 1e-8 mm from 0, and a reader does not."""
    hollow = cube(0.0, 0.0, 0.0) - cube(5.0, 1.5e-8, 5.0)
    assert closed(Surface(*whole_surface.mesh(hollow))) == pytest.approx(750.0, rel=1e-4)


@pytest.mark.parametrize("seed", range(2))
def test_rails_behind_a_narrowed_track_of_the_same_edge(seed):
    """The narrowed track ends where the slot does: their faces meet in an edge of the outlet's side."""
    rng = np.random.default_rng(seed)
    radius, width = float(rng.uniform(0.13, 0.17)), round(float(rng.uniform(24e-3, 28e-3)), 4)
    limit, left = round(0.4 * width, 4), bool(rng.integers(2))
    rails = make_device("rails", "b", span=(round(0.1 * width, 4), limit))
    track = replace(TRACK, radius=radius, width=width)
    chain = (make_device("narrowed_track", "b", limit=limit, text="x"), rails)
    assert closed(body(planned(chain, track=track, asked=SolidOptions(left=left)))) > 0.0
