"""Make the two parts of the tutorial as STL: a countersunk screw and a ring terminal.

Example: python docs/tutorial/parts.py
"""

from pathlib import Path

import numpy as np
import trimesh

HERE = Path(__file__).parent
SECTIONS = 48
SCREW = (
    (0.0, 0.0),
    (2.0, 0.0),
    (2.0, 9.7),
    (3.9, 11.6),
    (3.9, 12.0),
    (0.0, 12.0),
)  # [mm] radius, height: M4 x 12
RING, HOLE, THICKNESS = 4.0, 2.15, 0.8  # [mm] radius, radius, thickness: for a stud of 4 mm
BARREL, BORE, LENGTH = 1.7, 1.05, 6.0  # [mm] radius, radius, length: for a wire of 1.5 mm2


def screw():
    """A screw with a countersunk head of 90 deg, without its drive and its thread."""
    return trimesh.creation.revolve(np.array(SCREW), sections=SECTIONS)


def terminal():
    """A flat ring with a round barrel that lies in line with it."""
    ring = trimesh.creation.cylinder(RING, THICKNESS, sections=SECTIONS)
    neck = trimesh.creation.box((4.0, 2.4, THICKNESS))
    neck.apply_translation((4.0, 0.0, 0.0))
    along = trimesh.transformations.rotation_matrix(np.pi / 2.0, (0, 1, 0))
    lift = BARREL - 0.5 * THICKNESS  # the barrel's lowest line in the lower face of the ring

    def tube(radius, length):
        made = trimesh.creation.cylinder(radius, length, sections=SECTIONS, transform=along)
        made.apply_translation((5.0 + 0.5 * LENGTH, 0.0, lift))
        return made

    solid = trimesh.boolean.union([ring, neck, tube(BARREL, LENGTH)], engine="manifold")
    hole = trimesh.creation.cylinder(HOLE, 2.0 * THICKNESS, sections=SECTIONS)
    return trimesh.boolean.difference([solid, hole, tube(BORE, LENGTH + 2.0)], engine="manifold")


if __name__ == "__main__":
    screw().export(HERE / "countersunk_m4x12.stl")
    terminal().export(HERE / "ring_terminal.stl")
