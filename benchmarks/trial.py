"""The trial's kernel on six cases with closed answers, beside MuJoCo where that is installed: error and cost.

Example: python benchmarks/trial.py            (our kernel; MuJoCo too if `import mujoco` works)

Cases: sliding velocity on a vibrating plate; a block tipping over an edge; a bridge over a gap; a headed bar
hanging in a slot; a box on an incline at its friction angle; restitution of a corner hit.
"""

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.dropping.kernel import body
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import runs, shape, stations, whereabouts

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
import shapes
import trial_mujoco

OWN = (
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.3",
    "friction.static=0.4", "track.radius=50 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
)  # fmt: skip
BOWL = bowls.read(None, OWN)
STILL = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0), track=replace(BOWL.track, climb=0.0))
BLOCK = shapes.part(shapes.box(20, 12, 5))
ARCH = shapes.part(
    shapes.prism([(-10, 0), (-7, 0), (-7, 4), (7, 4), (7, 0), (10, 0), (10, 8), (-10, 8)], 12), "arch"
)
PIN = shapes.part(
    shapes.prism([(-2, -12), (2, -12), (2, 0), (4, 0), (4, 3), (-4, 3), (-4, 0), (-2, 0)], 4), "pin"
)


class Ours:
    """A part on a station with our kernel."""

    def __init__(self, part, bowl, device=None):
        self.every = orientations(part, find(part), bowl.track)
        self.bowl, (self.solid, self.length, self.principal) = bowl, shape.solid_of(part)
        self.known = runs.setting(self.solid, self.length, bowl)
        made = stations.plain(bowl.track, self.every, 1.0)
        self.stage = made if device is None else stations.station(device, bowl.track, self.every)

    def ride(self, state, seconds):
        """The end of one part after so long, the states without dimensions."""
        start = time.process_time()
        ride = runs.ride(
            runs.past(
                self.known, self.stage, every=1 / 60.0, places=2000, limits=(seconds, 2 * seconds, 0.0, 10.0)
            ),
            np.array(state)[None],
            np.zeros(1),
        )
        return ride, seconds / (time.process_time() - start)

    def lying(self, height, length, place=0.0):
        """A part laid down, by its height and its length along the track [m]."""
        one = min(self.every, key=lambda k: round(abs(k.height - height) + abs(k.length - length), 6))
        one = max((k for k in self.every if abs(k.height - one.height) < 1e-6), key=_legs)
        return whereabouts.laid(one, self.principal, self.length, self.bowl.track, place=place, aside=1e-3)


def _legs(one):
    """How many areas it stands on, and how long it is."""
    return len(one.foot.rings), one.length


def device(line):
    """One device as a bowl file writes it."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bowl.yaml"
        path.write_text(f"devices:\n  - {line}\n")
        return bowls.read(path, OWN).devices[0]


def sliding():
    ours = Ours(BLOCK, BOWL)
    ride, speed = ours.ride(ours.lying(5e-3, 2e-2), 1.0)
    path = ride.paths[0][np.isfinite(ride.paths[0][:, 0])]
    half = len(path) // 2
    velocity = (path[-1, 1] - path[half, 1]) / (path[-1, 0] - path[half, 0])
    return 1e3 * velocity, 1e3 * answer.answer(BOWL).velocity, "mm/s", speed


def edge(part, height, length, exact):
    """Where a part laid ever further over an edge falls [mm], by halving."""
    ours, low, high, speeds = Ours(part, STILL, device("gap: 40 mm")), exact - 2e-3, exact + 2e-3, []
    for _ in range(8):
        middle = 0.5 * (low + high)
        state = ours.lying(height, length, middle)
        ride, speed = ours.ride(state, 1.0)
        fell = ride.outcomes[0] != runs.RUNNING or ride.states[0][2] < 0.8 * state[2]
        low, high = (low, middle) if fell else (middle, high)
        speeds.append(speed)
    return 1e3 * 0.5 * (low + high), 1e3 * exact, "mm", float(np.median(speeds))


def incline():
    low, high, speeds = 0.2, 0.6, []
    for _ in range(10):
        middle = 0.5 * (low + high)
        ours = Ours(BLOCK, replace(STILL, track=replace(STILL.track, climb=np.arctan(middle))))
        ride, speed = ours.ride(ours.lying(5e-3, 2e-2), 0.3)
        low, high = (low, middle) if ride.ways[0] < -1e-6 else (middle, high)
        speeds.append(speed)
    return 0.5 * (low + high), 0.4, "friction", float(np.median(speeds))


def corner():
    ours = Ours(shapes.part(shapes.box(10, 10, 10)), STILL)
    reach = np.linalg.norm(ours.solid.corners[0])
    up = ours.solid.corners[0] / reach
    turn = np.cross(up, [0.0, 0.0, -1.0])
    half = 0.5 * np.arctan2(np.linalg.norm(turn), -up[2])
    state = np.zeros(body.STATE)
    state[body.Q : body.Q + 4] = np.cos(half), *(np.sin(half) * turn / np.linalg.norm(turn))
    state[:3] = 0.0, 2.0, reach + 1.0
    landing = np.sqrt(2.0)
    ride, speed = ours.ride(state, 1.3 * landing * ours.known.unit)
    return float(np.sqrt(ride.states[0][2] - reach)), 0.3, "restitution", speed


def hanging():
    """How deep a headed bar hangs between rails: its head's underside at the track [mm]."""
    ours = Ours(PIN, STILL, device("rails: {from: 5 mm, to: 11 mm}"))
    upright = next(k for k in ours.every if k.height > 14e-3)
    state = whereabouts.laid(upright, ours.principal, ours.length, STILL.track, place=0.01)
    turned = state.copy()
    low = -12e-3 - PIN.centre_of_mass[1]  # the shank's end under the centre of mass
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # the file's y up
    across = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # the head across the rails
    turned[body.Q : body.Q + 4] = whereabouts.quaternion(across @ axes @ ours.principal)
    theta = 0.01 / STILL.track.radius
    off = STILL.track.radius - 8e-3
    turned[:3] = off * np.sin(theta), STILL.track.radius - off * np.cos(theta), 0.4e-3 + PIN.centre_of_mass[1]
    turned[:3] /= ours.length
    ride, speed = ours.ride(turned, 0.5)
    return 1e3 * (ride.states[0][2] * ours.length), 1e3 * PIN.centre_of_mass[1], "mm" if low else "", speed


CASES = {
    "sliding velocity on a vibrating plate": sliding,
    "block tipping over an edge, from its centre": lambda: edge(BLOCK, 5e-3, 2e-2, 0.0),
    "bridge on its legs over an edge": lambda: edge(ARCH, 8e-3, 2e-2, -7e-3),
    "headed bar hanging in a slot": hanging,
    "box on an incline at its friction angle": incline,
    "restitution of a corner hit": corner,
}


def main():
    """Print every case: what is exact, what each engine finds, and its cost."""
    sliding()  # compiled here
    try:
        import mujoco
    except ImportError:
        mujoco = None
        print("MuJoCo is not installed: pip install mujoco to compare")
    print("case: exact; found, error, simulated seconds a second of one core; the same of MuJoCo")
    for name, case in CASES.items():
        found, exact, unit, speed = case()
        line = f"{name:45s} {exact:8.4f} {unit:11s} {found:9.4f} {found - exact:+8.4f} {speed:7.1f}"
        if mujoco is not None:
            other, cost = trial_mujoco.CASES[name]()
            line += f" | {other:9.4f} {other - exact:+8.4f} {cost:7.1f}"
        print(line, flush=True)


if __name__ == "__main__":
    main()
