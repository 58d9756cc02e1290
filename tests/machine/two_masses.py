"""Bowl and base as two rigid bodies that rise and turn, integrated in time: none of the closed forms."""

import numpy as np
from scipy.integrate import solve_ivp

GIVEN = (
    "machine.bowl_mass=6 kg", "machine.bowl_inertia=0.06 kg m2", "machine.base_mass=25 kg",
    "machine.base_inertia=0.25 kg m2", "machine.spring_radius=90 mm", "machine.spring_angle=20 deg",
    "machine.leaf_width=40 mm", "machine.leaf_thickness=2.5 mm", "machine.leaf_length=80 mm",
    "machine.leaf_modulus=206 GPa", "machine.leaves=10", "machine.damping=0.01",
)  # fmt: skip


def driven(machine, stiffness, damping, force, frequency, periods, steps=64):
    """The last period of a start from rest.

    Parameters
    ----------
    machine : Machine
    stiffness, damping, force
        Along the springs' motion [N/m], [N s/m], [N].
    frequency : float [Hz]
    periods, steps : int

    Returns
    -------
    (3, steps) float
        Way between bowl and base along the springs [m], rise of the bowl [m], its turn [rad].
    """
    w = 2.0 * np.pi * frequency
    sine, cosine, radius = np.sin(machine.spring_angle), np.cos(machine.spring_angle), machine.spring_radius
    m1, m2 = machine.bowl_mass, machine.base_mass
    i1, i2 = machine.bowl_inertia, machine.base_inertia
    along = np.array([sine, radius * cosine])  # of rise and turn: the way the leaves bend
    across = np.array([cosine, -radius * sine])  # the way they do not
    soft = np.array([1.0 / m1 + 1.0 / m2, 1.0 / i1 + 1.0 / i2])

    def motion(t, y):
        z, turn, vz, vturn = y[:4]  # bowl over base: rise, turn, their speeds
        way, speed = z * sine + radius * turn * cosine, vz * sine + radius * vturn * cosine
        push = force * np.cos(w * t) - stiffness * way - damping * speed
        hold = -push * (across * soft * along).sum() / (across * soft * across).sum()
        load = push * along + hold * across  # force and moment on the bowl; the base feels the opposite
        own = load / np.array([m1, i1])
        return [vz, vturn, *(soft * load), y[6], y[7], *own]

    end = periods / frequency
    times = end - np.arange(steps)[::-1] / (steps * frequency)
    done = solve_ivp(
        motion, (0.0, end), np.zeros(8), method="DOP853", rtol=1e-10, atol=1e-15, t_eval=times,
        max_step=0.05 / frequency,
    )  # fmt: skip
    z, turn = done.y[0], done.y[1]
    return np.array([z * sine + radius * turn * cosine, done.y[4], done.y[5]])


def amplitude(wave):
    """Amplitude of the first harmonic of one period, evenly sampled."""
    turn = 2.0 * np.pi * np.arange(len(wave)) / len(wave)
    return 2.0 / len(wave) * np.hypot((wave * np.cos(turn)).sum(), (wave * np.sin(turn)).sum())
