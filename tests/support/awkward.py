"""One awkward case for everybody: a curved, banked track, friction that differs each way, a skew body.

What is straight, level, even or symmetric hides wrong signs and swapped values; nothing here is.
"""

import functools

import numpy as np
import shapes

from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import add_travel, orientations

SETTINGS = (
    "track.radius=150 mm", "track.bank=3 deg", "track.climb=2 deg", "friction.static=0.5",
    "friction.kinetic=0.42", "friction.static_backward=0.62", "friction.kinetic_backward=0.55",
    "friction.wall=0.27",
)  # fmt: skip


def bowl(*more):
    """The bowl, with further settings."""
    return bowls.read(None, (*SETTINGS, *more))


def plain_bowl(*more):
    """The same with one friction both ways: what tips is followed on such a bowl only."""
    return bowls.read(None, (*(one for one in SETTINGS if "backward" not in one), *more))


def mesh():
    """An angle of unequal legs, sheared along its length: no turn and no mirror maps it onto itself [mm]."""
    made = shapes.prism(shapes.l_profile(17.0, 11.0, 3.0), 26.0)
    made.vertices = made.vertices + np.outer(made.vertices[:, 2], (0.21, 0.13, 0.0))
    return made


@functools.cache
def part():
    """The body as a part of steel, and its aspects."""
    made = shapes.part(mesh(), "skew")
    return made, find(made)


@functools.cache
def lying(*more):
    """Every orientation of the body on the bowl's track, knowing how it travels."""
    made, found = part()
    own = bowl(*more)
    return add_travel(orientations(made, found, own.track), own)


def second_moments(one):
    """Mean (3, 3) [m2] of the products of places in track axes, from the centre of mass, over tetrahedra."""
    mesh = one.posture.solid
    corners = mesh.vertices[mesh.faces]
    volumes = np.linalg.det(corners)
    values = corners - mesh.centre_of_mass
    apex = -mesh.centre_of_mass[None, None]
    whole = np.concatenate([np.broadcast_to(apex, (len(values), 1, 3)), values], axis=1)
    seen = whole @ one.axes.T
    total = seen.sum(axis=1)
    squares = np.einsum("ni,nj->nij", total, total) + np.einsum("nki,nkj->nij", seen, seen)
    return (volumes[:, None, None] * squares).sum(axis=0) / volumes.sum() / 20.0


def square_of_gyration(one, axis=1):
    """Mean square distance [m2] from an axis of the track through the centre of mass."""
    spread = second_moments(one)
    return np.trace(spread) - spread[axis, axis]
