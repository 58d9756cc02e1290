"""What a vision reject is built from: camera, lens, light, trigger, valve, and holes for brackets.

Values that the trade fixes, not this part, are named constants with their source or marked as an assumption.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.bowl.devices.base import room_of
from feederscrew.bowl.devices.features import SAME_PLACE_M, Bore
from feederscrew.bowl.devices.pneumatics import REACTION, SENSOR_TO_NOZZLE_M, TRIGGER, VisionReject
from feederscrew.bowl.record import Bowl
from feederscrew.feeding.stream import on_stretch
from feederscrew.sorting.orientations import Orientation, travel_speed

FIELD_MARGIN = 1.2  # [1] of the window: to align the camera (assumption)
PIXELS_PER_RESOLUTION = 2.0  # an edge is found to half of what two pixels cover: sampling theorem
# of a lens over the track (assumption)
AIM_M = 0.25
LEAST_DISTANCE_M = 0.12
GREATEST_DISTANCE_M = 0.6
BLUR_SHARE = 0.5  # [1] of the resolution that anything moves while the picture is taken
FOCAL_LENGTHS_M = (
    6e-3,
    8e-3,
    12e-3,
    16e-3,
    25e-3,
    35e-3,
    50e-3,
    75e-3,
)  # fixed C-mount lenses that are stocked
STAND_HOLE_M, STAND_THREAD = 6.6e-3, "M6"  # ISO 273, medium
STAND_OFF_M = 0.1  # of a laser line over the track (assumption)
LIGHTS = {  # by what a sensor sees (assumption)
    "outline": "flat dome light over the window, strobed; dull black inlay on the track below it",
    "side": "bar light beside the camera, strobed; dull white inlay in the wall behind the part",
    "height": "none: light of the through-beam fibres",
    "relief": "none: the laser's own line, across the wall's direction of view",
}


@dataclass(frozen=True)
class VisionCamera:
    """An industrial camera by the chip in it."""

    chip: str
    columns: int
    rows: int
    pixel: float  # [m]

    @property
    def size(self) -> tuple[float, float]:
        """Width and height [m] of the chip."""
        return self.columns * self.pixel, self.rows * self.pixel


CAMERAS = (  # of the chips' data sheets, the cheapest first
    VisionCamera("1.6 MP global shutter (IMX273)", 1440, 1080, 3.45e-6),
    VisionCamera("5 MP global shutter (IMX250)", 2448, 2048, 3.45e-6),
    VisionCamera("12 MP global shutter (IMX253)", 4096, 3000, 3.45e-6),
)


@dataclass(frozen=True)
class Lens:
    """A lens before a camera, focused on the track."""

    camera: VisionCamera
    focal_length: float  # [m]
    distance: float  # [m] from the lens to the track
    magnification: float  # [1] picture over part
    pixel: float  # [m] of the part that a pixel covers


def choose_lens(field: tuple[float, float], resolution: float) -> Lens:
    """Return the cheapest camera that resolves a field, with the lens that stands nearest to ``AIM_M``.

    Thin lens: 1 / f = 1 / a + 1 / b and m = b / a, so a = f (1 + 1 / m). The magnification m is the greatest
    at which the chip holds the field. A pixel covers p / m of the part, p the pixel of the chip; it may be
    the resolution over ``PIXELS_PER_RESOLUTION``. Where no camera resolves it, it is the finest.

    Parameters
    ----------
    field : (float, float) [m]
        Along and across the track, either may be the longer one: the camera is turned with it.
    resolution : float [m]

    Returns
    -------
    Lens

    References
    ----------
    E. Hecht, "Optics", 5th ed., 2017, section 5.2.3; Stemmer Imaging, "Optics technical overview".
    """
    longer, shorter = max(field), min(field)
    for camera in CAMERAS:
        wide, high = camera.size
        magnification = min(wide / longer, high / shorter)
        pixel = camera.pixel / magnification
        if pixel <= resolution / PIXELS_PER_RESOLUTION:
            break
    distances = [(f, f * (1.0 + 1.0 / magnification)) for f in FOCAL_LENGTHS_M]
    usable = [pair for pair in distances if LEAST_DISTANCE_M <= pair[1] <= GREATEST_DISTANCE_M] or distances
    focal_length, distance = min(usable, key=lambda pair: abs(pair[1] - AIM_M))
    return Lens(camera, focal_length, distance, magnification, pixel)


@dataclass(frozen=True)
class VisionStation:
    """A vision reject as it is built: lengths along the wall from where its device begins."""

    number: int  # of the device, from 1
    sees: str  # of ``pneumatics.SENSOR_VIEWS``
    field: tuple[float, float]  # [m] along the track, and across or up
    resolution: float  # [m]
    speed: float  # [m/s] of parts at the sensor
    lens: Lens | None  # None of a fibre or a laser
    parallax: float  # [m] by which the top of the tallest part is seen off its place at the field's edge
    exposure: float  # [s] at most
    beams: tuple[float, ...]  # [m] heights of the fibres' beams
    profiles: float  # [1/s] of a laser line, at least; 0 of others
    light: str
    sensor_at: float  # [m] where a part is looked at: its centre of mass
    trigger_at: float  # [m] of the light barrier that its front meets
    trigger_delay: float  # [s] from there to the picture
    valve_way: float  # [m] from the sensor to the nozzles
    valve_delay: float  # [s] that the part takes for it
    valve_setting: float  # [s] to set: less the reaction of sensor and valve
    pulse: float  # [s]
    holes: tuple[Bore, ...]  # beside those of the nozzles, which the solid has as well
    lacks: str  # what no camera on the list does; '' where all is well


def plan_vision_stations(bowl: Bowl, orientations: Sequence[Orientation]) -> tuple[VisionStation, ...]:
    """Return what each vision reject of a bowl is built from.

    A part is looked at as its centre of mass passes the sensor, and blown at as it passes the nozzles, the
    way d behind it: at the speed v that is d / v later. The valve is set that long after the picture, less
    ``REACTION``. The light barrier stands where the front of the wanted part is then, or, where that is
    behind the nozzles, at the begin of the window with a delay. While the shutter is open nothing may move
    by more than ``BLUR_SHARE`` of the resolution: neither the part at v nor the bowl at 2 pi f A.

    Parameters
    ----------
    bowl : Bowl
        With its devices and its drive.
    orientations : (M,) sequence of Orientation
        As parts come along the track.

    Returns
    -------
    tuple of VisionStation
        One for each vision reject, in the order parts meet them.

    References
    ----------
    ``choose_lens``; docs/tooling.md, "1. The method".
    """
    here, stations = orientations[0], []
    room, tallest = room_of(orientations), max(one.height for one in orientations)
    shaking = 2.0 * np.pi * bowl.drive.frequency * bowl.drive.amplitude
    placed = [device for device in bowl.devices if device.action.has_place]
    for number, device in enumerate(placed, start=1):
        here = device.onward(here)
        if not isinstance(device, VisionReject):
            continue
        speed = travel_speed(on_stretch(bowl, here))
        wanted = device.wanted(orientations)[0]
        resolution, play, middle = device.blur, device.like[2], 0.5 * room
        across = tallest if device.sees == "side" else bowl.track.width
        field = FIELD_MARGIN * room, FIELD_MARGIN * across
        lens = choose_lens(field, resolution) if device.sees in ("outline", "side") else None
        lacks = ""
        if lens is not None and lens.pixel > resolution / PIXELS_PER_RESOLUTION:
            what = (
                f"a pixel covers {1e3 * lens.pixel:.3g} mm, half the resolution is {500 * resolution:.3g} mm"
            )
            lacks = f"{what}: take a line-scan camera, or a narrower window"
        holes = device.features(bowl.track, orientations).mounts
        (trigger,) = (hole.place for hole in holes if hole.what == TRIGGER)
        way = middle + float(wanted.outline[:, 0].max()) - trigger  # of the front, from the barrier on
        delay = 0.0 if way <= SAME_PLACE_M else way / speed if speed > 0.0 else np.inf
        valve = SENSOR_TO_NOZZLE_M / speed if speed > 0.0 else np.inf
        far = np.inf if lens is None else lens.distance
        stations.append(
            VisionStation(
                number=number,
                sees=device.sees,
                field=field,
                resolution=resolution,
                speed=speed,
                lens=lens,
                parallax=0.0 if lens is None else 0.5 * max(field) * tallest / (far - tallest),
                exposure=BLUR_SHARE * resolution / max(speed, shaking),
                beams=(wanted.height - play, wanted.height + play) if device.sees == "height" else (),
                profiles=speed / resolution if device.sees == "relief" else 0.0,
                light=LIGHTS[device.sees],
                sensor_at=middle,
                trigger_at=trigger,
                trigger_delay=float(delay),
                valve_way=SENSOR_TO_NOZZLE_M,
                valve_delay=float(valve),
                valve_setting=float(max(valve - REACTION, 0.0)),
                pulse=device.time,
                holes=holes,
                lacks=lacks,
            )
        )
    return tuple(stations)
