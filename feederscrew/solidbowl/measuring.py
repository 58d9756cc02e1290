"""What the finished solid measures, by rays on its surface and not by its plan."""

from dataclasses import dataclass

import numpy as np

from feederscrew.solidbowl import facets, grooves_wall
from feederscrew.solidbowl.plan import SEEN

WALL_RAY_HEIGHT_M = 5e-4  # [m] over the track, where its wall is met
RIM_SECTION_RAD = (
    -0.3 - 1e-4
)  # [rad] before the outlet, where the rim is measured; beside the corners of facets


@dataclass(frozen=True)
class Measures:
    """Lengths [m] of a solid, as a shop would measure them."""

    diameter: float  # inner, of the wall where the outlet leaves it
    wall: float
    floor: float  # thickness by the wall
    height: float  # from the underside to the rim
    track_width: float  # half a turn before the outlet, along the surface
    outlet_height: float  # of the outlet's surface over the floor's edge, by the wall
    extent: tuple[float, float, float]  # of a box around it


def measures(made):
    """Measure a bowl.

    Parameters
    ----------
    made : BowlSolid

    Returns
    -------
    Measures
    """
    plan, body = made.plan, facets.unplaced(made)
    way, far = plan.way, 3.0 * plan.way.radius
    high = plan.top - 1e-3
    at = _rim(plan)
    rim = facets.first_met(body, (0.0, 0.0, high), _towards(at, far, high))
    r = float(way.wall_radius(way.at(_bare(plan)))) - 1e-3
    bare = np.array([r * np.cos(_bare(plan)), r * np.sin(_bare(plan))])
    floor = facets.first_met(body, (*bare, 5e-4), (*bare, -far))
    s = float(way.at(-0.5 * np.pi))
    outlet = way.end + 0.5 * plan.outlet
    x, y, z = map(float, np.ptp(made.vertices, axis=0))
    return Measures(
        diameter=2.0 * (rim[0] + way.radius - float(way.wall_radius(way.at(at)))),
        wall=rim[1] - rim[0],
        floor=floor[1] - floor[0],
        height=float(np.ptp(made.vertices[:, 2])),
        track_width=track_width(plan, body, s),
        outlet_height=_outlet_height(plan, body, outlet),
        extent=(x, y, z),
    )


def _rim(plan):
    """An angle at which the rim is measured: before every groove, where the wall is open."""
    starts = [float(plan.way.angle(one[0])) - 0.1 for one in grooves_wall.spans(plan)]
    return min([RIM_SECTION_RAD, *starts])


def _outlet_height(plan, body, outlet):
    """Height [m] of the outlet at the wall, seen where there is metal beside it: rails leave a slot."""
    for across in (1e-3, 5e-4, 0.5 * plan.width, plan.width - 1e-3):
        found = facets.below(body, plan.way.places(outlet, across) + [0.0, 0.0, 1e-3])
        if found is not None:
            return found - across * float(np.sin(plan.way.bank_at(outlet)))
    return float(plan.way.height(outlet, 0.0))


def track_width(plan, body, s):
    """Return the width [m] of the track at a length along the wall, along its surface.

    Rays from the middle of the track along its surface to the wall, at two heights over it: a wall may lean,
    and is carried on straight to the surface. One from within, below the surface, to the free edge.
    """
    way = plan.way
    theta, half, bank = float(way.angle(s)), 0.5 * plan.width, float(way.bank_at(s))
    outward, middle = np.array([np.cos(theta), np.sin(theta), 0.0]), way.places(s, half)
    along = np.cos(bank) * outward - [0.0, 0.0, np.sin(bank)]
    low, high = (
        facets.first_met(body, start, start + 3.0 * way.radius * along)[0]
        for start in (middle + [0.0, 0.0, WALL_RAY_HEIGHT_M], middle + [0.0, 0.0, 2.0 * WALL_RAY_HEIGHT_M])
    )
    under = float(way.height(s, plan.width)) - SEEN * plan.material.plate
    to_middle = float(way.wall_radius(s)) - half * float(np.cos(bank))
    start = to_middle - plan.across  # over the floor, of which the dome may rise above the track further in
    near = start * outward + [0.0, 0.0, under]
    to_edge = start + facets.first_met(body, near, _towards(theta, 3.0 * way.radius, under))[0]
    return (2.0 * low - high) + (to_middle - to_edge) / float(np.cos(bank))


def heights(plan, body, s, y):
    """Return the height [m] of the first surface below a place a little over the track."""
    place = plan.way.places(s, y)
    return facets.below(body, place + [0.0, 0.0, 0.5 * plan.headroom])


def _towards(theta, far, z):
    return far * np.cos(theta), far * np.sin(theta), z


def _bare(plan):
    """An angle at which the floor lies bare by the wall, or about: opposite to the track's first rise."""
    return float(plan.way.angle(0.0)) - 0.1
