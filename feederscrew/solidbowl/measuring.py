"""What the finished solid measures, by rays on its surface and not by its plan."""

from dataclasses import dataclass

import numpy as np

from feederscrew.solidbowl import facets

RIM = -0.3 - 1e-4  # [rad] before the outlet, where the rim is measured; beside the corners of facets


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
    rim = facets.first_met(body, (0.0, 0.0, high), _towards(RIM, far, high))
    r = float(way.wall_radius(way.at(_bare(plan)))) - 1e-3
    bare = np.array([r * np.cos(_bare(plan)), r * np.sin(_bare(plan))])
    floor = facets.first_met(body, (*bare, 5e-4), (*bare, -far))
    s = float(way.at(-0.5 * np.pi))
    outlet = way.end + 0.5 * plan.outlet
    return Measures(
        diameter=2.0 * (rim[0] + way.radius - float(way.wall_radius(way.at(RIM)))),
        wall=rim[1] - rim[0],
        floor=floor[1] - floor[0],
        height=float(np.ptp(made.vertices[:, 2])),
        track_width=track_width(plan, body, s),
        outlet_height=_outlet_height(plan, body, outlet),
        extent=tuple(float(x) for x in np.ptp(made.vertices, axis=0)),
    )


def _outlet_height(plan, body, outlet):
    """Height [m] of the outlet at the wall, seen where there is metal beside it: rails leave a slot."""
    for across in (1e-3, 5e-4, 0.5 * plan.width, plan.width - 1e-3):
        found = facets.below(body, plan.way.places(outlet, across) + [0.0, 0.0, 1e-3])
        if found is not None:
            return found - across * np.sin(plan.way.bank)
    return float(plan.way.height(outlet, 0.0))


def track_width(plan, body, s):
    """Return the width [m] of the track at a length along the wall, along its surface.

    Two rays: outwards above the track to the wall, and outwards below its surface to its free edge.
    """
    way = plan.way
    theta = float(way.angle(s))
    inside = float(way.wall_radius(s)) - plan.across
    z = float(way.height(s, plan.width))
    to_wall = facets.first_met(body, (0.0, 0.0, z + 1e-3), _towards(theta, 3.0 * way.radius, z + 1e-3))[0]
    under = z - 0.3 * plan.material.plate
    start = 0.5 * inside
    near = (start * np.cos(theta), start * np.sin(theta), under)
    to_edge = start + facets.first_met(body, near, _towards(theta, 3.0 * way.radius, under))[0]
    return (to_wall - to_edge) / float(np.cos(way.bank))


def heights(plan, body, s, y):
    """Return the height [m] of the first surface below a place a little over the track."""
    place = plan.way.places(s, y)
    return facets.below(body, place + [0.0, 0.0, 0.5 * plan.headroom])


def _towards(theta, far, z):
    return far * np.cos(theta), far * np.sin(theta), z


def _bare(plan):
    """An angle at which the floor lies bare by the wall, or about: opposite to the track's first rise."""
    return float(plan.way.angle(0.0)) - 0.1
