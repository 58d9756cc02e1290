"""Parts with closed-form answers, made without a file."""

import numpy as np
import trimesh

from feederscrew.part.record import Part

STEEL = 7850.0  # [kg/m3]


T_OUTLINE = [(-5.5, 0), (5.5, 0), (5.5, 12), (12.5, 12), (12.5, 25), (-12.5, 25), (-12.5, 12), (-5.5, 12)]
"""[mm] The profile of the thesis's T shape, 25 wide and high; it follows from Table 3-8."""


def part(mesh, name="part"):
    """Part of a trimesh in millimetres, of steel."""
    mesh = mesh.copy()
    mesh.apply_scale(1e-3)
    mesh.density = STEEL
    return Part(
        name=name, source=f"{name}.stl", sha256="0" * 64, units="mm", material="steel", density=STEEL,
        volume=float(mesh.volume), mass=float(mesh.mass), centre_of_mass=np.array(mesh.center_mass),
        inertia=np.array(mesh.moment_inertia), vertices=np.array(mesh.vertices), faces=np.array(mesh.faces),
    )  # fmt: skip


def box(x, y, z):
    """A box, its middle at the origin."""
    return trimesh.creation.box((x, y, z))


def cylinder(radius, height, sections):
    """A regular prism about z, its middle at the origin."""
    return trimesh.creation.cylinder(radius=radius, height=height, sections=sections)


def ball(radius, subdivisions):
    """A ball of 20 * 4**subdivisions facets."""
    return trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)


def prism(outline, thickness):
    """Prism over a simple polygon given counter-clockwise, by stitching its triangulated ends."""
    outline = np.asarray(outline, dtype=float)
    n, ears = len(outline), _ears(outline)
    vertices = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (-thickness / 2, thickness / 2)])
    k = np.arange(n)
    j = (k + 1) % n
    sides = np.vstack([np.column_stack([k, j, j + n]), np.column_stack([k, j + n, k + n])])
    return trimesh.Trimesh(vertices, np.vstack([ears[:, ::-1], ears + n, sides]), process=False)


def spur_gear(module=1.0, teeth=12, thickness=5.0):
    """A spur gear with straight flanks, about z."""
    root, tip, half = module * (0.5 * teeth - 1.25), module * (0.5 * teeth + 1.0), np.pi / (2 * teeth)
    flank = [(root, -0.9 * half), (tip, -0.4 * half), (tip, 0.4 * half), (root, 0.9 * half)]
    ring = [(far, 4.0 * half * k + turn) for k in range(teeth) for far, turn in flank]
    return prism([(far * np.cos(turn), far * np.sin(turn)) for far, turn in ring], thickness)


def t_nut(head=10.0, stem=5.0, high=3.0, deep=6.0, length=20.0):
    """A T profile, its stem down, extruded along z."""
    h, s = 0.5 * head, 0.5 * stem
    ring = [(-s, -deep), (s, -deep), (s, 0), (h, 0), (h, high), (-h, high), (-h, 0), (-s, 0)]
    return prism(ring, length)


def turned(mesh, rng):
    """The mesh turned and moved at random."""
    matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
    matrix[:3, 3] = rng.uniform(-50, 50, 3)
    return mesh.copy().apply_transform(matrix)


def noisy(mesh, size, rng):
    """The mesh with every corner moved by up to ``size``."""
    mesh = mesh.copy()
    mesh.vertices = mesh.vertices + rng.uniform(-size, size, mesh.vertices.shape)
    return mesh


def subdivided(mesh, times):
    """The same surface in 4**times as many facets."""
    for _ in range(times):
        mesh = mesh.subdivide()
    return mesh


def l_profile(width=30.0, height=20.0, sheet=2.0):
    """Outline of an L, counter-clockwise."""
    return [(0, 0), (width, 0), (width, sheet), (sheet, sheet), (sheet, height), (0, height)]


def _ears(points):
    """Triangles of a simple polygon by ear clipping."""
    left, out = list(range(len(points))), []

    def cross(o, a, b):
        (ax, ay), (bx, by) = points[a] - points[o], points[b] - points[o]
        return ax * by - ay * bx

    while len(left) > 2:
        for i in range(len(left)):
            a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            others = [p for p in left if p not in (a, b, c)]
            inside = (min(cross(a, b, p), cross(b, c, p), cross(c, a, p)) >= 0 for p in others)
            if cross(a, b, c) > 1e-12 and not any(inside):
                out.append((a, b, c))
                del left[i]
                break
    return np.array(out)
