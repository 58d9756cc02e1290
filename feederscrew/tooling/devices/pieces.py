"""What stands along the track at one device: holes, blades, slopes, jets and a sensor, of no kind by name.

Coordinates of a device: x along the wall from where the device begins, y from the wall inwards, z over the
track. A device hands over one `Standing`; `trial.staging` makes of
it what the kernel takes.
"""

from dataclasses import dataclass

import numpy as np

BLADE = 1.5e-3  # [m] thickness of a blade
GATE_FRAME_M = 5e-3  # [m] of a gate above its opening
GRIP = 0.6  # [1] friction of a dry steel track


@dataclass(frozen=True, eq=False)
class Hole:
    """A hole through the track."""

    outline: np.ndarray  # (K, 2) [m] x, y; open into the wall where y <= 0, at the free edge where y >= width


@dataclass(frozen=True, eq=False)
class Blade:
    """An upright plate on or over the track, at any angle to it."""

    solid: object  # shapely: of its face [m], along the face from its foot, height over the track
    foot: tuple[float, float] = (0.0, 0.0)  # [m] x, y where the face begins
    heading: float = 0.5 * np.pi  # [rad] from the track's direction; less than a right angle is swept back
    thickness: float = BLADE  # [m] behind the face
    friction: float | None = None  # [1] static and kinetic, both ways; None is the track's


@dataclass(frozen=True, eq=False)
class Slope:
    """Another lean of the track, from a place on: to the end of what is tried, or to the next slope."""

    begin: float  # [m] x
    climb: float | None = None  # [rad] rise along the track; None is the bowl's own
    bank: float | None = None  # [rad] tilt towards the wall
    wall: float | None = None  # [rad] by which the wall leans back from upright; None is as before


@dataclass(frozen=True, eq=False)
class Jet:
    """A round jet of air that pushes what of a part is in it."""

    at: tuple[float, float, float]  # [m] x, y, z of its mouth
    towards: tuple[float, float, float]  # [1] along the wall, inwards, up
    radius: float  # [m]
    spread: float  # [1] growth of the radius along its way
    thrust: float  # [N] on what takes all of it
    reach: float  # [m] from the mouth
    seconds: float = np.inf  # [s] of a pulse that a sensor sets off; infinite of a steady one


@dataclass(frozen=True, eq=False)
class Sensor:
    """What looks at each part as its centre of mass comes to a place, and sets off the pulsed jets."""

    at: float  # [m] x
    sees: str  # 'outline' from above, 'side' from the bowl's axis, 'height' or 'relief'
    wanted: tuple  # of Orientation: what is like any of them passes
    play: float  # [m] what is seen to differ by less passes
    resolution: float  # [m] to which it sees


@dataclass(frozen=True, eq=False)
class Standing:
    """All that stands along the track at one device."""

    length: float = 0.0  # [m] of the device along the wall
    holes: tuple[Hole, ...] = ()
    blades: tuple[Blade, ...] = ()
    slopes: tuple[Slope, ...] = ()
    jets: tuple[Jet, ...] = ()
    sensor: Sensor | None = None
    drop: float = 0.0  # [m] by which the track that goes on lies lower
    aside: float = 0.0  # [m] from the wall, where that begins
    hangs: bool = False  # whether parts leave hanging, their centres of mass below the track
    slot: tuple[
        float, ...
    ] = ()  # [m] from the wall: between which rails what hangs goes on behind the device
    settles: float = 0.0  # of the part's size: how far behind the device parts go on until they are looked at


def across(gate, width, every, place):
    """Return a Blade square across a track of some width [m], with an opening, at a place [m] along it."""
    import shapely

    tall = 2.0 * max(max(one.height for one in every), gate.bounds[3]) + GATE_FRAME_M
    return Blade(shapely.box(0.0, 0.0, width, tall).difference(gate), foot=(place, 0.0))
