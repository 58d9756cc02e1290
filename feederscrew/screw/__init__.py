"""Twists, wrenches and momentum screws; knows neither parts nor bowls.

The track uses them for the contact that opens first and the axis the part then tips about
(``mechanics.track_contacts``): reactions and tipping twists are reciprocal screws there. The equations of
floor and track are solved for whole maps at once, as arrays of six components in ``mechanics.track_balance``;
the tests hold them, and every screw the thesis prints, against this room.

Source: the thesis by the numbers of its equations; docs/method/screws.md and docs/equations.md.
"""

from feederscrew.screw.screws import (
    ORIGIN,
    Axis,
    Body,
    Dual,
    Momentum,
    Point,
    Screw,
    Twist,
    Wrench,
    force_screw,
    reactions,
    tipping_twists,
)

__all__ = [
    "ORIGIN",
    "Axis",
    "Body",
    "Dual",
    "Momentum",
    "Point",
    "Screw",
    "Twist",
    "Wrench",
    "force_screw",
    "reactions",
    "tipping_twists",
]
