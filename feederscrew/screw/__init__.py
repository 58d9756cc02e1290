"""Twists, wrenches and momentum screws; knows neither parts nor bowls.

A library of its own. The tool uses it for the contact that opens first on the track and the axis the part
then tips about (``mechanics.track.opening``): reactions and tipping twists are reciprocal screws there. The
equations of floor and track themselves are solved for whole maps at once, as arrays of six components in
``mechanics.track.system``; the tests hold them, and every screw the thesis prints, against this room.

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

Source: the thesis by the numbers of its equations; docs/method/screws.md and docs/equations.md.
"""

from feederscrew.screw.angle_between import dual_angle
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
