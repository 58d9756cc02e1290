"""Every key of a bowl file, once: checks, defaults and documentation are all read from here."""

from feederscrew.bowl.key import Key
from feederscrew.bowl.machine_keys import MACHINE_KEYS, SIZING_KEYS
from feederscrew.bowl.solid_keys import DRIVE_MOUNT_KEYS, HAND, SOLID_KEYS, SUPPLY
from feederscrew.bowl.unbalance import UNBALANCE_KEYS as UNBALANCE

BOWL_KEYS = (
    Key(
        "drive.amplitude", "drive.amplitude", "length", "0 mm", "20 mm", "0.21 mm",
        "half the peak-to-peak stroke, along the vibration direction",
    ),
    Key(
        "drive.peak_to_peak", "drive.amplitude", "length", "0 mm", "40 mm", "drive.amplitude",
        "the whole stroke, as the trade quotes it; write one of the two", 0.5,
    ),
    Key(
        "drive.frequency", "drive.frequency", "frequency", "1 Hz", "1000 Hz", "50 Hz",
        "of the vibration: that of the mains, or twice as much where both half-waves pull",
    ),
    Key(
        "drive.vibration_angle", "drive.vibration_angle", "angle", "0 deg", "90 deg", "25 deg",
        "beta, from the floor or track surface up to the vibration direction",
    ),
    Key(
        "drive.direction", "drive.direction", "angle", "-180 deg", "180 deg", "0 deg",
        "alpha, of the vibration within the surface; 0 is along the track",
    ),
    Key(
        "drive.phase", "drive.phase", "angle", "-180 deg", "180 deg", "0 deg",
        "by which the motion along the normal leads the one along the track: an elliptical drive",
    ),
    Key(
        "drive.second_harmonic", "drive.second_harmonic", "number", "0", "1", "0",
        "amplitude at twice the frequency, as a fraction of drive.amplitude",
    ),
    Key(
        "drive.second_harmonic_phase", "drive.second_harmonic_phase", "angle", "-360 deg", "360 deg", "0 deg",
        "psi of the motion sin(w t) + r sin(2 w t + psi), r being drive.second_harmonic",
    ),
    Key(
        "friction.static", "friction.static", "number", "0", "10", "0.6",
        "part on track, at the onset of sliding",
    ),
    Key(
        "friction.kinetic", "friction.kinetic", "number", "0", "10", "friction.static",
        "part on track, while sliding; never above static",
    ),
    Key(
        "friction.static_backward", "friction.static_backward", "number", "0", "10", "friction.static",
        "at the onset of sliding down the track; higher on a bristle coating",
    ),
    Key(
        "friction.kinetic_backward", "friction.kinetic_backward", "number", "0", "10", "friction.kinetic",
        "while sliding down the track; never above static_backward",
    ),
    Key(
        "friction.wall", "friction.wall", "number", "0", "10", "friction.kinetic",
        "part on bowl wall, while sliding",
    ),
    Key(
        "restitution", "restitution", "number", "0", "0.95", "0.2",
        "of an impact on the track: speed after over speed before",
    ),
    Key(
        "gravity", "gravity", "acceleration", "0.1 m/s2", "100 m/s2", "9.81 m/s2",
        "acceleration of free fall",
    ),
    Key(
        "track.climb", "track.climb", "angle", "-45 deg", "45 deg", "3 deg",
        "phi, rise along the track",
    ),
    Key(
        "track.bank", "track.bank", "angle", "0 deg", "85 deg", "0 deg",
        "delta, tilt about the track's direction, down towards the wall",
    ),
    Key(
        "track.radius", "track.radius", "length", "5 mm", "100 m", "150 mm",
        "of the bowl wall, where the track runs",
    ),
    Key(
        "track.width", "track.width", "length", "0.1 mm", "1000 mm", "25 mm",
        "of the track, from the wall to its free edge",
    ),
    *HAND,
    *MACHINE_KEYS,
    *UNBALANCE,
    *DRIVE_MOUNT_KEYS,
    *SUPPLY,
    *SIZING_KEYS,
    *SOLID_KEYS,
)  # fmt: skip
BY_NAME = {key.name: key for key in BOWL_KEYS}
OPTIONAL = ("machine",)  # sections that change other keys once one of theirs is given
BOWL_SECTIONS = tuple(dict.fromkeys(key.section for key in BOWL_KEYS if key.section))


def rival(key: Key) -> Key | None:
    """Return the other key of the same field, or None."""
    return next((other for other in BOWL_KEYS if other.field == key.field and other is not key), None)
