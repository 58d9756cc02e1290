"""A countersunk screw M5 between rails ever nearer to the wall, in MuJoCo: from where on it wedges.

Example: python benchmarks/wedging.py               (`pip install mujoco`; about a minute)
         python benchmarks/wedging.py 2.3 2.2       (where the slot of 5.4 mm begins [mm])

The drive of the default bowl on a straight wall; the screw hangs upright as it begins. Everything is in the
bowl's frame, in which the drive is a gravity that changes with time, as in ``trial_mujoco.py``.
"""

import sys

import numpy as np

from feederscrew import bowl as bowls

HEAD = ((2.5, 13.2), (5.0, 15.7), (5.0, 16.0))  # [mm] radius and height, from the shank's end
SHANK = ((2.5, 0.0), (2.5, 13.2))
SLOT, FLAT, SHEET = 5.4, 24, 1.0  # [mm]; sides; half of the sheet's thickness [mm]
STEP, SECONDS = 5e-5, 2.0  # [s]
NEAR = (3.0, 2.3, 2.2, 2.1)  # [mm] at 2.1 an upright one touches the wall and the farther rail
OFF, ABOVE = 0.02, 0.05  # [mm] from the wall at least, and over the rails, as it begins


def mesh(profile):
    """Places of a body of revolution as MuJoCo reads them."""
    turn = 2.0 * np.pi * np.arange(FLAT) / FLAT
    places = [(r * np.cos(t), r * np.sin(t), z) for r, z in profile for t in turn]
    return " ".join(f"{1e-3 * x:.7g}" for place in places for x in place)


def model(near, friction):
    """The wall, two rails and the screw between them."""
    far = near + SLOT
    own = f'friction="{friction} 0 0" solref="0.0005 1" solimp="0.95 0.99 0.0001" condim="3"'
    place = max(near + 0.5 * SLOT, HEAD[1][0] + OFF), ABOVE - SHANK[1][1] - 0.5 * SLOT + SHANK[0][0]
    rails = "".join(
        f'<geom {own} type="box" size="0.4 {1e-3 * half} {1e-3 * SHEET}" pos="0 {1e-3 * y} {-1e-3 * SHEET}"/>'
        for half, y in ((0.5 * near, 0.5 * near), (15.0, far + 15.0))
    )
    screw = "".join(f'<geom {own} type="mesh" mesh="{name}" density="7850"/>' for name in ("head", "shank"))
    return f"""<mujoco><option timestep="{STEP}" cone="elliptic" impratio="20" iterations="100"/>
<asset><mesh name="head" vertex="{mesh(HEAD)}"/><mesh name="shank" vertex="{mesh(SHANK)}"/></asset>
<worldbody><geom {own} type="plane" size="1 1 0.1" euler="-90 0 0"/>{rails}
<body pos="0 {1e-3 * place[0]} {1e-3 * place[1]}"><freejoint/>{screw}</body></worldbody></mujoco>"""


def velocity(near, bowl):
    """Velocity along the wall [mm/s] in the second half of the time."""
    import mujoco

    made = mujoco.MjModel.from_xml_string(model(near, bowl.friction.static))
    data, drive, climb = mujoco.MjData(made), bowl.drive, bowl.track.climb
    rate, ways = 2.0 * np.pi * drive.frequency, []
    for _ in range(round(SECONDS / STEP)):
        push = drive.amplitude * rate**2 * np.sin(rate * data.time)
        ahead = push * np.cos(drive.vibration_angle) - bowl.gravity * np.sin(climb)
        made.opt.gravity[:] = ahead, 0.0, push * np.sin(drive.vibration_angle) - bowl.gravity * np.cos(climb)
        mujoco.mj_step(made, data)
        ways.append(data.xpos[1, 0])
    half = len(ways) // 2
    return 1e3 * (ways[-1] - ways[half]) / (STEP * (len(ways) - 1 - half))


def main():
    """Print the velocity for each place of the slot."""
    bowl = bowls.default()
    for near in map(float, sys.argv[1:] or NEAR):
        print(f"slot {near:g} to {near + SLOT:g} mm: {velocity(near, bowl):.2f} mm/s", flush=True)


if __name__ == "__main__":
    main()
