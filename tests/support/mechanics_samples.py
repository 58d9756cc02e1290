"""Parts and bowls for the tests of the mechanics."""

from dataclasses import replace

import numpy as np

from feederscrew.bowl.record import Bowl, Drive, Friction, Track
from feederscrew.motion.track_balance import Seat
from feederscrew.resting.posture import Posture

DEG = np.pi / 180.0
BOWL = Bowl(
    drive=Drive(amplitude=0.05e-3, frequency=60.0, vibration_angle=20 * DEG, direction=0.0),
    friction=Friction(static=0.3, kinetic=0.3, wall=0.3),
    track=Track(climb=3 * DEG, bank=10 * DEG, radius=0.15, width=0.025),
    restitution=0.2,
    gravity=9.81,
)


def bowl(**changes):
    """The sample bowl with some values changed, named by their own word."""
    made = BOWL
    for section in ("drive", "friction", "track"):
        inner = getattr(made, section)
        words = {word: value for word, value in changes.items() if hasattr(inner, word)}
        made = replace(made, **{section: replace(inner, **words)})
    top = {word: value for word, value in changes.items() if word in ("gravity", "restitution")}
    return replace(made, **top)


def rectangle(length, width, x=0.0, y=0.0):
    """Corners, counter-clockwise, of a rectangle about (x, y)."""
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return signs * [length / 2, width / 2] + [x, y]


def box_posture(length=0.03, width=0.01, height=0.005, mass=0.01, offset=0.0):
    """A box on a face of its own, by hand: no file, no hull."""
    plan = rectangle(length, width)
    moments = mass / 12.0 * np.array([width**2 + height**2, length**2 + height**2, length**2 + width**2])
    corners = np.array([[x, y, z] for x, y in plan for z in (0.0, height)])
    return Posture("A", "flat", mass, height / 2, np.diag(moments), plan, plan, offset, corners=corners)


def rolling_posture(radius=0.003, length=0.02, mass=0.004):
    """A solid cylinder on its side, axis along x."""
    about, across = 0.5 * mass * radius**2, mass * (radius**2 / 4 + length**2 / 12)
    plan, strip = rectangle(length, 2 * radius), rectangle(length, 1e-4)
    inertia = np.diag([about, across, across])
    return Posture("A", "rolling", mass, radius, inertia, strip, plan, 0.0, axis=np.array([1.0, 0.0]))


def random_seat(rng):
    """A part of random mass, size and inertia against the wall."""
    length, width, height = rng.uniform(0.01, 0.03), rng.uniform(0.004, 0.01), rng.uniform(0.001, 0.004)
    mass = rng.uniform(1e-3, 1e-2)
    behind, ahead = rng.uniform(0.3, 0.6, 2) * length
    beside = -rng.uniform(0.3, 0.7) * width
    walls = [[-behind, beside, rng.uniform(-1, 1) * height], [ahead, beside, rng.uniform(-1, 1) * height]]
    inertia = mass * length**2 / 12 * np.array([rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 1.0])
    return Seat(mass, height, 0.0, inertia, np.array(walls), rectangle(length, width))


def random_bowl(rng):
    """A bowl whose drive does not lift the part."""
    return bowl(
        amplitude=rng.uniform(0.01e-3, 0.06e-3),
        frequency=rng.uniform(40, 60),
        vibration_angle=rng.uniform(5, 40) * DEG,
        direction=rng.uniform(-20, 20) * DEG,
        static=rng.uniform(0.3, 0.7),
        kinetic=rng.uniform(0.1, 0.3),
        wall=rng.uniform(0.0, 0.4),
        climb=rng.uniform(0, 6) * DEG,
        bank=rng.uniform(0, 25) * DEG,
        radius=rng.uniform(0.08, 0.3),
    )
