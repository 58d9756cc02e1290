"""What each kind of device does with an orientation: one table from kind to verdict."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.bowl.devices import KINDS
from feederscrew.errors import ConfigError
from feederscrew.tooling import foot as feet
from feederscrew.tooling import turning
from feederscrew.tooling.hanging import Hanging, hanging_margin, head_first
from feederscrew.tooling.holding import leans, may_lay_over, may_wedge, rides, widest

CLOSE = 1e-9  # [m] a part this much over a limit still passes
UNSURE = 2e-9  # [m] by which one is returned at least that has no support for a while
WORN = 2.5e-4  # [m] what an opening holds by less does not hold a part up
FAR = 10.0  # [m] an opening goes on so far below the track and behind the wall


@dataclass(frozen=True)
class Verdict:
    """What a device does with one orientation."""

    passes: float  # [1] share that passes; the rest goes back into the bowl
    margin: float  # [m] by which it passes, negative: by which it fails; NaN of a measured share
    shift: float = 0.0  # [rad] of the device from the foot's radial line where the margin is least
    hangs: bool = False  # whether it goes on hanging by the head
    onto: tuple[tuple[int, float], ...] = ()  # orientations it goes on in, with their shares; () as it is

    @property
    def decided(self):
        """Whether statics tells what becomes of it: where a device turns, momentum may."""
        return not self.onto or self.margin >= 0.0

    @property
    def sure(self):
        """Whether its margin is one: not where momentum, friction or the wall may decide otherwise."""
        return not -UNSURE <= self.margin <= 0.0


@dataclass(frozen=True)
class Judge:
    """How one kind of device is judged and drawn."""

    verdict: Callable | None  # (device, orientation, all) -> (margin [m], shift [rad]); None: its own way
    picture: str  # what of the orientation a picture shows: 'side', 'above', 'ahead', 'turned' or ''
    cut: bool  # whether it is cut out of the track


def verdict(device, one, every=(), sigma=0.0):
    """Return what a device does with an orientation.

    Parameters
    ----------
    device : Device
    one : Orientation
    every : sequence of Orientation
        Of the part, which a profile may name.
    sigma : float [m]
        Standard deviation of play and tolerance together: the share that passes is then
        Phi(margin / sigma), not 0 or 1.

    Returns
    -------
    Verdict

    Raises
    ------
    ConfigError
        If a profile names an orientation that the part does not have.
    """
    if device.kind == "yield":
        shares = {name.casefold(): share for name, share in device.shares}
        return Verdict(shares.get(one.aspect.casefold(), 1.0), math.nan)
    if KINDS[device.kind].turns:
        return _turned(device, one, every, sigma)
    margin, shift = JUDGES[device.kind].verdict(device, one, every)
    hangs = not isinstance(one, Hanging) and _hangs(device, one, margin)
    return Verdict(share(margin, sigma), float(margin), float(shift), hangs)


def _turned(device, one, every, sigma):
    """What a step or a ledge does: every part goes on, some of them turned over."""
    every = tuple(every)
    here = next((k for k, other in enumerate(every) if other is one), None)
    if here is None:
        raise ValueError(f"{one.name} is not one of the orientations")
    if device.kind == "step":
        turned, margin = turning.over_step(one, every, device.limit)
    else:
        margin, _ = _balcony(device, one, every)
        beyond = 1.0 - share(margin, sigma)
        turned = ()
        if beyond > 0.0:
            turned, certain = turning.beyond_ledge(one, every, device.limit)
            turned = tuple((place, beyond * part) for place, part in turned)
            margin = margin if margin >= 0.0 else min(-margin, certain)
    stays = 1.0 - sum(part for _, part in turned)
    return Verdict(1.0, float(margin), onto=(((here, stays),) if stays > 0.0 else ()) + turned)


def _hangs(device, one, margin):
    """Whether rails that an orientation passes let it down by its shank."""
    return device.kind == "rails" and margin >= 0.0 and _slot(device, one, ())[0] < 0.0


def share(margin, sigma):
    """Return the share that passes at a margin [m], its standard deviation being ``sigma`` [m]."""
    if sigma > 0.0:
        return 0.5 * math.erfc(-margin / (sigma * math.sqrt(2.0)))
    return float(margin >= -CLOSE)


def _height(device, one, every):
    return _unless_laid_over(device.limit - one.height, one, device.limit), 0.0


def _unless_laid_over(margin, one, low):
    """Margin of what a blade with its edge at a height holds up: none where it may lay the part over."""
    if margin < 0.0 < one.grip and may_lay_over(one, low):
        return max(margin, -UNSURE)
    return margin


def _width(device, one, every):
    return device.limit - one.width, 0.0


def _balcony(device, one, every):
    needed = one.balcony
    return (device.limit - needed if math.isfinite(needed) else -one.standing.reach), 0.0


def _canyon(device, one, every):
    margin = one.canyon - device.limit
    return carried(margin, -margin, leans(one, device.limit) if margin < 0.0 else 0.0), 0.0


def _gap(device, one, every):
    return carried(one.gap - device.limit, device.limit - one.gap, one.carry_ahead), 0.0


def _slot(device, one, every):
    first, last = device.span
    radius = one.track.radius
    high = radius - first if first > 0.0 else 2.0 * radius
    margin = feet.over_ring(one.standing, max(radius - last, 0.0), high)
    return (max(margin, -UNSURE) if rides(one, last - first, np.inf) else margin), 0.0


def _rails(device, one, every):
    if isinstance(one, Hanging):
        return one.over(device.span), 0.0
    over, _ = _slot(device, one, every)
    held = hanging_margin(one, device.span[1] - device.span[0]) if over < 0.0 else -np.inf
    if held > 0.0 and one.grip > 0.0 and head_first(one) and may_wedge(one, device.span):
        return 0.0, 0.0
    return (min(held, -over) if held > 0.0 else over), 0.0


def _cut_out(device, one, every):
    hole = feet.polygon(np.array(device.corners), one.track.radius)
    margin, shift = feet.least(one.standing, hole)
    if margin < 0.0 < one.carry:
        margin = carried(margin, feet.unheld(one.standing, hole), one.carry)
        length = float(np.ptp(np.array(device.corners)[:, 0]))
        margin = max(margin, -UNSURE) if rides(one, widest(device.corners), length) else margin
    return margin, shift


def carried(margin, way, carry):
    """Return the margin [m] of an orientation that travels, from that of one that is placed.

    Parameters
    ----------
    margin : float [m]
    way : float [m]
        Over which it is not supported.
    carry : float [m]
        What it travels on before it has tipped is taken from that; within it the verdict has no margin.
    """
    return margin if margin >= 0.0 else min(max(margin, carry - way), -UNSURE)


def _profile(device, one, every):
    if device.like:
        opening = seen(_named(device, every)).buffer(device.like[2])
    else:
        opening = shapely.Polygon(device.corners)
    return gate_margin(opening, one), 0.0


def gate_margin(opening, one):
    """Return ``opening_margin`` [m] of an orientation that travels: none where the gate may lay it over."""
    margin = opening_margin(opening, one)
    if margin >= 0.0 or one.grip <= 0.0:
        return margin
    worn = opening.buffer(min(WORN, -0.5 * margin))
    return _unless_laid_over(margin, one, _beside(worn, one).bounds[1])


def opening_margin(opening, one):
    """Return by how much [m] what is seen of a part over the track stays within an opening.

    Parameters
    ----------
    opening : shapely geometry
        In distance from the wall and height [m]; track and wall themselves are no border of it.
    one : Orientation
        What of it is beyond the track's free edge meets no gate.
    """
    shown = seen(one).intersection(shapely.box(-FAR, -FAR, one.track.width, FAR))
    inside = shown.distance(_solid(opening, one.track.width))
    if inside > 0.0:
        return inside
    corners = shapely.get_coordinates(shown)
    return -float(shapely.distance(shapely.points(corners), opening).max())


def _solid(opening, width):
    """A gate as wide as the track, without its opening; track and wall themselves are none of it."""
    gate = shapely.box(0.0, 0.0, width, FAR)
    return gate.difference(opening)


def _beside(opening, one):
    """What is seen of an orientation beside an opening."""
    return seen(one).intersection(_solid(opening, one.track.width))


def seen(one):
    """Return the silhouette of an orientation as a shapely geometry."""
    return shapely.union_all([shapely.Polygon(ring) for ring in one.silhouette])


def _named(device, every):
    """The orientation a profile names: of its aspect the one nearest in heading."""
    aspect, heading, _ = device.like
    known = [one for one in every if one.aspect.casefold() == aspect.casefold()]
    apart = [abs(math.remainder(one.heading - heading, 2.0 * math.pi)) for one in known]
    if not known or min(apart) > math.radians(1.0):
        names = ", ".join(one.name for one in every)
        what = f"profile names orientation {aspect}@{math.degrees(heading):.4g}, which the part does not have"
        raise ConfigError(device.where, what, f"known are {names}")
    return known[apart.index(min(apart))]


JUDGES = {
    "wiper": Judge(_height, "side", False),
    "height_bar": Judge(_height, "side", False),
    "hold_down": Judge(_height, "side", False),
    "pressure_break": Judge(_width, "above", False),
    "narrowed_track": Judge(_balcony, "above", True),
    "canyon": Judge(_canyon, "above", True),
    "gap": Judge(_gap, "above", True),
    "slot": Judge(_slot, "above", True),
    "rails": Judge(_rails, "above", True),
    "cut_out": Judge(_cut_out, "above", True),
    "profile": Judge(_profile, "ahead", False),
    "step": Judge(None, "turned", False),
    "tip": Judge(None, "turned", False),
    "yield": Judge(None, "", False),
}
if set(JUDGES) != set(KINDS):
    raise ImportError(f"devices without a verdict, or verdicts without a device: {set(JUDGES) ^ set(KINDS)}")
