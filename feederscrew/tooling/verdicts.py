"""An orientation at a device: what statics knows to tell of it, and the device's verdict."""

from dataclasses import replace

import numpy as np
import shapely

from feederscrew.mechanics.wall.lying_in_groove import becomes
from feederscrew.tooling import drift, sensor_views, turning
from feederscrew.tooling import foot as feet
from feederscrew.tooling.devices.base import UNSURE, Verdict, share
from feederscrew.tooling.devices.pieces import GRIP
from feederscrew.tooling.falling_through import falls_through
from feederscrew.tooling.hanging import Hanging, hanging_margin, head_first, shoulder_margin, tip_goes_down
from feederscrew.tooling.holding import (
    hangs_free,
    leans,
    may_lay_aside,
    may_lay_over,
    may_wedge,
    rides,
    widest,
)

WORN = 2.5e-4  # [m] what an opening holds by less does not hold a part up
BEYOND_OPENING_M = 10.0  # [m] an opening goes on so far below the track and behind the wall


def verdict(device, one, every=(), sigma=0.0):
    """Return what a device does with an orientation.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    device : Device
    one : Orientation
    every : sequence of Orientation
        Of the part, which a device may name.
    sigma : float [m]
        Standard deviation of play and tolerance together: the share that passes is then
        Phi(margin / sigma), not 0 or 1.

    Returns
    -------
    Verdict

    Raises
    ------
    ConfigError
        If a device names an orientation that the part does not have.
    """
    meeting = Meeting(one, every, sigma)
    found, blur = device.judged(meeting), device.hop_blur(one)
    return _less(found, blur, meeting) if blur > 0.0 else found


def _less(found, blur, meeting):
    """A verdict with its margin less what hopping takes of it [m]; within that it is not sure either way."""
    if not np.isfinite(found.margin) or found.margin == 0.0 or -UNSURE <= found.margin < 0.0:
        return found
    left = np.copysign(max(abs(found.margin) - blur, 0.0), found.margin)
    left = left if found.margin > 0.0 else min(left, -UNSURE)
    passes = found.passes if found.onto else meeting.share(left)
    if found.onto and found.margin > 0.0 and left == 0.0:
        left = -UNSURE
    return replace(found, passes=passes, margin=float(left))


class Meeting:
    """One orientation at a device: what a device asks of it, and how it says what becomes of it."""

    def __init__(self, one, every=(), sigma=0.0):
        self.one, self.every, self.sigma = one, tuple(every), sigma

    @property
    def size(self):
        """Its greatest length [m] in the plane of the track or across it."""
        return float(np.hypot(self.one.length, max(self.one.width, self.one.height)))

    @property
    def grip(self):
        """Friction [1] of the track: of one that is only placed, that of a bowl of the defaults."""
        return self.one.grip if self.one.grip > 0.0 else GRIP

    def falls_through(self, cut):
        """Return whether a hole (K, 2) [m] that does not carry it lets it through."""
        return falls_through(self.one, cut)

    def differs(self, other, sees):
        """Return by how much [m] a sensor sees it differ from another orientation."""
        return sensor_views.difference(self.one, other, sees)

    def askew(self, sees):
        """Return by how much [m] a sensor may see it differ from itself, as it comes askew."""
        return sensor_views.askew(self.one, sees)

    def force_to_clear(self, wide, height):
        """Return the least force [N] over a way along the track that takes it off it, at a height [m]."""
        return drift.force_to_clear(self.one, wide, height)

    def blown(self, force, down, seconds):
        """Return how far [m] a force [N] for some time [s] carries it over a track that stands still.

        ``down`` [N] presses it on the track meanwhile. Less what it has to go to leave it: negative where
        it stays, as what hangs between rails does.
        """
        if self.hanging:
            return self.one.distance - self.one.track.width
        gravity = self.one.gravity
        weight = self.one.posture.mass * gravity
        left = force - self.grip * max(weight + down, 0.0)
        if left <= 0.0:
            return self.one.distance - self.one.track.width
        speed = left * seconds / self.one.posture.mass
        way = 0.5 * speed * seconds + speed**2 / (2.0 * gravity * self.grip)
        return float(way - (self.one.track.width - self.one.distance))

    @property
    def hanging(self):
        """Whether it comes hanging between rails."""
        return isinstance(self.one, Hanging)

    @property
    def place(self):
        """Its place among the orientations, also where the track leans otherwise by now."""
        one = self.one
        for k, other in enumerate(self.every):
            if other is one or (other.posture is one.posture and other.heading == one.heading):
                return k
        raise ValueError(f"{one.name} is not one of the orientations")

    def passing(self):
        """Return the verdict of a device that does nothing."""
        return Verdict(1.0, float("nan"))

    def verdict(self, margin, shift=0.0, hangs=False):
        """Return the verdict of a margin [m]; ``shift`` [rad] and ``hangs`` as in Verdict."""
        return Verdict(self.share(margin), float(margin), float(shift), hangs)

    def turning(self, turned, margin):
        """Return the verdict of a device that turns shares of it into others: (place, share) each."""
        here = self.place
        stays = 1.0 - sum(part for _, part in turned)
        return Verdict(1.0, float(margin), onto=(((here, stays),) if stays > 0.0 else ()) + tuple(turned))

    def share(self, margin):
        """Return the share that passes at a margin [m]."""
        return share(margin, self.sigma)

    def over_span(self, span):
        """Return its margin [m] on a track without what lies between two distances off the wall."""
        radius, (first, last) = self.one.track.radius, span
        high = radius - first if first > 0.0 else 2.0 * radius
        return feet.over_ring(self.one.standing, max(radius - last, 0.0), high)

    def over_slot(self, span):
        """Return the same, unless it may ride over the hole on its sides: it is then not sure."""
        margin = self.over_span(span)
        return max(margin, -UNSURE) if self.rides(span[1] - span[0], np.inf) else margin

    def over_hole(self, hole):
        """Return its least margin [m] over the passage of HoleEdges, and the shift [rad] where it is."""
        return feet.least(self.one.standing, hole)

    def unheld(self, hole):
        """Return the longest way [m] over which HoleEdges leave it without support."""
        return feet.unheld(self.one.standing, hole)

    def leans(self, width):
        """Return by how much [m] a strip along the wall may be wider than it passes, as it leans there."""
        return leans(self.one, width)

    def rides(self, width, length):
        """Return whether it rides on its round sides over a hole of a width and a length [m]."""
        return rides(self.one, width, length)

    def widest(self, corners):
        """Return the greatest width [m] across the track of a hole with some corners (K, 2) [m]."""
        return widest(corners)

    def unless_laid_over(self, margin, low, sweep=0.0):
        """Return the margin [m] of what a blade from a height on holds up: none where it may lay it over.

        A face with a ``sweep`` [rad] to the direction of travel may do so to the side as well.
        """
        if not margin < 0.0 < self.one.grip:
            return margin
        over = may_lay_over(self.one, low) or (sweep > 0.0 and may_lay_aside(self.one, low, sweep))
        return max(margin, -UNSURE) if over else margin

    def through(self, opening):
        """Return its margin [m] in an opening: ``gate_margin``."""
        return gate_margin(opening, self.one)

    def held_by_head(self, width, widest=None):
        """Return by how much [m] a slot of some width, at its widest, holds its head and not its shank."""
        return hanging_margin(self.one, width, widest)

    def held_by_shoulders(self, span):
        """Return by how much [m] its shoulders hold it in a slot, its stem down; -inf if not."""
        return shoulder_margin(self.one, span)

    def wedges(self, span):
        """Return whether its head, which comes first, may stick between rails as a wedge."""
        return self.one.grip > 0.0 and head_first(self.one) and may_wedge(self.one, span)

    def hangs_free(self, span):
        """Return whether its weight turns its shank down, and its head then stays off the wall."""
        return self.one.grip <= 0.0 or hangs_free(self.one, span)

    def goes_down(self, near):
        """Return whether the tip of its shank goes down beside a rail that ends ``near`` [m] the wall."""
        return self.one.grip <= 0.0 or tip_goes_down(self.one, near)

    def pitched(self):
        """Return how it turns over its leading edge: a Turn."""
        return turning.pitched(self.one, self.every)

    def pitched_over(self, height):
        """Return what a step of some height [m] turns it into, and the margin [m]."""
        return turning.over_step(self.one, self.every, height)

    def laid_in_groove(self, angle):
        """Return the verdict of a groove, of two faces at an angle [rad]: what it lies in as it came passes.

        What turns there, or comes to lie as none of the known does, is not sure.
        """
        here, found = self.place, becomes(self.one, self.every, angle)
        if found == ((here, 1.0),):
            return self.passing()
        return Verdict(1.0, -UNSURE, onto=tuple((here if k < 0 else k, part) for k, part in found))

    def rolled_over(self, width):
        """Return what a ledge of some width [m] turns it into if its weight lies beyond, and the margin."""
        return turning.beyond_ledge(self.one, self.every, width)


def gate_margin(opening, one):
    """Return ``opening_margin`` [m] of an orientation that travels: none where the gate may lay it over."""
    margin = opening_margin(opening, one)
    if margin >= 0.0 or one.grip <= 0.0:
        return margin
    worn = opening.buffer(min(WORN, -0.5 * margin))
    return Meeting(one).unless_laid_over(margin, _beside(worn, one).bounds[1])


def opening_margin(opening, one):
    """Return by how much [m] what is seen of a part over the track stays within an opening.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    opening : shapely geometry
        In distance from the wall and height [m]; track and wall themselves are no border of it.
    one : Orientation
        What of it is beyond the track's free edge meets no gate.
    """
    shown = one.seen.intersection(
        shapely.box(-BEYOND_OPENING_M, -BEYOND_OPENING_M, one.track.width, BEYOND_OPENING_M)
    )
    inside = shown.distance(_solid(opening, one.track.width))
    if inside > 0.0:
        return inside
    corners = shapely.get_coordinates(shown)
    return -float(shapely.distance(shapely.points(corners), opening).max())


def _solid(opening, width):
    """A gate as wide as the track, without its opening; track and wall themselves are none of it."""
    gate = shapely.box(0.0, 0.0, width, BEYOND_OPENING_M)
    return gate.difference(opening)


def _beside(opening, one):
    """What is seen of an orientation beside an opening."""
    return one.seen.intersection(_solid(opening, one.track.width))
