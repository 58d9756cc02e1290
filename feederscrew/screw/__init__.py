"""Twists, wrenches and momentum screws; knows neither parts nor bowls.

dual          dual numbers
point         named reference points
screws        Screw, Twist, Wrench, Momentum and their algebra
angle         dual angle between two screws
forces        Poinsot: forces and couples to one wrench
rigid         rigid displacements
chasles       displacement to finite twist and back
reciprocal    reciprocal screws, contact reactions and tipping axes
euler         momentum screw, dual Euler equation, spatial triangle
notation      one screw in the four notations of the literature
"""

from feederscrew.screw.angle import dual_angle
from feederscrew.screw.chasles import displacement, finite_twist
from feederscrew.screw.dual import Dual
from feederscrew.screw.euler import Body, SpatialTriangle, force_screw, spatial_triangle, twist_rate
from feederscrew.screw.forces import poinsot
from feederscrew.screw.point import ORIGIN, Point
from feederscrew.screw.reciprocal import reactions, reciprocal_twists, reciprocity, tipping_twists
from feederscrew.screw.rigid import Displacement
from feederscrew.screw.screws import Axis, Momentum, Screw, Twist, Wrench

__all__ = [
    "ORIGIN",
    "Axis",
    "Body",
    "Displacement",
    "Dual",
    "Momentum",
    "Point",
    "Screw",
    "SpatialTriangle",
    "Twist",
    "Wrench",
    "displacement",
    "dual_angle",
    "finite_twist",
    "force_screw",
    "poinsot",
    "reactions",
    "reciprocal_twists",
    "reciprocity",
    "spatial_triangle",
    "tipping_twists",
    "twist_rate",
]
