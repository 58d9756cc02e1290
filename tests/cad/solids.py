"""Bowls as solids for the tests: planned by hand, built once, and checked as readers of STL see them."""

import functools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.reading import effective, record
from feederscrew.bowl.record import Track
from feederscrew.bowl.size import Size
from feederscrew.cad import facets
from feederscrew.cad.closed_body import body
from feederscrew.cad.measuring import ways_down
from feederscrew.cad.plan import SolidOptions, material, plan
from feederscrew.sorting.tooled_track import lay_out

RULES = record(effective({})).sizing
TRACK = Track(climb=np.radians(3.5), bank=0.0, radius=0.15, width=0.02)
STEEP = replace(TRACK, climb=np.radians(4.5))
PLAIN, STEPPED, CONICAL = (SolidOptions(shape=shape) for shape in ("cylinder", "stepped", "conical"))
NEAR = 5e-5  # [m]


def device(kind, **values):
    return make_device(kind, "b", **values)


def slanted(kind, degrees, text="{} deg"):
    """A bank, groove or spacing section at an angle."""
    return device(kind, angle=np.radians(degrees), text=text.format(degrees))


RAILS, GAP = device("rails", span=(3e-3, 7e-3)), device("gap", limit=9e-3)
CHAINS = {
    "none": (),
    "narrowed and rails": (device("narrowed track", limit=9e-3, text="9 mm"), RAILS),
    "gap": (GAP,),
    "canyon, slot": (device("canyon", limit=6e-3), device("slot", span=(8e-3, 12e-3))),
    "cut out": (device("cut-out", corners=((0.0, 0.0), (9e-3, 0.0), (9e-3, 8e-3))),),
    "blades": (device("wiper", limit=6e-3), device("hold-down", limit=8e-3)),
    "gate": (device("profile gate", corners=((0.0, 0.0), (9e-3, 0.0), (9e-3, 5e-3), (0.0, 7e-3))),),
    "jets": (*(device("air jet", nozzle=2e-3, pressure=2e4, height=z) for z in (1e-3, 8e-3)), GAP),
    "rails and wiper": (RAILS, device("wiper", limit=6e-3, sweep=np.radians(30.0))),
    "step": (device("step", limit=4e-3), device("gap", limit=5e-3)),
}


class One(SimpleNamespace):
    """What is 18 mm long, 14 mm wide and 12 mm high."""

    __hash__ = object.__hash__  # what devices compute of an orientation is kept

    def __init__(self, track):
        super().__init__(length=18e-3, height=12e-3, width=14e-3, track=track, size=np.hypot(18e-3, 14e-3))


def planned(devices=(), track=TRACK, asked=PLAIN, name="steel", turns=1.5):
    pitch = 2.0 * np.pi * track.radius * np.tan(track.climb)
    size = Size(2.0 * track.radius, {}, track.width, 0.0, 0.0, track.climb, turns * pitch, turns, pitch)
    tooled = lay_out(track, devices, [One(track)]) if devices else None
    track = track if tooled is None else tooled.track
    return plan(size, track, material(name, RULES), tooled, asked, extents=(18e-3, 14e-3, 12e-3))


@functools.cache
def built(chain="none", track=TRACK, asked=PLAIN, name="steel", turns=1.5):
    """The body of a chain of CHAINS."""
    return body(planned(CHAINS[chain], track, asked, name, turns))


def sized(solid):
    """The sheet's size of a solid, with where its mass lies."""
    own = {"mass": solid.mass, "inertia": solid.inertia, "unbalance": solid.unbalance}
    return Size(0.3, {}, 0.02, 0.0, 0.0, 0.06, 0.05, 1.5, 0.05, **own)


def closed(solid, near=1e-4):
    """The volume of a surface in which each edge has two facets that run opposite ways, and one piece."""
    faces = solid.faces
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert set(map(tuple, sides)) == set(map(tuple, sides[:, ::-1]))
    corners = (solid.vertices * 1e3).astype(np.float32).astype(float)[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert across.any(axis=1).all()
    points = np.unique((solid.vertices * 1e3).astype(np.float32), axis=0)
    assert not cKDTree(points).query_pairs(near)  # [mm] readers unite what lies nearer than 1e-5
    return float((corners[:, 0] * across).sum()) / 6.0


def is_one_body(solid):
    """Closed, of its volume, in one piece, and every way down from its track ends well."""
    assert closed(solid) == pytest.approx(solid.volume * 1e9, rel=1e-6)
    assert len(facets.placed(solid).decompose()) == 1
    return ways_down(solid)


def outward(place_or_angle):
    """The level direction (3,) from the axis at an angle, or to a place."""
    if np.ndim(place_or_angle) == 0:
        return np.array([np.cos(place_or_angle), np.sin(place_or_angle), 0.0])
    return np.array([*place_or_angle[:2], 0.0]) / np.hypot(*place_or_angle[:2])


def cuboid(half):
    """The eight corners (8, 3) of a box of half its sides."""
    return np.array(half) * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])


def rider(distance, height):
    """What lies so far off the wall, its centre of mass so high."""
    return SimpleNamespace(axes=np.eye(3), distance=distance, posture=SimpleNamespace(height=height))
